//! The standard output of `foldwell run`: a sentence or a few for every study, and for a sweep how many points
//! converged, which did not, and why.

use std::fmt::Write as _;

use foldwell::output::counted;
use foldwell::run::{PointStatus, RunReport, SweepReport, SweepSummary, UnansweredPoint};

/// Largest number of points without an answer that are listed; all are in `sweep.json`.
const MOST_LISTED: usize = 20;

/// Returns the descriptions of the studies of a run, one after the other.
pub(crate) fn describe_run(report: &RunReport) -> String {
    let mut text = String::new();
    for study in &report.summary.studies {
        // writing to a string does not fail
        let kept = if report.kept.contains(&study.name) { " (kept)" } else { "" };
        let _ = writeln!(text, "{}{kept}", study.sentence());
    }
    let _ = writeln!(text, "files in {}", report.out.display());
    text
}

/// Describes a sweep: counts, points without an answer and their reasons, and points that are missing.
pub(crate) fn describe_sweep(report: &SweepReport) -> String {
    let SweepSummary { keys, points, converged, not_converged, failed, missing, unanswered, .. } = &report.summary;
    let kept = if report.kept > 0 { format!(" ({} kept)", report.kept) } else { String::new() };
    let mut text = format!("{} along {}: {converged} converged{kept}", counted(*points, "point"), keys.join(", "));
    for (count, what) in [(not_converged, "not converged"), (failed, "failed")] {
        text += &if *count > 0 { format!(", {count} {what}") } else { String::new() };
    }
    text.push('\n');
    for UnansweredPoint { point, settings, status, reason } in unanswered.iter().take(MOST_LISTED) {
        let what = if *status == PointStatus::Failed { "failed" } else { "not converged" };
        // writing to a string does not fail
        let _ = writeln!(text, "  point {point} ({}) {what}: {reason}", settings.join(", "));
    }
    if unanswered.len() > MOST_LISTED {
        let _ = writeln!(text, "  and {} more, in sweep.json", unanswered.len() - MOST_LISTED);
    }
    if !missing.is_empty() {
        let are = if missing.len() == 1 { "is" } else { "are" };
        let count = counted(missing.len(), "point");
        let _ = writeln!(text, "{count} {are} missing: {}; --resume computes what is missing", ranges(missing));
    }
    let _ = writeln!(text, "table in {}", report.out.join("sweep.csv").display());
    text
}

/// Returns increasing numbers with runs of them shortened: `0, 3-7`.
fn ranges(numbers: &[usize]) -> String {
    let range = |run: &[usize]| match run {
        [first, .., last] => format!("{first}-{last}"),
        one => one.iter().map(usize::to_string).collect(),
    };
    let runs: Vec<String> = numbers.chunk_by(|a, b| a + 1 == *b).map(range).collect();
    if runs.len() > MOST_LISTED { format!("{}, ...", runs[..MOST_LISTED].join(", ")) } else { runs.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: neighbours are shortened to their ends, and very long lists are cut.
    #[test]
    fn neighbours_are_shortened() {
        assert_eq!(ranges(&[0, 3, 4, 5, 9, 10]), "0, 3-5, 9-10");
        let odd: Vec<usize> = (0..50).map(|k| 2 * k + 1).collect();
        assert!(ranges(&odd).ends_with("39, ..."), "{}", ranges(&odd));
    }
}
