//! Identifies drawn vertices that are the same vertex of the cell.
//!
//! Two drawn vertices that differ by a lattice vector, within 1e-6 of the shorter lattice vector, are one vertex; the
//! one that comes first in the file is in cell (0, 0) and gives the position. So are two that a screw motion of a
//! tube's cell carries into each other; of the cells that differ by a whole turn the nearest one is meant. In a finite
//! sheet every drawn vertex is a vertex of its own: layers of a folded sheet touch, and vertices of different faces may
//! stand at one place, closer than 1e-9 of the sheet's extent. Faces cannot be rebuilt there, and no face may have two
//! such corners.

use std::collections::HashMap;

use super::{Defect, Drawing, MeshPart, MeshProblem};
use crate::math::{Vec3, bounds};
use crate::sheet::ScrewLattice;
use crate::sheet::cell::Corner;

/// Largest number of cells, along either lattice vector, between a drawn vertex and its first appearance.
const FARTHEST: f64 = 1e6;
/// The same along either screw motion of a tube's cell.
const REACH: i32 = 4;

/// The corner of every drawn vertex, and the first appearance of every vertex of the cell.
#[derive(Clone, Debug)]
pub(crate) struct Identified {
    /// Corner that each drawn vertex represents.
    pub corner: Vec<Corner>,
    /// Drawn vertex that is the first appearance of each vertex of the cell.
    pub homes: Vec<usize>,
}

impl Identified {
    /// Returns the corners of a list of drawn vertices.
    pub(crate) fn corners(&self, drawn: &[usize]) -> Vec<Corner> {
        drawn.iter().map(|&v| self.corner[v]).collect()
    }
}

/// Identifies the vertices of `drawn`.
pub(super) fn identify(drawn: &Drawing) -> Result<Identified, Defect> {
    match (drawn.lattice, &drawn.screws) {
        (Some(lattice), _) => identify_periodic(drawn, &Metric::periodic(lattice)),
        (None, Some(screws)) => identify_turned(drawn, screws),
        (None, None) => {
            check_corners(drawn)?;
            let count = drawn.coords.len();
            Ok(Identified { corner: (0..count).map(Corner::home).collect(), homes: (0..count).collect() })
        }
    }
}

/// Returns each vertex of a finite sheet that stands where an earlier one stands, together with the first one there.
pub(crate) fn coincident(coords: &[Vec3]) -> Vec<[usize; 2]> {
    if coords.is_empty() {
        return vec![];
    }
    let metric = Metric::finite(coords);
    let mut buckets: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    let mut pairs = Vec::new();
    for (v, x) in coords.iter().enumerate() {
        let bucket = metric.bucket(*x);
        let near = metric.around(bucket).into_iter().filter_map(|b| buckets.get(&b)).flatten().copied();
        match near.filter(|&w| (coords[w] - x).norm() <= metric.tolerance).min() {
            Some(first) => pairs.push([v, first]),
            None => buckets.entry(bucket).or_default().push(v),
        }
    }
    pairs
}

/// Returns the places of vertices, each once and in the order of their first vertices, and the place of every vertex.
pub(crate) fn merged(coords: &[Vec3]) -> (Vec<Vec3>, Vec<usize>) {
    let mut first: Vec<usize> = (0..coords.len()).collect();
    coincident(coords).into_iter().for_each(|[vertex, there]| first[vertex] = there);
    let (mut places, mut of) = (Vec::new(), Vec::with_capacity(coords.len()));
    for (vertex, &there) in first.iter().enumerate() {
        of.push(if there == vertex { places.len() } else { of[there] });
        places.extend((there == vertex).then_some(coords[vertex]));
    }
    (places, of)
}

/// Checks that every place has one vertex, as rebuilding faces from edges needs it.
pub(crate) fn check_places(drawn: &Drawing) -> Result<(), Defect> {
    coincident(&drawn.coords).first().map_or(Ok(()), |&[vertex, other]| Err(duplicate(drawn, vertex, other)))
}

/// Checks that the corners of every face stand at different places.
fn check_corners(drawn: &Drawing) -> Result<(), Defect> {
    let first: HashMap<usize, usize> = coincident(&drawn.coords).into_iter().map(|[v, first]| (v, first)).collect();
    let at = |v: &usize| first.get(v).copied().unwrap_or(*v);
    for face in drawn.faces.iter().filter(|face| face.iter().any(|v| first.contains_key(v))) {
        let mut seen = HashMap::new();
        for &v in face {
            if let Some(other) = seen.insert(at(&v), v).filter(|other| *other != v) {
                return Err(duplicate(drawn, v.max(other), v.min(other)));
            }
        }
    }
    Ok(())
}

