//! Comparison of three treatments of stiff terms: as a tension in the factorization, as a weight with corrections, and
//! as a plain penalty.
//!
//! ```text
//! cargo bench --bench forms                  all parts
//! cargo bench --bench forms -- system        one part: system, weight
//! ```
//!
//! - `system`: the linear system of one Newton step, `[H R^T; R -C]`, at the same linearization, solved to a relative
//!   residual of 1e-10 in both block rows. *Augmented*: `H + R^T w R` with `w = min(k, gamma)` is factored, and the
//!   solution is improved by corrections for the true residual (this is `solver::kkt`). *Block*: the whole matrix is
//!   factored, regularised to `[H + e  R^T; R  -C - d]` so that it needs no pivoting, with the same corrections; the
//!   tensions are nodes of the graph that is ordered. *Penalty*: `H + k R^T R`, with the same corrections.
//! - `weight`: number of corrections and accuracy against `gamma`, and against `d` of the block form; also with closed
//!   gaps, as in the steps near a solution.
//!
//! Whole relaxations with the penalty energy are compared with the program's by the measurement `stiffness` of
//! `validation/`.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Star, measuring, norm, seconds, size, vector, wanted};
use foldwell::model::Model;
use foldwell::numerics::factor::{Factor, Inertia};
use foldwell::numerics::sparse::{Cliques, FIXED, SparsityPattern, symmetric_product};
use foldwell::solver::corrections::{IMPATIENT, NearlySolved, Pair, correct};
use foldwell::solver::kkt::KktSystem;
use foldwell::solver::{HessianKind, Layout, Linearization, Options, Problem, minimize};
use std::sync::Arc;

/// Regularisation of the block form, `d` and `e`: `d` relative to the inverse of the largest diagonal entry of `H`, `e`
/// relative to this entry.
const DELTA: f64 = 1e-8;
const LEAST: f64 = 1e-10;

fn main() {
    let parts: [(&str, fn()); 2] = [("system", system), ("weight", weight)];
    for (name, part) in parts {
        if wanted(name) {
            println!("\n== {name}");
            part();
        }
    }
}

/// The system of a Newton step with random right-hand sides.
struct System {
    model: Model,
    at: Linearization,
    compliance: Vec<f64>,
    a: Vec<f64>,
    b: Vec<f64>,
}

impl System {
    /// Makes the system at the drawn state with the Gauss-Newton Hessian, or at the relaxed state of the rigid sheet
    /// with the full Hessian.
    fn new(star: &Star, relaxed: bool) -> Self {
        let mut model = star.model(f64::INFINITY);
        let (unknowns, measures) = size(&model);
        let (mut x, mut tension, mut curvature) = (model.start(), vec![0.0; measures], HessianKind::GaussNewton);
        if relaxed {
            let found = minimize(&mut model, x, Options::default(), &mut |_| true).unwrap();
            (x, tension, curvature) = (found.x, found.tension, HessianKind::Full);
        }
        let mut at = Linearization::new(model.layout());
        model.linearize(&x, &tension, curvature, &mut at);
        let (a, b) = (vector(2, unknowns, 1.0), vector(3, measures, 1e-2));
        Self { model, at, compliance: vec![0.0; measures], a, b }
    }

    fn layout(&self) -> &Arc<Layout> {
        self.model.layout()
    }

    /// Changes the stiffness of the bars without changing the linearization.
    fn set_stiffness(&mut self, k: f64) {
        let model = &self.model;
        self.compliance = model.stiff().map(|bar| bar.spring.rest / k).collect();
    }

    fn unit(&self) -> f64 {
        self.at.pattern().largest_diagonal(&self.at.hessian)
    }

