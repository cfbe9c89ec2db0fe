//! What elements remember of how a state was reached.

use super::Model;
use crate::model::element::Element;
use crate::model::law::Memory;

impl Model {
    /// Returns the memories after a state, given its unknowns, of all elements that have one, soft ones first.
    pub(crate) fn memory_after(&self, x: &[f64]) -> Vec<Memory> {
        if !self.remembers() {
            return vec![];
        }
        let all = self.coordinates(x);
        let elements = self.elements().filter(Element::remembers);
        elements.map(|element| element.after(element.value(&all)).0).collect()
    }

    /// Sets the memories of all elements that have one, in the same order; zero where there are too few.
    pub(in crate::model) fn set_memory(&mut self, memory: &[Memory]) {
        if self.remembers() {
            let numbers = self.elements().filter(Element::remembers).map(|element| element.number);
            let numbers: Vec<usize> = numbers.collect();
            let given = memory.iter().copied().chain(std::iter::repeat(Memory::default()));
            numbers.into_iter().zip(given).for_each(|(number, memory)| self.memory[number] = memory);
        }
    }

    /// Whether any element has a memory.
    pub(crate) fn remembers(&self) -> bool {
        !self.memory.is_empty()
    }
}
