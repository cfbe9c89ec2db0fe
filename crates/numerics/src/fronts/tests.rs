//! The multifrontal factorization against dense ones, known eigenvalues and itself on other numbers of threads.

use crate::dense::symmetric_eigenvalues;
use crate::factor::{Factor, FactorError, Inertia};
use crate::parallel::Threads;
use crate::sparse::{Cliques, RankOne, Slots, SparsityPattern, symmetric_product};
use crate::vector::max_abs;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A sum of weighted outer products of differences, less a multiple of the identity.
struct OuterProductSum {
    pattern: SparsityPattern,
    cliques: Cliques,
    values: Vec<f64>,
}

impl OuterProductSum {
    fn new(size: usize, edges: &[[u32; 2]], weight: impl Fn(usize) -> f64, shift: f64) -> Self {
        let mut cliques = Cliques::new();
        edges.iter().for_each(|edge| cliques.push(*edge));
        let pattern = SparsityPattern::new(size, &[&cliques]);
        let slots = Slots::new(&pattern, &cliques);
        let mut values = vec![0.0; pattern.entries()];
        for k in 0..edges.len() {
            slots.add_outer(k, RankOne { weight: weight(k), gradient: &[1.0, -1.0] }, &mut values);
        }
        pattern.add_to_diagonal(&mut values, -shift);
        Self { pattern, cliques, values }
    }

    fn factor(&self) -> Factor {
        let node: Vec<u32> = (0..self.pattern.size() as u32).collect();
        Factor::new(&self.pattern, &node, &[&self.cliques]).unwrap()
    }

    fn right(&self) -> Vec<f64> {
        (0..self.pattern.size()).map(|k| (k as f64).sin()).collect()
    }

    /// Largest entry of `A x - b` over the largest of `A` and of `x`.
    fn residual(&self, x: &[f64]) -> f64 {
        let mut product = vec![0.0; x.len()];
        symmetric_product(&self.pattern, &self.values, x, &mut product);
        product.iter_mut().zip(self.right()).for_each(|(product, right)| *product -= right);
        max_abs(&product) / (max_abs(&self.values) * max_abs(x))
    }

    /// Inertia and solution.
    fn solved(&self, factor: &mut Factor) -> (Inertia, Vec<f64>) {
        let inertia = factor.factor(&self.pattern, &self.values).unwrap();
        let mut x = self.right();
        factor.solve(&mut x);
        (inertia, x)
    }
}

/// Edges between random pairs of unknowns, with holes: some unknowns have no neighbour.
fn random(size: usize, edges: usize, seed: u64, shift: f64) -> OuterProductSum {
    let mut numbers = ChaCha8Rng::seed_from_u64(seed);
    let mut any = || numbers.random_range(0..size as u32);
    let edges: Vec<[u32; 2]> = (0..edges).map(|_| [any(), any()]).filter(|[a, b]| a != b).collect();
    OuterProductSum::new(size, &edges, |k| if k % 3 == 0 { -1.0 } else { 1.5 }, shift)
}

/// Minus the second differences on a grid of points between zeros.
fn laplacian(counts: [usize; 3], shift: f64) -> OuterProductSum {
    let at = |i: usize, j: usize, k: usize| ((i * counts[1] + j) * counts[2] + k) as u32;
    let mut edges = Vec::new();
    for i in 0..counts[0] {
        for j in 0..counts[1] {
            for k in 0..counts[2] {
                let nexts = [(i + 1, j, k), (i, j + 1, k), (i, j, k + 1)];
                let inside = nexts.into_iter().filter(|&(i, j, k)| i < counts[0] && j < counts[1] && k < counts[2]);
                edges.extend(inside.map(|next| [at(i, j, k), at(next.0, next.1, next.2)]));
            }
        }
    }
    let mut sample = OuterProductSum::new(counts.iter().product(), &edges, |_| 1.0, 0.0);
    // the neighbours at zero make the diagonal the same everywhere
    for k in 0..sample.pattern.size() {
        let diagonal = sample.pattern.first_slot(k) as usize;
        sample.values[diagonal] = 6.0 - shift;
    }
    sample
}

