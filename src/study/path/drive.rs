//! The drive of a path, and its checks.

use crate::analysis::path::check_drive;
use crate::model::{Drive, DriveError, Driven};
use crate::output::figure::rounded;
use crate::scene::build;
use crate::scene::forms::StartSpec;
use crate::scene::spec::{DriveSpec, PathSpec, StudyKind};
use crate::study::{Context, StudyError};
use std::ops::Range;

/// Returns the drive that the study names, or the only one of the scene; that of the rest angles for a study of kind
/// `fold`.
pub(super) fn drive(context: &Context<'_>, spec: &PathSpec) -> Result<Drive, StudyError> {
    if folds(context) {
        let quantity = build::rest_drive(context.file, context.assembly, context.study.kind.span())?;
        return Ok(Drive { quantity, to: 1.0 });
    }
    let name = drive_name(context, spec);
    Ok(build::drive(context.file, context.assembly, name)?)
}

/// Whether the study is of kind `fold`.
pub(super) fn folds(context: &Context<'_>) -> bool {
    matches!(*context.study.kind, StudyKind::Fold(_))
}

/// Whether elements of the sheet yield.
pub(super) fn yields(context: &Context<'_>) -> bool {
    context.assembly.terms().laws.first_with_memory().is_some()
}

/// Whether the sheet snaps where the driven value turns back.
pub(super) fn snaps(context: &Context<'_>, spec: &PathSpec) -> bool {
    spec.snap.as_ref().map_or_else(|| folds(context) && !spec.switch && !yields(context), |snap| **snap)
}

/// Checks that a sheet that snaps, which is on one branch, is to follow no others, and that nothing yields in it: a snap is
/// one step to the minimum beyond, and what yields on the way there decides which.
pub(super) fn may_snap(context: &Context<'_>, spec: &PathSpec) -> Result<(), StudyError> {
    let Some(snap) = spec.snap.as_ref().filter(|snap| ***snap) else { return Ok(()) };
    let (message, help) = if yields(context) {
        let message = "where a sheet snaps to depends on its motion where elements yield, and paths know no motion";
        (message, "leave out `snap`, and drive a displacement: it passes the states between")
    } else if spec.switch {
        ("a sheet that snaps follows no other branches", "leave out snap or switch")
    } else {
        return Ok(());
    };
    Err(context.file.error_at(snap.span(), message, help).into())
}

/// Returns the name of the drive that the study names, or of the only one of the scene.
pub(super) fn drive_name<'a>(context: &'a Context<'_>, spec: &'a PathSpec) -> &'a str {
    if folds(context) {
        return "fold";
    }
    let first = context.file.scene.drives.first().map(|drive| drive.name.0.as_str());
    spec.drive.as_ref().map(|name| name.as_str()).or(first).unwrap_or_default()
}

/// Checks that loads or rest angles do not end where they begin: at 0 in the drawn state, as given in an earlier state.
pub(super) fn moves(context: &Context<'_>, spec: &PathSpec) -> Result<(), StudyError> {
    let drive = drive(context, spec)?;
    let drawn = matches!(spec.start.as_deref(), None | Some(StartSpec::Drawn));
    let stays = match drive.quantity {
        Driven::Loads | Driven::Rest => drive.to == f64::from(u8::from(!drawn)),
        Driven::Pressure(_) => matches!(check_drive(context.assembly, &drive, !drawn), Err(DriveError::NoWay { .. })),
        _ => false,
    };
    if !stays {
        return Ok(());
    }
    let span = end(context, spec);
    let message = format!("the path of study `{}` ends where it begins", context.name());
    let help = "loads, pressures and rest angles begin at 0 in the drawn state, and as given, which is 1 of a factor, in the \
         state of an earlier study or of a file";
    Err(context.file.error_at(span, message, help).into())
}

