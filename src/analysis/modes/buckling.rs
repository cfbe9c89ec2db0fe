//! Linear buckling: the factors of the loads at which a state ceases to be stable, to first order in the loads.
//!
//! While loads grow by `l`, the forces in all elements grow by `l` times those of the linear response, and the Hessian `K`
//! by `l G`, where `G` is their geometric stiffness; the state itself is taken not to move. The sheet buckles where
//! `(K + l G) u = 0` (K.-J. Bathe, "Finite element procedures", 2014, 6.8.2). The lowest `l` are found by subspace iteration
//! with `K^-1 G` (the same, 11.6), by the solver's own factorization, which rigid and very stiff terms do not disturb; and they
//! are believed only where the count of negative eigenvalues of `K + l G` beyond them agrees (Sylvester's law).

use super::error::ModesError;
use super::spectrum::{Observer, go_on, whole_hessian};
use crate::analysis::restored::{self, Forces};
use crate::model::{Assembly, Configuration, Drive, Driven, DrivenModel, Gauge};
use crate::numerics::factor::FactorError;
use crate::numerics::sparse::symmetric_product;
use crate::numerics::vector::{dot, larger, normalize};
use crate::numerics::{DenseMatrix, dense};
use crate::solver::path::ParametrizedProblem;
use crate::solver::{HessianKind, Linearization, Problem, Residuals, Tangent};

/// Scaled unbalanced force of a state that counts as an equilibrium.
const BALANCED: f64 = 1e-8;
/// Vectors of the subspace, more than four times those wanted; models of up to so many unknowns have all.
const MORE_VECTORS: usize = 32;
const ALL_VECTORS: usize = 128;
/// Most iterations, and the relative change of factors that have converged.
const MOST_ITERATIONS: usize = 300;
const CONVERGED: f64 = 1e-12;
/// Relative residual of solutions, and the least energy of a combination of vectors of energy 1 that depend on each other.
const EXACT: f64 = 1e-14;
const DEPENDENT: f64 = 1e-12;
/// Factors that are looked for where there are fewer than wanted, relative to the last one, or to the least of loads the
/// other way.
const FAR: f64 = 1e3;
/// Part of the largest `1 / l` that may be rounding error.
const NOISE: f64 = 1e-10;
/// Part of the work of the loads on motions up to which that of a self stress is rounding error.
const INDIFFERENT: f64 = 1e-6;
/// Relative difference of factors up to which they are one factor of several motions.
const SAME_FACTOR: f64 = 1e-6;

/// The lowest critical factors of the loads, and how the sheet buckles there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Buckling {
    /// Factors of all loads, ascending: 1 are the loads as they are given. Only those above the factor of the state.
    pub factors: Vec<f64>,
    /// Velocities of all coordinates, one list for each factor; those of the unknowns have norm 1.
    pub vectors: Vec<Vec<f64>>,
}

/// Finds the lowest critical factors of the loads, as many as wanted if there are so many, of the drawn state, in which the
/// loads are zero, or of another one, which has them in full. The last one is there as often as it has independent motions.
///
/// # Errors
/// [`ModesError::Loads`] where there are no loads, or they can turn the sheet; [`ModesError::NotStable`] where the state is
/// no equilibrium, or not a stable one; [`ModesError::FactorsUncertain`] where the count of negative eigenvalues disagrees;
/// [`ModesError::SelfStressed`] where they depend on a self stress;
/// others where a factorization fails or `observe` returned false.
pub fn buckling(
    assembly: &Assembly,
    state: Option<&Configuration>,
    wanted: usize,
    observe: &mut Observer<'_>,
) -> Result<Buckling, ModesError> {
    let mut model = assembly.model(Gauge::Held);
    let drawn = model.values(&model.start());
    let known = state.and_then(|state| model.enter(state).tension);
    let loads = Drive { quantity: Driven::Loads, to: 2.0 };
    let driven = DrivenModel::new(model, &loads, drawn, state.is_some())?;
    let x = driven.model.start();
    let tension = known.unwrap_or_else(|| restored::tensions(&driven.model, &x, &Forces::Unknown));
    go_on(observe)?;
    let mut tangent = Tangent::at_state(&driven, &x, &tension, HessianKind::Full)?;
    check_stable(&driven, &mut tangent, &tension)?;
    let (growth, of_stress) = driven.geometric_rate(&mut tangent, &x, &tension);
    let growth = growth.hessian;
    let (values, vectors) = critical(&mut tangent, &growth, wanted, observe)?;
    let count = first(&values, wanted);
    if let Some(of_stress) = of_stress
        && !is_indifferent(&tangent.at, [&growth, &of_stress.hessian], &vectors.columns(0, count).into())
    {
        return Err(ModesError::SelfStressed);
    }
    if let Some(beyond) = beyond(&values, count, wanted) {
        agrees(&mut tangent, &growth, (count, beyond))?;
    }
    let velocity = |k: usize| {
        let mut motion = vectors.column(k).as_slice().to_vec();
        normalize(&mut motion);
        driven.model.velocity(&motion)
    };
    Ok(Buckling {
        factors: values[..count].iter().map(|value| driven.parameter() + value.recip()).collect(),
        vectors: (0..count).map(velocity).collect(),
    })
}

