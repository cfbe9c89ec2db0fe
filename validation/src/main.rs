//! Checks claims about foldwell, and writes a report.
//!
//! A claim is a file in `validation/claims/`: a sentence, its source, the expected value, and a tolerance with its
//! reason ([`claim`]). The value comes from an experiment: a scene of `meshes/`, run as by `foldwell run`, or a
//! measurement programmed in [`measure`]. Each claim becomes a case of the report, which says whether it holds
//! ([`verdict`]). The reports `report.json`, `report.md` and `report.html` ([`report`], [`page`]) are written again
//! after every case, so that an interrupted validation leaves the results up to then.
//!
//! | exit status | meaning |
//! |---|---|
//! | 0 | every claim holds |
//! | 1 | a claim fails |
//! | 2 | a claim does not exist, or is none |
//! | 3 | a report cannot be written |
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod claim;
mod experiment;
mod findings;
mod forms;
mod library;
mod measure;
mod page;
mod precision;
mod report;
mod report_files;
mod star;
mod verdict;

use claim::{Claim, ClaimError};
use clap::Parser;
use experiment::Experiments;
use foldwell::numerics::parallel::Threads;
use foldwell::output::OutputError;
use report::{Case, Report};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use thiserror::Error;

/// Check claims about foldwell, and write a report.
#[derive(Clone, Debug, Default, Parser)]
#[command(version)]
struct Options {
    /// Only these claims; a name that ends in .toml is the file of a claim of one's own [default: all]
    claims: Vec<String>,
    /// Leave out what takes long
    #[arg(long)]
    quick: bool,
    /// Folder for the reports
    #[arg(long, value_name = "DIR", default_value = "validation-report")]
    out: PathBuf,
}

/// The reason why there is no report.
#[derive(Debug, Error)]
enum ValidationError {
    /// A file with a claim is not valid.
    #[error(transparent)]
    Claim(#[from] ClaimError),
    /// A file with a claim cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// There is no claim of this name.
    #[error("there is no claim `{name}`; the claims are {known}")]
    Unknown {
        /// The requested name.
        name: String,
        /// Names of the existing claims.
        known: String,
    },
    /// A report could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl ValidationError {
    /// Returns the exit status of the program.
    fn exit_status(&self) -> u8 {
        if matches!(self, Self::Output(_)) { 3 } else { 2 }
    }
}

fn main() -> ExitCode {
    let options = Options::parse();
    let claims = library::claims().and_then(|claims| chosen(claims, &options));
    let report = claims.and_then(|claims| Threads::new(None).install(|| check(claims, &options, &mut announce)));
    match report {
        Ok(report) => {
            println!("{}", report.verdict());
            ExitCode::from(u8::from(!report.all_passed()))
        }
        Err(error) => {
            eprintln!("Error: {error}");
            ExitCode::from(error.exit_status())
        }
    }
}

/// Prints what a case has found.
fn announce(case: &Case) {
    let mark = if case.passed { "holds" } else { "FAILS" };
    eprintln!("{mark}  {}: {} ({:.2} s)", case.name, case.distance(), case.seconds);
    case.failure.iter().for_each(|failure| eprintln!("       {failure}"));
}

/// Returns the claims selected by the options.
fn chosen(mut claims: Vec<Claim>, options: &Options) -> Result<Vec<Claim>, ValidationError> {
    for path in options.claims.iter().filter(|name| name.ends_with(".toml")) {
        claims.push(library::claim(Path::new(path), path)?);
    }
    let known = || claims.iter().map(|claim| claim.name.as_str());
    if let Some(name) = options.claims.iter().find(|name| !known().any(|known| known == *name)) {
        return Err(ValidationError::Unknown { name: name.clone(), known: known().collect::<Vec<_>>().join(", ") });
    }
    let asked = |claim: &Claim| {
        (options.claims.is_empty() && (claim.quick || !options.quick)) || options.claims.contains(&claim.name)
    };
    Ok(claims.into_iter().filter(asked).collect())
}

/// Checks claims and writes the reports. `announce` is called with every case once it is decided. A claim that does not
/// hold, and an experiment that gives no value, are cases of the report.
fn check(claims: Vec<Claim>, options: &Options, announce: &mut dyn FnMut(&Case)) -> Result<Report, ValidationError> {
    let mut laboratory = Experiments::new(options.out.clone(), options.quick);
    let mut report = Report::new(options.quick, claims.len());
    report.interrupted = true; // reports written before the end are marked as interrupted
    report.write(&options.out)?;
    for claim in &claims {
        let outcome = laboratory.perform(&claim.experiment);
        let case = Case::of(claim, outcome);
        announce(&case);
        report.push(case, outcome.first.then_some(outcome));
        report.write(&options.out)?;
    }
    report.interrupted = false;
    report.write(&options.out)?;
    Ok(report)
}

#[cfg(test)]
mod tests;
