use super::*;
use crate::Implicit;
use foldwell_numerics::DenseMatrix;
use foldwell_numerics::derivatives::{TOLERANCE, check_jacobian};
use foldwell_numerics::vector::{dot, norm};
use std::collections::{HashMap, HashSet};
use std::f64::consts::{PI, TAU};

type Rows<const N: usize> = Vec<(f64, [f64; N])>;

/// A surface from a function that gives every residual with its gradient, and one for the limit.
struct TextbookSurface<const N: usize> {
    rows: fn(&[f64]) -> Rows<N>,
    period: Option<f64>,
    limit: fn(&[f64]) -> f64,
    crosses: bool,
    linearizations: usize,
}

impl<const N: usize> TextbookSurface<N> {
    fn new(rows: fn(&[f64]) -> Rows<N>) -> Self {
        Self { rows, period: None, limit: |_| -1.0, crosses: false, linearizations: 0 }
    }
}

impl<const N: usize> Implicit for TextbookSurface<N> {
    fn unknowns(&self) -> usize {
        N
    }
    fn equations(&self) -> usize {
        (self.rows)(&[0.3; N]).len()
    }
    fn linearize(&mut self, x: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix) {
        self.linearizations += 1;
        for (row, (value, gradient)) in (self.rows)(x).into_iter().enumerate() {
            residual[row] = value;
            gradient.iter().enumerate().for_each(|(column, entry)| jacobian[(row, column)] = *entry);
        }
    }
}

impl<const N: usize> Surface for TextbookSurface<N> {
    fn period(&self, _: usize) -> Option<f64> {
        self.period
    }
    fn limit(&mut self, x: &[f64]) -> f64 {
        (self.limit)(x)
    }
    fn crosses(&self) -> bool {
        self.crosses
    }
}

/// The unit sphere, twice over.
fn sphere(x: &[f64]) -> Rows<3> {
    let row = (dot(x, x) - 1.0, [2.0 * x[0], 2.0 * x[1], 2.0 * x[2]]);
    vec![row, (-3.0 * row.0, row.1.map(|entry| -3.0 * entry))]
}

/// A torus of radii 1 and 0.4.
fn torus(x: &[f64]) -> Rows<3> {
    let around = x[0].hypot(x[1]);
    let out = around - 1.0;
    vec![(out * out + x[2] * x[2] - 0.16, [2.0 * out * x[0] / around, 2.0 * out * x[1] / around, 2.0 * x[2]])]
}

/// A torus in four angles: c = a + 0.4 sin b, d = b - 0.3 cos a, modulo pi.
fn angles(x: &[f64]) -> Rows<4> {
    let (s, c) = (x[2] - x[0] - 0.4 * x[1].sin()).sin_cos();
    let (t, d) = (x[3] - x[1] + 0.3 * x[0].cos()).sin_cos();
    vec![(s, [-c, -0.4 * x[1].cos() * c, c, 0.0]), (t, [-0.3 * x[0].sin() * d, -d, 0.0, d])]
}

/// A paraboloid.
fn bowl(x: &[f64]) -> Rows<3> {
    vec![(x[2] - 0.5 * (x[0] * x[0] + x[1] * x[1]), [-x[0], -x[1], 1.0])]
}

/// A cone with its tip at the origin.
fn cone(x: &[f64]) -> Rows<3> {
    vec![(x[0] * x[0] + x[1] * x[1] - x[2] * x[2], [2.0 * x[0], 2.0 * x[1], -2.0 * x[2]])]
}

/// The parabolic cylinder `z = 0.3 x^2` and the plane `z = 0.6 y`, which cross along `y = x^2 / 2`.
fn crossing(x: &[f64]) -> Rows<3> {
    let [u, v] = [x[2] - 0.3 * x[0] * x[0], x[2] - 0.6 * x[1]];
    vec![(u * v, [-0.6 * x[0] * v, -0.6 * u, u + v])]
}

