//! Which way a flat state rolls up: the direction of the axis of a screw before there is any curvature.
//!
//! At zero curvature the axis of a screw has a direction but no meaning: turning it is turning the sheet. Folding then
//! starts about whatever axis the chart was given, and from a bad one Newton's method may end in a poor minimum. So
//! the axis is laid where the first Newton step promises the largest fall of the energy.

use crate::model::Gauge;
use crate::model::assemble::{Drawn, Recipe, Surroundings, assemble};
use crate::sheet::{Sheet, Tiling};
use crate::solver::saddle::Saddle;
use crate::solver::{Curvature, Linearization, Problem};
use std::f64::consts::PI;

/// Directions that are tried, evenly over half a turn.
const DIRECTIONS: usize = 24;
/// Shift that keeps the step finite along motions that cost nothing.
const SHIFT: f64 = 1e-2;

/// The drawn state of a model; that of a screw with its axis where folding starts best.
pub fn drawn_for(sheet: &Sheet, tiling: &Tiling, surroundings: Surroundings, recipe: &Recipe) -> Drawn {
    let plain = Drawn::new(sheet, tiling, surroundings);
    if surroundings != Surroundings::Screw {
        return plain;
    }
    let (mut best, mut most) = (plain, f64::NEG_INFINITY);
    for k in 0..DIRECTIONS {
        let drawn = Drawn::turned(sheet, tiling, surroundings, PI * k as f64 / DIRECTIONS as f64);
        let fall = promised_fall(&drawn, tiling, recipe).unwrap_or(0.0);
        if fall > most * (1.0 + 1e-6) || k == 0 {
            (best, most) = (drawn, fall);
        }
    }
    best
}

/// Fall of the energy along the first Newton step, to second order.
fn promised_fall(drawn: &Drawn, tiling: &Tiling, recipe: &Recipe) -> Option<f64> {
    let model = assemble(drawn, tiling, recipe, Gauge::Held);
    let layout = model.layout();
    let mut at = Linearization::new(layout);
    let tension = vec![0.0; layout.stiff.len()];
    model.linearize(&model.start(), &tension, Curvature::GaussNewton, &mut at);
    let mut saddle = Saddle::new(layout, &at).ok()?;
    saddle.factor(layout, &at, model.compliance(), SHIFT).ok()?;
    let force = at.force(layout, &tension);
    let step = saddle.solve(layout, &at, model.compliance(), (&force, &tension), 1e-8);
    Some(force.iter().zip(&step.dx).map(|(f, d)| f * d).sum::<f64>() / 2.0)
}
