//! The claims of runs on their folders.

use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use super::{Observer, Progress, RunError};
use crate::output::OutputError;
use crate::output::claim::Claim;
use crate::scene::{Sweep, digest};

/// Time between two looks at a folder that another run has.
const GLANCE: Duration = Duration::from_millis(20);
/// Word for the waiting, in place of the name of a study.
const WAITING: &str = "waiting for another run";

/// Claims the folder of one run. It waits for another run into this folder if that is one of this process, which may
/// have been broken off and end after its step; with `patient` also if it is one of another process.
pub(super) fn of_run(folder: &Path, patient: bool, observer: Observer) -> Result<Claim, OutputError> {
    let waiting = Progress { study: WAITING.to_owned(), step: 0, of: None, residual: f64::NAN, part: f64::NAN };
    let waits = |process: u32| (patient || process == std::process::id()) && observer(&waiting).is_continue();
    loop {
        match Claim::on(folder, None) {
            Err(OutputError::Claimed { process, .. }) if waits(process) => sleep(GLANCE),
            found => return found,
        }
    }
}

/// Claims the folder of a sweep, which the runs of this sweep share: shards, and the workers that compute its points.
pub(super) fn of_sweep(folder: &Path, sweep: &Sweep) -> Result<Claim, RunError> {
    Ok(Claim::on(folder, Some(&digest(sweep.file())?))?)
}
