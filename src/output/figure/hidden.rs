//! Hidden surfaces: sorts pieces (triangles and lines) from back to front, the order in which they are painted.
//!
//! Two pieces whose projections overlap are compared where they overlap; an order by mean depths would be wrong for
//! long faces next to short ones. If two pieces pass through each other, the smaller one is cut by the plane of the
//! other (M. E. Newell, R. G. Newell, T. L. Sancha, Proc. ACM National Conf. 1972). Pieces that hide each other
//! cyclically, the strongly connected components of the relation "is painted before", are cut by planes of triangles
//! among them until there is a correct order (H. Fuchs, Z. M. Kedem, B. F. Naylor, SIGGRAPH 1980). All other pieces
//! stay whole.

use std::collections::HashMap;

use super::style::PaperPoint;
use crate::math::{Vec3, bounds};

/// Distances that count as zero, relative to the extent of the scene: in general, and in a scene of many pieces, where
/// surfaces that nearly coincide would otherwise be cut into far more pieces that cannot be distinguished.
const TOUCHING: [f64; 2] = [1e-6, 1e-3];
/// Number of pieces above which a scene has many.
const MANY: usize = 30_000;
/// Area that counts as zero, relative to the square of the extent of the scene.
const NO_AREA: f64 = 1e-10;
/// Distance by which lines are moved towards the eye before the faces on which they lie are cut, relative to the extent
/// of the scene.
const LIFT: f64 = 2e-5;
/// Largest number of planes among which the one that cuts the fewest pieces is chosen.
const TRIED: usize = 12;

/// A triangle or a line segment, or a part of one that was cut.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Piece {
    /// Corners, with coordinates to the right, upwards and towards the eye.
    pub corners: Vec<Vec3>,
    /// Index of the triangle or line of which it is a part.
    pub item: usize,
    /// Plane of a triangle; `None` for lines.
    plane: Option<TrianglePlane>,
}

/// The plane of the points `p` with `normal . p = height`; the normal points to the side of the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TrianglePlane {
    normal: Vec3,
    height: f64,
}

/// Returns the pieces from back to front, cut where there is no correct order. Triangles seen edge-on and pieces with
/// corners that are not finite are left out.
pub(crate) fn back_to_front(mut pieces: Vec<Piece>) -> Vec<Piece> {
    pieces.retain(|piece| piece.corners.iter().flatten().all(|x| x.is_finite()));
    let limits = Limits::of(&pieces);
    pieces.retain(|piece| piece.is_line() || 0.5 * turn(&piece.corners).abs() > limits.area);
    let mut pieces = apart(pieces, &limits);
    pieces.sort_by(|a, b| a.depth().total_cmp(&b.depth()));
    let mut before = vec![Vec::new(); pieces.len()];
    for [a, b] in close_pairs(&pieces) {
        match order(&pieces[a], &pieces[b], &limits) {
            Order::Apart => {}
            Order::Behind => before[b].push(a),
            Order::InFront => before[a].push(b),
            Order::Through => {
                before[a].push(b);
                before[b].push(a);
            }
        }
    }
    let mut ordered = Vec::with_capacity(pieces.len());
    for group in components(&before) {
        let alone = group.len() == 1;
        let group: Vec<Piece> = group.into_iter().map(|k| pieces[k].clone()).collect();
        if alone { ordered.extend(group) } else { cut(lifted(group, limits.lift), &limits, &mut ordered) }
    }
    ordered
}

/// Lengths and areas that are too small to be seen.
struct Limits {
    length: f64,
    area: f64,
    lift: f64,
}

impl Limits {
    fn of(pieces: &[Piece]) -> Self {
        let [low, high] = bounds(pieces.iter().flat_map(|piece| &piece.corners));
        let size = (high - low).max().max(0.0);
        let touching = TOUCHING[usize::from(pieces.len() > MANY)];
        Self { length: touching * size, area: NO_AREA * size * size, lift: LIFT.max(2.0 * touching) * size }
    }
}

impl Piece {
    /// Makes a triangle of three corners, or a line of two.
    pub(crate) fn new(corners: Vec<Vec3>, item: usize) -> Self {
        let plane = (corners.len() > 2).then(|| TrianglePlane::through([corners[0], corners[1], corners[2]])).flatten();
        Self { corners, item, plane }
    }

    fn is_line(&self) -> bool {
        self.corners.len() == 2
    }

