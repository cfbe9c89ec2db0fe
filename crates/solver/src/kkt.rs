//! The linear (KKT) system of a Newton step: unknowns `dx` and tensions `dt` of stiff measures,
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
//! lower block regularised. Measured for rigid sheets of 12, 24 and 48 cells a side
//! (`cargo bench --bench forms -- system`, solved to 1e-10) it takes 1.5 to 1.9 times as long, with 1.1 to 1.3 times as
//! many numbers in the factor and the same inertia. The augmented form is kept because it is faster there, has half the
//! unknowns, and needs no regularisation where `k` is moderate.
//!
//! `gamma` (`-- weight`, the same patches, drawn, to 1e-8): 1e4 needs 6, 16 and over 30 corrections, 1e6 needs 2, 3 and
//! 4, 3e6 needs 2, 2 and 3, 1e7 needs 1, 2 and 3, 1e8 needs 2, 2 and 5, 1e9 fails at 48. With the Gauss-Newton Hessian
//! it is 1e7: steps are long then and open gaps, which plain solves close the better the larger it is (at 1e6 starts
//! with self stresses fail, `tests/integration/model/redundant.rs` and `model/miura.rs`). With the full Hessian it is
//! 3e6: near a solution there are next to no gaps to close and rounding decides, which grows with it: to 1e-6, 3e6
//! needs one correction up to 57 cells a side and two at 82, 1e7 a second one from 40 or 57 on. Larger problems have
//! motions that this weight loses to rounding; the corrections of [`KktSystem::solve`] find them again (claim
//! `cells-residuals` of `validation/`: 100,000 cells). The plain penalty `H + k R^T R` is as good up to `k` = 1e8; at
//! 1e12 it loses the undeformed states of 24 and 48 cells a side.

use super::corrections::{self, IMPATIENT, NearlySolved, Pair};
use super::layout::Layout;
use super::linearization::{HessianKind, Linearization};
use foldwell_numerics::factor::{FactorError, Inertia};
use foldwell_numerics::sparse::{Rows, symmetric_product};
use foldwell_numerics::tearing::TornFactor;
use foldwell_numerics::vector::{max_abs, norm_blocked};
use std::sync::Arc;

/// Largest weight `gamma` of stiff measures relative to the largest entry of the soft Hessian, times the squared
/// largest entry of their gradient; see the module's page.
const fn largest_relative_weight(kind: HessianKind) -> f64 {
    match kind {
        HessianKind::GaussNewton => 1e7,
        HessianKind::Full => 3e6,
    }
}

/// Fraction of the identity added to the metric of a shift, relative to the largest entry of the Hessian. It is above
/// the rounding error of `S`, so that motions that cost nothing are held. Where there is no metric at all the identity
/// takes its place.
const IDENTITY_IN_METRIC: f64 = 1e-7;
/// Residuals of the second block row are measured against this many lengths of `dx`, besides the norm of its right-hand
/// side, which may be rounding error alone.
const STRETCH_UNIT_PER_LENGTH: f64 = 1e2;
/// Residuals of the first block row are measured against this part of the forces `R^T dt` before they balance, where
/// its right-hand side is smaller still and may be rounding error alone.
const FORCE_UNIT_PER_PULL: f64 = 1e-9;
/// A solution of the system.
#[derive(Clone, Debug)]
pub struct Increment {
    /// Change of the unknowns.
    pub dx: Vec<f64>,
    /// Change of the tensions.
    pub dt: Vec<f64>,
    /// Relative residual reached: the larger one of the two block rows.
    pub residual: f64,
}

/// A factorization of `S` and what is needed to solve the system with it.
pub struct KktSystem {
    layout: Arc<Layout>,
    factor: TornFactor,
    /// Chosen instead of [`largest_relative_weight`].
    relative_weight: Option<f64>,
    compliance: Vec<f64>,
    /// The Hessian with its shift; empty where it has none.
    shifted: Vec<f64>,
    /// Entries of the matrix that was factored last, in the pattern of the linearization: its lower triangle, by
    /// columns.
    pub values: Vec<f64>,
    /// Weights of the stiff measures in the matrix that was factored last.
    pub weights: Vec<f64>,
    /// Gradients of the stiff measures where it was factored.
    jacobian: Vec<f64>,
    /// Number of factorizations made.
    pub factorizations: usize,
    /// Number of solves with a factorization made.
    pub solves: usize,
}

