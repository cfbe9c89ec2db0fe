//! Stops: conditions that end a path before the driven value reaches its target.

use crate::analysis::intersections::{STACKED_LAYERS_MARGIN, SelfIntersection};
use crate::analysis::state::{State, cylinder};
use crate::math::fold_angle::fold_angle;
use crate::model::{Assembly, DrivenModel, Model};
use crate::solver::path::{PathState, Watch};
use std::f64::consts::TAU;

/// Numbers of the watched functions.
const CREASE_ANGLE: usize = 0;
pub(super) const CROSSING: usize = 1;
const CURVATURE: usize = 2;

/// Conditions that end a path before the driven value reaches its target; the first that is met ends it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathStop {
    /// Arc length at which the path ends; see [`PathPoint::arc_length`](super::PathPoint::arc_length).
    pub arc_length: Option<f64>,
    /// Magnitude of the curvature at which the path of a periodic sheet ends, an inverse length.
    pub curvature: Option<f64>,
    /// Number of an edge of the tiling, and its fold angle in radians at which the path ends.
    pub crease_angle: Option<(usize, f64)>,
    /// Whether the path ends where faces first pass through each other.
    pub self_intersection: bool,
}

/// The stops of a path as watched functions.
pub(super) struct Stops<'a> {
    assembly: &'a Assembly,
    crease_angle: Option<(usize, f64)>,
    /// The crease's angle in the last state that was asked for, from which angles continue.
    last_angle: f64,
    curvature: Option<f64>,
    crossing: Option<SelfIntersection>,
}

impl<'a> Stops<'a> {
    pub(super) fn new(assembly: &'a Assembly, stop: &PathStop) -> Self {
        let crossing = stop.self_intersection.then(|| SelfIntersection::new(assembly));
        let last_angle = stop.crease_angle.map_or(0.0, |(edge, _)| assembly.drawn_angles()[edge]);
        Self { assembly, crease_angle: stop.crease_angle, last_angle, curvature: stop.curvature, crossing }
    }

    /// The watched crease's angle less the one at which to stop.
    fn angle(&mut self, model: &Model, coordinates: &[f64]) -> Option<f64> {
        let (edge, wanted) = self.crease_angle?;
        let sites = self.assembly.tiling().edges[edge].hinge()?;
        let angle = fold_angle(model.domain().points(coordinates, &sites));
        self.last_angle = angle + TAU * ((self.last_angle - angle) / TAU).round();
        Some(self.last_angle - wanted)
    }

    /// The magnitude of the curvature less the one at which to stop.
    fn curvature(&self, coordinates: &[f64]) -> Option<f64> {
        Some(cylinder(self.assembly.drawn(), coordinates)?.curvature.abs() - self.curvature?)
    }

    /// 1 where faces pass through each other, -1 elsewhere.
    fn crosses(&mut self, driven: &DrivenModel, state: &PathState) -> Option<f64> {
        let finder = self.crossing.as_mut()?;
        let shown = State::new(&driven.model, &state.x, &state.tension);
        let any = finder.marks(self.assembly.drawn(), &shown, STACKED_LAYERS_MARGIN).any;
        Some(if any { 1.0 } else { -1.0 })
    }
}

impl Watch<DrivenModel> for Stops<'_> {
    fn values(&mut self, driven: &DrivenModel, state: &PathState) -> Vec<f64> {
        let coordinates = driven.model.coordinates(&state.x);
        let mut values = vec![f64::NAN; 3];
        values[CURVATURE] = self.curvature(&coordinates).unwrap_or(f64::NAN);
        values[CREASE_ANGLE] = self.angle(&driven.model, &coordinates).unwrap_or(f64::NAN);
        values[CROSSING] = self.crosses(driven, state).unwrap_or(f64::NAN);
        values
    }

    fn ends(&self, _function: usize) -> bool {
        true
    }
}
