//! All complex solutions of homogeneous quadrics, with multiplicity.
//!
//! `m` quadrics in `m + 1` homogeneous unknowns have `2^m` solutions in projective space, each counted with its multiplicity,
//! or infinitely many (Bezout). They are followed along `2^m` paths from a system whose solutions are known (`system`), by a
//! predictor and corrector with step control (`track`), through an endgame that finds multiple solutions as well
//! (`endgame`). In projective space nothing goes to infinity, so no path may be lost.
//!
//! What the paths find is not taken on trust. Simple solutions are proved by Smale's criterion, and two paths must not end at
//! one of them; the multiplicity of the others is computed from the equations around them (`multiplicity`) and has to be
//! the number of paths that end there; what is not real has to come in conjugate pairs. Where all agrees the multiplicities add up to `2^m`, so nothing is missing, whatever a
//! path did on its way. Where it does not, everything is done again with smaller steps and other random numbers.

mod elimination;
mod endgame;
mod multiplicity;
mod sections;
mod series;
mod singular;
mod system;
mod track;

#[cfg(test)]
mod tests;

use super::{DenseMatrix, parallel};
use endgame::{End, Simple};
use multiplicity::{Multiplicity, multiplicity};
use nalgebra::Complex;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
pub use sections::{Section, meets_real_points, solve_any};
pub use singular::{SingularPoint, real_singular_points};
use system::{C, Quadrics, TotalDegree, distance, normalize};
use track::{Care, Tracker};

/// More paths than these are refused: `2^16`.
const MOST_QUADRICS: usize = 16;
/// How often everything is done again with smaller steps and other random numbers.
const ATTEMPTS: u32 = 4;
/// Ends of paths nearer than this are one multiple solution.
const SAME: f64 = 1e-6;

/// Why solutions were not given.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HomotopyError {
    /// A quadric is no finite square matrix of the right size, or zero.
    #[error("quadric {number} is zero, not finite, or of another size than the others")]
    Quadric {
        /// Its place in the list.
        number: usize,
    },
    /// The numbers of quadrics and unknowns do not fit.
    #[error("{quadrics} quadrics in {unknowns} homogeneous unknowns do not have single solutions")]
    NotSquare {
        /// Number of quadrics.
        quadrics: usize,
        /// Number of unknowns.
        unknowns: usize,
    },
    /// Too many paths.
    #[error("{quadrics} quadrics have 2^{quadrics} solutions; at most {MOST_QUADRICS} quadrics are solved")]
    TooMany {
        /// Number of quadrics.
        quadrics: usize,
    },
    /// Paths did not come to an end.
    #[error("{paths} of the paths to the solutions were lost")]
    Lost {
        /// How many.
        paths: usize,
    },
    /// Two paths came to one simple solution.
    #[error("{paths} of the paths came to simple solutions of other paths")]
    Collision {
        /// How many.
        paths: usize,
    },
    /// Solutions were found without their conjugates.
    #[error("{paths} solutions were found without their conjugates")]
    Unpaired {
        /// How many.
        paths: usize,
    },
    /// The multiplicity of a solution is not the number of paths that came to it.
    #[error("{paths} paths came to a solution of multiplicity {multiplicity}")]
    Multiplicity {
        /// How many paths.
        paths: usize,
        /// From the equations around it.
        multiplicity: usize,
    },
}

/// An isolated solution.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// A vector of norm 1, its largest entry real and positive; all entries are real where the solution is.
    pub point: Vec<Complex<f64>>,
    /// Its multiplicity.
    pub multiplicity: usize,
    /// Whether it is real: proved where it is simple, otherwise up to 1e-6.
    pub real: bool,
    /// Estimated distance to the exact solution.
    pub error: f64,
}

/// All solutions of a square system.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solutions {
    /// The isolated ones, in the order of their paths.
    pub isolated: Vec<Solution>,
    /// Points of norm 1, one for each path that ended on a curve, a surface or more of solutions.
    pub on_continua: Vec<Vec<Complex<f64>>>,
    /// Number of paths, `2^m`: the sum of all multiplicities and of the paths that ended on continua.
    pub paths: usize,
    /// Number of times that everything was done again before all agreed.
    pub repeated: u32,
}

impl Solutions {
    /// Number of isolated solutions, each with its multiplicity.
    pub fn count(&self) -> usize {
        self.isolated.iter().map(|solution| solution.multiplicity).sum()
    }
}

/// All solutions of `m` quadrics `x^T A_k x = 0` in `m + 1` homogeneous unknowns.
///
/// Of each matrix the symmetric part counts. The same matrices give the same solutions: the random numbers have fixed
/// seeds. Fails on matrices that are zero, not finite or of the wrong size or number, and where after several attempts paths
/// and multiplicities still do not agree.
pub fn solve(quadrics: &[DenseMatrix]) -> Result<Solutions, HomotopyError> {
    solve_square(&Quadrics::new(quadrics, quadrics.len() + 1)?)
}

