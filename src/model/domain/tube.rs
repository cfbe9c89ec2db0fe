//! The motions of a tube about the z axis, to the cells of its strands and rows, and their derivatives.
//!
//! Cell `i p + j m` (see [`Seam`]) turns by `t = i alpha + j theta` and rises by `d = i rise + j h`, so that a point
//! `P` of cell (0, 0) has its copy at `R_z(t) P + d e_z`. The shared coordinates are `theta, h`, then `rise` and
//! `alpha` where they are free. A seam that keeps its turn has `alpha = 2 pi / g` with the number `g` of strands, and
//! one that keeps its rise has `rise = 0`: both closing conditions hold identically.

use super::shared::{Pulled, SharedMatrix};
use crate::math::Vec3;
use crate::sheet::{Seam, SeamKept};
use nalgebra::Matrix3;
use std::f64::consts::TAU;

/// The motion to one cell of a tube.
pub(super) struct TubeMotion {
    sin: f64,
    cos: f64,
    /// Translation along the axis.
    along: f64,
    /// Derivatives of the turn and of the translation by the shared coordinates.
    turns: [f64; 4],
    rises: [f64; 4],
}

impl TubeMotion {
    pub(super) fn new(seam: &Seam, kept: SeamKept, shared: &[f64], cell: [i32; 2]) -> Self {
        let [strand, row] = seam.place(cell);
        let (mut turns, mut rises) = ([0.0; 4], [0.0; 4]);
        (turns[0], rises[1]) = (f64::from(row), f64::from(row));
        let mut next = 2;
        if !kept.rise {
            rises[next] = f64::from(strand);
            next += 1;
        }
        let closed = if kept.turn {
            TAU * f64::from(strand.rem_euclid(seam.strands())) / f64::from(seam.strands())
        } else {
            turns[next] = f64::from(strand);
            0.0
        };
        let sum = |rates: &[f64; 4]| rates.iter().zip(shared).map(|(rate, x)| rate * x).sum::<f64>();
        let (sin, cos) = (closed + sum(&turns)).sin_cos();
        Self { sin, cos, along: sum(&rises), turns, rises }
    }

    pub(super) fn point(&self, v: &Vec3) -> Vec3 {
        Vec3::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y, v.z + self.along)
    }

    /// Returns the derivatives of a copy, which is at `point`, by its vertex and by the shared coordinates.
    pub(super) fn derivatives(&self, point: &Vec3) -> (Matrix3<f64>, Option<SharedMatrix>) {
        let mut by_shared = SharedMatrix::zeros();
        for k in 0..4 {
            by_shared.set_column(k, &Vec3::new(-point.y * self.turns[k], point.x * self.turns[k], self.rises[k]));
        }
        (Matrix3::new(self.cos, -self.sin, 0.0, self.sin, self.cos, 0.0, 0.0, 0.0, 1.0), Some(by_shared))
    }

    /// Adds the second derivative of `force . P` to the lower triangle, `P` being the position of a copy: the block
    /// of the point's vertex (at `at`) and that of the `count` shared coordinates (at `shared`, which come after it).
    pub(super) fn add_curvature(
        &self,
        copy: &Vec3,
        force: &Vec3,
        at: usize,
        (shared, count): (usize, usize),
        hessian: &mut Pulled,
    ) {
        let by_turn = [self.cos * force.y - self.sin * force.x, -self.cos * force.x - self.sin * force.y];
        let twice = -(force.x * copy.x + force.y * copy.y);
        for k in 0..count {
            (0..2).for_each(|axis| hessian[(shared + k, at + axis)] += self.turns[k] * by_turn[axis]);
            (0..=k).for_each(|l| hessian[(shared + k, shared + l)] += self.turns[k] * self.turns[l] * twice);
        }
    }
}

/// Returns the turns and the translations along the axis of the two lattice vectors.
pub(super) fn lattice_motions(seam: &Seam, kept: SeamKept, shared: &[f64]) -> [[f64; 2]; 2] {
    let alpha = if kept.turn { TAU / f64::from(seam.strands()) } else { shared[shared.len() - 1] };
    let rise = if kept.rise { 0.0 } else { shared[2] };
    let places = [seam.place([1, 0]), seam.place([0, 1])].map(|place| place.map(f64::from));
    let of = |per_strand: f64, per_row: f64| places.map(|[strand, row]| strand * per_strand + row * per_row);
    [of(alpha, shared[0]), of(rise, shared[1])]
}