/// Checks that the values of which the study lists the states, and the one at which it stops, lie on the way of the
/// drive. A sheet that snaps under loads may also need loads of the other sign.
pub(super) fn lists(context: &Context<'_>, spec: &PathSpec) -> Result<(), StudyError> {
    let stop = spec.stop.as_ref().and_then(|stop| stop.drive.as_ref());
    let asked = || spec.at.iter().chain(stop);
    if asked().next().is_none() {
        return Ok(());
    }
    let drive = drive(context, spec)?;
    let drawn = matches!(spec.start.as_deref(), None | Some(StartSpec::Drawn));
    // a drive without effect is refused elsewhere
    let Ok([from, to]) = check_drive(context.assembly, &drive, !drawn) else { return Ok(()) };
    let (way, then) = (to - from, then(context, spec));
    let farther = |far: f64, value: &f64| if (value - far) * way > 0.0 { *value } else { far };
    let nearer = |near: f64, value: &f64| if (value - near) * way < 0.0 { *value } else { near };
    let [from, to] = [then.iter().fold(from, nearer), then.iter().fold(to, farther)];
    let loads = matches!(drive.quantity, Driven::Loads | Driven::Pressure(_));
    let before = |value: f64| !loads && (value - from) * (to - from) < 0.0;
    let beyond = |value: f64| (value - to) * (to - from) > 0.0;
    let Some(off) = asked().find(|value| before(value.0) || beyond(value.0)) else { return Ok(()) };
    let [value, from, to] = [off.0, from, to].map(|number| rounded(number, 12));
    let message =
        format!("the drive `{}` does not pass {value}: it goes from {from} to {to}", drive_name(context, spec));
    let help = format!("give values between {from} and {to}, or drive it farther");
    Err(context.file.error_at(off.span(), message, help).into())
}

/// Returns the values to which the drive goes after its first end.
pub(super) fn then(context: &Context<'_>, spec: &PathSpec) -> Vec<f64> {
    let ends = table(context, spec).map(|table| &table.to.0[1..]);
    ends.into_iter().flatten().map(|angle| angle.radians).collect()
}

/// Checks that branches are asked for only where they are sought.
pub(super) fn follows(context: &Context<'_>, spec: &PathSpec) -> Result<(), StudyError> {
    let to_and_fro = !then(context, spec).is_empty();
    if !spec.switch || !(to_and_fro || yields(context)) {
        return Ok(());
    }
    let (message, place) = if to_and_fro {
        ("branches are not followed where a drive goes to and fro", end(context, spec))
    } else {
        ("branches are not sought where elements yield: stiffness jumps there", context.study.kind.span())
    };
    Err(context.file.error_at(place, message, "leave out `switch`").into())
}

/// Returns the drive that the study names, as the scene gives it; `None` for a study of kind `fold`.
fn table<'a>(context: &'a Context<'_>, spec: &PathSpec) -> Option<&'a DriveSpec> {
    let name = drive_name(context, spec);
    context.file.scene.drives.iter().find(|drive| !folds(context) && drive.name.0 == name)
}

/// Returns the place in the scene of the value to which the study drives; that of its kind for a study of kind `fold`.
fn end(context: &Context<'_>, spec: &PathSpec) -> Range<usize> {
    table(context, spec).map_or(context.study.kind.span(), |table| table.to.span())
}

/// Checks that a driven stiffness is one number, and another one than that at the end, that driven rest angles are others
/// than those of the drawn state, and that a driven crease can fold.
pub(super) fn has_effect(context: &Context<'_>, spec: &PathSpec) -> Result<(), StudyError> {
    let drive = drive(context, spec)?;
    if !matches!(drive.quantity, Driven::Stiffness(_) | Driven::Rest | Driven::Lock(_)) {
        return Ok(());
    }
    let (message, help) = match check_drive(context.assembly, &drive, false) {
        Ok(_) => return Ok(()),
        // the path may begin in another state
        Err(DriveError::NoWay { .. }) if !matches!(drive.quantity, Driven::Stiffness(_)) => return Ok(()),
        Err(error @ DriveError::NoMotion) => (error.to_string(), "drive the lock of another crease"),
        Err(error @ DriveError::RestAsDrawn) => {
            (error.to_string(), "give creases rest = \"assigned\", folded flat by their letters, or other rest angles")
        }
        Err(error) => {
            let help = "a driven stiffness goes from the one number that its term has in [energy] to another one";
            let message = match error {
                DriveError::NoWay { .. } => format!("the driven stiffness is {} at the beginning already", drive.to),
                other => other.to_string(),
            };
            (message, help)
        }
    };
    Err(context.file.error_at(end(context, spec), message, help).into())
}
