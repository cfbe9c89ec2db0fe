//! The same sheet in other words: turned, moved, mirrored, in other units, numbered and cut otherwise.

use super::super::experiment::{Bench, ExperimentError, Findings, Grid};
use super::super::report::figure;
use super::super::star;
use super::trial::{Rest, Trial};
use foldwell::math::Vec3;
use foldwell::model::Boundary;
use foldwell::numerics::{larger, worst};
use foldwell::sheet::build::{Drawing, build, draw};
use nalgebra::Rotation3;
use serde_json::json;

/// Largest offset of a rest angle, and the stiffness of the bars.
const OFF: f64 = 0.05;
const BARS: f64 = 1e6;
/// Factor from a unit of length to the other one.
const UNIT: f64 = 1000.0;

/// A way to draw the same sheet.
struct Change {
    name: &'static str,
    /// The other drawing.
    draw: fn(Drawing) -> Drawing,
    /// Whether patches of the other cell are the same patches.
    keeps_patches: bool,
    /// How often each crease of the sheet occurs in the other cell, the unit of energy, and the sign of its fold angles.
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
    // EA and torque per length as before: energies of both grow as the unit
    Change { name: "unit 1000 times smaller", draw: |drawn| mapped(drawn, |p| p * UNIT, true), energy: UNIT, ..SAME },
    // the first copy of a vertex in the file says in which cell it is: patches have other rims
    Change { name: "vertices numbered backwards", draw: renumbered, keeps_patches: false, ..SAME },
    Change { name: "faces listed backwards", draw: relisted, ..SAME },
    Change { name: "another cell: half of the faces one cell further", draw: shifted, keeps_patches: false, ..SAME },
    Change { name: "a cell twice as large", draw: doubled, keeps_patches: false, times: 2, energy: 2.0, ..SAME },
];

/// Fold angles in ascending order and energy of the relaxed sheet.
type Spectrum = (Vec<f64>, f64);

/// Relaxes the reference cell in all these drawings, as a patch of 3 x 3 cells, on a torus with a free lattice and on a screw. Rest angles
/// depend on the lengths of the edges, which no drawing changes; so the fold angles, in ascending order, and the energy
/// must be the same.
pub fn measure(bench: &Bench) -> Result<Findings, ExperimentError> {
    let (mut rows, mut worst) = (Vec::new(), [f64::NEG_INFINITY; 2]);
    let domains = [
        ("patch of 3 x 3 cells", Boundary::Patch, [3, 3]),
        ("torus", Boundary::FreeTorus, [1, 1]),
        ("screw", Boundary::Screw, [1, 1]),
    ];
    for (step, (domain, boundary, cells)) in domains.into_iter().enumerate() {
        bench.step(step, domains.len())?;
        let expected = spectrum(&SAME, boundary, cells)?;
        for change in CHANGES.iter().filter(|change| change.keeps_patches || boundary != Boundary::Patch) {
            let off = difference(&spectrum(change, boundary, cells)?, &expected, change);
            worst = [larger(worst[0], off[0]), larger(worst[1], off[1])];
            rows.push(vec![change.name.to_owned(), domain.to_owned(), figure(off[0]), figure(off[1])]);
        }
    }
    let values = json!({ "angles": worst[0], "energy": worst[1], "drawings": rows.len() });
    let header = ["drawing", "domain", "difference of fold angles (rad)", "relative difference of energy"];
    let title = "The same sheet in other words".into();
    let tables = vec![Grid { title, header: header.map(str::to_owned).to_vec(), rows }];
    Ok(Findings { values, tables, ..Findings::default() })
}

fn spectrum(change: &Change, boundary: Boundary, cells: [usize; 2]) -> Result<Spectrum, ExperimentError> {
    let drawn = (change.draw)(draw(&star::cell()?));
    let sheet = build(&drawn).map_err(|_| ExperimentError::Other(format!("{}: no sheet", change.name)))?;
    let (stiffness, rest) = ([BARS, 1.0], Rest::ByLength(change.sign * OFF));
    let trial = Trial { sheet, cells, boundary, stiffness, rest, lock: None };
    let found = trial.run().map_err(|why| ExperimentError::Other(format!("{}, {boundary:?}: {why}", change.name)))?;
    let mut angles: Vec<f64> = found.angles.iter().filter(|a| !a.is_nan()).map(|a| change.sign * a).collect();
    angles.sort_by(f64::total_cmp);
    Ok((angles, found.energy))
}

/// Largest difference of a fold angle, and the relative one of the energy; infinite where the counts differ, or there is none.
fn difference((angles, energy): &Spectrum, (expected, there): &Spectrum, change: &Change) -> [f64; 2] {
    let every: Vec<f64> = expected.iter().flat_map(|angle| vec![*angle; change.times]).collect();
    let off = worst(angles.iter().zip(&every).map(|(a, b)| (a - b).abs()));
    let off = off.filter(|_| angles.len() == every.len()).unwrap_or(f64::INFINITY);
    [off, (energy / there / change.energy - 1.0).abs()]
}

/// All points mapped; lattice vectors too where the map has a fixed origin.
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

/// Copies of faces, moved by a lattice vector; vertices that are drawn there already are used again.
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
    if let Some([along, _]) = drawn.lattice {
        let copies = moved(&mut drawn, 0..half, along);
        drawn.faces.splice(0..half, copies);
    }
    without_unused(drawn)
}

/// Without the vertices that no face has.
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
    if let Some([along, across]) = drawn.lattice {
        let copies = {
            let all = 0..drawn.faces.len();
            moved(&mut drawn, all, along)
        };
        drawn.faces.extend(copies);
        drawn.lattice = Some([2.0 * along, across]);
    }
    drawn
}
