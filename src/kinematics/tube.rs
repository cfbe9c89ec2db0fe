//! Tubes: screw-periodic sheets that close on themselves.
//!
//! A sheet rolls up to a tube with the seam `(n1, n2)` if cell `(n1, n2)` coincides with cell (0, 0):
//!
//! `n1 theta1 + n2 theta2 = 2 pi` and `n1 h1 + n2 h2 = 0`,
//!
//! with the rotation angles `theta_a` from cell to cell about the common axis and the translations `h_a` along it (J.
//! McInerney, B. G. Chen, L. Theran, C. D. Santangelo and D. Z. Rocklin, PNAS 117, 30252 (2020), who say that the
//! ratios are rational, which alone does not close the tube). Each condition removes one of the two motions that a
//! folded sheet has. With the first condition alone the seam slips along itself (F. Feng, P. Plucinsky and R. D. James,
//! Phys. Rev. E 101, 033002 (2020)).
//!
//! In terms of the rotation vectors `w_a` of the lattice rotations and the chords `l_a`, with `W = n1 w1 + n2 w2`,
//! `l = n1 l1 + n2 l2` and the length `L` of the drawn seam, the conditions are `|W| = 2 pi` and
//! `W . l / (2 pi L) = 0`. The second condition is smooth where there is no rotation. A tube is therefore found by
//! rolling up the periodic sheet with the second condition satisfied until the first one is met.
//!
//! Where a lattice rotation passes `pi`, its rotation vector reverses and `W` changes by a multiple of `2 pi`. As
//! equations that are [kept](Tube::keeping) the conditions are therefore stated with the longer of the two rotation
//! vectors `w`, which has the direction of the axis: `W . w / |w| = 0` up to multiples of `2 pi`, and
//! `w . l / (2 pi L) = 0`.

use super::folding_modes::with_zero_rates;
use super::motion::Moving;
use super::{AngleConditions, Closing, Closure, Displacement, Embedding, KinematicsError, folding_modes};
use crate::math::{Vec3, rotation};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::null_space;
use crate::numerics::root::Search;
use crate::sheet::{Seam, Sheet};
use crate::solver::continuation::{CurveOptions, CurvePoint, End, follow};
use nalgebra::DVector;
use std::f64::consts::TAU;

/// Tolerance of the closure residual and of the defects of a tube.
const CLOSURE_RESIDUAL: f64 = 4e-15;
/// Largest number of Newton steps from the end of the rolling to a tube.
const STEPS: usize = 10;
/// Largest number of points of a rolling.
const MOST_POINTS: usize = 2000;

/// One of the two conditions on a tube.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// The seam turns by `2 pi`.
    Turn,
    /// The seam has no translation along the axis.
    Rise,
}

/// Both conditions, in the order of their numbers.
pub const BOTH: [Condition; 2] = [Condition::Turn, Condition::Rise];

/// A periodic sheet that is to close along a seam; every crease folds.
#[derive(Clone, Debug)]
pub struct Tube<'a> {
    sheet: &'a Sheet,
    closure: Closure,
    embedding: Embedding,
    pub(crate) seam: Seam,
    /// Length of the drawn seam.
    length: f64,
    /// Axis of the drawing, about which the drawn seam turns by a positive angle; `None` for a sheet with lattice
    /// vectors.
    axis: Option<Vec3>,
}

/// Rotation vector and chord of the seam, `W` and `l`.
#[derive(Clone, Copy)]
struct SeamMotion {
    turn: Vec3,
    chord: Vec3,
}

impl<'a> Tube<'a> {
    /// Plans a tube in which cell `seam` coincides with cell (0, 0), of a periodic sheet or of one that is drawn rolled
    /// up. The drawn seam of the latter is measured along the chords from cell to cell.
    ///
    /// # Errors
    /// [`KinematicsError`] for a finite sheet, for one whose faces are not connected, and for the seam `[0, 0]`.
    pub fn new(sheet: &'a Sheet, seam: [i32; 2]) -> Result<Self, KinematicsError> {
        let chords = sheet.chords().ok_or(KinematicsError::NoLattice)?;
        let number = Seam::new(seam).ok_or(KinematicsError::NoSeam)?;
        let steps = [0, 1].map(|a| chords[a] * f64::from(seam[a]));
        let axis = sheet.screws.map(|screws| Vec3::z() * 1f64.copysign(screws.turn_of(seam)));
        let length = if axis.is_some() { steps[0].norm() + steps[1].norm() } else { (steps[0] + steps[1]).norm() };
        let (closure, embedding) = (Closure::of_cell(sheet)?, Embedding::new(sheet)?);
        Ok(Self { sheet, closure, embedding, seam: number, length, axis })
    }

