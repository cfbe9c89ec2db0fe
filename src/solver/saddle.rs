//! The linear system of a Newton step: unknowns `dx` and tensions `dt` of stiff measures,
//!
//! `[ H + s   R^T ] [dx]   [a]`
//! `[ R       -C  ] [dt] = [b]`,   `C = diag(1/k) >= 0`.
//!
//! Solved in the *augmented form*: with weights `w = min(k, gamma)` the matrix `S = H + s + R^T w R` has the size and
//! the pattern of the soft Hessian alone, and one factorization of it solves the system with `-1/w` in the place of
//! `-C`. Where `w = k` that is the system itself; elsewhere a few corrections on the residual of the true system make
//! up the difference.
//!
//! The alternative is the *block form*: factor the whole quasi-definite matrix, tensions among the unknowns, with its
//! lower block regularised. Measured for rigid patches of 12, 24 and 48 cells a side (`cargo bench --bench forms -- system`,
//! solved to 1e-10) it takes 1.5 to 1.9 times as long, with 1.1 to 1.3 times as many numbers in the factor and the same inertia.
//! The augmented form is kept because it is faster there, has half the unknowns, and needs no regularisation where `k` is moderate.
//!
//! `gamma` (`-- weight`, the same patches, drawn, to 1e-8): 1e4 needs 6, 16 and over 30 corrections, 1e6 needs 2, 3 and 4, 3e6 needs
//! 2, 2 and 3, 1e7 needs 1, 2 and 3, 1e8 needs 2, 2 and 5, 1e9 fails at 48. With the Gauss-Newton Hessian it is 1e7: steps are long
//! then and open gaps, which plain solves close the better the larger it is (at 1e6 starts with self stresses fail, `tests/redundant.rs`
//! and `tests/miura.rs`). With the full Hessian it is 3e6: near a solution there are next to no gaps to close and rounding decides, which
//! grows with it: to 1e-6, 3e6 needs one correction up to 57 cells a side and two at 82, 1e7 a second one from 40 or 57 on.
//! Larger sheets have motions that this weight loses to rounding; the corrections of [`Saddle::solve`] find them again
//! (`foldwell validate cells-residuals`: 100,000 cells). The plain penalty `H + k R^T R` is as good up to `k` = 1e8; at
//! 1e12 it loses the drawn states of 24 and 48 cells a side.

use super::corrections::{self, NearlySolved, Pair, norm};
use super::problem::{Curvature, Layout, Linearization};
use crate::numerics::factor::{FactorError, Inertia};
use crate::numerics::largest;
use crate::numerics::sparse::{Rows, symmetric_product};
use crate::numerics::tearing::TornFactor;

/// Weight of rigid measures over the largest entry of the soft Hessian: of the Gauss-Newton one, with which steps open gaps, and of the
/// full one, taken near a solution.
const fn usual_weight(curvature: Curvature) -> f64 {
    match curvature {
        Curvature::GaussNewton => 1e7,
        Curvature::Full => 3e6,
    }
}

/// What of the identity belongs to the metric, over the largest entry of the Hessian: above the rounding error of `S`, so
/// that motions that cost nothing are held. Without any metric it is the identity itself.
const LEAST_METRIC: f64 = 1e-7;

/// Stretches are measured against this many lengths of the step, besides their right-hand side, which may be nothing but
/// rounding error.
const STRETCH: f64 = 1e2;
/// Forces below this part of what tensions pull with may be nothing but rounding error.
const BALANCED: f64 = 1e-9;
/// Eigenvalues this much smaller than the largest entry of `S` count as zero.
const NEUTRAL: f64 = 1e-14;

/// A solution of the system.
pub struct Solved {
    /// Unknowns.
    pub dx: Vec<f64>,
    /// Tensions.
    pub dt: Vec<f64>,
    /// Relative residual reached: the larger one of the two block rows.
    pub residual: f64,
}

/// A factorization of `S` and what is needed to solve with it.
pub struct Saddle {
    factor: TornFactor,
    /// Weight of rigid measures over the largest entry of the soft Hessian, where it is not the usual one.
    gamma: Option<f64>,
    /// The Hessian with its shift; empty where it has none.
    shifted: Vec<f64>,
    values: Vec<f64>,
    weights: Vec<f64>,
    /// Gradients of the stiff measures where it was factored.
    jacobian: Vec<f64>,
    /// Factorizations made.
    pub factorizations: usize,
    /// Solves with a factorization made.
    pub solves: usize,
}

