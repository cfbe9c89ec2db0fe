//! The arrangement of segments in the plane: their points and the pieces between them, which meet at common points
//! only.
//!
//! This is iterated snap rounding (D. Halperin, E. Packer, "Iterated snap rounding", Computational Geometry 23, 2002)
//! with clusters of points in the place of the cells of a grid, so that no line of the grid parts two points that are
//! close. Points within a tolerance of each other are one cluster, which stands at the first of them. Then segments are
//! split at the clusters that lie on them, within the tolerance, and where two of them cross, which exact determinants
//! decide; a point on a segment and near its end is that end. A split moves a segment by up to the tolerance, so that
//! this is repeated until nothing is left to split. Every repetition makes pieces shorter or points fewer: a part of a
//! piece is longer than the tolerance and shorter than the piece. At last points go [back](super::straight) onto the
//! segments that they split.

use std::collections::{HashMap, HashSet};
use std::ops::ControlFlow;

use robust::{Coord, orient2d};

use super::piece::SegmentPiece;
use super::straight::straighten;
use crate::math::Vec2;
use crate::math::pieces::find;
use crate::sheet::boxes::{around, for_pairs_that_meet};
use crate::sheet::sides::sorted;

/// Most repetitions of splitting; two are usual.
const MOST_ROUNDS: usize = 20;

/// Distance in tolerances within which a point that lies on a piece is the end of the piece. From the square root of 2
/// on, both parts of a split piece are shorter than the piece: the point is at most 1 off the piece, and then at least
/// 1 along it from either end.
const NEAR_END: f64 = std::f64::consts::SQRT_2;

/// Largest distance in tolerances of the end of a segment from the point that it becomes. Ends that are meant to be one
/// point are a few tolerances apart; a longer chain of near points is a curve drawn in small steps, which would vanish.
const WIDEST: f64 = 4.0;

/// Distance in tolerances up to which points are not told apart: without it every line of a bundle through one point would
/// have a point of its own there, beside those of all others.
const SAME_POINT: f64 = 1.0 / 16.0;

/// Most points of an arrangement; ten thousand lines that all cross have a hundred times as many.
const MOST_POINTS: usize = 500_000;

/// The reason why segments have no arrangement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Disorder {
    /// The end of the segment of this number belongs to a chain of near points that is too wide for one point, or its
    /// pieces are still split after all repetitions.
    Tangled(usize),
    /// The lines meet at more points than this number, which is the limit.
    TooMany(usize),
}

/// Points and pieces of segments; pieces are in the order of their segments. Those of segments that lie on each other
/// have the same ends.
#[derive(Clone, Debug, Default)]
pub(crate) struct Arrangement {
    /// Positions of the points, those that no piece has included, as they are drawn.
    pub points: Vec<Vec2>,
    /// Where they stand on the segments that they split, which thus stay straight.
    pub straight: Vec<Vec2>,
    /// Pieces of all segments; segments within the tolerance have none.
    pub pieces: Vec<SegmentPiece>,
}

/// Returns the arrangement of `segments`, whose points are merged within the length `tolerance`; without `split` they
/// are only merged. Adds the number of pairs of pieces that were compared to `compared`.
pub(crate) fn arrange(
    segments: &[[Vec2; 2]],
    tolerance: f64,
    split: bool,
    compared: &mut usize,
) -> Result<Arrangement, Disorder> {
    let mut places =
        MergedPoints { tolerance, points: vec![], merged: vec![], merges: 0, cells: HashMap::new(), before: vec![] };
    let numbered = segments.iter().map(|ends| ends.map(|end| places.number(end)));
    let drawn: Vec<SegmentPiece> = numbered.enumerate().map(|(segment, ends)| SegmentPiece { ends, segment }).collect();
    let mut pieces = places.distinct(drawn.clone());
    let mut straight = None;
    if split {
        let mut rounds = 0;
        while let Some(parts) = split_once(&mut places, &pieces, compared)? {
            pieces = parts;
            rounds += 1;
            if rounds > MOST_ROUNDS {
                return Err(Disorder::Tangled(pieces.first().map_or(0, |piece| piece.segment)));
            }
        }
        let mut moved = places.clone();
        let ends: Vec<SegmentPiece> = drawn.iter().map(|piece| places.at_first(piece)).collect();
        straighten(&mut moved.points, (segments, &ends), &pieces, tolerance);
        // where that parts pieces anew, points stay as they are drawn
        straight = matches!(split_once(&mut moved, &pieces, compared), Ok(None)).then_some(moved.points);
    }
    for piece in &drawn {
        for (end, v) in segments[piece.segment].iter().zip(piece.ends) {
            if (places.position(v) - end).norm() > WIDEST * tolerance {
                return Err(Disorder::Tangled(piece.segment));
            }
        }
    }
    let straight = straight.unwrap_or_else(|| places.points.clone());
    Ok(Arrangement { points: places.points, straight, pieces })
}

