//! Spaces of symmetric 2 x 2 tensors `[t11, t22, t12]`, and Poisson's ratios in them.

use super::error::ResponseError;
use crate::numerics::dense::full_svd;
use crate::numerics::{DenseMatrix, larger};
use std::f64::consts::SQRT_2;

/// Singular value below which a tensor counts as zero, relative to modes of norm 1 and a cell of area 1.
const ZERO: f64 = 1e-9;
/// Smallest ratio of a singular value that counts as nonzero to one that counts as zero.
const LEAST_GAP: f64 = 1e3;

/// The space that some symmetric tensors span.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TensorSpace {
    /// A basis, orthonormal in the product `a11 b11 + a22 b22 + 2 a12 b12`.
    pub basis: Vec<[f64; 3]>,
    /// How far off the components of the basis may be: the error of modes of norm 1 over the smallest singular value of
    /// their tensors.
    pub uncertainty: f64,
}

/// Why there is no Poisson's ratio in a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoRatio {
    /// No mode has a tensor of this kind, a strain or a curvature.
    NoTensor,
    /// Any ratio is possible: three tensors are independent, or two have no shear in the direction.
    Any,
    /// The tensor has no component along the direction.
    NothingAlong,
}

impl NoRatio {
    /// Returns the reason as a word for tables: `no-mode`, `any` or `nothing-along`.
    pub fn word(self) -> &'static str {
        match self {
            Self::NoTensor => "no-mode",
            Self::Any => "any",
            Self::NothingAlong => "nothing-along",
        }
    }
}

/// Ranks and right singular vectors of a list of rows of numbers.
pub(super) struct Span {
    /// Number of singular values that count as nonzero.
    pub rank: usize,
    /// All singular values, descending, one for each row where there are more components than rows.
    pub values: Vec<f64>,
    /// Left singular vectors as columns: combinations of the components.
    pub components: DenseMatrix,
    /// Right singular vectors as columns: combinations of the rows.
    pub combinations: DenseMatrix,
}

impl Span {
    /// Decomposes the matrix that has one of these lists of components for each column.
    pub(super) fn new(columns: &DenseMatrix, half: &'static str) -> Result<Self, ResponseError> {
        let svd = full_svd(columns)?;
        let rank = svd.singular_values.iter().filter(|value| **value > ZERO).count();
        let kept = rank.checked_sub(1).map_or(f64::INFINITY, |last| svd.singular_values[last]);
        let dropped = svd.singular_values.get(rank).copied().unwrap_or(0.0);
        if !(kept >= LEAST_GAP * dropped.max(f64::EPSILON)) {
            return Err(ResponseError::UnclearRank { half, kept, dropped });
        }
        Ok(Self { rank, values: svd.singular_values, components: svd.u, combinations: svd.v })
    }
}

/// Returns the components of a tensor in which the product of tensors is that of vectors.
pub(super) fn flat([t11, t22, t12]: [f64; 3]) -> [f64; 3] {
    [t11, t22, SQRT_2 * t12]
}

/// Returns the components `along along`, `across across`, `along across` of a tensor for the direction at an angle
/// from x.
pub(crate) fn turned([t11, t22, t12]: [f64; 3], angle: f64) -> [f64; 3] {
    let (s, c) = angle.sin_cos();
    let along = c * c * t11 + s * s * t22 + 2.0 * c * s * t12;
    let across = s * s * t11 + c * c * t22 - 2.0 * c * s * t12;
    [along, across, c * s * (t22 - t11) + (c * c - s * s) * t12]
}

/// Returns `cof(a) : b`, which is `a11 b22 + a22 b11 - 2 a12 b12` and the same for `b` and `a`.
pub(crate) fn mixed_determinant(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[1] + a[1] * b[0] - 2.0 * a[2] * b[2]
}

impl TensorSpace {
    /// Makes the space that the tensors of modes of norm 1 span; `error` is the error of these modes.
    pub(super) fn new(span: &Span, error: f64) -> Self {
        let tensor = |k: usize| {
            let column = span.components.column(k);
            [column[0], column[1], column[2] / SQRT_2]
        };
        let least = span.rank.checked_sub(1).map_or(1.0, |last| span.values[last]);
        Self { basis: (0..span.rank).map(tensor).collect(), uncertainty: error / least }
    }

    /// Number of tensors in a basis.
    pub fn dimension(&self) -> usize {
        self.basis.len()
    }

