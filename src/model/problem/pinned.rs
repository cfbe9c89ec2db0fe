//! Patches that pins hold against rigid motions alone: any shape is moved onto them as a rigid body.

use super::{DEPENDENT, Model};
use crate::math::Vec3;
use crate::model::domain::Domain;
use crate::model::gauge;
use crate::numerics::dense::small::shortest_solution;
use nalgebra::{DMatrix, DVector, Rotation3};

/// Largest number of steps towards pins: with every step the distance is squared.
const MOST_MOVES: usize = 20;

impl Model {
    /// Whether the sheet is a patch that pins keep from no shape, since they hold rigid motions alone, without supports
    /// and rigid parts.
    pub(crate) fn takes_any_shape(&self) -> bool {
        let is_bare = self.supports.is_empty() && self.equations.bodies.is_empty();
        is_bare && matches!(self.equations.domain, Domain::Patch) && {
            let motions = self.rigid_motions(&self.base, true);
            let of_pinned: Vec<gauge::Motion> = self.pinned.iter().map(|&k| motions[k]).collect();
            gauge::choose(&of_pinned, &vec![false; of_pinned.len()]).len() == of_pinned.len()
        }
    }

    /// Moves a shape as a rigid body to where its pinned coordinates have their values, by Newton's method from where it
    /// is.
    pub(in crate::model) fn onto_pins(&self, mut coordinates: Vec<f64>) -> Vec<f64> {
        for _ in 0..MOST_MOVES {
            let motions = self.rigid_motions(&coordinates, true);
            let (centre, size) = gauge::centre_and_size(&self.equations.domain, &coordinates);
            let rows = DMatrix::from_fn(self.pinned.len(), 6, |row, motion| motions[self.pinned[row]][motion]);
            let off = self.pinned.iter().map(|&k| self.base[k] - coordinates[k]);
            let off = DVector::from_iterator(self.pinned.len(), off);
            if off.is_empty() || off.amax() <= f64::EPSILON * size {
                break;
            }
            let Some(motion) = shortest_solution(rows, &off, DEPENDENT) else { break };
            let (shift, turn) = (Vec3::from(motion.fixed_rows::<3>(0)), Vec3::from(motion.fixed_rows::<3>(3)));
            let turn = Rotation3::new(turn / size);
            let points = coordinates.chunks_exact(3).map(Vec3::from_column_slice);
            coordinates = points.flat_map(|p| <[f64; 3]>::from(centre + shift + turn * (p - centre))).collect();
        }
        coordinates
    }
}
