//! Spaces of symmetric 2 x 2 tensors `[t11, t22, t12]`, and Poisson's ratios in them.

use super::error::ResponseError;
use crate::numerics::DenseMatrix;
use crate::numerics::dense::full_svd;
use std::f64::consts::SQRT_2;

/// Singular value below which a tensor counts as zero, relative to modes of norm 1 and a cell of area 1.
const ZERO: f64 = 1e-9;
/// Smallest ratio of a singular value that counts as nonzero to one that counts as zero.
const LEAST_GAP: f64 = 1e3;
/// Component of a tensor, relative to its norm, below which it counts as zero.
const NO_COMPONENT: f64 = 1e-12;

/// The space that some symmetric tensors span.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TensorSpace {
    /// A basis, orthonormal in the product `a11 b11 + a22 b22 + 2 a12 b12`.
    pub basis: Vec<[f64; 3]>,
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
    ///
    /// # Errors
    /// [`ResponseError::UnclearRank`] where no clear gap separates zero from the other singular values; `half` names
    /// what the columns are.
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
    /// Makes the space that these tensors span; a tensor of a mode of norm 1 below 1e-9 counts as zero.
    pub(super) fn new(tensors: &[[f64; 3]], half: &'static str) -> Result<Self, ResponseError> {
        let span = Span::new(&DenseMatrix::from_fn(3, tensors.len(), |row, k| flat(tensors[k])[row]), half)?;
        let tensor = |k: usize| {
            let column = span.components.column(k);
            [column[0], column[1], column[2] / SQRT_2]
        };
        Ok(Self { basis: (0..span.rank).map(tensor).collect() })
    }

    /// Number of tensors in a basis.
    pub fn dimension(&self) -> usize {
        self.basis.len()
    }

    /// Poisson's ratio in a direction, at `angle` in radians from x: minus the component across over the component
    /// along the direction.
    ///
    /// In a space of one tensor it is that of the tensor, with whatever shear it has; in a space of two tensors that of
    /// the one without shear (or twist) in this direction. `None` where there is no tensor, where three make any ratio
    /// possible, and where the tensor has no component along the direction.
    pub fn ratio(&self, angle: f64) -> Option<f64> {
        let [along, across] = match &self.basis[..] {
            [only] => {
                let [along, across, _] = turned(*only, angle);
                [along, across]
            }
            [first, second] => {
                let (a, b) = (turned(*first, angle), turned(*second, angle));
                if a[2].hypot(b[2]) <= NO_COMPONENT {
                    return None;
                }
                [0, 1].map(|k| b[2] * a[k] - a[2] * b[k])
            }
            _ => return None,
        };
        (along.abs() > NO_COMPONENT * along.hypot(across)).then(|| -across / along)
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

    /// Claim: the ratio of one tensor is read off its components; of two it is that of the combination without shear;
    /// of none, of three, and along a direction without strain there is none.
    #[test]
    fn ratios_of_spaces() {
        let space = |tensors: &[[f64; 3]]| TensorSpace::new(tensors, "strains").unwrap();
        assert!((space(&[[2.0, -1.0, 0.3]]).ratio(0.0).unwrap() - 0.5).abs() <= 1e-15);
        assert!((space(&[[2.0, -1.0, 0.3]]).ratio(FRAC_PI_2).unwrap() - 2.0).abs() <= 1e-14);
        let two = space(&[[1.0, 3.0, 1.0], [1.0, -1.0, 1.0]]);
        assert_eq!(two.dimension(), 2);
        assert!((two.ratio(0.0)).is_none(), "without shear only [0, 4, 0] is left, which has no strain along x");
        assert!((two.ratio(FRAC_PI_2).unwrap()).abs() <= 1e-15);
        assert!(space(&[]).ratio(0.0).is_none() && space(&[[0.0, 1.0, 0.0]]).ratio(0.0).is_none());
        assert!(space(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).ratio(0.0).is_none());
        // along x and y neither tensor has shear: any ratio is possible
        assert!(space(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]).ratio(0.0).is_none());
    }

    /// Claim: tensors between zero and not zero are reported, not counted.
    #[test]
    fn an_unclear_rank_is_an_error() {
        let found = TensorSpace::new(&[[1e-8, 0.0, 0.0], [0.0, 5e-10, 0.0]], "strains");
        assert!(matches!(found, Err(ResponseError::UnclearRank { half: "strains", .. })));
    }
}
