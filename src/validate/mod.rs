//! Claims about the program, checked by the program: `foldwell validate`.
//!
//! One case per claim. Each has a file in `validation/claims/` with its source, the expected value, and a tolerance with its
//! reason ([`claim`]); all files are inside the program ([`library`]). A claim takes its value from an experiment: a scene
//! of `meshes/`, run as `foldwell run` does, or a measurement coded in [`measure`]. What is found is compared ([`verdict`]) and
//! reported as `report.json`, `report.md` and `report.html` ([`report`], [`page`]), after every case anew, so that an
//! interrupted validation leaves what it found.

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

/// What the command line can change about the validation.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct ValidateOptions {
    /// Leave out the claims that take long.
    pub quick: bool,
    /// Folder for the reports; `None`: `validation-report`.
    pub out: Option<PathBuf>,
    /// Only these claims, by name, or of files ending in `.toml`; empty: all.
    pub only: Vec<String>,
}

/// Why there is no report.
#[derive(Debug, Error, Diagnostic)]
pub(crate) enum ValidationError {
    /// A file of the program's own states no claim.
    #[error(transparent)]
    Claim(#[from] ClaimError),
    /// A file with a claim cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// There is no claim of this name.
    #[error("there is no claim `{name}`")]
    #[diagnostic(help("the claims are {known}"))]
    Unknown {
        /// Asked for.
        name: String,
        /// The claims there are.
        known: String,
    },
    /// A report could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl ValidationError {
    /// The exit status of the program: 2 where the input is wrong, 3 where a place cannot be written.
    pub(crate) fn exit_status(&self) -> u8 {
        if matches!(self, Self::Output(_)) { 3 } else { 2 }
    }
}

/// Checks the claims and writes the reports. `announce` sees every case once it is decided.
///
/// # Errors
/// [`ValidationError`]; a claim that fails, or an experiment that gives no value, is a case of the report instead.
pub(crate) fn validate(
    options: &ValidateOptions,
    observer: Observer,
    announce: &mut dyn FnMut(&Case),
) -> Result<Report, ValidationError> {
    let claims = chosen(library::claims()?, options)?;
    Threads::new(None).install(|| check(claims, options, observer, announce))
}

/// The claims that are asked for.
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
    report.interrupted = true; // that is what a report says which is left here
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
