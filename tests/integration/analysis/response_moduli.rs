//! Effective moduli compared with energies of tori and cylinders, and their rigid limit.

use crate::common::{self, Testing, energy_hessian, jacobian, linearized};
use foldwell::analysis::relax::relax;
use foldwell::analysis::response::{Moduli, ModuliMatrices, ResponseError, moduli, response};
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Gauge, Model, RIGID, Rest, RestLengths};
use foldwell::numerics::DenseMatrix;
use foldwell::sheet::generate::{Eggbox, Miura};
use foldwell::sheet::{Pattern, Sheet, generate};
use foldwell::solver::Problem;
use nalgebra::{DVector, Matrix2, Matrix3, SMatrix, SVector};

/// Stiffnesses of the bars, the creases and the facets.
#[derive(Clone, Copy)]
struct Stiff {
    bars: f64,
    creases: f64,
    facets: f64,
}

const SOFT: Stiff = Stiff { bars: 100.0, creases: 1.0, facets: 3.0 };

fn builder(sheet: &Sheet, stiff: Stiff) -> foldwell::model::Builder {
    Assembly::torus(sheet.clone(), [1, 1]).bars(stiff.bars).creases(stiff.creases).facets(stiff.facets)
}

fn found(sheet: &Sheet, stiff: Stiff) -> Moduli {
    moduli(&builder(sheet, stiff).build().unwrap()).unwrap()
}

/// Returns the generic reference cell, Miura-ori, and a cell of four parallelograms that is not symmetric.
fn sheets() -> [Sheet; 3] {
    let mut skew = generate(&Pattern::Eggbox(Eggbox::default())).unwrap();
    let [a, b] = [Vec3::new(0.62, 0.1, -0.7), Vec3::new(0.7, -0.1, 0.75)];
    let [c, d] = [Vec3::new(0.2, 0.75, -0.6), Vec3::new(-0.05, 0.7, 0.5)];
    skew.vertices = vec![Vec3::zeros(), a, c, a + c];
    skew.lattice = Some([a + b, c + d]);
    [common::mesh("open-star"), generate(&Pattern::Miura(Miura { fold: 0.6, ..Miura::default() })).unwrap(), skew]
}

/// Returns the matrix of all moduli, six by six.
fn whole(moduli: &ModuliMatrices) -> SMatrix<f64, 6, 6> {
    SMatrix::from_fn(|row, column| match (row < 3, column < 3) {
        (true, true) => moduli.stretching[row][column],
        (true, false) => moduli.coupling[row][column - 3],
        (false, true) => moduli.coupling[column][row - 3],
        (false, false) => moduli.bending[row - 3][column - 3],
    })
}

fn area(sheet: &Sheet) -> f64 {
    let [l1, l2] = sheet.lattice.unwrap();
    l1.cross(&l2).norm()
}

/// Returns the unit vectors in the plane of the lattice, the first along the first lattice vector.
fn plane(sheet: &Sheet) -> [Vec3; 2] {
    let [l1, l2] = sheet.lattice.unwrap();
    let x = l1.normalize();
    [x, (l2 - x * x.dot(&l2)).normalize()]
}

/// Returns the energy of a torus of 3 x 3 cells whose lattice is strained, relaxed, per area of the sheet at rest.
fn torus_energy(sheet: &Sheet, stiff: Stiff, [e11, e22, e12]: [f64; 3]) -> f64 {
    let [x, y] = plane(sheet);
    let small =
        0.5 * (e11 * x * x.transpose() + e22 * y * y.transpose() + e12 * (x * y.transpose() + y * x.transpose()));
    let change = Matrix3::identity() + small;
    let mut strained = sheet.clone();
    strained.vertices = sheet.vertices.iter().map(|p| change * p).collect();
    strained.lattice = sheet.lattice.map(|lattice| lattice.map(|l| change * l));
    let cells = [3, 3];
    let drawn = Assembly::fixed_torus(sheet.clone(), cells).bars(stiff.bars).build().unwrap();
    let edges = &drawn.tiling().edges;
    let length = |edge: usize| {
        let [i, j] = sheet.edges[edge].key.ends().map(|end| sheet.position(end));
        (j - i).norm()
    };
    let lengths = edges.iter().map(|edge| length(edge.edge)).collect();
    let angles = drawn.drawn_angles().to_vec();
    let assembly = Assembly::fixed_torus(strained, cells)
        .bars(stiff.bars)
        .rest_lengths(RestLengths::PerEdge(lengths))
        .creases(stiff.creases)
        .rest(Rest::PerEdge(angles.clone()))
        .facets(stiff.facets)
        .facet_rest(Rest::PerEdge(angles))
        .build()
        .unwrap();
    relax(&assembly).unwrap().state.total() / (9.0 * area(sheet))
}

