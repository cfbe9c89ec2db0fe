//! The linear response of sheets: Poisson's ratios against closed forms, counts of modes, and invariances.

use crate::common::{self, four_parallelograms};
use foldwell::analysis::chart::coordinates;
use foldwell::analysis::response::{Poisson, Relation, Response, SelfStress, response, response_at};
use foldwell::analysis::trace::Folded;
use foldwell::kinematics::{Closure, Embedding, Shape};
use foldwell::math::{Vec3, rotation};
use foldwell::model::Configuration;
use foldwell::model::{Assembly, RIGID};
use foldwell::sheet::generate::{Eggbox, Miura, Random};
use foldwell::sheet::{Corner, Edge, EdgeKey, EdgeKind, Pattern, Sheet, generate};
use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

/// Returns the response of a sheet whose polygons bend.
fn bending(sheet: Sheet) -> Response {
    response(&Assembly::torus(sheet, [1, 1]).bars(RIGID).facets(1.0).build().unwrap()).unwrap()
}

fn poisson(response: &Response) -> &Poisson {
    response.poisson.as_ref().unwrap()
}

/// Returns the ratios in the plane and of bending along a direction.
fn ratios(response: &Response, angle: f64) -> [f64; 2] {
    let poisson = poisson(response);
    [poisson.in_plane.ratio(angle).unwrap(), poisson.bending.ratio(angle).unwrap()]
}

/// Returns sides of random lengths and angles: a zigzag along y out of the plane, and one along x that is out of the
/// plane too, as in the eggbox, or in the plane, as in Miura-ori.
fn random_sides(seed: u64) -> [Vec3; 4] {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    let mut near = |side: Vec3| side + Vec3::from_fn(|_, _| rng.random_range(-0.35..0.35));
    let out = if seed.is_multiple_of(2) { Vec3::z() } else { Vec3::y() } * 0.7;
    let [x, y, z] = [Vec3::x(), Vec3::y(), 0.5 * Vec3::z()];
    [near(x + out), near(x - out), near(y + z), near(y - z)]
}

/// Returns the ratio for a stretch along `angle` of a strain `[e11, e22]` without shear.
fn turned_ratio([e11, e22]: [f64; 2], angle: f64) -> f64 {
    let (s, c) = angle.sin_cos();
    -(s * s * e11 + c * c * e22) / (c * c * e11 + s * s * e22)
}

/// Claim: Miura-ori of sector 60 degrees, from fold 0.1 to 1.4: Poisson's ratio in its plane is that of the closed form
/// `s = b cos g tan t / q`, `l = a sqrt(1 - sin^2 g sin^2 t)`, which gives `-(dl/l)/(ds/s) = -tan^2 t cos^2 g ...` (M.
/// Schenk, S. D. Guest, PNAS 110, 3276 (2013), eq. 4 and 5; Z. Y. Wei et al., Phys. Rev. Lett. 110, 215501 (2013)),
/// that of bending the opposite, along every direction. The closed form is checked by differences of the generated
/// cells. Tolerance 1e-10, relative to the ratio where that is large: the claim of the study; differences 1e-7.
#[test]
fn miura_ori_has_its_closed_forms() {
    let t = FRAC_PI_3;
    let cell = |fold: f64| generate(&Pattern::Miura(Miura { a: 1.3, b: 0.8, sector: t, fold })).unwrap();
    let lengths = |fold: f64| cell(fold).lattice.unwrap().map(|l| l.norm());
    for k in 0..=26 {
        let g = 0.1 + 0.05 * f64::from(k);
        // logarithmic rates of s and l by the fold
        let q2 = 1.0 + (g.cos() * t.tan()).powi(2);
        let ds = -g.tan() / q2;
        let dl = -g.sin() * g.cos() * t.sin().powi(2) / (1.0 - (g.sin() * t.sin()).powi(2));
        let step = 1e-5;
        let (low, high) = (lengths(g - step), lengths(g + step));
        let differences = [0, 1].map(|i| (high[i].ln() - low[i].ln()) / (2.0 * step));
        assert!((differences[0] - ds).abs() <= 1e-7 * ds.abs().max(1.0) && (differences[1] - dl).abs() <= 1e-7);
        let found = bending(cell(g));
        assert_eq!((found.modes.len(), found.table.rank, found.table.strains), (3, 3, 3), "fold {g}");
        for angle in [0.0, 0.4, FRAC_PI_2, 2.0] {
            let expected = turned_ratio([ds, dl], angle);
            let [in_plane, bend] = ratios(&found, angle);
            let tolerance = 1e-10 * expected.abs().max(1.0);
            assert!((in_plane - expected).abs() <= tolerance, "fold {g}, {angle}: {in_plane} for {expected}");
            assert!((bend + expected).abs() <= tolerance, "fold {g}, {angle}: {bend} for {}", -expected);
        }
        assert!(poisson(&found).sum.unwrap() <= 1e-10 && found.error <= 1e-11, "fold {g}: {:e}", found.error);
        assert_eq!(poisson(&found).relation, Relation::Opposite { strains: 1, four_parallelograms: true });
    }
}

