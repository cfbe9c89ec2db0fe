//! The elastic hinges of a model: creases and facets of finite stiffness, whether or not they have a tension as
//! unknown.

use super::Model;
use crate::model::element::Element;

impl Model {
    /// Returns by how much each soft element is off its rest value.
    pub(crate) fn off_rest(&self, x: &[f64]) -> Vec<f64> {
        let all = self.coordinates(x);
        self.soft().map(|element| element.value(&all) - element.spring.rest).collect()
    }

    /// Returns energy, force and stiffness of each soft element.
    pub(super) fn soft_responses(&self, x: &[f64]) -> Vec<[f64; 3]> {
        let all = self.coordinates(x);
        self.soft().map(|element| element.response(element.value(&all))).collect()
    }

    /// Returns for each soft element the derivatives of energy and force by its rest value, and the second one of the
    /// energy.
    pub(super) fn soft_by_rest(&self, x: &[f64]) -> Vec<[f64; 3]> {
        let all = self.coordinates(x);
        self.soft().map(|element| element.by_rest(element.value(&all))).collect()
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