    /// Returns the errors of the two conditions at fold angles, given with one number per edge in radians: `|W| - 2 pi`
    /// in radians and `W . l / (2 pi L)`, which is the rise of the seam relative to its drawn length if it turns by
    /// `2 pi`.
    ///
    /// For angles that do not close, the motions are those along the tree of the [embedding](super::embedding). Lattice
    /// rotations count as those by at most `pi`.
    /// # Panics
    /// If the length of `angles` is not the number of edges.
    pub fn defects(&self, angles: &[f64]) -> [f64; 2] {
        let still = vec![0.0; self.embedding.edges()];
        let SeamMotion { turn, chord } = self.seam_of(&Displacement::new(&self.embedding, angles, &still).lattice).0;
        [turn.norm() - TAU, turn.dot(&chord) / (TAU * self.length)]
    }

    /// Returns the closure Jacobian followed by a row for each condition in `kept`: its null vectors are the motions
    /// through screw-periodic sheets that satisfy these conditions.
    pub fn jacobian(&self, angles: &[f64], kept: &[Condition]) -> DenseMatrix {
        self.equations(angles, kept).1
    }

    /// Returns closure and the conditions in `kept` as equations: what vanishes on a tube, and its derivative.
    fn equations(&self, angles: &[f64], kept: &[Condition]) -> (Vec<f64>, DenseMatrix) {
        let mut values: Vec<f64> = self.closure.residual(angles).iter().copied().collect();
        let mut jacobian = self.closure.jacobian(angles);
        for &condition in kept {
            let (row, mut value, mut rates) = (values.len(), [0.0], DenseMatrix::zeros(1, angles.len()));
            self.keeping(condition).linearize(angles, &mut value, &mut rates);
            values.extend(value);
            jacobian = jacobian.insert_row(row, 0.0);
            jacobian.row_mut(row).copy_from(&rates);
        }
        (values, jacobian)
    }

    /// Computes the fold angles of a tube, closed up to rounding: the drawn sheet rolled up about the line across the
    /// seam, towards its face normals (`inwards`) or away from them.
    ///
    /// The drawn sheet must be spatially periodic and not flat. The tube may intersect itself.
    ///
    /// # Errors
    /// [`KinematicsError::NoTube`] if the sheet cannot be rolled up so far, and as
    /// [`folding_modes()`](super::folding_modes()) and [`FoldingModes::named`](super::FoldingModes::named).
    pub fn rolled_up(&self, inwards: bool) -> Result<Vec<f64>, KinematicsError> {
        let tensor = self.bending(if inwards { 1.0 } else { -1.0 })?;
        let ray = folding_modes(self.sheet)?.named(tensor)?;
        let size = ray.iter().map(|rate| rate * rate).sum::<f64>().sqrt();
        let ray = ray.iter().map(|rate| rate / size).collect();
        let options = CurveOptions { steps: MOST_POINTS, period: Some(TAU), stops: vec![0], ..CurveOptions::default() };
        let start = self.embedding.drawn_angles().to_vec();
        let kept = self.keeping(Condition::Rise);
        let mut curve = Closing::new(&self.closure, start.clone()).keeping(Some(&kept));
        let turned = |point: &CurvePoint| self.defects(&point.x)[Condition::Turn as usize];
        let mut stop = |_: &mut _, point: &CurvePoint, out: &mut Vec<f64>| out.push(turned(point));
        let found = follow(&mut curve, start, ray, &options, &mut stop, &mut |_| true);
        let rolled = found.points.last().filter(|_| matches!(found.end, End::Stopped { .. }));
        let turns = found.points.iter().map(|point| self.defects(&point.x)[0] + TAU);
        let missed = || KinematicsError::NoTube { seam: self.seam.lattice_vector(), turn: turns.fold(0.0, f64::max) };
        self.closed(&rolled.ok_or_else(missed)?.x, &BOTH, &[])
    }

