//! The lowest eigenvalues of the energy's Hessian at a state, dense or by iteration.
//!
//! The Hessian is that of the whole energy: tensions of bars add their geometric stiffness. Its unknowns may be given
//! factors, `x_k = factor_k y_k`: with the inverse square roots of masses the eigenvalues by `y` are squared
//! frequencies.

use super::error::{DENSE_EIGENVALUES, ModesError, SPARSE_EIGENVALUES};
use crate::model::Model;
use crate::numerics::factor::FactorError;
use crate::numerics::sparse::symmetric_product;
use crate::numerics::vector::{dot, max_abs, normalize};
use crate::numerics::{DenseMatrix, dense, eigen};
use crate::solver::{HessianKind, Linearization, Problem, Tangent};

/// Rigidity matrices of more rows or columns than this are not decomposed dense.
pub const DENSE_LIMIT: usize = 1200;
/// Most shifts of the Hessian that are tried, each four times the last.
const SHIFTS: i32 = 30;

/// Called between the parts of the work; returns false to stop.
pub type Observer<'a> = dyn FnMut() -> bool + Send + 'a;

pub(super) fn go_on(observe: &mut Observer<'_>) -> Result<(), ModesError> {
    if observe() { Ok(()) } else { Err(ModesError::Interrupted) }
}

/// The lower end of a spectrum.
#[derive(Default)]
pub(super) struct Spectrum {
    /// Eigenvalues, ascending.
    pub values: Vec<f64>,
    /// Velocities of all coordinates, one list for each eigenvalue; those of the substituted unknowns have norm 1.
    pub vectors: Vec<Vec<f64>>,
    /// Eigenvalues that are smaller in magnitude are zero up to rounding.
    pub rounding: f64,
}

/// Returns the linearization of a model at its reference state, with these tensions of its stiff measures.
pub(super) fn linearized(model: &Model, tension: &[f64]) -> Linearization {
    let mut at = Linearization::new(model.layout());
    model.linearize(&model.start(), tension, HessianKind::Full, &mut at);
    at
}

/// Eigenvalues and eigenvectors, and the largest diagonal entry of the matrix.
type Pairs = (Vec<f64>, Vec<Vec<f64>>, f64);

/// Whether the dense way finds this number of eigenpairs of a model, of which at most `free` are finite: else the
/// iteration does.
///
/// # Errors
/// [`ModesError::TooManyEigenvalues`] where neither does.
pub fn decomposed_dense(unknowns: usize, wanted: usize, free: usize) -> Result<bool, ModesError> {
    // the iteration works on 4 wanted + 64 vectors, of which there must be so many; and it cannot find more than there
    // are
    let iterated = wanted <= SPARSE_EIGENVALUES && 4 * wanted + 64 <= unknowns;
    if unknowns <= DENSE_LIMIT {
        Ok(true)
    } else if unknowns <= DENSE_EIGENVALUES {
        Ok(!iterated || wanted >= free)
    } else if iterated {
        Ok(false)
    } else {
        Err(ModesError::TooManyEigenvalues { wanted, unknowns })
    }
}

/// Other unknowns `y` by which some of them are substituted, `x = factor * map * y`, as motions of a rigid part that its
/// mass couples.
pub(super) struct Coupling {
    pub unknowns: Vec<usize>,
    pub map: DenseMatrix,
}

/// The map from all unknowns `y` to all unknowns `x`, without the factors.
fn substitution(couplings: &[Coupling], unknowns: usize) -> DenseMatrix {
    let mut whole = DenseMatrix::identity(unknowns, unknowns);
    for Coupling { unknowns, map } in couplings {
        for (row, &i) in unknowns.iter().enumerate() {
            unknowns.iter().enumerate().for_each(|(column, &j)| whole[(i, j)] = map[(row, column)]);
        }
    }
    whole
}

/// Lowest eigenvalues and eigenvectors of the energy's Hessian, by unknowns with these factors and couplings, at the
/// model's reference state with these tensions, on what the rigid terms leave free, which is at most `free`.
///
/// # Errors
/// [`ModesError::CoupledMotions`] where the dense way does not find them, which alone knows couplings.
pub(super) fn lowest(
    (model, tension): (&Model, &[f64]),
    (factors, couplings): (&[f64], &[Coupling]),
    (wanted, free): (usize, usize),
    observe: &mut Observer<'_>,
) -> Result<Spectrum, ModesError> {
    let unknowns = model.layout().unknowns;
    let (at, count) = ((model, tension), wanted.min(free));
    let (values, vectors, diagonal) = if decomposed_dense(unknowns, count, free)? {
        lowest_dense(at, (factors, couplings), count, observe)?
    } else if couplings.is_empty() {
        lowest_sparse(at, factors, count, observe)?
    } else {
        return Err(ModesError::CoupledMotions);
    };
    let velocity = |v: &Vec<f64>| model.velocity(&v.iter().zip(factors).map(|(y, f)| y * f).collect::<Vec<f64>>());
    let rounding = dense::eigenvalue_rounding(unknowns, diagonal);
    Ok(Spectrum { values, vectors: vectors.iter().map(velocity).collect(), rounding })
}

