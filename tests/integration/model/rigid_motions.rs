//! Rigid motions cost no energy with all boundary conditions, and the numbers of zero modes and self stresses are those
//! of the theory.

use crate::common::{self, Numbers, Testing, eigenvalues, energy_hessian, linearized, mesh, on, patch};
use approx::abs_diff_eq;
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Boundary, Terms};
use foldwell::model::{Gauge, Model};
use foldwell::sheet::generate::{MiuraPatch, Pattern, Random};
use foldwell::sheet::{EdgeKind, Sheet, generate};
use foldwell::solver::Problem;
use nalgebra::Rotation3;

const DOMAINS: [Boundary; 4] = [Boundary::Patch, Boundary::FixedTorus, Boundary::FreeTorus, Boundary::Screw];

fn random_sheet(seed: u64) -> Sheet {
    generate(&Pattern::Random(Random { seed, ..Random::default() })).unwrap()
}

/// Assembles bars of stiffness 1000 and creases of stiffness 1 with the drawn angles as rest angles; no coordinate is
/// held, not even vertex 0 of a screw.
fn free_model(sheet: Sheet, cells: [usize; 2], boundary: Boundary) -> Model {
    let case = on(sheet, cells, boundary).with_free_coordinates();
    let terms = Terms::bars_and_creases(1e3, 1.0, case.drawn_angles().to_vec());
    case.model_of(&terms, Gauge::Free)
}

/// Returns a strained state, for a screw a curved one.
fn strained(model: &Model, boundary: Boundary, numbers: &mut Numbers) -> Vec<f64> {
    let mut x: Vec<f64> = model.start().iter().map(|x| x + numbers.within(0.03)).collect();
    if boundary == Boundary::Screw {
        let kappa = x.len() - 5;
        x[kappa] = 0.2 + numbers.within(0.1);
    }
    x
}

fn total_energy(model: &Model, x: &[f64]) -> f64 {
    let gaps = model.gaps(x);
    model.energy(x) + gaps.iter().zip(model.compliance()).map(|(gap, c)| gap * gap / (2.0 * c)).sum::<f64>()
}

/// Returns the gradient of the whole energy, and the largest force of a single element.
fn pull(model: &Model, x: &[f64]) -> (Vec<f64>, f64) {
    let gaps = linearized(model, x, &vec![0.0; model.layout().stiff.len()]).gaps;
    let tension: Vec<f64> = gaps.iter().zip(model.compliance()).map(|(gap, c)| gap / c).collect();
    let at = linearized(model, x, &tension);
    (at.force(&tension).iter().map(|f| -f).collect(), at.largest_force)
}

/// Returns the coordinates after a rotation and a translation; lattice vectors are only rotated.
fn moved(boundary: Boundary, x: &[f64], turn: &Rotation3<f64>, shift: Vec3) -> Vec<f64> {
    let lattice = if boundary == Boundary::FreeTorus { x.len() - 6 } else { x.len() };
    let one = |(k, p): (usize, &[f64])| {
        let p = turn * Vec3::from_column_slice(p);
        <[f64; 3]>::from(if 3 * k < lattice { p + shift } else { p })
    };
    x.chunks(3).enumerate().flat_map(one).collect()
}

/// Claim: on patch and tori the energy does not change, and the forces rotate with the sheet, when it is rotated (not
/// on the torus with fixed lattice) and moved by several times its size. Tolerance: rounding errors of coordinates of
/// size 10, times the stiffness of the bars, divided by the energy or the largest force: 1e-15 * 10 * 1e3 / 10.
#[test]
fn energy_and_forces_move_with_the_sheet() {
    for boundary in &DOMAINS[..3] {
        for seed in 0..5 {
            let mut numbers = Numbers::new(seed);
            let model = free_model(random_sheet(seed), [2, 2], *boundary);
            let x = strained(&model, *boundary, &mut numbers);
            let turn = match boundary {
                Boundary::FixedTorus => Rotation3::identity(),
                _ => Rotation3::new(Vec3::from_column_slice(&numbers.many(3, 3.0))),
            };
            let y = moved(*boundary, &x, &turn, Vec3::from_column_slice(&numbers.many(3, 10.0)));
            let (before, after) = (total_energy(&model, &x), total_energy(&model, &y));
            assert!(abs_diff_eq!(before, after, epsilon = 1e-12 * before), "{boundary:?}: {before} {after}");
            let ((at_x, largest), (at_y, _)) = (pull(&model, &x), pull(&model, &y));
            let expected = moved(*boundary, &at_x, &turn, Vec3::zeros());
            let off = common::distance(&expected, &at_y) / largest;
            assert!(off < 1e-12, "{boundary:?}, seed {seed}: {off:e}");
        }
    }
}

