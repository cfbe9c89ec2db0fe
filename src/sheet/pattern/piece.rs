//! The pieces into which segments are split.

/// A piece of a segment between two points of an arrangement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SegmentPiece {
    /// Numbers of the two points, in the direction of the segment.
    pub ends: [usize; 2],
    /// Number of the segment.
    pub segment: usize,
}
