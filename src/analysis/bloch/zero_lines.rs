//! Lines of zero modes: the curves in the Brillouin zone on which a real determinant is zero.
//!
//! Curves are followed with the positive side on their left, by steps along the tangent and corrections along the
//! gradient. They begin on the rays at which the form at `q = 0` vanishes, wherever else the signs of the determinant
//! on a grid differ between neighbours, and round the extrema that the grid's signs hide (see
//! [`extrema`](super::extrema)). At the end every edge of the grid must be crossed by curves an odd number of times
//! where its ends differ in sign, and an even number of times where they do not: that is how one knows that no line is
//! missing.
//!
//! Where the determinant is so flat that its rounding moves a point by more than 1e-12, the point is corrected on the
//! rigidity matrix itself (see [`singular`](super::singular)).

mod line;
mod region;

use super::extrema::hidden;
use super::laurent::wavenumber;
use super::singular::SingularSearch;
use super::touching::touched;
use super::zone::{Zone, reduced};
use super::{BlochError, Rigidity};
use crate::numerics::larger;
pub use line::ZeroLine;
use line::{Arc, GRID, joined, length, line, next};
pub use region::Region;
use region::regions;
use std::f64::consts::{PI, TAU};

/// Distance from `q = 0` at which the curves through it begin and end.
const START: f64 = 1e-4;
/// Corrections end when they are as small as this.
const CORRECTED: f64 = 1e-14;
/// Relative size of corrections that may be rounding, where they do not become smaller.
const STALLED: f64 = 1e-9;
const CORRECTIONS: usize = 8;
/// Largest turn of the tangent in a step, in radians.
const LARGEST_TURN: f64 = 0.15;
/// Longest step near `q = 0`, in distances from it.
const LONGEST_NEAR: f64 = 0.2;
/// Steps shorter than this are a failure.
const SHORTEST: f64 = 1e-10;
const MOST_STEPS: usize = 200_000;
/// Attempts, each with steps a quarter as long.
const ATTEMPTS: usize = 3;
/// A point that lies off a chord by more than this part of its length is on no curve that has it.
const BULGE: f64 = 0.05;
/// Points that the polynomial knows worse than this are corrected on the matrix.
const EXACT: f64 = 1e-12;
/// Longest correction on the matrix, over the distance from `q = 0` and over the length of the next chord.
const LONGEST_CORRECTION: f64 = 0.01;

/// All lines and what they enclose.
#[derive(Clone, Debug, PartialEq)]
pub struct ZeroLines {
    /// The lines, those through `q = 0` first, taken straight through it.
    pub lines: Vec<ZeroLine>,
    /// The regions, the largest first.
    pub regions: Vec<Region>,
    /// Edges of the grid that were compared with the crossings of the lines.
    pub compared: usize,
}

impl ZeroLines {
    /// Follows all lines.
    ///
    /// # Errors
    /// [`BlochError::ZeroLines`] where the lines contradict the signs of the determinant, and [`BlochError::Touched`] where
    /// there is one without a change of sign.
    pub fn new(zone: &Zone) -> Result<Self, BlochError> {
        if let Some(q) = touched(zone, GRID) {
            return Err(BlochError::Touched { q });
        }
        let mut longest = 0.6 * TAU / GRID as f64;
        let mut last = Err(BlochError::ZeroLines { edges: 0 });
        for _ in 0..ATTEMPTS {
            last = Tracer::new(zone, longest).and_then(Tracer::all);
            if last.is_ok() {
                break;
            }
            longest /= 4.0;
        }
        last
    }

    /// The lines with their points corrected on the matrix of which the zone has the determinant, where the polynomial
    /// knows them worse than to 1e-12; the error of a point is that of the better of the two.
    pub fn refined(mut self, zone: &Zone, rigidity: &Rigidity) -> Self {
        let mut search = SingularSearch::new(rigidity);
        for line in &mut self.lines {
            line.residual = 0.0;
            let last = line.points.len() - 1;
            for k in 0..last {
                let q = line.points[k];
                if line.passes > 0 && norm(q.map(reduced)) < 0.5 * START {
                    continue; // exactly q = 0
                }
                let next = line.points[k + 1];
                let near = norm(q.map(reduced)).min(norm([0, 1].map(|a| next[a] - q[a])));
                let (there, error) = corrected_on_matrix(zone, &mut search, q, LONGEST_CORRECTION * near);
                (line.points[k], line.residual) = (there, larger(line.residual, error));
            }
            line.points[last] = [0, 1].map(|a| line.points[0][a] + TAU * f64::from(line.winding[a]));
            line.length = length(&line.points);
        }
        self
    }
}