    fn depth(&self) -> f64 {
        self.corners.iter().map(|corner| corner.z).sum::<f64>() / self.corners.len() as f64
    }

    /// Whether the piece has corners behind a plane and in front of it.
    fn sides(&self, plane: &TrianglePlane, limits: &Limits) -> [bool; 2] {
        let above = || self.corners.iter().map(|corner| plane.above(corner));
        [above().any(|d| d < -limits.length), above().any(|d| d > limits.length)]
    }

    /// Returns the parts in front of a plane and behind it; `None` if the piece lies on one side of it.
    fn cut_by(&self, plane: &TrianglePlane, limits: &Limits) -> Option<[Self; 2]> {
        (self.sides(plane, limits) == [true, true]).then(|| [1.0, -1.0].map(|sign| self.part(plane, sign)))
    }

    fn part(&self, plane: &TrianglePlane, sign: f64) -> Self {
        let mut corners = clipped(&self.corners, |corner| sign * plane.above(&corner), |p, q, part| p + (q - p) * part);
        if self.is_line() {
            corners.truncate(2);
        }
        Self { corners, ..*self }
    }

    /// Returns the depth (coordinate towards the eye) of the piece at a point of the figure.
    fn depth_at(&self, [x, y]: PaperPoint) -> f64 {
        if let Some(TrianglePlane { normal, height }) = self.plane {
            return (height - normal.x * x - normal.y * y) / normal.z;
        }
        let [a, b] = [self.corners[0], self.corners[1]];
        let along = [b.x - a.x, b.y - a.y];
        let length = along[0] * along[0] + along[1] * along[1];
        let part = if length > 0.0 { ((x - a.x) * along[0] + (y - a.y) * along[1]) / length } else { 0.5 };
        a.z + part.clamp(0.0, 1.0) * (b.z - a.z)
    }
}

impl TrianglePlane {
    fn through([a, b, c]: [Vec3; 3]) -> Option<Self> {
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        let normal = normal * if normal.z < 0.0 { -1.0 } else { 1.0 };
        Some(Self { normal, height: normal.dot(&a) })
    }

    fn above(&self, place: &Vec3) -> f64 {
        place.dot(&self.normal) - self.height
    }
}

/// Cuts pieces that pass through each other: the smaller one by the plane of the other.
fn apart(pieces: Vec<Piece>, limits: &Limits) -> Vec<Piece> {
    let size = |k: usize| if pieces[k].is_line() { 0.0 } else { turn(&pieces[k].corners).abs() };
    let mut cuts: Vec<Vec<TrianglePlane>> = vec![Vec::new(); pieces.len()];
    for [a, b] in close_pairs(&pieces) {
        if order(&pieces[a], &pieces[b], limits) == Order::Through {
            let [small, large] = if size(a) < size(b) { [a, b] } else { [b, a] };
            cuts[small].extend(pieces[large].plane);
        }
    }
    let mut found = Vec::with_capacity(pieces.len());
    for (piece, planes) in pieces.into_iter().zip(cuts) {
        let mut parts = vec![piece];
        for plane in planes {
            let cut = |part: Piece| match part.cut_by(&plane, limits) {
                Some(two) => Vec::from(two),
                None => vec![part],
            };
            parts = parts.into_iter().flat_map(cut).collect();
        }
        found.extend(parts);
    }
    found
}

/// Returns twice the area of a polygon in the figure, positive if its corners are counter-clockwise.
fn turn(corners: &[Vec3]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| a.x * b.y - b.x * a.y).sum()
}

/// The relative order of two pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    /// Their projections do not overlap.
    Apart,
    /// The first is painted before the second.
    Behind,
    /// The first is painted after the second.
    InFront,
    /// One passes through the other.
    Through,
}