    /// Returns the motions of a tube with these fold angles that satisfy the conditions in `kept` and do not move the
    /// edges in `locked`: an orthonormal column for each, with the rates of the fold angles of all edges.
    ///
    /// # Errors
    /// [`KinematicsError::Decomposition`] if their number is not clear.
    pub fn motions(
        &self,
        angles: &[f64],
        kept: &[Condition],
        locked: &[usize],
    ) -> Result<DenseMatrix, KinematicsError> {
        let moving: Vec<usize> = (0..angles.len()).filter(|edge| !locked.contains(edge)).collect();
        let basis = null_space(&self.jacobian(angles, kept).select_columns(&moving))?.basis;
        Ok(with_zero_rates(angles.len(), &moving, &basis))
    }

    /// Returns a motion that keeps a condition in the direction in which the quantity of the other one grows: the rise
    /// of the seam, or its turn. Both are those along the axis about which the seam turns by a positive angle.
    pub(crate) fn growing(&self, angles: &[f64], kept: Condition, motion: &[f64]) -> Vec<f64> {
        let mut rates = DenseMatrix::zeros(1, angles.len());
        self.keeping(BOTH[1 - kept as usize]).linearize(angles, &mut [0.0], &mut rates);
        let growth: f64 = rates.iter().zip(motion).map(|(a, b)| a * b).sum();
        let lattice = Displacement::new(&self.embedding, angles, motion).lattice;
        let positive = self.axis.unwrap_or_else(|| self.seam_of(&lattice).0.turn);
        let side = longer_turn(&lattice).0.dot(&positive);
        motion.iter().map(|rate| rate * 1f64.copysign(growth * side)).collect()
    }

    /// Returns one of the conditions as an equation.
    pub fn keeping(&self, kept: Condition) -> TubeCondition<'_, 'a> {
        TubeCondition { tube: self, kept }
    }

    /// Returns the curvature tensor `[k11, k22, k12]` of size 1 that bends along the seam and not across it.
    fn bending(&self, sign: f64) -> Result<[f64; 3], KinematicsError> {
        let lattice = self.sheet.lattice.ok_or(KinematicsError::NoLattice)?;
        let frame = super::metric::LatticeFrame::new(&lattice);
        let along = frame.vectors * nalgebra::Vector2::from(self.seam.lattice_vector().map(f64::from));
        let [x, y]: [f64; 2] = along.normalize().into();
        Ok([sign * x * x, sign * y * y, sign * x * y])
    }

    /// Solves closure and the conditions in `kept` by Newton's method, with the edges in `locked` at the angles of
    /// `start`.
    pub(crate) fn closed(
        &self,
        start: &[f64],
        kept: &[Condition],
        locked: &[usize],
    ) -> Result<Vec<f64>, KinematicsError> {
        let moving: Vec<usize> = (0..start.len()).filter(|edge| !locked.contains(edge)).collect();
        let mut angles = start.to_vec();
        let search = Search { most_steps: STEPS, residual: CLOSURE_RESIDUAL, terms: 0.0 };
        let (_, residual) = search.from(moving.iter().map(|&edge| start[edge]).collect(), |x| {
            moving.iter().zip(x).for_each(|(&edge, angle)| angles[edge] = *angle);
            let (defects, jacobian) = self.equations(&angles, kept);
            (DVector::from_vec(defects), jacobian.select_columns(&moving))
        })?;
        if residual <= CLOSURE_RESIDUAL { Ok(angles) } else { Err(KinematicsError::NotClosed { residual }) }
    }

    /// Returns the seam and its rate, from the lattice motions.
    fn seam_of(&self, lattice: &Option<[Moving; 2]>) -> (SeamMotion, SeamMotion) {
        let zero = SeamMotion { turn: Vec3::zeros(), chord: Vec3::zeros() };
        let moving = lattice.iter().flatten().zip(self.seam.lattice_vector());
        moving.fold((zero, zero), |(at, rate), (one, n)| {
            let (n, (turn, turning), chord) = (f64::from(n), turning(one), one.motion.translation);
            let at = SeamMotion { turn: at.turn + n * turn, chord: at.chord + n * chord };
            (at, SeamMotion { turn: rate.turn + n * turning, chord: rate.chord + n * one.twist.at(&chord) })
        })
    }
}

/// One of the conditions on a tube as an equation on its fold angles.
///
/// Both are stated with the longer of the two rotation vectors, and hold where its direction or the whole turns of the
/// seam change.
#[derive(Clone, Copy, Debug)]
pub struct TubeCondition<'t, 'a> {
    tube: &'t Tube<'a>,
    kept: Condition,
}