fn check<const N: usize>(rows: fn(&[f64]) -> Rows<N>) {
    let point: Vec<f64> = (0..N).map(|k| 0.4 + 0.37 * k as f64).collect();
    let found = rows(&point);
    let jacobian = DenseMatrix::from_fn(found.len(), N, |row, column| found[row].1[column]);
    check_jacobian(|x| rows(x).iter().map(|row| row.0).collect(), &point, &jacobian, TOLERANCE).unwrap();
}

/// Claim: the derivatives of the textbook surfaces are right.
#[test]
fn derivatives() {
    check(sphere);
    check(torus);
    check(angles);
    check(bowl);
    check(cone);
    check(crossing);
}

fn run<const N: usize>(surface: &mut TextbookSurface<N>, start: [f64; N], radius: f64) -> Atlas {
    let options = CoverOptions { radius, ..CoverOptions::default() };
    let atlas = cover(surface, &[start.to_vec()], options, &mut none, &mut |_| true).unwrap();
    for chart in &atlas.charts {
        let rows = (surface.rows)(&chart.x);
        let slope =
            |axis: usize| move |row: &(f64, [f64; N])| dot(&row.1, &chart.frame[axis * N..(axis + 1) * N]).abs();
        assert!(rows.iter().all(|row| row.0.abs() <= 1e-13), "{chart:?}");
        assert!([0, 1].iter().all(|axis| rows.iter().map(slope(*axis)).all(|slope| slope <= 1e-13)), "{chart:?}");
    }
    atlas
}

/// Numbers of a triangulation that is a manifold, oriented: every edge at most once in each sense, and the triangles at
/// every vertex one fan.
#[derive(Debug, PartialEq)]
struct TopologyCounts {
    euler: i64,
    /// Edges with a triangle on one side only.
    border: usize,
    vertices: usize,
}

fn topology(atlas: &Atlas) -> TopologyCounts {
    let mut edges = HashSet::new();
    let mut fans: HashMap<usize, Vec<[usize; 2]>> = HashMap::new();
    for [a, b, c] in &atlas.triangles {
        for [x, y, z] in [[a, b, c], [b, c, a], [c, a, b]] {
            assert!(edges.insert([*x, *y]), "edge {x} {y} twice in one sense");
            fans.entry(*x).or_default().push([*y, *z]);
        }
    }
    for (vertex, fan) in &fans {
        let ends: HashSet<usize> = fan.iter().map(|side| side[1]).collect();
        let first = fan.iter().map(|side| side[0]).find(|start| !ends.contains(start)).unwrap_or(fan[0][0]);
        let (mut at, mut seen) = (first, 0);
        while let Some(side) = fan.iter().find(|side| side[0] == at) {
            (at, seen) = (side[1], seen + 1);
            if at == first {
                break;
            }
        }
        assert_eq!(seen, fan.len(), "the triangles at vertex {vertex} are not one fan");
    }
    let border = edges.iter().filter(|[a, b]| !edges.contains(&[*b, *a])).count();
    assert_eq!(fans.len(), atlas.charts.len(), "every chart has triangles");
    let count = (edges.len() + border) / 2;
    let euler = fans.len() as i64 - count as i64 + atlas.triangles.len() as i64;
    TopologyCounts { euler, border, vertices: fans.len() }
}

/// Sum of the areas of the triangles, modulo the period, and the largest angle between a triangle and a tangent plane
/// at its corners, as a sine.
fn area(atlas: &Atlas, period: Option<f64>) -> f64 {
    let way = |from: usize, to: usize| -> Vec<f64> {
        let wrap = |d: f64| period.map_or(d, |period| d - period * (d / period).round());
        atlas.charts[to].x.iter().zip(&atlas.charts[from].x).map(|(b, a)| wrap(b - a)).collect()
    };
    let one = |[a, b, c]: &[usize; 3]| {
        let (u, v) = (way(*a, *b), way(*a, *c));
        let n = u.len();
        let frame = &atlas.charts[*a].frame;
        let part = |w: &[f64]| [dot(w, &frame[..n]), dot(w, &frame[n..])];
        let ([u0, u1], [v0, v1]) = (part(&u), part(&v));
        assert!(u0 * v1 - u1 * v0 > 0.0, "counter-clockwise in the frame");
        0.5 * (dot(&u, &u) * dot(&v, &v) - dot(&u, &v).powi(2)).sqrt()
    };
    atlas.triangles.iter().map(one).sum()
}

