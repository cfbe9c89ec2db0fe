//! Stiff and extreme cases: each is solved correctly, or refused with a reason; never with a silent wrong number, an
//! endless computation or a panic.

mod families;

use super::super::findings::{ExperimentError, Findings, ReportTable};
use super::trial::TrialVerdict;
use serde_json::{Value, json};

/// Numbers of trials by verdict, and descriptions of the wrong ones.
#[derive(Default)]
struct Tally {
    right: usize,
    unjudged: usize,
    refused: usize,
    wrong: Vec<String>,
}

impl Tally {
    fn add(&mut self, name: &str, outcome: &TrialVerdict) {
        match outcome {
            TrialVerdict::Right(_) => self.right += 1,
            TrialVerdict::Unjudged => self.unjudged += 1,
            TrialVerdict::Refused(_) => self.refused += 1,
            TrialVerdict::Wrong(reason) => self.wrong.push(format!("{name}: {reason}")),
        }
    }

    fn values(&self) -> Value {
        json!({
            "trials": self.right + self.unjudged + self.refused + self.wrong.len(),
            "right": self.right,
            "refused": self.refused,
            "unjudged": self.unjudged,
            "wrong": self.wrong.len(),
        })
    }
}

/// Runs all cases of all families.
pub fn measure(quick: bool) -> Result<Findings, ExperimentError> {
    let families = families::families(quick)?;
    let (mut tally, mut rows) = (Tally::default(), Vec::new());
    for family in families {
        for (name, attempt) in family.cases {
            let outcome = attempt();
            tally.add(&format!("{}, {name}", family.name), &outcome);
            rows.push(vec![family.name.to_owned(), name, verdict_text(&outcome), family.compared.to_owned()]);
        }
    }
    let header = ["what is extreme", "case", "what happens", "compared with"].map(str::to_owned).to_vec();
    let title = "Stiff and extreme cases, and the limits found".into();
    Ok(Findings { values: tally.values(), tables: vec![ReportTable { title, header, rows }], ..Findings::default() })
}

fn verdict_text(outcome: &TrialVerdict) -> String {
    match outcome {
        TrialVerdict::Right(error) => format!("right to {error:.0e}"),
        TrialVerdict::Unjudged => "converged, nothing to compare with".into(),
        TrialVerdict::Refused(reason) => format!("refused: {reason}"),
        TrialVerdict::Wrong(reason) => format!("WRONG: {reason}"),
    }
}