impl KktSystem {
    /// Makes room for a problem of this layout.
    ///
    /// # Errors
    /// [`FactorError::TooLarge`] where memory or indices run out.
    pub fn new(layout: &Arc<Layout>) -> Result<Self, FactorError> {
        Ok(Self {
            factor: TornFactor::of(layout.tearing()?)?,
            layout: layout.clone(),
            relative_weight: None,
            compliance: Vec::new(),
            shifted: Vec::new(),
            values: vec![0.0; layout.plan().pattern.entries()],
            weights: vec![0.0; layout.stiff.len()],
            jacobian: vec![0.0; layout.stiff.total()],
            factorizations: 0,
            solves: 0,
        })
    }

    /// The same with another largest weight of stiff measures, `gamma` relative to the largest entry of the soft
    /// Hessian.
    ///
    /// # Errors
    /// As [`KktSystem::new`].
    pub fn with_largest_weight(layout: &Arc<Layout>, gamma: f64) -> Result<Self, FactorError> {
        Ok(Self { relative_weight: Some(gamma), ..Self::new(layout)? })
    }

    /// Factors `S` with `shift` times the metric added to the Hessian. Returns the inertia of `S`: without negative
    /// eigenvalues the state is a minimum, as far as second order tells.
    ///
    /// # Errors
    /// [`FactorError`] where an entry is not finite, or a pivot vanishes.
    pub fn factor(&mut self, at: &Linearization, compliance: &[f64], shift: f64) -> Result<Inertia, FactorError> {
        self.values.copy_from_slice(&at.hessian);
        self.shifted.clear();
        if shift > 0.0 {
            at.add_metric(shift, &mut self.values);
            let some_metric = at.soft_stiffness.iter().any(|k| *k > 0.0);
            let identity = if some_metric { IDENTITY_IN_METRIC } else { 1.0 };
            at.pattern().add_to_diagonal(&mut self.values, shift * identity * hessian_size(at));
            self.shifted.clone_from(&self.values);
        }
        self.add_weighted_measures(at, compliance, 1.0);
        self.factor_filled(at, 1.0 + shift)
    }

    /// Count of numbers in the factor.
    pub fn stored(&self) -> usize {
        self.factor.stored()
    }

    /// Factors `S` with a multiple of the identity instead of the Hessian: solves then give the shortest motion.
    pub(crate) fn factor_shortest(&mut self, at: &Linearization, compliance: &[f64]) -> Result<Inertia, FactorError> {
        self.values.fill(0.0);
        at.pattern().add_to_diagonal(&mut self.values, hessian_size(at));
        self.shifted.clone_from(&self.values);
        self.add_weighted_measures(at, compliance, 1.0);
        self.factor_filled(at, 0.0)
    }

    /// Factors `S` with `zero` times the identity added to the Hessian, and largest weights of stiff measures that are
    /// `heavier` times the usual ones. Returns the number of its negative eigenvalues.
    pub(super) fn count_negative(
        &mut self,
        at: &Linearization,
        compliance: &[f64],
        [zero, heavier]: [f64; 2],
    ) -> Result<usize, FactorError> {
        self.values.copy_from_slice(&at.hessian);
        at.pattern().add_to_diagonal(&mut self.values, zero);
        self.shifted.clone_from(&self.values);
        self.add_weighted_measures(at, compliance, heavier);
        Ok(self.factor_filled(at, 1.0)?.negative)
    }

    /// Whether every stiff measure has its own stiffness as weight in the matrix that was factored last, so that this
    /// matrix is the Hessian of the whole energy.
    pub(super) fn weights_are_exact(&self) -> bool {
        self.weights.iter().zip(&self.compliance).all(|(weight, c)| *weight >= 1.0 / c)
    }