/// Claim: a screw sheet keeps its energy when it is moved along the axis, rotated about it, rotated in the plane with
/// its axis, and when the gauge is changed: all z moved by d and the radius 1/kappa with it, the angles kappa b as
/// before. Tolerance: as above.
#[test]
fn a_screw_keeps_its_energy() {
    for seed in 0..8 {
        let mut numbers = Numbers::new(seed);
        let model = free_model(random_sheet(seed), [1, 1], Boundary::Screw);
        let x = strained(&model, Boundary::Screw, &mut numbers);
        let before = total_energy(&model, &x);
        let (vertices, shared) = x.split_at(x.len() - 6);
        let (kappa, plane) = (shared[1], Rotation3::new(Vec3::z() * numbers.within(3.0)));
        let way = Vec3::new(shared[0].cos(), shared[0].sin(), 0.0);
        let axis = Vec3::z() / kappa;
        let turn = Rotation3::new(way * numbers.within(3.0));
        let (along, lift) = (numbers.within(5.0), numbers.within(0.5));
        let each = |map: &dyn Fn(Vec3) -> Vec3, shared: Vec<f64>| {
            let points = vertices.chunks(3).flat_map(|p| <[f64; 3]>::from(map(Vec3::from_column_slice(p))));
            points.chain(shared).collect::<Vec<f64>>()
        };
        let turned = each(&|p| turn * (p - axis) + axis + along * way, shared.to_vec());
        let lifted_kappa = 1.0 / (1.0 / kappa + lift);
        let lattice = [2, 3].map(|k| {
            let l = Vec3::new(shared[k + 2], shared[k], 0.0);
            let across = Vec3::z().cross(&way);
            l + across * across.dot(&l) * (kappa / lifted_kappa - 1.0)
        });
        let [l1, l2] = lattice;
        let lifted = each(&|p| p + Vec3::z() * lift, vec![shared[0], lifted_kappa, l1.y, l2.y, l1.x, l2.x]);
        let [l1, l2] = [2, 3].map(|k| plane * Vec3::new(shared[k + 2], shared[k], 0.0));
        let direction = shared[0] + plane.scaled_axis().z;
        let in_plane = each(&|p| plane * p, vec![direction, kappa, l1.y, l2.y, l1.x, l2.x]);
        for y in [turned, lifted, in_plane] {
            let after = total_energy(&model, &y);
            assert!(abs_diff_eq!(before, after, epsilon = 1e-12 * before), "seed {seed}: {before} {after}");
        }
    }
}

/// Claim: the forces of a strained sheet have no component along any rigid motion of its domain: no total force, no
/// total torque, on a screw no force along the axis and no torque about it. Tolerance: rounding errors of sums.
#[test]
fn forces_balance() {
    for boundary in DOMAINS {
        let model = free_model(random_sheet(3), if boundary == Boundary::Screw { [1, 1] } else { [3, 2] }, boundary);
        let x = strained(&model, boundary, &mut Numbers::new(3));
        let (force, largest) = pull(&model, &x);
        let screw = boundary == Boundary::Screw;
        let vertices = x.len() - model.domain().shared();
        let sum: Vec3 = force[..vertices].chunks(3).map(Vec3::from_column_slice).sum();
        let lattice = if screw { vertices } else { x.len() };
        let arm = |k: usize| {
            Vec3::from_column_slice(&x[k..k + 3]) - Vec3::z() * if screw { 1.0 / x[vertices + 1] } else { 0.0 }
        };
        let torque: Vec3 =
            (0..lattice).step_by(3).map(|k| arm(k).cross(&Vec3::from_column_slice(&force[k..k + 3]))).sum();
        let zeros: Vec<f64> = match boundary {
            Boundary::Screw => {
                let way = Vec3::new(x[vertices].cos(), x[vertices].sin(), 0.0);
                vec![sum.dot(&way), torque.dot(&way)]
            }
            Boundary::FixedTorus => sum.iter().copied().collect(),
            _ => sum.iter().chain(&torque).copied().collect(),
        };
        assert!(zeros.iter().all(|z| z.abs() < 1e-12 * largest), "{boundary:?}: {zeros:?} of {largest}");
    }
}

