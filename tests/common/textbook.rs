//! A problem for the solver that is defined by closures.
#![allow(dead_code)] // each test file uses a part

use foldwell::numerics::sparse::Cliques;
use foldwell::solver::{
    Equilibrium, HessianKind, Layout, Linearization, NewtonError, Options, Problem, SoftElement, minimize,
};
use std::sync::Arc;

/// A function that returns a scalar with its gradient and the lower triangle (row by row) of its Hessian, in its own
/// variables.
pub type Measure = Box<dyn Fn(&[f64]) -> (f64, Vec<f64>, Vec<f64>)>;

/// The problem to minimise `E = sum w m^2 / 2 - load . x` under stiff measures `m = c t`.
pub struct Textbook {
    layout: Arc<Layout>,
    soft: Vec<(f64, Measure)>,
    stiff: Vec<Measure>,
    load: Vec<f64>,
    compliance: Vec<f64>,
    scale: Vec<f64>,
}

impl Textbook {
    pub fn new(unknowns: usize) -> Self {
        let layout = Layout::new((0..unknowns as u32).collect(), Cliques::new(), Cliques::new());
        Self { layout, soft: vec![], stiff: vec![], load: vec![0.0; unknowns], compliance: vec![], scale: vec![] }
    }

    pub fn soft(mut self, members: &[u32], weight: f64, measure: Measure) -> Self {
        let mut soft = self.layout.soft.clone();
        soft.push(members.iter().copied());
        self.layout = Layout::new(self.layout.node.clone(), soft, self.layout.stiff.clone());
        self.soft.push((weight, measure));
        self
    }

    pub fn stiff(mut self, members: &[u32], compliance: f64, measure: Measure) -> Self {
        let mut stiff = self.layout.stiff.clone();
        stiff.push(members.iter().copied());
        self.layout = Layout::new(self.layout.node.clone(), self.layout.soft.clone(), stiff);
        self.stiff.push(measure);
        self.compliance.push(compliance);
        self.scale.push(1.0);
        self
    }

    pub fn load(mut self, load: &[f64]) -> Self {
        self.load = load.to_vec();
        self
    }

    fn at(cliques: &Cliques, k: usize, x: &[f64]) -> Vec<f64> {
        cliques.members(k).iter().map(|&member| x[member as usize]).collect()
    }

    pub fn run(&mut self, start: &[f64]) -> Result<Equilibrium, NewtonError> {
        minimize(self, start.to_vec(), Options::default(), &mut |_| true)
    }
}

impl Problem for Textbook {
    fn layout(&self) -> &Arc<Layout> {
        &self.layout
    }

    fn compliance(&self) -> &[f64] {
        &self.compliance
    }

    fn gap_scale(&self) -> &[f64] {
        &self.scale
    }

    fn gaps(&self, x: &[f64]) -> Vec<f64> {
        self.stiff.iter().enumerate().map(|(k, measure)| measure(&Self::at(&self.layout.stiff, k, x)).0).collect()
    }

    fn energy(&self, x: &[f64]) -> f64 {
        let cost = |(k, (weight, measure)): (usize, &(f64, Measure))| {
            0.5 * weight * measure(&Self::at(&self.layout.soft, k, x)).0.powi(2)
        };
        let loads: f64 = self.load.iter().zip(x).map(|(f, x)| f * x).sum();
        self.soft.iter().enumerate().map(cost).sum::<f64>() - loads
    }

    fn linearize(&self, x: &[f64], tension: &[f64], kind: HessianKind, out: &mut Linearization) {
        out.clear(kind);
        out.energy = self.energy(x);
        out.largest_force = self.load.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        out.gradient.iter_mut().zip(&self.load).for_each(|(g, f)| *g = -f);
        for (k, (weight, measure)) in self.soft.iter().enumerate() {
            let (value, gradient, mut hessian) = measure(&Self::at(&self.layout.soft, k, x));
            for g in &gradient {
                out.largest_force = out.largest_force.max(weight * g.abs() * value.abs().max(1e-3));
            }
            if kind == HessianKind::GaussNewton {
                hessian.clear();
            }
            let (stiffness, force) = (*weight, weight * value);
            out.add_soft(
                k,
                &SoftElement { stiffness, excess: 0.0, force, size: 1.0, gradient: &gradient, hessian: &hessian },
            );
        }
        for (k, measure) in self.stiff.iter().enumerate() {
            let (value, gradient, hessian) = measure(&Self::at(&self.layout.stiff, k, x));
            out.gaps[k] = value;
            out.largest_force = gradient.iter().fold(out.largest_force, |m, g| m.max((g * tension[k]).abs()));
            out.jacobian[self.layout.stiff.range(k)].copy_from_slice(&gradient);
            out.add_stiff(k, tension[k], &hessian);
        }
    }

    fn accept(&mut self, _x: &mut [f64]) {}
}

/// Returns the measure `a . x - rest`.
pub fn linear(a: &[f64], rest: f64) -> Measure {
    let a = a.to_vec();
    Box::new(move |x| {
        let value = a.iter().zip(x).map(|(a, x)| a * x).sum::<f64>() - rest;
        (value, a.clone(), vec![0.0; a.len() * (a.len() + 1) / 2])
    })
}

/// Returns the measure of a length, minus `rest`: the distance from a fixed point of the plane, or between two moving
/// points.
pub fn length(from: Option<[f64; 2]>, rest: f64) -> Measure {
    Box::new(move |x| {
        let (a, b) = match from {
            Some(a) => (a, [x[0], x[1]]),
            None => ([x[0], x[1]], [x[2], x[3]]),
        };
        let d = [b[0] - a[0], b[1] - a[1]];
        let l = d[0].hypot(d[1]);
        let u = [d[0] / l, d[1] / l];
        let block = |i: usize, j: usize| (f64::from(u8::from(i == j)) - u[i] * u[j]) / l;
        if from.is_some() {
            return (l - rest, u.to_vec(), vec![block(0, 0), block(1, 0), block(1, 1)]);
        }
        let sign = |i: usize, j: usize| if (i < 2) == (j < 2) { 1.0 } else { -1.0 };
        let lower = (0..4).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| sign(i, j) * block(i % 2, j % 2));
        (l - rest, vec![-u[0], -u[1], u[0], u[1]], lower.collect())
    })
}

pub fn steps(found: &Equilibrium) -> usize {
    found.history.iter().filter(|step| step.fraction > 0.0).count()
}