    /// Number of slow corrections after which there is no further one. Where measures of finite stiffness have less
    /// than that as weight, the first one leaves most of their self stresses, which only the next one sees apart from
    /// the rest.
    pub(super) fn most_slow(&self) -> usize {
        let mut measures = self.weights.iter().zip(&self.compliance);
        1 + usize::from(measures.any(|(weight, c)| *c > 0.0 && *weight < 1.0 / c))
    }

    /// Factors the values, which contain `part` times the soft elements' Gauss-Newton Hessian.
    fn factor_filled(&mut self, at: &Linearization, part: f64) -> Result<Inertia, FactorError> {
        self.factorizations += 1;
        self.factor.factor(at.pattern(), &self.values, at.rank_one_terms(part, &self.weights))
    }

    /// Adds the stiff measures to the values, with largest weights that are `heavier` times the usual ones.
    fn add_weighted_measures(&mut self, at: &Linearization, compliance: &[f64], heavier: f64) {
        self.compliance.clear();
        self.compliance.extend_from_slice(compliance);
        let size = stiffness_size(at, compliance);
        let gamma = heavier * self.relative_weight.unwrap_or_else(|| largest_relative_weight(at.kind));
        self.jacobian.copy_from_slice(&at.jacobian);
        for (row, &c) in compliance.iter().enumerate() {
            let largest = max_abs(at.stiff_gradient(row));
            self.weights[row] = f64::min(gamma * size / (largest * largest), 1.0 / c);
            at.add_outer(row, self.weights[row], &mut self.values);
        }
    }

    /// Solves the system that was factored, with `-1/w` instead of `-C`, for a force on every unknown and a stretch of
    /// every stiff measure. Returns the changes of the unknowns and of the tensions.
    pub fn apply(&mut self, force: &[f64], stretch: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let rows = Rows { cliques: &self.layout.stiff, values: &self.jacobian };
        let mut dx = force.to_vec();
        let weighted: Vec<f64> = stretch.iter().zip(&self.weights).map(|(b, w)| b * w).collect();
        rows.add_transpose_product(&weighted, &mut dx);
        self.factor.solve(&mut dx);
        self.solves += 1;
        let mut dt = vec![0.0; stretch.len()];
        rows.product(&dx, &mut dt);
        dt.iter_mut().zip(stretch).zip(&self.weights).for_each(|((t, b), w)| *t = w * (*t - b));
        (dx, dt)
    }

    /// Solves the true system of a linearization to a relative residual of `tolerance`, or until [corrections] no
    /// longer help. The linearization may be another one than that which was factored, near by: the corrections make up
    /// for the difference. Its own Hessian counts where the factorization has no shift.
    pub fn solve(&mut self, at: &Linearization, force: &[f64], stretch: &[f64], tolerance: f64) -> Increment {
        self.solve_with(at, [force, stretch], (tolerance, IMPATIENT))
    }

    /// Solves as [`KktSystem::solve`] does, with corrections that go on while they make any progress at all.
    pub(crate) fn solve_with(
        &mut self,
        at: &Linearization,
        [force, stretch]: [&[f64]; 2],
        until: (f64, f64),
    ) -> Increment {
        let (dx, dt) = self.apply(force, stretch);
        let right = Pair(force.to_vec(), divided(stretch, &at.sizes));
        let force_unit = f64::max(norm_blocked(force), FORCE_UNIT_PER_PULL * pull(at, &dt));
        let stretch_unit = norm_blocked(&right.1) + STRETCH_UNIT_PER_LENGTH * norm_blocked(&dx);
        let start = Pair(dx, multiplied(&dt, &at.sizes));
        let mut equations = AugmentedSystem { system: self, at };
        let corrected = corrections::correct(&mut equations, &right, start, [force_unit, stretch_unit], until);
        let (Pair(dx, dt), residual) = (corrected.found, corrected.residual);
        Increment { dx, dt: divided(&dt, &at.sizes), residual }
    }

