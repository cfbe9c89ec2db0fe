//! A curve to follow, how far, and what comes of it.

/// A point of a trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvePoint {
    /// Arc length from the start.
    pub arc_length: f64,
    /// The unknowns.
    pub x: Vec<f64>,
    /// Unit tangent.
    pub tangent: Vec<f64>,
    /// Largest component of `F` at the point.
    pub residual: f64,
    /// Number of corrections made.
    pub corrections: usize,
}

/// Tolerance, steps and ends of a trajectory.
#[derive(Clone, Debug)]
pub struct CurveOptions {
    /// Bound on the largest component of `F`.
    pub tolerance: f64,
    /// Longest step, in arc length.
    pub max_step: f64,
    /// Arc length at which the trajectory ends.
    pub length: f64,
    /// Largest number of points.
    pub steps: usize,
    /// Period of every unknown, if they are periodic: coming back to the start modulo periods then ends the trajectory.
    pub period: Option<f64>,
    /// Numbers of the indicators whose sign change ends the trajectory.
    pub stops: Vec<usize>,
    /// Number `n` of points of the interpolant of a step, 2 to 4; its degree is `2 n - 1`.
    pub points: usize,
}

impl Default for CurveOptions {
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
    /// The point at which it vanishes, or jumps.
    pub point: CurvePoint,
}

/// The reason for which a trajectory ends.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// The trajectory came back; its last point is the start, periods added.
    Closed(Return),
    /// An indicator changed sign at the last point.
    Stopped {
        /// Number of the indicator.
        indicator: usize,
    },
    /// The trajectory has the wanted length.
    Length,
    /// The largest number of points was reached.
    Steps,
    /// No step, however short, could be corrected onto the curve.
    Failed,
    /// The observer asked to stop.
    Interrupted,
}

/// A trajectory, whatever its end.
#[derive(Clone, Debug)]
pub struct Trajectory {
    /// Points, the start first.
    pub points: Vec<CurvePoint>,
    /// Sign changes of indicators that do not end the trajectory, in order.
    pub events: Vec<Event>,
    /// The reason for its end.
    pub end: End,
}

/// Cosine of the angle within which a trajectory arrives along a direction.
const ALONG: f64 = 0.999;

/// The return of a trajectory to its start.
#[derive(Clone, Debug, PartialEq)]
pub struct Return {
    /// Arc length of the whole trajectory.
    pub arc_length: f64,
    /// Unit tangent where it arrives.
    pub arrival: Vec<f64>,
    /// Number of periods by which each unknown differs from the start.
    pub windings: Vec<i64>,
}

impl Return {
    /// Whether it arrives against a direction in which a trajectory leaves.
    pub fn is_against(&self, direction: &[f64]) -> bool {
        -direction.iter().zip(&self.arrival).map(|(a, b)| a * b).sum::<f64>() > ALONG
    }
}
