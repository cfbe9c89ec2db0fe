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

mod crossing;
mod folding;
mod sign;
mod starts;
mod tip;

use super::branches::BranchesError;
use crate::kinematics::{Closure, Embedding, KinematicsError, SecondOrder, Shape};
use crate::model::{Assembly, Boundary};
use crate::solver::atlas::{self, Atlas, AtlasError, Coverage};
pub use crossing::{Lowest, Seam};
use folding::SurfaceClosure;
use thiserror::Error;

/// Largest angle between the tangent planes of neighbouring charts, in radians.
const MAX_TURN: f64 = 0.4;

/// The observer is asked after so many states.
const OBSERVED: usize = 256;
/// Charts are no larger than this part of the way at which half of the largest curvature is met.
const REACH: f64 = 2.0;

/// How a surface is covered.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceOptions {
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
    /// Of a complete covering: states within the limit beside which triangles are missing. Charts of one surface take those of
    /// another for their own where both cross at a small angle, and then there is no telling how they hang together.
    pub gaps: usize,
    /// Whether neighbours go the same way round everywhere.
    pub oriented: bool,
    /// Whether it has no border.
    pub closed: bool,
    /// Branch and sign of the nappes from which it was begun. One number is shared by nappes that lie opposite each
    /// other at the drawn state, and by those that hang together elsewhere.
    pub branches: Vec<(usize, i8)>,
    /// Largest radius of a chart: that of the options, or less where the largest curvature is met close to the drawn state.
    pub radius: f64,
    /// Ways away from the drawn state along which no state was found, or that are not known: what lies there may be missing.
    pub lost: usize,
    /// Whether two surfaces cross at the drawn state, along a curve of spatially periodic states.
    pub crossing: bool,
    /// Then the states of that curve on the edges of triangles that go over it.
    pub seam: Vec<Seam>,
    /// What second order establishes where there is no surface; then there are no states.
    pub negative: Option<Negative>,
}

/// What is established of a drawn state that no surface of cylinders leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Negative {
    /// The quadric is definite: no direction is real, and the drawn state cannot fold.
    NoDirection,
    /// The quadric is definite but for one direction, which alone is real: at most a curve of folded states.
    OneDirection,
}

impl std::fmt::Display for Negative {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NoDirection => {
                "no surface of folded states leaves the drawn state: the quadratic condition on its three linear motions is \
                 definite, so that none of them extends"
            }
            Self::OneDirection => {
                "no surface of folded states leaves the drawn state: the quadratic condition on its three linear motions is \
                 definite across its null direction, so that this one direction is the only real one and leaves at most a curve"
            }
        })
    }
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
    /// Second order does not say what leaves the drawn state.
    #[error(
        "second order does not tell the folded states here: the quadratic condition on the linear motions has the signature \
         {signature:?} (positive, negative, zero), whose zeros are multiple"
    )]
    Degenerate {
        /// Eigenvalues that are positive, negative and zero.
        signature: [usize; 3],
    },
    /// No direction was met, which does not say that there is none.
    #[error(
        "no simple real direction was met on {sections} random hyperplanes, and {multiple} multiple ones: this does not \
         establish that no surface leaves the drawn state"
    )]
    NoneMet {
        /// Hyperplanes.
        sections: usize,
        /// Real solutions of higher multiplicity, for which second order says no more.
        multiple: usize,
    },
    /// The curvature is met before the surface can be told from the drawn state.
    #[error(
        "nothing could be found within max_curvature = {max_curvature:e}: half of it is met at {reach:e} from the drawn state or nearer in \
         fold angles, where the surface cannot be told from its singular point; choose a larger max_curvature"
    )]
    NothingWithin {
        /// The largest curvature.
        max_curvature: f64,
        /// Distance from the drawn state, in fold angles, at which half of it is met.
        reach: f64,
    },
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
///
/// # Errors
/// [`SurfaceError`] where the sheet has no surface of folded states, or its directions are not established.
pub fn surface(
    assembly: &Assembly,
    options: &SurfaceOptions,
    observe: &mut dyn FnMut(usize) -> bool,
) -> Result<Surface, SurfaceError> {
    let sheet = assembly.sheet();
    if assembly.boundary() != Boundary::Screw {
        return Err(SurfaceError::NotScrew);
    }
    let closure = Closure::of_cell(sheet)?.with_locked(&assembly.locked_edges());
    if closure.unchecked_loops() > 0 || !sheet.holes.is_empty() {
        let loops = closure.unchecked_loops().max(sheet.holes.len());
        return Err(KinematicsError::Openings { loops }.into());
    }
    let embedding = Embedding::new(sheet)?;
    let second_order = SecondOrder::new(&closure, embedding.drawn_angles())?;
    let (modes, quadrics) = (second_order.count(), second_order.quadrics.len());
    if modes != quadrics + 2 {
        let left = modes as i64 - quadrics as i64;
        return Err(SurfaceError::NotTwoDimensional { modes, quadrics, left });
    }
    let mut folding = SurfaceClosure::new(&closure, &embedding, options.max_curvature);
    let starts = match starts::starts(&mut folding, &second_order, options)? {
        Ok(starts) => starts,
        Err(negative) => return Ok(Surface::nothing(negative, options.radius)),
    };
    let states: Vec<Vec<f64>> = starts.list.iter().map(|start| start.x.clone()).collect();
    let charts = atlas::CoverOptions {
        tolerance: options.tolerance,
        radius: options.radius.min(REACH * starts.reach),
        max_turn: MAX_TURN,
        max_charts: options.max_points,
    };
    let atlas = atlas::cover(&mut folding, &states, charts, observe)?;
    let radius = charts.radius;
    let found = Surface { radius, ..put_together(&folding, atlas, &starts, observe)? };
    if found.points.is_empty() && found.coverage != Coverage::Interrupted {
        return Err(SurfaceError::NothingWithin { max_curvature: options.max_curvature, reach: starts.reach });
    }
    Ok(found)
}

