//! A surface to cover, how finely, and what comes of it.

use crate::numerics::dense::DenseError;
use crate::solver::implicit::Implicit;
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
