//! Textbook paths: a truss that snaps through, one that snaps back, and a column that buckles.

use super::*;
use crate::problem::Problem;
use crate::{HessianKind, Layout, Linearization, SoftElement};
use foldwell_numerics::sparse::Cliques;
use foldwell_numerics::vector::max_abs;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Half span, height and stiffness EA of the truss.
const HALF_SPAN: f64 = 1.0;
const HEIGHT: f64 = 0.3;
const EA: f64 = 1.0;

/// A function with its gradient and the lower triangle of its Hessian, row by row.
type Value = (f64, Vec<f64>, Vec<f64>);

/// A problem made of functions of the unknowns and the parameter.
struct TextbookPath {
    layout: Arc<Layout>,
    compliance: Vec<f64>,
    scale: Vec<f64>,
    parameter: f64,
    way: f64,
    soft: fn(&[f64], f64) -> Value,
    stiff: fn(&[f64], f64) -> Vec<Value>,
    rates: fn(&[f64]) -> [Vec<f64>; 2],
    conjugate: fn(&[f64], &[f64]) -> f64,
}

impl TextbookPath {
    fn layout(unknowns: usize, measures: usize) -> Arc<Layout> {
        let (mut soft, mut stiff) = (Cliques::new(), Cliques::new());
        soft.push(0..unknowns as u32);
        (0..measures).for_each(|_| stiff.push(0..unknowns as u32));
        Layout::new(vec![0; unknowns], soft, stiff)
    }

    /// A problem of an energy alone, without a conjugate.
    fn of_energy(unknowns: usize, soft: fn(&[f64], f64) -> Value, rates: fn(&[f64]) -> [Vec<f64>; 2]) -> Self {
        Self {
            layout: Self::layout(unknowns, 0),
            compliance: vec![],
            scale: vec![],
            parameter: 0.0,
            way: 1.0,
            soft,
            stiff: |_, _| vec![],
            rates,
            conjugate: |_, _| 0.0,
        }
    }
}

impl Problem for TextbookPath {
    fn layout(&self) -> &Arc<Layout> {
        &self.layout
    }
    fn compliance(&self) -> &[f64] {
        &self.compliance
    }
    fn gap_scale(&self) -> &[f64] {
        &self.scale
    }
    fn energy(&self, x: &[f64]) -> f64 {
        (self.soft)(x, self.parameter).0
    }
    fn gaps(&self, x: &[f64]) -> Vec<f64> {
        (self.stiff)(x, self.parameter).into_iter().map(|(gap, ..)| gap).collect()
    }
    fn linearize(&self, x: &[f64], tension: &[f64], kind: HessianKind, out: &mut Linearization) {
        out.clear(kind);
        let (energy, gradient, hessian) = (self.soft)(x, self.parameter);
        out.energy = energy;
        out.largest_force = max_abs(&gradient).max(1e-3);
        out.add_soft(
            0,
            &SoftElement {
                stiffness: 0.0,
                excess: 0.0,
                force: 1.0,
                size: f64::INFINITY,
                gradient: &gradient,
                hessian: &hessian,
            },
        );
        for (k, (gap, gradient, hessian)) in (self.stiff)(x, self.parameter).into_iter().enumerate() {
            out.gaps[k] = gap;
            out.jacobian[k * x.len()..(k + 1) * x.len()].copy_from_slice(&gradient);
            out.largest_force = out.largest_force.max(max_abs(&gradient) * tension[k].abs());
            out.add_stiff(k, tension[k], &hessian);
        }
    }
    fn accept(&mut self, _x: &mut [f64]) {}
}

