//! Systems whose solutions are known beforehand.

use super::solutions::Solutions;
use super::system::{C, Quadrics, distance, normalize};
use super::*;
use crate::DenseMatrix;
use crate::random::symmetric;
use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// All solutions of as many quadrics as determine points.
fn solve(quadrics: &[DenseMatrix]) -> Result<Solutions, HomotopyError> {
    square::solve_square(&Quadrics::new(quadrics, quadrics.len() + 1)?)
}

fn random(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(1000 + seed)
}

fn vector(unknowns: usize, random: &mut ChaCha8Rng) -> DVector<f64> {
    DVector::from_fn(unknowns, |_, _| symmetric(random))
}

fn random_quadrics(count: usize, seed: u64) -> Vec<DenseMatrix> {
    let mut random = random(seed);
    let mut full = || DenseMatrix::from_fn(count + 1, count + 1, |_, _| symmetric(&mut random));
    (0..count).map(|_| full()).map(|a| &a + a.transpose()).collect()
}

/// The product of two linear forms.
fn product(a: &DVector<f64>, b: &DVector<f64>) -> DenseMatrix {
    a * b.transpose() + b * a.transpose()
}

/// A quadric in affine coordinates: `constant + linear x + x^T quadratic x`, the homogeneous unknown first.
fn affine(constant: f64, linear: &[f64], quadratic: &[(usize, usize, f64)]) -> DenseMatrix {
    let mut matrix = DenseMatrix::zeros(linear.len() + 1, linear.len() + 1);
    matrix[(0, 0)] = constant;
    for (k, c) in linear.iter().enumerate() {
        matrix[(0, k + 1)] += 0.5 * c;
        matrix[(k + 1, 0)] += 0.5 * c;
    }
    for &(i, j, c) in quadratic {
        matrix[(i + 1, j + 1)] += 0.5 * c;
        matrix[(j + 1, i + 1)] += 0.5 * c;
    }
    matrix
}

/// Multiplicities, ascending.
fn multiplicities(solutions: &Solutions) -> Vec<usize> {
    let mut list: Vec<usize> = solutions.isolated.iter().map(|solution| solution.multiplicity).collect();
    list.sort_unstable();
    list
}

fn residual(quadrics: &[DenseMatrix], solution: &Solution) -> f64 {
    Quadrics::new(quadrics, solution.point.len()).unwrap().residual(&solution.point)
}

fn at(solutions: &Solutions, point: &[f64]) -> Solution {
    let mut place: Vec<C> = point.iter().map(|entry| C::new(*entry, 0.0)).collect();
    normalize(&mut place);
    let near = |solution: &&Solution| distance(&place, &solution.point) <= 1e-8;
    solutions.isolated.iter().find(near).unwrap_or_else(|| panic!("{point:?} of {solutions:?}")).clone()
}

/// Claim (Bezout): m random quadrics have 2^m simple solutions, with their conjugates, each satisfied to rounding.
/// Tolerance: rounding of Newton's method, the worst of 64 Jacobians has a condition number of some 100.
#[test]
fn random_quadrics_have_all_their_solutions() {
    for (count, seed) in (0..=6).zip(0..).chain([(4, 10), (4, 11), (4, 12), (5, 13)]) {
        let quadrics = random_quadrics(count, seed);
        let found = solve(&quadrics).unwrap();
        assert_eq!((found.isolated.len(), found.count(), found.paths), (1 << count, 1 << count, 1 << count));
        for solution in &found.isolated {
            let good = residual(&quadrics, solution) <= 1e-15 && solution.error <= 1e-14;
            assert!(good, "{:e} {:e}", residual(&quadrics, solution), solution.error);
            let conjugate: Vec<C> = solution.point.iter().map(C::conj).collect();
            let partner = found.isolated.iter().find(|other| distance(&other.point, &conjugate) <= 1e-12).unwrap();
            assert_eq!(solution.real, partner == solution);
        }
    }
}

/// Claim: where every quadric is a product of two linear forms the solutions are the points where one form of each
/// vanishes, all real. Tolerance 1e-12: rounding, with condition numbers up to 1e3.
#[test]
fn products_of_linear_forms() {
    let mut random = random(1);
    let forms: Vec<[DVector<f64>; 2]> = (0..4).map(|_| [0, 1].map(|_| vector(5, &mut random))).collect();
    let quadrics: Vec<DenseMatrix> = forms.iter().map(|[a, b]| product(a, b)).collect();
    let found = solve(&quadrics).unwrap();
    assert_eq!(multiplicities(&found), [1; 16]);
    for choice in 0..16 {
        let rows = DenseMatrix::from_fn(4, 5, |k, column| forms[k][choice >> k & 1][column]);
        let point = crate::dense::null_space(&rows).unwrap().basis;
        let place: Vec<C> = point.iter().map(|entry| C::new(*entry, 0.0)).collect();
        let nearest =
            found.isolated.iter().min_by(|a, b| distance(&place, &a.point).total_cmp(&distance(&place, &b.point)));
        let nearest = nearest.unwrap();
        assert!(nearest.real && distance(&place, &nearest.point) <= 1e-12);
    }
}

