//! Angles beyond 2 pi, which are taken for degrees and refused, and angles beyond pi, at which faces have passed
//! through each other.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use super::rest::RestSpec;
use super::spec::{StudyKind, StudySpec};
use super::{Located, SceneError, SceneFile};
use crate::model::Terms;

/// Returns description and correction of the error if the absolute value of an angle is larger than 2 pi.
pub(super) fn fault(angle: f64) -> Option<[String; 2]> {
    (angle.abs() > TAU).then(|| {
        let radians = angle.to_radians();
        [
            format!("the angle {angle} is more than a whole turn"),
            format!("angles are radians: {angle} degrees are {radians:.6} rad"),
        ]
    })
}

/// Checks that no angle of a scene is larger than 2 pi in absolute value.
pub(super) fn check(file: &SceneFile) -> Result<(), SceneError> {
    let scene = &file.scene;
    let at = |angle: f64, span: Range<usize>| match fault(angle) {
        Some([message, help]) => Err(file.error_at(span, message, help)),
        None => Ok(()),
    };
    for rest in rests(file) {
        rest.angles().into_iter().try_for_each(|angle| at(angle, rest.span()))?;
    }
    for angle in scene.locks.iter().filter_map(|lock| lock.angle.as_ref()) {
        at(angle.0, angle.span())?;
    }
    scene.studies.iter().filter_map(stop_angle).try_for_each(|angle| at(angle.0, angle.span()))
}

/// Returns the rest angles that the scene gives creases and facets.
fn rests(file: &SceneFile) -> impl Iterator<Item = &Located<RestSpec>> {
    let energy = &file.scene.energy;
    let creases = energy.creases.as_ref().and_then(|creases| creases.rest.as_ref());
    let facets = energy.facets.as_ref().and_then(|facets| facets.rest.as_ref());
    creases.into_iter().chain(facets)
}

fn stop_angle(study: &StudySpec) -> Option<&Located<super::values::Finite>> {
    let stop = match &*study.kind {
        StudyKind::Trace(trace) => trace.stop.as_ref(),
        StudyKind::Path(path) => path.stop.as_ref(),
        _ => None,
    };
    Some(&stop?.crease_angle.as_ref()?.angle)
}

/// Returns remarks about rest angles and locks beyond pi, which are allowed.
pub(super) fn notes(file: &SceneFile, terms: &Terms) -> Vec<String> {
    let beyond = |angle: &f64| angle.abs() > PI;
    let through = "beyond pi (angles are radians), where the faces of a crease have passed through each other";
    let mut notes = Vec::new();
    let energy = &file.scene.energy;
    let given = [
        (&terms.creases, energy.creases.as_ref().is_some_and(|creases| creases.rest.is_some())),
        (&terms.facets, energy.facets.as_ref().is_some_and(|facets| facets.rest.is_some())),
    ];
    let given = given.into_iter().filter(|(_, given)| *given).flat_map(|(hinges, _)| hinges);
    let rest = given.flat_map(|hinges| &hinges.rest).filter(|angle| beyond(angle)).count();
    if rest > 0 {
        notes.push(format!("{rest} rest angles are {through}"));
    }
    let locks =
        file.scene.locks.iter().filter(|lock| lock.angle.as_ref().is_some_and(|angle| beyond(&angle.0))).count();
    if locks > 0 {
        notes.push(format!("{locks} of the angles of locks are {through}"));
    }
    notes
}
