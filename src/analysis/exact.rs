//! The equilibrium of hinges on exactly rigid faces, in fold angles alone: what a relaxation is compared with.
//!
//! Minimises `E = sum (K/2)(rho - rest)^2` among fold angles that close, from angles near such a state. One step: onto
//! the closed states (Newton's method across their tangents `Z`), then along them with the Hessian of the Lagrangian,
//! `Z^T (K + sum_r lambda_r B_r) Z`, `J^T lambda = -K (rho - rest)`, `B_r` the second derivative of closure (J. Nocedal
//! and S. J. Wright, "Numerical Optimization", 2006, section 18.3). No bar enters.

use crate::kinematics::closure::DIRECTION;
use crate::kinematics::{Closing, Closure};
use crate::model::{Domain, Element, Model, TermKind};
use crate::numerics::dense::{NullSpace, least_squares, least_squares_of_sums, symmetric_eigenvalues};
use crate::numerics::root::Search;
use crate::numerics::{DenseMatrix, worst};
use crate::sheet::{Sheet, Tiling};
use nalgebra::DVector;

/// Larger sheets are not compared: the matrices here are dense.
const MOST_EDGES: usize = 300;
const STEPS: usize = 30;
const CORRECTIONS: usize = 10;
/// Residual of closure, and last change of an angle, of a state that is found.
const CLOSURE_RESIDUAL: f64 = 1e-13;
const LAST_ANGLE_CHANGE_RAD: f64 = 1e-11;
/// Largest error of the exact state itself, in radians, with which it is worth a comparison.
const KNOWN: f64 = 1e-10;
/// Largest difference of a rest length from the drawn length, relative to the positions of its ends, at which the bar
/// is at rest as drawn.
const SAME_LENGTH: f64 = 1e-12;
/// Largest difference of a fold angle to an exact state that is still near by: half a turn.
const FARTHEST_RAD: f64 = std::f64::consts::PI;
/// Largest change of an angle in a step, and by closing after it: another branch of closed states is farther away.
const LONGEST_ANGLE_STEP_RAD: f64 = 0.3;

/// Hinges by edge: the energy of exactly folded states.
pub(crate) struct Springs {
    closure: Closure,
    stiffness: DVector<f64>,
    /// Rest angles of all edges; 0 where there is no spring.
    pub(crate) rest: DVector<f64>,
    /// Fold angle of every edge, those of rigid hinges at rest.
    start: Vec<f64>,
}

/// An exactly folded state at which the energy is stationary.
#[derive(Clone, Debug, PartialEq)]
pub struct Stationary {
    /// Fold angles of all edges.
    pub angles: Vec<f64>,
    /// Energy of the hinges.
    pub energy: f64,
    /// Directions along which folding lowers the energy: eigenvalues of the reduced Hessian that are negative.
    pub negative_eigenvalues: usize,
    /// Largest component of the closure residual.
    pub residual: f64,
    /// How far from closed the angles may be, in radians: the residual over the smallest singular value of closure that
    /// is none of its zeros. Next to a state with more motions, as that of a screw without curvature, it is the larger
    /// the nearer it is.
    pub error: f64,
}

/// The energy along the closed states at one of them, to second order in coordinates along its tangents.
struct EnergyExpansion {
    /// Rates of the folding edges, orthonormal columns.
    tangents: DenseMatrix,
    /// Falls of the energy.
    pull: DenseMatrix,
    hessian: DenseMatrix,
    /// Smallest singular value of closure that is not zero.
    least: f64,
}

/// Largest difference of a fold angle to the exact equilibrium near a relaxed state with these fold angles, of all
/// edges of the tiling, in radians.
///
/// `None` where there is none to compare with: loads pull, vertices are pinned, bars have other rest lengths than the
/// drawn ones, the sheet is periodic without screws, or with openings, or a tube of one cell, it is too large, no exact
/// state is found nearby, or what is found is not known well enough itself.
pub fn error_to_kinematic(sheet: &Sheet, tiling: &Tiling, model: &Model, angles: &[f64]) -> Option<f64> {
    let springs = Springs::new(sheet, tiling, model, angles)?;
    let exact = springs.stationary(&springs.start).filter(|exact| exact.error <= KNOWN)?.angles;
    let known = exact.iter().zip(angles).filter(|(_, angle)| !angle.is_nan());
    worst(known.map(|(exact, angle)| (exact - angle).abs())).filter(|error| *error <= FARTHEST_RAD)
}

/// Whether the bars of a model are at rest at their drawn lengths, which exact folding keeps.
fn rests_at_drawn_lengths(sheet: &Sheet, tiling: &Tiling, model: &Model) -> bool {
    // rounding is relative to the positions in the file, which may be far from its origin
    let as_drawn = |(edge, rest): (usize, f64)| {
        let [i, j] = sheet.edges[tiling.edges[edge].edge].key.ends().map(|end| sheet.position(end));
        (rest - (j - i).norm()).abs() <= SAME_LENGTH * (i.norm() + j.norm() + rest)
    };
    let mut bars = model.stiff().filter(|element| element.kind() == TermKind::Bars);
    bars.all(|bar| bar.edge().is_some_and(|edge| as_drawn((edge, bar.spring.rest))))
}

