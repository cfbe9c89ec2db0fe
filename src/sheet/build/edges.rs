//! The edges of the cell: they are found along the polygons, checked for their faces, and given their wings.

use std::collections::BTreeMap;

use super::hinges;
use super::split::{SplitTriangle, position};
use super::{Defect, Drawing, Identified, MeshPart, MeshProblem};
use crate::math::pieces::pieces;
use crate::sheet::cell::{Corner, Edge, EdgeKey, EdgeKind, Glue, TriangleSide};
use crate::sheet::sides::sides as sides_of;

/// An edge along the polygons, and the polygons of which it is a side.
pub(super) struct Side {
    key: EdgeKey,
    /// The drawn vertices of its ends where it first appears.
    drawn: [usize; 2],
    /// Each polygon that has this side, and whether it runs from `j` to `i` there.
    uses: Vec<(usize, bool)>,
}

/// Returns the sides of polygons in order of first appearance. If a side belongs to two polygons they run along it in
/// opposite directions, unless their piece has one side only.
pub(super) fn sides(drawn: &Drawing, polygons: &[Vec<Corner>]) -> Result<Vec<Side>, Defect> {
    let mut numbers: BTreeMap<EdgeKey, usize> = BTreeMap::new();
    let mut sides: Vec<Side> = Vec::new();
    for (f, polygon) in polygons.iter().enumerate() {
        for ([a, b], drawn) in sides_of(polygon).zip(sides_of(&drawn.faces[f])) {
            let (key, reversed) = EdgeKey::new(a, b);
            let number = *numbers.entry(key).or_insert(sides.len());
            if number == sides.len() {
                sides.push(Side { key, drawn, uses: Vec::with_capacity(2) });
            }
            sides[number].uses.push((f, reversed));
        }
    }
    let one_sided = one_sided(polygons.len(), &sides);
    sides.iter().try_for_each(|side| check_uses(drawn, side, &one_sided))?;
    Ok(sides)
}

/// Returns for each polygon whether it lies in a piece that has one side only, as a Moebius band has. Edges of more than
/// two faces say nothing of sides.
fn one_sided(polygons: usize, sides: &[Side]) -> Vec<bool> {
    // the upper and the lower side of each polygon, 2 f and 2 f + 1, which edges join to those of its neighbours
    let joined = sides.iter().filter_map(|side| match side.uses[..] {
        [(f, a), (g, b)] => Some((f, g, usize::from(a == b))),
        _ => None,
    });
    let joints = joined.flat_map(|(f, g, turned)| [0, 1].map(|side| [2 * f + side, 2 * g + (side + turned) % 2]));
    let mut found = vec![false; polygons];
    for piece in pieces(2 * polygons, joints, 0..2 * polygons) {
        piece.windows(2).filter(|pair| pair[0] / 2 == pair[1] / 2).for_each(|pair| found[pair[0] / 2] = true);
    }
    found
}

fn check_uses(drawn: &Drawing, side: &Side, one_sided: &[bool]) -> Result<(), Defect> {
    let [(f, a), (g, b)] = side.uses[..] else { return Ok(()) };
    if a != b || one_sided[f] {
        return Ok(());
    }
    let problem = MeshProblem::Orientation { edge: drawn.edge_name(side.drawn), faces: [f, g].map(|f| drawn.name(f)) };
    Err(Defect::new(MeshPart::Face(g), problem))
}

