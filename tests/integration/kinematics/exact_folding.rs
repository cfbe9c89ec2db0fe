//! Exact folding compared with closed forms and counts: null spaces, degree-four vertices, Miura-ori, the eggbox,
//! developable sheets, and the closed loops of the reference cell.

use crate::common::{Numbers, distance, mesh};
use approx::abs_diff_eq;
use foldwell::kinematics::{Closure, Embedding, Shape, folding_modes};
use foldwell::math::Vec3;
use foldwell::numerics::DenseMatrix;
use foldwell::numerics::dense::{least_squares, null_space};
use foldwell::sheet::generate::{Eggbox, Miura, Random, RandomDevelopable};
use foldwell::sheet::{EdgeKey, EdgeKind, Pattern, Sheet, fold, generate};
use std::f64::consts::{FRAC_PI_2, PI};

/// Length in fold angles (radians) of the longest step of Newton's method.
const LONGEST_STEP: f64 = 0.2;
/// Tolerance within which rotations commute, positions close and bars keep their lengths, as the library promises.
const COMPATIBLE: f64 = 1e-13;

/// A sheet to be folded, with some of its edges held.
struct Folding {
    sheet: Sheet,
    closure: Closure,
    embedding: Embedding,
}

impl Folding {
    fn new(sheet: Sheet, held: &[usize]) -> Self {
        let closure = Closure::of_cell(&sheet).unwrap().with_locked(held);
        let embedding = Embedding::new(&sheet).unwrap();
        Self { sheet, closure, embedding }
    }

    fn drawn(&self) -> Vec<f64> {
        self.embedding.drawn_angles().to_vec()
    }

    fn nullity(&self, angles: &[f64]) -> usize {
        null_space(&self.closure.jacobian(angles)).unwrap().basis.ncols()
    }

    /// Returns `angles + step * rates`, with a rate for each edge that folds.
    fn moved(&self, angles: &[f64], rates: &[f64], step: f64) -> Vec<f64> {
        let mut moved = angles.to_vec();
        self.closure.folding_edges().iter().zip(rates).for_each(|(&edge, rate)| moved[edge] += step * rate);
        moved
    }

    /// Makes angles close by steps of least norm; `None` if this does not converge.
    fn close(&self, mut angles: Vec<f64>) -> Option<Vec<f64>> {
        for _ in 0..100 {
            let residual = self.closure.residual(&angles);
            if residual.amax() <= 4e-15 {
                return Some(angles);
            }
            let right = DenseMatrix::from_column_slice(residual.len(), 1, residual.as_slice());
            let step = least_squares(&self.closure.jacobian(&angles), &right).ok()?.solution;
            angles = self.moved(&angles, step.as_slice(), -(LONGEST_STEP / step.norm()).min(1.0));
        }
        None
    }

    /// Returns the shape, after checking that it is compatible and has the drawn lengths of bars.
    fn shape(&self, angles: &[f64]) -> Shape {
        let placement = self.embedding.place(angles);
        let bars = self.sheet.edges.iter().map(|edge| {
            let ends = edge.key.ends();
            let [drawn, placed] = [ends.map(|end| self.sheet.position(end)), ends.map(|end| placement.corner(end))]
                .map(|[i, j]| (j - i).norm());
            (placed / drawn - 1.0).abs()
        });
        let (ways, bars) = (placement.compatibility, bars.fold(0.0, f64::max));
        assert!(ways <= COMPATIBLE && bars <= COMPATIBLE, "{}: {ways:e}, {bars:e}", self.sheet.title);
        Shape::of(&self.embedding, placement).unwrap()
    }
}

/// Numbers of vertices of the random cells along the two lattice vectors.
const SIZES: [[usize; 2]; 5] = [[2, 2], [2, 3], [3, 3], [4, 3], [4, 4]];
const SEEDS: u64 = 40;

/// Claim: the closure of 200 random cells has 3 null vectors in the drawn, spatially periodic state, and 2 on a
/// cylinder near it, along a ray on the cone of cylinders, whose curvature is about that of the ray. Source: McInerney
/// et al. (2020), "Folding motions and the index theorem": 3 in periodic states, 2 in screw-periodic ones. The
/// curvature is required within a factor of two, because the rays of some cells bend sharply.
#[test]
fn null_spaces_of_random_cells() {
    for size in SIZES {
        for seed in 0..SEEDS {
            let random = Random { size, seed, ..Random::default() };
            let folding = Folding::new(generate(&Pattern::Random(random)).unwrap(), &[]);
            let drawn = folding.drawn();
            assert_eq!(folding.nullity(&drawn), 3, "{size:?} {seed}");
            let (c, s) = (seed as f64).sin_cos();
            let ray = folding_modes(&folding.sheet).unwrap().named([c * c, s * s, c * s]).unwrap();
            let length = ray.iter().map(|rate| rate * rate).sum::<f64>().sqrt();
            let cylinder = folding.close(folding.moved(&drawn, &ray, 1e-4 / length)).unwrap();
            assert_eq!(folding.nullity(&cylinder), 2, "{size:?} {seed}");
            let ratio = folding.shape(&cylinder).curvature / (1e-4 / length);
            assert!((0.5..2.0).contains(&ratio), "{size:?} {seed}: {ratio}");
        }
    }
}

