//! Stiff and extreme cases: each is right, or refused for a reason; never a silent wrong number, a hang or a panic.

mod families;

use super::super::experiment::{Bench, ExperimentError, Findings, Grid};
use super::trial::{Outcome, Rest, Trial};
use crate::model::assemble::Surroundings;
use crate::sheet::generate::Random;
use crate::sheet::{Pattern, generate};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

/// Random scenes in a row.
const QUICK: usize = 300;
const LONG: usize = 10_000;

/// What is allowed in fold angles of random scenes, in radians: residuals of 1e-12 over the softest eigenvalue, about 0.01. Screws are
/// no exception, since force along the direction of their axis is measured where the curvature is one.
const ALLOWED: f64 = 1e-9;

/// How many trials came out how, and what was wrong.
#[derive(Default)]
struct Tally {
    right: usize,
    unjudged: usize,
    refused: usize,
    wrong: Vec<String>,
}

impl Tally {
    fn add(&mut self, name: &str, outcome: &Outcome) {
        match outcome {
            Outcome::Right(_) => self.right += 1,
            Outcome::Unjudged => self.unjudged += 1,
            Outcome::Refused(_) => self.refused += 1,
            Outcome::Wrong(reason) => self.wrong.push(format!("{name}: {reason}")),
        }
    }

    fn values(&self) -> Value {
        json!({
            "trials": self.all(),
            "right": self.right,
            "refused": self.refused,
            "part refused": self.refused as f64 / self.all() as f64,
            "unjudged": self.unjudged,
            "wrong": self.wrong.len(),
        })
    }

    fn all(&self) -> usize {
        self.right + self.unjudged + self.refused + self.wrong.len()
    }
}

/// Tries every family, case by case.
pub fn measure(bench: &Bench) -> Result<Findings, ExperimentError> {
    let families = families::families(bench.quick)?;
    let all: usize = families.iter().map(|family| family.cases.len()).sum();
    let (mut tally, mut rows) = (Tally::default(), Vec::new());
    for family in families {
        for (name, attempt) in family.cases {
            bench.step(tally.all(), all)?;
            let outcome = attempt();
            tally.add(&format!("{}, {name}", family.name), &outcome);
            rows.push(vec![family.name.to_owned(), name, said(&outcome), family.compared.to_owned()]);
        }
    }
    let header = ["what is extreme", "case", "what happens", "compared with"].map(str::to_owned).to_vec();
    let title = "Stiff and extreme cases, and the limits found".into();
    Ok(Findings { values: tally.values(), tables: vec![Grid { title, header, rows }], ..Findings::default() })
}

fn said(outcome: &Outcome) -> String {
    match outcome {
        Outcome::Right(error) => format!("right to {error:.0e}"),
        Outcome::Unjudged => "converged, nothing to compare with".into(),
        Outcome::Refused(reason) => format!("refused: {reason}"),
        Outcome::Wrong(reason) => format!("WRONG: {reason}"),
    }
}

/// Relaxes random sheets in a row: cells of 4 to 12 vertices, patches, tori and screws, bars of 1e2 to 1e16 or rigid,
/// rest angles off by 1e-6 to 0.3 rad.
pub fn random_scenes(bench: &Bench) -> Result<Findings, ExperimentError> {
    let count = if bench.quick { QUICK } else { LONG };
    let mut numbers = ChaCha8Rng::seed_from_u64(7);
    let mut tally = Tally::default();
    let mut rows = Vec::new();
    for seed in 0..count {
        if seed % 10 == 0 {
            bench.step(seed, count)?;
        }
        let trial = random_trial(&mut numbers, seed as u64)?;
        let outcome = trial.judged(ALLOWED);
        tally.add(&trial.description(), &outcome);
        if let Outcome::Refused(_) | Outcome::Wrong(_) = &outcome {
            rows.push(vec![trial.description(), said(&outcome)]);
        }
    }
    let header = ["scene", "what happens"].map(str::to_owned).to_vec();
    let (right, unjudged) = (tally.right, tally.unjudged);
    let title = format!(
        "{count} random scenes in a row: {right} right, {unjudged} with nothing to compare with, and the others"
    );
    Ok(Findings { values: tally.values(), tables: vec![Grid { title, header, rows }], ..Findings::default() })
}

fn random_trial(numbers: &mut ChaCha8Rng, seed: u64) -> Result<Trial, ExperimentError> {
    let mut below = |most: usize| ((numbers.random::<f64>() * most as f64) as usize).min(most - 1);
    let size = [2 + below(2), 2 + below(3)];
    let surroundings =
        [Surroundings::Patch, Surroundings::Screw, Surroundings::FreeTorus, Surroundings::FixedTorus][below(4)];
    let cells = if surroundings == Surroundings::Screw { [1, 1] } else { [1 + below(3), 1 + below(3)] };
    let rigid = below(3) == 0;
    let (power, spread) = (2.0 + 14.0 * numbers.random::<f64>(), 10f64.powf(-6.0 + 5.5 * numbers.random::<f64>()));
    let bars = if rigid { f64::INFINITY } else { 10f64.powf(power) };
    let sheet = generate(&Pattern::Random(Random { size, seed, ..Random::default() }))
        .map_err(|_| ExperimentError::Other("a random cell cannot be generated".into()))?;
    Ok(Trial { sheet, cells, surroundings, stiffness: [bars, 1.0], rest: Rest::Random(spread, seed), lock: None })
}
