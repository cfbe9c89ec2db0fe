//! The mass of a scene.

use super::{Located, SceneError, SceneFile};
use crate::model::Mass;

/// Checks that a mass is given in one way.
pub(super) fn check(file: &SceneFile) -> Result<(), SceneError> {
    let Some(mass) = &file.scene.mass else { return Ok(()) };
    let help = "give one of { vertex = 1.0 }, the mass of each vertex, and { area = 1.0 }, a mass per area";
    match (&mass.vertex, &mass.area) {
        (Some(_), Some(both)) => {
            Err(file.error_at(both.span(), "the sheet has both a mass per vertex and per area", help))
        }
        (None, None) => Err(file.error_at(mass.span(), "the mass has neither `vertex` nor `area`", help)),
        _ => Ok(()),
    }
}

/// Returns the mass of the sheet; `None` if the scene gives none.
pub(super) fn mass(file: &SceneFile) -> Option<Mass> {
    let spec = file.scene.mass.as_ref()?;
    let vertex = spec.vertex.as_ref().map(|mass| Mass::Vertex(mass.0));
    vertex.or(spec.area.as_ref().map(|mass| Mass::Area(mass.0)))
}

/// Checks that a study of the scene reads its mass.
pub(crate) fn is_read(file: &SceneFile) -> Result<(), SceneError> {
    let span = file.scene.mass.as_ref().map(Located::span);
    let weighs = file.scene.loads.iter().any(|load| load.weight.is_some());
    let unread = span.filter(|_| !weighs && !file.scene.studies.iter().any(|study| study.kind.reads_mass()));
    let Some(span) = unread else { return Ok(()) };
    let help = "frequencies are those of kind = \"modes\" with `eigenvalues` and kind = \"bloch\" with `path` or \
                `density`, weight is that of [[load]]; leave `mass` out otherwise";
    Err(file.error_at(span, "no study of this scene reads the mass", help))
}
