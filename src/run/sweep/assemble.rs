//! The table of a sweep, made from the folders of its points.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::{Deserialize, Serialize};

use super::place::{SUMMARY, TABLE, point_folder, points};
use super::record::Record;
use super::scalars;
use super::summary::{PointStatus, SweepSummary, UnansweredPoint};
use crate::output::files;
use crate::output::json::to_json;
use crate::output::table::csv_line;
use crate::run::{RunError, RunOptions, claim};
use crate::scene::{SceneFile, Sweep, digest};

/// A row of the table: what became of a point, why, and its scalar results.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SweepRow {
    status: PointStatus,
    reason: String,
    scalars: BTreeMap<String, String>,
}

impl SweepRow {
    pub(super) fn new(found: Option<&Record>) -> Self {
        let scalars = match found {
            Some(Record::Computed(studies)) => studies.iter().flat_map(scalars::of_study).collect(),
            _ => BTreeMap::new(),
        };
        let status = found.map_or(PointStatus::Missing, Record::status);
        Self { status, reason: found.map(Record::reason).unwrap_or_default(), scalars }
    }

    /// Whether another run may find another result: the point has none, or failed and may be tried again.
    fn is_open(&self) -> bool {
        matches!(self.status, PointStatus::Missing | PointStatus::Failed)
    }
}

/// The table of a sweep while its points are computed: what became of each, as far as that was looked up.
pub(super) struct Board<'a> {
    pub(super) sweep: &'a Sweep,
    pub(super) out: &'a Path,
    rows: Mutex<Vec<SweepRow>>,
}

impl<'a> Board<'a> {
    /// The table of a sweep of which no point was looked up.
    pub(super) fn new(sweep: &'a Sweep, out: &'a Path) -> Self {
        Self { sweep, out, rows: Mutex::new((0..sweep.len()).map(|_| SweepRow::new(None)).collect()) }
    }

    fn rows(&self) -> MutexGuard<'_, Vec<SweepRow>> {
        self.rows.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Records what was found of a point.
    pub(super) fn set(&self, index: usize, found: Option<&Record>) {
        let row = SweepRow::new(found);
        self.rows()[index] = row;
    }

    /// Looks up what became of a point.
    pub(super) fn look_up(&self, index: usize) -> Result<(), RunError> {
        let folder = point_folder(self.out, index);
        // most points of a long sweep that was just begun have no folder, and their scenes need not be read
        let found = if folder.is_dir() { Record::read(&self.sweep.scene(index)?, &folder) } else { None };
        self.set(index, found.as_ref());
        Ok(())
    }

    /// Writes the table and the summary, which it returns, after it has looked up the points that were missing or
    /// failed.
    ///
    /// Several runs may do this at once. Each looks again after it has written, and writes once more if a point was
    /// finished meanwhile: so the table that is written last has all points.
    pub(super) fn write(&self) -> Result<SweepSummary, RunError> {
        let mut written = None;
        loop {
            let open: Vec<usize> =
                (0..).zip(self.rows().iter()).filter(|(_, row)| row.is_open()).map(|(k, _)| k).collect();
            open.into_iter().try_for_each(|index| self.look_up(index))?;
            let summary = self.summary()?;
            if written.as_ref() == Some(&summary) {
                return Ok(summary);
            }
            files::write(&self.out.join(TABLE), table(self.sweep, &self.rows()))?;
            files::write(&self.out.join(SUMMARY), to_json(&summary))?;
            written = Some(summary);
        }
    }

    /// Returns the summary.
    pub(super) fn summary(&self) -> Result<SweepSummary, RunError> {
        summary(self.sweep, &self.rows())
    }
}

/// Collects the finished points from their folders and writes the table and the summary of a sweep into `out`; returns
/// the summary. The bytes of the table depend on the results of the points alone, not on the runs that computed them.
///
/// Several runs of one sweep may do this at once: the table that is written last has all points.
///
/// # Errors
/// [`RunError`] if a run of another scene is writing into the folder, if the scene of a point is refused, or if a file
/// cannot be written.
pub fn assemble(sweep: &Sweep, out: &Path) -> Result<SweepSummary, RunError> {
    let _claim = claim::of_sweep(out, sweep)?;
    Board::new(sweep, out).write()
}

