//! Motions of a tube that its closing conditions leave free, each set of conditions on its own.
//!
//! Two motions are left without conditions, one if the seam keeps its angle (it slips along itself) or its rise (it
//! opens), and none with both: generic tubes are rigid within screw-symmetric motions.

use super::error::ModesError;
use super::rank::{rank_of, rigid_part};
use super::spectrum::Observer;
use crate::model::{Assembly, Domain, Gauge};
use crate::sheet::SeamKept;
use crate::solver::Problem;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rigid motions of a tube: along its axis and about it.
const RIGID_MOTIONS: usize = 2;

/// Motions of the bars of a tube, one cell repeated about an axis, without rigid motions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "SeamMotionsSummary")]
pub struct SeamMotions {
    /// The seam `[n1, n2]`.
    pub seam: [i32; 2],
    /// Motions without closing conditions.
    pub free: usize,
    /// Motions with n1 theta1 + n2 theta2 = 2 pi: the seam slips along itself.
    pub turn: usize,
    /// Motions with n1 h1 + n2 h2 = 0: the tube opens or overlaps.
    pub rise: usize,
    /// Motions with both: of the closed tube; 0, it is rigid.
    pub both: usize,
    /// Smallest of the four gaps of singular values, as `gap`; null: nothing was dropped.
    pub gap: Option<f64>,
}

/// Counts the motions of a tube in the state with these coordinates; `None` for other boundary conditions.
pub(super) fn seam_motions(
    assembly: &Assembly,
    coordinates: &[f64],
    observe: &mut Observer<'_>,
) -> Result<Option<SeamMotions>, ModesError> {
    let Domain::Tube { seam, .. } = assembly.domain() else { return Ok(None) };
    let (mut counts, mut least) = ([0; 4], None::<f64>);
    for (count, (turn, rise)) in counts.iter_mut().zip([(false, false), (true, false), (false, true), (true, true)]) {
        let Some((other, place)) = assembly.tube_keeping(SeamKept { turn, rise }, coordinates) else { return Ok(None) };
        let mut bars = other.with_terms(rigid_part(assembly.terms())).model(Gauge::Free);
        bars.start_from(place);
        let (rank, gap) = rank_of(&bars, observe)?;
        *count = bars.layout().unknowns.saturating_sub(rank + RIGID_MOTIONS);
        least = [least, gap].into_iter().flatten().reduce(f64::min);
    }
    let [free, turn, rise, both] = counts;
    Ok(Some(SeamMotions { seam: seam.lattice_vector(), free, turn, rise, both, gap: least }))
}
