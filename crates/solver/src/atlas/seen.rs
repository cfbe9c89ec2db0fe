//! How one chart is seen from another.

use super::surface::Chart;
use foldwell_numerics::vector::dot;

/// Largest distance of neighbours relative to the sum of their radii.
pub(super) const MOST_DISTANCE_PER_RADII: f64 = 1.1;
/// Largest part of the way between neighbours that is across the tangent plane.
const MOST_PART_ACROSS: f64 = 0.5;
/// Least determinant of the frames of neighbours.
const LEAST_FRAME_DETERMINANT: f64 = 0.5;

/// A chart seen from another.
pub(super) struct Neighbour {
    /// Place in the other's tangent plane, at the distance of both.
    pub at: [f64; 2],
    pub radius: f64,
}

/// The shortest way from `a` to `b`, modulo periods.
pub(super) fn separate(a: &[f64], b: &[f64], periods: &[Option<f64>], way: &mut [f64]) {
    for (unknown, way) in way.iter_mut().enumerate() {
        let away = b[unknown] - a[unknown];
        *way = match periods[unknown] {
            Some(period) if away.abs() > 0.5 * period => away - period * (away / period).round(),
            _ => away,
        };
    }
}

/// The chart `b` seen from `a` if they are neighbours, and the determinant of their frames.
pub(super) fn see(a: &Chart, b: &Chart, periods: &[Option<f64>], way: &mut [f64]) -> Option<(Neighbour, f64)> {
    let n = a.x.len();
    separate(&a.x, &b.x, periods, way);
    let square = dot(way, way);
    let reach = MOST_DISTANCE_PER_RADII * (a.radius + b.radius);
    if !(square > 0.0 && square < reach * reach) {
        return None;
    }
    let at = [dot(&a.frame[..n], way), dot(&a.frame[n..], way)];
    let flat = at[0] * at[0] + at[1] * at[1];
    let determinant = determinant(&overlap(&a.frame, &b.frame));
    if square - flat > MOST_PART_ACROSS * MOST_PART_ACROSS * square || determinant.abs() < LEAST_FRAME_DETERMINANT {
        return None;
    }
    let stretch = (square / flat).sqrt();
    Some((Neighbour { at: at.map(|x| x * stretch), radius: b.radius }, determinant))
}

/// Products of the tangents of two frames.
fn overlap(a: &[f64], b: &[f64]) -> [[f64; 2]; 2] {
    let n = a.len() / 2;
    [&a[..n], &a[n..]].map(|s| [dot(s, &b[..n]), dot(s, &b[n..])])
}

fn determinant(m: &[[f64; 2]; 2]) -> f64 {
    m[0][0] * m[1][1] - m[0][1] * m[1][0]
}

/// The larger of the two angles between planes: the arc cosine of the smaller singular value of the products.
pub(super) fn turn(a: &[f64], b: &[f64]) -> f64 {
    let m = overlap(a, b);
    let size: f64 = m.iter().flatten().map(|x| x * x).sum();
    let product = determinant(&m).abs();
    // Singular values p >= q: p q = product, (p - q)^2 = size - 2 product.
    let difference = (size - 2.0 * product).max(0.0).sqrt();
    let smaller = 0.5 * ((size + 2.0 * product).sqrt() - difference);
    smaller.min(1.0).acos()
}
