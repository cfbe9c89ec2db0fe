//! The choice of the unknowns of a model: which generalised coordinates are held, and which elements couple the others.

use super::{LEFT_WING, Model, POSE, RIGHT_WING};
use crate::math::pieces::pieces;
use crate::math::rotation::inverse_left_jacobian;
use crate::model::configuration::Configuration;
use crate::model::domain::Domain;
use crate::model::element::Element;
use crate::model::gauge;
use crate::model::problem::Gauge;
use crate::numerics::dense::small::shortest_solution;
use crate::numerics::sparse::{Cliques, FIXED};
use crate::solver::{Layout, Start};
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// Least separation of the rigid motions by the held coordinates, relative to that of newly chosen ones, for a state from
/// which steps are made.
const WELL_HELD: f64 = 0.5;
/// The same for a state from which a path or a relaxation goes on; states of a path are compared with each other where
/// the same is held. A longest step takes up to 0.2 of it: from less a step may pass the state at which it vanishes,
/// beyond which the same shapes follow once more, and the path would seem to turn back.
const STILL_HELD: f64 = 0.3;
/// Largest change of a unit with which a path goes on. Turning the axis moves points in proportion to the curvature: in
/// the unit of a straight sheet, the stiffness of a curved one against it is so large that all others drown in its
/// rounding errors.
const MOST_CHANGED_UNIT: f64 = 4.0;
/// Distance of the vertices of a part from their centroid, relative to the mean edge, up to which they are in one place:
/// what holds the rotation of such a part does not hold the sheet.
const POINT: f64 = 1e-6;
/// Singular value of the rigid motions of the held coordinates, relative to motions of unit length, below which a
/// motion is not held.
const NOT_HELD: f64 = 1e-9;