/// Where a piece ends.
enum ArcEnd<'a> {
    /// Where it began, with this tangent.
    Start([f64; 2]),
    /// At `q = 0`, on one of these rays.
    Origin(&'a mut Vec<bool>),
}

struct Tracer<'a> {
    zone: &'a Zone,
    longest: f64,
    /// Angles of the rays at `q = 0`.
    rays: Vec<f64>,
    /// Whether the determinant is positive at the grid points, `q2` by `q1`.
    positive: Vec<bool>,
    /// Norm of the gradient there.
    steepness: Vec<f64>,
    /// Crossings of the edges to the next point in `q1` and in `q2`.
    crossings: [Vec<u32>; 2],
}

impl<'a> Tracer<'a> {
    fn new(zone: &'a Zone, longest: f64) -> Result<Self, BlochError> {
        let lines = zone.directions()?;
        let rays = lines.iter().flat_map(|&angle| [angle, angle + PI]).collect();
        let at = |k: usize| [wavenumber(k % GRID, GRID), wavenumber(k / GRID, GRID)];
        let of = |(value, gradient)| (value > 0.0, norm(gradient));
        let (positive, steepness) = (0..GRID * GRID).map(|k| of(zone.at(at(k)))).unzip();
        let crossings = [vec![0; GRID * GRID], vec![0; GRID * GRID]];
        Ok(Self { zone, longest, rays, positive, steepness, crossings })
    }

    fn all(mut self) -> Result<ZeroLines, BlochError> {
        let mut lines = self.through_origin()?;
        for a in 0..2 {
            for k in 0..GRID * GRID {
                if self.changes(a, k) && self.crossings[a][k] == 0 {
                    let low = [wavenumber(k % GRID, GRID), wavenumber(k / GRID, GRID)];
                    let mut high = low;
                    high[a] += TAU / GRID as f64;
                    let start = self.zero_between([low, high], self.positive[k]);
                    lines.push(self.closed_line(start, self.longest)?);
                }
            }
        }
        for hidden in hidden(self.zone, GRID, &self.positive, &self.steepness) {
            let start = self.zero_between([hidden.extremum, hidden.outside], hidden.positive);
            if !lines.iter().any(|line| contains(line, start)) {
                let radius = norm([0, 1].map(|a| start[a] - hidden.extremum[a]));
                lines.push(self.closed_line(start, self.longest.min(0.3 * radius))?);
            }
        }
        let edges = (0..2).flat_map(|a| (0..GRID * GRID).map(move |k| (a, k)));
        let missed = edges.filter(|&(a, k)| (self.crossings[a][k] % 2 == 1) != self.changes(a, k));
        match missed.count() {
            0 => Ok(ZeroLines { lines, regions: regions(&self.positive), compared: 2 * GRID * GRID }),
            edges => Err(BlochError::ZeroLines { edges }),
        }
    }

    /// Whether the signs at the ends of an edge of the grid differ.
    fn changes(&self, a: usize, k: usize) -> bool {
        self.positive[k] != self.positive[next(a, k)]
    }

    /// The zero between a point where the determinant has this sign and one where it has the other, by bisection.
    fn zero_between(&self, [mut inside, mut outside]: [[f64; 2]; 2], positive: bool) -> [f64; 2] {
        for _ in 0..60 {
            let middle = [0, 1].map(|a| 0.5 * (inside[a] + outside[a]));
            let end = if (self.zone.at(middle).0 > 0.0) == positive { &mut inside } else { &mut outside };
            *end = middle;
        }
        inside
    }

