//! Sheets that pass through themselves, and sheets that only touch themselves, of known shape.

use crate::common::on;
use foldwell::analysis::intersections::{Crossings, Finder, Marks, STACKED_LAYERS_MARGIN, SelfIntersection, crossings};
use foldwell::analysis::state::State;
use foldwell::math::Vec3;
use foldwell::model::{Boundary, Drawn};
use foldwell::sheet::{Sheet, Tiling, fold, tile};
use rand::{RngExt, SeedableRng};
use std::f64::consts::{PI, TAU};

/// Returns the parameter to 1e-10 at which a sheet first crosses itself, by bisection between `free`, where it does
/// not, and `crossing`, where it does.
fn first_crossing(crosses: impl Fn(f64) -> bool, [mut free, mut crossing]: [f64; 2]) -> f64 {
    while crossing - free > 1e-10 {
        let middle = 0.5 * (free + crossing);
        *(if crosses(middle) { &mut crossing } else { &mut free }) = middle;
    }
    crossing
}

/// Returns a grid of `n1 x n2` parallelograms of two triangles each, with these positions of its `(n1 + 1) (n2 + 1)`
/// vertices.
fn grid(n: [usize; 2], place: impl Fn(usize, usize) -> Vec3) -> (Vec<Vec3>, Vec<[usize; 3]>) {
    let points = (0..=n[1]).flat_map(|j| (0..=n[0]).map(move |i| (i, j))).map(|(i, j)| place(i, j)).collect();
    let number = |i: usize, j: usize| j * (n[0] + 1) + i;
    let corners = (0..n[1])
        .flat_map(|j| (0..n[0]).map(move |i| [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)]));
    let triangles = corners.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    (points, triangles)
}

/// Returns a strip of `n` rectangles rolled up on a circle; each is rotated by `angle` relative to the one before.
fn rolled(n: usize, angle: f64) -> (Vec<Vec3>, Vec<[usize; 3]>) {
    grid([n, 1], |i, j| Vec3::new((i as f64 * angle).cos(), (i as f64 * angle).sin(), j as f64))
}

/// Claim: a strip of n rectangles rolled up crosses itself if and only if it exceeds a whole turn, `n angle > 2 pi`,
/// and bisection finds that angle. Source: chords of one circle cross if their ends alternate. Tolerance: the required
/// 1e-10; half of that below the angle nothing crosses.
#[test]
fn a_strip_crosses_itself_after_a_whole_turn() {
    for n in [5, 12, 31] {
        let crosses = |angle: f64| -> bool {
            let (points, triangles) = rolled(n, angle);
            !crossings(&points, &triangles).pairs.is_empty()
        };
        let whole = TAU / n as f64;
        for part in [0.1, 0.9, 0.999_999, 1.000_001, 1.05] {
            assert_eq!(crosses(part * whole), part > 1.0, "{n} {part}");
        }
        let found = first_crossing(crosses, [0.5 * whole, 1.05 * whole]);
        assert!(crosses(found) && !crosses(found - 1e-10), "{n}: {found}");
        assert!(!((found - whole).abs() > 1e-10), "{n}: {found} and {whole}");
    }
}

/// Claim: around a vertex of four faces, a face that folds onto its second neighbour crosses it from the moment when it
/// passes through, and the bisection finds this state. Source: the opposite edge of the face passes through the sector
/// between the rays at 0 and 80 degrees. Both faces have only the vertex in common.
#[test]
fn faces_with_a_common_vertex() {
    let degrees = |angle: f64, z: f64| Vec3::new(angle.to_radians().cos(), angle.to_radians().sin(), z);
    let triangles = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
    let fan = |height: f64| {
        let points =
            [Vec3::zeros(), degrees(0.0, 0.0), degrees(80.0, 0.0), degrees(40.0, height), Vec3::new(0.5, -0.2, 1.0)];
        crossings(&points, &triangles)
    };
    assert_eq!(fan(0.3).pairs, [[0usize; 2]; 0]);
    assert_eq!(fan(0.0).pairs, [[0usize; 2]; 0], "lies on it");
    assert_eq!(fan(-0.3), Crossings { faces: vec![true, false, true, false], pairs: vec![[0, 2]] });
    let found = first_crossing(|s| !fan(0.3 - s).pairs.is_empty(), [0.0, 0.6]);
    assert!(!((found - 0.3).abs() > 1e-10), "{found}");
}

