//! The kinds of study that a tube has, and why it has no others.

use super::context::Context;
use super::error::StudyError;
use crate::model::Domain;
use crate::scene::spec::StudyKind;

/// Advice for a study of the ways in which a tube folds.
const COUNTED: &str = "use domain = \"screw\"; `modes` counts the motions of a tube";

/// Checks that the study is one of those that a tube has.
pub(super) fn check(context: &Context<'_>) -> Result<(), StudyError> {
    let Domain::Tube { .. } = context.assembly.domain() else { return Ok(()) };
    let refused = match &*context.study.kind {
        StudyKind::Relax(_) | StudyKind::Modes(_) | StudyKind::Trace(_) => None,
        StudyKind::Wells(wells) if wells.rigid => {
            Some(("the rigid states of a closed tube are single points", "leave out `rigid`"))
        }
        StudyKind::Wells(_) => None,
        StudyKind::Surface(_) => Some((
            "the folded states of a tube are no surface: its closing conditions leave one motion or none",
            COUNTED,
        )),
        StudyKind::Branches(_) => Some(("branches leave the drawn state, and a tube is another one", COUNTED)),
        StudyKind::Landscape(_) => {
            let help = "use domain = \"patch\" or \"torus\"";
            Some(("a landscape is the energy along folding modes of a periodic sheet, and a tube has none", help))
        }
        StudyKind::Bloch(_) => {
            let help = "use domain = \"screw\", and start from a relaxation or a trajectory";
            Some(("wavenumbers around a closed tube are whole numbers, and bloch asks for all", help))
        }
        StudyKind::Response(_) => {
            let help = "use domain = \"screw\" or \"torus\"";
            Some(("strains and curvatures of a closed tube are fixed by its seam", help))
        }
        StudyKind::Path(_) | StudyKind::Fold(_) => {
            let help = "use domain = \"patch\", or relax the tube at every value of a [sweep]";
            Some(("paths of equilibria of tubes are not known", help))
        }
    };
    match refused {
        None => Ok(()),
        Some((message, help)) => Err(context.refuse(message, help).into()),
    }
}
