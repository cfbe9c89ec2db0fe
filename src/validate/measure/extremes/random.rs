//! Random scenes in a row: none may be wrong, hang or panic.

use super::super::super::experiment::{Bench, ExperimentError, Findings, Grid};
use super::super::trial::{Outcome, Rest, Trial};
use super::{Tally, said};
use foldwell::model::Boundary;
use foldwell::numerics::parallel;
use foldwell::sheet::generate::Random;
use foldwell::sheet::{Pattern, generate};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const FEW: usize = 300;
const MANY: usize = 10_000;
/// So many are shared out to the threads at a time.
const BATCH: usize = 100;
/// What is allowed in fold angles, in radians: residuals of 1e-12 over the softest eigenvalue, about 0.01. Screws are no exception, since
/// force along the direction of their axis is measured where the curvature is one.
const ALLOWED: f64 = 1e-9;

/// The first three hundred random scenes.
pub fn random_scenes(bench: &Bench) -> Result<Findings, ExperimentError> {
    in_a_row(bench, FEW)
}

/// Ten thousand random scenes.
pub fn ten_thousand_scenes(bench: &Bench) -> Result<Findings, ExperimentError> {
    in_a_row(bench, MANY)
}

/// Relaxes random sheets in a row: cells of 4 to 12 vertices, patches, tori and screws, bars of 1e2 to 1e16 or rigid,
/// rest angles off by 1e-6 to 0.3 rad.
fn in_a_row(bench: &Bench, count: usize) -> Result<Findings, ExperimentError> {
    let mut numbers = ChaCha8Rng::seed_from_u64(7);
    let (mut tally, mut rows) = (Tally::default(), Vec::new());
    for first in (0..count).step_by(BATCH) {
        bench.step(first, count)?;
        let seeds = first..count.min(first + BATCH);
        let trials: Vec<Trial> =
            seeds.map(|seed| random_trial(&mut numbers, seed as u64)).collect::<Result<_, ExperimentError>>()?;
        let outcomes = parallel::map_with_state(trials.len(), || (), |(), k| trials[k].judged(ALLOWED));
        for (trial, outcome) in trials.iter().zip(&outcomes) {
            tally.add(&trial.description(), outcome);
            if let Outcome::Refused(_) | Outcome::Wrong(_) = outcome {
                rows.push(vec![trial.description(), said(outcome)]);
            }
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
    let boundary = [Boundary::Patch, Boundary::Screw, Boundary::FreeTorus, Boundary::FixedTorus][below(4)];
    let cells = if boundary == Boundary::Screw { [1, 1] } else { [1 + below(3), 1 + below(3)] };
    let rigid = below(3) == 0;
    let (power, spread) = (2.0 + 14.0 * numbers.random::<f64>(), 10f64.powf(-6.0 + 5.5 * numbers.random::<f64>()));
    let bars = if rigid { f64::INFINITY } else { 10f64.powf(power) };
    let sheet = generate(&Pattern::Random(Random { size, seed, ..Random::default() }))
        .map_err(|_| ExperimentError::Other("a random cell cannot be generated".into()))?;
    Ok(Trial { sheet, cells, boundary, stiffness: [bars, 1.0], rest: Rest::Random(spread, seed), lock: None })
}
