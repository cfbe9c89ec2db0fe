//! Reader of the files that a run has written into its folder.

use std::fs;
use std::path::Path;

use serde_json::{Map, Value};

use super::RunError;
use crate::output::html::Content;
use crate::output::{OutputError, vtk};
use crate::scene::outputs::{is_one_of, owned};
use crate::scene::values::Label;

/// Returns the summary of the run that wrote into a folder.
pub(super) fn summary(folder: &Path) -> Result<Map<String, Value>, RunError> {
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
pub(super) fn study_name(study: &Map<String, Value>) -> Option<&str> {
    let name = study.get("name")?.as_str()?;
    Label::try_from(name.to_owned()).is_ok().then_some(name)
}

/// Returns the files of a study that can be shown.
pub(super) fn contents(folder: &Path, name: &str) -> Result<Vec<(String, Content<'static>)>, OutputError> {
    let content = |file: String| {
        let content = content(&folder.join(&file));
        content.map(|content| Some((file, content?))).transpose()
    };
    files_of(folder, name).into_iter().filter_map(content).collect()
}

/// Returns the files of a study that may be there: those beside its own folder, and those in it.
pub(super) fn files_of(folder: &Path, name: &str) -> Vec<String> {
    let own = owned(name);
    let entries = fs::read_dir(folder.join(name)).into_iter().flatten().flatten();
    let inside = entries.map(|entry| format!("{name}/{}", entry.file_name().to_string_lossy()));
    let beside = own.iter().filter(|file| !file.contains('/')).cloned();
    beside.chain(inside).filter(|file| is_one_of(&own, file)).collect()
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
