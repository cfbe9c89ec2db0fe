//! Edges seen along z: finds crossings, and the faces that edges bound.

use std::cmp::Ordering;
use std::collections::HashMap;
use std::ops::ControlFlow;

use super::{Defect, Drawing, MeshPart, MeshProblem};
use crate::math::{Vec2, Vec3};
use crate::sheet::boxes::{around, for_pairs_that_meet};

/// Sine of the angle below which three points count as collinear.
const ALIGNED: f64 = 1e-12;

/// A side that is compared with all others: its ends, and the part of the mesh that messages name.
pub(crate) type PlacedSide = ([usize; 2], MeshPart);

/// Checks that no two edges meet in the plane other than at common ends.
pub(crate) fn check_crossings(drawn: &Drawing, sides: &[PlacedSide]) -> Result<(), Defect> {
    let boxes: Vec<[Vec2; 2]> = sides.iter().map(|side| around(side.0.map(|v| drawn.coords[v].xy()), 0.0)).collect();
    let crossing = for_pairs_that_meet(&boxes, |p, q| match meet(&drawn.coords, sides[q].0, sides[p].0) {
        true => ControlFlow::Break([q, p]),
        false => ControlFlow::Continue(()),
    });
    let Some([a, b]) = crossing.break_value() else { return Ok(()) };
    let place = sides[b].1;
    let [a, b] = [a, b].map(|side| drawn.edge_name(sides[side].0));
    Err(Defect::new(place, MeshProblem::Crossing { a, b }))
}

/// Returns the orientation of the corner `a`, `b`, `c` seen from above, -1, 0 or 1; it is 0 within [`ALIGNED`].
fn turn(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    let (u, v) = ((b - a).xy(), (c - a).xy());
    let area = u.perp(&v);
    if area.abs() <= ALIGNED * u.norm() * v.norm() { 0.0 } else { area.signum() }
}

/// Whether `c` lies on the segment `a b`, ends included.
fn touches(a: Vec3, b: Vec3, c: Vec3) -> bool {
    turn(a, b, c) == 0.0 && (a - c).xy().dot(&(b - c).xy()) <= 0.0
}

fn meet(x: &[Vec3], p: [usize; 2], q: [usize; 2]) -> bool {
    if let Some(common) = p.iter().find(|v| q.contains(v)) {
        let [b, c] = [p, q].map(|s| x[if s[0] == *common { s[1] } else { s[0] }]);
        let [u, v] = [b, c].map(|end| (end - x[*common]).xy());
        return u.dot(&v) > 0.0 && u.perp(&v).powi(2) <= ALIGNED * ALIGNED * u.norm_squared() * v.norm_squared();
    }
    let ([a, b], [c, d]) = (p.map(|v| x[v]), q.map(|v| x[v]));
    let crosses = turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0;
    crosses || touches(a, b, c) || touches(a, b, d) || touches(c, d, a) || touches(c, d, b)
}

/// Returns the faces that `edges` bound, counter-clockwise seen from above.
///
/// Every edge is walked once in both directions, turning as far left as possible; a walk that runs clockwise is the
/// outer boundary of a piece. Edges must not cross, must separate two faces (or a face from the outside), and those of
/// one piece must not lie inside another one.
pub(crate) fn faces_of(drawn: &Drawing, edges: &[[usize; 2]]) -> Result<Vec<Vec<usize>>, Defect> {
    let x = &drawn.coords;
    let placed: Vec<_> = edges.iter().enumerate().map(|(e, &ends)| (ends, MeshPart::Edge(e))).collect();
    if let Some(&([a, b], place)) = placed.iter().find(|([a, b], _)| (x[*a] - x[*b]).xy().norm() == 0.0) {
        return Err(Defect::new(place, MeshProblem::Upright(drawn.edge_name([a, b]))));
    }
    super::check_places(drawn)?;
    check_crossings(drawn, &placed)?;
    let (walks, owner) = walks(&rounds(x, edges), edges);
    if let Some((e, &[a, b])) = edges.iter().enumerate().find(|(_, [a, b])| owner[&(*a, *b)] == owner[&(*b, *a)]) {
        let problem = MeshProblem::LooseEdge { edge: e, ends: drawn.edge_name([a, b]) };
        return Err(Defect::new(MeshPart::Edge(e), problem));
    }
    let (faces, outside): (Vec<_>, Vec<_>) = walks.into_iter().partition(|walk| area(x, walk) > 0.0);
    let Some(inner) = nested(x, &outside) else { return Ok(faces) };
    let edge = edges.iter().position(|ends| ends.contains(&inner)).unwrap_or_default();
    Err(Defect::new(MeshPart::Edge(edge), MeshProblem::Nested { edge, ends: drawn.edge_name(edges[edge]) }))
}

/// Returns a vertex of a closed walk that lies inside another one, of walks that do not cross.
fn nested(x: &[Vec3], walks: &[Vec<usize>]) -> Option<usize> {
    let bounds = |walk: &Vec<usize>| {
        let first = x[walk[0]].xy();
        walk.iter().fold([first; 2], |[low, high], &v| [low.inf(&x[v].xy()), high.sup(&x[v].xy())])
    };
    let boxes: Vec<[Vec2; 2]> = walks.iter().map(bounds).collect();
    let found = for_pairs_that_meet(&boxes, |p, q| {
        let inner = [(p, q), (q, p)].into_iter().find(|(inner, outer)| is_inside(x, walks[*inner][0], &walks[*outer]));
        inner.map_or(ControlFlow::Continue(()), |(inner, _)| ControlFlow::Break(walks[inner][0]))
    });
    found.break_value()
}