/// Claim: the eggbox has Poisson's ratio `tan^2 e / tan^2 f` in its plane, `f` and `e` the slopes of its sides with
/// `sin f sin e = cos t`, from the derivatives of its lengths, and the opposite of bending (H. Nassar, A. Lebee, L.
/// Monasse, Proc. R. Soc. A 473, 20160705 (2017)), in every direction. Tolerance as of Miura-ori.
#[test]
fn the_eggbox_has_its_closed_forms() {
    for sector in [0.6, FRAC_PI_3, 1.4] {
        for part in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let f: f64 = FRAC_PI_2 - sector * (1.0 - part);
            let e = (f64::cos(sector) / f.sin()).asin();
            // (dx/x) and (dy/y) per change of f: x = a cos f, y = b cos e, cos f sin e + sin f cos e de/df = 0
            let strain = [-f.tan(), e.tan() * e.tan() / f.tan()];
            let sheet = generate(&Pattern::Eggbox(Eggbox { a: 1.3, b: 0.8, sector, fold: f })).unwrap();
            let found = bending(sheet);
            for angle in [0.0, 0.3, FRAC_PI_2, 2.4] {
                let expected = turned_ratio(strain, angle);
                let tolerance = 1e-10 * expected.abs().max(1.0);
                let [in_plane, bend] = ratios(&found, angle);
                assert!((in_plane - expected).abs() <= tolerance, "{sector} {f} {angle}: {in_plane} for {expected}");
                assert!((bend + expected).abs() <= tolerance, "{sector} {f} {angle}: {bend}");
            }
            assert_eq!(poisson(&found).relation.opposite(), Some(true));
        }
    }
}

/// Returns the sides after the angle between the second two, `c` and `d`, has grown by `step`, all lengths and the
/// angles of all four parallelograms kept: exact folding in the plane.
fn folded([a, b, c, d]: [Vec3; 4], step: f64) -> [Vec3; 4] {
    let normal = c.cross(&d).normalize();
    let turned = rotation::exp(&(normal * step)) * d;
    let place = |side: &Vec3| {
        let (along_c, along_d) = (side.dot(&c), side.dot(&d));
        let gram = nalgebra::Matrix2::new(c.dot(&c), c.dot(&turned), c.dot(&turned), turned.dot(&turned));
        let mix = gram.try_inverse().unwrap() * nalgebra::Vector2::new(along_c, along_d);
        let flat = c * mix[0] + turned * mix[1];
        flat + normal * (side.norm_squared() - flat.norm_squared()).sqrt().copysign(side.dot(&normal))
    };
    [place(&a), place(&b), c, turned]
}

