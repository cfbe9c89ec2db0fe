//! Fold angles of a file that no edge can have.

use super::assignment::Assignment;
use super::drawn_edge::DrawnEdge;

/// A fold angle that contradicts the letter of its edge, another copy of the edge, or the range of angles; the message
/// says how to correct it.
#[derive(Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages say it
pub enum FoldAngleFault {
    #[error(
        "edge {edge} of the list, {ends}, has the fold angle {given} degrees; a target angle should be between -180 and \
         180 degrees, valley positive"
    )]
    Range {
        edge: usize,
        ends: DrawnEdge,
        /// The fold angle, in degrees.
        given: f64,
    },
    #[error(
        "edge {edge} of the list, {ends}, is assigned {letter} and has the fold angle {given} degrees; mountains have \
         negative angles and valleys positive ones: change the sign or the letter"
    )]
    OtherSide {
        edge: usize,
        ends: DrawnEdge,
        letter: Assignment,
        /// The fold angle, in degrees.
        given: f64,
    },
    #[error(
        "edge {edge} of the list, {ends}, has the fold angle {given} degrees, and another copy of it in the drawing has \
         {before} degrees; give both the same, or one of them null"
    )]
    Copies {
        edge: usize,
        ends: DrawnEdge,
        /// Fold angle of this copy, in degrees.
        given: f64,
        /// Fold angle of the copy that is listed before, in degrees.
        before: f64,
    },
}
