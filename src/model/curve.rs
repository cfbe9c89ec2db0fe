//! Laws of what an element is off its rest value: a hinge of an angle, a bar of a strain.

use super::law::{Law, Memory};
use std::fmt;

/// The energy of a hinge by the angle, or of a bar by the strain, that it is off rest; both in units of the spring
/// constant at rest.
pub trait ForceCurve: fmt::Debug + Send + Sync {
    /// Returns the energy and its first two derivatives, that is torque and stiffness. The energy is 0 at 0.
    fn at(&self, off: f64) -> [f64; 3];

    /// Whether its stiffness jumps; see [`Law::has_kinks`].
    fn has_kinks(&self) -> bool {
        false
    }

    /// Returns the curve of an element with this memory; see [`Law::remembering`].
    fn remembering(&self, _memory: Memory) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }

    /// Returns the memory of an element that has gone to a value, and what it has dissipated; see [`Law::after`].
    fn after(&self, _off: f64) -> (Memory, f64) {
        (Memory::default(), 0.0)
    }
}

/// The law of a hinge whose torque follows a curve: `phi = f(m - rest)`, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfAngle<C>(pub C);

impl<C: ForceCurve + 'static> Law for OfAngle<C> {
    fn at(&self, angle: f64, rest: f64) -> [f64; 3] {
        self.0.at(angle - rest)
    }

    fn has_kinks(&self) -> bool {
        self.0.has_kinks()
    }

    fn remembering(&self, memory: Memory) -> Option<Box<dyn Law>> {
        Some(Box::new(OfAngle(self.0.remembering(memory)?)))
    }

    fn after(&self, angle: f64, rest: f64) -> (Memory, f64) {
        self.0.after(angle - rest)
    }
}

/// The law of a bar whose force follows a curve: `phi = rest^2 f(m / rest - 1)`, lengths by strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfStrain<C>(pub C);

impl<C: ForceCurve + 'static> Law for OfStrain<C> {
    fn at(&self, length: f64, rest: f64) -> [f64; 3] {
        let [f, first, second] = self.0.at((length - rest) / rest);
        [rest * rest * f, rest * first, second]
    }

    fn has_kinks(&self) -> bool {
        self.0.has_kinks()
    }

    fn remembering(&self, memory: Memory) -> Option<Box<dyn Law>> {
        Some(Box::new(OfStrain(self.0.remembering(memory)?)))
    }

    fn after(&self, length: f64, rest: f64) -> (Memory, f64) {
        let (memory, dissipated) = self.0.after((length - rest) / rest);
        (memory, rest * rest * dissipated)
    }

    fn by_rest(&self, length: f64, rest: f64) -> [f64; 3] {
        let ([f, first, second], stretch) = (self.0.at((length - rest) / rest), length / rest);
        let twice = 2.0 * f - 2.0 * stretch * first + stretch * stretch * second;
        [2.0 * rest * f - length * first, first - stretch * second, twice]
    }
}

/// The torque `k |d|^p` with the sign of `d`, the angle off rest in radians; `p = 4/3` is the bending of thin facets
/// (K. Liu and G. H. Paulino, "Highly efficient nonlinear structural analysis of origami assemblages using the MERLIN2
/// software", Origami 7, 1167 (2018)). For `p > 1` there is no stiffness at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power {
    /// The exponent `p`, at least 1.
    pub exponent: f64,
}

impl ForceCurve for Power {
    fn at(&self, off: f64) -> [f64; 3] {
        let (p, size) = (self.exponent, off.abs());
        let torque = size.powf(p);
        [torque * size / (p + 1.0), torque.copysign(off), p * size.powf(p - 1.0)]
    }

    /// Next to rest the stiffnesses of two elements may have any ratio, so that no step from there looks smooth.
    fn has_kinks(&self) -> bool {
        self.exponent > 1.0
    }
}

/// A spring of two stiffnesses: `k` up to two values off rest, `ratio k` beyond them. A bar that buckles has the values
/// `[-s, inf]`, a cable, which cannot be pushed, `[0, inf]` and the ratio 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bilinear {
    /// The stiffness beyond the values over that between them, at least 0.
    pub ratio: f64,
    /// The lower value, at most 0, and the upper one, at least 0: angles in radians or strains off rest; may be
    /// infinite.
    pub at: [f64; 2],
}

impl ForceCurve for Bilinear {
    fn at(&self, off: f64) -> [f64; 3] {
        let limit = off.clamp(self.at[0], self.at[1]);
        let (beyond, inside) = (off - limit, 0.5 * limit * limit);
        let stiffness = if beyond == 0.0 { 1.0 } else { self.ratio };
        [inside + limit * beyond + 0.5 * self.ratio * beyond * beyond, limit + self.ratio * beyond, stiffness]
    }