    /// The part of a stretch that no motion makes, relative to the stretch: 1 where it is a self stress, 0 where it can
    /// be reached. Corrections end where the part is at most `enough`.
    pub(super) fn unreachable_part(&mut self, at: &Linearization, stretch: &[f64], enough: f64) -> f64 {
        let right = Pair(vec![0.0; self.layout.unknowns], divided(stretch, &at.sizes));
        let (dx, dt) = self.apply(&right.0, stretch);
        let units = [pull(at, &dt), norm_blocked(&right.1)];
        let start = Pair(dx, multiplied(&dt, &at.sizes));
        let mut equations = AugmentedSystem { system: self, at };
        corrections::correct(&mut equations, &right, start, units, (enough, IMPATIENT)).residual
    }
}

/// Size of the Hessian: its largest diagonal entry, 1 where it vanishes.
pub(super) fn hessian_size(at: &Linearization) -> f64 {
    let scale = at.pattern().largest_diagonal(&at.hessian);
    if scale > 0.0 { scale } else { 1.0 }
}

/// Size of the stiffness of a problem: that of its Hessian. Where there are no soft elements the Hessian is that of the
/// tensions alone and may nearly vanish, so that it is at least the stiffness of the softest measure that is not rigid.
pub(super) fn stiffness_size(at: &Linearization, compliance: &[f64]) -> f64 {
    let hessian = hessian_size(at);
    if at.soft_stiffness.iter().any(|k| *k > 0.0) {
        return hessian;
    }
    let finite = compliance.iter().enumerate().filter(|(_, c)| **c > 0.0);
    let softest = finite.map(|(row, c)| max_abs(at.stiff_gradient(row)).powi(2) / c).fold(f64::INFINITY, f64::min);
    if softest.is_finite() { hessian.max(softest) } else { hessian }
}

/// Size of the largest entry of the Hessian with the usual weights of stiff measures.
pub(super) fn largest_weighted_entry(at: &Linearization, compliance: &[f64]) -> f64 {
    let heaviest = largest_relative_weight(at.kind) * stiffness_size(at, compliance);
    let weighted = |(row, c): (usize, &f64)| f64::min(heaviest, max_abs(at.stiff_gradient(row)).powi(2) / c);
    compliance.iter().enumerate().map(weighted).fold(hessian_size(at), f64::max)
}

/// Norm of the forces of these tensions, measure by measure, before they balance.
fn pull(at: &Linearization, tension: &[f64]) -> f64 {
    let pulls = (0..).zip(tension).map(|(row, t)| t * norm_blocked(at.stiff_gradient(row)));
    pulls.map(|pull| pull * pull).sum::<f64>().sqrt()
}

pub(super) fn divided(v: &[f64], sizes: &[f64]) -> Vec<f64> {
    v.iter().zip(sizes).map(|(v, size)| v / size).collect()
}

pub(super) fn multiplied(v: &[f64], sizes: &[f64]) -> Vec<f64> {
    v.iter().zip(sizes).map(|(v, size)| v * size).collect()
}

/// The true system and its augmented form. Stretches are divided by the natural sizes of the measures' gradients and
/// tensions multiplied by them: then all stretches are lengths, and all tensions forces.
struct AugmentedSystem<'a> {
    system: &'a mut KktSystem,
    at: &'a Linearization,
}

impl NearlySolved for AugmentedSystem<'_> {
    fn product(&self, Pair(dx, dt): &Pair) -> Pair {
        let dt = &divided(dt, &self.at.sizes);
        let rows = self.at.rows();
        let (mut a, mut b) = (vec![0.0; dx.len()], vec![0.0; dt.len()]);
        let shifted = &self.system.shifted;
        let hessian = if shifted.is_empty() { &self.at.hessian } else { shifted };
        symmetric_product(self.at.pattern(), hessian, dx, &mut a);
        rows.add_transpose_product(dt, &mut a);
        rows.product(dx, &mut b);
        b.iter_mut().zip(&self.system.compliance).zip(dt).for_each(|((b, c), t)| *b -= c * t);
        Pair(a, divided(&b, &self.at.sizes))
    }

    fn solve(&mut self, Pair(a, b): &Pair) -> Pair {
        let (dx, dt) = self.system.apply(a, &multiplied(b, &self.at.sizes));
        Pair(dx, multiplied(&dt, &self.at.sizes))
    }

    fn most_slow(&self) -> usize {
        self.system.most_slow()
    }
}