/// Claim: cells of four parallelograms of random lengths and angles have one mode that strains them in the plane and
/// two that bend them, with opposite Poisson's ratios in every direction (J. McInerney, G. H. Paulino, D. Z. Rocklin,
/// PNAS 119, e2202777119 (2022)), a height at which those that bend have no strain, and the strain of exact folding, by
/// differences. Tolerance: 1e-9, the claim of the study, 180 directions each; differences 1e-6.
#[test]
fn four_parallelograms_have_opposite_ratios() {
    let mut signs = [0, 0];
    for seed in 0..60 {
        let sides = random_sides(seed);
        let found = bending(four_parallelograms(sides));
        let ratios = poisson(&found);
        assert_eq!((found.modes.len(), found.table.rank, found.table.curvatures), (3, 3, 2), "seed {seed}");
        assert_eq!(ratios.relation, Relation::Opposite { strains: 1, four_parallelograms: true });
        assert!(ratios.sum.unwrap() <= 1e-9, "seed {seed}: {:e}", ratios.sum.unwrap());
        assert!(ratios.neutral_height.is_some(), "seed {seed}");
        let step = 1e-5;
        let lattice = [-step, step].map(|step| {
            let [a, b, c, d] = folded(sides, step);
            [a + b, c + d]
        });
        let lattice_rates = [0, 1].map(|k| (lattice[1][k] - lattice[0][k]) / (2.0 * step));
        let [a, b, c, d] = sides;
        let drawn = [a + b, c + d];
        let exact = foldwell::kinematics::metric::LatticeFrame::new(&drawn).strain_rate(&drawn, &lattice_rates);
        let strain = found.modes[0].strain;
        let scale = exact.iter().map(|e| e.abs()).fold(0.0, f64::max);
        let largest = [0, 1, 2].into_iter().find(|&k| exact[k].abs() == scale).unwrap();
        for k in 0..3 {
            let off = strain[k] - exact[k] / exact[largest];
            assert!(off.abs() <= 1e-6, "seed {seed}: {strain:?} for {exact:?}");
        }
        signs[usize::from(ratios.in_plane.ratio(0.0).unwrap() > 0.0)] += 1;
    }
    assert!(signs.iter().all(|count| *count > 5), "both signs occur: {signs:?}");
}

/// Claim: generic triangulated cells have three modes that map one to one onto strains and onto curvature tensors: the
/// table has rank 3, no ratio exists and none is said to be opposite; the modes are named by curvatures. Random cells
/// that cannot be flattened. Tolerance of names: rounding over the smallest singular value.
#[test]
fn generic_cells_have_no_ratio() {
    for seed in 0..20 {
        for size in [[2, 2], [2, 3]] {
            let sheet = generate(&Pattern::Random(Random { size, seed, ..Random::default() })).unwrap();
            let found = response(&Assembly::torus(sheet, [1, 1]).bars(RIGID).build().unwrap()).unwrap();
            let table = &found.table;
            assert_eq!((found.modes.len(), table.rank, table.strains, table.curvatures), (3, 3, 3, 3), "seed {seed}");
            let ratios = poisson(&found);
            assert!(matches!(ratios.relation, Relation::NoPlanarMode { least } if least > 1e-3));
            assert_eq!(ratios.relation.opposite(), None);
            assert!((0..8).all(|k| ratios.in_plane.ratio(0.3 * f64::from(k)).is_err()));
            assert!((0..8).all(|k| ratios.bending.ratio(0.3 * f64::from(k)).is_err()));
            assert!(ratios.sum.is_none() && ratios.neutral_height.is_none() && found.error <= 1e-12);
            for (k, mode) in found.modes.iter().enumerate() {
                let off = (0..3).map(|i| mode.curvature[i] - f64::from(u8::from(i == k)));
                assert!(off.map(f64::abs).fold(0.0, f64::max) <= 1e-11, "seed {seed}: {:?}", mode.curvature);
            }
        }
    }
}