/// Entries of the Hessian of the whole energy, bars of finite stiffness included.
pub(super) fn whole_hessian(at: &Linearization, compliance: &[f64]) -> Vec<f64> {
    let mut values = at.hessian.clone();
    for (row, c) in compliance.iter().enumerate().filter(|(_, c)| **c > 0.0) {
        at.add_outer(row, 1.0 / c, &mut values);
    }
    values
}

fn lowest_dense(
    (model, tension): (&Model, &[f64]),
    (factors, couplings): (&[f64], &[Coupling]),
    count: usize,
    observe: &mut Observer<'_>,
) -> Result<Pairs, ModesError> {
    go_on(observe)?;
    let (layout, mut at) = (model.layout(), linearized(model, tension));
    at.substitute(factors);
    let compliance = model.compliance();
    let values = whole_hessian(&at, compliance);
    let mut hessian = at.pattern().to_dense(&values);
    let mut full = dense::from_rows(&at.rows(), layout.unknowns);
    let map = Some(substitution(couplings, layout.unknowns)).filter(|_| !couplings.is_empty());
    if let Some(map) = &map {
        full *= map;
        hessian = map.tr_mul(&(hessian * map));
    }
    let rigid: Vec<usize> = (0..compliance.len()).filter(|&row| compliance[row] == 0.0).collect();
    let free = if rigid.is_empty() {
        DenseMatrix::identity(layout.unknowns, layout.unknowns)
    } else {
        dense::null_space_of_sums(&full.select_rows(&rigid), max_abs(at.rows().values))?.basis
    };
    go_on(observe)?;
    let found = dense::symmetric_eigen(&(free.transpose() * hessian * &free))?;
    let count = count.min(found.values.len());
    let free = match map {
        Some(map) => map * free,
        None => free,
    };
    let vectors = (0..count).map(|k| (&free * found.vectors.column(k)).as_slice().to_vec()).collect();
    Ok((found.values[..count].to_vec(), vectors, at.pattern().largest_diagonal(&values)))
}

/// Returns the lowest eigenvalues of the Hessian `H` on the null space of the rigid measures, and their vectors. They
/// are found by shift and invert, as the largest eigenvalues of `(H + shift)^-1`.
fn lowest_sparse(
    (model, tension): (&Model, &[f64]),
    factors: &[f64],
    count: usize,
    observe: &mut Observer<'_>,
) -> Result<Pairs, ModesError> {
    let layout = model.layout();
    let zero = vec![0.0; layout.stiff.len()];
    let mut tangent = Tangent::at_state(model, &model.start(), tension, HessianKind::Full)?;
    tangent.at.substitute(factors);
    let diagonal = tangent.at.pattern().largest_diagonal(&whole_hessian(&tangent.at, model.compliance()));
    let unit = tangent.at.pattern().largest_diagonal(&tangent.at.hessian);
    let (mut shift, mut powers) = (0.0, 0..SHIFTS);
    loop {
        // without a shift that makes the Hessian positive, the largest eigenvalues of its inverse are not the lowest of
        // its own
        let power = powers.next().ok_or(FactorError::Singular { ratio: 0.0 })?;
        let next = 1e-7 * unit * 4f64.powi(power);
        go_on(observe)?;
        tangent.at.add_identity(next - shift);
        shift = next;
        if tangent.factor(0.0).is_ok_and(|inertia| inertia.negative == 0) {
            break;
        }
    }
    let mut inverse = |v: &[f64]| tangent.solve(v, &zero, 1e-13).dx;
    let (_, vectors) = eigen::largest(layout.unknowns, count, |v| observe().then(|| inverse(v)))?;
    // once more, since Lanczos vectors are only as good as the largest eigenvalue of the inverse allows
    let mut vectors: Vec<Vec<f64>> = vectors.iter().map(|v| inverse(v)).collect();
    vectors.iter_mut().for_each(|v| normalize(v));
    tangent.at.add_identity(-shift);
    let quotient = |v: &[f64]| rayleigh_quotient(model, &tangent.at, v);
    let mut pairs: Vec<(f64, Vec<f64>)> = vectors.into_iter().map(|v| (quotient(&v), v)).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (values, vectors) = pairs.into_iter().unzip();
    Ok((values, vectors, diagonal))
}

/// `v^T H v / v^T v` with the Hessian of the whole energy: its error is that of the vector squared.
fn rayleigh_quotient(model: &Model, at: &Linearization, v: &[f64]) -> f64 {
    let mut product = vec![0.0; v.len()];
    symmetric_product(at.pattern(), &at.hessian, v, &mut product);
    let mut stretch = vec![0.0; model.compliance().len()];
    at.rows().product(v, &mut stretch);
    let finite = stretch.iter().zip(model.compliance()).filter(|(_, c)| **c > 0.0);
    (dot(v, &product) + finite.map(|(s, c)| s * s / c).sum::<f64>()) / dot(v, v)
}
