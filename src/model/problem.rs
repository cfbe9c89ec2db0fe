//! The model: terms on a domain, with pins, loads and a gauge, as the problem that the solver minimises.

use super::domain::Domain;
use super::element::{Elements, Spring};
use super::gauge;
use crate::numerics::dense::small::shortest_solution;
use crate::numerics::sparse::{Cliques, FIXED};
use crate::solver::{Layout, Problem};

use std::ops::Range;
use std::sync::Arc;

mod energy;
mod reference_state;
mod turning;

/// Ranges of the coordinates of a hinge's two wings among the coordinates of its element.
pub(super) const LEFT_WING: Range<u32> = 6..9;
pub(super) const RIGHT_WING: Range<u32> = 9..12;

/// Singular value of the matrix of rigid motions on the held coordinates, relative to the largest one, below which
/// rigid motions count as dependent.
const DEPENDENT: f64 = 1e-9;
/// Least separation of the rigid motions by the held coordinates, relative to that of newly chosen ones; below it the
/// held coordinates may constrain the shape too.
const LEAST_SEPARATION_RATIO: f64 = 1e-3;

/// The mechanical model of a sheet: its terms on a domain, with held coordinates and loads.
pub struct Model {
    domain: Domain,
    /// Coordinates of the reference state: the drawn state, or the one that replaced it. Held coordinates keep these
    /// values.
    base: Vec<f64>,
    pinned: Vec<usize>,
    /// Index of the coordinate of each unknown.
    free: Vec<u32>,
    soft: Vec<Box<dyn Elements>>,
    stiff: Vec<Box<dyn Elements>>,
    loads: Vec<f64>,
    /// Unknowns that would have to be held to prevent rotations of the sheet under loads.
    turning: Vec<u32>,
    layout: Arc<Layout>,
    compliance: Vec<f64>,
    gap_scale: Vec<f64>,
    edges: usize,
    mean_edge: f64,
    gauge: Gauge,
    /// Sizes of the shared unknowns in units of their coordinates; empty if unknowns and coordinates are the same.
    units: Vec<f64>,
}

/// The treatment of the rigid motions that no pin prevents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gauge {
    /// For minimisation: one coordinate is held for each rigid motion. Under loads rotations stay free; translations
    /// are held, since loads must balance along them.
    Held,
    /// For spectra and ranks: no coordinate is held in addition to pins.
    Free,
}

/// The parts of a model, the argument of [`Model::new`].
pub(crate) struct Parts {
    /// The map from coordinates to points.
    pub domain: Domain,
    /// Coordinates of the drawn state.
    pub drawn: Vec<f64>,
    /// Terms that enter with their energy.
    pub soft: Vec<Box<dyn Elements>>,
    /// Terms that enter with a tension as an unknown for each element.
    pub stiff: Vec<Box<dyn Elements>>,
    /// Indices of the coordinates held by pins and by the boundary conditions.
    pub pinned: Vec<usize>,
    /// Force on each coordinate; empty without loads.
    pub loads: Vec<f64>,
    /// Number of edges of the tiling; the edge numbers of elements are below it.
    pub edges: usize,
    /// Unit of length to which the gaps of bars are relative: the mean edge length.
    pub mean_edge: f64,
    /// The treatment of rigid motions.
    pub gauge: Gauge,
}

impl Model {
    /// Makes a model of its parts.
    pub(crate) fn new(parts: Parts) -> Self {
        let Parts { domain, drawn, soft, stiff, pinned, loads, edges, mean_edge, gauge } = parts;
        let springs = || stiff.iter().flat_map(|term| (0..term.len()).map(move |k| (term.is_angle(), term.spring(k))));
        let compliance = springs().map(|(_, spring)| 1.0 / spring.stiffness).collect();
        let gap_scale = springs().map(|(angle, _)| if angle { 1.0 } else { mean_edge }).collect();
        let (free, layout) = (Vec::new(), Layout::new(Vec::new(), Cliques::new(), Cliques::new()));
        let mut model = Self {
            domain,
            base: drawn,
            pinned,
            free,
            soft,
            stiff,
            loads,
            turning: vec![],
            layout,
            compliance,
            gap_scale,
            edges,
            mean_edge,
            gauge,
            units: vec![],
        };
        model.units = model.units_at(&model.base);
        model.choose_unknowns();
        model
    }

    /// Chooses the held coordinates at the reference state, and numbers the other ones as unknowns.
    fn choose_unknowns(&mut self) {
        let held = self.chosen(&gauge::rigid_motions(&self.domain, &self.base, self.loads.is_empty()));
        self.free = (0..held.len() as u32).filter(|&k| !held[k as usize]).collect();
        let mut number = vec![FIXED; held.len()];
        self.free.iter().enumerate().for_each(|(unknown, &k)| number[k as usize] = unknown as u32);
        self.turning = self.turning_unknowns(&number);
        self.layout = layout(&self.domain, &self.base, &self.free, &number, &self.soft, &self.stiff);
    }

