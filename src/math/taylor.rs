//! Power series in one variable, cut off after the fourth power: how a scalar changes along a path.

use std::ops::{Add, Mul, Sub};

/// Number of coefficients.
pub(crate) const TERMS: usize = 5;

/// The series `c[0] + c[1] a + c[2] a^2 + c[3] a^3 + c[4] a^4` in a parameter `a`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Taylor(pub [f64; TERMS]);

/// A point that moves with the parameter: the series of its three coordinates.
pub(crate) type Path = [Taylor; 3];

impl Add for Taylor {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl Sub for Taylor {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - other.0[k]))
    }
}

impl Mul for Taylor {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| (0..=k).map(|j| self.0[j] * other.0[k - j]).sum()))
    }
}

impl Taylor {
    /// The quotient of two series; the divisor must not start with zero.
    pub(crate) fn over(self, divisor: Self) -> Self {
        let mut quotient = Self::default();
        for k in 0..TERMS {
            let known: f64 = (0..k).map(|j| quotient.0[j] * divisor.0[k - j]).sum();
            quotient.0[k] = (self.0[k] - known) / divisor.0[0];
        }
        quotient
    }

    /// The square root; of a series that starts positive.
    pub(crate) fn sqrt(self) -> Self {
        let mut root = Self::default();
        root.0[0] = self.0[0].sqrt();
        for k in 1..TERMS {
            let known: f64 = (1..k).map(|j| root.0[j] * root.0[k - j]).sum();
            root.0[k] = (self.0[k] - known) / (2.0 * root.0[0]);
        }
        root
    }

    /// `atan2(self, x)`, integrated from its derivative `(x y' - y x') / (x^2 + y^2)`.
    pub(crate) fn atan2(self, x: Self) -> Self {
        let rate = (x * self.derivative() - self * x.derivative()).over(x * x + self * self);
        let mut angle = Self::default();
        angle.0[0] = self.0[0].atan2(x.0[0]);
        for k in 1..TERMS {
            angle.0[k] = rate.0[k - 1] / k as f64;
        }
        angle
    }

    /// The derivative; its last coefficient is not known and left zero.
    fn derivative(self) -> Self {
        Self(std::array::from_fn(|k| if k + 1 < TERMS { (k + 1) as f64 * self.0[k + 1] } else { 0.0 }))
    }
}

/// Difference of two points.
pub(crate) fn difference(a: &Path, b: &Path) -> Path {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

/// Scalar product.
pub(crate) fn dot(a: &Path, b: &Path) -> Taylor {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub fn cross(a: &Path, b: &Path) -> Path {
    std::array::from_fn(|axis| {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        a[next] * b[last] - a[last] * b[next]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: root and angle have the textbook series of `sqrt(1 + a)` and `atan(a)`, and `atan2` knows the quadrant.
    /// Tolerance: rounding.
    #[test]
    fn textbook_series() {
        let near = |found: Taylor, expected: [f64; TERMS]| {
            found.0.iter().zip(expected).for_each(|(f, e)| assert!((f - e).abs() <= 1e-15, "{found:?} {expected:?}"));
        };
        let (one, a) = (Taylor([1.0, 0.0, 0.0, 0.0, 0.0]), Taylor([0.0, 1.0, 0.0, 0.0, 0.0]));
        near((one + a).sqrt(), [1.0, 0.5, -0.125, 0.0625, -0.0390625]);
        near(a.atan2(one), [0.0, 1.0, 0.0, -1.0 / 3.0, 0.0]);
        let behind = (a - a).atan2(a - one);
        assert_eq!(behind.0[0], std::f64::consts::PI);
    }
}
