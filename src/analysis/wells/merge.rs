//! Wells told apart by their fold angles: rigid motions change none of them, and the translations of a torus exchange
//! them. Where pins or rigid parts make a difference between places of one shape ([`super::placement`]) they are told
//! apart by these too.
//!
//! A translation counts where it leaves stiffnesses, rest angles and locked angles as they are. Angles are not taken
//! modulo whole turns, because the energy is not: a crease wound once more is another well, and passes through itself.

use super::placement::PlacementConditions;
use super::settle::Settled;
use crate::analysis::state::State;
use crate::model::{Assembly, Gauge, Hinges, Spring, Stiffness};
use std::collections::HashMap;
use std::iter::successors;

/// Largest difference of a fold angle between two finds of one well, in radians.
pub(crate) const SAME_WELL_ANGLE_RAD: f64 = 1e-5;

/// Torque of a hinge over its stiffness, in radians, up to which it is a rounding error of an equilibrium.
const NO_TORQUE_RAD: f64 = 1e-11;

/// Rest angles of copies of a crease that are the same differ by no more, in radians; stiffnesses relative to them.
const ROUNDING: f64 = 1e-9;

/// Whether angles differ by at most this much, each.
pub(super) fn are_close(a: &[f64], b: &[f64], most: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= most)
}

/// A stable state.
#[derive(Clone, Debug)]
pub struct Well {
    /// Its first find.
    pub settled: Settled,
    /// How many starts reached it.
    pub reached: usize,
}

/// The translations of a torus that its energy does not feel, each as the edge to which every edge of the tiling goes;
/// elsewhere only the one that moves nothing.
fn translations(assembly: &Assembly) -> Vec<Vec<usize>> {
    let tiling = assembly.tiling();
    if !tiling.periodic {
        return vec![(0..tiling.edges.len()).collect()];
    }
    let number: HashMap<(usize, [usize; 2]), usize> =
        tiling.edges.iter().enumerate().map(|(k, edge)| ((edge.edge, edge.cell), k)).collect();
    let [n1, n2] = tiling.cells;
    let shifts = (0..n2).flat_map(|m2| (0..n1).map(move |m1| [m1, m2]));
    let moved = |[m1, m2]: [usize; 2]| -> Vec<usize> {
        let to = |[c1, c2]: [usize; 2]| [(c1 + m1) % n1, (c2 + m2) % n2];
        tiling.edges.iter().map(|edge| number[&(edge.edge, to(edge.cell))]).collect()
    };
    shifts.map(moved).filter(|moved| unfelt(assembly, moved)).collect()
}

/// Whether stiffnesses, rest angles and locks go over into themselves.
fn unfelt(assembly: &Assembly, moved: &[usize]) -> bool {
    let terms = assembly.terms();
    let even = |stiffness: &Stiffness| {
        let mut pairs = moved.iter().enumerate().map(|(from, &to)| [from, to].map(|edge| stiffness.of(edge)));
        pairs.all(|[a, b]| a == b || (a - b).abs() <= ROUNDING * a.abs() || (a.is_nan() && b.is_nan()))
    };
    let same = |hinges: &Option<Hinges>| {
        let Some(Hinges { rest, stiffness }) = hinges else { return true };
        let mut pairs = rest.iter().zip(moved).map(|(from, &to)| [*from, rest[to]]);
        even(stiffness) && pairs.all(|[a, b]| (a - b).abs() <= ROUNDING || (a.is_nan() && b.is_nan()))
    };
    let locks: HashMap<usize, f64> = terms.locks.iter().copied().collect();
    let locked = |edge: usize, angle: f64| locks.get(&edge).is_some_and(|other| (other - angle).abs() <= ROUNDING);
    let bars = terms.bar_stiffness().is_none_or(even);
    let stays = moved.iter().enumerate().all(|(from, to)| from == *to);
    (terms.own.is_empty() || stays)
        && bars
        && same(&terms.creases)
        && same(&terms.facets)
        && locks.iter().all(|(edge, angle)| locked(moved[*edge], *angle))
}

/// A test of whether two states are the same well.
#[derive(Clone, Debug)]
pub struct Comparison {
    translations: Vec<Vec<usize>>,
    /// The rest angle of each edge, and the distance from it within which its hinge hardly pulls.
    slack: Vec<[f64; 2]>,
    placement: Option<PlacementConditions>,
}

/// Returns for each edge the rest angle of its hinge and the distance from it within which the hinge pulls less than
/// equilibria are solved for: none to speak of for a spring, but laws that have no stiffness at rest leave angles there
/// unknown, and states that differ in these alone are one.
fn slack(assembly: &Assembly) -> Vec<[f64; 2]> {
    let model = assembly.model(Gauge::Held);
    let mut slack = vec![[0.0; 2]; model.edges()];
    for hinge in model.soft().filter(|hinge| hinge.is_angle() && hinge.has_law()) {
        let Some(edge) = hinge.edge() else { continue };
        let Spring { rest, stiffness } = hinge.spring;
        let pulls = |off: f64| {
            [rest - off, rest + off].iter().any(|at| hinge.response(*at)[1].abs() > NO_TORQUE_RAD * stiffness)
        };
        let widths = successors(Some(SAME_WELL_ANGLE_RAD), |width| Some(1.2 * width));
        slack[edge] = [rest, widths.take_while(|width| *width < 1.0 && !pulls(*width)).last().unwrap_or(0.0)];
    }
    slack
}

impl Comparison {
    /// Prepares the test for the states of a sheet.
    pub fn new(assembly: &Assembly) -> Self {
        Self {
            translations: translations(assembly),
            slack: slack(assembly),
            placement: PlacementConditions::new(assembly),
        }
    }

    /// Smallest over the translations of the largest difference of two lists of fold angles of all edges; angles at which
    /// hinges do not pull are no different.
    pub fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let differ = |moved: &Vec<usize>| {
            let pairs = moved.iter().zip(&self.slack).zip(a).map(|((&to, slack), a)| (slack, [*a, b[to]]));
            let felt = pairs.filter(|([rest, slack], pair)| !pair.iter().all(|at| (at - rest).abs() <= *slack));
            felt.map(|(_, [a, b])| (a - b).abs()).filter(|d| !d.is_nan()).fold(0.0, f64::max)
        };
        self.translations.iter().map(differ).fold(f64::INFINITY, f64::min)
    }

    /// Whether two states are one.
    fn same(&self, a: &State, b: &State) -> bool {
        self.distance(&a.fold_angle, &b.fold_angle) <= SAME_WELL_ANGLE_RAD
            && self.placement.as_ref().is_none_or(|placement| placement.leads(&a.coordinates, &b.coordinates))
    }
}

/// The wells among these states, sorted by energy.
pub fn wells(found: impl Iterator<Item = Settled>, comparison: &Comparison) -> Vec<Well> {
    let mut wells: Vec<Well> = Vec::new();
    for settled in found {
        let known = wells.iter_mut().find(|well| comparison.same(&well.settled.relaxed.state, &settled.relaxed.state));
        match known {
            Some(well) => well.reached += 1,
            None => wells.push(Well { settled, reached: 1 }),
        }
    }
    wells.sort_by(|a, b| a.settled.energy.total_cmp(&b.settled.energy));
    wells
}

/// The number of the well that a state is.
pub(crate) fn which(wells: &[Well], state: &State, comparison: &Comparison) -> Option<usize> {
    wells.iter().position(|well| comparison.same(&well.settled.relaxed.state, state))
}