impl Saddle {
    /// Room for a problem of this layout.
    pub fn new(layout: &Layout, linearization: &Linearization) -> Result<Self, FactorError> {
        let factor = TornFactor::of(layout.tearing()?)?;
        let (shifted, values) = (vec![], vec![0.0; linearization.pattern().entries()]);
        let weights = vec![0.0; layout.stiff.len()];
        let jacobian = vec![0.0; linearization.jacobian.len()];
        Ok(Self { factor, gamma: None, shifted, values, weights, jacobian, factorizations: 0, solves: 0 })
    }

    /// The same with another weight of rigid measures over the largest entry of the soft Hessian, whatever its curvature.
    pub fn weighing(layout: &Layout, linearization: &Linearization, gamma: f64) -> Result<Self, FactorError> {
        Ok(Self { gamma: Some(gamma), ..Self::new(layout, linearization)? })
    }

    /// Factors `S` with `shift` times the metric added to the Hessian.
    pub fn factor(
        &mut self,
        layout: &Layout,
        at: &Linearization,
        compliance: &[f64],
        shift: f64,
    ) -> Result<Inertia, FactorError> {
        self.fill(layout, at, compliance, shift);
        self.factor_filled(layout, at, 1.0 + shift)
    }

    /// Entries of the matrix that was factored last, in the pattern of the linearization: its lower triangle, by columns.
    pub fn entries(&self) -> &[f64] {
        &self.values
    }

    /// Weights of the stiff measures in the matrix that was factored last.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Numbers in the factor.
    pub fn stored(&self) -> usize {
        self.factor.stored()
    }

    /// Factors `S` with the identity in the place of the Hessian: solves then give the shortest motion.
    pub fn factor_shortest(
        &mut self,
        layout: &Layout,
        at: &Linearization,
        compliance: &[f64],
    ) -> Result<Inertia, FactorError> {
        self.values.fill(0.0);
        at.pattern().add_to_diagonal(&mut self.values, Self::unit(at));
        self.shifted.clone_from(&self.values);
        self.weigh(layout, at, compliance);
        self.factor_filled(layout, at, 0.0)
    }

    /// Inertia of `S`, with eigenvalues that are zero to rounding error counted as positive.
    pub fn inertia(&mut self, layout: &Layout, at: &Linearization, compliance: &[f64]) -> Result<Inertia, FactorError> {
        self.fill(layout, at, compliance, 0.0);
        let neutral = NEUTRAL * at.pattern().largest_diagonal(&self.values);
        at.pattern().add_to_diagonal(&mut self.values, neutral);
        self.factor_filled(layout, at, 1.0)
    }

    /// Factors the values, which have `part` of the soft elements' Gauss-Newton Hessian in them.
    fn factor_filled(&mut self, layout: &Layout, at: &Linearization, part: f64) -> Result<Inertia, FactorError> {
        self.factorizations += 1;
        self.factor.factor(at.pattern(), &self.values, at.outer(layout, part, &self.weights))
    }

    fn fill(&mut self, layout: &Layout, at: &Linearization, compliance: &[f64], shift: f64) {
        self.values.copy_from_slice(&at.hessian);
        self.shifted.clear();
        if shift > 0.0 {
            at.add_metric(layout, shift, &mut self.values);
            let some_metric = at.soft_stiffness.iter().any(|k| *k > 0.0);
            let least = if some_metric { LEAST_METRIC } else { 1.0 };
            at.pattern().add_to_diagonal(&mut self.values, shift * least * Self::unit(at));
            self.shifted.clone_from(&self.values);
        }
        self.weigh(layout, at, compliance);
    }

    /// Adds the weighted stiff measures.
    fn weigh(&mut self, layout: &Layout, at: &Linearization, compliance: &[f64]) {
        let unit = Self::unit(at);
        let gamma = self.gamma.unwrap_or_else(|| usual_weight(at.curvature));
        self.jacobian.copy_from_slice(&at.jacobian);
        for (row, &c) in compliance.iter().enumerate() {
            let gradient = &at.jacobian[layout.stiff.range(row)];
            let largest = largest(gradient);
            self.weights[row] = f64::min(gamma * unit / (largest * largest), 1.0 / c);
            at.add_outer(layout, row, self.weights[row], &mut self.values);
        }
    }

    /// Size of the Hessian: its largest diagonal entry, 1 where it vanishes.
    fn unit(at: &Linearization) -> f64 {
        let scale = at.pattern().largest_diagonal(&at.hessian);
        if scale > 0.0 { scale } else { 1.0 }
    }

