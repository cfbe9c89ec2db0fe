//! One relaxation on its way: the model, what is asked for, where it began, and what has been done so far. The routes work on it.

use super::recorder::Recorder;
use crate::analysis::method::{IntrinsicFailure, Method, RelaxOptions};
use crate::model::Model;
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Problem, Start, Step};
use std::ops::Range;

/// How a relaxation ended so far.
pub(super) type Ending = Result<Equilibrium, NewtonError>;

/// Relative fall of an energy that rounding errors do not explain.
const LOWER: f64 = 1e-10;

/// Whether an energy is lower than another by more than rounding errors.
pub(super) fn is_lower(energy: f64, than: f64) -> bool {
    than - energy > LOWER * than.abs()
}

/// Whether a relaxation failed because the observer asked to stop.
pub(super) fn is_interruption(error: &NewtonError) -> bool {
    error.failure == Failure::Interrupted
}

/// Whether a relaxation ended in an equilibrium of lower energy than before, or was interrupted.
pub(super) fn is_better(other: &Ending, before: &Ending) -> bool {
    match (other, before) {
        (Ok(other), Ok(before)) => is_lower(other.energy, before.energy),
        (Ok(_), Err(_)) => true,
        (Err(error), _) => is_interruption(error),
    }
}

/// The coordinates, the hinges' angles and the energy of a start.
pub(super) struct Origin {
    pub(super) coordinates: Vec<f64>,
    pub(super) angles: Vec<f64>,
    pub(super) energy: f64,
}

/// A relaxation on its way.
pub(super) struct Run<'a> {
    pub(super) model: &'a mut Model,
    pub(super) options: Options,
    pub(super) method: Method,
    /// Where it began.
    pub(super) origin: Origin,
    /// Whether tensions were known there: it is then next to an equilibrium, and stays on its branch.
    pub(super) restarted: bool,
    pub(super) recorder: Recorder<'a>,
    /// Which steps of the history were made with bars that stretch.
    pub(super) soft_steps: Range<usize>,
    /// Why fold angles were given up, if they were tried as unknowns.
    pub(super) intrinsic_failure: Option<IntrinsicFailure>,
}

impl<'a> Run<'a> {
    pub(super) fn new(
        model: &'a mut Model,
        start: &Start,
        options: RelaxOptions,
        observe: &'a mut dyn FnMut(&Step) -> bool,
    ) -> Self {
        let origin =
            Origin { coordinates: model.coordinates(&start.x), angles: model.angles(), energy: model.energy(&start.x) };
        let RelaxOptions { newton: options, method, keep_every } = options;
        let recorder = Recorder::new(observe, keep_every);
        let restarted = start.tension.is_some();
        Self { model, options, method, origin, restarted, recorder, soft_steps: 0..0, intrinsic_failure: None }
    }

    /// Minimises from a start, to the tolerance that was asked for.
    ///
    /// # Errors
    /// [`NewtonError`] as [`minimize`](crate::solver::minimize).
    pub(super) fn minimize(&mut self, start: impl Into<Start>) -> Ending {
        self.recorder.minimize(self.model, start, self.options)
    }

    /// Makes these coordinates the ones from which the relaxation goes on, with angles that continue from those of the start. Returns the
    /// unknowns.
    pub(super) fn begin_anew(&mut self, coordinates: Vec<f64>) -> Vec<f64> {
        self.model.set_angles(&self.origin.angles);
        self.model.start_from(coordinates)
    }

    /// Tries another way and takes its ending where it has one that is `better` than the one before; else the model and the history
    /// are again as they were.
    pub(super) fn prefer(
        &mut self,
        before: Ending,
        way: impl FnOnce(&mut Self) -> Option<Ending>,
        better: impl FnOnce(&Ending, &Ending) -> bool,
    ) -> Ending {
        let (place, steps, soft_steps) = (self.model.place(), self.recorder.steps(), self.soft_steps.clone());
        if let Some(other) = way(self).filter(|other| better(other, &before)) {
            return other;
        }
        self.recorder.forget_after(steps);
        self.soft_steps = soft_steps;
        self.model.go_to(&place);
        before
    }

    /// Whether anything but the tensions of a restarted state has changed.
    pub(super) fn has_moved(&self) -> bool {
        !self.restarted || self.recorder.history().iter().any(|step| step.fraction > 0.0)
    }
}
