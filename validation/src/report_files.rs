//! Writing of the reports `report.json`, `report.md` and `report.html` ([`super::page`]).

use super::page;
use super::report::Report;
use foldwell::output::json::to_json;
use foldwell::output::{OutputError, files};
use std::path::Path;

impl Report {
    /// Writes the three reports.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn write(&self, folder: &Path) -> Result<(), OutputError> {
        files::write(&folder.join("report.json"), to_json(self))?;
        files::write(&folder.join("report.md"), self.markdown())?;
        files::write(&folder.join("report.html"), page::html(self))
    }
}
