//! Measures that drives prescribe: the supports of displacements, and the volumes that faces under pressure enclose.

use super::Model;
use super::effect::Effect;
use crate::model::element::{Elements, TermKind};
use crate::model::enclosed::Enclosed;
use crate::model::law::{Memory, Spring};
use crate::model::problem::Support;
use crate::model::terms::RIGID;
use std::ops::Range;
use std::sync::Arc;

impl Model {
    /// Adds supports of these linear functions, at their values in the reference state, and chooses the unknowns anew.
    pub(super) fn support_moved(&mut self, functions: Vec<Vec<(usize, f64)>>, is_angle: bool) -> Effect {
        let (first, given) = (self.compliance.len(), self.supports.len());
        for terms in functions {
            let support = Support { terms, rest: 0.0, is_angle };
            let rest = support.value(&self.base);
            self.supports.push(Support { rest, ..support });
        }
        self.count_measures();
        self.choose_unknowns();
        Effect::Prescribed((first..).zip(self.supports[given..].iter().map(|support| support.rest)).collect())
    }

    /// Returns the faces under the pressure of this name, and their numbers, which are soft elements; `None` if there
    /// are none.
    pub(super) fn pressure_of(&self, name: &str) -> Option<(Range<usize>, &Arc<dyn Elements>)> {
        let soft = &self.equations.soft;
        let is_wanted = |term: &Arc<dyn Elements>| term.head().kind == TermKind::Pressure && term.head().name == name;
        let number = soft.iter().position(is_wanted)?;
        let first: usize = soft[..number].iter().map(|term| term.len()).sum();
        Some((first..first + soft[number].len(), &soft[number]))
    }

    /// Keeps the volume that the faces under the pressure of this name enclose, instead of the pressure. Returns the
    /// number of that volume among the stiff measures and its value, and the drawn area of the faces, by which it is
    /// divided.
    pub(super) fn hold_volume(&mut self, name: &str) -> Option<((usize, f64), f64)> {
        let (faces, term) = self.pressure_of(name)?;
        let volume = Enclosed::new(term.clone(), &self.equations.drawn);
        let (area, rest) = (volume.area, volume.value(0, self.domain(), &self.base[..self.points()]));
        let measure = self.compliance.len() - self.supports.len();
        Arc::make_mut(&mut self.equations).stiff.push(Arc::new(volume));
        self.springs[faces].iter_mut().for_each(|face| face.stiffness = 0.0);
        self.springs.push(Spring { stiffness: RIGID, rest });
        self.last.push(f64::NAN);
        if self.remembers() {
            self.memory.push(Memory::default());
        }
        self.count_measures();
        self.choose_unknowns();
        Some(((measure, rest), area))
    }

    /// Sets the prescribed value of a stiff measure: the rest value of an element, or that of a support.
    pub(super) fn prescribe(&mut self, measure: usize, rest: f64) {
        let number = self.soft_elements() + measure;
        match number.checked_sub(self.springs.len()) {
            None => self.springs[number].rest = rest,
            Some(support) => self.supports[support].rest = rest,
        }
    }
}