/// Whether a ray from vertex `v` along x leaves a closed walk: it crosses its sides an odd number of times.
fn is_inside(x: &[Vec3], v: usize, walk: &[usize]) -> bool {
    let at = x[v].xy();
    let crosses = |&(&a, &b): &(&usize, &usize)| {
        let [a, b] = [a, b].map(|end| x[end].xy() - at);
        (a.y > 0.0) != (b.y > 0.0) && (a.x * (b.y - a.y) - a.y * (b.x - a.x)) * (b.y - a.y) > 0.0
    };
    walk.iter().zip(walk.iter().cycle().skip(1)).filter(crosses).count() % 2 == 1
}

/// Returns the neighbours of every vertex, counter-clockwise.
fn rounds(x: &[Vec3], edges: &[[usize; 2]]) -> Vec<Vec<usize>> {
    let mut rounds = vec![Vec::new(); x.len()];
    for &[a, b] in edges {
        rounds[a].push(b);
        rounds[b].push(a);
    }
    for (v, round) in rounds.iter_mut().enumerate() {
        round.sort_by(|&a, &b| by_angle(x[a] - x[v], x[b] - x[v]));
    }
    rounds
}

/// Compares directions in the plane by their angle in `[0, 2 pi)`, without trigonometry.
fn by_angle(a: Vec3, b: Vec3) -> Ordering {
    let lower = |d: Vec3| d.y < 0.0 || (d.y == 0.0 && d.x < 0.0);
    lower(a).cmp(&lower(b)).then_with(|| 0.0f64.total_cmp(&a.xy().perp(&b.xy())))
}

type Owner = HashMap<(usize, usize), usize>;

/// Returns all closed walks that turn as far left as possible, and the walk to which each directed edge belongs.
fn walks(rounds: &[Vec<usize>], edges: &[[usize; 2]]) -> (Vec<Vec<usize>>, Owner) {
    let mut place = HashMap::new();
    for (v, round) in rounds.iter().enumerate() {
        place.extend(round.iter().enumerate().map(|(k, &from)| ((from, v), k)));
    }
    let next = |(from, at): (usize, usize)| {
        let round = &rounds[at];
        (at, round[(place[&(from, at)] + round.len() - 1) % round.len()])
    };
    let mut owner = Owner::new();
    let mut walks = Vec::new();
    for start in edges.iter().flat_map(|&[a, b]| [(a, b), (b, a)]) {
        let mut walk = Vec::new();
        let mut at = start;
        while !owner.contains_key(&at) {
            owner.insert(at, walks.len());
            walk.push(at.0);
            at = next(at);
        }
        if !walk.is_empty() {
            walks.push(walk);
        }
    }
    (walks, owner)
}

/// Returns the area of a closed walk seen from above, counter-clockwise positive.
pub(super) fn area(x: &[Vec3], walk: &[usize]) -> f64 {
    let origin = x[walk[0]];
    let pairs = walk.iter().zip(walk.iter().cycle().skip(1));
    pairs.map(|(&a, &b)| (x[a] - origin).xy().perp(&(x[b] - origin).xy())).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::error::DrawnEdge;

    fn drawn(xy: &[[f64; 2]]) -> Drawing {
        Drawing { coords: xy.iter().map(|p| Vec3::new(p[0], p[1], 0.0)).collect(), ..Drawing::default() }
    }

    /// Claim: the faces are the two triangles, counter-clockwise, although one edge is listed against its direction.
    #[test]
    fn faces_of_a_split_square() {
        let square = drawn(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        let faces = faces_of(&square, &[[0, 1], [2, 1], [2, 3], [3, 0], [0, 2]]).unwrap();
        assert_eq!(faces, [vec![0, 1, 2], vec![2, 3, 0]]);
    }

    /// Claim: crossing edges, a vertex on an edge, and two overlapping edges are found; neighbours are not reported.
    #[test]
    fn crossings() {
        let five = drawn(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0]]);
        assert!(meet(&five.coords, [0, 2], [1, 3]));
        assert!(meet(&five.coords, [0, 2], [1, 4]));
        assert!(meet(&five.coords, [0, 2], [0, 4]));
        assert!(!meet(&five.coords, [0, 4], [4, 2]));
        assert!(!meet(&five.coords, [0, 1], [4, 2]));
    }

    /// Claim: an edge with the outside on both sides bounds no face; two parts beside each other are two
    /// pieces, and one inside the other is refused.
    #[test]
    fn loose_edges_and_islands() {
        let xy = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [5.0, 0.0], [6.0, 0.0], [5.0, 1.0]];
        let loose = faces_of(&drawn(&xy), &[[0, 1], [1, 2], [2, 0], [1, 3]]).unwrap_err();
        assert!(matches!(*loose.problem, MeshProblem::LooseEdge { edge: 3, .. }), "{loose}");
        let apart = faces_of(&drawn(&xy), &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3]]).unwrap();
        assert_eq!(apart, [vec![0, 1, 2], vec![3, 4, 5]]);
        let within = [[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [1.0, 1.0], [2.0, 1.0], [1.0, 2.0]];
        let nested = faces_of(&drawn(&within), &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3]]).unwrap_err();
        assert_eq!(*nested.problem, MeshProblem::Nested { edge: 3, ends: DrawnEdge(3, 4) });
    }
}
