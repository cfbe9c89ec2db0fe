//! Tubes: screw-periodic sheets that close on themselves, their seams and their ends.

use crate::common::{Testing, jacobian, linearized, mesh, on};
use foldwell::analysis::chart::coordinates;
use foldwell::analysis::trace::Folded;
use foldwell::kinematics::tube::{BOTH, Condition};
use foldwell::kinematics::{Closure, Embedding, Motion, Shape, Tube};
use foldwell::math::Vec3;
use foldwell::model::Gauge;
use foldwell::model::{Assembly, Boundary, Terms};
use foldwell::numerics::DenseMatrix;
use foldwell::numerics::dense::{least_squares, null_space};
use foldwell::sheet::build::{Drawing, build};
use foldwell::sheet::generate::Random;
use foldwell::sheet::{Corner, EdgeKind, Pattern, Seam, Sheet, generate};
use nalgebra::{Matrix3, Rotation3};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Sets of conditions that are kept, and the numbers of motions that are left (theory, section 9).
const LEFT: [(&[Condition], usize); 4] = [(&[], 2), (&[Condition::Turn], 1), (&[Condition::Rise], 1), (&BOTH, 0)];

/// Returns tubes of the reference cell and of a random one, with seams along the lattice vectors and oblique to them:
/// sheet, seam, angles.
fn tubes() -> Vec<(Sheet, [i32; 2], Vec<f64>)> {
    let random = generate(&Pattern::Random(Random { seed: 3, size: [2, 3], ..Random::default() })).unwrap();
    let mut found = Vec::new();
    for sheet in [mesh("open-star"), random] {
        for seam in [[0, 8], [1, 8], [8, 0], [7, -3], [2, 8]] {
            for inwards in [true, false] {
                let angles = Tube::new(&sheet, seam).unwrap().rolled_up(inwards).unwrap();
                found.push((sheet.clone(), seam, angles));
            }
        }
    }
    found
}

fn shape(sheet: &Sheet, angles: &[f64]) -> Shape {
    Shape::at(&Embedding::new(sheet).unwrap(), angles).unwrap()
}

/// Claim: a tube closes: `n1 theta1 + n2 theta2 = 2 pi`, `n1 h1 + n2 h2 = 0`, cell `(n1, n2)` coincides with cell (0,
/// 0), faces close, rotations commute. Tolerances: rounding errors of angles of size 2 pi, and of positions after some
/// ten cells.
#[test]
fn tubes_close() {
    for (sheet, [n1, n2], angles) in tubes() {
        let Shape { theta, screw, compatibility, .. } = shape(&sheet, &angles);
        let of = |[a, b]: [f64; 2]| f64::from(n1) * a + f64::from(n2) * b;
        let (turn, rise) = (of(theta).abs() - TAU, of(screw.rise()));
        assert!(turn.abs() <= 2e-14 && rise.abs() <= 2e-14, "{turn:e} {rise:e}");
        assert!(Closure::of_cell(&sheet).unwrap().residual(&angles).amax() <= 4e-15);
        assert!(compatibility <= 1e-13, "{compatibility:?}");
        let once_round = screw.motion([n1, n2]);
        let moved = |x: &Vec3| (once_round.apply(x) - x).norm();
        assert!(moved(&Vec3::zeros()) <= 1e-13 && moved(&Vec3::new(1.0, 2.0, 3.0)) <= 1e-13);
    }
}

