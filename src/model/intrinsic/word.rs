//! Products of rotations and translations along a loop over the faces, with first and second derivatives.
//!
//! A frame stands on a face, with x along an edge and z along the normal. It goes over the faces by rotations about x
//! (the fold angle of an edge), rotations about z (the sector of a face between two edges) and translations along x (an
//! edge). Round a closed loop the product `g` of these motions is the identity.
//!
//! If factor `p` of the product changes at the rate 1, the product changes as `dg = [w, v] g` with the angular velocity
//! `w` and the velocity `v` of the origin: for a rotation its axis `w`, which goes through the point `c`, and `v = -w x
//! c`; for a translation `w = 0` and its direction `v`. For two factors, `p` before `q`, of a product that is the
//! identity, the second derivative of the rotation vector is `(w_p x w_q) / 2` and that of the position `w_p x v_q`.

use crate::math::{Vec3, in_lower_triangle, rotation};
use crate::numerics::sparse::FIXED;
use crate::solver::constrained::Block;
use nalgebra::Matrix3;

/// A number of an edge that is fixed, or a variable: its place among those of the sheet, or of a loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum EdgeValue {
    Variable(u32),
    Fixed(f64),
}

/// One motion of the frame.
#[derive(Clone, Copy, Debug)]
pub(super) enum FrameMotion {
    /// Rotation about x by a fold angle times `sign`.
    Fold { angle: EdgeValue, sign: f64 },
    /// Rotation about z by `sign` times the angle of a triangle between its sides `lengths[0]` and `lengths[1]`,
    /// opposite to `lengths[2]`.
    Sector { lengths: [EdgeValue; 3], sign: f64 },
    /// Rotation about z by a fixed angle.
    Turn { sine: f64, cosine: f64 },
    /// Translation along x.
    Shift { length: EdgeValue },
}

/// What has to come of a product of motions. Positions are divided by a unit of length.
#[derive(Clone, Copy, Debug)]
pub(super) enum Ends {
    /// The identity, for rotations about one point: three rows.
    Round,
    /// The identity: six rows.
    Rim { unit: f64 },
    /// A position at this distance: one row.
    Bridge { length: EdgeValue, unit: f64 },
}

/// A product of motions and what has to come of it.
#[derive(Clone, Debug)]
pub(super) struct Word {
    pub(super) factors: Vec<FrameMotion>,
    pub(super) ends: Ends,
}

/// A factor that varies: how the product changes with it, and how it changes with its variables.
struct Rate {
    angular: Vec3,
    linear: Vec3,
    places: [u32; 3],
    gradient: [f64; 3],
    /// Second derivatives by the three variables.
    hessian: Option<Matrix3<f64>>,
}

impl EdgeValue {
    /// Returns the number, of these variables.
    pub(super) fn get(&self, z: &[f64]) -> f64 {
        match *self {
            Self::Variable(variable) => z[variable as usize],
            Self::Fixed(value) => value,
        }
    }

    /// Returns the place of the variable, or [`FIXED`].
    fn place(&self) -> u32 {
        if let Self::Variable(variable) = *self { variable } else { FIXED }
    }
}

impl Word {
    /// Returns the number of rows.
    pub(super) fn rows(&self) -> usize {
        match self.ends {
            Ends::Round => 3,
            Ends::Rim { .. } => 6,
            Ends::Bridge { .. } => 1,
        }
    }

    /// Puts what is wrong with the product into `out`, with derivatives by the variables `z` of the word: its rotation
    /// vector and its position, or the distance of its position minus a length. The Hessian is that of a product as it
    /// has to be.
    pub(super) fn linearize(&self, z: &[f64], multipliers: Option<&[f64]>, out: &mut Block) {
        let (mut rates, mut frame, mut place) =
            (Vec::with_capacity(self.factors.len()), Matrix3::identity(), Vec3::zeros());
        for factor in &self.factors {
            let axes = [frame.column(0).into_owned(), frame.column(2).into_owned()];
            rates.extend(factor.rate(z, axes, &place, multipliers.is_some()));
            factor.apply(z, &mut frame, &mut place);
        }
        // velocities of the end instead of the origin
        rates.iter_mut().for_each(|rate| rate.linear += rate.angular.cross(&place));
        out.values.clear();
        out.jacobian.clear();
        out.jacobian.resize(self.rows() * z.len(), 0.0);
        out.hessian.clear();
        out.hessian.resize(multipliers.map_or(0, |_| z.len() * (z.len() + 1) / 2), 0.0);
        match self.ends {
            Ends::Round => self.close(&rates, &frame, None, out),
            Ends::Rim { unit } => self.close(&rates, &frame, Some((place, unit)), out),
            Ends::Bridge { length, unit } => self.bridge(&rates, &place, (length, unit), z, out),
        }
        let Some(multipliers) = multipliers else { return };
        match self.ends {
            Ends::Round => add_hessian(&rates, &vector(multipliers), &Vec3::zeros(), &mut out.hessian),
            Ends::Rim { unit } => {
                add_hessian(&rates, &vector(multipliers), &(vector(&multipliers[3..]) / unit), &mut out.hessian);
            }
            Ends::Bridge { unit, .. } => {
                let (distance, force) = (place.norm(), multipliers[0] / unit);
                add_hessian(&rates, &Vec3::zeros(), &(place * (force / distance)), &mut out.hessian);
                add_bending(&rates, &place, force, &mut out.hessian);
            }
        }
    }

