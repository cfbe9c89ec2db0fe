//! Random sheets, asked in two ways that must agree: in another unit of length, mirrored, moved, turned, with other numbers of their
//! vertices and another cell of the same lattice, with bars all but rigid, once more from the answer, by dense
//! eigenvalues and by the exact kinematics; and the scenes of the repository on a grid of rest values and stiffnesses.
//!
//! Where one of the two ways says that it has no answer there is nothing to compare: these cases are counted. `FOLDWELL_CASES=20000
//! cargo test --release --test differential -- --nocapture` runs many and prints how many there were of each kind, and the seed of
//! each that fell; `FOLDWELL_FIRST` is the first seed.
#![allow(clippy::unwrap_used)] // in helpers of tests as in tests

#[path = "../common/mod.rs"]
mod common;
mod folded;
mod grid;
#[path = "../common/redrawn.rs"]
mod redrawn;
mod relaxed;
mod report;
mod threads;
mod trial;

use report::Report;
use threads::on_all_threads;

/// Seeds that once fell.
const FELL: [u64; 27] = [
    130, 1765, 2042, 2617, 4623, 5455, 5830, 6315, 6944, 7022, 7328, 7357, 7949, 8205, 10780, 10790, 11896, 12071,
    12920, 13210, 13432, 13568, 14790, 16586, 18530, 18956, 19010,
];
/// Cases where nothing else is asked for.
const USUAL: u64 = 150;
/// Folding is asked of one case in so many: it takes much longer than a relaxation.
const FOLDED: u64 = 10;

fn examine(seed: u64) -> Report {
    let mut report = Report::default();
    relaxed::examine(seed, &mut report);
    if seed.is_multiple_of(FOLDED) {
        folded::examine(seed / FOLDED, &mut report);
    }
    report.fell.iter().for_each(|fell| println!("{fell}"));
    report
}

/// Claim: two ways to the same answer give the same one, or one of them says why it gives none.
#[test]
fn two_ways_agree() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let (cases, first) = (number("FOLDWELL_CASES").unwrap_or(USUAL), number("FOLDWELL_FIRST").unwrap_or(0));
    let seeds: Vec<u64> = FELL.into_iter().chain(first..first + cases).collect();
    let report = on_all_threads(&seeds, |seed| examine(*seed)).into_iter().fold(Report::default(), Report::and);
    println!("{cases} cases; comparisons, and those without an answer: {:#?}", report.made);
    println!("what was said where there was no answer: {:#?}", report.said);
    let [answered, unanswered] = report.made["relaxed"];
    assert!(4 * answered >= 3 * (answered + unanswered), "{answered} of {} have an answer", answered + unanswered);
    let compared: usize = report.made.values().map(|[made, _]| made).sum();
    let apart = report.made.get(report::ELSEWHERE).map_or(0, |[made, _]| *made);
    assert!(50 * apart <= compared, "{apart} of {compared} comparisons are of two equilibria");
    assert!(report.fell.is_empty(), "{} disagreements: {:#?}", report.fell.len(), report.fell);
}
