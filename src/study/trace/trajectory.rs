//! A trajectory of a study, how it ended, and its entry in the summary.

use super::summary::{ArcLength, ClosedTube, RayName, TraceSummary, TrajectorySummary, TurningPoint};
use crate::analysis::along::{AlongFailure, RelaxedTrajectory, StateAlong, cylinder_errors};
use crate::analysis::relax::Relaxed;
use crate::analysis::trace::{Folded, TURNING, Traced};
use crate::kinematics::RealDirections;
use crate::model::{Assembly, Domain};
use crate::numerics::{larger, worst};
use crate::output::figure::rounded;
use crate::scene::spec::Engine;
use crate::solver::Failure;
use crate::solver::continuation::{self, End};
use crate::study::{Context, branches};

/// A trajectory, with the relaxations at its states if they were computed.
pub(super) struct Path<'a> {
    pub traced: &'a Traced,
    pub relaxed: Option<&'a RelaxedTrajectory>,
    /// Largest number of its pictures, apart from that of the last state.
    pub pictures: usize,
}

impl Path<'_> {
    /// Returns the reason for which the trajectory did not reach its end; `None` if it did.
    pub fn failure(&self) -> Option<String> {
        let relaxation = self.relaxed.and_then(|relaxed| relaxed.failure);
        let (branch, sign) = self.traced.branch;
        let why = match (relaxation, &self.traced.end) {
            (Some(AlongFailure::Relaxation(Failure::Interrupted)), _) | (None, End::Interrupted) => {
                "interrupted".to_owned()
            }
            (Some(failure), _) => format!("a relaxation failed: {failure}"),
            (None, End::Failed) => "the trajectory did not come to its end: no step leads on".to_owned(),
            (None, End::Steps) => {
                let most = continuation::CurveOptions::default().steps;
                format!("the trajectory has not come to its end after {most} steps: raise max_step, or give a stop")
            }
            _ => return None,
        };
        Some(format!("branch {branch}, sign {sign}: {why}"))
    }

    /// Whether the observer asked to stop during the trajectory or its relaxations.
    pub fn interrupted(&self) -> bool {
        let relaxation = self.relaxed.and_then(|relaxed| relaxed.failure);
        self.traced.end == End::Interrupted || relaxation == Some(AlongFailure::Relaxation(Failure::Interrupted))
    }

    /// Number of states, up to the first at which a relaxation failed.
    pub fn len(&self) -> usize {
        let failed = self.relaxed.filter(|relaxed| relaxed.failure.is_some());
        failed.map_or(self.traced.states.len(), |relaxed| relaxed.states.len() + 1)
    }

    /// Returns the number of the state that the picture shows, and its description: the last state, or that half way
    /// along a closed trajectory.
    pub fn shown(&self) -> (usize, String) {
        let (states, (branch, sign)) = (&self.traced.states[..self.len()], self.traced.branch);
        let all = states.last().map_or(0.0, |state| state.arc_length);
        let closed = matches!(self.traced.end, End::Closed(_)) && self.failure().is_none();
        let half = states.partition_point(|state| state.arc_length < 0.5 * all);
        let step = if closed { half / self.every() * self.every() } else { states.len() - 1 };
        let at = rounded(states[step].arc_length, 4);
        let which = if closed {
            format!("half way along a closed trajectory of {}", rounded(all, 4))
        } else {
            "its end".into()
        };
        (step, format!("branch {branch}, sign {}1, arc length {at}: {which}", if sign < 0 { '\u{2212}' } else { '+' }))
    }

    /// Returns `n` such that every `n`-th state has a picture.
    pub fn every(&self) -> usize {
        self.len().div_ceil(self.pictures)
    }

    /// Returns the relaxation at a state; `None` at the drawn state, where trajectories begin and close.
    pub fn relaxed_at(&self, step: usize) -> Option<&StateAlong> {
        self.relaxed?.states.get(step.checked_sub(1)?)
    }

    /// Returns the largest residual: the scaled residual of the relaxations if there are any, otherwise that of
    /// closure. `None` if no relaxation has succeeded.
    pub fn residual(&self) -> Option<f64> {
        let of = |relaxed: &Relaxed| larger(relaxed.residual_force, relaxed.residual_length);
        match self.relaxed {
            Some(relaxed) => worst(relaxed.states.iter().map(|along| of(&along.relaxed))),
            None => worst(self.traced.states.iter().map(|state| state.residual)),
        }
    }
}

