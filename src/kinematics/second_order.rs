//! The obstruction quadrics of a state, which linear folding motions must satisfy to extend to second order.
//!
//! A linear motion `v = N x`, `N` a basis of the null space of the closure Jacobian `J`, moves the angles by
//! `s v + s^2 w`. The faces close to second order if `J w + B(v, v) = 0` with the second-order closure `B`. A solution
//! `w` exists if the left null vectors `y`, `y^T J = 0`, satisfy `x^T A_y x = 0` with
//! `A_y = sum_row y_row N^T B_row N`. A spatially periodic state that is not flat has 3 modes and one independent
//! quadric, that of the loop: `Omega_1 x Omega_2` along the normal. A flat developable state has `Nv + 2` modes and
//! `Nv` quadrics, one for each vertex; the loop is their sum.

use super::closure::DIRECTION;
use super::folding_modes::with_zero_rates;
use super::{Closure, KinematicsError};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::small::orthonormal_triangular;
use crate::numerics::dense::{Svd, full_svd, null_space_of_sums, rank_of_sums, symmetric_eigenvalues};
use crate::numerics::vector::max_abs;

/// Largest closure residual of a state whose directions are computed.
const CLOSURE_RESIDUAL: f64 = 1e-9;

/// Eigenvalues below this fraction of the largest one count as zero in a signature.
const ZERO: f64 = 1e-9;

/// The linear motions of a state, and the quadrics that they must satisfy to extend to second order.
#[derive(Clone, Debug)]
pub struct SecondOrder {
    /// Orthonormal linear motions as columns, `Ne x n`: rates of all fold angles, zero at locked edges and on the rim.
    pub modes: DenseMatrix,
    /// The obstruction along each vector of an orthonormal basis of left null vectors: symmetric `n x n` matrices.
    pub forms: Vec<DenseMatrix>,
    /// Orthonormal matrices (as vectors of their entries) with the same span as the forms: the independent quadrics.
    pub quadrics: Vec<DenseMatrix>,
    /// Ratio of the smallest singular value that counts as nonzero to the largest one that counts as zero, of the
    /// closure Jacobian and of the list of forms.
    pub gaps: [f64; 2],
}

impl SecondOrder {
    /// Computes the motions and quadrics of a closed state. `angles` holds the fold angle of every edge in radians; the
    /// locked edges of the closure keep their angles.
    ///
    /// # Errors
    /// [`KinematicsError`] if the state does not close to 1e-9, or if a rank is not clear.
    ///
    /// # Panics
    /// If the length of `angles` is not the number of edges.
    pub fn new(closure: &Closure, angles: &[f64]) -> Result<Self, KinematicsError> {
        let residual = closure.residual(angles).amax();
        let closed = closure.rows() == 0 || residual <= CLOSURE_RESIDUAL;
        if !closed {
            return Err(KinematicsError::NotClosed { residual });
        }
        let right = closure.motions(angles)?;
        let left = null_space_of_sums(&closure.jacobian(angles).transpose(), DIRECTION)?.basis;
        let modes = with_zero_rates(angles.len(), closure.folding_edges(), &right.basis);
        let parts = closure.second_order(angles, &modes);
        let along = |y: &[f64]| -> DenseMatrix {
            let zero = DenseMatrix::zeros(modes.ncols(), modes.ncols());
            y.iter().zip(&parts).fold(zero, |sum, (weight, part)| sum + part * *weight)
        };
        let forms: Vec<DenseMatrix> = left.column_iter().map(|y| along(y.as_slice())).collect();
        let (quadrics, gap) = independent(&forms)?;
        Ok(Self { modes, forms, quadrics, gaps: [right.gap, gap] })
    }

    /// Whether the one quadric is definite across one null direction, which is then the only real one: that of a motion
    /// without curvature, along which the states stay spatially periodic, as in the planar folding of a triangulated
    /// Miura-ori.
    pub(crate) fn one_direction_is_real(&self) -> Result<bool, KinematicsError> {
        let [quadric] = &self.quadrics[..] else { return Ok(false) };
        let [positive, negative, zero] = signature(quadric)?;
        Ok(zero == 1 && (positive == 0) != (negative == 0))
    }

    /// Number of linear motions.
    pub fn count(&self) -> usize {
        self.modes.ncols()
    }
}