    fn product(&self, Pair(dx, dt): &Pair) -> Pair {
        let rows = self.at.rows();
        let (mut a, mut b) = (vec![0.0; dx.len()], vec![0.0; dt.len()]);
        symmetric_product(self.at.pattern(), &self.at.hessian, dx, &mut a);
        rows.add_transpose_product(dt, &mut a);
        rows.product(dx, &mut b);
        b.iter_mut().zip(&self.compliance).zip(dt).for_each(|((b, c), t)| *b -= c * t);
        Pair(a, b)
    }
}

/// A factorization that solves the system, exactly or approximately.
trait Form {
    fn factor(&mut self, system: &System) -> Option<Inertia>;
    fn apply(&mut self, system: &System, right: &Pair) -> Pair;
    fn stored(&self) -> usize;
}

/// A system and a form that solves it.
struct Solver<'a>(&'a mut dyn Form, &'a System);

impl NearlySolved for Solver<'_> {
    fn product(&self, found: &Pair) -> Pair {
        self.1.product(found)
    }

    fn solve(&mut self, right: &Pair) -> Pair {
        self.0.apply(self.1, right)
    }
}

/// Solves with corrections; returns their number and the residual reached.
fn solve(form: &mut dyn Form, system: &System, tolerance: f64) -> (usize, f64) {
    let right = Pair(system.a.clone(), system.b.clone());
    let units = [norm(&system.a), norm(&system.b)];
    let first = form.apply(system, &right);
    let corrected = correct(&mut Solver(form, system), &right, first, units, (tolerance, IMPATIENT));
    let left = right.minus(&system.product(&corrected.found));
    (corrected.corrections, f64::max(norm(&left.0) / units[0], norm(&left.1) / units[1]))
}

/// The matrix `H + R^T w R` with `w = min(k, gamma)`; a penalty if `gamma` is infinite.
struct Weighted(KktSystem);

impl Weighted {
    fn new(system: &System, gamma: f64) -> Self {
        Self(KktSystem::with_largest_weight(system.layout(), gamma).unwrap())
    }
}

impl Form for Weighted {
    fn factor(&mut self, system: &System) -> Option<Inertia> {
        self.0.factor(&system.at, &system.compliance, 0.0).ok()
    }

    fn apply(&mut self, _: &System, Pair(a, b): &Pair) -> Pair {
        let (dx, dt) = self.0.apply(a, b);
        Pair(dx, dt)
    }

    fn stored(&self) -> usize {
        self.0.stored()
    }
}

/// The matrix `[H + e  R^T; R  -C - d]`.
struct Block {
    delta: f64,
    pattern: SparsityPattern,
    factor: Factor,
    values: Vec<f64>,
    /// Positions in `values` of the entries of the Hessian, of the Jacobian, and of the tensions' diagonal.
    hessian: Vec<usize>,
    jacobian: Vec<usize>,
    diagonal: Vec<usize>,
}

impl Block {
    fn new(system: &System, delta: f64) -> Self {
        let layout = system.layout();
        let unknowns = layout.unknowns;
        let mut stiff = Cliques::new();
        for (row, members) in layout.stiff.iter().enumerate() {
            stiff.push(members.iter().copied().chain([(unknowns + row) as u32]));
        }
        let size = unknowns + layout.stiff.len();
        let pattern = SparsityPattern::new(size, &[&layout.soft, &stiff]);
        let blocks = layout.node.iter().max().map_or(0, |last| last + 1);
        let node: Vec<u32> = layout.node.iter().copied().chain(blocks..blocks + layout.stiff.len() as u32).collect();
        let factor = Factor::new(&pattern, &node, &[&layout.soft, &stiff]).unwrap();
        let mut starts = vec![0];
        (0..size).for_each(|k| starts.push(starts[k] + pattern.column(k).len()));
        let place = |row: u32, column: usize| starts[column] + pattern.column(column).binary_search(&row).unwrap();
        let old = system.at.pattern();
        let hessian = (0..unknowns).flat_map(|k| old.column(k).iter().map(move |&row| (row, k)));
        let hessian = hessian.map(|(row, k)| place(row, k)).collect();
        let members = layout.stiff.iter().enumerate().flat_map(|(row, list)| list.iter().map(move |&m| (row, m)));
        let entry = |(row, m): (usize, u32)| {
            if m == FIXED { usize::MAX } else { place((unknowns + row) as u32, m as usize) }
        };
        let jacobian = members.map(entry).collect();
        let diagonal = starts[unknowns..size].to_vec();
        Self { delta, values: vec![0.0; pattern.entries()], pattern, factor, hessian, jacobian, diagonal }
    }
}

