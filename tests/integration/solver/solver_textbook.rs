//! The solver on textbook problems without sheets.

use crate::textbook::{Textbook, length, linear, steps};
use approx::assert_abs_diff_eq;
use foldwell::solver::tension::settle;
use foldwell::solver::{Failure, Options, Start, minimize};

fn rosenbrock() -> Textbook {
    let valley = |x: &[f64]| (x[1] - x[0] * x[0], vec![-2.0 * x[0], 1.0], vec![-2.0, 0.0, 0.0]);
    Textbook::new(2).soft(&[0, 1], 200.0, Box::new(valley)).soft(&[0], 2.0, linear(&[1.0], 1.0))
}

/// Claim: the minimum (1, 1) of Rosenbrock's valley `100 (y - x^2)^2 + (1 - x)^2` is found from the usual start and
/// from others in at most 30 steps (steepest descent needs thousands); the energy never increases.
#[test]
fn rosenbrocks_valley() {
    for start in [[-1.2, 1.0], [-3.0, -4.0], [0.0, 5.0], [1.0, 1.0]] {
        let found = rosenbrock().run(&start).unwrap();
        assert!(found.x.iter().all(|x| (x - 1.0).abs() < 1e-10), "{:?}", found.x);
        assert!(steps(&found) <= 30, "{} steps from {start:?}", steps(&found));
        assert_eq!(found.negative_eigenvalues, Some(0));
        assert!(found.history.windows(2).all(|pair| pair[1].energy <= pair[0].energy * (1.0 + 1e-12)));
    }
}

/// Claim: the minimum of `|x|^2 / 2` under `x0 + x1 + x2 = 3 + c0 t0`, `x0 - x2 = 1 + c1 t1` is `x = -A^T t` with `(A
/// A^T + C) t = -b`, `A A^T = diag(3, 2)`: in one step, at every compliance, including 0.
#[test]
fn a_quadratic_with_known_multipliers() {
    for c in [[0.0, 0.0], [1e-12, 0.0], [1e-4, 1e-16], [0.5, 2.0], [1e3, 1e-3]] {
        let mut problem = Textbook::new(3);
        for k in 0..3u32 {
            problem = problem.soft(&[k], 1.0, linear(&[1.0], 0.0));
        }
        problem = problem.stiff(&[0, 1, 2], c[0], linear(&[1.0, 1.0, 1.0], 3.0)).stiff(
            &[0, 2],
            c[1],
            linear(&[1.0, -1.0], 1.0),
        );
        let found = problem.run(&[0.3, -0.2, 5.0]).unwrap();
        let t = [-3.0 / (3.0 + c[0]), -1.0 / (2.0 + c[1])];
        let x = [-t[0] - t[1], -t[0], -t[0] + t[1]];
        for (found, expected) in found.tension.iter().zip(&t).chain(found.x.iter().zip(&x)) {
            assert!((found - expected).abs() < 1e-12, "{c:?}: {found} for {expected}");
        }
        assert!(steps(&found) <= 2, "{c:?}: {} steps", steps(&found));
        let energy = 0.5 * x.iter().map(|x| x * x).sum::<f64>() + 0.5 * (c[0] * t[0] * t[0] + c[1] * t[1] * t[1]);
        assert_abs_diff_eq!(found.energy, energy, epsilon = 1e-12 * energy);
    }
}

/// Claim: a condition given twice, and once more with another length, leaves two self stresses; the settled tensions
/// are the shortest: for rows `a, a, 2a` with `R^T t` fixed they are in the ratio 1 : 1 : 2.
#[test]
fn redundant_conditions_share_the_tension() {
    let mut problem = Textbook::new(2);
    for k in 0..2u32 {
        problem = problem.soft(&[k], 1.0, linear(&[1.0], 0.0));
    }
    for factor in [1.0, 1.0, 2.0] {
        problem = problem.stiff(&[0, 1], 0.0, linear(&[factor, factor], 2.0 * factor));
    }
    let found = problem.run(&[5.0, -1.0]).unwrap();
    assert!(found.x.iter().all(|x| (x - 1.0).abs() < 1e-12), "{:?}", found.x);
    let settled = settle(&problem, &found);
    assert_eq!(settled.self_stresses, Some(2));
    assert!(settled.residuals.force <= 1e-12 && settled.residuals.length <= 1e-12);
    for (tension, expected) in settled.tension.iter().zip([-1.0 / 6.0, -1.0 / 6.0, -1.0 / 3.0]) {
        assert!((tension - expected).abs() < 1e-12, "{:?}", settled.tension);
    }
}

/// Claim: contradictory conditions, linear ones and two circles that do not intersect, are reported as infeasible, with
/// a gap not smaller than the least possible, and without steps.
#[test]
fn contradictions_are_infeasible() {
    let plain = Textbook::new(1).soft(&[0], 1.0, linear(&[1.0], 0.0));
    let mut line = plain.stiff(&[0], 0.0, linear(&[1.0], 0.0)).stiff(&[0], 0.0, linear(&[1.0], 1.0));
    let plain = Textbook::new(2).soft(&[0], 1.0, linear(&[1.0], 0.0)).soft(&[1], 1.0, linear(&[1.0], 0.0));
    let circle = |x: f64| length(Some([x, 0.0]), 1.0);
    let mut circles = plain.stiff(&[0, 1], 0.0, circle(-2.0)).stiff(&[0, 1], 0.0, circle(2.0));
    for (error, least) in [(line.run(&[0.2]).unwrap_err(), 0.5), (circles.run(&[0.1, 0.7]).unwrap_err(), 0.99)] {
        match error.failure {
            Failure::Infeasible { gap } => assert!(gap >= least, "gap {gap} of {least}"),
            other => panic!("{other}"),
        }
        assert!(error.history.is_empty());
    }
}

