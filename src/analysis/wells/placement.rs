//! Pins: whether they say more about a state than its shape, and whether two states of one shape are one for them.
//!
//! Pins that only take rigid motions away, such as three, two and one coordinate of three vertices, hold no shape: every
//! shape of the free sheet can be placed on them. Then states of one shape count as one. Other pins hold the shape too,
//! and one shape can be held by them in several places, between which the sheet has to bend: a triangle on two pinned
//! vertices, whose third one is kept in a plane, stands on either side of that plane's zero line. Two states of one shape
//! then are one if a rigid motion that the pins leave free leads from one to the other.

use crate::math::{Vec3, rotation};
use crate::model::gauge;
use crate::model::{Assembly, Domain};
use crate::numerics::dense::small::shortest_solution;
use nalgebra::{DMatrix, DVector};

/// Most steps from one state to the other, and the longest turn in a step, in radians.
const STEPS: usize = 60;
const LONGEST_TURN_RAD: f64 = 0.5;
/// Distance of two vertices, over the mean edge, up to which they are in the same place.
const SAME_PLACE: f64 = 1e-4;
/// Weight of pinned coordinates against others.
const WEIGHT: f64 = 1e6;
/// Singular values, relative, of motions that are none.
const DEPENDENT: f64 = 1e-12;

/// What pins say about the place of a sheet.
#[derive(Clone, Debug)]
pub(crate) struct Placement {
    domain: Domain,
    /// Indices of the pinned coordinates.
    pinned: Vec<usize>,
    mean_edge: f64,
}

impl Placement {
    /// Of the pins of a patch; `None` where the shape says all.
    pub(crate) fn new(assembly: &Assembly) -> Option<Self> {
        let terms = assembly.terms();
        let pinned = pinned(assembly);
        let shapes = pinned.is_empty() || (!holds_shape(assembly) && terms.loads.is_empty());
        let placement = || Self { domain: assembly.drawn().domain.clone(), pinned, mean_edge: assembly.mean_edge() };
        (!shapes).then(placement)
    }

    /// Whether a rigid motion that the pins leave free leads from one state to another of the same shape.
    ///
    /// The sheet is moved towards the other state by rigid motions, step by step, each the one that brings all vertices
    /// closest and leaves those that are pinned where they are.
    pub(crate) fn leads(&self, from: &[f64], to: &[f64]) -> bool {
        let mut at = from.to_vec();
        for _ in 0..STEPS {
            let apart = at.iter().zip(to).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if apart <= SAME_PLACE * self.mean_edge {
                return true;
            }
            let Some(step) = self.step(&at, to) else { return false };
            moved(&mut at, &step);
        }
        false
    }

    /// Returns the best rigid motion: a translation and then a rotation vector about the centroid.
    fn step(&self, at: &[f64], to: &[f64]) -> Option<[Vec3; 2]> {
        let motions = gauge::rigid_motions(&self.domain, at, true);
        let rows = motions.len() + self.pinned.len();
        let place = |row: usize| match row.checked_sub(motions.len()) {
            None => (row, 1.0),
            Some(pin) => (self.pinned[pin], WEIGHT),
        };
        let matrix = DMatrix::from_fn(rows, 6, |row, motion| place(row).1 * motions[place(row).0][motion]);
        let right = DVector::from_fn(rows, |row, _| place(row).1 * (to[place(row).0] - at[place(row).0]));
        let found = shortest_solution(matrix, &right, DEPENDENT)?;
        let (points, centre) = (points(at), centre(at));
        let size = points.map(|p| (p - centre).norm()).fold(f64::MIN_POSITIVE, f64::max);
        let [shift, turn] = [Vec3::new(found[0], found[1], found[2]), Vec3::new(found[3], found[4], found[5]) / size];
        let part = (LONGEST_TURN_RAD / turn.norm().max(LONGEST_TURN_RAD)).min(1.0);
        Some([part * shift, part * turn])
    }
}

/// Whether pins hold more than rigid motions.
pub(crate) fn holds_shape(assembly: &Assembly) -> bool {
    let pinned = pinned(assembly);
    let [all, free] = rigid_motions(assembly, &pinned);
    !pinned.is_empty() && all - free < pinned.len()
}

/// Returns the number of rigid motions that pins leave free.
pub fn free_rigid_motions(assembly: &Assembly) -> usize {
    rigid_motions(assembly, &pinned(assembly))[1]
}

/// Returns the numbers of rigid motions of the drawn state without pins, and with these coordinates pinned.
fn rigid_motions(assembly: &Assembly, pinned: &[usize]) -> [usize; 2] {
    let drawn = assembly.drawn();
    let motions = gauge::rigid_motions(&drawn.domain, &drawn.coordinates, true);
    let mut held = vec![false; motions.len()];
    let all = gauge::choose(&motions, &held).len();
    pinned.iter().for_each(|&k| held[k] = true);
    [all, gauge::choose(&motions, &held).len()]
}

fn pinned(assembly: &Assembly) -> Vec<usize> {
    let coordinates = |(vertex, axes): &(usize, [bool; 3])| {
        let first = 3 * *vertex;
        let axes = *axes;
        (0..3).filter(move |axis| axes[*axis]).map(move |axis| first + axis)
    };
    assembly.terms().pins.iter().flat_map(coordinates).collect()
}

fn points(coordinates: &[f64]) -> impl Iterator<Item = Vec3> {
    coordinates.chunks_exact(3).map(Vec3::from_column_slice)
}

fn centre(coordinates: &[f64]) -> Vec3 {
    points(coordinates).sum::<Vec3>() / (coordinates.len() / 3) as f64
}

/// Moves a sheet by a translation and a rotation vector about its centroid.
fn moved(coordinates: &mut [f64], [shift, turn]: &[Vec3; 2]) {
    let (centre, turn) = (centre(coordinates), rotation::exp(turn));
    for point in coordinates.chunks_exact_mut(3) {
        let to = centre + shift + turn * (Vec3::from_column_slice(point) - centre);
        point.copy_from_slice(to.as_slice());
    }
}
