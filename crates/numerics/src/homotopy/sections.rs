//! Quadrics of any number: more than determine points, or fewer.
//!
//! With fewer the solutions are curves, surfaces and so on. A random linear space of the right dimension meets them in
//! points, as many as their degree says (witness points; A. J. Sommese and C. W. Wampler, "The numerical solution of
//! systems of polynomials", 2005, chapter 13). With more, random combinations of the quadrics are solved, and of their
//! solutions those are kept that satisfy all quadrics.

use super::error::HomotopyError;
use super::multiplicity::{Multiplicity, multiplicity};
use super::solutions::{Group, Solutions, grouped, multiple, turned};
use super::square::solve_square;
use super::system::{C, Quadrics};
use crate::DenseMatrix;
use crate::random::symmetric;
use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Largest residual, for quadrics of norm 1, of a solution of combinations that is one of all quadrics.
const SOLUTION_RESIDUAL: f64 = 1e-8;

/// The solutions of quadrics of any number, or where there are infinitely many, those on a random linear space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Dimension of the solutions in projective space: unknowns less one less quadrics, and 0 with more quadrics.
    pub dimension: usize,
    /// Bezout's number: the sum of all multiplicities, of the paths that ended on continua and of the extraneous
    /// solutions.
    pub expected: usize,
    /// The solutions, of the random linear space where `dimension` is not 0.
    pub solutions: Solutions,
    /// Number of solutions of the combinations that are none of all quadrics, with multiplicity.
    pub extraneous: usize,
}

/// Solves quadrics `x^T A_k x = 0` of any number in `unknowns` homogeneous unknowns.
///
/// The quadrics should be linearly independent.
///
/// # Errors
/// [`HomotopyError`]: the quadrics do not fit the unknowns, or their solutions cannot be followed.
pub fn solve_any(quadrics: &[DenseMatrix], unknowns: usize) -> Result<Section, HomotopyError> {
    if unknowns == 0 {
        return Ok(Section::default());
    }
    let all = Quadrics::new(quadrics, unknowns)?;
    let dimension = (unknowns - 1).saturating_sub(quadrics.len());
    let mut random = ChaCha8Rng::seed_from_u64(u64::MAX);
    if dimension > 0 {
        let solutions = on_linear_space(&all, &random_frame(unknowns, quadrics.len() + 1, &mut random))?;
        return Ok(Section { dimension, expected: solutions.paths, solutions, extraneous: 0 });
    }
    if quadrics.len() == unknowns - 1 {
        let solutions = solve_square(&all)?;
        return Ok(Section { dimension, expected: solutions.paths, solutions, extraneous: 0 });
    }
    let solutions = kept(&all, solve_square(&combined(&all, &mut random)?)?);
    let (expected, found) = (solutions.paths, solutions.count() + solutions.on_continua.len());
    Ok(Section { dimension, expected, solutions, extraneous: expected.saturating_sub(found) })
}

/// Whether one of some random real linear spaces meets the solutions of fewer quadrics than determine points in a real
/// point. The solutions then have infinitely many real points; where none of the spaces does, nothing is said about
/// them.
///
/// # Errors
/// [`HomotopyError`]: the quadrics do not fit the unknowns, or their solutions cannot be followed.
pub fn meets_real_points(quadrics: &[DenseMatrix], unknowns: usize, spaces: usize) -> Result<bool, HomotopyError> {
    let all = Quadrics::new(quadrics, unknowns)?;
    let mut random = ChaCha8Rng::seed_from_u64(u64::MAX);
    for _ in 0..spaces {
        let solutions = on_linear_space(&all, &random_frame(unknowns, quadrics.len() + 1, &mut random))?;
        if solutions.isolated.iter().any(|solution| solution.real && solution.multiplicity == 1) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Orthonormal columns in random directions.
pub(super) fn random_frame(rows: usize, columns: usize, random: &mut ChaCha8Rng) -> DenseMatrix {
    DenseMatrix::from_fn(rows, columns, |_, _| symmetric(random)).qr().q()
}

/// The solutions that are combinations of the columns of a frame.
pub(super) fn on_linear_space(all: &Quadrics, frame: &DenseMatrix) -> Result<Solutions, HomotopyError> {
    let restricted: Vec<DenseMatrix> = all.matrices.iter().map(|a| frame.transpose() * a * frame).collect();
    let mut solutions = solve_square(&Quadrics::new(&restricted, frame.ncols())?)?;
    let frame = frame.map(|entry| C::new(entry, 0.0));
    let lifted = |point: &[C]| (&frame * DVector::from_column_slice(point)).as_slice().to_vec();
    for solution in &mut solutions.isolated {
        solution.point = turned(lifted(&solution.point), solution.real);
    }
    solutions.on_continua.iter_mut().for_each(|point| *point = lifted(point));
    Ok(solutions)
}

/// Random combinations of the quadrics, as many as determine points.
fn combined(all: &Quadrics, random: &mut ChaCha8Rng) -> Result<Quadrics, HomotopyError> {
    let weights = random_frame(all.count(), all.unknowns - 1, random);
    let combinations: Vec<DenseMatrix> = weights
        .column_iter()
        .map(|weights| weights.iter().zip(&all.matrices).map(|(weight, matrix)| matrix * *weight).sum())
        .collect();
    Quadrics::new(&combinations, all.unknowns)
}

/// The solutions of combinations that are solutions of all quadrics, with their multiplicity there.
fn kept(all: &Quadrics, combined: Solutions) -> Solutions {
    let Solutions { isolated, on_continua, paths } = combined;
    let mut kept = Solutions { paths, ..Solutions::default() };
    for mut solution in isolated.into_iter().filter(|solution| all.residual(&solution.point) <= SOLUTION_RESIDUAL) {
        if let Multiplicity::Isolated(multiplicity) = multiplicity(all, &solution.point, solution.multiplicity) {
            solution.multiplicity = multiplicity;
        }
        kept.isolated.push(solution);
    }
    // what combinations have in common along a curve, all quadrics may have at a point
    let common = on_continua.into_iter().filter(|point| all.residual(point) <= SOLUTION_RESIDUAL);
    for Group { point, error, members } in grouped(common.map(|point| (point, 0.0))) {
        match multiplicity(all, &point, members.len()) {
            Multiplicity::Isolated(found) => kept.isolated.push(multiple(point, found, error)),
            Multiplicity::Larger | Multiplicity::Unknown => kept.on_continua.extend(members),
        }
    }
    kept
}
