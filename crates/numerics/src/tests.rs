//! Sparse algebra against dense: the same matrices built both ways from random cliques.

use super::DenseMatrix;
use super::dense::{full_svd, singular_values, symmetric_eigenvalues};
use super::factor::{DENSE_LIMIT, Factor, FactorError};
use super::sparse::{Cliques, ElementBlock, FIXED, RankOne, Rows, Slots, SparsityPattern, symmetric_product};
use super::tearing::{Tearing, TornFactor};
use super::{eigen, parallel, rank};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::sync::Arc;

/// A symmetric matrix of random cliques, with an unknown twice in some and fixed members in others.
struct RandomCliques {
    pattern: SparsityPattern,
    cliques: Cliques,
    values: Vec<f64>,
    dense: DenseMatrix,
    node: Vec<u32>,
}

fn sample(size: usize, seed: u64, diagonal: f64) -> RandomCliques {
    let mut numbers = ChaCha8Rng::seed_from_u64(seed);
    let mut cliques = Cliques::new();
    for _ in 0..2 * size {
        let mut members: Vec<u32> = (0..4).map(|_| numbers.random_range(0..size as u32)).collect();
        if numbers.random::<f64>() < 0.2 {
            members[1] = FIXED;
        }
        cliques.push(members);
    }
    let pattern = SparsityPattern::new(size, &[&cliques]);
    let slots = Slots::new(&pattern, &cliques);
    let (mut values, mut dense) = (vec![0.0; pattern.entries()], DenseMatrix::identity(size, size) * diagonal);
    pattern.add_to_diagonal(&mut values, diagonal);
    for (k, members) in cliques.iter().enumerate() {
        let mut block = Vec::new();
        for p in 0..4 {
            for q in 0..=p {
                let entry = numbers.random::<f64>() - 0.5;
                block.push(entry);
                for (a, b) in if p == q { vec![(p, q)] } else { vec![(p, q), (q, p)] } {
                    if members[a] != FIXED && members[b] != FIXED {
                        dense[(members[a] as usize, members[b] as usize)] += entry;
                    }
                }
            }
        }
        slots.add_block(k, 1.0, &block, &mut values);
    }
    RandomCliques { pattern, cliques, values, dense, node: (0..size as u32).collect() }
}

/// Claim: scattering blocks through slots is adding them to a dense matrix, repeated and fixed members included; the
/// product and the dense copy agree with it. Tolerance: rounding of sums of a few dozen numbers of size 1.
#[test]
fn blocks_add_up() {
    for seed in 0..5 {
        let RandomCliques { pattern, values, dense, .. } = sample(40, seed, 0.0);
        assert!((pattern.to_dense(&values) - &dense).amax() < 1e-14);
        let x: Vec<f64> = (0..40).map(|k| (k as f64).sin()).collect();
        let mut y = vec![0.0; 40];
        symmetric_product(&pattern, &values, &x, &mut y);
        let expected = &dense * nalgebra::DVector::from_column_slice(&x);
        assert!((nalgebra::DVector::from_column_slice(&y) - expected).amax() < 1e-13);
    }
}

/// Claim (Sylvester): the factorization counts the negative eigenvalues that a dense decomposition finds, below and
/// above the size at which it becomes sparse, and solves. Tolerance of the solution: 1e-16 times the condition, which
/// is below 1e5 for these seeds.
#[test]
fn inertia_and_solution() {
    for (size, seed) in [(10, 1), (DENSE_LIMIT, 2), (DENSE_LIMIT + 1, 3), (200, 4), (300, 5)] {
        for diagonal in [0.0, 0.7, 3.0, 20.0] {
            let RandomCliques { pattern, cliques, values, dense, node } = sample(size, seed, diagonal);
            let mut factor = Factor::new(&pattern, &node, &[&cliques]).unwrap();
            let inertia = factor.factor(&pattern, &values).unwrap();
            let expected = symmetric_eigenvalues(&dense).unwrap().iter().filter(|v| **v < 0.0).count();
            assert_eq!(inertia.negative, expected, "size {size}, diagonal {diagonal}");
            let ones = nalgebra::DVector::repeat(size, 1.0);
            let mut x = (&dense * &ones).as_slice().to_vec();
            factor.solve(&mut x);
            assert!(x.iter().all(|x| (x - 1.0).abs() <= 1e-9), "size {size}, diagonal {diagonal}");
        }
    }
}