    /// The pieces between rays at `q = 0`, joined straight through it.
    fn through_origin(&mut self) -> Result<Vec<ZeroLine>, BlochError> {
        let mut used = vec![false; self.rays.len()];
        let mut arcs: Vec<([usize; 2], Arc)> = Vec::new();
        for ray in 0..self.rays.len() {
            let (sine, cosine) = self.rays[ray].sin_cos();
            let (start, _) = self.corrected([START * cosine, START * sine])?;
            let tangent = tangent(self.zone.at(start).1);
            if used[ray] || tangent[0] * cosine + tangent[1] * sine <= 0.0 {
                continue;
            }
            used[ray] = true;
            let arc = self.follow(start, self.longest, ArcEnd::Origin(&mut used))?;
            self.count(&arc.points);
            let last = arc.points[arc.points.len() - 1].map(reduced);
            arcs.push(([ray, self.nearest_ray(last)], arc));
        }
        if used.iter().any(|used| !used) || arcs.len() * 2 != self.rays.len() {
            return Err(BlochError::ZeroLines { edges: 0 });
        }
        Ok(joined(arcs))
    }

    fn nearest_ray(&self, q: [f64; 2]) -> usize {
        let angle = q[1].atan2(q[0]);
        let away = |ray: &usize| reduced(self.rays[*ray] - angle).abs();
        (0..self.rays.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0)
    }

    /// A closed curve through a point near it, with a first step of some length.
    fn closed_line(&mut self, start: [f64; 2], first: f64) -> Result<ZeroLine, BlochError> {
        let (start, _) = self.corrected(start)?;
        // not on the edge of the grid itself, where rounding would decide whether it is crossed
        let start = self.step(start, 0.3 * first).map_or(start, |(off, _)| off);
        let along = tangent(self.zone.at(start).1);
        let arc = self.follow(start, first, ArcEnd::Start(along))?;
        self.count(&arc.points);
        Ok(line(arc.points, 0, arc.residual))
    }

    /// Follows a line from a point on it to its end.
    fn follow(&self, start: [f64; 2], first: f64, mut end: ArcEnd<'_>) -> Result<Arc, BlochError> {
        let mut arc = Arc { points: vec![start], residual: 0.0 };
        let (mut here, mut step) = (start, first);
        for _ in 0..MOST_STEPS {
            let from_origin = if self.rays.is_empty() { f64::INFINITY } else { norm(here.map(reduced)) };
            step = step.min(self.longest).min(LONGEST_NEAR * from_origin);
            let Some((there, residual)) = self.step(here, step) else {
                step *= 0.5;
                if step < SHORTEST {
                    return Err(BlochError::ZeroLines { edges: 0 });
                }
                continue;
            };
            if let ArcEnd::Start(along) = end
                && arc.points.len() > 2
                && passes(start, along, here, there, step)
            {
                let turns = [0, 1].map(|a| ((there[a] - start[a]) / TAU).round());
                arc.points.push([0, 1].map(|a| start[a] + TAU * turns[a]));
                return Ok(arc);
            }
            arc.points.push(there);
            arc.residual = arc.residual.max(residual);
            (here, step) = (there, 1.3 * step);
            if let ArcEnd::Origin(used) = &mut end
                && arrives(here, self.zone)
            {
                used[self.nearest_ray(here.map(reduced))] = true;
                return Ok(arc);
            }
        }
        Err(BlochError::ZeroLines { edges: 0 })
    }

    /// One step, and the size of its last correction; `None` where it is too long.
    fn step(&self, from: [f64; 2], length: f64) -> Option<([f64; 2], f64)> {
        let along = tangent(self.zone.at(from).1);
        let predicted = [0, 1].map(|a| from[a] + length * along[a]);
        let (there, residual) = self.corrected(predicted).ok()?;
        let now = tangent(self.zone.at(there).1);
        let cosine = along[0] * now[0] + along[1] * now[1];
        let off = norm([0, 1].map(|a| there[a] - predicted[a]));
        (cosine >= LARGEST_TURN.cos() && off <= 0.2 * length).then_some((there, residual))
    }

