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
//! lower block regularised. Measured at the drawn state of rigid patches (`cargo bench --bench forms -- system`, solved
//! to 1e-10) it takes 1.45, 1.26 and 1.05 times as long at 12, 24 and 48 cells a side, with as many numbers in the factor
//! and the same inertia. The augmented form is kept because it is never slower there, has half the unknowns, and needs
//! no regularisation where `k` is moderate. `gamma` (`-- weight`): 1e4 does not converge at 24 cells a side, 1e6 needs 6
//! to 9 corrections at 48, 1e7 and 1e8 need 4 to 6, 1e9 fails there; 1e7 keeps a decade to the cliff. The plain penalty
//! `H + k R^T R` is as good up to `k` = 1e8; at 1e12 it loses the drawn states of 24 and 48 cells a side.

use super::problem::{Layout, Linearization};
use crate::numerics::factor::{Factor, FactorError, Inertia};
use crate::numerics::sparse::{Rows, symmetric_product};

/// Weight of rigid measures over the largest entry of the soft Hessian.
const GAMMA: f64 = 1e7;
/// What of the identity belongs to the metric, over the largest entry of the Hessian: above the rounding error of `S`, so
/// that motions that cost nothing are held. Without any metric it is the identity itself.
const LEAST_METRIC: f64 = 1e-7;

