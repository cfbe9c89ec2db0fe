//! Soft bars, which a sheet may crush on its way: bars that are stiffer for a while keep its triangles open.
//!
//! Newton's method takes long steps far from equilibrium, and soft bars let a triangle collapse in one of them, where
//! the model has no state to go on from. With stiffer bars the sheet finds a minimum, which is followed while they
//! become as soft as they are. This comes last: on shipped scenes, minima of stiffer bars are often not the lowest.

use super::{rest_path, soft_bars};
use crate::analysis::relax::run::{Ending, Run, is_better};
use crate::model::DrivenModel;

/// Stiffnesses of the bars over their own, tried one after the other. The stiffest leads to the lowest minima on the
/// shipped scenes; each of the others finds one where no other does.
const RATIOS: [f64; 5] = [1000.0, 100.0, 30.0, 10.0, 3.0];
/// Stiffness of rigid bars over that of the softest hinge, for each of these ratios: from 1e5 on.
const RIGID_RATIO: f64 = 100.0;

/// The minimum to which that of stiffer bars leads; the ending before where it leads to none.
pub(super) fn relaxed(run: &mut Run<'_>, ending: Ending) -> Ending {
    RATIOS.into_iter().fold(ending, |ending, ratio| match ending {
        Ok(found) => Ok(found),
        failed => run.prefer(failed, |run| from_stiffer(run, ratio), is_better),
    })
}

/// The ending of the path on which bars this much stiffer become as soft as they are; that of rigid ones, which begin
/// as bars that stretch. `None` where there is no path to follow.
fn from_stiffer(run: &mut Run<'_>, ratio: f64) -> Option<Ending> {
    if run.model.has_rigid_bars() {
        return (!soft_bars::has_locks(run)).then(|| soft_bars::from_the_start(run, &[RIGID_RATIO * ratio]));
    }
    let start = run.begin_anew();
    let bars = run.model.soft_bars();
    let softening = |model| DrivenModel::by_compliance(model, bars.clone(), [ratio.recip(), 1.0]);
    if bars.is_empty() { None } else { rest_path::from_minimum(run, &softening, start) }
}