impl TubeCondition<'_, '_> {
    /// Returns the value of the equation, and its rate with that of the lattice motions.
    fn value(&self, lattice: &Option<[Moving; 2]>) -> [f64; 2] {
        let (seam, seam_rate) = self.tube.seam_of(lattice);
        let (larger, rate) = longer_turn(lattice);
        let length = TAU * self.tube.length;
        let Condition::Turn = self.kept else {
            let rise_rate = rate.dot(&seam.chord) + larger.dot(&seam_rate.chord);
            return [larger.dot(&seam.chord) / length, rise_rate / length];
        };
        let axis = larger.normalize();
        let axis_rate = (rate - axis * axis.dot(&rate)) / larger.norm();
        let turn = axis.dot(&seam.turn);
        [turn - TAU * (turn / TAU).round(), axis_rate.dot(&seam.turn) + axis.dot(&seam_rate.turn)]
    }
}

impl AngleConditions for TubeCondition<'_, '_> {
    fn count(&self) -> usize {
        1
    }

    fn linearize(&self, angles: &[f64], values: &mut [f64], rates: &mut DenseMatrix) {
        let visit = |edge, lattice: &_| [values[0], rates[(0, edge)]] = self.value(lattice);
        Displacement::for_each_edge(&self.tube.embedding, angles, visit);
    }
}

/// Returns the rotation vector of a lattice motion, and its rate.
fn turning(moving: &Moving) -> (Vec3, Vec3) {
    let turn = rotation::log(&moving.motion.rotation);
    (turn, rotation::inverse_left_jacobian(&turn) * moving.twist.angular)
}

/// Returns the longer of the two rotation vectors of the lattice motions, and its rate.
fn longer_turn(lattice: &Option<[Moving; 2]>) -> (Vec3, Vec3) {
    let turns = lattice.iter().flatten().map(turning);
    turns.max_by(|a, b| a.0.norm().total_cmp(&b.0.norm())).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::super::test_sheets::*;
    use super::*;
    use crate::numerics::derivatives::{TOLERANCE, check_jacobian};

    /// Claim: the Jacobian of closure and both conditions is their derivative, edge by edge, on cylinders, on tubes, on
    /// a tube that is drawn rolled up, and off the closed states, where the rotations do not commute; on tubes all
    /// equations hold to rounding.
    #[test]
    fn conditions_are_equations() {
        let (sheet, drawn_tube) = (open_star(), kresling_cell());
        let (star, kresling) = (Tube::new(&sheet, [1, 8]).unwrap(), Tube::new(&drawn_tube, [6, 0]).unwrap());
        let rolled = star.rolled_up(true).unwrap();
        for (tube, closed) in [(&star, rolled), (&kresling, kresling.embedding.drawn_angles().to_vec())] {
            assert!(tube.equations(&closed, &BOTH).0.iter().all(|value| value.abs() <= 1e-14));
            for off in [0.0, 0.02] {
                let angles: Vec<f64> = closed.iter().enumerate().map(|(k, x)| x + off * (k as f64).sin()).collect();
                let jacobian = tube.jacobian(&angles, &BOTH);
                check_jacobian(|x| tube.equations(x, &BOTH).0, &angles, &jacobian, TOLERANCE).unwrap();
            }
        }
        for angles in open_star_reference().cylinders(&sheet) {
            let jacobian = star.jacobian(&angles, &BOTH);
            check_jacobian(|x| star.equations(x, &BOTH).0, &angles, &jacobian, TOLERANCE).unwrap();
        }
    }

    /// Claim: invalid tubes are refused: the seam `[0, 0]`, a finite sheet, and a seam so short that the sheet cannot
    /// turn by a whole turn along it.
    #[test]
    fn refused() {
        let sheet = open_star();
        assert_eq!(Tube::new(&sheet, [0, 0]).unwrap_err(), KinematicsError::NoSeam);
        assert_eq!(Tube::new(&finite_grid(2, 2, 0.3), [0, 5]).unwrap_err(), KinematicsError::NoLattice);
        let found = Tube::new(&sheet, [0, 1]).unwrap().rolled_up(true);
        assert!(matches!(found, Err(KinematicsError::NoTube { seam: [0, 1], turn }) if turn <= TAU / 2.0), "{found:?}");
    }
}
