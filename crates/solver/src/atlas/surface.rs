//! A surface to cover, how finely, and what comes of it.

use crate::implicit::Implicit;
use foldwell_numerics::dense::DenseError;
use thiserror::Error;

/// Number of charts that are kept of an interrupted covering.
pub const KEPT: usize = 4096;

/// A surface given by equations, with its limit.
pub trait Surface: Implicit {
    /// The period of an unknown (`2 pi` for an angle) where there is one.
    fn period(&self, _unknown: usize) -> Option<f64> {
        None
    }
    /// A continuous function that is negative on the part of the surface that is wanted, and zero on its border.
    fn limit(&mut self, _x: &[f64]) -> f64 {
        f64::NEG_INFINITY
    }
    /// Whether it crosses another surface that satisfies the same equations. Charts are then placed by following it,
    /// which costs several times as much.
    fn crosses(&self) -> bool {
        false
    }
}

/// Fineness and extent of a covering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoverOptions {
    /// Largest component of the residual of a point.
    pub tolerance: f64,
    /// Largest radius of a chart: neighbouring points are one to two radii apart.
    pub radius: f64,
    /// Largest angle between the tangent planes of a chart and of one placed on its rim, in radians.
    pub max_turn: f64,
    /// Largest number of charts.
    pub max_charts: usize,
}

impl Default for CoverOptions {
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
    /// Radius of the ball of the chart.
    pub radius: f64,
    /// Value of [`Surface::limit`]; zero to rounding on the border.
    pub limit: f64,
    /// Largest component of the residual.
    pub residual: f64,
    /// Number of the start from which the chart was reached.
    pub start: usize,
}

/// The end of a covering.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coverage {
    /// Everything that can be reached within the limit is covered.
    #[default]
    Complete,
    /// Everything is covered but what lies beyond some charts, at which the surface could not be followed with the
    /// smallest radius.
    Open {
        /// Number of these charts.
        charts: usize,
    },
    /// The surface could not be followed at so many charts that it was given up before all of it was covered.
    GivenUp {
        /// Number of these charts.
        charts: usize,
    },
    /// As many charts as [`CoverOptions::max_charts`] allows were placed.
    TooManyCharts,
    /// The observer asked to stop.
    Interrupted,
}

impl Coverage {
    /// Whether the covering came to its own end: nothing more could be placed.
    pub fn is_whole(self) -> bool {
        matches!(self, Self::Complete | Self::Open { .. })
    }
}

/// A covered surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Atlas {
    /// The charts, those on the border last.
    pub charts: Vec<Chart>,
    /// Triangles of neighbouring charts, counter-clockwise in their frames. Across the end of a period the nearest
    /// images are meant.
    pub triangles: Vec<[usize; 3]>,
    /// For each start, the number of that from which the chart was reached that holds it: its own unless it was passed
    /// over; `None` where a further start is not on the surface.
    pub reached: Vec<Option<usize>>,
    /// The end of a covering.
    pub coverage: Coverage,
    /// Whether the frames of all neighbours go the same way round.
    pub oriented: bool,
}

impl Atlas {
    /// Two atlases side by side, the charts of the other behind; the coverage is that of the less complete one.
    pub fn and(mut self, other: Self) -> Self {
        let before = self.charts.len();
        self.reached.extend(other.reached);
        self.charts.extend(other.charts);
        self.triangles.extend(other.triangles.into_iter().map(|triangle| triangle.map(|corner| corner + before)));
        self.coverage = match (self.coverage, other.coverage) {
            (Coverage::Open { charts: a }, Coverage::Open { charts: b }) => Coverage::Open { charts: a + b },
            (one, Coverage::Complete) | (Coverage::Complete, one) => one,
            (Coverage::Open { .. }, worse) | (worse, _) => worse,
        };
        self.oriented &= other.oriented;
        self
    }
}

/// The reason for which a surface was not covered.
#[derive(Clone, Debug, Error, PartialEq)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum AtlasError {
    #[error("start {start} is not on the surface, or the surface bends too sharply there")]
    Start { start: usize },
    #[error("at start {start} the equations leave {tangents} tangents; a surface has two")]
    Singular { start: usize, tangents: usize },
    #[error(transparent)]
    Dense(#[from] DenseError),
}
