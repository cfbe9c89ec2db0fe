//! Crossings of triangles compared with exact integer arithmetic, and in sheets of known shape.
//!
//! The reference shares no code with the library: a point of a triangle is a convex combination of its corners, and
//! whether two triangles have a common point, or a point interior to both, is a linear program in the weights.
//! Coordinates are converted to integers over a common power of two, and the simplex method runs on integers without
//! division remainders.

use foldwell::analysis::intersections::{self, Triangle, crossings};
use foldwell::math::Vec3;
use num_bigint::BigInt;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;

type Point = [BigInt; 3];

/// Returns the coordinates of six points as integers over a common power of two.
fn integers(points: &[Vec3]) -> Vec<Point> {
    let parts = |x: f64| {
        let bits = x.to_bits();
        let (exponent, fraction) = ((bits >> 52 & 0x7ff) as i64, (bits & ((1 << 52) - 1)) as i64);
        let mantissa = if exponent == 0 { fraction } else { fraction | 1 << 52 };
        (mantissa * if x < 0.0 { -1 } else { 1 }, exponent.max(1))
    };
    let numbers = points.iter().flatten().map(|&x| parts(x));
    let least = numbers.filter(|(mantissa, _)| *mantissa != 0).map(|(_, exponent)| exponent).min().unwrap_or(0);
    let whole = |x: f64| match parts(x) {
        (0, _) => BigInt::ZERO,
        (mantissa, exponent) => BigInt::from(mantissa) << (exponent - least),
    };
    points.iter().map(|p| [whole(p.x), whole(p.y), whole(p.z)]).collect()
}

/// Whether `sum x_j columns_j = right` has a solution with all `x_j >= 0`: the first phase of the simplex method with
/// Bland's rule, on integers over a common denominator (pivots after J. Edmonds; every division is exact).
fn feasible(columns: &[Vec<BigInt>], right: &[BigInt]) -> bool {
    let mut rows: Vec<Vec<BigInt>> = Vec::new();
    for (k, r) in right.iter().enumerate() {
        let row = columns.iter().map(|column| column[k].clone()).chain([r.clone()]);
        rows.push(if *r < BigInt::ZERO { row.map(|x| -x).collect() } else { row.collect() });
    }
    // the last row is the sum of the artificial variables, which must become zero
    rows.push((0..=columns.len()).map(|j| rows.iter().map(|row| &row[j]).sum()).collect());
    let (m, n) = (right.len(), columns.len());
    let mut basis: Vec<usize> = (n..n + m).collect();
    let mut denominator = BigInt::from(1);
    loop {
        let Some(enter) = (0..n).find(|&j| rows[m][j] > BigInt::ZERO) else { return rows[m][n] == BigInt::ZERO };
        let leave = (0..m).filter(|&i| rows[i][enter] > BigInt::ZERO).min_by(|&i, &k| {
            let ratios = (&rows[i][n] * &rows[k][enter]).cmp(&(&rows[k][n] * &rows[i][enter]));
            ratios.then(basis[i].cmp(&basis[k]))
        });
        let leave = leave.expect("the sum of the artificial variables is bounded");
        let (pivot_row, pivot) = (rows[leave].clone(), rows[leave][enter].clone());
        for row in rows.iter_mut().enumerate().filter(|(i, _)| *i != leave).map(|(_, row)| row) {
            let factor = row[enter].clone();
            for (x, p) in row.iter_mut().zip(&pivot_row) {
                let product = &*x * &pivot - &factor * p;
                assert_eq!(&product % &denominator, BigInt::ZERO);
                *x = product / &denominator;
            }
        }
        basis[leave] = enter;
        denominator = pivot;
    }
}

fn minus(p: &Point, q: &Point) -> Point {
    [0, 1, 2].map(|k| &p[k] - &q[k])
}