    /// Puts the rotation vector of the product and its position into `out`.
    fn close(&self, rates: &[Rate], frame: &Matrix3<f64>, place: Option<(Vec3, f64)>, out: &mut Block) {
        let defect = rotation::log(frame);
        let chart = rotation::inverse_left_jacobian(&defect);
        out.values.extend(defect.iter());
        out.values.extend(place.iter().flat_map(|(place, unit)| <[f64; 3]>::from(place / *unit)));
        let rows = self.rows();
        for rate in rates {
            let turned = chart * rate.angular;
            let moved = place.map(|(_, unit)| rate.linear / unit);
            for (variable, factor) in rate.variables() {
                let column = &mut out.jacobian[rows * variable..];
                let entries = turned.iter().chain(moved.iter().flatten());
                column.iter_mut().zip(entries).for_each(|(out, entry)| *out += factor * entry);
            }
        }
    }

    /// Puts the distance of the product's position minus a length into `out`.
    fn bridge(&self, rates: &[Rate], place: &Vec3, (length, unit): (EdgeValue, f64), z: &[f64], out: &mut Block) {
        out.values.push((place.norm() - length.get(z)) / unit);
        let towards = place.normalize();
        for rate in rates {
            for (variable, factor) in rate.variables() {
                out.jacobian[variable] += factor * towards.dot(&rate.linear) / unit;
            }
        }
        if let EdgeValue::Variable(variable) = length {
            out.jacobian[variable as usize] -= 1.0 / unit;
        }
    }
}

impl Rate {
    /// The variables on which the factor depends, and its derivatives by them.
    fn variables(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let pairs = self.places.iter().zip(&self.gradient).filter(|(place, _)| **place != FIXED);
        pairs.map(|(&place, &factor)| (place as usize, factor))
    }
}

fn vector(numbers: &[f64]) -> Vec3 {
    Vec3::from_column_slice(&numbers[..3])
}

/// Adds `turning . R'' + moving . p''` to a lower triangle, for the rotation vector `R` of a product near the identity
/// and its position `p`.
fn add_hessian(rates: &[Rate], turning: &Vec3, moving: &Vec3, out: &mut [f64]) {
    for (q, second) in rates.iter().enumerate() {
        for (p, first) in rates[..=q].iter().enumerate() {
            let curl = 0.5 * first.angular.cross(&second.angular);
            let amount = turning.dot(&curl) + moving.dot(&first.angular.cross(&second.linear));
            add_product(first, second, p == q, amount, out);
        }
        if let Some(hessian) = &second.hessian {
            let force = turning.dot(&second.angular) + moving.dot(&second.linear);
            for i in 0..3 {
                for j in (0..=i).filter(|&j| second.places[i] != FIXED && second.places[j] != FIXED) {
                    let place = in_lower_triangle(second.places[i] as usize, second.places[j] as usize);
                    out[place] += force * hessian[(i, j)];
                }
            }
        }
    }
}

/// Adds `force` times what a change of direction makes of a distance: `(dp . dp - (u . dp)^2) / |p|` with `u = p /
/// |p|`.
fn add_bending(rates: &[Rate], place: &Vec3, force: f64, out: &mut [f64]) {
    let (distance, towards) = (place.norm(), place.normalize());
    for (q, second) in rates.iter().enumerate() {
        for (p, first) in rates[..=q].iter().enumerate() {
            let [a, b] = [first, second].map(|rate| rate.linear - towards * towards.dot(&rate.linear));
            add_product(first, second, p == q, force * a.dot(&b) / distance, out);
        }
    }
}

/// Adds a second derivative by two factors as second derivatives by their variables.
fn add_product(first: &Rate, second: &Rate, same: bool, amount: f64, out: &mut [f64]) {
    for (i, a) in first.variables() {
        for (j, b) in second.variables() {
            // two different factors come in both orders, one factor has both orders of its own variables in these loops
            let times = match (same, i == j) {
                (false, true) => 2.0,
                (true, false) => 0.5,
                _ => 1.0,
            };
            out[in_lower_triangle(i, j)] += times * amount * a * b;
        }
    }
}

