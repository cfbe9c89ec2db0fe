//! Remarks about a scene for the user: what is allowed, but may not be what was meant.

use super::SceneFile;
use super::rest::RestSpec;
use crate::model::Assembly;
use crate::sheet::info::{TURNED_OVER, frames_said, remarks, targets_said};
use crate::sheet::{Assignment, Edge, EdgeKind, Sheet};
use std::collections::BTreeSet;

/// Returns remarks about a scene, made before its studies.
pub(crate) fn notes(file: &SceneFile, assembly: &Assembly) -> Vec<String> {
    let mut notes = super::turns::notes(file, assembly.terms());
    notes.extend(one_angle_for_both_sides(file, assembly));
    notes.extend(unused_targets(file, assembly));
    if assembly.sheet().record.turned_over {
        notes.push(TURNED_OVER.to_owned());
    }
    notes.extend(assembled(assembly.sheet()));
    notes.extend(loose(assembly));
    if !assembly.sheet().is_repeated() && file.scene.sheet.cells.as_deref().is_some_and(|cells| cells.0 != [1, 1]) {
        notes.push("`cells` has no effect: the mesh is a finite sheet, which is not repeated".to_owned());
    }
    let [against, folded] = assembly.sheet().drawn_against_targets();
    if against > 0 {
        notes.push(format!(
            "{against} of {folded} folded creases are drawn on the other side than the target angles of the file; if it is \
             most of them, the pattern is folded backwards or its faces are listed clockwise"
        ));
    }
    let record = &assembly.sheet().record;
    notes.extend(remarks(assembly.sheet()));
    notes.extend(frames_said(record.frame, record.further_frames).filter(|_| file.scene.sheet.frame.is_none()));
    notes
}

/// Says what the faces of an edge of more than two, and edges of no face, are taken for.
fn assembled(sheet: &Sheet) -> Vec<String> {
    let is_joint = |edge: &&Edge| edge.key.round == 1 && !sheet.glue.contains_key(&edge.key.whole());
    let (joints, bars) = (sheet.edges.iter().filter(is_joint).count(), sheet.bars_alone().count());
    let said = format!(
        "edges of more than two faces: {joints}; every two neighbours round each fold on a hinge, unless `foldwell:glue` in \
         the mesh welds or frees them"
    );
    let alone = format!("edges of no face: {bars}; they are bars, as cables and struts");
    [(joints, said), (bars, alone)].into_iter().filter(|(count, _)| *count > 0).map(|(_, said)| said).collect()
}

/// Says that bars of a patch hang loose, whose polygons reach over its rim and are not there.
fn loose(assembly: &Assembly) -> Option<String> {
    let tiling = assembly.tiling();
    let mut is_on_face = vec![false; tiling.positions.len()];
    tiling.triangles.iter().flat_map(|triangle| triangle.corners).for_each(|corner| is_on_face[corner.vertex] = true);
    let ends: BTreeSet<usize> = tiling.edges.iter().flat_map(|edge| edge.ends).map(|end| end.vertex).collect();
    let count = ends.into_iter().filter(|vertex| !is_on_face[*vertex]).count();
    let cut = count > 0 && assembly.sheet().is_repeated() && assembly.sheet().bars_alone().next().is_none();
    cut.then(|| {
        format!(
            "vertices on no face: {count}; the polygons there reach over the rim of the patch and are left out, and their \
             bars hang loose"
        )
    })
}

/// Says that a single rest angle folds mountains and valleys to the same side. Only letters that the drawing does not
/// show count: a sheet that is drawn folded may well be meant to unfold or to fold back.
fn one_angle_for_both_sides(file: &SceneFile, assembly: &Assembly) -> Option<String> {
    let RestSpec::Angle(angle) = **file.scene.energy.rests()[0]? else { return None };
    let sheet = assembly.sheet();
    let creases = assembly.tiling().edges.iter().filter(|edge| edge.kind == EdgeKind::Crease);
    let letters: Vec<_> = creases.map(|tiled| sheet.assignments.get(&sheet.edges[tiled.edge].key)).collect();
    let count = |letter| letters.iter().filter(|found| **found == Some(&letter)).count();
    let [mountains, valleys] = [Assignment::Mountain, Assignment::Valley].map(count);
    let size = angle.radians.abs();
    (mountains > 0 && valleys > 0 && size > 0.0).then(|| {
        format!(
            "rest = {:?} is one angle for {mountains} mountains and {valleys} valleys, which then fold to the same \
             side; rest = {{ M = -{size:?}, V = {size:?} }} follows the letters",
            angle.radians
        )
    })
}

/// Says that the mesh has target angles that the energy does not use.
fn unused_targets(file: &SceneFile, assembly: &Assembly) -> Option<String> {
    let count = assembly.sheet().targets_not_drawn();
    let used = file.scene.energy.rests().into_iter().flatten().any(|rest| matches!(**rest, RestSpec::Target));
    (count > 0 && !used).then(|| targets_said(count))
}