/// Claim: rigid polygons leave Miura-ori its folding alone, with the same ratio in the plane, and the reason says that
/// polygons have to bend; a flat sheet has one mode more for each vertex, of which none strains it; a lock on a crease
/// of soft Miura-ori leaves two modes that bend; a rigid diagonal leaves planar folding, which bends no polygon, and
/// one mode that bends, whose ratio is not the opposite. Source: counts of theory.
#[test]
fn the_relation_says_why() {
    let miura = |fold: f64| generate(&Pattern::Miura(Miura { fold, ..Miura::default() })).unwrap();
    let rigid = response(&Assembly::torus(miura(0.6), [1, 1]).bars(RIGID).facets(RIGID).build().unwrap()).unwrap();
    assert_eq!((rigid.modes.len(), rigid.table.rank, rigid.table.curvatures), (1, 1, 0));
    assert_eq!(poisson(&rigid).relation, Relation::NoBendingMode { locked: true });
    let ratio = poisson(&rigid).in_plane.ratio(0.0).unwrap();
    assert!((ratio + 2.0435366317).abs() <= 1e-10, "{ratio}, for 0.6 and 60 degrees by an independent program");
    assert!(poisson(&rigid).bending.ratio(0.0).is_err() && poisson(&rigid).relation.because().contains("facets"));
    let crease = miura(0.6).edges[0].key;
    let held = Assembly::torus(miura(0.6), [1, 1]).bars(RIGID).facets(RIGID).lock(crease, None).build().unwrap();
    let held = response(&held).unwrap();
    assert_eq!((held.modes.len(), held.table.rank, poisson(&held).relation), (0, 0, Relation::NoModes));
    let flat = bending(miura(0.0));
    assert_eq!((flat.modes.len(), flat.table.rank, flat.table.strains), (6, 3, 0));
    assert_eq!(poisson(&flat).relation, Relation::NoStrain);
    let locked = Assembly::torus(miura(0.6), [1, 1]).bars(RIGID).facets(1.0).lock(crease, None).build().unwrap();
    let locked = response(&locked).unwrap();
    assert_eq!((locked.modes.len(), locked.table.curvatures), (2, 2));
    assert!(matches!(poisson(&locked).relation, Relation::NoPlanarMode { .. }));
    let sheet = miura(0.6);
    let diagonal = sheet.edges.iter().position(|edge| edge.kind == EdgeKind::Facet).unwrap();
    let stiffness: Vec<f64> = (0..sheet.edges.len()).map(|edge| if edge == diagonal { RIGID } else { 1.0 }).collect();
    let stiff = Assembly::torus(sheet, [1, 1]).bars(RIGID).facets(stiffness).build().unwrap();
    let stiff = response(&stiff).unwrap();
    assert_eq!((stiff.modes.len(), stiff.table.curvatures), (2, 1));
    assert_eq!(
        (poisson(&stiff).relation, poisson(&stiff).relation.opposite()),
        (Relation::OneBendingMode, Some(false))
    );
    assert!(poisson(&stiff).sum.unwrap() > 0.1, "{:?}", poisson(&stiff).sum);
}

/// Claim: a symmetric cell whose vertices are off by 1e-6 has no mode without curvature, and so no ratio, and the
/// reason says how close it is to a cell that has; off by 1e-13 it has one. Its faces are triangles, as of an exported
/// mesh.
#[test]
fn a_rounded_drawing_is_called_close() {
    let rounded = |off: f64| {
        let mut sheet = four_parallelograms(random_sides(2));
        sheet.vertices.iter_mut().zip([0.3, -0.7, 0.9, -0.4]).for_each(|(p, part)| p.z += off * part);
        bending(sheet)
    };
    let found = rounded(1e-6);
    assert!(matches!(poisson(&found).relation, Relation::NoPlanarMode { least } if least < 1e-5 && least > 1e-8));
    assert!(poisson(&found).relation.because().contains("close to one"));
    assert_eq!(found.table.curvature_values.len(), 3);
    assert_eq!(poisson(&rounded(1e-13)).relation.opposite(), Some(true));
}

/// Claim: the velocities of a mode stretch no bar of any cell, keep vertex 0 and move its copies as the strain and the
/// curvature tensor say. Tolerance: rounding at a distance of some cells.
#[test]
fn fields_belong_to_the_table() {
    let sheets = [common::mesh("open-star"), four_parallelograms(random_sides(3)), common::mesh("miura")];
    for sheet in sheets {
        let found = bending(sheet.clone());
        let [l1, l2] = sheet.lattice.unwrap();
        for mode in &found.modes {
            let at = |corner: Corner| mode.field.at(corner.vertex, corner.shift).unwrap();
            for edge in &sheet.edges {
                for shift in [[0, 0], [3, -2], [-4, 5]] {
                    let [i, j] =
                        edge.key.ends().map(|end| Corner { shift: [0, 1].map(|k| end.shift[k] + shift[k]), ..end });
                    let stretch = (sheet.position(j) - sheet.position(i)).dot(&(at(j) - at(i)));
                    assert!(stretch.abs() <= 1e-11, "{}: {stretch:e}", sheet.title);
                }
            }
            let vertex = |shift: [i32; 2]| at(Corner { vertex: 0, shift });
            assert!(vertex([0, 0]).norm() <= 1e-14);
            let stretched = 2.0 * l1.dot(&vertex([1, 0])) / l1.norm_squared();
            assert!((stretched - mode.strain[0]).abs() <= 1e-12);
            // the second difference along the first lattice vector is k11 |l1|^2
            let normal = l1.cross(&l2).normalize();
            let bent = (vertex([2, 0]) - 2.0 * vertex([1, 0])).dot(&normal) / l1.norm_squared();
            assert!((bent - mode.curvature[0]).abs() <= 1e-11, "{}: {bent} for {:?}", sheet.title, mode.curvature);
        }
    }
}