/// Points, those within the tolerance of each other merged, found by their place in a grid.
#[derive(Clone)]
struct MergedPoints {
    tolerance: f64,
    points: Vec<Vec2>,
    /// For each point, itself or an earlier point with which it is one.
    merged: Vec<usize>,
    /// Number of merges so far.
    merges: usize,
    /// The last point in every cell of a grid, which is two tolerances wide, and for each point the one before it
    /// there.
    cells: HashMap<[i64; 2], usize>,
    before: Vec<Option<usize>>,
}

impl MergedPoints {
    /// Returns the number of a point at `x`, merged with the points within the tolerance.
    fn number(&mut self, x: Vec2) -> usize {
        let cell = |c: f64| (c / (2.0 * self.tolerance)).floor() as i64;
        let mut near: Vec<usize> = Vec::new();
        for i in cell(x.x - self.tolerance)..=cell(x.x + self.tolerance) {
            for j in cell(x.y - self.tolerance)..=cell(x.y + self.tolerance) {
                let mut next = self.cells.get(&[i, j]).copied();
                while let Some(v) = next {
                    if self.is_at(v, x) {
                        return v;
                    }
                    if (self.points[v] - x).norm() <= self.tolerance {
                        near.push(v);
                    }
                    next = self.before[v];
                }
            }
        }
        let new = self.points.len();
        self.points.push(x);
        self.merged.push(new);
        self.before.push(self.cells.insert([cell(x.x), cell(x.y)], new));
        near.into_iter().for_each(|v| self.merge(v, new));
        new
    }

    /// Whether point `v` is not told apart from one at `x`.
    fn is_at(&self, v: usize, x: Vec2) -> bool {
        (self.points[v] - x).norm() <= SAME_POINT * self.tolerance
    }

    /// Returns the first of the points that are one with `v`.
    fn first(&mut self, v: usize) -> usize {
        find(&mut self.merged, v)
    }

    /// A piece between the points that its ends are one with.
    fn at_first(&mut self, piece: &SegmentPiece) -> SegmentPiece {
        SegmentPiece { ends: piece.ends.map(|v| self.first(v)), ..*piece }
    }

    fn position(&mut self, v: usize) -> Vec2 {
        let first = self.first(v);
        self.points[first]
    }

    fn merge(&mut self, v: usize, w: usize) {
        let [v, w] = [v, w].map(|v| self.first(v));
        if v != w {
            self.merged[v.max(w)] = v.min(w);
            self.merges += 1;
        }
    }

    /// Returns the pieces between merged points: without those of no length, and each piece of a segment once.
    fn distinct(&mut self, pieces: Vec<SegmentPiece>) -> Vec<SegmentPiece> {
        let mut known = HashSet::new();
        let pieces = pieces.into_iter().map(|piece| self.at_first(&piece));
        pieces.filter(|p| p.ends[0] != p.ends[1] && known.insert((p.segment, sorted(p.ends)))).collect()
    }
}