    fn has_kinks(&self) -> bool {
        true
    }
}

/// The reason for which points are no curve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum CurveError {
    #[error("a curve has at least three points, one of them 0, 0")]
    TooFew,
    #[error("point {at} has a number that is not finite")]
    NotFinite {
        /// The point, counted from 0.
        at: usize,
    },
    #[error("point {at} is at {value:?}, which does not lie beyond {before:?} of the point before")]
    NotAscending {
        /// The point, counted from 0.
        at: usize,
        value: f64,
        before: f64,
    },
    #[error("no point is 0, 0: the element has no force at rest, from which angles and strains are counted")]
    NoRest,
    #[error("the curve does not rise at 0, 0: its slope there is the stiffness at rest")]
    NotStable,
}

impl CurveError {
    /// The point that is wrong, counted from 0; `None` if it is all of them.
    pub fn point(&self) -> Option<usize> {
        match *self {
            Self::NotFinite { at } | Self::NotAscending { at, .. } => Some(at),
            Self::TooFew | Self::NoRest | Self::NotStable => None,
        }
    }
}

/// A curve through measured points: monotone cubics between neighbours (F. N. Fritsch and R. E. Carlson, SIAM J. Numer.
/// Anal. 17, 238 (1980), with the slopes of F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5, 300 (1984)),
/// which rise and fall only where the points do, and straight beyond the first and the last point.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Angle or strain off rest, force, slope and energy at every point, outwards from rest; the last three over the
    /// slope at rest. Above rest, and below it with the signs of angle and force changed: so the energy of a state near
    /// rest is no difference of large numbers.
    sides: [Vec<[f64; 4]>; 2],
    slope: f64,
}

impl Measured {
    /// Takes points `[angle or strain off rest, torque or force]` in ascending order; one of them is `[0, 0]`.
    ///
    /// # Errors
    /// [`CurveError`] if this is not so, or the curve does not rise there.
    pub fn new(points: &[[f64; 2]]) -> Result<Self, CurveError> {
        if points.len() < 3 {
            return Err(CurveError::TooFew);
        }
        if let Some(at) = points.iter().position(|point| !point.iter().all(|number| number.is_finite())) {
            return Err(CurveError::NotFinite { at });
        }
        if let Some(at) = (1..points.len()).find(|&k| points[k][0] <= points[k - 1][0]) {
            let (value, before) = (points[at][0], points[at - 1][0]);
            return Err(CurveError::NotAscending { at, value, before });
        }
        let rest = points.iter().position(|point| *point == [0.0, 0.0]).ok_or(CurveError::NoRest)?;
        let slopes = monotone_slopes(points);
        let slope = slopes[rest];
        if slope <= 0.0 {
            return Err(CurveError::NotStable);
        }
        let knots = points.iter().zip(&slopes).map(|(point, unit)| [point[0], point[1] / slope, unit / slope]);
        let knots: Vec<[f64; 3]> = knots.collect();
        let below: Vec<[f64; 3]> =
            knots[..=rest].iter().rev().map(|&[off, force, slope]| [-off, -force, slope]).collect();
        Ok(Self { sides: [with_energies(&knots[rest..]), with_energies(&below)], slope })
    }

    /// The slope at rest in the units of the points: the stiffness of a hinge, the EA of a bar.
    pub fn slope(&self) -> f64 {
        self.slope
    }
}

impl ForceCurve for Measured {
    fn at(&self, off: f64) -> [f64; 3] {
        let (knots, size) = (&self.sides[usize::from(off < 0.0)], off.abs());
        let after = knots.partition_point(|knot| knot[0] <= size);
        let from = &knots[after - 1];
        let [energy, force, slope] = match knots.get(after) {
            Some(next) => piece(from, next, size),
            None => straight(from, size),
        };
        [from[3] + energy, if off < 0.0 { -force } else { force }, slope]
    }
}

/// The straight line beyond the last knot: the energy from it, force and slope.
fn straight(&[from, force, slope, _]: &[f64; 4], at: f64) -> [f64; 3] {
    let beyond = at - from;
    [beyond * (force + 0.5 * slope * beyond), force + slope * beyond, slope]
}

/// Gives every point the energy of the curve from the first one to it.
fn with_energies(points: &[[f64; 3]]) -> Vec<[f64; 4]> {
    let mut energy = 0.0;
    let mut knots: Vec<[f64; 4]> = Vec::with_capacity(points.len());
    for &[off, force, slope] in points {
        if let Some(before) = knots.last() {
            energy += piece(before, &[off, force, slope, 0.0], off)[0];
        }
        knots.push([off, force, slope, energy]);
    }
    knots
}

