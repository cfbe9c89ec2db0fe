//! A model whose rigid bars have a finite stiffness for a while.

use super::Model;
use crate::math::fold_angle::FLAT_RAD;
use crate::model::element::TermKind;
use crate::model::law::Spring;

impl Model {
    /// Whether some of the bars are rigid.
    pub(crate) fn has_rigid_bars(&self) -> bool {
        self.rigid_bars().next().is_some()
    }

    /// Whether some of the bars have a larger stiffness `EA` than this one, a force.
    pub(crate) fn has_bars_above(&self, stiffness: f64) -> bool {
        self.stiff_of(TermKind::Bars).any(|(_, bar)| bar.spring.stiffness * bar.spring.rest > stiffness)
    }

    /// Gives all bars, or the rigid ones alone, at most this stiffness `EA`, a force; infinity gives them their own again.
    pub(crate) fn limit_bars(&mut self, stiffness: f64, only_rigid: bool) {
        let springs: Vec<_> = self.stiff_of(TermKind::Bars).map(|(measure, bar)| (measure, bar.spring)).collect();
        let limited = |(_, spring): &(usize, Spring)| !only_rigid || spring.stiffness.is_infinite();
        for (measure, Spring { stiffness: own, rest }) in springs.into_iter().filter(limited) {
            self.compliance[measure] = own.recip().max(rest / stiffness);
        }
    }

    /// Returns the number among the stiff measures and the compliance of each bar that stretches.
    pub(crate) fn soft_bars(&self) -> Vec<(usize, f64)> {
        let bars = self.stiff_of(TermKind::Bars).map(|(measure, _)| (measure, self.compliance[measure]));
        bars.filter(|(_, compliance)| *compliance > 0.0).collect()
    }

    /// Returns the smallest stiffness of the hinges that are not rigid, torque per radian and length; infinite if there
    /// are none.
    pub(crate) fn softest_hinge(&self) -> f64 {
        let stiffness = self.elastic_hinges().map(|hinge| hinge.spring.stiffness / self.length_of(&hinge));
        stiffness.fold(f64::INFINITY, f64::min)
    }

    /// Returns the number among the stiff measures and the rest length of each bar that is rigid by its own stiffness.
    pub(crate) fn rigid_bars(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let rigid = self.stiff_of(TermKind::Bars).filter(|(_, bar)| bar.spring.stiffness.is_infinite());
        rigid.map(|(measure, bar)| (measure, bar.spring.rest))
    }

    /// Returns the number of hinges of finite stiffness that are not flat at rest, that of those folded to the side of their
    /// rest angle, and the largest angle off rest of one of them, in radians.
    pub(crate) fn hinges_on_rest_side(&self, x: &[f64]) -> (usize, usize, f64) {
        let coordinates = self.coordinates(x);
        let (mut hinges, mut on_rest_side, mut farthest) = (0, 0, 0.0);
        for hinge in self.elements().filter(|element| element.is_elastic_hinge() && !element.is_beyond_spring()) {
            let (rest, value) = (hinge.spring.rest, hinge.value(&coordinates));
            if rest.abs() > FLAT_RAD {
                hinges += 1;
                on_rest_side += usize::from(rest * value > 0.0);
                farthest = f64::max(farthest, (value - rest).abs());
            }
        }
        (hinges, on_rest_side, farthest)
    }
}
