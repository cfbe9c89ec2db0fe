//! The tangent problem at one state: the equations of equilibrium linearized there, factored, and solved.
//!
//! With it one asks for a single Newton step ([`Tangent::newton_step`]), for the number of negative eigenvalues
//! ([`Tangent::negative_eigenvalues`]) or for the response to forces and stretches ([`Tangent::solve`]) without an
//! iteration.

use super::corrections::IMPATIENT;
use super::kkt::{Increment, KktSystem};
use super::linearization::{HessianKind, Linearization};
use super::problem::Problem;
use foldwell_numerics::factor::{FactorError, Inertia};

/// A linearization and the factorization of its KKT system. One value serves many states, one after the other.
pub struct Tangent {
    /// The numbers of the problem at the state.
    pub at: Linearization,
    pub(super) system: KktSystem,
    pub(super) compliance: Vec<f64>,
}

impl Tangent {
    /// Makes room for the tangent problems of a problem.
    ///
    /// # Errors
    /// [`FactorError::TooLarge`] where memory or indices run out.
    pub fn new<P: Problem>(problem: &P) -> Result<Self, FactorError> {
        let layout = problem.layout();
        let (at, system) = (Linearization::new(layout), KktSystem::new(layout)?);
        Ok(Self { at, system, compliance: problem.compliance().to_vec() })
    }

    /// The tangent problem at the unknowns `x` with these tensions, not yet factored.
    ///
    /// # Errors
    /// As [`Tangent::new`].
    pub fn at_state<P: Problem>(
        problem: &P,
        x: &[f64],
        tension: &[f64],
        kind: HessianKind,
    ) -> Result<Self, FactorError> {
        let mut tangent = Self::new(problem)?;
        problem.linearize(x, tension, kind, &mut tangent.at);
        Ok(tangent)
    }

    /// Factors with `shift` times the metric added to the Hessian. Returns the inertia: without negative eigenvalues
    /// and without a shift the state is that of a minimum, on what the rigid measures leave free.
    ///
    /// # Errors
    /// [`FactorError`] where an entry is not finite, or a pivot vanishes.
    pub fn factor(&mut self, shift: f64) -> Result<Inertia, FactorError> {
        self.system.factor(&self.at, &self.compliance, shift)
    }

    /// Factors with a multiple of the identity instead of the Hessian: solves then give the shortest motion.
    ///
    /// # Errors
    /// As [`Tangent::factor`].
    pub fn factor_shortest(&mut self) -> Result<Inertia, FactorError> {
        self.system.factor_shortest(&self.at, &self.compliance)
    }

    /// The response of unknowns and tensions to a force on every unknown and a stretch of every stiff measure, by the
    /// last factorization and corrected until the relative residual is at most `tolerance` or no longer falls.
    pub fn solve(&mut self, force: &[f64], stretch: &[f64], tolerance: f64) -> Increment {
        self.system.solve(&self.at, force, stretch, tolerance)
    }

    /// The Newton step from this state with these tensions, as [`Tangent::solve`].
    pub fn newton_step(&mut self, tension: &[f64], tolerance: f64) -> Increment {
        self.newton_step_with(tension, (tolerance, IMPATIENT))
    }

    /// The Newton step as [`Tangent::newton_step`], with corrections that go on with this patience.
    pub(crate) fn newton_step_with(&mut self, tension: &[f64], (tolerance, patience): (f64, f64)) -> Increment {
        let missing = self.at.missing(tension, &self.compliance);
        let force = self.at.force(tension);
        self.system.solve_with(&self.at, [&force, &missing], (tolerance, patience))
    }
}