/// Claim: the Hessian of the energy at rest, creases included, has as many zeros as the domain has rigid motions, 6 on
/// a patch, 3 on a torus with fixed lattice, 6 with free lattice, and no other eigenvalue within six decades of them.
/// Two eigenvalue solvers: nalgebra's on a matrix assembled here, and the program's.
#[test]
fn zeros_of_the_hessian_are_rigid_motions() {
    for (boundary, expected) in [(DOMAINS[0], 6), (DOMAINS[1], 3), (DOMAINS[2], 6)] {
        for seed in 0..4 {
            let case = on(random_sheet(seed), [2, 2], boundary);
            let terms = Terms::bars_and_creases(1e3, 1.0, case.drawn_angles().to_vec());
            let model = case.model_of(&terms, Gauge::Free);
            let values = eigenvalues(energy_hessian(&model, &model.start()));
            let largest = values[values.len() - 1];
            let zeros = values.iter().filter(|v| v.abs() < 1e-12 * largest).count();
            assert_eq!(zeros, expected, "{boundary:?}, seed {seed}: {:e}", values[expected] / largest);
            assert!(values[expected] > 1e-6 * largest, "{boundary:?}, seed {seed}: {:e}", values[expected] / largest);
            let modes = case.modes_of(&terms, values.len()).unwrap();
            assert_eq!(modes.rigid_motions, expected);
            let off = common::distance(&modes.eigenvalues, &values) / largest;
            assert!(off < 1e-13, "{off:e}");
        }
    }
}

/// Claim: for minimisation as many coordinates are held as there are rigid motions that are not prevented otherwise,
/// and the Hessian at rest has no zero left: 6 on a patch, 3 with one pinned vertex, none with three; 3 on a torus with
/// fixed lattice, 6 with free lattice. On a screw the chart itself holds vertex 0.
#[test]
fn what_is_held_is_what_costs_nothing() {
    let pinned = |vertices: &[usize]| vertices.iter().map(|v| (*v, [true; 3])).collect::<Vec<_>>();
    for (boundary, pins, expected) in [
        (Boundary::Patch, vec![], 6),
        (Boundary::Patch, pinned(&[5]), 3),
        (Boundary::Patch, pinned(&[0, 5, 10]), 0),
        (Boundary::FixedTorus, vec![], 3),
        (Boundary::FreeTorus, vec![], 6),
    ] {
        let case = on(random_sheet(2), [2, 2], boundary);
        let terms = Terms { pins, ..Terms::bars_and_creases(1e3, 1.0, case.drawn_angles().to_vec()) };
        let [free, held] = [Gauge::Free, Gauge::Held].map(|gauge| case.model_of(&terms, gauge));
        assert_eq!(free.layout().unknowns - held.layout().unknowns, expected, "{boundary:?}");
        let values = eigenvalues(energy_hessian(&held, &held.start()));
        assert!(values[0] > 1e-7 * values[values.len() - 1], "{boundary:?}: {:e}", values[0]);
    }
    let case = on(random_sheet(2), [1, 1], Boundary::Screw);
    let held = case.model_of(&Terms::bars_and_creases(1e3, 1.0, case.drawn_angles().to_vec()), Gauge::Held);
    assert_eq!(held.layout().unknowns, 3 * (case.sheet().vertices.len() - 1) + 5);
}

/// Claim: `[zero modes, self stresses, Maxwell count, rigid motions]` of the bars only of generic random cells, with Nv
/// = 4, 6 or 9 vertices and one or several cells: 3, 3, 0, 3 on a torus with fixed lattice; 6, 0, 6, 6 with free
/// lattice; 2, 0, 2, 0 on a screw (theory, sections 3 and 4; generic, hence random).
#[test]
fn modes_of_generic_periodic_bars() {
    for (seed, size) in [(1, [2, 2]), (2, [2, 3]), (3, [3, 3]), (4, [2, 2])] {
        for (boundary, cells, expected) in [
            (Boundary::FixedTorus, [1, 1], (3, 3, 0, 3)),
            (Boundary::FreeTorus, [1, 1], (6, 0, 6, 6)),
            (Boundary::Screw, [1, 1], (2, 0, 2, 0)),
        ] {
            let sheet = generate(&Pattern::Random(Random { seed, size, ..Random::default() })).unwrap();
            let case = on(sheet, cells, boundary);
            let found = case.modes_of(&Terms { bars: Some(1.0f64.into()), ..Terms::default() }, 0).unwrap();
            let counts = (found.zero_modes, found.self_stresses, found.maxwell_count, found.rigid_motions);
            assert_eq!(counts, expected, "{boundary:?}, seed {seed}");
            assert!(found.gap.unwrap() > 1e6, "{boundary:?}, seed {seed}: gap {:?}", found.gap);
        }
    }
}