fn cross(u: &Point, v: &Point) -> Point {
    [0, 1, 2].map(|k| &u[(k + 1) % 3] * &v[(k + 2) % 3] - &u[(k + 2) % 3] * &v[(k + 1) % 3])
}

/// The relative position of two closed triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Contact {
    /// No common point.
    Disjoint,
    /// Common points, but neither triangle passes through the other.
    Touching,
    /// Each triangle passes through the other.
    Crossing,
}

/// Returns the relative position of two triangles by its definition.
fn oracle(a: &Triangle, b: &Triangle) -> Contact {
    let points = integers(&[&a[..], &b[..]].concat());
    let (a, b) = points.split_at(3);
    let number = |x: i64| BigInt::from(x);
    // weights l_i, m_j >= 0 that add up to 1 each, with sum l_i a_i = sum m_j b_j
    let closed = |p: &Point, sign: i64, ends: [i64; 2]| -> Vec<BigInt> {
        p.iter().map(|x| x * sign).chain(ends.map(number)).collect()
    };
    let columns: Vec<_> =
        a.iter().map(|p| closed(p, 1, [1, 0])).chain(b.iter().map(|p| closed(p, -1, [0, 1]))).collect();
    if !feasible(&columns, &[0, 0, 0, 1, 1].map(number)) {
        return Contact::Disjoint;
    }
    // all weights positive, up to a common factor: l_i = 1 + x_i, m_j = 1 + y_j
    let open = |p: &Point, sign: i64| -> Vec<BigInt> { p.iter().chain([&number(1)]).map(|x| x * sign).collect() };
    let columns: Vec<_> = a.iter().map(|p| open(p, 1)).chain(b.iter().map(|p| open(p, -1))).collect();
    let right: Vec<BigInt> = (0..4).map(|k| -columns.iter().map(|column| &column[k]).sum::<BigInt>()).collect();
    let normal = |t: &[Point]| cross(&minus(&t[1], &t[0]), &minus(&t[2], &t[0]));
    let parallel = cross(&normal(a), &normal(b)).iter().all(|x| *x == BigInt::ZERO);
    if !parallel && feasible(&columns, &right) { Contact::Crossing } else { Contact::Touching }
}

/// A generator of random pairs of triangles.
struct Source {
    numbers: ChaCha8Rng,
}

impl Source {
    fn uniform(&mut self) -> f64 {
        2.0 * self.numbers.random::<f64>() - 1.0
    }