impl Form for Block {
    fn factor(&mut self, system: &System) -> Option<Inertia> {
        let unit = system.unit();
        self.values.fill(0.0);
        self.pattern.add_to_diagonal(&mut self.values, LEAST * unit);
        self.hessian.iter().zip(&system.at.hessian).for_each(|(&place, value)| self.values[place] += value);
        for (&place, value) in self.jacobian.iter().zip(&system.at.jacobian) {
            if place != usize::MAX {
                self.values[place] += value;
            }
        }
        for (&place, c) in self.diagonal.iter().zip(&system.compliance) {
            self.values[place] = -c.max(self.delta / unit);
        }
        self.factor.factor(&self.pattern, &self.values).ok()
    }

    fn apply(&mut self, _: &System, Pair(a, b): &Pair) -> Pair {
        let mut both = [a.as_slice(), b].concat();
        self.factor.solve(&mut both);
        let dt = both.split_off(a.len());
        Pair(both, dt)
    }

    fn stored(&self) -> usize {
        self.factor.stored()
    }
}

fn system() {
    println!(
        "{:>8} {:>3} {:>6} {:>10} | {:>9} {:>8} {:>6} {:>8} {:>8} {:>7} | {:>6}",
        "state", "n", "k", "form", "factor ms", "solve ms", "corr.", "residual", "stored M", "inertia", "ratio"
    );
    let (sizes, rounds): (&[usize], usize) = if measuring() { (&[12, 24, 48], 3) } else { (&[3], 1) };
    for &n in sizes {
        let star = Star::new(n);
        for relaxed in [false, true] {
            let mut system = System::new(&star, relaxed);
            let state = if relaxed { "relaxed" } else { "drawn" };
            for k in [1e4, 1e8, 1e12, f64::INFINITY] {
                system.set_stiffness(k);
                compare_forms(&system, &format!("{state:>8} {n:3} {k:6.0e}"), rounds);
            }
        }
    }
}

fn compare_forms(system: &System, label: &str, rounds: usize) {
    let mut forms: Vec<(&str, Box<dyn Form>)> = vec![
        ("augmented", Box::new(Weighted(KktSystem::new(system.layout()).unwrap()))),
        ("block", Box::new(Block::new(system, DELTA))),
        ("penalty", Box::new(Weighted::new(system, f64::INFINITY))),
    ];
    if system.compliance.contains(&0.0) {
        forms.pop();
    }
    let mut first = f64::NAN;
    for (name, form) in &mut forms {
        let mut found = (0, f64::NAN);
        let mut inertia = None;
        let (mut factor, mut solves) = (Vec::new(), Vec::new());
        for _ in 0..rounds {
            factor.push(seconds(|| inertia = form.factor(system)));
            solves.push(seconds(|| found = solve(form.as_mut(), system, 1e-10)));
        }
        let (factor, solves) = (common::median(&mut factor), common::median(&mut solves));
        let total = if found.1 <= 1e-10 { factor + solves } else { f64::NAN };
        first = if *name == "augmented" { total } else { first };
        let expected = if *name == "block" { system.b.len() } else { 0 };
        let right = match inertia {
            Some(inertia) if inertia.negative == expected => "right".to_string(),
            Some(inertia) => format!("{:+}", inertia.negative as i64 - expected as i64),
            None => "fails".to_string(),
        };
        println!(
            "{label} {name:>10} | {:9.2} {:8.2} {:6} {:8.0e} {:8.2} {right:>7} | {:6.2}",
            1e3 * factor,
            1e3 * solves,
            found.0,
            found.1,
            form.stored() as f64 / 1e6,
            total / first
        );
    }
}