impl ParametrizedProblem for TextbookPath {
    fn parameter(&self) -> f64 {
        self.parameter
    }
    fn set_parameter(&mut self, value: f64) {
        self.parameter = value;
    }
    fn parameter_scale(&self) -> f64 {
        self.way
    }
    fn parameter_rates(&self, _at: &Linearization, x: &[f64], _tension: &[f64]) -> [Vec<f64>; 2] {
        (self.rates)(x)
    }
    fn conjugate(&self, _at: &Linearization, x: &[f64], tension: &[f64]) -> f64 {
        (self.conjugate)(x, tension)
    }
    /// All conjugates here are linear.
    fn conjugate_rate(&self, _at: &Linearization, _x: &[f64], _tension: &[f64], rates: &Rates) -> f64 {
        (self.conjugate)(&rates.x, &rates.tension)
    }
}

/// A watch of nothing.
struct Nothing;

impl<P> Watch<P> for Nothing {
    fn values(&mut self, _problem: &P, _state: &PathState) -> Vec<f64> {
        vec![]
    }
    fn ends(&self, _marks: &[PathMark]) -> bool {
        false
    }
}

impl<P> PathObserver<P> for Nothing {
    fn state(&mut self, _branch: usize, _problem: &P, _state: &MarkedState) -> bool {
        true
    }
    fn known_state(&mut self, _branch: usize, _problem: &P, _state: &MarkedState) {}
    fn entry(&mut self, _entry: &PathEntry) -> bool {
        true
    }
}

fn follow(problem: &mut TextbookPath, x: Vec<f64>, settings: &PathSettings) -> Vec<Branch> {
    follow_path(problem, Start::from(x), settings, &mut Nothing, &mut Nothing, PathRecord::default()).unwrap()
}

fn marked(branch: &Branch, mark: PathMark) -> Vec<&PathState> {
    branch.states.iter().filter(|marked| marked.mark == Some(mark)).map(|marked| &marked.state).collect()
}

/// Length of a bar of the truss whose apex is at height `z`, as a measure: both bars together.
fn bar(z: f64) -> Value {
    let (rest, length) = (HALF_SPAN.hypot(HEIGHT), HALF_SPAN.hypot(z));
    (length - rest, vec![z / length], vec![HALF_SPAN * HALF_SPAN / length.powi(3)])
}

fn compliance_of_bars() -> f64 {
    HALF_SPAN.hypot(HEIGHT) / (2.0 * EA)
}

/// The load of the truss at height `z`: theory of two bars, `F = -2 EA/L0 (l - L0) z/l`.
fn load(z: f64) -> f64 {
    let (gap, gradient, _) = bar(z);
    -gap / compliance_of_bars() * gradient[0]
}

/// Claim: under a load a two-bar truss is followed through both limit points and on to where its bars are pulled; every
/// state lies on the closed curve, limit points are located to 1e-12, unstable states lie between them, and the work is
/// the energy. Source: `F(z)` above, with extrema at `l^3 = L0 w^2`. Tolerances: rounding, and 1e-9 of the largest
/// work.
#[test]
fn a_truss_snaps_through() {
    let mut truss = TextbookPath {
        layout: TextbookPath::layout(1, 1),
        compliance: vec![compliance_of_bars()],
        scale: vec![1.0],
        parameter: 0.0,
        way: 0.02,
        soft: |x, load| (load * x[0], vec![load], vec![0.0]),
        stiff: |x, _| vec![bar(x[0])],
        rates: |_| [vec![1.0], vec![0.0]],
        conjugate: |x, _| -x[0],
    };
    let branches = follow(&mut truss, vec![HEIGHT], &PathSettings { target: 0.02, ..PathSettings::default() });
    let [branch] = &branches[..] else { panic!("{} branches", branches.len()) };
    assert_eq!(branch.end, BranchEnd::Target);
    for MarkedState { state, .. } in &branch.states {
        assert!((state.parameter - load(state.x[0])).abs() <= 1e-12, "{} {}", state.x[0], state.parameter);
    }
    let turns = marked(branch, PathMark::ParameterTurns);
    let limit = (HALF_SPAN.hypot(HEIGHT) * HALF_SPAN.powi(2)).powf(2.0 / 3.0) - HALF_SPAN.powi(2);
    let limit = limit.sqrt();
    assert!((limit - 0.170711647439495).abs() < 1e-14 && turns.len() == 2);
    assert!((turns[0].x[0] - limit).abs() <= 1e-12 && (turns[1].x[0] + limit).abs() <= 1e-12);
    assert!((turns[0].parameter - 9.530291997895e-3).abs() <= 1e-14);
    let unstable = branch.states.iter().filter(|marked| marked.mark.is_none());
    for MarkedState { state, .. } in unstable {
        assert_eq!(state.negative_eigenvalues, Some(usize::from(state.x[0].abs() < limit)), "{}", state.x[0]);
    }
    // the integral of the displacement over the load is the product less the elastic energy
    let last = &branch.states[branch.states.len() - 1];
    let (z, force) = (last.state.x[0], last.state.parameter);
    let elastic = bar(z).0.powi(2) / (2.0 * compliance_of_bars());
    let expected = -z * force - (elastic);
    assert!((last.work - expected).abs() <= 1e-9 * expected.abs(), "{} {expected}", last.work);
}