/// Claim: a patch of `open-star` with b sides of triangles on its rim and l loose bars has 6 + b - 3 + 2 l zero modes
/// and no self stress: Euler's formula V - E + F = 1 with 3 F + b + 2 l = 2 E gives 3 V - E = b + 3 + 2 l. All sizes up
/// to 7 x 7 that have a rim, and long ones.
#[test]
fn modes_of_patches() {
    for cells in [[2, 2], [3, 3], [4, 4], [6, 6], [7, 7], [1, 5], [2, 9]] {
        let case = patch("open-star", cells);
        let sides = |wings: usize| {
            case.tiling().edges.iter().filter(|edge| edge.wings.iter().flatten().count() == wings).count()
        };
        let (loose, rim) = (sides(0), sides(1));
        let found = case.modes_of(&Terms { bars: Some(1.0f64.into()), ..Terms::default() }, 0).unwrap();
        assert_eq!((found.zero_modes, found.self_stresses), (rim + 3 + 2 * loose, 0), "{cells:?}, {loose} loose bars");
        let columns = 3 * case.tiling().positions.len() as i64;
        assert_eq!((found.maxwell_count, found.rigid_motions), (columns - case.edges() as i64, 6));
        if loose == 0 {
            assert_eq!(found.folding_modes, Some(rim - 3), "{cells:?}");
        }
    }
}

fn miura(fold: f64) -> Assembly {
    let pattern = Pattern::MiuraPatch(MiuraPatch { a: 2.0, b: 2.0, fold, ..MiuraPatch::default() });
    on(generate(&pattern).unwrap(), [1, 1], Boundary::Patch)
}

/// Claim: Miura-ori of 5 x 5 cells, bars only, diagonals included, has V = 121 and 40 vertices on its rim; folded 6 +
/// 40 - 3 = 43 zero modes and no self stress, flat V + 3 = 124 and as many self stresses as inner vertices, 81.
#[test]
fn modes_of_miura_flat_and_folded() {
    let bars = Terms { bars: Some(1.0f64.into()), ..Terms::default() };
    for (fold, expected) in [(0.0, (124, 81)), (std::f64::consts::PI / 12.0, (43, 0))] {
        let case = miura(fold);
        assert_eq!(case.tiling().positions.len(), 121);
        let found = case.modes_of(&bars, 0).unwrap();
        assert_eq!((found.zero_modes, found.self_stresses), expected, "fold {fold}");
        assert_eq!(found.maxwell_count, 43);
    }
}

/// Claim: with rigid quadrilaterals the folded Miura-ori of 5 x 5 cells has 420 rows (220 sides, 100 diagonals, 100
/// locks of those) of rank 356: 64 self stresses, and 363 - 356 = 7 zero modes, one of them folding.
#[test]
fn modes_of_miura_with_rigid_quadrilaterals() {
    let case = miura(std::f64::consts::PI / 12.0);
    assert_eq!((case.edges(), case.count(EdgeKind::Facet)), (320, 100));
    let terms = Terms { bars: Some(1.0f64.into()), facets: case.facets(f64::INFINITY), ..Terms::default() };
    let found = case.modes_of(&terms, 0).unwrap();
    assert_eq!((found.zero_modes, found.self_stresses, found.folding_modes), (7, 64, Some(1)));
}

/// Claim: the counts do not depend on the orientation of the sheet in space, nor on its size.
#[test]
fn counts_are_invariant() {
    let mut sheet = mesh("random");
    let turn = Rotation3::new(Vec3::new(0.4, -1.0, 2.0));
    let change = |p: &Vec3| turn * p * 1e3 + Vec3::new(5.0, 6.0, -7.0);
    sheet.vertices.iter_mut().for_each(|p| *p = change(p));
    let lattice = sheet.lattice.unwrap().map(|l| turn * l * 1e3);
    sheet.lattice = Some(lattice);
    for (boundary, expected) in [(DOMAINS[1], (3, 3)), (DOMAINS[2], (6, 0)), (DOMAINS[3], (2, 0))] {
        let case = on(sheet.clone(), [1, 1], boundary);
        let found = case.modes_of(&Terms { bars: Some(1.0f64.into()), ..Terms::default() }, 0).unwrap();
        assert_eq!((found.zero_modes, found.self_stresses), expected, "{boundary:?}");
    }
}
