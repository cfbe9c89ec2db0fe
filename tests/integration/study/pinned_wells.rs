//! Wells and barriers of sheets that pins hold and loads pull, compared with closed forms, and with those of free
//! sheets where pins hold no shape.

use crate::common::{self, Scene, Testing, case_folder, on};
use approx::{abs_diff_eq, assert_relative_eq};
use foldwell::analysis::wells::barrier::{BarrierError, barrier};
use foldwell::analysis::wells::merge::{Comparison, Well, wells};
use foldwell::analysis::wells::placement::free_rigid_motions;
use foldwell::analysis::wells::starts::{Outcome, Starts, relax_around};
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Boundary, Terms};
use foldwell::sheet::{Sheet, fold};
use foldwell::solver::Options;

/// Height of the pyramid as drawn; its base has half diagonals of 1, its bars EA = 1.
const HEIGHT: f64 = 0.3;
/// Stiffness of creases with which the second well is shallow: with 2.8e-3 there is none.
const SHALLOW: f64 = 2.4e-3;

/// A pyramid without its base: four triangles around an apex, vertex 0, over a square.
const PYRAMID: &str = include_str!("../../cases/pyramid.fold");

fn parse(text: &str) -> Sheet {
    fold::parse(text, "sheet.fold").unwrap()
}

/// The pyramid with its base pinned: by symmetry its apex moves on its axis, on which everything has a closed form, as
/// of a von Mises truss with four bars of length l = sqrt(1 + z^2): the fold angles of the creases over the bars are 2
/// atan(z / l).
#[derive(Clone, Copy)]
struct OnAxis {
    /// Stiffness of the creases.
    creases: f64,
    /// Downward force on the apex.
    load: f64,
}

impl OnAxis {
    fn energy(&self, z: f64) -> f64 {
        let (drawn, length) = ((1.0 + HEIGHT * HEIGHT).sqrt(), (1.0 + z * z).sqrt());
        let angle = |z: f64| 2.0 * (z / (1.0 + z * z).sqrt()).atan();
        let bar = 0.5 / drawn * (length - drawn).powi(2);
        let crease = 0.5 * self.creases * drawn * (angle(z) - angle(HEIGHT)).powi(2);
        4.0 * (bar + crease) + self.load * (z - HEIGHT)
    }

    fn slope(&self, z: f64) -> f64 {
        let (drawn, length) = ((1.0 + HEIGHT * HEIGHT).sqrt(), (1.0 + z * z).sqrt());
        let angle = |z: f64| 2.0 * (z / (1.0 + z * z).sqrt()).atan();
        let bar = (length - drawn) / drawn * z / length;
        let crease = self.creases * drawn * (angle(z) - angle(HEIGHT)) * 2.0 / ((1.0 + 2.0 * z * z) * length);
        4.0 * (bar + crease) + self.load
    }

    /// Returns the heights of all equilibria, in ascending order, by bisection.
    fn equilibria(&self) -> Vec<f64> {
        let grid: Vec<f64> = (0..=400).map(|k| -0.5 + k as f64 / 400.0 + 1e-4).collect();
        let between = grid.windows(2).filter(|pair| self.slope(pair[0]) * self.slope(pair[1]) < 0.0);
        let bisected = |pair: &[f64]| {
            let (mut a, mut b) = (pair[0], pair[1]);
            for _ in 0..60 {
                let middle = 0.5 * (a + b);
                if self.slope(a) * self.slope(middle) <= 0.0 { b = middle } else { a = middle }
            }
            0.5 * (a + b)
        };
        between.map(bisected).collect()
    }
}

