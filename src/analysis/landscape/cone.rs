//! The exact cone of cylinders: the modes whose rest angles, at a given amplitude, are those of an exact cylinder.
//!
//! To first order these are the tensors `k11 k22 = k12^2`; at an amplitude `a` they are off by the order of `a`. The
//! kinematics finds them: fold angles `rho` that close, whose components along the three linear modes make a tensor of
//! norm `a` at a given azimuth,
//!
//! `closure(rho) = 0,  |K| = a,  t . K = 0`,  `K` the point of the tensor, `t` along the ring of the linear cone,
//!
//! by Newton's method. The energy of a patch has its zeros there too, found without the kinematics by
//! [`distance`].

use super::samples::SampleError;
use super::sphere::{self, Direction, curvature};
use super::{HeldSheet, TaylorPaths};
use crate::kinematics::{Closing, Closure, FoldingModes, KinematicsError};
use crate::math::Vec3;
use crate::numerics::DenseMatrix;
use crate::numerics::root::Search;
use crate::sheet::Sheet;
use crate::solver::Implicit;
use nalgebra::DVector;
use std::f64::consts::FRAC_PI_4;

const STEPS: usize = 30;
/// Largest residual of a point of the cone, closure and components over the amplitude.
const CONE_RESIDUAL: f64 = 1e-12;
/// Half the first window about a zero, in radians, and how much smaller the next ones are.
const WINDOW: f64 = 1e-2;
const WINDOWS: usize = 3;
const NARROWER: f64 = 1e-2;

/// The exact cone of a sheet.
pub struct Cone<'a> {
    closure: Closure,
    modes: &'a FoldingModes,
    drawn: Vec<f64>,
    /// Points of the tensors of fold-angle changes, `3 x Ne`.
    tensor: DenseMatrix,
}

impl<'a> Cone<'a> {
    /// Of a sheet with three modes, these edges locked.
    ///
    /// # Errors
    /// [`KinematicsError`] as [`FoldingModes::named`].
    pub fn new(sheet: &Sheet, modes: &'a FoldingModes, locked: &[usize]) -> Result<Self, KinematicsError> {
        modes.named([1.0, 0.0, 0.0])?;
        let closure = Closure::of_cell(sheet)?.with_locked(locked);
        let points: Vec<Vec3> = modes.curvatures.column_iter().map(|k| sphere::point([k[0], k[1], k[2]])).collect();
        let points = DenseMatrix::from_fn(3, points.len(), |row, mode| points[mode][row]);
        let drawn = crate::kinematics::drawn_fold_angles(sheet);
        Ok(Self { closure, modes, drawn, tensor: points * modes.basis.transpose() })
    }

    /// The point of the cone at this amplitude near an azimuth, on the nappe of positive (1) or negative (-1)
    /// curvature, on the unit sphere; `None` where Newton's method does not find it.
    pub fn point(&self, azimuth: f64, nappe: i8, amplitude: f64) -> Option<Vec3> {
        let sign = f64::from(nappe);
        let start = Direction { polar: FRAC_PI_4, azimuth }.point() * sign;
        let along = Vec3::new(0.0, -azimuth.sin(), azimuth.cos());
        let rates = self.modes.named(curvature(&start)).ok()?;
        let angles: Vec<f64> = self.drawn.iter().zip(&rates).map(|(angle, rate)| angle + amplitude * rate).collect();
        let mut closing = Closing::new(&self.closure, self.drawn.clone());
        let start = closing.folding(&angles);
        let tensor = self.tensor.select_columns(self.closure.folding_edges());
        let drawn = closing.folding(&self.drawn);
        let (equations, unknowns) = (closing.equations(), closing.unknowns());
        let point = |x: &[f64]| -> Vec3 {
            (&tensor * DVector::from_fn(unknowns, |k, _| x[k] - drawn[k])).fixed_rows::<3>(0).into_owned()
        };
        let conditions = |x: &[f64]| {
            let (residual, jacobian) = closing.linearized(x);
            let k = point(x);
            let on_ray = [k.norm() / amplitude - 1.0, along.dot(&k) / amplitude];
            let mut all = jacobian.resize_vertically(equations + 2, 0.0);
            all.row_mut(equations).copy_from(&(k.normalize().transpose() * &tensor / amplitude));
            all.row_mut(equations + 1).copy_from(&(along.transpose() * &tensor / amplitude));
            (DVector::from_iterator(equations + 2, residual.iter().copied().chain(on_ray)), all)
        };
        let search = Search { most_steps: STEPS, residual: CONE_RESIDUAL, terms: 0.0 };
        search.root(start, conditions).map(|x| point(&x).normalize())
    }
}

/// The angle between a point of the exact cone and the zero of the energy across the cone next to it: the square root of
/// the energy is taken with opposite signs on both sides, where it is smooth, and its zero found in ever smaller windows.
///
/// # Errors
/// [`SampleError`] where a sample beside the point does not converge.
pub fn distance(held: &HeldSheet, courses: &TaylorPaths, point: &Vec3, amplitude: f64) -> Result<f64, SampleError> {
    let Direction { polar, azimuth } = Direction::of(point);
    let at = |off: f64| Direction { polar: polar + off, azimuth }.point();
    let (mut middle, mut window) = (0.0, WINDOW);
    for narrowed in 0..WINDOWS {
        let root = |off: f64| -> Result<f64, SampleError> {
            Ok(sphere::sample(held, courses, &at(off), amplitude)?.relaxed.state.total().sqrt())
        };
        let (below, above) = (root(middle - window)?, root(middle + window)?);
        if !(below + above > 0.0) {
            // in the widest window there has to be energy on both sides of the zero
            if narrowed == 0 {
                return Err(SampleError::NoEnergy);
            }
            break;
        }
        middle += window * (below - above) / (below + above);
        window *= NARROWER;
    }
    let zero = at(middle);
    Ok(zero.cross(point).norm().atan2(zero.dot(point)))
}
