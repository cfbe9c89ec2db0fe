//! The orders in which the states of a study are shown one after the other: one for each branch.
//!
//! A trajectory leaves the drawn state in two directions. Its states are shown from the end of the negative direction
//! back to the drawn state and on to the end of the positive one, so that no state jumps to a distant one. A direction
//! that comes back to its first state is a sequence of its own, since the other one may lead round the same loop.

use super::table::columns_of;
use crate::math::{Vec3, bounds};
use serde::Serialize;

/// Largest distance between the first and the last state of a closed trajectory, relative to the extent of the sheet.
const CLOSED: f64 = 1e-6;

/// States in the order in which they are shown.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Sequence {
    /// Name of the sequence; empty if it is the only one of the study.
    pub name: String,
    /// Numbers of the states.
    pub states: Vec<usize>,
}

/// The place of a state on the branches of its study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// Number of the branch; `None` if the study has no branches.
    pub branch: Option<i64>,
    /// Direction along the branch, 1 or -1; `None` if branches have one direction only.
    pub sign: Option<i64>,
}

/// Returns the places of states on their branches, by their rows in the table of the study; no branches if there is no
/// table.
pub(crate) fn places(table: Option<&str>, rows: impl Iterator<Item = Option<usize>>) -> Vec<Place> {
    let table = columns_of(table.unwrap_or_default(), &["branch", "sign"]);
    let number = |row: Option<usize>, column: usize| {
        let value = table.get(row?)?[column];
        value.is_finite().then_some(value as i64)
    };
    rows.map(|row| Place { branch: number(row, 0), sign: number(row, 1) }).collect()
}

/// Returns the sequences of states, given with their places in the order of the table of the study, and with their
/// points.
pub(crate) fn sequences(states: &[(Place, &[Vec3])]) -> Vec<Sequence> {
    let mut runs: Vec<(Place, Vec<usize>)> = Vec::new();
    for (number, (place, _)) in states.iter().enumerate() {
        match runs.last_mut() {
            Some((last, run)) if last == place => run.push(number),
            _ => runs.push((*place, vec![number])),
        }
    }
    let mut found: Vec<Sequence> = Vec::new();
    let mut rest = runs.into_iter().peekable();
    while let Some((place, run)) = rest.next() {
        let opposite = rest.next_if(|(next, run)| {
            let turned =
                place.sign.is_some() && next.branch == place.branch && next.sign == place.sign.map(|sign| -sign);
            turned && !is_closed(states, run)
        });
        match opposite {
            Some((_, other)) if !is_closed(states, &run) => {
                let [plus, minus] = if place.sign == Some(-1) { [other, run] } else { [run, other] };
                // both directions begin at the same state, which is shown once
                let states = minus.iter().rev().chain(plus.iter().skip(1)).copied().collect();
                found.push(Sequence { name: name(Place { sign: None, ..place }), states });
            }
            other => {
                found.push(Sequence { name: name(place), states: run });
                found.extend(other.map(|(place, states)| Sequence { name: name(place), states }));
            }
        }
    }
    if let [only] = &mut found[..] {
        only.name.clear();
    }
    found
}

fn name(place: Place) -> String {
    let branch = place.branch.map_or("all states".to_owned(), |branch| format!("branch {branch}"));
    match place.sign {
        None => branch,
        Some(sign) if sign < 0 => format!("{branch}, direction \u{2212}"),
        Some(_) => format!("{branch}, direction +"),
    }
}

/// Whether the last state of a sequence is its first one.
fn is_closed(states: &[(Place, &[Vec3])], run: &[usize]) -> bool {
    let (Some(first), Some(last)) = (run.first(), run.last()) else { return false };
    let (first, last) = (states[*first].1, states[*last].1);
    let [low, high] = bounds(first);
    let apart = first.iter().zip(last).map(|(a, b)| (b - a).amax()).fold(0.0, f64::max);
    run.len() > 2 && first.len() == last.len() && apart <= CLOSED * (high - low).amax()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns states of one point beside a fixed one, the point at these places.
    fn states(table: &[(i64, i64, f64)]) -> Vec<(Place, Vec<Vec3>)> {
        let state = |&(branch, sign, x): &(i64, i64, f64)| {
            (Place { branch: Some(branch), sign: Some(sign) }, vec![Vec3::zeros(), Vec3::new(x, 0.0, 1.0)])
        };
        table.iter().map(state).collect()
    }

    fn found(states: &[(Place, Vec<Vec3>)]) -> Vec<(String, Vec<usize>)> {
        let views: Vec<(Place, &[Vec3])> = states.iter().map(|(place, points)| (*place, points.as_slice())).collect();
        sequences(&views).into_iter().map(|sequence| (sequence.name, sequence.states)).collect()
    }

    /// Claim: the two directions of a branch make one sequence that never jumps, and the drawn state is in it once.
    /// Exact: the order of numbers.
    #[test]
    fn both_directions_are_one_sequence() {
        let table = [(0, 1, 0.0), (0, 1, 0.1), (0, 1, 0.2), (0, -1, 0.0), (0, -1, -0.1), (1, 1, 0.0), (1, 1, 0.5)];
        let expected = [("branch 0".to_owned(), vec![4, 3, 1, 2]), ("branch 1, direction +".to_owned(), vec![5, 6])];
        assert_eq!(found(&states(&table)), expected);
        let [only] = &found(&states(&table[..5]))[..] else { panic!("one sequence") };
        assert_eq!(only.0, "");
    }

    /// Claim: a direction that comes back to its first state is not joined with the other one, which leads round the
    /// same loop.
    #[test]
    fn loops_stay_alone() {
        let round = |sign: i64| [0.0, 0.1, 0.2, 0.0].map(|x| (0, sign, x * sign as f64));
        let names: Vec<String> =
            found(&states(&[round(1), round(-1)].concat())).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["branch 0, direction +", "branch 0, direction \u{2212}"]);
    }

    /// Claim: branches without directions, and studies without branches, keep the order of the table.
    #[test]
    fn the_order_of_the_table() {
        let plain = Place { branch: None, sign: None };
        let points = [Vec3::x()];
        assert_eq!(sequences(&[(plain, &points[..]), (plain, &points)])[0].states, [0, 1]);
        let path = |branch| (Place { branch: Some(branch), sign: None }, &points[..]);
        let names: Vec<String> = sequences(&[path(0), path(0), path(1)]).into_iter().map(|s| s.name).collect();
        assert_eq!(names, ["branch 0", "branch 1"]);
        assert!(sequences(&[]).is_empty());
    }
}
