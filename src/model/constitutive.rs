//! Constitutive response: energy, force and stiffness of an element at a value of its measure, from its law and memory.

use super::element::Element;
use super::law::{Law, Memory, Spring, Stored};
use crate::math::quadrature::by_rule;

/// Distance from rest at which the stiffness on both sides is asked for: a strain, or an angle in radians.
const BESIDE_REST: f64 = 1e-6;
/// Distance from rest, over the rest value, below which force and energy of a law less those of its spring are
/// integrals of the difference of their stiffnesses: the difference of two forces loses that many digits there, and of
/// two energies twice as many.
const NEAR_REST: f64 = 1e-5;

impl Element<'_> {
    /// Its law with its memory, if that has one.
    fn remembering(&self) -> Option<Box<dyn Law>> {
        match self.stored() {
            Stored::Spring | Stored::Value => None,
            Stored::Law(law) | Stored::BeyondSpring(law) => law.remembering(self.memory),
        }
    }

    /// Whether its law has a memory.
    pub(crate) fn remembers(&self) -> bool {
        self.remembering().is_some()
    }

    /// Returns energy, force (its derivative by the value) and stiffness (the second one) at a value. The energy is
    /// what it stores and has dissipated.
    pub fn response(&self, value: f64) -> [f64; 3] {
        let Spring { stiffness, rest } = self.spring;
        let off = value - rest;
        match self.stored() {
            Stored::Spring => {
                let force = stiffness * off;
                [0.5 * force * off, force, stiffness]
            }
            Stored::Value => [stiffness * value, stiffness, 0.0],
            Stored::BeyondSpring(law)
                if off.abs() <= NEAR_REST * rest.abs() && !law.has_kinks() && !self.remembers() =>
            {
                beyond_near_rest(law.as_ref(), off, self.spring)
            }
            Stored::Law(_) | Stored::BeyondSpring(_) => {
                self.scaled([0.5 * off * off, off, 1.0], |law| law.at(value, rest))
            }
        }
    }

    /// Returns the derivatives of energy and force by the rest value, and the second one of the energy.
    pub(crate) fn by_rest(&self, value: f64) -> [f64; 3] {
        let rest = self.spring.rest;
        self.scaled([rest - value, -1.0, 1.0], |law| law.by_rest(value, rest))
    }

    /// Returns the stiffness times what its law says, where a spring says `linear`.
    fn scaled(&self, linear: [f64; 3], ask: impl Fn(&dyn Law) -> [f64; 3]) -> [f64; 3] {
        let known = |law: &dyn Law| self.remembering().map_or_else(|| ask(law), |own| ask(&*own));
        let unit = match self.stored() {
            Stored::Spring => linear,
            Stored::Law(law) => known(&**law),
            Stored::BeyondSpring(law) => {
                let whole = known(&**law);
                [0, 1, 2].map(|k| whole[k] - linear[k])
            }
            Stored::Value => [0.0; 3],
        };
        unit.map(|part| self.spring.stiffness * part)
    }

    /// Returns its memory after a value, and what it has dissipated up to there.
    pub(crate) fn after(&self, value: f64) -> (Memory, f64) {
        let Some(law) = self.remembering() else { return (self.memory, 0.0) };
        let (after, dissipated) = law.after(value, self.spring.rest);
        (after, self.spring.stiffness * dissipated)
    }

    /// Whether it has no force at its rest value, and the stiffness of its spring there and on both sides.
    pub(crate) fn is_spring_at_rest(&self) -> bool {
        let Spring { stiffness: of_spring, rest } = self.spring;
        let at = |value: f64| Self { memory: Memory::default(), ..*self }.response(value);
        let expected = if self.is_beyond_spring() { 0.0 } else { of_spring };
        let is_off = |value: f64, known: f64| (at(value)[2] - expected).abs() > known * of_spring;
        let beside = BESIDE_REST * if self.is_angle() { 1.0 } else { rest };
        !self.has_law()
            || (at(rest)[1].abs() <= 1e-9 * of_spring * rest.abs()
                && !is_off(rest, 1e-9)
                && ![rest - beside, rest + beside].into_iter().any(|value| is_off(value, 1e-3)))
    }

    /// Whether its stiffness jumps at some values.
    pub(crate) fn has_kinks(&self) -> bool {
        matches!(self.stored(), Stored::Law(law) | Stored::BeyondSpring(law) if law.has_kinks())
    }
}

/// Returns energy, force and stiffness of a law less those of its spring, at a value so near rest that the difference
/// is lost in the rounding errors of both: `phi'` is the integral of `phi'' - 1` from rest, and `phi` that of `phi'`.
fn beyond_near_rest(law: &dyn Law, off: f64, Spring { stiffness, rest }: Spring) -> [f64; 3] {
    let second = |part: f64| law.at(rest + part * off, rest)[2] - 1.0;
    let weighted = |part: f64| {
        let here = second(part);
        [(1.0 - part) * here, here]
    };
    // no more than one rule: what is left of its error is rounding
    let [energy, force] = by_rule(weighted, [0.0, 1.0]);
    [off * off * energy, off * force, second(1.0)].map(|unit| stiffness * unit)
}
