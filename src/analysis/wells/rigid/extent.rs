//! The fold angles that belong to a landscape of rigid states.
//!
//! A crease folded by more than `pi` has led its panels through each other, unless it is meant to: with a rest angle
//! beyond `pi` it may be wound up to half a turn further than that. Angles of states are known modulo `2 pi` only, and
//! each of a state's images within these bounds is a state of its own, with its own energy.

use crate::analysis::exact::Springs;
use std::f64::consts::{PI, TAU};

/// Two stationary states are one where no angle differs by more, in radians.
pub(super) const SAME_STATE_ANGLE_RAD: f64 = 1e-7;

/// Bounds of the fold angle of every edge, in radians.
pub(super) struct Extent {
    bounds: Vec<[f64; 2]>,
}

impl Extent {
    /// The bounds for creases with these rest angles.
    pub(super) fn new(springs: &Springs) -> Self {
        let beyond = |rest: &f64| [if *rest < -PI { rest - PI } else { -PI }, if *rest > PI { rest + PI } else { PI }];
        Self { bounds: springs.rest.iter().map(beyond).collect() }
    }

    /// How far the furthest angle of an edge is beyond its bounds; negative within them.
    pub(super) fn excess(&self, angles: &[f64]) -> f64 {
        let beyond = angles.iter().zip(&self.bounds).map(|(angle, [least, most])| (least - angle).max(angle - most));
        beyond.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether a state belongs to the landscape.
    pub(super) fn holds(&self, angles: &[f64]) -> bool {
        self.excess(angles) <= 0.0
    }

    /// The images of a state that belong to the landscape.
    pub(super) fn images(&self, angles: &[f64]) -> Vec<Vec<f64>> {
        let mut images = vec![Vec::new()];
        for (angle, [least, most]) in angles.iter().zip(&self.bounds) {
            let first = angle + TAU * ((least - angle) / TAU).ceil();
            let count = ((most - first) / TAU).floor() as i64 + 1;
            let wound: Vec<f64> = (0..count).map(|turns| first + TAU * turns as f64).collect();
            let with = |image: &Vec<f64>, angle: &f64| -> Vec<f64> { image.iter().chain([angle]).copied().collect() };
            images = images.iter().flat_map(|image| wound.iter().map(move |angle| with(image, angle))).collect();
        }
        images
    }
}
