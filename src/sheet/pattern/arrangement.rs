//! The arrangement of segments in the plane: their points and the pieces between them, which meet at common points only.
//!
//! Ends closer than a tolerance become one point. Then segments are split at the points that lie on them, within the
//! tolerance, and where two of them cross, which exact determinants decide. A split moves a segment by up to the
//! tolerance, so that this is repeated until nothing is left to split. Pairs are found by a sweep along x.

use std::collections::HashMap;

use robust::{Coord, orient2d};

use crate::math::Vec2;

/// Most repetitions of splitting; two are usual.
const MOST_ROUNDS: usize = 20;

/// A piece of a segment between two points of an arrangement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    /// Numbers of the two points, in the direction of the segment.
    pub ends: [usize; 2],
    /// Number of the segment.
    pub segment: usize,
}

/// Points and pieces of segments; pieces are in the order of their segments. Those of segments that lie on each other
/// have the same ends.
#[derive(Clone, Debug, Default)]
pub(crate) struct Arrangement {
    /// Positions of the points.
    pub points: Vec<Vec2>,
    /// Pieces of all segments; segments within the tolerance have none.
    pub pieces: Vec<Piece>,
}

/// Returns the arrangement of `segments`, whose points are merged within the length `tolerance`; without `split` they are
/// only merged.
pub(crate) fn arrange(segments: &[[Vec2; 2]], tolerance: f64, split: bool) -> Arrangement {
    let mut places = Places { tolerance, points: vec![], buckets: HashMap::new() };
    let numbered = segments.iter().map(|ends| ends.map(|end| places.number(end)));
    let pieces = numbered.enumerate().map(|(segment, ends)| Piece { ends, segment });
    let mut pieces: Vec<Piece> = pieces.filter(|piece| piece.ends[0] != piece.ends[1]).collect();
    for _ in 0..if split { MOST_ROUNDS } else { 0 } {
        let cuts = cuts(&mut places, &pieces);
        if cuts.iter().all(Vec::is_empty) {
            break;
        }
        pieces = pieces.iter().zip(cuts).flat_map(|(piece, cuts)| parts(&places.points, *piece, cuts)).collect();
    }
    Arrangement { points: places.points, pieces }
}

/// Points that are at least `tolerance` apart, found by their place in a grid.
struct Places {
    tolerance: f64,
    points: Vec<Vec2>,
    buckets: HashMap<[i64; 2], Vec<usize>>,
}

impl Places {
    /// Returns the number of the point at `x`, within the tolerance; a new one if there is none.
    fn number(&mut self, x: Vec2) -> usize {
        let [i, j] = [x.x, x.y].map(|c| (c / self.tolerance).floor() as i64);
        let around = (-1..=1).flat_map(|a| (-1..=1).map(move |b| [i.saturating_add(a), j.saturating_add(b)]));
        let near = around.filter_map(|bucket| self.buckets.get(&bucket)).flatten().copied();
        let off = |v: usize| (self.points[v] - x).norm();
        if let Some(v) = near.filter(|&v| off(v) <= self.tolerance).min_by(|&a, &b| off(a).total_cmp(&off(b))) {
            return v;
        }
        self.points.push(x);
        self.buckets.entry([i, j]).or_default().push(self.points.len() - 1);
        self.points.len() - 1
    }
}

/// Returns the points at which every piece is to be split.
fn cuts(places: &mut Places, pieces: &[Piece]) -> Vec<Vec<usize>> {
    let mut cuts = vec![Vec::new(); pieces.len()];
    let boxes: Vec<[Vec2; 2]> = pieces.iter().map(|piece| bounds(places, piece)).collect();
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by(|&a, &b| boxes[a][0].x.total_cmp(&boxes[b][0].x));
    let mut open: Vec<usize> = Vec::new();
    for p in order {
        let [low, high] = boxes[p];
        open.retain(|&q| boxes[q][1].x >= low.x);
        for &q in open.iter().filter(|&&q| boxes[q][0].y <= high.y && boxes[q][1].y >= low.y) {
            for (own, v) in meet(places, pieces[p].ends, pieces[q].ends) {
                cuts[if own { p } else { q }].push(v);
            }
        }
        open.push(p);
    }
    cuts
}

/// Returns the lower and the upper corner of the rectangle around a piece, wider by the tolerance.
fn bounds(places: &Places, piece: &Piece) -> [Vec2; 2] {
    let [a, b] = piece.ends.map(|v| places.points[v]);
    let margin = Vec2::repeat(places.tolerance);
    [a.inf(&b) - margin, a.sup(&b) + margin]
}