/// Places of the wings of a hinge among the members of its clique.
const LEFT: std::ops::Range<u32> = 6..9;
const RIGHT: std::ops::Range<u32> = 9..12;

/// Hinges on all inner edges of a triangulated grid of vertices, a sheet or a tube, with random blocks that leave the
/// wings of a hinge uncoupled and random outer products besides, some of weight zero.
struct RandomHinges {
    pattern: SparsityPattern,
    node: Vec<u32>,
    cliques: Cliques,
    weights: Vec<f64>,
    gradients: Vec<f64>,
    values: Vec<f64>,
}

/// Ends and wings of the hinges of a grid; a tube closes after `width` vertices.
fn grid(width: u32, height: u32, tube: bool) -> Vec<[u32; 4]> {
    let at = |column: u32, row: u32| row * width + column % width;
    let mut hinges = Vec::new();
    for row in 0..height - 1 {
        for column in 0..if tube { width } else { width - 1 } {
            let before = if column == 0 { width - 1 } else { column - 1 };
            let (home, next) = (at(column, row), at(column + 1, row));
            let (above, across) = (at(column, row + 1), at(column + 1, row + 1));
            hinges.push([home, across, above, next]);
            if row > 0 {
                hinges.push([home, next, across, at(column, row - 1)]);
            }
            if tube || column > 0 {
                hinges.push([home, above, at(before, row), across]);
            }
        }
    }
    hinges
}

fn hinges(width: u32, height: u32, tube: bool, seed: u64, diagonal: f64) -> RandomHinges {
    let mut numbers = ChaCha8Rng::seed_from_u64(seed);
    let (vertices, mut cliques) = (width * height, Cliques::new());
    for points in grid(width, height, tube) {
        // the first vertex is held, and one unknown belongs to all hinges
        let place = |vertex: u32, k: u32| if vertex == 0 { FIXED } else { 3 * (vertex - 1) + k };
        let members = points.iter().flat_map(|&vertex| [0, 1, 2].map(|k| place(vertex, k)));
        cliques.push_split(members.chain([3 * vertices - 3]), LEFT, RIGHT);
    }
    let node: Vec<u32> = (0..3 * vertices - 2).map(|k| k / 3).collect();
    let pattern = SparsityPattern::new(node.len(), &[&cliques]);
    let slots = Slots::new(&pattern, &cliques);
    let mut values = vec![0.0; pattern.entries()];
    pattern.add_to_diagonal(&mut values, diagonal);
    let (mut weights, mut gradients) = (Vec::new(), Vec::new());
    for k in 0..cliques.len() {
        let gradient: Vec<f64> = (0..13).map(|_| numbers.random::<f64>() - 0.5).collect();
        let weight = if numbers.random::<f64>() < 0.1 { 0.0 } else { 3.0 * numbers.random::<f64>() };
        let places = (0..13).flat_map(|p| (0..=p).map(move |q| (p, q)));
        let apart = |(p, q)| RIGHT.contains(&p) && LEFT.contains(&q);
        let block: Vec<f64> =
            places.map(|place| if apart(place) { 0.0 } else { numbers.random::<f64>() - 0.5 }).collect();
        let outer = RankOne { weight, gradient: &gradient };
        slots.add_element(k, &ElementBlock { outer, scale: 0.5, block: &block }, &mut values);
        weights.push(weight);
        gradients.extend(gradient);
    }
    RandomHinges { pattern, node, cliques, weights, gradients, values }
}

