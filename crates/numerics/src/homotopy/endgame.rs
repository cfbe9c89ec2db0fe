//! The end of a path, at `t = 0`: simple solutions by Newton's method, multiple ones by Cauchy's integral.
//!
//! Near `t = 0` a path is a power series in `t^(1/c)` with a winding number `c`. Led `c` times round the circle
//! `|t| = r` it comes back to where it began, and the mean over these rounds is its end (A. P. Morgan, A. J. Sommese
//! and C. W. Wampler, "Computing singular solutions to polynomial systems", Advances in Applied Mathematics 13, 305,
//! 1992). The mean of equally spaced points converges geometrically. A circle that holds more than the one singular
//! point gives a mean that is no solution; then the path goes on to a smaller circle.

use super::elimination;
use super::error::HomotopyError;
use super::system::{C, Homotopy, Quadrics, TotalDegree, distance, in_patch, norm, normalize};
use super::track::{Care, Tracker};
use crate::parallel;

/// Number of attempts at all paths.
const ATTEMPTS: u32 = 4;
/// First step of a path in its parameter, which goes from 1 to 0.
const FIRST_STEP: f64 = 0.05;
/// Parameter at which the endgame takes paths over.
const START: f64 = 0.02;
/// Ratio of the radius of a circle to that of the one before.
const RADIUS_RATIO: f64 = 0.25;
/// Largest number of circles.
const MOST_CIRCLES: usize = 24;
/// Number of points on a round; every second one gives the estimate of the error.
const POINTS_PER_ROUND: usize = 16;
const MOST_ROUNDS: usize = 64;
/// Distance of the end of a round from its beginning, relative to the size of the circle, below which the round is
/// closed.
const CLOSED_DISTANCE: f64 = 1e-4;
/// Largest residual of a mean that is a solution.
const SOLUTION_RESIDUAL: f64 = 3e-13;
/// Largest distance between the means of all points and of every second one.
const MEANS_DISTANCE: f64 = 1e-9;
/// Largest product of a correction and the curvature bound at which a solution counts as simple. Smale's theorem needs
/// 0.157 (M. Shub and S. Smale, "Complexity of Bezout's theorem I", J. AMS 6, 459, 1993).
const APPROXIMATE_ZERO: f64 = 0.1;

/// The end of a path.
#[derive(Clone, Debug)]
pub(super) enum HomotopyEnd {
    Simple(Simple),
    Singular { point: Vec<C>, error: f64 },
}

/// A simple solution, proved to exist near the point.
#[derive(Clone, Debug)]
pub(super) struct Simple {
    /// The solution, a vector of norm 1.
    pub point: Vec<C>,
    /// The last correction of Newton's method.
    pub error: f64,
    /// No other solution is nearer than this.
    pub separation: f64,
}

/// A homotopy that tells simple solutions at `t = 0` from singular ones.
pub(super) trait Target: Homotopy {
    /// The simple solution at or very near to a point, if there is one.
    fn simple(&self, x: &[C]) -> Option<Simple>;
}

impl Target for TotalDegree<'_> {
    fn simple(&self, x: &[C]) -> Option<Simple> {
        proved_simple(self.quadrics(), x)
    }
}

/// Returns what the first attempt that succeeds finds; each has smaller steps and other random numbers than the one
/// before.
pub(super) fn attempted<T>(attempt: impl Fn(u32) -> Result<T, HomotopyError>) -> Result<T, HomotopyError> {
    (1..ATTEMPTS).fold(attempt(0), |found, repeated| found.or_else(|_| attempt(repeated)))
}

/// Follows the paths from all starts, at `t = 1`, to their ends; fails where one is lost.
pub(super) fn ends(
    homotopy: &(impl Target + Sync),
    starts: &[Vec<C>],
    repeated: u32,
) -> Result<Vec<HomotopyEnd>, HomotopyError> {
    let path = |start: &Vec<C>| {
        let mut tracker = Tracker::new(homotopy, Care::of_attempt(repeated));
        let x = tracker.track(start, C::new(1.0, 0.0), C::new(START, 0.0), FIRST_STEP)?;
        finish(&mut tracker, x)
    };
    let ends = parallel::map_with_state(starts.len(), || (), |(), k| path(&starts[k]));
    let ends: Vec<HomotopyEnd> = ends.into_iter().flatten().collect();
    let paths = starts.len() - ends.len();
    if paths == 0 { Ok(ends) } else { Err(HomotopyError::Lost { paths }) }
}

/// Follows a path from [`START`] to its end; `None` where it is lost.
fn finish<H: Target>(tracker: &mut Tracker<H>, x: Vec<C>) -> Option<HomotopyEnd> {
    let (mut x, mut radius) = (x, START);
    for circle in 0..MOST_CIRCLES {
        let t = C::new(radius, 0.0);
        let leapt = tracker.step(&x, t, C::default());
        if let Some(simple) = leapt.and_then(|(point, _)| tracker.homotopy.simple(&point)) {
            return Some(HomotopyEnd::Simple(simple));
        }
        if circle > 0
            && let Some(end) = by_integral(tracker, &x, radius)
        {
            return Some(end);
        }
        x = tracker.track(&x, t, t * RADIUS_RATIO, 0.3)?;
        radius *= RADIUS_RATIO;
    }
    None
}

