//! Checks of single faces.

use std::collections::{BTreeMap, BTreeSet};

use super::planar::PlacedSide;
use super::{Defect, Drawing, Identified, MeshPart, MeshProblem};
use crate::sheet::cell::Corner;
use crate::sheet::sides::{self, sorted};

/// Checks that all corners exist, that no face has a vertex twice, that no face is drawn twice, and that every vertex
/// belongs to a face or to a bar.
pub(super) fn check(drawn: &Drawing, identified: &Identified) -> Result<(), Defect> {
    for (h, hole) in drawn.holes.iter().enumerate() {
        check_indices(drawn, hole, MeshPart::Hole(h), || format!("opening {h}"))?;
        if hole.len() < 3 {
            return Err(Defect::new(MeshPart::Hole(h), MeshProblem::SmallHole { hole: h, corners: hole.len() }));
        }
    }
    let mut seen: BTreeMap<Vec<Corner>, (usize, [i32; 2])> = BTreeMap::new();
    let mut used = vec![false; identified.homes.len()];
    for (f, face) in drawn.faces.iter().enumerate() {
        check_indices(drawn, face, MeshPart::Face(f), || format!("face {}", drawn.name(f)))?;
        check_corners(drawn, f, face)?;
        let (canonical, base) = canonical(&identified.corners(face));
        if let Some((other, there)) = seen.insert(canonical, (f, base)) {
            let cell = [base[0] - there[0], base[1] - there[1]];
            let problem = MeshProblem::DuplicateFace { face: drawn.name(f), other: drawn.name(other), cell };
            return Err(Defect::new(MeshPart::Face(f), problem));
        }
        face.iter().for_each(|&v| used[identified.corner[v].vertex] = true);
    }
    drawn.bars.iter().flatten().for_each(|&v| used[identified.corner[v].vertex] = true);
    let Some(unused) = used.iter().position(|&u| !u) else { return Ok(()) };
    let home = identified.homes[unused];
    Err(Defect::new(MeshPart::Vertex(home), MeshProblem::UnusedVertex { vertex: drawn.name(home) }))
}

fn check_indices(drawn: &Drawing, list: &[usize], place: MeshPart, what: impl Fn() -> String) -> Result<(), Defect> {
    let Some(&v) = list.iter().find(|&&v| v >= drawn.coords.len()) else { return Ok(()) };
    let (found, last) = (drawn.name(v).to_string(), drawn.name(drawn.coords.len() - 1));
    Err(Defect::new(place, MeshProblem::Index { what: what(), found, first: drawn.first, last }))
}

fn check_corners(drawn: &Drawing, f: usize, face: &[usize]) -> Result<(), Defect> {
    if face.len() < 3 {
        let problem = MeshProblem::FewCorners { face: drawn.name(f), corners: face.len() };
        return Err(Defect::new(MeshPart::Face(f), problem));
    }
    let mut seen = BTreeSet::new();
    let Some(&v) = face.iter().find(|&&v| !seen.insert(v)) else { return Ok(()) };
    Err(Defect::new(MeshPart::Face(f), MeshProblem::RepeatedVertex { face: drawn.name(f), vertex: drawn.name(v) }))
}

/// Returns the sorted corners, translated so that one of the lowest vertices is in cell (0, 0), and the cell from
/// which they were translated. The result is the same for every copy, every first corner and both directions of a
/// face.
fn canonical(corners: &[Corner]) -> (Vec<Corner>, [i32; 2]) {
    let lowest = corners.iter().map(|c| c.vertex).min().unwrap_or_default();
    let candidates = corners.iter().filter(|c| c.vertex == lowest).map(|base| {
        let back = [-base.shift[0], -base.shift[1]];
        let mut moved: Vec<_> = corners.iter().map(|c| c.translated(back)).collect();
        moved.sort_unstable();
        (moved, base.shift)
    });
    candidates.min().unwrap_or_default()
}

/// Returns the drawn sides of all faces, each once, in the order of the file.
pub(crate) fn sides(drawn: &Drawing) -> Vec<PlacedSide> {
    let mut seen = BTreeSet::new();
    let faces = drawn.faces.iter().enumerate();
    let all = faces.flat_map(|(f, face)| sides::sides(face).map(move |side| (side, MeshPart::Face(f))));
    all.filter(|(side, _)| seen.insert(sorted(*side))).collect()
}

/// Returns the listed edges, followed by the sides that are not listed; empty if that is the order of the sides.
pub(crate) fn listed_order(drawn: &Drawing, listed: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let sides: Vec<[usize; 2]> = sides(drawn).into_iter().map(|(ends, _)| ends).collect();
    let known: BTreeSet<[usize; 2]> = listed.iter().map(|ends| sorted(*ends)).collect();
    let others = sides.iter().filter(|ends| !known.contains(&sorted(**ends)));
    let order: Vec<[usize; 2]> = listed.iter().chain(others).copied().collect();
    if order == sides { vec![] } else { order }
}