/// Claim: a pinned pyramid that snaps through has two wells and one pass, with the energies of the closed form above,
/// without a load and with one below the load at which it snaps; the energy is the elastic one less the work of the
/// load, which the table of states, of elastic energies, does not contain. Source: the energy along the axis, and that
/// of a load on the way from the drawn state. Tolerance: relaxations to 1e-12, passes to 1e-11 of the forces.
#[test]
fn a_pyramid_snaps_through() {
    let pins: String = (1..5).map(|vertex| format!("[[pin]]\nvertex = {vertex}\n")).collect();
    for (creases, load) in [(1e-4, 0.0), (1e-4, 4e-3), (1e-8, 1e-3), (SHALLOW, 0.0)] {
        let energy = format!("[energy]\nbars = {{ stiffness = 1.0 }}\ncreases = {{ stiffness = {creases} }}\n{pins}");
        let exact = OnAxis { creases, load };
        let [below, pass, above]: [f64; 3] = exact.equilibria().try_into().unwrap();
        let mut expected = [exact.energy(above), exact.energy(below)];
        expected.sort_by(f64::total_cmp);
        let pull =
            if load > 0.0 { format!("[[load]]\nvertex = 0\nforce = [0.0, 0.0, {:e}]\n", -load) } else { String::new() };
        let study = "[[study]]\nname = \"a\"\nkind = \"wells\"\nstarts = 100\nbarriers = [[0, 1]]\n";
        let ran = Scene::on("mesh = \"cases/pyramid.fold\"", &format!("{energy}{pull}{study}")).converged();
        let found = ran.wells("a");
        let energies: Vec<f64> = found.wells.iter().map(|well| well.energy).collect();
        assert_eq!(energies.len(), 2, "{load}: {energies:?}");
        for (found, expected) in energies.iter().zip(expected) {
            assert!(abs_diff_eq!(*found, expected, epsilon = 1e-12), "{load}: {found:e} {expected:e}");
        }
        let barrier = &found.barriers[0];
        assert_relative_eq!(barrier.energy.unwrap(), exact.energy(pass), max_relative = 1e-9);
        let heights = expected.map(|well| exact.energy(pass) - well);
        assert!(barrier.height.unwrap().iter().zip(heights).all(|(a, b)| abs_diff_eq!(*a, b, epsilon = 1e-11)));
        assert_eq!((barrier.bars, barrier.singular), (Some(1.0), false));
        let elastic = OnAxis { creases, load: 0.0 };
        let lowest = if exact.energy(above) < exact.energy(below) { above } else { below };
        let total = ran.out.table("a.csv").at(0, "energy_total");
        assert!(abs_diff_eq!(total, elastic.energy(lowest), epsilon = 1e-12), "{load}: {total:e}");
    }
}

/// Returns the wells that random starts reach.
fn reached(assembly: &Assembly, count: usize) -> Vec<Well> {
    let starts = Starts { count, seed: 11, spread: std::f64::consts::PI, options: Options::default() };
    let minima = relax_around(assembly, None, &starts, &|| true).into_iter().filter_map(|outcome| match outcome {
        Outcome::Well(settled) => Some(*settled),
        _ => None,
    });
    wells(minima, &Comparison::new(assembly))
}

/// Claim: pins that only take away rigid motions leave wells, energies and passes as they are: a closed drum held at
/// three, two and one coordinate of three vertices. The free drum has the pass of an independent program, 8.219153e-5.
/// Tolerance: that of passes, 1e-11 of the forces.
#[test]
fn pins_that_hold_no_shape() {
    let case = on(fold::read(&case_folder().join("drum.fold")).unwrap(), [1, 1], Boundary::Patch);
    let free = Terms::bars_and_creases(1.0, 1e-6, case.drawn_angles().to_vec());
    let free = Terms { facets: case.facets(f64::INFINITY), ..free };
    let pins = vec![(0, [true; 3]), (1, [true, false, true]), (2, [false, false, true])];
    let pinned = case.with_terms(Terms { pins, ..free.clone() });
    let free = case.with_terms(free);
    assert_eq!((free_rigid_motions(&free), free_rigid_motions(&pinned)), (6, 0));
    let found = [&free, &pinned].map(|assembly| {
        let wells = reached(assembly, 40);
        let pass = barrier(assembly, &wells, [0, 1], &mut || true).unwrap().pass;
        let energies: Vec<f64> = wells.iter().map(|well| well.settled.energy).collect();
        (energies, pass)
    });
    let [(free, free_pass), (pinned, pinned_pass)] = found;
    // higher wells are reached by few starts: each that the pinned sheet has is one of the free sheet
    assert!(free.len() >= 2 && pinned.len() >= 2, "{free:?} {pinned:?}");
    assert!(common::distance(&free[..2], &pinned[..2]) <= 1e-15, "{free:?} {pinned:?}");
    let known = |energy: &f64| free.iter().any(|other| (energy - other).abs() <= 1e-12);
    assert!(pinned.iter().all(known), "{free:?} {pinned:?}");
    assert_relative_eq!(free_pass.energy, pinned_pass.energy, max_relative = 1e-9);
    assert_relative_eq!(pinned_pass.energy, 8.219153e-5, max_relative = 1e-7);
    assert!(common::distance(&free_pass.state.fold_angle, &pinned_pass.state.fold_angle) <= 1e-6);
}

