//! Symmetries of a periodic sheet: rotations and reflections of order two that, with a translation, carry it into
//! itself.
//!
//! Candidates are the maps of the lattice onto itself whose square is the identity, each with and without turning the
//! sheet over. A candidate with a translation is a symmetry if it carries every vertex to a vertex, to 1e-6 of the
//! shorter lattice vector, and every edge to an edge, diagonals of polygons included.

use super::cell::{Corner, EdgeKey, Sheet};
use crate::math::Vec3;
use std::collections::HashMap;

/// The kind of a symmetry; "across" is perpendicular to the lattice plane, "along" lies in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SymmetryKind {
    /// A two-fold axis across the sheet.
    AxisAcross,
    /// A two-fold axis along the sheet.
    AxisAlong,
    /// A two-fold screw axis along the sheet: half a turn and half a period.
    ScrewAlong,
    /// A mirror plane across the sheet.
    MirrorAcross,
    /// A glide plane across the sheet: a reflection and half a period.
    GlideAcross,
    /// A mirror plane along the sheet, which only a flat sheet has.
    MirrorAlong,
    /// A glide plane along the sheet: up and down exchanged, and half a period.
    GlideAlong,
    /// A centre of inversion.
    Inversion,
}

impl SymmetryKind {
    /// Returns the words for it.
    pub fn words(self) -> &'static str {
        match self {
            Self::AxisAcross => "two-fold axis across the sheet",
            Self::AxisAlong => "two-fold axis along the sheet",
            Self::ScrewAlong => "two-fold screw axis along the sheet",
            Self::MirrorAcross => "mirror plane across the sheet",
            Self::GlideAcross => "glide plane across the sheet",
            Self::MirrorAlong => "mirror plane along the sheet",
            Self::GlideAlong => "glide plane along the sheet",
            Self::Inversion => "centre of inversion",
        }
    }
}

/// A symmetry of a periodic sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Symmetry {
    /// Its kind.
    pub kind: SymmetryKind,
    /// Unit vector of an axis along the sheet, of the line in which a plane across the sheet meets it, or of the
    /// translation of a glide plane along it; `None` for the others.
    pub direction: Option<Vec3>,
    /// Whether it exchanges the two sides of the sheet: then mountains become valleys.
    pub turns_over: bool,
    /// Image of each vertex of the cell.
    pub vertices: Vec<usize>,
    /// Image of each edge.
    pub edges: Vec<usize>,
}

/// A linear map of the lattice onto itself.
type LatticeMap = [[i32; 2]; 2];

/// Returns the symmetries of order two of a periodic sheet, one of each kind and direction; none for finite
/// sheets and for those that are no surface with two sides.
///
/// ```
/// use foldwell::sheet::generate::{Pattern, generate};
/// use foldwell::sheet::symmetry::{SymmetryKind, symmetries};
///
/// let found = symmetries(&generate(&Pattern::named("eggbox")?)?);
/// // a sheet of parallelograms has a glide plane along it, or another symmetry that turns it over
/// assert!(found.iter().any(|symmetry| symmetry.turns_over));
/// assert!(symmetries(&generate(&Pattern::named("random")?)?).is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn symmetries(sheet: &Sheet) -> Vec<Symmetry> {
    let Some(lattice) = sheet.lattice.filter(|_| sheet.is_surface()) else { return vec![] };
    let frame = LatticeSheet::new(sheet, lattice);
    let maps = frame.lattice_maps().into_iter().flat_map(|map| [(map, false), (map, true)]);
    let maps = maps.filter(|map| *map != (IDENTITY, false));
    maps.filter_map(|(map, turns_over)| frame.symmetry(map, turns_over)).collect()
}

const IDENTITY: LatticeMap = [[1, 0], [0, 1]];
const HALF_TURN: LatticeMap = [[-1, 0], [0, -1]];

/// A sheet in the coordinates of its lattice.
struct LatticeSheet<'a> {
    sheet: &'a Sheet,
    lattice: [Vec3; 2],
    /// Covectors of the lattice vectors, and the unit normal.
    covectors: [Vec3; 2],
    normal: Vec3,
    tolerance: f64,
    numbers: HashMap<EdgeKey, usize>,
}

impl<'a> LatticeSheet<'a> {
    fn new(sheet: &'a Sheet, lattice @ [l1, l2]: [Vec3; 2]) -> Self {
        let normal = l1.cross(&l2).normalize();
        let [c1, c2] = [l2.cross(&normal), normal.cross(&l1)];
        let covectors = [c1 / c1.dot(&l1), c2 / c2.dot(&l2)];
        let numbers = sheet.edges.iter().enumerate().map(|(number, edge)| (edge.key, number)).collect();
        Self { sheet, lattice, covectors, normal, tolerance: 1e-6 * l1.norm().min(l2.norm()), numbers }
    }

    /// Returns the maps of order two, and the identity, that keep lengths: with entries of at most one they are all,
    /// for lattice vectors that are not much longer than the shortest ones.
    fn lattice_maps(&self) -> Vec<LatticeMap> {
        let [l1, l2] = &self.lattice;
        let metric = [[l1.dot(l1), l1.dot(l2)], [l2.dot(l1), l2.dot(l2)]];
        let within = self.tolerance * l1.norm().max(l2.norm());
        let kept = |map: &LatticeMap| {
            let image = [0, 1].map(|a| l1 * f64::from(map[0][a]) + l2 * f64::from(map[1][a]));
            (0..2).all(|a| (0..2).all(|b| (image[a].dot(&image[b]) - metric[a][b]).abs() <= within))
        };
        let square = |m: &LatticeMap| [0, 1].map(|a| [0, 1].map(|b| m[a][0] * m[0][b] + m[a][1] * m[1][b]));
        let entry = |k: i32, place: u32| k / 3i32.pow(place) % 3 - 1;
        let all = (0..81).map(|k| [[entry(k, 0), entry(k, 1)], [entry(k, 2), entry(k, 3)]]);
        all.filter(|map| square(map) == IDENTITY && kept(map)).collect()
    }

