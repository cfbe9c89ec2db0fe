//! Different drawings of one sheet relax to the same fold angles and energy: rotated, translated, mirrored, in another
//! unit, with other numbers, orders or cells, or with a cell twice as large. `tests/differential` tests random sheets.

use crate::common;
use foldwell::analysis::relax::relax;
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Boundary, Terms};
use foldwell::sheet::Sheet;
use foldwell::sheet::build::{Drawing, build, draw};
use nalgebra::Rotation3;

/// Largest difference of a rest angle from the drawn angle, the stiffness of the bars, and the ratio of two units of
/// length.
const OFF: f64 = 0.05;
const BARS: f64 = 1e6;
const UNIT: f64 = 1000.0;
/// Tolerance: residuals of 1e-12 divided by the softest eigenvalue, about 0.01 on the largest patch, and the rounding
/// errors of points at a distance of 100.
const ALLOWED: f64 = 1e-9;

/// Another drawing of the same sheet.
struct Change {
    name: &'static str,
    /// The function that makes the other drawing.
    draw: fn(Drawing) -> Drawing,
    /// Whether patches of the other cell are the same patches.
    keeps_patches: bool,
    /// Number of copies of each crease of the sheet in the other cell, the unit of energy, and the sign of the fold
    /// angles.
    times: usize,
    energy: f64,
    sign: f64,
}

const SAME: Change =
    Change { name: "as drawn", draw: |drawn| drawn, keeps_patches: true, times: 1, energy: 1.0, sign: 1.0 };

const CHANGES: [Change; 8] = [
    Change { name: "turned", draw: turned, ..SAME },
    Change { name: "moved by 100", draw: |drawn| mapped(drawn, |p| p + Vec3::new(60.0, -80.0, 0.0), false), ..SAME },
    Change { name: "mirrored", draw: |drawn| mapped(drawn, |p| Vec3::new(p.x, p.y, -p.z), true), sign: -1.0, ..SAME },
    // EA and torque per length are unchanged: both energies are proportional to the unit
    Change { name: "unit 1000 times smaller", draw: |drawn| mapped(drawn, |p| p * UNIT, true), energy: UNIT, ..SAME },
    // the first copy of a vertex in the file determines its cell: patches have other rims
    Change { name: "vertices numbered backwards", draw: renumbered, keeps_patches: false, ..SAME },
    Change { name: "faces listed backwards", draw: relisted, ..SAME },
    Change { name: "half of the faces one cell further", draw: shifted, keeps_patches: false, ..SAME },
    Change { name: "a cell twice as large", draw: doubled, keeps_patches: false, times: 2, energy: 2.0, ..SAME },
];

/// Returns the drawn angles plus `off` times the sine of ten times the edge length divided by the mean one: the same
/// rest angles for all drawings of the sheet.
fn rest_by_length(assembly: &Assembly, off: f64) -> Vec<f64> {
    let sheet = assembly.sheet();
    let ends = sheet.edges.iter().map(|edge| edge.key.ends().map(|end| sheet.position(end)));
    let lengths: Vec<f64> = ends.map(|[a, b]| (b - a).norm()).collect();
    let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
    let edges = assembly.drawn_angles().iter().zip(&assembly.tiling().edges);
    edges.map(|(angle, edge)| angle + off * (10.0 * lengths[edge.edge] / mean).sin()).collect()
}

/// Returns the fold angles of the relaxed sheet in ascending order, and its energy.
fn relaxed(change: &Change, boundary: Boundary, cells: [usize; 2]) -> (Vec<f64>, f64) {
    let sheet: Sheet = build(&(change.draw)(draw(&common::mesh("open-star")))).unwrap();
    let drawn = Assembly::without_terms(sheet, cells, boundary).unwrap();
    let terms = Terms::bars_and_creases(BARS, 1.0, rest_by_length(&drawn, change.sign * OFF));
    let found = relax(&drawn.with_terms(terms).with_best_axis()).unwrap();
    let mut angles: Vec<f64> = found.state.fold_angle.iter().filter(|a| !a.is_nan()).map(|a| change.sign * a).collect();
    angles.sort_by(f64::total_cmp);
    (angles, found.state.total())
}

