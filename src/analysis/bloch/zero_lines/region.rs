//! Parts of the zone in which the determinant has one sign.

use super::line::{GRID, next};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A part of the zone in which the determinant has one sign.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "RegionSummary")]
pub struct Region {
    /// The sign, +1 or -1.
    #[schemars(with = "serde_json::Value", extend("enum" = [1, -1]))]
    pub sign: i8,
    /// Its part of the zone.
    pub fraction: f64,
}

/// Connected parts of the grid of equal sign, the largest first.
pub(crate) fn regions(positive: &[bool]) -> Vec<Region> {
    let mut seen = vec![false; positive.len()];
    let mut regions = Vec::new();
    for first in 0..positive.len() {
        let (mut stack, mut count) = (vec![first], 0usize);
        while let Some(k) = stack.pop() {
            if std::mem::replace(&mut seen[k], true) {
                continue;
            }
            count += 1;
            let (column, row) = (k % GRID, k / GRID);
            let back = [row * GRID + (column + GRID - 1) % GRID, (row + GRID - 1) % GRID * GRID + column];
            let neighbours = [next(0, k), next(1, k), back[0], back[1]];
            stack.extend(neighbours.into_iter().filter(|&other| !seen[other] && positive[other] == positive[k]));
        }
        if count > 0 {
            let sign = if positive[first] { 1 } else { -1 };
            regions.push(Region { sign, fraction: count as f64 / positive.len() as f64 });
        }
    }
    regions.sort_by(|a, b| b.fraction.total_cmp(&a.fraction));
    regions
}
