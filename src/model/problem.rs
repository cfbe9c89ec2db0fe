//! The model: terms on a domain, with pins, loads and a gauge, as the problem that the solver minimises.

use super::domain::Domain;
use super::element::{Elements, Spring};
use super::gauge;
use super::part::Part;
use crate::math::Vec3;
use crate::math::rotation::inverse_left_jacobian;
use crate::numerics::dense::small::shortest_solution;
use crate::numerics::sparse::{Cliques, FIXED};
use crate::solver::{Layout, Problem};

use std::ops::Range;
use std::sync::Arc;

mod bodies;
pub(super) mod driving;
mod energy;
mod reference_state;
mod support;
mod turning;

use bodies::{Bodies, POSE};
pub(crate) use support::Support;

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
    /// Generalised coordinates of the reference state, which is the drawn state or the one that replaced it: those of
    /// all points, then the poses of rigid parts. Held coordinates keep these values.
    base: Vec<f64>,
    bodies: Bodies,
    supports: Vec<Support>,
    pinned: Vec<usize>,
    /// Index of the coordinate of each unknown.
    free: Vec<u32>,
    soft: Vec<Box<dyn Elements>>,
    stiff: Vec<Box<dyn Elements>>,
    loads: Vec<f64>,
    /// Factor of all loads: 1 unless a path drives it.
    load_factor: f64,
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
    /// Vertices that move as rigid bodies, on a patch.
    pub parts: Vec<Part>,
    /// Linear functions of the coordinates that keep their values.
    pub supports: Vec<Support>,
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
        let Parts { domain, drawn, soft, stiff, pinned, parts, supports, loads, edges, mean_edge, gauge } = parts;
        let bodies = Bodies::new(&parts, &drawn);
        let mut base = drawn;
        base.resize(base.len() + bodies.coordinates(), 0.0);
        let (free, layout) = (Vec::new(), Layout::new(Vec::new(), Cliques::new(), Cliques::new()));
        let (compliance, gap_scale) = (vec![], vec![]);
        let mut model = Self {
            domain,
            base,
            bodies,
            supports,
            pinned,
            free,
            soft,
            stiff,
            loads,
            load_factor: 1.0,
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
        model.count_measures();
        model.choose_unknowns();
        model
    }

    /// Lists compliance and natural size of all stiff measures: those of the terms, then the supports.
    fn count_measures(&mut self) {
        let springs = self.stiff.iter().flat_map(|term| (0..term.len()).map(|k| (term.is_angle(), term.spring(k))));
        let of_terms = springs.map(|(angle, spring)| (angle, 1.0 / spring.stiffness));
        let measures = of_terms.chain(self.supports.iter().map(|support| (support.is_angle, 0.0)));
        (self.gap_scale, self.compliance) =
            measures.map(|(angle, c)| (if angle { 1.0 } else { self.mean_edge }, c)).unzip();
    }

    /// Chooses the held coordinates at the reference state, and numbers the other ones as unknowns.
    fn choose_unknowns(&mut self) {
        let mut held = self.chosen(&self.rigid_motions(&self.base, self.loads.is_empty()));
        held.truncate(self.base.len());
        let derived = |k: u32| self.is_derived(k as usize);
        self.free = (0..held.len() as u32).filter(|&k| !held[k as usize] && !derived(k)).collect();
        let mut number = vec![FIXED; held.len()];
        self.free.iter().enumerate().for_each(|(unknown, &k)| number[k as usize] = unknown as u32);
        self.turning = self.turning_unknowns(&number);
        self.layout = self.new_layout(&number);
    }

    /// Whether a generalised coordinate follows from the pose of a part.
    fn is_derived(&self, coordinate: usize) -> bool {
        self.bodies.part_of(coordinate / 3).is_some() && coordinate < self.points()
    }

    /// Number of the coordinates of points, the first of the generalised coordinates.
    fn points(&self) -> usize {
        self.base.len() - self.bodies.coordinates()
    }

    /// Returns the rates of the generalised coordinates under the rigid motions, then those of the values that supports
    /// keep. Coordinates that follow from poses have none.
    fn rigid_motions(&self, generalised: &[f64], rotations: bool) -> Vec<gauge::Motion> {
        let points = &generalised[..self.points()];
        let mut motions = gauge::rigid_motions(&self.domain, points, rotations);
        if self.bodies.is_empty() && self.supports.is_empty() {
            return motions;
        }
        let (centre, size) = gauge::centre_and_size(&self.domain, points);
        let turn = if rotations { 1.0 / size } else { 0.0 };
        (0..motions.len()).filter(|&k| self.is_derived(k)).for_each(|k| motions[k].fill(0.0));
        for part in 0..self.bodies.coordinates() / POSE {
            motions.extend(gauge::rows_of(1.0, turn * (self.bodies.pivot(part, generalised) - centre)));
            let by_turn = turn * inverse_left_jacobian(&self.bodies.rotation(part, generalised));
            motions.extend([0, 1, 2].map(|row| {
                let mut motion = gauge::Motion::zeros();
                (0..3).for_each(|k| motion[3 + k] = self.mean_edge * by_turn[(row, k)]);
                motion
            }));
        }
        for support in &self.supports {
            let rates = support.terms.iter().map(|(k, factor)| *factor * motions[*k]);
            motions.push(rates.sum());
        }
        motions
    }

    /// Returns which coordinates are held if these are the rigid motions: the pinned ones, those of poses that are not
    /// free, and those that the gauge adds; then that the values of supports are.
    fn chosen(&self, motions: &[gauge::Motion]) -> Vec<bool> {
        let mut held = vec![false; motions.len()];
        self.pinned.iter().for_each(|&k| held[k] = true);
        let poses = self.points()..self.base.len();
        poses.zip(self.bodies.free()).for_each(|(k, free)| held[k] = !free);
        held[self.base.len()..].fill(true);
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
        let motions = self.rigid_motions(&self.generalised(x), self.loads.is_empty());
        let separation = |held: &[bool]| gauge::separation(&motions, held);
        let mut held = vec![true; motions.len()];
        self.free.iter().for_each(|&k| held[k as usize] = false);
        separation(&held) >= LEAST_SEPARATION_RATIO * separation(&self.chosen(&motions))
    }

    /// Makes `coordinates` the reference state and chooses the held coordinates anew at that state. Returns its
    /// unknowns, which are numbered differently than before.
    pub(crate) fn rebase_gauge(&mut self, coordinates: Vec<f64>) -> Vec<f64> {
        self.base = self.with_poses(coordinates);
        self.choose_unknowns();
        let mut x = self.start();
        self.accept(&mut x);
        x
    }

    /// Returns the unknowns of the reference state.
    pub fn start(&self) -> Vec<f64> {
        self.extracted(&self.base)
    }

    /// Extracts the unknowns from all coordinates. Without rigid parts they may also be rates, of which it extracts
    /// those of the unknowns.
    pub fn unknowns(&self, coordinates: &[f64]) -> Vec<f64> {
        if self.bodies.is_empty() {
            return self.extracted(coordinates);
        }
        self.extracted(&self.with_poses(coordinates.to_vec()))
    }

    /// Extracts the unknowns from the generalised coordinates.
    fn extracted(&self, generalised: &[f64]) -> Vec<f64> {
        self.free.iter().map(|&k| generalised[k as usize] / self.unit(k as usize)).collect()
    }

    /// Completes the coordinates of all points by the poses of parts that are closest to them. Coordinates of poses
    /// that are not free keep their drawn values, zero.
    fn with_poses(&self, mut coordinates: Vec<f64>) -> Vec<f64> {
        if !self.bodies.is_empty() {
            coordinates.resize(self.base.len(), 0.0);
            self.bodies.find_poses(&mut coordinates, &self.base);
            self.bodies.place(&mut coordinates);
        }
        coordinates
    }

    /// Returns the sizes of the shared unknowns at a state. With [`Gauge::Free`] there are none, since spectra and
    /// ranks are those of the coordinates themselves.
    fn units_at(&self, coordinates: &[f64]) -> Vec<f64> {
        if self.gauge == Gauge::Free { vec![] } else { self.domain.units(coordinates, self.mean_edge) }
    }

    /// Returns the size of an unknown in units of its coordinate.
    fn unit(&self, coordinate: usize) -> f64 {
        if let Some(pose) = coordinate.checked_sub(self.points()) {
            return if pose % POSE < 3 { 1.0 } else { 1.0 / self.mean_edge };
        }
        let first = self.points() - self.units.len();
        coordinate.checked_sub(first).map_or(1.0, |shared| self.units[shared])
    }

    /// Returns the rates of all coordinates for given rates of the unknowns; zero where a coordinate is held.
    pub fn velocity(&self, rates: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.base.len()];
        self.free.iter().zip(rates).for_each(|(&k, rate)| all[k as usize] = *rate * self.unit(k as usize));
        self.bodies.set_velocities(&self.base, &mut all);
        all.truncate(self.points());
        all
    }

    /// Subtracts from velocities of all coordinates the rigid motion of the reference state that is closest to them
    /// on the held coordinates. If coordinates are held only against drift, they have zero velocity afterwards.
    pub(crate) fn without_drift(&self, velocity: &[f64]) -> Vec<f64> {
        let motions = gauge::rigid_motions(&self.domain, &self.base[..self.points()], true);
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
        self.base = self.with_poses(coordinates);
        let mut x = self.start();
        self.accept(&mut x);
        x
    }

    /// Returns for every coordinate of a point whether it is held, or follows from the pose of a part.
    pub(crate) fn held(&self) -> Vec<bool> {
        let mut held = vec![true; self.base.len()];
        self.free.iter().for_each(|&k| held[k as usize] = false);
        held.truncate(self.points());
        held
    }

    /// Returns all coordinates of a state, given its unknowns.
    pub fn coordinates(&self, x: &[f64]) -> Vec<f64> {
        let mut all = self.generalised(x);
        all.truncate(self.points());
        all
    }

    /// Returns the generalised coordinates of a state, given its unknowns.
    fn generalised(&self, x: &[f64]) -> Vec<f64> {
        let mut all = self.base.clone();
        self.free.iter().zip(x).for_each(|(&k, value)| all[k as usize] = *value * self.unit(k as usize));
        self.bodies.place(&mut all);
        all
    }

    /// Whether there are loads, supports or rigid parts, or pins other than the coordinates that a screw holds.
    pub(crate) fn held_or_loaded(&self) -> bool {
        let supported = !self.supports.is_empty() || !self.bodies.is_empty();
        supported || !self.loads.is_empty() || (!matches!(self.domain, Domain::Screw) && !self.pinned.is_empty())
    }

    /// Whether the sheet is a patch without pins, supports, rigid parts and loads.
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

    /// Returns the rest values of all elements, soft terms first, and the prescribed values of supports.
    pub(crate) fn rests(&self) -> Vec<f64> {
        let of_terms = self.terms().flat_map(|term| (0..term.len()).map(|k| term.spring(k).rest));
        of_terms.chain(self.supports.iter().map(|support| support.rest)).collect()
    }

    /// Returns the values of the measures of all elements at the unknowns `x`, soft terms first, and of supports.
    pub fn values(&self, x: &[f64]) -> Vec<f64> {
        let generalised = self.generalised(x);
        let all = &generalised[..self.points()];
        let of_terms = self.terms().flat_map(|term| (0..term.len()).map(|k| term.value(k, &self.domain, all)));
        of_terms.chain(self.supports.iter().map(|support| support.value(&generalised))).collect()
    }

    /// Sets the rest values to `origin + part (target - origin)`, and exactly to `target` if `part` is 1. Both lists
    /// have one value for each element, soft terms first, and one for each support.
    pub(crate) fn set_rests(&mut self, origin: &[f64], target: &[f64], part: f64) {
        let between = |k: usize| if part == 1.0 { target[k] } else { origin[k] + part * (target[k] - origin[k]) };
        let mut at = 0;
        for term in self.soft.iter_mut().chain(&mut self.stiff) {
            for k in 0..term.len() {
                term.set_spring(k, Spring { rest: between(at), ..term.spring(k) });
                at += 1;
            }
        }
        self.supports.iter_mut().zip(at..).for_each(|(support, k)| support.rest = between(k));
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

    /// Returns the unknowns on which element `k` of a term depends: for each of its points those of its coordinates, or
    /// of the pose of its part; then the shared ones.
    fn members(&self, term: &dyn Elements, k: usize, number: &[u32]) -> Vec<u32> {
        let (points, shared) = (self.points(), self.domain.shared());
        let of_point = |vertex: usize| match self.bodies.part_of(vertex) {
            Some(part) => points + POSE * part..points + POSE * (part + 1),
            None => 3 * vertex..3 * vertex + 3,
        };
        let of_points = term.sites(k).iter().flat_map(|site| of_point(site.vertex));
        of_points.chain(points - shared..points).map(|coordinate| number[coordinate]).collect()
    }

    /// Returns the layout of the unknowns; `number` is that of each generalised coordinate. Soft elements are those of
    /// the soft terms, then the loads of each loaded part; stiff ones those of the stiff terms, then the supports.
    fn new_layout(&self, number: &[u32]) -> Arc<Layout> {
        let collect = |terms: &[Box<dyn Elements>]| {
            let mut cliques = Cliques::new();
            for term in terms {
                for k in 0..term.len() {
                    let members = self.members(term.as_ref(), k, number);
                    let splits = term.is_hinge() && !self.bodies.touch(term.sites(k));
                    if splits { cliques.push_split(members, LEFT_WING, RIGHT_WING) } else { cliques.push(members) }
                }
            }
            cliques
        };
        let (mut soft, mut stiff) = (collect(&self.soft), collect(&self.stiff));
        let points = self.points();
        for (part, _) in self.loaded_parts() {
            soft.push((0..POSE).map(|k| number[points + POSE * part + k]));
        }
        self.supports.iter().for_each(|support| stiff.push(support.terms.iter().map(|(k, _)| number[*k])));
        let vertices = (points - self.domain.shared()) / 3;
        let block = |k: usize| match k.checked_sub(points) {
            Some(pose) => (vertices + 1 + pose / POSE) as u32,
            None => (k / 3).min(vertices) as u32,
        };
        let mut blocks: Vec<u32> = self.free.iter().map(|&k| block(k as usize)).collect();
        let mut used = blocks.clone();
        used.dedup();
        blocks.iter_mut().for_each(|b| *b = used.binary_search(b).unwrap_or(0) as u32);
        Layout::new(blocks, soft, stiff)
    }

    /// Returns the parts that carry loads, with their loads.
    fn loaded_parts(&self) -> Vec<(usize, Vec<(usize, Vec3)>)> {
        if self.loads.is_empty() { vec![] } else { self.bodies.loaded(&self.loads) }
    }
}