/// Claim: the unit sphere, from an equation and its multiple, is covered by a closed oriented triangulation of Euler
/// characteristic 2, whose area tends to 4 pi with the square of the radius. An equal hexagonal packing of edge h and
/// flat triangles would miss about h^2/12 of it to h^2/4, by the spread of the edges from one to two radii: 0.35
/// radius^2.
#[test]
fn sphere_is_closed() {
    let mut errors = Vec::new();
    for radius in [0.14, 0.07, 0.035] {
        let mut surface = TextbookSurface::new(sphere);
        let atlas = run(&mut surface, [0.0, 0.6, 0.8], radius);
        let found = topology(&atlas);
        assert_eq!((atlas.coverage, atlas.oriented, found.euler, found.border), (Coverage::Complete, true, 2, 0));
        let missing = 1.0 - area(&atlas, None) / (4.0 * PI);
        assert!(missing > 0.0 && missing <= 0.35 * radius * radius, "{missing} at {radius}");
        // Discs of half the radius do not overlap, discs of the radius cover.
        let discs = 4.0 / (radius * radius);
        assert!((found.vertices as f64) < 4.0 * discs && found.vertices as f64 > discs, "{} charts", found.vertices);
        assert!(surface.linearizations <= 11 * found.vertices, "{} linearizations", surface.linearizations);
        errors.push(missing);
    }
    assert!((errors[0] / errors[2]).log2() >= 3.0, "second order: {errors:?}");
}

/// Claim: of two surfaces that satisfy one equation and cross at angles up to 31 degrees, the one with the start is
/// covered as if the other were not there: one disc on both sides of the crossing, with the area of the parabolic
/// cylinder over the unit disc (the integral of `sqrt(1 + 0.36 x^2)`, by the midpoint rule), to the second order in the
/// radius. Tolerance of the place: the residual 1e-13 over the distance from the crossing.
#[test]
fn a_surface_is_followed_over_its_crossing_with_another() {
    let limit = |x: &[f64]| x[0] * x[0] + x[1] * x[1] - 1.0;
    let start = [0.3, -0.4, 0.3 * 0.09];
    let steps = 2000;
    let slab = |k: usize| {
        let x = -1.0 + (2.0 * k as f64 + 1.0) / steps as f64;
        2.0 * (1.0 - x * x).sqrt() * (1.0 + 0.36 * x * x).sqrt() * 2.0 / steps as f64
    };
    let exact: f64 = (0..steps).map(slab).sum();
    for radius in [0.12, 0.06] {
        let atlas = run(&mut TextbookSurface { limit, crosses: true, ..TextbookSurface::new(crossing) }, start, radius);
        let found = topology(&atlas);
        assert_eq!((atlas.coverage, atlas.oriented, found.euler), (Coverage::Complete, true, 1));
        let sides = |chart: &Chart| [chart.x[2] - 0.3 * chart.x[0] * chart.x[0], chart.x[2] - 0.6 * chart.x[1]];
        assert!(atlas.charts.iter().map(sides).all(|[u, v]| u.abs() <= 1e-12 / v.abs().max(1e-6)));
        for sign in [1.0, -1.0] {
            assert!(atlas.charts.iter().map(sides).filter(|[_, v]| sign * v > 0.05).count() > 20);
        }
        let missing = 1.0 - area(&atlas, None) / exact;
        assert!(missing.abs() <= 0.35 * radius * radius, "{missing} at {radius}");
    }
}

