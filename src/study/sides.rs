//! The sides to which hinges are folded, beside those of their rest angles.

use super::Context;
use crate::model::{Configuration, Gauge};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The sides to which the creases and soft facets are folded that have a rest angle other than 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RestSides {
    /// Number of these creases and facets.
    pub hinges: usize,
    /// Number of those that are folded to the side of their rest angle.
    pub on_rest_side: usize,
    /// Largest angle between one of them and its rest angle, in radians.
    #[serde(default)]
    pub farthest: f64,
}

impl RestSides {
    /// The sides in a state whose rest angles are those of the scene.
    pub(super) fn of(context: &Context<'_>, state: &Configuration) -> Self {
        let mut model = context.assembly.model(Gauge::Held);
        let x = model.enter(state).x;
        let (hinges, on_rest_side, farthest) = model.hinges_on_rest_side(&x);
        Self { hinges, on_rest_side, farthest }
    }

    /// Says how many are on the side of their rest angles.
    pub(super) fn said([on_rest_side, hinges]: [usize; 2]) -> String {
        format!("{on_rest_side} of {hinges} hinges on the side of their rest angles")
    }
}