/// Claim: all drawings of a sheet relax to the same fold angles and energy. Source: symmetry; rest angles depend on the
/// lengths of the edges, which are the same in all drawings.
#[test]
fn every_drawing_of_a_sheet_relaxes_alike() {
    for (boundary, cells) in [(Boundary::Patch, [3, 3]), (Boundary::FreeTorus, [1, 1]), (Boundary::Screw, [1, 1])] {
        let (expected, energy) = relaxed(&SAME, boundary, cells);
        for change in CHANGES.iter().filter(|change| change.keeps_patches || boundary != Boundary::Patch) {
            let (angles, found) = relaxed(change, boundary, cells);
            let every: Vec<f64> = expected.iter().flat_map(|angle| vec![*angle; change.times]).collect();
            assert_eq!(angles.len(), every.len(), "{}, {boundary:?}", change.name);
            let off = common::distance(&angles, &every);
            let off_energy = (found / energy / change.energy - 1.0).abs();
            assert!(off <= ALLOWED && off_energy <= ALLOWED, "{}, {boundary:?}: {off:e} {off_energy:e}", change.name);
        }
    }
}

/// Maps all points, and the lattice vectors if `vectors`.
fn mapped(mut drawn: Drawing, map: impl Fn(Vec3) -> Vec3, vectors: bool) -> Drawing {
    drawn.planar = false;
    drawn.coords.iter_mut().for_each(|p| *p = map(*p));
    if vectors {
        drawn.lattice = drawn.lattice.map(|lattice| lattice.map(map));
    }
    drawn
}

fn turned(drawn: Drawing) -> Drawing {
    let rotation = Rotation3::new(Vec3::new(0.7, -1.1, 2.3));
    mapped(drawn, |p| rotation * p, true)
}

fn renumbered(mut drawn: Drawing) -> Drawing {
    let last = drawn.coords.len() - 1;
    drawn.coords.reverse();
    drawn.faces.iter_mut().flatten().for_each(|vertex| *vertex = last - *vertex);
    drawn
}

fn relisted(mut drawn: Drawing) -> Drawing {
    drawn.faces.reverse();
    drawn.faces.iter_mut().for_each(|face| face.rotate_left(1));
    drawn
}

/// Returns copies of faces, moved by a lattice vector; vertices that exist there already are used again.
fn moved(drawn: &mut Drawing, faces: std::ops::Range<usize>, by: Vec3) -> Vec<Vec<usize>> {
    let mut copies = drawn.faces[faces].to_vec();
    for vertex in copies.iter_mut().flatten() {
        let place = drawn.coords[*vertex] + by;
        let known = drawn.coords.iter().position(|p| (p - place).norm() <= 1e-9);
        *vertex = known.unwrap_or_else(|| {
            drawn.coords.push(place);
            drawn.coords.len() - 1
        });
    }
    copies
}

fn shifted(mut drawn: Drawing) -> Drawing {
    let half = drawn.faces.len() / 2;
    let [along, _] = drawn.lattice.unwrap();
    let copies = moved(&mut drawn, 0..half, along);
    drawn.faces.splice(0..half, copies);
    without_unused(drawn)
}

/// Removes the vertices that belong to no face.
fn without_unused(mut drawn: Drawing) -> Drawing {
    let mut numbers = vec![None; drawn.coords.len()];
    let mut coords = Vec::new();
    for vertex in drawn.faces.iter_mut().flatten() {
        let number = numbers[*vertex].get_or_insert_with(|| {
            coords.push(drawn.coords[*vertex]);
            coords.len() - 1
        });
        *vertex = *number;
    }
    Drawing { coords, ..drawn }
}

fn doubled(mut drawn: Drawing) -> Drawing {
    let [along, across] = drawn.lattice.unwrap();
    let all = 0..drawn.faces.len();
    let copies = moved(&mut drawn, all, along);
    drawn.faces.extend(copies);
    drawn.lattice = Some([2.0 * along, across]);
    drawn
}
