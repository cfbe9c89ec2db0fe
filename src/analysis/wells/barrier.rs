//! The barrier between two wells: a path with soft bars, its pass, and the pass followed to the sheet's own stiffness.
//!
//! Soft bars, at most a hundred times as stiff as the creases, let the sheet deform from one well to the other even
//! where no rigidly folded states connect them. The string method ([`super::string`]) finds such a path. The highest
//! state on it is close to a pass. Newton's method ([`super::pass`]) converges to the pass, and follows it while the
//! bars become ten times as stiff in each stage, until they have the stiffness of the sheet; infinite stiffness is the
//! last stage.
//!
//! Where bars differ, the stiffness of a stage limits that of every bar: softer bars keep their own. The unit is the
//! stiffness of the median crease. If a stage fails, the path is sought again with stiffer bars, and at last with those
//! of the sheet itself, because some wells exist for stiff bars only. States that slide down from a steep pass are then
//! held with increasing strength.
//!
//! A pass is accepted if its Hessian has exactly one negative eigenvalue, if its energy is above that of both wells,
//! and if the descents to its two sides end in different wells. If these are other wells than the given two, the rest of
//! the way is sought likewise, and the highest pass on it is the barrier.

use super::limit::{Height, STIFFER, flat_energy};
use super::merge::{Comparison, SAME_WELL_ANGLE_RAD, Well, are_close, which};
use super::pass::{Descent, OPTIONS, Pass, equilibrium, sides};
use super::settle::{MinimumTracker, Settled};
use super::string::STRENGTH;
use crate::model::Assembly;
use crate::solver::Failure;
use crate::solver::inertia::in_words;
use thiserror::Error;

/// Stiffness of bars over that of creases at which a path is sought first.
const SOFTEST: f64 = 1e2;
/// Stiffness over that of creases after which the next is the rigid limit.
const ALMOST_RIGID: f64 = 1e12;
/// Farthest fold angle, in radians, from the last pass before the rigid limit to that in the limit. A regular one is
/// approached as one over the stiffness, one where branches cross as its cube root; to that, Newton's steps get no
/// nearer than tolerances ask.
const REGULAR: f64 = 1e-7;
/// Tries from ever stiffer bars, before those of the sheet.
const TRIES: usize = 6;
/// Bent paths that are tried where a straight one leads over a state that is no pass.
const BENDS: u64 = 3;
/// Energies that differ by this part are those of one pass.
const SAME_PASS: f64 = 1e-8;
/// Least distance of two wells in soft bars, over that of the wells of the sheet.
const APART: f64 = 1e-3;
/// How often, at last, a path is held more strongly in the sheet's own bars, and by what factor.
const STRONGEST: i32 = 4;
const STRONGER: f64 = 100.0;
/// How often a row of states is refined around its highest one.
const REFINEMENTS: usize = 5;
/// How often the rest of a way is sought from a pass that joins other wells, in turn.
const LEGS: usize = 3;
/// Shortest factor between two stiffnesses.
const SHORTEST: f64 = 1.05;

/// Why there is no pass.
#[derive(Clone, Debug, Error, PartialEq)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum BarrierError {
    #[error("barriers need linear bars and hinges and no other terms, and here is another: {term}")]
    NotLinear { term: String },
    #[error("with bars of {stiffness:e} the wells are no longer these two")]
    OneWell { stiffness: f64 },
    #[error("the path could not be followed with bars of {stiffness:e}: {failure}")]
    Path { stiffness: f64, failure: Failure },
    #[error("no pass was found with bars of {stiffness:e}: {failure}")]
    NoPass { stiffness: f64, failure: Failure },
    #[error(
        "with bars of {stiffness:e} the equilibrium near the highest state has {} negative eigenvalues, not one",
        in_words(*found)
    )]
    Index { stiffness: f64, found: Option<usize> },
    #[error("the pass that was found, of energy {pass}, lies below a well that it should lead to, of energy {well}")]
    TooLow { pass: f64, well: f64 },
    #[error(
        "the pass that was found, of energy {pass}, leads into a minimum of energy {minimum} that is none of the wells: more starts \
         may find it"
    )]
    UnknownWell { pass: f64, minimum: f64 },
    #[error("the pass that was found, of energy {pass}, leads into well {well} on both sides")]
    OneSided { pass: f64, well: usize },
    #[error(
        "the pass that was found, of energy {pass}, joins wells {joins:?}, and there is no way between {leg:?}: {why}"
    )]
    PartOfTheWay { pass: f64, joins: [usize; 2], leg: [usize; 2], why: Box<Self> },
    #[error("the wells have the same fold angles, and paths are sought between different ones")]
    SameShape,
    #[error("no path was tried")]
    NotTried,
}