fn solve_square(quadrics: &Quadrics) -> Result<Solutions, HomotopyError> {
    let count = quadrics.count();
    if quadrics.unknowns != count + 1 {
        return Err(HomotopyError::NotSquare { quadrics: count, unknowns: quadrics.unknowns });
    }
    if count > MOST_QUADRICS {
        return Err(HomotopyError::TooMany { quadrics: count });
    }
    let mut found = attempt(quadrics, 0);
    for repeated in 1..ATTEMPTS {
        if found.is_ok() {
            break;
        }
        found = attempt(quadrics, repeated);
    }
    found
}

fn attempt(quadrics: &Quadrics, repeated: u32) -> Result<Solutions, HomotopyError> {
    let homotopy = TotalDegree::new(quadrics, &mut ChaCha8Rng::seed_from_u64(u64::from(repeated)));
    let paths = 1 << quadrics.count();
    let path = |number: usize| {
        let mut tracker = Tracker::new(&homotopy, careful(repeated));
        let [start, end] = [1.0, endgame::START].map(|t| C::new(t, 0.0));
        let x = tracker.track(&homotopy.start(number), start, end, 0.05)?;
        endgame::finish(&mut tracker, quadrics, x)
    };
    let ends: Vec<End> =
        parallel::map_with_state(paths, || (), |(), number| path(number)).into_iter().filter_map(Result::ok).collect();
    if ends.len() < paths {
        return Err(HomotopyError::Lost { paths: paths - ends.len() });
    }
    let mut solutions = Solutions { paths, repeated, ..Solutions::default() };
    add_simple(&ends, &mut solutions)?;
    add_singular(quadrics, &ends, &mut solutions)?;
    check_pairs(&solutions.isolated)?;
    Ok(solutions)
}

/// How careful steps are the first time, and each time again.
fn careful(repeated: u32) -> Care {
    Care { correction: 0.01 * 0.1f64.powi(repeated as i32), contraction: 0.1 * 0.3f64.powi(repeated as i32) }
}

/// Adds the simple solutions; fails where two paths ended at one.
fn add_simple(ends: &[End], solutions: &mut Solutions) -> Result<(), HomotopyError> {
    let simple = |end: &End| if let End::Simple(simple) = end { Some(simple.clone()) } else { None };
    let simple: Vec<Simple> = ends.iter().filter_map(simple).collect();
    let same = |a: &Simple, b: &Simple| distance(&a.point, &b.point) <= a.separation.max(b.separation);
    let twice = |(k, one): (usize, &Simple)| simple[..k].iter().any(|other| same(one, other));
    let paths = parallel::map_with_state(simple.len(), || (), |(), k| twice((k, &simple[k])))
        .into_iter()
        .filter(|twice| *twice)
        .count();
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
fn add_singular(quadrics: &Quadrics, ends: &[End], solutions: &mut Solutions) -> Result<(), HomotopyError> {
    let singular = |end: &End| match end {
        End::Singular { point, error } => Some((point.clone(), *error)),
        End::Simple(_) => None,
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

/// Points that are the same up to [`SAME`].
struct Group {
    point: Vec<C>,
    /// Largest error or distance of a member.
    error: f64,
    members: Vec<Vec<C>>,
}

fn grouped(points: impl Iterator<Item = (Vec<C>, f64)>) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (point, error) in points {
        match groups.iter_mut().find(|group| distance(&group.point, &point) <= SAME) {
            Some(group) => {
                group.error = group.error.max(error).max(distance(&group.point, &point));
                group.members.push(point);
            }
            None => groups.push(Group { point: point.clone(), error, members: vec![point] }),
        }
    }
    groups
}

/// A solution that is not simple.
fn multiple(point: Vec<C>, multiplicity: usize, error: f64) -> Solution {
    let real = distance(&point, &conjugate(&point)) <= SAME;
    Solution { point: turned(point, real), multiplicity, real, error }
}

fn conjugate(point: &[C]) -> Vec<C> {
    point.iter().map(C::conj).collect()
}

/// Solutions of real quadrics that are not real come in conjugate pairs, of equal multiplicity.
fn check_pairs(solutions: &[Solution]) -> Result<(), HomotopyError> {
    let alone = |solution: &Solution| {
        let partner = conjugate(&solution.point);
        let same = |other: &Solution| other.multiplicity == solution.multiplicity;
        !solution.real && !solutions.iter().any(|other| same(other) && distance(&other.point, &partner) <= SAME)
    };
    let lonely = parallel::map_with_state(solutions.len(), || (), |(), k| alone(&solutions[k]));
    match lonely.into_iter().filter(|alone| *alone).count() {
        0 => Ok(()),
        paths => Err(HomotopyError::Unpaired { paths }),
    }
}

/// The same point with its largest entry real and positive; a real one without imaginary parts.
fn turned(point: Vec<C>, real: bool) -> Vec<C> {
    let largest =
        point.iter().copied().fold(C::default(), |a, b| if b.norm() > a.norm() * (1.0 + 1e-9) { b } else { a });
    let phase = largest.conj() / largest.norm();
    let mut turned: Vec<C> = point.iter().map(|entry| entry * phase).collect();
    if real {
        turned.iter_mut().for_each(|entry| entry.im = 0.0);
    }
    normalize(&mut turned);
    turned
}
