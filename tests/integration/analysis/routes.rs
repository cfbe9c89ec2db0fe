//! Ways by which a relaxation reaches what Newton's method from the start does not.

use crate::common::{Testing, mesh, on};
use approx::assert_relative_eq;
use foldwell::analysis::relax::{Relaxed, relax_from};
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Boundary, Gauge, RIGID, Terms};
use foldwell::sheet::build::{Drawing, build};
use foldwell::sheet::generate::Random;
use foldwell::solver::{Options, Problem, Start};
use foldwell::{Pattern, Rest, generate, relax};

fn names(relaxed: &Relaxed) -> Vec<&'static str> {
    relaxed.routes.iter().map(|route| route.name).collect()
}

/// Claim: the bird base with bars of 300, folded to 0.8 and 0.9 of its letters, comes to rest at the energies that
/// another minimizer finds (`validation/independent.py`: shifted Newton's method with warm starts along the fraction),
/// 1.278269936 and 0.308122142. Tolerance: those digits.
#[test]
fn bird_bases_fold() {
    for (fraction, energy) in [(0.8, 1.278_269_936), (0.9, 0.308_122_142)] {
        let builder = Assembly::patch(mesh("bird-base"), [1, 1]).bars(300.0).creases(1.0).facets(1.0);
        let assembly = builder.rest(Rest::Assigned(fraction)).build().unwrap();
        let model = assembly.model(Gauge::Held);
        let relaxed = relax_from(&model, model.start(), Options::default(), &mut |_| true).unwrap();
        assert_relative_eq!(relaxed.state.total(), energy, max_relative = 2e-9);
        assert_eq!(relaxed.negative_eigenvalues, Some(0), "{:?}", names(&relaxed));
    }
}

/// Claim: a saddle with two negative eigenvalues, on a torus with fixed lattice and bars of 3e4, is left for a minimum
/// below it; a start that knows its tensions stays. The curvatures are so small that with shifts of a hundredth of the
/// Hessian and more 200 steps are not enough.
#[test]
fn shallow_saddles_are_left() {
    let case = on(mesh("open-star"), [4, 4], Boundary::FixedTorus);
    let rest = vec![0.0; case.edges()];
    let terms = Terms::bars_and_creases(3e4, 1.0, rest);
    let model = case.with_terms(terms).model(Gauge::Held);
    let relaxed = relax_from(&model, model.start(), Options::default(), &mut |_| true).unwrap();
    assert_eq!(names(&relaxed)[..2], ["positions", "saddle"]);
    assert_eq!((relaxed.routes[0].negative_eigenvalues, relaxed.negative_eigenvalues), (Some(2), Some(0)));
    assert!(relaxed.history.len() <= 40, "{}", relaxed.history.len());
    let saddle = relaxed.history[relaxed.routes[0].iterations].energy;
    assert!(relaxed.state.total() < saddle * (1.0 - 1e-7), "{} and {saddle}", relaxed.state.total());
}

/// Claim: a flat plate of rigid bars that is pushed against its hinged side turns over and comes to rest in tension on
/// the other side, whichever diagonals it has, and so does one of bars of 1e12: flat it is a saddle, which no step on its
/// bars leaves to first order, but one on bars that stretch. Source: mirror image. Tolerance: rounding of a rotation by
/// half a turn.
#[test]
fn pushed_plates_turn_over() {
    for (diagonals, bars) in (0..64).flat_map(|diagonals| [(diagonals, RIGID), (diagonals, 1e12)]) {
        let point = |i: usize, j: usize| 4 * j + i;
        let squares = (0..6).flat_map(|k| {
            let [i, j] = [k % 3, k / 3];
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            if diagonals >> k & 1 == 0 { [vec![a, b, c], vec![a, c, d]] } else { [vec![a, b, d], vec![b, c, d]] }
        });
        let coords: Vec<Vec3> = (0..12).map(|k| Vec3::new((k % 4) as f64, (k / 4) as f64, 0.0)).collect();
        let sheet = build(&Drawing { coords: coords.clone(), faces: squares.collect(), ..Drawing::default() }).unwrap();
        let case = on(sheet, [1, 1], Boundary::Patch);
        let pins = (0..3).map(|j| (point(0, j), [true; 3])).collect();
        let loads = (0..3).map(|j| (point(3, j), Vec3::new(-0.68, 0.0, 0.0))).collect();
        let terms = Terms { pins, loads, ..Terms::bars_and_creases(bars, 1.0, vec![0.0; case.edges()]) };
        let model = case.with_terms(terms).model(Gauge::Held);
        let relaxed = relax_from(&model, model.start(), Options::default(), &mut |_| true).unwrap();
        assert_eq!(relaxed.negative_eigenvalues, Some(0), "{diagonals}, {bars:e}: {:?}", names(&relaxed));
        let turned = coords.iter().flat_map(|point| [-point.x, point.y, point.z]);
        let off = turned.zip(&relaxed.state.coordinates).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off <= 1e-7, "{diagonals}, {bars:e}: {off:e}");
    }
}

/// Claim: the same saddle is an answer where tensions are known, here those of the drawn state, which are none.
#[test]
fn known_tensions_stay() {
    let case = on(mesh("open-star"), [4, 4], Boundary::FixedTorus);
    let terms = Terms::bars_and_creases(3e4, 1.0, vec![0.0; case.edges()]);
    let model = case.with_terms(terms).model(Gauge::Held);
    let tension = Some(vec![0.0; model.compliance().len()]);
    let start = Start { x: model.start(), tension };
    let relaxed = relax_from(&model, start, Options::default(), &mut |_| true).unwrap();
    assert_eq!(relaxed.negative_eigenvalues, Some(2), "{:?}", names(&relaxed));
}

/// Claim: a sheet of which every vertex is pinned, so that nothing can move, is at rest where it is drawn, with bars of
/// any stiffness.
#[test]
fn sheets_without_unknowns_are_at_rest() {
    for bars in [1.0, f64::INFINITY] {
        let mut builder = Assembly::patch(generate(&Pattern::named("truss").unwrap()).unwrap(), [1, 1]).bars(bars);
        for vertex in 0..3 {
            builder = builder.pin(vertex, [0, 0], [true; 3]);
        }
        let relaxed = relax(&builder.build().unwrap()).unwrap();
        assert_eq!((relaxed.state.total(), relaxed.negative_eigenvalues), (0.0, Some(0)), "bars {bars}");
    }
}

/// Claim: a cell of one vertex on a torus whose lattice is fixed can only be displaced as a whole: it is at rest where
/// it is drawn, whatever the rest angles of its creases are, with bars of any stiffness.
#[test]
fn cells_that_can_only_be_displaced_are_at_rest() {
    let sheet = generate(&Pattern::Random(Random { size: [1, 1], ..Random::default() })).unwrap();
    let case = on(sheet, [1, 1], Boundary::FixedTorus);
    for bars in [1e3, f64::INFINITY] {
        let terms = Terms::bars_and_creases(bars, 1.0, vec![0.3; case.edges()]);
        let relaxed = case.relax(&terms).unwrap();
        assert_eq!(relaxed.negative_eigenvalues, Some(0), "bars {bars}");
        assert!(relaxed.state.total() > 0.1, "bars {bars}: {}", relaxed.state.total());
    }
}