/// Claim: self stresses are orthonormal, their forces and moments are orthogonal, and their work falls; so their forces
/// and moments belong to the sheet: they are the same in every orientation, and with another unit of length forces fall
/// with it and moments do not. Tolerance: rounding over the distance between singular values.
#[test]
fn self_stresses_belong_to_the_sheet() {
    let turn = rotation::exp(&Vec3::new(0.4, -1.1, 0.7));
    for sheet in [common::mesh("open-star"), four_parallelograms(random_sides(5)), four_parallelograms(random_sides(8))]
    {
        let found = bending(sheet.clone());
        let [l1, l2] = sheet.lattice.unwrap();
        let length = l1.cross(&l2).norm().sqrt();
        let work = |stress: &SelfStress| {
            let scaled = stress.moment.map(|moment| moment / length);
            [stress.force, scaled].concat()
        };
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        for (k, a) in found.stresses.iter().enumerate() {
            for (l, b) in found.stresses.iter().enumerate() {
                let expected = f64::from(u8::from(k == l));
                assert!((dot(&a.tension, &b.tension) - expected).abs() <= 1e-13);
                assert!(k == l || dot(&work(a), &work(b)).abs() <= 1e-13);
                assert!(k >= l || dot(&work(a), &work(a)) > 1.01 * dot(&work(b), &work(b)), "well separated");
            }
        }
        for unit in [1.0, 40.0] {
            for (one, other) in
                found.stresses.iter().zip(bending(common::scaled(common::turned(sheet.clone(), &turn), unit)).stresses)
            {
                assert!((0..3).all(|k| (one.force[k] - unit * other.force[k]).abs() <= 1e-11), "{one:?} {other:?}");
                assert!((0..3).all(|k| (one.moment[k] - other.moment[k]).abs() <= 1e-11), "{one:?} {other:?}");
            }
        }
    }
}

/// Claim (duality): the rates of a mode are a self stress of the cell, whose work on strains is `cof(K)/2` and on
/// curvatures `-cof(E)/2`, per area; and no self stress does work on a mode. Tolerance: rounding.
#[test]
fn modes_are_self_stresses() {
    for sheet in [common::mesh("open-star"), four_parallelograms(random_sides(5)), common::mesh("miura")] {
        let found = bending(sheet.clone());
        // with a free lattice each mode in the plane is a zero mode more than the count of theory, 6
        let planar = found.modes.len() - found.table.curvatures;
        assert_eq!((found.stresses.len(), found.self_stresses), (3, planar), "held and free lattice");
        let work = |force: [f64; 3], on: [f64; 3]| (0..3).map(|k| force[k] * on[k]).sum::<f64>();
        for mode in &found.modes {
            for stress in &found.stresses {
                let on_mode = work(stress.force, mode.strain) + work(stress.moment, mode.curvature);
                assert!(on_mode.abs() <= 1e-12, "{}: {on_mode:e}", sheet.title);
            }
            let mut left = mode.rates.clone();
            let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
            for stress in &found.stresses {
                let part: f64 = mode.rates.iter().zip(&stress.tension).map(|(rate, t)| rate * t).sum();
                left.iter_mut().zip(&stress.tension).for_each(|(left, t)| *left -= part * t);
                (0..3).for_each(|k| force[k] += part * stress.force[k]);
                (0..3).for_each(|k| moment[k] += part * stress.moment[k]);
            }
            assert!(left.iter().all(|left| left.abs() <= 1e-12), "{}", sheet.title);
            let cof = |t: [f64; 3]| [t[1], t[0], -2.0 * t[2]];
            for k in 0..3 {
                let expected = [0.5 * cof(mode.curvature)[k], -0.5 * cof(mode.strain)[k]];
                assert!((force[k] - expected[0]).abs() <= 1e-11 && (moment[k] - expected[1]).abs() <= 1e-11);
            }
        }
    }
}