/// Returns the parts of the pieces between the points at which they meet; `None` if there is nothing to split or merge.
fn split_once(
    places: &mut MergedPoints,
    pieces: &[SegmentPiece],
    compared: &mut usize,
) -> Result<Option<Vec<SegmentPiece>>, Disorder> {
    let mut edges: Vec<[usize; 2]> = Vec::new();
    let mut numbers = HashMap::new();
    let mut number = |ends: [usize; 2]| {
        *numbers.entry(sorted(ends)).or_insert_with(|| {
            edges.push(ends);
            edges.len() - 1
        })
    };
    let edge_of: Vec<usize> = pieces.iter().map(|piece| number(piece.ends)).collect();
    let merges = places.merges;
    let ends = edges.iter().map(|ends| ends.map(|v| places.points[v]));
    let boxes: Vec<[Vec2; 2]> = ends.map(|ends| around(ends, places.tolerance)).collect();
    let mut cuts = Cuts { of_edge: vec![Vec::new(); edges.len()], edges, places };
    let stopped = for_pairs_that_meet(&boxes, |p, q| {
        cuts.meet(p, q);
        *compared += 1;
        let points = cuts.places.points.len();
        if points > MOST_POINTS { ControlFlow::Break(Disorder::TooMany(points)) } else { ControlFlow::Continue(()) }
    });
    if let ControlFlow::Break(disorder) = stopped {
        return Err(disorder);
    }
    let Cuts { of_edge, places, .. } = cuts;
    if of_edge.iter().all(Vec::is_empty) && places.merges == merges {
        return Ok(None);
    }
    let parts = pieces.iter().zip(edge_of).flat_map(|(piece, edge)| parts(places, *piece, &of_edge[edge])).collect();
    Ok(Some(places.distinct(parts)))
}

/// The points at which edges are to be split.
struct Cuts<'p> {
    places: &'p mut MergedPoints,
    /// The ends of every edge; pieces of several segments may lie on one edge.
    edges: Vec<[usize; 2]>,
    of_edge: Vec<Vec<usize>>,
}

impl Cuts<'_> {
    /// Splits two edges where they meet.
    fn meet(&mut self, p: usize, q: usize) {
        let [ends_p, ends_q] = [self.edges[p], self.edges[q]];
        if self.go_apart(ends_p, ends_q) || self.is_beside(ends_p, ends_q) || self.is_beside(ends_q, ends_p) {
            return;
        }
        let mut touching = false;
        for (edge, ends, points) in [(p, ends_p, ends_q), (q, ends_q, ends_p)] {
            for v in points {
                if touches(self.places, ends, v) {
                    self.split(edge, v);
                    touching = true;
                }
            }
        }
        if touching || ends_p.iter().any(|v| ends_q.contains(v)) {
            return;
        }
        let [[a, b], [c, d]] = [ends_p, ends_q].map(|ends| ends.map(|v| self.places.points[v]));
        let [from, to] = [turn(c, d, a), turn(c, d, b)];
        if from * to >= 0.0 || turn(a, b, c) * turn(a, b, d) >= 0.0 {
            return;
        }
        let x = a + (b - a) * (from / (from - to));
        let mut last = [p, q].into_iter().filter_map(|edge| self.of_edge[edge].last().copied());
        let v = last.find(|&v| self.places.is_at(v, x)).unwrap_or_else(|| self.places.number(x));
        [p, q].into_iter().for_each(|edge| self.split(edge, v));
    }

    /// Whether edges have an end in common and go apart from there, so that they touch nowhere else: of many lines through
    /// one point all pairs are asked.
    fn go_apart(&self, ends: [usize; 2], others: [usize; 2]) -> bool {
        let Some(k) = (0..2).find(|&k| others.contains(&ends[k])) else { return false };
        let l = usize::from(others[1] == ends[k]);
        let [from, one, other] = [ends[k], ends[1 - k], others[1 - l]].map(|v| self.places.points[v]);
        let [one, other] = [one - from, other - from];
        let longest = one.norm_squared().max(other.norm_squared());
        one.perp(&other).powi(2) > self.places.tolerance.powi(2) * longest
    }

    /// Whether an edge lies on one side of the line of another, farther from it than points are merged, so that they meet
    /// nowhere: of many lines side by side nearly all pairs do.
    fn is_beside(&self, ends: [usize; 2], others: [usize; 2]) -> bool {
        let [[a, b], [c, d]] = [ends, others].map(|ends| ends.map(|v| self.places.points[v]));
        let along = d - c;
        let [from, to] = [a, b].map(|x| along.perp(&(x - c)));
        let near = self.places.tolerance.powi(2) * along.norm_squared();
        from * to > 0.0 && from.powi(2).min(to.powi(2)) > near
    }

    /// Splits an edge at a point, which is merged with the end of the edge if it is near.
    fn split(&mut self, edge: usize, v: usize) {
        let v = self.places.first(v);
        let x = self.places.points[v];
        let off = self.edges[edge].map(|end| (self.places.points[end] - x).norm());
        let nearer = usize::from(off[1] < off[0]);
        if off[nearer] <= NEAR_END * self.places.tolerance {
            self.places.merge(v, self.edges[edge][nearer]);
        } else if self.of_edge[edge].last() != Some(&v) {
            self.of_edge[edge].push(v);
        }
    }
}

