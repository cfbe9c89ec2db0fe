//! The soft elements of a model, and its elastic hinges: creases and facets of finite stiffness, whether or not they have a
//! tension as unknown.

use super::Model;
use crate::model::element::{Elements, Spring};

impl Model {
    /// Number of elements of the soft terms.
    pub(super) fn soft_elements(&self) -> usize {
        self.soft.iter().map(|term| term.len()).sum()
    }

    /// Returns by how much each soft element is off its rest value.
    pub(super) fn off_rest(&self, x: &[f64]) -> Vec<f64> {
        let all = self.coordinates(x);
        let elements = self.soft.iter().flat_map(|term| (0..term.len()).map(move |k| (term, k)));
        elements.map(|(term, k)| term.value(k, &self.domain, &all) - term.spring(k).rest).collect()
    }

    /// Returns the numbers of the elastic hinges in the order of [`Model::values`].
    pub(crate) fn elastic_hinges(&self) -> Vec<usize> {
        let elements = self.terms().flat_map(|term| (0..term.len()).map(move |k| is_elastic_hinge(term, k)));
        elements.enumerate().filter(|(_, is_hinge)| *is_hinge).map(|(number, _)| number).collect()
    }

    /// Returns rest angle and stiffness of every elastic hinge.
    pub(crate) fn hinge_springs(&self) -> Vec<Spring> {
        let elements = self.terms().flat_map(|term| (0..term.len()).map(move |k| (term, k)));
        elements.filter(|(term, k)| is_elastic_hinge(*term, *k)).map(|(term, k)| term.spring(k)).collect()
    }

    /// Returns the fold angle of every elastic hinge at the unknowns `x`.
    pub(crate) fn hinge_angles(&self, x: &[f64]) -> Vec<f64> {
        let values = self.values(x);
        self.elastic_hinges().into_iter().map(|number| values[number]).collect()
    }

    /// Multiplies the stiffness of all elastic hinges by a factor.
    pub(crate) fn scale_hinges(&mut self, factor: f64) {
        for term in self.soft.iter_mut().chain(&mut self.stiff) {
            for k in 0..term.len() {
                if is_elastic_hinge(term.as_ref(), k) {
                    let spring = term.spring(k);
                    term.set_spring(k, Spring { stiffness: factor * spring.stiffness, ..spring });
                }
            }
        }
        self.count_measures();
    }
}

fn is_elastic_hinge(term: &dyn Elements, k: usize) -> bool {
    term.is_angle() && term.spring(k).stiffness.is_finite()
}
