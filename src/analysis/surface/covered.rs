//! How a surface of folded states is covered, and what the covering gives.

use crate::kinematics::Shape;
use crate::solver::atlas::Coverage;

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
    /// Branch, and the sign of the curvature with which folding left the drawn state, or the last tip, on the way here.
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
#[derive(Clone, Debug, Default)]
pub struct FoldedSurface {
    /// Its states; where charts meet the largest curvature, states are exactly there.
    pub points: Vec<SurfacePoint>,
    /// Triangles of states, the same way round on each piece where `oriented`. Across the end of a period (2 pi) the
    /// nearest images are meant.
    pub triangles: Vec<[usize; 3]>,
    /// How the covering ended; holes around the drawn state are closed and do not count.
    pub coverage: Coverage,
    /// Of a complete covering: states within the limit beside which triangles are missing. Charts of one surface take
    /// those of another for their own where both cross at a small angle, and then there is no telling how they hang
    /// together.
    pub gaps: usize,
    /// Whether neighbours go the same way round everywhere.
    pub oriented: bool,
    /// Whether it has no border.
    pub closed: bool,
    /// Branch and sign of the nappes from which it was begun. One number is shared by nappes that lie opposite each
    /// other at the drawn state, and by those that hang together elsewhere; a nappe that was found only behind another
    /// spatially periodic state has one of its own.
    pub branches: Vec<(usize, i8)>,
    /// Largest radius of a chart: that of the options, or less where the largest curvature is met close to the drawn
    /// state.
    pub radius: f64,
    /// Spatially periodic states at which nappes meet, each once.
    pub tips: usize,
    /// Ways away from spatially periodic states along which no state was found, or that are not known: what lies there
    /// may be missing.
    pub lost: usize,
    /// Whether two surfaces cross at the drawn state, along a curve of spatially periodic states.
    pub crossing: bool,
    /// Then the states of that curve on the edges of triangles that go over it.
    pub seam: Vec<SeamState>,
    /// Dimension of the states: 2, or 1 where they are a curve. Then there are no triangles.
    pub dimension: usize,
    /// Neighbours on a curve.
    pub segments: Vec<[usize; 2]>,
    /// Fact of second order that leaves no surface, where there is one; the states are then none, or those of a curve.
    pub negative: Option<Negative>,
}

/// What is established of a drawn state that no surface of cylinders leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Negative {
    /// The quadric is definite: no direction is real, and the drawn state cannot fold.
    #[error(
        "no surface of folded states leaves the drawn state: the quadratic condition on its three linear motions is \
         definite, so that none of them extends"
    )]
    NoDirection,
    /// The quadric is definite but for one direction, which alone is real: at most a curve of folded states.
    #[error(
        "no surface of folded states leaves the drawn state: the quadratic condition on its three linear motions is \
         definite across its null direction, so that this one direction is the only real one and leaves at most a curve"
    )]
    OneDirection,
    /// No direction satisfies all quadrics where a curve is expected: the drawn state cannot fold.
    #[error(
        "no folded states leave the drawn state: the quadratic conditions on its linear motions have no real solution"
    )]
    NoRay,
}

impl FoldedSurface {
    /// Keeps the first states and the triangles among them.
    pub(crate) fn truncate(&mut self, kept: usize) {
        self.points.truncate(kept);
        self.triangles.retain(|triangle| triangle.iter().all(|&corner| corner < kept));
        self.segments.retain(|segment| segment.iter().all(|&end| end < kept));
    }

    /// No states, for an established reason where there is one.
    pub(super) fn nothing(negative: Option<Negative>, radius: f64) -> Self {
        Self { negative, radius, oriented: true, dimension: 2, ..Self::default() }
    }
}

/// A state on the curve, between two neighbours on one surface.
#[derive(Clone, Debug)]
pub struct SeamState {
    /// Fold angles of all edges.
    pub angles: Vec<f64>,
    /// The states between which it lies, by number.
    pub between: [usize; 2],
}