/// The cubic between two knots: the energy from the left one, force and slope.
fn piece(left: &[f64; 4], right: &[f64; 4], at: f64) -> [f64; 3] {
    let width = right[0] - left[0];
    let secant = (right[1] - left[1]) / width;
    let square = (3.0 * secant - 2.0 * left[2] - right[2]) / width;
    let cube = (left[2] + right[2] - 2.0 * secant) / (width * width);
    let t = at - left[0];
    [
        t * (left[1] + t * (left[2] / 2.0 + t * (square / 3.0 + t * cube / 4.0))),
        left[1] + t * (left[2] + t * (square + t * cube)),
        left[2] + t * (2.0 * square + 3.0 * t * cube),
    ]
}

/// Slopes at the points with which cubics rise and fall only where the points do: weighted harmonic means of the slopes
/// on both sides, 0 at an extremum; at the ends those of the straight line to the neighbour.
fn monotone_slopes(points: &[[f64; 2]]) -> Vec<f64> {
    let widths: Vec<f64> = points.windows(2).map(|two| two[1][0] - two[0][0]).collect();
    let secants: Vec<f64> =
        points.windows(2).zip(&widths).map(|(two, width)| (two[1][1] - two[0][1]) / width).collect();
    let inner = |k: usize| {
        let ([before, after], [left, right]) = ([secants[k - 1], secants[k]], [widths[k - 1], widths[k]]);
        if before * after <= 0.0 {
            return 0.0;
        }
        3.0 * (left + right) / ((2.0 * right + left) / before + (right + 2.0 * left) / after)
    };
    let inner = (1..secants.len()).map(inner);
    secants.first().copied().into_iter().chain(inner).chain(secants.last().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: a curve goes through its points, rises where they rise, and is straight beyond them, with the slope that
    /// a spring of the same points has if they lie on a line. Tolerance: rounding errors.
    #[test]
    fn measured_points_lie_on_the_curve() {
        let points = [[-1.0, -3.0], [-0.2, -1.0], [0.0, 0.0], [0.1, 0.4], [0.5, 0.4], [1.2, 5.0]];
        let curve = Measured::new(&points).unwrap();
        for [off, force] in points {
            assert!((curve.slope() * curve.at(off)[1] - force).abs() < 1e-14, "{off}");
        }
        let stiffness = (-200..=200).map(|k| curve.at(0.01 * f64::from(k))[2]);
        assert!(stiffness.clone().all(|slope| slope >= -1e-14) && stiffness.fold(0.0, f64::max) > 1.0);
        let line = Measured::new(&[[-1.0, -2.0], [0.0, 0.0], [3.0, 6.0]]).unwrap();
        for off in [-4.0, -0.3, 0.0, 1.7, 5.0] {
            let [energy, force, slope] = line.at(off);
            assert!((energy - 0.5 * off * off).abs() < 1e-14 && (force - off).abs() < 1e-14 && slope == 1.0, "{off}");
        }
        assert_eq!(line.slope(), 2.0);
    }

    /// Claim: next to rest the energy has the digits of a spring's, on both sides, where a curve has long pieces.
    /// Tolerance: what the curve's third derivative makes of the energy, of the order of the strain.
    #[test]
    fn energies_next_to_rest_keep_their_digits() {
        let curve = Measured::new(&[[-0.1, -2.0], [0.0, 0.0], [0.1, 1.0]]).unwrap();
        for off in [-1e-6, -1e-10, 1e-10, 1e-6] {
            assert!((curve.at(off)[0] / (0.5 * off * off) - 1.0).abs() < 20.0 * off.abs(), "{off}");
        }
    }

    /// Claim: points that are no curve are refused with the point.
    #[test]
    fn points_that_are_no_curve_are_refused() {
        let cases: [(&[[f64; 2]], &str); 5] = [
            (&[[0.0, 0.0], [1.0, 1.0]], "at least three"),
            (&[[0.0, 0.0], [1.0, f64::NAN], [2.0, 1.0]], "point 1 has a number"),
            (&[[0.0, 0.0], [1.0, 1.0], [1.0, 2.0]], "point 2 is at 1.0"),
            (&[[-1.0, 0.0], [0.5, 1.0], [1.0, 2.0]], "no point is 0, 0"),
            (&[[-1.0, 1.0], [0.0, 0.0], [1.0, -1.0]], "does not rise"),
        ];
        for (points, message) in cases {
            let found = Measured::new(points).unwrap_err().to_string();
            assert!(found.contains(message), "{points:?}: {found}");
        }
    }
}
