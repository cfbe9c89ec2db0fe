//! One relaxation of an extreme case, and a verdict on it: right, refused with a reason, or wrong.

use super::super::forms::{self, Form};
use foldwell::analysis::exact::error_to_kinematic;
use foldwell::analysis::relax::relax_from;
use foldwell::analysis::state::State;
use foldwell::model::{Assembly, AssemblyError, Boundary, Gauge, Hinges, Model, RIGID, Terms};
use foldwell::numerics::random::numbers;
use foldwell::numerics::{larger, worst};
use foldwell::sheet::Sheet;
use foldwell::solver::Options;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// Duration after which a relaxation counts as endless.
const PATIENCE: Duration = Duration::from_secs(60);
/// Largest allowed relative change of the length of a rigid bar.
const KEPT: f64 = 1e-9;
/// Largest scaled residual at which the augmented form counts as being in equilibrium.
const BALANCED: f64 = 1e-9;
/// Weight of the augmented form relative to the stiffness of the creases, and the difference in fold angles (radians)
/// up to which it agrees.
const WEIGHT: f64 = 1e4;
const AGREES: f64 = 1e-6;
/// Seed of the random rest angles.
const SEED: u64 = 1;

/// The verdict on a trial.
#[derive(Clone, Debug, PartialEq)]
pub enum TrialVerdict {
    /// The result agrees with an independent computation, with this largest difference of a fold angle.
    Right(f64),
    /// The relaxation converged, but there is no independent result to compare with.
    Unjudged,
    /// The relaxation was refused or failed, for this reason.
    Refused(String),
    /// Anything else: a wrong number, a panic, or no end.
    Wrong(String),
}

/// A sheet with bars and creases whose rest angles differ from the drawn angles.
pub struct Trial {
    /// The cell, or the finite sheet.
    pub sheet: Sheet,
    /// Numbers of cells along the two lattice vectors.
    pub cells: [usize; 2],
    /// Boundary conditions.
    pub boundary: Boundary,
    /// Stiffnesses of bars and of creases; facets are rigid.
    pub stiffness: [f64; 2],
    /// Largest difference of the random rest angles from the drawn angles, in radians.
    pub off: f64,
    /// An edge and the fold angle at which it is locked.
    pub lock: Option<(usize, f64)>,
}

/// The state at which a trial ended.
pub struct TrialResult {
    /// Fold angle of every edge in radians; NaN for edges without a hinge.
    pub angles: Vec<f64>,
    /// Largest difference of a fold angle from the exact kinematics; `None` if there is nothing to compare with.
    pub to_kinematic: Option<f64>,
    /// Largest difference of a fold angle from the equilibrium of the augmented form; `None` if that finds none.
    pub to_augmented: Option<f64>,
    /// Largest relative change of the length of a bar.
    pub stretch: f64,
}

impl Trial {
    /// Makes a patch with rigid bars and creases of stiffness 1.
    pub fn rigid(sheet: Sheet, cells: [usize; 2], off: f64) -> Self {
        let stiffness = [f64::INFINITY, 1.0];
        Self { sheet, cells, boundary: Boundary::Patch, stiffness, off, lock: None }
    }

    /// Assembles the sheet with its bars, creases, rigid polygons and lock.
    fn assembly(&self) -> Result<Assembly, AssemblyError> {
        let drawn = Assembly::without_terms(self.sheet.clone(), self.cells, self.boundary)?;
        let [bars, creases] = self.stiffness;
        let polygons = drawn.tiling().facets().next().is_some();
        let terms = Terms {
            facets: polygons.then(|| Hinges { stiffness: RIGID.into(), rest: drawn.drawn_angles().to_vec() }),
            locks: self.lock.into_iter().collect(),
            ..Terms::bars_and_creases(bars, creases, self.rest_angles(&drawn))
        };
        Ok(drawn.with_terms(terms).with_best_axis())
    }

    /// Relaxes from the drawn state. The error is the reason for a failure.
    pub fn run(&self) -> Result<TrialResult, String> {
        let [bars, creases] = self.stiffness;
        let assembly = self.assembly().map_err(|error| error.to_string())?;
        let mut model = assembly.model(Gauge::Held);
        let (start, clock) = (model.start(), Instant::now());
        let found = relax_from(&model, start, Options::default(), &mut |_| clock.elapsed() < PATIENCE);
        let found = found.map_err(|error| error.failure.to_string())?;
        let (rigid, angles) = (bars.is_infinite(), found.state.fold_angle);
        Ok(TrialResult {
            to_kinematic: rigid
                .then(|| error_to_kinematic(assembly.sheet(), assembly.tiling(), &model, &angles))
                .flatten(),
            to_augmented: if rigid { None } else { augmented(&mut model, creases) }.map(|a| distance(&angles, &a)),
            stretch: stretch(&model, &found.state.coordinates),
            angles,
        })
    }

