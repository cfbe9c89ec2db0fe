//! The pipeline: reads a scene, builds its sheet and model, computes its studies and writes their files.

use std::path::Path;

use crate::output::OutputError;
use crate::output::table::Table;
use crate::scene::{SceneFile, Setting};
use crate::sheet::pattern::Cleanup;
use crate::sheet::{Info, Pattern, Sheet, flatten, generate, welded};

mod belongings;
mod claim;
mod convert;
mod error;
mod film;
mod folder;
mod in_memory;
mod info;
mod inputs;
mod ledger;
mod log;
mod meshes;
mod report;
mod resume;
mod runner;
pub mod schema;
mod single;
mod studies;
mod summary;
mod sweep;
mod view;

pub use crate::output::film::FilmOptions;
pub use crate::study::{Observer, Progress};
pub use error::RunError;
pub use film::film;
pub use in_memory::{Computed, compute};
pub use info::{Counts, ElementCounts, EnergyCounts, edges, vertices};
pub use ledger::Ledger;
use meshes::{MeshKind, ending, read_mesh};
pub use meshes::{write_sheet, write_state};
pub use report::{RunOptions, RunReport};
pub use single::{run, run_and_keep};
pub use summary::{SheetSummary, Summary};
pub use sweep::{
    PointStatus, Shard, ShardError, SweepReport, SweepRow, SweepSummary, UnansweredPoint, assemble, assemble_at,
    check_scenes, points, rows, run_point, sweep, table_of,
};
pub use view::view;

/// Reads a scene, computes its studies and writes their files.
///
/// # Errors
/// [`RunError`] if nothing could be computed; a study that fails is reported in the [`RunReport`] instead.
pub fn run_scene(scene: &Path, options: &RunOptions, observer: Observer) -> Result<RunReport, RunError> {
    run(&read_scene(scene, &[])?, options, observer, &Ledger::default())
}

/// Reads a scene file and sets some of its keys.
///
/// # Errors
/// [`RunError::NoScene`] if the file is a mesh, [`RunError::Scene`] if it cannot be read or is wrong.
pub fn read_scene(path: &Path, settings: &[Setting]) -> Result<SceneFile, RunError> {
    if MeshKind::of(path).is_some() {
        return Err(RunError::NoScene { path: path.into() });
    }
    Ok(crate::scene::read_set(path, settings)?)
}

/// Does the checks that [`run`] does before it computes anything, of a sweep those of every point; writes nothing.
///
/// # Errors
/// [`RunError`] if [`run`] would refuse the scene, or one of the points of its sweep.
pub fn check(file: &SceneFile, options: &RunOptions) -> Result<(), RunError> {
    if file.scene.sweep.is_some() {
        return sweep::check(file, options);
    }
    single::check(file, options)
}

/// Generates the sheet of a pattern from the table `{ pattern = "miura", .. }`.
///
/// # Errors
/// [`RunError::Pattern`] if there is no such pattern or a parameter is wrong.
pub fn new_sheet(table: &toml::Table) -> Result<Sheet, RunError> {
    Ok(generate(&Pattern::of(table)?)?)
}

/// Options for reading a mesh or a scene.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Keys of the scene that are set first.
    pub settings: Vec<Setting>,
    /// The frame of the FOLD file; `None` for that of the scene, or the first with a mesh.
    pub frame: Option<usize>,
}

/// Returns counts and measures of the sheet of a mesh or a scene, and of the energy of a scene.
///
/// # Errors
/// [`RunError`] if the file cannot be read or is wrong, if there is no such frame, and if keys of a mesh are set.
pub fn info(mesh_or_scene: &Path, wanted: &Wanted) -> Result<Counts, RunError> {
    if ending(mesh_or_scene) == "toml" {
        let assembly = crate::scene::build::assembly(&wanted.scene(mesh_or_scene)?)?;
        return Ok(Counts { sheet: Info::new(assembly.sheet()), energy: Some(EnergyCounts::new(&assembly)) });
    }
    Ok(Counts { sheet: Info::new(&wanted.sheet(mesh_or_scene)?), energy: None })
}

/// Returns the [`vertices`] or the [`edges`] of the sheet of a mesh or a scene as a table in CSV.
///
/// # Errors
/// [`RunError`], as [`info`].
pub fn list(mesh_or_scene: &Path, wanted: &Wanted, listed: fn(&Sheet) -> Table) -> Result<String, RunError> {
    let table = listed(&wanted.sheet(mesh_or_scene)?);
    Ok(table.to_csv().map_err(|fault| OutputError::Shape { path: mesh_or_scene.into(), fault })?)
}