/// Rotates points by an oblique rotation.
fn turned(points: &[Vec3]) -> Vec<Vec3> {
    let rotation = nalgebra::Rotation3::new(Vec3::new(0.3, -1.1, 0.7));
    points.iter().map(|p| rotation * p + Vec3::new(0.1, 0.2, 0.3)).collect()
}

/// Claim: Miura-ori folded flat touches itself in all its layers and crosses nowhere, nor does it on the way there.
/// After an oblique rotation its layers intersect by rounding errors, which the margin for states known to a tolerance
/// ignores. Source: the closed form of Miura-ori (M. Schenk, S. D. Guest, PNAS 110, 3276 (2013)) with sides 5 and an
/// angle of cosine 3/5, for which the flat state has integer coordinates.
#[test]
fn miura_ori_folds_flat_without_crossing() {
    let miura = |g: f64| {
        let (sine, tangent) = (0.8, 4.0 / 3.0);
        let q = (1.0 + (g.cos() * tangent).powi(2)).sqrt();
        let (s, v) = (5.0 * g.cos() * tangent / q, 5.0 / q);
        let (l, h) = (5.0 * (1.0 - (g.sin() * sine).powi(2)).sqrt(), 5.0 * sine * g.sin());
        grid([8, 8], |i, j| Vec3::new(s * i as f64, l * j as f64 + v * (i % 2) as f64, h * (j % 2) as f64))
    };
    for g in [0.0, 0.3, 1.0, 1.5, 1.57, std::f64::consts::FRAC_PI_2 - 1e-6] {
        let (points, triangles) = miura(g);
        assert!(crossings(&points, &triangles).pairs.is_empty(), "{g}");
        assert!(crossings(&turned(&points), &triangles).pairs.is_empty(), "{g}, turned");
    }
    let (flat, triangles) =
        grid([8, 8], |i, j| Vec3::new(0.0, 3.0 * j as f64 + 5.0 * (i % 2) as f64, 4.0 * (j % 2) as f64));
    assert!(crossings(&flat, &triangles).pairs.is_empty());
    let flat = turned(&flat);
    assert!(!crossings(&flat, &triangles).pairs.is_empty(), "rounding errors are there to be seen");
    assert!(Finder::new(triangles).crossings(&flat, STACKED_LAYERS_MARGIN).pairs.is_empty());
}

/// Claim: a margin ignores crossings less deep than it, and no others: layers pushed through each other by d cross for
/// margins below d.
#[test]
fn a_margin_is_a_depth() {
    let (sheet, faces) = grid([1, 1], |i, j| Vec3::new(i as f64, j as f64, 0.0));
    let tip = [[0.3, 0.2, -0.01], [0.3, 0.1, 1.0], [0.4, 0.2, 1.0]].map(Vec3::from);
    let points = [&sheet[..], &tip].concat();
    let mut finder = Finder::new([&faces[..], &[[4, 5, 6]]].concat());
    for (margin, crossing) in [(0.0, true), (1e-9, true), (0.009_99, true), (0.010_01, false)] {
        assert_eq!(finder.crossings(&points, margin).faces, [crossing, false, crossing], "{margin}");
    }
}