/// Does the same for the sweep of a scene in the folder of its run, for a program that ends a run without waiting for
/// it, and removes its unfinished files; `None` if the folder does not exist.
///
/// # Errors
/// As [`assemble`].
pub fn assemble_at(file: &SceneFile, options: &RunOptions) -> Result<Option<SweepSummary>, RunError> {
    let out = options.folder(file);
    if !out.exists() {
        return Ok(None);
    }
    let summary = assemble(&points(file)?, &out)?;
    summary.missing.iter().for_each(|&index| files::remove_own_drafts(&point_folder(&out, index)));
    files::remove_own_drafts(&out);
    Ok(Some(summary))
}

/// Returns the table of a sweep with these rows as text, and its summary; a point without a row is missing.
///
/// # Errors
/// [`RunError`] if a file that the scene names cannot be read.
pub fn table_of(sweep: &Sweep, rows: Vec<Option<SweepRow>>) -> Result<(String, SweepSummary), RunError> {
    let rows: Vec<SweepRow> = rows.into_iter().map(|row| row.unwrap_or_else(|| SweepRow::new(None))).collect();
    Ok((table(sweep, &rows), summary(sweep, &rows)?))
}

/// Returns the text of the table. The columns of results are those that a point has, studies in the order of the scene.
fn table(sweep: &Sweep, rows: &[SweepRow]) -> String {
    let columns = columns(sweep, rows);
    let header = ["point"].into_iter().chain(sweep.keys()).chain(["status", "reason"]);
    let mut text = csv_line(header.chain(columns.iter().map(String::as_str)));
    for (index, row) in rows.iter().enumerate() {
        let (point, number) = (sweep.point(index), index.to_string());
        let start = [number.as_str()].into_iter().chain(point.values.iter().map(String::as_str));
        let results = columns.iter().map(|column| row.scalars.get(column).map_or("", String::as_str));
        text += &csv_line(start.chain([row.status.word(), &row.reason]).chain(results));
    }
    text
}

fn columns(sweep: &Sweep, rows: &[SweepRow]) -> Vec<String> {
    let studies = sweep.file().scene.studies.iter();
    let order: BTreeMap<&str, usize> = studies.enumerate().map(|(k, study)| (study.name.0.as_str(), k)).collect();
    let found: BTreeSet<String> = rows.iter().flat_map(|row| row.scalars.keys().cloned()).collect();
    // a result that is a table at some points and null at others has the columns of the table
    let is_table = |column: &str| {
        let inside = format!("{column}.");
        found.iter().any(|other| other.starts_with(&inside))
    };
    let mut columns: Vec<String> = found.iter().filter(|column| !is_table(column)).cloned().collect();
    columns.sort_by_key(|column| {
        column.split('.').next().and_then(|name| order.get(name).copied()).unwrap_or(order.len())
    });
    columns
}

fn summary(sweep: &Sweep, rows: &[SweepRow]) -> Result<SweepSummary, RunError> {
    let with = |status: PointStatus| (0..).zip(rows).filter(move |(_, row)| row.status == status);
    let unanswered = |(index, row): (usize, &SweepRow)| UnansweredPoint {
        point: index,
        settings: sweep.point(index).settings.iter().map(ToString::to_string).collect(),
        status: row.status,
        reason: row.reason.clone(),
    };
    let open = |row: &SweepRow| matches!(row.status, PointStatus::NotConverged | PointStatus::Failed);
    let file = sweep.file();
    Ok(SweepSummary {
        version: env!("CARGO_PKG_VERSION"),
        scene: file.path().display().to_string(),
        settings: file.settings().to_vec(),
        title: file.title(),
        units: file.scene.units.clone(),
        digest: digest(file)?,
        keys: sweep.keys().map(str::to_owned).collect(),
        points: rows.len(),
        converged: with(PointStatus::Converged).count(),
        not_converged: with(PointStatus::NotConverged).count(),
        failed: with(PointStatus::Failed).count(),
        missing: with(PointStatus::Missing).map(|(index, _)| index).collect(),
        unanswered: (0..).zip(rows).filter(|(_, row)| open(row)).map(unanswered).collect(),
    })
}
