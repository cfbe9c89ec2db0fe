//! The pairs of rectangles in the plane that meet.

use std::ops::ControlFlow;

use crate::math::Vec2;

/// Most entries in all strips, in multiples of the number of boxes.
const ENTRIES: f64 = 4.0;

/// A box over which a sweep has come, side by side with the others in memory.
struct Open {
    number: usize,
    /// The lowest strip in which it is.
    lowest: usize,
    /// Its lower side.
    low: f64,
    /// Its upper corner.
    high: Vec2,
}

/// Calls `visit` once for each pair of boxes that meet, until it breaks; boxes are given by their lower and upper
/// corners. In `visit(p, q)` box `p` does not begin to the left of box `q`.
///
/// The plane is cut into horizontal strips, and every strip is swept along x. There are as many strips as fit where
/// boxes are in a few strips on average, so that the work is about that of visiting the pairs.
pub(super) fn for_pairs_that_meet<B>(
    boxes: &[[Vec2; 2]],
    mut visit: impl FnMut(usize, usize) -> ControlFlow<B>,
) -> ControlFlow<B> {
    let low = boxes.iter().fold(f64::INFINITY, |low, corners| low.min(corners[0].y));
    let high = boxes.iter().fold(f64::NEG_INFINITY, |high, corners| high.max(corners[1].y));
    let heights: f64 = boxes.iter().map(|[low, high]| high.y - low.y).sum();
    let count = boxes.len() as f64;
    let strips = (ENTRIES * count * (high - low) / heights).min(count.sqrt()).max(1.0).floor();
    let strip = |y: f64| ((y - low) / (high - low) * strips).min(strips - 1.0) as usize;
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&a, &b| boxes[a][0].x.total_cmp(&boxes[b][0].x));
    let lowest: Vec<usize> = boxes.iter().map(|corners| strip(corners[0].y)).collect();
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); strips as usize];
    for p in order {
        members[lowest[p]..=strip(boxes[p][1].y)].iter_mut().for_each(|strip| strip.push(p));
    }
    for (here, members) in members.into_iter().enumerate() {
        let mut open: Vec<Open> = Vec::new();
        for p in members {
            let [low, high] = boxes[p];
            open.retain(|other| other.high.x >= low.x);
            for other in &open {
                // a pair that shares several strips is visited in the lowest of them
                let is_lowest = lowest[p].max(other.lowest) == here;
                if is_lowest && low.y <= other.high.y && other.low <= high.y {
                    visit(p, other.number)?;
                }
            }
            open.push(Open { number: p, lowest: lowest[p], low: low.y, high });
        }
    }
    ControlFlow::Continue(())
}

/// Returns the lower and the upper corner of the box around a segment, wider by `margin` on all sides.
pub(super) fn around([a, b]: [Vec2; 2], margin: f64) -> [Vec2; 2] {
    let margin = Vec2::repeat(margin);
    [a.inf(&b) - margin, a.sup(&b) + margin]
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Claim: each pair of boxes that meet is visited once, whether boxes are small, long, equal or without width.
    /// Source: all pairs one by one.
    #[test]
    fn every_pair_once() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        for [width, height] in [[0.05, 0.05], [0.01, 1.0], [1.0, 0.01], [0.0, 0.0], [1.0, 1.0]] {
            let mut boxes: Vec<[Vec2; 2]> = (0..200)
                .map(|_| {
                    let low = Vec2::new(random.random(), random.random());
                    [low, low + Vec2::new(width * random.random::<f64>(), height * random.random::<f64>())]
                })
                .collect();
            boxes.extend_from_within(..20);
            let mut found = Vec::new();
            let all = for_pairs_that_meet(&boxes, |p, q| {
                found.push([p.min(q), p.max(q)]);
                ControlFlow::<()>::Continue(())
            });
            assert!(all.is_continue());
            found.sort_unstable();
            let meet = |p: usize, q: usize| {
                let (from, to) = (boxes[p][0].sup(&boxes[q][0]), boxes[p][1].inf(&boxes[q][1]));
                from.x <= to.x && from.y <= to.y
            };
            let pairs = (0..boxes.len()).flat_map(|p| (p + 1..boxes.len()).map(move |q| [p, q]));
            assert_eq!(found, pairs.filter(|[p, q]| meet(*p, *q)).collect::<Vec<_>>(), "{width} x {height}");
        }
    }
}