impl Model {
    /// Chooses the held coordinates at the reference state, and numbers the other ones as unknowns.
    pub(super) fn choose_unknowns(&mut self) {
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
    pub(super) fn is_derived(&self, coordinate: usize) -> bool {
        self.equations.bodies.part_of(coordinate / 3).is_some() && coordinate < self.points()
    }

    /// Returns the rates of the generalised coordinates under the rigid motions, then those of the values that supports
    /// keep. Coordinates that follow from poses have none.
    pub(super) fn rigid_motions(&self, generalised: &[f64], rotations: bool) -> Vec<gauge::Motion> {
        let points = &generalised[..self.points()];
        let mut motions = gauge::rigid_motions(&self.equations.domain, points, rotations);
        if self.equations.bodies.is_empty() && self.supports.is_empty() {
            return motions;
        }
        let (centre, size) = gauge::centre_and_size(&self.equations.domain, points);
        let turn = if rotations { 1.0 / size } else { 0.0 };
        (0..motions.len()).filter(|&k| self.is_derived(k)).for_each(|k| motions[k].fill(0.0));
        for part in 0..self.equations.bodies.coordinates() / POSE {
            motions.extend(gauge::rows_of(1.0, turn * (self.equations.bodies.pivot(part, generalised) - centre)));
            let is_point = self.equations.bodies.is_point(part, POINT * self.equations.mean_edge);
            let turn = if is_point { 0.0 } else { turn };
            let by_turn = turn * inverse_left_jacobian(&self.equations.bodies.rotation(part, generalised));
            motions.extend([0, 1, 2].map(|row| {
                let mut motion = gauge::Motion::zeros();
                (0..3).for_each(|k| motion[3 + k] = self.equations.mean_edge * by_turn[(row, k)]);
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
    pub(super) fn chosen(&self, motions: &[gauge::Motion]) -> Vec<bool> {
        let mut held = self.held_by_conditions(motions.len());
        if self.equations.gauge == Gauge::Held {
            self.chosen_by_pieces(motions, &held).into_iter().for_each(|k| held[k] = true);
        }
        held
    }

    /// Returns the coordinates to hold, in addition to those already `held`, so that no piece of the sheet has a rigid
    /// motion.
    pub(super) fn chosen_by_pieces(&self, motions: &[gauge::Motion], held: &[bool]) -> Vec<usize> {
        let of_piece = |(number, piece): (usize, &Vec<usize>)| {
            let (motions, held) = self.motions_of_piece((number, piece), motions, held);
            gauge::choose(&motions, &held).into_iter().map(|k| piece[k]).collect::<Vec<_>>()
        };
        self.pieces().iter().enumerate().flat_map(of_piece).collect()
    }

    /// The rigid motions of the coordinates of a piece, and which of them are held. Further cylinders about the axis of
    /// a screw move along it and about it, which are displacements in the plane of the chart, but not away from it.
    fn motions_of_piece(
        &self,
        (number, piece): (usize, &[usize]),
        motions: &[gauge::Motion],
        held: &[bool],
    ) -> (Vec<gauge::Motion>, Vec<bool>) {
        let is_further =
            number > 0 && self.equations.gauge == Gauge::Held && matches!(self.equations.domain, Domain::Screw);
        let of = |k: &usize| {
            let mut motion = motions[*k];
            motion[2] *= f64::from(u8::from(!is_further));
            (motion, held[*k])
        };
        piece.iter().map(of).unzip()
    }

    /// Returns the vertices of each connected piece of the sheet, ascending.
    pub(crate) fn vertices_of_pieces(&self) -> Vec<Vec<usize>> {
        let points = self.points() - self.equations.domain.shared();
        let of = |piece: Vec<usize>| piece.into_iter().filter(|k| *k < points && k % 3 == 0).map(|k| k / 3).collect();
        self.pieces().into_iter().map(of).collect()
    }

    /// Returns the generalised coordinates of each connected piece of the sheet, with the supports that act on them,
    /// which come after all coordinates. Elements, rigid parts and supports connect points. Points without elements
    /// count as one piece, and the coordinates that all points share are those of the first.
    fn pieces(&self) -> Vec<Vec<usize>> {
        let (points, count) = (self.points(), self.base.len() + self.supports.len());
        if self.elements().next().is_none() {
            return vec![(0..count).collect()];
        }
        let shared = points - self.equations.domain.shared();
        let of_points = (0..shared / 3).flat_map(|vertex| [1, 2].map(|axis| [3 * vertex, 3 * vertex + axis]));
        let of_elements = self.elements().flat_map(|element| {
            let first = 3 * element.sites()[0].vertex;
            element.sites().iter().map(move |site| [first, 3 * site.vertex])
        });
        let of_parts = (0..shared / 3).filter_map(|vertex| Some((vertex, self.equations.bodies.part_of(vertex)?)));
        let of_parts = of_parts.map(|(vertex, part)| [3 * vertex, points + POSE * part]);
        let of_poses = (points..self.base.len()).map(|k| [points + (k - points) / POSE * POSE, k]);
        let of_supports = self.supports.iter().zip(self.base.len()..);
        let of_supports =
            of_supports.flat_map(|(support, k)| support.terms.iter().map(move |(member, _)| [*member, k]));
        let links = of_points.chain(of_elements).chain(of_parts).chain(of_poses).chain(of_supports);
        pieces(count, links.chain((shared..points).map(|k| [0, k])), 0..count)
    }

    /// Makes these coordinates the reference state of a screw, and holds as many coordinates of its axis as `held`
    /// says: the direction, then the curvature. Returns the unknowns.
    pub(crate) fn hold_axis(&mut self, held: usize, coordinates: Vec<f64>) -> Vec<f64> {
        let axis = self.points() - self.equations.domain.shared();
        self.pinned.retain(|k| !(axis..axis + 2).contains(k));
        self.pinned.extend(axis..axis + held);
        self.rebase_gauge(coordinates)
    }

    /// Makes a state the reference state, as [`enter`](Self::enter) does, and chooses anew what is held if it would not
    /// hold rigid motions well: steps from here may then have no room. Returns the unknowns with the tensions, and whether
    /// the same is held.
    pub(crate) fn enter_well_held(&mut self, state: &Configuration) -> (Start, bool) {
        let Start { x, tension } = self.enter(state);
        let is_well_held = self.gauge_quality(&x) >= WELL_HELD;
        let x = if is_well_held { x } else { self.rebase_gauge(self.coordinates(&x)) };
        (Start { x, tension }, is_well_held)
    }

    /// Chooses anew what is held where it would soon hold the shape instead of rigid motions, and the units of unknowns
    /// where they have become others. Returns then the unknowns of the state `x`, and the given rates of unknowns less
    /// the rigid motion of each piece with which its coordinates now held would move.
    pub(super) fn still_held(&mut self, x: &[f64], rates: &[f64]) -> Option<[Vec<f64>; 2]> {
        let generalised = self.generalised(x);
        let units = self.units_at(&generalised[..self.points()]);
        let ratios = units.iter().zip(&self.units).map(|(new, old)| f64::max(new / old, old / new));
        if self.gauge_quality(x) >= STILL_HELD && ratios.fold(1.0, f64::max) <= MOST_CHANGED_UNIT {
            return None;
        }
        let motions = self.rigid_motions(&generalised, self.loads.is_empty());
        let mut moved = vec![0.0; motions.len()];
        self.free.iter().zip(rates).for_each(|(&k, rate)| moved[k as usize] = *rate);
        let before: Vec<f64> = (0..self.base.len()).map(|k| self.unit(k)).collect();
        self.rechoose(generalised);
        let mut held = vec![true; motions.len()];
        self.free.iter().for_each(|&k| held[k as usize] = false);
        (0..held.len()).for_each(|k| held[k] &= !self.is_derived(k));
        for (number, piece) in self.pieces().iter().enumerate() {
            let (motions, held) = self.motions_of_piece((number, piece), &motions, &held);
            let rows: Vec<usize> = (0..piece.len()).filter(|&k| held[k]).collect();
            if rows.is_empty() {
                continue;
            }
            let right = DVector::from_fn(rows.len(), |row, _| moved[piece[rows[row]]]);
            let rows = DMatrix::from_fn(rows.len(), 6, |row, motion| motions[rows[row]][motion]);
            let drift = shortest_solution(rows, &right, NOT_HELD)?;
            piece.iter().zip(&motions).for_each(|(&k, motion)| moved[k] -= motion.dot(&drift));
        }
        let in_new_units = |k: &u32| moved[*k as usize] * before[*k as usize] / self.unit(*k as usize);
        Some([self.start(), self.free.iter().map(in_new_units).collect()])
    }

    /// Makes these generalised coordinates the reference state, and chooses anew there what is held and the units.
    pub(super) fn rechoose(&mut self, generalised: Vec<f64>) {
        self.units = self.units_at(&generalised[..self.points()]);
        self.base = generalised;
        self.choose_unknowns();
    }

    /// Separation of the rigid motions of the state `x` by the held coordinates, relative to that by newly chosen ones; 0
    /// where these are more or fewer, as of a truss that becomes straight or ceases to be.
    fn gauge_quality(&self, x: &[f64]) -> f64 {
        if self.equations.gauge == Gauge::Free {
            return 1.0;
        }
        let motions = self.rigid_motions(&self.generalised(x), self.loads.is_empty());
        let mut held: Vec<bool> = (0..motions.len()).map(|k| !self.is_derived(k)).collect();
        self.free.iter().for_each(|&k| held[k as usize] = false);
        let chosen = self.chosen(&motions);
        let count = |held: &[bool]| held.iter().filter(|held| **held).count();
        if count(&held) != count(&chosen) {
            return 0.0;
        }
        let quality = |(number, piece): (usize, &Vec<usize>)| {
            let [now, best] = [&held, &chosen].map(|held| {
                let (motions, held) = self.motions_of_piece((number, piece), &motions, held);
                gauge::separation(&motions, &held)
            });
            if best > 0.0 { now / best } else { 1.0 }
        };
        self.pieces().iter().enumerate().map(quality).fold(1.0, f64::min)
    }

    /// Returns the unknowns on which an element depends: for each of its points those of its coordinates, or
    /// of the pose of its part; then the shared ones.
    fn members(&self, element: &Element<'_>, number: &[u32]) -> Vec<u32> {
        let (points, shared) = (self.points(), self.equations.domain.shared());
        let of_point = |vertex: usize| match self.equations.bodies.part_of(vertex) {
            Some(part) => points + POSE * part..points + POSE * (part + 1),
            None => 3 * vertex..3 * vertex + 3,
        };
        let of_points = element.sites().iter().flat_map(|site| of_point(site.vertex));
        of_points.chain(points - shared..points).map(|coordinate| number[coordinate]).collect()
    }

    /// Returns the layout of the unknowns; `number` is that of each generalised coordinate. Soft elements are those of
    /// the soft terms, then the loads of each loaded part; stiff ones those of the stiff terms, then the supports.
    fn new_layout(&self, number: &[u32]) -> Arc<Layout> {
        let (mut soft, mut stiff) = (Cliques::new(), Cliques::new());
        for element in self.elements() {
            let cliques = if element.number < self.soft_elements() { &mut soft } else { &mut stiff };
            let members = self.members(&element, number);
            let splits = element.term.head().is_hinge && !self.equations.bodies.touch(element.sites());
            if splits { cliques.push_split(members, LEFT_WING, RIGHT_WING) } else { cliques.push(members) }
        }
        let points = self.points();
        for (part, _) in self.loaded_parts() {
            soft.push((0..POSE).map(|k| number[points + POSE * part + k]));
        }
        self.supports.iter().for_each(|support| stiff.push(support.terms.iter().map(|(k, _)| number[*k])));
        let vertices = (points - self.equations.domain.shared()) / 3;
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
}