    /// Returns which coordinates are held if these are the rigid motions: the pinned ones, and those that the gauge
    /// adds.
    fn chosen(&self, motions: &[gauge::Motion]) -> Vec<bool> {
        let mut held = vec![false; motions.len()];
        self.pinned.iter().for_each(|&k| held[k] = true);
        if self.gauge == Gauge::Held {
            gauge::choose(motions, &held).into_iter().for_each(|k| held[k] = true);
        }
        held
    }

    /// Whether the held coordinates remove the rigid motions of the state `x` nearly as well as newly chosen ones
    /// would. If they do not, they may constrain the shape, and a state that seems to be an equilibrium need not be
    /// one.
    pub(crate) fn gauge_is_valid(&self, x: &[f64]) -> bool {
        if self.gauge == Gauge::Free {
            return true;
        }
        let motions = gauge::rigid_motions(&self.domain, &self.coordinates(x), self.loads.is_empty());
        let separation = |held: &[bool]| gauge::separation(&motions, held);
        separation(&self.held()) >= LEAST_SEPARATION_RATIO * separation(&self.chosen(&motions))
    }

    /// Makes `coordinates` the reference state and chooses the held coordinates anew at that state. Returns its
    /// unknowns, which are numbered differently than before.
    pub(crate) fn rebase_gauge(&mut self, coordinates: Vec<f64>) -> Vec<f64> {
        self.base = coordinates;
        self.choose_unknowns();
        let mut x = self.start();
        self.accept(&mut x);
        x
    }

    /// Returns the unknowns of the reference state.
    pub fn start(&self) -> Vec<f64> {
        self.unknowns(&self.base)
    }

    /// Extracts the unknowns from all coordinates, or their rates from the rates of all coordinates.
    pub fn unknowns(&self, coordinates: &[f64]) -> Vec<f64> {
        self.free.iter().map(|&k| coordinates[k as usize] / self.unit(k as usize)).collect()
    }

    /// Returns the sizes of the shared unknowns at a state. With [`Gauge::Free`] there are none, since spectra and
    /// ranks are those of the coordinates themselves.
    fn units_at(&self, coordinates: &[f64]) -> Vec<f64> {
        if self.gauge == Gauge::Free { vec![] } else { self.domain.units(coordinates, self.mean_edge) }
    }

    /// Returns the size of an unknown in units of its coordinate.
    fn unit(&self, coordinate: usize) -> f64 {
        let first = self.base.len() - self.units.len();
        coordinate.checked_sub(first).map_or(1.0, |shared| self.units[shared])
    }