impl FrameMotion {
    /// Returns how the product changes with this factor, if it varies. `axes` are x and z of the frame before it.
    fn rate(&self, z: &[f64], [x, up]: [Vec3; 2], place: &Vec3, want_hessian: bool) -> Option<Rate> {
        let about = |axis: Vec3| (axis, place.cross(&axis));
        let of_one = |(angular, linear): (Vec3, Vec3), variable: u32, rate: f64| Rate {
            angular,
            linear,
            places: [variable, FIXED, FIXED],
            gradient: [rate, 0.0, 0.0],
            hessian: None,
        };
        match self {
            Self::Fold { angle: EdgeValue::Variable(angle), sign } => Some(of_one(about(x), *angle, *sign)),
            Self::Sector { lengths, sign } => {
                let (angular, linear) = about(up);
                let corner = TriangleAngle::new(lengths.map(|length| length.get(z)));
                let gradient = corner.gradient();
                let hessian = want_hessian.then(|| *sign * corner.hessian(&gradient));
                let places = lengths.map(|length| length.place());
                Some(Rate { angular, linear, places, gradient: gradient.map(|g| sign * g), hessian })
            }
            Self::Shift { length: EdgeValue::Variable(length) } => Some(of_one((Vec3::zeros(), x), *length, 1.0)),
            _ => None,
        }
    }

    /// Moves the frame by this factor.
    fn apply(&self, z: &[f64], frame: &mut Matrix3<f64>, place: &mut Vec3) {
        match self {
            Self::Fold { angle, sign } => turn(frame, [1, 2], (sign * angle.get(z)).sin_cos()),
            Self::Sector { lengths, sign } => {
                let corner = TriangleAngle::new(lengths.map(|length| length.get(z)));
                turn(frame, [0, 1], (sign * corner.sine, corner.cosine));
            }
            Self::Turn { sine, cosine } => turn(frame, [0, 1], (*sine, *cosine)),
            Self::Shift { length } => *place += frame.column(0) * length.get(z),
        }
    }
}

/// Turns two axes of a frame in their plane, from the first to the second.
fn turn(frame: &mut Matrix3<f64>, [a, b]: [usize; 2], (sine, cosine): (f64, f64)) {
    let [first, second] = [a, b].map(|k| frame.column(k).into_owned());
    frame.set_column(a, &(cosine * first + sine * second));
    frame.set_column(b, &(cosine * second - sine * first));
}

/// The angle of a triangle between sides of lengths `a` and `b`, opposite to `c`.
pub(super) struct TriangleAngle {
    sides: [f64; 3],
    pub(super) sine: f64,
    pub(super) cosine: f64,
}

impl TriangleAngle {
    /// Sine and cosine; not numbers if no triangle has these sides.
    pub(super) fn new(sides: [f64; 3]) -> Self {
        let [a, b, c] = sides;
        let mut sorted = sides;
        sorted.sort_by(|a, b| b.total_cmp(a));
        let [l, m, s] = sorted;
        // four times the area, without cancellation (W. Kahan, "Miscalculating area and angles of a needle-like
        // triangle", 2014)
        let area = ((l + (m + s)) * (s - (l - m)) * (s + (l - m)) * (l + (m - s))).sqrt();
        Self { sides, sine: area / (2.0 * a * b), cosine: ((a - c) * (a + c) + b * b) / (2.0 * a * b) }
    }

    /// Derivatives of the angle by the three sides.
    fn gradient(&self) -> [f64; 3] {
        let ([a, b, c], area) = (self.sides, self.double_area());
        [-(a - b * self.cosine) / area, -(b - a * self.cosine) / area, c / area]
    }

    /// Second derivatives of the angle by the three sides.
    fn hessian(&self, g: &[f64; 3]) -> Matrix3<f64> {
        let ([a, b, _], area) = (self.sides, self.double_area());
        let (sine, cosine) = (self.sine, self.cosine);
        let numerators = [
            [-1.0 - b * sine * g[0], cosine - b * sine * g[1], -b * sine * g[2]],
            [cosine - a * sine * g[0], -1.0 - a * sine * g[1], -a * sine * g[2]],
            [0.0, 0.0, 1.0],
        ];
        let areas = [b * sine + a * b * cosine * g[0], a * sine + a * b * cosine * g[1], a * b * cosine * g[2]];
        Matrix3::from_fn(|i, j| (numerators[i][j] - g[i] * areas[j]) / area)
    }

    fn double_area(&self) -> f64 {
        self.sides[0] * self.sides[1] * self.sine
    }
}
