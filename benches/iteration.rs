//! Cost of one Newton iteration, and of its parts.
//!
//! ```text
//! cargo bench --bench iteration                    all parts
//! cargo bench --bench iteration -- split           one part: split, study, assembly, threads, dense
//! ```
//!
//! Patches of the reference cell with exactly rigid bars and random rest angles. All times of a line are medians of
//! runs taken by turns; compare along a line, not between machines.
//!
//! - `split`: times relative to one factorization and one solve of the same matrix. *plain*: one iteration near the
//!   solution: assembly, filling and factoring the matrix, solving with corrections to a relative residual of 1e-6 for
//!   random forces (the number of solves is `solves`), residuals, energy and gaps of the new state. *once*: the same
//!   with one solve, and the relative residual `left` by it. *run*: one iteration of a whole run (the time of the
//!   minimiser, without the set-up, divided by its accepted steps; refused shifts, retraction and shorter steps are
//!   included), and its parts. This part runs last and ends with an error if *plain* is more than 1.5.
//! - `study`: additional cost of a whole relaxation: analysis of the pattern, and self stresses.
//! - `assembly`: cost against the number of unknowns; the exponent must be 1.
//! - `threads`: assembly with one and two threads, by turns.
//! - `dense`: the size below which the dense factorization is faster than the sparse one.
#![allow(clippy::unwrap_used)]

mod common;

use common::kernels::{Sparse, dense_factor_and_solve};
use common::timed::Timed;
use common::{Star, exponent, in_turns, measuring, seconds, size, vector, wanted};
use foldwell::model::{Model, RIGID};
use foldwell::numerics::factor::DENSE_LIMIT;
use foldwell::numerics::parallel::{FEWEST_SHARED_ELEMENTS, Threads};
use foldwell::numerics::tearing::TornFactor;
use foldwell::solver::kkt::KktSystem;
use foldwell::solver::{
    Equilibrium, HessianKind, Layout, Linearization, NewtonError, Options, Problem, Residuals, minimize, tension,
};

/// Largest cost of a plain iteration relative to one factorization and one solve.
const MOST: f64 = 1.5;
/// Relative residual to which the linear system of a plain iteration is solved.
const SOLVED: f64 = 1e-6;
/// Number of steps of a run whose parts are timed; the cost of one step is measured, not their number.
const SOME_STEPS: usize = 8;
/// A part of the benchmark; the argument is the list of numbers of cells along each side.
type Part = fn(&[usize]);

fn main() {
    let parts: [(&str, Part); 5] =
        [("study", study), ("assembly", assembly), ("threads", threads), ("dense", dense), ("split", split)];
    let sizes: &[usize] = if measuring() { &[13, 24, 40, 57, 82] } else { &[3] };
    for (name, part) in parts {
        if wanted(name) {
            println!("\n== {name}");
            part(sizes);
        }
    }
}

fn rounds() -> usize {
    if measuring() { 5 } else { 1 }
}

/// Run time of a minimisation and of its parts in seconds; for the parts of the linear algebra, their numbers.
#[derive(Clone, Copy, Default)]
struct Spent {
    whole: f64,
    linearize: f64,
    energy: f64,
    gaps: f64,
    accept: f64,
    iterations: f64,
    factorizations: f64,
    solves: f64,
    gap_counts: f64,
}

/// Minimises from the drawn state in at most `iterations` steps.
fn minimise(star: &Star, iterations: usize) -> (Spent, Equilibrium) {
    let mut model = star.model(RIGID);
    let start = model.start();
    let mut timed = Timed::new(&mut model);
    let options = Options { iterations, ..Options::default() };
    let mut found = None;
    let whole = seconds(|| found = Some(minimize(&mut timed, start, options, &mut |_| true)));
    let found = match found.expect("it ran") {
        Ok(found) => found,
        Err(NewtonError { x, tension, history, .. }) => {
            Equilibrium { x, tension, history, energy: f64::NAN, negative_eigenvalues: Some(0), independent: false }
        }
    };
    let sum = |count: fn(&foldwell::solver::Step) -> usize| found.history.iter().map(count).sum::<usize>() as f64;
    let spent = Spent {
        whole,
        linearize: timed.linearize.get(),
        energy: timed.energy.get(),
        gaps: timed.gaps.get(),
        accept: timed.accept,
        iterations: sum(|step| usize::from(step.fraction > 0.0)),
        factorizations: sum(|step| step.factorizations),
        solves: sum(|step| step.solves),
        gap_counts: timed.retractions.get() as f64,
    };
    (spent, found)
}