fn duplicate(drawn: &Drawing, vertex: usize, other: usize) -> Defect {
    let problem = MeshProblem::DuplicateVertex { vertex: drawn.name(vertex), other: drawn.name(other) };
    Defect::new(MeshPart::Vertex(vertex), problem)
}

fn identify_periodic(drawn: &Drawing, metric: &Metric) -> Result<Identified, Defect> {
    let mut buckets: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    let mut found = Found::new(drawn);
    for (v, &x) in drawn.coords.iter().enumerate() {
        let bucket = metric.bucket(x);
        let near = metric.around(bucket).into_iter().filter_map(|b| buckets.get(&b)).flatten();
        let copy = near.copied().filter(|&c| metric.shift(drawn, x, found.identified.homes[c]).is_some()).min();
        let known = copy.map(|c| copy_corner(drawn, metric, v, c, found.identified.homes[c])).transpose()?;
        if known.is_none() {
            buckets.entry(bucket).or_default().push(found.identified.homes.len());
        }
        found.add(v, known)?;
    }
    Ok(found.identified)
}

/// The vertices that were identified so far.
struct Found<'a> {
    drawn: &'a Drawing,
    /// Drawn vertex at each corner.
    taken: HashMap<Corner, usize>,
    identified: Identified,
}

impl<'a> Found<'a> {
    fn new(drawn: &'a Drawing) -> Self {
        let identified = Identified { corner: Vec::with_capacity(drawn.coords.len()), homes: Vec::new() };
        Self { drawn, taken: HashMap::new(), identified }
    }

    /// Adds the next drawn vertex, a copy of a known one or the first appearance of another.
    fn add(&mut self, v: usize, known: Option<Corner>) -> Result<(), Defect> {
        let corner = known.unwrap_or_else(|| {
            self.identified.homes.push(v);
            Corner::home(self.identified.homes.len() - 1)
        });
        if let Some(other) = self.taken.insert(corner, v) {
            return Err(duplicate(self.drawn, v, other));
        }
        self.identified.corner.push(corner);
        Ok(())
    }
}

/// Identifies the vertices of a cell that screw motions repeat.
fn identify_turned(drawn: &Drawing, screws: &ScrewLattice) -> Result<Identified, Defect> {
    let mut cells: Vec<[i32; 2]> = (-REACH..=REACH).flat_map(|n1| (-REACH..=REACH).map(move |n2| [n1, n2])).collect();
    cells.sort_by_key(|[n1, n2]| n1 * n1 + n2 * n2);
    let [first, second] = screws.chords(&drawn.coords[0]);
    let tolerance = 1e-6 * first.norm().min(second.norm());
    let mut found = Found::new(drawn);
    for (v, x) in drawn.coords.iter().enumerate() {
        let is_copy = |home: usize, cell| (screws.copy(&drawn.coords[home], cell) - x).norm() <= tolerance;
        let known = cells.iter().find_map(|&shift| {
            let vertex = found.identified.homes.iter().position(|&home| is_copy(home, shift))?;
            Some(Corner { vertex, shift })
        });
        found.add(v, known)?;
    }
    Ok(found.identified)
}

/// Returns the corner of drawn vertex `v`, a copy of vertex `c` of the cell, which first appears as drawn vertex
/// `home`.
fn copy_corner(drawn: &Drawing, metric: &Metric, v: usize, c: usize, home: usize) -> Result<Corner, Defect> {
    let [n1, n2] = metric.shift(drawn, drawn.coords[v], home).unwrap_or([0.0, 0.0]);
    if n1.abs() > FARTHEST || n2.abs() > FARTHEST {
        let problem = MeshProblem::FarAway { vertex: drawn.name(v), other: drawn.name(home), n1, n2 };
        return Err(Defect::new(MeshPart::Vertex(v), problem));
    }
    Ok(Corner { vertex: c, shift: [n1 as i32, n2 as i32] })
}

/// A grid of buckets for vertices in which close vertices fall into the same or neighbouring buckets.
struct Metric {
    tolerance: f64,
    /// Three covectors that give the coordinates: lattice coordinates and height, or x, y, z.
    axes: [Vec3; 3],
    /// Width of a bucket along each covector.
    width: [f64; 3],
    /// Number of buckets after which a periodic coordinate repeats; `None` for other coordinates.
    period: [Option<i64>; 3],
}

