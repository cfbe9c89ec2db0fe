//! The numbers of a problem at one state: energy, gradient, Hessian, gaps and Jacobian.

use super::layout::Layout;
use foldwell_numerics::larger;
use foldwell_numerics::sparse::{Cliques, ElementBlock, FIXED, RankOne, Rows, SparsityPattern};
use std::sync::Arc;

/// The part of the soft Hessian that a linearization contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HessianKind {
    /// The term `k g g^T` of each soft element alone, positive semidefinite; and the whole Hessian of elements that have
    /// no stiffness `k`, which are energies by themselves.
    GaussNewton,
    /// The whole Hessian.
    Full,
}

/// A soft element at one state. Its energy is a function of one measure `m(x)`, and its Hessian is
/// `(k + excess) g g^T + f h`.
#[derive(Clone, Copy, Debug)]
pub struct SoftElement<'a> {
    /// Stiffness `k >= 0` of the Gauss-Newton part: for a spring the second derivative of the energy by the measure.
    pub stiffness: f64,
    /// Second derivative of the energy by the measure, less `k`: not zero where the energy is not quadratic.
    pub excess: f64,
    /// Force `f`: the first derivative of the energy by the measure.
    pub force: f64,
    /// Change of the measure that counts as one radian where steps are bounded; infinite for a measure that bounds no
    /// step.
    pub size: f64,
    /// Gradient `g` of the measure by the unknowns of the element.
    pub gradient: &'a [f64],
    /// Hessian `h` of the measure: its lower triangle, row by row, or empty for the Gauss-Newton part `k g g^T` alone.
    pub hessian: &'a [f64],
}

/// A problem's numbers at one state.
#[derive(Debug)]
pub struct Linearization {
    /// Soft energy.
    pub energy: f64,
    /// Gradient of the soft energy.
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
    /// For each soft element the change of its measure that counts as one radian; see [`SoftElement::size`].
    pub soft_sizes: Vec<f64>,
    /// Natural size of each stiff measure's gradient: 1 for lengths, one over the unit of length for angles. Rows of
    /// the Jacobian are compared in these units, so that nothing depends on the unit of length.
    pub sizes: Vec<f64>,
    /// Largest force of a single element on a single unknown.
    pub largest_force: f64,
    /// Largest stiffness of a single soft element at rest on a single unknown: what is rounding error beside it counts as
    /// zero, also where all stiffness vanishes, as that of powers does at rest.
    pub rest_stiffness: f64,
    /// The part of the soft Hessian that is contained.
    pub kind: HessianKind,
    layout: Arc<Layout>,
}

impl Linearization {
    /// Zeros for a problem of this layout, to be filled by [`Problem::linearize`](super::Problem::linearize).
    pub fn new(layout: &Arc<Layout>) -> Self {
        Self {
            energy: 0.0,
            gradient: vec![0.0; layout.unknowns],
            gaps: vec![0.0; layout.stiff.len()],
            jacobian: vec![0.0; layout.stiff.total()],
            hessian: vec![0.0; layout.plan().pattern.entries()],
            sizes: vec![1.0; layout.stiff.len()],
            soft_gradients: vec![0.0; layout.soft.total()],
            soft_stiffness: vec![0.0; layout.soft.len()],
            soft_sizes: vec![1.0; layout.soft.len()],
            largest_force: 0.0,
            rest_stiffness: 0.0,
            kind: HessianKind::Full,
            layout: layout.clone(),
        }
    }

    /// Sets all numbers that are summed to zero, and notes which part of the soft Hessian will be added.
    pub fn clear(&mut self, kind: HessianKind) {
        self.kind = kind;
        self.energy = 0.0;
        self.largest_force = 0.0;
        self.rest_stiffness = 0.0;
        self.gradient.fill(0.0);
        self.hessian.fill(0.0);
    }

    /// Adds the force and the Hessian of soft element number `number`.
    pub fn add_soft(&mut self, number: usize, element: &SoftElement<'_>) {
        let SoftElement { stiffness, excess, force, size, gradient, hessian } = *element;
        self.soft_stiffness[number] = stiffness;
        self.soft_sizes[number] = size;
        self.soft_gradients[self.layout.soft.range(number)].copy_from_slice(gradient);
        for (&member, g) in self.layout.soft.members(number).iter().zip(gradient) {
            if member != FIXED {
                self.gradient[member as usize] += force * g;
            }
        }
        let block = ElementBlock { outer: RankOne { weight: stiffness, gradient }, scale: force, block: hessian };
        self.layout.plan().soft.add_element(number, &block, &mut self.hessian);
        if excess > 0.0 || (excess < 0.0 && self.kind == HessianKind::Full) {
            self.layout.plan().soft.add_outer(number, RankOne { weight: excess, gradient }, &mut self.hessian);
        }
    }

    /// Adds the Hessian of a stiff measure (lower triangle, row by row) times its tension.
    pub fn add_stiff(&mut self, measure: usize, tension: f64, block: &[f64]) {
        self.layout.plan().stiff.add_block(measure, tension, block, &mut self.hessian);
    }

