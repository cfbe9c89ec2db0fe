//! What of a run is finished, for whoever cannot wait until it ends.
//!
//! A run looks at its observer between the steps of its work, and some of them take long: a large sheet is built, a large
//! matrix is factorized. Whoever has asked such a run to stop and does not want to wait for the end of the step closes its
//! ledger instead: that writes what is finished, and the study at work as interrupted, and from then on the run writes
//! its summary no more.

use super::{RunError, RunReport};
use crate::output::files;
use crate::output::summary::{StudySummary, Summary};
use crate::scene::spec::StudySpec;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How many times as long as writing the summary took passes before it is written again: with many studies it is long, and
/// writing it after each would take most of the time.
const PATIENCE: u32 = 20;

/// The books of a run: its finished studies and the one at work. Clones share them.
#[derive(Clone, Debug, Default)]
pub struct Ledger(Arc<Mutex<Entries>>);

#[derive(Debug, Default)]
struct Entries {
    closed: bool,
    /// What is finished; none before the run has begun to write.
    report: Option<RunReport>,
    /// Places in the scene of the finished studies, in order.
    places: Vec<usize>,
    /// The study at work, not answered, and its place in the scene.
    at_work: Option<(StudySummary, usize)>,
    /// When the summary was written, and how long that took.
    written: Option<(Instant, Duration)>,
}

impl Ledger {
    fn entries(&self) -> MutexGuard<'_, Entries> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Begins the books with what is finished already, studies of these places in the scene, and writes the summary.
    pub(super) fn open(&self, report: RunReport, places: Vec<usize>) -> Result<(), RunError> {
        let mut entries = self.entries();
        (entries.report, entries.places) = (Some(report), places);
        entries.write()
    }

    /// Notes the study that is worked on now, and its place in the scene.
    pub(super) fn begin(&self, study: &StudySpec, place: usize) {
        self.entries().at_work = Some((StudySummary::unanswered(&study.name.0, study.kind.name()), place));
    }

    /// Notes a finished study and its place in the scene, and writes the summary unless that was just done.
    pub(super) fn finished(&self, study: StudySummary, place: usize) -> Result<(), RunError> {
        let mut entries = self.entries();
        entries.at_work = None;
        entries.insert(study, place);
        match entries.written {
            Some((last, took)) if last.elapsed() < took * PATIENCE => Ok(()),
            _ => entries.write(),
        }
    }

    /// Writes the summary.
    pub(super) fn write(&self) -> Result<(), RunError> {
        self.entries().write()
    }

    /// Ends the books: writes the summary and gives the report.
    pub(super) fn end(&self, interrupted: bool) -> Result<RunReport, RunError> {
        let mut entries = self.entries();
        entries.write()?;
        let report = entries.report.clone().expect("a run that ends has begun");
        Ok(RunReport { interrupted, ..report })
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
        let at_work = entries.at_work.take();
        let Some(out) = entries.report.as_ref().map(|report| report.out.clone()) else {
            entries.closed = true;
            return Ok(None);
        };
        if let Some((study, place)) = at_work {
            files::remove_own_drafts(&out.join(&study.name));
            entries.insert(StudySummary { reason: Some(INTERRUPTED.into()), ..study }, place);
        }
        files::remove_own_drafts(&out);
        entries.write()?;
        entries.closed = true;
        Ok(entries.report.clone().map(|report| RunReport { interrupted: true, ..report }))
    }
}

impl Entries {
    fn summary(&mut self) -> Option<&mut Summary> {
        self.report.as_mut().map(|report| &mut report.summary)
    }

    fn insert(&mut self, study: StudySummary, place: usize) {
        let at = self.places.partition_point(|other| *other < place);
        if let Some(summary) = self.summary() {
            summary.studies.insert(at, study);
            self.places.insert(at, place);
        }
    }

    /// Writes the summary, unless the books are closed.
    fn write(&mut self) -> Result<(), RunError> {
        let Some(report) = self.report.as_ref().filter(|_| !self.closed) else { return Ok(()) };
        let start = Instant::now();
        report.summary.write(&report.out.join("summary.json"))?;
        self.written = Some((Instant::now(), start.elapsed()));
        Ok(())
    }
}

/// Why a study that was stopped gave no answer.
pub(crate) const INTERRUPTED: &str = "interrupted";