impl Metric {
    fn finite(coords: &[Vec3]) -> Self {
        let [low, high] = bounds(coords);
        let tolerance = (1e-9 * (high - low).norm()).max(f64::MIN_POSITIVE);
        Self { tolerance, axes: [Vec3::x(), Vec3::y(), Vec3::z()], width: [2.0 * tolerance; 3], period: [None; 3] }
    }

    fn periodic([l1, l2]: [Vec3; 2]) -> Self {
        let tolerance = 1e-6 * l1.norm().min(l2.norm());
        let normal = l1.cross(&l2).normalize();
        let (c1, c2) = (l2.cross(&normal), normal.cross(&l1));
        let axes = [c1 / c1.dot(&l1), c2 / c2.dot(&l2), normal];
        let count = |axis: &Vec3| (1.0 / (2.0 * tolerance * axis.norm())).floor().clamp(1.0, 1e6);
        let counts = [count(&axes[0]), count(&axes[1])];
        let width = [1.0 / counts[0], 1.0 / counts[1], 2.0 * tolerance];
        Self { tolerance, axes, width, period: [Some(counts[0] as i64), Some(counts[1] as i64), None] }
    }

    fn bucket(&self, x: Vec3) -> [i64; 3] {
        std::array::from_fn(|k| {
            let u = self.axes[k].dot(&x);
            match self.period[k] {
                Some(p) => (((u - u.floor()) / self.width[k]) as i64).rem_euclid(p),
                None => (u / self.width[k]).floor() as i64,
            }
        })
    }

    fn around(&self, b: [i64; 3]) -> Vec<[i64; 3]> {
        let number = |k: usize, step: i64| {
            let moved = b[k].saturating_add(step);
            self.period[k].map_or(moved, |p| moved.rem_euclid(p))
        };
        (0..27).map(|d| [number(0, d % 3 - 1), number(1, d / 3 % 3 - 1), number(2, d / 9 - 1)]).collect()
    }

    /// Returns the numbers of lattice vectors from the drawn vertex `home` to `x`; `None` if `x` is not a copy of it.
    fn shift(&self, drawn: &Drawing, x: Vec3, home: usize) -> Option<[f64; 2]> {
        let d = x - drawn.coords[home];
        let n = [self.axes[0].dot(&d).round(), self.axes[1].dot(&d).round()];
        let [l1, l2] = drawn.lattice.unwrap_or_default();
        ((d - l1 * n[0] - l2 * n[1]).norm() <= self.tolerance).then_some(n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(coords: &[[f64; 3]], lattice: Option<[[f64; 3]; 2]>) -> Drawing {
        Drawing {
            coords: coords.iter().map(|&c| c.into()).collect(),
            lattice: lattice.map(|l| l.map(Into::into)),
            ..Drawing::default()
        }
    }

    /// Claim: copies are found across the wrap of a skew lattice, inside the tolerance and not outside. Source: the
    /// tolerance is 1e-6 of the shorter lattice vector, which is 1 here.
    #[test]
    fn copies_within_the_tolerance() {
        let lattice = Some([[1.0, 0.0, 0.0], [0.9, 3.0, 0.0]]);
        let near = drawn(&[[1e-9, 0.0, 0.0], [1.9 - 9e-7, 3.0, 0.0], [-1.0, 0.0, 5e-7]], lattice);
        let found = identify(&near).unwrap();
        assert_eq!(found.homes, [0]);
        assert_eq!(found.corner[1].shift, [1, 1]);
        assert_eq!(found.corner[2].shift, [-1, 0]);
        let far = drawn(&[[0.0; 3], [1.9, 3.0, 1.1e-6]], lattice);
        assert_eq!(identify(&far).unwrap().homes, [0, 1]);
    }

    /// Claim: two vertices at the same position are refused with a lattice, where faces are rebuilt, and as corners of
    /// one face; otherwise they are two vertices.
    #[test]
    fn one_place_one_vertex() {
        let places = [[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.5, 1e-12], [1.0, 0.0, 0.0]];
        let problem = MeshProblem::DuplicateVertex { vertex: 2, other: 1 };
        let periodic = drawn(&places, Some([[2.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
        assert_eq!(*identify(&periodic).unwrap_err().problem, problem);
        let mut finite = drawn(&places, None);
        assert_eq!(*check_places(&finite).unwrap_err().problem, problem);
        finite.faces = vec![vec![0, 1, 3], vec![0, 3, 2]];
        assert_eq!(identify(&finite).unwrap().homes, [0, 1, 2, 3]);
        assert_eq!(coincident(&finite.coords), [[2, 1]]);
        finite.faces = vec![vec![0, 1, 3, 2]];
        assert_eq!(*identify(&finite).unwrap_err().problem, problem);
    }
}