/// Claim: the results for a sequence of states are those for each state alone: refitting the tree loses no crossing.
/// States: heaps of triangles that move far, and one with a corner at infinity, whose faces cross nothing.
#[test]
fn states_one_after_another() {
    let mut numbers = rand_chacha::ChaCha8Rng::seed_from_u64(5);
    let mut point = || Vec3::from([0; 3].map(|_| numbers.random::<f64>()));
    let triangles: Vec<[usize; 3]> = (0..100).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let mut finder = Finder::new(triangles.clone());
    for state in 0..8 {
        let mut points: Vec<Vec3> = (0..300).map(|_| point() * 10f64.powi(state % 3)).collect();
        if state == 4 {
            points[0].x = f64::INFINITY;
            points[4].z = f64::NAN;
        }
        let found = finder.crossings(&points, 0.0);
        assert_eq!(found, crossings(&points, &triangles));
        assert!(found.pairs.len() > 50, "{}", found.pairs.len());
        assert!(state != 4 || !found.faces[0] && !found.faces[1]);
    }
}

/// A sheet in its drawn state, its model, and the test for self-intersections.
struct Case {
    drawn: Drawn,
    tiling: Tiling,
    check: SelfIntersection,
}

impl Case {
    fn new(sheet: &Sheet, cells: [usize; 2], boundary: Boundary, shown: [usize; 2]) -> Self {
        let cells = if boundary == Boundary::Screw { shown } else { cells };
        let drawn = on(sheet.clone(), cells, boundary);
        Self { check: SelfIntersection::new(&drawn), drawn: drawn.drawn().clone(), tiling: drawn.tiling().clone() }
    }

    /// Returns the marks of a state with these coordinates and with this fold angle at all edges.
    fn marks(&mut self, coordinates: Vec<f64>, angle: f64) -> Marks {
        let edges = self.tiling.edges.len();
        let state = State { fold_angle: vec![angle; edges], ..State::empty(coordinates, edges) };
        self.check.marks(&self.drawn, &state)
    }
}

/// Claim: a hinge folded beyond pi has passed through itself, although its positions are those of the opposite fold; at
/// pi its faces lie on each other. Boundary edges have no angle. Source: fold angles are continued through pi.
#[test]
fn a_hinge_beyond_pi() {
    let text = r#"{"vertices_coords": [[0, 0, 0], [0, 1, 0], [-1, 0.5, 0], [1, 0.5, 0]], "faces_vertices": [[0, 1, 2], [1, 0, 3]]}"#;
    let sheet = fold::parse(text, "hinge.fold").unwrap();
    let mut hinge = Case::new(&sheet, [1, 1], Boundary::Patch, [1, 1]);
    for (angle, crossing) in
        [(0.0, false), (3.0, false), (PI, false), (PI + 1e-12, false), (3.2, true), (-3.2, true), (6.9, true)]
    {
        let mut x = hinge.drawn.coordinates.clone();
        let [right, height] = [f64::cos(angle), f64::sin(angle)];
        (x[9], x[11]) = (right, height);
        let marks = hinge.marks(x, angle);
        assert_eq!(marks, Marks { any: crossing, faces: vec![crossing; 2] }, "{angle}");
    }
    let x = hinge.drawn.coordinates.clone();
    assert!(!hinge.marks(x, f64::NAN).any);
}

/// Claim: a cell of a screw-periodic sheet that is rolled up more and more tightly crosses others as soon as the shown
/// cells exceed a turn, and not before. The axis lies along the first lattice vector. The shown n cells have every face
/// of them once: the rim at their end is a copy of that at their beginning, n cells further, and meets it after a whole
/// turn.
#[test]
fn a_tube_closes_on_itself() {
    let text = std::fs::read_to_string("meshes/random-developable.fold").unwrap();
    let sheet = fold::parse(&text, "random-developable.fold").unwrap();
    for n in [6, 9, 20] {
        let mut tube = Case::new(&sheet, [1, 1], Boundary::Screw, [10, n]);
        for (turns, crossing) in [(0.0, false), (0.5, false), (0.999, false), (1.0 + 0.5 / n as f64, true)] {
            let mut x = tube.drawn.coordinates.clone();
            let shared = x.len() - 5;
            x[shared] = turns * TAU / (n as f64 * x[shared + 2]);
            let marks = tube.marks(x, 0.0);
            assert_eq!(marks.any, crossing, "{n} cells, {turns} turns");
            assert_eq!(marks.faces.contains(&true), crossing);
        }
    }
}

