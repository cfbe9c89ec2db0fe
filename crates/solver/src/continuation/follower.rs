//! The predictor and corrector, and where indicators change sign.

use super::closing;
use super::curve::{CurveOptions, CurvePoint, End, Event, Return, Trajectory};
use super::hermite::{Hermite, MOST};
use crate::implicit::{Corrector, Implicit};
use foldwell_numerics::vector::{dot, normalize};

/// Distance of a prediction from the curve that is aimed at, and the one above which a step is refused.
const WANTED_DISTANCE: f64 = 3e-6;
const LARGEST_DISTANCE: f64 = 1e-2;
/// Cosine of the largest angle between the tangents at both ends of a step.
const LEAST_TANGENT_COSINE: f64 = 0.9;
/// First step, in arc length, and the one below which a trajectory has failed.
const FIRST_STEP: f64 = 1e-2;
const LEAST_STEP: f64 = 1e-9;
/// Arc length to which sign changes are located.
const LOCATED_ARC_LENGTH: f64 = 1e-11;

/// A trajectory on its way.
struct CurveFollower<'a, C> {
    curve: &'a mut C,
    indicators: &'a mut dyn FnMut(&mut C, &CurvePoint, &mut Vec<f64>),
    corrector: Corrector,
    tolerance: f64,
    points: Vec<CurvePoint>,
    events: Vec<Event>,
    /// Interpolant of the last step, through `memory` points.
    dense: Hermite,
    memory: usize,
    spare: Vec<f64>,
}

/// Follows `curve`, as many independent equations as unknowns less one, from `x` along the unit vector `tangent`.
/// `indicators` appends the values whose sign changes are located, as many at every point, NaN where there is none.
/// `observe` sees every point and returns false to stop.
pub fn follow<C: Implicit>(
    curve: &mut C,
    x: Vec<f64>,
    tangent: Vec<f64>,
    options: &CurveOptions,
    indicators: &mut dyn FnMut(&mut C, &CurvePoint, &mut Vec<f64>),
    observe: &mut dyn FnMut(&CurvePoint) -> bool,
) -> Trajectory {
    let start = CurvePoint { arc_length: 0.0, x, tangent, residual: 0.0, corrections: 0 };
    let mut values = Vec::new();
    indicators(curve, &start, &mut values);
    let corrector = Corrector::new(curve);
    let spare = start.x.clone();
    let mut follower = CurveFollower {
        curve,
        indicators,
        corrector,
        tolerance: options.tolerance,
        points: vec![start],
        events: Vec::new(),
        dense: Hermite::default(),
        memory: options.points.clamp(2, MOST),
        spare,
    };
    let end = follower.run(options, values, observe);
    Trajectory { points: follower.points, events: follower.events, end }
}