    /// Poisson's ratio in a direction, at `angle` in radians from x: minus the component across over the component
    /// along the direction.
    ///
    /// In a space of one tensor it is that of the tensor, with whatever shear it has; in a space of two tensors that of
    /// the one without shear (or twist) in this direction. The component along the direction is none where it is below
    /// 1e-9 of the tensor's norm, as a tensor below 1e-9 of its mode is none, and where less than three digits of it
    /// are known.
    ///
    /// # Errors
    /// [`NoRatio`] where there is no tensor, where any ratio is possible, and where the tensor has no component along
    /// the direction.
    pub fn ratio(&self, angle: f64) -> Result<f64, NoRatio> {
        let least = larger(ZERO, LEAST_GAP * self.uncertainty);
        let [along, across] = match &self.basis[..] {
            [] => return Err(NoRatio::NoTensor),
            [only] => {
                let [along, across, _] = turned(*only, angle);
                [along, across]
            }
            [first, second] => {
                let (a, b) = (turned(*first, angle), turned(*second, angle));
                if a[2].hypot(b[2]) <= least {
                    return Err(NoRatio::Any);
                }
                [0, 1].map(|k| b[2] * a[k] - a[2] * b[k])
            }
            _ => return Err(NoRatio::Any),
        };
        if along.abs() > least { Ok(-across / along) } else { Err(NoRatio::NothingAlong) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// Claim: a quarter turn exchanges the directions and reverses the shear, and turning keeps trace, determinant and
    /// the mixed determinant. Tolerance: rounding.
    #[test]
    fn components_turn() {
        let (a, b) = ([1.0, -0.3, 0.7], [0.2, 0.5, -0.4]);
        let quarter = turned(a, FRAC_PI_2);
        assert!([0, 1, 2].iter().all(|&k| (quarter[k] - [-0.3, 1.0, -0.7][k]).abs() <= 1e-15));
        for angle in [0.3, 1.0, 2.5] {
            let (u, v) = (turned(a, angle), turned(b, angle));
            assert!((u[0] + u[1] - 0.7).abs() <= 1e-15);
            assert!((mixed_determinant(u, v) - mixed_determinant(a, b)).abs() <= 1e-15);
            assert!((mixed_determinant(u, u) - mixed_determinant(a, a)).abs() <= 2e-15);
        }
    }

    fn span(tensors: &[[f64; 3]]) -> Result<Span, ResponseError> {
        Span::new(&DenseMatrix::from_fn(3, tensors.len(), |row, k| flat(tensors[k])[row]), "strains")
    }

    /// Claim: the ratio of one tensor is read off its components; of two it is that of the combination without shear;
    /// of none, of three, and along a direction without strain there is none.
    #[test]
    fn ratios_of_spaces() {
        let space = |tensors: &[[f64; 3]]| TensorSpace::new(&span(tensors).unwrap(), 1e-15);
        assert!((space(&[[2.0, -1.0, 0.3]]).ratio(0.0).unwrap() - 0.5).abs() <= 1e-15);
        assert!((space(&[[2.0, -1.0, 0.3]]).ratio(FRAC_PI_2).unwrap() - 2.0).abs() <= 1e-14);
        let two = space(&[[1.0, 3.0, 1.0], [1.0, -1.0, 1.0]]);
        assert_eq!(two.dimension(), 2);
        // without shear only [0, 4, 0] is left, which has no strain along x
        assert_eq!(two.ratio(0.0), Err(NoRatio::NothingAlong));
        assert!((two.ratio(FRAC_PI_2).unwrap()).abs() <= 1e-15);
        assert_eq!(space(&[]).ratio(0.0), Err(NoRatio::NoTensor));
        assert_eq!(space(&[[0.0, 1.0, 0.0]]).ratio(0.0), Err(NoRatio::NothingAlong));
        assert_eq!(space(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).ratio(0.0), Err(NoRatio::Any));
        // along x and y neither tensor has shear: any ratio is possible
        assert_eq!(space(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]).ratio(0.0), Err(NoRatio::Any));
    }

    /// Claim: where a tensor has neither strain along a direction nor across it there is no ratio, whatever rounding
    /// leaves of both; an eighth of a turn from such a direction the ratio of the same tensor is 1. A tensor that is
    /// known to 1e-6 only has none where 1e-4 of it is left.
    #[test]
    fn no_ratio_of_rounding() {
        let space = |tensor: [f64; 3], error: f64| TensorSpace::new(&span(&[tensor]).unwrap(), error);
        let eggbox = space([0.3, -0.3 + 1e-16, 2e-16], 1e-15);
        let eighth = 0.5 * FRAC_PI_2;
        assert!([eighth, 3.0 * eighth].iter().all(|&angle| eggbox.ratio(angle) == Err(NoRatio::NothingAlong)));
        assert!((eggbox.ratio(0.0).unwrap() - 1.0).abs() <= 1e-14);
        assert!(space([1e-4, 1.0, 0.0], 1e-15).ratio(0.0).is_ok());
        assert_eq!(space([1e-4, 1.0, 0.0], 1e-6).ratio(0.0), Err(NoRatio::NothingAlong));
    }

    /// Claim: tensors between zero and not zero are reported, not counted.
    #[test]
    fn an_unclear_rank_is_an_error() {
        let found = span(&[[1e-8, 0.0, 0.0], [0.0, 5e-10, 0.0]]);
        assert!(matches!(found, Err(ResponseError::UnclearRank { half: "strains", .. })));
    }
}
