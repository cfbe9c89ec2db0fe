//! Retraction: a state is pulled back onto the stiff measures, `m = c t`, by chord corrections with one factorization.

use super::iteration::Newton;
use super::outcome::Failure;
use crate::linearization::{HessianKind, missing};
use crate::problem::{Problem, Residuals};
use foldwell_numerics::sparse::FIXED;
use foldwell_numerics::vector::{add_scaled, moved};

/// Largest scaled gap of a start.
pub(super) const START_GAP: f64 = 1e-10;
/// Largest number of chord corrections of a start.
const START_CHORDS: i32 = 50;
/// Largest number of Gauss-Newton steps of a start.
const START_STEPS: usize = 30;
/// Part of the gap that a whole Gauss-Newton step of a start must close; a shorter one closes as much less.
const LEAST_CLOSED_PART: f64 = 0.3;
/// Number of lengths tried of a Gauss-Newton step of a start, each half of the one before.
const START_HALVINGS: i32 = 5;
/// Scaled gap below which it may be rounding error.
const ROUNDING_GAP: f64 = 1e-12;

/// A state on the stiff measures.
pub(super) struct RetractedState {
    pub(super) x: Vec<f64>,
    pub(super) tension: Vec<f64>,
    pub(super) merit: f64,
}

impl<P: Problem> Newton<'_, P> {
    /// Pulls the start onto the stiff measures: by chord corrections, and where one linearization does not reach so
    /// far, by damped Gauss-Newton steps before.
    pub(super) fn retract_start(&mut self) -> Result<(), Failure> {
        self.stretch_held();
        let mut gap = Residuals::new(self.problem, &self.tangent.at, &self.tension).length;
        let mut walled = false;
        for _ in 0..START_STEPS {
            if gap <= START_GAP {
                return Ok(());
            }
            self.factor_start()?;
            let retracted = self.retract(self.x.clone(), self.tension.clone(), START_GAP, START_CHORDS);
            match retracted {
                Ok(trial) if trial.merit.is_finite() => {
                    self.start_from(trial);
                    return Ok(());
                }
                Ok(_) => walled = true,
                Err(_) => {}
            }
            let (left, is_walled) = self.approach(gap);
            walled |= is_walled;
            let Some(left) = left else { break };
            gap = left;
        }
        // behind a wall of infinite energy: as it is, with the tensions that measures of finite stiffness have
        let trial = if walled { self.stretched(self.x.clone(), self.tension.clone(), START_GAP) } else { None };
        self.start_from(trial.ok_or(Failure::Infeasible { gap })?);
        Ok(())
    }

    /// Gives measures of finite stiffness that no unknown moves, as those between pinned points, their tensions.
    fn stretch_held(&mut self) {
        let (measures, compliance) = (&self.problem.layout().stiff, self.problem.compliance());
        for (row, tension) in self.tension.iter_mut().enumerate().filter(|(row, _)| compliance[*row] > 0.0) {
            if measures.members(row).iter().all(|member| *member == FIXED) {
                *tension = self.tangent.at.gaps[row] / compliance[row];
            }
        }
    }

    fn start_from(&mut self, trial: RetractedState) {
        (self.x, self.tension) = (trial.x, trial.tension);
        self.problem.accept(&mut self.x);
        self.linearize();
    }

    /// Factors for the retraction of a start: near a solution, where tensions are known, it should cost the least
    /// energy; elsewhere it should be the shortest.
    fn factor_start(&mut self) -> Result<(), Failure> {
        if self.kind == HessianKind::Full {
            return self.factor(0.0);
        }
        self.tangent.factor_shortest()?;
        Ok(())
    }

    /// One Gauss-Newton step towards the stiff measures, halved until it makes the largest gap clearly smaller; that
    /// gap, and whether a state on the way had infinite energy.
    fn approach(&mut self, gap: f64) -> (Option<f64>, bool) {
        let open = self.tangent.at.missing(&self.tension, self.problem.compliance());
        let (dx, dt) = self.tangent.system.apply(&vec![0.0; self.x.len()], &open);
        let mut walled = false;
        for fraction in (0..START_HALVINGS).map(|halving| 0.5f64.powi(halving)) {
            let (x, tension) = (moved(&self.x, fraction, &dx), moved(&self.tension, fraction, &dt));
            let open = missing(&self.problem.gaps(&x), &tension, self.problem.compliance());
            let left = self.largest_scaled_gap(&open);
            if left <= (1.0 - LEAST_CLOSED_PART * fraction) * gap {
                if !self.problem.energy(&x).is_finite() {
                    walled = true;
                    continue;
                }
                (self.x, self.tension) = (x, tension);
                self.problem.accept(&mut self.x);
                self.linearize();
                return (Some(left), walled);
            }
        }
        (None, walled)
    }

    /// The state at `x` with the tensions that measures of finite stiffness have there; `None` where rigid ones are not
    /// met to the scaled gap `wanted`.
    pub(super) fn stretched(&self, x: Vec<f64>, mut tension: Vec<f64>, wanted: f64) -> Option<RetractedState> {
        let (gaps, compliance) = (self.problem.gaps(&x), self.problem.compliance());
        let measures = tension.iter_mut().zip(&gaps).zip(compliance);
        measures.filter(|(_, c)| **c > 0.0).for_each(|((tension, gap), c)| *tension = gap / c);
        let open = self.largest_scaled_gap(&missing(&gaps, &tension, compliance));
        let merit = self.merit_of(&x, &tension, &gaps);
        (open <= wanted).then_some(RetractedState { x, tension, merit })
    }

    /// Chord corrections onto `m = c t` until the largest scaled gap is `wanted`, or at the level of rounding error.
    pub(super) fn retract(
        &mut self,
        mut x: Vec<f64>,
        mut tension: Vec<f64>,
        wanted: f64,
        most: i32,
    ) -> Result<RetractedState, f64> {
        let no_force = vec![0.0; x.len()];
        let mut last = f64::INFINITY;
        for left in (0..=most).rev() {
            let gaps = self.problem.gaps(&x);
            let open = missing(&gaps, &tension, self.problem.compliance());
            let size = self.largest_scaled_gap(&open);
            let rate = size / last;
            if size <= wanted || (size <= ROUNDING_GAP && rate > 0.5) {
                let merit = self.merit_of(&x, &tension, &gaps);
                return Ok(RetractedState { x, tension, merit });
            }
            if !(size.is_finite() && rate < 1.0 && size * rate.powi(left) <= wanted.max(ROUNDING_GAP)) {
                return Err(size);
            }
            last = size;
            let (dx, dt) = self.tangent.system.apply(&no_force, &open);
            add_scaled(&mut x, 1.0, &dx);
            add_scaled(&mut tension, 1.0, &dt);
        }
        Err(last)
    }
}
