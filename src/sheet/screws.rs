//! Screw motions that repeat a cell about an axis: the lattice of a tube that a file draws as it is, rolled up.

use super::seam::{Seam, SeamKept};
use crate::math::Vec3;

/// Two commuting screw motions about the z axis, which repeat a cell as two lattice vectors do on a sheet that goes
/// straight on: cell `(n1, n2)` is cell (0, 0) turned by `n1 turn[0] + n2 turn[1]` and moved by
/// `n1 rise[0] + n2 rise[1]` along the axis.
///
/// ```
/// use foldwell::math::Vec3;
/// use foldwell::sheet::ScrewLattice;
///
/// let ring = ScrewLattice { turn: [std::f64::consts::FRAC_PI_2, 0.1], rise: [0.0, 2.0] };
/// let copy = ring.copy(&Vec3::new(1.0, 0.0, 0.0), [1, 0]);
/// assert!((copy - Vec3::new(0.0, 1.0, 0.0)).norm() < 1e-15);
/// // four cells go once round
/// assert!(ring.turn_of([4, 0]) == std::f64::consts::TAU && ring.rise_of([4, 0]) == 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScrewLattice {
    /// Angles of the two motions in radians, right-handed about z.
    pub turn: [f64; 2],
    /// Translations of the two motions along z.
    pub rise: [f64; 2],
}

impl ScrewLattice {
    /// Returns the angle from cell (0, 0) to a cell, in radians.
    pub fn turn_of(&self, cell: [i32; 2]) -> f64 {
        f64::from(cell[0]) * self.turn[0] + f64::from(cell[1]) * self.turn[1]
    }

    /// Returns the translation along the axis from cell (0, 0) to a cell.
    pub fn rise_of(&self, cell: [i32; 2]) -> f64 {
        f64::from(cell[0]) * self.rise[0] + f64::from(cell[1]) * self.rise[1]
    }

    /// Returns the coordinates of a tube that all its vertices share: the turn and the rise of the next row, then those
    /// of the next strand that the seam leaves free, rise before turn.
    pub(crate) fn shared(&self, seam: &Seam, kept: SeamKept) -> Vec<f64> {
        let [strand, row] = seam.basis();
        let rise = (!kept.rise).then(|| self.rise_of(strand));
        let turn = (!kept.turn).then(|| self.turn_of(strand));
        [self.turn_of(row), self.rise_of(row)].into_iter().chain(rise).chain(turn).collect()
    }

    /// Returns the copy in a cell of a point of cell (0, 0).
    pub fn copy(&self, point: &Vec3, cell: [i32; 2]) -> Vec3 {
        let (sin, cos) = self.turn_of(cell).sin_cos();
        Vec3::new(cos * point.x - sin * point.y, sin * point.x + cos * point.y, point.z + self.rise_of(cell))
    }

    /// Returns the chords from a point of cell (0, 0) to its copies in cells (1, 0) and (0, 1).
    pub fn chords(&self, point: &Vec3) -> [Vec3; 2] {
        [[1, 0], [0, 1]].map(|cell| self.copy(point, cell) - point)
    }
}
