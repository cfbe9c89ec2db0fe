//! Stops: conditions that end a path before the driven value reaches its target.

use crate::analysis::intersections::SelfIntersection;
use crate::analysis::state::{State, cylinder};
use crate::math::fold_angle::fold_angle;
use crate::model::{Assembly, DrivenModel, Model};
use crate::solver::path::{ParametrizedProblem, PathMark, PathState, Watch};
use crate::solver::{Linearization, Problem, Start};
use std::f64::consts::TAU;

/// Numbers of the watched functions.
const CREASE_ANGLE: usize = 0;
pub(super) const CROSSING: usize = 1;
const CURVATURE: usize = 2;
const DRIVE: usize = 3;
const DISPLACEMENT: usize = 4;
const REACTION: usize = 5;

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
    /// A probe, and its displacement at which the path ends.
    pub displacement: Option<(Probe, f64)>,
    /// Driven value at which the path ends.
    pub drive: Option<f64>,
    /// [Reaction](super::PathPoint::reaction) at which the path ends.
    pub reaction: Option<f64>,
    /// Number of states with which a branch ends.
    pub states: Option<usize>,
    /// Number of limit points at the last of which a branch ends.
    pub limit_points: Option<usize>,
}

/// A quantity that is read from every state: the mean displacement of some vertices of a patch along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Numbers of the vertices.
    pub vertices: Vec<usize>,
    /// The axis: 0, 1 or 2.
    pub axis: usize,
}

impl Probe {
    /// The displacement from the drawn state to one with these coordinates, in units of length.
    pub fn displacement(&self, assembly: &Assembly, coordinates: &[f64]) -> f64 {
        let drawn = &assembly.drawn().coordinates;
        let moved = self.vertices.iter().map(|vertex| 3 * vertex + self.axis).map(|k| coordinates[k] - drawn[k]);
        moved.sum::<f64>() / self.vertices.len() as f64
    }
}

/// The stops of a path as watched functions.
pub(super) struct Stops<'a> {
    assembly: &'a Assembly,
    stop: &'a PathStop,
    /// Whether extrema of the reaction are limit points.
    has_conjugate_limits: bool,
    /// The crease's angle in the last state that was asked for, from which angles continue.
    last_angle: f64,
    crossing: Option<SelfIntersection>,
    /// Whether the path ends where the driven value turns back.
    snap: bool,
}

impl<'a> Stops<'a> {
    pub(super) fn new(assembly: &'a Assembly, stop: &'a PathStop, has_conjugate_limits: bool, snap: bool) -> Self {
        let crossing = stop.self_intersection.then(|| SelfIntersection::new(assembly));
        let last_angle = stop.crease_angle.map_or(0.0, |(edge, _)| assembly.drawn_angles()[edge]);
        Self { assembly, stop, has_conjugate_limits, last_angle, crossing, snap }
    }

    /// The watched crease's angle less the one at which to stop.
    fn angle(&mut self, model: &Model, coordinates: &[f64]) -> Option<f64> {
        let (edge, wanted) = self.stop.crease_angle?;
        let sites = self.assembly.tiling().edges[edge].hinge()?;
        let angle = fold_angle(model.domain().points(coordinates, &sites));
        self.last_angle = angle + TAU * ((self.last_angle - angle) / TAU).round();
        Some(self.last_angle - wanted)
    }

    /// The magnitude of the curvature less the one at which to stop.
    fn curvature(&self, coordinates: &[f64]) -> Option<f64> {
        Some(cylinder(self.assembly.drawn(), coordinates)?.curvature.abs() - self.stop.curvature?)
    }

    /// 1 where faces pass through each other, -1 elsewhere.
    fn crosses(&mut self, driven: &DrivenModel, x: &[f64], tension: &[f64]) -> Option<f64> {
        let finder = self.crossing.as_mut()?;
        let shown = State::new(&driven.model, x, tension);
        let any = finder.marks(self.assembly.drawn(), &shown).any;
        Some(if any { 1.0 } else { -1.0 })
    }

    /// The values of all watched functions in a state with these unknowns and tensions, this parameter and its conjugate;
    /// not numbers where nothing is watched.
    fn values_at(
        &mut self,
        driven: &DrivenModel,
        (x, tension): (&[f64], &[f64]),
        [parameter, conjugate]: [f64; 2],
    ) -> Vec<f64> {
        let coordinates = driven.model.coordinates(x);
        let mut values = vec![f64::NAN; 6];
        values[CURVATURE] = self.curvature(&coordinates).unwrap_or(f64::NAN);
        values[CREASE_ANGLE] = self.angle(&driven.model, &coordinates).unwrap_or(f64::NAN);
        values[CROSSING] = self.crosses(driven, x, tension).unwrap_or(f64::NAN);
        let drive = driven.drive_at(parameter);
        values[DRIVE] = self.stop.drive.map_or(f64::NAN, |wanted| drive - wanted);
        let displacement = self.stop.displacement.as_ref();
        let off = |(probe, wanted): &(Probe, f64)| probe.displacement(self.assembly, &coordinates) - wanted;
        values[DISPLACEMENT] = displacement.map_or(f64::NAN, off);
        let reaction = driven.reaction_of(conjugate, parameter);
        values[REACTION] = self.stop.reaction.map_or(f64::NAN, |wanted| reaction - wanted);
        values
    }

    /// Whether a watched function, but the driven value itself, changes its sign between a state of a path and the start
    /// of another stretch.
    pub(super) fn passes(&mut self, driven: &DrivenModel, before: &[f64], start: &Start) -> bool {
        let tension = start.tension.as_deref().unwrap_or_default();
        let at = Linearization::new(driven.layout());
        let conjugate = driven.conjugate(&at, &start.x, tension);
        let after = self.values_at(driven, (&start.x, tension), [driven.parameter(), conjugate]);
        let pairs = before.iter().zip(&after).enumerate();
        pairs.into_iter().any(|(function, (before, after))| function != DRIVE && before * after < 0.0)
    }
}

impl Watch<DrivenModel> for Stops<'_> {
    fn values(&mut self, driven: &DrivenModel, state: &PathState) -> Vec<f64> {
        self.values_at(driven, (&state.x, &state.tension), [state.parameter, state.conjugate[0]])
    }

    fn ends(&self, marks: &[PathMark]) -> bool {
        let is_limit = |mark: &PathMark| match mark {
            PathMark::ParameterTurns => true,
            PathMark::ConjugateTurns => self.has_conjugate_limits,
            _ => false,
        };
        let Some(last) = marks.last() else { return false };
        let enough =
            || self.stop.limit_points.is_some_and(|most| marks.iter().filter(|mark| is_limit(mark)).count() >= most);
        let snaps = self.snap && *last == PathMark::ParameterTurns;
        snaps || matches!(last, PathMark::Watched(_)) || (is_limit(last) && enough())
    }
}
