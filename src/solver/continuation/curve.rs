//! A curve to follow, how far, and what comes of it.

use crate::solver::implicit::Implicit;

/// A curve: as many independent equations as unknowns less one.
pub trait Curve: Implicit {
    /// Appends the values whose sign changes are located; as many at every point, NaN where there is none.
    fn indicators(&mut self, point: &Point, out: &mut Vec<f64>) {
        let _ = (point, out);
    }
}

/// A point of a trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Arc length from the start.
    pub arc_length: f64,
    /// The unknowns.
    pub x: Vec<f64>,
    /// Unit tangent.
    pub tangent: Vec<f64>,
    /// Largest component of `F`.
    pub residual: f64,
    /// Corrections made.
    pub corrections: usize,
}

/// How a trajectory is followed.
#[derive(Clone, Debug)]
pub struct Options {
    /// Bound on the largest component of `F`.
    pub tolerance: f64,
    /// Longest step.
    pub max_step: f64,
    /// Arc length at which it ends.
    pub length: f64,
    /// Most points.
    pub steps: usize,
    /// Period of every unknown: then coming back to the start modulo periods ends it.
    pub period: Option<f64>,
    /// Indicators that end it.
    pub stops: Vec<usize>,
    /// Points of the interpolant of a step, 2 to 4: its degree is twice that, less one.
    pub points: usize,
}

impl Default for Options {
    fn default() -> Self {
        let (length, steps) = (f64::INFINITY, 100_000);
        Self { tolerance: 1e-13, max_step: 0.25, length, steps, period: None, stops: Vec::new(), points: 3 }
    }
}

/// A sign change of an indicator.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Number of the indicator.
    pub indicator: usize,
    /// Where it vanishes, or jumps.
    pub point: Point,
}

/// Why a trajectory ends.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// It came back; the last point is the start, periods added.
    Closed(Return),
    /// This indicator changed sign at the last point.
    Stopped {
        /// Number of the indicator.
        indicator: usize,
    },
    /// It has the wanted length.
    Length,
    /// The most steps were made.
    Steps,
    /// No step leads on.
    Failed,
    /// The observer asked to stop.
    Interrupted,
}

/// A trajectory, whatever its end.
#[derive(Clone, Debug)]
pub struct Trajectory {
    /// Its points, the start first.
    pub points: Vec<Point>,
    /// Sign changes of indicators that do not end it, in order.
    pub events: Vec<Event>,
    /// Why it ends.
    pub end: End,
}

/// Where a trajectory came back.
#[derive(Clone, Debug, PartialEq)]
pub struct Return {
    /// Arc length of the whole trajectory.
    pub arc_length: f64,
    /// Its unit tangent where it arrives.
    pub arrival: Vec<f64>,
    /// Periods by which each unknown differs from the start.
    pub windings: Vec<i64>,
}
