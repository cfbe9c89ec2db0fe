//! Where a minimisation begins and when it stops.

/// Tolerance and number of steps of a minimisation.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Largest scaled residual, of force and of length, of a converged state.
    pub tolerance: f64,
    /// Largest number of accepted steps.
    pub iterations: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { tolerance: 1e-12, iterations: 200 }
    }
}

/// The state in which a minimisation begins.
#[derive(Clone, Debug)]
pub struct Start {
    /// Unknowns.
    pub x: Vec<f64>,
    /// Tensions of the stiff measures near a solution, if they are known: the first steps then use the full Hessian.
    pub tension: Option<Vec<f64>>,
}

impl From<Vec<f64>> for Start {
    fn from(x: Vec<f64>) -> Self {
        Self { x, tension: None }
    }
}
