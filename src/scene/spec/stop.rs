//! Where paths and traces stop, and what is read along a path.

use super::vertices::VertexSet;
use crate::scene::Located;
use crate::scene::values::{Count, EdgeName, Finite, Label, Positive};
use crate::sheet::angle::Angle;
use schemars::JsonSchema;
use serde::Deserialize;
use std::ops::Range;

/// `stop = { .. }`, with at least one condition.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StopSpec {
    /// Length of the trajectory in fold angles.
    pub arc_length: Option<Located<Positive>>,
    /// Magnitude of the curvature.
    pub curvature: Option<Located<Positive>>,
    /// A crease and the angle at which to stop.
    pub crease_angle: Option<CreaseAngle>,
    /// Whether to stop when faces first pass through each other.
    pub self_intersection: Option<bool>,
    /// Of a path: a value of the drive.
    pub drive: Option<Located<Finite>>,
    /// Of a path: a probe, and the displacement at which to stop.
    pub displacement: Option<ProbeValue>,
    /// Of a path: a value of the reaction.
    pub reaction: Option<Located<Finite>>,
    /// Of a path: a number of states.
    pub states: Option<Located<Count>>,
    /// Of a path: a number of limit points; it stops at the last of them.
    pub limit_points: Option<Located<Count>>,
}

/// `{ probe, value }`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProbeValue {
    /// Name of the probe.
    pub probe: Located<String>,
    /// Its displacement.
    pub value: Finite,
}

impl StopSpec {
    /// Whether it has no condition.
    pub(crate) fn is_empty(&self) -> bool {
        self.arc_length.is_none()
            && self.curvature.is_none()
            && self.crease_angle.is_none()
            && self.self_intersection != Some(true)
            && self.of_path().is_none()
    }

    /// The place of a condition that only paths have, if there is one.
    pub(crate) fn of_path(&self) -> Option<Range<usize>> {
        let Self { drive, displacement, reaction, states, limit_points, .. } = self;
        let numbers = [drive, reaction].map(|value| value.as_ref().map(Located::span));
        let counts = [states, limit_points].map(|count| count.as_ref().map(Located::span));
        let probe = displacement.as_ref().map(|stop| stop.probe.span());
        numbers.into_iter().chain(counts).chain([probe]).flatten().next()
    }
}

/// `{ crease, angle }`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CreaseAngle {
    /// The crease `[i, j, n1, n2]`.
    pub crease: Located<EdgeName>,
    /// Its fold angle.
    pub angle: Located<Angle>,
}

/// `{ name, vertices, axis }`: the mean displacement of vertices of a patch.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProbeSpec {
    /// Its name.
    pub name: Located<Label>,
    /// The vertices.
    pub vertices: Located<VertexSet>,
    /// The axis along which they move.
    pub axis: ProbeAxis,
}

/// An axis of the drawn state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ProbeAxis {
    /// x.
    X,
    /// y.
    Y,
    /// z.
    Z,
}
