//! A model that measures the run times of its parts.

use super::seconds;
use foldwell::model::Model;
use foldwell::solver::{HessianKind, Layout, Linearization, Problem};
use std::cell::Cell;
use std::sync::Arc;

/// A model whose calls are timed; times in seconds.
pub struct Timed<'a> {
    model: &'a mut Model,
    pub linearize: Cell<f64>,
    pub energy: Cell<f64>,
    pub gaps: Cell<f64>,
    pub retractions: Cell<usize>,
    pub accept: f64,
}

impl<'a> Timed<'a> {
    /// Makes a timed model with all times zero.
    pub fn new(model: &'a mut Model) -> Self {
        let zero = || Cell::new(0.0);
        Self { model, linearize: zero(), energy: zero(), gaps: zero(), retractions: Cell::new(0), accept: 0.0 }
    }
}

impl Problem for Timed<'_> {
    fn layout(&self) -> &Arc<Layout> {
        self.model.layout()
    }

    fn compliance(&self) -> &[f64] {
        self.model.compliance()
    }

    fn gap_scale(&self) -> &[f64] {
        self.model.gap_scale()
    }

    fn energy(&self, x: &[f64]) -> f64 {
        let mut energy = 0.0;
        let time = seconds(|| energy = self.model.energy(x));
        self.energy.set(self.energy.get() + time);
        energy
    }

    fn gaps(&self, x: &[f64]) -> Vec<f64> {
        let mut gaps = Vec::new();
        let time = seconds(|| gaps = self.model.gaps(x));
        self.gaps.set(self.gaps.get() + time);
        self.retractions.set(self.retractions.get() + 1);
        gaps
    }

    fn linearize(&self, x: &[f64], tension: &[f64], kind: HessianKind, out: &mut Linearization) {
        let time = seconds(|| self.model.linearize(x, tension, kind, out));
        self.linearize.set(self.linearize.get() + time);
    }

    fn accept(&mut self, x: &mut [f64]) {
        self.accept += seconds(|| self.model.accept(x));
    }
}
