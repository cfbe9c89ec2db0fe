//! Corrections of the solution of a linear system, with a solver that nearly solves it.
//!
//! They are generalised conjugate residuals (Eisenstat, Elman and Schultz, SIAM J. Numer. Anal. 20, 345, 1983): what each
//! changes of the residual is orthogonal to what those before changed. So the few motions of a large sheet that are softer
//! than the rounding errors of a factorization cost a few corrections and do not hold up the rest.

use crate::numerics::larger;
use nalgebra::DVectorView;

/// Corrections go on while each makes the residual at least this much smaller, and are at most so many.
const SLOWEST: f64 = 0.95;
const MOST: usize = 30;

/// A vector of a system with two block rows: unknowns and tensions, or forces and stretches.
#[derive(Clone, Debug)]
pub struct Pair(pub Vec<f64>, pub Vec<f64>);

/// A linear system with two block rows, and a solver that nearly solves it.
pub trait NearlySolved {
    /// The system's matrix times a vector.
    fn product(&self, found: &Pair) -> Pair;
    /// Very nearly the solution for this right-hand side.
    fn solve(&mut self, right: &Pair) -> Pair;
}

/// What corrections reach.
pub struct Corrected {
    /// The solution.
    pub found: Pair,
    /// Its residual as corrections follow it, the larger one of the two block rows in their units. Rounding errors of the
    /// solution are not in it.
    pub residual: f64,
    /// Corrections made.
    pub corrections: usize,
}

/// Corrects `found` until the residual of each block row is at most `tolerance` of its unit, or until that no longer helps.
pub fn correct(
    system: &mut dyn NearlySolved,
    right: &Pair,
    mut found: Pair,
    units: [f64; 2],
    tolerance: f64,
) -> Corrected {
    let per_unit = units.map(per);
    let mut left = right.less(&system.product(&found)).times(per_unit);
    let (mut before, mut last): (Vec<Correction>, f64) = (vec![], f64::INFINITY);
    loop {
        let residual = larger(norm(&left.0), norm(&left.1));
        if residual <= tolerance || !(residual < SLOWEST * last) || before.len() == MOST {
            return Corrected { found, residual, corrections: before.len() };
        }
        last = residual;
        let mut motion = system.solve(&left.clone().times(units));
        let mut change = system.product(&motion).times(per_unit);
        for earlier in &before {
            let part = earlier.part_of(&change);
            change.add(-part, &earlier.change);
            motion.add(-part, &earlier.motion);
        }
        let correction = Correction { per_square: per(change.dot(&change)), motion, change };
        let part = correction.part_of(&left);
        left.add(-part, &correction.change);
        found.add(part, &correction.motion);
        before.push(correction);
    }
}

/// A motion, what it changes of the residual, and one over the square of that.
struct Correction {
    motion: Pair,
    change: Pair,
    per_square: f64,
}

impl Correction {
    /// How often its change is in another one.
    fn part_of(&self, residual: &Pair) -> f64 {
        residual.dot(&self.change) * self.per_square
    }
}

impl Pair {
    /// Adds a multiple of another one.
    pub fn add(&mut self, part: f64, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(v, w)| *v += part * w);
        self.1.iter_mut().zip(&other.1).for_each(|(v, w)| *v += part * w);
    }

    /// This one less another one.
    pub fn less(&self, other: &Self) -> Self {
        let less = |v: &[f64], w: &[f64]| v.iter().zip(w).map(|(v, w)| v - w).collect();
        Self(less(&self.0, &other.0), less(&self.1, &other.1))
    }

    /// With its block rows times these factors.
    fn times(mut self, factors: [f64; 2]) -> Self {
        self.0.iter_mut().for_each(|v| *v *= factors[0]);
        self.1.iter_mut().for_each(|v| *v *= factors[1]);
        self
    }

    fn dot(&self, other: &Self) -> f64 {
        dot(&self.0, &other.0) + dot(&self.1, &other.1)
    }
}

/// One over a size; of what is zero, no unit makes anything else.
fn per(size: f64) -> f64 {
    size.max(f64::MIN_POSITIVE).recip()
}

/// Euclidean norm.
pub fn norm(v: &[f64]) -> f64 {
    dot(v, v).sqrt()
}

fn dot(v: &[f64], w: &[f64]) -> f64 {
    DVectorView::from_slice(v, v.len()).dot(&DVectorView::from_slice(w, w.len()))
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

    /// Claim: a residual that is no number is none, also where that of the other block row is zero or there is no such row: it is never
    /// within a tolerance. Source: the larger of two numbers is not known where one is not.
    #[test]
    fn what_is_no_number_is_not_solved() {
        for stretches in [0, 2] {
            let right = Pair(vec![1.0; 3], vec![0.0; stretches]);
            let found = correct(&mut Broken, &right, right.clone(), [1.0; 2], 0.1);
            assert!(found.residual.is_nan(), "{}", found.residual);
        }
    }
}
