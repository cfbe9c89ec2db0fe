//! Films of the states of studies, from the files in the folder of a run.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::RunError;
use super::folder::{contents, study_name, summary};
use super::meshes::ending;
use crate::output::OutputError;
use crate::output::film::{FilmOptions, Reel, write_gif, write_mp4};
use crate::output::html::{Content, MODES, own_table, put_in_order, row_of};
use crate::output::picture::Picture;
use crate::output::sequence::{Place, Sequence, places, sequences};
use crate::sheet::text::read_bytes;

/// Number of frames in which a mode swings to and fro, and its amplitude relative to the size of the sheet.
const SWING_FRAMES: usize = 16;
const SWING: f64 = 0.1;

/// Writes films: of one study if `from` is its series `NAME.pvd`, and of each study with at least two states if it is
/// the folder of a run. Returns their paths: `NAME.gif` beside the series, unless `to` is another one, which may be an
/// MP4.
///
/// The states of a trajectory are in their order along one branch, from the end of the negative direction to that of
/// the positive one; this is the first branch, or that of the number `branch`. Each mode swings to and fro once.
///
/// # Errors
/// [`RunError`] if there are no such states, if a file cannot be read, or if the film cannot be written.
pub fn film(
    from: &Path,
    to: Option<&Path>,
    branch: Option<i64>,
    options: FilmOptions,
) -> Result<Vec<PathBuf>, RunError> {
    if let Some(to) = to.filter(|to| !["gif", "mp4"].contains(&ending(to).as_str())) {
        return Err(RunError::Ending { path: to.into(), ending: ending(to), expected: ".gif or .mp4" });
    }
    let (folder, studies) = studies(from)?;
    let films = studies.into_iter().map(|(name, kind)| Filmed::read(&folder, name, &kind));
    let mut films: Vec<Filmed> = films.collect::<Result<_, _>>()?;
    films.retain(|film| film.states.len() > 1);
    if films.is_empty() {
        return Err(RunError::NothingToFilm { path: from.into() });
    }
    if let Some(to) = to.filter(|_| films.len() > 1) {
        let studies = films.iter().map(|film| film.name.clone()).collect();
        return Err(RunError::SeveralFilms { path: to.into(), studies });
    }
    let mut written = Vec::new();
    for film in films {
        let path = to.map_or_else(|| folder.join(format!("{}.gif", film.name)), Path::to_owned);
        write(&path, &film.reel(&folder, branch)?, options)?;
        written.push(path);
    }
    Ok(written)
}

/// Returns the folder, and the names and kinds of the studies that are asked for.
fn studies(from: &Path) -> Result<(PathBuf, Vec<(String, String)>), RunError> {
    let named = |folder: &Path| -> Result<Vec<(String, String)>, RunError> {
        let summary = summary(folder)?;
        let all = summary.get("studies").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_object);
        let kind = |study: &serde_json::Map<String, Value>| {
            study.get("kind").and_then(Value::as_str).unwrap_or_default().to_owned()
        };
        Ok(all.filter_map(|study| Some((study_name(study)?.to_owned(), kind(study)))).collect())
    };
    if ending(from) != "pvd" {
        return Ok((from.into(), named(from)?));
    }
    // a series that is not there, or must not be read, is named as such
    read_bytes(from).map_err(|source| OutputError::Read { path: from.into(), source })?;
    let folder = from.parent().unwrap_or(Path::new("")).to_owned();
    let name = from.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let place = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder };
    let kind = named(&place).unwrap_or_default().into_iter().find(|(study, _)| *study == name);
    Ok((place, vec![(name, kind.map_or_else(String::new, |(_, kind)| kind))]))
}

/// The states of a study.
struct Filmed {
    name: String,
    is_modes: bool,
    states: Vec<Picture>,
    /// Where they are on the branches of the study.
    places: Vec<Place>,
}

impl Filmed {
    fn read(folder: &Path, name: String, kind: &str) -> Result<Self, RunError> {
        let mut files = contents(folder, &name)?;
        put_in_order(&mut files);
        let table = own_table(&name, &files).map(str::to_owned);
        let state = |(file, content): (String, Content<'_>)| Some((row_of(&name, &file), content.picture()?.clone()));
        let (rows, states): (Vec<_>, _) = files.into_iter().filter_map(state).unzip();
        let places = places(table.as_deref(), rows.into_iter());
        Ok(Self { is_modes: MODES.contains(&kind), name, states, places })
    }

    /// Returns the pictures in the order of the film, seen as the first of them in the table.
    fn reel(self, folder: &Path, branch: Option<i64>) -> Result<Reel, RunError> {
        if self.is_modes {
            let phase = |frame: usize| (TAU * frame as f64 / SWING_FRAMES as f64).sin();
            let swing = |picture: &Picture| {
                (0..SWING_FRAMES).map(|frame| picture.displaced(SWING * phase(frame))).collect::<Vec<_>>()
            };
            return Ok(Reel { pictures: self.states.iter().flat_map(swing).collect(), front: 0 });
        }
        let places = self.places;
        let points = self.states.iter().map(|picture| picture.points.as_slice());
        let placed: Vec<_> = places.iter().copied().zip(points).collect();
        let of_branch = |sequence: &Sequence| sequence.states.iter().any(|&state| places[state].branch == branch);
        let found = sequences(&placed).into_iter().find(|sequence| branch.is_none() || of_branch(sequence));
        let Some(sequence) = found else {
            let mut known: Vec<i64> = places.iter().filter_map(|place| place.branch).collect();
            known.dedup();
            let path = folder.join(format!("{}.pvd", self.name));
            return Err(RunError::NoBranch { path, branch: branch.unwrap_or_default(), known });
        };
        let mut states: Vec<Option<Picture>> = self.states.into_iter().map(Some).collect();
        let front = (0..sequence.states.len()).min_by_key(|&k| sequence.states[k]).unwrap_or(0);
        Ok(Reel { pictures: sequence.states.iter().filter_map(|&state| states[state].take()).collect(), front })
    }
}

fn write(path: &Path, reel: &Reel, options: FilmOptions) -> Result<(), RunError> {
    if ending(path) == "gif" {
        return Ok(write_gif(path, reel, options)?);
    }
    match write_mp4(path, reel, options) {
        Err(OutputError::Write { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
            Err(RunError::NoFfmpeg { path: path.into() })
        }
        written => Ok(written?),
    }
}
