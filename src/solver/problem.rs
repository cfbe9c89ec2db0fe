//! What the solver asks of a problem.
//!
//! Minimise `E(x) + sum_r m_r(x)^2 / (2 c_r)`: a soft energy `E` and stiff measures with gaps `m_r` (the measure less
//! its rest value) and compliances `c_r = 1/k_r >= 0`. A compliance of zero is the constraint `m_r(x) = 0`. The
//! tension `t_r` of a measure is an unknown of its own, `m_r = c_r t_r`, so nothing is ever multiplied by `k_r`.

use crate::numerics::factor::FactorError;
use crate::numerics::larger;
use crate::numerics::sparse::{Cliques, FIXED, Pattern, Rows, Slots};
use crate::numerics::tearing::Tearing;
use std::sync::{Arc, OnceLock};

/// Which unknowns there are and which are coupled.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Number of unknowns.
    pub unknowns: usize,
    /// Block of each unknown (a vertex, say), numbered without gaps: blocks stay together in the order of elimination.
    pub node: Vec<u32>,
    /// Unknowns of each soft element.
    pub soft: Cliques,
    /// Unknowns of each stiff measure.
    pub stiff: Cliques,
    /// Made when it is first asked for; the couplings do not change after that.
    plan: OnceLock<Arc<Plan>>,
}

/// What follows from the couplings alone, for all states and all solves: the pattern of the Hessian, where elements go in it, and
/// how it is factored.
#[derive(Debug)]
struct Plan {
    pattern: Pattern,
    soft: Slots,
    stiff: Slots,
    tearing: OnceLock<Result<Arc<Tearing>, FactorError>>,
}

impl Layout {
    /// Of these blocks of the unknowns and couplings.
    pub fn new(node: Vec<u32>, soft: Cliques, stiff: Cliques) -> Self {
        Self { unknowns: node.len(), node, soft, stiff, plan: OnceLock::new() }
    }

    fn plan(&self) -> &Arc<Plan> {
        self.plan.get_or_init(|| {
            let pattern = Pattern::new(self.unknowns, &[&self.soft, &self.stiff]);
            let (soft, stiff) = (Slots::new(&pattern, &self.soft), Slots::new(&pattern, &self.stiff));
            Arc::new(Plan { pattern, soft, stiff, tearing: OnceLock::new() })
        })
    }

    /// How matrices of the Hessian's pattern are factored; analysed once.
    ///
    /// # Errors
    /// As [`Tearing::new`].
    pub fn tearing(&self) -> Result<&Arc<Tearing>, FactorError> {
        let plan = self.plan();
        let analyse = || Tearing::new(&plan.pattern, &self.node, &[&self.soft, &self.stiff]).map(Arc::new);
        plan.tearing.get_or_init(analyse).as_ref().map_err(|error| *error)
    }
}

/// How much of the soft Hessian to take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curvature {
    /// Only `k g g^T` of each soft element: positive semidefinite.
    GaussNewton,
    /// All of it.
    Full,
}

/// A soft energy with stiff measures.
pub trait Problem {
    /// Unknowns and couplings; the same at every state.
    fn layout(&self) -> &Layout;
    /// `1/k >= 0` of each stiff measure.
    fn compliance(&self) -> &[f64];
    /// Natural size of each stiff measure's gap: a length for lengths, 1 for angles.
    fn gap_scale(&self) -> &[f64];
    /// Natural size of the unknowns, which are lengths.
    fn unit_of_length(&self) -> f64 {
        1.0
    }
    /// Soft energy at `x`.
    fn energy(&self, x: &[f64]) -> f64;
    /// Gaps of the stiff measures at `x`.
    fn gaps(&self, x: &[f64]) -> Vec<f64>;
    /// Fills `out` at `(x, tension)`: all but the products with the tension of the Jacobian.
    fn linearize(&self, x: &[f64], tension: &[f64], curvature: Curvature, out: &mut Linearization);
    /// Adds to the Hessian what keeps motions of the whole in place that cost nothing, where there are any; forces stay as they are.
    fn hold(&self, _tension: &[f64], _out: &mut Linearization) {}
    /// Called with every accepted state; may write the same state in other coordinates.
    fn accept(&mut self, x: &mut [f64]);
    /// Called with every accepted state: may move it as a whole where that lowers the soft energy and changes no gap. Returns by how much.
    fn relieve(&mut self, _x: &mut [f64]) -> f64 {
        0.0
    }
}