/// Whether point `v` lies between the ends of an edge, within the tolerance; the ends themselves do not.
fn touches(places: &MergedPoints, ends: [usize; 2], v: usize) -> bool {
    if ends.contains(&v) {
        return false;
    }
    let ([a, b], x) = (ends.map(|v| places.points[v]), places.points[v]);
    let along = b - a;
    let (squared, t) = (along.norm_squared(), (x - a).dot(&along));
    t > 0.0 && t < squared && (x - a).perp(&along).powi(2) <= places.tolerance.powi(2) * squared
}

/// Returns twice the signed area of a triangle, with the right sign however thin it is.
fn turn(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| Coord { x: p.x, y: p.y });
    orient2d(a, b, c)
}

/// Returns the parts of a piece between these points on it.
fn parts(places: &mut MergedPoints, piece: SegmentPiece, cuts: &[usize]) -> Vec<SegmentPiece> {
    let [a, b] = piece.ends;
    let mut cuts: Vec<usize> = cuts.iter().map(|&v| places.first(v)).collect();
    let along = |v: usize| (places.points[v] - places.points[a]).dot(&(places.points[b] - places.points[a]));
    cuts.sort_by(|&v, &w| along(v).total_cmp(&along(w)).then(v.cmp(&w)));
    cuts.dedup();
    let stops: Vec<usize> = [a].into_iter().chain(cuts).chain([b]).collect();
    stops.windows(2).map(|w| SegmentPiece { ends: [w[0], w[1]], ..piece }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn arranged(segments: &[[f64; 4]]) -> Arrangement {
        let ends = segments.iter().map(|s| [Vec2::new(s[0], s[1]), Vec2::new(s[2], s[3])]);
        arrange(&ends.collect::<Vec<_>>(), 1e-6, true, &mut 0).unwrap()
    }

    fn points(found: &Arrangement) -> usize {
        found.pieces.iter().flat_map(|piece| piece.ends).collect::<HashSet<_>>().len()
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
        assert_eq!(ends(&corner), [[0, 1], [1, 3]]);
        let overlap = arranged(&[[0.0, 0.0, 2.0, 0.0], [3.0, 0.0, 1.0, 0.0]]);
        assert_eq!(ends(&overlap), [[0, 3], [3, 1], [2, 1], [1, 3]]);
    }

    /// Claim: `n` random lines through a disc that all cross pairwise have `n (n - 1) / 2` crossings and `n^2` pieces,
    /// and three lines through one point have one. Source: no three of the random lines meet in one point.
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
        assert_eq!((points(&found), found.pieces.len()), (80 + 780, 1600));
        let pencil: Vec<_> = (0..12).map(|k| line(k as f64 * 0.25, 0.0)).collect();
        let found = arranged(&pencil);
        assert_eq!((points(&found), found.pieces.len()), (25, 24));
    }

    /// Claim: three lines that miss one point by 1.1 tolerances meet in one point, and so do lines of one grid point
    /// whose ends form a chain; a curve in steps below the tolerance is refused with its first line. Source: counted by
    /// hand.
    #[test]
    fn near_points_are_one_point() {
        let third = |k: usize| Vec2::new((k as f64 * 2.0 * PI / 3.0).cos(), (k as f64 * 2.0 * PI / 3.0).sin());
        let side = |k: usize| {
            let (across, along) = (third(k) * 0.32e-6, Vec2::new(-third(k).y, third(k).x));
            let [a, b] = [across - along, across + along];
            [a.x, a.y, b.x, b.y]
        };
        let triangle = arranged(&[0, 1, 2].map(side));
        assert_eq!((points(&triangle), triangle.pieces.len()), (7, 6));
        let chain = arranged(&[[0.0, 0.0, 1.0, 0.0], [0.0, 1.8e-6, 0.0, 1.0], [0.0, 0.9e-6, 1.0, 1.0]]);
        assert_eq!(ends(&chain), [[0, 1], [0, 3], [0, 5]]);
        let step = |k: usize| Vec2::new(k as f64 * 0.9e-6, 0.0);
        let curve: Vec<[Vec2; 2]> = (0..10).map(|k| [step(k), step(k + 1)]).collect();
        assert_eq!(arrange(&curve, 1e-6, true, &mut 0).unwrap_err(), Disorder::Tangled(4));
    }
}
