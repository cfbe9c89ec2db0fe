//! Parts of the zone in which the determinant has one sign.

use super::line::next;
use crate::math::pieces::pieces;
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
    let sides = (0..positive.len()).flat_map(|k| [[k, next(0, k)], [k, next(1, k)]]);
    let joined = sides.filter(|[a, b]| positive[*a] == positive[*b]);
    let region = |piece: Vec<usize>| Region {
        sign: if positive[piece[0]] { 1 } else { -1 },
        fraction: piece.len() as f64 / positive.len() as f64,
    };
    let mut regions: Vec<Region> = pieces(positive.len(), joined, 0..positive.len()).into_iter().map(region).collect();
    regions.sort_by(|a, b| b.fraction.total_cmp(&a.fraction));
    regions
}
