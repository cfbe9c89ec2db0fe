//! The string method: a path of lowest energy between two wells, as a row of states.
//!
//! W. E, W. Ren and E. Vanden-Eijnden, "Simplified and improved string method for computing the minimum energy paths in
//! barrier-crossing events", Journal of Chemical Physics 126, 164103 (2007): the states of the row descend and are then
//! put at equal distances along it, again and again. Distances are those of fold angles, `sqrt(sum k (d rho)^2)`, and
//! both halves of a sweep are one relaxation for every state: held ([`super::settle`]) near the point of the row where
//! it belongs.

use super::settle::{MinimumTracker, Settled};
use crate::numerics::random::numbers;
use crate::solver::{Failure, Options, Step};
use std::f64::consts::PI;

/// Strength with which states of the row are held: the step of the descent is one over it.
pub(crate) const STRENGTH: f64 = 32.0;
/// States of the row, its ends included.
const STATES: usize = 17;
/// Most sweeps, and the movement in a sweep, over the length of the row, at which it is at rest.
const SWEEPS: usize = 80;
const AT_REST: f64 = 1e-3;
/// How far a bent row is from the straight one in its middle, over its length.
const BENT: f64 = 0.1;
/// When the states of a row are converged.
const STRING_OPTIONS: Options = Options { tolerance: 1e-10, iterations: 60 };

/// The row of states between two wells. It begins straight in fold angles, or bent sideways at random, for each number
/// but zero in another way: a straight one between symmetric states is symmetric and may rest on a ridge.
pub(crate) fn string(
    settler: &MinimumTracker,
    [from, to]: [&Settled; 2],
    bend: u64,
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<Vec<Settled>, Failure> {
    let sideways = sideways(settler, [from, to], bend);
    let mut row = grown(settler, [from, to], &sideways, observe)?;
    for _ in 0..SWEEPS {
        let moved = sweep(settler, &mut row, observe)?;
        if moved <= AT_REST * length(settler, &row) {
            break;
        }
    }
    Ok(row)
}

/// Three states of a row around its highest one, twice as near to each other. The given ones are neighbours in the row.
pub(crate) fn refined(
    settler: &MinimumTracker,
    [before, top, after]: [Settled; 3],
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<[Settled; 3], Failure> {
    let mut middle = |other: &Settled| {
        let target = between(&top.rho, &other.rho, 0.5);
        settler.near(&top.place, &target, STRING_OPTIONS, observe).map_err(|error| error.failure)
    };
    let (first, second) = (middle(&before)?, middle(&after)?);
    Ok(if first.energy > top.energy.max(second.energy) {
        [before, first, top]
    } else if second.energy > top.energy {
        [top, second, after]
    } else {
        [first, top, second]
    })
}

/// The largest change of fold angles in a bend.
fn sideways(settler: &MinimumTracker, [from, to]: [&Settled; 2], bend: u64) -> Vec<f64> {
    let nothing = vec![0.0; from.rho.len()];
    if bend == 0 {
        return nothing;
    }
    let random: Vec<f64> = numbers(bend).take(nothing.len()).collect();
    let size = BENT * distance(settler, &from.rho, &to.rho) / distance(settler, &random, &nothing);
    random.into_iter().map(|turn| size * turn).collect()
}

/// States on the way between the fold angles of two wells, each from the one before it, from both ends.
fn grown(
    settler: &MinimumTracker,
    [from, to]: [&Settled; 2],
    sideways: &[f64],
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<Vec<Settled>, Failure> {
    let mut row: Vec<Option<Settled>> = vec![None; STATES];
    row[0] = Some(from.clone());
    row[STATES - 1] = Some(to.clone());
    let inner = (1..STATES - 1).map(|k| if k % 2 == 1 { (k.div_ceil(2), -1) } else { (STATES - 1 - k / 2, 1) });
    for (at, back) in inner {
        let part = at as f64 / (STATES - 1) as f64;
        let beside = row[at.wrapping_add_signed(back)].clone().unwrap_or_else(|| from.clone());
        let mut target = between(&from.rho, &to.rho, part);
        target.iter_mut().zip(sideways).for_each(|(rho, turn)| *rho += turn * (PI * part).sin());
        let found = settler.near(&beside.place, &target, STRING_OPTIONS, observe).map_err(|error| error.failure)?;
        row[at] = Some(found);
    }
    Ok(row.into_iter().flatten().collect())
}

/// One sweep; the largest movement of a state.
fn sweep(
    settler: &MinimumTracker,
    row: &mut [Settled],
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<f64, Failure> {
    let old: Vec<Settled> = row.to_vec();
    let angles: Vec<&[f64]> = old.iter().map(|settled| settled.rho.as_slice()).collect();
    let places = stations(settler, &angles);
    let (whole, last) = (places[row.len() - 1], row.len() - 1);
    let mut moved: f64 = 0.0;
    for at in 1..last {
        let station = whole * at as f64 / last as f64;
        let behind = (0..last).rfind(|&k| places[k] <= station).unwrap_or(0);
        let part = (station - places[behind]) / (places[behind + 1] - places[behind]);
        let target = between(&old[behind].rho, &old[behind + 1].rho, part);
        let nearest = if part < 0.5 { behind } else { behind + 1 };
        let found =
            settler.near(&old[nearest].place, &target, STRING_OPTIONS, observe).map_err(|error| error.failure)?;
        moved = moved.max(distance(settler, &found.rho, &old[at].rho));
        row[at] = found;
    }
    Ok(moved)
}

fn between(a: &[f64], b: &[f64], part: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + part * (b - a)).collect()
}

/// Distance of fold angles in the metric of the creases.
pub fn distance(settler: &MinimumTracker, a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).zip(settler.stiffness()).map(|((a, b), k)| k * (a - b).powi(2));
    squares.sum::<f64>().sqrt()
}

/// Distance of every state along a row of states, which have these fold angles.
pub(crate) fn stations(settler: &MinimumTracker, row: &[&[f64]]) -> Vec<f64> {
    let mut along = vec![0.0];
    for pair in row.windows(2) {
        along.push(along[along.len() - 1] + distance(settler, pair[0], pair[1]));
    }
    along
}

fn length(settler: &MinimumTracker, row: &[Settled]) -> f64 {
    row.windows(2).map(|pair| distance(settler, &pair[0].rho, &pair[1].rho)).sum()
}
