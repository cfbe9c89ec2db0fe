//! Points of an arrangement put back onto the segments that they split.
//!
//! A point within the tolerance of a segment splits it, which bends it by up to the tolerance. A crease that ends short of
//! the rim, or beyond it, bends neither where its end goes along its own line to the rim; and a corner that both sides pass
//! is where they meet.

use std::collections::BTreeMap;

use super::piece::SegmentPiece;
use crate::math::Vec2;

/// Passes in which points go back onto segments, whose ends go onto others.
const PASSES: usize = 4;

/// Least distance in tolerances by which a point goes back: points that are off by rounding stay.
const LEAST_MOVE: f64 = 1e-9;

/// Least sine of the angle between two lines with which a point goes to where they meet: at smaller ones, below 14
/// degrees, that is far.
const LEAST_SINE: f64 = 0.25;

/// Moves points onto the segments that they split, and there to where segments that end at them meet them. `drawn` are
/// the segments and the points at their ends, `pieces` what they are split into.
pub(super) fn straighten(
    points: &mut [Vec2],
    (segments, drawn): (&[[Vec2; 2]], &[SegmentPiece]),
    pieces: &[SegmentPiece],
    tolerance: f64,
) {
    let mut through: BTreeMap<usize, Through> = BTreeMap::new();
    for piece in pieces {
        let ends = drawn[piece.segment].ends;
        let inner = piece.ends.into_iter().filter(|v| !ends.contains(v));
        inner.for_each(|v| through.entry(v).or_default().split.push(ends));
    }
    for (piece, [a, b]) in drawn.iter().zip(segments) {
        for (v, ends) in piece.ends.into_iter().zip([[*a, *b], [*b, *a]]) {
            through.entry(v).or_default().ending.push(ends);
        }
    }
    through.retain(|_, lines| !lines.split.is_empty() || lines.is_beside_all());
    for _ in 0..PASSES {
        for (&v, lines) in &through {
            let split: Vec<_> = lines.split.iter().map(|ends| ends.map(|v| points[v])).collect();
            let moved = met(points[v], &split, &lines.ending);
            if (moved - points[v]).norm() > LEAST_MOVE * tolerance {
                points[v] = moved;
            }
        }
    }
}

/// The segments through a point.
#[derive(Default)]
struct Through {
    /// The points at the ends of those that it splits.
    split: Vec<[usize; 2]>,
    /// Those that end at it, as they are drawn, with this end first.
    ending: Vec<[Vec2; 2]>,
}

impl Through {
    /// Whether no two segments are drawn to the same end.
    fn is_beside_all(&self) -> bool {
        let ends: Vec<Vec2> = self.ending.iter().map(|ends| ends[0]).collect();
        ends.len() > 1 && ends.iter().enumerate().all(|(k, end)| !ends[..k].contains(end))
    }
}

/// Returns where the first of the lines `split` is met, next to `x`, by the one most across it of the others, or else of
/// `ending`; its point nearest to `x` where they are all nearly parallel. Without lines `split` the first of the others is
/// met.
fn met(x: Vec2, split: &[[Vec2; 2]], ending: &[[Vec2; 2]]) -> Vec2 {
    // the unit normal of each line, and its distance from `x`
    let equations = |lines: &[[Vec2; 2]]| -> Vec<(Vec2, f64)> {
        let normal = |[a, b]: &[Vec2; 2]| Vec2::new(a.y - b.y, b.x - a.x).try_normalize(0.0);
        lines.iter().filter_map(|line| Some((normal(line)?, normal(line)?.dot(&(line[0] - x))))).collect()
    };
    let [split, ending] = [split, ending].map(equations);
    let Some(&(normal, off)) = split.first().or(ending.first()) else { return x };
    let sine = |line: &(Vec2, f64)| normal.perp(&line.0);
    let across = |lines: &[(Vec2, f64)]| {
        let most = lines.iter().rev().copied().max_by(|a, b| sine(a).abs().total_cmp(&sine(b).abs()));
        most.filter(|line| sine(line).abs() > LEAST_SINE)
    };
    match across(&split).or_else(|| across(&ending)) {
        Some(line) => {
            let (other, beside) = line;
            x + Vec2::new(off * other.y - beside * normal.y, beside * normal.x - off * other.x) / sine(&line)
        }
        None => x + off * normal,
    }
}

#[cfg(test)]
mod tests {
    use super::super::arrangement::{Arrangement, arrange};
    use super::*;
    use std::collections::BTreeSet;

    /// Claim: a line stays straight where others end short of it, beyond it or cross it there, and a point on two lines
    /// is where they meet. Source: counted by hand.
    #[test]
    fn lines_stay_straight() {
        let within = |segments: &[[f64; 4]]| {
            let ends = segments.iter().map(|s| [Vec2::new(s[0], s[1]), Vec2::new(s[2], s[3])]);
            arrange(&ends.collect::<Vec<_>>(), 0.1, true, &mut 0).unwrap()
        };
        let points =
            |found: &Arrangement| found.pieces.iter().flat_map(|piece| piece.ends).collect::<BTreeSet<_>>().len();
        for end in [-0.08, 0.08] {
            let found = within(&[[0.0, 0.0, 10.0, 0.0], [4.0, end, 4.0, 5.0]]);
            assert_eq!((points(&found), found.straight[2]), (4, Vec2::new(4.0, 0.0)), "{found:?}");
            assert_eq!(found.points[2].y, end);
        }
        let over = within(&[[4.0, 0.08, 4.0, -5.0], [0.0, 0.0, 10.0, 0.0], [4.05, 5.0, 4.05, 0.05]]);
        assert_eq!((over.pieces.len(), over.straight[0]), (4, Vec2::new(4.0, 0.0)), "{over:?}");
        // corners that both lines pass are where they meet
        let frame =
            [[-0.06, 0.0, 10.05, 0.0], [10.0, -0.05, 10.0, 6.07], [10.04, 6.0, -0.08, 6.0], [0.0, 6.05, 0.0, -0.05]];
        let frame = within(&frame);
        let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 6.0], [0.0, 6.0]].map(|[x, y]| Vec2::new(x, y));
        let is_corner = |v: usize| corners.iter().any(|corner| (frame.straight[v] - corner).norm() < 1e-12);
        assert!(frame.pieces.len() == 4 && frame.pieces.iter().all(|piece| is_corner(piece.ends[0])), "{frame:?}");
        // an end is cut off or drawn out along its own line
        let slanted = within(&[[0.0, 0.0, 10.0, 0.0], [4.06, 0.06, 7.0, 3.0], [1.94, -0.06, 6.0, 4.0]]);
        let of = |segment: usize| slanted.pieces.iter().find(|piece| piece.segment == segment).unwrap().ends[0];
        let off = [(1, 4.0), (2, 2.0)].map(|(segment, x)| (slanted.straight[of(segment)] - Vec2::new(x, 0.0)).norm());
        assert!(off.iter().all(|off| *off < 1e-12), "{off:?}");
        let crossed = within(&[[0.0, 0.0, 10.0, 0.0], [4.0, -4.0, 4.0, 4.0], [4.05, 0.05, 8.0, 5.0]]);
        let place = crossed.pieces.iter().find(|piece| piece.segment == 2).unwrap().ends[0];
        assert_eq!(crossed.straight[place], Vec2::new(4.0, 0.0));
    }
}
