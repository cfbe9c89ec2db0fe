//! The ledger of a run: a record of its finished studies, available before the run ends.
//!
//! A run calls its observer between the steps of its work, and some steps take long, such as building a large sheet or
//! factorizing a large matrix. A caller that has asked a run to stop and does not want to wait for the end of the step
//! closes the ledger instead. This writes the finished studies, and the current study as interrupted; afterwards the
//! run no longer writes its summary.

use super::{RunError, RunReport};
use crate::output::files;
use crate::output::json::to_json;
use crate::scene::spec::StudySpec;
use crate::study::StudySummary;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Least time between two writings of the summary, as a multiple of the time that the last one took. With many studies
/// the summary is long, and writing it after each study would take most of the time.
const PATIENCE: u32 = 20;

/// The record of a run: its finished studies and the current one. Clones share the same record.
#[derive(Clone, Debug, Default)]
pub struct Ledger(Arc<Mutex<Entries>>);

#[derive(Debug, Default)]
struct Entries {
    closed: bool,
    /// The finished studies; `None` before the run has begun to write.
    report: Option<RunReport>,
    /// Positions of the finished studies in the scene, in increasing order.
    places: Vec<usize>,
    /// The current study, not yet computed, its position in the scene, and when it began.
    at_work: Option<(StudySummary, usize, Instant)>,
    /// Time at which the summary was last written, and how long that took.
    written: Option<(Instant, Duration)>,
}

impl Ledger {
    fn entries(&self) -> MutexGuard<'_, Entries> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Starts the record with the studies that are finished already, given with their positions in the scene, and
    /// writes the summary.
    pub(super) fn open(&self, report: RunReport, places: Vec<usize>) -> Result<(), RunError> {
        let mut entries = self.entries();
        (entries.report, entries.places) = (Some(report), places);
        entries.write()
    }

    /// Records the study that is computed now, and its position in the scene.
    pub(super) fn begin(&self, study: &StudySpec, place: usize) {
        let unanswered = StudySummary::unanswered(&study.name.0, study.kind.name());
        self.entries().at_work = Some((unanswered, place, Instant::now()));
    }

    /// Records a finished study and its position in the scene, and writes the summary unless that was just done.
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

    /// Ends the record: writes the summary and returns the report.
    pub(super) fn end(&self, interrupted: bool) -> Result<RunReport, RunError> {
        let mut entries = self.entries();
        entries.write()?;
        let report = entries.report.clone().expect("a run that ends has begun");
        Ok(RunReport { interrupted, ..report })
    }

    /// Ends the record while the run is still working: writes `summary.json` with the finished studies and with the
    /// current one as interrupted. Returns `None` if the run has not begun to write.
    ///
    /// If the program ends immediately afterwards, as `ends` says, unfinished files of the run are removed from its
    /// folder, but not those that it begins to write later, and the folder is free for other runs. Else it is so when
    /// the run has ended its step.
    ///
    /// # Errors
    /// [`RunError`] if the summary cannot be written.
    pub fn close(&self, ends: bool) -> Result<Option<RunReport>, RunError> {
        let mut entries = self.entries();
        let at_work = entries.at_work.take();
        let Some(out) = entries.report.as_ref().map(|report| report.out.clone()) else {
            entries.closed = true;
            return Ok(None);
        };
        let folder = at_work.as_ref().map(|(study, ..)| out.join(&study.name));
        if let Some((study, place, clock)) = at_work {
            let seconds = clock.elapsed().as_secs_f64();
            entries.insert(StudySummary { reason: Some(INTERRUPTED.into()), seconds, ..study }, place);
        }
        entries.write()?;
        entries.closed = true;
        if ends {
            folder.iter().chain([&out]).for_each(|folder| files::remove_own_drafts(folder));
        }
        Ok(entries.report.clone().map(|report| RunReport { interrupted: true, ..report }))
    }
}

impl Entries {
    fn insert(&mut self, study: StudySummary, place: usize) {
        let at = self.places.partition_point(|other| *other < place);
        if let Some(report) = &mut self.report {
            report.summary.studies.insert(at, study);
            self.places.insert(at, place);
        }
    }

    /// Writes the summary, unless the ledger is closed.
    fn write(&mut self) -> Result<(), RunError> {
        let Some(report) = self.report.as_ref().filter(|_| !self.closed) else { return Ok(()) };
        let start = Instant::now();
        files::write(&report.out.join("summary.json"), to_json(&report.summary))?;
        self.written = Some((Instant::now(), start.elapsed()));
        Ok(())
    }
}

/// The reason in the summary of a study that was stopped.
pub(crate) const INTERRUPTED: &str = "interrupted";