/// The number of eigenvalues of [`laplacian`] below zero: `sum_d 2 - 2 cos(pi m_d / (n_d + 1)) < shift`.
fn eigenvalues_below(counts: [usize; 3], shift: f64) -> usize {
    let axis = |n: usize| (1..=n).map(move |m| 2.0 - 2.0 * (std::f64::consts::PI * m as f64 / (n + 1) as f64).cos());
    let mut count = 0;
    for a in axis(counts[0]) {
        for b in axis(counts[1]) {
            count += axis(counts[2]).filter(|c| a + b + c < shift).count();
        }
    }
    count
}

/// Claim (Sylvester): the signs of the pivots are those of the eigenvalues of a dense decomposition, for connected
/// patterns, forests and isolated unknowns; solutions are accurate. Tolerance of the relative residual: 1e-16 times the
/// growth of indefinite factors without pivoting, below 1e5 for these seeds.
#[test]
fn random_patterns_agree_with_dense_ones() {
    for (seed, (size, edges)) in [(65, 20), (100, 70), (150, 300), (300, 450)].into_iter().enumerate() {
        for shift in [-3.17, 0.37] {
            let sample = random(size, edges, seed as u64, shift);
            let (inertia, x) = sample.solved(&mut sample.factor());
            let eigenvalues = symmetric_eigenvalues(&sample.pattern.to_dense(&sample.values)).unwrap();
            assert_eq!(
                inertia.negative,
                eigenvalues.iter().filter(|v| **v < 0.0).count(),
                "size {size}, shift {shift}"
            );
            assert!(sample.residual(&x) < 1e-11, "size {size}, shift {shift}: {:e}", sample.residual(&x));
        }
    }
}

/// Claim: on grids the number of negative pivots is that of the eigenvalues below the shift, which are known, definite
/// and indefinite, and solutions are accurate. Tolerance: as above.
#[test]
fn grids_have_known_inertia() {
    for counts in [[400, 1, 1], [40, 30, 1], [9, 8, 7], [17, 17, 16]] {
        for shift in [0.0, 0.3, 3.1] {
            let sample = laplacian(counts, shift);
            let (inertia, x) = sample.solved(&mut sample.factor());
            assert_eq!(inertia.negative, eigenvalues_below(counts, shift), "{counts:?}, shift {shift}");
            assert!(sample.residual(&x) < 1e-11, "{counts:?}, shift {shift}: {:e}", sample.residual(&x));
        }
    }
}

/// Claim: pivots and solutions have the same bits on one, two and three threads, in a rayon pool and outside of any,
/// where subtrees are tasks of their own and the last front is worked on in tiles; the pool is used.
#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    let sample = laplacian([20, 19, 18], 1.3);
    let mut factor = sample.factor();
    assert!(factor.stored() > super::FEWEST_SHARED_NUMBERS);
    let (inertia, x) = sample.solved(&mut factor);
    for count in 1..=3 {
        let threads = Threads::new(Some(count));
        assert_eq!(threads.install(|| sample.solved(&mut factor)), (inertia, x.clone()));
        assert_eq!(threads.started(), count > 1);
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    assert_eq!(pool.install(|| sample.solved(&mut factor)), (inertia, x));
}

/// Claim: zero and infinite pivots end in `Singular` and numbers that are not finite in `NotFinite`, on one thread and
/// on two, and the factorization can be used again.
#[test]
fn singular_and_not_finite() {
    for counts in [[30, 10, 1], [16, 15, 14]] {
        let sample = laplacian(counts, 0.0);
        let mut factor = sample.factor();
        for threads in [1, 2].map(|count| Threads::new(Some(count))) {
            let mut with = |values: &[f64]| threads.install(|| factor.factor(&sample.pattern, values));
            let zero = vec![0.0; sample.values.len()];
            assert_eq!(with(&zero), Err(FactorError::Singular { ratio: 0.0 }));
            let huge: Vec<f64> = sample.values.iter().map(|v| if *v > 0.0 { 1e-200 } else { 1e200 }).collect();
            assert!(matches!(with(&huge), Err(FactorError::Singular { .. })));
            let mut one = sample.values.clone();
            let last = one.len() - 1;
            one[last] = f64::NAN;
            assert_eq!(with(&one), Err(FactorError::NotFinite));
            assert_eq!(with(&sample.values).unwrap().negative, 0);
        }
    }
}
