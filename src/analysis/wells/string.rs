//! The string method: a path of lowest energy between two wells, as a row of states.
//!
//! W. E, W. Ren and E. Vanden-Eijnden, "Simplified and improved string method for computing the minimum energy paths in
//! barrier-crossing events", Journal of Chemical Physics 126, 164103 (2007): the states of the row descend and are then
//! put at equal distances along it, again and again. Distances are those of fold angles, `sqrt(sum k (d rho)^2)`, and
//! both halves of a sweep are one relaxation for every state: held ([`super::settle`]) near the point of the row where
//! it belongs.

use super::settle::{MinimumTracker, Settled};
use crate::numerics::random::numbers;
use crate::solver::{Failure, Observe};
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

impl MinimumTracker {
    /// The row of states between two wells. It begins straight in fold angles, or bent sideways at random, for each number
    /// but zero in another way: a straight one between symmetric states is symmetric and may rest on a ridge.
    pub(super) fn string(&self, ends: [&Settled; 2], bend: u64, observe: Observe<'_>) -> Result<Vec<Settled>, Failure> {
        let mut row = self.grown(ends, &self.sideways(ends, bend), observe)?;
        for _ in 0..SWEEPS {
            let moved = self.sweep(&mut row, observe)?;
            if moved <= AT_REST * self.length(&row) {
                break;
            }
        }
        Ok(row)
    }

    /// Three states of a row around its highest one, twice as near to each other. The given ones are neighbours in the row.
    pub(super) fn refined(&self, around: [Settled; 3], observe: Observe<'_>) -> Result<[Settled; 3], Failure> {
        let [before, top, after] = around;
        let mut middle = |other: &Settled| self.step(&top.place, &between(&top.rho, &other.rho, 0.5), observe);
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
    fn sideways(&self, [from, to]: [&Settled; 2], bend: u64) -> Vec<f64> {
        let nothing = vec![0.0; from.rho.len()];
        if bend == 0 {
            return nothing;
        }
        let random: Vec<f64> = numbers(bend).take(nothing.len()).collect();
        let size = BENT * self.distance(&from.rho, &to.rho) / self.distance(&random, &nothing);
        random.into_iter().map(|turn| size * turn).collect()
    }

    /// States on the way between the fold angles of two wells, each from the one before it, from both ends.
    fn grown(
        &self,
        [from, to]: [&Settled; 2],
        sideways: &[f64],
        observe: Observe<'_>,
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
            row[at] = Some(self.step(&beside.place, &target, observe)?);
        }
        Ok(row.into_iter().flatten().collect())
    }

    /// One sweep; the largest movement of a state.
    fn sweep(&self, row: &mut [Settled], observe: Observe<'_>) -> Result<f64, Failure> {
        let old: Vec<Settled> = row.to_vec();
        let angles: Vec<&[f64]> = old.iter().map(|settled| settled.rho.as_slice()).collect();
        let places = self.stations(&angles);
        let (whole, last) = (places[row.len() - 1], row.len() - 1);
        let mut moved: f64 = 0.0;
        for at in 1..last {
            let station = whole * at as f64 / last as f64;
            let behind = (0..last).rfind(|&k| places[k] <= station).unwrap_or(0);
            let part = (station - places[behind]) / (places[behind + 1] - places[behind]);
            let target = between(&old[behind].rho, &old[behind + 1].rho, part);
            let nearest = if part < 0.5 { behind } else { behind + 1 };
            row[at] = self.step(&old[nearest].place, &target, observe)?;
            moved = moved.max(self.distance(&row[at].rho, &old[at].rho));
        }
        Ok(moved)
    }

    /// Distance of fold angles in the metric of the creases.
    pub fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let squares = a.iter().zip(b).zip(&self.stiffness).map(|((a, b), k)| k * (a - b).powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// Distance of every state along a row of states, which have these fold angles.
    pub(crate) fn stations(&self, row: &[&[f64]]) -> Vec<f64> {
        let mut along = vec![0.0];
        for pair in row.windows(2) {
            along.push(along[along.len() - 1] + self.distance(pair[0], pair[1]));
        }
        along
    }

    fn length(&self, row: &[Settled]) -> f64 {
        row.windows(2).map(|pair| self.distance(&pair[0].rho, &pair[1].rho)).sum()
    }
}

fn between(a: &[f64], b: &[f64], part: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + part * (b - a)).collect()
}