/// A linearization and its factorization, as in the minimiser.
struct Step {
    model: Model,
    at: Linearization,
    system: KktSystem,
    right: (Vec<f64>, Vec<f64>),
}

impl Step {
    fn new(model: Model, x: &[f64], tension: &[f64]) -> Self {
        let mut at = Linearization::new(model.layout());
        model.linearize(x, tension, HessianKind::Full, &mut at);
        let system = KktSystem::new(model.layout()).unwrap();
        let (unknowns, measures) = size(&model);
        let right = (vector(2, unknowns, 1.0), vector(3, measures, 1e-2));
        Self { model, at, system, right }
    }

    /// Assembles `S` and factors it, and returns the time.
    fn factor(&mut self) -> f64 {
        let compliance = self.model.compliance();
        seconds(|| self.system.factor(&self.at, compliance, 0.0).unwrap())
    }

    fn solve(&mut self) -> f64 {
        seconds(|| self.system.apply(&self.right.0, &self.right.1))
    }

    /// Makes one iteration without line search, with its linear system solved to the relative residual `tolerance` in
    /// at least one solve. Returns the time and the relative residual reached.
    fn plain(&mut self, x: &[f64], tension: &[f64], tolerance: f64) -> (f64, f64) {
        let closed = vec![0.0; tension.len()];
        let mut left = f64::NAN;
        let time = seconds(|| {
            self.model.linearize(x, tension, HessianKind::Full, &mut self.at);
            self.system.factor(&self.at, self.model.compliance(), 0.0).unwrap();
            let residuals = Residuals::new(&self.model, &self.at, tension);
            let step = self.system.solve(&self.at, &self.right.0, &closed, tolerance);
            left = step.residual;
            (residuals, self.model.gaps(x), self.model.energy(x))
        });
        (time, left)
    }
}

/// A factorization of a matrix of the same size and pattern, without the rest of the solver.
struct Bare {
    factor: TornFactor,
    weights: Vec<f64>,
    values: Vec<f64>,
    right: Vec<f64>,
}

/// Returns the time of the set-up, which a problem needs once: analysis of the pattern and allocation.
fn set_up(layout: &Layout) -> f64 {
    let fresh = Layout::new(layout.node.clone(), layout.soft.clone(), layout.stiff.clone());
    seconds(|| (KktSystem::new(&fresh).is_ok(), Linearization::new(&fresh)))
}

impl Bare {
    fn new(step: &Step) -> Self {
        let layout = step.model.layout();
        let mut values = step.at.hessian.clone();
        let weights = vec![1e6; layout.stiff.len()];
        for (row, weight) in weights.iter().enumerate() {
            step.at.add_outer(row, *weight, &mut values);
        }
        let factor = TornFactor::of(layout.tearing().unwrap()).unwrap();
        Self { factor, weights, values, right: step.right.0.clone() }
    }

    fn factor(&mut self, step: &Step) -> f64 {
        let outer = step.at.rank_one_terms(1.0, &self.weights);
        seconds(|| self.factor.factor(step.at.pattern(), &self.values, outer).unwrap())
    }

    fn solve(&mut self) -> f64 {
        let mut x = self.right.clone();
        seconds(|| self.factor.solve(&mut x))
    }
}

/// Returns how often a sheet of `n` cells along each side is made and run, and how often the parts of an iteration are
/// timed for each of these.
fn repeats(n: usize) -> (usize, usize) {
    match n {
        _ if !measuring() => (1, 1),
        41.. => (3, 3),
        _ => (rounds(), 9),
    }
}

