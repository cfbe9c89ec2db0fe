//! Supports: linear functions of the generalised coordinates that keep a value exactly.
//!
//! A guide keeps the coordinate of a vertex along a direction, and a driven displacement is moved along one. Each
//! enters with a tension of its own, the force of the support.

/// A linear function of generalised coordinates with a prescribed value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Support {
    /// Numbers of the generalised coordinates, and their coefficients.
    pub terms: Vec<(usize, f64)>,
    /// The prescribed value: a length, or an angle in radians.
    pub rest: f64,
    /// Whether the value is an angle.
    pub is_angle: bool,
}

impl Support {
    /// The value of the function.
    pub(super) fn value(&self, generalised: &[f64]) -> f64 {
        self.terms.iter().map(|(k, factor)| factor * generalised[*k]).sum()
    }
}
