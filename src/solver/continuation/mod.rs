//! Continuation: follows a curve `F(x) = 0` from a point on it, in arc length.
//!
//! Predictor: the Hermite interpolant of the last points and their tangents, read beyond the last one. Corrector: Newton's
//! method across the predicted tangent ([`super::implicit`]); redundant equations are welcome. The step follows the error of
//! the prediction. Where branches cross, the Jacobian loses rank at one point; steps go over such points, and the predicted
//! tangent keeps the trajectory on the smooth branch. Arc length is the integral of the interpolant's speed.
//!
//! Along the way the curve's *indicators* are watched: where one changes sign the point is located on the curve. Some of
//! them end the trajectory. Given a period, the trajectory ends where it comes back to its start (`closing`).

mod closing;
mod hermite;
#[cfg(test)]
mod tests;

pub use closing::Return;

use super::implicit::{Corrector, Implicit};
use hermite::Hermite;

/// Error of a prediction that is aimed at, and the one above which a step is refused.
const AIM: f64 = 3e-6;
const MOST_ERROR: f64 = 1e-2;
/// Cosine of the largest turn of the tangent in a step.
const LEAST_TURN: f64 = 0.9;
/// First step, and the one below which a trajectory has failed.
const FIRST: f64 = 1e-2;
const LEAST: f64 = 1e-9;
/// Accuracy in arc length to which sign changes are located.
const LOCATED: f64 = 1e-11;

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

/// What is known while following a curve.
struct Follower<'a, C> {
    curve: &'a mut C,
    corrector: Corrector,
    tolerance: f64,
    points: Vec<Point>,
    /// Interpolant of the last step, through this many points.
    dense: Hermite,
    memory: usize,
    spare: Vec<f64>,
}

/// Follows `curve` from `x` along the unit vector `tangent`. `observe` sees every point and returns false to stop.
pub fn follow<C: Curve>(
    curve: &mut C,
    x: Vec<f64>,
    tangent: Vec<f64>,
    options: &Options,
    observe: &mut dyn FnMut(&Point) -> bool,
) -> Trajectory {
    let start = Point { arc_length: 0.0, x, tangent, residual: 0.0, corrections: 0 };
    let mut indicators = Vec::new();
    curve.indicators(&start, &mut indicators);
    let corrector = Corrector::new(curve);
    let spare = start.x.clone();
    let mut follower = Follower {
        curve,
        corrector,
        tolerance: options.tolerance,
        points: vec![start],
        dense: Hermite::default(),
        memory: options.points.clamp(2, hermite::MOST),
        spare,
    };
    let mut events = Vec::new();
    let end = follower.run(options, indicators, &mut events, observe);
    Trajectory { points: follower.points, events, end }
}