/// Corrections go on while each makes the residual at least this much smaller.
const SLOWEST: f64 = 0.7;
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
    factor: Factor,
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
        let factor = Factor::of(layout.symbolic()?)?;
        let values = vec![0.0; linearization.pattern().entries()];
        let shifted = values.clone();
        let weights = vec![0.0; layout.stiff.len()];
        let jacobian = vec![0.0; linearization.jacobian.len()];
        Ok(Self { factor, shifted, values, weights, jacobian, factorizations: 0, solves: 0 })
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
        self.factorizations += 1;
        self.factor.factor(at.pattern(), &self.values)
    }

    /// Entries of the matrix that was factored last, in the pattern of the linearization: its lower triangle, by columns.
    pub fn entries(&self) -> &[f64] {
        &self.values
    }

    /// Factors `S` with the identity in the place of the Hessian: solves then give the shortest motion.
    pub fn factor_shortest(
        &mut self,
        layout: &Layout,
        at: &Linearization,
        compliance: &[f64],
    ) -> Result<Inertia, FactorError> {
        self.shifted.fill(0.0);
        at.pattern().add_to_diagonal(&mut self.shifted, Self::unit(at));
        self.weigh(layout, at, compliance);
        self.factorizations += 1;
        self.factor.factor(at.pattern(), &self.values)
    }

    /// Inertia of `S`, with eigenvalues that are zero to rounding error counted as positive.
    pub fn inertia(&mut self, layout: &Layout, at: &Linearization, compliance: &[f64]) -> Result<Inertia, FactorError> {
        self.fill(layout, at, compliance, 0.0);
        let neutral = NEUTRAL * at.pattern().largest_diagonal(&self.values);
        at.pattern().add_to_diagonal(&mut self.values, neutral);
        self.factorizations += 1;
        self.factor.factor(at.pattern(), &self.values)
    }

    fn fill(&mut self, layout: &Layout, at: &Linearization, compliance: &[f64], shift: f64) {
        self.shifted.copy_from_slice(&at.hessian);
        if shift > 0.0 {
            at.add_metric(layout, shift, &mut self.shifted);
            let some_metric = at.soft_stiffness.iter().any(|k| *k > 0.0);
            let least = if some_metric { LEAST_METRIC } else { 1.0 };
            at.pattern().add_to_diagonal(&mut self.shifted, shift * least * Self::unit(at));
        }
        self.weigh(layout, at, compliance);
    }

    /// Adds the weighted stiff measures.
    fn weigh(&mut self, layout: &Layout, at: &Linearization, compliance: &[f64]) {
        let unit = Self::unit(at);
        self.jacobian.copy_from_slice(&at.jacobian);
        self.values.copy_from_slice(&self.shifted);
        for (row, &c) in compliance.iter().enumerate() {
            let gradient = &at.jacobian[layout.stiff.range(row)];
            let largest = gradient.iter().fold(0.0f64, |m, g| m.max(g.abs()));
            self.weights[row] = f64::min(GAMMA * unit / (largest * largest), 1.0 / c);
            at.add_outer(layout, row, self.weights[row], &mut self.values);
        }
    }

    /// Size of the Hessian: its largest diagonal entry, 1 where it vanishes.
    fn unit(at: &Linearization) -> f64 {
        let scale = at.pattern().largest_diagonal(&at.hessian);
        if scale > 0.0 { scale } else { 1.0 }
    }

    /// Takes the Hessian of another linearization for what is solved from now on, corrected from the last factorization.
    pub fn keep(&mut self, at: &Linearization) {
        self.shifted.copy_from_slice(&at.hessian);
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

    /// Solves the true system to a relative residual of `tolerance`, or until corrections no longer help.
    pub fn solve(
        &mut self,
        layout: &Layout,
        at: &Linearization,
        compliance: &[f64],
        (a, b): (&[f64], &[f64]),
        tolerance: f64,
    ) -> Solved {
        let (mut dx, mut dt) = self.apply(layout, a, b);
        let mut last = f64::INFINITY;
        loop {
            let (ra, rb) = self.residual(layout, at, compliance, (a, b), (&dx, &dt));
            let of_stretch = over(norm(&rb), norm(b) + STRETCH * norm(&dx));
            let residual = f64::max(over(norm(&ra), norm(a)), of_stretch);
            if residual <= tolerance || !(residual < SLOWEST * last) {
                let unit = f64::max(norm(a), BALANCED * Self::pull(layout, at, &dt));
                return Solved { dx, dt, residual: f64::max(over(norm(&ra), unit), of_stretch) };
            }
            last = residual;
            let (ddx, ddt) = self.apply(layout, &ra, &rb);
            dx.iter_mut().zip(&ddx).for_each(|(x, d)| *x += d);
            dt.iter_mut().zip(&ddt).for_each(|(t, d)| *t += d);
        }
    }

    /// What tensions pull with, before they balance.
    fn pull(layout: &Layout, at: &Linearization, tension: &[f64]) -> f64 {
        let sizes: Vec<f64> = tension.iter().map(|t| t.abs()).collect();
        let mut pull = vec![0.0; layout.unknowns];
        let rows = at.rows(layout);
        let absolute: Vec<f64> = rows.values.iter().map(|value| value.abs()).collect();
        Rows { cliques: rows.cliques, values: &absolute }.add_transpose_product(&sizes, &mut pull);
        norm(&pull)
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
        let zero = vec![0.0; layout.unknowns];
        let (mut dx, mut dt) = (zero.clone(), vec![0.0; b.len()]);
        let (mut ra, mut rb, mut last) = (zero.clone(), b.to_vec(), f64::INFINITY);
        loop {
            let (ddx, ddt) = self.apply(layout, &ra, &rb);
            dx.iter_mut().zip(&ddx).for_each(|(x, d)| *x += d);
            dt.iter_mut().zip(&ddt).for_each(|(t, d)| *t += d);
            (ra, rb) = self.residual(layout, at, compliance, (&zero, b), (&dx, &dt));
            let left = over(norm(&rb), norm(b));
            if left <= enough || !(left < SLOWEST * last) {
                return left;
            }
            last = left;
        }
    }

    fn residual(
        &self,
        layout: &Layout,
        at: &Linearization,
        compliance: &[f64],
        (a, b): (&[f64], &[f64]),
        (dx, dt): (&[f64], &[f64]),
    ) -> (Vec<f64>, Vec<f64>) {
        let rows = at.rows(layout);
        let (mut ra, mut rb) = (vec![0.0; a.len()], vec![0.0; b.len()]);
        symmetric_product(at.pattern(), &self.shifted, dx, &mut ra);
        rows.add_transpose_product(dt, &mut ra);
        ra.iter_mut().zip(a).for_each(|(r, a)| *r = a - *r);
        rows.product(dx, &mut rb);
        for (k, r) in rb.iter_mut().enumerate() {
            *r = b[k] - *r + compliance[k] * dt[k];
        }
        (ra, rb)
    }
}

/// A residual over its right-hand side; zero where there is no residual.
fn over(residual: f64, right: f64) -> f64 {
    if residual > 0.0 { residual / right.max(f64::MIN_POSITIVE) } else { 0.0 }
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|a| a * a).sum::<f64>().sqrt()
}
