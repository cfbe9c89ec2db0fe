//! The pipeline: reads a scene, builds its sheet and model, computes its studies and writes their files.

use std::path::Path;

use crate::numerics::parallel::Threads;
use crate::output::picture::Picture;
use crate::output::{files, vtk};
use crate::sheet::build::{self, Drawing};
use crate::sheet::{Info, Pattern, Sheet, fold, generate, obj};

mod belongings;
mod convert;
mod ending;
mod error;
mod film;
mod info;
mod inputs;
mod ledger;
mod report;
mod resume;
mod runner;
mod view;
mod written;

pub use crate::output::film::FilmOptions;
pub use crate::study::Observer;
pub use crate::study::Progress;
use ending::ending;
pub use error::RunError;
pub use film::film;
pub use info::{Counts, ElementCounts, EnergyCounts};
pub use ledger::Ledger;
pub use report::{RunOptions, RunReport};
use runner::Runner;
pub use view::view;

/// Reads a scene, computes its studies and writes their files.
///
/// # Errors
/// [`RunError`] if nothing could be computed; a study that fails is reported in the [`RunReport`] instead.
pub fn run_scene(scene: &Path, options: &RunOptions, observer: Observer) -> Result<RunReport, RunError> {
    run_with_ledger(scene, options, observer, &Ledger::default())
}

/// Does the same as [`run_scene`] and records the run in `ledger`, so that another thread can end the run without
/// waiting for it.
///
/// # Errors
/// [`RunError`], as [`run_scene`].
pub fn run_with_ledger(
    scene: &Path,
    options: &RunOptions,
    observer: Observer,
    ledger: &Ledger,
) -> Result<RunReport, RunError> {
    Threads::new(options.threads).install(|| run_on_these_threads(scene, options, observer, ledger))
}

fn run_on_these_threads(
    scene: &Path,
    options: &RunOptions,
    observer: Observer,
    ledger: &Ledger,
) -> Result<RunReport, RunError> {
    if MeshKind::of(scene).is_some() {
        return Err(RunError::NoScene { path: scene.into() });
    }
    let file = crate::scene::read(scene)?;
    if file.scene.studies.is_empty() {
        let help =
            "add one: [[study]], name = \"relaxed\", kind = \"relax\"; `foldwell info` counts what the sheet has";
        return Err(file.error_at(0..0, "there is nothing to compute: the scene has no [[study]]", help).into());
    }
    let assembly = crate::scene::build::assembly(&file)?;
    let mut runner = Runner::new(&file, &assembly, options, observer, ledger)?;
    for study in &file.scene.studies {
        runner.study(study)?;
        if runner.interrupted() {
            break;
        }
    }
    runner.finish()
}

/// Generates a pattern from the table `{ pattern = "miura", .. }` and writes it as a FOLD file.
///
/// # Errors
/// [`RunError`] if a parameter is wrong or the file cannot be written.
pub fn new_mesh(table: &toml::Table, out: &Path) -> Result<(), RunError> {
    let pattern: Pattern = table.clone().try_into().map_err(|error: toml::de::Error| RunError::Pattern {
        message: error.message().to_owned(),
        names: Pattern::names().join(", "),
    })?;
    let sheet = generate(&pattern)
        .map_err(|error| RunError::Pattern { message: error.to_string(), names: Pattern::names().join(", ") })?;
    Ok(files::write(out, fold::write(&sheet))?)
}

/// Returns counts and measures of the sheet of a mesh or a scene, and of the energy of a scene.
///
/// # Errors
/// [`RunError`] if the file cannot be read or is wrong.
pub fn info(mesh_or_scene: &Path) -> Result<Counts, RunError> {
    if ending(mesh_or_scene) == "toml" {
        let assembly = crate::scene::build::assembly(&crate::scene::read(mesh_or_scene)?)?;
        return Ok(Counts { sheet: Info::new(assembly.sheet()), energy: Some(EnergyCounts::new(&assembly)) });
    }
    let sheet = read_mesh(mesh_or_scene, ".fold, .obj, .vtu or .toml")?;
    Ok(Counts { sheet: Info::new(&sheet), energy: None })
}

/// Converts a mesh between FOLD, OBJ and VTU, which are recognised by the endings of the file names. Returns a sentence
/// for each part of the mesh that the new file does not keep.
///
/// # Errors
/// [`RunError`] if a file cannot be read, is wrong, has an unknown ending or cannot be written.
pub fn convert(from: &Path, to: &Path) -> Result<Vec<String>, RunError> {
    let sheet = read_mesh(from, MESHES)?;
    match MeshKind::of(to) {
        Some(MeshKind::Fold) => files::write(to, fold::write(&sheet))?,
        Some(MeshKind::Obj) => files::write(to, obj::write(&sheet))?,
        Some(MeshKind::Vtu) => vtk::write_vtu(to, &Picture::drawn(&sheet))?,
        None => return Err(RunError::Ending { path: to.into(), ending: ending(to), expected: MESHES }),
    }
    Ok(convert::not_kept(&sheet, MeshKind::of(from), MeshKind::of(to)))
}

const MESHES: &str = ".fold, .obj or .vtu";

/// The kinds of files that hold a mesh, recognised by the endings of their names.
#[derive(Clone, Copy, PartialEq, Eq)]
enum MeshKind {
    Fold,
    Obj,
    Vtu,
}

impl MeshKind {
    fn of(path: &Path) -> Option<Self> {
        match ending(path).as_str() {
            "fold" => Some(Self::Fold),
            "obj" => Some(Self::Obj),
            "vtu" => Some(Self::Vtu),
            _ => None,
        }
    }
}

fn read_mesh(path: &Path, expected: &'static str) -> Result<Sheet, RunError> {
    match MeshKind::of(path) {
        Some(MeshKind::Fold) => Ok(fold::read(path)?),
        Some(MeshKind::Obj) => Ok(obj::read(path)?),
        Some(MeshKind::Vtu) => {
            let mesh = vtk::read_vtu(path)?;
            let title = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let faces = mesh.triangles.iter().map(|t| t.to_vec()).collect();
            let drawn = Drawing { title, coords: mesh.points, faces, ..Drawing::default() };
            build::build(&drawn).map_err(|defect| RunError::NoSheet { path: path.into(), defect })
        }
        None => Err(RunError::Ending { path: path.into(), ending: ending(path), expected }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::OutputError;
    use crate::scene::SceneError;
    use std::io;

    /// Claim: a file that does not exist is wrong input (status 2); a file that cannot be read or written is a failure
    /// of the system, not of the user's scene (status 3).
    #[test]
    fn exit_statuses() {
        let read = |kind: io::ErrorKind| SceneError::Read { path: "a".into(), source: kind.into() };
        assert_eq!(RunError::from(read(io::ErrorKind::NotFound)).exit_status(), 2);
        assert_eq!(RunError::from(read(io::ErrorKind::PermissionDenied)).exit_status(), 3);
        let write = OutputError::Write { path: "a".into(), source: io::ErrorKind::StorageFull.into() };
        assert_eq!(RunError::from(write).exit_status(), 3);
    }
}
