//! Loads without effect, sheets far from the origin, and locks in any unit of length do not change the results.

use crate::common::{self, Scene, Testing, on, patch};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use foldwell::analysis::relax::Relaxed;
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Boundary, Terms};
use foldwell::sheet::fold;
use foldwell::study::relax::RelaxSummary;

/// Returns four cells of `open-star` with rigid bars and rest angles within 0.1 rad of the drawn angles.
fn four_cells() -> (Assembly, Terms) {
    let case = patch("open-star", [2, 2]);
    let terms = Terms::bars_and_creases(f64::INFINITY, 1.0, case.rest_per_cell(0.1, 3));
    (case, terms)
}

fn relaxed(loads: Vec<(usize, Vec3)>, pins: Vec<(usize, [bool; 3])>) -> Relaxed {
    let (case, terms) = four_cells();
    case.relax(&Terms { loads, pins, ..terms }).unwrap()
}

/// Claim: forces that are zero, that cancel at their vertex, or that act on pinned coordinates give the same bits as no
/// forces.
#[test]
fn loads_that_do_nothing() {
    let plain = relaxed(vec![], vec![]);
    let (pin, x) = (vec![(0, [true; 3])], Vec3::x());
    let pinned = relaxed(vec![], pin.clone());
    for (loads, pins, expected) in [
        (vec![(0, Vec3::zeros())], vec![], &plain),
        (vec![(0, x), (0, -x)], vec![], &plain),
        (vec![(0, Vec3::new(1.0, 2.0, 0.5))], pin, &pinned),
    ] {
        let found = relaxed(loads, pins);
        assert_eq!((&found.configuration, found.iterations), (&expected.configuration, expected.iterations));
    }
}

/// Claim: balanced forces that leave the rotations of a sheet free need only a few more steps than none, whatever their
/// size; the energy and the angles tend to those without forces to first order: the bound, 10 times their size, is far
/// above the response of shapes of this stiffness.
#[test]
fn small_loads_change_little() {
    let plain = relaxed(vec![], vec![]);
    for size in [1e-9, 1e-6, 1e-3, 1e-2] {
        for pull in [Vec3::x(), -Vec3::x(), Vec3::new(0.3, -0.5, 0.8)] {
            let far = four_cells().0.tiling().positions.len() - 1;
            let found = relaxed(vec![(0, -size * pull), (far, size * pull)], vec![]);
            assert!(found.iterations <= 30, "{size:e} {pull}: {} iterations", found.iterations);
            let off = common::distance(&found.state.fold_angle, &plain.state.fold_angle);
            assert!(off <= 10.0 * size, "{size:e} {pull}: {off:e}");
        }
    }
}

/// Claim: a sheet that hangs from one vertex rotates under its load until the load acts along the line through the pin.
#[test]
fn a_sheet_hangs_from_a_pin() {
    let (case, _) = four_cells();
    let last = case.tiling().positions.len() - 1;
    let found = relaxed(vec![(last, Vec3::new(0.0, 0.0, -0.01))], vec![(0, [true; 3])]);
    let place = |k: usize| Vec3::from_column_slice(&found.state.coordinates[3 * k..3 * k + 3]);
    let arm = place(last) - place(0);
    assert!(found.iterations <= 40, "{} iterations", found.iterations);
    assert_abs_diff_eq!(arm.xy().norm(), 0.0, epsilon = 1e-6 * arm.norm()); // forces balance to 1e-12 of the largest, 1e-10 of the load
    assert!(arm.z < 0.0);
}

/// Claim: a sheet at a distance of a million of its sizes from the origin relaxes as at the origin, except for the
/// digits that its coordinates have lost: 1e-10 of an edge, in angles within 0.1 rad.
#[test]
fn far_from_the_origin() {
    for boundary in [Boundary::Patch, Boundary::FixedTorus, Boundary::FreeTorus, Boundary::Screw] {
        let cells = if boundary == Boundary::Screw { [1, 1] } else { [2, 2] };
        let run = |far: f64| {
            let mut sheet = common::mesh("open-star");
            sheet.vertices.iter_mut().for_each(|p| *p += far * Vec3::new(1.0, -1.0, 1.0));
            let case = on(sheet, cells, boundary);
            case.relax(&Terms::bars_and_creases(1e6, 1.0, case.rest_per_cell(0.1, 3))).unwrap()
        };
        let (near, far) = (run(0.0), run(1e6));
        let off = common::distance(&near.state.fold_angle, &far.state.fold_angle);
        assert!(off <= 1e-7 && far.iterations <= near.iterations + 2, "{boundary:?}: {off:e}, {}", far.iterations);
    }
}

/// Relaxes a rigid cell on a screw with a crease locked away from its drawn angle, from a scene.
fn locked_in(unit: f64, angle: f64) -> RelaxSummary {
    let scene = format!(
        "[sheet]\nmesh = \"star.fold\"\ndomain = \"screw\"\n[energy]\nbars = {{ stiffness = inf }}\n\
         creases = {{ stiffness = 1.0, rest = {{ file = \"cases/star-rest.csv\" }} }}\n\
         [[lock]]\ncrease = [0, 1, 0, 0]\nangle = {angle}\n[[study]]\nname = \"a\"\nkind = \"relax\"\ndraw = []\n"
    );
    let mesh = fold::write(&common::scaled(common::mesh("open-star"), unit));
    Scene::new(scene).with("star.fold", mesh).ran().relaxed("a").clone()
}

/// Claim: if the drawn state is a branch point, as with this lock, the branch on which a relaxation ends does not
/// depend on the unit of length; and the summary reports the branch point, with as many rays as two quadrics in the
/// plane of motions have: four. Energies are those of torques per length, so they have the unit; tolerance: rounding
/// errors.
#[test]
fn the_unit_does_not_choose_a_branch() {
    for angle in [-0.49339316800066285, -0.393_393_168_000_662_9] {
        let expected = locked_in(1.0, angle);
        assert_eq!(expected.branch_point_start, Some(4));
        assert_eq!(expected.directions_at_start.as_deref(), Some("listed"));
        for unit in [2.0, 0.5, 1024.0, 1.0 / 1024.0, 0.9, 7.0, 1000.0] {
            let found = locked_in(unit, angle);
            assert_relative_eq!(found.energy.total / unit, expected.energy.total, max_relative = 1e-10);
        }
    }
}
