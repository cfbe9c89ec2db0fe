//! The parts of a mesh file that a conversion does not keep.

use super::MeshKind;
use crate::sheet::{EdgeKind, Sheet};

/// Returns a sentence for each part of the file of `sheet` that is not in the new file.
pub(super) fn not_kept(sheet: &Sheet, from: Option<MeshKind>, to: Option<MeshKind>) -> Vec<String> {
    let mut notes = Vec::new();
    match sheet.record.further_frames {
        0 => {}
        1 => notes.push("1 further frame in `file_frames` is not kept, only the first frame is read".to_owned()),
        count => {
            notes.push(format!("{count} further frames in `file_frames` are not kept, only the first frame is read"))
        }
    }
    if !sheet.record.left_out.is_empty() {
        notes.push(format!("not kept: {}", quoted(sheet.record.left_out.iter())));
    }
    if to == Some(MeshKind::Vtu) && !sheet.record.metadata.is_empty() {
        notes.push(format!("not kept: {}", quoted(sheet.record.metadata.iter().map(|(key, _)| key))));
    }
    if to == Some(MeshKind::Vtu) && !sheet.assignments.is_empty() {
        let count = sheet.assignments.len();
        notes.push(format!("VTU has no letters for edges: {count} that the drawing does not show are not kept"));
    }
    if to == Some(MeshKind::Vtu) && !sheet.targets.is_empty() {
        notes.push(format!("VTU has no target angles: {} that are not drawn are not kept", sheet.targets_not_drawn()));
    }
    let stiffnesses = sheet.stiffness.hinges.len() + sheet.stiffness.bars.len();
    if to != Some(MeshKind::Fold) && stiffnesses > 0 {
        notes.push(format!("{stiffnesses} stiffnesses of edges are not kept: FOLD alone has a place for them"));
    }
    if from == Some(MeshKind::Vtu) && sheet.edges.iter().any(|edge| edge.kind == EdgeKind::Crease) {
        notes.push("VTU does not tell diagonals of polygons from creases: all edges are creases now".to_owned());
    }
    notes
}

fn quoted<'k>(keys: impl Iterator<Item = &'k String>) -> String {
    keys.map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ")
}
