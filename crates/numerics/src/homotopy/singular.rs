//! The singular points of a curve of solutions: `m` quadrics in `m + 2` homogeneous unknowns.
//!
//! A random linear space misses them, and an isolated real point of a curve is always one of them. With a random frame
//! `N` of `m` columns the points where `D(x) = det(dF/dx N)` vanishes are those where the projection of the curve along
//! `N` to a line is ramified, and its singular points, whatever `N` is. `D` has degree `m`, so there are `m 2^m` such
//! points, and the homotopy
//!
//! `F(x) = 0, (1 - t) D(x) + t g l_1(x) ... l_m(x) = 0`
//!
//! begins at the points of the curve on `m` random planes `l_k = 0` (regeneration: J. D. Hauenstein, A. J. Sommese and
//! C. W. Wampler, "Regeneration homotopies for solving systems of polynomials", Mathematics of Computation 80, 345,
//! 2011). Singular points are those ends where the Jacobian of `F` has not its full rank. A second choice of `N`
//! confirms them.

use super::endgame::{HomotopyEnd, Simple, Target, attempted, ends};
use super::error::HomotopyError;
use super::sections::{on_linear_space, random_frame};
use super::solutions::{SAME_SOLUTION_DISTANCE, conjugate, grouped, turned};
use super::system::{C, Homotopy, HomotopyDerivatives, Quadrics, distance, unit};
use crate::DenseMatrix;
use crate::complex::{ComplexMatrix, determinant};
use crate::dense::{full_svd, symmetric_eigenvalues};
use nalgebra::{Complex, DVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Singular value of the Jacobian below which it counts as zero.
const ZERO: f64 = 1e-6;

/// A point, and the estimated distance to the exact one.
type Estimate = (Vec<C>, f64);

/// A real singular point of a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct SingularPoint {
    /// A vector of norm 1, its largest entry positive.
    pub point: Vec<f64>,
    /// Whether no real branch of the curve goes through it: both its tangents are complex.
    pub isolated: bool,
    /// Estimated distance to the exact point.
    pub error: f64,
}

/// The real singular points of the curve of solutions of `m` quadrics in `m + 2` homogeneous unknowns.
///
/// `None` where some of the curve is counted twice or more: all of that is singular. Points where more than two
/// branches meet are not called isolated.
///
/// # Errors
/// [`HomotopyError`]: the quadrics do not fit the unknowns, or their solutions cannot be followed.
pub fn real_singular_points(quadrics: &[DenseMatrix]) -> Result<Option<Vec<SingularPoint>>, HomotopyError> {
    let count = quadrics.len();
    let quadrics = Quadrics::new(quadrics, count + 2)?;
    let found = attempted(|attempt| confirmed(&quadrics, attempt))?;
    Ok(found.map(|points| points.into_iter().map(|(point, error)| described(&quadrics, point, error)).collect()))
}

/// Real points that two choices of random numbers have in common.
fn confirmed(quadrics: &Quadrics, attempt: u32) -> Result<Option<Vec<Estimate>>, HomotopyError> {
    let [first, second] = [0, 1].map(|choice| singular_points(quadrics, attempt, choice));
    let (Some(first), Some(second)) = (first?, second?) else { return Ok(None) };
    let near = |a: &[C], b: &[C]| distance(a, b) <= SAME_SOLUTION_DISTANCE;
    let real = first.into_iter().filter(|(point, _)| near(point, &conjugate(point)));
    Ok(Some(real.filter(|(point, _)| second.iter().any(|(other, _)| near(point, other))).collect()))
}

/// Singular ends of all paths, each once; `None` where a plane meets the curve in multiple points.
fn singular_points(quadrics: &Quadrics, attempt: u32, choice: u64) -> Result<Option<Vec<Estimate>>, HomotopyError> {
    let mut random = ChaCha8Rng::seed_from_u64(1 + 2 * u64::from(attempt) + choice);
    let mut starts = Vec::new();
    let mut planes = Vec::new();
    for _ in 0..quadrics.count() {
        let frame = random_frame(quadrics.unknowns, quadrics.unknowns, &mut random);
        let (plane, inside) = (frame.column(0).into_owned(), frame.columns(1, quadrics.unknowns - 1).into_owned());
        let solutions = on_linear_space(quadrics, &inside)?;
        if solutions.isolated.len() < solutions.paths {
            return Ok(None);
        }
        starts.extend(solutions.isolated.into_iter().map(|solution| solution.point));
        planes.push(plane);
    }
    let frame = random_frame(quadrics.unknowns, quadrics.count(), &mut random);
    let polar = Polar { quadrics, frame, planes, factor: unit(&mut random) };
    let singular = ends(&polar, &starts, attempt)?.into_iter().filter_map(|end| match end {
        HomotopyEnd::Singular { point, error } => Some((point, error)),
        HomotopyEnd::Simple(_) => None,
    });
    Ok(Some(grouped(singular).into_iter().map(|group| (group.point, group.error)).collect()))
}

/// `F` and the polar equation.
struct Polar<'a> {
    quadrics: &'a Quadrics,
    /// Orthonormal columns `N`.
    frame: DenseMatrix,
    planes: Vec<DVector<f64>>,
    factor: C,
}