/// Claim: squares of linear forms double the solutions: with k squares among four quadrics every solution has
/// multiplicity 2^k, up to one of multiplicity 16. Tolerance of the place 1e-8, as asked of the mean of a circle.
#[test]
fn squares_of_linear_forms() {
    for squares in 1..=4 {
        let mut random = random(20 + squares);
        let mut quadrics = random_quadrics(4, 30 + squares);
        let forms: Vec<DVector<f64>> = (0..squares).map(|_| vector(5, &mut random)).collect();
        forms.iter().enumerate().for_each(|(k, form)| quadrics[k] = product(form, form));
        let found = solve(&quadrics).unwrap();
        assert_eq!(multiplicities(&found), vec![1 << squares; 1 << (4 - squares)]);
        for solution in &found.isolated {
            let point = DVector::from_column_slice(&solution.point);
            let off = forms.iter().map(|form| form.map(|entry| C::new(entry, 0.0)).dot(&point).norm());
            assert!(off.fold(0.0, f64::max) <= 1e-8, "{solution:?}");
        }
    }
}

/// Claim: two conics that touch have there a solution of multiplicity 2, that osculate 3, that hyperosculate 4: a
/// circle of curvature 1 and parabolas; and two conics of the same axis touch twice.
#[test]
fn tangency_and_osculation() {
    // y - x^2/2 + terms of a conic through the origin with the same tangent and curvature
    let circle = affine(0.0, &[0.0, -2.0], &[(0, 0, 1.0), (1, 1, 1.0)]);
    let touching = affine(0.0, &[0.0, -1.0], &[(0, 0, 1.0)]);
    let osculating = affine(0.0, &[0.0, -2.0], &[(0, 0, 1.0), (0, 1, 0.7), (1, 1, 0.4)]);
    let hyperosculating = affine(0.0, &[0.0, -2.0], &[(0, 0, 1.0), (1, 1, 0.3)]);
    for (conic, expected) in [(touching, vec![1, 1, 2]), (osculating, vec![1, 3]), (hyperosculating, vec![4])] {
        let found = solve(&[circle.clone(), conic]).unwrap();
        assert_eq!(multiplicities(&found), expected);
        let origin = at(&found, &[1.0, 0.0, 0.0]);
        assert!(origin.real && origin.multiplicity == expected[expected.len() - 1] && origin.error <= 1e-8);
    }
    let ellipse = affine(-1.0, &[0.0, 0.0], &[(0, 0, 0.25), (1, 1, 1.0)]);
    let unit = affine(-1.0, &[0.0, 0.0], &[(0, 0, 1.0), (1, 1, 1.0)]);
    let found = solve(&[unit, ellipse]).unwrap();
    assert_eq!(multiplicities(&found), [2, 2]);
    assert!(at(&found, &[1.0, 0.0, 1.0]).real && at(&found, &[1.0, 0.0, -1.0]).real);
}

/// Claim: solutions 1e-5 apart are told apart, real ones from a conjugate pair too: x^2 = +-d^2/4 with y z fixed.
/// Tolerance of the place: rounding over the distance, 1e-16 / 1e-5.
#[test]
fn clusters_are_resolved() {
    for (sign, distance) in [(1.0, 1e-2), (1.0, 1e-5), (-1.0, 1e-5)] {
        let pair = affine(-sign * 0.25 * distance * distance, &[0.0, 0.0], &[(0, 0, 1.0)]);
        let other = affine(-1.0, &[0.3, 0.1], &[(0, 1, 0.4), (1, 1, 1.0)]);
        let found = solve(&[pair, other]).unwrap();
        assert_eq!(multiplicities(&found), [1; 4]);
        for solution in &found.isolated {
            let x = solution.point[1] / solution.point[0];
            let off = if sign > 0.0 { x.re.abs() } else { x.im.abs() } - 0.5 * distance;
            assert!(off.abs() <= 1e-10, "{x}");
            assert_eq!(solution.real, sign > 0.0);
        }
    }
}

