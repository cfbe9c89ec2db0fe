//! The energy as an engine of trajectories: relaxations with a crease locked along a rigid trajectory.
//!
//! At every state of the trajectory the crease that moves fastest there is locked at its angle, and the sheet relaxes
//! at its own stiffness from where the last relaxation ended, moved on by the same amount again. Steps that suit the
//! fold angles may be too long for that: a relaxation that fails, or ends at angles to which the rigid step does not
//! lead, is made anew in two steps of half the length, and these likewise. Only the first step starts from the rigid
//! state, since all rays leave from the same place; and where a trajectory comes back, that place itself, the drawn
//! state, is not relaxed again: there a locked crease does not say about which axis the sheet folds. Rigid bars must
//! meet every rigid state to rounding; softer ones stay off it by what the creases pull them.

use super::chart;
use super::relax::{Relaxed, relax_model};
use super::state::{Cylinder, cylinder};
use super::trace::{Folded, Traced};
use crate::model::{Assembly, Configuration, Domain, Drawn, Gauge};
use crate::numerics::{larger, worst};
use crate::solver::continuation::End;
use crate::solver::{Failure, Observe, Options};
use std::f64::consts::TAU;
use thiserror::Error;

/// The crease that is locked stays the same while it moves at least this part as fast as the fastest.
const FAST_ENOUGH: f64 = 0.5;

/// Most times that a step is halved.
const HALVINGS: usize = 6;
/// Largest difference between the steps of a fold angle with soft measures and with rigid ones, as a part of the arc
/// length: beyond it the relaxed state has left the trajectory for another state.
const ELSEWHERE: f64 = 0.5;
/// Steps count as no shorter than this there.
const SHORT: f64 = 0.01;
/// Where all measures are rigid there is one state beside the rigid one: a fold angle that differs by more than this,
/// in radians, is another state's. What relaxations leave open is 1e-9 and less, times a thousand where angles move
/// fast.
const SAME_STATE: f64 = 1e-6;
/// Beside a rigid state that is interpolated it may differ by this part of the arc length.
const INTERPOLATED: f64 = 0.05;

/// A relaxed state beside a rigid one.
#[derive(Clone, Debug)]
pub struct StateAlong {
    /// The equilibrium.
    pub relaxed: Relaxed,
    /// Fold angles of all edges, continuous along the trajectory; zero where there is no hinge.
    pub angles: Vec<f64>,
    /// Largest difference of a fold angle to the rigid state.
    pub error: f64,
}

/// The relaxations beside a trajectory.
#[derive(Clone, Debug)]
pub struct RelaxedTrajectory {
    /// One state for every state of the trajectory but the first, which is drawn, and the last where it closes; fewer
    /// where one failed.
    pub states: Vec<StateAlong>,
    /// Why the next one failed.
    pub failure: Option<AlongFailure>,
}

/// Why there is no relaxed state beside a rigid one.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum AlongFailure {
    #[error(transparent)]
    Relaxation(#[from] Failure),
    #[error("it ends in another rigid state, whose fold angles differ by up to {apart:.1e} rad")]
    Elsewhere {
        /// Largest difference of a fold angle to the rigid trajectory, in radians.
        apart: f64,
    },
}

impl RelaxedTrajectory {
    /// Largest difference of a fold angle to the rigid trajectory; `None` where no state was compared.
    pub fn error(&self) -> Option<f64> {
        worst(self.states.iter().map(|state| state.error))
    }
}

/// Largest differences between the relaxed cylinders and the rigid ones along a trajectory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CylinderErrors {
    /// Of the signed curvature.
    pub curvature: f64,
    /// Of a component of the strain.
    pub strain: f64,
    /// Of a rotation angle, in radians; whole turns and the direction of the axis left aside.
    pub theta: f64,
}

/// Compares the cylinders of relaxations with those of its trajectory; `None` for a finite sheet, and where there is no
/// state to compare.
pub fn cylinder_errors(drawn: &Drawn, traced: &Traced, relaxed: &RelaxedTrajectory) -> Option<CylinderErrors> {
    let mut most = CylinderErrors::default();
    for (rigid, state) in traced.states.iter().skip(1).zip(&relaxed.states) {
        let (shape, found) = (rigid.shape.as_ref()?, relaxed_cylinder(drawn, rigid, state)?);
        let strain = found.strain.iter().zip(&shape.strain).map(|(a, b)| (a - b).abs());
        let theta = [1.0, -1.0].map(|way| {
            let off = found.theta.iter().zip(&shape.theta).map(|(a, b)| a - way * b);
            off.map(|off| (off - TAU * (off / TAU).round()).abs()).fold(0.0, larger)
        });
        most.curvature = larger(most.curvature, (found.curvature - shape.curvature).abs());
        most.strain = strain.fold(most.strain, larger);
        most.theta = larger(most.theta, theta[0].min(theta[1]));
    }
    (!relaxed.states.is_empty()).then_some(most)
}

