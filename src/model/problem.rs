//! The model: terms on a domain, with pins, loads and a gauge, as the problem that the solver minimises.

use super::domain::Domain;
use super::element::{Element, Elements};
use super::gauge;
use super::law::{Memory, Spring};
use crate::math::Vec3;
use crate::numerics::dense::small::shortest_solution;
use crate::numerics::sparse::Cliques;
use crate::solver::{Layout, Problem};

use std::ops::Range;
use std::sync::Arc;

mod bodies;
pub(super) mod driving;
mod energy;
mod hinges;
mod kept;
mod memory;
mod pinned;
mod short_steps;
mod softened;
mod support;
mod turning;
mod unknowns;

pub(super) use bodies::Bodies;
use bodies::POSE;
pub(crate) use support::Support;

/// Curvature times the mean edge below which a change of the direction of a screw's axis counts as at this curvature, in
/// eigenvalues: at a straight state it moves nothing.
const NEARLY_STRAIGHT: f64 = 0.01;
/// Ranges of the coordinates of a hinge's two wings among the coordinates of its element.
pub(super) const LEFT_WING: Range<u32> = 6..9;
pub(super) const RIGHT_WING: Range<u32> = 9..12;

/// Singular value of the matrix of rigid motions on the held coordinates, relative to the largest one, below which
/// rigid motions count as dependent.
const DEPENDENT: f64 = 1e-9;

/// The equations of a sheet, which no run of a solver changes: measures on a domain, and rigid parts.
#[derive(Clone)]
pub(super) struct Equations {
    /// The map from coordinates to points.
    pub domain: Domain,
    /// Coordinates of the drawn state, whose lengths turn a stiffness per length into that of an element.
    pub drawn: Vec<f64>,
    /// Vertices that move as rigid bodies.
    pub bodies: Bodies,
    /// Terms that enter with their energy.
    pub soft: Vec<Arc<dyn Elements>>,
    /// Terms that enter with a tension as an unknown for each element.
    pub stiff: Vec<Arc<dyn Elements>>,
    /// Number of edges of the tiling; the edge numbers of elements are below it.
    pub edges: usize,
    /// Unit of length to which the gaps of bars are relative: the mean edge length.
    pub mean_edge: f64,
    /// The treatment of rigid motions.
    pub gauge: Gauge,
}

/// The mechanical model of a sheet: its terms on a domain, with springs, held coordinates and loads. Clones share what
/// never changes.
#[derive(Clone)]
pub struct Model {
    equations: Arc<Equations>,
    /// The springs of all elements, soft ones first.
    springs: Vec<Spring>,
    /// Angles of all elements in the last accepted state, from which angles continue; not numbers for lengths.
    last: Vec<f64>,
    /// Memories of all elements; empty where no law has one.
    memory: Vec<Memory>,
    /// Generalised coordinates of the reference state, which is the drawn state or the one that replaced it: those of
    /// all points, then the poses of rigid parts. Held coordinates keep these values.
    base: Vec<f64>,
    /// Linear functions of the coordinates that keep their values.
    supports: Vec<Support>,
    pinned: Vec<usize>,
    /// Index of the coordinate of each unknown.
    free: Vec<u32>,
    loads: Vec<f64>,
    /// Factor of all loads: 1 unless a path drives it.
    load_factor: f64,
    /// Unknowns that would have to be held to prevent rotations of the sheet under loads.
    turning: Vec<u32>,
    layout: Arc<Layout>,
    compliance: Vec<f64>,
    gap_scale: Vec<f64>,
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

impl Model {
    /// Makes a model with the springs of all elements, soft ones first, in the drawn state. `pinned` are the
    /// coordinates held by pins and by the boundary conditions, `loads` the force on each coordinate, empty without
    /// loads.
    pub(super) fn new(
        equations: Equations,
        springs: Vec<Spring>,
        pinned: Vec<usize>,
        supports: Vec<Support>,
        loads: Vec<f64>,
    ) -> Self {
        let mut base = equations.drawn.clone();
        base.resize(base.len() + equations.bodies.coordinates(), 0.0);
        let mut model = Self {
            equations: Arc::new(equations),
            last: vec![f64::NAN; springs.len()],
            memory: vec![],
            springs,
            base,
            supports,
            pinned,
            free: vec![],
            loads,
            load_factor: 1.0,
            turning: vec![],
            layout: Layout::new(Vec::new(), Cliques::new(), Cliques::new()),
            compliance: vec![],
            gap_scale: vec![],
            units: vec![],
        };
        let equations = model.equations.clone();
        model.accept_angles(&equations.drawn);
        if model.soft().any(|element| element.remembers()) {
            model.memory = vec![Memory::default(); model.springs.len()];
        }
        model.units = model.units_at(&model.base);
        model.count_measures();
        model.choose_unknowns();
        model
    }