fn weight() {
    println!(
        "corrections to 1e-6, 1e-8 and 1e-10 (-: not reached), and the residual where they no longer help; `closed`: \
         corrections made towards 1e-8, and the residual then, where the gaps to close are only 1e-10"
    );
    println!(
        "{:>3} {:>8} {:>6} {:>10} {:>7} | {:>5} {:>5} {:>5} {:>8} | {:>6}",
        "n", "state", "k", "form", "", "1e-6", "1e-8", "1e-10", "best", "closed"
    );
    let sizes: &[usize] = if measuring() { &[12, 24, 48] } else { &[3] };
    for &n in sizes {
        let star = Star::new(n);
        for relaxed in [false, true] {
            let mut system = System::new(&star, relaxed);
            for k in [1e8, f64::INFINITY] {
                system.set_stiffness(k);
                let label = format!("{n:3} {:>8} {k:6.0e}", if relaxed { "relaxed" } else { "drawn" });
                for gamma in [1e4, 1e5, 1e6, 3e6, 1e7, 1e8, 1e9, 1e10] {
                    corrections(
                        &mut Weighted::new(&system, gamma),
                        &mut system,
                        &format!("{label}  augmented {gamma:7.0e}"),
                    );
                }
                for delta in [1e-6, 1e-8, 1e-10] {
                    corrections(
                        &mut Block::new(&system, delta),
                        &mut system,
                        &format!("{label}      block {delta:7.0e}"),
                    );
                }
            }
        }
    }
    without_gaps(if measuring() { &[13, 24, 40, 57, 82] } else { &[3] });
}

/// Prints the number of corrections to 1e-6 at the relaxed state with closed gaps for each weight, with the solver of
/// the minimiser.
fn without_gaps(sizes: &[usize]) {
    let weights = [1e5, 1e6, 3e6, 1e7, 1e8];
    let names = weights.map(|gamma| format!("{gamma:>5.0e}")).join(" ");
    println!("corrections to 1e-6 where no gaps are open, relaxed, k = inf, against gamma\n  n {names}");
    for &n in sizes {
        let system = System::new(&Star::new(n), true);
        let closed = vec![0.0; system.b.len()];
        let corrections = weights.map(|gamma| {
            let mut kkt = KktSystem::with_largest_weight(system.layout(), gamma).unwrap();
            kkt.factor(&system.at, &system.compliance, 0.0).unwrap();
            let solved = kkt.solve(&system.at, &system.a, &closed, 1e-6);
            let shown = if solved.residual <= 1e-6 { (kkt.solves - 1).to_string() } else { "-".to_string() };
            format!("{shown:>5}")
        });
        println!("{n:3} {}", corrections.join(" "));
    }
}

fn corrections(form: &mut dyn Form, system: &mut System, label: &str) {
    if form.factor(system).is_none() {
        return println!("{label} | fails");
    }
    let count = |form: &mut dyn Form, tolerance| match solve(form, system, tolerance) {
        (corrections, residual) if residual <= tolerance => corrections.to_string(),
        _ => "-".to_string(),
    };
    let [loose, middle, tight] = [1e-6, 1e-8, 1e-10].map(|tolerance| count(form, tolerance));
    let best = solve(form, system, 0.0).1;
    system.b.iter_mut().for_each(|b| *b *= 1e-8);
    let (closed, reached) = solve(form, system, 1e-8);
    system.b.iter_mut().for_each(|b| *b *= 1e8);
    println!("{label} | {loose:>5} {middle:>5} {tight:>5} {best:8.0e} | {closed:>6} {reached:8.0e}");
}
