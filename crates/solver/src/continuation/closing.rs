//! Whether a trajectory comes back to its start modulo periods, and exactly where.
//!
//! Where the distance to the start has a minimum within a step, the curve is interpolated through four corrected points
//! beside the minimum, none of them at it: the start may be a point where branches cross, and there no correction
//! converges. The interpolant, of degree seven, then says whether the distance vanishes.

use super::curve::{CurvePoint, Return};
use super::hermite::Hermite;
use foldwell_numerics::vector::{dot, norm};

/// Distances of the four points from the minimum, in arc length.
pub(super) const BESIDE: [f64; 4] = [-0.02, -0.01, 0.01, 0.02];
/// Largest distance of a closed trajectory's interpolant from the start.
const LARGEST_GAP: f64 = 1e-7;
/// Largest number of Newton steps towards the minimum, and the step, relative to the arc length, that ends them.
const MOST_STEPS: usize = 20;
const SMALLEST_STEP: f64 = 1e-14;

/// The difference of a point to the start, whole periods taken off.
fn difference(x: &[f64], start: &[f64], period: f64) -> Vec<f64> {
    x.iter().zip(start).map(|(x, start)| x - start - turns(x - start, period) * period).collect()
}

/// The number of whole periods nearest to a difference.
fn turns(difference: f64, period: f64) -> f64 {
    (difference / period).round()
}

/// Half the rate of the squared distance to the start.
pub(super) fn approach(point: &CurvePoint, start: &[f64], period: f64) -> f64 {
    dot(&difference(&point.x, start, period), &point.tangent)
}

/// Arc length near a step of this interpolant at which the distance to the start has its minimum; `None` where the
/// minimum is too far away to be that of the start.
pub(super) fn nearest(dense: &Hermite, (from, to): (f64, f64), start: &[f64], period: f64) -> Option<f64> {
    let found = Nearest::new(dense, 0.5 * (from + to), start, period);
    let width = to - from;
    (from - width <= found.arc_length && found.arc_length <= to + width && found.distance < width)
        .then_some(found.arc_length)
}

/// The return that four corrected points beside the minimum of the distance at `nearest` show.
pub(super) fn closed(beside: &[CurvePoint], nearest: f64, start: &[f64], period: f64) -> Option<Return> {
    if beside.len() < BESIDE.len() {
        return None;
    }
    let mut hermite = Hermite::default();
    hermite.fit(&beside.iter().collect::<Vec<_>>());
    let found = Nearest::new(&hermite, nearest, start, period);
    let speed = norm(&found.slope);
    (found.distance <= LARGEST_GAP).then(|| Return {
        arc_length: found.arc_length,
        arrival: found.slope.iter().map(|v| v / speed).collect(),
        windings: found.windings,
    })
}

/// The point of an interpolant nearest to the start, whole periods taken off.
struct Nearest {
    arc_length: f64,
    distance: f64,
    slope: Vec<f64>,
    windings: Vec<i64>,
}

impl Nearest {
    /// Newton's method from the arc length `s`.
    fn new(hermite: &Hermite, mut s: f64, start: &[f64], period: f64) -> Self {
        let (mut x, mut slope) = (start.to_vec(), start.to_vec());
        for _ in 0..MOST_STEPS {
            hermite.at(s, &mut x, &mut slope);
            let away = difference(&x, start, period);
            let step = dot(&away, &slope) / dot(&slope, &slope);
            s -= step;
            if step.abs() < SMALLEST_STEP * (1.0 + s.abs()) {
                break;
            }
        }
        hermite.at(s, &mut x, &mut slope);
        let windings = x.iter().zip(start).map(|(x, start)| turns(x - start, period) as i64).collect();
        Self { arc_length: s, distance: norm(&difference(&x, start, period)), slope, windings }
    }
}
