//! A sparse matrix by rows.

use super::cliques::{Cliques, FIXED};
use std::ops::Range;

/// A sparse matrix with one row a clique; an unknown that occurs twice in a clique has the sum of its entries.
#[derive(Clone, Debug)]
pub struct Rows<'a> {
    /// Which unknowns each row has.
    pub cliques: &'a Cliques,
    /// One number for each member of each clique.
    pub values: &'a [f64],
}

impl Rows<'_> {
    /// The entries of each row: unknowns and numbers.
    fn entries(&self) -> impl Iterator<Item = impl Iterator<Item = (u32, f64)>> {
        let members = &self.cliques.members;
        let pairs =
            |range: Range<usize>| members[range.clone()].iter().copied().zip(self.values[range].iter().copied());
        self.cliques.ranges().map(pairs)
    }

    /// `y = R x`.
    pub fn product(&self, x: &[f64], y: &mut [f64]) {
        for (row, out) in self.entries().zip(y) {
            *out = row.map(|(member, value)| if member == FIXED { 0.0 } else { value * x[member as usize] }).sum();
        }
    }

    /// `y += R^T t`.
    pub fn add_transpose_product(&self, t: &[f64], y: &mut [f64]) {
        for (row, tension) in self.entries().zip(t) {
            for (member, value) in row {
                if member != FIXED {
                    y[member as usize] += value * tension;
                }
            }
        }
    }
}