const SPRING: f64 = 0.02;

/// Claim: a truss pushed through a soft spring snaps back: the driven displacement turns around too, and both kinds of
/// limit points are located to 1e-10. Source: `u = z - F(z)/s` with a spring of stiffness `s`; displacement turns where
/// `F'(z) = s`, the force where `l^3 = L0 w^2`. Tolerance of the located points: rounding over the curvature there.
#[test]
fn a_truss_behind_a_soft_spring_snaps_back() {
    let mut truss = TextbookPath {
        layout: TextbookPath::layout(2, 2),
        compliance: vec![compliance_of_bars(), 0.0],
        scale: vec![1.0; 2],
        parameter: 0.0,
        way: 1.0,
        soft: |x, _| {
            let off = x[0] - x[1];
            (0.5 * SPRING * off * off, vec![SPRING * off, -SPRING * off], vec![SPRING, -SPRING, SPRING])
        },
        stiff: |x, driven| {
            let (gap, gradient, hessian) = bar(x[0]);
            let bars = (gap, vec![gradient[0], 0.0], vec![hessian[0], 0.0, 0.0]);
            vec![bars, (x[1] - HEIGHT + driven, vec![0.0, 1.0], vec![0.0; 3])]
        },
        rates: |_| [vec![0.0; 2], vec![0.0, 1.0]],
        conjugate: |_, tension| tension[1],
    };
    let branches = follow(&mut truss, vec![HEIGHT; 2], &PathSettings { target: 1.2, ..PathSettings::default() });
    let branch = &branches[0];
    assert_eq!(branch.end, BranchEnd::Target);
    for MarkedState { state, .. } in &branch.states {
        let z = state.x[0];
        let expected = HEIGHT - z + load(z) / SPRING;
        assert!((state.parameter - expected).abs() <= 1e-12, "{z} {} {expected}", state.parameter);
        assert!((state.conjugate[0] - load(z)).abs() <= 1e-13, "{} {}", state.conjugate[0], load(z));
    }
    let slope = |z: f64| (load(z + 1e-5) - load(z - 1e-5)) / 2e-5;
    let turns = marked(branch, PathMark::ParameterTurns);
    assert_eq!(turns.len(), 2);
    turns.iter().for_each(|state| assert!((slope(state.x[0]) - SPRING).abs() <= 1e-9, "{}", slope(state.x[0])));
    let forces = marked(branch, PathMark::ConjugateTurns);
    assert_eq!(forces.len(), 2);
    assert!((forces[0].x[0] - 0.170711647439495).abs() <= 1e-11, "{}", forces[0].x[0]);
    assert!((forces[1].x[0] + 0.170711647439495).abs() <= 1e-11, "{}", forces[1].x[0]);
    assert!(marked(branch, PathMark::BranchPoint(1)).is_empty());
    // work done by the drive: the energies of the bars and of the spring
    let last = &branch.states[branch.states.len() - 1];
    let [z, u] = [last.state.x[0], last.state.x[1]];
    let energy = bar(z).0.powi(2) / (2.0 * compliance_of_bars()) + 0.5 * SPRING * (z - u).powi(2);
    assert!((last.work - energy).abs() <= 1e-9 * energy, "{} {energy}", last.work);
}