/// Claim: curves of solutions are recognised: two quadrics with a common linear factor share a line, and meet once more
/// outside of it; three quadrics of a net that all hold one twisted cubic share just that.
#[test]
fn continua_are_recognised() {
    let mut random = random(5);
    let [common, a, b] = [0, 1, 2].map(|_| vector(3, &mut random));
    let found = solve(&[product(&common, &a), product(&common, &b)]).unwrap();
    assert_eq!((multiplicities(&found), found.on_continua.len()), (vec![1], 3));
    let common = common.map(|entry| C::new(entry, 0.0));
    let off = found.on_continua.iter().map(|point| common.dot(&DVector::from_column_slice(point)).norm());
    assert!(off.fold(0.0, f64::max) <= 1e-9);
    // 2 x 2 minors of (x0 x1 x2; x1 x2 x3)
    let minor = |i: usize, j: usize, k: usize, l: usize| {
        let mut matrix = DenseMatrix::zeros(4, 4);
        [(i, j, 0.5), (j, i, 0.5), (k, l, -0.5), (l, k, -0.5)].iter().for_each(|&(a, b, c)| matrix[(a, b)] += c);
        matrix
    };
    let cubic = solve(&[minor(0, 2, 1, 1), minor(0, 3, 1, 2), minor(1, 3, 2, 2)]).unwrap();
    assert_eq!((cubic.count(), cubic.on_continua.len()), (0, 8));
}

/// Claim: two quadrics in four unknowns are a curve of degree 4; with four quadrics in four unknowns, all through two
/// points and otherwise random, only these two remain of eight.
#[test]
fn fewer_and_more_quadrics() {
    let mut random = random(6);
    let mut full = || DenseMatrix::from_fn(4, 4, |_, _| symmetric(&mut random));
    let curve = solve_any(&[full(), full()], 4).unwrap();
    assert_eq!((curve.dimension, curve.expected, curve.solutions.isolated.len(), curve.extraneous), (1, 4, 4, 0));
    let through: Vec<DenseMatrix> = (0..4)
        .map(|_| {
            let mut matrix = full();
            (matrix[(0, 0)], matrix[(1, 1)]) = (0.0, 0.0);
            matrix
        })
        .collect();
    let points = solve_any(&through, 4).unwrap();
    assert_eq!((points.dimension, points.expected, points.solutions.count(), points.extraneous), (0, 8, 2, 6));
    assert!(at(&points.solutions, &[1.0, 0.0, 0.0, 0.0]).real && at(&points.solutions, &[0.0, 1.0, 0.0, 0.0]).real);
    let none = solve_any(&[full(), full(), full(), full()], 4).unwrap();
    assert_eq!((none.solutions.count(), none.extraneous), (0, 8));
    let one = solve_any(&[], 1).unwrap();
    assert_eq!((one.solutions.count(), one.expected), (1, 1));
}

/// Claim: what cannot be solved is refused with its reason.
#[test]
fn refusals() {
    let quadrics = random_quadrics(2, 3);
    let zero = DenseMatrix::zeros(3, 3);
    assert_eq!(solve(&[quadrics[0].clone(), zero]).unwrap_err(), HomotopyError::Quadric { number: 1 });
    assert_eq!(solve(&random_quadrics(2, 3)[..1]).unwrap_err(), HomotopyError::Quadric { number: 0 });
    let many = vec![DenseMatrix::identity(18, 18); 17];
    assert_eq!(solve(&many).unwrap_err(), HomotopyError::TooMany { quadrics: 17 });
}

/// Claim: a random curve of two quadrics has no singular point. Two quadrics that touch one plane in one point have one
/// there: the difference of their second-order parts in the plane is definite, and the point isolated, or indefinite,
/// and a crossing. A curve that is counted twice is singular all along.
#[test]
fn singular_points_of_curves() {
    let mut random = random(51);
    let [first, second] = [0, 1].map(|_| DenseMatrix::from_fn(4, 4, |_, _| symmetric(&mut random)));
    assert_eq!(real_singular_points(&[first, second]), Ok(Some(vec![])));
    let plane = [0.0, 0.0, 1.0];
    let general = affine(0.0, &plane, &[(0, 0, 0.3), (0, 2, 0.2), (1, 1, 0.7), (1, 2, -0.4), (2, 2, 0.5)]);
    for (sign, isolated) in [(1.0, true), (-1.0, false)] {
        let other = [(0, 0, 1.3), (0, 2, -0.1), (1, 1, 0.7 + sign), (0, 1, 0.2), (2, 2, 0.9)];
        let found = real_singular_points(&[general.clone(), affine(0.0, &plane, &other)]).unwrap().unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].isolated, isolated);
        assert!(found[0].point[0] > 1.0 - 1e-12 && found[0].point[1..].iter().all(|x| x.abs() <= 1e-8), "{found:?}");
    }
    let double = product(&vector(4, &mut random), &vector(4, &mut random));
    let square = vector(4, &mut random);
    assert_eq!(real_singular_points(&[double, product(&square, &square)]), Ok(None));
}
