//! The tube of a scene: its sheet rolled up until it closes along the seam.

use super::spec::DomainSpec;
use super::values::SeamCell;
use super::{Located, SceneError, SceneFile};
use crate::analysis::tube::rolled_up;
use crate::kinematics::KinematicsError;
use crate::model::{Assembly, Domain, Roll};
use crate::sheet::Sheet;

/// Returns the start of the tube of a scene; `None` for other domains.
pub(super) fn roll(file: &SceneFile, sheet: &Sheet) -> Result<Option<Roll>, SceneError> {
    let spec = &file.scene.sheet;
    let (DomainSpec::Tube, Some(seam)) = (spec.domain(), &spec.seam) else { return Ok(None) };
    if sheet.screws.is_some() {
        return drawn(file, sheet, seam).map(Some);
    }
    let inwards = spec.inwards.as_deref().copied().unwrap_or(true);
    let refused = |error: KinematicsError| file.error_at(seam.span(), error.to_string(), help(&error, inwards));
    rolled_up(sheet, seam.0, spec.seam_kept(), inwards).map(Some).map_err(refused)
}

/// Returns a tube that its mesh draws as one.
fn drawn(file: &SceneFile, sheet: &Sheet, seam: &Located<SeamCell>) -> Result<Roll, SceneError> {
    if let Some(inwards) = &file.scene.sheet.inwards {
        let message = "`inwards` is given for a mesh that is drawn rolled up";
        return Err(file.error_at(inwards.span(), message, "leave it out"));
    }
    Roll::as_drawn(sheet, seam.0, file.scene.sheet.seam_kept()).map_err(|error| {
        let help = "give the cell [n1, n2] to which the screw motions of `foldwell:lattice` lead after one turn by 360 degrees";
        file.error_at(seam.span(), error.to_string(), help)
    })
}

/// Checks that no polygon of a sheet that is rolled up is rigid: rolling it up bends them all.
pub(super) fn polygons_bend(file: &SceneFile, assembly: &Assembly) -> Result<(), SceneError> {
    let rolled_up = matches!(assembly.domain(), Domain::Tube { .. }) && assembly.sheet().screws.is_none();
    if !rolled_up || assembly.rigid_facets_of_cell().is_empty() {
        return Ok(());
    }
    let span = file.scene.sheet.seam.as_ref().map_or(0..0, |seam| seam.span());
    let help = "give `facets` in [energy] a finite stiffness, so that polygons bend, or split them into triangles";
    Err(file.error_at(span, "a sheet with rigid polygons is not rolled up", help))
}

/// Returns what may be done about a sheet that cannot be rolled up.
fn help(error: &KinematicsError, inwards: bool) -> String {
    match error {
        KinematicsError::NoTube { .. } => {
            format!("give a longer seam, or roll it up the other way: inwards = {}", !inwards)
        }
        _ => {
            "a tube is made of a periodic sheet that is drawn folded and has one way to bend along its seam".to_owned()
        }
    }
}