/// Returns the Jacobian of the bars of one screw-periodic cell at an exact state, with vertex 0 pinned: `3 Nv` rows, `3
/// Nv + 2` columns, and further rows for `n1 theta1 + n2 theta2` and `n1 h1 + n2 h2`, where `theta_a = kappa b_a`, with
/// `b` perpendicular to the axis and `h` along it.
fn bars(sheet: &Sheet, [n1, n2]: [i32; 2], angles: &[f64], kept: &[Condition]) -> DenseMatrix {
    let shape = shape(sheet, angles);
    let (positions, rates) = (shape.positions.clone(), vec![]);
    let (angles, shape, seam) = (angles.to_vec(), Some(shape), None);
    let folded = Folded { arc_length: 0.0, angles, rates, shape, seam, positions, residual: 0.0 };
    let case = on(sheet.clone(), [1, 1], Boundary::Screw);
    let mut model = case.model_of(&Terms { bars: Some(f64::INFINITY.into()), ..Terms::default() }, Gauge::Held);
    let x = model.start_from(coordinates(&folded));
    let at = linearized(&model, &x, &vec![0.0; case.edges()]);
    let stretched = at.gaps.iter().fold(0.0, |most: f64, gap| most.max(gap.abs()));
    assert!(stretched <= 1e-13, "the chart's bars have their drawn lengths: {stretched:e}");
    let (bars, n) = (jacobian(&model, &at), [f64::from(n1), f64::from(n2)]);
    let columns = bars.ncols();
    let all = model.coordinates(&x);
    let [direction, kappa, y1, y2, x1, x2] = [6, 5, 4, 3, 2, 1].map(|k| all[all.len() - k]);
    let ((sin, cos), l) = (f64::sin_cos(direction), [n[0] * x1 + n[1] * x2, n[0] * y1 + n[1] * y2]);
    let (along, across) = (cos * l[0] + sin * l[1], cos * l[1] - sin * l[0]);
    let weighed = |parts: [f64; 2]| [n[0] * parts[1], n[1] * parts[1], n[0] * parts[0], n[1] * parts[0]];
    let turn = [&[-kappa * along, across][..], &weighed([-kappa * sin, kappa * cos])].concat();
    let rise = [&[across, 0.0][..], &weighed([cos, sin])].concat();
    let wanted: Vec<&[f64]> =
        kept.iter().map(|condition| if *condition == Condition::Turn { &turn[..] } else { &rise }).collect();
    let unit = |column: usize| {
        let mut rates = vec![0.0; columns];
        rates[column] = 1.0;
        model.velocity(&rates).split_off(all.len() - 6)
    };
    let rate = |row: &[f64], column: usize| row.iter().zip(unit(column)).map(|(a, b)| a * b).sum::<f64>();
    DenseMatrix::from_fn(bars.nrows() + wanted.len(), columns, |row, column| match row.checked_sub(bars.nrows()) {
        None => bars[(row, column)],
        Some(extra) => rate(wanted[extra], column),
    })
}

/// Claim (theory, section 9): within screw-symmetric motions a tube has 2 motions, 1 if its seam keeps turning by `2
/// pi` (it slips), 1 if it keeps its height, 0 with both: rigid. By the closure of the fold angles and by the lengths
/// of the bars in the chart of screw motions, which share no equation. Ranks are separated by more than ten decades.
#[test]
fn motions_left_by_the_conditions() {
    for (sheet, seam, angles) in tubes() {
        let tube = Tube::new(&sheet, seam).unwrap();
        for (kept, left) in LEFT {
            for matrix in [tube.jacobian(&angles, kept), bars(&sheet, seam, &angles, kept)] {
                let null = null_space(&matrix).unwrap();
                assert_eq!(null.basis.ncols(), left, "{} {seam:?} {kept:?}", sheet.title);
                assert!(null.gap > 1e10, "{:e}", null.gap);
            }
        }
    }
}