impl Springs {
    /// The hinges of a model, rigid ones at rest and the others from these angles of all edges; `None` where nothing
    /// can be said, as [`error_to_kinematic`].
    pub(crate) fn new(sheet: &Sheet, tiling: &Tiling, model: &Model, angles: &[f64]) -> Option<Self> {
        let edges = angles.len();
        let closes = !matches!(model.domain(), Domain::Patch | Domain::Screw);
        let is_linear = model.elements().all(|element| !element.has_law() && element.edge().is_some());
        if edges > MOST_EDGES || model.held_or_loaded() || closes || !is_linear {
            return None;
        }
        if !rests_at_drawn_lengths(sheet, tiling, model) {
            return None;
        }
        let mut stiffness = DVector::zeros(edges);
        let mut rest = DVector::zeros(edges);
        let mut start: Vec<f64> = angles.iter().map(|angle| if angle.is_nan() { 0.0 } else { *angle }).collect();
        let mut rigid = Vec::new();
        for hinge in model.elements().filter(Element::is_hinge) {
            let (Some(edge), spring) = (hinge.edge(), hinge.spring) else { continue };
            if spring.stiffness.is_infinite() {
                start[edge] = spring.rest;
                rigid.push(edge);
            } else {
                (stiffness[edge], rest[edge]) = (spring.stiffness, spring.rest);
            }
        }
        let closure = Closure::of_tiling(sheet, tiling).ok()?.with_locked(&rigid);
        closure.is_complete().ok()?;
        Some(Self { closure, stiffness, rest, start })
    }

    /// The energy of the hinges at fold angles of all edges.
    pub(crate) fn energy(&self, angles: &[f64]) -> f64 {
        let off =
            angles.iter().zip(&self.rest).zip(&self.stiffness).map(|((angle, rest), k)| k * (angle - rest).powi(2));
        0.5 * off.sum::<f64>()
    }

    /// The stationary state near these fold angles of all edges, of whatever index; `None` where Newton's method finds
    /// none.
    pub(crate) fn stationary(&self, start: &[f64]) -> Option<Stationary> {
        let mut closing = Closing::new(&self.closure, self.start.clone());
        let start = closing.folding(start);
        let mut x = close(&mut closing, start, f64::INFINITY)?;
        for _ in 0..STEPS {
            let step = self.along(&closing, &x)?.step()?;
            let longest = step.amax();
            let part = (LONGEST_ANGLE_STEP_RAD / longest).min(1.0);
            x.iter_mut().zip(step.iter()).for_each(|(x, d)| *x += part * d);
            x = close(&mut closing, x, LONGEST_ANGLE_STEP_RAD)?;
            if longest <= LAST_ANGLE_CHANGE_RAD {
                let angles = closing.angles(&x);
                let along = self.along(&closing, &x)?;
                let (energy, residual) = (self.energy(&angles), self.closure.residual(&angles).amax());
                let (negative_eigenvalues, error) = (along.negative()?, residual / along.least);
                return Some(Stationary { angles, energy, negative_eigenvalues, residual, error });
            }
        }
        None
    }

    /// The energy along the closed states.
    fn along(&self, closing: &Closing<'_>, x: &[f64]) -> Option<EnergyExpansion> {
        let folding = self.closure.folding_edges();
        let angles = closing.angles(x);
        let NullSpace { basis: tangents, singular_values, rank, .. } = self.closure.motions(&angles).ok()?;
        let least = rank.checked_sub(1).map_or(f64::INFINITY, |last| singular_values[last]);
        let stiffness = DVector::from_iterator(folding.len(), folding.iter().map(|&edge| self.stiffness[edge]));
        let off = folding.iter().map(|&edge| angles[edge] - self.rest[edge]);
        let force = -stiffness.component_mul(&DVector::from_iterator(folding.len(), off));
        let right = DenseMatrix::from_column_slice(folding.len(), 1, force.as_slice());
        let jacobian = self.closure.jacobian(&angles);
        let lambda = least_squares_of_sums(&jacobian.transpose(), &right, DIRECTION).ok()?.solution;
        let mut spread = DenseMatrix::zeros(angles.len(), tangents.ncols());
        folding.iter().enumerate().for_each(|(row, &edge)| spread.row_mut(edge).copy_from(&tangents.row(row)));
        let mut hessian = tangents.transpose() * DenseMatrix::from_diagonal(&stiffness) * &tangents;
        let second = self.closure.second_order(&angles, &spread);
        lambda.iter().zip(&second).for_each(|(lambda, part)| hessian += part * (2.0 * lambda));
        let pull = tangents.tr_mul(&right);
        Some(EnergyExpansion { tangents, pull, hessian, least })
    }
}

impl EnergyExpansion {
    /// Newton's step of the angles.
    fn step(&self) -> Option<DVector<f64>> {
        if self.tangents.ncols() == 0 {
            return Some(DVector::zeros(self.tangents.nrows()));
        }
        Some((&self.tangents * least_squares(&self.hessian, &self.pull).ok()?.solution).column(0).into_owned())
    }

    /// Number of negative eigenvalues.
    fn negative(&self) -> Option<usize> {
        Some(symmetric_eigenvalues(&self.hessian).ok()?.iter().filter(|value| **value < 0.0).count())
    }
}

/// The closed state nearest to `x`, across the tangents there; `None` where Newton's method finds none, or moves an
/// angle by more than `reach`.
fn close(closing: &mut Closing<'_>, x: Vec<f64>, reach: f64) -> Option<Vec<f64>> {
    let search = Search { most_steps: CORRECTIONS, residual: CLOSURE_RESIDUAL, terms: DIRECTION };
    let closed = search.root(x.clone(), |x| closing.linearized(x))?;
    let is_near = closed.iter().zip(&x).all(|(closed, x)| (closed - x).abs() <= reach);
    is_near.then_some(closed)
}
