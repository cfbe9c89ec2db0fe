//! The shape of a periodic sheet at some fold angles: positions, screw, signed curvature, strain.
//!
//! The length of the vector `k` from vertex 0 towards the axis (see [`Screw`]) is the absolute value of the curvature.
//! Along a trajectory or over a surface the signed curvature is continuous: the sign changes only where `k` passes
//! through zero. There `k` reverses its direction relative to the first face at vertex 0, which the embedding holds
//! fixed, so that a state takes its sign from a nearby one by `k . k_last` ([`Shape::continue_from`]).
//!
//! A state that is not connected to another by a known path has the sign of `h1 theta2 - h2 theta1`, with the rotation
//! angles and the translations of the two lattice vectors along one direction of the axis (either direction gives the
//! same sign), times -1 if the drawn lattice vectors turn clockwise seen from the side of the face normals. Where
//! folding leaves a spatially periodic state both rules agree, and the curvature is positive if the axis is on the side
//! of the face normals.

use super::KinematicsError;
use super::embedding::{Embedding, Placement};
use super::metric::LatticeFrame;
use super::motion::Moving;
use super::screw::Screw;
use crate::math::Vec3;
use std::f64::consts::TAU;

/// Rotation angle in radians below which the sheet counts as having no axis: the error of the axis direction is the
/// rounding error divided by the angle.
const NO_TURN: f64 = 1e-8;
/// Largest number of times that a path between two states is halved.
const HALVINGS: usize = 10;
/// Largest incompatibility of an intermediate state, relative to its curvature times the length of the cell.
const OPEN: f64 = 0.1;

/// A periodic sheet at some fold angles, in the frame of the [embedding](super::embedding).
#[derive(Clone, Debug)]
pub struct Shape {
    /// Positions of the vertices of cell (0, 0).
    pub positions: Vec<Vec3>,
    /// Axis, angles and chords, from which the motion to any cell follows.
    pub screw: Screw,
    /// Rotation angles from a cell to the next about the common axis, in radians; the axis is directed so that the
    /// larger one is positive.
    pub theta: [f64; 2],
    /// Signed curvature of the cylinder of vertex 0: the inverse of its distance from the axis, with the sign that the
    /// [module](self) defines. NaN if vertex 0 is on the axis.
    pub curvature: f64,
    /// Strain `[strain11, strain22, strain12]` of the chords from vertex 0 relative to the drawn lattice.
    pub strain: [f64; 3],
    /// The error of closure of the angles; see [`Placement::compatibility`].
    pub compatibility: f64,
}

impl Shape {
    /// Computes the shape at the fold angles of every edge, in radians, valley positive.
    ///
    /// Angles that do not close are accepted, but their shape has no clear meaning;
    /// [`compatibility`](Self::compatibility) holds the errors.
    ///
    /// # Errors
    /// [`KinematicsError`] for a finite sheet.
    ///
    /// # Panics
    /// If the length of `angles` is not the number of edges.
    pub fn at(embedding: &Embedding, angles: &[f64]) -> Result<Self, KinematicsError> {
        Self::of(embedding, embedding.place(angles))
    }

    /// Computes the shape of a placement.
    ///
    /// # Errors
    /// [`KinematicsError`] for a finite sheet.
    pub fn of(embedding: &Embedding, placement: Placement) -> Result<Self, KinematicsError> {
        let (Some(motions), Some(drawn)) = (placement.lattice, &embedding.lattice) else {
            return Err(KinematicsError::NoLattice);
        };
        let screw = Screw::new(&motions);
        let curvature = signed_curvature(embedding, &screw);
        let strain = LatticeFrame::new(drawn).strain(&screw.chords);
        let Placement { positions, compatibility, .. } = placement;
        Ok(Self { positions, screw, theta: screw.theta, curvature, strain, compatibility })
    }

    /// Whether the rotations of the lattice are so large that curvature and axis are more than rounding errors.
    pub(crate) fn turns(&self) -> bool {
        self.theta.iter().any(|theta| theta.abs() >= NO_TURN)
    }

    /// Whether the angles close well enough for the axis to be defined. Near a state without curvature, angles halfway
    /// between two states have closure errors that are larger than the effect of the curvature.
    fn closes(&self) -> bool {
        self.compatibility <= OPEN * self.screw.towards_axis().norm() * self.cell()
    }

    /// Returns the length of the longer chord from vertex 0 to its copies.
    fn cell(&self) -> f64 {
        self.screw.chords.iter().map(|chord| chord.norm()).fold(0.0, f64::max)
    }

    /// Sets the sign of the curvature to the one after a small step from `last`. Does nothing if one of the two states
    /// has no rotation.
    ///
    /// If the axis passes close by vertex 0, `k` changes its side as well, but there the curvature is large and keeps
    /// its sign.
    pub fn continue_from(&mut self, last: &Self) {
        let (before, now) = (last.screw.towards_axis(), self.screw.towards_axis());
        if !(self.turns() && last.turns() && self.curvature.is_finite() && last.curvature.is_finite()) {
            return;
        }
        let passes_zero = before.dot(&now) < 0.0 && before.norm().min(now.norm()) * self.cell() < 1.0;
        let sign = if passes_zero { -last.curvature.signum() } else { last.curvature.signum() };
        self.curvature = self.curvature.abs() * sign;
    }

