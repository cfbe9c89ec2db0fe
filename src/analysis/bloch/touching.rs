//! Lines along which the determinant touches zero without a change of sign, as a square does: no grid shows them by its
//! signs, and they are not followed.
//!
//! Where the magnitude of the determinant is least among the points of a grid, its least value along the gradient is
//! sought. If that is zero and the determinant has one sign on both sides, the point is on such a line, unless the second
//! derivatives say that it is a single point.

use super::extrema::is_least;
use super::laurent::wavenumber;
use super::zone::Zone;
use std::f64::consts::TAU;

/// Distance from `q = 0` up to which no line is sought: all determinants vanish there.
const NEAR_ORIGIN: f64 = 0.5;
/// Number of steps that shorten an interval, each to two thirds, until rounding errors are left.
const THIRDS: usize = 80;
/// Distance at which both sides of a line are looked at, in meshes of the grid.
const BESIDE: f64 = 0.1;
/// Smaller over larger second derivative above which a zero is a single point.
const SINGLE: f64 = 1e-4;
/// Multiple of the uncertainty of the determinant up to which it is zero.
const CERTAIN: f64 = 10.0;

/// Returns the wavenumbers of a point on such a line, in radians, found from an `n x n` grid; `None` if none is found.
pub(super) fn touched(zone: &Zone, n: usize) -> Option<[f64; 2]> {
    let at = |k: usize| [wavenumber(k % n, n), wavenumber(k / n, n)];
    let magnitudes: Vec<f64> = (0..n * n).map(|k| zone.at(at(k)).0.abs()).collect();
    let least = (0..n * n).filter(|&k| is_least(n, &magnitudes, k)).map(at);
    least.filter(|q| q[0].hypot(q[1]) > NEAR_ORIGIN).find_map(|start| touched_next_to(zone, start, TAU / n as f64))
}

/// Returns the point of such a line along the gradient at a point of a grid of this mesh; `None` if there is none.
fn touched_next_to(zone: &Zone, start: [f64; 2], mesh: f64) -> Option<[f64; 2]> {
    let gradient = zone.at(start).1;
    let length = gradient[0].hypot(gradient[1]);
    let along = if length > 0.0 { gradient.map(|slope| slope / length) } else { [1.0, 0.0] };
    let place = |way: f64| [0, 1].map(|axis| start[axis] + way * along[axis]);
    let way = least_between([-mesh, mesh], |way| zone.at(place(way)).0.abs());
    let [before, after] = [way - BESIDE * mesh, way + BESIDE * mesh].map(|way| zone.at(place(way)).0);
    let q = place(way);
    let is_zero = zone.at(q).0.abs() <= CERTAIN * zone.uncertainty(q);
    (is_zero && before * after > 0.0 && !is_single(zone, q)).then_some(q)
}

/// Whether the determinant grows from a zero in all directions, by its second derivatives.
fn is_single(zone: &Zone, q: [f64; 2]) -> bool {
    let [xx, yy, xy] = zone.curvature(q);
    let (mean, half) = (0.5 * (xx + yy).abs(), (0.5 * (xx - yy)).hypot(xy));
    mean - half > SINGLE * (mean + half)
}

/// Returns where a function with one minimum between two numbers is least.
fn least_between([mut low, mut high]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..THIRDS {
        let third = (high - low) / 3.0;
        if value(low + third) < value(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    0.5 * (low + high)
}