/// Claim: the closure of 200 random flat cells has Nv + 2 null vectors. Source: as above.
#[test]
fn null_spaces_of_flat_cells() {
    for size in SIZES {
        for seed in 0..SEEDS {
            let random = RandomDevelopable { size, seed, ..RandomDevelopable::default() };
            let folding = Folding::new(generate(&Pattern::RandomDevelopable(random)).unwrap(), &[]);
            assert_eq!(folding.nullity(&folding.drawn()), size[0] * size[1] + 2, "{size:?} {seed}");
        }
    }
}

/// Claim: along every folding of a flat sheet both chords become shorter (a chord is shorter than the path on the
/// sheet); near the flat state these cells also have `strain22 < 0`, which on an oblique lattice is not the strain of a
/// length and can be positive elsewhere (`tests/integration/kinematics/folding_theory.rs`); and the mirror image has
/// the same strain and the opposite curvature. States: those to which Newton's method converges from random angles.
/// Tolerance of the mirror image: rounding errors.
#[test]
fn developable_sheets_get_shorter() {
    let (mut folded, mut near) = (0, 0);
    for seed in 0..20 {
        let random = RandomDevelopable { size: [2, 2 + seed as usize % 2], seed, ..RandomDevelopable::default() };
        let folding = Folding::new(generate(&Pattern::RandomDevelopable(random)).unwrap(), &[]);
        let mut numbers = Numbers::new(seed);
        for size in [0.1, 0.2, 0.3, 0.6, 1.0, 1.5] {
            let start = numbers.many(folding.sheet.edges.len(), size);
            let Some(angles) = folding.close(start) else { continue };
            let (shape, drawn) = (folding.shape(&angles), folding.sheet.lattice.unwrap());
            assert!((0..2).all(|a| shape.screw.chords[a].norm() < drawn[a].norm()));
            let largest = angles.iter().fold(0.0, |most: f64, angle| most.max(angle.abs()));
            if largest < 0.5 {
                assert!(shape.strain[0] < 0.0 && shape.strain[1] < 0.0, "{:?}", shape.strain);
                near += 1;
            }
            let mirrored = folding.shape(&angles.iter().map(|angle| -angle).collect::<Vec<_>>());
            assert!(distance(&shape.strain, &mirrored.strain) <= 1e-13);
            assert!((shape.curvature + mirrored.curvature).abs() <= 1e-12 * shape.curvature.abs().max(1.0));
            folded += 1;
        }
    }
    assert!(folded >= 50 && near >= 20, "{folded} {near}");
}