    /// Does the same for a longer path, given the fold angles of `last` and of this shape. Steps are halved until `k`
    /// turns by at most a sixth of a turn in each.
    pub(crate) fn continue_over(&mut self, embedding: &Embedding, last: &Self, angles: [&[f64]; 2]) {
        self.continue_halving(embedding, last, angles, HALVINGS);
    }

    fn continue_halving(&mut self, embedding: &Embedding, last: &Self, [from, to]: [&[f64]; 2], left: usize) {
        let (before, now) = (last.screw.towards_axis(), self.screw.towards_axis());
        let turned = before.dot(&now) < 0.5 * before.norm() * now.norm();
        if left > 0 && turned && self.turns() && last.turns() {
            let nearest = |(a, b): (&f64, &f64)| a + 0.5 * (b - a - TAU * ((b - a) / TAU).round());
            let between: Vec<f64> = from.iter().zip(to).map(nearest).collect();
            let middle = Self::at(embedding, &between).ok().filter(|middle| middle.turns() && middle.closes());
            if let Some(mut middle) = middle {
                middle.continue_halving(embedding, last, [from, &between], left - 1);
                return self.continue_halving(embedding, &middle, [&between, to], left - 1);
            }
        }
        self.continue_from(last);
    }

    /// Returns the rate of the strain, from the lattice motions with their rates; it needs no rotation.
    pub(crate) fn strain_rate(&self, embedding: &Embedding, lattice: &[Moving; 2]) -> Option<[f64; 3]> {
        let chords = lattice.map(|moving| moving.twist.at(&moving.motion.translation));
        Some(LatticeFrame::new(embedding.lattice.as_ref()?).strain_rate(&self.screw.chords, &chords))
    }

    /// Returns the rate of the signed curvature, from the lattice motions with their rates; `None` if there is no
    /// rotation.
    pub(crate) fn curvature_rate(&self, lattice: &[Moving; 2]) -> Option<f64> {
        let towards = self.screw.rate(lattice)?.towards_axis;
        Some(self.screw.towards_axis().dot(&towards) / self.curvature)
    }
}

/// Returns the curvature of a state that is not connected to another by a known path.
fn signed_curvature(embedding: &Embedding, screw: &Screw) -> f64 {
    let ([h1, h2], [theta1, theta2]) = (screw.rise(), screw.theta);
    let side = embedding.lattice.map_or(1.0, |[l1, l2]| l1.cross(&l2).dot(&embedding.drawn_area));
    screw.towards_axis().norm().copysign((h1 * theta2 - h2 * theta1) * side)
}

#[cfg(test)]
mod tests {
    use super::super::test_sheets::*;
    use super::super::{Closure, Displacement};
    use super::*;
    use crate::numerics::DenseMatrix;
    use crate::numerics::dense::null_space;
    use crate::numerics::derivatives::{TOLERANCE, check_jacobian};
    use crate::sheet::Sheet;