impl<C: Curve> Follower<'_, C> {
    fn run(
        &mut self,
        options: &Options,
        mut indicators: Vec<f64>,
        events: &mut Vec<Event>,
        observe: &mut dyn FnMut(&Point) -> bool,
    ) -> End {
        let mut step = FIRST.min(options.max_step);
        let mut approach = 0.0;
        while self.points.len() <= options.steps {
            let Some(next) = self.step(step.min(options.max_step)) else { return End::Failed };
            step = next;
            if let Some(end) = self.ended(options, &mut approach) {
                return end;
            }
            let before = std::mem::take(&mut indicators);
            self.curve.indicators(&self.points[self.points.len() - 1], &mut indicators);
            if let Some(indicator) = self.pass(options, &before, &indicators, events) {
                return End::Stopped { indicator };
            }
            if self.points[self.points.len() - 1].arc_length >= options.length {
                return if self.cut(options.length) { End::Length } else { End::Failed };
            }
            if !observe(&self.points[self.points.len() - 1]) {
                return End::Interrupted;
            }
        }
        End::Steps
    }

    /// One accepted step of about this length, or shorter; the length of the next, `None` where there is none.
    fn step(&mut self, mut length: f64) -> Option<f64> {
        let first = self.points.len().saturating_sub(self.memory);
        let known: Vec<&Point> = self.points[first..].iter().collect();
        let order = 2 * known.len();
        self.dense.fit(&known);
        let last = self.points[self.points.len() - 1].clone();
        while length > LEAST {
            let mut point = last.clone();
            self.dense.at(last.arc_length + length, &mut point.x, &mut point.tangent);
            normalize(&mut point.tangent);
            let found = self.corrector.correct(self.curve, &mut point.x, &mut point.tangent, self.tolerance);
            let turn: f64 = point.tangent.iter().zip(&last.tangent).map(|(a, b)| a * b).sum();
            match found {
                Some(found) if turn >= LEAST_TURN && found.distance <= MOST_ERROR.min(0.2 * length) => {
                    (point.residual, point.corrections) = (found.residual, found.corrections);
                    self.push(point, length);
                    let factor = 0.9 * (AIM / found.distance.max(1e-16)).powf(1.0 / order as f64);
                    return Some(length * factor.clamp(0.3, 2.0));
                }
                _ => length *= 0.4,
            }
        }
        None
    }

    /// Appends a point whose arc length is found from the interpolant of the last step.
    fn push(&mut self, mut point: Point, guess: f64) {
        let last = self.points[self.points.len() - 1].arc_length;
        let mut length = guess;
        for _ in 0..4 {
            point.arc_length = last + length;
            let first = self.points.len().saturating_sub(self.memory - 1);
            let near: Vec<&Point> = self.points[first..].iter().chain([&point]).collect();
            self.dense.fit(&near);
            let mut x = point.x.clone();
            let longer = self.dense.length(last, point.arc_length, &mut x, &mut self.spare);
            let change = (longer - length).abs();
            length = longer;
            if change <= 1e-14 {
                break;
            }
        }
        self.points.push(point);
    }

    /// The end by coming back.
    fn ended(&mut self, options: &Options, approach: &mut f64) -> Option<End> {
        let period = options.period?;
        let start = self.points[0].x.clone();
        let now = closing::approach(&self.points[self.points.len() - 1], &start, period);
        let passed = *approach < 0.0 && now >= 0.0;
        *approach = now;
        let found = passed.then(|| closing::look(self, &start, period)).flatten()?;
        let mut last = self.points.pop()?;
        last.arc_length = found.arc_length;
        last.x = start.iter().zip(&found.windings).map(|(x, turns)| x + *turns as f64 * period).collect();
        last.tangent.clone_from(&found.arrival);
        while self.points.last().is_some_and(|point| point.arc_length >= last.arc_length) {
            self.points.pop();
        }
        self.points.push(last);
        Some(End::Closed(found))
    }

    /// Locates the sign changes of the last step; one that ends the trajectory becomes its last point.
    fn pass(&mut self, options: &Options, before: &[f64], after: &[f64], events: &mut Vec<Event>) -> Option<usize> {
        let changed = |k: &usize| before[*k] * after[*k] < 0.0 || (after[*k] == 0.0 && before[*k] != 0.0);
        let mut found: Vec<Event> =
            (0..before.len()).filter(changed).filter_map(|k| self.locate(k, before[k], after[k])).collect();
        found.sort_by(|a, b| a.point.arc_length.total_cmp(&b.point.arc_length));
        for event in found {
            if options.stops.contains(&event.indicator) {
                let last = self.points.len() - 1;
                self.points[last] = event.point;
                return Some(event.indicator);
            }
            events.push(event);
        }
        None
    }

    /// Where an indicator changes sign within the last step: the Illinois variant of the rule of false position.
    fn locate(&mut self, indicator: usize, before: f64, after: f64) -> Option<Event> {
        let (from, to) = self.last_step()?;
        let (mut low, mut high) = ((from, before), (to, after));
        let mut best = self.points[self.points.len() - 1].clone();
        let mut values = Vec::new();
        for round in 0..100 {
            if (high.0 - low.0).abs() <= LOCATED || high.1 == 0.0 {
                break;
            }
            let share = if round % 3 == 2 { 0.5 } else { (low.1 / (low.1 - high.1)).clamp(1e-3, 1.0 - 1e-3) };
            let s = low.0 + share * (high.0 - low.0);
            let Some(point) = self.point_at(s) else { break };
            values.clear();
            self.curve.indicators(&point, &mut values);
            let value = values[indicator];
            if value * high.1 > 0.0 || value == 0.0 {
                (high, best) = ((s, value), point);
                low.1 *= 0.5;
            } else {
                low = (s, value);
                high.1 *= 0.5;
            }
        }
        Some(Event { indicator, point: best })
    }

    /// Makes the trajectory end at this arc length within its last step; false where no point is found there.
    fn cut(&mut self, length: f64) -> bool {
        let Some(point) = self.point_at(length) else { return false };
        let last = self.points.len() - 1;
        self.points[last] = point;
        true
    }

    /// Arc lengths between which the last step lies.
    fn last_step(&self) -> Option<(f64, f64)> {
        let [.., from, to] = &self.points[..] else { return None };
        Some((from.arc_length, to.arc_length))
    }

    fn dense(&self) -> &Hermite {
        &self.dense
    }

    /// A point of the curve near the last step.
    ///
    /// Next to a point where branches cross no correction converges, or it goes to another branch: there the interpolant
    /// itself is taken where it is as good as a corrected point.
    fn point_at(&mut self, arc_length: f64) -> Option<Point> {
        let mut point = self.points[self.points.len() - 1].clone();
        point.arc_length = arc_length;
        self.dense.at(arc_length, &mut point.x, &mut point.tangent);
        normalize(&mut point.tangent);
        let predicted = point.clone();
        match self.corrector.correct(self.curve, &mut point.x, &mut point.tangent, self.tolerance) {
            Some(found) if found.distance <= MOST_ERROR => {
                (point.residual, point.corrections) = (found.residual, found.corrections);
                Some(point)
            }
            _ => {
                let residual = self.corrector.residual(self.curve, &predicted.x);
                (residual <= self.tolerance).then_some(Point { residual, corrections: 0, ..predicted })
            }
        }
    }
}

fn normalize(v: &mut [f64]) {
    let length = v.iter().map(|a| a * a).sum::<f64>().sqrt();
    v.iter_mut().for_each(|a| *a /= length);
}
