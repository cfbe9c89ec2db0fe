//! The multiplicity of a solution from the equations around it alone; no path is asked.
//!
//! In an affine patch the solution is the origin. Where the Jacobian has rank `r`, `r` of the equations give `r`
//! unknowns as power series of the other `z`; what is left are series `g(z)` without linear terms. The multiplicity is
//! the dimension of power series modulo the `g`: of monomials up to degree `k` less the rank of all products `z^a g_j`
//! cut off there, as soon as this number stays the same from one `k` to the next (F. S. Macaulay, "The algebraic theory
//! of modular systems", 1916; B. H. Dayton and Z. Zeng, "Computing the multiplicity structure in solving polynomial
//! systems", ISSAC 2005). Around a solution that is not isolated it never stays the same. There it grows beyond any
//! number of paths, and a solution where it is larger than the number of paths that end there is not isolated (D. J.
//! Bates, J. D. Hauenstein, C. Peterson and A. J. Sommese, "A numerical local dimension test", SIAM J. Numer. Anal. 47,
//! 3608, 2009).

use super::elimination;
use super::series::{Monomials, Series};
use super::system::{C, Quadrics};
use nalgebra::{DMatrix, SVD};

type Matrix = DMatrix<C>;

/// Singular values of the Jacobian below this are zero, and so are coefficients of the series.
const ZERO: f64 = 1e-6;
/// More monomials than these are not looked at.
const MOST_MONOMIALS: usize = 500;

/// The multiplicity of a solution, by the equations around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Multiplicity {
    Isolated(usize),
    /// Larger than the limit that was given.
    Larger,
    /// The multiplicity needs more monomials than are looked at.
    Unknown,
}

/// The multiplicity of a solution of norm 1, of quadrics as many as unknowns less one or more.
pub(super) fn multiplicity(quadrics: &Quadrics, x: &[C], limit: usize) -> Multiplicity {
    let Some(split) = Split::new(quadrics, x) else { return Multiplicity::Unknown };
    let mut before = 1;
    for degree in 1.. {
        if before > limit {
            return Multiplicity::Larger;
        }
        if Monomials::count(split.kernel.ncols(), degree) > MOST_MONOMIALS {
            return Multiplicity::Unknown;
        }
        let now = split.dual_dimension(degree);
        if now == before {
            break;
        }
        before = now;
    }
    Multiplicity::Isolated(before)
}

/// The equations in the patch of a solution, unknowns and equations parted by the Jacobian.
struct Split {
    /// Quadratic parts.
    forms: Vec<Matrix>,
    /// The unknowns without linear part, as columns.
    kernel: Matrix,
    /// The other unknowns, `rest * z'` with `z'` of the power series.
    rest: Matrix,
    /// Takes quadratic parts of the equations to the unknowns of `rest`.
    solve: Matrix,
    /// Takes the equations to those without linear part.
    project: Matrix,
}

impl Split {
    fn new(quadrics: &Quadrics, x: &[C]) -> Option<Self> {
        let patch = complement(x);
        let point = Matrix::from_column_slice(x.len(), 1, x);
        let matrices: Vec<Matrix> = quadrics.matrices.iter().map(|a| a.map(|entry| C::new(entry, 0.0))).collect();
        let mut jacobian = Matrix::zeros(matrices.len(), patch.ncols());
        for (mut row, a) in jacobian.row_iter_mut().zip(&matrices) {
            row.copy_from(&((point.transpose() * a * &patch) * C::new(2.0, 0.0)));
        }
        let svd = SVD::try_new(jacobian, true, true, f64::EPSILON, 1000)?;
        let rank = svd.singular_values.iter().filter(|value| **value > ZERO).count();
        let (left, right) = (svd.u?.columns(0, rank).into_owned(), svd.v_t?.adjoint());
        let inverse = Matrix::from_diagonal(&svd.singular_values.rows(0, rank).map(|value| C::new(-1.0 / value, 0.0)));
        Some(Self {
            forms: matrices.iter().map(|a| patch.transpose() * a * &patch).collect(),
            kernel: right.columns(rank, right.ncols() - rank).into_owned(),
            rest: right.columns(0, rank).into_owned(),
            solve: inverse * left.adjoint(),
            project: Matrix::identity(matrices.len(), matrices.len()) - &left * left.adjoint(),
        })
    }

    /// Dimension of power series modulo the equations, all cut off at a degree.
    fn dual_dimension(&self, degree: usize) -> usize {
        let monomials = Monomials::new(self.kernel.ncols(), degree);
        let left_over = combine(&self.project, &self.quadratic_parts(&monomials, degree), &monomials);
        let mut rows = Vec::new();
        for monomial in (0..monomials.degrees.len()).filter(|&k| monomials.degrees[k] + 2 <= degree) {
            for series in &left_over {
                let mut row = monomials.zero();
                monomials.add_shifted(&mut row, C::new(1.0, 0.0), monomial, series);
                rows.push(row);
            }
        }
        let small = |row: &Series| row.iter().all(|entry| entry.norm() <= ZERO);
        rows.retain(|row| !small(row));
        monomials.degrees.len() - elimination::rank(&rows, ZERO)
    }

    /// The quadratic parts of the equations as series, with the unknowns of `rest` solved for.
    fn quadratic_parts(&self, monomials: &Monomials, degree: usize) -> Vec<Series> {
        let mut rest = vec![monomials.zero(); self.rest.ncols()];
        let mut parts = Vec::new();
        // each time one more degree of `rest` is right, degree 2 the first time
        for _ in 1..degree.max(2) {
            let unknowns = self.unknowns(&rest, monomials);
            parts = self.forms.iter().map(|form| value(form, &unknowns, monomials)).collect();
            rest = combine(&self.solve, &parts, monomials);
        }
        parts
    }

    /// `kernel * z + rest`: the unknowns of degree 1 are the monomials after the first.
    fn unknowns(&self, rest: &[Series], monomials: &Monomials) -> Vec<Series> {
        let mut unknowns = combine(&self.rest, rest, monomials);
        for (series, row) in unknowns.iter_mut().zip(self.kernel.row_iter()) {
            row.iter().enumerate().for_each(|(k, entry)| series[1 + k] += entry);
        }
        unknowns
    }
}

/// An orthonormal basis of the vectors `y` with `x^H y = 0`: columns of a Householder reflection.
fn complement(x: &[C]) -> Matrix {
    let phase = if x[0] == C::default() { C::new(1.0, 0.0) } else { x[0] / x[0].norm() };
    let mut v = Matrix::from_column_slice(x.len(), 1, x);
    v[0] += phase;
    let scale = C::new(2.0 / v.norm_squared(), 0.0);
    let reflection = Matrix::identity(x.len(), x.len()) - (&v * v.adjoint()) * scale;
    reflection.columns(1, x.len() - 1).into_owned()
}

/// The value of a quadratic form at series.
fn value(form: &Matrix, unknowns: &[Series], monomials: &Monomials) -> Series {
    let mut sum = monomials.zero();
    for (series, product) in unknowns.iter().zip(&combine(form, unknowns, monomials)) {
        monomials.add_product(&mut sum, series, product);
    }
    sum
}

/// `matrix * series`, every series an entry of the vector.
fn combine(matrix: &Matrix, series: &[Series], monomials: &Monomials) -> Vec<Series> {
    let mut sums = vec![monomials.zero(); matrix.nrows()];
    for (sum, row) in sums.iter_mut().zip(matrix.row_iter()) {
        for (factor, series) in row.iter().zip(series) {
            sum.iter_mut().zip(series).for_each(|(a, b)| *a += factor * b);
        }
    }
    sums
}
