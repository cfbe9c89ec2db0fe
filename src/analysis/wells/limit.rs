//! The energy to which a pass tends as its bars become rigid, from its energies at finite stiffness.

use super::pass::Pass;
use crate::model::{Assembly, Gauge};
use crate::sheet::flatten;

/// Factor from the stiffness of the bars of a pass to the next.
pub(super) const STIFFER: f64 = 10.0;

/// Differences of energies, relative, from which their law is read.
const CLEAR: f64 = 1e-8;
/// Largest fold angle, in radians, of a pass in nearly rigid bars that tends to the flat state: with the cube root of
/// one over their stiffness.
const NEARLY_FLAT_RAD: f64 = 1e-2;
/// How many estimated errors of a limit it may be off.
const ERRORS_OF_LIMIT: f64 = 5.0;

/// A pass at one stiffness of the bars.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Height {
    /// Stiffness of the bars.
    pub stiffness: f64,
    /// Energy of the pass.
    pub energy: f64,
}

/// How the energies of a pass tend to their rigid limit: `limit - constant * stiffness^-exponent`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidLimit {
    /// The power of one over the stiffness.
    pub exponent: f64,
    /// The limit.
    pub energy: f64,
    /// Estimate of the limit's error: the difference to that of three energies before it, or, where there are none, to
    /// the last energy.
    pub error: f64,
}

/// The law through the last three energies, at stiffnesses ten times apart, that differ by more than rounding errors;
/// `None` where there are none.
pub fn rigid_limit(heights: &[Height]) -> Option<RigidLimit> {
    let known: Vec<&Height> = heights.iter().filter(|height| height.stiffness.is_finite()).collect();
    let mut laws = known.windows(3).rev().filter_map(law);
    let last = laws.next()?;
    Some(RigidLimit { error: laws.next().map_or(last.error, |before| (last.energy - before.energy).abs()), ..last })
}

fn law(three: &[&Height]) -> Option<RigidLimit> {
    let even = three.windows(2).all(|pair| (pair[1].stiffness / pair[0].stiffness / STIFFER - 1.0).abs() <= 1e-9);
    let [first, second] = [three[1].energy - three[0].energy, three[2].energy - three[1].energy];
    let ratio = second / first;
    let clear = second.abs() > CLEAR * three[2].energy.abs() && 0.0 < ratio && ratio < 1.0;
    let left = second * ratio / (1.0 - ratio);
    let law = RigidLimit { exponent: -ratio.log10(), energy: three[2].energy + left, error: left.abs() };
    (even && clear).then_some(law)
}

/// The energy of the flat state of a sheet without loads, where a pass that is singular in rigid bars tends to it: the
/// sheet can be unfolded, all hinges of the last regular pass are nearly flat, and the energies tend to that energy
/// within a few times the error of their limit.
pub(super) fn flat_energy(assembly: &Assembly, singular: &Pass, heights: &[Height]) -> Option<f64> {
    let flat = singular.rho.iter().all(|angle| angle.abs() <= NEARLY_FLAT_RAD);
    let limit = rigid_limit(heights).filter(|_| flat)?;
    if assembly.terms().is_loaded() || flatten(assembly.sheet()).is_err() {
        return None;
    }
    let energy = assembly.model(Gauge::Held).elastic_hinges().map(|hinge| hinge.response(0.0)[0]).sum::<f64>();
    ((energy - limit.energy).abs() <= ERRORS_OF_LIMIT * limit.error).then_some(energy)
}
