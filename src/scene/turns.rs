//! Numbers beyond pi that are given as angles, which are taken for degrees and refused; angles beyond pi that are
//! meant, at which faces have passed through each other.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use super::spec::{HingeLawSpec, StudyKind, StudySpec};
use super::{Located, SceneError, SceneFile};
use crate::model::Terms;
use crate::sheet::angle::Angle;

/// Returns description and correction of the error in an angle of a scene: it is beyond pi and has no unit, or it is
/// beyond 2 pi.
fn fault(angle: Angle) -> Option<[String; 2]> {
    let Angle { radians, has_unit } = angle;
    if !radians.is_finite() {
        return Some([format!("the number is {radians}"), "expected a finite number".into()]);
    }
    if has_unit || radians.abs() <= PI {
        return fault_of_turns(radians);
    }
    let mut help = format!("angles are radians; did you mean \"{radians} deg\", {:.6} rad?", radians.to_radians());
    if radians.abs() <= TAU {
        help.push_str(&format!(" An angle beyond pi is written with its unit, \"{radians} rad\""));
    }
    Some([format!("the angle {radians} is beyond pi"), help])
}

/// Returns description and correction of the error if an angle in radians, of a table for instance, is beyond 2 pi.
pub(super) fn fault_of_turns(angle: f64) -> Option<[String; 2]> {
    (angle.abs() > TAU).then(|| {
        let radians = angle.to_radians();
        [
            format!("the angle {angle} is more than a whole turn"),
            format!("angles are radians: {angle} degrees are {radians:.6} rad"),
        ]
    })
}

/// Checks all angles of a scene.
pub(super) fn check(file: &SceneFile) -> Result<(), SceneError> {
    let scene = &file.scene;
    let at = |angle: Angle, span: Range<usize>| match fault(angle) {
        Some([message, help]) => Err(file.error_at(span, message, help)),
        None => Ok(()),
    };
    for rest in scene.energy.rests().into_iter().flatten() {
        rest.angles().into_iter().try_for_each(|angle| at(angle, rest.span()))?;
    }
    for law in scene.energy.hinges().into_iter().filter_map(|spec| spec?.law.as_ref()) {
        let mut changes = law.each().into_iter().flat_map(HingeLawSpec::changes);
        changes.try_for_each(|angle| at(angle, law.span()))?;
    }
    for angle in scene.locks.iter().filter_map(|lock| lock.angle.as_ref()) {
        at(**angle, angle.span())?;
    }
    for drive in scene.drives.iter().filter(|drive| drive.lock.is_some()) {
        drive.to.0.iter().try_for_each(|&angle| at(angle, drive.to.span()))?;
    }
    scene.studies.iter().filter_map(stop_angle).try_for_each(|angle| at(**angle, angle.span()))
}

fn stop_angle(study: &StudySpec) -> Option<&Located<Angle>> {
    let stop = match &*study.kind {
        StudyKind::Trace(trace) => trace.stop.as_ref(),
        StudyKind::Path(path) | StudyKind::Fold(path) => path.stop.as_ref(),
        _ => None,
    };
    Some(&stop?.crease_angle.as_ref()?.angle)
}

/// Returns remarks about rest angles and locks beyond pi, which are allowed.
pub(super) fn notes(file: &SceneFile, terms: &Terms) -> Vec<String> {
    let beyond = |angle: &f64| angle.abs() > PI;
    let through = "beyond pi (angles are radians), where the faces of a crease have passed through each other";
    let mut notes = Vec::new();
    let hinges = [&terms.creases, &terms.facets].into_iter().zip(file.scene.energy.rests());
    let given = hinges.filter(|(_, given)| given.is_some()).flat_map(|(hinges, _)| hinges);
    let rest = given.flat_map(|hinges| &hinges.rest).filter(|angle| beyond(angle)).count();
    if rest > 0 {
        notes.push(format!("{rest} rest angles are {through}"));
    }
    let locks =
        file.scene.locks.iter().filter(|lock| lock.angle.as_ref().is_some_and(|angle| beyond(&angle.radians))).count();
    if locks > 0 {
        notes.push(format!("{locks} of the angles of locks are {through}"));
    }
    notes
}
