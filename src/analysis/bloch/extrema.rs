//! Extrema of the determinant of which a grid does not see the sign.
//!
//! A closed line of zeros encloses an extremum of the determinant, of the sign that the outside does not have. A line
//! smaller than the mesh of a grid leaves all signs on the grid as they are, but its extremum is still there: where the
//! norm of the gradient on the grid is smallest among its neighbours, Newton's method leads to the nearest point
//! without a gradient. It is hidden when it is an extremum and its sign is not that of the four points of the grid
//! around it.

use super::laurent::wavenumber;
use super::zone::{Zone, reduced};
use std::f64::consts::{PI, TAU};

/// Newton steps at most.
const STEPS: usize = 20;
/// The last step of Newton's method.
const LAST_STEP: f64 = 1e-12;
/// Longest way from the point of the grid, in meshes.
const FARTHEST: f64 = 2.0;
/// Extrema nearer to each other than this are one.
const SAME_EXTREMUM_DISTANCE: f64 = 1e-8;

/// An extremum of the other sign than its boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hidden {
    /// Its wavenumbers.
    pub extremum: [f64; 2],
    /// Whether the determinant is positive there.
    pub positive: bool,
    /// The nearest point of the grid, where it has the other sign.
    pub outside: [f64; 2],
}

/// The extrema that a grid of `n x n` wavenumbers, half a mesh away from `q = 0`, hides, from the signs of the
/// determinant and the norm of its gradient on it, `q2` by `q1`.
pub(crate) fn hidden(zone: &Zone, n: usize, positive: &[bool], steepness: &[f64]) -> Vec<Hidden> {
    let mut found: Vec<Hidden> = Vec::new();
    for k in (0..n * n).filter(|&k| is_least(n, steepness, k)) {
        let start = [wavenumber(k % n, n), wavenumber(k / n, n)];
        let Some(extremum) = extremum(zone, start, FARTHEST * TAU / n as f64) else { continue };
        let value = zone.at(extremum).0;
        // at q = 0 itself, and where the determinant touches zero, there is no sign
        if !(value.abs() > zone.uncertainty(extremum)) {
            continue;
        }
        let corners = corners(n, extremum);
        let apart = |other: &Hidden| [0, 1].map(|a| reduced(other.extremum[a] - extremum[a]).abs());
        let known = found.iter().map(apart).any(|[x, y]| x.max(y) <= SAME_EXTREMUM_DISTANCE);
        if !known && corners.iter().all(|&[i, j]| positive[j * n + i] != (value > 0.0)) {
            let outside = corners.map(|[i, j]| {
                let at = [wavenumber(i, n), wavenumber(j, n)];
                [0, 1].map(|a| extremum[a] + reduced(at[a] - extremum[a]))
            });
            let away = |q: &[f64; 2]| (q[0] - extremum[0]).hypot(q[1] - extremum[1]);
            let nearest = outside.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)));
            found.extend(nearest.map(|outside| Hidden { extremum, positive: value > 0.0, outside }));
        }
    }
    found
}

/// Whether no neighbour of a point of the grid has a smaller value.
pub(super) fn is_least(n: usize, values: &[f64], k: usize) -> bool {
    let (i, j) = (k % n, k / n);
    let around = |by: usize| (0..3).map(move |step| (by + n + step - 1) % n);
    around(j).all(|j| around(i).all(|i| values[k] <= values[j * n + i]))
}

/// The points of the grid at the corners of the mesh in which a point is.
fn corners(n: usize, q: [f64; 2]) -> [[usize; 2]; 4] {
    let place = |q: f64| ((q + PI) / TAU * n as f64 - 0.5).floor().rem_euclid(n as f64) as usize % n;
    let [i, j] = q.map(place);
    [[i, j], [(i + 1) % n, j], [i, (j + 1) % n], [(i + 1) % n, (j + 1) % n]]
}

/// The extremum to which Newton's method leads; `None` where it is a saddle, or too far away.
fn extremum(zone: &Zone, start: [f64; 2], farthest: f64) -> Option<[f64; 2]> {
    let mut q = start;
    for _ in 0..STEPS {
        let ([x, y], [xx, yy, xy]) = (zone.at(q).1, zone.curvature(q));
        let determinant = xx * yy - xy * xy;
        let step = [(xy * y - yy * x) / determinant, (xy * x - xx * y) / determinant];
        q = [0, 1].map(|a| q[a] + step[a]);
        if !((q[0] - start[0]).hypot(q[1] - start[1]) <= farthest) {
            return None;
        }
        if step[0].hypot(step[1]) <= LAST_STEP {
            return (determinant > 0.0).then_some(q);
        }
    }
    None
}
