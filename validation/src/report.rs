//! The report of a validation.

use super::claim::{Claim, Numbers, Wanted};
use super::experiment::Performed;
use super::findings::ReportTable;
use super::precision::{Diagram, Setting};
use super::verdict::{compare, numbers_at};
use foldwell::output::figure::chart::LineChart;
use serde::Serialize;

/// A claim that was checked.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    /// Name of the claim.
    pub name: String,
    /// The statement, in a sentence.
    pub claim: String,
    /// Source of the expected value.
    pub source: String,
    /// The command that computes the value.
    pub command: String,
    /// Path of the value in the result of the command.
    pub value: String,
    /// `equal`, `at most` or `at least`.
    pub comparison: &'static str,
    /// Expected value, or the bound.
    pub expected: Numbers,
    /// Value found; `None` if there is none.
    pub found: Option<Numbers>,
    /// Tolerance of the worst number.
    pub tolerance: f64,
    /// Distance of the worst number from its expected value, or beyond its bound (negative if within).
    pub miss: Option<f64>,
    /// Reason for the size of the tolerance or the bound.
    pub reason: String,
    /// Whether the claim holds.
    pub passed: bool,
    /// Duration of the experiment in seconds; several claims may share it.
    pub seconds: f64,
    /// The reason why there is no value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// The results of a validation.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Version of the program.
    pub version: &'static str,
    /// Whether only the quick claims were requested.
    pub quick: bool,
    /// Whether the validation was stopped before all claims were checked.
    pub interrupted: bool,
    /// Number of claims to check.
    pub claims: usize,
    /// Number of `cases` that passed.
    pub passed: usize,
    /// Total duration of all experiments in seconds.
    pub seconds: f64,
    /// The claims that were checked.
    pub cases: Vec<Case>,
    /// Diagrams of error against run time.
    pub diagrams: Vec<Diagram>,
    /// Other charts; their numbers are also in the tables.
    #[serde(skip)]
    pub charts: Vec<LineChart>,
    /// Tables of the measurements.
    pub tables: Vec<ReportTable>,
}

impl Case {
    /// Compares the result of an experiment with a claim.
    pub fn of(claim: &Claim, outcome: &Performed) -> Self {
        let (comparison, expected) = match &claim.wanted {
            Wanted::Equal { numbers, .. } => ("equal", numbers.clone()),
            Wanted::AtMost(bound) => ("at most", Numbers::One(*bound)),
            Wanted::AtLeast(bound) => ("at least", Numbers::One(*bound)),
        };
        let found = outcome.found.as_ref().ok().and_then(|findings| numbers_at(&findings.values, &claim.value));
        let failure = match &outcome.found {
            Err(error) => Some(error.to_string()),
            Ok(_) => found.is_none().then(|| format!("there is no number at {}", claim.value)),
        };
        let verdict = compare(&claim.wanted, found.as_ref().unwrap_or(&Numbers::Many(vec![])));
        Self {
            name: claim.name.clone(),
            claim: claim.claim.clone(),
            source: claim.source.clone(),
            command: claim.command(),
            value: claim.value.clone(),
            comparison,
            expected,
            tolerance: verdict.tolerance,
            miss: found.is_some().then_some(verdict.miss),
            found,
            reason: claim.reason.clone(),
            passed: verdict.passed,
            seconds: outcome.seconds,
            failure,
        }
    }

    /// Returns the expected value and its tolerance as a short text.
    pub fn expectation(&self) -> String {
        match self.comparison {
            "equal" => format!("{} \u{b1} {}", short(&self.expected), figure(self.tolerance)),
            comparison => format!("{comparison} {}", short(&self.expected)),
        }
    }

    /// Returns the value found as a short text.
    pub fn finding(&self) -> String {
        self.found.as_ref().map_or_else(|| self.failure.clone().unwrap_or_default(), short)
    }

    /// Returns a text with the distance from the expected value or the bound.
    pub fn distance(&self) -> String {
        match (self.miss, self.comparison) {
            (None, _) => "no value".into(),
            (Some(miss), "equal") => format!("off by {}, allowed {}", figure(miss), figure(self.tolerance)),
            (Some(miss), _) if miss > 0.0 => format!("beyond by {}", figure(miss)),
            (Some(miss), _) => format!("within by {}", figure(-miss)),
        }
    }
}

impl Report {
    /// Makes an empty report.
    pub fn new(quick: bool, claims: usize) -> Self {
        Self { version: env!("CARGO_PKG_VERSION"), quick, claims, ..Self::default() }
    }

