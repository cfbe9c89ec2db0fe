//! Validation: `foldwell validate` checks claims about the program.
//!
//! There is one case for each claim. A claim is a file in `validation/claims/` with its source, the expected value, and
//! a tolerance with the reason for it ([`claim`]); all these files are embedded in the program ([`library`]). The value
//! comes from an experiment: a scene of `meshes/`, run as by `foldwell run`, or a measurement programmed in
//! [`measure`]. It is compared with the expected value ([`verdict`]). The reports `report.json`, `report.md` and
//! `report.html` ([`report`], [`page`]) are written again after every case, so that an interrupted validation leaves
//! the results up to then.

pub(crate) mod claim;
pub(crate) mod experiment;
pub(crate) mod findings;
mod forms;
pub(crate) mod library;
pub(crate) mod measure;
pub(crate) mod page;
pub(crate) mod precision;
pub(crate) mod report;
mod report_files;
pub(crate) mod star;
pub(crate) mod verdict;

use claim::{Claim, ClaimError};
use experiment::Experiments;
use findings::ExperimentError;
use foldwell::numerics::parallel::Threads;
use foldwell::output::OutputError;
use foldwell::run::Observer;
use miette::Diagnostic;
use report::{Case, Report};
use std::path::PathBuf;
use thiserror::Error;

/// The options of `foldwell validate`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct ValidateOptions {
    /// Whether to leave out the claims that take long.
    pub quick: bool,
    /// Folder of the reports; `None` for `validation-report`.
    pub out: Option<PathBuf>,
    /// Names of the claims to check, or paths of files with claims, which end in `.toml`; empty for all claims.
    pub only: Vec<String>,
}

/// The reason why there is no report.
#[derive(Debug, Error, Diagnostic)]
pub(crate) enum ValidationError {
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
    #[error("there is no claim `{name}`")]
    #[diagnostic(help("the claims are {known}"))]
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
    /// Returns the exit status of the program: 2 for invalid input, 3 if a file cannot be written.
    pub(crate) fn exit_status(&self) -> u8 {
        if matches!(self, Self::Output(_)) { 3 } else { 2 }
    }
}

/// Checks the claims and writes the reports. `announce` is called with every case once it is decided.
///
/// # Errors
/// [`ValidationError`]. A claim that does not hold, and an experiment that gives no value, are not errors but cases of
/// the report.
pub(crate) fn validate(
    options: &ValidateOptions,
    observer: Observer,
    announce: &mut dyn FnMut(&Case),
) -> Result<Report, ValidationError> {
    let claims = chosen(library::claims()?, options)?;
    Threads::new(None).install(|| check(claims, options, observer, announce))
}

/// Returns the claims selected by the options.
fn chosen(mut claims: Vec<Claim>, options: &ValidateOptions) -> Result<Vec<Claim>, ValidationError> {
    for path in options.only.iter().filter(|name| name.ends_with(".toml")) {
        let text =
            std::fs::read_to_string(path).map_err(|source| ValidationError::Read { path: path.into(), source })?;
        claims.push(Claim::parse(path, &text)?);
    }
    let known = || claims.iter().map(|claim| claim.name.as_str());
    if let Some(name) = options.only.iter().find(|name| !known().any(|known| known == *name)) {
        return Err(ValidationError::Unknown { name: name.clone(), known: known().collect::<Vec<_>>().join(", ") });
    }
    let asked = |claim: &Claim| {
        (options.only.is_empty() && (claim.quick || !options.quick)) || options.only.contains(&claim.name)
    };
    Ok(claims.into_iter().filter(asked).collect())
}

fn check(
    claims: Vec<Claim>,
    options: &ValidateOptions,
    observer: Observer,
    announce: &mut dyn FnMut(&Case),
) -> Result<Report, ValidationError> {
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from("validation-report"));
    let mut laboratory = Experiments::new(out.clone(), options.quick, observer);
    let mut report = Report::new(options.quick, claims.len());
    let mut interrupted = false;
    report.interrupted = true; // reports written before the end are marked as interrupted
    report.write(&out)?;
    for claim in &claims {
        let outcome = laboratory.perform(&claim.experiment);
        if matches!(outcome.found, Err(ExperimentError::Interrupted)) {
            interrupted = true;
            break;
        }
        let case = Case::of(claim, outcome);
        announce(&case);
        report.push(case, outcome.first.then_some(outcome));
        report.write(&out)?;
    }
    report.interrupted = interrupted;
    report.write(&out)?;
    Ok(report)
}

#[cfg(test)]
mod tests;
