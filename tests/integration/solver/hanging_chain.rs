//! A hanging chain of rigid bars compared with its closed form: forces and positions, from several starts.
//!
//! The chain has `n` bars of length 1 between two points at a distance of 0.7 n, and a weight of 0.5 at each joint. The
//! force in bar `k` is `(H, V_k)` with `V_k = w (k - (n - 1)/2)`, along the bar; `H` is the force at which the bars
//! span the distance.

use crate::textbook::{Textbook, length, linear};
use approx::abs_diff_eq;
use std::f64::consts::PI;

const WEIGHT: f64 = 0.5;
const REACH: f64 = 0.7;

struct Chain {
    bars: usize,
    /// Horizontal force.
    force: f64,
}

impl Chain {
    fn new(bars: usize) -> Self {
        let wanted = REACH * bars as f64;
        let (mut low, mut high) = (1e-9, 1e6);
        for _ in 0..200 {
            let force: f64 = 0.5 * (low + high);
            let chain = Self { bars, force };
            let span: f64 = (0..bars).map(|k| force / chain.tension(k)).sum();
            if span < wanted { low = force } else { high = force }
        }
        Self { bars, force: low }
    }

    fn vertical(&self, k: usize) -> f64 {
        WEIGHT * (k as f64 - (self.bars as f64 - 1.0) / 2.0)
    }

    fn tension(&self, k: usize) -> f64 {
        self.force.hypot(self.vertical(k))
    }

    /// Returns the positions of the joints in the closed form.
    fn joints(&self) -> Vec<[f64; 2]> {
        let mut place = [0.0, 0.0];
        let next = |k: usize| {
            place = [place[0] + self.force / self.tension(k), place[1] + self.vertical(k) / self.tension(k)];
            place
        };
        (0..self.bars - 1).map(next).collect()
    }

    /// Returns the problem, with or without springs that are slack in the closed form and hold the joints on their way
    /// there.
    fn problem(&self, springs: bool) -> Textbook {
        let joints = self.bars - 1;
        let span = REACH * self.bars as f64;
        let mut problem = Textbook::new(2 * joints).load(&[0.0, -WEIGHT].repeat(joints));
        problem = problem.stiff(&[0, 1], 0.0, length(Some([0.0, 0.0]), 1.0));
        for k in 1..joints as u32 {
            problem = problem.stiff(&[2 * k - 2, 2 * k - 1, 2 * k, 2 * k + 1], 0.0, length(None, 1.0));
        }
        let last = 2 * joints as u32 - 2;
        problem = problem.stiff(&[last, last + 1], 0.0, length(Some([span, 0.0]), 1.0));
        let places = self.joints().into_iter().flatten().enumerate().filter(|_| springs);
        places.fold(problem, |problem, (k, place)| problem.soft(&[k as u32], 0.1, linear(&[1.0], place)))
    }

    /// Returns a half circle below the points, a little too long.
    fn half_circle(&self) -> Vec<f64> {
        let span = REACH * self.bars as f64;
        let angle = |k: usize| PI * k as f64 / self.bars as f64;
        (1..self.bars).flat_map(|k| [0.5 * span * (1.0 - angle(k).cos()), -0.45 * span * angle(k).sin()]).collect()
    }

    /// Returns joints on two straight lines.
    fn v(&self) -> Vec<f64> {
        let depth = (1.0 - REACH * REACH).sqrt();
        (1..self.bars).flat_map(|k| [REACH * k as f64, -depth * k.min(self.bars - k) as f64]).collect()
    }

    fn hangs(&self, springs: bool, start: &[f64]) {
        let found = self.problem(springs).run(start).unwrap_or_else(|error| panic!("{} bars: {error}", self.bars));
        for k in 0..self.bars {
            let (tension, expected) = (found.tension[k], self.tension(k));
            assert!(
                abs_diff_eq!(tension, expected, epsilon = 1e-9 * expected),
                "{} bars, bar {k}: {tension}",
                self.bars
            );
        }
        for (k, place) in self.joints().iter().enumerate() {
            let off = (found.x[2 * k] - place[0]).hypot(found.x[2 * k + 1] - place[1]);
            assert!(off < 1e-9, "{} bars, joint {k}: off by {off:e}", self.bars);
        }
        assert_eq!(found.negative_eigenvalues, Some(0));
    }
}

/// Claim: the closed form is found from a half circle, with slack springs. Tolerance: residual 1e-12 times the length
/// of the chain divided by the softest stiffness.
#[test]
fn from_a_half_circle() {
    for bars in [4, 9] {
        let chain = Chain::new(bars);
        chain.hangs(true, &chain.half_circle());
    }
}

/// Claim: the same from two straight lines, also with so many bars that the factorization is sparse.
#[test]
fn from_a_v() {
    for bars in [4, 10, 40] {
        let chain = Chain::new(bars);
        chain.hangs(true, &chain.v());
    }
}

/// Claim: the same without soft terms: only the tensions hold the joints.
#[test]
fn without_springs() {
    for bars in [4, 10, 40] {
        let chain = Chain::new(bars);
        chain.hangs(false, &chain.v());
    }
}
