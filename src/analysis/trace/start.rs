//! The first state of trajectories, and the rays along which they leave it.

use super::error::TraceError;
use crate::analysis::branches::{Branches, branches};
use crate::kinematics::tube::{BOTH, Condition};
use crate::kinematics::{Ray, RealDirections, Tube};
use crate::model::{Assembly, Domain};
use crate::sheet::{Seam, SeamKept};

/// The first state of trajectories, with its rays.
pub(super) struct TraceStart<'a> {
    /// Fold angles of all edges in radians, zero where there is no hinge.
    pub angles: Vec<f64>,
    /// The rays to follow.
    pub rays: Vec<Ray>,
    /// Completeness of the rays among all real directions of folding.
    pub directions: RealDirections,
    /// Whether folding keeps the sheet spatially periodic.
    pub planar: bool,
    /// A tube with the condition that it keeps; `None` for other sheets, and for a tube without rays.
    pub tube: Option<(Tube<'a>, Condition)>,
}

/// Finds the rays of the drawn state, or of the tube from which the assembly starts.
pub(super) fn start(assembly: &Assembly) -> Result<TraceStart<'_>, TraceError> {
    let angles = assembly.start_angles().iter().map(|angle| if angle.is_nan() { 0.0 } else { *angle }).collect();
    if let Domain::Tube { seam, kept, .. } = assembly.domain() {
        return of_tube(assembly, angles, (*seam, *kept));
    }
    let Branches { rays: found, planar, .. } = branches(assembly)?;
    match found.directions {
        RealDirections::Continuum if found.rays.is_empty() => return Err(TraceError::Continuum),
        RealDirections::NotEstablished if found.rays.is_empty() => return Err(TraceError::NotEstablished),
        _ => {}
    }
    Ok(TraceStart { angles, rays: found.rays, directions: found.directions, planar, tube: None })
}

/// Counts the motions of a tube that keep its closing conditions. Where there is none, the Jacobian of closure and
/// conditions has full column rank: the tube is rigid. One motion that keeps one condition makes two rays.
fn of_tube(
    assembly: &Assembly,
    angles: Vec<f64>,
    (seam, kept): (Seam, SeamKept),
) -> Result<TraceStart<'_>, TraceError> {
    let tube = Tube::new(assembly.sheet(), seam.lattice_vector())?;
    let is_kept = |condition: &Condition| match condition {
        Condition::Turn => kept.turn,
        Condition::Rise => kept.rise,
    };
    let conditions: Vec<Condition> = BOTH.into_iter().filter(is_kept).collect();
    let locked = assembly.locked_edges();
    // a drawing closes to the digits of its file
    let angles = tube.closed(&angles, &conditions, &locked)?;
    let motions = tube.motions(&angles, &conditions, &locked)?;
    let (rays, tube) = match (motions.ncols(), &conditions[..]) {
        (0, _) => (Vec::new(), None),
        (1, &[condition]) => {
            let growing = tube.growing(&angles, condition, motions.as_slice());
            let ray = |sign: i8| Ray {
                branch: 0,
                sign,
                multiplicity: 1,
                direction: growing.iter().map(|rate| f64::from(sign) * rate).collect(),
                error: 0.0,
            };
            ([1, -1].map(ray).to_vec(), Some((tube, condition)))
        }
        (motions, _) => return Err(TraceError::MotionsOfTube { motions, closed: kept.is_closed() }),
    };
    Ok(TraceStart { angles, rays, directions: RealDirections::Listed, planar: false, tube })
}