/// Claim: ratios do not depend on the orientation of the sheet, its unit of length, the order of its vertices, or the
/// choice of lattice vectors, apart from the direction from which angles count; a mirror image has the same. The
/// neutral height is a place of the sheet: it grows with the unit, is reversed in the mirror, and counted from another
/// vertex it is less by how much that vertex is higher. Tolerance: rounding.
#[test]
fn ratios_belong_to_the_sheet() {
    let sides = random_sides(8);
    let found = bending(four_parallelograms(sides));
    let turn = rotation::exp(&Vec3::new(0.4, -1.1, 0.7));
    let same = |other: &Response, shift: f64, sign: f64| {
        (0..12).all(|k| {
            let angle = PI * f64::from(k) / 12.0;
            let (a, b) = (ratios(&found, angle), ratios(other, shift + sign * angle));
            a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-10 * a.abs().max(1.0))
        })
    };
    let height = |response: &Response| poisson(response).neutral_height.unwrap();
    let is_at = |response: &Response, expected: f64| (height(response) / expected - 1.0).abs() <= 1e-10;
    let large = bending(four_parallelograms(sides.map(|side| 40.0 * (turn * side))));
    assert!(same(&large, 0.0, 1.0) && is_at(&large, 40.0 * height(&found)));
    let mirrored = bending(four_parallelograms(sides.map(|side| Vec3::new(side.x, side.y, -side.z))));
    assert!(same(&mirrored, 0.0, 1.0) && is_at(&mirrored, -height(&found)));
    // the second zigzag first: angles count from the other lattice vector, the other way round
    let [a, b, c, d] = sides;
    let between = (a + b).angle(&(c + d));
    assert!(same(&bending(four_parallelograms([c, d, a, b])), between, -1.0));
    let begun_elsewhere = bending(four_parallelograms([b, a, d, c]));
    let higher = (a + c).dot(&(a + b).cross(&(c + d)).normalize());
    assert!(same(&begun_elsewhere, 0.0, 1.0) && is_at(&begun_elsewhere, height(&found) - higher));
    assert!(higher.abs() > 0.1, "{higher}");
}

/// Claim: a torus of several cells in the drawn state has the response of one cell, a patch has none, and cells that
/// differ have none.
#[test]
fn several_cells_respond_like_one() {
    let sheet = common::mesh("miura");
    let one = bending(sheet.clone());
    let several = Assembly::torus(sheet.clone(), [3, 2]).bars(RIGID).facets(1.0).build().unwrap();
    let found = response(&several).unwrap();
    for (a, b) in one.modes.iter().zip(&found.modes) {
        assert!(a.rates.iter().zip(&b.rates).all(|(a, b)| (a - b).abs() <= 1e-11));
    }
    let screw = Assembly::screw(sheet.clone(), [1, 1]).bars(RIGID).facets(1.0).build().unwrap();
    assert_eq!(response(&screw).unwrap().modes.len(), 3);
    let patch = Assembly::patch(sheet, [2, 2]).bars(RIGID).build().unwrap();
    assert!(response(&patch).unwrap_err().to_string().contains("periodic"));
}

/// Returns the stored cylinders of `tests/cases/open-star.json` as fold angles of all edges.
fn cylinders(sheet: &Sheet) -> Vec<Vec<f64>> {
    let case: Value = serde_json::from_str(include_str!("../../cases/open-star.json")).unwrap();
    let keys: Vec<Vec<i64>> = serde_json::from_value(case["edge_list"].clone()).unwrap();
    let name = |key: &Vec<i64>| {
        let corner = |vertex: i64, shift: [i64; 2]| Corner { vertex: vertex as usize, shift: shift.map(|n| n as i32) };
        EdgeKey::new(corner(key[0], [0, 0]), corner(key[1], [key[2], key[3]])).0
    };
    let of_state = |state: &Value| {
        let stored: Vec<f64> = serde_json::from_value(state["fold_angles"].clone()).unwrap();
        let angle = |edge: &Edge| stored[keys.iter().position(|key| name(key) == edge.key).unwrap()];
        sheet.edges.iter().map(angle).collect()
    };
    case["states"].as_array().unwrap().iter().map(of_state).collect()
}

/// Returns the metric of the chords, and the curvature tensor in the components of the lattice, of a cylinder.
fn forms(shape: &Shape) -> [[f64; 3]; 2] {
    let [l1, l2] = shape.screw.chords;
    let bend = |a: usize, b: usize| shape.theta[a] * shape.theta[b] / shape.curvature;
    [[l1.dot(&l1), l2.dot(&l2), l1.dot(&l2)], [bend(0, 0), bend(1, 1), bend(0, 1)]]
}