/// Returns a triangle on two vertices on the x axis, its apex over them, and a second triangle hinged to it. The first
/// two vertices are pinned, and the apex too along these axes.
fn flap(apex: [bool; 3]) -> Assembly {
    let sheet = parse(
        r#"{"vertices_coords": [[-1, 0, 0], [1, 0, 0], [0, 0, 0.05], [-1.2, 0.1, 0.9]],
            "faces_vertices": [[0, 1, 2], [0, 2, 3]]}"#,
    );
    let case = on(sheet, [1, 1], Boundary::Patch);
    let terms = Terms::bars_and_creases(1.0, 1e-3, case.drawn_angles().to_vec());
    let pins = vec![(0, [true; 3]), (1, [true; 3]), (2, apex)];
    case.with_terms(Terms { pins, ..terms })
}

/// Claim: states of one shape in different places are one well if a rigid motion that the pins leave free leads from
/// one to the other, and two wells if none does. Source: the apex of a triangle on a pinned base turns about that base,
/// unless it is kept in the plane through it: then it has to press its sides to get to the other side of the base, as
/// in a von Mises truss. Both wells are the drawn shape, without energy. No path leads along fold angles that are the
/// same.
#[test]
fn one_shape_in_two_places() {
    let turning = reached(&flap([false; 3]), 24);
    assert_eq!(turning.len(), 1);
    assert!(turning[0].settled.energy.abs() <= 1e-15);
    let kept = flap([false, true, false]);
    let found = reached(&kept, 24);
    assert_eq!(found.len(), 2);
    let apex = |well: &Well| well.settled.place.coordinates[8];
    assert!(found.iter().all(|well| well.settled.energy.abs() <= 1e-15));
    assert!(abs_diff_eq!(apex(&found[0]), -apex(&found[1]), epsilon = 1e-6) && apex(&found[0]).abs() > 0.04);
    assert_eq!(barrier(&kept, &found, [0, 1], &mut || true).unwrap_err(), BarrierError::SameShape);
}

/// Claim: a load turns a sheet that pins do not hold, so that its energy has no wells of shapes: the scene is refused
/// with what would be right; so are rigid wells of a pinned sheet, since fold angles do not know of pins.
#[test]
fn loads_need_pins_that_hold() {
    let scene = |more: &str, study: &str| {
        let energy = "[energy]\nbars = { stiffness = 1.0 }\ncreases = { stiffness = 1e-3 }";
        let study = format!("{energy}\n{more}[[study]]\nname = \"a\"\nkind = \"wells\"\n{study}");
        Scene::on("mesh = \"cases/pyramid.fold\"", &study)
    };
    let pin = |vertex: usize| format!("[[pin]]\nvertex = {vertex}\n");
    let load = "[[load]]\nvertex = 0\nforce = [0.0, 0.0, -1e-3]\n";
    let two = format!("{}{}{load}", pin(1), pin(3));
    scene(&two, "").refused("a sheet that pins hold in place");
    scene(&pin(1), "rigid = true").refused("which pins, parts and loads do not know");
    let pull = Vec3::new(0.0, 0.0, -1e-3);
    let case = on(parse(PYRAMID), [1, 1], Boundary::Patch);
    let held = |vertices: &[usize]| {
        let pins = vertices.iter().map(|vertex| (*vertex, [true; 3])).collect();
        free_rigid_motions(&case.with_terms(Terms { pins, loads: vec![(0, pull)], ..Terms::default() }))
    };
    assert_eq!([held(&[]), held(&[1]), held(&[1, 3]), held(&[1, 2, 3])], [6, 3, 1, 0]);
}