/// Returns orthonormal matrices with the span of the forms, and the gap between the singular values that count as
/// nonzero and as zero.
///
/// The motions have norm 1, so that forms are sums of terms of the size of the [`DIRECTION`] of an edge.
fn independent(forms: &[DenseMatrix]) -> Result<(Vec<DenseMatrix>, f64), KinematicsError> {
    let entries = forms.first().map_or(0, DenseMatrix::len);
    if entries == 0 {
        return Ok((Vec::new(), 1.0 / f64::EPSILON));
    }
    let columns = DenseMatrix::from_fn(entries, forms.len(), |entry, form| forms[form][entry]);
    let Svd { singular_values, v, .. } = full_svd(&orthonormal_triangular(columns)[1])?;
    let found = rank_of_sums(&singular_values, DIRECTION)?;
    let combined = |k: usize| -> DenseMatrix {
        let weights = v.column(k) / singular_values[k];
        forms.iter().zip(weights.iter()).map(|(form, weight)| form * *weight).sum()
    };
    Ok(((0..found.rank).map(combined).collect(), found.gap))
}

/// Returns the numbers of positive, negative and zero eigenvalues of a symmetric matrix; an eigenvalue counts as zero
/// up to 1e-9 of the largest one.
///
/// For the one quadric of a periodic state, `[2, 1, 0]` or `[1, 2, 0]` is a cone of real directions, `[3, 0, 0]` has
/// none, and `[2, 0, 1]` has one, of multiplicity two.
pub(crate) fn signature(quadric: &DenseMatrix) -> Result<[usize; 3], KinematicsError> {
    let values = symmetric_eigenvalues(quadric)?;
    let threshold = ZERO * max_abs(&values);
    let [positive, negative] = [1.0, -1.0].map(|sign| values.iter().filter(|v| sign * **v > threshold).count());
    Ok([positive, negative, values.len() - positive - negative])
}

#[cfg(test)]
mod tests {
    use super::super::test_sheets::*;
    use super::super::{drawn_fold_angles, folding_modes};
    use super::*;
    use crate::math::Vec3;
    use crate::sheet::generate::{Random, RandomDevelopable};
    use crate::sheet::{Pattern, Sheet, generate};
    use nalgebra::DVector;

    fn random_cell(size: [usize; 2], seed: u64) -> Sheet {
        generate(&Pattern::Random(Random { size, seed, ..Random::default() })).unwrap()
    }

    fn flat_cell(size: [usize; 2], seed: u64) -> Sheet {
        generate(&Pattern::RandomDevelopable(RandomDevelopable { size, seed, ..RandomDevelopable::default() })).unwrap()
    }

    /// A flat cell of 3 x 2 vertices with one vertex lifted: this vertex and its neighbours are not flat; vertex 5 is
    /// flat with all six edges around it.
    fn mixed_cell() -> Sheet {
        let mut sheet = flat_cell([4, 3], 2);
        sheet.vertices[0].z += 0.3;
        sheet
    }

    fn of(sheet: &Sheet, locked: &[usize]) -> SecondOrder {
        let closure = Closure::of_cell(sheet).unwrap().with_locked(locked);
        SecondOrder::new(&closure, &drawn_fold_angles(sheet)).unwrap()
    }

    /// Returns the second derivative of the residual along the modes, entry by entry, by extrapolated central
    /// differences.
    fn by_differences(closure: &Closure, angles: &[f64], modes: &DenseMatrix) -> Vec<DenseMatrix> {
        let residual = |x: &DVector<f64>| {
            let moved: Vec<f64> = angles.iter().zip((modes * x).iter()).map(|(angle, rate)| angle + rate).collect();
            closure.residual(&moved)
        };
        let count = modes.ncols();
        let unit = |k: usize| DVector::from_fn(count, |i, _| f64::from(i == k));
        let second = |a: usize, b: usize, h: f64| {
            let (plus, minus) = ((unit(a) + unit(b)) * h, (unit(a) - unit(b)) * h);
            (residual(&plus) + residual(&-&plus) - residual(&minus) - residual(&-&minus)) / (8.0 * h * h)
        };
        let mut parts = vec![DenseMatrix::zeros(count, count); closure.rows()];
        for (a, b) in (0..count).flat_map(|a| (0..count).map(move |b| (a, b))) {
            let found = (4.0 * second(a, b, 2e-3) - second(a, b, 4e-3)) / 3.0;
            parts.iter_mut().zip(found.iter()).for_each(|(part, entry)| part[(a, b)] = *entry);
        }
        parts
    }