/// Claim: the stretching moduli are those of the energy of a large torus under small imposed strain, for bars from soft
/// to stiff. Mean of both signs at strains of 1e-4: its error is the square of that times the stiffness of other
/// orders. Tolerance 1e-6, the claim of the study.
#[test]
fn stretching_is_that_of_a_strained_torus() {
    for (number, sheet) in sheets().iter().enumerate() {
        for bars in [1.0, 100.0, 1e4] {
            let stiff = Stiff { bars, ..SOFT };
            let moduli = found(sheet, stiff).matrices.unwrap();
            let s = Matrix3::from_fn(|i, j| moduli.stretching[i][j]);
            for e in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.7, -0.4, 0.3], [-0.2, 0.9, 0.5]] {
                let at = |sign: f64| torus_energy(sheet, stiff, e.map(|e| sign * 1e-4 * e));
                let energy = 0.5 * (at(1.0) + at(-1.0)) / 1e-8;
                let e = Vec3::from(e);
                let expected = 0.5 * e.dot(&(s * e));
                let off = (energy - expected).abs() / expected;
                assert!(off <= 1e-6, "sheet {number}, bars {bars}, {e:?}: {energy} for {expected}, off by {off:e}");
            }
        }
    }
}

/// Returns the model of one cell on a screw with its axis in a direction, all coordinates free.
fn screw(sheet: &Sheet, stiff: Stiff, direction: f64) -> Model {
    let screw = Assembly::screw(sheet.clone(), [1, 1]).bars(stiff.bars).creases(stiff.creases).facets(stiff.facets);
    screw.build().unwrap().with_axis(direction).with_free_coordinates().model(Gauge::Free)
}

/// Returns the second derivatives of the energy by the last six coordinates of a screw, minimised over all vertices but
/// vertex 0.
fn condensed(hessian: &DenseMatrix) -> DenseMatrix {
    let vertices = hessian.nrows() - 6 - 3;
    let inner = hessian.view((3, 3), (vertices, vertices)).into_owned();
    let mixed = hessian.view((3, 3 + vertices), (vertices, 6)).into_owned();
    let outer = hessian.view((3 + vertices, 3 + vertices), (6, 6)).into_owned();
    outer - mixed.transpose() * inner.lu().solve(&mixed).unwrap()
}

/// Claim: stretching, coupling and bending moduli are the Hessian of the energy of one cell in the coordinates of a
/// screw, condensed to strain and curvature, for bending about axes in every direction. Source: the chart of theory,
/// whose second derivatives are checked entry by entry elsewhere. Tolerance: rounding, 1e-9 of the largest modulus.
#[test]
fn moduli_are_the_condensed_hessian_of_a_screw() {
    for sheet in &sheets() {
        for bars in [1.0, 100.0, 1e6] {
            let stiff = Stiff { bars, ..SOFT };
            let matrix = whole(&found(sheet, stiff).matrices.unwrap());
            for direction in [0.0, 0.5, 1.3, 2.2, 3.0] {
                let model = screw(sheet, stiff, direction);
                let hessian = condensed(&energy_hessian(&model, &model.start()));
                // coordinates: direction, kappa, y1, y2, x1, x2
                let (sin, cos) = f64::sin_cos(direction);
                let [x, y] = plane(sheet);
                let lattice = sheet.lattice.unwrap().map(|l| nalgebra::Vector2::new(x.dot(&l), y.dot(&l)));
                let a = Matrix2::from_columns(&lattice);
                let motion = |strain: Matrix2<f64>, kappa: f64| {
                    let rates = 0.5 * strain * a;
                    DVector::from_vec(vec![0.0, kappa, rates.m21, rates.m22, rates.m11, rates.m12])
                };
                let unit = |k: usize| match k {
                    0 => Matrix2::new(1.0, 0.0, 0.0, 0.0),
                    1 => Matrix2::new(0.0, 0.0, 0.0, 1.0),
                    _ => Matrix2::new(0.0, 1.0, 1.0, 0.0),
                };
                let mut motions: Vec<(DVector<f64>, SVector<f64, 6>)> =
                    (0..3).map(|k| (motion(unit(k), 0.0), SVector::ith(k, 1.0))).collect();
                let bend = SVector::from([0.0, 0.0, 0.0, sin * sin, cos * cos, -sin * cos]);
                motions.push((motion(Matrix2::zeros(), 1.0), bend));
                let largest = matrix.amax();
                for (u, m) in &motions {
                    for (v, n) in &motions {
                        let chart = u.dot(&(&hessian * v)) / area(sheet);
                        let own = m.dot(&(matrix * n));
                        assert!((chart - own).abs() <= 1e-9 * largest, "{bars}, {direction}: {own} for {chart}");
                    }
                }
            }
        }
    }
}