/// Claim: a rigid column on a torsional spring buckles where the load is the spring's stiffness; the point is located
/// to 1e-10, and with `switch` both buckled branches are followed, on which the load is `angle / sin(angle)`. Source:
/// E = angle^2/2 - load (1 - cos(angle)). Tolerance: rounding; next to the branch point the angle is known to its root.
#[test]
fn a_column_buckles() {
    let mut column = TextbookPath::of_energy(
        1,
        |x, load| {
            let (sin, cos) = x[0].sin_cos();
            (0.5 * x[0] * x[0] - load * (1.0 - cos), vec![x[0] - load * sin], vec![1.0 - load * cos])
        },
        |x| [vec![-x[0].sin()], vec![]],
    );
    let settings = PathSettings { target: 1.5, switch: true, ..PathSettings::default() };
    let branches = follow(&mut column, vec![0.0], &settings);
    let points = marked(&branches[0], PathMark::BranchPoint(1));
    assert!(points.len() == 1 && (points[0].parameter - 1.0).abs() <= 1e-10, "{points:?}");
    assert!(branches[0].states.iter().all(|marked| marked.state.x[0] == 0.0));
    assert_eq!(branches[0].states.last().and_then(|last| last.state.negative_eigenvalues), Some(1));
    assert_eq!(branches.len(), 3);
    for (branch, sign) in branches[1..].iter().zip([1.0, -1.0]) {
        assert_eq!(branch.end, BranchEnd::Target);
        for MarkedState { state, .. } in &branch.states[1..] {
            let angle = state.x[0];
            assert!((state.parameter - angle / angle.sin()).abs() <= 1e-10, "{angle} {}", state.parameter);
            assert_eq!(state.negative_eigenvalues, Some(0));
        }
        let _ = sign;
    }
    let ends: Vec<f64> = branches[1..].iter().map(|b| b.states[b.states.len() - 1].state.x[0]).collect();
    assert!((ends[0] + ends[1]).abs() <= 1e-10 && ends[0].abs() > 1.0, "{ends:?}");
}

/// Part by which the load falls in each wave of a staircase, and waves a length.
const FALL: f64 = 1e-3;
const WAVES: f64 = 6.0;

/// Claim: pairs of limit points that are a tenth of a step apart are found, whatever the longest step. Source: the load
/// `x - (1 + e) sin(k x)/k` falls where `cos(k x) > 1/(1 + e)`, within `0.0075` of `x = 2 pi n / k`. Tolerance: where
/// the load turns, to rounding over its curvature.
#[test]
fn close_pairs_of_limit_points_are_found() {
    for max_step in [0.02, 0.05, 0.1, 0.2] {
        let mut staircase = TextbookPath::of_energy(
            1,
            |x, load| {
                let ((sin, cos), x) = ((WAVES * x[0]).sin_cos(), x[0]);
                let energy = 0.5 * x * x + (1.0 + FALL) * cos / (WAVES * WAVES) - load * x;
                (energy, vec![x - (1.0 + FALL) * sin / WAVES - load], vec![1.0 - (1.0 + FALL) * cos])
            },
            |_| [vec![-1.0], vec![]],
        );
        let start = std::f64::consts::PI / WAVES;
        staircase.parameter = start;
        let settings = PathSettings { target: 4.0 + start, max_step, ..PathSettings::default() };
        let branches = follow(&mut staircase, vec![start], &settings);
        let turns = marked(&branches[0], PathMark::ParameterTurns);
        assert_eq!(turns.len(), 8, "{max_step}: {turns:?}");
        for state in turns {
            let slope = 1.0 - (1.0 + FALL) * (WAVES * state.x[0]).cos();
            assert!(slope.abs() <= 1e-9, "{max_step}: {slope} at {}", state.x[0]);
        }
    }
}

