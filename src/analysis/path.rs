//! Paths: equilibria of an assembly along one driven quantity, through limit points, with branches on request.

mod stops;

use super::relax::relax_model;
use super::state::State;
use crate::model::{Assembly, Configuration, Drive, DriveError, DrivenModel, Element, Gauge, Memory, Model};
use crate::solver::path::ParametrizedProblem;
use crate::solver::path::{
    self, Branch, BranchEnd, MarkedState, PathError, PathMark, PathObserver, PathSettings, PathState,
};
pub use crate::solver::path::{HalfBranches, PathEntry, PathRecord};
use crate::solver::{Failure, Options, Problem, Start};
use stops::{CROSSING, Stops};
pub use stops::{PathStop, Probe};
use thiserror::Error;

/// Tolerance, steps and ends of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct PathOptions {
    /// Bound on both scaled residuals of every state.
    pub tolerance: f64,
    /// Longest step in arc length.
    pub max_step: f64,
    /// Whether the branches that leave at branch points are followed too.
    pub switch: bool,
    /// Conditions that end the path early.
    pub stop: PathStop,
    /// Driven values of which the states are points of their own, wherever the path passes them.
    pub at: Vec<f64>,
    /// Driven values to which the drive goes, one after the other, when it has come to the end that it names: to and fro.
    pub then: Vec<f64>,
}

impl Default for PathOptions {
    fn default() -> Self {
        Self { tolerance: 1e-12, max_step: 0.05, switch: false, stop: PathStop::default(), at: vec![], then: vec![] }
    }
}

/// A kind of special state, at which stability changes, branches meet or a stop is met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathEvent {
    /// The load has an extremum along the path.
    LimitLoad,
    /// The displacement has an extremum along the path.
    LimitDisplacement,
    /// Other equilibria leave the path.
    BranchPoint,
    /// Faces begin to pass through each other.
    SelfIntersection,
    /// A stop ends the path.
    Stop,
}

/// An equilibrium of a path.
#[derive(Clone, Debug)]
pub struct PathPoint {
    /// Arc length from the beginning of the branch, of the unknowns' root mean square in units of the mean edge length
    /// together with the drive in units of the whole way that it is driven.
    pub arc_length: f64,
    /// The driven value.
    pub drive: f64,
    /// The part of its way that the drive has gone: 0 at the beginning, 1 at the end.
    pub part: f64,
    /// Its conjugate: the force on a driven displacement, the torque of a driven angle, the displacement of loads.
    pub reaction: f64,
    /// Work that the drive has done on the sheet since the path began.
    pub work: f64,
    /// The state.
    pub state: State,
    /// Unknowns.
    pub x: Vec<f64>,
    /// Tensions of the stiff measures of the assembly's model without drive.
    pub tension: Vec<f64>,
    /// Angles of the elements, from which angles continue; see [`crate::model::Model::angles`].
    pub angles: Vec<f64>,
    /// Memories of the elements that yield; see [`Configuration::memory`].
    pub memory: Vec<Memory>,
    /// Largest unbalanced force over the largest force of an element.
    pub residual_force: f64,
    /// Largest gap of a stiff measure over its natural size.
    pub residual_length: f64,
    /// Negative eigenvalues of the Hessian while the driven value is held: 0 where the state is stable; `None` where
    /// their number cannot be established.
    pub negative_eigenvalues: Option<usize>,
    /// Newton steps made for this state.
    pub iterations: usize,
    /// The event that is located at this state; `None` for an ordinary state.
    pub event: Option<PathEvent>,
    /// The multiplicity and half branches where the event is a branch point; `None` for other events.
    pub branch_point: Option<BranchPoint>,
}

/// The multiplicity of a branch point, and the half branches that were found to leave it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BranchPoint {
    /// Number of eigenvalues that change their sign there.
    pub multiplicity: usize,
    /// The half branches that leave there; `None` where they were not sought, or sought at a state of another branch
    /// that is the same.
    pub half_branches: Option<HalfBranches>,
}

