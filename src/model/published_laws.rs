//! Laws of published programs.

use super::curve::ForceCurve;
use super::law::Law;
use std::f64::consts::{FRAC_PI_2, PI};

/// A hinge that is a spring between two fold angles and becomes ever stiffer beyond them, so that faces never pass
/// through each other: its torque diverges where it is folded flat. Beyond a limit `m1`, with `s = pi - |m1|`,
///
/// `phi' = m1 - rest + (2 s / pi) tan(pi (|m| - |m1|) / (2 s))`, with the sign of `m1` before the tangent
///
/// (K. Liu and G. H. Paulino, "Nonlinear mechanics of non-rigid origami", Proc. R. Soc. A 473, 20170348 (2017),
/// equation 28).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffening {
    /// The lower limit, between -pi and 0, and the upper one, between 0 and pi, in radians.
    pub limits: [f64; 2],
}

impl Law for Stiffening {
    fn at(&self, angle: f64, rest: f64) -> [f64; 3] {
        let limit = angle.clamp(self.limits[0], self.limits[1]);
        let (off, beyond) = (limit - rest, angle - limit);
        if beyond == 0.0 {
            return [0.5 * off * off, off, 1.0];
        }
        let unit = (PI - limit.abs()) / FRAC_PI_2;
        if !(angle.abs() < PI) {
            return [f64::INFINITY; 3];
        }
        let turned = beyond / unit;
        let energy = 0.5 * off * off + off * beyond - unit * unit * turned.cos().ln();
        [energy, off + unit * turned.tan(), turned.cos().powi(-2)]
    }

    /// The torque beyond a limit, the tangent above, does not depend on the rest angle.
    fn by_rest(&self, angle: f64, rest: f64) -> [f64; 3] {
        [rest - angle, -1.0, 1.0]
    }
}

/// A bar of the force `EA (l^(a - 1) - l^(b - 1)) / (a - b)` at the stretch `l`, its length over its rest length (R. W.
/// Ogden; `a = 5`, `b = 1` in MERLIN, Liu and Paulino 2017).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ogden {
    /// The exponents `a` and `b`, which differ.
    pub exponents: [f64; 2],
}

impl ForceCurve for Ogden {
    // of the strain: of the stretch, which is near 1, small strains of stiff bars would have lost their digits
    fn at(&self, strain: f64) -> [f64; 3] {
        let ([a, b], log) = (self.exponents, strain.ln_1p());
        let power = |a: f64| if a == 0.0 { log } else { (a * log).exp_m1() / a };
        let slope = |a: f64| (a - 1.0) * ((a - 2.0) * log).exp();
        let force = ((a - 1.0) * log).exp_m1() - ((b - 1.0) * log).exp_m1();
        [power(a) - power(b), force, slope(a) - slope(b)].map(|part| part / (a - b))
    }
}

/// A bar of the force `EA l (l^2 - 1) / 2` at the stretch `l`: linear in the strain of Green and Lagrange.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GreenLagrange;

impl ForceCurve for GreenLagrange {
    fn at(&self, strain: f64) -> [f64; 3] {
        let twice = strain * (2.0 + strain); // of Green and Lagrange, from the strain as for `Ogden`
        [0.125 * twice * twice, 0.5 * (1.0 + strain) * twice, 1.0 + 1.5 * twice]
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Bilinear, ElasticPlastic, Formula, Measured, Memory, OfAngle, OfStrain, Power};
    use super::*;

    const ANGLES: [f64; 4] = [-2.9, -1.0, 0.7, 2.4];
    const LENGTHS: [f64; 4] = [0.6, 1.1, 1.5, 2.0];
    const POINTS: [[f64; 2]; 5] = [[-2.0, -3.0], [-0.45, -1.0], [0.0, 0.0], [0.2, 0.5], [0.9, 0.4]];

    /// A law, values of its measure, a rest value, and whether it has the stiffness of a spring there.
    type LawAtValues = (Box<dyn Law>, [f64; 4], f64, bool);

