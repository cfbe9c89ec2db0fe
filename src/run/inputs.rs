//! The files that a scene reads: a run that would overwrite one of them is refused before it writes anything.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::sweep::place;
use crate::scene::outputs::{is_one_of, outputs};
use crate::scene::spec::StudySpec;
use crate::scene::{SceneError, SceneFile, named_files};

/// A file that is read: its name, its real path, and the folders and file names of both, which differ for a link.
struct Input {
    named: PathBuf,
    real: PathBuf,
    places: Vec<(PathBuf, String)>,
}

impl Input {
    fn new(named: PathBuf) -> Option<Self> {
        let real = fs::canonicalize(&named).ok()?;
        let parent = named.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let here = named.file_name().and_then(|file| Some(fs::canonicalize(parent).ok()?.join(file)));
        let place = |path: &PathBuf| Some((path.parent()?.into(), path.file_name()?.to_str()?.to_owned()));
        let places = [Some(real.clone()), here].iter().flatten().filter_map(place).collect();
        Some(Self { named, real, places })
    }

    /// Whether writing one of these files into the folder `out` would replace this input. `name` is that of a study,
    /// whose folder is in `out`.
    fn is_among(&self, out: &Path, name: Option<&str>, files: &[String]) -> bool {
        let within = |(prefix, folder): (String, PathBuf)| {
            let folder = fs::canonicalize(folder).ok()?;
            let mut found = self.places.iter().filter(|(parent, _)| *parent == folder);
            found.find(|(_, file)| is_one_of(files, &format!("{prefix}{file}"))).map(|_| ())
        };
        let own = name.map(|name| (format!("{name}/"), out.join(name)));
        let is_real = |file: &String| fs::canonicalize(out.join(file)).is_ok_and(|real| real == self.real);
        own.into_iter().chain([(String::new(), out.into())]).any(|folder| within(folder).is_some())
            || files.iter().any(is_real)
    }
}

fn inputs(file: &SceneFile) -> Vec<Input> {
    let named = std::iter::once(file.path().to_path_buf()).chain(named_files(file));
    named.filter_map(Input::new).collect()
}

/// Returns the real paths of the files that a scene reads, including that of the scene.
pub(crate) fn real_paths(file: &SceneFile) -> HashSet<PathBuf> {
    inputs(file).into_iter().map(|input| input.real).collect()
}

/// Checks that a run into the folder `out` would not overwrite a file that the scene reads.
pub(crate) fn check(file: &SceneFile, out: &Path) -> Result<(), SceneError> {
    if !out.exists() {
        return Ok(());
    }
    let sweeps = file.scene.sweep.is_some();
    let summary: &[&str] = if sweeps { &[place::TABLE, place::SUMMARY] } else { &["summary.json"] };
    let summary: Vec<String> = summary.iter().map(|&name| name.to_owned()).collect();
    let refused = |input: &Input, study: Option<&StudySpec>| {
        let span = study.map_or(0..0, |study| study.name.span());
        let who = study.map_or("the summary of this run".to_owned(), |study| format!("study `{}`", study.name.0));
        let message = format!("{who} would overwrite {}, which this scene reads", input.named.display());
        file.error_at(span, message, "choose another folder with --out, or another name for the study")
    };
    for input in inputs(file) {
        if input.is_among(out, None, &summary) {
            return Err(refused(&input, None));
        }
        let of_study = |study: &&StudySpec| input.is_among(out, Some(&study.name.0), &outputs(study));
        // the studies of a sweep write into the folders of its points
        if let Some(study) = file.scene.studies.iter().filter(|_| !sweeps).find(of_study) {
            return Err(refused(&input, Some(study)));
        }
    }
    Ok(())
}