    fn below(&mut self, n: usize) -> usize {
        self.numbers.random_range(0..n)
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.uniform(), self.uniform(), self.uniform())
    }

    fn triangle(&mut self) -> Triangle {
        [self.point(), self.point(), self.point()]
    }

    fn grid_point(&mut self, most: usize) -> Vec3 {
        Vec3::from([0; 3].map(|_| self.below(2 * most + 1) as f64 - most as f64))
    }

    fn on_grid(&mut self, most: usize) -> [Triangle; 2] {
        [0; 2].map(|_| [0; 3].map(|_| self.grid_point(most)))
    }

    /// Returns a point of a triangle, on its edges or next to it, as near to its plane as double precision allows.
    fn near(&mut self, t: &Triangle) -> Vec3 {
        let weights = [0.0, 0.25, 0.5, 1.0, self.uniform(), 1.5];
        let (u, v) = (weights[self.below(6)], weights[self.below(6)]);
        t[0] + (t[1] - t[0]) * u + (t[2] - t[0]) * v
    }

    /// Moves a point by up to two units in the last place in each coordinate.
    fn nudged(&mut self, p: Vec3) -> Vec3 {
        p.map(|x| (0..self.below(3)).fold(x, |x, _| if self.below(2) == 0 { x.next_up() } else { x.next_down() }))
    }

    /// Moves a point by about 1e-15.
    fn shifted(&mut self, p: Vec3) -> Vec3 {
        p + self.point() * 2e-15
    }

    /// Returns a pair of this kind.
    fn pair(&mut self, kind: &str) -> [Triangle; 2] {
        let mut a = self.triangle();
        let mut b = self.triangle();
        match kind {
            "at random" => {}
            "on a grid" => return self.on_grid(2),
            "on a finer grid" => return self.on_grid(4).map(|t| t.map(|p| p * 0.1 + Vec3::repeat(0.7))),
            "in a plane of the axes" => [a, b] = [a, b].map(|t| t.map(|p| Vec3::new(p.y, 0.5, p.x))),
            "in a plane, exactly" => {
                let (origin, e, f) = (self.grid_point(9), self.grid_point(5), self.grid_point(5));
                let grid = self.on_grid(3);
                [a, b] = grid.map(|t| t.map(|p| (origin + e * p.x + f * p.y) / 64.0));
            }
            "in a plane, rounded" => b = [0; 3].map(|_| self.near(&a)),
            "stacked, 1e-15 apart" => b = [0; 3].map(|_| self.near(&a)).map(|p| self.shifted(p)),
            "a corner near the other" => {
                let corner = self.near(&a);
                b[0] = self.nudged(corner);
            }
            "an edge near a corner" => {
                let [way, corner] = [self.point(), a[1]];
                [b[0], b[1]] = [self.nudged(corner + way), self.nudged(corner - way)];
            }
            "edges near each other" => {
                let (way, place) = (self.point(), a[0] + (a[1] - a[0]) * self.uniform());
                [b[0], b[1]] = [self.shifted(place + way), self.nudged(place - way * 0.5)];
            }
            "needles" => {
                let part = 10f64.powi(-(self.below(17) as i32));
                a[2] = a[0] + (a[1] - a[0]) * self.uniform() + self.point() * part;
                b[2] = b[0] + (b[1] - b[0]) * self.uniform() + self.point() * part;
            }
            "without area" => {
                let grid = self.on_grid(2);
                [a, b] = grid;
                a[2] = [a[0], 2.0 * a[1] - a[0], 0.5 * (a[0] + a[1])][self.below(3)];
                if self.below(2) == 0 {
                    b[1] = b[0] + (b[2] - b[0]) * (self.below(5) as f64 - 1.0);
                }
            }
            "far from the origin" => [a, b] = [a, b].map(|t| t.map(|p| p + Vec3::new(1e6, -3e5, 7.0))),
            "of very different sizes" => b = b.map(|p| p * 1e-9 + (a[0] + a[1] * 2.0 + a[2]) / 4.0),
            other => panic!("no such kind: {other}"),
        }
        [a, b]
    }
}

const KINDS: [&str; 14] = [
    "at random",
    "on a grid",
    "on a finer grid",
    "in a plane of the axes",
    "in a plane, exactly",
    "in a plane, rounded",
    "stacked, 1e-15 apart",
    "a corner near the other",
    "an edge near a corner",
    "edges near each other",
    "needles",
    "without area",
    "far from the origin",
    "of very different sizes",
];