/// Claim: a torn factorization counts the negative eigenvalues of the matrix itself and solves with it; on sheets, and
/// on tubes so narrow that wings meet each other or an end of their hinge. Tolerance as in [`inertia_and_solution`].
#[test]
fn torn_inertia_and_solution() {
    for (width, height, tube, open) in [(12, 9, false, 20), (3, 80, true, 1), (2, 30, true, 0), (1, 30, true, 0)] {
        for (seed, diagonal) in [(1, 0.0), (2, 2.0), (3, 8.0)] {
            let RandomHinges { pattern, node, cliques, weights, gradients, values } =
                hinges(width, height, tube, seed, diagonal);
            let tearing = Arc::new(Tearing::new(&pattern, &node, &[&cliques]).unwrap());
            assert!(tearing.open() >= open, "{width} x {height}: {} open", tearing.open());
            let mut factor = TornFactor::of(&tearing).unwrap();
            let outer =
                |_, clique: usize| RankOne { weight: weights[clique], gradient: &gradients[cliques.range(clique)] };
            let inertia = factor.factor(&pattern, &values, outer).unwrap();
            let dense = pattern.to_dense(&values);
            let expected = symmetric_eigenvalues(&dense).unwrap().iter().filter(|v| **v < 0.0).count();
            assert_eq!(inertia.negative, expected, "{width} x {height}, seed {seed}");
            let ones = nalgebra::DVector::repeat(node.len(), 1.0);
            let mut x = (&dense * &ones).as_slice().to_vec();
            factor.solve(&mut x);
            assert!(x.iter().all(|x| (x - 1.0).abs() <= 1e-9), "{width} x {height}, seed {seed}");
        }
    }
}

/// Claim: tearing makes the factor smaller, and leaves alone what is too small for it. The bound is what a sheet of
/// 6,400 vertices is seen to need, rounded up.
#[test]
fn tearing_saves() {
    let RandomHinges { pattern, node, cliques, .. } = hinges(80, 80, false, 1, 0.0);
    let torn = TornFactor::of(&Arc::new(Tearing::new(&pattern, &node, &[&cliques]).unwrap())).unwrap();
    let whole = Factor::new(&pattern, &node, &[&cliques]).unwrap();
    assert!((torn.stored() as f64) < 0.85 * whole.stored() as f64, "{} of {}", torn.stored(), whole.stored());
    let RandomHinges { pattern, node, cliques, .. } = hinges(4, 5, false, 1, 0.0);
    assert_eq!(Tearing::new(&pattern, &node, &[&cliques]).unwrap().open(), 0);
}

/// Claim: numbers that are not finite and a matrix of zeros are refused, not factored.
#[test]
fn what_cannot_be_factored() {
    for size in [10, 100] {
        let RandomCliques { pattern, cliques, mut values, node, .. } = sample(size, 7, 1.0);
        let mut factor = Factor::new(&pattern, &node, &[&cliques]).unwrap();
        values[3] = f64::NAN;
        assert_eq!(factor.factor(&pattern, &values), Err(FactorError::NotFinite));
        values.fill(0.0);
        assert!(matches!(factor.factor(&pattern, &values), Err(FactorError::Singular { .. })));
    }
}

