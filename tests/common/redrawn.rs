//! The same sheet drawn otherwise: its vertices in another order, in other cells, with other lattice vectors, or
//! several copies of it.

use super::common::Numbers;
use foldwell::math::Vec3;
use foldwell::model::{Hinges, Stiffness, Terms};
use foldwell::sheet::build::{Drawing, build};
use foldwell::sheet::{Corner, EdgeKey, ScrewLattice, Sheet, Site, Tiling};
use std::collections::BTreeMap;

/// A sheet that shows another one, and the way from its numbers to those of the other.
pub struct Redrawn {
    /// The sheet.
    pub sheet: Sheet,
    /// The corner of the other sheet at which each vertex is drawn.
    pub corners: Vec<Corner>,
    /// Its lattice vectors in those of the other.
    pub basis: [[i32; 2]; 2],
}

/// Returns the sheet with its vertices in random order, each in some cell in which a face has it, and with other
/// lattice vectors.
pub fn redrawn(sheet: &Sheet, numbers: &mut Numbers, basis: [[i32; 2]; 2]) -> Redrawn {
    let mut corners = drawn_corners(sheet);
    shuffle(&mut corners, numbers);
    from_corners(sheet, &[corners], &[Vec3::zeros()], basis)
}

/// Returns the sheet with its vertices in random order, each in the cell in which it was, and its faces in the opposite
/// order.
pub fn renumbered(sheet: &Sheet, numbers: &mut Numbers) -> Redrawn {
    let mut other = sheet.clone();
    other.polygons.reverse();
    let (mut home, away): (Vec<Corner>, Vec<Corner>) =
        drawn_corners(sheet).into_iter().partition(|corner| corner.shift == [0, 0]);
    let missing = (0..sheet.vertices.len()).map(Corner::home).filter(|corner| !home.contains(corner));
    home.extend(missing.collect::<Vec<_>>());
    shuffle(&mut home, numbers);
    home.extend(away);
    from_corners(&other, &[home], &[Vec3::zeros()], [[1, 0], [0, 1]])
}

/// Returns two copies of the sheet as two pieces of one, the second one moved.
pub fn two_pieces(sheet: &Sheet, moved: Vec3) -> Redrawn {
    let home = (0..sheet.vertices.len()).map(Corner::home);
    let away = drawn_corners(sheet).into_iter().filter(|corner| corner.shift != [0, 0]);
    let corners: Vec<Corner> = home.chain(away).collect();
    from_corners(sheet, &[corners.clone(), corners], &[Vec3::zeros(), moved], [[1, 0], [0, 1]])
}

/// Returns the corners of all faces, each once.
fn drawn_corners(sheet: &Sheet) -> Vec<Corner> {
    let mut corners: Vec<Corner> = sheet.polygons.iter().flatten().copied().collect();
    corners.sort_unstable_by_key(|corner| (corner.vertex, corner.shift));
    corners.dedup();
    corners
}

fn shuffle(corners: &mut [Corner], numbers: &mut Numbers) {
    let mut shuffled: Vec<(f64, Corner)> = corners.iter().map(|corner| (numbers.within(1.0), *corner)).collect();
    shuffled.sort_by(|a, b| a.0.total_cmp(&b.0));
    corners.iter_mut().zip(shuffled).for_each(|(corner, (_, other))| *corner = other);
}

/// Draws copies of a sheet by corners that have all of its faces, each copy moved by a vector.
fn from_corners(sheet: &Sheet, copies: &[Vec<Corner>], moved: &[Vec3], basis: [[i32; 2]; 2]) -> Redrawn {
    let mut drawing = Drawing { title: sheet.title.clone(), ..Drawing::default() };
    let mut homes = Vec::new();
    for (corners, by) in copies.iter().zip(moved) {
        let begin = drawing.coords.len();
        let number: BTreeMap<Corner, usize> = corners.iter().enumerate().map(|(k, c)| (*c, begin + k)).collect();
        drawing.coords.extend(corners.iter().map(|corner| sheet.position(*corner) + by));
        let list = |corners: &Vec<Corner>| corners.iter().map(|corner| number[corner]).collect::<Vec<usize>>();
        drawing.faces.extend(sheet.polygons.iter().map(list));
        // a vertex of the new sheet is where it is drawn first
        let mut seen = vec![false; sheet.vertices.len()];
        homes.extend(corners.iter().copied().filter(|corner| !std::mem::replace(&mut seen[corner.vertex], true)));
    }
    drawing.lattice = sheet.lattice.map(|[l1, l2]| basis.map(|[a, b]| l1 * f64::from(a) + l2 * f64::from(b)));
    let of = |numbers: [f64; 2]| basis.map(|[a, b]| numbers[0] * f64::from(a) + numbers[1] * f64::from(b));
    drawing.screws = sheet.screws.map(|screws| ScrewLattice { turn: of(screws.turn), rise: of(screws.rise) });
    let sheet = build(&drawing).expect("the drawing of a sheet");
    assert!(sheet.vertices.len() == homes.len(), "each vertex is drawn once in a cell");
    Redrawn { sheet, corners: homes, basis }
}

/// A vertex of a tiling by the vertex of the sheet and the cell in which it is.
type Place = (usize, [i32; 2]);