/// Claim: all verdicts are right for 14 kinds of pairs, each with no common corner, one, and a common edge; also for
/// the pair in reverse order, with its corners in another order, mirrored, and scaled by a power of two. Source: the
/// reference above. No tolerance. Every verdict occurs, in all kinds together at least a hundred times for each number
/// of common corners that allows it.
#[test]
fn no_wrong_verdict() {
    let mut counts: BTreeMap<(usize, String), usize> = BTreeMap::new();
    let mut pairs = 0;
    for (k, kind) in KINDS.iter().enumerate() {
        let mut source = Source { numbers: ChaCha8Rng::seed_from_u64(k as u64) };
        for round in 0..1500 {
            let [a, mut b] = source.pair(kind);
            let common = round % 3;
            let place = source.below(3);
            (0..common).for_each(|c| b[(place + c) % 3] = a[c]);
            let expected = oracle(&a, &b);
            let crossing = expected == Contact::Crossing;
            assert_eq!(intersections::cross(&a, &b), crossing, "{kind}: {a:?} {b:?}");
            let scale = 2f64.powi(source.below(120) as i32 - 60);
            let mirrored = |p: Vec3| Vec3::new(p.z, p.x, -p.y) * scale;
            let (p, q) = (source.below(3), source.below(3));
            let (turned, swapped) = ([b[p], b[(p + 2) % 3], b[(p + 1) % 3]], [a[q], a[(q + 1) % 3], a[(q + 2) % 3]]);
            let other = intersections::cross(&turned.map(mirrored), &swapped.map(mirrored));
            assert_eq!(other, crossing, "{kind}, mirrored and scaled by {scale}: {a:?} {b:?}");
            *counts.entry((common, format!("{expected:?}"))).or_default() += 1;
            pairs += 1;
        }
    }
    println!("{pairs} pairs: {counts:?}");
    assert!(pairs >= 20_000);
    for (common, verdicts) in
        [(0, &["Disjoint", "Touching", "Crossing"][..]), (1, &["Touching", "Crossing"]), (2, &["Touching"])]
    {
        let found: Vec<_> = counts.keys().filter(|(c, _)| *c == common).collect();
        assert_eq!(found.len(), verdicts.len(), "{counts:?}");
        for verdict in verdicts {
            assert!(counts[&(common, verdict.to_string())] >= 100, "{common} {verdict}: {counts:?}");
        }
    }
}

/// Claim: the reference itself is right in evident cases: a triangle and another one that passes through it, lies on
/// it, or lies apart from it.
#[test]
fn the_oracle_sees_what_the_eye_sees() {
    let base = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Vec3::from);
    let other = |z: f64| [[1.0, 1.0, z], [1.5, 1.0, z + 2.0], [1.0, 1.5, z + 2.0]].map(Vec3::from);
    assert_eq!(oracle(&base, &other(-1.0)), Contact::Crossing);
    assert_eq!(oracle(&base, &other(0.0)), Contact::Touching);
    assert_eq!(oracle(&base, &other(5e-324)), Contact::Disjoint);
    assert_eq!(oracle(&base, &base.map(|p| p * 0.5)), Contact::Touching);
    assert_eq!(oracle(&base, &other(-2.0)), Contact::Touching);
    assert_eq!(oracle(&base, &other(-2.5)), Contact::Disjoint);
}

/// Claim: the search over boxes finds every pair that a search over all pairs finds, in random heaps of triangles some
/// of which share corners. Source: the definition, pair by pair.
#[test]
fn boxes_lose_no_pair() {
    let mut source = Source { numbers: ChaCha8Rng::seed_from_u64(77) };
    let mut all = 0;
    for size in [0, 1, 2, 3, 4, 40, 150] {
        for flat in [1.0, 0.0, 0.3] {
            let points: Vec<Vec3> =
                (0..size).map(|_| source.point().component_mul(&Vec3::new(1.0, flat, 1.0))).collect();
            let mut corner = || source.below(size);
            let mut triangles: Vec<[usize; 3]> =
                if size < 3 { vec![] } else { (0..size).map(|_| [corner(), corner(), corner()]).collect() };
            triangles.retain(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
            let found = crossings(&points, &triangles);
            let at = |k: usize| triangles[k].map(|point| points[point]);
            let mut expected = Vec::new();
            for i in 0..triangles.len() {
                expected
                    .extend((i + 1..triangles.len()).filter(|&j| intersections::cross(&at(i), &at(j))).map(|j| [i, j]));
            }
            assert_eq!(found.pairs, expected);
            let marked = |k: usize| expected.iter().any(|pair| pair.contains(&k));
            assert!(found.faces.iter().enumerate().all(|(k, &face)| face == marked(k)));
            all += expected.len();
        }
    }
    assert!(all > 1000, "{all}");
}
