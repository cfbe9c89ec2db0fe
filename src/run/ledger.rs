//! What of a run is finished, for whoever cannot wait until it ends.
//!
//! A run looks at its observer between the steps of its work, and some of them take long: a large sheet is built, a large
//! matrix is factorized. Whoever has asked such a run to stop and does not want to wait for the end of the step closes its
//! ledger instead: that writes what is finished, and the study at work as interrupted, and from then on the run writes
//! its summary no more.

use super::{RunError, RunReport};
use crate::output::files;
use crate::output::summary::StudySummary;
use crate::scene::spec::StudySpec;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The books of a run: its finished studies and the one at work. Clones share them.
#[derive(Clone, Debug, Default)]
pub struct Ledger(Arc<Mutex<Entries>>);

#[derive(Debug, Default)]
struct Entries {
    closed: bool,
    report: Option<RunReport>,
    /// Name and kind of the study at work, and its place among those of the scene.
    at_work: Option<(StudySummary, usize)>,
}

impl Ledger {
    fn entries(&self) -> MutexGuard<'_, Entries> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes the study that is worked on now.
    pub(super) fn begin(&self, study: &StudySpec, place: usize) {
        self.entries().at_work = Some((StudySummary::unanswered(&study.name.0, study.kind.name()), place));
    }

    /// Notes what is finished and writes it, unless the ledger is closed.
    pub(super) fn write(&self, report: RunReport) -> Result<(), RunError> {
        let mut entries = self.entries();
        if entries.closed {
            return Ok(());
        }
        entries.at_work = None;
        report.summary.write(&report.out.join("summary.json"))?;
        entries.report = Some(report);
        Ok(())
    }

    /// Ends the books of a run that works on: writes `summary.json` with the finished studies and the one at work, which is
    /// interrupted. `None` where the run has not begun to write.
    ///
    /// What the run has on its way is removed from its folder; a file that it begins to write later is not. This is for a
    /// program that ends at once.
    ///
    /// # Errors
    /// [`RunError`] where the summary cannot be written.
    pub fn close(&self) -> Result<Option<RunReport>, RunError> {
        let mut entries = self.entries();
        entries.closed = true;
        let at_work = entries.at_work.take();
        let Some(report) = &mut entries.report else { return Ok(None) };
        report.interrupted = true;
        if let Some((study, place)) = at_work {
            files::remove_own_drafts(&report.out.join(&study.name));
            let studies = &mut report.summary.studies;
            studies.insert(place.min(studies.len()), StudySummary { reason: Some(INTERRUPTED.into()), ..study });
        }
        files::remove_own_drafts(&report.out);
        report.summary.write(&report.out.join("summary.json"))?;
        Ok(Some(report.clone()))
    }
}

/// Why a study that was stopped gave no answer.
pub const INTERRUPTED: &str = "interrupted";
