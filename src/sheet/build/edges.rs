//! The edges of the cell: they are found along the polygons, checked for their faces, and given their wings.

use std::collections::BTreeMap;

use super::split::Part;
use super::{Defect, Drawing, MeshPart, Problem};
use crate::sheet::cell::{Corner, Edge, EdgeKey, EdgeKind, TriangleSide};

/// An edge along the polygons, and the polygons of which it is a side.
pub(super) struct Side {
    key: EdgeKey,
    /// The drawn vertices of its ends where it first appears.
    drawn: [usize; 2],
    /// Each polygon that has this side, and whether it runs from `j` to `i` there.
    uses: Vec<(usize, bool)>,
}

/// Returns the sides of polygons in order of first appearance. Each side belongs to one polygon, or to two that run
/// along it in opposite directions.
pub(super) fn sides(drawn: &Drawing, polygons: &[Vec<Corner>]) -> Result<Vec<Side>, Defect> {
    let mut numbers: BTreeMap<EdgeKey, usize> = BTreeMap::new();
    let mut sides: Vec<Side> = Vec::new();
    for (f, polygon) in polygons.iter().enumerate() {
        for a in 0..polygon.len() {
            let b = (a + 1) % polygon.len();
            let (key, reversed) = EdgeKey::new(polygon[a], polygon[b]);
            let number = *numbers.entry(key).or_insert(sides.len());
            if number == sides.len() {
                let drawn = [drawn.faces[f][a], drawn.faces[f][b]];
                sides.push(Side { key, drawn, uses: Vec::with_capacity(2) });
            }
            sides[number].uses.push((f, reversed));
        }
    }
    sides.iter().try_for_each(|side| check_uses(drawn, side))?;
    Ok(sides)
}

fn check_uses(drawn: &Drawing, side: &Side) -> Result<(), Defect> {
    let edge = drawn.edge_name(side.drawn);
    let faces: Vec<_> = side.uses.iter().map(|u| drawn.name(u.0)).collect();
    match side.uses[..] {
        [(_, a), (g, b)] if a == b => {
            let problem = Problem::Orientation { edge, faces: [faces[0], faces[1]] };
            Err(Defect::new(MeshPart::Face(g), problem))
        }
        [_, _, (third, _), ..] => Err(Defect::new(MeshPart::Face(third), Problem::NonManifoldEdge { edge, faces })),
        _ => Ok(()),
    }
}

/// Checks that in a periodic sheet the edges of one face are exactly the sides of the listed openings.
pub(super) fn check_rims(drawn: &Drawing, sides: &[Side], holes: &[Vec<Corner>]) -> Result<(), Defect> {
    if !drawn.is_repeated() {
        return Ok(());
    }
    let mut rim: BTreeMap<EdgeKey, &Side> = sides.iter().map(|s| (s.key, s)).collect();
    for (h, hole) in holes.iter().enumerate() {
        for a in 0..hole.len() {
            let b = (a + 1) % hole.len();
            let faces = rim.remove(&EdgeKey::new(hole[a], hole[b]).0).map_or(0, |s| s.uses.len());
            if faces != 1 {
                let edge = drawn.edge_name([drawn.holes[h][a], drawn.holes[h][b]]);
                return Err(Defect::new(MeshPart::Hole(h), Problem::HoleSide { hole: h, edge, faces }));
            }
        }
    }
    match sides.iter().find(|s| s.uses.len() == 1 && rim.contains_key(&s.key)) {
        Some(side) => {
            let face = side.uses[0].0;
            let problem = Problem::Unmatched { edge: drawn.edge_name(side.drawn), face: drawn.name(face) };
            Err(Defect::new(MeshPart::Face(face), problem))
        }
        None => Ok(()),
    }
}

/// Returns the edges of the cell, sides first, then diagonals, with the opposite vertices of their triangles.
pub(super) fn with_wings(drawn: &Drawing, sides: Vec<Side>, parts: &[Part]) -> Result<Vec<Edge>, Defect> {
    let mut edges: Vec<Edge> = sides.iter().map(bare).collect();
    let mut numbers: BTreeMap<EdgeKey, usize> = edges.iter().enumerate().map(|(e, edge)| (edge.key, e)).collect();
    for part in parts {
        let Some(([a, b], ends)) = part.diagonal else { continue };
        let key = EdgeKey::new(a, b).0;
        if numbers.insert(key, edges.len()).is_some() {
            let face = part.triangle.polygon;
            let problem = Problem::DiagonalIsEdge { face: drawn.name(face), edge: drawn.edge_name(ends) };
            return Err(Defect::new(MeshPart::Face(face), problem));
        }
        edges.push(Edge { key, kind: EdgeKind::Facet, wings: [None; 2] });
    }
    for part in parts {
        for TriangleSide { key, side, opposite, .. } in part.triangle.sides() {
            edges[numbers[&key]].wings[side] = Some(opposite);
        }
    }
    Ok(edges)
}

fn bare(side: &Side) -> Edge {
    let kind = if side.uses.len() == 2 { EdgeKind::Crease } else { EdgeKind::Boundary };
    Edge { key: side.key, kind, wings: [None; 2] }
}
