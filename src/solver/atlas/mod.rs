//! Surfaces `F(x) = 0` covered by an atlas of charts.
//!
//! A chart is a point of the surface with two orthonormal tangents and a radius; its ball is cut by those of its
//! neighbours to a `polygon`. While a corner of the polygon lies outside the ball, a new chart is placed on the rim and
//! corrected onto the surface (M. E. Henderson, "Multiple parameter continuation: computing implicitly defined
//! k-manifolds", International Journal of Bifurcation and Chaos 12 (2002) 451-476; here the place is where the rims of
//! two balls meet, so that centres are no closer than a radius). Points are neighbours modulo the periods of the
//! unknowns, so that a surface can close. The triangles are dual to the polygons, see `mesh`, and are cut where the
//! surface's limit is met, see `cut`.
//!
//! A radius follows the turning of the tangent plane. Towards a singular point, as the tip of a cone, radii shrink with
//! the distance, so that no chart reaches across it; below a hundredth of the largest radius a chart stays open.

mod cover;
mod cut;
mod grid;
mod mesh;
mod polygon;
#[cfg(test)]
mod tests;

use super::implicit::Implicit;
use crate::numerics::dense::DenseError;
use thiserror::Error;

/// Charts that are kept of an interrupted covering.
pub const KEPT: usize = 4096;

/// A surface given by equations, with its limit.
pub trait Surface: Implicit {
    /// The period of an unknown (`2 pi` for an angle) where there is one.
    fn period(&self, _unknown: usize) -> Option<f64> {
        None
    }
    /// Negative on the part of the surface that is wanted, zero on its border; continuous.
    fn limit(&mut self, _x: &[f64]) -> f64 {
        f64::NEG_INFINITY
    }
}

/// How finely and how far to cover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Largest residual of a point.
    pub tolerance: f64,
    /// Largest radius of a chart: neighbouring points are one to two radii apart.
    pub radius: f64,
    /// Largest angle between the tangent planes of a chart and of one placed on its rim, in radians.
    pub max_turn: f64,
    /// Most charts.
    pub max_charts: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { tolerance: 1e-13, radius: 0.1, max_turn: 0.3, max_charts: 100_000 }
    }
}

/// A point of the surface with its tangent plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Unknowns; periodic ones go on through their period along the way the chart was found.
    pub x: Vec<f64>,
    /// Two orthonormal tangents, one behind the other; the same way round on a sheet.
    pub frame: Vec<f64>,
    /// Radius of its ball.
    pub radius: f64,
    /// Value of [`Surface::limit`]; zero to rounding on the border.
    pub limit: f64,
    /// Largest component of the residual.
    pub residual: f64,
    /// Number of the start from which it was reached.
    pub start: usize,
}

/// How the covering ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coverage {
    /// All that can be reached within the limit is covered.
    Complete,
    /// But for what lies beyond so many charts, at which the surface could not be followed with the smallest radius.
    Open {
        /// Their number.
        charts: usize,
    },
    /// The surface could not be followed at so many charts that it was given up before all of it was covered.
    GivenUp {
        /// Their number.
        charts: usize,
    },
    /// [`Options::max_charts`] were placed.
    TooManyCharts,
    /// The observer asked to stop.
    Interrupted,
}

/// A covered surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Atlas {
    /// Charts, those on the border last.
    pub charts: Vec<Chart>,
    /// Triangles of neighbouring charts, counter-clockwise in their frames. Across the end of a period the nearest
    /// images are meant.
    pub triangles: Vec<[usize; 3]>,
    /// How the covering ended.
    pub coverage: Coverage,
    /// Whether the frames of all neighbours go the same way round.
    pub oriented: bool,
}

/// Why there is no atlas.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum AtlasError {
    /// A start is not on the surface.
    #[error("start {start} is not on the surface, or the surface bends too sharply there")]
    Start {
        /// Number of the start.
        start: usize,
    },
    /// At a start there are more or fewer tangents than two.
    #[error("at start {start} the equations leave {tangents} tangents; a surface has two")]
    Singular {
        /// Number of the start.
        start: usize,
        /// Dimension of the null space.
        tangents: usize,
    },
    /// The linear algebra at a start failed.
    #[error(transparent)]
    Dense(#[from] DenseError),
}

/// Covers the parts of a surface that hold the `starts`: points on it, or within a thousandth of the radius of it, at
/// which it is not singular. A start that lies in a chart already is passed over.
///
/// `observe` is told the number of charts from time to time and returns false to stop. What is kept then are the first
/// [`KEPT`] charts and their triangles, so that stopping is quick however many there are.
pub fn cover<S: Surface>(
    surface: &mut S,
    starts: &[Vec<f64>],
    options: Options,
    observe: &mut dyn FnMut(usize) -> bool,
) -> Result<Atlas, AtlasError> {
    let mut cover = cover::Cover::new(surface, options);
    for (number, start) in starts.iter().enumerate() {
        cover.start(number, start)?;
    }
    let mut coverage = cover.run(observe);
    let rings = cover.rings(&mut coverage, observe);
    let triangles = mesh::triangles(&rings, &|a, b| cover.distance(a, b));
    let oriented = cover.oriented;
    let (charts, triangles) = cut::at_limit(&mut cover, triangles, &mut coverage, observe);
    Ok(Atlas { charts, triangles, coverage, oriented })
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// Adds `factor * step` to `x`.
fn add(x: &mut [f64], factor: f64, step: &[f64]) {
    x.iter_mut().zip(step).for_each(|(x, step)| *x += factor * step);
}