/// Claim: the observer receives every state once, the start first, and can stop the iteration; the error contains the
/// states so far.
#[test]
fn the_observer_stops_the_iteration() {
    let mut seen = 0;
    let mut problem = rosenbrock();
    let stopped = minimize(&mut problem, vec![-1.2, 1.0], Options::default(), &mut |_| {
        seen += 1;
        seen < 3
    });
    let error = stopped.unwrap_err();
    assert_eq!((error.failure, error.history.len(), seen), (Failure::Interrupted, 3, 3));
    let mut seen = Vec::new();
    let found = minimize(&mut problem, vec![-1.2, 1.0], Options::default(), &mut |step| {
        seen.push(*step);
        true
    });
    assert_eq!(found.unwrap().history, seen);
}

/// Claim: the error after too few steps contains their number.
#[test]
fn too_few_steps_are_said() {
    let options = Options { iterations: 2, ..Options::default() };
    let error = minimize(&mut rosenbrock(), vec![-1.2, 1.0], options, &mut |_| true).unwrap_err();
    assert!(matches!(error.failure, Failure::TooManySteps { iterations: 2, .. }), "{error}");
    assert_eq!(error.history.len(), 3);
}

/// Returns the problem `(x^2 - 1)^2 / 2 + y^2 / 2`: two wells and a saddle at the origin.
fn wells() -> Textbook {
    let wall = |x: &[f64]| (x[0] * x[0] - 1.0, vec![2.0 * x[0]], vec![2.0]);
    Textbook::new(2).soft(&[0], 1.0, Box::new(wall)).soft(&[1], 1.0, linear(&[1.0], 0.0))
}

/// Claim: from exactly the saddle between two wells, the saddle is reported with its one negative eigenvalue; from a
/// start a little to one side the well on that side is found.
#[test]
fn a_saddle_is_reported_or_left() {
    let found = wells().run(&[0.0, 0.0]).unwrap();
    assert_eq!((found.x.as_slice(), found.negative_eigenvalues), ([0.0, 0.0].as_slice(), Some(1)));
    for start in [[1e-3, 0.0], [-1e-3, 0.5], [0.4, -1.0], [3.0, 0.0]] {
        let found = wells().run(&start).unwrap();
        assert!((found.x[0] - f64::signum(start[0])).abs() < 1e-11, "from {start:?} to {:?}", found.x);
        assert_eq!(found.negative_eigenvalues, Some(0));
    }
}

/// Claim: near a minimum a shift is removed at once, even if it is still large. The problem is a stiff spring that
/// carries a load of 1 and a well a millionth as stiff, started where it is unstable: its force is small compared with
/// the load.
#[test]
fn shifts_end_near_a_minimum() {
    let well = |x: &[f64]| (x[0] * x[0] - 1.0, vec![2.0 * x[0]], vec![2.0]);
    let spring = Textbook::new(2).soft(&[0], 1.0, linear(&[1.0], 0.0)).load(&[1.0, 0.0]);
    let start = Start { x: vec![1.0, 0.5], tension: Some(vec![]) };
    let found =
        minimize(&mut spring.soft(&[1], 1e-6, Box::new(well)), start, Options::default(), &mut |_| true).unwrap();
    assert!((found.x[1] - 1.0).abs() < 1e-6, "{:?}", found.x);
    let shifts: Vec<f64> = found.history.iter().map(|step| step.shift).collect();
    assert!(found.history[0].residual_force < 1e-5, "{}", found.history[0].residual_force);
    // the start has no shift yet; large ones follow, and none after them
    let end = shifts.iter().rposition(|shift| *shift > 0.0).expect("the start is unstable");
    assert!(end + 1 < shifts.len() && shifts[1..=end].iter().all(|shift| *shift >= 0.25), "{shifts:?}");
}

/// Claim: bounds on the numbers of operations. A quadratic takes one factorization for its step (that of the
/// certificate is not in the history); every step makes at least one solve; Rosenbrock's valley makes no more
/// factorizations than steps, plus those of raised shifts.
#[test]
fn costs_are_counted() {
    let mut quadratic = Textbook::new(1).soft(&[0], 4.0, linear(&[1.0], 2.0));
    let found = quadratic.run(&[7.0]).unwrap();
    let counts: Vec<[usize; 2]> = found.history.iter().map(|step| [step.factorizations, step.solves]).collect();
    assert_eq!(counts, [[0, 0], [1, 1]]);
    let found = rosenbrock().run(&[-1.2, 1.0]).unwrap();
    let factorizations: usize = found.history.iter().map(|step| step.factorizations).sum();
    assert!(factorizations >= steps(&found) && factorizations <= 3 * steps(&found), "{factorizations}");
    assert!(found.history[1..].iter().all(|step| step.solves >= 1));
}
