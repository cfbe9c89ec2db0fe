//! Plasticity: elements that yield, and remember it.

use super::curve::ForceCurve;
use super::law::Memory;

/// The force of a bar by its strain off rest `e`, or of a hinge by its angle, that yields: it is `e - z` with the plastic
/// strain `z`, up to a bound that follows the strain (kinematic hardening) and grows (isotropic hardening).
///
/// In a step the element takes the `z` of least `(e - z)^2 / 2 + a z^2 / 2 + y |z - z0| + b (|z - z0| + s0)^2 / 2`, where
/// `z0` is its plastic strain before, `s0` the sum of all its changes, `a` and `b` the hardenings and `y` the strain at
/// which it first yields: return mapping by the energy (J. C. Simo and T. J. R. Hughes, "Computational inelasticity",
/// 1998, 1.4 and 1.6). The first two terms are stored, `y s + b s^2 / 2` is dissipated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticPlastic {
    /// The strain, or the angle in radians, off rest at which it first yields: the yield force over the stiffness; positive.
    pub at: f64,
    /// Stiffness of the kinematic hardening over that of the element: force by plastic strain; at least 0.
    pub kinematic: f64,
    /// Stiffness of the isotropic hardening over that of the element; at least 0.
    pub isotropic: f64,
    /// Its plastic strain, and the sum of all changes of it; zero at first.
    pub memory: Memory,
}

/// Excess over the bound, relative to the bound, that is rounding error: a state on the bound unloads.
const ROUNDING: f64 = 1e-13;

impl ElasticPlastic {
    /// Returns the memory after a value off rest, and whether it has changed.
    fn mapped(&self, off: f64) -> (Memory, bool) {
        let Self { at, kinematic, isotropic, memory: Memory { kept, gone } } = *self;
        let trial = off - kept - kinematic * kept;
        let bound = at + isotropic * gone;
        let excess = trial.abs() - bound;
        if !(excess > ROUNDING * bound) {
            return (self.memory, false);
        }
        let change = excess / (1.0 + kinematic + isotropic);
        (Memory { kept: kept + change.copysign(trial), gone: gone + change }, true)
    }

    /// Returns what an element with this memory has dissipated.
    fn dissipated(&self, Memory { gone, .. }: Memory) -> f64 {
        self.at * gone + 0.5 * self.isotropic * gone * gone
    }
}

impl ForceCurve for ElasticPlastic {
    fn at(&self, off: f64) -> [f64; 3] {
        let (memory, yields) = self.mapped(off);
        let (force, hardening) = (off - memory.kept, self.kinematic + self.isotropic);
        let stored = 0.5 * (force * force + self.kinematic * memory.kept * memory.kept);
        let stiffness = if yields { hardening / (1.0 + hardening) } else { 1.0 };
        [stored + self.dissipated(memory), force, stiffness]
    }

    fn remembering(&self, memory: Memory) -> Option<Self> {
        Some(Self { memory, ..*self })
    }

    fn after(&self, off: f64) -> (Memory, f64) {
        let (memory, _) = self.mapped(off);
        (memory, self.dissipated(memory))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Law, OfStrain};
    use super::*;

    /// Claim: with a memory too, the derivatives by value and by rest value are those of the energy, and the energy is the
    /// same before and after the memory is brought up to the value. Source: central differences. Tolerance: 1e-8, their
    /// truncation and rounding errors; 1e-15, rounding.
    #[test]
    fn derivatives_with_a_memory_are_right() {
        let memory = Memory { kept: 0.03, gone: 0.08 };
        let law = OfStrain(ElasticPlastic { at: 0.05, kinematic: 0.2, isotropic: 0.1, memory });
        for (length, rest) in [(1.0, 1.2), (1.22, 1.2), (1.3, 1.2), (1.5, 1.1)] {
            let slope = |f: &dyn Fn(f64) -> f64, at: f64| (f(at + 1e-5) - f(at - 1e-5)) / 2e-5;
            let ([energy, force, stiffness], by_rest) = (law.at(length, rest), law.by_rest(length, rest));
            let pairs = [
                (force, slope(&|m| law.at(m, rest)[0], length)),
                (stiffness, slope(&|m| law.at(m, rest)[1], length)),
                (by_rest[0], slope(&|r| law.at(length, r)[0], rest)),
                (by_rest[1], slope(&|r| law.at(length, r)[1], rest)),
                (by_rest[2], slope(&|r| law.by_rest(length, r)[0], rest)),
            ];
            for (found, expected) in pairs {
                assert!((found - expected).abs() < 1e-8, "{length}: {found} {expected}");
            }
            let after = law.remembering(law.after(length, rest).0).unwrap();
            assert!((after.at(length, rest)[0] - energy).abs() < 1e-15, "{length}");
        }
    }
}
