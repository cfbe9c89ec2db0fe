//! The report of a validation.

use super::claim::{Claim, Numbers, Wanted};
use super::experiment::Performed;
use super::findings::ReportTable;
use super::precision::{Diagram, Setting};
use super::verdict::{compare, numbers_at};
use foldwell::output::figure::chart::Chart;
use serde::Serialize;

/// A claim that was checked.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Case {
    /// Its name.
    pub name: String,
    /// What is claimed.
    pub claim: String,
    /// Where the expected value comes from.
    pub source: String,
    /// The command that computes it.
    pub command: String,
    /// Which value of what the command gives.
    pub value: String,
    /// `equal`, `at most` or `at least`.
    pub comparison: &'static str,
    /// What the value has to be.
    pub expected: Numbers,
    /// What it is; `None` where there is none.
    pub found: Option<Numbers>,
    /// What is allowed for the worst number.
    pub tolerance: f64,
    /// How far the worst number is from what it has to be, or beyond its bound (negative: within it).
    pub miss: Option<f64>,
    /// Why the tolerance, or the bound, is what it is.
    pub reason: String,
    /// Whether the claim holds.
    pub passed: bool,
    /// Time of the experiment, which claims may share.
    pub seconds: f64,
    /// Why there is no value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// All that was checked.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(crate) struct Report {
    /// Version of the program.
    pub version: &'static str,
    /// Whether only the quick claims were asked for.
    pub quick: bool,
    /// Whether it was stopped before all claims were checked.
    pub interrupted: bool,
    /// How many claims were to be checked.
    pub claims: usize,
    /// How many of `cases` passed.
    pub passed: usize,
    /// Time of all experiments.
    pub seconds: f64,
    /// The claims that were checked.
    pub cases: Vec<Case>,
    /// Diagrams of error against run time.
    pub diagrams: Vec<Diagram>,
    /// Other charts; what they show stands in the tables.
    #[serde(skip)]
    pub charts: Vec<Chart>,
    /// Tables of what was measured besides.
    pub tables: Vec<ReportTable>,
}

impl Case {
    /// Compares what an experiment gave with what a claim says.
    pub(crate) fn of(claim: &Claim, outcome: &Performed) -> Self {
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

    /// What has to be and what is allowed, in a few words.
    pub(crate) fn expectation(&self) -> String {
        match self.comparison {
            "equal" => format!("{} \u{b1} {}", short(&self.expected), figure(self.tolerance)),
            comparison => format!("{comparison} {}", short(&self.expected)),
        }
    }

    /// What was found, in a few words.
    pub(crate) fn finding(&self) -> String {
        self.found.as_ref().map_or_else(|| self.failure.clone().unwrap_or_default(), short)
    }

    /// By how much it fails, or how far it is from failing.
    pub(crate) fn distance(&self) -> String {
        match (self.miss, self.comparison) {
            (None, _) => "no value".into(),
            (Some(miss), "equal") => format!("off by {}, allowed {}", figure(miss), figure(self.tolerance)),
            (Some(miss), _) if miss > 0.0 => format!("beyond by {}", figure(miss)),
            (Some(miss), _) => format!("within by {}", figure(-miss)),
        }
    }
}

impl Report {
    /// An empty report.
    pub(crate) fn new(quick: bool, claims: usize) -> Self {
        Self { version: env!("CARGO_PKG_VERSION"), quick, claims, ..Self::default() }
    }

    /// Adds a case, and what its experiment gave where it is the first to ask for it.
    pub(crate) fn push(&mut self, case: Case, outcome: Option<&Performed>) {
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
    pub(crate) fn all_passed(&self) -> bool {
        self.passed == self.claims
    }

    /// Which claims were checked and how many hold, in a sentence.
    pub(crate) fn verdict(&self) -> String {
        let failed = self.cases.len() - self.passed;
        let left = match self.claims - self.cases.len() {
            0 => String::new(),
            left => format!(", {left} not checked"),
        };
        let which = if self.quick { "quick claims" } else { "claims" };
        format!("{} of {} {which} hold, {failed} fail{left}; {:.0} s", self.passed, self.claims, self.seconds)
    }

    pub(crate) fn markdown(&self) -> String {
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

/// The cheapest setting for errors that one may want.
pub(crate) fn cheapest(diagram: &Diagram) -> ReportTable {
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

/// A few numbers in a few digits.
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

/// A number with at most ten digits, with an exponent where it is very large or small.
pub(crate) fn figure(number: f64) -> String {
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
