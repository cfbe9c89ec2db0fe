//! Linearly dependent rigid terms: rigid quadrilaterals, fixed tori, flat vertices.

use crate::common::{Numbers, Testing, distance, eigenvalues, jacobian, linearized, mesh, on, patch};
use foldwell::analysis::relax::{Relaxed, relax_from};
use foldwell::math::Vec3;
use foldwell::model::Gauge;
use foldwell::model::{Assembly, Boundary, Terms};
use foldwell::numerics::DenseMatrix;
use foldwell::sheet::generate;
use foldwell::sheet::generate::{MiuraPatch, Pattern, Random, RandomDevelopable};
use foldwell::solver::{Options, Problem, Start};

const RIGID: f64 = f64::INFINITY;

fn miura(cells: [usize; 2]) -> Assembly {
    let pattern = Pattern::MiuraPatch(MiuraPatch { a: 2.0, b: 2.0, cells, ..MiuraPatch::default() });
    on(generate(&pattern).unwrap(), [1, 1], Boundary::Patch)
}

/// Returns terms with rigid bars, rigid quadrilaterals and the given rest angles of creases.
fn rigid_quads(case: &Assembly, rest: Vec<f64>) -> Terms {
    Terms { facets: case.facets(RIGID), ..Terms::bars_and_creases(RIGID, 1.0, rest) }
}

fn converged(found: &Relaxed) {
    assert!(found.residual_force <= 1e-12 && found.residual_length <= 1e-12, "{:?}", found.history.last());
}

/// Returns the Jacobian of the rigid terms at a relaxed state, with no coordinate held, and their tensions, in units in
/// which terms of one stiffness store the square of a tension.
fn forces(case: &Assembly, terms: &Terms, found: &Relaxed) -> (DenseMatrix, Vec<f64>) {
    let mut model = case.model_of(terms, Gauge::Free);
    let x = model.start_from(found.state.coordinates.clone());
    let at = linearized(&model, &x, found.configuration.tensions());
    let mut rows = jacobian(&model, &at);
    let units: Vec<f64> = model.proportions().into_iter().map(f64::sqrt).collect();
    rows.row_iter_mut().zip(&units).for_each(|(mut row, unit)| row /= *unit);
    (rows, found.configuration.tensions().iter().zip(&units).map(|(tension, unit)| tension * unit).collect())
}

/// Returns the number of self stresses by a dense decomposition (nalgebra's), and the relative part of the tensions
/// along them.
fn self_stress_part((rows, tension): &(DenseMatrix, Vec<f64>)) -> (usize, f64) {
    let gram = rows * rows.transpose();
    let found = nalgebra::SymmetricEigen::new(gram);
    let largest = found.eigenvalues.amax();
    let t = nalgebra::DVector::from_column_slice(tension);
    let null: Vec<usize> = (0..tension.len()).filter(|&k| found.eigenvalues[k] < 1e-12 * largest).collect();
    let part: f64 = null.iter().map(|&k| found.eigenvectors.column(k).dot(&t).powi(2)).sum();
    (null.len(), part.sqrt() / t.norm())
}

/// Claim: Miura-ori of 5 x 5 cells with rigid quadrilaterals and rigid bars, rest angles within 0.1 rad of the drawn
/// ones: converged, 64 self stresses, and tensions of least norm. Tolerance of the norm: the eigenvalues of `R R^T`
/// separate null vectors to 1e-16 over 1e-3.
#[test]
fn miura_with_rigid_quadrilaterals() {
    let case = miura([5, 5]);
    for seed in 1..4 {
        let terms = rigid_quads(&case, case.rest_per_hinge(0.1, seed));
        let found = case.relax(&terms).unwrap();
        converged(&found);
        assert_eq!((found.self_stresses, found.negative_eigenvalues), (Some(64), Some(0)));
        let (count, part) = self_stress_part(&forces(&case, &terms, &found));
        assert_eq!(count, 64);
        assert!(part < 1e-8, "seed {seed}: {part:e} of the tensions is self stress");
        assert!(distance(&found.state.coordinates, &case.drawn().coordinates) > 1e-3, "nothing moved");
    }
}