/// Claim: counting signs gives the number of singular values above a threshold; taking the null space out of a vector
/// is projecting it onto the range. Two of the rows are copies, so the rank is short by two. Tolerance: 1e-10 of the
/// regularisation, to the power of eight corrections: rounding.
#[test]
fn rank_and_range() {
    let mut numbers = ChaCha8Rng::seed_from_u64(11);
    let (mut cliques, mut values) = (Cliques::new(), Vec::new());
    for row in 0..60u32 {
        cliques.push([row % 58, (7 * row + 3) % 70, (11 * row + 5) % 70].map(|m| if row >= 58 { m % 58 } else { m }));
        values.extend((0..3).map(|_| numbers.random::<f64>() - 0.5));
    }
    let last = cliques.members(0).to_vec();
    let copy = [values[0], values[1], values[2]];
    for factor in [2.0, -1.0] {
        cliques.push(last.iter().copied());
        values.extend(copy.map(|v| factor * v));
    }
    let rows = Rows { cliques: &cliques, values: &values };
    let mut dense = DenseMatrix::zeros(62, 70);
    for (row, members) in cliques.iter().enumerate() {
        members.iter().zip(&values[cliques.range(row)]).for_each(|(m, v)| dense[(row, *m as usize)] += v);
    }
    let largest = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let node: Vec<u32> = (0..70).collect();
    for tau in [1e-6, 0.1, 0.5] {
        let expected = singular_values(&dense).unwrap().iter().filter(|s| **s > tau * largest).count();
        assert_eq!(rank::count_above(&rows, 70, &node, tau).unwrap(), expected, "{tau}");
    }
    assert_eq!(rank::count_above(&rows, 70, &node, 1e-6).unwrap(), 60);
    let t: Vec<f64> = (0..62).map(|k| (k as f64).cos()).collect();
    let found = rank::without_null(&rows, 70, &node, &t).unwrap();
    let svd = full_svd(&dense).unwrap();
    let range = svd.u.columns(0, 60);
    let expected = range * (range.transpose() * nalgebra::DVector::from_column_slice(&t));
    assert!((nalgebra::DVector::from_column_slice(&found) - expected).amax() < 1e-10);
}

/// Claim: the iteration finds the largest eigenvalues of a positive matrix, with vectors that satisfy `A v = mu v`.
/// Tolerance: 1e-13 was asked for, relative to the largest.
#[test]
fn largest_eigenvalues() {
    let RandomCliques { dense, .. } = sample(120, 21, 0.0);
    let square = &dense * &dense;
    let (values, vectors) =
        eigen::largest(120, 6, |x| Some((&square * nalgebra::DVector::from_column_slice(x)).as_slice().to_vec()))
            .unwrap();
    let expected = symmetric_eigenvalues(&square).unwrap();
    for (k, (value, vector)) in values.iter().zip(&vectors).enumerate() {
        assert!((value - expected[119 - k]).abs() < 1e-11 * expected[119], "{k}");
        let v = nalgebra::DVector::from_column_slice(vector);
        assert!((&square * &v - *value * &v).norm() < 1e-9 * expected[119] * v.norm());
    }
}

/// Claim: an operator that asks to stop is not asked again, at its first product or at a later one; other panics pass.
#[test]
fn eigenpairs_can_be_stopped() {
    for stop in [1, 2, 40] {
        let mut products = 0;
        let found = eigen::largest(120, 6, |x| {
            products += 1;
            (products < stop).then(|| x.iter().enumerate().map(|(k, x)| k as f64 * x).collect())
        });
        assert_eq!((found, products), (Err(eigen::EigenError::Stopped), stop));
    }
    // a product that is no number is no eigenpair of zero
    let infinite = Err(FactorError::NotFinite.into());
    assert_eq!(eigen::largest(120, 6, |x| Some(vec![f64::NAN; x.len()])), infinite);
    let broken = std::panic::catch_unwind(|| eigen::largest(120, 6, |_| std::panic::resume_unwind(Box::new(7))));
    assert_eq!(broken.unwrap_err().downcast_ref(), Some(&7));
}

/// Claim: results arrive in order, each once, above and below the size at which threads are used.
#[test]
fn work_is_consumed_in_order() {
    for count in [
        0,
        1,
        parallel::FEWEST_SHARED_ELEMENTS - 1,
        parallel::FEWEST_SHARED_ELEMENTS,
        3 * parallel::FEWEST_SHARED_ELEMENTS + 7,
        10_000,
    ] {
        let mut next = 0;
        parallel::compute_and_consume(
            count,
            |k, square: &mut usize| *square = k * k,
            |k, square| {
                assert_eq!((k, *square), (next, next * next));
                next += 1;
            },
        );
        assert_eq!(next, count);
    }
}
