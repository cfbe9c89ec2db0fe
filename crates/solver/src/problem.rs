//! The problem that the solver minimises.

use super::layout::Layout;
use super::linearization::{HessianKind, Linearization};
use foldwell_numerics::larger;
use std::sync::Arc;
use thiserror::Error;

/// A soft energy with stiff measures: minimise `E(x) + sum_r m_r(x)^2 / (2 c_r)`.
pub trait Problem {
    /// Unknowns and couplings; the same at every state until [`Problem::choose_anew`] chooses others.
    fn layout(&self) -> &Arc<Layout>;
    /// Compliance `c = 1/k >= 0` of each stiff measure; zero makes it the constraint `m(x) = 0`.
    fn compliance(&self) -> &[f64];
    /// Natural size of each stiff measure's gap: a length for lengths, 1 for angles.
    fn gap_scale(&self) -> &[f64];
    /// Compliances of the stiff measures in proportion to each other, as if all were made of one material. Tensions
    /// that self stresses of rigid measures leave free are those of measures that are very stiff in this proportion.
    fn proportions(&self) -> Vec<f64> {
        vec![1.0; self.compliance().len()]
    }
    /// Natural size of the unknowns, which are lengths.
    fn unit_of_length(&self) -> f64 {
        1.0
    }
    /// Largest change of the measure of a soft element in one step, to first order; without one, steps of any length
    /// are tried.
    fn largest_change(&self) -> f64 {
        f64::INFINITY
    }
    /// Soft energy at `x`.
    fn energy(&self, x: &[f64]) -> f64;
    /// Gaps of the stiff measures at `x`: each measure minus its rest value.
    fn gaps(&self, x: &[f64]) -> Vec<f64>;
    /// Fills `out` at `(x, tension)`. The gradient there is that of the soft energy: products of tensions with the
    /// Jacobian are not part of it, those with the Hessians of the stiff measures are part of the Hessian.
    fn linearize(&self, x: &[f64], tension: &[f64], kind: HessianKind, out: &mut Linearization);
    /// Adds terms to the Hessian that make it regular along motions that cost nothing, where there are any; forces stay
    /// as they are.
    fn hold(&self, _tension: &[f64], _out: &mut Linearization) {}
    /// Whether a step from the accepted state `from` to `to` is short enough for the problem to be what its derivatives
    /// say, as one that turns an angle too far or flattens a triangle is not.
    fn admits(&self, _from: &[f64], _to: &[f64]) -> bool {
        true
    }
    /// Why a state is none of which derivatives tell anything, as one with a triangle without height; `None` for other
    /// states.
    fn breakdown(&self, _x: &[f64]) -> Option<Collapse> {
        None
    }
    /// Sees every accepted state; may write the same state in other coordinates.
    fn accept(&mut self, x: &mut [f64]);
    /// Sees every accepted state; may move it as a whole where that lowers the soft energy and changes no gap. Returns
    /// by how much the energy fell.
    fn relieve(&mut self, _x: &mut [f64]) -> f64 {
        0.0
    }
    /// Chooses anew how states are written as unknowns where the present choice would soon be singular. Returns then the
    /// unknowns of the accepted state `x`, and these rates of them.
    fn choose_anew(&mut self, _x: &[f64], _rates: &[f64]) -> Option<[Vec<f64>; 2]> {
        None
    }
}

/// A triangle that has lost its height, so that fold angles beside it mean nothing.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "the triangle of vertices {}, {} and {} has collapsed: its height is {quality:.0e} of its longest side, and fold angles mean \
     nothing beside it. Stiffer bars keep it open, or a start nearer to the equilibrium",
    vertices[0], vertices[1], vertices[2]
)]
pub struct Collapse {
    /// Numbers of its vertices, copies of the cell numbered one after the other.
    pub vertices: [usize; 3],
    /// Least height over longest side.
    pub quality: f64,
}

/// Distance of a state from equilibrium. A component is not a number where one of the numbers it is made of is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residuals {
    /// Largest unbalanced force on an unknown, relative to the largest force of a single element.
    pub force: f64,
    /// Largest gap `|m - c t|` of a stiff measure, relative to its natural size.
    pub length: f64,
}

impl Residuals {
    /// The residuals of a problem at the state of a linearization, with these tensions.
    pub fn new<P: Problem>(problem: &P, at: &Linearization, tension: &[f64]) -> Self {
        let unbalanced = at.force(tension).iter().fold(0.0f64, |m, f| larger(m, f.abs()));
        let open = at.gaps.iter().zip(tension).zip(problem.compliance()).map(|((m, t), c)| m - c * t);
        let length = open.zip(problem.gap_scale()).fold(0.0, |m, (o, s)| larger(m, o.abs() / s));
        Self { force: if unbalanced == 0.0 { 0.0 } else { unbalanced / at.largest_force }, length }
    }
}