/// The reason for which a branch of a path ends.
#[derive(Clone, Debug, PartialEq)]
pub enum PathEnd {
    /// The drive arrived.
    Arrived,
    /// A stop was met.
    Stopped,
    /// A branch came back to the driven value at which the path began, or to a branch point that is known.
    Returned,
    /// A branch came back to a state of its own and would go on over its own states.
    Retraced,
    /// The largest number of states was reached.
    TooManySteps,
    /// No step, however short, led on.
    Failed,
    /// The observer asked to stop.
    Interrupted,
}

/// A branch of a path: number 0 begins at the start, the others at branch points.
#[derive(Clone, Debug)]
pub struct PathBranch {
    /// The states, in order.
    pub points: Vec<PathPoint>,
    /// The reason for its end.
    pub end: PathEnd,
}

/// The reason for which a path cannot begin.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum PathFailure {
    /// The drive has no effect.
    #[error(transparent)]
    Drive(#[from] DriveError),
    /// The relaxation from the start failed, for this reason.
    #[error("no equilibrium was found with which the path could begin: {0}")]
    Start(#[from] Failure),
    /// The path cannot be followed.
    #[error(transparent)]
    Path(#[from] PathError),
}

/// Follows the equilibria of an assembly while a quantity is driven, from the equilibrium next to `start` (the drawn
/// state if `None`). `observe` sees the number of the branch and every accepted state, and returns false to stop.
///
/// ```
/// use foldwell::analysis::path::{PathEvent, PathOptions, follow_path};
/// use foldwell::math::Vec3;
/// use foldwell::model::{Drive, Driven};
/// use foldwell::{Assembly, Pattern, generate};
///
/// // two bars between supports, pushed down at the vertex between them
/// let truss = generate(&Pattern::named("truss")?)?;
/// let assembly = Assembly::patch(truss, [1, 1])
///     .bars(1.0)
///     .pin(0, [0, 0], [true; 3])
///     .pin(2, [0, 0], [true; 3])
///     .pin(1, [0, 0], [false, true, false])
///     .build()?;
/// let quantity = Driven::Vertices { vertices: vec![1], direction: Vec3::new(0.0, 0.0, 1.0) };
/// let branches =
///     follow_path(&assembly, &Drive { quantity, to: -0.6 }, None, &PathOptions::default(), &mut |_, _| true)?;
/// let largest = branches[0].points.iter().find(|point| point.event == Some(PathEvent::LimitLoad));
/// // the largest force of two bars of length L0 is found where their length is the cube root of L0
/// assert!(largest.is_some_and(|point| (point.reaction + 9.530291997895e-3).abs() < 1e-12));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`PathFailure`] if the drive has no effect, or no equilibrium is found to begin with.
pub fn follow_path(
    assembly: &Assembly,
    drive: &Drive,
    start: Option<Configuration>,
    options: &PathOptions,
    observe: &mut dyn FnMut(usize, &PathPoint) -> bool,
) -> Result<Vec<PathBranch>, PathFailure> {
    resume_path(assembly, drive, start, options, PathRecord::default(), PathCallbacks { observe, keep: &mut |_| true })
}

/// Functions that are called while a path is followed: with each new state, and with each entry of the record of the
/// path.
pub struct PathCallbacks<'a> {
    /// Sees the number of the branch and every new state, and returns false to stop; not those of a record.
    pub observe: &'a mut dyn FnMut(usize, &PathPoint) -> bool,
    /// Sees every new entry of the record before `observe` sees its states, and returns false to stop.
    pub keep: &'a mut dyn FnMut(&PathEntry) -> bool,
}

/// Does the same as [`follow_path`], and goes on from what an interrupted run of the same path has recorded: of that
/// nothing is computed again.
///
/// # Errors
/// As [`follow_path`].
pub fn resume_path(
    assembly: &Assembly,
    drive: &Drive,
    start: Option<Configuration>,
    options: &PathOptions,
    record: PathRecord,
    callbacks: PathCallbacks<'_>,
) -> Result<Vec<PathBranch>, PathFailure> {
    let model = assembly.model(Gauge::Held);
    let measures = model.compliance().len();
    let (mut driven, first) = begin(model, drive, start, options)?;
    let settings = PathSettings {
        tolerance: options.tolerance,
        max_step: options.max_step,
        target: driven.target(),
        then: options.then.iter().map(|value| driven.parameter_at(*value)).collect(),
        listed: options.at.iter().map(|value| driven.parameter_at(*value)).collect(),
        length: options.stop.arc_length.unwrap_or(f64::INFINITY),
        switch: options.switch,
        ..PathSettings::default()
    };
    let settings = PathSettings { steps: options.stop.states.unwrap_or(settings.steps), ..settings };
    let mut watch = Stops::new(assembly, &options.stop, driven.has_conjugate_limits());
    let ways = [driven.parameter(), settings.target].into_iter().chain(settings.then.iter().copied()).collect();
    let mut seen = Seen { measures, ways, branches: vec![], callbacks };
    let found = path::follow_path(&mut driven, first, &settings, &mut watch, &mut seen, record)?;
    Ok(found.iter().zip(seen.branches).map(|(branch, (points, _))| ended(branch, points, &options.stop)).collect())
}

/// The points of a path so far, and its observers.
struct Seen<'a> {
    /// Number of stiff measures of the model without drive.
    measures: usize,
    /// Parameters at the beginning and at the ends of all ways.
    ways: Vec<f64>,
    /// The states of each branch, and how often its parameter has begun to go another way.
    branches: Vec<(Vec<PathPoint>, usize)>,
    callbacks: PathCallbacks<'a>,
}