/// Factors the tangent of a state, and checks that the state is a stable equilibrium.
fn check_stable(driven: &DrivenModel, tangent: &mut Tangent, tension: &[f64]) -> Result<(), ModesError> {
    let Residuals { force, length } = Residuals::new(driven, &tangent.at, tension);
    let unbalanced = larger(force, length);
    let negative = tangent.negative_eigenvalues()?;
    tangent.factor(0.0)?;
    let unknowns = tangent.at.gradient.len();
    let push: Vec<f64> = (0..unknowns).map(start).collect();
    let moved = tangent.solve(&push, &vec![0.0; tension.len()], EXACT).dx;
    let softest = dot(&push, &moved) / dot(&moved, &moved);
    let pattern = tangent.at.pattern();
    let soft = pattern.largest_diagonal(&tangent.at.hessian);
    let diagonal =
        if soft > 0.0 { soft } else { pattern.largest_diagonal(&whole_hessian(&tangent.at, driven.compliance())) };
    match negative {
        Some(0) if unbalanced <= BALANCED && softest > dense::eigenvalue_rounding(unknowns, diagonal) => Ok(()),
        _ => Err(ModesError::NotStable { unbalanced, softest, negative }),
    }
}

/// How many of these values, descending, are positive and no rounding errors.
fn positive(values: &[f64]) -> usize {
    let largest = values.iter().fold(0.0, |largest, value| larger(largest, value.abs()));
    values.iter().take_while(|value| **value > NOISE * largest).count()
}

/// How many of these values, descending, belong to the wanted factors: those equal to the last one too.
fn first(values: &[f64], wanted: usize) -> usize {
    let positive = &values[..positive(values)];
    let Some(last) = positive.get(wanted.saturating_sub(1)) else { return positive.len() };
    positive.iter().take_while(|value| **value >= (1.0 - SAME_FACTOR) * last).count()
}

/// A component of a vector that has something of every motion.
fn start(k: usize) -> f64 {
    1.0 + (k as f64 * 0.618_033_988_75).fract()
}

/// The largest `1 / l`, descending, with their vectors, by subspace iteration: each step solves `K W = -G V`, and takes the
/// best of the span of `W`. Of small models the span is that of all motions.
fn critical(
    tangent: &mut Tangent,
    growth: &[f64],
    wanted: usize,
    observe: &mut Observer<'_>,
) -> Result<(Vec<f64>, DenseMatrix), ModesError> {
    let unknowns = tangent.at.gradient.len();
    let size = if unknowns <= ALL_VECTORS { unknowns } else { (4 * wanted + MORE_VECTORS).min(unknowns) };
    let mut vectors = DenseMatrix::from_fn(unknowns, size, |row, k| start(row * (k + 1) + 7 * k) - 1.5);
    let mut known = vec![];
    for _ in 0..MOST_ITERATIONS {
        let mut moved = DenseMatrix::zeros(unknowns, vectors.ncols());
        let pushed = -grown(&tangent.at, growth, &vectors);
        for k in 0..vectors.ncols() {
            go_on(observe)?;
            let nothing = vec![0.0; tangent.at.gaps.len()];
            let motion = tangent.solve(pushed.column(k).as_slice(), &nothing, EXACT).dx;
            moved.column_mut(k).copy_from_slice(&motion);
        }
        let found = best(&moved, &pushed, &grown(&tangent.at, growth, &moved))?;
        let values = found.0;
        vectors = found.1;
        let [now, before] = [&values, &known].map(|values| &values[..first(values, wanted)]);
        let largest = values.iter().fold(0.0, |largest, value| larger(largest, value.abs()));
        let rounding = dense::eigenvalue_rounding(unknowns, largest);
        let stays = |(now, before): (&f64, &f64)| (now - before).abs() <= CONVERGED * now + rounding;
        if !known.is_empty() && now.len() == before.len() && now.iter().zip(before).all(stays) {
            return Ok((values, vectors));
        }
        known = values;
    }
    Err(FactorError::Eigenpairs { wanted, found: 0 }.into())
}

