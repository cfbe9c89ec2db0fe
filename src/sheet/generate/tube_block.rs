//! A block of aligned Miura tubes: a cellular solid that folds without stretching.

use std::f64::consts::{FRAC_PI_3, FRAC_PI_4};

use super::super::angle::radians;
use super::error::{GenerateError, count};
use super::parts::parameters;
use super::tubes::MiuraTubes;
use crate::math::Vec3;
use crate::sheet::cell::Sheet;

/// Most tubes on top of each other.
const MOST_TUBES: usize = 100;

parameters! {
    /// A block of `tubes[0]` by `tubes[1]` aligned tubes of Miura-ori along x, which share their walls.
    ///
    /// Each is the tube of [`MiuraTubes`], moved by multiples of its sides `u` and `v`: all walls of one direction are
    /// the same, so that the block folds as one tube does. Four faces meet at the lines inside it.
    TubeBlock {
        /// As of [`MiuraTubes`].
        a: f64 = 1.0,
        /// As of [`MiuraTubes`].
        b: f64 = 1.0,
        /// As of [`MiuraTubes`].
        sector: f64 as "radians" = FRAC_PI_3,
        /// As of [`MiuraTubes`].
        fold: f64 as "radians" = FRAC_PI_4,
        /// Number of zigzags along the axis, 1 to 500. Default 2.
        cells: usize = 2,
        /// Numbers of tubes along the sides `u` and `v` of a tube, 1 to 100. Default 2 by 2.
        tubes: [usize; 2] = [2, 2],
    }
}

impl TubeBlock {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let Self { a, b, sector, fold, cells, tubes } = *self;
        let tube = MiuraTubes { a, b, sector, fold, cells }.tube()?;
        let [n, m] = [count("tubes", tubes[0], 1, MOST_TUBES)?, count("tubes", tubes[1], 1, MOST_TUBES)?];
        let [u, v] = tube.sides;
        let ring: Vec<Vec3> = (0..=n).flat_map(|i| (0..=m).map(move |j| u * i as f64 + v * j as f64)).collect();
        let point = |i: usize, j: usize| i * (m + 1) + j;
        // walls outside run round the block, so that all its faces outside are seen from there
        let wall = |from: usize, to: usize, turned: bool| if turned { [to, from] } else { [from, to] };
        let along_u = (0..n).flat_map(|i| (0..=m).map(move |j| wall(point(i, j), point(i + 1, j), j == m)));
        let along_v = (0..=n).flat_map(|i| (0..m).map(move |j| wall(point(i, j), point(i, j + 1), i == 0)));
        let walls: Vec<[usize; 2]> = along_u.chain(along_v).collect();
        let parts = tube.walls("tube-block", &ring, &walls);
        parts.sheet(format!("{} tubes = [{n}, {m}].", tube.words))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lengths(sheet: &Sheet) -> Vec<f64> {
        sheet.edges.iter().map(|edge| (sheet.vertices[edge.key.j] - sheet.vertices[edge.key.i]).norm()).collect()
    }

    /// Claim: a block of tubes has the same bars at every fold, diagonals included, so that it folds without stretching,
    /// and four faces at the lines inside; two tubes on top of each other are the aligned tubes. Source: 2 by 3 tubes
    /// have 12 lines, 2 of them inside, and 17 walls. Tolerance: rounding.
    #[test]
    fn blocks_of_tubes_fold_without_stretching() {
        let block =
            |fold: f64, tubes| TubeBlock { fold, a: 1.2, cells: 3, tubes, ..TubeBlock::default() }.sheet().unwrap();
        let [one, other] = [0.6, 1.3].map(|fold| block(fold, [2, 3]));
        for (one, other) in lengths(&one).iter().zip(lengths(&other)) {
            assert!((one - other).abs() < 1e-14, "{one} {other}");
        }
        assert_eq!((one.vertices.len(), one.polygons.len()), (7 * 12, 6 * 17));
        let with_four = one.edges.iter().filter(|edge| one.hinges_round(edge.key) == 4).count();
        assert_eq!(with_four, 4 * 2 * 6, "four hinges round each of the six pieces of the lines inside");
        let sorted = |sheet: &Sheet| {
            let mut lengths = lengths(sheet);
            lengths.sort_by(f64::total_cmp);
            lengths
        };
        let aligned = MiuraTubes { fold: 0.6, a: 1.2, cells: 3, ..MiuraTubes::default() }.aligned().unwrap();
        for (block, aligned) in sorted(&block(0.6, [1, 2])).iter().zip(sorted(&aligned)) {
            assert!((block - aligned).abs() < 1e-14, "{block} {aligned}");
        }
    }
}