    /// Lists compliance and natural size of all stiff measures: those of the terms, then the supports.
    fn count_measures(&mut self) {
        let of_terms = self.stiff().map(|element| (element.is_angle(), 1.0 / element.spring.stiffness));
        let measures = of_terms.chain(self.supports.iter().map(|support| (support.is_angle, 0.0))).collect::<Vec<_>>();
        (self.gap_scale, self.compliance) =
            measures.into_iter().map(|(angle, c)| (if angle { 1.0 } else { self.equations.mean_edge }, c)).unzip();
    }

    /// Number of the coordinates of points, the first of the generalised coordinates.
    fn points(&self) -> usize {
        self.base.len() - self.equations.bodies.coordinates()
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
        self.extracted(&self.with_poses(coordinates.to_vec()))
    }

    /// Extracts the unknowns from the generalised coordinates.
    fn extracted(&self, generalised: &[f64]) -> Vec<f64> {
        self.free.iter().map(|&k| generalised[k as usize] / self.unit(k as usize)).collect()
    }

    /// Completes the coordinates of all points by the poses of parts that are closest to them. Coordinates of poses
    /// that are not free keep their drawn values, zero.
    fn with_poses(&self, mut coordinates: Vec<f64>) -> Vec<f64> {
        if !self.equations.bodies.is_empty() {
            coordinates.resize(self.base.len(), 0.0);
            self.equations.bodies.find_poses(&mut coordinates, &self.base);
            self.equations.bodies.place(&mut coordinates);
        }
        coordinates
    }

    /// Returns the sizes of the shared unknowns at a state. With [`Gauge::Free`] there are none, since spectra and
    /// ranks are those of the coordinates themselves.
    fn units_at(&self, coordinates: &[f64]) -> Vec<f64> {
        if self.equations.gauge == Gauge::Free {
            vec![]
        } else {
            self.equations.domain.units(coordinates, self.equations.mean_edge)
        }
    }

    /// Returns the size of an unknown in units of its coordinate.
    fn unit(&self, coordinate: usize) -> f64 {
        if let Some(pose) = coordinate.checked_sub(self.points()) {
            return if pose % POSE < 3 { 1.0 } else { 1.0 / self.equations.mean_edge };
        }
        let first = self.points() - self.units.len();
        coordinate.checked_sub(first).map_or(1.0, |shared| self.units[shared])
    }

    /// Returns for each unknown of a free gauge how much its coordinate changes where it moves points by a length of 1,
    /// about, at the reference state: 1 but for shared coordinates that are no lengths. The direction of the axis of a
    /// screw counts as at a curvature of `NEARLY_STRAIGHT` at least.
    pub fn units_of_length(&self) -> Vec<f64> {
        let Equations { domain, mean_edge, .. } = &*self.equations;
        let units = domain.units_above(&self.base[..self.points()], *mean_edge, NEARLY_STRAIGHT);
        let first = self.points() - units.len();
        let unit = |k: &u32| (*k as usize).checked_sub(first).and_then(|shared| units.get(shared)).unwrap_or(&1.0);
        self.free.iter().map(unit).copied().collect()
    }

    /// Returns the unknowns of the pose of every rigid part.
    pub(crate) fn poses(&self) -> Vec<Vec<usize>> {
        let mut poses = vec![vec![]; self.equations.bodies.coordinates() / POSE];
        for (unknown, &coordinate) in self.free.iter().enumerate() {
            if let Some(pose) = (coordinate as usize).checked_sub(self.points()) {
                poses[pose / POSE].push(unknown);
            }
        }
        poses
    }

    /// Returns the rates of all coordinates for given rates of the unknowns; zero where a coordinate is held.
    pub fn velocity(&self, rates: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.base.len()];
        self.free.iter().zip(rates).for_each(|(&k, rate)| all[k as usize] = *rate * self.unit(k as usize));
        self.equations.bodies.set_velocities(&self.base, &mut all);
        all.truncate(self.points());
        all
    }

    /// Subtracts from velocities of all coordinates the rigid motion of the reference state that is closest to them
    /// on the held coordinates. If coordinates are held only against drift, they have zero velocity afterwards.
    pub(crate) fn without_drift(&self, velocity: &[f64]) -> Vec<f64> {
        let motions = gauge::rigid_motions(&self.equations.domain, &self.base[..self.points()], true);
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
        if !matches!(self.equations.domain, Domain::Screw) {
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
        self.equations.bodies.place(&mut all);
        all
    }

    /// Whether there are loads, supports or rigid parts, or pins other than the coordinates that a screw holds.
    pub(crate) fn held_or_loaded(&self) -> bool {
        let supported = !self.supports.is_empty() || !self.equations.bodies.is_empty();
        supported
            || !self.loads.is_empty()
            || (!matches!(self.equations.domain, Domain::Screw) && !self.pinned.is_empty())
    }

    /// Returns the map from coordinates to points.
    pub fn domain(&self) -> &Domain {
        &self.equations.domain
    }

    /// Returns the number of edges of the tiling; not every edge needs to have an element.
    pub(crate) fn edges(&self) -> usize {
        self.equations.edges
    }

    /// Returns all elements, soft ones first.
    pub fn elements(&self) -> impl Iterator<Item = Element<'_>> {
        self.soft().chain(self.stiff())
    }