/// Checks that in a periodic sheet the edges of one face are exactly the sides of the listed openings.
pub(super) fn check_rims(drawn: &Drawing, sides: &[Side], holes: &[Vec<Corner>]) -> Result<(), Defect> {
    if !drawn.is_repeated() {
        return Ok(());
    }
    let mut rim: BTreeMap<EdgeKey, &Side> = sides.iter().map(|s| (s.key, s)).collect();
    for (h, hole) in holes.iter().enumerate() {
        for ([a, b], ends) in sides_of(hole).zip(sides_of(&drawn.holes[h])) {
            let faces = rim.remove(&EdgeKey::new(a, b).0).map_or(0, |s| s.uses.len());
            if faces != 1 {
                let edge = drawn.edge_name(ends);
                return Err(Defect::new(MeshPart::Hole(h), MeshProblem::HoleSide { hole: h, edge, faces }));
            }
        }
    }
    let unmatched = sides.iter().find(|s| s.uses.len() == 1 && rim.contains_key(&s.key));
    let Some(side) = unmatched else { return Ok(()) };
    let face = side.uses[0].0;
    let problem = MeshProblem::Unmatched { edge: drawn.edge_name(side.drawn), face: drawn.name(face) };
    Err(Defect::new(MeshPart::Face(face), problem))
}

/// Returns the joints between the faces of edges of more than two faces, by the names of the edges; those of which the
/// drawing says nothing are left out.
pub(super) fn glue(drawn: &Drawing, cell: &Identified, sides: &[Side]) -> Result<BTreeMap<EdgeKey, Vec<Glue>>, Defect> {
    let mut found = BTreeMap::new();
    for (e, (ends, words)) in drawn.glue.iter().enumerate().filter(|(_, (_, words))| !words.is_empty()) {
        let key = EdgeKey::new(cell.corner[ends[0]], cell.corner[ends[1]]).0;
        let faces = sides.iter().find(|side| side.key == key).map_or(0, |side| side.uses.len());
        let words = if words.len() == 1 { vec![words[0]; faces] } else { words.clone() };
        if faces < 3 || words.len() != faces {
            let problem = MeshProblem::Glue { edge: drawn.edge_name(*ends), faces, found: words.len() };
            return Err(Defect::new(MeshPart::Edge(e), problem));
        }
        found.insert(key, words);
    }
    Ok(found)
}

/// Returns the edges of the cell, with the opposite vertices of their triangles: sides first, then diagonals, then edges
/// of no face, then the further hinges of edges of more than two faces.
pub(super) fn with_wings(
    drawn: &Drawing,
    cell: &Identified,
    (sides, glue): (&[Side], &BTreeMap<EdgeKey, Vec<Glue>>),
    parts: &[SplitTriangle],
) -> Result<Vec<Edge>, Defect> {
    let mut edges: Vec<Edge> = sides.iter().map(bare).collect();
    let mut numbers: BTreeMap<EdgeKey, usize> = edges.iter().enumerate().map(|(e, edge)| (edge.key, e)).collect();
    for part in parts {
        let Some(([a, b], ends)) = part.diagonal else { continue };
        let key = EdgeKey::new(a, b).0;
        if numbers.insert(key, edges.len()).is_some() {
            let face = part.triangle.polygon;
            let problem = MeshProblem::DiagonalIsEdge { face: drawn.name(face), edge: drawn.edge_name(ends) };
            return Err(Defect::new(MeshPart::Face(face), problem));
        }
        edges.push(Edge { key, kind: EdgeKind::Facet, wings: [None; 2] });
    }
    let mut flaps: Vec<Vec<TriangleSide>> = vec![vec![]; edges.len()];
    for side in parts.iter().flat_map(|part| part.triangle.sides()) {
        flaps[numbers[&side.key]].push(side);
    }
    for &ends in &drawn.bars {
        let key = EdgeKey::new(cell.corner[ends[0]], cell.corner[ends[1]]).0;
        if !numbers.contains_key(&key) {
            edges.push(Edge { key, kind: EdgeKind::Boundary, wings: [None; 2] });
        }
    }
    let place = |corner| position(drawn, cell, corner);
    let further: Vec<Edge> =
        edges.iter_mut().zip(&flaps).flat_map(|(edge, flaps)| hinges::open_out(edge, flaps, glue, place)).collect();
    edges.extend(further);
    Ok(edges)
}

fn bare(side: &Side) -> Edge {
    let kind = if side.uses.len() > 1 { EdgeKind::Crease } else { EdgeKind::Boundary };
    Edge { key: side.key, kind, wings: [None; 2] }
}