/// Makes cells of the star with vertex 1 of each moved by `push` towards the next cell, as a patch, a torus or a screw.
fn pushed(sheet: &Sheet, cells: [usize; 2], boundary: Boundary, push: f64) -> Case {
    let mut case = Case::new(sheet, cells, boundary, [5, 5]);
    let [l1, l2] = sheet.lattice.unwrap();
    let way = case.drawn.frame * (l1 + 0.5 * l2 - Vec3::z()) * push;
    let vertices = case.drawn.coordinates.len() - case.drawn.domain.shared();
    for vertex in (1..vertices / 3).step_by(4) {
        (0..3).for_each(|k| case.drawn.coordinates[3 * vertex + k] += way[k]);
    }
    case
}

/// Claim: cells that are pushed into each other are found, on a screw among the shown cells, on a torus of one cell
/// among its neighbours, none of which is shown. Source: the same 5 x 5 cells as a patch, those that have neighbours on
/// all sides, or the one in the middle. The faces include some that cross the rim of a cell.
#[test]
fn cells_are_held_against_their_neighbours() {
    let sheet = fold::parse(include_str!("../../cases/open-star.fold"), "open-star.fold").unwrap();
    for push in [0.0, 0.2, 0.5] {
        let marks = |cells: [usize; 2], boundary: Boundary| {
            let mut case = pushed(&sheet, cells, boundary, push);
            (case.marks(case.drawn.coordinates.clone(), 0.0), case.tiling)
        };
        let (laid_out, tiling) = marks([5, 5], Boundary::Patch);
        assert_eq!(laid_out.any, push > 0.4, "{push}");
        let (rolled, complete) = (marks([1, 1], Boundary::Screw).0, tile(&sheet, [5, 5], true).triangles);
        assert_eq!((rolled.any, rolled.faces.len()), (laid_out.any, complete.len()), "{push}");
        for (t, laid_out) in
            tiling.triangles.iter().zip(&laid_out.faces).filter(|(t, _)| t.cell.map(|c| c % 4 != 0) == [true; 2])
        {
            let at = complete.iter().position(|face| (face.triangle, face.cell) == (t.triangle, t.cell));
            assert_eq!(rolled.faces[at.unwrap()], *laid_out, "{push}");
        }
        let middle = |triangle: usize| {
            let at = tiling.triangles.iter().position(|t| t.triangle == triangle && t.cell == [2, 2]);
            laid_out.faces[at.unwrap()]
        };
        for boundary in [Boundary::FreeTorus, Boundary::FixedTorus] {
            let (found, _) = marks([1, 1], boundary);
            assert_eq!(found.any, laid_out.any, "{boundary:?} {push}");
            let drawn = tile(&sheet, [1, 1], true).triangles;
            assert_eq!(found.faces, drawn.iter().map(|t| middle(t.triangle)).collect::<Vec<_>>(), "{push}");
        }
    }
}

/// Claim: no mesh in `meshes/` crosses itself in the drawn state, by its coordinates only. Source: they can be folded
/// from paper.
#[test]
fn drawn_meshes_do_not_cross_themselves() {
    let mut count = 0;
    for entry in std::fs::read_dir("meshes").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "fold") {
            let tiling = tile(&fold::read(&path).unwrap(), [4, 4], false);
            let triangles: Vec<_> = tiling.triangles.iter().map(|t| t.corners.map(|site| site.vertex)).collect();
            assert!(crossings(&tiling.positions, &triangles).pairs.is_empty(), "{}", path.display());
            count += 1;
        }
    }
    assert!(count >= 10);
}