    /// Solves the system that was factored, with `-1/w` in the place of `-C`.
    pub fn apply(&mut self, layout: &Layout, a: &[f64], b: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let rows = Rows { cliques: &layout.stiff, values: &self.jacobian };
        let mut dx = a.to_vec();
        let weighted: Vec<f64> = b.iter().zip(&self.weights).map(|(b, w)| b * w).collect();
        rows.add_transpose_product(&weighted, &mut dx);
        self.factor.solve(&mut dx);
        self.solves += 1;
        let mut dt = vec![0.0; b.len()];
        rows.product(&dx, &mut dt);
        dt.iter_mut().zip(b).zip(&self.weights).for_each(|((t, b), w)| *t = w * (*t - b));
        (dx, dt)
    }

    /// Solves the true system of a linearization, with its own Hessian where that was factored without shift, to a relative residual of
    /// `tolerance`, or until [corrections] no longer help.
    pub fn solve(
        &mut self,
        layout: &Layout,
        at: &Linearization,
        compliance: &[f64],
        (a, b): (&[f64], &[f64]),
        tolerance: f64,
    ) -> Solved {
        let (dx, dt) = self.apply(layout, a, b);
        let right = Pair(a.to_vec(), over(b, &at.sizes));
        let units = [f64::max(norm(a), BALANCED * Self::pull(layout, at, &dt)), norm(&right.1) + STRETCH * norm(&dx)];
        let mut equations = Equations { saddle: self, layout, at, compliance };
        let start = Pair(dx, times(&dt, &at.sizes));
        let corrected = corrections::correct(&mut equations, &right, start, units, tolerance);
        let (Pair(dx, dt), residual) = (corrected.found, corrected.residual);
        Solved { dx, dt: over(&dt, &at.sizes), residual }
    }

    /// What tensions pull with, before they balance.
    fn pull(layout: &Layout, at: &Linearization, tension: &[f64]) -> f64 {
        let pulls = (0..).zip(tension).map(|(row, t)| t * norm(&at.jacobian[layout.stiff.range(row)]));
        pulls.map(|pull| pull * pull).sum::<f64>().sqrt()
    }

    /// The part of `b` that no motion makes, relative to `b`: 1 where `b` is a self stress, 0 where it can be reached. Corrections
    /// end where it is at most `enough`.
    pub fn unreachable(
        &mut self,
        layout: &Layout,
        at: &Linearization,
        compliance: &[f64],
        b: &[f64],
        enough: f64,
    ) -> f64 {
        let right = Pair(vec![0.0; layout.unknowns], over(b, &at.sizes));
        let (dx, dt) = self.apply(layout, &right.0, b);
        let units = [Self::pull(layout, at, &dt), norm(&right.1)];
        let start = Pair(dx, times(&dt, &at.sizes));
        let mut equations = Equations { saddle: self, layout, at, compliance };
        corrections::correct(&mut equations, &right, start, units, enough).residual
    }
}

/// Entry by entry over these sizes.
fn over(v: &[f64], sizes: &[f64]) -> Vec<f64> {
    v.iter().zip(sizes).map(|(v, size)| v / size).collect()
}

/// Entry by entry times these sizes.
fn times(v: &[f64], sizes: &[f64]) -> Vec<f64> {
    v.iter().zip(sizes).map(|(v, size)| v * size).collect()
}

/// The true system and its augmented form, stretches over the natural sizes of the measures' gradients and tensions times these: then
/// all stretches are lengths, and all tensions forces.
struct Equations<'a> {
    saddle: &'a mut Saddle,
    layout: &'a Layout,
    at: &'a Linearization,
    compliance: &'a [f64],
}

impl NearlySolved for Equations<'_> {
    fn product(&self, Pair(dx, dt): &Pair) -> Pair {
        let dt = &over(dt, &self.at.sizes);
        let rows = self.at.rows(self.layout);
        let (mut a, mut b) = (vec![0.0; dx.len()], vec![0.0; dt.len()]);
        let shifted = &self.saddle.shifted;
        let hessian = if shifted.is_empty() { &self.at.hessian } else { shifted };
        symmetric_product(self.at.pattern(), hessian, dx, &mut a);
        rows.add_transpose_product(dt, &mut a);
        rows.product(dx, &mut b);
        b.iter_mut().zip(self.compliance).zip(dt).for_each(|((b, c), t)| *b -= c * t);
        Pair(a, over(&b, &self.at.sizes))
    }

    fn solve(&mut self, Pair(a, b): &Pair) -> Pair {
        let (dx, dt) = self.saddle.apply(self.layout, a, &times(b, &self.at.sizes));
        Pair(dx, times(&dt, &self.at.sizes))
    }
}
