//! Cuts: edges whose two faces are not joined.
//!
//! If cuts, or a cut and the rim, divide the faces around a vertex into several fans, the vertex is replaced by one
//! vertex for each fan. The fan of the face that is listed first keeps the vertex; the others get new ones, numbered
//! after all drawn vertices by vertex and then by face. An end of a cut inside the sheet stays one vertex.

use std::collections::BTreeMap;

use super::{Defect, Drawing, Identified, MeshPart, MeshProblem};
use crate::math::pieces::pieces;
use crate::sheet::assignment::Assignment;
use crate::sheet::cell::{Corner, EdgeKey};
use crate::sheet::sides;

/// Cut edges by name, each with its index in the list of edges.
type Cuts = BTreeMap<EdgeKey, usize>;

/// A corner of a face: the number of the face, and the index of the corner in it.
type Wedge = (usize, usize);

/// Separates the polygons along the cuts of `drawn`. Returns for every new vertex the vertex from which it was split
/// off.
pub(super) fn cut(
    drawn: &Drawing,
    identified: &mut Identified,
    polygons: &mut [Vec<Corner>],
) -> Result<Vec<usize>, Defect> {
    let cuts = inner_cuts(drawn, identified, polygons)?;
    if cuts.is_empty() {
        return Ok(vec![]);
    }
    let mut origins = Vec::new();
    let mut moved = Vec::new();
    for (vertex, wedges) in wedges_at_cuts(&cuts, polygons) {
        if fans(polygons, &wedges, &Cuts::new()).len() > 1 {
            continue; // these fans were not made by a cut; they are refused later
        }
        for fan in fans(polygons, &wedges, &cuts).into_iter().skip(1) {
            moved.extend(fan.into_iter().map(|wedge| (wedge, identified.homes.len())));
            identified.homes.push(identified.homes[vertex]);
            origins.push(vertex);
        }
    }
    for ((face, corner), vertex) in moved {
        polygons[face][corner].vertex = vertex;
    }
    check_open(drawn, identified, polygons, &cuts, &origins)?;
    Ok(origins)
}

/// Returns the cuts between two faces; a cut along the rim has no effect.
fn inner_cuts(drawn: &Drawing, identified: &Identified, polygons: &[Vec<Corner>]) -> Result<Cuts, Defect> {
    let mut cuts = Cuts::new();
    for (e, (ends, assignment)) in drawn.assignments.iter().enumerate() {
        if *assignment == Assignment::Cut {
            let [a, b] = ends.map(|v| identified.corner[v]);
            cuts.insert(EdgeKey::new(a, b).0, e);
        }
    }
    if cuts.is_empty() {
        return Ok(cuts);
    }
    let uses = uses(polygons);
    cuts.retain(|key, _| uses.get(key) == Some(&2));
    let Some(&edge) = cuts.values().min().filter(|_| drawn.is_repeated()) else { return Ok(cuts) };
    let ends = drawn.edge_name(drawn.assignments[edge].0);
    Err(Defect::new(MeshPart::Edge(edge), MeshProblem::PeriodicCut { edge, ends }))
}

/// Returns the number of polygons that have each edge.
fn uses(polygons: &[Vec<Corner>]) -> BTreeMap<EdgeKey, usize> {
    let sides = polygons.iter().flat_map(|polygon| sides::sides(polygon));
    sides::uses(sides.map(|[a, b]| EdgeKey::new(a, b).0))
}

/// Returns the corners of faces at every vertex where a cut ends.
fn wedges_at_cuts(cuts: &Cuts, polygons: &[Vec<Corner>]) -> BTreeMap<usize, Vec<Wedge>> {
    let mut at: BTreeMap<usize, Vec<Wedge>> = cuts.keys().flat_map(|key| [(key.i, vec![]), (key.j, vec![])]).collect();
    for (f, polygon) in polygons.iter().enumerate() {
        for (k, corner) in polygon.iter().enumerate() {
            if let Some(wedges) = at.get_mut(&corner.vertex) {
                wedges.push((f, k));
            }
        }
    }
    at
}

/// Groups the corners of faces at a vertex, which are in the order of faces, into fans that are connected by edges
/// without cuts. Fans and their members are in that order too.
fn fans(polygons: &[Vec<Corner>], wedges: &[Wedge], cuts: &Cuts) -> Vec<Vec<Wedge>> {
    let mut first: BTreeMap<Corner, usize> = BTreeMap::new();
    let mut joints = Vec::new();
    for (number, &(f, k)) in wedges.iter().enumerate() {
        let polygon = &polygons[f];
        let back = polygon[k].shift.map(|n| -n);
        for other in [(k + polygon.len() - 1) % polygon.len(), (k + 1) % polygon.len()] {
            if !cuts.contains_key(&EdgeKey::new(polygon[k], polygon[other]).0) {
                joints.push([number, *first.entry(polygon[other].translated(back)).or_insert(number)]);
            }
        }
    }
    let fans = pieces(wedges.len(), joints.into_iter(), 0..wedges.len());
    fans.into_iter().map(|fan| fan.into_iter().map(|number| wedges[number]).collect()).collect()
}

/// Checks that the faces at every vertex hang together by edges.
pub(super) fn check_fans(drawn: &Drawing, identified: &Identified, polygons: &[Vec<Corner>]) -> Result<(), Defect> {
    let mut at: Vec<Vec<Wedge>> = vec![vec![]; identified.homes.len()];
    for (f, polygon) in polygons.iter().enumerate() {
        polygon.iter().enumerate().for_each(|(k, corner)| at[corner.vertex].push((f, k)));
    }
    let apart = at.iter().position(|wedges| fans(polygons, wedges, &Cuts::new()).len() > 1);
    let Some(vertex) = apart else { return Ok(()) };
    let home = identified.homes[vertex];
    Err(Defect::new(MeshPart::Vertex(home), MeshProblem::NonManifoldVertex { vertex: drawn.name(home) }))
}

/// Checks that the two sides of every cut have become two edges.
fn check_open(
    drawn: &Drawing,
    identified: &Identified,
    polygons: &[Vec<Corner>],
    cuts: &Cuts,
    origins: &[usize],
) -> Result<(), Defect> {
    let drawn_count = identified.homes.len() - origins.len();
    let origin = |v: usize| v.checked_sub(drawn_count).map_or(v, |k| origins[k]);
    for (key, _) in uses(polygons).into_iter().filter(|(_, count)| *count > 1) {
        let [i, j] = key.ends().map(|end| Corner { vertex: origin(end.vertex), ..end });
        if let Some(&edge) = cuts.get(&EdgeKey::new(i, j).0) {
            let ends = drawn.edge_name(drawn.assignments[edge].0);
            return Err(Defect::new(MeshPart::Edge(edge), MeshProblem::ClosedCut { edge, ends }));
        }
    }
    Ok(())
}
