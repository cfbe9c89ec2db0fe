//! A start whose way back onto its stiff measures leads through a wall of infinite energy.

use crate::{HessianKind, Layout, Linearization, Options, Problem, SoftElement, minimize};
use foldwell_numerics::sparse::Cliques;
use std::sync::Arc;

/// Coordinate of the wall, at which the energy becomes infinite.
const WALL: f64 = 0.5;
/// Coordinate at which the spring is at rest, behind the wall.
const REST: f64 = 1.0;
/// Compliance of the spring: its stretch by a force of 1, the inverse of its stiffness.
const COMPLIANCE: f64 = 1e-6;

/// A point `x` on a line, pushed back by `1 / (WALL - x)`, on a stiff spring.
struct Walled(Arc<Layout>);

impl Walled {
    /// Energy of the wall with two derivatives.
    fn wall(x: f64) -> [f64; 3] {
        let left = WALL - x;
        if left > 0.0 { [left.recip(), left.powi(-2), 2.0 * left.powi(-3)] } else { [f64::INFINITY; 3] }
    }
}

impl Problem for Walled {
    fn layout(&self) -> &Arc<Layout> {
        &self.0
    }
    fn compliance(&self) -> &[f64] {
        &[COMPLIANCE]
    }
    fn gap_scale(&self) -> &[f64] {
        &[1.0]
    }
    fn energy(&self, x: &[f64]) -> f64 {
        Self::wall(x[0])[0]
    }
    fn gaps(&self, x: &[f64]) -> Vec<f64> {
        vec![x[0] - REST]
    }
    fn linearize(&self, x: &[f64], tension: &[f64], kind: HessianKind, out: &mut Linearization) {
        out.clear(kind);
        let [energy, force, stiffness] = Self::wall(x[0]);
        (out.energy, out.largest_force) = (energy, force.max(tension[0].abs()));
        out.add_soft(0, &SoftElement { stiffness, excess: 0.0, force, size: 1.0, gradient: &[1.0], hessian: &[0.0] });
        out.gaps[0] = x[0] - REST;
        out.jacobian.copy_from_slice(&[1.0]);
        out.add_stiff(0, tension[0], &[0.0]);
    }
    fn accept(&mut self, _x: &mut [f64]) {}
}

/// Claim: the equilibrium in front of the wall is found from a start whose spring is off by a length, though pulling
/// the start onto its spring leads through the wall. Expected: the root of `1 / d^2 = (REST - WALL + d) / c` for the
/// distance `d` from the wall, by bisection. Tolerance: the residual of the force, 1e-10 of it, over its rate `2 / d`,
/// thousandfold.
#[test]
fn a_start_behind_a_wall_is_taken_as_it_is() {
    let force = |d: f64| d.powi(-2) - (REST - WALL + d) / COMPLIANCE;
    let halved = |(low, high): (f64, f64)| {
        let middle = 0.5 * (low + high);
        if force(middle) > 0.0 { (middle, high) } else { (low, middle) }
    };
    let expected = (0..100).fold((1e-9, WALL), |between, _| halved(between)).0;
    let (mut soft, mut stiff) = (Cliques::new(), Cliques::new());
    soft.push([0]);
    stiff.push([0]);
    for start in [0.0, -3.0, 0.49] {
        let mut walled = Walled(Layout::new(vec![0], soft.clone(), stiff.clone()));
        let found = minimize(&mut walled, vec![start], Options::default(), &mut |_| true).unwrap();
        let distance = WALL - found.x[0];
        assert!((distance / expected - 1.0).abs() < 1e-7, "from {start}: {distance} instead of {expected}");
        assert!((found.tension[0] * distance.powi(2) + 1.0).abs() < 1e-7, "tension {}", found.tension[0]);
    }
}
