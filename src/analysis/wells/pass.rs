//! Passes: equilibria with exactly one negative eigenvalue.
//!
//! Newton's method on the whole system of coordinates and tensions, without shift, from a state near a pass; it
//! converges to whatever equilibrium is near, so the inertia is counted afterwards. What a pass joins is found by
//! descending from it on both sides.

use super::merge::{SAME_WELL_ANGLE_RAD, are_close};
use super::settle::{MinimumTracker, Settled};
use super::string::STRENGTH;
use super::work::Work;
use crate::analysis::state::State;
use crate::model::{Assembly, Configuration, Gauge};
use crate::solver::{Failure, Options, Start, stationary_point};

/// Largest change of a fold angle in a step.
const LONGEST_ANGLE_STEP_RAD: f64 = 0.2;

/// Steps of the descent from a pass before the sheet is set free.
const DESCENT: usize = 12;
/// Steps after these, each held half as strongly as the one before, that lead on towards the well.
const LAST_STEPS: usize = 8;
/// Tolerance of a pass, and of the wells beside it.
pub(super) const OPTIONS: Options = Options { tolerance: 1e-11, iterations: 60 };

/// How often a descent is held a hundred times as strongly, and the part of its strength that it loses in a step.
const STRONGER: i32 = 4;
const WEAKER: f64 = 4.0;

/// Largest number of steps of a careful descent.
const CAREFUL_STEPS: usize = 300;
/// Displacement with which a careful descent begins, relative to that of an ordinary descent.
const FIRST_PUSH: f64 = 0.1;
/// Largest step of a careful descent, relative to its distance from the pass.
const PART_OF_WAY: f64 = 0.5;
/// Step in radians below which a careful descent is continued without limits.
const AT_REST_RAD: f64 = 1e-4;

/// An equilibrium that Newton's method found.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Where it is.
    pub place: Configuration,
    /// What it looks like.
    pub state: State,
    /// Fold angles of the elastic hinges.
    pub rho: Vec<f64>,
    /// Its elastic energy less the work of loads from the drawn state.
    pub energy: f64,
    /// Negative eigenvalues of the energy's Hessian on what rigid bars leave free: one at a pass; `None` where their
    /// number cannot be established.
    pub negative_eigenvalues: Option<usize>,
    /// Largest unbalanced force over the largest force of an element.
    pub residual_force: f64,
    /// Largest gap over the mean edge.
    pub residual_length: f64,
}

/// A descent from a pass.
pub(crate) struct Descent {
    /// States on the way.
    way: Vec<Settled>,
    /// Where the sheet comes to rest.
    pub end: Settled,
}

impl Descent {
    /// Returns the fold angles and energies of its states, from the first after the pass to the end.
    pub fn row(&self) -> impl DoubleEndedIterator<Item = (&[f64], f64)> {
        self.way.iter().chain([&self.end]).map(|settled| (settled.rho.as_slice(), settled.energy))
    }
}

/// The equilibrium near a place.
pub(crate) fn equilibrium(assembly: &Assembly, from: &Configuration) -> Result<Pass, Failure> {
    let mut model = assembly.model(Gauge::Held);
    let tension = model.enter(from).tension;
    let start = Start { x: model.rebase_gauge(from.coordinates.clone()), tension };
    let found = stationary_point(&mut model, start, LONGEST_ANGLE_STEP_RAD, OPTIONS)?;
    let state = State::new(&model, &found.x, &found.tension);
    let rho = model.hinge_angles(&found.x);
    Ok(Pass {
        place: model.configuration(&found.x, Some(found.tension)),
        rho,
        energy: state.total() - Work::new(assembly).to(&state.coordinates),
        state,
        negative_eigenvalues: found.negative_eigenvalues,
        residual_force: found.residuals.force,
        residual_length: found.residuals.length,
    })
}