/// Returns the points at which two pieces are to be split, each with whether it splits the first one.
fn meet(places: &mut Places, p: [usize; 2], q: [usize; 2]) -> Vec<(bool, usize)> {
    let on_p = q.into_iter().filter(|&v| touches(places, p, v)).map(|v| (true, v));
    let on_q = p.into_iter().filter(|&v| touches(places, q, v)).map(|v| (false, v));
    let touching: Vec<(bool, usize)> = on_p.chain(on_q).collect();
    if !touching.is_empty() || p.iter().any(|v| q.contains(v)) {
        return touching;
    }
    let ([a, b], [c, d]) = (p.map(|v| places.points[v]), q.map(|v| places.points[v]));
    let [from, to] = [turn(c, d, a), turn(c, d, b)];
    if from * to >= 0.0 || turn(a, b, c) * turn(a, b, d) >= 0.0 {
        return touching;
    }
    let v = places.number(a + (b - a) * (from / (from - to)));
    let split = [(true, p), (false, q)].into_iter().filter(|(_, ends)| !ends.contains(&v));
    split.map(|(own, _)| (own, v)).collect()
}

/// Whether point `v` lies between the ends of a piece, within the tolerance; the ends themselves do not.
fn touches(places: &Places, ends: [usize; 2], v: usize) -> bool {
    if ends.contains(&v) {
        return false;
    }
    let ([a, b], x) = (ends.map(|v| places.points[v]), places.points[v]);
    let along = b - a;
    let t = (x - a).dot(&along) / along.norm_squared();
    t > 0.0 && t < 1.0 && (x - a - along * t).norm() <= places.tolerance
}

/// Returns twice the signed area of a triangle, with the right sign however thin it is.
fn turn(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| Coord { x: p.x, y: p.y });
    orient2d(a, b, c)
}

/// Returns the parts of a piece between these points on it.
fn parts(points: &[Vec2], piece: Piece, mut cuts: Vec<usize>) -> Vec<Piece> {
    let [a, b] = piece.ends;
    let along = |v: usize| (points[v] - points[a]).dot(&(points[b] - points[a]));
    cuts.sort_by(|&v, &w| along(v).total_cmp(&along(w)).then(v.cmp(&w)));
    cuts.dedup();
    let stops: Vec<usize> = [a].into_iter().chain(cuts).chain([b]).collect();
    stops.windows(2).map(|w| Piece { ends: [w[0], w[1]], ..piece }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arranged(segments: &[[f64; 4]]) -> Arrangement {
        let ends = segments.iter().map(|s| [Vec2::new(s[0], s[1]), Vec2::new(s[2], s[3])]);
        arrange(&ends.collect::<Vec<_>>(), 1e-6, true)
    }

    fn ends(found: &Arrangement) -> Vec<[usize; 2]> {
        found.pieces.iter().map(|piece| piece.ends).collect()
    }

    /// Claim: a crossing, an end on a segment, ends almost at one place, and an overlap are split and merged; segments
    /// within the tolerance vanish. Source: counted by hand.
    #[test]
    fn meeting_segments() {
        let cross = arranged(&[[0.0, 0.0, 2.0, 2.0], [0.0, 2.0, 2.0, 0.0]]);
        assert_eq!(ends(&cross), [[0, 4], [4, 1], [2, 4], [4, 3]]);
        assert_eq!(cross.points[4], Vec2::new(1.0, 1.0));
        let touch = arranged(&[[0.0, 0.0, 2.0, 0.0], [1.0, 3e-7, 1.0, 5.0]]);
        assert_eq!(ends(&touch), [[0, 2], [2, 1], [2, 3]]);
        let corner = arranged(&[[0.0, 0.0, 1.0, 0.0], [1.0 + 5e-7, 0.0, 1.0, 1.0], [0.0, 0.0, 1e-7, 0.0]]);
        assert_eq!(ends(&corner), [[0, 1], [1, 2]]);
        let overlap = arranged(&[[0.0, 0.0, 2.0, 0.0], [3.0, 0.0, 1.0, 0.0]]);
        assert_eq!(ends(&overlap), [[0, 3], [3, 1], [2, 1], [1, 3]]);
    }

    /// Claim: `n` random lines through a disc that all cross pairwise have `n (n - 1) / 2` crossings and `n^2` pieces, and
    /// three lines through one point have one. Source: no three of the random lines meet in one point.
    #[test]
    fn pencils_and_lines_in_general_position() {
        let line = |angle: f64, off: f64| {
            let (along, across) = (Vec2::new(angle.cos(), angle.sin()), Vec2::new(-angle.sin(), angle.cos()));
            let [a, b] = [-1000.0, 1000.0].map(|s| along * s + across * off);
            [a.x, a.y, b.x, b.y]
        };
        let off = |k: usize| (k as f64 * 0.618_033_988_75).fract() * 0.1;
        let lines: Vec<_> = (0..40).map(|k| line(k as f64 * 0.0777, off(k))).collect();
        let found = arranged(&lines);
        assert_eq!((found.points.len(), found.pieces.len()), (80 + 780, 1600));
        let pencil: Vec<_> = (0..12).map(|k| line(k as f64 * 0.25, 0.0)).collect();
        let found = arranged(&pencil);
        assert_eq!((found.points.len(), found.pieces.len()), (25, 24));
    }
}
