//! The page of a run: all of its studies, read back from the files in its folder.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use super::RunError;
use crate::output::html::{Content, StudyFiles, page};
use crate::output::{OutputError, files, vtk};
use crate::scene::outputs::{is_one_of, owned};

/// Name of the page in the folder of the run.
const PAGE: &str = "view.html";

/// Writes the page of a run and returns its path: `view.html` in the folder of the run, unless `to` is another one.
///
/// # Errors
/// [`RunError::NoRun`] if the folder has no `summary.json` of a run, [`RunError::PageOfStudy`] if the page would replace
/// that of a study, [`RunError::Output`] if a file cannot be read or the page cannot be written.
pub fn view(folder: &Path, to: Option<&Path>) -> Result<PathBuf, RunError> {
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

fn summary(folder: &Path) -> Result<Map<String, Value>, RunError> {
    let path = folder.join("summary.json");
    let no_run = |why: String| RunError::NoRun { path: folder.into(), why };
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(source) if source.kind() == std::io::ErrorKind::PermissionDenied => {
            return Err(OutputError::Read { path, source }.into());
        }
        Err(source) => return Err(no_run(format!("summary.json cannot be read: {source}"))),
    };
    let found: Value = serde_json::from_str(&text)
        .map_err(|error| no_run(format!("summary.json:{}:{}: {error}", error.line(), error.column())))?;
    match found {
        Value::Object(summary) if summary.get("studies").is_some_and(Value::is_array) => Ok(summary),
        _ => Err(no_run("summary.json is not that of a run: it has no list `studies`".into())),
    }
}

/// Returns the name of a study, if it is one that a scene can give: other names might lead out of the folder.
fn study_name(study: &Map<String, Value>) -> Option<&str> {
    let name = study.get("name")?.as_str()?;
    let allowed = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    (!name.is_empty() && name.chars().all(allowed)).then_some(name)
}

/// Whether a path is that of the page of a study.
fn is_page_of(folder: &Path, name: &str, path: &Path) -> bool {
    let own = folder.join(format!("{name}.html"));
    own == path || fs::canonicalize(&own).is_ok_and(|own| fs::canonicalize(path).is_ok_and(|path| path == own))
}

/// Returns the files of a study.
fn contents(folder: &Path, name: &str) -> Result<Vec<(String, Content<'static>)>, OutputError> {
    let own = owned(name);
    let entries = fs::read_dir(folder.join(name)).into_iter().flatten().flatten();
    let inside = entries.map(|entry| format!("{name}/{}", entry.file_name().to_string_lossy()));
    let beside = own.iter().filter(|file| !file.contains('/')).cloned();
    let content = |file: String| match content(&folder.join(&file)) {
        Ok(Some(content)) => Some(Ok((file, content))),
        Ok(None) => None,
        Err(error) => Some(Err(error)),
    };
    beside.chain(inside).filter(|file| is_one_of(&own, file)).filter_map(content).collect()
}

/// Reads a file; `None` if there is none, or if a page shows nothing of it.
fn content(path: &Path) -> Result<Option<Content<'static>>, OutputError> {
    if !path.is_file() {
        return Ok(None);
    }
    let text = || fs::read_to_string(path).map_err(|source| OutputError::Read { path: path.into(), source });
    Ok(match path.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => Some(Content::Table(text()?.into())),
        Some("svg") => Some(Content::Figure(text()?.into())),
        Some("vtu") => Some(Content::StateRead(Box::new(vtk::read_picture(path)?))),
        Some("vtp" | "vti") => Some(Content::Other),
        _ => None,
    })
}