    fn laws() -> Vec<LawAtValues> {
        let bilinear = Bilinear { ratio: 0.2, at: [-0.9, 0.3] };
        let measured = Measured::new(&POINTS).unwrap();
        let yields = ElasticPlastic { at: 0.05, kinematic: 0.2, isotropic: 0.1, memory: Memory::default() };
        let torque = "k*(sinh(2*(m - m0))/2 + 0.1*(m - m0)^3 + 0.3*m0*(m - m0)^2)";
        vec![
            (Box::new(Stiffening { limits: [-2.0, 1.0] }), ANGLES, 0.3, true),
            (Box::new(OfAngle(Power { exponent: 4.0 / 3.0 })), ANGLES, 0.3, false),
            (Box::new(OfAngle(bilinear)), ANGLES, 0.3, true),
            (Box::new(OfAngle(measured.clone())), ANGLES, 0.3, true),
            (Box::new(Formula::of_angle(torque).unwrap()), ANGLES, 0.3, true),
            (Box::new(OfStrain(Ogden { exponents: [5.0, 1.0] })), LENGTHS, 1.2, true),
            (Box::new(OfStrain(Ogden { exponents: [2.0, 0.0] })), LENGTHS, 1.2, true),
            (Box::new(OfStrain(GreenLagrange)), LENGTHS, 1.2, true),
            (Box::new(OfStrain(bilinear)), LENGTHS, 1.2, true),
            (Box::new(OfStrain(measured)), LENGTHS, 1.2, true),
            (Box::new(Formula::of_length("k*m0*ln(m/m0)").unwrap()), LENGTHS, 1.2, true),
            (Box::new(OfAngle(yields)), ANGLES, 0.3, true),
            (Box::new(OfStrain(yields)), LENGTHS, 1.2, true),
        ]
    }

    fn difference(f: impl Fn(f64) -> f64, at: f64) -> f64 {
        let step = |h: f64| (f(at + h) - f(at - h)) / (2.0 * h);
        (4.0 * step(5e-4) - step(1e-3)) / 3.0
    }

    /// Claim: a law is a spring at rest, and its derivatives by value and by rest value are those of its energy.
    /// Source: extrapolated central differences. Tolerance: their rounding errors and truncation, 1e-10 of values up to
    /// 10, 1e-8 at a wall.
    #[test]
    fn derivatives_are_right() {
        for (law, values, rest, is_spring) in laws() {
            let [energy, force, stiffness] = law.at(rest, rest);
            let expected = if is_spring { 1.0 } else { 0.0 };
            assert!(energy == 0.0 && force == 0.0 && (stiffness - expected).abs() < 1e-15, "{law:?} at rest");
            for value in values {
                let ([_, force, stiffness], by_rest) = (law.at(value, rest), law.by_rest(value, rest));
                let found = [force, stiffness, by_rest[0], by_rest[1], by_rest[2]];
                let expected = [
                    difference(|m| law.at(m, rest)[0], value),
                    difference(|m| law.at(m, rest)[1], value),
                    difference(|r| law.at(value, r)[0], rest),
                    difference(|r| law.at(value, r)[1], rest),
                    difference(|r| law.by_rest(value, r)[0], rest),
                ];
                for (found, expected) in found.into_iter().zip(expected) {
                    assert!(
                        (found - expected).abs() <= 1e-9 * (1.0 + expected.abs()),
                        "{law:?} {value}: {found} {expected}"
                    );
                }
            }
        }
    }

    /// Claim: what laws of bars have beyond a spring keeps its digits at small strains: `3 e^2 / 2 + e^3 / 2` of the strain
    /// `e` by Green and Lagrange, `3 e^2 / 2 + e^3 + e^4 / 4` with the exponents 5 and 1. Source: the forces, multiplied out.
    /// Tolerance: rounding errors of the strain, not of 1.
    #[test]
    fn small_strains_keep_their_digits() {
        let strain = 2f64.powi(-20);
        let (green_lagrange, ogden) = (OfStrain(GreenLagrange), OfStrain(Ogden { exponents: [5.0, 1.0] }));
        let square = 1.5 * strain * strain;
        let cases: [(&dyn Law, f64); 2] =
            [(&green_lagrange, 0.5 * strain.powi(3)), (&ogden, strain.powi(3) + 0.25 * strain.powi(4))];
        for (law, cube) in cases {
            let beyond = law.at(1.0 + strain, 1.0)[1] - strain;
            assert!((beyond - square - cube).abs() <= 4.0 * f64::EPSILON * strain, "{law:?}: {beyond:e}");
        }
    }

    /// Claim: a stiffening hinge cannot be folded flat.
    #[test]
    fn walls_are_not_passed() {
        let law = Stiffening { limits: [-2.0, 1.0] };
        assert!(law.at(PI, 0.0)[0] == f64::INFINITY && law.at(-3.5, 0.0)[0] == f64::INFINITY);
    }
}