    fn rest_angles(&self, assembly: &Assembly) -> Vec<f64> {
        assembly.drawn_angles().iter().zip(numbers(SEED)).map(|(angle, number)| angle + self.off * number).collect()
    }

    /// For rigid bars, checks that the state agrees with the exact kinematics to `allowed` radians or, without exact
    /// kinematics, that the bars kept their lengths. For soft bars, checks whether the state is that of the augmented
    /// form, which may also find another minimum.
    pub fn judged(&self, allowed: f64) -> TrialVerdict {
        judge(|found| match (found.to_kinematic, found.to_augmented) {
            (Some(error), _) => within(error, allowed),
            (None, Some(error)) if error <= AGREES => TrialVerdict::Right(error),
            (None, _) if self.stiffness[0].is_finite() || found.stretch <= KEPT => TrialVerdict::Unjudged,
            (None, _) => TrialVerdict::Wrong(format!("a rigid bar changed its length by {:.1e}", found.stretch)),
        })(self)
    }

    /// Checks whether the fold angles are the expected ones to `allowed` radians.
    pub fn against(&self, expected: &[f64], allowed: f64) -> TrialVerdict {
        judge(|found| within(distance(&found.angles, expected), allowed))(self)
    }
}

/// Returns a function that runs a trial and gives its verdict; a panic and an endless relaxation are wrong.
pub fn judge(verdict: impl Fn(&TrialResult) -> TrialVerdict) -> impl Fn(&Trial) -> TrialVerdict {
    move |trial| match catch_unwind(AssertUnwindSafe(|| trial.run())) {
        Ok(Ok(found)) => verdict(&found),
        Ok(Err(reason)) if reason.contains("stopped on request") => {
            TrialVerdict::Wrong(format!("no end after {} s", PATIENCE.as_secs()))
        }
        Ok(Err(reason)) => TrialVerdict::Refused(reason),
        Err(_) => TrialVerdict::Wrong("panic".into()),
    }
}

/// Returns [`TrialVerdict::Right`] if the error is at most `allowed`.
pub fn within(error: f64, allowed: f64) -> TrialVerdict {
    if error <= allowed { TrialVerdict::Right(error) } else { TrialVerdict::Wrong(format!("off by {error:.1e}")) }
}

/// Returns the largest difference where `expected` is a number; NaN if `angles` lacks one of these, if there are none,
/// or if the lengths differ.
pub fn distance(angles: &[f64], expected: &[f64]) -> f64 {
    let known = angles.iter().zip(expected).filter(|(_, expected)| !expected.is_nan());
    let worst = worst(known.map(|(a, b)| (a - b).abs()));
    worst.filter(|_| angles.len() == expected.len()).unwrap_or(f64::NAN)
}

/// Returns the fold angles of the equilibrium of the augmented form; `None` if it finds none.
fn augmented(model: &mut Model, creases: f64) -> Option<Vec<f64>> {
    let found = forms::minimize(model, Form::Augmented(WEIGHT * creases)).ok()?;
    let balanced = found.residuals.iter().all(|residual| *residual <= BALANCED);
    balanced.then(|| State::new(model, &found.x, &found.tension).fold_angle)
}

/// Returns the largest relative change of the length of a bar, computed from the points.
fn stretch(model: &Model, coordinates: &[f64]) -> f64 {
    let bars = model.stiff().filter(|element| !element.is_angle());
    let change = bars.map(|bar| bar.value(coordinates) / bar.spring.rest - 1.0);
    change.fold(0.0, |most, change| larger(most, change.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: a missing fold angle fails a trial wherever it is, and so does a comparison without any numbers.
    #[test]
    fn what_is_missing_is_not_right() {
        let nan = f64::NAN;
        assert_eq!(distance(&[1.0, nan, 2.5], &[1.0, nan, 2.0]), 0.5);
        for (angles, expected) in
            [(&[nan, 2.0][..], &[1.0, 2.0][..]), (&[1.0], &[nan]), (&[], &[]), (&[1.0, 2.0], &[1.0])]
        {
            let off = distance(angles, expected);
            assert!(off.is_nan(), "{angles:?} {expected:?}: {off}");
            assert!(matches!(within(off, 1.0), TrialVerdict::Wrong(_)));
        }
    }
}