/// A problem's numbers at one state.
pub struct Linearization {
    /// Soft energy.
    pub energy: f64,
    /// Its gradient.
    pub gradient: Vec<f64>,
    /// Gaps of the stiff measures.
    pub gaps: Vec<f64>,
    /// Gradients of the stiff measures, laid out as the members of `Layout::stiff`.
    pub jacobian: Vec<f64>,
    /// Soft Hessian plus the tension-weighted Hessians of the stiff measures, in the slots of the pattern.
    pub hessian: Vec<f64>,
    /// Gradients of the soft elements, laid out as the members of `Layout::soft`.
    pub soft_gradients: Vec<f64>,
    /// Stiffnesses of the soft elements.
    pub soft_stiffness: Vec<f64>,
    /// Natural size of each stiff measure's gradient: 1 for lengths, one over the unit of length for angles. Rows are compared in
    /// these units, so that nothing depends on the unit of length.
    pub sizes: Vec<f64>,
    /// Largest force of a single element on a single unknown.
    pub largest_force: f64,
    /// How much of the soft Hessian is in it.
    pub curvature: Curvature,
    plan: Arc<Plan>,
}

impl Linearization {
    /// Space for a problem of this layout.
    pub fn new(layout: &Layout) -> Self {
        let plan = layout.plan().clone();
        Self {
            energy: 0.0,
            gradient: vec![0.0; layout.unknowns],
            gaps: vec![0.0; layout.stiff.len()],
            jacobian: vec![0.0; layout.stiff.total()],
            hessian: vec![0.0; plan.pattern.entries()],
            sizes: vec![1.0; layout.stiff.len()],
            soft_gradients: vec![0.0; layout.soft.total()],
            soft_stiffness: vec![0.0; layout.soft.len()],
            largest_force: 0.0,
            curvature: Curvature::Full,
            plan,
        }
    }

    /// Sets all numbers that are summed to zero; so much of the soft Hessian will be added.
    pub fn clear(&mut self, curvature: Curvature) {
        self.curvature = curvature;
        self.energy = 0.0;
        self.largest_force = 0.0;
        self.gradient.fill(0.0);
        self.hessian.fill(0.0);
    }

    /// Adds force and Hessian of a soft element: its stiffness `k` and the gradient `g` of its measure, its force `f`
    /// and the Hessian `h` of its measure (lower triangle, row by row; empty: only `k g g^T` of `k g g^T + f h`).
    pub fn add_soft(&mut self, layout: &Layout, element: usize, (k, g): (f64, &[f64]), (f, h): (f64, &[f64])) {
        self.soft_stiffness[element] = k;
        self.soft_gradients[layout.soft.range(element)].copy_from_slice(g);
        for (&member, g) in layout.soft.members(element).iter().zip(g) {
            if member != FIXED {
                self.gradient[member as usize] += f * g;
            }
        }
        self.plan.soft.add_curvature(element, (k, g), (f, h), &mut self.hessian);
    }

    /// Adds `shift` times the metric, the Gauss-Newton part `sum k g g^T` of the soft Hessian, to `values`.
    pub fn add_metric(&self, layout: &Layout, shift: f64, values: &mut [f64]) {
        for (element, k) in self.soft_stiffness.iter().enumerate() {
            let gradient = &self.soft_gradients[layout.soft.range(element)];
            self.plan.soft.add_outer(element, shift * k, gradient, values);
        }
    }