/// Claim: branch points just behind and before limit points are located where a motion of their own has no stiffness, and
/// not where that of the path has none. Source: the path `y = z = 0` of `x^4/4 - 3 x^2/2 - load x + 10 (x + 1 - b) y^2 +
/// 10 (x - 1 + b) z^2` turns at `x = -1` and `x = 1`, and `y` and `z` have no stiffness at `b - 1` and `1 - b`.
/// Tolerance: a thousandth of `b`; located at the limit points they are off by all of it.
#[test]
fn branch_points_beside_limit_points_are_located() {
    const B: f64 = 1e-5;
    for max_step in [0.02, 0.05, 0.1, 0.2] {
        let mut wings = TextbookPath::of_energy(
            3,
            |at, load| {
                let ([x, y, z], [a, b]) = ([at[0], at[1], at[2]], [20.0 * (at[0] + 1.0 - B), 20.0 * (at[0] - 1.0 + B)]);
                let energy = 0.25 * x.powi(4) - 1.5 * x * x - load * x + 0.5 * (a * y * y + b * z * z);
                let force = x.powi(3) - 3.0 * x - load + 10.0 * (y * y + z * z);
                let hessian = vec![3.0 * x * x - 3.0, 20.0 * y, a, 20.0 * z, 0.0, b];
                (energy, vec![force, a * y, b * z], hessian)
            },
            |_| [vec![-1.0, 0.0, 0.0], vec![]],
        );
        wings.parameter = -2.0;
        let settings = PathSettings { target: 3.0, max_step, ..PathSettings::default() };
        let branches = follow(&mut wings, vec![-2.0, 0.0, 0.0], &settings);
        let found = marked(&branches[0], PathMark::BranchPoint(1));
        let places: Vec<f64> = found.iter().map(|state| state.x[0]).collect();
        assert_eq!(places.len(), 2, "{max_step}: {places:?}");
        let off = places.iter().map(|x| (x.abs() - 1.0 + B).abs()).fold(0.0, f64::max);
        assert!(off <= 1e-3 * B, "{max_step}: {places:?}");
    }
}

/// Claim: the Newton steps of a path count those of steps that were refused: of a curve that bends ever more sharply, which
/// long steps miss, they are at least half of the evaluations, of which there is one for each Newton step and one or two
/// for each state that is asked for. Source: the curve `y = sin(u^2)`, `u = load`.
#[test]
fn refused_steps_are_counted() {
    static EVALUATIONS: AtomicUsize = AtomicUsize::new(0);
    let mut wave = TextbookPath::of_energy(
        2,
        |x, load| {
            EVALUATIONS.fetch_add(1, Ordering::Relaxed);
            let (u, sine, cosine) = (x[0], (x[0] * x[0]).sin(), (x[0] * x[0]).cos());
            let (off, slope) = (x[1] - sine, 2.0 * u * cosine);
            let bent = slope * slope - off * (2.0 * cosine - 4.0 * u * u * sine);
            let energy = 0.5 * (u - load).powi(2) + 0.5 * off * off;
            (energy, vec![u - load - off * slope, off], vec![1.0 + bent, -slope, 1.0])
        },
        |_| [vec![-1.0, 0.0], vec![]],
    );
    let settings = PathSettings { target: 4.0, max_step: 2.0, ..PathSettings::default() };
    let branches = follow(&mut wave, vec![0.0, 0.0], &settings);
    let steps: usize = branches[0].states.iter().map(|marked| marked.state.iterations).sum();
    let evaluations = EVALUATIONS.load(Ordering::Relaxed);
    assert!(2 * steps >= evaluations, "{steps} of {evaluations}");
}

