//! The fold angles that a file gives its edges: the drawn ones, or targets of folding.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::assign::{edges_by_drawn_name, with_one_hinge};
use super::{Defect, Drawing, Identified, MeshPart, MeshProblem};
use crate::sheet::assigned::is_same_angle;
use crate::sheet::assignment::Assignment;
use crate::sheet::cell::{Edge, EdgeKey, EdgeKind, Sheet, is_folded_flat};
use crate::sheet::error::DrawnEdge;

/// Keeps the fold angles of the file as targets if some of them are not the drawn ones; otherwise they say nothing that
/// the drawing does not. An angle that is not drawn has to be between -pi and pi, and on the side of its edge's letter.
/// An edge without a letter whose target is on the other side than its drawing takes the letter of its target.
pub(super) fn keep(drawn: &Drawing, identified: &Identified, sheet: &mut Sheet) -> Result<(), Defect> {
    if drawn.fold_angles.is_empty() {
        return Ok(());
    }
    let (known, letters) = (edges_by_drawn_name(sheet), letters(drawn, identified));
    let mut targets: BTreeMap<EdgeKey, f64> = BTreeMap::new();
    let mut letters_of_targets = Vec::new();
    let mut all_drawn = true;
    for (e, &(ends, angle)) in drawn.fold_angles.iter().enumerate() {
        let Some(angle) = angle else { continue };
        let [a, b] = ends.map(|v| identified.corner[v]);
        let (name, _) = EdgeKey::new(a, b);
        let numbers = known.get(&name).map(Vec::as_slice).unwrap_or_default();
        let named = (e, drawn.edge_name(ends));
        if numbers.is_empty() {
            return Err(Defect::new(MeshPart::Edge(e), MeshProblem::LooseEdge { edge: e, ends: named.1 }));
        }
        let refused = |problem: MeshProblem| Defect::new(MeshPart::FoldAngle(e), problem);
        for edge in with_one_hinge(sheet, numbers).iter().map(|&number| &sheet.edges[number]) {
            let is_drawn = is_drawn(sheet, edge, angle);
            if let Some(fault) = fault(named, letters.get(&name).copied(), angle, is_drawn) {
                return Err(refused(fault));
            }
            let before = targets.insert(edge.key, angle).filter(|before| !is_same_angle(*before, angle));
            if let Some(before) = before {
                let [given, before] = [angle, before].map(f64::to_degrees);
                return Err(refused(MeshProblem::AngleOfCopies { edge: e, ends: named.1, given, before }));
            }
            all_drawn &= is_drawn;
            if !letters.contains_key(&name) && is_other_side(sheet.drawn_assignment(edge), angle) {
                letters_of_targets.push((edge.key, Assignment::of_side(angle)));
            }
        }
    }
    if !all_drawn {
        sheet.targets = targets;
        sheet.assignments.extend(letters_of_targets);
    }
    Ok(())
}

/// Returns the letters of the file by the names of the edges.
fn letters(drawn: &Drawing, identified: &Identified) -> BTreeMap<EdgeKey, Assignment> {
    let named = drawn.assignments.iter().map(|(ends, letter)| (ends.map(|v| identified.corner[v]), *letter));
    named.map(|([a, b], letter)| (EdgeKey::new(a, b).0, letter)).collect()
}

/// Whether an angle is the drawn one; what a file says about an edge of one face has no meaning. Of an edge folded flat
/// without a letter, the drawing does not show the side, so that an angle on the other side is kept.
fn is_drawn(sheet: &Sheet, edge: &Edge, angle: f64) -> bool {
    let drawn = sheet.drawn_angle(edge).unwrap_or(0.0);
    let other_side = is_folded_flat(drawn) && is_folded_flat(angle) && drawn * angle < 0.0;
    edge.kind == EdgeKind::Boundary || (is_same_angle(angle, drawn) && !other_side)
}

/// Returns the reason for which an edge cannot have this angle.
fn fault(
    (edge, ends): (usize, DrawnEdge),
    letter: Option<Assignment>,
    angle: f64,
    is_drawn: bool,
) -> Option<MeshProblem> {
    let given = angle.to_degrees();
    match letter {
        _ if !is_within_a_turn(angle) && !is_drawn => Some(MeshProblem::AngleRange { edge, ends, given }),
        Some(letter) if is_other_side(letter, angle) => Some(MeshProblem::AngleOtherSide { edge, ends, letter, given }),
        _ => None,
    }
}

/// Whether an angle contradicts a letter: a valley below zero, or a mountain above it.
fn is_other_side(letter: Assignment, angle: f64) -> bool {
    let contradicts = match letter {
        Assignment::Mountain => angle > 0.0,
        Assignment::Valley => angle < 0.0,
        _ => false,
    };
    contradicts && !is_same_angle(angle, 0.0) && is_within_a_turn(angle)
}

fn is_within_a_turn(angle: f64) -> bool {
    angle.abs() <= PI || is_same_angle(angle.abs(), PI)
}