    /// Returns the symmetry with this linear part, without a glide if there is a choice.
    fn symmetry(&self, map: LatticeMap, turns_over: bool) -> Option<Symmetry> {
        let first = self.image(map, turns_over, &self.sheet.vertices[0]);
        let of = |place: &Vec3| {
            let shift = place - first;
            let corners = self.images(map, turns_over, &shift)?;
            let edges = self.edges(map, &corners)?;
            let glides = self.glides(map, &shift);
            let vertices = corners.iter().map(|corner| corner.vertex).collect();
            let kind = kind(map, turns_over, glides);
            let direction = self.direction(map, &shift).filter(|_| kind != SymmetryKind::MirrorAlong);
            Some((glides, Symmetry { kind, direction, turns_over, vertices, edges }))
        };
        self.sheet.vertices.iter().filter_map(of).min_by_key(|(glides, _)| *glides).map(|(_, found)| found)
    }

    /// Returns the image of a point under the linear part.
    fn image(&self, map: LatticeMap, turns_over: bool, point: &Vec3) -> Vec3 {
        let at = self.covectors.map(|covector| covector.dot(point));
        let height = self.normal.dot(point) * if turns_over { -1.0 } else { 1.0 };
        let along = |a: usize| self.lattice[a] * (f64::from(map[a][0]) * at[0] + f64::from(map[a][1]) * at[1]);
        along(0) + along(1) + self.normal * height
    }

    /// Returns the corner at the image of each vertex; `None` if one has none.
    fn images(&self, map: LatticeMap, turns_over: bool, shift: &Vec3) -> Option<Vec<Corner>> {
        let corner = |point: &Vec3| {
            let place = self.image(map, turns_over, point) + shift;
            self.sheet.vertices.iter().enumerate().find_map(|(vertex, home)| {
                let step = place - home;
                let cells = self.covectors.map(|covector| covector.dot(&step).round());
                let off = step - self.lattice[0] * cells[0] - self.lattice[1] * cells[1];
                (off.norm() <= self.tolerance).then(|| Corner { vertex, shift: cells.map(|n| n as i32) })
            })
        };
        self.sheet.vertices.iter().map(corner).collect()
    }

    /// Returns the number of the image of each edge; `None` if one has none.
    fn edges(&self, map: LatticeMap, corners: &[Corner]) -> Option<Vec<usize>> {
        let image = |corner: Corner| {
            let cells = [0, 1].map(|a| map[a][0] * corner.shift[0] + map[a][1] * corner.shift[1]);
            corners[corner.vertex].translated(cells)
        };
        let number = |key: &EdgeKey| {
            let [a, b] = key.ends().map(image);
            self.numbers.get(&EdgeKey::new(a, b).0).copied()
        };
        self.sheet.edges.iter().map(|edge| number(&edge.key)).collect()
    }

    /// Whether a symmetry with this translation has a part of it that no other origin removes.
    fn glides(&self, map: LatticeMap, shift: &Vec3) -> bool {
        let at = self.covectors.map(|covector| covector.dot(shift));
        let twice = |at: [f64; 2]| [0, 1].map(|a| at[a] + f64::from(map[a][0]) * at[0] + f64::from(map[a][1]) * at[1]);
        let nearby = (-2..=2).flat_map(|m| (-2..=2).map(move |n| [f64::from(m), f64::from(n)]));
        !nearby.into_iter().any(|cell| {
            let rest = twice([at[0] + cell[0], at[1] + cell[1]]);
            (self.lattice[0] * rest[0] + self.lattice[1] * rest[1]).norm() <= 4.0 * self.tolerance
        })
    }

    /// Returns the unit vector that a reflection of the lattice keeps, or along which a map that keeps the lattice
    /// translates.
    fn direction(&self, map: LatticeMap, shift: &Vec3) -> Option<Vec3> {
        match map {
            HALF_TURN => None,
            IDENTITY => (shift - self.normal * self.normal.dot(shift)).try_normalize(self.tolerance),
            _ => {
                let kept = |k: usize| self.lattice[k] + self.image(map, false, &self.lattice[k]);
                kept(0).try_normalize(self.tolerance).or_else(|| kept(1).try_normalize(self.tolerance))
            }
        }
    }
}

fn kind(map: LatticeMap, turns_over: bool, glides: bool) -> SymmetryKind {
    match (map, turns_over, glides) {
        (HALF_TURN, false, _) => SymmetryKind::AxisAcross,
        (HALF_TURN, true, _) => SymmetryKind::Inversion,
        (IDENTITY, _, true) => SymmetryKind::GlideAlong,
        (IDENTITY, _, false) => SymmetryKind::MirrorAlong,
        (_, false, true) => SymmetryKind::GlideAcross,
        (_, false, false) => SymmetryKind::MirrorAcross,
        (_, true, true) => SymmetryKind::ScrewAlong,
        (_, true, false) => SymmetryKind::AxisAlong,
    }
}
