//! The errors of a run.

use crate::output::OutputError;
use crate::scene::SceneError;
use crate::sheet::error::Defect;
use crate::sheet::pattern::NotFlat;
use crate::sheet::{GenerateError, NotDevelopable, SheetError};
use crate::study::StudyError;
use miette::Diagnostic;
use std::path::PathBuf;
use thiserror::Error;

/// The reasons for which a run, a conversion or a generator has no result.
#[derive(Debug, Error, Diagnostic)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum RunError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error("{}: this is a mesh, not a scene", path.display())]
    #[diagnostic(help("name it in a scene, a .toml file: under [sheet], mesh = \"{}\"", path.display()))]
    NoScene { path: PathBuf },
    #[error(transparent)]
    Mesh(#[from] SheetError),
    #[error("{}: {defect}", path.display())]
    NoSheet { path: PathBuf, defect: Defect },
    #[error("{}: this sheet has no solid of that thickness: {defect}", path.display())]
    #[diagnostic(help("layers of a sheet that is folded flat have no room for a thickness: take a state before"))]
    NoSolid { path: PathBuf, defect: Defect },
    #[error(transparent)]
    #[diagnostic(help("{}", .0.help()))]
    Pattern(#[from] GenerateError),
    #[error("{}: not the folder of a run: {why}", path.display())]
    #[diagnostic(help("name the folder that `foldwell run` wrote, the one with `summary.json`"))]
    NoRun { path: PathBuf, why: String },
    #[error("{}: this is the page of study `{study}`", path.display())]
    #[diagnostic(help("name another file: -o FILE.html"))]
    PageOfStudy { path: PathBuf, study: String },
    #[error("{}: frame {frame} is asked for, but this file has no frames", path.display())]
    #[diagnostic(help("frames are those of FOLD files; leave out the frame"))]
    NoFrames { path: PathBuf, frame: usize },
    #[error("{}: {reason}", path.display())]
    #[diagnostic(help("write another format, .fold, .obj or .vtu, or unfold the sheet, as `convert --flatten` does"))]
    NotFlat { path: PathBuf, reason: NotFlat },
    #[error("{}: {reason}", path.display())]
    #[diagnostic(help("`foldwell info` says whether a sheet is developable"))]
    NotDevelopable { path: PathBuf, reason: NotDevelopable },
    #[error("{}: the thickness is {thickness}, expected a number above 0", path.display())]
    Thickness { path: PathBuf, thickness: f64 },
    #[error("{}: no study with two states or more to film", path.display())]
    #[diagnostic(help("states are the files NAME/NAME_0000.vtu, ...: draw = [\"vtk\"] in a study writes them"))]
    NothingToFilm { path: PathBuf },
    #[error("{}: there is no branch {branch}", path.display())]
    #[diagnostic(help("{}", match &known[..] {
        [] => "this study has no branches; leave out --branch".to_owned(),
        known => format!("the branches are {}", known.iter().map(i64::to_string).collect::<Vec<_>>().join(", ")),
    }))]
    NoBranch { path: PathBuf, branch: i64, known: Vec<i64> },
    #[error("{}: one file for the films of {}", path.display(), studies.join(", "))]
    #[diagnostic(help("name one of them: {}.pvd", studies[0]))]
    SeveralFilms { path: PathBuf, studies: Vec<String> },
    #[error("{}: MP4 is written by ffmpeg, which is not on the PATH", path.display())]
    #[diagnostic(help("install ffmpeg, or name a file that ends in .gif"))]
    NoFfmpeg { path: PathBuf },
    #[error("{}: {}", path.display(), unknown_ending(ending))]
    #[diagnostic(help("expected one of {expected}"))]
    Ending { path: PathBuf, ending: String, expected: &'static str },
}

impl From<StudyError> for RunError {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Scene(error) => Self::Scene(error),
            StudyError::Output(error) => Self::Output(error),
        }
    }
}

impl RunError {
    /// Returns the exit status of the program: 2 if the input is wrong, 3 if an existing file or folder cannot be read
    /// or written, or is being written by another run.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::Scene(SceneError::Read { source, .. } | SceneError::Mesh(SheetError::Read { source, .. }))
            | Self::Mesh(SheetError::Read { source, .. })
            | Self::Output(OutputError::Read { source, .. })
                if !wrong_input(source) =>
            {
                3
            }
            Self::Output(OutputError::Write { .. } | OutputError::Claimed { .. }) => 3,
            _ => 2,
        }
    }
}

/// Returns the message about an unknown ending.
fn unknown_ending(ending: &str) -> String {
    if ending.is_empty() {
        "a file without an ending".to_owned()
    } else {
        format!("files ending in `{ending}` are not known here")
    }
}

/// Whether a file could not be read because of its name: it does not exist, or it is not a text file.
fn wrong_input(error: &std::io::Error) -> bool {
    use std::io::ErrorKind::{InvalidData, IsADirectory, NotADirectory, NotFound};
    matches!(error.kind(), NotFound | InvalidData | IsADirectory | NotADirectory)
}