/// Claim: a state is found on its branch, and not on another one at a distance of a thousandth of a step. Tolerance:
/// the interpolant between states 0.1 apart is off by a fifth of that distance, so that Newton's method leads to the
/// nearer branch. Source: branches `y = sin(3 u) +- d`, `u = load`, of the energy `(u - load)^2/2 + z^3/3 - d^2 z` with
/// `z = y - sin(3 u)`.
#[test]
fn neighbouring_branches_are_told_apart() {
    const APART: f64 = 5e-5;
    let mut pair = TextbookPath::of_energy(
        2,
        |x, load| {
            let (sin, cos) = (3.0 * x[1]).sin_cos();
            let (off, along) = (x[0] - sin, x[1] - load);
            let slope = off * off - APART * APART;
            let energy = 0.5 * along * along + off.powi(3) / 3.0 - APART * APART * off;
            let bend = 1.0 + 9.0 * sin * slope + 18.0 * cos * cos * off;
            (energy, vec![slope, along - 3.0 * cos * slope], vec![2.0 * off, -6.0 * cos * off, bend])
        },
        |_| [vec![0.0, -1.0], vec![]],
    );
    let mut follower = follower::Follower::new(&mut pair, PathSettings::default()).unwrap();
    let mut states = vec![];
    for (load, side) in [(0.0, 1.0), (0.04, 1.0), (0.1, 1.0), (0.06, 1.0), (0.06, -1.0)] {
        let x = vec![f64::sin(3.0 * load) + side * APART, load];
        let guess = Rates { x, tension: vec![], parameter: load };
        let (mut state, _) = follower.settle(guess, &bordered::Hyperplane::of_parameter(2, 1.0), 0.0).unwrap().unwrap();
        // between the chord and the curve, which differ by less than what is told apart
        state.arc_length = load * (1.0 + 9.0 + 2.0f64).sqrt() / std::f64::consts::SQRT_2;
        states.push(state);
    }
    let [from, middle, to, on, beside] = &states[..] else { panic!("five states") };
    assert!(follower.passes(from, to, on).unwrap());
    assert!(!follower.passes(from, to, beside).unwrap());
    assert!(!follower.passes(from, middle, on).unwrap(), "beyond the second state");
}

/// Claim: a path that is a closed curve ends where it comes back to its own states, and not after many rounds. Source:
/// the energy `x^3/3 - (1 - u^2) x` with `u = load` has the equilibria `x^2 + u^2 = 1`, a circle; in arc length, in
/// which two unknowns count half and the load once, its circumference is the integral of `sqrt(1/2 + cos^2)`.
/// Tolerance: the last step.
#[test]
fn a_closed_path_ends_where_it_began() {
    let mut circle = TextbookPath {
        layout: TextbookPath::layout(2, 1),
        compliance: vec![0.0],
        scale: vec![1.0],
        parameter: 0.0,
        way: 1.0,
        soft: |x, _| {
            let height = 1.0 - x[1] * x[1];
            let energy = x[0].powi(3) / 3.0 - height * x[0];
            let gradient = vec![x[0] * x[0] - height, 2.0 * x[0] * x[1]];
            (energy, gradient, vec![2.0 * x[0], 2.0 * x[1], 2.0 * x[0]])
        },
        stiff: |x, load| vec![(x[1] - load, vec![0.0, 1.0], vec![0.0; 3])],
        rates: |_| [vec![0.0; 2], vec![-1.0]],
        conjugate: |_, tension| -tension[0],
    };
    let settings = PathSettings { target: 2.0, ..PathSettings::default() };
    let branches = follow(&mut circle, vec![1.0, 0.0], &settings);
    let speed = |k: i32| (0.5 + (f64::from(k) * std::f64::consts::PI / 500.0).cos().powi(2)).sqrt();
    let circumference = (0..1000).map(speed).sum::<f64>() * std::f64::consts::PI / 500.0;
    let beyond = branches[0].states.last().map_or(0.0, |last| last.state.arc_length) - circumference;
    assert_eq!(branches[0].end, BranchEnd::Retraced);
    assert!((-0.01..0.2).contains(&beyond), "{beyond}");
    assert_eq!(marked(&branches[0], PathMark::ParameterTurns).len(), 2);
}
