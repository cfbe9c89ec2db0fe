//! How large the forces of rigid measures are, beside those that they balance.

use crate::model::Model;
use crate::solver::{Equilibrium, HessianKind, Linearization, Problem};

/// The largest force of a rigid measure over the largest one of all others.
pub(super) fn rigid_over_others(model: &Model, found: &Equilibrium) -> f64 {
    let mut at = Linearization::new(model.layout());
    let mut largest = |tension: &[f64]| {
        model.linearize(&found.x, tension, HessianKind::GaussNewton, &mut at);
        at.largest_force
    };
    let of_others: Vec<f64> =
        found.tension.iter().zip(model.compliance()).map(|(t, c)| if *c == 0.0 { 0.0 } else { *t }).collect();
    largest(&found.tension) / largest(&of_others)
}
