//! Whether a trajectory comes back to its start modulo periods, and exactly where.
//!
//! Where the distance to the start has a minimum within a step, the curve is interpolated through four corrected points
//! beside the minimum, none of them at it: the start may be a point where branches cross, and there no correction
//! converges. The interpolant, of degree seven, then says whether the distance vanishes.

use super::hermite::Hermite;
use super::{Curve, Follower, Point};

/// Distances of the four points from the minimum, in arc length.
const BESIDE: [f64; 4] = [-0.02, -0.01, 0.01, 0.02];
/// Largest distance of a closed trajectory's interpolant from the start.
const CLOSED: f64 = 1e-7;

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

/// The difference of a point to the start, whole periods taken off.
fn difference(x: &[f64], start: &[f64], period: f64, windings: &mut [f64]) -> Vec<f64> {
    let turned = x.iter().zip(start).zip(windings).map(|((x, start), turns)| {
        *turns = ((x - start) / period).round();
        x - start - *turns * period
    });
    turned.collect()
}

/// Half the rate of the squared distance to the start.
pub fn approach(point: &Point, start: &[f64], period: f64) -> f64 {
    let mut turns = vec![0.0; start.len()];
    let away = difference(&point.x, start, period, &mut turns);
    away.iter().zip(&point.tangent).map(|(a, b)| a * b).sum()
}

/// Looks for a return near the minimum of the distance to the start within the follower's last step.
pub fn look<C: Curve>(follower: &mut Follower<'_, C>, start: &[f64], period: f64) -> Option<Return> {
    let (from, to) = follower.last_step()?;
    let (mut x, mut slope, mut turns) = (start.to_vec(), start.to_vec(), vec![0.0; start.len()]);
    let mut nearest = 0.5 * (from + to);
    let mut seek = |hermite: &Hermite, s: f64| {
        let mut s = s;
        for _ in 0..20 {
            hermite.at(s, &mut x, &mut slope);
            let away = difference(&x, start, period, &mut turns);
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let step = dot(&away, &slope) / dot(&slope, &slope);
            s -= step;
            if step.abs() < 1e-14 * (1.0 + s.abs()) {
                break;
            }
        }
        hermite.at(s, &mut x, &mut slope);
        let away = difference(&x, start, period, &mut turns);
        let distance = away.iter().map(|a| a * a).sum::<f64>().sqrt();
        (s, distance, slope.clone(), turns.clone())
    };
    let (s, distance, ..) = seek(follower.dense(), nearest);
    let width = to - from;
    if !(from - width <= s && s <= to + width && distance < width) {
        return None;
    }
    nearest = s;
    let points: Vec<Point> = BESIDE.iter().filter_map(|away| follower.point_at(nearest + away)).collect();
    if points.len() < BESIDE.len() {
        return None;
    }
    let mut hermite = Hermite::default();
    hermite.fit(&points.iter().collect::<Vec<_>>());
    let (arc_length, distance, slope, turns) = seek(&hermite, nearest);
    let speed = slope.iter().map(|v| v * v).sum::<f64>().sqrt();
    (distance <= CLOSED).then(|| Return {
        arc_length,
        arrival: slope.iter().map(|v| v / speed).collect(),
        windings: turns.iter().map(|turns| *turns as i64).collect(),
    })
}
