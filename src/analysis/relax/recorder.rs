//! The states on the way of a relaxation: its observer, which keeps every n-th of them where that is asked for.

use crate::analysis::state::State;
use crate::model::Model;
use crate::solver::{Equilibrium, NewtonError, Options, Start, Step, minimize_iterates};
use std::num::NonZeroUsize;

/// A state on the way of a relaxation, which
/// [`RelaxOptions::keep_every`](crate::analysis::relax::RelaxOptions::keep_every) asks for.
///
/// ```
/// use foldwell::analysis::relax::RelaxOptions;
/// use foldwell::analysis::relax::relax_from;
/// use foldwell::model::Gauge;
/// use foldwell::{Assembly, Pattern, RIGID, Rest, generate};
/// use std::num::NonZeroUsize;
///
/// let sheet = generate(&Pattern::named("miura")?)?;
/// let assembly = Assembly::patch(sheet, [2, 2]).bars(RIGID).creases(1.0).rest(Rest::Flat).build()?;
/// let model = assembly.model(Gauge::Held);
/// let options = RelaxOptions { keep_every: NonZeroUsize::new(1), ..RelaxOptions::default() };
/// let relaxed = relax_from(&model, model.start(), options, &mut |_| true)?;
/// assert!(relaxed.kept.len() == relaxed.history.len());
/// assert!(relaxed.kept[0].state.total() > relaxed.state.total());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct KeptState {
    /// Its place in the history of the relaxation.
    pub iteration: usize,
    /// The state.
    pub state: State,
}

/// The observer of a relaxation. It writes the history of its steps, shows them to another observer, and keeps states.
pub(super) struct Recorder<'a> {
    observe: &'a mut dyn FnMut(&Step) -> bool,
    every: Option<NonZeroUsize>,
    /// The steps so far.
    pub(super) history: Vec<Step>,
    kept: Vec<KeptState>,
}

impl<'a> Recorder<'a> {
    /// An observer that shows steps to `observe` and keeps one in `every` states, the first one included; none without
    /// that.
    pub(super) fn new(observe: &'a mut dyn FnMut(&Step) -> bool, every: Option<NonZeroUsize>) -> Self {
        Self { observe, every, history: vec![], kept: vec![] }
    }

    /// Sees a step, and the state that it leads to, which is made only where it is kept. Returns whether to go on.
    pub(super) fn see(&mut self, step: &Step, state: impl FnOnce() -> State) -> bool {
        let iteration = self.steps();
        if self.every.is_some_and(|every| iteration.is_multiple_of(every.get())) {
            self.kept.push(KeptState { iteration, state: state() });
        }
        self.history.push(*step);
        (self.observe)(step)
    }

    /// Minimises a model under this observer.
    pub(super) fn minimize(
        &mut self,
        model: &mut Model,
        start: impl Into<Start>,
        options: Options,
    ) -> Result<Equilibrium, NewtonError> {
        minimize_iterates(model, start, options, &mut |at| {
            self.see(at.step, || State::new(at.problem, at.x, at.tension))
        })
    }

    /// Number of steps so far.
    pub(super) fn steps(&self) -> usize {
        self.history.len()
    }

    /// Forgets all steps after the first `steps`: they turn out not to belong to the history.
    pub(super) fn forget_after(&mut self, steps: usize) {
        self.history.truncate(steps);
        self.kept.retain(|kept| kept.iteration < steps);
    }

    /// Returns the history, and the states that were kept, the last of the history among them in any case: as `last`,
    /// where that is known.
    pub(super) fn end(mut self, last: Option<&State>) -> (Vec<Step>, Vec<KeptState>) {
        if let Some(last) = last.filter(|_| self.every.is_some()) {
            let iteration = self.steps().saturating_sub(1);
            self.kept.retain(|kept| kept.iteration < iteration);
            self.kept.push(KeptState { iteration, state: last.clone() });
        }
        (self.history, self.kept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: Step = Step {
        energy: 0.0,
        residual_force: 0.0,
        residual_length: 0.0,
        fraction: 1.0,
        shift: 0.0,
        factorizations: 0,
        solves: 0,
        intrinsic: false,
    };

    fn state(number: usize) -> State {
        State::empty(vec![number as f64], 0)
    }

    fn kept_of(every: Option<usize>, see: impl Fn(&mut Recorder<'_>)) -> Vec<(usize, f64)> {
        let mut observe = |_: &Step| true;
        let mut recorder = Recorder::new(&mut observe, every.and_then(NonZeroUsize::new));
        see(&mut recorder);
        let (_, kept) = recorder.end(Some(&state(99)));
        kept.into_iter().map(|kept| (kept.iteration, kept.state.coordinates[0])).collect()
    }

    /// Claim: every n-th state and the last one are kept, and none, not even made, where none is asked for. Exact.
    #[test]
    fn every_nth_state_and_the_last() {
        let seven = |recorder: &mut Recorder<'_>| (0..7).for_each(|k| assert!(recorder.see(&STEP, || state(k))));
        assert_eq!(kept_of(Some(3), seven), [(0, 0.0), (3, 3.0), (6, 99.0)]);
        assert_eq!(kept_of(Some(4), seven), [(0, 0.0), (4, 4.0), (6, 99.0)]);
        let unmade = |recorder: &mut Recorder<'_>| assert!(recorder.see(&STEP, || panic!("no state is asked for")));
        assert_eq!(kept_of(None, unmade), []);
    }

    /// Claim: steps that are forgotten leave no state, and those after them are counted as if they had never been.
    /// Exact.
    #[test]
    fn forgotten_steps_leave_no_state() {
        let kept = kept_of(Some(2), |recorder| {
            (0..3).for_each(|k| assert!(recorder.see(&STEP, || state(k))));
            let mark = recorder.steps();
            (10..13).for_each(|k| assert!(recorder.see(&STEP, || state(k))));
            recorder.forget_after(mark);
            (20..23).for_each(|k| assert!(recorder.see(&STEP, || state(k))));
        });
        assert_eq!(kept, [(0, 0.0), (2, 2.0), (4, 21.0), (5, 99.0)]);
    }
}