/// Returns the tube with these fold angles, cut to rows of cells: a finite sheet with its axis along z and vertex 0 of
/// the first cell at height 0 in the half-plane `y = 0`, `x > 0`. The seam is closed only up to rounding.
fn cut(sheet: &Sheet, seam: [i32; 2], angles: &[f64], rows: i32) -> Sheet {
    let (Shape { positions, screw, .. }, seam) = (shape(sheet, angles), Seam::new(seam).unwrap());
    let (towards, z) = (screw.towards_axis(), screw.axis.unwrap());
    let x = -towards.normalize();
    let rotation = Matrix3::from_rows(&[x.transpose(), z.cross(&x).transpose(), z.transpose()]);
    let frame = Motion { rotation, translation: Vec3::x() / towards.norm() };
    let mut drawn = Drawing::default();
    let mut numbers: HashMap<Corner, usize> = HashMap::new();
    for cell in (0..rows).flat_map(|row| (0..seam.strands()).map(move |strand| seam.cell(strand, row))) {
        for triangle in &sheet.triangles {
            let corners = triangle.corners.map(|corner| {
                let shift = seam.home([0, 1].map(|a| corner.shift[a] + cell[a]));
                let home = Corner { shift, ..corner };
                *numbers.entry(home).or_insert_with(|| {
                    drawn.coords.push(frame.apply(&screw.motion(home.shift).apply(&positions[home.vertex])));
                    drawn.coords.len() - 1
                })
            });
            drawn.faces.push(corners.to_vec());
        }
    }
    build(&drawn).unwrap()
}

/// Returns the zero modes of the bars of a finite sheet, as columns.
fn zero_modes(case: &Assembly) -> DenseMatrix {
    let model = case.model_of(&Terms { bars: Some(1.0f64.into()), ..Terms::default() }, Gauge::Free);
    let at = linearized(&model, &model.start(), &vec![0.0; case.edges()]);
    null_space(&jacobian(&model, &at)).unwrap().basis
}

/// Returns the factors by which the zero modes of a tube along z grow from a row to the next, ascending in magnitude; a
/// row is mapped to the next by the rotation `turn` and the translation `rise`. The shift maps the space of zero modes
/// to itself, which is tested to 1e-9.
fn growth(case: &Assembly, turn: f64, rise: f64) -> Vec<f64> {
    let (modes, vertices) = (zero_modes(case), &case.sheet().vertices);
    let rotation = Rotation3::from_axis_angle(&Vec3::z_axis(), turn);
    let next = |x: &Vec3| {
        let there = rotation * x + rise * Vec3::z();
        vertices.iter().position(|y| (y - there).norm() <= 1e-9)
    };
    let pairs: Vec<[usize; 2]> = vertices.iter().enumerate().filter_map(|(a, x)| Some([a, next(x)?])).collect();
    let [mut here, mut there] = [0, 1].map(|_| DenseMatrix::zeros(3 * pairs.len(), modes.ncols()));
    for (k, &[a, b]) in pairs.iter().enumerate() {
        here.rows_mut(3 * k, 3).copy_from(&modes.rows(3 * a, 3));
        there.rows_mut(3 * k, 3).copy_from(&(rotation.inverse().matrix() * modes.rows(3 * b, 3)));
    }
    let shift = least_squares(&here, &there).unwrap();
    assert!(shift.residual.amax() <= 1e-9, "{:e}", shift.residual.amax());
    let mut growth: Vec<f64> = shift.solution.complex_eigenvalues().iter().map(|factor| factor.norm()).collect();
    growth.sort_by(f64::total_cmp);
    growth
}

/// Checks that there are as many zero modes as the rims have edges, no self stress, and six rigid motions.
fn check_counts(case: &Assembly, rim: usize) {
    let edges = case.sheet().edges.iter().filter(|edge| edge.kind == EdgeKind::Boundary).count();
    let found = case.modes_of(&Terms { bars: Some(1.0f64.into()), ..Terms::default() }, 0).unwrap();
    let counts = (found.zero_modes, found.self_stresses, found.maxwell_count, found.rigid_motions);
    assert_eq!((edges, counts), (rim, (rim, 0, rim as i64, 6)), "gap {:?}", found.gap);
}