impl Redrawn {
    /// Returns the corner of the other sheet that a corner of this one shows.
    fn corner(&self, corner: Corner) -> Corner {
        let home = self.corners[corner.vertex];
        let cell = |axis: usize| {
            corner.shift[0] * self.basis[0][axis] + corner.shift[1] * self.basis[1][axis] + home.shift[axis]
        };
        Corner { vertex: home.vertex, shift: [cell(0), cell(1)] }
    }

    /// Returns the edge of the other sheet that each edge of this one is; `None` where diagonals were drawn otherwise.
    pub fn edges(&self, other: &Sheet) -> Option<Vec<usize>> {
        let number: BTreeMap<EdgeKey, usize> = other.edges.iter().enumerate().map(|(k, edge)| (edge.key, k)).collect();
        let ends = |key: &EdgeKey| key.ends().map(|end| self.corner(end));
        let old = |key: &EdgeKey| number.get(&EdgeKey::new(ends(key)[0], ends(key)[1]).0).copied();
        self.sheet.edges.iter().map(|edge| old(&edge.key)).collect()
    }

    /// Returns terms of a tiling of the other sheet as those of a tiling of this one with as many cells; `None` where
    /// diagonals were drawn otherwise.
    ///
    /// # Panics
    /// For terms that a scene with a relaxation does not have: stiffnesses of single edges, guides and parts.
    pub fn terms(&self, here: &Tiling, other: &Tiling, terms: &Terms) -> Option<Terms> {
        let edges = self.tiled_edges(here, other)?;
        let hinges = |hinges: &Option<Hinges>| {
            hinges.as_ref().map(|Hinges { stiffness, rest }| {
                assert!(matches!(stiffness, Stiffness::Uniform(_)));
                Hinges { stiffness: stiffness.clone(), rest: edges.iter().map(|&old| rest[old]).collect() }
            })
        };
        assert!(terms.guides.is_empty() && terms.parts.is_empty());
        let locks: BTreeMap<usize, f64> = terms.locks.iter().copied().collect();
        let locks = edges.iter().enumerate().filter_map(|(k, old)| Some((k, *locks.get(old)?))).collect();
        let (pins, loads) = (self.at_vertices(here, other, &terms.pins), self.at_vertices(here, other, &terms.loads));
        let (creases, facets) = (hinges(&terms.creases), hinges(&terms.facets));
        Some(Terms { creases, facets, locks, pins, loads, ..terms.clone() })
    }

    /// Returns what is at vertices of a tiling of the other sheet at the vertices of a tiling of this one that show
    /// them.
    fn at_vertices<T: Copy>(&self, here: &Tiling, other: &Tiling, given: &[(usize, T)]) -> Vec<(usize, T)> {
        let number = |vertex: usize| {
            let (old, shift) = self.place(here, other, Site { vertex, shift: [0, 0] });
            (shift == [0, 0]).then_some(old)
        };
        let all = (0..here.positions.len()).flat_map(|k| given.iter().map(move |(at, what)| (k, *at, *what)));
        all.filter(|(k, at, _)| number(*k) == Some(*at)).map(|(k, _, what)| (k, what)).collect()
    }

    /// Returns the edge of a tiling of the other sheet that each edge of a tiling of this one is.
    fn tiled_edges(&self, here: &Tiling, other: &Tiling) -> Option<Vec<usize>> {
        let place = |site: &Site| (site.vertex, site.shift);
        let number: BTreeMap<[Place; 2], usize> =
            other.edges.iter().enumerate().map(|(k, edge)| (from_first(edge.ends.each_ref().map(place)), k)).collect();
        let old = |ends: &[Site; 2]| number.get(&from_first(ends.map(|site| self.place(here, other, site)))).copied();
        here.edges.iter().map(|edge| old(&edge.ends)).collect()
    }

    /// Returns number and shift in the other tiling of a vertex of a tiling of this sheet.
    fn place(&self, here: &Tiling, other: &Tiling, site: Site) -> Place {
        let (vertices, cells) = (self.sheet.vertices.len(), here.cells.map(|n| n as i32));
        let (vertex, cell) = (site.vertex % vertices, (site.vertex / vertices) as i32);
        let of_tiling = [cell % cells[0], cell / cells[0]];
        let shift = [0, 1].map(|axis| of_tiling[axis] + site.shift[axis] * cells[axis]);
        let old = self.corner(Corner { vertex, shift });
        let [n1, n2] = other.cells.map(|n| n as i32);
        let (in_tiling, around) = (
            [old.shift[0].rem_euclid(n1), old.shift[1].rem_euclid(n2)],
            [old.shift[0].div_euclid(n1), old.shift[1].div_euclid(n2)],
        );
        let of_cell = other.positions.len() / (other.cells[0] * other.cells[1]);
        ((in_tiling[1] * n1 + in_tiling[0]) as usize * of_cell + old.vertex, around)
    }
}

/// Returns two ends in a fixed order, their shifts counted from the first one.
fn from_first([a, b]: [Place; 2]) -> [Place; 2] {
    let shift = |from: Place, to: Place| [to.1[0] - from.1[0], to.1[1] - from.1[1]];
    let (one, other) = ([(a.0, [0, 0]), (b.0, shift(a, b))], [(b.0, [0, 0]), (a.0, shift(b, a))]);
    one.min(other)
}