/// What was found between two wells.
#[derive(Clone, Debug)]
pub struct Barrier {
    /// The wells between which it was sought.
    pub between: [usize; 2],
    /// The wells into which the sheet descends from the pass; those sought, or others on the way of which it is the highest.
    pub joins: [usize; 2],
    /// The pass, with one negative eigenvalue; where it is singular in rigid bars, the last one that is not.
    pub pass: Pass,
    /// Whether the bars are rigid and the pass, which exists at every finite stiffness, is singular there: branches
    /// cross in it.
    pub singular: bool,
    /// Energy of the flat state, exactly, if the singular pass is that.
    pub flat: Option<f64>,
    /// The pass on its way to this stiffness.
    pub heights: Vec<Height>,
    /// Stiffness of the bars in which the path was found.
    pub stiffness: f64,
    /// The descents from the pass, from the first of the wells that it joins to the second one: distances along them,
    /// in `sqrt(sum k (d rho)^2)`, and energies. Where the pass is singular, in the bars in which it is not.
    pub path: Vec<(f64, f64)>,
}

/// The barrier between two of the wells: the highest pass on the way that is found. `go_on` returns false to stop.
///
/// # Errors
/// [`BarrierError`] where no pass is found, or those that are found make no way between these wells.
pub fn barrier(
    assembly: &Assembly,
    wells: &[Well],
    between: [usize; 2],
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Barrier, BarrierError> {
    if let Some(term) = assembly.terms().first_not_linear() {
        return Err(BarrierError::NotLinear { term: term.to_owned() });
    }
    way(&mut BarrierSearch { assembly, wells, between, go_on }, LEGS)
}

/// The highest pass on the way between the two wells of a search: the one that is found, or where this joins other wells,
/// a higher one on the rest of the way from these. That is sought so many times in turn at most.
fn way(search: &mut BarrierSearch<'_>, legs: usize) -> Result<Barrier, BarrierError> {
    let between = search.between;
    let mut highest = search.lowest_pass()?;
    let (pass, joins @ [a, b]) = (highest.pass.energy, highest.joins);
    let [near, far] = if a == between[1] || b == between[0] { [b, a] } else { joins };
    for leg in [[between[0], near], [far, between[1]]].into_iter().filter(|[a, b]| a != b) {
        search.between = leg;
        let found = if legs > 0 { way(search, legs - 1) } else { Err(BarrierError::NotTried) };
        let found = found.map_err(|why| BarrierError::PartOfTheWay { pass, joins, leg, why: why.into() })?;
        highest = if found.pass.energy > highest.pass.energy { found } else { highest };
    }
    Ok(Barrier { between, ..highest })
}

/// The search for a barrier between two of the wells.
struct BarrierSearch<'a> {
    assembly: &'a Assembly,
    wells: &'a [Well],
    between: [usize; 2],
    go_on: &'a mut dyn FnMut() -> bool,
}

