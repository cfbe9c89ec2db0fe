//! One relaxation on its way: the model, what is asked for, where it began, and what has been done so far. The routes
//! work on it.

use super::recorder::Recorder;
use crate::analysis::relax::options::{IntrinsicFailure, Method, RelaxOptions};
use crate::model::{Configuration, Model};
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Problem, Start, Step};
use std::ops::Range;

/// How a relaxation ended so far.
pub(super) type Ending = Result<Equilibrium, NewtonError>;

/// Relative fall of an energy that rounding errors do not explain.
const LOWER: f64 = 1e-10;

/// A way that a relaxation took, and how it stood after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RouteTried {
    /// The name of the route.
    pub name: &'static str,
    /// Accepted steps that it added to the history: none where it did not help.
    pub iterations: usize,
    /// The failure that stood after it; `None` for an equilibrium.
    pub failure: Option<Failure>,
    /// Negative eigenvalues of the equilibrium that stood after it; `None` where it is none, or where they could not be
    /// counted.
    pub negative_eigenvalues: Option<usize>,
}

/// Whether a relaxation failed because the observer asked to stop.
pub(super) fn is_interruption(error: &NewtonError) -> bool {
    error.failure == Failure::Interrupted
}

/// Whether a relaxation ended in an equilibrium of lower energy than before, or was interrupted.
pub(super) fn is_better(other: &Ending, before: &Ending) -> bool {
    match (other, before) {
        (Ok(other), Ok(before)) => before.energy - other.energy > LOWER * before.energy.abs(),
        (Ok(_), Err(_)) => true,
        (Err(error), _) => is_interruption(error),
    }
}

/// A relaxation on its way, with a model of its own.
pub(super) struct Run<'a> {
    pub(super) model: Model,
    pub(super) options: Options,
    pub(super) method: Method,
    /// Where it began.
    pub(super) start: Configuration,
    pub(super) start_energy: f64,
    pub(super) recorder: Recorder<'a>,
    /// The ways that were taken.
    pub(super) routes: Vec<RouteTried>,
    /// Which steps of the history were made with bars that stretch.
    pub(super) soft_steps: Range<usize>,
    /// Why fold angles were given up, if they were tried as unknowns.
    pub(super) intrinsic_failure: Option<IntrinsicFailure>,
}

impl<'a> Run<'a> {
    pub(super) fn new(
        model: Model,
        start: &Start,
        options: RelaxOptions,
        observe: &'a mut dyn FnMut(&Step) -> bool,
    ) -> Self {
        let start_energy = model.energy(&start.x);
        let start = model.configuration(&start.x, start.tension.clone());
        let RelaxOptions { newton: options, method, keep_every } = options;
        let recorder = Recorder::new(observe, keep_every);
        let (routes, soft_steps) = (vec![], 0..0);
        Self { model, options, method, start, start_energy, recorder, routes, soft_steps, intrinsic_failure: None }
    }

    /// Whether tensions were known at the start: it is then next to an equilibrium, and the relaxation stays on its
    /// branch.
    pub(super) fn is_restarted(&self) -> bool {
        self.start.tension.is_some()
    }

    /// Notes a way that was taken, with the steps that it added after the first `steps` of the history. One that found
    /// nothing better than the equilibrium that was there is passed over.
    pub(super) fn note(&mut self, name: &'static str, steps: usize, ending: &Ending) {
        let added = self.recorder.history.get(steps..).unwrap_or_default();
        if added.is_empty() && ending.is_ok() {
            return;
        }
        let iterations = added.iter().filter(|step| step.fraction > 0.0).count();
        let (failure, negative_eigenvalues) = match ending {
            Ok(found) => (None, found.negative_eigenvalues),
            Err(error) => (Some(error.failure), None),
        };
        self.routes.push(RouteTried { name, iterations, failure, negative_eigenvalues });
    }

    /// Minimises from a start, to the tolerance that was asked for.
    pub(super) fn minimize(&mut self, start: impl Into<Start>) -> Ending {
        self.recorder.minimize(&mut self.model, start, self.options)
    }

    /// Does something while all bars, or the rigid ones alone, have at most this stiffness over that of the softest hinge.
    pub(super) fn with_soft_bars<T>(&mut self, ratio: f64, only_rigid: bool, go: impl FnOnce(&mut Self) -> T) -> T {
        let first = if self.soft_steps.is_empty() { self.recorder.steps() } else { self.soft_steps.start };
        self.model.limit_bars(ratio * self.model.softest_hinge(), only_rigid);
        let found = go(self);
        self.model.limit_bars(f64::INFINITY, only_rigid);
        self.soft_steps = first..self.recorder.steps();
        found
    }

    /// Goes back to the start. Returns its unknowns.
    pub(super) fn begin_anew(&mut self) -> Vec<f64> {
        self.model.enter(&self.start).x
    }

    /// Tries another way and takes its ending where it has one that is `better` than the one before; else the model and
    /// the history are again as they were.
    pub(super) fn prefer(
        &mut self,
        before: Ending,
        way: impl FnOnce(&mut Self) -> Option<Ending>,
        better: impl FnOnce(&Ending, &Ending) -> bool,
    ) -> Ending {
        let (model, steps, soft_steps) = (self.model.clone(), self.recorder.steps(), self.soft_steps.clone());
        if let Some(other) = way(self).filter(|other| better(other, &before)) {
            return other;
        }
        self.recorder.forget_after(steps);
        self.soft_steps = soft_steps;
        self.model = model;
        before
    }

    /// Whether anything but the tensions of a restarted state has changed.
    pub(super) fn has_moved(&self) -> bool {
        !self.is_restarted() || self.recorder.history.iter().any(|step| step.fraction > 0.0)
    }
}
