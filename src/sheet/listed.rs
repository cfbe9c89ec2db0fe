//! Drawings with a list of edges, as FOLD files and arrays have it.

use std::collections::{BTreeMap, BTreeSet};

use super::assigned::is_same_angle;
use super::assignment::Assignment;
use super::build::{Drawing, Identified, build, build_identified, drawn_sides, edges_by_drawn_name, listed_order};
use super::cell::{Corner, EdgeKey, Sheet, is_folded_flat};
use super::error::{Defect, DrawnEdge, MeshPart, MeshProblem};
use super::sides::{self, sorted};

/// Builds the sheet that `drawn` draws, of which `listed` are edges in the order in which files list them. The faces
/// are turned over if the letters are those of the other side. Also returns the corner of the cell that each drawn
/// vertex represents.
pub(crate) fn build_listed(drawn: &Drawing, listed: &[[usize; 2]]) -> Result<(Sheet, Identified), Defect> {
    let turned = turned_over(drawn);
    let drawn = turned.as_ref().unwrap_or(drawn);
    let (mut sheet, identified) = build_identified(drawn)?;
    let (known, sides) = (edges_by_drawn_name(&sheet), sides(&sheet));
    let bars: BTreeSet<EdgeKey> = sheet.bars_alone().map(|edge| edge.key).collect();
    for (edge, ends) in listed.iter().enumerate() {
        let [a, b] = ends.map(|v| identified.corner[v]);
        let found = known.get(&EdgeKey::new(a, b).0).and_then(|numbers| numbers.first()).map(|&n| &sheet.edges[n]);
        if !found.is_some_and(|edge| sides.contains(&edge.key) || bars.contains(&edge.key)) {
            let problem = MeshProblem::LooseEdge { edge, ends: DrawnEdge(ends[0], ends[1]) };
            return Err(Defect::new(MeshPart::Edge(edge), problem));
        }
    }
    let order = listed_order(drawn, listed);
    sheet.listed_edges = order.into_iter().map(|ends| ends.map(|v| identified.corner[v])).collect();
    sheet.record.turned_over = turned.is_some();
    Ok((sheet, identified))
}

/// Builds a sheet of arrays as [`build_listed`] does, after a check of the numbers of vertices in the list of edges.
///
/// # Errors
/// As [`build`]; also for a wrong list of edges.
pub fn build_arrays(drawn: &Drawing, listed: &[[usize; 2]]) -> Result<Sheet, Defect> {
    let edge = |(edge, problem)| Defect::new(MeshPart::Edge(edge), problem);
    check_ends(listed, drawn.coords.len()).map_err(edge)?;
    let drawn = Drawing { bars: bars_alone(drawn, listed), ..drawn.clone() };
    build_listed(&drawn, listed).map(|(sheet, _)| sheet)
}

/// Checks that the ends of edges are two vertices of `count`, and that no edge is listed twice; the error names the
/// edge.
pub(crate) fn check_ends(ends: &[[usize; 2]], count: usize) -> Result<(), (usize, MeshProblem)> {
    let mut seen = BTreeMap::new();
    for (edge, &[a, b]) in ends.iter().enumerate() {
        if let Some(beyond) = [a, b].into_iter().find(|&v| v >= count) {
            let (what, last) = (format!("edge {edge} of the list"), count.saturating_sub(1));
            return Err((edge, MeshProblem::Index { what, found: beyond.to_string(), first: 0, last }));
        }
        if a == b {
            return Err((edge, MeshProblem::Loop { edge, vertex: a }));
        }
        if let Some(other) = seen.insert(sorted([a, b]), edge) {
            return Err((edge, MeshProblem::DuplicateEdge { edge, other, ends: DrawnEdge(a, b) }));
        }
    }
    Ok(())
}

/// Returns the listed edges that no face is drawn along: bars, as cables and struts are. In a flat drawing with faces
/// there are none: lines that are no sides are not to be carried by it.
pub(crate) fn bars_alone(drawn: &Drawing, listed: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let first = drawn.coords.first().map_or(0.0, |x| x.z);
    if !drawn.faces.is_empty() && drawn.coords.iter().all(|x| x.z == first) {
        return vec![];
    }
    let sides: BTreeSet<[usize; 2]> = drawn_sides(drawn).into_iter().map(|(ends, _)| sorted(ends)).collect();
    listed.iter().copied().filter(|ends| !sides.contains(&sorted(*ends))).collect()
}

/// Returns the edges that are sides, and not diagonals, of polygons.
fn sides(sheet: &Sheet) -> BTreeSet<EdgeKey> {
    let sides = sheet.polygons.iter().flat_map(|polygon| sides::sides(polygon));
    sides.map(|[a, b]| EdgeKey::new(a, b).0).collect()
}

/// Returns the mesh with all faces turned over if its letters are those of the other side: at least two creases are
/// drawn as mountains and valleys, and every one of them is drawn as the other one.
fn turned_over(drawn: &Drawing) -> Option<Drawing> {
    let folds = |letter| matches!(letter, Assignment::Mountain | Assignment::Valley);
    let letters: Vec<_> = drawn.assignments.iter().filter(|(_, letter)| folds(*letter)).collect();
    if drawn.is_repeated() || !drawn.fold_angles.is_empty() || letters.len() < 2 {
        return None;
    }
    let bare = Drawing { assignments: vec![], ..drawn.clone() };
    let sheet = build(&bare).ok()?;
    let known = edges_by_drawn_name(&sheet);
    let shown = letters.iter().filter_map(|(ends, letter)| {
        let [a, b] = ends.map(Corner::home);
        let edge = &sheet.edges[*known.get(&EdgeKey::new(a, b).0)?.first()?];
        let angle = sheet.drawn_angle(edge).filter(|angle| !is_folded_flat(*angle) && !is_same_angle(*angle, 0.0))?;
        Some((angle > 0.0) == (*letter == Assignment::Valley))
    });
    let agree: Vec<bool> = shown.collect();
    (agree.len() > 1 && agree.iter().all(|agrees| !agrees)).then(|| {
        let turn = |face: &Vec<usize>| face[..1].iter().chain(face[1..].iter().rev()).copied().collect();
        Drawing { faces: drawn.faces.iter().map(turn).collect(), ..drawn.clone() }
    })
}
