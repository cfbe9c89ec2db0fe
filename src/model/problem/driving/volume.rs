//! Pressures by their names, and the volumes that their faces enclose.

use super::Model;
use crate::model::element::{Elements, TermKind};
use crate::model::enclosed::Enclosed;
use crate::model::law::{Memory, Spring};
use crate::model::terms::RIGID;
use std::ops::Range;
use std::sync::Arc;

impl Model {
    /// Returns the numbers of the faces under the pressure of this name, which are soft elements; `None` if there are
    /// none.
    pub(super) fn pressure_of(&self, name: &str) -> Option<Range<usize>> {
        let (first, term) = self.pressure_term(name)?;
        Some(first..first + term.len())
    }

    fn pressure_term(&self, name: &str) -> Option<(usize, &Arc<dyn Elements>)> {
        let soft = &self.equations.soft;
        let is_wanted = |term: &Arc<dyn Elements>| term.head().kind == TermKind::Pressure && term.head().name == name;
        let number = soft.iter().position(is_wanted)?;
        Some((soft[..number].iter().map(|term| term.len()).sum(), &soft[number]))
    }

    /// Keeps the volume that the faces under the pressure of this name enclose, instead of the pressure. Returns the
    /// number of that volume among the stiff measures, and the drawn area of the faces, by which it is divided.
    pub(super) fn hold_volume(&mut self, name: &str) -> Option<(usize, f64)> {
        let (first, term) = self.pressure_term(name)?;
        let faces = first..first + term.len();
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
        Some((measure, area))
    }
}
