//! A state of a model, edge by edge and as a cylinder.

use crate::kinematics::Shape;
use crate::kinematics::metric::LatticeFrame;
use crate::math::Vec3;
use crate::model::{Domain, Drawn, Element, Memory, Model, ScrewTurns, TermKind};
use crate::solver::Problem;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// The numbers that bars, and hinges, remember that yield: what they keep, and how far that has gone in all.
pub(crate) const REMEMBERED: [[&str; 2]; 2] =
    [["plastic_strain", "plastic_strain_total"], ["plastic_angle", "plastic_angle_total"]];

/// What an equilibrium, or any other state, looks like.
///
/// Lists of numbers of edges are in the order of the edges of the [tiling](crate::model::Assembly::tiling), each of
/// which names its cell and its edge of the [sheet](crate::model::Assembly::sheet); coordinates are x, y, z of the
/// points of the tiling one after the other.
///
/// ```
/// use foldwell::sheet::EdgeKind;
/// use foldwell::{Assembly, Pattern, RIGID, Rest, generate, relax};
///
/// let sheet = generate(&Pattern::named("miura")?)?;
/// let assembly = Assembly::patch(sheet, [2, 2]).bars(RIGID).creases(1.0).rest(Rest::Flat).build()?;
/// let state = relax(&assembly)?.state;
/// for (edge, angle) in assembly.tiling().edges.iter().zip(&state.fold_angle) {
///     let of_cell = &assembly.sheet().edges[edge.edge];
///     if of_cell.kind == EdgeKind::Crease {
///         println!("cell {:?}, crease {:?}: {angle:.4} rad", edge.cell, of_cell.key);
///     }
/// }
/// assert_eq!(state.fold_angle.len(), assembly.tiling().edges.len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// All coordinates in the domain's frame, shared ones last.
    pub coordinates: Vec<f64>,
    /// Energy of the bars.
    pub energy_bars: f64,
    /// Energy of the creases.
    pub energy_creases: f64,
    /// Energy of the facets.
    pub energy_facets: f64,
    /// Names and energies of the terms of one's own.
    pub energy_own: Vec<(String, f64)>,
    /// Fold angle of every edge that has a hinge in the model, in radians, continued through pi; else NaN.
    pub fold_angle: Vec<f64>,
    /// Rest angle of the same hinges; NaN where there is none.
    pub rest_angle: Vec<f64>,
    /// Strain of every bar; NaN where there is none.
    pub strain: Vec<f64>,
    /// Energy of every edge, bar and hinge together.
    pub energy: Vec<f64>,
    /// Force along every bar, positive where it is stretched; NaN where there is none.
    pub tension: Vec<f64>,
    /// Torque of the hinges over every edge, that of a lock included; NaN where there is none.
    pub torque: Vec<f64>,
    /// Energy that elements have dissipated which yield, on all the way to this state.
    pub dissipated: f64,
    /// Memories of the elements that yield, one list for each name, one number for each edge, NaN where nothing yields:
    /// `plastic_strain` of bars and `plastic_angle` of hinges in radians, which they keep without force, and
    /// `plastic_strain_total` and `plastic_angle_total`, the sums of the sizes of all changes of these. Empty for sheets
    /// that are elastic.
    pub memory: BTreeMap<&'static str, Vec<f64>>,
}

impl State {
    /// A state of `edges` edges of which nothing is known but where its points are.
    pub fn empty(coordinates: Vec<f64>, edges: usize) -> Self {
        let unknown = || vec![f64::NAN; edges];
        Self {
            coordinates,
            fold_angle: unknown(),
            rest_angle: unknown(),
            strain: unknown(),
            energy: vec![0.0; edges],
            tension: unknown(),
            torque: unknown(),
            ..Self::default()
        }
    }

