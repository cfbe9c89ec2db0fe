//! The sign of the curvature over a surface, carried from neighbour to neighbour.
//!
//! Next to the drawn state the sign of a state says on which side the axis lies; from there it spreads over the
//! triangles, to the nearest states first. Where the surface leads from one side to the other round the axis, without
//! passing a straight state, the two signs meet along a line, and no choice is continuous across it.

use super::SurfacePoint;
use crate::kinematics::Embedding;
use std::collections::{BTreeSet, VecDeque};

/// Carries signs over pairs of neighbours from the first state of every start; pieces that hang together with no start
/// keep the signs of single states. `starts` is the number of the start from which each state was found.
pub(super) fn carry(
    embedding: &Embedding,
    points: &mut [SurfacePoint],
    pairs: impl Iterator<Item = [usize; 2]>,
    starts: &[usize],
) {
    let mut near = vec![BTreeSet::new(); points.len()];
    for [a, b] in pairs {
        near[a].insert(b);
        near[b].insert(a);
    }
    let mut reached = vec![false; points.len()];
    let mut waiting = VecDeque::new();
    for start in 0..starts.iter().max().map_or(0, |last| last + 1) {
        let first = (0..points.len()).find(|&k| starts[k] == start && points[k].shape.turns());
        waiting.extend(first);
    }
    waiting.iter().for_each(|&k| reached[k] = true);
    while let Some(k) = waiting.pop_front() {
        for &next in &near[k] {
            if reached[next] || !points[next].shape.turns() {
                continue;
            }
            let mut shape = points[next].shape.clone();
            shape.continue_over(embedding, &points[k].shape, [&points[k].angles, &points[next].angles]);
            points[next].shape = shape;
            reached[next] = true;
            waiting.push_back(next);
        }
    }
}