/// Returns the components of a tensor in the lattice of a metric, from those in the frame of its first lattice vector.
fn in_lattice([t11, t22, t12]: [f64; 3], [g11, g22, g12]: [f64; 3]) -> [f64; 3] {
    let (a11, a12) = (g11.sqrt(), g12 / g11.sqrt());
    let a = nalgebra::Matrix2::new(a11, a12, 0.0, (g22 - a12 * a12).sqrt());
    let t = a.transpose() * nalgebra::Matrix2::new(t11, t12, t12, t22) * a;
    [t.m11, t.m22, t.m12]
}

/// Claim: a cylinder has two linear modes, whose fold rates close, and whose strains, curvature tensors and lattice
/// rotations are the differences of exact folding along them; axis, angles, chords and curvature are those of the
/// state. The states are those of an independent program. Tolerance: closure 1e-9, as the states close to 1e-12;
/// differences of step 1e-5: 1e-7.
#[test]
fn a_cylinder_has_two_modes() {
    let sheet = common::mesh("open-star");
    let (embedding, closure) = (Embedding::new(&sheet).unwrap(), Closure::of_cell(&sheet).unwrap());
    let assembly = Assembly::screw(sheet.clone(), [1, 1]).bars(RIGID).build().unwrap();
    let states = cylinders(&sheet);
    assert_eq!(states.len(), 4);
    for angles in states {
        let shape = Shape::at(&embedding, &angles).unwrap();
        let positions = shape.positions.clone();
        let state = Folded {
            arc_length: 0.0,
            angles: angles.clone(),
            rates: vec![],
            shape: Some(shape.clone()),
            seam: None,
            positions,
            residual: 0.0,
        };
        let start = Configuration::new(coordinates(&state), vec![], None);
        let found = response_at(&assembly, &start).unwrap();
        assert_eq!((found.modes.len(), found.table.rank, found.self_stresses), (2, 2, 0));
        assert!(found.poisson.is_none() && found.stresses.is_empty());
        assert!((found.lattice.curvature.abs() - shape.curvature.abs()).abs() <= 1e-9);
        assert!((0..2).all(|a| (found.lattice.theta[a] - shape.theta[a]).abs() <= 1e-9));
        let chords = found.lattice.chords.map(Vec3::from);
        assert!((0..2).all(|a| (chords[a].norm() - shape.screw.chords[a].norm()).abs() <= 1e-9));
        let axis = Vec3::from(found.lattice.axis.unwrap());
        let rises = chords.map(|chord| axis.dot(&chord));
        assert!((0..2).all(|a| (rises[a] - shape.screw.rise()[a]).abs() <= 1e-9), "{rises:?}");
        for mode in &found.modes {
            let rates = DVector::from_column_slice(&mode.rates);
            assert!((closure.jacobian(&angles) * &rates).amax() <= 1e-9 * rates.amax());
            let step = 1e-5 / rates.amax();
            let moved = [-step, step].map(|step| {
                let near: Vec<f64> = angles.iter().zip(&mode.rates).map(|(angle, rate)| angle + step * rate).collect();
                let mut there = Shape::at(&embedding, &near).unwrap();
                there.curvature = there.curvature.abs().copysign(found.lattice.curvature);
                forms(&there)
            });
            let rate = |form: usize| [0, 1, 2].map(|k| (moved[1][form][k] - moved[0][form][k]) / (2.0 * step));
            let metric = forms(&shape)[0];
            // the lattice as it lies on the cylinder: along the axis as it is, across it the arc
            let (rise, arc) = (shape.screw.rise(), shape.theta.map(|theta| theta / shape.curvature));
            let flat = |a: usize, b: usize| rise[a] * rise[b] + arc[a] * arc[b];
            let on_cylinder = [flat(0, 0), flat(1, 1), flat(0, 1)];
            let expected = [rate(0), rate(1)];
            let given = [in_lattice(mode.strain, metric), in_lattice(mode.curvature, on_cylinder)];
            for (given, expected) in given.iter().flatten().zip(expected.iter().flatten()) {
                assert!((given - expected).abs() <= 1e-7 * rates.amax(), "{given} for {expected}");
            }
        }
    }
}