    fn close(found: &[f64], expected: &[f64], tolerance: f64) -> bool {
        found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= tolerance)
    }

    /// Claim: curvature, rotation angles and strain are those that an independent program found, in size, sign and
    /// order; the mirror image has the same strain and the opposite curvature. Tolerance 1e-9, that of the project; the
    /// states of that program close to 1e-12. Mirrored: rounding.
    #[test]
    fn stored_states_of_open_star() {
        let sheet = open_star();
        let embedding = Embedding::new(&sheet).unwrap();
        let states = open_star_reference().states(&sheet);
        assert_eq!(states.len(), 4);
        for (angles, kappa, theta, strain) in states {
            let shape = Shape::at(&embedding, &angles).unwrap();
            assert!((shape.curvature - kappa).abs() <= 1e-9, "{} for {kappa}", shape.curvature);
            assert!(close(&shape.theta, &theta, 1e-9) && close(&shape.strain, &strain, 1e-9), "{shape:?}");
            let mirrored: Vec<f64> = angles.iter().map(|angle| -angle).collect();
            let mirrored = Shape::at(&embedding, &mirrored).unwrap();
            assert!((mirrored.curvature + kappa).abs() <= 1e-9 && close(&mirrored.strain, &strain, 1e-9));
        }
    }

    /// Returns cylinders, each with the rates of a combination of its two linear motions.
    fn moving_cylinders(sheet: &Sheet) -> Vec<(Vec<f64>, Vec<f64>)> {
        let closure = Closure::of_cell(sheet).unwrap();
        let states = open_star_reference().cylinders(sheet).into_iter().map(|angles| closed(&closure, angles));
        let moving = states.map(|angles| {
            let basis = null_space(&closure.jacobian(&angles)).unwrap().basis;
            assert_eq!(basis.ncols(), 2);
            let rates = (basis.column(0) - 0.7 * basis.column(1)).as_slice().to_vec();
            (angles, rates)
        });
        moving.collect()
    }

    /// Claim: rates of curvature, angles, axis, chords and strain are the derivatives along exact motions: angles moved
    /// along the rates and closed again.
    #[test]
    fn rates_are_derivatives() {
        let sheet = open_star();
        let (embedding, closure) = (Embedding::new(&sheet).unwrap(), Closure::of_cell(&sheet).unwrap());
        for (angles, rates) in moving_cylinders(&sheet) {
            let at = |t: &[f64]| {
                let moved = angles.iter().zip(&rates).map(|(angle, rate)| angle + t[0] * rate).collect();
                let shape = Shape::at(&embedding, &closed(&closure, moved)).unwrap();
                let Screw { axis, chords, .. } = shape.screw;
                let vectors = [axis.unwrap(), chords[0], chords[1], shape.screw.towards_axis()];
                let numbers = [&[shape.curvature], &shape.theta[..], &shape.strain[..]].concat();
                numbers.into_iter().chain(vectors.iter().flat_map(|v| v.iter().copied())).collect::<Vec<_>>()
            };
            let lattice = Displacement::new(&embedding, &angles, &rates).lattice.unwrap();
            let shape = Shape::at(&embedding, &angles).unwrap();
            let (screw, curvature) = (shape.screw.rate(&lattice).unwrap(), shape.curvature_rate(&lattice).unwrap());
            let strain = shape.strain_rate(&embedding, &lattice).unwrap();
            let vectors = [screw.axis, screw.chords[0], screw.chords[1], screw.towards_axis];
            let numbers = [&[curvature], &screw.theta[..], &strain[..]].concat();
            let found: Vec<f64> = numbers.into_iter().chain(vectors.iter().flat_map(|v| v.iter().copied())).collect();
            let found = DenseMatrix::from_vec(found.len(), 1, found);
            check_jacobian(at, &[0.0], &found, TOLERANCE).unwrap();
        }
    }

    /// Claim: the axis itself rotates as the paper's last formula on displacements says, `(1 - S) ds = W x s` across
    /// the axis, for both lattice rotations. Tolerance: rounding divided by the rotation angle.
    #[test]
    fn axis_turns_as_published() {
        let sheet = open_star();
        let embedding = Embedding::new(&sheet).unwrap();
        for (angles, rates) in moving_cylinders(&sheet) {
            let lattice = Displacement::new(&embedding, &angles, &rates).lattice.unwrap();
            let shape = Shape::at(&embedding, &angles).unwrap();
            let (s, rate) = (shape.screw.axis.unwrap(), shape.screw.rate(&lattice).unwrap().axis);
            assert!(rate.norm() > 1e-2 && rate.dot(&s).abs() <= 1e-13);
            for moving in lattice {
                let left = rate - moving.motion.rotation * rate;
                assert!((left - moving.twist.angular.cross(&s)).norm() <= 1e-12 * rate.norm());
            }
        }
    }

    /// Claim: through the spatially periodic state the curvature passes linearly through zero, at the rate given by the
    /// curvature tensor of the ray (its trace, since the tensor has rank one), and the axis there is along the line
    /// that the tensor does not bend. Tolerance 1e-5: the error of central differences of step 1e-3 is its square times
    /// third derivatives.
    #[test]
    fn curvature_goes_through_zero() {
        let sheet = open_star();
        let (embedding, closure) = (Embedding::new(&sheet).unwrap(), Closure::of_cell(&sheet).unwrap());
        let modes = super::super::folding_modes(&sheet).unwrap();
        for (ray, _) in open_star_reference().rays(&sheet) {
            let at = |t: f64| {
                let moved = embedding.drawn_angles().iter().zip(&ray).map(|(angle, rate)| angle + t * rate).collect();
                Shape::at(&embedding, &closed(&closure, moved)).unwrap()
            };
            let amplitudes = modes.basis.transpose() * nalgebra::DVector::from_vec(ray.clone());
            let k = &modes.curvatures * amplitudes;
            assert_eq!(at(0.0).curvature.abs(), 0.0);
            let [before, after] = [-1e-3, 1e-3].map(at);
            let rate = (after.curvature - before.curvature) / 2e-3;
            assert!((rate - (k[0] + k[1])).abs() <= 1e-5, "{rate} for {}", k[0] + k[1]);
            let [theta1, theta2] = after.theta;
            let along = LatticeFrame::new(&sheet.lattice.unwrap()).vectors * nalgebra::Vector2::new(-theta2, theta1);
            let [x, y]: [f64; 2] = along.normalize().into();
            let bent = (k[0] * x + k[2] * y).hypot(k[2] * x + k[1] * y);
            assert!(bent <= 1e-2 * rate.abs(), "{bent}");
        }
    }

    /// Claim: a finite sheet is refused.
    #[test]
    fn finite_sheets_are_refused() {
        let embedding = Embedding::new(&finite_grid(2, 2, 0.3)).unwrap();
        assert_eq!(Shape::at(&embedding, embedding.drawn_angles()).unwrap_err(), KinematicsError::NoLattice);
    }
}