fn split(sizes: &[usize]) {
    println!(
        "plain, once, run: one iteration over factorization + solve alone. In parts of factorization + solve, per iteration of \
         the run; set-up (once per run) is apart.\n{:>3} {:>7} {:>5} {:>8} {:>7} {:>6} {:>6} {:>6} {:>7} {:>6} | {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} | \
         {:>5} {:>5} {:>5} | {:>6}",
        "n",
        "unknown",
        "steps",
        "f ms",
        "s ms",
        "plain",
        "solves",
        "once",
        "left",
        "run",
        "assem",
        "fill",
        "factor",
        "solves",
        "energy",
        "gaps",
        "accept",
        "rest",
        "fact",
        "solve",
        "gaps",
        "set-up"
    );
    let mut most = 0.0f64;
    for &n in sizes {
        let star = Star::new(n);
        let (_, found) = minimise(&star, 60);
        let unknowns = found.x.len();
        let (rounds, times_each) = repeats(n);
        let (mut runs, mut left, mut solves) = (Vec::new(), f64::NAN, 0);
        let mut times = [const { Vec::new() }; 7];
        for _ in 0..rounds {
            // made again in every round, because its place in memory changes the times by a few per cent, most for the
            // smallest and the largest sheet
            let mut step = Step::new(star.model(RIGID), &found.x, &found.tension);
            step.factor();
            let mut bare = Bare::new(&step);
            bare.factor(&step);
            runs.push(minimise(&star, SOME_STEPS).0);
            times[4].push(set_up(step.model.layout()));
            for _ in 0..times_each {
                times[0].push(bare.factor(&step));
                times[1].push(bare.solve());
                times[2].push(step.factor());
                times[3].push(step.solve());
                let before = step.system.solves;
                times[5].push(step.plain(&found.x, &found.tension, SOLVED).0);
                solves = step.system.solves - before;
                let once = step.plain(&found.x, &found.tension, f64::INFINITY);
                times[6].push(once.0);
                left = once.1;
            }
        }
        let medians = times.map(|mut t| common::median(&mut t));
        most = most.max(print_split(n, unknowns, &mut runs, medians, (solves, left)));
    }
    assert!(most <= MOST || !measuring(), "a plain iteration takes {most:.2} of a factorization and a solve");
}

/// Prints a line of the table; returns the cost of a plain iteration relative to a factorization and a solve.
fn print_split(n: usize, unknowns: usize, runs: &mut [Spent], medians: [f64; 7], (solves, left): (usize, f64)) -> f64 {
    let [f, s, factor, solve, setup, plain, once] = medians;
    runs.sort_by(|a, b| a.whole.total_cmp(&b.whole));
    let run = runs[runs.len() / 2];
    let unit = (f + s) * run.iterations;
    let iterations = run.whole - setup;
    let parts = [
        run.linearize,
        run.factorizations * (factor - f).max(0.0),
        run.factorizations * f,
        run.solves * solve,
        run.energy,
        run.gaps,
        run.accept,
    ];
    let rest = iterations - parts.iter().sum::<f64>();
    let ratios = [plain, once, iterations / run.iterations].map(|time| time / (f + s));
    print!("{n:3} {unknowns:7} {:5} {:8.2} {:7.2}", run.iterations, 1e3 * f, 1e3 * s);
    print!(" {:6.2} {solves:6} {:6.2} {left:7.0e} {:6.2} |", ratios[0], ratios[1], ratios[2]);
    parts.iter().chain([&rest]).for_each(|part| print!(" {:6.2}", part / unit));
    let per = |count: f64| count / run.iterations;
    let counts = [run.factorizations, run.solves, run.gap_counts].map(per);
    println!(" | {:5.2} {:5.2} {:5.2} | {:6.2}", counts[0], counts[1], counts[2], setup / (f + s));
    ratios[0]
}

fn study(sizes: &[usize]) {
    println!("shares of a whole relaxation (seconds of the study)");
    println!("{:>3} {:>9} {:>9} {:>9} {:>9}", "n", "study ms", "newton", "set-up", "settle");
    for &n in sizes.iter().filter(|n| **n <= 40) {
        let star = Star::new(n);
        let (_, found) = minimise(&star, 60);
        let model = star.model(RIGID);
        let medians = in_turns(
            rounds(),
            &mut [
                &mut || {
                    let model = star.model(RIGID);
                    seconds(|| star.relax(&model).expect("it converges"))
                },
                &mut || seconds(|| tension::settle(&model, &found)),
                &mut || set_up(model.layout()),
            ],
        );
        let [whole, settle, setup] = medians[..] else { unreachable!("three pieces of work") };
        let newton = whole - settle - setup;
        println!(
            "{n:3} {:9.1} {:8.0}% {:8.0}% {:8.0}%",
            1e3 * whole,
            100.0 * newton / whole,
            100.0 * setup / whole,
            100.0 * settle / whole
        );
    }
}

