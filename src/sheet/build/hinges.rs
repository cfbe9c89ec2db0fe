//! The hinges between the faces round an edge.
//!
//! Two faces have one hinge. Round an edge of more than two faces, every two neighbours have one: the faces are sorted
//! by their angle about the edge in the drawing, in the sense of a right-handed screw along it, from the face that is
//! listed first. The fold angle of a hinge is then pi less the angle between its two faces, and the fold angles of `m`
//! faces sum up to `(m - 2) pi`. Such edges join tubes and cells (E. T. Filipov, T. Tachi and G. H. Paulino, "Origami
//! tubes assembled into stiff, yet reconfigurable structures and metamaterials", PNAS 112 (2015) 12321-12326).

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::math::Vec3;
use crate::sheet::cell::{Corner, Edge, EdgeKey, EdgeKind, Glue, TriangleSide};

/// Gives an edge the wings of its hinge; of an edge of more than two faces those of the first one. Returns the further
/// hinges of such an edge.
pub(super) fn open_out(
    edge: &mut Edge,
    flaps: &[TriangleSide],
    glue: &BTreeMap<EdgeKey, Vec<Glue>>,
    place: impl Fn(Corner) -> Vec3,
) -> Vec<Edge> {
    let [first, others @ ..] = flaps else { return vec![] };
    if others.len() < 2 {
        // two faces that run along it in the same direction are those of a sheet with one side
        edge.wings[first.side] = Some(first.opposite);
        edge.wings[1 - first.side] = others.first().map(|other| other.opposite);
        return vec![];
    }
    let words = glue.get(&edge.key).cloned().unwrap_or_else(|| vec![Glue::Fold; flaps.len()]);
    let mut hinges = round(edge.key, flaps, &words, place);
    if hinges.is_empty() {
        edge.kind = EdgeKind::Boundary;
    } else {
        *edge = hinges.remove(0);
    }
    hinges
}

/// Returns the hinges between the neighbours round an edge that something joins.
fn round(key: EdgeKey, flaps: &[TriangleSide], words: &[Glue], place: impl Fn(Corner) -> Vec3) -> Vec<Edge> {
    let [from, to] = key.ends().map(&place);
    let along = (to - from).normalize();
    let across = |flap: &TriangleSide| {
        let arm = place(flap.opposite) - from;
        arm - along * along.dot(&arm)
    };
    let first = across(&flaps[0]);
    let angle = |flap: &TriangleSide| {
        let arm = across(flap);
        along.dot(&first.cross(&arm)).atan2(first.dot(&arm)).rem_euclid(TAU)
    };
    let mut sorted: Vec<(f64, Corner)> = flaps[1..].iter().map(|flap| (angle(flap), flap.opposite)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let apexes: Vec<Corner> =
        std::iter::once(flaps[0].opposite).chain(sorted.into_iter().map(|(_, apex)| apex)).collect();
    let mut hinges = Vec::new();
    for (k, word) in words.iter().enumerate().filter(|(_, word)| **word != Glue::Free) {
        let kind = if *word == Glue::Weld { EdgeKind::Facet } else { EdgeKind::Crease };
        let wings = [Some(apexes[k]), Some(apexes[(k + 1) % apexes.len()])];
        hinges.push(Edge { key: EdgeKey { round: hinges.len(), ..key }, kind, wings });
    }
    hinges
}