    /// Adds a case, and the result of its experiment if this is given (it is given for the first claim that uses it).
    pub fn push(&mut self, case: Case, outcome: Option<&Performed>) {
        self.passed += usize::from(case.passed);
        self.cases.push(case);
        if let Some(outcome) = outcome {
            self.seconds += outcome.seconds;
            if let Ok(findings) = &outcome.found {
                self.diagrams.extend(findings.diagrams.iter().cloned());
                self.charts.extend(findings.charts.iter().cloned());
                self.tables.extend(findings.tables.iter().cloned());
            }
        }
    }

    /// Whether every claim was checked and holds.
    pub fn all_passed(&self) -> bool {
        self.passed == self.claims
    }

    /// Returns a sentence with the numbers of claims that hold, fail and were not checked.
    pub fn verdict(&self) -> String {
        let failed = self.cases.len() - self.passed;
        let left = match self.claims - self.cases.len() {
            0 => String::new(),
            left => format!(", {left} not checked"),
        };
        let which = if self.quick { "quick claims" } else { "claims" };
        format!("{} of {} {which} hold, {failed} fail{left}; {:.0} s", self.passed, self.claims, self.seconds)
    }

    pub fn markdown(&self) -> String {
        let mut text = format!("# Validation of foldwell {}\n\n{}.\n", self.version, self.verdict());
        let row = |case: &Case| {
            let passed = if case.passed { "holds" } else { "**fails**" };
            [&case.name, &case.claim, &case.expectation(), &case.finding(), passed, &format!("{:.2}", case.seconds)]
                .map(str::to_owned)
                .to_vec()
        };
        let header = ["name", "claim", "expected", "found", "", "seconds"].map(str::to_owned).to_vec();
        let title = "Claims".into();
        text += &markdown_table(&ReportTable { title, header, rows: self.cases.iter().map(row).collect() });
        for case in self.cases.iter().filter(|case| !case.passed) {
            text +=
                &format!("\n**{} fails**: {}. {}\n", case.name, case.distance(), case.failure.as_deref().unwrap_or(""));
        }
        self.diagrams.iter().for_each(|diagram| text += &markdown_table(&cheapest(diagram)));
        self.tables.iter().for_each(|table| text += &markdown_table(table));
        text += "\n## Sources, tolerances, commands\n";
        for Case { name, source, reason, command, value, .. } in &self.cases {
            text += &format!("\n- **{name}**: `{command}`, `{value}`. Source: {source} Tolerance: {reason}\n");
        }
        text
    }
}

/// Returns a table of the cheapest setting for each error of a list.
pub fn cheapest(diagram: &Diagram) -> ReportTable {
    let row = |(wanted, best): (f64, Option<(&str, &Setting)>)| match best {
        Some((method, setting)) => {
            let Setting { label, error, seconds } = setting;
            vec![figure(wanted), method.to_owned(), label.clone(), figure(*error), figure(*seconds)]
        }
        None => vec![figure(wanted), "none reaches it".into(), String::new(), String::new(), String::new()],
    };
    ReportTable {
        title: format!("{}: the cheapest setting for a wanted error", diagram.title),
        header: ["wanted error", "method", "setting", "its error", "its seconds"].map(str::to_owned).to_vec(),
        rows: diagram.cheapest().into_iter().map(row).collect(),
    }
}

fn markdown_table(table: &ReportTable) -> String {
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let rule = format!("|{}\n", "---|".repeat(table.header.len()));
    let rows: String = table.rows.iter().map(|row| line(row)).collect();
    format!("\n## {}\n\n{}{rule}{rows}", table.title, line(&table.header))
}

/// Formats the first few of some numbers.
fn short(numbers: &Numbers) -> String {
    const MOST: usize = 6;
    let list = numbers.list();
    let shown: Vec<String> = list.iter().take(MOST).map(|number| figure(*number)).collect();
    let more = if list.len() > MOST { format!(", ... ({} numbers)", list.len()) } else { String::new() };
    match numbers {
        Numbers::One(number) => figure(*number),
        Numbers::Many(_) => format!("[{}{more}]", shown.join(", ")),
    }
}

/// Formats a number with at most ten digits, with an exponent if it is very large or small.
pub fn figure(number: f64) -> String {
    let size = number.abs();
    if number == 0.0 || (1e-3..1e7).contains(&size) {
        let digits = if size >= 1.0 { 9 - size.log10() as usize } else { 6 };
        let text = format!("{number:.digits$}");
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        text.into()
    } else if (format!("{number:e}").len() as i32) < 8 {
        format!("{number:e}")
    } else {
        format!("{number:.2e}")
    }
}