/// Whether a sheet is rolled up and closed along a seam.
pub(super) fn is_tube(assembly: &Assembly) -> bool {
    matches!(assembly.domain(), Domain::Tube { .. })
}

/// Returns the summary of these trajectories; `asked` says whether self-intersections were looked for.
pub(super) fn summary(context: &Context<'_>, paths: &[Path<'_>], engine: Engine, asked: bool) -> TraceSummary {
    let Some(first) = paths.first() else {
        let (directions, end) = (branches::word(RealDirections::Listed), "no-real-branch".to_owned());
        return TraceSummary { directions, branches: vec![TrajectorySummary { end, ..TrajectorySummary::default() }] };
    };
    let one = |path: &Path<'_>| TrajectorySummary {
        self_intersecting: asked.then_some(path.traced.first_self_intersection.is_some()),
        ..trajectory(context.assembly, path, engine)
    };
    TraceSummary { directions: branches::word(first.traced.directions), branches: paths.iter().map(one).collect() }
}

fn trajectory(assembly: &Assembly, path: &Path<'_>, engine: Engine) -> TrajectorySummary {
    let one = path.traced;
    let end = match one.end {
        _ if path.interrupted() => "interrupted",
        _ if path.failure().is_some() => "failed",
        End::Closed(_) => "closed",
        End::Stopped { .. } | End::Length => "stop",
        End::Steps | End::Failed | End::Interrupted => "failed",
    };
    let last = path.len().checked_sub(1).map(|last| &one.states[last]);
    let compared = path.relaxed.filter(|_| engine == Engine::Both);
    let errors = compared.and_then(|relaxed| cylinder_errors(assembly.drawn(), one, relaxed));
    let newton = |relaxed: &RelaxedTrajectory| relaxed.states.iter().map(|along| along.relaxed.iterations).sum();
    TrajectorySummary {
        branch: Some(one.branch.0),
        sign: Some(one.branch.1),
        closed: end == "closed",
        arc_length: last.map_or(0.0, |state| state.arc_length),
        steps: path.len() - 1,
        iterations: path.relaxed.map_or(one.corrections, newton),
        max_residual: path.residual(),
        ends_at: one.ends_at.map(|(branch, sign)| RayName { branch, sign }),
        end: end.to_owned(),
        self_intersecting: None,
        first_self_intersection: one.first_self_intersection.map(|arc_length| ArcLength { arc_length }),
        error_to_kinematic: compared.and_then(RelaxedTrajectory::error),
        error_of_curvature: errors.map(|errors| errors.curvature),
        error_of_strain: errors.map(|errors| errors.strain),
        error_of_theta: errors.map(|errors| errors.theta),
        turning_points: one.turning_points.iter().map(turning_point).collect(),
        closed_tubes: is_tube(assembly).then(|| one.closed_tubes.iter().map(closed_tube).collect()),
    }
}

fn turning_point((quantity, state): &(usize, Folded)) -> TurningPoint {
    let shape = state.shape.as_ref();
    let value =
        shape.map_or(f64::NAN, |shape| if *quantity == 0 { shape.curvature } else { shape.strain[quantity - 1] });
    TurningPoint { of: TURNING[*quantity].to_owned(), arc_length: state.arc_length, value }
}

fn closed_tube(state: &Folded) -> ClosedTube {
    let curvature = state.shape.as_ref().map_or(f64::NAN, |shape| shape.curvature);
    ClosedTube { arc_length: state.arc_length, curvature }
}