/// Returns the order of `a` relative to `b`.
fn order(a: &Piece, b: &Piece, limits: &Limits) -> Order {
    if a.is_line() && b.is_line() {
        return Order::Apart;
    }
    if b.is_line() {
        return match order(b, a, limits) {
            Order::Behind => Order::InFront,
            Order::InFront => Order::Behind,
            other => other,
        };
    }
    if a.is_line() && a.corners.iter().all(|end| b.corners.contains(end)) {
        return Order::InFront;
    }
    let places = overlap(a, b);
    let corners: Vec<Vec3> = places.iter().map(|[x, y]| Vec3::new(*x, *y, 0.0)).collect();
    let longest = |from: &Vec3| corners.iter().map(|to| (to - from).norm()).fold(0.0, f64::max);
    let meet = match corners.first() {
        None => false,
        Some(first) if a.is_line() => longest(first) > limits.length,
        Some(_) => 0.5 * turn(&corners).abs() > limits.area,
    };
    if !meet {
        return Order::Apart;
    }
    let above = places.iter().map(|place| a.depth_at(*place) - b.depth_at(*place));
    let (low, high) = above.fold((0.0f64, 0.0f64), |(low, high), d| (low.min(d), high.max(d)));
    match (high > limits.length, low < -limits.length) {
        (true, true) => Order::Through,
        (true, false) => Order::InFront,
        (false, true) => Order::Behind,
        // they coincide; lines are painted after the faces on which they lie
        (false, false) if a.is_line() || low + high > 0.0 => Order::InFront,
        (false, false) if low + high < 0.0 => Order::Behind,
        (false, false) => Order::Apart,
    }
}

/// Returns the corners of the common part of the projections of a piece and a triangle.
fn overlap(a: &Piece, b: &Piece) -> Vec<PaperPoint> {
    let mut places: Vec<PaperPoint> = a.corners.iter().map(|corner| [corner.x, corner.y]).collect();
    let sense = turn(&b.corners).signum();
    for k in 0..b.corners.len() {
        let (from, to) = (b.corners[k], b.corners[(k + 1) % b.corners.len()]);
        let inside = |[x, y]: PaperPoint| sense * ((to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x));
        places = clipped(&places, inside, |p, q, part| [0, 1].map(|k| p[k] + part * (q[k] - p[k])));
        if places.is_empty() {
            break;
        }
    }
    places
}

/// Returns the part of a convex polygon in which a function, linear between corners, is not negative.
fn clipped<P: Copy>(corners: &[P], inside: impl Fn(P) -> f64, between: impl Fn(P, P, f64) -> P) -> Vec<P> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (k, &corner) in corners.iter().enumerate() {
        let next = corners[(k + 1) % corners.len()];
        let (here, there) = (inside(corner), inside(next));
        if here >= 0.0 {
            kept.push(corner);
        }
        if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
            kept.push(between(corner, next, here / (here - there)));
        }
    }
    kept
}

/// Returns all pairs of pieces whose bounding boxes in the figure overlap, each once. Candidates are the pieces that
/// share a square of a grid.
fn close_pairs(pieces: &[Piece]) -> Vec<[usize; 2]> {
    let bounds = |piece: &Piece| {
        let all = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        piece.corners.iter().fold(all, |[l, b, r, t], c| [l.min(c.x), b.min(c.y), r.max(c.x), t.max(c.y)])
    };
    let boxes: Vec<[f64; 4]> = pieces.iter().map(bounds).collect();
    let width = |[left, bottom, right, top]: &[f64; 4]| (right - left).max(top - bottom);
    let side = 2.0 * boxes.iter().map(width).sum::<f64>() / boxes.len().max(1) as f64;
    let square = |x: f64| (x / side.max(f64::MIN_POSITIVE)).floor() as i64;
    let mut squares: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    let mut pairs = Vec::new();
    for (k, [left, bottom, right, top]) in boxes.iter().enumerate() {
        for x in square(*left)..=square(*right) {
            for y in square(*bottom)..=square(*top) {
                let others = squares.entry([x, y]).or_default();
                for &other in others.iter() {
                    let [l, b, r, t] = boxes[other];
                    let meet = l <= *right && *left <= r && b <= *top && *bottom <= t;
                    // each pair is counted only in the first square that both share
                    if meet && [x, y] == [square(left.max(l)), square(bottom.max(b))] {
                        pairs.push([other, k]);
                    }
                }
                others.push(k);
            }
        }
    }
    pairs
}