/// Where the sheet goes from a pass when pushed along a change of its fold angles, and against it.
///
/// A descent that is held too weakly steps across a steep pass: where one side leads over to the other, or both end in
/// one state, both are held more strongly; where that does not help, with steps that are short against the way from the
/// pass.
pub(crate) fn sides(assembly: &Assembly, pass: &Pass, along: &[f64]) -> Result<[Descent; 2], Failure> {
    let [one_way, other_way] = [1.0, -1.0].map(|sign| along.iter().map(|turn| sign * turn).collect::<Vec<f64>>());
    let differ = |a: &Descent, b: &Descent| !are_close(&a.end.rho, &b.end.rho, SAME_WELL_ANGLE_RAD);
    let mut last = Err(Failure::SingularStart);
    for stronger in 0..STRONGER {
        let strength = STRENGTH * 100f64.powi(stronger);
        let side = |push: &[f64]| descent(assembly, pass, push, strength);
        let ends = side(&one_way).and_then(|one| Ok((one, side(&other_way)?)));
        let sound = matches!(&ends, Ok(((a, true), (b, true))) if differ(a, b));
        last = ends.map(|(one, other)| [one.0, other.0]);
        if sound {
            return last;
        }
    }
    let careful = |push: &[f64]| careful_descent(assembly, pass, push);
    match (careful(&one_way), careful(&other_way)) {
        (Ok(one), Ok(other)) if differ(&one, &other) => Ok([one, other]),
        _ => last,
    }
}

/// Descends from a pass to the side of a push with steps that are short against the way from the pass, so that none
/// leads across it, however steep the pass and however near the well on the other side.
fn careful_descent(assembly: &Assembly, pass: &Pass, push: &[f64]) -> Result<Descent, Failure> {
    let mut strength = STRENGTH * 100f64.powi(STRONGER);
    let mut settler = MinimumTracker::new(assembly, strength);
    let mut target: Vec<f64> = pass.rho.iter().zip(push).map(|(rho, turn)| rho + FIRST_PUSH * turn).collect();
    let (mut way, mut place, mut energy) = (Vec::new(), pass.place.clone(), pass.energy);
    for _ in 0..CAREFUL_STEPS {
        let found = settler.step(&place, &target, &mut |_| true)?;
        let (step, far) = (largest_difference(&found.rho, &target), largest_difference(&target, &pass.rho));
        if step <= PART_OF_WAY * far && found.energy <= energy {
            (place, energy) = (found.place.clone(), found.energy);
            target.clone_from(&found.rho);
            way.push(found);
            if step <= AT_REST_RAD && strength <= STRENGTH {
                break;
            }
            strength = (strength / WEAKER).max(STRENGTH);
        } else {
            strength *= WEAKER * WEAKER;
        }
        settler.strength = strength;
    }
    let end = settler.free(&place.without_tension(), OPTIONS, &mut |_| true).map_err(|error| error.failure)?;
    Ok(Descent { way, end })
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Descends from a pass to the side of a push, first held with this strength and then ever less; whether the first step
/// went to that side.
fn descent(assembly: &Assembly, pass: &Pass, push: &[f64], strength: f64) -> Result<(Descent, bool), Failure> {
    let mut target: Vec<f64> = pass.rho.iter().zip(push).map(|(rho, turn)| rho + turn).collect();
    let (mut way, mut place, mut strength, mut to_its_side) = (Vec::new(), pass.place.clone(), strength, None);
    let mut settler = MinimumTracker::new(assembly, strength);
    let mut weak = 0;
    while weak < DESCENT {
        let found = settler.step(&place, &target, &mut |_| true)?;
        let moved = |((rho, from), turn): ((&f64, &f64), &f64)| (rho - from) * turn;
        to_its_side.get_or_insert_with(|| found.rho.iter().zip(&pass.rho).zip(push).map(moved).sum::<f64>() > 0.0);
        (place, target) = (found.place.clone(), found.rho.clone());
        way.push(found);
        if strength > STRENGTH {
            strength = (strength / WEAKER).max(STRENGTH);
            settler.strength = strength;
        } else {
            weak += 1;
        }
    }
    for _ in 0..LAST_STEPS {
        settler.strength *= 0.5;
        let Ok(found) = settler.step(&place, &target, &mut |_| true) else { break };
        (place, target) = (found.place.clone(), found.rho.clone());
        way.push(found);
    }
    let end = settler.free(&place.without_tension(), OPTIONS, &mut |_| true).map_err(|error| error.failure)?;
    Ok((Descent { way, end }, to_its_side == Some(true)))
}