    /// Corrections along the gradient, and the size of the last.
    fn corrected(&self, mut q: [f64; 2]) -> Result<([f64; 2], f64), BlochError> {
        let mut before = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            let (value, gradient) = self.zone.at(q);
            let squared = gradient[0] * gradient[0] + gradient[1] * gradient[1];
            let step = gradient.map(|g| value * g / squared);
            q = [0, 1].map(|a| q[a] - step[a]);
            let size = norm(step);
            let stalled = size <= STALLED * norm(q.map(reduced)) && size > 0.25 * before;
            if size <= CORRECTED || stalled {
                return Ok((q, size));
            }
            before = size;
        }
        Err(BlochError::ZeroLines { edges: 0 })
    }

    /// Adds the crossings of a polygon with the edges of the grid.
    fn count(&mut self, points: &[[f64; 2]]) {
        let spacing = TAU / GRID as f64;
        let place = |q: f64| ((q + PI) / spacing - 0.5).floor() as i64;
        for pair in points.windows(2) {
            for a in 0..2 {
                let [low, high] = [pair[0][a].min(pair[1][a]), pair[0][a].max(pair[1][a])];
                for line in place(low) + 1..=place(high) {
                    let level = (line as f64 + 0.5) * spacing - PI;
                    let part = (level - pair[0][a]) / (pair[1][a] - pair[0][a]);
                    let guess = pair[0][1 - a] + part * (pair[1][1 - a] - pair[0][1 - a]);
                    let other = place(self.on_line(a, level, guess)).rem_euclid(GRID as i64) as usize;
                    let line = line.rem_euclid(GRID as i64) as usize;
                    // an edge along the other direction, on the line of equal q_a
                    let k = if a == 0 { other * GRID + line } else { line * GRID + other };
                    self.crossings[1 - a][k] += 1;
                }
            }
        }
    }

    /// The zero near `guess` on the line `q_a = level`, by Newton's method as far as it makes small steps.
    fn on_line(&self, a: usize, level: f64, guess: f64) -> f64 {
        let mut other = guess;
        for _ in 0..4 {
            let mut q = [level; 2];
            q[1 - a] = other;
            let (value, gradient) = self.zone.at(q);
            let step = value / gradient[1 - a];
            if !(step.abs() <= 0.1 * self.longest) {
                return other;
            }
            other -= step;
        }
        other
    }
}

/// A point near a zero line moved onto it, and its error: by the matrix where the polynomial does not know it well.
fn corrected_on_matrix(zone: &Zone, search: &mut SingularSearch<'_>, q: [f64; 2], longest: f64) -> ([f64; 2], f64) {
    let (value, gradient) = zone.at(q);
    let known = (value.abs() + zone.uncertainty(q)) / norm(gradient);
    if known <= EXACT {
        return (q, known);
    }
    match search.on_zone(q) {
        Some((there, error)) if error < known && norm([0, 1].map(|a| there[a] - q[a])) <= longest => (there, error),
        _ => (q, known),
    }
}

/// Whether a point of a zero line is on this one.
fn contains(line: &ZeroLine, q: [f64; 2]) -> bool {
    line.points.windows(2).any(|pair| {
        let (chord, from) = ([0, 1].map(|a| pair[1][a] - pair[0][a]), [0, 1].map(|a| reduced(q[a] - pair[0][a])));
        let squared = chord[0] * chord[0] + chord[1] * chord[1];
        let along = (from[0] * chord[0] + from[1] * chord[1]) / squared;
        let off = (from[0] * chord[1] - from[1] * chord[0]) / squared;
        off.abs() <= BULGE && (-BULGE..=1.0 + BULGE).contains(&along)
    })
}

fn norm(v: [f64; 2]) -> f64 {
    v[0].hypot(v[1])
}

/// The unit tangent with the gradient on its left.
fn tangent(gradient: [f64; 2]) -> [f64; 2] {
    let size = norm(gradient);
    [gradient[1] / size, -gradient[0] / size]
}

/// Whether a step of a curve passes the point where it began, up to turns round the zone.
fn passes(start: [f64; 2], along: [f64; 2], from: [f64; 2], to: [f64; 2], step: f64) -> bool {
    let ahead = |q: [f64; 2]| [0, 1].map(|a| reduced(q[a] - start[a]));
    let (before, after) = (ahead(from), ahead(to));
    let part = |v: [f64; 2]| v[0] * along[0] + v[1] * along[1];
    norm(before) <= 1.5 * step && norm(after) <= 1.5 * step && part(before) < 0.0 && part(after) >= 0.0
}

/// Whether a curve has come back to `q = 0`: as near as where curves begin, and moving inwards.
fn arrives(q: [f64; 2], zone: &Zone) -> bool {
    let near = q.map(reduced);
    let along = tangent(zone.at(q).1);
    norm(near) <= 1.25 * START && near[0] * along[0] + near[1] * along[1] < 0.0
}
