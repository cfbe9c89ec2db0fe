//! A sheet with all that acts on it, drawn otherwise.

use crate::common::Numbers;
use crate::redrawn::{Redrawn, redrawn, renumbered, two_pieces};
use foldwell::analysis::tube::rolled_up;
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Boundary, Domain, Roll, Terms};
use foldwell::sheet::{ScrewLattice, Seam, SeamKept, Sheet};
use nalgebra::{Matrix3, Rotation3};
use std::fmt;

/// The unit of length of the drawing in another unit.
const UNIT: f64 = 1000.0;
/// Another basis of the lattice.
const OBLIQUE: [[i32; 2]; 2] = [[1, 0], [1, 1]];

/// A way to draw a sheet otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drawn {
    Turned,
    Oblique,
    Renumbered,
    Unit,
    Pieces,
}

/// All ways.
pub const WAYS: [Drawn; 5] = [Drawn::Turned, Drawn::Oblique, Drawn::Renumbered, Drawn::Unit, Drawn::Pieces];

impl fmt::Display for Drawn {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self {
            Self::Turned => "turned",
            Self::Oblique => "oblique",
            Self::Renumbered => "renumbered",
            Self::Unit => "unit",
            Self::Pieces => "pieces",
        };
        out.write_str(name)
    }
}

impl Drawn {
    /// Returns the sheet drawn so, and the factor that its energy then has; `None` where it cannot be drawn so: a patch
    /// has no lattice of its own, other domains are of one piece, and diagonals of parallelograms may be drawn
    /// otherwise.
    pub fn of(self, given: &Assembly, numbers: &mut Numbers) -> Option<(Assembly, f64)> {
        let (sheet, is_patch) = (given.sheet(), *given.domain() == Domain::Patch);
        match self {
            Self::Turned => Some((turned(given, numbers), 1.0)),
            Self::Unit => Some((in_unit(given), UNIT)),
            Self::Oblique if is_patch => None,
            Self::Oblique => Some((assembled(given, redrawn(sheet, numbers, OBLIQUE))?, 1.0)),
            Self::Renumbered => Some((assembled(given, renumbered(sheet, numbers))?, 1.0)),
            Self::Pieces if is_patch => {
                let moved = Vec3::new(0.3, -0.2, 1.7) * given.mean_edge();
                Some((assembled(given, two_pieces(sheet, moved))?, 2.0))
            }
            Self::Pieces => None,
        }
    }
}

/// Returns the assembly of a sheet that shows that of another one, with its terms.
fn assembled(given: &Assembly, other: Redrawn) -> Option<Assembly> {
    let bare = bare(given, other.sheet.clone(), other.basis);
    let terms = other.terms(bare.tiling(), given.tiling(), given.terms())?;
    Some(bare.with_terms(terms))
}

/// Returns a sheet with the boundary conditions of an assembly, whose lattice vectors have this basis, without terms.
fn bare(given: &Assembly, sheet: Sheet, basis: [[i32; 2]; 2]) -> Assembly {
    let cells = given.shown();
    let boundary = match given.domain() {
        Domain::Patch => Boundary::Patch,
        Domain::FixedTorus(_) => Boundary::FixedTorus,
        Domain::FreeTorus => Boundary::FreeTorus,
        Domain::Screw => Boundary::Screw,
        Domain::Tube { seam, kept, .. } => return bare_tube(sheet, in_basis(*seam, basis), *kept, cells),
        Domain::Own(_) => panic!("no scene has a domain of its own"),
    };
    Assembly::without_terms(sheet, cells, boundary).unwrap()
}

fn bare_tube(sheet: Sheet, seam: Seam, kept: SeamKept, cells: [usize; 2]) -> Assembly {
    let seam = seam.lattice_vector();
    let roll = if sheet.screws.is_some() {
        Roll::as_drawn(&sheet, seam, kept).unwrap()
    } else {
        rolled_up(&sheet, seam, kept, true).unwrap()
    };
    Assembly::tube_without_terms(sheet, &roll, cells).unwrap()
}

/// Returns a seam by its numbers in another basis of the lattice, one of determinant 1.
fn in_basis(seam: Seam, [[a, b], [c, d]]: [[i32; 2]; 2]) -> Seam {
    assert!(a * d - b * c == 1);
    let [n1, n2] = seam.lattice_vector();
    Seam::new([d * n1 - c * n2, a * n2 - b * n1]).unwrap()
}

/// Returns the sheet turned. A tube that is drawn as one turns about its axis; pins along axes allow a cyclic change of
/// the axes alone.
fn turned(given: &Assembly, numbers: &mut Numbers) -> Assembly {
    let cyclic = Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);
    let sheet = given.sheet();
    let (about, angle) = (Vec3::from_iterator(numbers.many(3, 2.0)), 2.0 + numbers.within(1.0));
    let is_along_axes = given.terms().pins.iter().any(|(_, axes)| *axes != [true; 3]);
    let turn = match (&sheet.screws, is_along_axes) {
        (Some(_), _) => Rotation3::from_axis_angle(&Vec3::z_axis(), angle).into_inner(),
        (None, true) => cyclic,
        (None, false) => Rotation3::new(about).into_inner(),
    };
    let mut other = sheet.clone();
    other.vertices.iter_mut().for_each(|p| *p = turn * *p);
    other.lattice = other.lattice.map(|lattice| lattice.map(|l| turn * l));
    let terms = given.terms();
    let pins = terms
        .pins
        .iter()
        .map(|(vertex, [x, y, z])| (*vertex, if turn == cyclic { [*z, *x, *y] } else { [*x, *y, *z] }));
    let loads = terms.loads.iter().map(|(vertex, force)| (*vertex, turn * force));
    let terms = Terms { pins: pins.collect(), loads: loads.collect(), ..terms.clone() };
    bare(given, other, [[1, 0], [0, 1]]).with_terms(terms)
}

/// Returns the sheet in another unit of length. EA and stiffnesses of creases are forces, and stay; energies have the
/// factor.
fn in_unit(given: &Assembly) -> Assembly {
    let mut other = given.sheet().clone();
    other.vertices.iter_mut().for_each(|p| *p *= UNIT);
    other.lattice = other.lattice.map(|lattice| lattice.map(|l| UNIT * l));
    other.screws = other.screws.map(|ScrewLattice { turn, rise }| ScrewLattice { turn, rise: rise.map(|r| UNIT * r) });
    bare(given, other, [[1, 0], [0, 1]]).with_terms(given.terms().clone())
}
