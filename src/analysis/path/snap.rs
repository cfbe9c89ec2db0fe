//! Snapping: from a limit point, beyond which the driven value cannot grow along the path, to the minimum beyond.

use crate::analysis::relax::relax_model;
use crate::model::DrivenModel;
use crate::solver::path::{Branch, BranchEnd, MarkedState, ParametrizedProblem, PathMark};
use crate::solver::{Options, Start};

/// Part of the whole way by which a limit point is passed: the state at it is where two equilibria meet.
const BEYOND: f64 = 0.005;

/// The limit point of the driven value at which a branch ends; `None` if it ends elsewhere.
pub(super) fn limit_point(branch: &Branch) -> Option<&MarkedState> {
    let last = branch.states.last().filter(|last| last.mark == Some(PathMark::ParameterTurns))?;
    (branch.end == BranchEnd::Marked).then_some(last)
}

/// Takes a model that is driven to `target` from the state `x` at a limit point to the minimum a little beyond, but
/// neither to the target nor over one of the parameters `kept`, of which the path has states of their own. `None` if
/// none is found.
pub(super) fn beyond(driven: &mut DrivenModel, x: &[f64], target: f64, kept: &[f64], tolerance: f64) -> Option<Start> {
    let (from, step) = (driven.parameter(), BEYOND * driven.parameter_scale());
    let way = (target - from).signum();
    let ahead = kept.iter().chain([&target]).map(|value| (value - from) * way);
    let step = ahead.filter(|distance| *distance > 0.0).fold(step, |step, distance| step.min(0.5 * distance));
    driven.set_parameter(from + step * way);
    let options = Options { tolerance, ..Options::default() };
    let (relaxed, model, x) = relax_model(driven.model.clone(), x.to_vec(), options, &mut |_| true).ok()?;
    if relaxed.negative_eigenvalues != Some(0) {
        return None;
    }
    driven.model = model;
    let tension = relaxed.configuration.tension.unwrap_or_default();
    let x = driven.about_best_axis(x, &tension);
    Some(Start { x, tension: Some(tension) })
}
