//! The linear system of one step, reduced to the multipliers.
//!
//! With `D = diag(c)` and the residuals `r = D^-1 (z - a) + J^T l` and `F`, the step `dz` and the change `dl` of the
//! multipliers solve
//!
//! `(D^-1 + W) dz + J^T dl = -r`, `J dz = -F`.
//!
//! Without `W` (the Gauss-Newton step) `dz` is eliminated: `S dl = F - J D r` with `S = J D J^T`, which is symmetric
//! and positive definite if the constraints are independent, and couples two blocks of constraints only if they have a
//! variable in common. With `W` the same factorization is the constraint preconditioner of projected conjugate
//! gradients (N. Gould, M. Hribar and J. Nocedal, SIAM J. Sci. Comput. 23, 1376 (2001)).

use super::problem::{Blocks, ConstrainedProblem, Derivatives};
use crate::layout::Layout;
use foldwell_numerics::factor::FactorError;
use foldwell_numerics::sparse::{Cliques, RankOne};
use foldwell_numerics::tearing::TornFactor;
use foldwell_numerics::vector::{add_scaled, dot_blocked};
use std::collections::HashMap;
use std::sync::Arc;

/// Largest number of conjugate gradients of one step.
const MOST_GRADIENTS: usize = 30;

/// A step of the variables and of the multipliers.
#[derive(Clone, Debug)]
pub(super) struct PrimalDualStep {
    pub(super) dz: Vec<f64>,
    pub(super) dl: Vec<f64>,
}

/// The matrix `S`, its factorization, and what is needed to solve with it.
pub(super) struct Reduced<'a, P> {
    problem: &'a P,
    layout: Arc<Layout>,
    /// Block and place in its list, for each block with each variable.
    uses: Vec<Vec<(u32, u32)>>,
    factor: TornFactor,
    values: Vec<f64>,
    gradients: Vec<f64>,
    pub(super) factorizations: usize,
    pub(super) solves: usize,
}

impl<'a, P: ConstrainedProblem> Reduced<'a, P> {
    /// Analyses the pattern of `S`.
    pub(super) fn new(problem: &'a P, variables: usize) -> Result<Self, FactorError> {
        let blocks = problem.blocks();
        let mut uses = vec![Vec::new(); variables];
        for (block, list) in blocks.variables.iter().enumerate() {
            (0..).zip(list).for_each(|(place, &variable)| uses[variable as usize].push((block as u32, place)));
        }
        let coupled = coupled(blocks, &uses);
        let node = (0..blocks.len()).flat_map(|block| blocks.rows(block).map(move |_| block as u32)).collect();
        let gradients = vec![0.0; coupled.total()];
        let layout = Layout::new(node, coupled, Cliques::new());
        let factor = TornFactor::of(layout.tearing()?)?;
        let values = vec![0.0; layout.plan().pattern.entries()];
        Ok(Self { problem, layout, uses, factor, values, gradients, factorizations: 0, solves: 0 })
    }

    /// Factors `S` for these derivatives.
    pub(super) fn factor(&mut self, at: &Derivatives) -> Result<(), FactorError> {
        let (blocks, plan) = (self.problem.blocks(), self.layout.plan());
        if blocks.is_empty() {
            return Ok(());
        }
        self.values.fill(0.0);
        for (variable, (uses, &weight)) in self.uses.iter().zip(self.problem.compliance()).enumerate() {
            let gradient = &mut self.gradients[self.layout.soft.range(variable)];
            let mut start = 0;
            for &(block, place) in uses {
                let column = at.column(blocks, block as usize, place as usize);
                gradient[start..start + column.len()].copy_from_slice(column);
                start += column.len();
            }
            plan.soft.add_outer(variable, RankOne { weight, gradient }, &mut self.values);
        }
        let (layout, gradients, compliance) = (&self.layout, &self.gradients, self.problem.compliance());
        let outer =
            |_, variable| RankOne { weight: compliance[variable], gradient: &gradients[layout.soft.range(variable)] };
        self.factorizations += 1;
        let inertia = self.factor.factor(&plan.pattern, &self.values, outer)?;
        if inertia.negative > 0 { Err(FactorError::Singular { ratio: inertia.ratio }) } else { Ok(()) }
    }

    /// Returns `S^-1 right`.
    fn solve(&mut self, mut right: Vec<f64>) -> Vec<f64> {
        if !right.is_empty() {
            self.factor.solve(&mut right);
            self.solves += 1;
        }
        right
    }

    /// Returns the Gauss-Newton step for the derivatives that were factored. `pull` is `D r`, `values` is `F`; both
    /// may be those of another state.
    pub(super) fn gauss_newton(&mut self, at: &Derivatives, pull: &[f64], values: &[f64]) -> PrimalDualStep {
        let blocks = self.problem.blocks();
        let mut right = at.product(blocks, pull);
        right.iter_mut().zip(values).for_each(|(right, value)| *right = value - *right);
        let dl = self.solve(right);
        let mut dz = vec![0.0; pull.len()];
        at.add_transpose_product(blocks, &dl, &mut dz);
        dz.iter_mut().zip(pull).zip(self.problem.compliance()).for_each(|((dz, pull), c)| *dz = -(pull + c * *dz));
        PrimalDualStep { dz, dl }
    }