    /// The state of a model with these unknowns and tensions of the stiff measures. Stiff measures have the energy of
    /// their tensions, without cancellation.
    pub fn new(model: &Model, x: &[f64], tension: &[f64]) -> Self {
        let coordinates = model.coordinates(x);
        let measured = Self::of_measures(model, |element| element.value(&coordinates), |row, _| tension[row]);
        Self { coordinates, ..measured }
    }

    /// The state of a model whose elements have these values, and whose stiff measures, counted through, have these
    /// tensions at these values. It has no coordinates.
    pub(super) fn of_measures(
        model: &Model,
        value: impl Fn(&Element<'_>) -> f64,
        tension: impl Fn(usize, &Element<'_>) -> f64,
    ) -> Self {
        let mut state = Self::empty(vec![], model.edges());
        for element in model.soft() {
            let value = value(&element);
            let [energy, force, _] = element.response(value);
            state.add(&element, value, [force, energy]);
        }
        for (row, element) in model.stiff().enumerate() {
            let tension = tension(row, &element);
            let energy = 0.5 * model.compliance()[row] * tension * tension;
            state.add(&element, value(&element), [tension, energy]);
        }
        state
    }

    /// Returns the state with these fold angles of the edges that are not hinges of its model.
    pub fn with_angles(mut self, angles: Vec<f64>) -> Self {
        let unknown = self.fold_angle.iter_mut().zip(angles).filter(|(known, _)| known.is_nan());
        unknown.for_each(|(known, angle)| *known = angle);
        self
    }

    /// Adds an element whose measure has this value and which has this force and this energy.
    fn add(&mut self, element: &Element<'_>, value: f64, [force, energy]: [f64; 2]) {
        if element.is_load() {
            return;
        }
        let Some(edge) = element.edge() else { return self.add_own(element.name(), energy) };
        let energy = energy - self.remember(element, edge, value);
        let rest = element.spring.rest;
        if element.is_angle() {
            (self.fold_angle[edge], self.rest_angle[edge]) = (value, rest);
            add_known(&mut self.torque[edge], force);
        } else {
            self.strain[edge] = value / rest - 1.0;
            add_known(&mut self.tension[edge], force);
        }
        self.energy[edge] += energy;
        match element.kind() {
            TermKind::Bars => self.energy_bars += energy,
            TermKind::Creases => self.energy_creases += energy,
            TermKind::Facets => self.energy_facets += energy,
            TermKind::Locks | TermKind::Own | TermKind::Pressure | TermKind::Torque => {
                debug_assert!(energy == 0.0, "locks are rigid");
            }
        }
    }

    /// Notes what an element remembers after a value; returns what it has dissipated.
    fn remember(&mut self, element: &Element<'_>, edge: usize, value: f64) -> f64 {
        if !element.remembers() {
            return 0.0;
        }
        let (Memory { kept, gone }, dissipated) = element.after(value);
        let edges = self.energy.len();
        for (name, number) in REMEMBERED[usize::from(element.is_angle())].into_iter().zip([kept, gone]) {
            self.memory.entry(name).or_insert_with(|| vec![f64::NAN; edges])[edge] = number;
        }
        self.dissipated += dissipated;
        dissipated
    }

    /// Adds to the energy of a term of one's own.
    fn add_own(&mut self, name: &str, energy: f64) {
        match self.energy_own.iter_mut().find(|(known, _)| known == name) {
            Some((_, sum)) => *sum += energy,
            None => self.energy_own.push((name.to_owned(), energy)),
        }
    }

    /// Energy of a term by its name: bars, creases, facets, or that of a term of one's own; 0 where there is none of
    /// this name.
    pub fn energy_of_term(&self, name: &str) -> f64 {
        let kind = TermKind::ALL.into_iter().find(|kind| kind.name() == name);
        let own = self.energy_own.iter().find(|(known, _)| known == name).map(|(_, energy)| *energy);
        own.or_else(|| kind.map(|kind| self.energy_of(kind))).unwrap_or(0.0)
    }

    /// Energy of the terms of a kind; locks are rigid and loads have none, and terms of one's own are taken together.
    pub(crate) fn energy_of(&self, kind: TermKind) -> f64 {
        match kind {
            TermKind::Bars => self.energy_bars,
            TermKind::Creases => self.energy_creases,
            TermKind::Facets => self.energy_facets,
            TermKind::Locks | TermKind::Pressure | TermKind::Torque => 0.0,
            TermKind::Own => self.energy_own.iter().map(|(_, energy)| energy).sum(),
        }
    }

    /// Energy of all terms.
    pub fn total(&self) -> f64 {
        TermKind::ALL.iter().fold(0.0, |sum, kind| sum + self.energy_of(*kind))
    }
}

/// Adds to a number that is NaN as long as nothing was added.
fn add_known(sum: &mut f64, part: f64) {
    *sum = if sum.is_nan() { part } else { *sum + part };
}

/// A sheet periodic up to screw motions, as seen from vertex 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cylinder {
    /// Signed curvature, 1/(distance of vertex 0 from the axis), with the sign of the chart's: it changes only where
    /// the curvature passes zero, as that of a [shape](crate::kinematics::Shape) along a trajectory does.
    pub curvature: f64,
    /// Rotation angles of the two lattice rotations about their common axis, in radians, between -pi and pi. The axis
    /// is directed so that the larger of the two in magnitude is positive.
    pub theta: [f64; 2],
    /// Strain `a^-T g a^-1 - I` of the chords from vertex 0 to its copies: components 11, 22, 12.
    pub strain: [f64; 3],
}

impl From<&Shape> for Cylinder {
    fn from(shape: &Shape) -> Self {
        Self { curvature: shape.curvature, theta: shape.theta, strain: shape.strain }
    }
}

/// The cylinder of a periodic state; `None` on a patch.
pub(crate) fn cylinder(drawn: &Drawn, x: &[f64]) -> Option<Cylinder> {
    let domain = &drawn.domain;
    let chords = chords(domain, x)?;
    let (curvature, theta) = curvature_and_turns(domain, x);
    let theta = theta.map(|theta| theta - TAU * (theta / TAU).round());
    let larger = if theta[0].abs() >= theta[1].abs() { theta[0] } else { theta[1] };
    let sign = if larger < 0.0 { -1.0 } else { 1.0 };
    let reference = drawn.chords.or_else(|| self::chords(domain, &drawn.coordinates))?;
    Some(Cylinder { curvature, theta: theta.map(|t| t * sign), strain: LatticeFrame::new(&reference).strain(&chords) })
}

/// The signed curvature, and the turns of the two lattice vectors about one direction of the axis; zero where nothing
/// turns.
fn curvature_and_turns(domain: &Domain, x: &[f64]) -> (f64, [f64; 2]) {
    if let Some(ScrewTurns { kappa, theta, .. }) = domain.turns(x) {
        return (kappa / (1.0 - kappa * x[2]), theta);
    }
    let (Some([turns, shifts]), Domain::Tube { counterclockwise, .. }) = (domain.tube_motions(x), domain) else {
        return (0.0, [0.0; 2]);
    };
    let wrapped = turns.map(|theta| theta - TAU * (theta / TAU).round());
    let side = if *counterclockwise { 1.0 } else { -1.0 };
    let area = (shifts[0] * wrapped[1] - shifts[1] * wrapped[0]) * side;
    (1f64.copysign(area) / x[0].hypot(x[1]), turns)
}

/// Chords from vertex 0 to its copies in the next cells.
fn chords(domain: &Domain, x: &[f64]) -> Option<[Vec3; 2]> {
    if matches!(domain, Domain::Patch | Domain::Own(_)) {
        return None;
    }
    let site = |shift| crate::model::Site { vertex: 0, shift };
    let origin = domain.point(x, site([0, 0]));
    Some([[1, 0], [0, 1]].map(|shift| domain.point(x, site(shift)) - origin))
}
