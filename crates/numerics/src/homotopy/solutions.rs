//! Solutions in projective space, and which of them are the same.

use super::system::{C, distance, normalize};
use nalgebra::Complex;

/// Distance below which ends of paths are one multiple solution.
pub(super) const SAME_SOLUTION_DISTANCE: f64 = 1e-6;

/// An isolated solution.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// A vector of norm 1, its largest entry real and positive; all entries are real where the solution is.
    pub point: Vec<Complex<f64>>,
    /// Multiplicity of the solution.
    pub multiplicity: usize,
    /// Whether it is real: proved where it is simple, otherwise up to 1e-6.
    pub real: bool,
    /// Estimated distance to the exact solution.
    pub error: f64,
}

/// The solutions of a square system.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solutions {
    /// The isolated solutions, in the order of their paths.
    pub isolated: Vec<Solution>,
    /// Points of norm 1, one for each path that ended on a curve, a surface or more of solutions.
    pub on_continua: Vec<Vec<Complex<f64>>>,
    /// Number of paths, `2^m`: the sum of all multiplicities and of the paths that ended on continua.
    pub paths: usize,
}

impl Solutions {
    /// Number of isolated solutions, each with its multiplicity.
    pub fn count(&self) -> usize {
        self.isolated.iter().map(|solution| solution.multiplicity).sum()
    }
}

/// Points that are the same up to [`SAME_SOLUTION_DISTANCE`].
pub(super) struct Group {
    pub(super) point: Vec<C>,
    /// Largest error or distance of a member.
    pub(super) error: f64,
    pub(super) members: Vec<Vec<C>>,
}

/// Puts points that are the same together, in the order of the first of each group.
pub(super) fn grouped(points: impl Iterator<Item = (Vec<C>, f64)>) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (point, error) in points {
        match groups.iter_mut().find(|group| distance(&group.point, &point) <= SAME_SOLUTION_DISTANCE) {
            Some(group) => {
                group.error = group.error.max(error).max(distance(&group.point, &point));
                group.members.push(point);
            }
            None => groups.push(Group { point: point.clone(), error, members: vec![point] }),
        }
    }
    groups
}

/// A solution that is not simple.
pub(super) fn multiple(point: Vec<C>, multiplicity: usize, error: f64) -> Solution {
    let real = distance(&point, &conjugate(&point)) <= SAME_SOLUTION_DISTANCE;
    Solution { point: turned(point, real), multiplicity, real, error }
}

/// The complex conjugate of a point.
pub(super) fn conjugate(point: &[C]) -> Vec<C> {
    point.iter().map(C::conj).collect()
}

/// A point multiplied by a phase so that its largest entry is real and positive; a real one without imaginary parts.
pub(super) fn turned(point: Vec<C>, real: bool) -> Vec<C> {
    let largest =
        point.iter().copied().fold(C::default(), |a, b| if b.norm() > a.norm() * (1.0 + 1e-9) { b } else { a });
    let phase = largest.conj() / largest.norm();
    let mut turned: Vec<C> = point.iter().map(|entry| entry * phase).collect();
    if real {
        turned.iter_mut().for_each(|entry| entry.im = 0.0);
    }
    normalize(&mut turned);
    turned
}