impl BarrierSearch<'_> {
    /// The lowest pass that is found on paths between the wells, whichever wells it joins.
    fn lowest_pass(&mut self) -> Result<Barrier, BarrierError> {
        let Self { assembly, wells, between, .. } = *self;
        let creases = assembly.crease_stiffness();
        let own = assembly.bar_stiffness();
        let softer = (0..TRIES).map(|attempt| SOFTEST * creases * STIFFER.powi(attempt as i32));
        let tried = softer.take_while(|stiffness| *stiffness < own).chain(own.is_finite().then_some(own));
        let (mut failed, mut by_the_way): (_, Option<Barrier>) = (BarrierError::NotTried, None);
        let [one, other] = between.map(|well| &wells[well].settled.rho);
        if are_close(one, other, SAME_WELL_ANGLE_RAD) {
            return Err(BarrierError::SameShape);
        }
        for stiffness in tried {
            for bend in 0..=BENDS {
                match self.sought((stiffness, bend, STRENGTH)) {
                    Ok(found) if found.joins.iter().all(|well| between.contains(well)) => return Ok(found),
                    // over other wells: the way through softer bars may have been the shorter one only there
                    Ok(found) => match by_the_way.take() {
                        Some(before) if same_pass(&before, &found, wells) => {
                            return Ok(before);
                        }
                        before => by_the_way = Some(lower(found, before)),
                    },
                    Err(error) => failed = error,
                }
                if !(self.go_on)() {
                    return Err(failed);
                }
                if by_the_way.is_some() || !matches!(failed, BarrierError::Index { .. }) {
                    break; // a bend is of no use
                }
            }
        }
        match by_the_way {
            Some(found) => Ok(found),
            None if own.is_finite() => self.held_strongly().ok_or(failed),
            None => Err(failed),
        }
    }

    /// The barrier on a path in the sheet's own bars whose states are held ever more strongly: from a pass that is steep
    /// against the creases, as where wells and barrier are made by bars alone, states that are held weakly slide down.
    fn held_strongly(&mut self) -> Option<Barrier> {
        for power in 1..=STRONGEST {
            match self.sought((self.assembly.bar_stiffness(), 0, STRENGTH * STRONGER.powi(power))) {
                Ok(found) => return Some(found),
                Err(_) if (self.go_on)() => {}
                Err(_) => break,
            }
        }
        None
    }

    /// The barrier by way of a path in bars of a stiffness, which begins with the bend of a number, and whose states are
    /// held so strongly.
    fn sought(&mut self, (stiffness, bend, strength): (f64, u64, f64)) -> Result<Barrier, BarrierError> {
        let Self { assembly, wells, between, .. } = *self;
        let failed = |failure| BarrierError::Path { stiffness, failure };
        let settler = MinimumTracker::new(&assembly.with_bars_at_most(stiffness), strength);
        let mut soft = Vec::new();
        for well in between {
            let place = &wells[well].settled.place;
            let found = settler.free(&place.without_tension(), OPTIONS, &mut |_| (self.go_on)());
            soft.push(found.map_err(|error| failed(error.failure))?);
        }
        let apart = |soft: &Settled, well: usize| settler.distance(&soft.rho, &wells[well].settled.rho);
        // further from its well than half the way to the other, a state is likely to be a third one
        let way = settler.distance(&wells[between[0]].settled.rho, &wells[between[1]].settled.rho);
        let stayed = (0..2).all(|k| apart(&soft[k], between[k]) < 0.5 * way);
        if !stayed || settler.distance(&soft[0].rho, &soft[1].rho) <= APART * way {
            return Err(BarrierError::OneWell { stiffness });
        }
        let row = settler.string([&soft[0], &soft[1]], bend, &mut |_| (self.go_on)()).map_err(failed)?;
        let top = (1..row.len() - 1).max_by(|&a, &b| row[a].energy.total_cmp(&row[b].energy)).unwrap_or(0);
        let along: Vec<f64> = row[top + 1].rho.iter().zip(&row[top - 1].rho).map(|(a, b)| 0.25 * (a - b)).collect();
        let around = [top - 1, top, top + 1].map(|at| row[at].clone());
        let first = self.near_top(stiffness, &settler, around)?;
        let (pass, heights, singular) = followed(assembly, first, stiffness)?;
        let own = if singular {
            heights.last().map_or(stiffness, |height| height.stiffness)
        } else {
            assembly.bar_stiffness()
        };
        let ends = sides(&assembly.with_bars_at_most(own), &pass, &along).map_err(failed)?;
        let comparison = Comparison::new(assembly);
        let number = |end: &Settled| which(wells, &end.relaxed.state, &comparison);
        let higher = between.iter().map(|well| wells[*well].settled.energy).fold(f64::NEG_INFINITY, f64::max);
        if !(pass.energy > higher) {
            return Err(BarrierError::TooLow { pass: pass.energy, well: higher });
        }
        let path = over(&settler, &pass, &ends);
        match [number(&ends[1].end), number(&ends[0].end)] {
            [Some(a), Some(b)] if a != b => {
                let flat = if singular { flat_energy(assembly, &pass, &heights) } else { None };
                Ok(Barrier { between, joins: [a, b], pass, singular, flat, heights, stiffness, path })
            }
            [Some(well), Some(_)] => Err(BarrierError::OneSided { pass: pass.energy, well }),
            [None, _] => Err(BarrierError::UnknownWell { pass: pass.energy, minimum: ends[1].end.energy }),
            [_, None] => Err(BarrierError::UnknownWell { pass: pass.energy, minimum: ends[0].end.energy }),
        }
    }

    /// The pass near the middle one of three neighbours in a row of states. Where Newton's method ends in none, or in a
    /// minimum next to it, the row is refined there.
    fn near_top(
        &mut self,
        stiffness: f64,
        settler: &MinimumTracker,
        mut around: [Settled; 3],
    ) -> Result<Pass, BarrierError> {
        let mut first = None;
        for _ in 0..=REFINEMENTS {
            let [before, top, after] = &around;
            match index_one(self.assembly, stiffness, [top, before, after]) {
                Ok(pass) => return Ok(pass),
                Err(error @ (BarrierError::Index { found: Some(0), .. } | BarrierError::NoPass { .. })) => {
                    first.get_or_insert(error);
                }
                Err(error) => return Err(first.unwrap_or(error)),
            }
            let failed = |failure| BarrierError::Path { stiffness, failure };
            around = settler.refined(around, &mut |_| (self.go_on)()).map_err(failed)?;
        }
        Err(first.unwrap_or(BarrierError::NotTried))
    }
}

