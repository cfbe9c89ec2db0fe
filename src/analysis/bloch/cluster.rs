//! Roots that coincide, as those of symmetric sheets do: found as singular points of the rigidity matrix, which knows
//! them to all digits where the determinant's coefficients know them to half.
//!
//! With the left and right singular vectors `W`, `V` of the `m` smallest singular values at `z`, the matrix
//! `G = W^H R V` is their diagonal there and has the derivative `G' = W^H dR V` by `log z`: what couples these vectors
//! to the others vanishes at `z` on both sides, so that it enters with the square of a step. The eigenvalues of
//! `-G'^-1 G` are therefore Newton steps to the `m` roots near by. Where `R` has `m` null vectors at a root of
//! multiplicity `m`, `G'` is invertible there and all of them end at one point. Where `R` has fewer null vectors, the
//! roots coincide as far as the determinant's coefficients tell and are then found as a zero of its derivative.

use super::rigidity::TERM;
use super::root::Root;
use super::singular::SingularSearch;
use super::{Laurent, Rigidity};
use crate::math::pieces::pieces;
use crate::numerics::complex::{ComplexMatrix, eigenvalues};
use crate::numerics::dense::small::inverse;
use crate::numerics::dense::{Svd, full_svd};
use nalgebra::Complex;

/// Newton steps at most.
const STEPS: usize = 8;
/// Longest way of `log z` from the mean of a cluster to the roots on the matrix.
const FARTHEST: f64 = 0.01;
/// Roots nearer to the mean of a cluster than so many roundings are one root.
const ROUNDINGS: f64 = 16.0;

/// The roots of a cluster by their numbers in a list: each within the rounding errors of another of them. Roots that
/// are alone are left out.
pub(crate) fn clusters(roots: &[Root]) -> Vec<Vec<usize>> {
    let pairs = (0..roots.len()).flat_map(|b| (0..b).map(move |a| [a, b]));
    let near = pairs.filter(|[a, b]| meet(&roots[*a], &roots[*b]));
    pieces(roots.len(), near, 0..roots.len()).into_iter().filter(|cluster| cluster.len() > 1).collect()
}

/// Whether two roots are apart by no more than the rounding of the determinant's coefficients may put between them.
fn meet(a: &Root, b: &Root) -> bool {
    let apart = (a.z / b.z).ln().norm();
    apart <= a.rounding().max(b.rounding()).min(FARTHEST)
}

/// The roots `z_a` of a cluster on the matrix, as many as there were: the other factor and the place where to begin are
/// those of `z`. `None` where the matrix has fewer null vectors than the cluster has roots, so that it knows them no
/// better, or Newton's method does not settle.
pub(crate) fn on_matrix(rigidity: &Rigidity, mut z: [Complex<f64>; 2], a: usize, count: usize) -> Option<Vec<Root>> {
    let start = z[a];
    for _ in 0..STEPS {
        let step = Steps::at(rigidity, z, a, count)?;
        z[a] *= step.mean().exp();
        if !((z[a] / start).ln().norm() <= FARTHEST) {
            return None;
        }
        if step.mean().norm() <= step.rounding() {
            return Steps::at(rigidity, z, a, count)?.roots(rigidity, z, a);
        }
    }
    None
}