/// Returns the four faces around a vertex with sectors between these directions, as a finite sheet.
fn fan(directions: &[Vec3; 4]) -> Sheet {
    let points: Vec<[f64; 3]> = [Vec3::zeros()].iter().chain(directions).map(|x| (*x).into()).collect();
    let text =
        format!(r#"{{"vertices_coords": {points:?}, "faces_vertices": [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]}}"#);
    fold::parse(&text, "fan.fold").unwrap()
}

fn crease(sheet: &Sheet, i: usize, j: usize) -> usize {
    sheet.edges.iter().position(|edge| edge.key == EdgeKey { i, j, shift: [0, 0], round: 0 }).unwrap()
}

/// Claim: at a vertex with four creases, opposite fold angles satisfy `cos rho2 = A cos rho0 + B`, with `A = sin t3 sin
/// t0 / (sin t1 sin t2)` and `B = (cos t1 cos t2 - cos t3 cos t0) / (sin t1 sin t2)` and the sector `t_k` between
/// creases `k` and `k + 1`: both sides give the angle between crease 1 and crease 3 (law of cosines on the sphere).
/// Pyramids, saddles and flat ones. Tolerance: rounding errors divided by the sensitivity of closure, which grows if
/// the cosine is near one.
#[test]
fn vertices_of_degree_four() {
    let mut numbers = Numbers::new(7);
    let mut checked = 0;
    for case in 0..30 {
        let heights = [[0.5, 0.5, 0.5, 0.5], [0.6, -0.6, 0.6, -0.6], [0.0; 4]][case % 3];
        let directions: [Vec3; 4] = std::array::from_fn(|k| {
            let (sin, cos) = (FRAC_PI_2 * k as f64 + numbers.within(0.3)).sin_cos();
            Vec3::new(cos, sin, heights[k])
        });
        let sector = |k: usize| directions[k % 4].angle(&directions[(k + 1) % 4]);
        let [t0, t1, t2, t3] = [0, 1, 2, 3].map(sector);
        let a = t3.sin() * t0.sin() / (t1.sin() * t2.sin());
        let b = (t1.cos() * t2.cos() - t3.cos() * t0.cos()) / (t1.sin() * t2.sin());
        let sheet = fan(&directions);
        let [first, opposite] = [crease(&sheet, 0, 1), crease(&sheet, 0, 3)];
        let folding = Folding::new(sheet, &[first]);
        for _ in 0..20 {
            let mut start = numbers.many(folding.sheet.edges.len(), 2.0);
            start[first] = numbers.within(3.0);
            let expected = a * start[first].cos() + b;
            if expected.abs() > 0.99 {
                continue;
            }
            let Some(angles) = folding.close(start) else { continue };
            assert!(abs_diff_eq!(angles[opposite].cos(), expected, epsilon = 1e-12), "{case}");
            checked += 1;
        }
    }
    assert!(checked >= 200, "{checked}");
}

/// A cell of four rigid parallelograms.
struct Quads {
    folding: Folding,
    creases: Vec<usize>,
    /// The crease that is driven; the diagonals are held too.
    driven: usize,
}

impl Quads {
    fn new(sheet: Sheet) -> Self {
        let of_kind = |kind| (0..sheet.edges.len()).filter(|&e| sheet.edges[e].kind == kind).collect::<Vec<_>>();
        let (creases, mut held) = (of_kind(EdgeKind::Crease), of_kind(EdgeKind::Facet));
        let driven = *creases.iter().find(|&&edge| along_x(&sheet, edge)).unwrap();
        held.push(driven);
        Self { folding: Folding::new(sheet, &held), creases, driven }
    }

    /// Folds, from the previous state, until every crease along x has the fold angle `along` and all others `across`,
    /// each with its drawn sign. Returns the lengths of the cell.
    fn check(&self, angles: &mut Vec<f64>, along: f64, across: f64) -> [f64; 2] {
        let drawn = self.folding.drawn();
        angles[self.driven] = along.copysign(drawn[self.driven]);
        *angles = self.folding.close(angles.clone()).unwrap();
        for &edge in &self.creases {
            let expected = if along_x(&self.folding.sheet, edge) { along } else { across };
            let found = angles[edge];
            assert!(
                abs_diff_eq!(found, expected.copysign(drawn[edge]), epsilon = 2e-12),
                "{edge}: {found} for {expected}"
            );
        }
        let shape = self.folding.shape(angles);
        assert!(shape.curvature.abs() <= 1e-12 && shape.theta.iter().all(|theta| theta.abs() <= 1e-12));
        shape.screw.chords.map(|chord| chord.norm())
    }
}

/// Whether an edge connects vertices of one row.
fn along_x(sheet: &Sheet, edge: usize) -> bool {
    sheet.edges[edge].key.i / 2 == sheet.edges[edge].key.j / 2
}

/// Claim: Miura-ori folds along `g` with fold angles `2 g` of the zigzag creases and `tan(straight/2) = cos(sector)
/// tan(zigzag/2)` of the straight ones (T. Tachi, "Generalization of rigid-foldable quadrilateral-mesh origami", 2009,
/// equal sectors), its cells measure `2 b cos g tan t / sqrt(1 + cos^2 g tan^2 t)` by `2 a sqrt(1 - sin^2 g sin^2 t)`
/// (M. Schenk and S. D. Guest, PNAS 110, 3276, 2013), from nearly flat to nearly folded, and it has no curvature.
/// Tolerance: the residual, 4e-15, divided by the softest singular value, which is least near the ends.
#[test]
fn miura_along_the_whole_fold() {
    let pattern = Miura { a: 1.3, b: 0.8, sector: 1.1, fold: 0.3 };
    let Miura { a, b, sector: t, .. } = pattern;
    let quads = Quads::new(generate(&Pattern::Miura(pattern)).unwrap());
    for way in [-1.0, 1.0] {
        let (mut angles, mut g) = (quads.folding.drawn(), 0.3);
        while (0.02..FRAC_PI_2 - 0.02).contains(&g) {
            let [first, second] = quads.check(&mut angles, 2.0 * g, 2.0 * (t.cos() * g.tan()).atan());
            let run = g.cos() * t.tan();
            assert!((first - 2.0 * b * run / (1.0 + run * run).sqrt()).abs() <= 1e-12);
            assert!((second - 2.0 * a * (1.0 - (g.sin() * t.sin()).powi(2)).sqrt()).abs() <= 1e-12);
            g += 0.02 * way;
        }
    }
}

/// Claim: the eggbox folds with slopes `f`, `e` of its sides that satisfy `sin f sin e = cos(sector)`; half the fold
/// angles have the tangents `cos f tan e` along x and `cos e tan f` along y, from the right-angled spherical triangles
/// around a top (Napier's rules), and cells measure `2 a cos f` by `2 b cos e` (Schenk and Guest as above). Over nearly
/// the whole range. Tolerance: as above.
#[test]
fn eggbox_along_the_whole_fold() {
    let pattern = Eggbox { a: 1.3, b: 0.8, sector: 1.0, fold: 1.0 };
    let Eggbox { a, b, sector: t, .. } = pattern;
    let quads = Quads::new(generate(&Pattern::Eggbox(pattern)).unwrap());
    for way in [-1.0, 1.0] {
        let (mut angles, mut f) = (quads.folding.drawn(), 1.0);
        while (FRAC_PI_2 - t + 0.02..FRAC_PI_2 - 0.02).contains(&f) {
            let e = (t.cos() / f.sin()).asin();
            let [along, across] = [f.cos() * e.tan(), e.cos() * f.tan()].map(|tangent| 2.0 * tangent.atan());
            let [first, second] = quads.check(&mut angles, along, across);
            assert!(
                abs_diff_eq!(first, 2.0 * a * f.cos(), epsilon = 1e-12)
                    && abs_diff_eq!(second, 2.0 * b * e.cos(), epsilon = 1e-12)
            );
            f += 0.02 * way;
        }
    }
}

/// Returns the loops of `tests/cases/open-star.json`, found by an independent program: first direction and arc length.
fn reference_loops(folding: &Folding) -> Vec<(Vec<f64>, f64)> {
    let text = include_str!("../../cases/open-star.json");
    let reference: serde_json::Value = serde_json::from_str(text).unwrap();
    let list = reference["edge_list"].as_array().unwrap();
    let place = |&edge: &usize| {
        let EdgeKey { i, j, shift: [n1, n2], .. } = folding.sheet.edges[edge].key;
        list.iter().position(|entry| *entry == serde_json::json!([i, j, n1, n2])).unwrap()
    };
    let places: Vec<usize> = folding.closure.folding_edges().iter().map(place).collect();
    let read = |entry: &serde_json::Value| {
        let start = places.iter().map(|&place| entry["start"][place].as_f64().unwrap()).collect();
        (start, entry["arc_length"].as_f64().unwrap())
    };
    reference["loops"].as_array().unwrap().iter().map(read).collect()
}

/// Claim: with edge (0, 1, 0, 0) held, every ray of the reference cell returns to the drawn angles modulo 2 pi after
/// the length that an independent program found; along the whole way rotations commute, positions close and bars keep
/// their lengths to 1e-13, one motion is left, and the curvature changes smoothly, including its sign, also on the long
/// loop, along which the sheet passes through itself and ends inside out. Tolerance of the length: the steps of 0.02
/// are measured as straight lines, and the last one ends within one step.
#[test]
fn loops_of_open_star_close() {
    const STEP: f64 = 0.02;
    let sheet = mesh("open-star");
    let held = crease(&sheet, 0, 1);
    let folding = Folding::new(sheet, &[held]);
    let drawn = folding.drawn();
    for (mut tangent, length) in reference_loops(&folding) {
        let (mut angles, mut arc, mut shape) = (drawn.clone(), 0.0, folding.shape(&drawn));
        while arc < length - 0.5 || distance_modulo_turns(&angles, &drawn) > 1.5 * STEP {
            let next = folding.close(folding.moved(&angles, &tangent, STEP)).unwrap();
            arc += next.iter().zip(&angles).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            let basis = null_space(&folding.closure.jacobian(&next)).unwrap().basis;
            assert_eq!(basis.ncols(), 1, "{arc}");
            let along: f64 = basis.iter().zip(&tangent).map(|(a, b)| a * b).sum();
            tangent = basis.iter().map(|rate| rate * along.signum()).collect();
            let mut after = folding.shape(&next);
            after.continue_from(&shape);
            assert!(
                abs_diff_eq!(after.curvature, shape.curvature, epsilon = 0.05),
                "{arc}: {} {}",
                shape.curvature,
                after.curvature
            );
            (angles, shape) = (next, after);
            assert!(arc < length + 0.1);
        }
        assert!(abs_diff_eq!(arc, length, epsilon = 0.1), "{arc} for {length}");
    }
}

fn distance_modulo_turns(a: &[f64], b: &[f64]) -> f64 {
    let turned = |d: f64| d - 2.0 * PI * (d / (2.0 * PI)).round();
    a.iter().zip(b).map(|(a, b)| turned(a - b).powi(2)).sum::<f64>().sqrt()
}
