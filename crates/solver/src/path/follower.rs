//! Steps along a path: predictor, corrector, and the length of the next step.

use super::bordered::{Bordered, Hyperplane};
use super::interpolant::Cubic;
use super::outcome::{Found, PathError, PathSettings};
use super::problem::{ParametrizedProblem, PathState, Rates};
use crate::newton::Start;
use foldwell_numerics::vector::dot;

/// Length of the first step relative to the longest one, and the shortest one relative to it.
const FIRST_STEP: f64 = 0.1;
const SHORTEST_STEP: f64 = 1e-9;
/// Rate of the parameter along a tangent, over the largest possible one, up to which the tangent does not tell where the
/// parameter grows: the load of a net of cables without force grows with the third power of the way.
const STANDING: f64 = 1e-9;
/// Error of a prediction relative to the step that is aimed at.
const WANTED_ERROR: f64 = 0.02;
/// Cosine of the largest angle between the tangents at both ends of a step.
pub(super) const LEAST_TANGENT_COSINE: f64 = 0.8;
/// Length of a step relative to the longest one below which a path whose stiffness jumps is taken to have a kink: there
/// no step, however short, looks smooth.
const KINK_STEP: f64 = 1e-3;
/// Largest change of the measure of a soft element in a step: a fold angle in radians.
const LARGEST_MEASURE_CHANGE: f64 = 0.5;
/// Distance, over the scale of the parameter, from the value sought at which a state has it.
const LOCATED: f64 = 1e-9;
/// Bounds of the ratio of one step to the one before.
pub(super) const SHRINK: f64 = 0.4;
const GROWTH: f64 = 1.6;

/// A path on its way.
pub(super) struct Follower<'a, P: ParametrizedProblem> {
    pub problem: &'a mut P,
    pub bordered: Bordered,
    pub settings: PathSettings,
    /// Whether stiffness may jump on the way.
    kinks: bool,
    /// The parameter at which the path began.
    pub origin: f64,
    /// Largest rate of the conjugate quantity, and largest product of it and the parameter's way, on the path.
    pub largest: [f64; 2],
    /// Number of Newton steps so far, those to states that were refused included.
    pub newton_steps: usize,
}

impl<'a, P: ParametrizedProblem> Follower<'a, P> {
    /// Makes room for the systems of a problem.
    pub fn new(problem: &'a mut P, settings: PathSettings) -> Found<Self> {
        let (bordered, kinks, origin) = (Bordered::new(problem)?, problem.may_have_kinks(), problem.parameter());
        Ok(Self { problem, bordered, settings, kinks, origin, largest: [0.0; 2], newton_steps: 0 })
    }

    /// Takes a state into account in the largest values of the path.
    pub fn measure(&mut self, state: &PathState) {
        let way = (state.parameter - self.origin).abs();
        self.largest[0] = self.largest[0].max(state.conjugate[1].abs());
        self.largest[1] = self.largest[1].max(way * state.conjugate[0].abs());
    }

    /// The first state, at the problem's parameter, with the tangent towards the target.
    pub fn begin(&mut self, Start { x, tension }: Start) -> Found<PathState> {
        let tension = tension.unwrap_or_else(|| vec![0.0; self.problem.layout().stiff.len()]);
        let sign = if self.settings.target < self.origin { -1.0 } else { 1.0 };
        let plane = Hyperplane::of_parameter(x.len(), sign);
        let guess = Rates { x, tension, parameter: self.origin };
        let (mut state, _) = self.settle(guess, &plane, 0.0)?.ok_or(PathError::NoStart)?;
        self.problem.accept(&mut state.x);
        let stands = state.tangent.parameter.abs() <= STANDING * self.bordered.unit * self.bordered.length;
        if stands && !self.leads(&state, sign)? {
            state = state.scaled(-1.0);
        }
        Ok(state)
    }

    /// Whether the first step from a state leads towards larger (`1.0`) or smaller parameters.
    fn leads(&mut self, state: &PathState, sign: f64) -> Found<bool> {
        let reference = self.problem.reference(&state.x);
        let next = self.step(None, state, self.first_step())?;
        self.problem.set_reference(&reference);
        Ok(next.is_some_and(|(next, _)| (next.parameter - state.parameter) * sign > 0.0))
    }

    /// Goes to how a state is written, with the reference that belongs to it.
    pub fn go_to(&mut self, state: &PathState, reference: &[f64]) -> Found<()> {
        self.problem.set_reference(reference);
        if self.problem.choice() != state.choice {
            self.problem.set_choice(&state.choice);
            self.bordered = Bordered::new(self.problem)?;
        }
        Ok(())
    }

    /// The last state of a path as it is written by a new choice, where the present one would soon be singular.
    pub fn chosen_anew(&mut self, last: &PathState) -> Found<Option<PathState>> {
        let Some([x, rates]) = self.problem.choose_anew(&last.x, &last.tangent.x) else { return Ok(None) };
        self.bordered = Bordered::new(self.problem)?;
        let tangent = Rates { x: rates, ..last.tangent.clone() };
        let per_length = 1.0 / self.size(&tangent);
        let choice = self.problem.choice();
        Ok(Some(PathState { x, tangent, choice, ..last.clone() }.scaled(per_length)))
    }