/// Claim: a torus in space is closed with Euler characteristic 0, its area 4 pi^2 R r to 0.5 times the square of radius
/// over smallest radius of curvature; charts become smaller where it turns more than allowed.
#[test]
fn torus_is_closed() {
    for radius in [0.1, 0.05] {
        let atlas = run(&mut TextbookSurface::new(torus), [1.4, 0.0, 0.0], radius);
        let found = topology(&atlas);
        assert_eq!((atlas.coverage, atlas.oriented, found.euler, found.border), (Coverage::Complete, true, 0, 0));
        let missing = 1.0 - area(&atlas, None) / (4.0 * PI * PI * 0.4);
        assert!(missing.abs() <= 0.5 * (radius / 0.4f64).powi(2), "{missing}");
    }
    let options = CoverOptions { radius: 0.2, max_turn: 0.2, ..CoverOptions::default() };
    let atlas =
        cover(&mut TextbookSurface::new(torus), &[vec![1.4, 0.0, 0.0]], options, &mut none, &mut |_| true).unwrap();
    assert_eq!((topology(&atlas).euler, topology(&atlas).border), (0, 0));
    let normal = |chart: usize| {
        nalgebra::Vector3::from_column_slice(&atlas.charts[chart].frame[..3])
            .cross(&nalgebra::Vector3::from_column_slice(&atlas.charts[chart].frame[3..]))
    };
    for [a, b, _] in &atlas.triangles {
        assert!(normal(*a).angle(&normal(*b)) <= 0.4, "neighbours are at most two radii apart");
    }
}

/// Claim: a torus of angles closes modulo 2 pi: Euler characteristic 0, no border, area as by the trapezoidal rule
/// (which converges exponentially) to 0.1 radius^2, half of what is missing at curvatures of 0.5.
#[test]
fn torus_of_angles_closes_over_its_periods() {
    let mut surface = TextbookSurface::new(angles);
    surface.period = Some(TAU);
    let atlas = run(&mut surface, [0.0, 0.0, 0.0, -0.3], 0.25);
    let found = topology(&atlas);
    assert_eq!((atlas.coverage, atlas.oriented, found.euler, found.border), (Coverage::Complete, true, 0, 0));
    let samples = 64;
    let element = |k: usize| {
        let [a, b] = [k / samples, k % samples].map(|k| TAU * k as f64 / samples as f64);
        let [u, v] = [[1.0, 0.0, 1.0, 0.3 * a.sin()], [0.0, 1.0, 0.4 * b.cos(), 1.0]];
        (dot(&u, &u) * dot(&v, &v) - dot(&u, &v).powi(2)).sqrt()
    };
    let expected = (TAU / samples as f64).powi(2) * (0..samples * samples).map(element).sum::<f64>();
    let missing = 1.0 - area(&atlas, Some(TAU)) / expected;
    assert!(missing.abs() <= 0.1 * 0.25 * 0.25, "{missing}");
}

/// Claim: a paraboloid cut by the cylinder of radius 1 about its axis is a disc: Euler characteristic 1, border on the
/// limit to 1e-12, nothing beyond it, area 2 pi (2 sqrt 2 - 1)/3 to 0.5 radius^2; no triangle is thin.
#[test]
fn limit_is_the_border() {
    for radius in [0.2, 0.1, 0.04] {
        let mut surface = TextbookSurface::new(bowl);
        surface.limit = |x| x[0].hypot(x[1]) - 1.0;
        let atlas = run(&mut surface, [0.1, 0.0, 0.005], radius);
        let found = topology(&atlas);
        assert_eq!((atlas.coverage, found.euler), (Coverage::Complete, 1));
        let border = atlas.charts.iter().filter(|chart| chart.limit.abs() <= 1e-12).count();
        assert_eq!(border, found.border, "as many edges as corners on the border");
        assert!(atlas.charts.iter().all(|chart| chart.limit <= 1e-12));
        assert!(atlas.charts[found.vertices - border..].iter().all(|chart| chart.limit.abs() <= 1e-12), "border last");
        let missing = 1.0 - area(&atlas, None) / (TAU * (8.0f64.sqrt() - 1.0) / 3.0);
        assert!(missing > 0.0 && missing <= 0.5 * radius * radius, "{missing}");
        for triangle in &atlas.triangles {
            assert!(smallest_height(&atlas, triangle) >= 0.1 * radius, "{triangle:?}");
        }
    }
}

fn smallest_height(atlas: &Atlas, [a, b, c]: &[usize; 3]) -> f64 {
    let way = |from: &usize, to: &usize| {
        atlas.charts[*to].x.iter().zip(&atlas.charts[*from].x).map(|(b, a)| b - a).collect::<Vec<f64>>()
    };
    let (u, v, w) = (way(a, b), way(a, c), way(b, c));
    let double = (dot(&u, &u) * dot(&v, &v) - dot(&u, &v).powi(2)).sqrt();
    double / norm(&u).max(norm(&v)).max(norm(&w))
}

