//! Checks the assignments of edges against the mesh and stores them in the sheet.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

use super::{Defect, Drawing, Identified, MeshPart, MeshProblem};
use crate::sheet::assignment::Assignment;
use crate::sheet::cell::{Edge, EdgeKey, EdgeKind, Sheet};
use crate::sheet::sides::{sorted, uses_of_sides};

/// Least distance in degrees of a fold angle from 0 and from 180 at which it is a mountain or a valley.
const SIDE_TOLERANCE: f64 = 1e-3;

/// Applies the assignments of the file to the edges of `sheet`: joined parts of a polygon become facets, assignments
/// that contradict the mesh are refused, and those that the drawing alone would not give are stored.
pub(super) fn assign(drawn: &Drawing, identified: &Identified, sheet: &mut Sheet) -> Result<(), Defect> {
    if drawn.assignments.is_empty() {
        return Ok(());
    }
    let known = edges_by_drawn_name(sheet);
    let (faces, targets) = (uses_of_sides(&drawn.faces), targets(drawn));
    for (e, &(ends, assignment)) in drawn.assignments.iter().enumerate() {
        let [a, b] = ends.map(|v| identified.corner[v]);
        let numbers = known.get(&EdgeKey::new(a, b).0).map(Vec::as_slice).unwrap_or_default();
        // a weld between faces is an edge of the list, as a diagonal is not
        let is_diagonal = |edge: &Edge| edge.kind == EdgeKind::Facet && !sheet.glue.contains_key(&edge.key.whole());
        let diagonal = numbers.iter().any(|&number| is_diagonal(&sheet.edges[number]));
        if numbers.is_empty() || (diagonal && assignment != Assignment::Join) {
            return Err(Defect::new(
                MeshPart::Edge(e),
                MeshProblem::LooseEdge { edge: e, ends: drawn.edge_name(ends) },
            ));
        }
        for &number in with_one_hinge(sheet, numbers) {
            if assignment == Assignment::Join && sheet.edges[number].kind == EdgeKind::Crease {
                sheet.edges[number].kind = EdgeKind::Facet;
            }
            let edge = &sheet.edges[number];
            // the outline of the drawn cell is not a boundary of a periodic sheet
            if assignment == Assignment::Boundary && faces.get(&sorted(ends)) == Some(&1) && drawn.is_repeated() {
                continue;
            }
            // a simulator folds some creases to the other side, or the whole pattern backwards
            let is_aimed = targets.contains(&(sorted(ends), assignment));
            let found = fault(sheet, edge, (e, drawn.edge_name(ends)), assignment);
            if let Some(problem) =
                found.filter(|problem| !(is_aimed && matches!(problem, MeshProblem::OtherSide { .. })))
            {
                return Err(Defect::new(MeshPart::Edge(e), problem));
            }
            let (key, shown) = (edge.key, sheet.drawn_assignment(edge));
            if assignment != shown {
                sheet.assignments.insert(key, assignment);
            }
        }
    }
    Ok(())
}

/// Returns the drawn edges with a target angle that is not zero, each with the letter of its side. An angle beyond pi
/// is no target: it is a drawn one and a full turn, on the other side.
fn targets(drawn: &Drawing) -> BTreeSet<([usize; 2], Assignment)> {
    let side = |(ends, angle): &([usize; 2], Option<f64>)| {
        let angle = angle.filter(|angle| *angle != 0.0 && angle.abs() <= PI)?;
        Some((sorted(*ends), Assignment::of_side(angle)))
    };
    drawn.fold_angles.iter().filter_map(side).collect()
}

fn fault(
    sheet: &Sheet,
    found: &Edge,
    (edge, ends): (usize, crate::sheet::error::DrawnEdge),
    assignment: Assignment,
) -> Option<MeshProblem> {
    let drawn = sheet.drawn_angle(found).unwrap_or(0.0).to_degrees();
    let folded = drawn.abs() > SIDE_TOLERANCE && drawn.abs() < 180.0 - SIDE_TOLERANCE;
    match (assignment, found.kind) {
        (Assignment::Boundary, EdgeKind::Crease | EdgeKind::Facet) => Some(MeshProblem::BoundaryInside { edge, ends }),
        (Assignment::Join, EdgeKind::Boundary) => Some(MeshProblem::JoinAtRim { edge, ends }),
        (Assignment::Mountain | Assignment::Valley, EdgeKind::Crease)
            if folded && assignment != Assignment::of_side(drawn) =>
        {
            Some(MeshProblem::OtherSide { edge, ends, letter: assignment, drawn })
        }
        _ => None,
    }
}

/// Returns these numbers of edges if each has one hinge at most: a letter or an angle says nothing of an edge of more
/// than two faces.
pub(super) fn with_one_hinge<'n>(sheet: &Sheet, numbers: &'n [usize]) -> &'n [usize] {
    if numbers.iter().all(|&number| sheet.edges[number].key.has_bar()) { numbers } else { &[] }
}

/// Returns the numbers of the edges that each drawn edge has become, keyed by the edge's name before the sheet was
/// cut.
pub(crate) fn edges_by_drawn_name(sheet: &Sheet) -> BTreeMap<EdgeKey, Vec<usize>> {
    let mut known: BTreeMap<EdgeKey, Vec<usize>> = BTreeMap::new();
    for (number, edge) in sheet.edges.iter().enumerate() {
        let [i, j] = edge.key.ends().map(|end| sheet.uncut(end));
        known.entry(EdgeKey::new(i, j).0).or_default().push(number);
    }
    known
}