/// The root of a multiplicity `count` near `start`, along `z_b` at `z_a = exp(i q)`, of a determinant whose matrix may
/// have fewer null vectors there.
///
/// Where `p` has such a root, its derivative of order `count - 1` by `log z` has a simple one, which the coefficients
/// know to all digits. `None` where one of the lower derivatives is there more than the rounding of the coefficients.
pub(crate) fn of_polynomial(
    polynomial: &Laurent,
    (a, q): (usize, f64),
    start: Complex<f64>,
    count: usize,
) -> Option<Root> {
    let (coefficients, sizes) = (polynomial.along(a, q), polynomial.sizes(a));
    let largest = polynomial.largest();
    let derivative = |z: Complex<f64>, order: usize| -> (Complex<f64>, f64) {
        let (mut value, mut size) = (Complex::ZERO, 0.0);
        for (k, (c, bound)) in coefficients.iter().zip(&sizes).enumerate() {
            let power = polynomial.lowest[1 - a] + k as f64;
            let factor = z.powf(power) * power.powi(order as i32);
            value += c * factor;
            // every coefficient carries the rounding of the largest
            size += bound.max(largest) * factor.norm();
        }
        (value, size)
    };
    let mut z = start;
    for _ in 0..STEPS {
        let step: Complex<f64> = -derivative(z, count - 1).0 / derivative(z, count).0;
        z *= step.exp();
    }
    let vanishes = |order: usize| {
        let (value, size) = derivative(z, order);
        value.norm() <= ROUNDINGS * f64::EPSILON * size
    };
    let near = (z / start).ln().norm() <= FARTHEST;
    let condition = derivative(z, count - 1).1 / derivative(z, count).0.norm();
    (near && condition.is_finite() && (0..count).all(vanishes)).then_some(Root { z, condition, multiplicity: count })
}

/// Whether the matrix has a null vector up to rounding.
pub(crate) fn is_singular(rigidity: &Rigidity, z: [Complex<f64>; 2]) -> bool {
    let values = full_svd(&rigidity.at(z)).map(|found| found.singular_values).unwrap_or_default();
    let ends = values.first().zip(values.last());
    ends.is_some_and(|(most, least)| *least <= ROUNDINGS * f64::EPSILON * most.max(TERM))
}

/// Newton steps from one place to all roots of a cluster.
struct Steps {
    /// Changes of `log z`.
    all: Vec<Complex<f64>>,
    /// Change of `log z` per relative change of the entries of the matrix.
    condition: f64,
}

impl Steps {
    fn at(rigidity: &Rigidity, z: [Complex<f64>; 2], a: usize, count: usize) -> Option<Self> {
        let (mut matrix, mut slope) = (rigidity.at(z), rigidity.derivative(z, a) * z[a]);
        for (k, scale) in rigidity.scales(z).into_iter().enumerate() {
            matrix.row_mut(k).scale_mut(scale);
            slope.row_mut(k).scale_mut(scale);
        }
        let Svd { u, singular_values, v } = full_svd(&matrix).ok()?;
        let first = singular_values.len().checked_sub(count)?;
        let slope = u.columns(first, count).adjoint() * slope * v.columns(first, count);
        let value = |k: usize| Complex::new(singular_values[first + k], 0.0);
        let diagonal = ComplexMatrix::from_fn(count, count, |i, j| if i == j { value(i) } else { Complex::ZERO });
        let least = *full_svd(&slope).ok()?.singular_values.last()?;
        let all = eigenvalues(&(-inverse(slope)? * diagonal)).ok()?;
        let condition = singular_values[0] / least;
        (condition.is_finite() && all.iter().all(|step| step.norm() <= FARTHEST)).then_some(Self { all, condition })
    }

    fn mean(&self) -> Complex<f64> {
        self.all.iter().sum::<Complex<f64>>() / self.all.len() as f64
    }

    /// How well `log z` is known.
    fn rounding(&self) -> f64 {
        ROUNDINGS * f64::EPSILON * self.condition.max(1.0)
    }

    /// The roots: one of this multiplicity where they agree as far as the matrix tells, else each sought by itself. `None`
    /// where these are not apart by more than their rounding.
    fn roots(&self, rigidity: &Rigidity, z: [Complex<f64>; 2], a: usize) -> Option<Vec<Root>> {
        if self.all.iter().all(|step| step.norm() <= self.rounding()) {
            let root = Root { z: z[a], condition: self.condition, multiplicity: self.all.len() };
            return Some(vec![root; self.all.len()]);
        }
        let mut search = SingularSearch::new(rigidity);
        let near = |step: &Complex<f64>| {
            let mut at = z;
            at[a] *= step.exp();
            search.root(at, a)
        };
        let roots: Vec<Root> = self.all.iter().map(near).collect::<Option<_>>()?;
        clusters(&roots).is_empty().then_some(roots)
    }
}