/// Returns the cylinder of a relaxed state beside a rigid one; `None` for a finite sheet. The coordinates of a tube do
/// not tell the sign of its curvature where lattice rotations have passed a half turn: there it is that of the rigid
/// state.
pub(crate) fn relaxed_cylinder(drawn: &Drawn, rigid: &Folded, relaxed: &StateAlong) -> Option<Cylinder> {
    let found = cylinder(drawn, &relaxed.relaxed.state.coordinates)?;
    match (&drawn.domain, &rigid.shape) {
        (Domain::Tube { .. }, Some(shape)) => {
            Some(Cylinder { curvature: found.curvature.abs().copysign(shape.curvature), ..found })
        }
        _ => Some(found),
    }
}

/// Relaxes beside every state of a trajectory. `observe` sees every accepted step and returns false to stop.
pub fn relax_along(assembly: &Assembly, options: Options, traced: &Traced, observe: Observe<'_>) -> RelaxedTrajectory {
    let mut relaxed = RelaxedTrajectory { states: Vec::new(), failure: None };
    let mut track = Track { assembly, options, angles: Vec::new(), crease: None, known: Vec::new() };
    let closed = usize::from(matches!(traced.end, End::Closed(_)));
    let Some((drawn, rest)) = traced.states[..traced.states.len() - closed].split_first() else { return relaxed };
    track.angles.clone_from(&drawn.angles);
    for (state, before) in rest.iter().zip(&traced.states) {
        let halvings = if track.known.is_empty() { 0 } else { HALVINGS };
        match track.reach((before, state), halvings, observe) {
            Ok(state) => relaxed.states.push(state),
            Err(failure) => {
                relaxed.failure = Some(failure);
                break;
            }
        }
    }
    relaxed
}

/// The crease to lock: the last one while it is fast enough.
fn fastest(rates: &[f64], last: Option<usize>) -> usize {
    let speed = |edge: &usize| rates[*edge].abs();
    let first = (0..rates.len()).max_by(|a, b| speed(a).total_cmp(&speed(b))).unwrap_or(0);
    last.filter(|edge| speed(edge) >= FAST_ENOUGH * speed(&first)).unwrap_or(first)
}

/// Whether relaxed angles made another step than the rigid ones.
fn goes_elsewhere(before: &[f64], now: &[f64], (from, to): (&Folded, &Folded)) -> bool {
    let most = ELSEWHERE * f64::max(to.arc_length - from.arc_length, SHORT);
    let steps = now.iter().zip(before).zip(to.angles.iter().zip(&from.angles));
    let mut off = steps.map(|((now, before), (to, from))| (now - before - (to - from)).abs());
    off.any(|off| !(off <= most))
}

/// A rigid state between two, as far as a relaxation needs it: its angles, by cubic interpolation, and their rates.
fn between(from: &Folded, to: &Folded) -> Folded {
    let length = to.arc_length - from.arc_length;
    let ends = || from.angles.iter().zip(&to.angles).zip(from.rates.iter().zip(&to.rates));
    Folded {
        arc_length: from.arc_length + 0.5 * length,
        angles: ends().map(|((a, b), (u, v))| 0.5 * (a + b) + 0.125 * length * (u - v)).collect(),
        rates: ends().map(|((a, b), (u, v))| 1.5 * (b - a) / length - 0.25 * (u + v)).collect(),
        residual: f64::NAN,
        ..Folded::default()
    }
}

/// The last relaxed states.
#[derive(Clone)]
struct Track<'a> {
    assembly: &'a Assembly,
    options: Options,
    angles: Vec<f64>,
    crease: Option<usize>,
    /// Rigid arc length and coordinates of the last states that share a gauge, the newest last; at most two.
    known: Vec<(f64, Vec<f64>)>,
}