impl Surface {
    /// Keeps the first states and the triangles among them.
    pub fn truncate(&mut self, kept: usize) {
        self.points.truncate(kept);
        self.triangles.retain(|triangle| triangle.iter().all(|&corner| corner < kept));
    }

    /// No states, for an established reason.
    fn nothing(negative: Negative, radius: f64) -> Self {
        let (points, triangles, branches) = (Vec::new(), Vec::new(), Vec::new());
        let (coverage, negative) = (Coverage::Complete, Some(negative));
        Self {
            points,
            triangles,
            coverage,
            gaps: 0,
            oriented: true,
            closed: false,
            branches,
            radius,
            lost: 0,
            crossing: false,
            seam: Vec::new(),
            negative,
        }
    }
}

/// The states of an atlas, the hole around the drawn state closed where it is a tip.
fn put_together(
    folding: &SurfaceClosure<'_>,
    mut atlas: Atlas,
    starts: &starts::Starts,
    observe: &mut dyn FnMut(usize) -> bool,
) -> Result<Surface, KinematicsError> {
    let branch = starts::branches(&atlas, &starts.list);
    let tip::Left { border, open } = tip::close(folding, &mut atlas);
    let coverage = match atlas.coverage {
        Coverage::Open { .. } if open == 0 => Coverage::Complete,
        Coverage::Open { .. } => Coverage::Open { charts: open },
        other => other,
    };
    let points = Vec::with_capacity(atlas.charts.len());
    let (triangles, closed, negative) = (atlas.triangles, border == 0, None);
    let gaps = if coverage == Coverage::Complete { open } else { 0 };
    let Atlas { oriented, .. } = atlas;
    let mut branches = branch.clone();
    branches.sort_unstable_by_key(|(branch, sign)| (*branch, -sign));
    branches.dedup();
    let (lost, crossing, radius, seam) = (starts.lost, starts.crossing, 0.0, Vec::new());
    let mut surface = Surface {
        points,
        triangles,
        coverage,
        gaps,
        oriented,
        closed,
        branches,
        radius,
        lost,
        crossing,
        seam,
        negative,
    };
    for (k, chart) in atlas.charts.iter().enumerate() {
        let stopped = surface.coverage == Coverage::Interrupted;
        if !stopped && k % OBSERVED == 0 && !observe(atlas.charts.len()) {
            surface.coverage = Coverage::Interrupted;
        }
        if k >= atlas::KEPT && surface.coverage == Coverage::Interrupted {
            break;
        }
        surface.points.push(SurfacePoint {
            branch: branch[chart.start],
            angles: folding.all(&chart.x),
            shape: folding.shape(&chart.x)?,
            residual: chart.residual,
            radius: chart.radius,
        });
    }
    surface.truncate(surface.points.len());
    let from: Vec<usize> = atlas.charts.iter().take(surface.points.len()).map(|chart| chart.start).collect();
    sign::carry(folding.embedding(), &mut surface.points, &surface.triangles, &from);
    if starts.crossing {
        surface.seam = crossing::seam(folding, &surface.points, &surface.triangles);
        // charts go over the curve along which surfaces cross, to the other sign
        let sides = surface.points.iter_mut().filter(|point| point.shape.turns());
        sides.for_each(|point| point.branch.1 = if point.shape.curvature < 0.0 { -1 } else { 1 });
    }
    Ok(surface)
}
