//! The step from a drawn mesh to a sheet: one builder and one set of checks for all file formats and generators.
//!
//! Vertices are identified by lattice vectors (`identify`); faces become polygons of the cell (`faces`), which are
//! separated along cuts (`cuts`) and split into triangles (`split`); then edges get their hinges (`edges`, `hinges`),
//! assignments (`assign`) and target angles (`targets`).

mod assign;
mod cuts;
mod draw;
mod drawing;
mod edges;
mod faces;
mod hinges;
mod identify;
pub(crate) mod planar;
mod rebuild;
mod split;
mod targets;

use super::cell::Sheet;
use super::error::{Defect, MeshPart, MeshProblem};
use super::memory::free_memory;
use crate::math::Vec3;
pub(crate) use assign::edges_by_drawn_name;
pub use draw::draw;
pub use drawing::{Drawing, GluedEdge};
pub(crate) use faces::{listed_order, sides as drawn_sides};
pub(crate) use identify::{Identified, check_places, coincident, merged};
pub(crate) use rebuild::rebuild_faces;

/// Bytes for each vertex while a sheet is made: its faces, edges and their names. Measured: 2,300 in FOLD files of
/// triangles and of polygons.
const BYTES_OF_VERTEX: f64 = 2_000.0;
/// Number of vertices from which on the memory is asked for: 20 MB.
const MANY_VERTICES: usize = 10_000;

/// Builds the sheet that `drawn` draws.
///
/// # Errors
/// [`Defect`] with the vertex, face, edge or opening that is wrong; see [`MeshProblem`] for all of them.
pub fn build(drawn: &Drawing) -> Result<Sheet, Defect> {
    build_identified(drawn).map(|(sheet, _)| sheet)
}

/// Does the same as [`build`], and also returns the corner of the cell that each drawn vertex represents.
pub(crate) fn build_identified(drawn: &Drawing) -> Result<(Sheet, Identified), Defect> {
    check_numbers(drawn)?;
    let mut identified = identify::identify(drawn)?;
    faces::check(drawn, &identified)?;
    if drawn.planar && !drawn.folded && sides_seen(drawn) != [true; 2] {
        planar::check_crossings(drawn, &faces::sides(drawn))?;
    }
    let mut polygons: Vec<_> = drawn.faces.iter().map(|face| identified.corners(face)).collect();
    let holes: Vec<_> = drawn.holes.iter().map(|hole| identified.corners(hole)).collect();
    let named = |(name, list): (&String, &Vec<usize>)| (name.clone(), identified.corners(list));
    let names = drawn.names.iter().map(named).collect();
    let cut_from = cuts::cut(drawn, &mut identified, &mut polygons)?;
    let sides = edges::sides(drawn, &polygons)?;
    edges::check_rims(drawn, &sides, &holes)?;
    let parts = split::triangles(drawn, &identified, &polygons)?;
    let glue = edges::glue(drawn, &identified, &sides)?;
    let edges = edges::with_wings(drawn, &identified, (&sides, &glue), &parts)?;
    let triangles = parts.into_iter().map(|part| part.triangle).collect();
    let mut sheet = Sheet {
        title: drawn.title.clone(),
        description: drawn.description.clone(),
        vertices: identified.homes.iter().map(|&v| drawn.coords[v]).collect(),
        lattice: drawn.lattice,
        screws: drawn.screws,
        polygons,
        triangles,
        edges,
        holes,
        cut_from,
        names,
        glue,
        ..Sheet::default()
    };
    assign::assign(drawn, &identified, &mut sheet)?;
    targets::keep(drawn, &identified, &mut sheet)?;
    cuts::check_fans(drawn, &identified, &sheet.polygons)?;
    Ok((sheet, identified))
}

/// Whether a plane drawing shows faces from above, and faces from below. Where it shows both it is a sheet that is folded
/// flat, whose layers lie on each other.
pub(crate) fn sides_seen(drawn: &Drawing) -> [bool; 2] {
    let areas: Vec<f64> = drawn.faces.iter().map(|face| planar::area(&drawn.coords, face)).collect();
    [areas.iter().any(|area| *area > 0.0), areas.iter().any(|area| *area < 0.0)]
}

/// Checks that there are vertices and faces, that coordinates are finite, and that the lattice spans an area.
fn check_numbers(drawn: &Drawing) -> Result<(), Defect> {
    if drawn.coords.is_empty() {
        return Err(Defect::new(MeshPart::Mesh, MeshProblem::Empty { what: "vertices" }));
    }
    check_memory(drawn.coords.len())?;
    for (v, x) in drawn.coords.iter().enumerate() {
        if let Some(&value) = x.iter().find(|c| !(0.0..=1e50).contains(&c.abs())) {
            return Err(Defect::new(MeshPart::Vertex(v), MeshProblem::Coordinate { vertex: drawn.name(v), value }));
        }
    }
    if drawn.faces.is_empty() && drawn.bars.is_empty() {
        return Err(Defect::new(MeshPart::Mesh, MeshProblem::Empty { what: "faces" }));
    }
    match (drawn.lattice, &drawn.screws) {
        (Some(lattice), _) => check_lattice(lattice),
        (None, Some(screws)) => check_lattice(screws.chords(&drawn.coords[0])),
        (None, None) if drawn.holes.is_empty() => Ok(()),
        (None, None) => Err(Defect::new(MeshPart::Hole(0), MeshProblem::HolesWithoutLattice)),
    }
}

/// Checks that a sheet of so many vertices fits the memory. What there is is not asked for small ones.
fn check_memory(vertices: usize) -> Result<(), Defect> {
    let needed = BYTES_OF_VERTEX * vertices as f64;
    let room = if vertices < MANY_VERTICES { f64::INFINITY } else { free_memory() };
    let too_large = MeshProblem::TooLarge(vertices, needed / 1e9, room / 1e9);
    if needed <= room { Ok(()) } else { Err(Defect::new(MeshPart::Mesh, too_large)) }
}

fn check_lattice([l1, l2]: [Vec3; 2]) -> Result<(), Defect> {
    let lengths = [l1.norm(), l2.norm()];
    let area = l1.cross(&l2).norm();
    let good = lengths.iter().all(|l| (1e-50..=1e50).contains(l)) && area > 1e-6 * lengths[0] * lengths[1];
    if good { Ok(()) } else { Err(Defect::new(MeshPart::Lattice, MeshProblem::Lattice { area, lengths })) }
}