impl Track<'_> {
    /// Relaxes beside `to`, by shorter steps from `from` where one does not lead there.
    fn reach(
        &mut self,
        (from, to): (&Folded, &Folded),
        halvings: usize,
        observe: Observe<'_>,
    ) -> Result<StateAlong, AlongFailure> {
        let before = self.clone();
        let interpolated = if to.positions.is_empty() { INTERPOLATED * (to.arc_length - from.arc_length) } else { 0.0 };
        let most = f64::max(SAME_STATE, interpolated);
        let found = match self.step(to, fastest(&to.rates, self.crease), observe) {
            // the relaxed state, if its measures are all rigid only where it is the rigid one
            Ok(state) if self.assembly.terms().is_rigid() && !(state.error <= most) => {
                Err(AlongFailure::Elsewhere { apart: state.error })
            }
            found => found,
        };
        let wrong = match &found {
            Ok(state) => goes_elsewhere(&before.angles, &state.angles, (from, to)),
            Err(failure) => *failure != AlongFailure::Relaxation(Failure::Interrupted),
        };
        if !wrong || halvings == 0 {
            return found;
        }
        *self = before;
        let middle = between(from, to);
        self.reach((from, &middle), halvings - 1, observe)?;
        self.reach((&middle, to), halvings - 1, observe)
    }

    fn step(&mut self, state: &Folded, crease: usize, observe: Observe<'_>) -> Result<StateAlong, AlongFailure> {
        let mut terms = self.assembly.terms().clone();
        terms.locks.push((crease, state.angles[crease]));
        let mut model = self.assembly.with_terms(terms).model(Gauge::Held);
        let last = self.known.last().map(|(_, at)| at.clone());
        let coordinates = last.unwrap_or_else(|| chart::coordinates_in(self.assembly.domain(), state));
        let angles = model.angles_among(&self.angles);
        let (here, is_held_as_drawn) = model.enter_well_held(&Configuration::new(coordinates, angles, None));
        let ahead = self.ahead(state.arc_length).filter(|_| is_held_as_drawn);
        let start = ahead.map_or(here, |ahead| model.unknowns(&ahead).into());
        let (relaxed, model, _) = relax_model(model, start, self.options, observe)
            .map_err(|error| AlongFailure::Relaxation(error.failure))?;
        self.keep(model.domain(), &model.held(), state.arc_length, relaxed.state.coordinates.clone());
        self.crease = Some(crease);
        self.angles = self.continued(&relaxed.state.coordinates);
        let off = |(a, b): (&f64, &f64)| (a - b).abs();
        let error = self.angles.iter().zip(&state.angles).map(off).fold(0.0, larger);
        Ok(StateAlong { relaxed, angles: self.angles.clone(), error })
    }

    /// Coordinates if all goes on as between the last two states.
    fn ahead(&self, arc_length: f64) -> Option<Vec<f64>> {
        let [(s0, x0), (s1, x1)] = &self.known[..] else { return None };
        let part = (arc_length - s1) / (s1 - s0);
        Some(x1.iter().zip(x0).map(|(now, before)| now + part * (now - before)).collect())
    }

    /// Keeps a state, and the one before where it has the same gauge: the height of vertex 0 moves with a screw's axis,
    /// what keeps it from turning in the plane may change, and rotations jump by whole turns.
    fn keep(&mut self, domain: &Domain, held: &[bool], arc_length: f64, coordinates: Vec<f64>) {
        let near = |a: [f64; 2], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1.0);
        let same = |at: &[f64]| {
            let fixed = (0..at.len()).filter(|&k| held[k]).all(|k| at[k] == coordinates[k]);
            let turns = domain.turns(at).zip(domain.turns(&coordinates));
            fixed && turns.is_none_or(|(there, here)| near(there.theta, here.theta))
        };
        self.known.retain(|(_, at)| same(at));
        if self.known.len() == 2 {
            self.known.remove(0);
        }
        self.known.push((arc_length, coordinates));
    }

    /// Fold angles of all edges at coordinates, each next to the last one.
    fn continued(&self, coordinates: &[f64]) -> Vec<f64> {
        let next = |(angle, last): (f64, &f64)| angle + TAU * ((last - angle) / TAU).round();
        self.assembly
            .fold_angles_at(coordinates)
            .into_iter()
            .zip(&self.angles)
            .map(|(angle, last)| if angle.is_nan() { 0.0 } else { next((angle, last)) })
            .collect()
    }
}
