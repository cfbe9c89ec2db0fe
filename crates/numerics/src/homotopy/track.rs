//! Following a solution of a homotopy from one parameter to another: predictor, corrector, step control.
//!
//! Points are vectors of norm 1; each step works in the affine patch of the point where it begins. The predictor is the
//! classical Runge-Kutta method on `H_x x' = -H_t`, the corrector Newton's method. A step is accepted where the first
//! correction is small and the corrections then fall as they do for a simple solution: their quotient measures distance
//! over distance to the next solution, so that paths near each other are not confused.

use super::elimination;
use super::system::{C, Homotopy, HomotopyDerivatives, norm, normalize};

/// Corrections below this are rounding.
const ROUNDING: f64 = 1e-11;
/// Corrections have ended when they are below this.
const CORRECTED: f64 = 1e-9;
const MOST_STEPS: usize = 20_000;
const SHORTEST_STEP: f64 = 1e-10;

/// Bounds of the corrections of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Care {
    /// Largest first correction.
    pub correction: f64,
    /// Largest quotient of the second correction and the first.
    pub contraction: f64,
}

impl Care {
    /// Care at the first attempt (0), and more at each repetition.
    pub fn of_attempt(repeated: u32) -> Self {
        Self { correction: 0.01 * 0.1f64.powi(repeated as i32), contraction: 0.1 * 0.3f64.powi(repeated as i32) }
    }
}

pub(super) struct Tracker<'a, H> {
    pub homotopy: &'a H,
    care: Care,
    local: HomotopyDerivatives,
    matrix: Vec<C>,
}

impl<'a, H: Homotopy> Tracker<'a, H> {
    pub fn new(homotopy: &'a H, care: Care) -> Self {
        let n = homotopy.quadrics().unknowns;
        Self { homotopy, care, local: HomotopyDerivatives::new(n), matrix: vec![C::default(); n * n] }
    }

    /// Follows the solution `x` along the straight line between two parameters; `first` is the part of the line that
    /// the first step tries. `None` where it is lost: steps become too short, or too many.
    pub fn track(&mut self, x: &[C], from: C, to: C, first: f64) -> Option<Vec<C>> {
        let (mut x, mut done, mut length) = (x.to_vec(), 0.0, first);
        for _ in 0..MOST_STEPS {
            let last = length >= 1.0 - done;
            let next = if last { 1.0 } else { done + length };
            match self.step(&x, from + (to - from) * done, from + (to - from) * next) {
                Some((found, _)) if last => return Some(found),
                Some((found, used)) => {
                    (x, done) = (found, next);
                    length *= (0.8 * used.powf(-0.2)).clamp(0.5, 3.0);
                }
                None => length = 0.4 * (next - done),
            }
            if length < SHORTEST_STEP {
                return None;
            }
        }
        None
    }

    /// Newton's method at one parameter until rounding is all that is left.
    pub fn polished(&mut self, x: &[C], t: C) -> Vec<C> {
        let (mut polished, mut before) = (x.to_vec(), CORRECTED);
        for _ in 0..3 {
            let Some(correction) = self.correction(&polished, t, x).filter(|c| norm(c) < before) else { break };
            before = norm(&correction);
            polished.iter_mut().zip(&correction).for_each(|(a, b)| *a += b);
        }
        normalize(&mut polished);
        polished
    }

    /// The point that a step leads to, and how much of what is allowed it used: 1 is all; `None` if it is refused.
    pub fn step(&mut self, x: &[C], from: C, to: C) -> Option<(Vec<C>, f64)> {
        let mut found = self.predict(x, from, to)?;
        let (mut before, mut used) = (f64::INFINITY, 0.0f64);
        for iteration in 0..5 {
            let correction = self.correction(&found, to, x)?;
            let size = norm(&correction);
            if iteration == 0 {
                used = size / self.care.correction;
            } else if iteration == 1 && size > ROUNDING {
                used = used.max(size / (before * self.care.contraction));
            }
            let growing = size > ROUNDING && size > 0.5 * before;
            if !(used <= 1.0) || growing {
                return None;
            }
            found.iter_mut().zip(&correction).for_each(|(a, b)| *a += b);
            if iteration > 0 && size <= CORRECTED {
                normalize(&mut found);
                return Some((found, used));
            }
            before = size;
        }
        None
    }

    /// One step of the classical Runge-Kutta method.
    fn predict(&mut self, x: &[C], from: C, to: C) -> Option<Vec<C>> {
        let (half, whole) = (0.5 * (to - from), to - from);
        let along = |k: &[C], length: C| -> Vec<C> { x.iter().zip(k).map(|(a, b)| a + length * b).collect() };
        let k1 = self.tangent(x, from, x)?;
        let k2 = self.tangent(&along(&k1, half), from + half, x)?;
        let k3 = self.tangent(&along(&k2, half), from + half, x)?;
        let k4 = self.tangent(&along(&k3, whole), to, x)?;
        let sum = (0..x.len()).map(|i| x[i] + whole / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        Some(sum.collect())
    }

    /// `x'` with `H_x x' = -H_t`, orthogonal to the patch.
    fn tangent(&mut self, x: &[C], t: C, patch: &[C]) -> Option<Vec<C>> {
        self.homotopy.evaluate(x, t, &mut self.local);
        let right = self.local.rate.iter().map(|rate| -rate).collect();
        self.solve(right, patch)
    }

    /// `dx` with `H_x dx = -H`, orthogonal to the patch.
    fn correction(&mut self, x: &[C], t: C, patch: &[C]) -> Option<Vec<C>> {
        self.homotopy.evaluate(x, t, &mut self.local);
        let right = self.local.value.iter().map(|value| -value).collect();
        self.solve(right, patch)
    }

    fn solve(&mut self, mut right: Vec<C>, patch: &[C]) -> Option<Vec<C>> {
        let equations = self.local.jacobian.len();
        self.matrix[..equations].copy_from_slice(&self.local.jacobian);
        self.matrix[equations..].iter_mut().zip(patch).for_each(|(a, b)| *a = b.conj());
        right.push(C::default());
        elimination::solve(&mut self.matrix, &mut right).then_some(right)
    }
}
