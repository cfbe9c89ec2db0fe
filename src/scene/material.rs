//! The material of a scene, and the stiffnesses that follow from it.

use super::spec::MaterialSpec;
use super::{Located, SceneError, SceneFile};
use crate::model::Material;

/// Checks that every term of the energy has a stiffness, or the material one for it.
pub(super) fn check(file: &SceneFile) -> Result<(), SceneError> {
    let (energy, material) = (&file.scene.energy, file.scene.material.as_ref());
    let bars = energy.bars.as_ref().filter(|bars| bars.stiffness.is_none()).map(Located::span);
    let creases = energy.creases.as_ref().filter(|creases| creases.stiffness.is_none()).map(Located::span);
    let facets = energy.facets.as_ref().filter(|facets| facets.stiffness.is_none()).map(Located::span);
    let creases_follow = material.is_some_and(|material| material.crease_length.is_some());
    let terms = [(bars, material.is_some()), (creases, creases_follow), (facets, material.is_some())];
    for ((without, follows), curve) in terms.into_iter().zip(energy.curves()) {
        let Some(span) = without.filter(|_| !follows && curve.is_none()) else { continue };
        let help = "`stiffness` has to be given here, or follow from [material], for creases with `crease_length`";
        return Err(file.error_at(span, "missing key `stiffness`", help));
    }
    Ok(())
}

/// Returns the material of the sheet; `None` if the scene gives none.
pub(super) fn material(file: &SceneFile) -> Option<Material> {
    let MaterialSpec { young, poisson, thickness, crease_length } = **file.scene.material.as_ref()?;
    let (young, poisson, thickness) = (young.0, poisson.0, thickness.0);
    Some(Material { young, poisson, thickness, crease_length: crease_length.map(|length| length.0) })
}
