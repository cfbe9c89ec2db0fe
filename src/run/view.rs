//! The page of a run: all of its studies, read back from the files in its folder.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use super::RunError;
use super::folder::{contents, study_name, summary};
use super::meshes::ending;
use crate::output::html::{StudyFiles, page};
use crate::output::{OutputError, files};

/// Name of the page in the folder of the run.
const PAGE: &str = "view.html";

/// Writes the page of a run and returns its path: `view.html` in the folder of the run, unless `to` is another one.
///
/// # Errors
/// [`RunError::Ending`] if `to` does not end in `.html`, [`RunError::NoRun`] if the folder has no `summary.json` of a
/// run, [`RunError::PageOfStudy`] if the page would replace that of a study, [`RunError::Output`] if a file cannot be
/// read or the page cannot be written.
pub fn view(folder: &Path, to: Option<&Path>) -> Result<PathBuf, RunError> {
    if let Some(to) = to.filter(|to| ending(to) != "html") {
        return Err(RunError::Ending { path: to.into(), ending: ending(to), expected: ".html" });
    }
    let summary = summary(folder)?;
    let word = |key: &str| summary.get(key).and_then(Value::as_str);
    let title = word("title").or(word("scene")).unwrap_or_default();
    let studies: Vec<&Map<String, Value>> =
        summary.get("studies").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_object).collect();
    let to = to.map_or_else(|| folder.join(PAGE), Path::to_owned);
    if let Some(name) = studies.iter().filter_map(|study| study_name(study)).find(|name| is_page_of(folder, name, &to))
    {
        return Err(RunError::PageOfStudy { path: to, study: name.to_owned() });
    }
    let read = |study: &&Map<String, Value>| {
        let files = study_name(study).map_or(Ok(Vec::new()), |name| contents(folder, name))?;
        Ok(StudyFiles::new((*study).clone(), files))
    };
    let studies: Vec<StudyFiles<'_>> = studies.iter().map(read).collect::<Result<_, OutputError>>()?;
    files::write(&to, page(title, &studies))?;
    Ok(to)
}

/// Whether a path is that of the page of a study.
fn is_page_of(folder: &Path, name: &str, path: &Path) -> bool {
    let own = folder.join(format!("{name}.html"));
    own == path || fs::canonicalize(&own).is_ok_and(|own| fs::canonicalize(path).is_ok_and(|path| path == own))
}