impl<C: Implicit> CurveFollower<'_, C> {
    fn run(
        &mut self,
        options: &CurveOptions,
        mut indicators: Vec<f64>,
        observe: &mut dyn FnMut(&CurvePoint) -> bool,
    ) -> End {
        let mut step = FIRST_STEP.min(options.max_step);
        let mut approach = 0.0;
        while self.points.len() <= options.steps {
            let Some(next) = self.step(step.min(options.max_step)) else { return End::Failed };
            step = next;
            if let Some(end) = self.ended(options, &mut approach) {
                return end;
            }
            let before = std::mem::take(&mut indicators);
            (self.indicators)(self.curve, &self.points[self.points.len() - 1], &mut indicators);
            if let Some(indicator) = self.pass(options, &before, &indicators) {
                return End::Stopped { indicator };
            }
            if self.points[self.points.len() - 1].arc_length >= options.length {
                self.events.retain(|event| event.point.arc_length <= options.length);
                let Some(point) = self.point_at(options.length) else { return End::Failed };
                self.points.pop();
                self.points.push(point);
                return End::Length;
            }
            if !observe(&self.points[self.points.len() - 1]) {
                return End::Interrupted;
            }
        }
        End::Steps
    }

    /// Makes one step of about this length, or shorter. Returns the length of the next one, `None` where no step leads
    /// on.
    fn step(&mut self, mut length: f64) -> Option<f64> {
        let first = self.points.len().saturating_sub(self.memory);
        let known: Vec<&CurvePoint> = self.points[first..].iter().collect();
        let order = 2 * known.len();
        self.dense.fit(&known);
        let last = self.points[self.points.len() - 1].clone();
        while length > LEAST_STEP {
            let mut point = last.clone();
            self.dense.at(last.arc_length + length, &mut point.x, &mut point.tangent);
            normalize(&mut point.tangent);
            let found = self.corrector.correct(self.curve, &mut point.x, &mut point.tangent, self.tolerance);
            let turn = dot(&point.tangent, &last.tangent);
            match found {
                Some(found) if turn >= LEAST_TANGENT_COSINE && found.distance <= LARGEST_DISTANCE.min(0.2 * length) => {
                    (point.residual, point.corrections) = (found.residual, found.corrections);
                    self.push(point, length);
                    let factor = 0.9 * (WANTED_DISTANCE / found.distance.max(1e-16)).powf(1.0 / order as f64);
                    return Some(length * factor.clamp(0.3, 2.0));
                }
                _ => length *= 0.4,
            }
        }
        None
    }

    /// Appends a point whose arc length is found from the interpolant of the last step.
    fn push(&mut self, mut point: CurvePoint, guess: f64) {
        let last = self.points[self.points.len() - 1].arc_length;
        let mut length = guess;
        for _ in 0..4 {
            point.arc_length = last + length;
            let first = self.points.len().saturating_sub(self.memory - 1);
            let near: Vec<&CurvePoint> = self.points[first..].iter().chain([&point]).collect();
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

    /// The end of a trajectory that came back to its start.
    fn ended(&mut self, options: &CurveOptions, approach: &mut f64) -> Option<End> {
        let period = options.period?;
        let start = self.points[0].x.clone();
        let now = closing::approach(&self.points[self.points.len() - 1], &start, period);
        let passed = *approach < 0.0 && now >= 0.0;
        *approach = now;
        let found = passed.then(|| self.come_back(&start, period)).flatten()?;
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

    /// Looks for a return to the start within the last step.
    fn come_back(&mut self, start: &[f64], period: f64) -> Option<Return> {
        let nearest = closing::nearest(&self.dense, self.last_step()?, start, period)?;
        let beside: Vec<CurvePoint> = closing::BESIDE.iter().filter_map(|away| self.point_at(nearest + away)).collect();
        closing::closed(&beside, nearest, start, period)
    }

    /// Locates the sign changes of the last step; one that ends the trajectory becomes its last point.
    fn pass(&mut self, options: &CurveOptions, before: &[f64], after: &[f64]) -> Option<usize> {
        let changed = |k: &usize| before[*k] * after[*k] < 0.0 || (after[*k] == 0.0 && before[*k].abs() > 0.0);
        let mut found: Vec<Event> =
            (0..before.len()).filter(changed).filter_map(|k| self.locate(k, before[k], after[k])).collect();
        found.sort_by(|a, b| a.point.arc_length.total_cmp(&b.point.arc_length));
        for event in found {
            if options.stops.contains(&event.indicator) {
                let last = self.points.len() - 1;
                self.points[last] = event.point;
                return Some(event.indicator);
            }
            self.events.push(event);
        }
        None
    }

    /// Locates the sign change of an indicator within the last step, by the Illinois variant of the rule of false
    /// position.
    fn locate(&mut self, indicator: usize, before: f64, after: f64) -> Option<Event> {
        let (from, to) = self.last_step()?;
        let (mut low, mut high) = ((from, before), (to, after));
        let mut best = self.points[self.points.len() - 1].clone();
        let mut values = Vec::new();
        for round in 0..100 {
            if (high.0 - low.0).abs() <= LOCATED_ARC_LENGTH || high.1 == 0.0 {
                break;
            }
            let share = if round % 3 == 2 { 0.5 } else { (low.1 / (low.1 - high.1)).clamp(1e-3, 1.0 - 1e-3) };
            let s = low.0 + share * (high.0 - low.0);
            let Some(point) = self.point_at(s) else { break };
            values.clear();
            (self.indicators)(self.curve, &point, &mut values);
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

    /// Arc lengths between which the last step lies.
    fn last_step(&self) -> Option<(f64, f64)> {
        let [.., from, to] = &self.points[..] else { return None };
        Some((from.arc_length, to.arc_length))
    }

    /// A point of the curve near the last step.
    ///
    /// Next to a point where branches cross no correction converges, or it goes to another branch: there the
    /// interpolant itself is taken where it is as good as a corrected point.
    fn point_at(&mut self, arc_length: f64) -> Option<CurvePoint> {
        let mut point = self.points[self.points.len() - 1].clone();
        point.arc_length = arc_length;
        self.dense.at(arc_length, &mut point.x, &mut point.tangent);
        normalize(&mut point.tangent);
        let predicted = point.clone();
        match self.corrector.correct(self.curve, &mut point.x, &mut point.tangent, self.tolerance) {
            Some(found) if found.distance <= LARGEST_DISTANCE => {
                (point.residual, point.corrections) = (found.residual, found.corrections);
                Some(point)
            }
            _ => {
                let residual = self.corrector.residual(self.curve, &predicted.x);
                (residual <= self.tolerance).then_some(CurvePoint { residual, corrections: 0, ..predicted })
            }
        }
    }
}
