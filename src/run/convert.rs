//! Meshes of VTU files, and the parts of a mesh file that a conversion does not keep.

use std::collections::BTreeSet;

use crate::output::picture::Picture;
use crate::output::vtk::VtuMesh;
use crate::sheet::build::{self, Drawing};
use crate::sheet::info::{TURNED_OVER, remarks};
use crate::sheet::{Assignment, Edge, EdgeKind, Sheet};

/// Largest magnitude of a fold angle, in radians, at which a mountain or valley may be drawn on the other side.
const FLAT_RAD: f64 = 1e-6;

/// Returns the mesh of a VTU file as a drawing. Lines that are assigned J are diagonals of polygons and become facets;
/// a mountain or valley that the state has folded to the other side is what the state shows.
pub(super) fn drawing(mesh: VtuMesh, title: String) -> Drawing {
    let sorted = |[a, b]: [usize; 2]| [a.min(b), a.max(b)];
    let sides = |face: &[usize]| -> Vec<[usize; 2]> {
        (0..face.len()).map(|k| sorted([face[k], face[(k + 1) % face.len()]])).collect()
    };
    let triangles = mesh.triangles.iter().flat_map(|corners| sides(corners));
    let sides: BTreeSet<[usize; 2]> = triangles.chain(mesh.polygons.iter().flat_map(|face| sides(face))).collect();
    let letters = mesh.letters.unwrap_or_default();
    let angles = mesh.fold_angle.unwrap_or_else(|| vec![0.0; letters.len()]);
    let told = mesh.lines.iter().zip(letters).zip(angles).filter_map(|((ends, letter), angle)| {
        let contrary = match letter {
            Assignment::Mountain => angle > FLAT_RAD,
            Assignment::Valley => angle < -FLAT_RAD,
            Assignment::Boundary => true,
            _ => false,
        };
        (!contrary && sides.contains(&sorted(*ends))).then_some((*ends, letter))
    });
    Drawing {
        title,
        assignments: told.collect(),
        coords: mesh.points,
        faces: mesh.triangles.iter().map(|t| t.to_vec()).chain(mesh.polygons).collect(),
        ..Drawing::default()
    }
}

/// Returns a sentence for each part of the file of `sheet` that a file of this ending does not keep.
pub(super) fn not_kept(sheet: &Sheet, ending: &str) -> Vec<String> {
    let mut notes = Vec::new();
    let (is_fold, name) = (ending == "fold", ending.to_uppercase());
    let frames = sheet.record.further_frames;
    if frames > 0 && (!is_fold || sheet.record.frames.is_none()) {
        let (frames, are) =
            if frames == 1 { ("1 other frame".into(), "is") } else { (format!("{frames} other frames"), "are") };
        notes.push(format!("{frames} in `file_frames` {are} not kept, only frame {} is", sheet.record.frame));
    }
    if sheet.record.turned_over {
        notes.push(TURNED_OVER.to_owned());
    }
    notes.extend(remarks(sheet));
    if ending == "obj" && !sheet.listed_edges.is_empty() {
        notes.push("OBJ has no list of edges: their order is not kept".to_owned());
    }
    if !sheet.record.left_out.is_empty() {
        notes.push(format!("not kept: {}", quoted(sheet.record.left_out.iter())));
    }
    if !["fold", "obj"].contains(&ending) && !sheet.record.metadata.is_empty() {
        notes.push(format!("not kept: {}", quoted(sheet.record.metadata.iter().map(|(key, _)| key))));
    }
    if ["vtu", "stl", "ply", "glb"].contains(&ending) && !sheet.targets.is_empty() {
        notes.push(format!(
            "{name} has no target angles: {} that are not drawn are not kept",
            sheet.targets_not_drawn()
        ));
    }
    let partial = partly_folded(sheet);
    if ["cp", "dxf"].contains(&ending) && partial > 0 {
        notes.push(format!("{name} has no target angles: {partial} that are not those of a flat fold are not kept"));
    }
    if ["stl", "ply", "glb"].contains(&ending) && (sheet.lattice.is_some() || !sheet.assignments.is_empty()) {
        notes.push(format!("{name} has faces only: lattice vectors and letters of edges are not kept"));
    }
    if ending == "vtu" && sheet.lattice.is_some() {
        let again = build::build(&drawing(mesh(Picture::drawn(sheet)), String::new()));
        let unread = again.err().map_or(String::new(), |defect| {
            format!("; it cannot be read as such, since with its own edges alone {}", defect.problem)
        });
        notes.push(format!("VTU has no lattice vectors: the cell is written as a finite sheet{unread}"));
    }
    if !is_fold && sheet.screws.is_some() {
        notes.push("the screw motions that repeat the cell are not kept: FOLD alone has a place for them".to_owned());
    }
    let bars_alone = sheet.bars_alone().count();
    if !is_fold && bars_alone > 0 {
        notes.push(format!("{bars_alone} edges without faces are not kept: FOLD alone has a place for them"));
    }
    if !is_fold && !sheet.glue.is_empty() {
        notes.push(
            "what joins the faces of edges of more than two is not kept: FOLD alone has a place for it".to_owned(),
        );
    }
    let stiffnesses = sheet.stiffness.hinges.len() + sheet.stiffness.bars.len();
    if !is_fold && stiffnesses > 0 {
        notes.push(format!("{stiffnesses} stiffnesses of edges are not kept: FOLD alone has a place for them"));
    }
    notes
}

/// Returns the mesh of the file of a picture, without the points that belong to no face.
pub(super) fn mesh(picture: Picture) -> VtuMesh {
    let Picture { mut points, mut triangles, mut lines, fold_angle, letters, .. } = picture;
    let mut number = vec![None; points.len()];
    triangles.iter().flatten().for_each(|&point| number[point] = Some(0));
    number.iter_mut().flatten().enumerate().for_each(|(k, number)| *number = k);
    let mut is_used = number.iter().map(Option::is_some);
    points.retain(|_| is_used.next().unwrap_or_default());
    // the ends of lines that are no sides are beyond the points, and are not looked at
    let renumbered = |point: &mut usize| *point = number[*point].unwrap_or(usize::MAX);
    triangles.iter_mut().flatten().chain(lines.iter_mut().flatten()).for_each(renumbered);
    VtuMesh { points, triangles, lines, fold_angle: Some(fold_angle), letters: Some(letters), ..VtuMesh::default() }
}

/// Returns the number of creases whose target angle is not that of their letter in a flat fold.
fn partly_folded(sheet: &Sheet) -> usize {
    let is_partial = |edge: &&Edge| match (sheet.targets.get(&edge.key), sheet.assignment(edge).flat_folded_angle()) {
        (Some(target), Some(folded)) => (target - folded).abs() > FLAT_RAD,
        (Some(target), None) => *target != 0.0,
        (None, _) => false,
    };
    sheet.edges.iter().filter(|edge| edge.kind == EdgeKind::Crease).filter(is_partial).count()
}

fn quoted<'k>(keys: impl Iterator<Item = &'k String>) -> String {
    keys.map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ")
}
