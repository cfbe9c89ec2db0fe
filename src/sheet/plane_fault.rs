//! Edges in a plane from which faces cannot be rebuilt.

use super::drawn_edge::DrawnEdge;

/// The reason why faces cannot be rebuilt from the edges of a mesh; `faces_vertices` in its file gives them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)] // the messages say it
pub enum PlaneFault {
    #[error("edge {0} has no length seen along z; give `faces_vertices`, which cannot be rebuilt for it")]
    Upright(DrawnEdge),
    #[error(
        "edge {edge} of the list, {ends}, belongs to edges inside a face that are not joined to the others; give \
         `faces_vertices`, which cannot be rebuilt for them, or join them"
    )]
    Nested { edge: usize, ends: DrawnEdge },
}
