//! The scenes of one call of `foldwell run`: all are read and checked before the first is computed.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use foldwell::run::{self, RunError, RunOptions};
use foldwell::scene::{self, SceneFile, Setting};

use super::ending::CommandFailure;

/// The word that stands for standard input.
const STANDARD_INPUT: &str = "-";
/// The name of a scene from standard input, in messages and of its folder.
const ITS_NAME: &str = "stdin";

/// Reads some scenes, sets keys in each, and returns them with the options of their runs. Several scenes are checked
/// before any of them is computed; a single one is checked when it is run.
pub(super) fn read(
    paths: &[PathBuf],
    settings: &[Setting],
    options: &RunOptions,
) -> Result<Vec<(SceneFile, RunOptions)>, CommandFailure> {
    let mut folders: BTreeMap<PathBuf, &PathBuf> = BTreeMap::new();
    let mut scenes = Vec::new();
    for path in paths {
        let out = folder(path, options.out.as_deref(), paths.len() > 1);
        if options.out.is_none() && out.is_file() {
            return Err(CommandFailure::NoFolder(out));
        }
        if let Some(first) = folders.insert(out.clone(), path) {
            return Err(CommandFailure::SameFolder { first: first.clone(), second: path.clone(), out });
        }
        scenes.push((read_one(path, settings)?, RunOptions { out: Some(out), ..options.clone() }));
    }
    if paths.len() > 1 {
        scenes.iter().try_for_each(|(scene, options)| run::check(scene, options))?;
    }
    Ok(scenes)
}

/// Returns the folder for the files of a scene: named like the scene, or as `--out` says; of several scenes, below
/// that.
fn folder(scene: &Path, out: Option<&Path>, several: bool) -> PathBuf {
    let name = if scene == Path::new(STANDARD_INPUT) { Path::new(ITS_NAME) } else { scene };
    let stem = PathBuf::from(name.file_stem().unwrap_or_default());
    match out {
        Some(out) if several => out.join(stem),
        Some(out) => out.to_owned(),
        None => stem,
    }
}

fn read_one(path: &Path, settings: &[Setting]) -> Result<SceneFile, CommandFailure> {
    if path != Path::new(STANDARD_INPUT) {
        return Ok(run::read_scene(path, settings)?);
    }
    let mut text = String::new();
    io::stdin().read_to_string(&mut text).map_err(CommandFailure::StandardInput)?;
    Ok(scene::parse_set(&text, ITS_NAME, settings).map_err(RunError::from)?)
}