    /// Claim: every entry of the second-order closure is the second derivative of the residual, at flat, folded and
    /// mixed states, also if a vertex is adjacent to its own copy, round an opening, and with locks. Tolerance 2e-9:
    /// differences of step 2e-3 have a rounding error of 1e-16 / h^2 = 3e-11 and a truncation error of h^4 = 2e-11, for
    /// matrices of size 1 with factors up to some ten.
    #[test]
    fn second_order_is_the_second_derivative() {
        let finite = [finite_grid(3, 3, 0.4), column()];
        for sheet in [open_star(), open_flat(), miura(), mixed_cell(), random_cell([1, 1], 3)].into_iter().chain(finite)
        {
            let closure = Closure::of_cell(&sheet).unwrap().with_locked(&[1]);
            let angles = drawn_fold_angles(&sheet);
            let modes =
                SecondOrder::new(&closure, &angles).map_or_else(|_| panic!("{}", sheet.title), |found| found.modes);
            let expected = by_differences(&closure, &angles, &modes);
            for (row, (found, expected)) in closure.second_order(&angles, &modes).iter().zip(&expected).enumerate() {
                let off = (found - expected).amax();
                assert!(off <= 2e-9, "{} row {row}: {off:e}", sheet.title);
            }
        }
    }

    /// Claim: periodic states that are not flat have 3 modes and one independent quadric, with the other singular
    /// values at most 1e-8 of its own, and it is the loop quadric `(Omega_1 x Omega_2) . n` up to a factor. Source:
    /// theory. Tolerance: rounding.
    #[test]
    fn periodic_states_have_the_loop_quadric() {
        let sheets = [open_star(), miura()].into_iter().chain((0..20).map(|seed| random_cell([2, 2], seed)));
        for sheet in sheets.chain((0..5).map(|seed| random_cell([3, 2], seed))) {
            let found = of(&sheet, &[]);
            assert_eq!((found.count(), found.quadrics.len()), (3, 1), "{}", sheet.description);
            assert!(found.gaps[1] >= 1e8, "{:e}", found.gaps[1]);
            let modes = folding_modes(&sheet).unwrap();
            let [l1, l2] = sheet.lattice.unwrap();
            let normal = l1.cross(&l2).normalize();
            let omega = |mode: usize, a: usize| -> Vec3 { modes.lattice_rotations[mode][a] };
            let entry = |a: usize, b: usize| {
                0.5 * (omega(a, 0).cross(&omega(b, 1)) + omega(b, 0).cross(&omega(a, 1))).dot(&normal)
            };
            let change = modes.basis.transpose() * &found.modes;
            let mut expected = change.transpose() * DenseMatrix::from_fn(3, 3, entry) * change;
            expected /= expected.norm();
            let quadric = &found.quadrics[0];
            let off = (quadric * quadric.dot(&expected).signum() - expected).amax();
            assert!(off <= 1e-8, "{off:e}");
        }
    }

    /// Claim: the loop quadric of Miura-ori has two eigenvalues of one sign and a zero; a generic cell has a cone of
    /// real directions. Source: theory (-0.125, -0.117, 0 for another normalisation, with the quotient 0.936).
    #[test]
    fn signatures() {
        let miura = of(&miura(), &[]).quadrics[0].clone();
        let mut sign = signature(&miura).unwrap();
        sign[..2].sort_unstable();
        assert_eq!(sign, [0, 2, 1]);
        let mut star = signature(&of(&open_star(), &[]).quadrics[0]).unwrap();
        star[..2].sort_unstable();
        assert_eq!(star, [1, 2, 0]);
    }

    /// Claim: flat developable states have Nv + 2 modes and Nv independent quadrics, and one mode fewer with a lock.
    /// Source: theory.
    #[test]
    fn flat_states_have_a_quadric_for_each_vertex() {
        let sheets = [open_flat(), flat_cell([3, 2], 1), flat_cell([3, 3], 4), flat_cell([2, 1], 0)];
        for sheet in sheets {
            let vertices = sheet.vertices.len();
            let free = of(&sheet, &[]);
            assert_eq!((free.count(), free.quadrics.len()), (vertices + 2, vertices), "{}", sheet.description);
            assert_eq!(of(&sheet, &[2]).count(), vertices + 1);
        }
    }

    /// Claim: on the folded cylinders of open-star two motions exist, and both extend: the states form a smooth surface
    /// there. States that do not close are refused.
    #[test]
    fn nothing_obstructs_on_a_cylinder() {
        let sheet = open_star();
        for folded in open_star_reference().cylinders(&sheet) {
            let closure = Closure::of_cell(&sheet).unwrap();
            let free = SecondOrder::new(&closure, &folded).unwrap();
            assert_eq!((free.count(), free.quadrics.len()), (2, 0));
            let mut off = folded.clone();
            off[2] += 1e-3;
            assert!(matches!(SecondOrder::new(&closure, &off), Err(KinematicsError::NotClosed { .. })));
        }
    }
}
