//! Motions of a tube that its closing conditions leave free, each set of conditions on its own.
//!
//! Two motions are left without conditions, one if the seam keeps its angle (it slips along itself) or its rise (it
//! opens), and none with both: generic tubes are rigid within screw-symmetric motions.

use super::error::ModesError;
use super::rank::{rank_of, rigid_part};
use super::spectrum::Observer;
use crate::model::{Assembly, Boundary, Gauge};
use crate::sheet::SeamKept;
use crate::solver::Problem;

/// Rigid motions of a tube: along its axis and about it.
const RIGID_MOTIONS: usize = 2;

/// Numbers of motions of the bars of a tube, rigid motions left out, that sets of closing conditions leave free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeamMotions {
    /// The seam.
    pub seam: [i32; 2],
    /// Number of motions without closing conditions.
    pub free: usize,
    /// Number of motions that keep the seam's angle of `2 pi`.
    pub turn: usize,
    /// Number of motions that keep the seam's rise of 0.
    pub rise: usize,
    /// Number of motions that keep angle and rise of the seam.
    pub both: usize,
    /// Smallest of the four ratios of the smallest kept to the largest dropped singular value; infinite where none is
    /// dropped.
    pub gap: f64,
}

/// Counts the motions of a tube in the state with these coordinates; `None` for other boundary conditions.
pub(super) fn seam_motions(
    assembly: &Assembly,
    coordinates: &[f64],
    observe: &mut Observer<'_>,
) -> Result<Option<SeamMotions>, ModesError> {
    let Boundary::Tube { seam, .. } = assembly.boundary() else { return Ok(None) };
    let (mut counts, mut least) = ([0; 4], f64::INFINITY);
    for (count, (turn, rise)) in counts.iter_mut().zip([(false, false), (true, false), (false, true), (true, true)]) {
        let Some((other, place)) = assembly.tube_keeping(SeamKept { turn, rise }, coordinates) else { return Ok(None) };
        let mut bars = other.with_terms(rigid_part(assembly.terms())).model(Gauge::Free);
        bars.start_from(place);
        let (rank, gap) = rank_of(&bars, observe)?;
        *count = bars.layout().unknowns.saturating_sub(rank + RIGID_MOTIONS);
        least = gap.map_or(least, |gap| least.min(gap));
    }
    let [free, turn, rise, both] = counts;
    Ok(Some(SeamMotions { seam: seam.lattice_vector(), free, turn, rise, both, gap: least }))
}