/// Whether two barriers have one pass: its energy, or its height where loads put the zero of the energy elsewhere, is
/// the same.
fn same_pass(a: &Barrier, b: &Barrier, wells: &[Well]) -> bool {
    let height = b.pass.energy - wells[b.joins[0]].settled.energy;
    (a.pass.energy - b.pass.energy).abs() <= SAME_PASS * b.pass.energy.abs().max(height)
}

/// The one with the lower pass.
fn lower(found: Barrier, other: Option<Barrier>) -> Barrier {
    other.filter(|other| other.pass.energy <= found.pass.energy).unwrap_or(found)
}

/// Returns the distances along the descents to both sides of a pass, and the energies there: from the end of the second
/// descent up to the pass, and down the first one.
fn over(settler: &MinimumTracker, pass: &Pass, [one, other]: &[Descent; 2]) -> Vec<(f64, f64)> {
    let row = other.row().rev().chain([(pass.rho.as_slice(), pass.energy)]).chain(one.row());
    let (angles, energies): (Vec<&[f64]>, Vec<f64>) = row.unzip();
    settler.stations(&angles).into_iter().zip(energies).collect()
}

/// The pass next to the first of these states at which there is one.
fn index_one(assembly: &Assembly, stiffness: f64, near: [&Settled; 3]) -> Result<Pass, BarrierError> {
    let mut why = None;
    for state in near {
        let reason = match equilibrium(&assembly.with_bars_at_most(stiffness), &state.place) {
            Ok(pass) if pass.negative_eigenvalues == Some(1) => return Ok(pass),
            Ok(pass) => BarrierError::Index { stiffness, found: pass.negative_eigenvalues },
            Err(failure) => BarrierError::NoPass { stiffness, failure },
        };
        why.get_or_insert(reason);
    }
    Err(why.unwrap_or(BarrierError::NotTried))
}

/// The pass with ever stiffer bars, up to those of the sheet.
fn followed(assembly: &Assembly, first: Pass, stiffness: f64) -> Result<(Pass, Vec<Height>, bool), BarrierError> {
    let goal = assembly.bar_stiffness();
    let creases = assembly.crease_stiffness();
    let mut heights = vec![Height { stiffness, energy: first.energy }];
    let (mut pass, mut at, mut factor) = (first, stiffness, STIFFER);
    while at < goal {
        let next = if at >= ALMOST_RIGID * creases { goal } else { (at * factor).min(goal) };
        match equilibrium(&assembly.with_bars_at_most(next), &pass.place) {
            Ok(found)
                if found.negative_eigenvalues == Some(1)
                    && (next.is_finite() || are_close(&found.rho, &pass.rho, REGULAR)) =>
            {
                heights.push(Height { stiffness: next, energy: found.energy });
                (pass, at, factor) = (found, next, (factor * factor).min(STIFFER));
            }
            _ if next.is_infinite() => return Ok((pass, heights, true)),
            Ok(found) if factor < SHORTEST => {
                return Err(BarrierError::Index { stiffness: next, found: found.negative_eigenvalues });
            }
            Err(failure) if factor < SHORTEST => return Err(BarrierError::NoPass { stiffness: next, failure }),
            _ => factor = factor.sqrt(),
        }
    }
    Ok((pass, heights, false))
}