/// Returns the strongly connected components of a relation (R. Tarjan, SIAM J. Comput. 1, 146 (1972)). A component
/// comes after all members that are before any of its own; otherwise the order is that of the indices.
fn components(before: &[Vec<usize>]) -> Vec<Vec<usize>> {
    const NEW: usize = usize::MAX;
    let mut found = Vec::new();
    let (mut number, mut lowest) = (vec![NEW; before.len()], vec![NEW; before.len()]);
    let (mut open, mut is_open, mut count) = (Vec::new(), vec![false; before.len()], 0);
    for root in 0..before.len() {
        let mut path: Vec<(usize, usize)> = if number[root] == NEW { vec![(root, 0)] } else { Vec::new() };
        while let Some((node, child)) = path.pop() {
            if child == 0 {
                (number[node], lowest[node], is_open[node]) = (count, count, true);
                count += 1;
                open.push(node);
            } else {
                let last = before[node][child - 1];
                if is_open[last] {
                    lowest[node] = lowest[node].min(lowest[last]);
                }
            }
            if let Some(&next) = before[node].get(child) {
                path.push((node, child + 1));
                if number[next] == NEW {
                    path.push((next, 0));
                }
            } else if lowest[node] == number[node] {
                let start = open.iter().rposition(|other| *other == node).unwrap_or(0);
                let group = open.split_off(start);
                group.iter().for_each(|other| is_open[*other] = false);
                found.push(group);
            }
        }
    }
    found
}

/// Moves the lines towards the eye, so that they are painted after all faces on which they lie.
fn lifted(mut group: Vec<Piece>, lift: f64) -> Vec<Piece> {
    let lines = group.iter_mut().filter(|piece| piece.is_line());
    lines.flat_map(|piece| &mut piece.corners).for_each(|end| end.z += lift);
    group
}

/// Appends the pieces of a group to `ordered` from back to front, cut by planes of its triangles (a BSP tree).
fn cut(group: Vec<Piece>, limits: &Limits, ordered: &mut Vec<Piece>) {
    let mut tasks = vec![(group, false)];
    while let Some((mut pieces, done)) = tasks.pop() {
        let plane = if done { None } else { fewest_cuts(&pieces, limits) };
        let Some(plane) = plane else {
            pieces.sort_by(|a, b| a.is_line().cmp(&b.is_line()).then(a.depth().total_cmp(&b.depth())));
            ordered.extend(pieces);
            continue;
        };
        let (mut behind, mut on, mut front) = (Vec::new(), Vec::new(), Vec::new());
        for piece in pieces {
            match piece.sides(&plane, limits) {
                [true, true] => {
                    front.push(piece.part(&plane, 1.0));
                    behind.push(piece.part(&plane, -1.0));
                }
                [true, false] => behind.push(piece),
                [false, true] => front.push(piece),
                [false, false] => on.push(piece),
            }
        }
        tasks.extend([(front, false), (on, true), (behind, false)]);
    }
}