/// Claim: charts never reach across the tip of a cone: from a start on one sheet only that sheet is covered, down to
/// a hole about as large as the smallest charts, and the coverage says that it is open; from a start on each, both are,
/// without a triangle between them.
#[test]
fn a_tip_is_not_crossed() {
    let mut surface = TextbookSurface::new(cone);
    surface.limit = |x| x[2].abs() - 1.0;
    let atlas = run(&mut surface, [0.3, 0.4, 0.5], 0.1);
    assert!(matches!(atlas.coverage, Coverage::Open { charts } if charts > 0), "{:?}", atlas.coverage);
    let lowest = atlas.charts.iter().map(|chart| chart.x[2]).fold(f64::INFINITY, f64::min);
    assert!(lowest > 0.0 && lowest <= 0.02, "{lowest}");
    let starts = [vec![0.3, 0.4, 0.5], vec![0.3, 0.4, -0.5], vec![0.31, 0.4, 0.506]];
    let options = CoverOptions { radius: 0.1, ..CoverOptions::default() };
    let both = cover(&mut surface, &starts, options, &mut none, &mut |_| true).unwrap();
    let side = |chart: usize| both.charts[chart].x[2] > 0.0;
    assert!(both.triangles.iter().all(|[a, b, c]| side(*a) == side(*b) && side(*b) == side(*c)));
    assert!(both.charts.iter().all(|chart| (chart.x[2] > 0.0) == (chart.start != 1)), "each knows its start");
    let upper = both.charts.iter().filter(|chart| chart.x[2] > 0.0).count();
    assert!(upper.abs_diff(atlas.charts.len()) * 20 <= upper && upper < both.charts.len(), "{upper}");
    assert_eq!(both.reached, [Some(0), Some(1), Some(0)], "the third lies in a chart of the first");
    // the same, with the lower sheet begun only after the upper one is covered, and a start that is nowhere
    let mut asked = 0;
    let mut further = |_: &mut TextbookSurface<3>, charts: &[Chart], _: &[[usize; 3]]| {
        asked += 1;
        assert_eq!(charts.iter().any(|chart| chart.x[2] < 0.0), asked > 1);
        if asked > 1 { vec![] } else { vec![starts[1].clone(), vec![0.0; 3]] }
    };
    let behind = cover(&mut surface, &starts[..1], options, &mut further, &mut |_| true).unwrap();
    assert_eq!((behind.reached, behind.charts.len()), (vec![Some(0), Some(1), None], both.charts.len()));
}

/// Claim: a singular start, a start off the surface, a small allowance and an impatient observer are all said.
#[test]
fn what_cannot_be_done_is_said() {
    let options = CoverOptions::default();
    let mut always = |_: usize| true;
    let tip = cover(&mut TextbookSurface::new(cone), &[vec![0.0; 3]], options, &mut none, &mut always);
    assert_eq!(tip, Err(AtlasError::Singular { start: 0, tangents: 3 }));
    let off = cover(&mut TextbookSurface::new(cone), &[vec![0.3, 0.4, 0.6]], options, &mut none, &mut always);
    assert!(matches!(off, Err(AtlasError::Start { start: 0 })), "{off:?}");
    let few = CoverOptions { max_charts: 50, ..options };
    let atlas = cover(&mut TextbookSurface::new(sphere), &[vec![0.0, 0.0, 1.0]], few, &mut none, &mut always).unwrap();
    assert_eq!(atlas.coverage, Coverage::TooManyCharts);
    let atlas =
        cover(&mut TextbookSurface::new(sphere), &[vec![0.0, 0.0, 1.0]], options, &mut none, &mut |_| false).unwrap();
    assert_eq!(atlas.coverage, Coverage::Interrupted);
}

/// No further starts.
fn none<S: Surface>(_surface: &mut S, _charts: &[Chart], _triangles: &[[usize; 3]]) -> Vec<Vec<f64>> {
    Vec::new()
}
