//! The elastic hinges of a model: creases and facets of finite stiffness, whether or not they have a tension as
//! unknown.

use super::Model;
use crate::model::element::Element;

impl Model {
    /// Returns by how much each soft element is off its rest value.
    pub(crate) fn off_rest(&self, x: &[f64]) -> Vec<f64> {
        self.of_soft(x, |element, value| value - element.spring.rest)
    }

    /// Returns what a function says of each soft element and its value.
    pub(super) fn of_soft<'m, T>(&'m self, x: &[f64], of: impl Fn(&Element<'m>, f64) -> T) -> Vec<T> {
        let all = self.coordinates(x);
        self.soft().map(|element| of(&element, element.value(&all))).collect()
    }

    /// Returns the elastic hinges.
    pub(crate) fn elastic_hinges(&self) -> impl Iterator<Item = Element<'_>> {
        self.elements().filter(Element::is_elastic_hinge)
    }

    /// Returns the fold angle of every elastic hinge at the unknowns `x`.
    pub(crate) fn hinge_angles(&self, x: &[f64]) -> Vec<f64> {
        let all = self.coordinates(x);
        self.elastic_hinges().map(|hinge| hinge.value(&all)).collect()
    }

    /// Multiplies the stiffness of all elastic hinges by a factor.
    pub(crate) fn scale_hinges(&mut self, factor: f64) {
        let hinges: Vec<usize> = self.elastic_hinges().map(|hinge| hinge.number).collect();
        hinges.into_iter().for_each(|number| self.springs[number].stiffness *= factor);
        self.count_measures();
    }
}
