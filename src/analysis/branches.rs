//! The branches along which exact folding leaves the drawn state, with a count that shows that none is missing.
//!
//! The sheet is one cell, repeated by screw motions, or a finite patch; locked edges and rigid diagonals keep their
//! angle.

use crate::kinematics::{Closure, FoldingModes, KinematicsError, Ray, Rays, SecondOrder, folding_modes, signature};
use crate::model::{Assembly, Domain};
use crate::sheet::Sheet;
use nalgebra::DVector;

/// Folding edges beyond which the dense decompositions take too long.
const MOST_EDGES: usize = 1200;

/// A trace of the curvature tensor below this, in radians per length for a direction of norm 1 and a lattice of length
/// 1, is none.
const NO_CURVATURE: f64 = 1e-7;

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum BranchesError {
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    #[error(
        "on a torus with a lattice the folding angles of one cell do not say all; ask for domain \"screw\" or \"patch\""
    )]
    Torus,
    #[error("branches are not known on a domain of one's own")]
    OwnDomain,
    #[error("the sheet has {edges} edges that fold; at most {MOST_EDGES} are looked at")]
    TooLarge { edges: usize },
}

/// What leaves the drawn state.
#[derive(Clone, Debug, PartialEq)]
pub struct Branches {
    /// Number of linear folding motions.
    pub modes: usize,
    /// Number of independent quadrics that these must satisfy.
    pub quadrics: usize,
    /// Positive, negative and zero eigenvalues of the quadric, where it is just one.
    pub signature: Option<[usize; 3]>,
    /// Solutions and rays.
    pub rays: Rays,
    /// Whether the one real direction is that of planar folding, along which the states stay spatially periodic.
    pub planar: bool,
    /// Sign of the curvature into which each ray bends the sheet: 1 towards the face normals, -1 away from them, 0 for
    /// none; `None` for a finite sheet, which has no curvature.
    pub curvature_signs: Vec<Option<i8>>,
}

/// Finds the branches that leave the drawn state; locks and rigid diagonals of its terms are kept. No real ray is an
/// answer.
///
/// # Errors
/// [`BranchesError`] for a torus, for a domain of one's own, for periodic sheets with openings, for too many edges, and
/// where ranks are not clear or the solutions do not add up.
pub fn branches(assembly: &Assembly) -> Result<Branches, BranchesError> {
    let (sheet, domain) = (assembly.sheet(), assembly.domain());
    if domain.is_torus() {
        return Err(BranchesError::Torus);
    }
    if matches!(domain, Domain::Own(_)) {
        return Err(BranchesError::OwnDomain);
    }
    let closure = Closure::of_tiling(sheet, assembly.tiling())?.with_locked(&assembly.locked_edges());
    closure.is_complete()?;
    let edges = closure.folding_edges().len();
    if edges > MOST_EDGES {
        return Err(BranchesError::TooLarge { edges });
    }
    let angles = assembly.drawn_angles_or_zero();
    let second_order = SecondOrder::new(&closure, &angles)?;
    let rays = Rays::new(&second_order)?;
    let signature = match &second_order.quadrics[..] {
        [quadric] => Some(signature(quadric)?),
        _ => None,
    };
    let curvature_signs = if *domain == Domain::Screw {
        let modes = folding_modes(sheet)?;
        rays.rays.iter().map(|ray| Some(curvature_sign(sheet, &modes, ray))).collect()
    } else {
        vec![None; rays.rays.len()]
    };
    let (modes, quadrics) = (second_order.count(), second_order.quadrics.len());
    let planar = *domain == Domain::Screw && second_order.one_direction_is_real()?;
    Ok(Branches { modes, quadrics, signature, rays, planar, curvature_signs })
}

/// The sign of the trace of the ray's curvature tensor, which has rank one or none.
fn curvature_sign(sheet: &Sheet, modes: &FoldingModes, ray: &Ray) -> i8 {
    let amplitudes = modes.basis.transpose() * DVector::from_column_slice(&ray.direction);
    let curvature = &modes.curvatures * amplitudes;
    let length = sheet.lattice.map_or(1.0, |[first, second]| first.norm().max(second.norm()));
    let trace = (curvature[0] + curvature[1]) * length;
    if trace.abs() <= NO_CURVATURE { 0 } else { trace.signum() as i8 }
}