/// Claim: tensions of redundant rigid terms are those to which the tensions of stiff ones of equal stiffness converge,
/// and the stiff ones are right at 1e10 too. Sheets: rigid quadrilaterals of Miura-ori (self stresses of bars and
/// hinges), and a torus with fixed lattice. Source: relaxations with stiffness 1e4 to 1e10. Tolerance: first order in the
/// softness, and the rounding of stretches of 1e-10.
#[test]
fn tensions_are_the_limit_of_stiff_ones() {
    let torus = on(generate(&Pattern::Random(Random::default())).unwrap(), [1, 1], Boundary::FixedTorus);
    for (name, case, quads) in [("quads", miura([3, 3]), true), ("torus", torus, false)] {
        let rest = case.rest_per_hinge(0.1, 1);
        let tensions = |stiffness: f64| {
            let facets = if quads { case.facets(stiffness) } else { None };
            let terms = Terms { facets, ..Terms::bars_and_creases(stiffness, 1.0, rest.clone()) };
            case.relax(&terms).unwrap().state.tension
        };
        let rigid = tensions(RIGID);
        let largest = rigid.iter().filter(|t| t.is_finite()).fold(0.0, |most: f64, t| most.max(t.abs()));
        for stiffness in [1e4, 1e6, 1e8, 1e10] {
            let stiff = tensions(stiffness);
            let both = stiff.iter().zip(&rigid).filter(|(stiff, _)| stiff.is_finite());
            let off = both.fold(0.0, |most: f64, (stiff, rigid)| most.max((stiff - rigid).abs())) / largest;
            assert!(off <= 4e3 / stiffness + 1e-5, "{name}, {stiffness:e}: {off:e}");
        }
    }
}

/// Claim: on a torus with fixed lattice a generic rigid sheet has 3 self stresses and cannot move: only tensions, of
/// least norm, balance the creases' torques. One cell and 3 x 3 cells (generic: these do not fold at a finite
/// wavenumber).
#[test]
fn fixed_tori() {
    for (seed, cells) in [(1, [1, 1]), (2, [1, 1]), (1, [3, 3])] {
        let sheet = generate(&Pattern::Random(Random { seed, ..Random::default() })).unwrap();
        let case = on(sheet, cells, Boundary::FixedTorus);
        let terms = Terms::bars_and_creases(RIGID, 1.0, case.rest_per_hinge(0.1, seed));
        let found = case.relax(&terms).unwrap();
        converged(&found);
        assert_eq!((found.self_stresses, found.negative_eigenvalues), (Some(3), Some(0)), "{cells:?}");
        let (count, part) = self_stress_part(&forces(&case, &terms, &found));
        assert_eq!(count, 3, "{cells:?}");
        assert!(part < 1e-8, "{cells:?}: {part:e}");
    }
}

/// Claim: a torus with fixed lattice has three self stresses at every size, although they are only a hundredth of a
/// random stretch, and they are removed from the tensions, although some motions of large tori stretch almost nothing.
#[test]
fn large_fixed_tori() {
    for n in [8, 12, 20, 28] {
        let case = on(mesh("open-star"), [n, n], Boundary::FixedTorus);
        let found = case.relax(&Terms::bars_and_creases(RIGID, 1.0, vec![0.0; case.drawn_angles().len()])).unwrap();
        converged(&found);
        assert_eq!(found.self_stresses, Some(3), "{n} x {n}");
    }
}

/// Claim: folded Miura-ori with bending facets, a developable sheet on one of its branches, has no self stress.
#[test]
fn a_developable_sheet_on_a_branch() {
    let case = miura([5, 5]);
    for seed in 1..4 {
        let terms =
            Terms { facets: case.facets(1.0), ..Terms::bars_and_creases(RIGID, 1.0, case.rest_per_hinge(0.1, seed)) };
        let found = case.relax(&terms).unwrap();
        converged(&found);
        assert_eq!((found.self_stresses, found.negative_eigenvalues), (Some(0), Some(0)));
    }
}

