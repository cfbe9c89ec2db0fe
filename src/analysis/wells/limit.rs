//! The energy to which a pass tends as its bars become rigid, from its energies at finite stiffness.

/// Factor from the stiffness of the bars of a pass to the next.
pub(super) const STIFFER: f64 = 10.0;

/// Differences of energies, relative, from which their law is read.
const CLEAR: f64 = 1e-8;

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
