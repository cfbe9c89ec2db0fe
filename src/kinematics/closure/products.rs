//! Products of turns, the second order of a product of rotations.

use crate::math::Vec3;
use crate::numerics::DenseMatrix;

/// Adds the symmetric part of `2 half before_a x turns_b` to the matrices of its three components.
pub(super) fn add_products(parts: &mut [DenseMatrix], (before, turns): (&[Vec3], &[Vec3]), half: f64) {
    for (a, before) in before.iter().enumerate() {
        for (b, turn) in turns.iter().enumerate() {
            let product = half * before.cross(turn);
            for (part, component) in parts.iter_mut().zip(product.iter()) {
                part[(a, b)] += component;
                part[(b, a)] += component;
            }
        }
    }
}
