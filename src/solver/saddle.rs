//! The linear system of a Newton step: unknowns `dx` and tensions `dt` of stiff measures,
//!
//! `[ H + s   R^T ] [dx]   [a]`
//! `[ R       -C  ] [dt] = [b]`,   `C = diag(1/k) >= 0`.
//!
//! Solved in the *augmented form*: with weights `w = min(k, gamma)` the matrix `S = H + s + R^T w R` has the size and
//! the pattern of the soft Hessian alone, and one factorization of it solves the system with `-1/w` in the place of
//! `-C`. Where `w = k` that is the system itself; elsewhere a few corrections on the residual of the true system make
//! up the difference. Where the saddle form would keep as many tensions as bars in the factorization, this one keeps
//! none. For the measured comparison see `benches/forms.rs`.

use super::problem::{Layout, Linearization};
use crate::numerics::factor::{Factor, FactorError, Inertia};
use crate::numerics::sparse::diagonal_slot;

/// Weight of rigid measures over the largest entry of the soft Hessian.
const GAMMA: f64 = 1e6;

/// A factorization of `S` and what is needed to solve with it.
pub struct Saddle {
    factor: Factor,
    values: Vec<f64>,
    weights: Vec<f64>,
    shift: f64,
    /// Factorizations made.
    pub factorizations: usize,
    /// Solves with a factorization made.
    pub solves: usize,
}

impl Saddle {
    /// Analyses the pattern of a problem.
    pub fn new(layout: &Layout, linearization: &Linearization) -> Result<Self, FactorError> {
        let pattern = linearization.pattern();
        let factor = Factor::new(pattern, &layout.node, &[&layout.soft, &layout.stiff])?;
        let values = vec![0.0; pattern.entries()];
        let weights = vec![0.0; layout.stiff.len()];
        Ok(Self { factor, values, weights, shift: 0.0, factorizations: 0, solves: 0 })
    }

    /// Size of the Hessian's diagonal, the unit in which shifts and weights are chosen.
    pub fn scale(linearization: &Linearization) -> f64 {
        let pattern = linearization.pattern();
        let diagonal = (0..pattern.size()).map(|k| linearization.hessian[diagonal_slot(pattern, k)].abs());
        diagonal.fold(0.0, f64::max)
    }

    /// Factors `S` with this shift.
    pub fn factor(
        &mut self,
        layout: &Layout,
        at: &Linearization,
        compliance: &[f64],
        shift: f64,
    ) -> Result<Inertia, FactorError> {
        let pattern = at.pattern();
        self.shift = shift;
        self.values.copy_from_slice(&at.hessian);
        for k in 0..pattern.size() {
            self.values[diagonal_slot(pattern, k)] += shift;
        }
        let scale = Self::scale(at);
        for (row, &c) in compliance.iter().enumerate() {
            let gradient = &at.jacobian[layout.stiff.range(row)];
            let largest = gradient.iter().fold(0.0f64, |m, g| m.max(g.abs()));
            let gamma = GAMMA * if scale > 0.0 { scale } else { 1.0 } / (largest * largest);
            self.weights[row] = gamma.min(1.0 / c);
            at.add_outer(layout, row, self.weights[row], &mut self.values);
        }
        self.factorizations += 1;
        self.factor.factor(pattern, &self.values)
    }

    /// Solves with `-1/w` in the place of `-C`.
    pub fn apply(&mut self, layout: &Layout, at: &Linearization, a: &[f64], b: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let rows = at.rows(layout);
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
    ) -> (Vec<f64>, Vec<f64>, f64) {
        let (mut dx, mut dt) = self.apply(layout, at, a, b);
        let start = norm(a).max(f64::MIN_POSITIVE);
        let start_b = norm(b).max(f64::MIN_POSITIVE);
        let mut last = f64::INFINITY;
        loop {
            let (ra, rb) = self.residual(layout, at, compliance, (a, b), (&dx, &dt));
            let size = (norm(&ra) / start).max(norm(&rb) / start_b);
            if size <= tolerance || !(size < 0.7 * last) {
                return (dx, dt, size);
            }
            last = size;
            let (ddx, ddt) = self.apply(layout, at, &ra, &rb);
            dx.iter_mut().zip(&ddx).for_each(|(x, d)| *x += d);
            dt.iter_mut().zip(&ddt).for_each(|(t, d)| *t += d);
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
        at.hessian_product(self.shift, dx, &mut ra);
        rows.add_transpose_product(dt, &mut ra);
        ra.iter_mut().zip(a).for_each(|(r, a)| *r = a - *r);
        rows.product(dx, &mut rb);
        for (k, r) in rb.iter_mut().enumerate() {
            *r = b[k] - *r + compliance[k] * dt[k];
        }
        (ra, rb)
    }
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|a| a * a).sum::<f64>().sqrt()
}