impl Polar<'_> {
    /// `D` and its gradient, from the rows `dF_k/dx`: `dD = sum_k dF_k'(dx) N . cofactors_k`, with `dF_k' = 2 A_k dx`.
    fn determinant(&self, rows: &[C]) -> (C, Vec<C>) {
        let (n, count) = (self.quadrics.unknowns, self.quadrics.count());
        let entry = |row: usize, column: usize| -> C {
            self.frame.column(column).iter().zip(&rows[row * n..]).map(|(a, b)| b * *a).sum()
        };
        let matrix: Vec<C> = (0..count * count).map(|place| entry(place / count, place % count)).collect();
        let (mut value, mut gradient) = (C::default(), vec![C::default(); n]);
        for (k, a) in self.quadrics.matrices.iter().enumerate() {
            let cofactors: Vec<C> = (0..count).map(|column| cofactor(&matrix, count, k, column)).collect();
            if k == 0 {
                value = cofactors.iter().zip(&matrix).map(|(c, entry)| c * entry).sum();
            }
            let lifted: Vec<C> =
                self.frame.row_iter().map(|row| row.iter().zip(&cofactors).map(|(a, c)| c * *a).sum()).collect();
            for (entry, column) in gradient.iter_mut().zip(a.column_iter()) {
                *entry += column.iter().zip(&lifted).map(|(a, c)| c * (2.0 * a)).sum::<C>();
            }
        }
        (value, gradient)
    }

    /// The product of the planes and its gradient.
    fn product(&self, x: &[C]) -> (C, Vec<C>) {
        let values: Vec<C> = self.planes.iter().map(|plane| plane.iter().zip(x).map(|(a, x)| x * *a).sum()).collect();
        let mut gradient = vec![C::default(); x.len()];
        for (k, plane) in self.planes.iter().enumerate() {
            let others: C =
                values.iter().enumerate().filter(|(other, _)| *other != k).map(|(_, value)| value).product();
            gradient.iter_mut().zip(plane.iter()).for_each(|(sum, a)| *sum += others * *a);
        }
        (values.iter().product(), gradient)
    }
}

/// The determinant without a row and a column, with its sign.
fn cofactor(matrix: &[C], n: usize, row: usize, column: usize) -> C {
    let kept = matrix.iter().enumerate().filter(|(k, _)| k / n != row && k % n != column).map(|(_, entry)| *entry);
    let sign = if (row + column).is_multiple_of(2) { 1.0 } else { -1.0 };
    determinant(ComplexMatrix::from_row_iterator(n - 1, n - 1, kept)) * sign
}

impl Homotopy for Polar<'_> {
    fn quadrics(&self) -> &Quadrics {
        self.quadrics
    }

    fn evaluate(&self, x: &[C], t: C, at: &mut HomotopyDerivatives) {
        let (n, count) = (x.len(), self.quadrics.count());
        self.quadrics.evaluate(x, &mut at.value[..count], &mut at.jacobian[..count * n]);
        at.rate.fill(C::default());
        let (polar, polar_gradient) = self.determinant(&at.jacobian);
        let (planes, planes_gradient) = self.product(x);
        let rest = C::new(1.0, 0.0) - t;
        at.value[count] = rest * polar + t * self.factor * planes;
        at.rate[count] = self.factor * planes - polar;
        let row = at.jacobian[count * n..].iter_mut().zip(polar_gradient.iter().zip(&planes_gradient));
        row.for_each(|(entry, (polar, planes))| *entry = rest * polar + t * self.factor * planes);
    }
}

impl Target for Polar<'_> {
    /// A point where the curve is smooth.
    fn simple(&self, x: &[C]) -> Option<Simple> {
        let (n, count) = (x.len(), self.quadrics.count());
        let (mut value, mut jacobian) = (vec![C::default(); count], vec![C::default(); count * n]);
        self.quadrics.evaluate(x, &mut value, &mut jacobian);
        let matrix = nalgebra::DMatrix::from_row_slice(count, n, &jacobian);
        let smallest = matrix.singular_values().min();
        (smallest > ZERO).then(|| Simple { point: x.to_vec(), error: 0.0, separation: 0.0 })
    }
}

/// A real point, and whether the quadratic form on its two tangent directions is definite.
fn described(quadrics: &Quadrics, point: Vec<C>, error: f64) -> SingularPoint {
    let point: Vec<f64> = turned(point, true).iter().map(|entry: &Complex<f64>| entry.re).collect();
    let isolated = definite(quadrics, &DVector::from_column_slice(&point)).unwrap_or(false);
    SingularPoint { point, isolated, error }
}

fn definite(quadrics: &Quadrics, x: &DVector<f64>) -> Option<bool> {
    let (count, n) = (quadrics.count(), quadrics.unknowns);
    let mut jacobian = DenseMatrix::zeros(count + 1, n);
    quadrics.matrices.iter().zip(jacobian.row_iter_mut()).for_each(|(a, mut row)| row.copy_from(&(a * x).transpose()));
    jacobian.row_mut(count).copy_from(&x.transpose());
    let svd = full_svd(&jacobian).ok()?;
    let rank = svd.singular_values.iter().filter(|value| **value > ZERO).count();
    if rank != count {
        return Some(false);
    }
    let tangents = svd.v.columns(rank, n - rank);
    let weights = svd.u.column(count);
    let form: DenseMatrix = quadrics.matrices.iter().zip(weights.iter()).map(|(a, weight)| a * *weight).sum();
    let values = symmetric_eigenvalues(&(tangents.transpose() * form * tangents)).ok()?;
    let (least, most) = (values.first()?, values.last()?);
    Some(least * most > ZERO * least.abs().max(most.abs()).powi(2))
}