/// Claim: a random developable patch, folded at finite stiffness from a randomly moved start, is on a branch: from
/// there the exactly rigid sheet converges, without self stress, near the stiff one.
#[test]
fn a_random_developable_patch_on_a_branch() {
    for seed in [1, 2, 3] {
        let sheet = generate(&Pattern::RandomDevelopable(RandomDevelopable { seed, ..Default::default() })).unwrap();
        let case = on(sheet, [3, 3], Boundary::Patch);
        let rest = case.rest_per_hinge(0.8, seed);
        let stiff = {
            let model = case.model_of(&Terms::bars_and_creases(1e5, 1.0, rest.clone()), Gauge::Held);
            let mut numbers = Numbers::new(seed);
            let start: Vec<f64> = model.start().iter().map(|x| x + numbers.within(0.1)).collect();
            relax_from(&model, start, Options::default(), &mut |_| true).unwrap()
        };
        assert_eq!(stiff.negative_eigenvalues, Some(0));
        let mut model = case.model_of(&Terms::bars_and_creases(RIGID, 1.0, rest), Gauge::Held);
        let start = model.start_from(stiff.state.coordinates.clone());
        let found = relax_from(&model, start, Options::default(), &mut |_| true)
            .unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        converged(&found);
        assert_eq!((found.self_stresses, found.negative_eigenvalues), (Some(0), Some(0)), "seed {seed}");
        let off = distance(&found.state.fold_angle, &stiff.state.fold_angle);
        assert!(off < 0.1, "seed {seed}: off by {off}");
    }
}

/// Claim: an exactly flat rigid patch whose rest angles are folded leaves the flat state, which is a singular start,
/// and comes to rest on a branch, at every size and for any rest angles; its energy is below that of the flat state.
/// Source: the energy of the flat state, half the squared rest angles times the lengths of the creases.
#[test]
fn a_flat_rigid_patch_leaves_the_flat_state() {
    for cells in [[2, 2], [4, 4], [6, 6]] {
        for seed in 1..4 {
            let case = patch("open-flat", cells);
            let rest = case.rest_per_hinge(0.1, seed);
            let edges = case.tiling().edges.iter().zip(&rest).filter(|(edge, _)| edge.hinge().is_some());
            let flat: f64 = edges
                .map(|(edge, rest)| {
                    let [a, b] = edge.ends.map(|site| case.tiling().positions[site.vertex]);
                    0.5 * (b - a).norm() * rest * rest
                })
                .sum();
            let found = case.relax(&Terms::bars_and_creases(RIGID, 1.0, rest)).unwrap();
            converged(&found);
            assert!(found.branch_choice.is_some_and(|choice| choice.soft_bars), "{cells:?}, seed {seed}");
            assert_eq!(found.negative_eigenvalues, Some(0), "{cells:?}, seed {seed}");
            assert!(found.state.total() < 0.99 * flat, "{cells:?}, seed {seed}: {} of {flat}", found.state.total());
        }
    }
}

/// Returns the number of negative eigenvalues of the Hessian of the whole energy at a relaxed state, dense, by another
/// library; all stiffnesses must be finite. Rigid motions are held.
fn negative(case: &Assembly, terms: &Terms, found: &Relaxed) -> usize {
    let mut model = case.model_of(terms, Gauge::Held);
    let x = model.enter(&found.configuration).x;
    let at = linearized(&model, &x, found.configuration.tensions());
    let rows = jacobian(&model, &at);
    let stiff = DenseMatrix::from_diagonal(&nalgebra::DVector::from_iterator(
        rows.nrows(),
        model.compliance().iter().map(|c| 1.0 / c),
    ));
    let hessian = at.pattern().to_dense(&at.hessian) + rows.tr_mul(&stiff) * &rows;
    eigenvalues(hessian).iter().filter(|value| **value < 0.0).count()
}