    /// Returns the elements that enter with their energy.
    pub fn soft(&self) -> impl Iterator<Item = Element<'_>> {
        self.elements_of(&self.equations.soft, 0)
    }

    /// Returns the elements that enter with tensions.
    pub fn stiff(&self) -> impl Iterator<Item = Element<'_>> {
        self.elements_of(&self.equations.stiff, self.soft_elements())
    }

    fn elements_of<'a>(
        &'a self,
        terms: &'a [Arc<dyn Elements>],
        first: usize,
    ) -> impl Iterator<Item = Element<'a>> + 'a {
        let of_terms = terms.iter().flat_map(|term| (0..term.len()).map(move |index| (term.as_ref(), index)));
        of_terms.zip(first..).map(|((term, index), number)| self.element(term, index, number))
    }

    fn element<'a>(&'a self, term: &'a dyn Elements, index: usize, number: usize) -> Element<'a> {
        let (spring, last) = (self.springs[number], self.last[number]);
        let memory = self.memory.get(number).copied().unwrap_or_default();
        Element { number, spring, last, memory, domain: &self.equations.domain, term, index }
    }

    /// Number of elements that enter with their energy.
    pub fn soft_elements(&self) -> usize {
        self.equations.soft.iter().map(|term| term.len()).sum()
    }

    /// Returns the rest values of all elements, soft ones first, and the prescribed values of supports.
    pub(crate) fn rests(&self) -> Vec<f64> {
        let of_springs = self.springs.iter().map(|spring| spring.rest);
        of_springs.chain(self.supports.iter().map(|support| support.rest)).collect()
    }

    /// Returns the values of the measures of all elements at the unknowns `x`, soft ones first, and of supports.
    pub fn values(&self, x: &[f64]) -> Vec<f64> {
        let generalised = self.generalised(x);
        let of_elements = self.elements().map(|element| element.value(&generalised[..self.points()]));
        of_elements.chain(self.supports.iter().map(|support| support.value(&generalised))).collect()
    }

    /// Sets the rest values to `origin + part (target - origin)`, and exactly to `target` if `part` is 1. Both lists
    /// have one value for each element, soft ones first, and one for each support.
    pub(crate) fn set_rests(&mut self, origin: &[f64], target: &[f64], part: f64) {
        let between = |k: usize| if part == 1.0 { target[k] } else { origin[k] + part * (target[k] - origin[k]) };
        self.springs.iter_mut().zip(0..).for_each(|(spring, k)| spring.rest = between(k));
        self.supports.iter_mut().zip(self.springs.len()..).for_each(|(support, k)| support.rest = between(k));
    }

    /// Returns the angles of the last accepted state, from which angles continue: those of hinges, soft ones first.
    pub fn angles(&self) -> Vec<f64> {
        self.elements().filter(Element::is_angle).map(|element| element.last).collect()
    }

    /// Sets the angles from which angles continue, in the order of [`Model::angles`].
    pub(super) fn set_angles(&mut self, angles: &[f64]) {
        let numbers: Vec<usize> = self.elements().filter(Element::is_angle).map(|element| element.number).collect();
        numbers.into_iter().zip(angles).for_each(|(number, angle)| self.last[number] = *angle);
    }

    /// Returns the angles of the hinges, in the order of [`Model::angles`], among those of all edges.
    pub(crate) fn angles_among(&self, fold_angles: &[f64]) -> Vec<f64> {
        let hinges = self.elements().filter(Element::is_angle);
        hinges.map(|hinge| hinge.edge().map_or(hinge.last, |edge| fold_angles[edge])).collect()
    }

    /// Makes the angles continue from these fold angles of the edges; not a number: where there is no hinge.
    pub(crate) fn continue_from(&mut self, fold_angles: &[f64]) {
        self.set_angles(&self.angles_among(fold_angles));
    }

    /// Returns the parts that carry loads, with their loads.
    fn loaded_parts(&self) -> Vec<(usize, Vec<(usize, Vec3)>)> {
        if self.loads.is_empty() { vec![] } else { self.equations.bodies.loaded(&self.loads) }
    }
}
