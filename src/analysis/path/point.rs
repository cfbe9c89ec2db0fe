//! The branches of a path: their states, events and ends.

use crate::analysis::path::stops::CROSSING;
use crate::analysis::state::State;
use crate::model::{Configuration, DrivenModel, Element, Memory, Model};
use crate::solver::path::{HalfBranches, MarkedState, PathMark, PathState};

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
    /// The sheet has come from a limit point to the minimum beyond.
    Snap,
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
    /// No minimum was found beyond the limit point at which it ends.
    NoMinimum,
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

impl PathPoint {
    /// The state as one from which another analysis begins.
    pub fn configuration(&self) -> Configuration {
        let Self { state, angles, tension, memory, .. } = self.clone();
        Configuration { coordinates: state.coordinates, angles, tension: Some(tension), memory }
    }
}

/// Makes the point of a state, but for what depends on those before.
pub(super) fn point(driven: &DrivenModel, marked: &MarkedState) -> PathPoint {
    let MarkedState { state, mark, negative_eigenvalues, .. } = marked;
    let PathState { x, tension, parameter, conjugate: [conjugate, _], .. } = state;
    PathPoint {
        arc_length: f64::NAN,
        drive: driven.drive_at(*parameter),
        part: f64::NAN,
        reaction: driven.reaction_of(*conjugate, *parameter),
        work: f64::NAN,
        state: State::new(&driven.model, x, tension),
        tension: driven.without_drive(tension),
        angles: angles_at(&driven.model, x),
        memory: driven.model.memory_after(x),
        residual_force: state.residual_force,
        residual_length: state.residual_length,
        negative_eigenvalues: *negative_eigenvalues,
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

/// Values of all angles of a model, in the order of [`Model::angles`].
fn angles_at(model: &Model, x: &[f64]) -> Vec<f64> {
    let all = model.coordinates(x);
    model.elements().filter(Element::is_angle).map(|hinge| hinge.value(&all)).collect()
}
