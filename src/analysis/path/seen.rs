//! The points of a path while it is followed.
//!
//! A sheet that snaps has a path of several stretches: each ends at a limit point, and the next one begins at the minimum
//! to which the sheet snaps from there. Their points make one branch.

use super::options::PathOptions;
use super::point::{PathBranch, PathEnd, PathEvent, PathPoint, point};
use super::stops::PathStop;
use crate::model::DrivenModel;
use crate::solver::path::{MarkedState, PathEntry, PathMark, PathObserver, PathSettings, PathState};

/// Functions that are called while a path is followed: with each new state, and with each entry of the record of the
/// path.
pub struct PathCallbacks<'a> {
    /// Sees the number of the branch and every new state, and returns false to stop; not those of a record.
    pub observe: &'a mut dyn FnMut(usize, &PathPoint) -> bool,
    /// Sees every new entry of the record before `observe` sees its states, and returns false to stop.
    pub keep: &'a mut dyn FnMut(&PathEntry) -> bool,
}

/// The points of a path so far, and its observers.
pub(super) struct Seen<'a> {
    /// Parameters at the beginning and at the ends of all ways.
    ways: Vec<f64>,
    /// The states of each branch, and how often its parameter has begun to go another way.
    branches: Vec<(Vec<PathPoint>, usize)>,
    /// Sums over the stretches before the one that is followed.
    before: Before,
    callbacks: PathCallbacks<'a>,
}

/// Sums over the stretches of a path that have ended, and where the last one did.
#[derive(Default)]
struct Before {
    /// Number of these stretches.
    stretches: usize,
    /// Number of their states.
    points: usize,
    /// Sum of their arc lengths.
    arc_length: f64,
    /// Integral of the conjugate over the parameter.
    work: f64,
    /// The parameter at the limit point at which the last one ended.
    parameter: f64,
}

impl<'a> Seen<'a> {
    /// No points yet of a path whose parameter goes these ways.
    pub(super) fn new(ways: Vec<f64>, callbacks: PathCallbacks<'a>) -> Self {
        Self { ways, branches: vec![], before: Before::default(), callbacks }
    }

    /// The number of the stretch that is followed.
    pub(super) fn stretch(&self) -> usize {
        self.before.stretches
    }

    /// The states of each branch.
    pub(super) fn points(self) -> impl Iterator<Item = Vec<PathPoint>> {
        self.branches.into_iter().map(|(points, _)| points)
    }

    /// The branches, which end for this reason.
    pub(super) fn ended(self, end: PathEnd) -> Vec<PathBranch> {
        self.points().map(|points| PathBranch { points, end: end.clone() }).collect()
    }

    /// How often the parameter of the first branch has begun to go another way.
    fn turns(&self) -> usize {
        self.branches.first().map_or(0, |(_, turns)| *turns)
    }

    /// The parameter to which the present way of the first branch goes.
    pub(super) fn target(&self) -> f64 {
        self.ways[self.turns() + 1]
    }

    /// The settings of the next stretch.
    pub(super) fn settings(&self, options: &PathOptions, stop: &PathStop, driven: &DrivenModel) -> PathSettings {
        let settings = PathSettings {
            tolerance: options.tolerance,
            max_step: options.max_step,
            target: self.target(),
            then: self.ways[self.turns() + 2..].to_vec(),
            returns: driven.is_stiffness(),
            listed: options.at.iter().map(|value| driven.parameter_at(*value)).collect(),
            length: stop.arc_length.unwrap_or(f64::INFINITY),
            switch: options.switch && !options.snap,
            ..PathSettings::default()
        };
        PathSettings { steps: stop.states.unwrap_or(settings.steps), ..settings }
    }

    /// The stops of the next stretch: lengths and counts less those of the stretches before it.
    pub(super) fn left_of(&self, stop: &PathStop) -> PathStop {
        PathStop {
            arc_length: stop.arc_length.map(|length| length - self.before.arc_length),
            states: stop.states.map(|most| most.saturating_sub(self.before.points)),
            limit_points: stop.limit_points.map(|most| most.saturating_sub(self.limits())),
            ..stop.clone()
        }
    }

    /// Whether the path has passed as many limit points, or has as many states, as end it.
    pub(super) fn has_enough(&self, stop: &PathStop) -> bool {
        let states = self.branches.first().map_or(0, |(points, _)| points.len());
        stop.limit_points.is_some_and(|most| self.limits() >= most) || stop.states.is_some_and(|most| states >= most)
    }

    /// Number of limit points so far.
    fn limits(&self) -> usize {
        let is_limit = |event| matches!(event, PathEvent::LimitLoad | PathEvent::LimitDisplacement);
        let points = self.branches.iter().flat_map(|(points, _)| points);
        points.filter(|point| point.event.is_some_and(is_limit)).count()
    }

    /// Begins another stretch after one that ended at a limit point.
    pub(super) fn begin_stretch(&mut self, limit: &MarkedState) {
        self.before = Before {
            stretches: self.before.stretches + 1,
            points: self.branches[0].0.len(),
            arc_length: self.before.arc_length + limit.state.arc_length,
            work: self.before.work + limit.work,
            parameter: limit.state.parameter,
        };
    }
}

impl PathObserver<DrivenModel> for Seen<'_> {
    fn state(&mut self, branch: usize, driven: &DrivenModel, marked: &MarkedState) -> bool {
        self.known_state(branch, driven, marked);
        self.branches[branch].0.last().is_none_or(|point| (self.callbacks.observe)(branch, point))
    }

    fn known_state(&mut self, branch: usize, driven: &DrivenModel, marked: &MarkedState) {
        self.branches.resize_with(self.branches.len().max(branch + 1), Default::default);
        let snapped = self.before.stretches > 0 && self.branches[branch].0.len() == self.before.points;
        let PathState { parameter, conjugate: [conjugate, _], .. } = marked.state;
        if snapped {
            self.before.work += conjugate * (parameter - self.before.parameter);
        }
        let turns = self.branches[branch].1;
        let part = part_of(&self.ways, turns, parameter);
        let (points, turns) = &mut self.branches[branch];
        let found = point(driven, marked);
        points.push(PathPoint {
            part,
            arc_length: self.before.arc_length + marked.state.arc_length,
            work: driven.work_of(self.before.work + marked.work, conjugate, parameter),
            event: if snapped { Some(PathEvent::Snap) } else { found.event },
            ..found
        });
        *turns += usize::from(marked.mark == Some(PathMark::Turned));
    }

    fn entry(&mut self, entry: &PathEntry) -> bool {
        let branch = entry.branch + self.before.stretches;
        (self.callbacks.keep)(&PathEntry { branch, ..entry.clone() })
    }
}

/// The part of all ways that a parameter has gone on the way after this many turns.
fn part_of(ways: &[f64], turns: usize, parameter: f64) -> f64 {
    let lengths = || ways.windows(2).map(|way| (way[1] - way[0]).abs());
    (lengths().take(turns).sum::<f64>() + (parameter - ways[turns]).abs()) / lengths().sum::<f64>()
}