    /// Returns the rates of all coordinates for given rates of the unknowns; zero where a coordinate is held.
    pub fn velocity(&self, rates: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.base.len()];
        self.free.iter().zip(rates).for_each(|(&k, rate)| all[k as usize] = *rate * self.unit(k as usize));
        all
    }

    /// Subtracts from velocities of all coordinates the rigid motion of the reference state that is closest to them
    /// on the held coordinates. If coordinates are held only against drift, they have zero velocity afterwards.
    pub(crate) fn without_drift(&self, velocity: &[f64]) -> Vec<f64> {
        let motions = gauge::rigid_motions(&self.domain, &self.base, true);
        let held: Vec<usize> = (0..velocity.len()).zip(self.held()).filter(|(_, held)| *held).map(|(k, _)| k).collect();
        let rows = nalgebra::DMatrix::from_fn(held.len(), 6, |row, motion| motions[held[row]][motion]);
        let right = nalgebra::DVector::from_fn(held.len(), |row, _| velocity[held[row]]);
        let drift = shortest_solution(rows, &right, DEPENDENT).unwrap_or_else(|| nalgebra::DVector::zeros(6));
        let moved = motions.iter().map(|motion| motion.iter().zip(drift.iter()).map(|(m, d)| m * d).sum::<f64>());
        velocity.iter().zip(moved).map(|(v, drift)| v - drift).collect()
    }

    /// Makes `coordinates` the reference state without choosing the held coordinates anew. Coordinates held by the
    /// gauge take their values from `coordinates` (also the height of a screw's vertex 0, which moves with the axis),
    /// pinned ones keep those of the drawn state, and angles continue from the last accepted state. Returns the
    /// unknowns.
    pub fn start_from(&mut self, mut coordinates: Vec<f64>) -> Vec<f64> {
        if !matches!(self.domain, Domain::Screw) {
            self.pinned.iter().for_each(|&k| coordinates[k] = self.base[k]);
        }
        self.base = coordinates;
        let mut x = self.start();
        self.accept(&mut x);
        x
    }

    /// Returns for every coordinate whether it is held.
    pub(crate) fn held(&self) -> Vec<bool> {
        let mut held = vec![true; self.base.len()];
        self.free.iter().for_each(|&k| held[k as usize] = false);
        held
    }

    /// Returns all coordinates of a state, given its unknowns.
    pub fn coordinates(&self, x: &[f64]) -> Vec<f64> {
        let mut all = self.base.clone();
        self.free.iter().zip(x).for_each(|(&k, value)| all[k as usize] = *value * self.unit(k as usize));
        all
    }

    /// Whether there are loads, or pins other than the coordinates that a screw holds.
    pub(crate) fn held_or_loaded(&self) -> bool {
        !self.loads.is_empty() || (!matches!(self.domain, Domain::Screw) && !self.pinned.is_empty())
    }

    /// Whether the sheet is a patch without pins and loads.
    pub(crate) fn is_free_patch(&self) -> bool {
        matches!(self.domain, Domain::Patch) && !self.held_or_loaded()
    }

    /// Returns the map from coordinates to points.
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// Returns the number of edges of the tiling; not every edge needs to have an element.
    pub(crate) fn edges(&self) -> usize {
        self.edges
    }

    /// Returns the terms that enter with their energy.
    pub fn soft(&self) -> &[Box<dyn Elements>] {
        &self.soft
    }

    /// Returns the terms that enter with tensions.
    pub fn stiff(&self) -> &[Box<dyn Elements>] {
        &self.stiff
    }

    /// Returns the rest values of all elements, soft terms first.
    pub(crate) fn rests(&self) -> Vec<f64> {
        self.terms().flat_map(|term| (0..term.len()).map(|k| term.spring(k).rest)).collect()
    }

    /// Returns the values of the measures of all elements at the unknowns `x`, soft terms first.
    pub fn values(&self, x: &[f64]) -> Vec<f64> {
        let all = self.coordinates(x);
        self.terms().flat_map(|term| (0..term.len()).map(|k| term.value(k, &self.domain, &all))).collect()
    }

    /// Sets the rest values to `origin + part (target - origin)`, and exactly to `target` if `part` is 1. Both lists
    /// have one value for each element, soft terms first.
    pub(crate) fn set_rests(&mut self, origin: &[f64], target: &[f64], part: f64) {
        let mut at = 0;
        for term in self.soft.iter_mut().chain(&mut self.stiff) {
            for k in 0..term.len() {
                let rest = if part == 1.0 { target[at] } else { origin[at] + part * (target[at] - origin[at]) };
                term.set_spring(k, Spring { rest, ..term.spring(k) });
                at += 1;
            }
        }
    }

    /// Multiplies the stiffness of each element of the soft terms by its factor.
    pub fn scale_soft(&mut self, factors: &[f64]) {
        let mut factors = factors.iter();
        for term in &mut self.soft {
            for (k, factor) in (0..term.len()).zip(factors.by_ref()) {
                let spring = term.spring(k);
                term.set_spring(k, Spring { stiffness: factor * spring.stiffness, ..spring });
            }
        }
    }

    /// Returns the angles of the last accepted state, from which angles continue.
    pub(crate) fn angles(&self) -> Vec<f64> {
        self.terms().flat_map(|term| term.angles().iter().copied()).collect()
    }

    /// Sets the angles from which angles continue, in the order of [`Model::angles`].
    pub fn set_angles(&mut self, angles: &[f64]) {
        let mut at = 0;
        for term in self.soft.iter_mut().chain(&mut self.stiff) {
            let count = term.angles().len();
            term.set_angles(&angles[at..at + count]);
            at += count;
        }
    }

    fn terms(&self) -> impl Iterator<Item = &dyn Elements> {
        self.soft.iter().chain(&self.stiff).map(AsRef::as_ref)
    }
}

/// Returns the unknowns on which element `k` depends: those of the coordinates of its points, then the shared ones.
fn members(term: &dyn Elements, k: usize, domain: &Domain, number: &[u32]) -> Vec<u32> {
    let points = term.sites(k).iter().flat_map(|site| 3 * site.vertex..3 * site.vertex + 3);
    let shared = number.len() - domain.shared()..number.len();
    points.chain(shared).map(|coordinate| number[coordinate]).collect()
}

fn layout(
    domain: &Domain,
    drawn: &[f64],
    free: &[u32],
    number: &[u32],
    soft: &[Box<dyn Elements>],
    stiff: &[Box<dyn Elements>],
) -> Arc<Layout> {
    let collect = |terms: &[Box<dyn Elements>]| {
        let mut cliques = Cliques::new();
        for term in terms {
            for k in 0..term.len() {
                let members = members(term.as_ref(), k, domain, number);
                if term.is_hinge() { cliques.push_split(members, LEFT_WING, RIGHT_WING) } else { cliques.push(members) }
            }
        }
        cliques
    };
    let vertices = (drawn.len() - domain.shared()) / 3;
    let mut blocks: Vec<u32> = free.iter().map(|&k| (k / 3).min(vertices as u32)).collect();
    let mut used = blocks.clone();
    used.dedup();
    blocks.iter_mut().for_each(|b| *b = used.binary_search(b).unwrap_or(0) as u32);
    Layout::new(blocks, collect(soft), collect(stiff))
}