/// The mean over the rounds of a circle, where it is a solution.
fn by_integral<H: Target>(tracker: &mut Tracker<H>, x: &[C], radius: f64) -> Option<HomotopyEnd> {
    let (points, winding) = rounds(tracker, x, radius)?;
    let mean = |step: usize| -> Vec<C> {
        let count = points.len().div_ceil(step) as f64;
        (0..x.len()).map(|i| points.iter().step_by(step).map(|point| point[i]).sum::<C>() / count).collect()
    };
    let (mut point, mut coarse) = (mean(1), mean(2));
    normalize(&mut point);
    normalize(&mut coarse);
    let error = distance(&point, &coarse);
    let solved = error <= MEANS_DISTANCE && tracker.homotopy.quadrics().residual(&point) <= SOLUTION_RESIDUAL;
    if !solved {
        return None;
    }
    match tracker.homotopy.simple(&point) {
        None => Some(HomotopyEnd::Singular { point, error }),
        Some(found) => (winding == 1).then_some(HomotopyEnd::Simple(found)),
    }
}

/// The points of a path on a circle, in the patch of the first, until it closes; and how many rounds that takes.
fn rounds<H: Homotopy>(tracker: &mut Tracker<H>, x: &[C], radius: f64) -> Option<(Vec<Vec<C>>, usize)> {
    let on_circle = |k: usize| {
        C::from_polar(radius, std::f64::consts::TAU * (k % POINTS_PER_ROUND) as f64 / POINTS_PER_ROUND as f64)
    };
    let first = tracker.polished(x, on_circle(0));
    let (mut points, mut at, mut size) = (Vec::new(), first.clone(), 0.0f64);
    for winding in 1..=MOST_ROUNDS {
        for k in 0..POINTS_PER_ROUND {
            points.push(in_patch(&first, &at));
            size = size.max(distance(&first, &at));
            at = tracker.track(&at, on_circle(k), on_circle(k + 1), 1.0)?;
            at = tracker.polished(&at, on_circle(k + 1));
        }
        if distance(&first, &at) <= CLOSED_DISTANCE * size + 1e-13 {
            return Some((points, winding));
        }
    }
    None
}

/// Newton's method at the target; `Some` where Smale's criterion proves a simple solution.
///
/// With `b` a bound of the correction and `g >= |DF^-1 D^2F / 2|`, `b g` small proves a solution within `2 b` and no
/// other within `0.2 / g`. The quadrics have norm 1, so `|D^2F / 2| <= sqrt(m)`; and as they are known to rounding
/// only, the correction is never less than `|DF^-1|` times that.
fn proved_simple(quadrics: &Quadrics, x: &[C]) -> Option<Simple> {
    let mut point = x.to_vec();
    let (mut error, mut bound, mut curvature) = (f64::INFINITY, f64::INFINITY, f64::INFINITY);
    for _ in 0..8 {
        let (correction, inverse) = newton(quadrics, &point)?;
        let size = norm(&correction);
        let ended = size >= 0.5 * error;
        (error, bound) = (error.min(size), size.max(inverse * f64::EPSILON));
        curvature = inverse * (quadrics.count() as f64).sqrt();
        if ended {
            break;
        }
        point.iter_mut().zip(&correction).for_each(|(a, b)| *a += b);
        normalize(&mut point);
    }
    let proved = bound * curvature <= APPROXIMATE_ZERO;
    proved.then(|| Simple { point, error, separation: 0.2 / curvature.max(1.0) })
}

/// The correction at a point of norm 1, and the Frobenius norm of the inverse Jacobian in its patch.
fn newton(quadrics: &Quadrics, x: &[C]) -> Option<(Vec<C>, f64)> {
    let n = x.len();
    let (mut value, mut jacobian) = (vec![C::default(); n], vec![C::default(); n * n]);
    quadrics.evaluate(x, &mut value, &mut jacobian);
    jacobian[n * (n - 1)..].iter_mut().zip(x).for_each(|(a, b)| *a = b.conj());
    let mut squares = 0.0;
    for k in 0..n {
        let mut column = vec![C::default(); n];
        column[k] = C::new(1.0, 0.0);
        if !elimination::solve(&mut jacobian.clone(), &mut column) {
            return None;
        }
        squares += column.iter().map(C::norm_sqr).sum::<f64>();
    }
    let mut correction: Vec<C> = value.iter().map(|value| -value).collect();
    elimination::solve(&mut jacobian, &mut correction).then_some((correction, squares.sqrt()))
}
