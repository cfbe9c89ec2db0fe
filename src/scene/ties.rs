//! Vertices that are drawn in one place and tied: parts that move, but do not turn.

use std::collections::BTreeMap;

use super::places::{Held, Places};
use super::spec::VertexSet;
use super::{SceneError, SceneFile};
use crate::model::{Assembly, Part};
use crate::sheet::build::coincident;

/// The name of the set of all vertices, of which those in one place are tied.
const COINCIDENT: &str = "coincident";

/// Adds the ties of a scene to its parts. Axes along which one of the tied vertices is pinned are no motions of the tie,
/// and its pins are left out.
pub(super) fn add(
    (file, assembly): (&SceneFile, &Assembly),
    held: &mut Held,
    parts: &mut Vec<Part>,
) -> Result<(), SceneError> {
    let (places, positions) = (Places::new(file, assembly), &assembly.tiling().positions);
    for tie in &file.scene.ties {
        let set = match &*tie.vertices {
            VertexSet::Name(name) if name == COINCIDENT => (0..positions.len()).collect(),
            _ => places.set(&tie.vertices)?,
        };
        let wrong = |message: String, help: &str| Err(file.error_at(tie.vertices.span(), message, help));
        let points: Vec<_> = set.iter().map(|&vertex| positions[vertex]).collect();
        let mut together: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for [vertex, first] in coincident(&points) {
            together.entry(first).or_insert_with(|| vec![set[first]]).push(set[vertex]);
        }
        if together.is_empty() {
            let help = "a tie is for vertices that are drawn in one place; those apart move together as a [[part]]";
            return wrong("no two of these vertices stand in one place".into(), help);
        }
        for vertices in together.into_values() {
            let is_tied = |vertex: &usize| vertices.contains(vertex);
            if let Some(vertex) = parts.iter().flat_map(|part| &part.vertices).find(|&vertex| is_tied(vertex)) {
                let help = "a vertex belongs to one part or tie at most";
                return wrong(format!("{} is in another part or tie too", places.described(*vertex)), help);
            }
            if let Some((vertex, _)) = held.guides.iter().find(|(vertex, _)| is_tied(vertex)) {
                let help = "ties know the pinned axes of their vertices, and no `normal`";
                return wrong(format!("{} is tied, and pinned along a normal", places.described(*vertex)), help);
            }
            let mut free = [true, true, true, false, false, false];
            let pins = held.pins.iter().filter(|(vertex, _)| is_tied(vertex));
            pins.for_each(|(_, axes)| (0..3).for_each(|axis| free[axis] &= !axes[axis]));
            held.pins.retain(|(vertex, _)| !is_tied(vertex));
            parts.push(Part { vertices, free });
        }
    }
    Ok(())
}