/// Whether the geometric stiffness of a self stress, beside that of the loads, changes nothing for these motions.
fn is_indifferent(at: &Linearization, [of_loads, of_stress]: [&[f64]; 2], motions: &DenseMatrix) -> bool {
    let largest = |geometric: &[f64]| motions.tr_mul(&grown(at, geometric, motions)).amax();
    largest(of_stress) <= INDIFFERENT * largest(of_loads)
}

/// The products of the geometric stiffness with vectors.
fn grown(at: &Linearization, growth: &[f64], vectors: &DenseMatrix) -> DenseMatrix {
    let mut products = DenseMatrix::zeros(vectors.nrows(), vectors.ncols());
    for (mut product, vector) in products.column_iter_mut().zip(vectors.column_iter()) {
        let mut column = vec![0.0; vectors.nrows()];
        symmetric_product(at.pattern(), growth, vector.as_slice(), &mut column);
        product.copy_from_slice(&column);
    }
    products
}

/// The values `1 / l` on the span of `W`, descending, and their vectors, given `K W` and `G W`.
fn best(
    moved: &DenseMatrix,
    elastic: &DenseMatrix,
    geometric: &DenseMatrix,
) -> Result<(Vec<f64>, DenseMatrix), ModesError> {
    let energy = moved.tr_mul(elastic);
    // motions that the loads hardly press have small energies, which are exact all the same
    let size = energy.diagonal().map(|energy| if energy > 0.0 { energy.sqrt().recip() } else { 0.0 });
    let energy = DenseMatrix::from_fn(moved.ncols(), moved.ncols(), |j, k| {
        0.5 * size[j] * (energy[(j, k)] + energy[(k, j)]) * size[k]
    });
    let root = dense::symmetric_eigen(&energy)?;
    let kept: Vec<usize> = (0..root.values.len()).filter(|&k| root.values[k] > DEPENDENT).collect();
    let scaled = DenseMatrix::from_fn(moved.ncols(), kept.len(), |row, k| {
        size[row] * root.vectors[(row, kept[k])] / root.values[kept[k]].sqrt()
    });
    let growth = scaled.transpose() * moved.tr_mul(geometric) * &scaled;
    let found = dense::symmetric_eigen(&(0.5 * (&growth + growth.transpose())))?;
    // ascending, of the geometric stiffness: the other way round of what is sought
    Ok((found.values.iter().map(|value| -value).collect(), moved * scaled * found.vectors))
}

/// Where to count: between the last of the factors that were found and the next, and far out where there are fewer than were
/// wanted; `None` where the loads make no forces.
fn beyond(values: &[f64], count: usize, wanted: usize) -> Option<f64> {
    let largest = values.iter().fold(0.0, |largest, value| larger(largest, value.abs()));
    let last = values[..count].last().map(|value| value.recip());
    match (last, values[..positive(values)].get(count)) {
        (Some(last), Some(next)) => Some(0.5 * (last + next.recip())),
        (Some(last), None) if count >= wanted => Some(1.5 * last),
        (Some(last), None) => Some(FAR * last),
        (None, _) => Some(FAR / largest).filter(|far| far.is_finite()),
    }
}

/// Checks that just so many eigenvalues are negative where the loads have grown by this much.
fn agrees(tangent: &mut Tangent, growth: &[f64], (count, beyond): (usize, f64)) -> Result<(), ModesError> {
    tangent.at.hessian.iter_mut().zip(growth).for_each(|(value, growth)| *value += beyond * growth);
    let negative = tangent.negative_eigenvalues()?;
    if negative == Some(count) { Ok(()) } else { Err(ModesError::FactorsUncertain { count, negative }) }
}
