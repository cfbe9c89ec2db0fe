//! Meshes of VTU files, and the parts of a mesh file that a conversion does not keep.

use crate::output::picture::Picture;
use crate::output::vtk::VtuMesh;
use crate::sheet::build::{self, Drawing};
use crate::sheet::info::{TURNED_OVER, remarks};
use crate::sheet::sides::{sorted, uses_of_sides};
use crate::sheet::{Assignment, Edge, EdgeKind, Sheet};

/// Largest magnitude of a fold angle, in radians, at which a mountain or valley may be drawn on the other side.
const FLAT_RAD: f64 = 1e-6;

/// Returns the mesh of a VTU file as a drawing. Lines that are assigned J are diagonals of polygons and become facets;
/// a mountain or valley that the state has folded to the other side is what the state shows.
pub(super) fn drawing(mesh: VtuMesh, title: String) -> Drawing {
    let faces: Vec<Vec<usize>> = mesh.triangles.iter().map(|t| t.to_vec()).chain(mesh.polygons).collect();
    let sides = uses_of_sides(&faces);
    let letters = mesh.letters.unwrap_or_default();
    let angles = mesh.fold_angle.unwrap_or_else(|| vec![0.0; letters.len()]);
    let told = mesh.lines.iter().zip(letters).zip(angles).filter_map(|((ends, letter), angle)| {
        let contrary = match letter {
            Assignment::Mountain => angle > FLAT_RAD,
            Assignment::Valley => angle < -FLAT_RAD,
            Assignment::Boundary => true,
            _ => false,
        };
        (!contrary && sides.contains_key(&sorted(*ends))).then_some((*ends, letter))
    });
    Drawing { title, assignments: told.collect(), coords: mesh.points, faces, ..Drawing::default() }
}

/// Returns a sentence for each part of the file of `sheet` that a file of this ending does not keep.
pub(super) fn not_kept(sheet: &Sheet, ending: &str) -> Vec<String> {
    let (is_fold, name, record) = (ending == "fold", ending.to_uppercase(), &sheet.record);
    let (partial, frames) = (partly_folded(sheet), record.further_frames);
    let other_frames = || {
        let (frames, are) =
            if frames == 1 { ("1 other frame".into(), "is") } else { (format!("{frames} other frames"), "are") };
        format!("{frames} in `file_frames` {are} not kept, only frame {} is", record.frame)
    };
    let unread = || {
        let again = build::build(&drawing(mesh(Picture::drawn(sheet)), String::new()));
        again.err().map_or(String::new(), |defect| {
            format!("; it cannot be read as such, since with its own edges alone {}", defect.problem)
        })
    };
    let (bars_alone, stiffnesses) =
        (sheet.bars_alone().count(), sheet.stiffness.hinges.len() + sheet.stiffness.bars.len());
    let fold_alone = |has: bool, what: String, them: &str| {
        (has && !is_fold).then(|| format!("{what} not kept: FOLD alone has a place for {them}"))
    };
    let of_source = [
        (frames > 0 && (!is_fold || record.frames.is_none())).then(other_frames),
        record.turned_over.then(|| TURNED_OVER.to_owned()),
    ];
    let of_ending = [
        (ending == "obj" && !sheet.listed_edges.is_empty())
            .then(|| "OBJ has no list of edges: their order is not kept".to_owned()),
        (!record.left_out.is_empty()).then(|| format!("not kept: {}", quoted(record.left_out.iter()))),
        (!["fold", "obj"].contains(&ending) && !record.metadata.is_empty())
            .then(|| format!("not kept: {}", quoted(record.metadata.iter().map(|(key, _)| key)))),
        (["vtu", "stl", "ply", "glb"].contains(&ending) && !sheet.targets.is_empty()).then(|| {
            format!("{name} has no target angles: {} that are not drawn are not kept", sheet.targets_not_drawn())
        }),
        (["cp", "dxf"].contains(&ending) && partial > 0)
            .then(|| format!("{name} has no target angles: {partial} that are not those of a flat fold are not kept")),
        (["stl", "ply", "glb"].contains(&ending) && (sheet.lattice.is_some() || !sheet.assignments.is_empty()))
            .then(|| format!("{name} has faces only: lattice vectors and letters of edges are not kept")),
        (ending == "vtu" && sheet.lattice.is_some())
            .then(|| format!("VTU has no lattice vectors: the cell is written as a finite sheet{}", unread())),
        fold_alone(sheet.screws.is_some(), "the screw motions that repeat the cell are".to_owned(), "them"),
        fold_alone(bars_alone > 0, format!("{bars_alone} edges without faces are"), "them"),
        fold_alone(!sheet.glue.is_empty(), "what joins the faces of edges of more than two is".to_owned(), "it"),
        fold_alone(stiffnesses > 0, format!("{stiffnesses} stiffnesses of edges are"), "them"),
    ];
    of_source.into_iter().flatten().chain(remarks(sheet)).chain(of_ending.into_iter().flatten()).collect()
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