/// Returns rest angles whose torques balance in the flat state, along the null space of the transposed gradients.
fn balanced(case: &Assembly, size: f64, seed: u64) -> Vec<f64> {
    let terms = Terms { bars: None, ..Terms::bars_and_creases(RIGID, RIGID, case.drawn_angles().to_vec()) };
    let model = case.model_of(&terms, Gauge::Free);
    let rows = jacobian(&model, &linearized(&model, &model.start(), &vec![0.0; model.layout().stiff.len()]));
    let found = nalgebra::SymmetricEigen::new(&rows * rows.transpose());
    let mut numbers = Numbers::new(seed);
    let null: Vec<usize> =
        (0..rows.nrows()).filter(|&k| found.eigenvalues[k] < 1e-12 * found.eigenvalues.amax()).collect();
    let sum = null.iter().fold(nalgebra::DVector::zeros(rows.nrows()), |sum, &k| {
        sum + numbers.within(1.0) * found.eigenvectors.column(k)
    });
    let moments = size / sum.amax() * sum;
    let mut rest = vec![0.0; case.edges()];
    for (element, moment) in model.stiff().zip(&moments) {
        let edge = element.edge().unwrap();
        let [a, b] = case.tiling().edges[edge].ends.map(|site| case.tiling().positions[site.vertex]);
        rest[edge] = moment / (a - b).norm();
    }
    rest
}

/// Claim: a flat patch whose rest angles balance is in equilibrium in the flat state at finite stiffness, which is
/// found with its negative eigenvalues: none for small rest angles, some for large ones on soft bars (where folding
/// costs less than the stretching that it relieves), as many as a dense decomposition counts.
#[test]
fn a_flat_equilibrium_reports_its_negative_eigenvalues() {
    let case = patch("open-flat", [4, 4]);
    let mut unstable = 0;
    for (size, bars, seed) in [(1e-3, 1e4, 1), (1.0, 1e2, 1), (3.0, 1e2, 2), (3.0, 10.0, 3)] {
        let terms = Terms::bars_and_creases(bars, 1.0, balanced(&case, size, seed));
        let found = case.relax(&terms).unwrap();
        converged(&found);
        assert!(
            found.state.fold_angle.iter().all(|angle| angle.is_nan() || angle.abs() < 1e-9),
            "it left the flat state"
        );
        let expected = negative(&case, &terms, &found);
        println!("rest angles {size}, bars {bars}: {expected} negative eigenvalues");
        assert_eq!(found.negative_eigenvalues, Some(expected));
        assert!(size > 0.1 || expected == 0);
        unstable += usize::from(expected > 0);
    }
    assert!(unstable > 0, "no case was unstable: the test shows nothing");
}

/// Claim: a flat patch compressed in its plane beyond buckling, asked for the equilibrium next to a start of known
/// tensions (none), stays flat, since no force acts out of the plane, and reports its buckling modes, as many as a
/// dense decomposition counts; stretched by the same forces it reports none. The forces are proportional to the
/// distance from the centre; pins hold the six rigid motions.
#[test]
fn a_compressed_flat_sheet_reports_buckling() {
    let case = patch("open-flat", [4, 4]);
    let positions = &case.tiling().positions;
    let by = |direction: Vec3| {
        move |a: &usize, b: &usize| positions[*a].dot(&direction).total_cmp(&positions[*b].dot(&direction))
    };
    let vertices = || 0..positions.len();
    let [left, right] = [Vec3::x(), -Vec3::x()].map(|d| vertices().min_by(by(d)).unwrap());
    let top = vertices().max_by(by(Vec3::y())).unwrap();
    let pins = vec![(left, [true; 3]), (right, [false, true, true]), (top, [false, false, true])];
    let centre = positions.iter().sum::<Vec3>() / positions.len() as f64;
    for (pressure, buckles) in [(0.05, true), (0.5, true), (-0.05, false), (-0.5, false)] {
        let loads = vertices().map(|v| (v, pressure * (centre - positions[v]))).collect();
        let terms =
            Terms { loads, pins: pins.clone(), ..Terms::bars_and_creases(1e4, 0.1, case.drawn_angles().to_vec()) };
        let model = case.model_of(&terms, Gauge::Held);
        let start = Start { x: model.start(), tension: Some(vec![0.0; model.compliance().len()]) };
        let found = relax_from(&model, start, Options::default(), &mut |_| true).unwrap();
        converged(&found);
        assert!(found.state.coordinates.chunks(3).all(|p| p[2].abs() < 1e-9), "it left the plane");
        let counted = found.negative_eigenvalues.unwrap();
        println!("pressed by {pressure}: {counted} negative eigenvalues");
        assert_eq!(counted > 0, buckles, "{counted}");
        assert_eq!(counted, negative(&case, &terms, &found));
    }
}
