//! What was compared and what fell.

use crate::trial::{Answer, Trial};
use std::collections::BTreeMap;

/// Energies agree to this part of themselves. Residual forces of 1e-12 over the softest eigenvalue, squared, are far
/// below; what is left is the rounding of angles far from rest.
pub const SAME: f64 = 1e-8;

/// Comparisons of two equilibria that the same sheet has.
pub const ELSEWHERE: &str = "two equilibria";

#[derive(Default)]
pub struct Report {
    /// Comparisons made, and those in which one side had no answer, by kind.
    pub made: BTreeMap<&'static str, [usize; 2]>,
    /// Kinds of failures that were said.
    pub said: BTreeMap<String, usize>,
    pub fell: Vec<String>,
}

impl Report {
    pub fn count(&mut self, kind: &'static str, answered: bool) {
        self.made.entry(kind).or_default()[usize::from(!answered)] += 1;
    }

    pub fn judge(&mut self, kind: &'static str, ok: bool, what: impl Fn() -> String) {
        self.count(kind, true);
        if !ok {
            self.fell.push(format!("{kind}: {}", what()));
        }
    }

    /// Energies, the other one over its unit, must agree; or else the sheet has both equilibria, which is counted
    /// apart: a flat one in the state of the other, whose coordinates are those of this drawing, any in what random
    /// starts reach.
    pub fn compare(
        &mut self,
        kind: &'static str,
        one: (&Trial, &Answer),
        other: &Result<Answer, String>,
        unit: f64,
        what: &str,
    ) {
        let (trial, answer) = one;
        let other = match other {
            Ok(other) => other,
            Err(message) => return self.unanswered(kind, message),
        };
        let energy = other.energy / unit;
        let rounding = SAME * answer.energy.abs() + 1e-13 + answer.open + other.open / unit;
        let same = (energy - answer.energy).abs() <= rounding;
        let such = |found: f64, _: &[f64]| (found - energy).abs() <= 10.0 * SAME * energy;
        if !same
            && ([answer.negative, other.negative] != [Some(0); 2]
                || trial.starts_flat() && trial.has_minimum_at(&other.coordinates, such)
                || trial.has_equilibrium(such))
        {
            return self.count(ELSEWHERE, true);
        }
        self.judge(kind, same, || format!("{what}: {:e} and {energy:e}", answer.energy));
    }

    pub fn unanswered(&mut self, kind: &'static str, message: &str) {
        self.count(kind, false);
        *self.said.entry(format!("{kind}: {}", words(message))).or_default() += 1;
    }

    /// Both reports as one.
    pub fn and(mut self, other: Self) -> Self {
        for (kind, [made, not]) in other.made {
            let counts = self.made.entry(kind).or_default();
            *counts = [counts[0] + made, counts[1] + not];
        }
        other.said.into_iter().for_each(|(what, count)| *self.said.entry(what).or_default() += count);
        self.fell.extend(other.fell);
        self
    }
}

/// A message without its numbers.
pub fn words(message: &str) -> String {
    message.split(' ').filter(|word| !word.contains(|c: char| c.is_ascii_digit())).collect::<Vec<_>>().join(" ")
}
