//! As many quadrics as determine points: all paths are followed, and what they find is checked.

use super::endgame::{HomotopyEnd, Simple, attempted, ends};
use super::error::{HomotopyError, MOST_QUADRICS};
use super::multiplicity::{Multiplicity, multiplicity};
use super::solutions::{Group, SAME_SOLUTION_DISTANCE, Solution, Solutions, conjugate, grouped, multiple, turned};
use super::system::{C, Quadrics, TotalDegree, distance};
use crate::parallel;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Finds all solutions of `m` quadrics `x^T A_k x = 0` in `m + 1` homogeneous unknowns.
///
/// The symmetric part of each matrix counts. The same matrices give the same solutions: the random numbers have fixed
/// seeds.
pub(super) fn solve_square(quadrics: &Quadrics) -> Result<Solutions, HomotopyError> {
    let count = quadrics.count();
    if quadrics.unknowns != count + 1 {
        return Err(HomotopyError::NotSquare { quadrics: count, unknowns: quadrics.unknowns });
    }
    if count > MOST_QUADRICS {
        return Err(HomotopyError::TooMany { quadrics: count });
    }
    attempted(|repeated| attempt(quadrics, repeated))
}

fn attempt(quadrics: &Quadrics, repeated: u32) -> Result<Solutions, HomotopyError> {
    let homotopy = TotalDegree::new(quadrics, &mut ChaCha8Rng::seed_from_u64(u64::from(repeated)));
    let paths = 1 << quadrics.count();
    let starts: Vec<Vec<C>> = (0..paths).map(|number| homotopy.start(number)).collect();
    let ends = ends(&homotopy, &starts, repeated)?;
    let mut solutions = Solutions { paths, ..Solutions::default() };
    add_simple(&ends, &mut solutions)?;
    add_singular(quadrics, &ends, &mut solutions)?;
    check_pairs(&solutions.isolated)?;
    Ok(solutions)
}

/// Adds the simple solutions; fails where two paths ended at one.
fn add_simple(ends: &[HomotopyEnd], solutions: &mut Solutions) -> Result<(), HomotopyError> {
    let simple = |end: &HomotopyEnd| if let HomotopyEnd::Simple(simple) = end { Some(simple.clone()) } else { None };
    let simple: Vec<Simple> = ends.iter().filter_map(simple).collect();
    let same = |a: &Simple, b: &Simple| distance(&a.point, &b.point) <= a.separation.max(b.separation);
    let twice = |(k, one): (usize, &Simple)| simple[..k].iter().any(|other| same(one, other));
    let repeated = parallel::map_with_state(simple.len(), || (), |(), k| twice((k, &simple[k])));
    let paths = repeated.into_iter().filter(|twice| *twice).count();
    if paths > 0 {
        return Err(HomotopyError::Collision { paths });
    }
    solutions.isolated.extend(simple.into_iter().map(solution));
    Ok(())
}

fn solution(Simple { point, error, separation }: Simple) -> Solution {
    // a simple solution and its conjugate are one, or further apart than this
    let real = distance(&point, &conjugate(&point)) <= separation;
    Solution { point: turned(point, real), multiplicity: 1, real, error }
}

/// Puts ends that are the same together and adds them; fails where their number is not the multiplicity.
fn add_singular(quadrics: &Quadrics, ends: &[HomotopyEnd], solutions: &mut Solutions) -> Result<(), HomotopyError> {
    let singular = |end: &HomotopyEnd| match end {
        HomotopyEnd::Singular { point, error } => Some((point.clone(), *error)),
        HomotopyEnd::Simple(_) => None,
    };
    for Group { point, error, members } in grouped(ends.iter().filter_map(singular)) {
        let paths = members.len();
        match multiplicity(quadrics, &point, paths) {
            Multiplicity::Larger => solutions.on_continua.extend(members),
            Multiplicity::Isolated(multiplicity) if multiplicity != paths => {
                return Err(HomotopyError::Multiplicity { paths, multiplicity });
            }
            Multiplicity::Isolated(_) | Multiplicity::Unknown => {
                solutions.isolated.push(multiple(point, paths, error));
            }
        }
    }
    Ok(())
}

/// Solutions of real quadrics that are not real come in conjugate pairs, of equal multiplicity.
fn check_pairs(solutions: &[Solution]) -> Result<(), HomotopyError> {
    let alone = |solution: &Solution| {
        let partner = conjugate(&solution.point);
        let same = |other: &Solution| other.multiplicity == solution.multiplicity;
        !solution.real
            && !solutions.iter().any(|other| same(other) && distance(&other.point, &partner) <= SAME_SOLUTION_DISTANCE)
    };
    let lonely = parallel::map_with_state(solutions.len(), || (), |(), k| alone(&solutions[k]));
    match lonely.into_iter().filter(|alone| *alone).count() {
        0 => Ok(()),
        paths => Err(HomotopyError::Unpaired { paths }),
    }
}
