//! Limiting problems of the solver: no soft energy at all, no energy at the minimum, an unstable equilibrium.

use crate::textbook::{Textbook, length, linear, steps};
use approx::assert_abs_diff_eq;

/// Claim: a stiff measure instead of the steep wall of the valley changes only the path: `sqrt(200) (y - x^2)` with
/// compliance 1 has the same minimum and the same energy, and with compliance 0 the minimum of `(1 - x)^2` on the
/// parabola. Compliances from 1 down to 0.
#[test]
fn the_valley_with_a_stiff_wall() {
    for compliance in [1.0 / 200.0, 1e-6, 1e-12, 0.0] {
        let wall = |x: &[f64]| (x[1] - x[0] * x[0], vec![-2.0 * x[0], 1.0], vec![-2.0, 0.0, 0.0]);
        let mut problem =
            Textbook::new(2).soft(&[0], 2.0, linear(&[1.0], 1.0)).stiff(&[0, 1], compliance, Box::new(wall));
        let found = problem.run(&[-1.2, 1.0]).unwrap();
        assert!(found.x.iter().all(|x| (x - 1.0).abs() < 1e-9), "c = {compliance:e}: {:?}", found.x);
        assert!(steps(&found) <= 30, "c = {compliance:e}: {} steps", steps(&found));
    }
}

/// Claim: a pendulum on a rigid bar of length 2 with a weight of 3 hangs straight down with the weight as tension, from
/// the side and from nearly the top; exactly at the top it is in equilibrium with one negative eigenvalue. Tolerance
/// there: 1e-12 of the length, to which the solver closes gaps.
#[test]
fn a_pendulum() {
    let pendulum = || Textbook::new(2).load(&[0.0, -3.0]).stiff(&[0, 1], 0.0, length(Some([0.0, 0.0]), 2.0));
    for start in [[2.0, 0.0], [1.0, -1.0], [-1.2, 1.6], [0.1, 2.0]] {
        let found = pendulum().run(&start).unwrap_or_else(|error| panic!("from {start:?}: {error}"));
        assert!(found.x[0].abs() < 1e-10 && (found.x[1] + 2.0).abs() < 1e-12, "{:?}", found.x);
        assert_abs_diff_eq!(found.tension[0], 3.0, epsilon = 1e-11);
        assert_eq!(found.negative_eigenvalues, Some(0));
    }
    let top = pendulum().run(&[0.0, 2.0]).unwrap();
    assert_eq!(top.negative_eigenvalues, Some(1));
    assert!(top.x[0] == 0.0 && (top.x[1] - 2.0).abs() < 2e-12, "{:?}", top.x);
    assert!((top.tension[0] + 3.0).abs() < 1e-12, "at the top the bar is pressed");
}