impl Wanted {
    fn scene(&self, path: &Path) -> Result<SceneFile, RunError> {
        let settings: Vec<Setting> = self.settings.iter().cloned().chain(self.frame.map(Setting::of_frame)).collect();
        Ok(crate::scene::read_set(path, &settings)?)
    }

    fn sheet(&self, mesh_or_scene: &Path) -> Result<Sheet, RunError> {
        if ending(mesh_or_scene) == "toml" {
            return Ok(crate::scene::build::sheet(&self.scene(mesh_or_scene)?)?);
        }
        let sheet = read_mesh(mesh_or_scene, self.frame, None, meshes::READ_OR_SCENE)?;
        if self.settings.is_empty() { Ok(sheet) } else { Err(RunError::NoScene { path: mesh_or_scene.into() }) }
    }
}

/// Reads the sheet of a mesh in the format of its ending; of a FOLD file the given frame, or the first with a mesh.
/// `merge` is a distance in units of the file: points of a drawing of lines, or of a flat FOLD file, that are nearer to
/// each other become one.
///
/// # Errors
/// [`RunError`] if the file cannot be read, is wrong or has an unknown ending, if there is no such frame, and if points
/// are to be merged in a file of faces.
pub fn read_sheet(path: &Path, frame: Option<usize>, merge: Option<f64>) -> Result<Sheet, RunError> {
    match merge {
        Some(_) => read_mesh(path, frame, Some(&Cleanup { merge, split: true }), meshes::CLEANED),
        None => read_mesh(path, frame, None, meshes::READ),
    }
}

/// Converts a mesh between the formats that are recognised by the endings of file names; of a FOLD file the given
/// frame, or the first with a mesh. Where a thickness is given, the new file has the solid of the sheet
/// ([`thickened`](crate::sheet::thickened)). Returns a sentence for each part of the mesh that it does not keep.
///
/// # Errors
/// [`RunError`] if a file cannot be read, is wrong, has an unknown ending or cannot be written, if there is no such
/// frame, if the new file is for flat sheets and the sheet is not flat, and if the thickness is not above 0.
pub fn convert(from: &Path, to: &Path, frame: Option<usize>, thickness: Option<f64>) -> Result<Vec<String>, RunError> {
    write_sheet(&read_mesh(from, frame, None, meshes::READ)?, to, thickness)
}

/// Does the same as [`convert`] with a flat crease pattern whose vertices are merged, and whose edges are split where
/// they cross and touch.
///
/// # Errors
/// As [`convert`]; also if the mesh is no flat finite crease pattern, if edges that lie on each other differ, and if
/// the merging distance is not positive or too large.
pub fn convert_cleaned(
    from: &Path,
    to: &Path,
    frame: Option<usize>,
    cleanup: &Cleanup,
) -> Result<Vec<String>, RunError> {
    write_sheet(&read_mesh(from, frame, Some(cleanup), meshes::CLEANED)?, to, None)
}

/// Does the same as [`convert`] with the crease pattern of a folded sheet: the sheet unfolded into the plane, with its
/// fold angles as target angles.
///
/// # Errors
/// As [`convert`]; also if the sheet cannot be unfolded.
pub fn convert_flattened(from: &Path, to: &Path, frame: Option<usize>) -> Result<Vec<String>, RunError> {
    let folded = read_mesh(from, frame, None, meshes::READ)?;
    let pattern = flatten(&folded).map_err(|reason| RunError::NotDevelopable { path: from.into(), reason })?;
    write_sheet(&pattern, to, None)
}

/// Does the same as [`convert`] with the pieces of a sheet joined where they touch ([`welded`]).
///
/// # Errors
/// As [`convert`]; also if what is joined is no sheet.
pub fn convert_welded(from: &Path, to: &Path, frame: Option<usize>) -> Result<Vec<String>, RunError> {
    let apart = read_mesh(from, frame, None, meshes::READ)?;
    let (sheet, [vertices, faces]) =
        welded(&apart).map_err(|defect| RunError::NoSheet { path: from.into(), defect })?;
    let mut notes = write_sheet(&sheet, to, None)?;
    notes.push(format!("vertices joined to others at their places: {vertices}; faces on others left out: {faces}"));
    Ok(notes)
}

#[cfg(test)]
mod tests {
    use super::*;
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