impl PathObserver<DrivenModel> for Seen<'_> {
    fn state(&mut self, branch: usize, driven: &DrivenModel, marked: &MarkedState) -> bool {
        self.known_state(branch, driven, marked);
        self.branches[branch].0.last().is_none_or(|point| (self.callbacks.observe)(branch, point))
    }

    fn known_state(&mut self, branch: usize, driven: &DrivenModel, marked: &MarkedState) {
        self.branches.resize_with(self.branches.len().max(branch + 1), Default::default);
        let turns = self.branches[branch].1;
        let part = part_of(&self.ways, turns, marked.state.parameter);
        let (points, turns) = &mut self.branches[branch];
        points.push(PathPoint { part, ..point(driven, marked, self.measures) });
        *turns += usize::from(marked.mark == Some(PathMark::Turned));
    }

    fn entry(&mut self, entry: &PathEntry) -> bool {
        (self.callbacks.keep)(entry)
    }
}

/// The part of all ways that a parameter has gone on the way after this many turns.
fn part_of(ways: &[f64], turns: usize, parameter: f64) -> f64 {
    let lengths = || ways.windows(2).map(|way| (way[1] - way[0]).abs());
    (lengths().take(turns).sum::<f64>() + (parameter - ways[turns]).abs()) / lengths().sum::<f64>()
}

/// Checks that a drive has an effect on an assembly, in its drawn state or, `restarted`, in another one. Returns the
/// driven values at the beginning and at the end of its way.
///
/// # Errors
/// [`DriveError`] if it has none.
pub fn check_drive(assembly: &Assembly, drive: &Drive, restarted: bool) -> Result<[f64; 2], DriveError> {
    let model = assembly.model(Gauge::Held);
    let drawn = model.values(&model.start());
    let driven = DrivenModel::new(model, drive, drawn, restarted)?;
    Ok([driven.drive_at(driven.parameter()), drive.to])
}

/// Makes the driven model and finds its equilibrium at the beginning.
fn begin(
    mut model: Model,
    drive: &Drive,
    start: Option<Configuration>,
    options: &PathOptions,
) -> Result<(DrivenModel, Start), PathFailure> {
    let drawn = model.values(&model.start());
    let restarted = start.is_some();
    let tension = start.and_then(|state| {
        let Start { x, tension } = model.enter(&state);
        if !model.gauge_is_valid(&x) {
            model.rebase_gauge(state.coordinates);
        }
        tension
    });
    let mut driven = DrivenModel::new(model, drive, drawn, restarted)?;
    let x = driven.model.start();
    let (x, tension) = if let Some(mut tension) = tension {
        // an equilibrium of any stability: the path's own iteration finds what the new support carries
        tension.resize(driven.compliance().len(), 0.0);
        (x, tension)
    } else {
        let newton = Options { tolerance: options.tolerance, ..Options::default() };
        let (relaxed, model, x) =
            relax_model(driven.model.clone(), x, newton, &mut |_| true).map_err(|error| error.failure)?;
        driven.model = model;
        (x, relaxed.configuration.tension.unwrap_or_default())
    };
    let x = driven.about_best_axis(x, &tension);
    Ok((driven, Start { x, tension: Some(tension) }))
}

