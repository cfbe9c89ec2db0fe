//! The closure of a cell as a surface.

use super::covered::SurfacePoint;
use crate::kinematics::{Closing, Closure, Embedding, KinematicsError, SecondOrder, Shape, SpatiallyPeriodic};
use crate::numerics::DenseMatrix;
use crate::solver::Implicit;
use crate::solver::atlas::Surface;
use nalgebra::DVector;
use std::f64::consts::TAU;

/// Fold angles that close, up to a curvature. The unknowns are the angles of the folding edges.
pub(super) struct SurfaceClosure<'a> {
    closure: &'a Closure,
    closing: Closing<'a>,
    pub embedding: &'a Embedding,
    /// Angles of the folding edges at the state from which folding starts.
    pub drawn: Vec<f64>,
    max_curvature: f64,
    /// Whether two surfaces cross at the state from which folding starts.
    pub crossing: bool,
}

impl<'a> SurfaceClosure<'a> {
    pub(crate) fn new(closure: &'a Closure, embedding: &'a Embedding, max_curvature: f64) -> Self {
        Self::at(closure, embedding, (embedding.drawn_angles(), max_curvature))
    }

    /// The same cell, at another state than the drawn one.
    pub(crate) fn at(closure: &'a Closure, embedding: &'a Embedding, (angles, max_curvature): (&[f64], f64)) -> Self {
        let closing = Closing::new(closure, angles.to_vec());
        let drawn = closing.folding(angles);
        Self { closure, closing, embedding, drawn, max_curvature, crossing: false }
    }

    /// The same surface with folding that starts from a closed state on it, and what second order says of that.
    pub(crate) fn leaving(&self, x: &[f64]) -> Result<(Self, SecondOrder), KinematicsError> {
        let angles = self.all(x);
        let second_order = SecondOrder::new(self.closure, &angles)?;
        Ok((Self::at(self.closure, self.embedding, (&angles, self.max_curvature)), second_order))
    }

    /// The entries of the folding edges.
    pub(crate) fn folding(&self, all: &[f64]) -> Vec<f64> {
        self.closing.folding(all)
    }

    /// The angles of all edges.
    pub(crate) fn all(&self, x: &[f64]) -> Vec<f64> {
        self.closing.angles(x)
    }

    /// The cylinder at the angles of the folding edges.
    pub(crate) fn shape(&self, x: &[f64]) -> Result<Shape, KinematicsError> {
        Shape::at(self.embedding, &self.all(x))
    }

    /// The state at the angles of the folding edges, on this branch, and the radius of its chart.
    pub(crate) fn point(
        &self,
        x: &[f64],
        branch: (usize, i8),
        [residual, radius]: [f64; 2],
    ) -> Result<SurfacePoint, KinematicsError> {
        Ok(SurfacePoint { branch, angles: self.all(x), shape: self.shape(x)?, residual, radius })
    }

    /// The largest component of the closure residual.
    pub(crate) fn residual(&self, x: &[f64]) -> f64 {
        self.closure.residual(&self.all(x)).amax()
    }

    /// Closure and the rotation vectors of both lattice motions, which vanish at a spatially periodic state; and the
    /// Jacobian, right to first order in those vectors.
    pub(crate) fn periodic(&self, x: &[f64]) -> (DVector<f64>, DenseMatrix) {
        let periodic = SpatiallyPeriodic(self.embedding);
        Closing::new(self.closure, self.all(x)).keeping(Some(&periodic)).linearized(x)
    }
}

impl Implicit for SurfaceClosure<'_> {
    fn unknowns(&self) -> usize {
        self.closing.unknowns()
    }

    fn equations(&self) -> usize {
        self.closing.equations()
    }

    fn linearize(&mut self, x: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix) {
        self.closing.linearize(x, residual, jacobian);
    }
}

impl Surface for SurfaceClosure<'_> {
    fn period(&self, _unknown: usize) -> Option<f64> {
        Some(TAU)
    }

    /// The magnitude of the curvature less the largest one; infinite where vertex 0 is on the axis.
    fn limit(&mut self, x: &[f64]) -> f64 {
        let curvature = self.shape(x).map_or(f64::NAN, |shape| shape.curvature.abs());
        if curvature.is_nan() { f64::INFINITY } else { curvature - self.max_curvature }
    }

    fn crosses(&self) -> bool {
        self.crossing
    }
}
