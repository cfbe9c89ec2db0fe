//! Cost of exact folding per state: closure with its Jacobian, positions, shape, displacement, and a step.
//!
//! ```text
//! cargo bench --bench kinematics
//! ```
//!
//! The state is a folded one of the reference cell (four vertices, twelve edges, one of them held). Every number is the
//! median, over rounds taken by turns, of the mean time of many calls. `step` is one step of 0.02 along the loop
//! through this state: predictor along the tangent, Newton corrector perpendicular to it to 1e-13, shape, and the next
//! tangent, here by Cholesky factors of `J^T J + t t^T` with the old tangent `t`. At last the whole surface of folded
//! states up to a curvature of 2 is computed, with its triangles, at three resolutions.
#![allow(clippy::unwrap_used)]

mod common;

use common::{in_turns, measuring, seconds};
use foldwell::analysis::surface::{SurfaceOptions, surface};
use foldwell::kinematics::{Closure, Displacement, Embedding, Shape};
use foldwell::model::{Assembly, Boundary};
use foldwell::numerics::{DenseMatrix, dense::null_space};
use foldwell::sheet::{Sheet, fold};
use nalgebra::{DVector, DVectorView};
use std::f64::consts::TAU;
use std::hint::black_box;

fn main() {
    let (rounds, calls) = if measuring() { (21, 5_000) } else { (1, 10) };
    let sheet = fold::parse(include_str!("../meshes/open-star.fold"), "open-star.fold").unwrap();
    let (closure, embedding) = (Closure::of_cell(&sheet).unwrap().with_locked(&[0]), Embedding::new(&sheet).unwrap());
    let start = Tracer::new(&closure, &embedding);
    let (angles, rates) = (start.angles.clone(), vec![1.0; sheet.edges.len()]);
    let (mut residual, mut jacobian) = (start.residual.clone(), start.jacobian.clone());
    let time =
        |work: &mut dyn FnMut(&[f64])| seconds(|| (0..calls).for_each(|_| work(black_box(&angles)))) / f64::from(calls);
    let residual_alone = &mut vec![0.0; residual.len()];
    let times = in_turns(
        rounds,
        &mut [
            &mut || time(&mut |angles| closure.residual_into(angles, residual_alone)),
            &mut || time(&mut |angles| closure.linearize_into(angles, &mut residual, &mut jacobian)),
            &mut || time(&mut |angles| drop(black_box(embedding.place(angles)))),
            &mut || time(&mut |angles| drop(black_box(Shape::at(&embedding, angles).unwrap()))),
            &mut || time(&mut |angles| drop(black_box(Displacement::new(&embedding, angles, &rates)))),
            &mut || {
                let mut tracer = start.clone();
                time(&mut |_| tracer.step(&closure, &embedding))
            },
        ],
    );
    for (name, time) in ["closure", "with Jacobian", "placement", "shape", "displacement", "step"].iter().zip(times) {
        println!("{name:16} {:8.3} us", 1e6 * time);
    }
    cover(&sheet);
}

/// Covers the surface of the cell up to a curvature of 2, or of 0.1 if nothing is measured.
fn cover(sheet: &Sheet) {
    let cell = Assembly::without_terms(sheet.clone(), [1, 1], Boundary::Screw).unwrap();
    let resolutions = if measuring() { &[16, 24, 32][..] } else { &[16] };
    for &resolution in resolutions {
        let max_curvature = if measuring() { 2.0 } else { 0.1 };
        let radius = TAU / f64::from(resolution);
        let options = SurfaceOptions { radius, tolerance: 3e-14, max_curvature, max_points: 300_000 };
        let mut found = None;
        let time = seconds(|| found = Some(surface(&cell, &options, &mut |_| true).unwrap()));
        let points = found.unwrap().points.len();
        let each = 1e6 * time / points as f64;
        println!(
            "surface {resolution:8} {time:8.3} s, {points} points: {each:.1} us each, 20,000 in {:.2} s",
            0.02 * each
        );
    }
}

/// A state on a loop, with the tangent there.
#[derive(Clone)]
struct Tracer {
    angles: Vec<f64>,
    tangent: DVector<f64>,
    residual: Vec<f64>,
    jacobian: DenseMatrix,
}

impl Tracer {
    /// Starts at the drawn state along a linear mode; after some steps the state is on a loop.
    fn new(closure: &Closure, embedding: &Embedding) -> Self {
        let angles = embedding.drawn_angles().to_vec();
        let jacobian = closure.jacobian(&angles);
        let tangent = null_space(&jacobian).unwrap().basis.column(0).into_owned();
        let residual = vec![0.0; jacobian.nrows()];
        let mut tracer = Self { angles, tangent, residual, jacobian };
        (0..50).for_each(|_| tracer.step(closure, embedding));
        tracer
    }

    fn step(&mut self, closure: &Closure, embedding: &Embedding) {
        self.move_by(closure, &(0.02 * &self.tangent));
        loop {
            closure.linearize_into(&self.angles, &mut self.residual, &mut self.jacobian);
            let residual = DVectorView::from_slice(&self.residual, self.residual.len());
            let normal = self.jacobian.tr_mul(&self.jacobian) + &self.tangent * self.tangent.transpose();
            let factor = normal.cholesky().unwrap();
            if residual.amax() <= 1e-13 {
                self.tangent = factor.solve(&self.tangent).normalize();
                break;
            }
            let step = -factor.solve(&self.jacobian.tr_mul(&residual));
            self.move_by(closure, &step);
        }
        black_box(Shape::at(embedding, &self.angles).unwrap());
    }

    fn move_by(&mut self, closure: &Closure, step: &DVector<f64>) {
        closure.folding_edges().iter().zip(step.iter()).for_each(|(&edge, step)| self.angles[edge] += step);
    }
}