fn point(driven: &DrivenModel, marked: &MarkedState, measures: usize) -> PathPoint {
    let MarkedState { state, mark, work, .. } = marked;
    let PathState { x, tension, parameter, conjugate: [conjugate, _], .. } = state;
    PathPoint {
        arc_length: state.arc_length,
        drive: driven.drive_at(*parameter),
        part: f64::NAN,
        reaction: driven.reaction_of(*conjugate, *parameter),
        work: driven.work_of(*work, *conjugate, *parameter),
        state: State::new(&driven.model, x, tension),
        x: x.clone(),
        tension: tension[..measures].to_vec(),
        angles: angles_at(&driven.model, x),
        memory: driven.model.memory_after(x),
        residual_force: state.residual_force,
        residual_length: state.residual_length,
        negative_eigenvalues: state.negative_eigenvalues,
        iterations: state.iterations,
        event: mark.and_then(|mark| event(driven, mark)),
        branch_point: mark.and_then(branch_point),
    }
}

fn branch_point(mark: PathMark) -> Option<BranchPoint> {
    let PathMark::BranchPoint(multiplicity) = mark else { return None };
    Some(BranchPoint { multiplicity, half_branches: None })
}

fn event(driven: &DrivenModel, mark: PathMark) -> Option<PathEvent> {
    match (mark, driven.is_load()) {
        (PathMark::ParameterTurns, true) => Some(PathEvent::LimitLoad),
        (PathMark::ParameterTurns, false) => Some(PathEvent::LimitDisplacement),
        (PathMark::ConjugateTurns, _) if !driven.has_conjugate_limits() => None,
        (PathMark::ConjugateTurns, true) => Some(PathEvent::LimitDisplacement),
        (PathMark::ConjugateTurns, false) => Some(PathEvent::LimitLoad),
        (PathMark::BranchPoint(_), _) => Some(PathEvent::BranchPoint),
        (PathMark::Watched(CROSSING), _) => Some(PathEvent::SelfIntersection),
        (PathMark::Watched(_), _) => Some(PathEvent::Stop),
        (PathMark::Listed | PathMark::Turned, _) => None,
    }
}

fn ended(branch: &Branch, mut points: Vec<PathPoint>, stop: &PathStop) -> PathBranch {
    let end = match branch.end {
        BranchEnd::Target => PathEnd::Arrived,
        BranchEnd::Returned => PathEnd::Returned,
        BranchEnd::Retraced => PathEnd::Retraced,
        BranchEnd::Length | BranchEnd::Marked => PathEnd::Stopped,
        BranchEnd::Steps if stop.states.is_some() => PathEnd::Stopped,
        BranchEnd::Steps => PathEnd::TooManySteps,
        BranchEnd::Failed => PathEnd::Failed,
        BranchEnd::Interrupted => PathEnd::Interrupted,
    };
    if matches!(branch.end, BranchEnd::Length | BranchEnd::Steps)
        && end == PathEnd::Stopped
        && let Some(last) = points.last_mut()
    {
        last.event = Some(PathEvent::Stop);
    }
    for (state, found) in &branch.half_branches {
        if let Some(point) = points.get_mut(*state).and_then(|point| point.branch_point.as_mut()) {
            point.half_branches = Some(*found);
        }
    }
    PathBranch { points, end }
}

impl PathPoint {
    /// The state as one from which another analysis begins.
    pub fn configuration(&self) -> Configuration {
        let Self { state, angles, tension, memory, .. } = self.clone();
        Configuration { coordinates: state.coordinates, angles, tension: Some(tension), memory }
    }
}

/// Values of all angles of a model, in the order of [`Model::angles`].
fn angles_at(model: &Model, x: &[f64]) -> Vec<f64> {
    let all = model.coordinates(x);
    model.elements().filter(Element::is_angle).map(|hinge| hinge.value(&all)).collect()
}
