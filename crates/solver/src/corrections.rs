//! Iterative refinement of the solution of a linear system, with a solver that nearly solves it.
//!
//! The corrections are generalised conjugate residuals (Eisenstat, Elman and Schultz, SIAM J. Numer. Anal. 20, 345,
//! 1983): what each changes of the residual is orthogonal to what those before changed. So the few motions of a large
//! system that are softer than the rounding errors of a factorization cost a few corrections and do not hold up the
//! rest.

use foldwell_numerics::vector::{add_scaled, dot_blocked, larger, moved, norm_blocked};

/// Ratio of successive residuals above which another correction is not worth a solve.
pub const IMPATIENT: f64 = 0.95;
/// The ratio above which corrections make next to no progress. The first ones of a large system may be slow, as they
/// look for many soft motions at once, and later ones fast.
pub const PATIENT: f64 = 0.9999;
const MOST_CORRECTIONS: usize = 30;
/// Change of the residual by a correction after a slow one, relative to the residual that it answers, that is rounding
/// error, as that of a self stress of rigid measures, which no tension takes away: that of measures of 1e12 is some 1e-6.
const LEAST_CHANGE: f64 = 1e-6;

/// A vector of a system with two block rows: unknowns and tensions, or forces and stretches.
#[derive(Clone, Debug)]
pub struct Pair(pub Vec<f64>, pub Vec<f64>);

/// A linear system with two block rows, and a solver that nearly solves it.
pub trait NearlySolved {
    /// The system's matrix times a vector.
    fn product(&self, found: &Pair) -> Pair;
    /// An approximate solution for this right-hand side.
    fn solve(&mut self, right: &Pair) -> Pair;
    /// Number of corrections in a row that make little progress, after which there is no further one.
    fn most_slow(&self) -> usize {
        1
    }
}

/// The result of corrections.
pub struct RefinedSolution {
    /// The solution.
    pub found: Pair,
    /// Residual as the corrections update it: the larger one of the two block rows, in their units. Rounding errors of
    /// the solution are not part of it.
    pub residual: f64,
    /// Number of corrections made.
    pub corrections: usize,
}

/// Corrects `found` until the residual of each block row is at most `tolerance` of its unit, or until that no longer
/// helps: where corrections leave more than the part `slowest` of the residual.
pub fn correct(
    system: &mut dyn NearlySolved,
    right: &Pair,
    mut found: Pair,
    units: [f64; 2],
    (tolerance, slowest): (f64, f64),
) -> RefinedSolution {
    let per_unit = units.map(reciprocal);
    let mut left = right.minus(&system.product(&found)).scaled(per_unit);
    let (mut before, mut last, mut slow): (Vec<Correction>, f64, usize) = (vec![], f64::INFINITY, 0);
    loop {
        let residual = larger(norm_blocked(&left.0), norm_blocked(&left.1));
        slow = if residual < slowest * last { 0 } else { slow + 1 };
        let enough = residual <= tolerance || residual.is_nan();
        if enough || slow == system.most_slow() || before.len() == MOST_CORRECTIONS {
            return RefinedSolution { found, residual, corrections: before.len() };
        }
        last = residual;
        let mut motion = system.solve(&left.clone().scaled(units));
        let mut change = system.product(&motion).scaled(per_unit);
        for earlier in &before {
            let part = earlier.projection(&change);
            change.add(-part, &earlier.change);
            motion.add(-part, &earlier.motion);
        }
        if slow > 0 && change.dot(&change).sqrt() <= LEAST_CHANGE * residual {
            return RefinedSolution { found, residual, corrections: before.len() };
        }
        let correction = Correction { per_square: reciprocal(change.dot(&change)), motion, change };
        let part = correction.projection(&left);
        left.add(-part, &correction.change);
        found.add(part, &correction.motion);
        before.push(correction);
    }
}

/// A motion, what it changes of the residual, and the reciprocal of the square of that change.
struct Correction {
    motion: Pair,
    change: Pair,
    per_square: f64,
}

impl Correction {
    /// Projection coefficient of `residual` on this correction's change.
    fn projection(&self, residual: &Pair) -> f64 {
        residual.dot(&self.change) * self.per_square
    }
}

impl Pair {
    /// Adds `part` times another vector.
    pub(crate) fn add(&mut self, part: f64, other: &Self) {
        add_scaled(&mut self.0, part, &other.0);
        add_scaled(&mut self.1, part, &other.1);
    }

    /// The difference to another vector.
    pub fn minus(&self, other: &Self) -> Self {
        Self(moved(&self.0, -1.0, &other.0), moved(&self.1, -1.0, &other.1))
    }

    /// The vector with its two block rows multiplied by these factors.
    fn scaled(mut self, factors: [f64; 2]) -> Self {
        self.0.iter_mut().for_each(|v| *v *= factors[0]);
        self.1.iter_mut().for_each(|v| *v *= factors[1]);
        self
    }

    fn dot(&self, other: &Self) -> f64 {
        dot_blocked(&self.0, &other.0) + dot_blocked(&self.1, &other.1)
    }
}

/// Reciprocal of a size, guarded against division by zero.
fn reciprocal(size: f64) -> f64 {
    size.max(f64::MIN_POSITIVE).recip()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A system whose forces are not numbers, as those of a solver that broke down; its stretches are none.
    struct Broken;

    impl NearlySolved for Broken {
        fn product(&self, found: &Pair) -> Pair {
            Pair(vec![f64::NAN; found.0.len()], vec![0.0; found.1.len()])
        }

        fn solve(&mut self, right: &Pair) -> Pair {
            right.clone()
        }
    }

    /// Claim: a residual that is no number is none, also where that of the other block row is zero or there is no such
    /// row: it is never within a tolerance. Source: the larger of two numbers is not known where one is not.
    #[test]
    fn what_is_no_number_is_not_solved() {
        for stretches in [0, 2] {
            let right = Pair(vec![1.0; 3], vec![0.0; stretches]);
            let found = correct(&mut Broken, &right, right.clone(), [1.0; 2], (0.1, IMPATIENT));
            assert!(found.residual.is_nan(), "{}", found.residual);
        }
    }
}