    /// Adds `shift` times the metric, the Gauss-Newton part `sum k g g^T` of the soft Hessian, to `values`.
    pub fn add_metric(&self, shift: f64, values: &mut [f64]) {
        for (element, k) in self.soft_stiffness.iter().enumerate() {
            let gradient = &self.soft_gradients[self.layout.soft.range(element)];
            self.layout.plan().soft.add_outer(element, RankOne { weight: shift * k, gradient }, values);
        }
    }

    /// Adds `weight g g^T` of a stiff measure to `values`.
    pub fn add_outer(&self, measure: usize, weight: f64, values: &mut [f64]) {
        let gradient = &self.jacobian[self.layout.stiff.range(measure)];
        self.layout.plan().stiff.add_outer(measure, RankOne { weight, gradient }, values);
    }

    /// The rank-one terms of a matrix that contains `part` times the soft elements' Gauss-Newton Hessian and the stiff
    /// measures with these weights: a function of the list (0: soft elements, 1: stiff measures) and the number in it.
    pub fn rank_one_terms<'a>(&'a self, part: f64, weights: &[f64]) -> impl Fn(usize, usize) -> RankOne<'a> {
        move |list, number| match list {
            0 => {
                let gradient = &self.soft_gradients[self.layout.soft.range(number)];
                RankOne { weight: part * self.soft_stiffness[number], gradient }
            }
            _ => RankOne { weight: weights[number], gradient: self.stiff_gradient(number) },
        }
    }

    /// Substitutes unknowns: `x_k = factors[k] y_k`. All derivatives are by `y` afterwards.
    pub fn substitute(&mut self, factors: &[f64]) {
        let scale = |cliques: &Cliques, values: &mut [f64]| {
            for (clique, k) in cliques.iter().zip(0..) {
                for (&member, value) in clique.iter().zip(&mut values[cliques.range(k)]).filter(|(m, _)| **m != FIXED) {
                    *value *= factors[member as usize];
                }
            }
        };
        scale(&self.layout.soft, &mut self.soft_gradients);
        scale(&self.layout.stiff, &mut self.jacobian);
        self.gradient.iter_mut().zip(factors).for_each(|(slope, factor)| *slope *= factor);
        self.layout.plan().pattern.scale(&mut self.hessian, factors);
    }

    /// Adds `amount` times the identity to the Hessian.
    pub fn add_identity(&mut self, amount: f64) {
        self.layout.plan().pattern.add_to_diagonal(&mut self.hessian, amount);
    }

    /// Adds `amount` to the diagonal entry of one unknown in the Hessian.
    pub fn add_to_diagonal(&mut self, unknown: usize, amount: f64) {
        self.layout.plan().pattern.add_to_one(&mut self.hessian, unknown, amount);
    }

    /// SparsityPattern of the Hessian; it has room for the outer products of the stiff gradients.
    pub fn pattern(&self) -> &SparsityPattern {
        &self.layout.plan().pattern
    }

    /// The Jacobian of the stiff measures.
    pub fn rows(&self) -> Rows<'_> {
        Rows { cliques: &self.layout.stiff, values: &self.jacobian }
    }

    /// Gradient of a stiff measure by its unknowns.
    pub(super) fn stiff_gradient(&self, measure: usize) -> &[f64] {
        &self.jacobian[self.layout.stiff.range(measure)]
    }

    /// The Jacobian of the stiff measures with every row divided by its natural size, so that no unit of length decides
    /// which rows are large.
    pub fn scaled_jacobian(&self) -> Vec<f64> {
        let mut values = self.jacobian.clone();
        for (row, size) in self.sizes.iter().enumerate() {
            values[self.layout.stiff.range(row)].iter_mut().for_each(|v| *v /= size);
        }
        values
    }

    /// The gradients of the soft elements as a matrix.
    pub fn soft_rows(&self) -> Rows<'_> {
        Rows { cliques: &self.layout.soft, values: &self.soft_gradients }
    }

    /// Largest change along `dx`, to first order, of the measure of a soft element that has a stiffness; the others are
    /// loads.
    pub fn largest_measure_change(&self, dx: &[f64]) -> f64 {
        let mut changes = vec![0.0; self.layout.soft.len()];
        self.soft_rows().product(dx, &mut changes);
        changes.iter().zip(&self.soft_sizes).fold(0.0, |most, (change, size)| larger(most, (change / size).abs()))
    }

    /// The stretch `c t - m` that each stiff measure lacks to its tension's law `m = c t`.
    pub fn missing(&self, tension: &[f64], compliance: &[f64]) -> Vec<f64> {
        missing(&self.gaps, tension, compliance)
    }

    /// Unbalanced force `-(gradient + R^T t)` on every unknown.
    pub fn force(&self, tension: &[f64]) -> Vec<f64> {
        let mut force = self.gradient.clone();
        self.rows().add_transpose_product(tension, &mut force);
        force.iter_mut().for_each(|f| *f = -*f);
        force
    }
}

/// The stretch `c t - m` that stiff measures with these gaps lack to `m = c t`.
pub(super) fn missing(gaps: &[f64], tension: &[f64], compliance: &[f64]) -> Vec<f64> {
    gaps.iter().zip(tension).zip(compliance).map(|((m, t), c)| c * t - m).collect()
}