    /// Returns the step with the full Hessian, to which `shift D^-1` is added, to a relative accuracy, from the
    /// Gauss-Newton step for the same residuals; `None` if the Hessian is seen not to be positive definite along the
    /// constraints.
    pub(super) fn newton(
        &mut self,
        at: &Derivatives,
        start: PrimalDualStep,
        (shift, accuracy): (f64, f64),
    ) -> Option<PrimalDualStep> {
        let (blocks, compliance) = (self.problem.blocks(), self.problem.compliance());
        let PrimalDualStep { mut dz, mut dl } = start;
        let wanted = accuracy * energy_norm(&dz, compliance);
        // what the Gauss-Newton step leaves of the first equation
        let mut left: Vec<f64> = dz.iter().zip(compliance).map(|(dz, c)| shift * dz / c).collect();
        at.add_hessian_product(blocks, &dz, &mut left);
        let mut direction: Vec<f64> = vec![];
        let mut square = 0.0;
        for _ in 0..MOST_GRADIENTS {
            let gradient = self.project(at, &mut left, &mut dl);
            let next = dot_blocked(&left, &gradient);
            if !(next.sqrt() > wanted) {
                return (next >= 0.0).then_some(PrimalDualStep { dz, dl });
            }
            let part = if direction.is_empty() { 0.0 } else { next / square };
            direction.resize(gradient.len(), 0.0);
            direction.iter_mut().zip(&gradient).for_each(|(d, g)| *d = part * *d - g);
            square = next;
            let mut image: Vec<f64> = direction.iter().zip(compliance).map(|(d, c)| (1.0 + shift) * d / c).collect();
            at.add_hessian_product(blocks, &direction, &mut image);
            let curvature = dot_blocked(&direction, &image);
            if !(curvature > 0.0) {
                return None;
            }
            add_scaled(&mut dz, square / curvature, &direction);
            add_scaled(&mut left, square / curvature, &image);
        }
        Some(PrimalDualStep { dz, dl })
    }

    /// Returns `F^T S^-1 F` for values of the constraints: the squared energy norm of the shortest step that makes up
    /// for them.
    pub(super) fn cost_of_closing(&mut self, values: &[f64]) -> f64 {
        dot_blocked(values, &self.solve(values.to_vec()))
    }

    /// Takes the part `J^T m` out of a residual, puts it into the multipliers, and returns `D` times the rest, which is
    /// along the constraints.
    fn project(&mut self, at: &Derivatives, left: &mut [f64], dl: &mut [f64]) -> Vec<f64> {
        let (blocks, compliance) = (self.problem.blocks(), self.problem.compliance());
        let scaled: Vec<f64> = left.iter().zip(compliance).map(|(r, c)| c * r).collect();
        let part: Vec<f64> = self.solve(at.product(blocks, &scaled)).into_iter().map(|m| -m).collect();
        at.add_transpose_product(blocks, &part, left);
        add_scaled(dl, 1.0, &part);
        left.iter().zip(compliance).map(|(r, c)| c * r).collect()
    }
}

/// Returns the rows that each variable couples. If two blocks of several have no other variable in common, the clique
/// is split there: only this rank-one term couples them.
fn coupled(blocks: &Blocks, uses: &[Vec<(u32, u32)>]) -> Cliques {
    let pairs = |uses: &[(u32, u32)]| {
        let places = (0..uses.len()).flat_map(|b| (0..b).map(move |a| [a, b]));
        places.map(|pair| (pair, pair.map(|place| uses[place].0))).collect::<Vec<_>>()
    };
    let mut common: HashMap<[u32; 2], usize> = HashMap::new();
    let several = || uses.iter().filter(|uses| uses.len() > 2);
    several().flat_map(|uses| pairs(uses)).for_each(|(_, pair)| *common.entry(pair).or_default() += 1);
    let mut cliques = Cliques::new();
    for uses in uses {
        let rows = |place: usize| blocks.rows(uses[place].0 as usize);
        let members = (0..uses.len()).flat_map(rows).map(|row| row as u32);
        let range = |place: usize| {
            let start: usize = (0..place).map(|before| rows(before).len()).sum();
            start as u32..(start + rows(place).len()) as u32
        };
        let mut alone = pairs(uses).into_iter().filter(|(_, pair)| uses.len() > 2 && common[pair] == 1);
        match alone.next() {
            Some(([a, b], _)) => cliques.push_split(members, range(a), range(b)),
            None => cliques.push(members),
        }
    }
    cliques
}

/// Returns `sqrt(v^T D^-1 v)`.
pub(super) fn energy_norm(v: &[f64], compliance: &[f64]) -> f64 {
    v.iter().zip(compliance).map(|(v, c)| v * v / c).sum::<f64>().sqrt()
}