fn assembly(sizes: &[usize]) {
    println!("{:>3} {:>7} {:>12} {:>12} {:>14}", "n", "unknown", "full us/unk", "gauss us/unk", "evaluate us/unk");
    let mut points = [const { Vec::new() }; 3];
    for &n in sizes {
        let star = Star::new(n);
        let model = star.model(RIGID);
        let (x, t) = (&model.start(), &vector(4, size(&model).1, 1.0));
        let mut full = Linearization::new(model.layout());
        let mut gauss = Linearization::new(model.layout());
        let medians = in_turns(
            3 * rounds(),
            &mut [
                &mut || seconds(|| model.linearize(x, t, HessianKind::Full, &mut full)),
                &mut || seconds(|| model.linearize(x, t, HessianKind::GaussNewton, &mut gauss)),
                &mut || seconds(|| (model.gaps(x), model.energy(x))),
            ],
        );
        let unknowns = size(&model).0 as f64;
        let per = |k: usize| 1e6 * medians[k] / unknowns;
        println!("{n:3} {unknowns:7} {:12.3} {:12.3} {:14.3}", per(0), per(1), per(2));
        points.iter_mut().zip(&medians).for_each(|(list, &time)| list.push((unknowns, time)));
    }
    if sizes.len() > 1 {
        let [full, gauss, evaluate] = points.map(|list| exponent(&list));
        println!("exponent    {full:12.3} {gauss:12.3} {evaluate:14.3}");
    }
}

/// Returns the elapsed time in seconds (not processor time, since several threads share the work).
fn elapsed(work: impl FnOnce()) -> f64 {
    let clock = std::time::Instant::now();
    work();
    clock.elapsed().as_secs_f64()
}

fn threads(sizes: &[usize]) {
    let small: &[usize] = if measuring() { &[8, 9, 10, 11, 12, 16, 18] } else { &[] };
    println!("below {FEWEST_SHARED_ELEMENTS} elements one thread does all the work");
    println!("{:>8} {:>11} {:>6} {:>11} {:>6}", "elements", "assemble us", "2 / 1", "evaluate us", "2 / 1");
    let [one, two] = [1, 2].map(|count| Threads::new(Some(count)));
    for &n in small.iter().chain(sizes) {
        let model = Star::new(n).model(RIGID);
        let (x, t) = (model.start(), vec![0.0; size(&model).1]);
        let [mut at, mut other] = [0, 1].map(|_| Linearization::new(model.layout()));
        let assemble = |at: &mut Linearization| elapsed(|| model.linearize(&x, &t, HessianKind::Full, at));
        let evaluate = || elapsed(|| _ = (model.gaps(&x), model.energy(&x)));
        let medians = in_turns(
            20 * rounds(),
            &mut [
                &mut || one.install(|| assemble(&mut at)),
                &mut || two.install(|| assemble(&mut other)),
                &mut || one.install(evaluate),
                &mut || two.install(evaluate),
            ],
        );
        let [alone, shared, evaluated, evaluated_shared] = medians[..] else { unreachable!("four pieces of work") };
        let (elements, assembly, evaluation) = (t.len(), shared / alone, evaluated_shared / evaluated);
        println!("{elements:8} {:11.0} {assembly:6.2} {:11.0} {evaluation:6.2}", 1e6 * alone, 1e6 * evaluated);
    }
}

fn dense(_: &[usize]) {
    println!("now dense up to {DENSE_LIMIT} unknowns; microseconds for one factorization and one solve");
    println!("{:>7} {:>9} {:>9} {:>14}", "unknown", "sparse", "dense", "dense / sparse");
    let cells: &[[usize; 2]] =
        if measuring() { &[[1, 1], [2, 1], [2, 2], [3, 2], [3, 3], [4, 3], [4, 4], [5, 5]] } else { &[[2, 2]] };
    for &cells in cells {
        let model = Star::oblong(cells).model(RIGID);
        let (x, tension) = (model.start(), vec![0.0; size(&model).1]);
        let step = Step::new(model, &x, &tension);
        let mut bare = Bare::new(&step);
        step.at.pattern().add_to_diagonal(&mut bare.values, 1.0);
        let (pattern, values, right) = (step.at.pattern(), &bare.values, &bare.right);
        let mut sparse = Sparse::new(pattern, step.model.layout());
        let medians = in_turns(
            if measuring() { 300 } else { 1 },
            &mut [&mut || sparse.factor_and_solve(values, right), &mut || {
                dense_factor_and_solve(pattern, values, right)
            }],
        );
        let [sparse, dense] = medians[..] else { unreachable!("two pieces of work") };
        println!("{:7} {:9.1} {:9.1} {:14.2}", right.len(), 1e6 * sparse, 1e6 * dense, dense / sparse);
    }
}