/// Returns the energy of a screw whose curvature is held, minimised over all vertices but vertex 0 by Newton's method.
fn bent_energy(model: &Model, kappa: f64) -> f64 {
    let mut x = model.start();
    let (count, vertices) = (x.len(), x.len() - 6);
    x[vertices + 1] = kappa;
    for _ in 0..12 {
        let tension: Vec<f64> = model.gaps(&x).iter().zip(model.compliance()).map(|(gap, c)| gap / c).collect();
        let at = linearized(model, &x, &tension);
        let rows = jacobian(model, &at);
        let force = DVector::from_column_slice(&at.gradient) + rows.tr_mul(&DVector::from_column_slice(&tension));
        let mut weighted = rows.clone();
        weighted.row_iter_mut().zip(model.compliance()).for_each(|(mut row, c)| row /= *c);
        let hessian = at.pattern().to_dense(&at.hessian) + rows.tr_mul(&weighted);
        let inner = hessian.view((3, 3), (vertices - 3, vertices - 3)).into_owned();
        let step = inner.lu().solve(&force.rows(3, vertices - 3).into_owned()).unwrap();
        (0..vertices - 3).for_each(|k| x[3 + k] -= step[k]);
        assert_eq!(count, x.len());
    }
    let stretched: f64 = model.gaps(&x).iter().zip(model.compliance()).map(|(gap, c)| gap * gap / (2.0 * c)).sum();
    model.energy(&x) + stretched
}

/// Claim: the bending moduli are those of the energy of cylinders of small curvature about axes in every direction, at
/// held lattice. Mean of both signs at 1e-3 per length: the error is the square of that. Tolerance 1e-6.
#[test]
fn bending_is_that_of_cylinders() {
    for sheet in &sheets() {
        for bars in [1.0, 100.0] {
            let stiff = Stiff { bars, ..SOFT };
            let bending = found(sheet, stiff).matrices.unwrap().bending;
            let b = Matrix3::from_fn(|i, j| bending[i][j]);
            for direction in [0.0, 0.8, 1.6, 2.5] {
                let model = screw(sheet, stiff, direction);
                let at = |kappa: f64| {
                    let mean = 0.5 * (bent_energy(&model, kappa) + bent_energy(&model, -kappa));
                    2.0 * mean / (kappa * kappa * area(sheet))
                };
                // the next order of the mean, in the fourth power of the curvature, is taken out by two curvatures
                let energy = (4.0 * at(1e-3) - at(2e-3)) / 3.0;
                let (sin, cos) = f64::sin_cos(direction);
                let k = Vec3::new(sin * sin, cos * cos, -sin * cos);
                let expected = k.dot(&(b * k));
                let off = (energy - expected).abs() / expected;
                assert!(off <= 1e-6, "bars {bars}, {direction}: {energy} for {expected}, off by {off:e}");
            }
        }
    }
}

/// Claim: the limit of the moduli over the stiffness of the bars has rank 3, and its null space are the three linear
/// modes, found by closure in fold angles; the moduli over `EA` approach it. On a self stress's strains and bendings
/// the energy grows with the stiffness, along the modes it stays. Tolerance: rounding; the approach is as 1/EA.
#[test]
fn the_rigid_limit_knows_the_modes() {
    for sheet in &sheets() {
        let cell = response(&builder(sheet, SOFT).build().unwrap()).unwrap();
        let limit = whole(&found(sheet, SOFT).rigid_limit.unwrap());
        let mut values = common::eigenvalues(DenseMatrix::from_fn(6, 6, |i, j| limit[(i, j)]));
        values.sort_by(f64::total_cmp);
        assert!(values[2].abs() <= 1e-12 * values[5] && values[3] >= 1e-3 * values[5], "{values:?}");
        let of_mode = |k: usize| {
            let mode = &cell.modes[k];
            SVector::<f64, 6>::from_iterator(mode.strain.iter().chain(&mode.curvature).copied())
        };
        for k in 0..3 {
            assert!((limit * of_mode(k)).norm() <= 1e-12 * of_mode(k).norm() * values[5], "mode {k}");
        }
        let at = |bars: f64| whole(&found(sheet, Stiff { bars, ..SOFT }).matrices.unwrap());
        for bars in [1e4, 1e6, 1e8] {
            let off = (at(bars) / bars - limit).amax() / limit.amax();
            assert!(off <= 100.0 / bars, "{bars}: {off:e}");
        }
        let (soft, stiff) = (at(1e6), at(1e8)); // the stress with the least work has 2 % of it from hinges at 1e4
        for stress in &cell.stresses {
            let direction = SVector::<f64, 6>::from_iterator(stress.force.iter().chain(&stress.moment).copied());
            let growth = direction.dot(&(stiff * direction)) / direction.dot(&(soft * direction));
            assert!((growth / 100.0 - 1.0).abs() <= 0.01, "100 times the stiffness: {growth}");
        }
        for k in 0..3 {
            let (before, after) = (of_mode(k).dot(&(soft * of_mode(k))), of_mode(k).dot(&(stiff * of_mode(k))));
            assert!((after / before - 1.0).abs() <= 0.02, "mode {k}: {before} {after}");
        }
    }
}

