//! The two-dimensional surface of folded states of one cell, repeated by screw motions, as triangles.
//!
//! Where `modes - quadrics` of the drawn state is two (a generic periodic cell: 3 and 1; a flat one: `Nv + 2` and `Nv`)
//! the folded states are a surface in the space of fold angles: at cylinders closure has a null space of dimension two,
//! and the drawn state is the tip of a cone, at which two nappes or more meet. [`crate::solver::atlas`] covers them
//! with charts, from a state on each (`starts`), until they close modulo 2 pi or the curvature is met. The hole that
//! charts leave around the tip is closed with triangles to the drawn state (`tip`).
//!
//! Nappes of a flat cell come close to each other where its directions nearly meet, closer than the smallest charts;
//! there the coverage stays open, and says so.

mod folding;
mod sign;
mod starts;
mod tip;

use super::branches::{self, BranchesError};
use crate::kinematics::{Closure, Embedding, KinematicsError, SecondOrder, Shape};
use crate::model::assemble::Surroundings;
use crate::solver::atlas::{self, Atlas, AtlasError, Coverage};
use folding::Folding;
use thiserror::Error;

/// Largest angle between the tangent planes of neighbouring charts, in radians.
const MAX_TURN: f64 = 0.4;

/// What to cover.
pub struct Question<'a> {
    /// The drawn state; what is locked stays so.
    pub start: branches::Question<'a>,
    /// Largest radius of a chart, in fold angles: neighbouring states are one to two radii apart, fewer where the
    /// surface bends.
    pub radius: f64,
    /// Bound on the closure residual.
    pub tolerance: f64,
    /// Magnitude of the curvature at which the surface ends, 1/length.
    pub max_curvature: f64,
    /// Most states.
    pub max_points: usize,
}

/// A folded state.
#[derive(Clone, Debug)]
pub struct SurfacePoint {
    /// Branch, and the sign of the curvature with which folding left the drawn state on the way here.
    pub branch: (usize, i8),
    /// Fold angles of all edges, in radians; continuous from the start of the piece.
    pub angles: Vec<f64>,
    /// The cylinder.
    pub shape: Shape,
    /// Largest component of the closure residual.
    pub residual: f64,
    /// Radius of its chart; 0 at the drawn state.
    pub radius: f64,
}

/// A triangulated surface of folded states.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its states; where charts meet the largest curvature, states are exactly there.
    pub points: Vec<SurfacePoint>,
    /// Triangles of states, the same way round on each piece where `oriented`. Across the end of a period (2 pi) the
    /// nearest images are meant.
    pub triangles: Vec<[usize; 3]>,
    /// How the covering ended; holes around the drawn state are closed and do not count.
    pub coverage: Coverage,
    /// Whether neighbours go the same way round everywhere.
    pub oriented: bool,
    /// Whether it has no border.
    pub closed: bool,
    /// Branch and sign of the nappes from which it was begun. One number is shared by nappes that lie opposite each
    /// other at the drawn state, and by those that hang together elsewhere.
    pub branches: Vec<(usize, i8)>,
}

/// Why there is no surface.
#[derive(Debug, Error)]
pub enum SurfaceError {
    /// The drawn state is no state of a cell with two commuting screw motions.
    #[error("a surface of folded states needs domain \"screw\": its states are drawn in the space of lattice strains")]
    NotScrew,
    /// The folded states are not a surface.
    #[error(
        "the folded states are no surface: {modes} linear folding motions and {quadrics} quadratic conditions on them leave \
         {left} dimensions, not 2"
    )]
    NotTwoDimensional {
        /// Linear folding motions of the drawn state.
        modes: usize,
        /// Independent quadrics.
        quadrics: usize,
        /// Their difference.
        left: i64,
    },
    /// What the drawn state says.
    #[error(transparent)]
    Branches(#[from] BranchesError),
    /// The sheet cannot be put together.
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    /// No ray could be followed away from the drawn state.
    #[error("{rays} real directions leave the drawn state, but along none of them a folded state was found")]
    NoStart {
        /// How many.
        rays: usize,
    },
    /// The charts could not be begun.
    #[error(transparent)]
    Atlas(#[from] AtlasError),
}

/// Covers the surface; no points where no direction is real. `observe` is told the number of charts and returns false
/// to stop.
pub fn surface(question: &Question<'_>, observe: &mut dyn FnMut(usize) -> bool) -> Result<Surface, SurfaceError> {
    let start = &question.start;
    if start.surroundings != Surroundings::Screw {
        return Err(SurfaceError::NotScrew);
    }
    let closure = Closure::of_cell(start.sheet)?.with_locked(&branches::locked(start));
    if closure.unchecked_loops() > 0 || !start.sheet.holes.is_empty() {
        let loops = closure.unchecked_loops().max(start.sheet.holes.len());
        return Err(KinematicsError::Openings { loops }.into());
    }
    let embedding = Embedding::new(start.sheet)?;
    let second_order = SecondOrder::new(&closure, embedding.drawn_angles())?;
    let (modes, quadrics) = (second_order.count(), second_order.quadrics.len());
    if modes != quadrics + 2 {
        let left = modes as i64 - quadrics as i64;
        return Err(SurfaceError::NotTwoDimensional { modes, quadrics, left });
    }
    let mut folding = Folding::new(&closure, &embedding, question.max_curvature);
    let starts = starts::starts(&mut folding, &second_order, question)?;
    let states: Vec<Vec<f64>> = starts.iter().map(|start| start.x.clone()).collect();
    let options = atlas::Options {
        tolerance: question.tolerance,
        radius: question.radius,
        max_turn: MAX_TURN,
        max_charts: question.max_points,
    };
    let atlas = atlas::cover(&mut folding, &states, options, observe)?;
    Ok(put_together(&folding, atlas, &starts)?)
}

/// The states of an atlas, the hole around the drawn state closed where it is a tip.
fn put_together(folding: &Folding<'_>, mut atlas: Atlas, starts: &[starts::Start]) -> Result<Surface, KinematicsError> {
    let branch = starts::branches(&atlas, starts);
    let tip::Left { rims, open } = tip::close(folding, &mut atlas);
    let coverage = match atlas.coverage {
        Coverage::Open { .. } if open == 0 => Coverage::Complete,
        Coverage::Open { .. } => Coverage::Open { charts: open },
        other => other,
    };
    let point = |chart: &atlas::Chart| {
        Ok(SurfacePoint {
            branch: branch[chart.start],
            angles: folding.all(&chart.x),
            shape: folding.shape(&chart.x)?,
            residual: chart.residual,
            radius: chart.radius,
        })
    };
    let mut points = atlas.charts.iter().map(point).collect::<Result<Vec<_>, KinematicsError>>()?;
    let from: Vec<usize> = atlas.charts.iter().map(|chart| chart.start).collect();
    sign::carry(folding.embedding(), &mut points, &atlas.triangles, &from);
    let mut branches = branch;
    branches.sort_unstable_by_key(|(branch, sign)| (*branch, -sign));
    branches.dedup();
    Ok(Surface { points, triangles: atlas.triangles, coverage, oriented: atlas.oriented, closed: rims == 0, branches })
}