    /// Adds the Hessian of a stiff measure (lower triangle, row by row) times its tension.
    pub fn add_stiff(&mut self, measure: usize, tension: f64, block: &[f64]) {
        self.plan.stiff.add_block(measure, tension, block, &mut self.hessian);
    }

    /// Adds `weight g g^T` of stiff measure `measure` to `values`.
    pub fn add_outer(&self, layout: &Layout, measure: usize, weight: f64, values: &mut [f64]) {
        let gradient = &self.jacobian[layout.stiff.range(measure)];
        self.plan.stiff.add_outer(measure, weight, gradient, values);
    }

    /// Weight and gradient of the outer product that an element, soft (list 0) or stiff (list 1), has in a matrix with `part` of the
    /// soft elements' Gauss-Newton Hessian and these weights of the stiff measures.
    pub fn outer<'a>(
        &'a self,
        layout: &Layout,
        part: f64,
        weights: &[f64],
    ) -> impl Fn(usize, usize) -> (f64, &'a [f64]) {
        move |list, element| match list {
            0 => (part * self.soft_stiffness[element], &self.soft_gradients[layout.soft.range(element)]),
            _ => (weights[element], &self.jacobian[layout.stiff.range(element)]),
        }
    }

    /// Adds `amount` times the identity to the Hessian.
    pub fn add_identity(&mut self, amount: f64) {
        self.plan.pattern.add_to_diagonal(&mut self.hessian, amount);
    }

    /// Adds an amount to the diagonal entry of an unknown in the Hessian.
    pub fn add_to_diagonal(&mut self, unknown: usize, amount: f64) {
        self.plan.pattern.add_to_one(&mut self.hessian, unknown, amount);
    }

    /// Pattern of the Hessian; it has room for the outer products of the stiff gradients.
    pub fn pattern(&self) -> &Pattern {
        &self.plan.pattern
    }

    /// The Jacobian of the stiff measures.
    pub fn rows<'a>(&'a self, layout: &'a Layout) -> Rows<'a> {
        Rows { cliques: &layout.stiff, values: &self.jacobian }
    }

    /// The Jacobian of the stiff measures with every row over its natural size.
    pub fn even_jacobian(&self, layout: &Layout) -> Vec<f64> {
        let mut values = self.jacobian.clone();
        for (row, size) in self.sizes.iter().enumerate() {
            values[layout.stiff.range(row)].iter_mut().for_each(|v| *v /= size);
        }
        values
    }

    /// The gradients of the soft elements as a matrix.
    pub fn soft_rows<'a>(&'a self, layout: &'a Layout) -> Rows<'a> {
        Rows { cliques: &layout.soft, values: &self.soft_gradients }
    }

    /// Largest change of a soft element's measure along `dx`, to first order.
    pub fn largest_turn(&self, layout: &Layout, dx: &[f64]) -> f64 {
        let mut turns = vec![0.0; layout.soft.len()];
        self.soft_rows(layout).product(dx, &mut turns);
        turns.iter().fold(0.0, |most, turn| larger(most, turn.abs()))
    }

    /// What each stiff measure lacks to `m = c t`.
    pub fn missing(&self, tension: &[f64], compliance: &[f64]) -> Vec<f64> {
        missing(&self.gaps, tension, compliance)
    }

    /// Unbalanced force `-(gradient + R^T t)` on every unknown.
    pub fn force(&self, layout: &Layout, tension: &[f64]) -> Vec<f64> {
        let mut force = self.gradient.clone();
        self.rows(layout).add_transpose_product(tension, &mut force);
        force.iter_mut().for_each(|f| *f = -*f);
        force
    }
}

/// What stiff measures with these gaps lack to `m = c t`.
pub(super) fn missing(gaps: &[f64], tension: &[f64], compliance: &[f64]) -> Vec<f64> {
    gaps.iter().zip(tension).zip(compliance).map(|((m, t), c)| c * t - m).collect()
}