/// Claim: an open tube, cut to rows of cells, has as many zero modes as its two rims have edges, and no self stress:
/// `V + F = E` and `3 F + b = 2 E` give `3 V - E = b`. Six are rigid motions. The number of the others does not depend
/// on the length, and neither do the factors by which they change from row to row: as many decay from one end as from
/// the other, with reciprocal factors (theory, section 8: roots pair). Rolled up inwards, with seam `[0, 8]`, 13 modes
/// belong to each end; outwards 8 do and 10 belong to none, waves along the whole tube. Tolerances: 1e-4 for factors of
/// size 1, of which those of rigid motions are double, and relative 1e-5 for all.
#[test]
fn end_modes_of_open_tubes() {
    let sheet = mesh("open-star");
    for (seam, inwards, [rim, each_end, waves]) in
        [([0, 8], true, [32, 13, 0]), ([0, 8], false, [32, 8, 10]), ([0, 6], true, [24, 9, 0])]
    {
        let tube = Tube::new(&sheet, seam).unwrap();
        let angles = tube.rolled_up(inwards).unwrap();
        let Shape { theta, screw, .. } = shape(&sheet, &angles);
        let mut first: Option<Vec<f64>> = None;
        for rows in [2, 3, 5] {
            let case = on(cut(&sheet, seam, &angles, rows), [1, 1], Boundary::Patch);
            check_counts(&case, rim);
            let growth = growth(&case, theta[0], screw.rise()[0]);
            let falling = growth.iter().filter(|factor| **factor < 1.0 - 1e-4).count();
            let rising = growth.iter().filter(|factor| **factor > 1.0 + 1e-4).count();
            assert_eq!((falling, rising, rim - falling - rising), (each_end, each_end, 6 + waves), "{growth:?}");
            let paired = growth.iter().zip(growth.iter().rev()).map(|(a, b)| (a * b - 1.0).abs());
            assert!(paired.fold(0.0, f64::max) <= 1e-5, "{growth:?}");
            let first = first.get_or_insert_with(|| growth.clone());
            let apart = first.iter().zip(&growth).map(|(a, b)| (a / b - 1.0).abs());
            assert!(apart.fold(0.0, f64::max) <= 1e-5, "{growth:?}");
        }
    }
}

/// Claim: a tube of one strand, which ends in a step, has as many zero modes as stated above: 36 for seam (1, 8), for
/// any number of cells.
#[test]
fn zero_modes_of_helical_tubes() {
    let sheet = mesh("open-star");
    let tube = Tube::new(&sheet, [1, 8]).unwrap();
    for inwards in [true, false] {
        let angles = tube.rolled_up(inwards).unwrap();
        for cells in [12, 19, 30] {
            check_counts(&on(cut(&sheet, [1, 8], &angles, cells), [1, 1], Boundary::Patch), 36);
        }
    }
}

/// Returns the tube of `meshes/helical-tube.fold`.
fn helical_tube() -> Sheet {
    let sheet = mesh("open-star");
    let tube = Tube::new(&sheet, [1, 8]).unwrap();
    cut(&sheet, [1, 8], &tube.rolled_up(true).unwrap(), 48)
}

/// Claim: `meshes/helical-tube.fold` agrees with its description: the reference cell rolled up until cell (1, 8)
/// coincides with cell (0, 0), one strand of 48 cells. Its edges are as long as those of the flat cell. Tolerance: the
/// differences between mathematical libraries, over Newton's method and some fifty cells.
#[test]
fn the_helical_tube_in_meshes() {
    let (kept, computed) = (mesh("helical-tube"), helical_tube());
    assert_eq!((&kept.triangles, kept.lattice), (&computed.triangles, None));
    let off = kept.vertices.iter().zip(&computed.vertices).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(off <= 1e-11, "{off:e}");
    let cell = mesh("open-star");
    let lengths = |sheet: &Sheet| -> Vec<f64> {
        let ends = sheet.edges.iter().map(|edge| edge.key.ends().map(|end| sheet.position(end)));
        ends.map(|[a, b]| (b - a).norm()).collect()
    };
    let flat = lengths(&cell);
    let nearest = |length: &f64| flat.iter().map(|other| (other - length).abs()).fold(f64::INFINITY, f64::min);
    assert!(lengths(&kept).iter().all(|length| nearest(length) <= 1e-12));
}
