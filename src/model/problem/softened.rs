//! A model whose rigid bars have a finite stiffness for a while.

use super::Model;
use crate::model::element::TermKind;

impl Model {
    /// Whether some of the bars are rigid.
    pub(crate) fn has_rigid_bars(&self) -> bool {
        self.rigid_bars().next().is_some()
    }

    /// Gives the rigid bars this stiffness `EA`, a force; infinity makes them rigid again.
    pub(crate) fn soften_rigid_bars(&mut self, stiffness: f64) {
        let lengths: Vec<(usize, f64)> = self.rigid_bars().collect();
        lengths.into_iter().for_each(|(measure, length)| self.compliance[measure] = length / stiffness);
    }

    /// Returns the smallest stiffness of the hinges that are not rigid, torque per radian and length; infinite if there
    /// are none.
    pub(crate) fn softest_hinge(&self) -> f64 {
        let hinges =
            self.terms().filter(|term| term.is_hinge()).flat_map(|term| (0..term.len()).map(move |k| (term, k)));
        let stiffness = hinges.map(|(term, k)| term.spring(k).stiffness / self.length_of(term, k));
        stiffness.filter(|stiffness| stiffness.is_finite()).fold(f64::INFINITY, f64::min)
    }

    /// Returns the number among the stiff measures and the rest length of each bar that is rigid by its own stiffness.
    pub(super) fn rigid_bars(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let measures = self.stiff.iter().flat_map(|term| (0..term.len()).map(move |k| (term, k))).enumerate();
        let rigid =
            measures.filter(|(_, (term, k))| term.kind() == TermKind::Bars && term.spring(*k).stiffness.is_infinite());
        rigid.map(|(measure, (term, k))| (measure, term.spring(k).rest))
    }

    /// Returns the number of soft hinges whose rest angle is not zero, and of those that are folded to the side of it.
    pub(crate) fn hinges_on_rest_side(&self, x: &[f64]) -> [usize; 2] {
        let coordinates = self.coordinates(x);
        let hinges =
            self.soft.iter().filter(|term| term.is_hinge()).flat_map(|term| (0..term.len()).map(move |k| (term, k)));
        let sides = hinges.map(|(term, k)| (term.spring(k).rest, term.value(k, &self.domain, &coordinates)));
        let aimed: Vec<bool> = sides.filter(|(rest, _)| *rest != 0.0).map(|(rest, angle)| rest * angle > 0.0).collect();
        [aimed.len(), aimed.iter().filter(|same| **same).count()]
    }
}