    /// One step from the last of two states (or the only one) of about this length. Returns the state and the length
    /// of the next step; `None` where no step leads on.
    pub fn step(
        &mut self,
        before: Option<&PathState>,
        last: &PathState,
        length: f64,
    ) -> Found<Option<(PathState, f64)>> {
        let mut length = length.min(self.settings.max_step);
        let unit_of_length = self.bordered.length;
        // a cubic through states on both sides of a kink says nothing of what lies beyond
        let is_smooth = |before: &&PathState| self.cosine(&before.tangent, &last.tangent) >= LEAST_TANGENT_COSINE;
        let before = before.filter(is_smooth);
        while length > SHORTEST_STEP * self.settings.max_step {
            let guess = predicted(before, last, length);
            let at_kink = self.kinks && length < KINK_STEP * self.settings.max_step;
            // at a kink the path may go on either way
            for of_unknowns in [false, true].into_iter().filter(|of_unknowns| at_kink || !of_unknowns) {
                let plane = self.plane(&last.tangent, of_unknowns);
                let Some((mut state, off)) = self.settle(guess.clone(), &plane, 0.0)? else { continue };
                let chord = Cubic::new(last, &state).chord();
                let way = self.size(&chord);
                let turn = self.cosine(&last.tangent, &state.tangent);
                let folds = self.bordered.tangent.at.largest_measure_change(&chord.x);
                let error = off / (unit_of_length * length);
                let is_smooth = turn >= LEAST_TANGENT_COSINE && error <= 10.0 * WANTED_ERROR;
                let is_short = folds <= LARGEST_MEASURE_CHANGE && self.problem.admits(&last.x, &state.x);
                if is_short && (is_smooth || at_kink) {
                    state.arc_length = last.arc_length + way;
                    self.problem.accept(&mut state.x);
                    let factor = (WANTED_ERROR / error.max(1e-12)).powf(1.0 / 3.0);
                    return Ok(Some((state, length * factor.clamp(SHRINK, GROWTH))));
                }
            }
            length *= SHRINK;
        }
        Ok(None)
    }

    /// The plane across a direction; at a kink, where the parameter may turn back at once while the unknowns go on, across
    /// the direction of the unknowns.
    fn plane(&self, direction: &Rates, at_kink: bool) -> Hyperplane {
        let plane = Hyperplane::across(direction, self.bordered.unit);
        if at_kink { Hyperplane { parameter: 0.0, ..plane } } else { plane }
    }

    /// First step of a path.
    pub fn first_step(&self) -> f64 {
        FIRST_STEP * self.settings.max_step
    }

    /// Cosine of the angle between two tangents.
    pub fn cosine(&self, a: &Rates, b: &Rates) -> f64 {
        self.product(a, b) / (self.product(a, a) * self.product(b, b)).sqrt()
    }

    /// Product of two changes, the parameter's part in units of length.
    pub fn product(&self, a: &Rates, b: &Rates) -> f64 {
        let unit = self.bordered.unit;
        dot(&a.x, &b.x) + a.parameter * b.parameter / (unit * unit)
    }

    /// The state of the path at a part of the way from one state to the next.
    pub fn between(&mut self, from: &PathState, to: &PathState, part: f64) -> Found<Option<PathState>> {
        let cubic = Cubic::new(from, to);
        let arc_length = from.arc_length + part * (to.arc_length - from.arc_length);
        // where there may be a kink only the plane across the unknowns may meet the path, as in a step
        let (jumps, kinks) = (self.problem.has_kinks(), self.kinks);
        for at_kink in [false, true].into_iter().filter(|at_kink| if *at_kink { kinks } else { !jumps }) {
            let plane = self.plane(&cubic.chord(), at_kink);
            if let Some((state, _)) = self.settle(cubic.at(part), &plane, arc_length)? {
                return Ok(Some(state));
            }
        }
        Ok(None)
    }

    /// The state of the path with this parameter next to a part of the way from one state to the next.
    pub fn at_parameter(&mut self, from: &PathState, to: &PathState, parameter: f64) -> Found<Option<PathState>> {
        let part = (parameter - from.parameter) / (to.parameter - from.parameter);
        let guess = Rates { parameter, ..Cubic::new(from, to).at(part) };
        let plane = Hyperplane::of_parameter(from.x.len(), (to.parameter - from.parameter).signum());
        let arc_length = from.arc_length + part * (to.arc_length - from.arc_length);
        if let Some((state, _)) = self.settle(guess, &plane, arc_length)? {
            return Ok(Some(state));
        }
        // next to a state at which the parameter turns only planes across the path meet it well
        let found = self.locate([from, to], &mut |_, state| state.parameter - parameter)?;
        let off = LOCATED * self.problem.parameter_scale();
        Ok(found.filter(|state| (state.parameter - parameter).abs() <= off))
    }
}

/// The state predicted at this arc length beyond the last of two states, or beyond the only one.
fn predicted(before: Option<&PathState>, last: &PathState, length: f64) -> Rates {
    if let Some(before) = before {
        let part = 1.0 + length / (last.arc_length - before.arc_length);
        // far beyond the interval a cubic is worth less than the tangent
        if part <= 1.0 + 2.0 * GROWTH {
            return Cubic::new(before, last).at(part);
        }
    }
    let mut guess = last.place();
    guess.add(length, &last.tangent);
    guess
}