/// Claim: the stiffness of a rigid mode is the energy of its hinges, `sum k L rate^2` per area; the softest principal
/// strains and bendings approach those of rigid bars from below, with a difference as 1/EA, with all digits at every
/// stiffness; rigid bars have exactly those.
#[test]
fn the_softest_are_the_rigid_modes() {
    for sheet in &sheets() {
        let rigid = found(sheet, Stiff { bars: RIGID, ..SOFT });
        assert!(rigid.matrices.is_none() && rigid.rigid_limit.is_some());
        assert_eq!((rigid.rigid_modes.len(), rigid.softest.len()), (3, 3));
        // energy of the modes from their fold rates
        let cell = response(&builder(sheet, SOFT).build().unwrap()).unwrap();
        for principal in &rigid.rigid_modes {
            let target: Vec<f64> = principal.strain.iter().chain(&principal.curvature).copied().collect();
            let table = DenseMatrix::from_fn(6, 3, |row, k| {
                let mode = &cell.modes[k];
                if row < 3 { mode.strain[row] } else { mode.curvature[row - 3] }
            });
            let mix = table.clone().svd(true, true).solve(&DVector::from_vec(target.clone()), 1e-12).unwrap();
            assert!((&table * &mix - DVector::from_vec(target)).amax() <= 1e-11);
            let energy: f64 = (0..sheet.edges.len())
                .map(|edge| {
                    let rate: f64 = (0..3).map(|k| mix[k] * cell.modes[k].rates[edge]).sum();
                    let [i, j] = sheet.edges[edge].key.ends().map(|end| sheet.position(end));
                    let stiffness = match sheet.edges[edge].kind {
                        foldwell::sheet::EdgeKind::Facet => SOFT.facets,
                        _ => SOFT.creases,
                    };
                    stiffness * (j - i).norm() * rate * rate
                })
                .sum();
            let expected = energy / area(sheet);
            assert!((principal.stiffness / expected - 1.0).abs() <= 1e-10, "{} for {expected}", principal.stiffness);
        }
        let mut last = [0.0; 3];
        for bars in [1.0, 1e2, 1e4, 1e6, 1e8, 1e12, RIGID] {
            let found = found(sheet, Stiff { bars, ..SOFT });
            for (k, last) in last.iter_mut().enumerate() {
                let ratio = found.softest[k].stiffness / rigid.rigid_modes[k].stiffness;
                assert!(ratio >= *last - 1e-12 && ratio <= 1.0 + 1e-12, "{bars}, {k}: {ratio}");
                assert!(1.0 - ratio <= 1e3 / bars + 1e-12, "{bars}, {k}: {ratio}");
                *last = ratio;
            }
        }
    }
}

/// Claim: a sheet whose hinges cost nothing has moduli of rank 3; one without bars, under stress, or with rigid
/// polygons has none, and says why.
#[test]
fn sheets_without_moduli() {
    let [star, miura, _] = sheets();
    let loose = moduli(&Assembly::torus(star.clone(), [1, 1]).bars(100.0).build().unwrap()).unwrap();
    let matrix = whole(&loose.matrices.unwrap());
    assert!((matrix - 100.0 * whole(&loose.rigid_limit.unwrap())).amax() <= 1e-11 * matrix.amax());
    assert!(loose.softest.iter().all(|principal| principal.stiffness.abs() <= 1e-12 * matrix.amax()));
    let without = Assembly::torus(star.clone(), [1, 1]).creases(1.0).build().unwrap();
    assert!(matches!(moduli(&without), Err(ResponseError::NoBars)));
    let stressed = Assembly::torus(star, [1, 1]).bars(1.0).creases(1.0).rest(Rest::Flat).build().unwrap();
    assert!(matches!(moduli(&stressed), Err(ResponseError::UnderStress { off }) if off > 0.1));
    let stiff = Stiff { facets: RIGID, ..SOFT };
    let rigid = found(&miura, stiff);
    assert!(rigid.matrices.is_some() && rigid.rigid_modes.len() == 1, "bars stretch and bend the polygons");
}
