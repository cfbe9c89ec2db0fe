//! Starts whose way back onto their stiff measures leads through a wall of infinite energy, and starts that are in balance
//! only with what is held.

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

/// A point on a spring of stiffness 1 that is at rest at `(0, 1)`. Its second coordinate is held at 0 until the unknowns
/// are chosen anew.
struct HeldPoint {
    layout: Arc<Layout>,
    free: bool,
}

impl HeldPoint {
    fn new(free: bool) -> Self {
        let mut soft = Cliques::new();
        soft.push(0..if free { 2 } else { 1 });
        Self { layout: Layout::new(vec![0; if free { 2 } else { 1 }], soft, Cliques::new()), free }
    }

    /// How far the point is off rest.
    fn off(&self, x: &[f64]) -> [f64; 2] {
        [x[0], if self.free { x[1] - 1.0 } else { -1.0 }]
    }
}

impl Problem for HeldPoint {
    fn layout(&self) -> &Arc<Layout> {
        &self.layout
    }
    fn compliance(&self) -> &[f64] {
        &[]
    }
    fn gap_scale(&self) -> &[f64] {
        &[]
    }
    fn energy(&self, x: &[f64]) -> f64 {
        self.off(x).iter().map(|off| 0.5 * off * off).sum()
    }
    fn gaps(&self, _x: &[f64]) -> Vec<f64> {
        vec![]
    }
    fn linearize(&self, x: &[f64], _tension: &[f64], kind: HessianKind, out: &mut Linearization) {
        out.clear(kind);
        (out.energy, out.largest_force) = (self.energy(x), 1.0);
        let hessian = if self.free { &[1.0, 0.0, 1.0][..] } else { &[1.0] };
        let gradient = &self.off(x)[..x.len()];
        out.add_soft(0, &SoftElement { stiffness: 0.0, excess: 0.0, force: 1.0, size: 1.0, gradient, hessian });
    }
    fn accept(&mut self, _x: &mut [f64]) {}
    fn choose_anew(&mut self, x: &[f64], rates: &[f64]) -> Option<[Vec<f64>; 2]> {
        let written = |first: &[f64]| vec![first[0], 0.0];
        let chosen = (!self.free).then(|| [written(x), written(rates)])?;
        *self = Self::new(true);
        Some(chosen)
    }
}

/// Claim: a start that is in balance only with what it holds is no equilibrium: the point goes to where its spring rests.
/// Exact to rounding.
#[test]
fn a_start_in_balance_with_what_it_holds_is_none() {
    for start in [0.0, 0.3] {
        let found = minimize(&mut HeldPoint::new(false), vec![start], Options::default(), &mut |_| true).unwrap();
        assert!(found.x.len() == 2 && found.x[0].abs() < 1e-15 && (found.x[1] - 1.0).abs() < 1e-15, "{:?}", found.x);
    }
}