/// Returns the plane of a triangle among the pieces that cuts the fewest of them; `None` if no cut is needed.
fn fewest_cuts(pieces: &[Piece], limits: &Limits) -> Option<TrianglePlane> {
    if pieces.len() < 2 {
        return None;
    }
    // the corners of a thin piece may have moved off its plane by rounding
    let is_flat = |piece: &Piece, plane: &TrianglePlane| piece.sides(plane, limits) == [false, false];
    let planes = pieces.iter().filter_map(|piece| piece.plane.filter(|plane| is_flat(piece, plane)));
    let planes: Vec<TrianglePlane> = planes.collect();
    let cuts = |plane: &TrianglePlane| pieces.iter().filter(|piece| piece.sides(plane, limits) == [true, true]).count();
    let every = planes.len().div_ceil(TRIED).max(1);
    planes.into_iter().step_by(every).min_by_key(cuts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn triangle(item: usize, corners: [[f64; 3]; 3]) -> Piece {
        Piece::new(corners.map(Vec3::from).to_vec(), item)
    }

    /// Whether a point of the figure lies in a triangle, at least `margin` from its sides.
    fn covers(piece: &Piece, place: PaperPoint, margin: f64) -> bool {
        let corners = &piece.corners;
        let side = |k: usize| {
            let (p, q) = (corners[k], corners[(k + 1) % corners.len()]);
            let across = (q.x - p.x) * (place[1] - p.y) - (q.y - p.y) * (place[0] - p.x);
            across / (q - p).xy().norm().max(1e-12)
        };
        let sense = turn(corners).signum();
        !piece.is_line() && (0..corners.len()).all(|k| sense * side(k) >= margin)
    }

    /// Checks at many points that the nearest face to the eye is painted last.
    fn check(faces: &[Piece], random: &mut ChaCha8Rng) -> (usize, usize) {
        let ordered = back_to_front(faces.to_vec());
        let mut seen = 0;
        for _ in 0..4000 {
            let place = [0, 1].map(|_| random.random_range(-1.0..1.0));
            let within = faces.iter().filter(|face| covers(face, place, 1e-4));
            let nearest = within.max_by(|a, b| a.depth_at(place).total_cmp(&b.depth_at(place)));
            let painted = ordered.iter().rev().find(|piece| covers(piece, place, 0.0));
            let (Some(nearest), Some(painted)) = (nearest, painted) else { continue };
            seen += 1;
            let painted = &faces[painted.item];
            assert!(nearest.depth_at(place) - painted.depth_at(place) <= 1e-3, "{place:?}: {nearest:?} {painted:?}");
        }
        (ordered.len(), seen)
    }

    /// Claim: three long triangles that hide each other cyclically are painted so that each hides the next, which needs
    /// one cut; any order by mean depths is wrong for one of them.
    #[test]
    fn circle_of_three() {
        let beam = |item: usize| {
            let turned = |x: f64, y: f64, z: f64| {
                let (sin, cos) = (item as f64 * std::f64::consts::TAU / 3.0).sin_cos();
                [cos * x - sin * y, sin * x + cos * y, z]
            };
            triangle(item, [turned(-0.9, 0.25, -0.4), turned(0.9, 0.2, 0.4), turned(0.9, 0.3, 0.4)])
        };
        let faces: Vec<Piece> = (0..3).map(beam).collect();
        let limits = Limits::of(&faces);
        let circle = [0, 1, 2].map(|k| order(&faces[k], &faces[(k + 1) % 3], &limits));
        assert!(circle == [Order::Behind; 3] || circle == [Order::InFront; 3], "{circle:?}");
        let (pieces, seen) = check(&faces, &mut ChaCha8Rng::seed_from_u64(1));
        assert!((4..=6).contains(&pieces) && seen > 100, "{pieces} {seen}");
    }

    /// Claim: of many random triangles that pass through each other, the nearest is seen at every point.
    #[test]
    fn random_triangles() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        for count in [2, 10, 40] {
            let mut corner = || [0, 1, 2].map(|_| random.random_range(-1.0..1.0));
            let faces: Vec<Piece> = (0..count).map(|k| triangle(k, [corner(), corner(), corner()])).collect();
            check(&faces, &mut random);
        }
    }

    /// Claim: faces of a sheet that do not pass through each other stay whole, also next to much larger ones.
    #[test]
    fn sheets_stay_whole() {
        let far = triangle(0, [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.9]]);
        let near = |k: usize| {
            let x = -0.5 + 0.01 * k as f64;
            triangle(k + 1, [[x, -0.9, 0.1], [x + 0.01, -0.9, 0.1], [x, -0.88, 0.1]])
        };
        let faces: Vec<Piece> = std::iter::once(far).chain((0..90).map(near)).collect();
        assert_eq!(check(&faces, &mut ChaCha8Rng::seed_from_u64(3)).0, 91);
        assert_eq!(back_to_front(faces)[0].item, 0, "mean depth 0.3 is above that of the others, and yet it is behind");
    }

    /// Claim: a line on faces is painted after them and before the faces that hide it; of a line that passes through a
    /// face, only the part behind it is hidden.
    #[test]
    fn lines() {
        let face = triangle(0, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let cover = triangle(1, [[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [0.0, 1.0, 0.5]]);
        let rim = Piece::new(face.corners[..2].to_vec(), 2);
        let through = Piece::new(vec![Vec3::new(0.1, 0.1, 1.0), Vec3::new(0.4, 0.4, 0.2)], 3);
        let ordered = back_to_front(vec![rim, through, cover, face]);
        let place = |item: usize| ordered.iter().position(|piece| piece.item == item).unwrap();
        assert!(place(0) < place(2) && place(2) < place(1), "{ordered:?}");
        let parts: Vec<(bool, f64)> =
            ordered.iter().enumerate().filter(|(_, p)| p.item == 3).map(|(k, p)| (k > place(1), p.depth())).collect();
        assert!(parts.len() == 2 && parts.iter().all(|(after, depth)| *after == (*depth > 0.5)), "{parts:?}");
    }

    /// Claim: pieces that are edge-on, without extent or not finite are left out; an empty scene is allowed.
    #[test]
    fn what_cannot_be_seen() {
        let side = triangle(0, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.0, 1.0]]);
        let lost = triangle(1, [[0.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0], [0.5, 1.0, 1.0]]);
        assert_eq!(back_to_front(vec![side, lost]), []);
        assert_eq!(back_to_front(vec![]), []);
    }
}
