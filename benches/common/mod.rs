//! Shared parts of the benchmarks: patches of the reference cell with random rest angles, interleaved timing, and
//! statistics.
#![allow(dead_code)] // each benchmark uses a part

pub mod kernels;
pub mod timed;

use cpu_time::ThreadTime;
use foldwell::analysis::relax::{Relaxed, relax_from};
use foldwell::model::{Assembly, Gauge, Model, Terms};
use foldwell::sheet::fold;
use foldwell::solver::{Options, Problem};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A patch of the reference cell. The rest angles differ from the drawn angles by random numbers of at most 0.1 rad,
/// which are the same on every machine.
pub struct Star {
    drawn: Assembly,
    rest: Vec<f64>,
}

impl Star {
    /// Makes `n x n` cells.
    pub fn new(n: usize) -> Self {
        Self::oblong([n, n])
    }

    /// Makes `n1 x n2` cells.
    pub fn oblong(cells: [usize; 2]) -> Self {
        let sheet = fold::parse(include_str!("../../meshes/open-star.fold"), "open-star.fold");
        let drawn = Assembly::patch(sheet.expect("the mesh of the repository"), cells).build();
        let (drawn, mut numbers) = (drawn.expect("a patch"), random(1));
        let rest = drawn.drawn_angles().iter().map(|angle| angle + uniform(&mut numbers, 0.1)).collect();
        Self { drawn, rest }
    }

    /// Returns the model with bars of the stiffness `EA`, and creases of stiffness 1 (torque per radian and length).
    pub fn model(&self, stiffness: f64) -> Model {
        self.drawn.with_terms(Terms::bars_and_creases(stiffness, 1.0, self.rest.clone())).model(Gauge::Held)
    }

    /// Relaxes `model` from the drawn state; `None` if it does not converge.
    pub fn relax(&self, model: &Model) -> Option<Relaxed> {
        relax_from(model, model.start(), Options::default(), &mut |_| true).ok()
    }
}

/// Returns the numbers of unknowns and of stiff elements of a model.
pub fn size(model: &Model) -> (usize, usize) {
    (model.layout().unknowns, model.layout().stiff.len())
}

/// Returns a generator of random numbers, which are the same on every machine.
pub fn random(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// Returns a random number between `-most` and `most`.
pub fn uniform(numbers: &mut ChaCha8Rng, most: f64) -> f64 {
    most * (2.0 * numbers.random::<f64>() - 1.0)
}

/// Returns `count` random numbers between `-most` and `most`.
pub fn vector(seed: u64, count: usize, most: f64) -> Vec<f64> {
    let mut numbers = random(seed);
    (0..count).map(|_| uniform(&mut numbers, most)).collect()
}

/// Whether to measure, as in `cargo bench`. `cargo test --benches` and `cargo bench -- --test` only run small sizes
/// once.
pub fn measuring() -> bool {
    let given = |name: &str| std::env::args().any(|argument| argument == name);
    given("--bench") && !given("--test")
}

/// Whether to run a part of the benchmark: if it is named in the arguments, or none is named.
pub fn wanted(part: &str) -> bool {
    let mut named = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).peekable();
    named.peek().is_none() || named.any(|name| name == part)
}

/// Returns the processor time of this thread that `work` takes, in seconds; time in which the processor does other work
/// does not count.
pub fn seconds<T>(work: impl FnOnce() -> T) -> f64 {
    let clock = ThreadTime::now();
    std::hint::black_box(work());
    clock.elapsed().as_secs_f64()
}

/// Returns the medians of the times of several pieces of work, run by turns so that other load affects all of them
/// alike.
pub fn in_turns(rounds: usize, work: &mut [&mut dyn FnMut() -> f64]) -> Vec<f64> {
    let mut times = vec![Vec::new(); work.len()];
    for _ in 0..rounds {
        work.iter_mut().zip(&mut times).for_each(|(work, times)| times.push(work()));
    }
    times.iter_mut().map(|times| median(times)).collect()
}

/// Returns the median; of an even number of values, the larger one of the two in the middle.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Returns the exponent `p` of the power law `y ~ x^p` that fits best in logarithms.
pub fn exponent(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let (mx, my) = (logs.iter().map(|p| p.0).sum::<f64>() / count, logs.iter().map(|p| p.1).sum::<f64>() / count);
    let slope = |p: &(f64, f64)| ((p.0 - mx) * (p.1 - my), (p.0 - mx) * (p.0 - mx));
    let (above, below) = logs.iter().map(slope).fold((0.0, 0.0), |s, t| (s.0 + t.0, s.1 + t.1));
    above / below
}

/// Returns the Euclidean norm.
pub fn norm(v: &[f64]) -> f64 {
    v.iter().map(|a| a * a).sum::<f64>().sqrt()
}

/// Returns the largest difference of two lists; NaN if one of their numbers is NaN.
///
/// # Panics
/// If the lists are empty or their lengths differ.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "lists of one length");
    foldwell::numerics::worst(a.iter().zip(b).map(|(a, b)| (a - b).abs())).expect("something to compare")
}
