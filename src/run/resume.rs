//! The results of an earlier run into the same folder, and the decision which of them can be kept.
//!
//! A study enters `summary.json` only after all its files are complete, so a study that is listed there as converged is
//! finished. It is kept if the digest of the scene and of every file that the scene names is the same, and if the
//! study's own files are those on record. A study from which a later one starts leaves its state in `NAME.state.json`,
//! every number with enough digits to be read back exactly, so that the later study starts from the same state.

use super::belongings::Belongings;
use crate::math::Vec3;
use crate::model::Configuration;
use crate::output::figure::surface::TrajectoryPoint;
use crate::output::json::from_file;
use crate::output::table::columns_of;
use crate::output::{OutputError, files};
use crate::scene::SceneFile;
use crate::scene::forms::StartSpec;
use crate::scene::spec::{StudyKind, StudySpec};
use crate::study::StudySummary;
use serde::Deserialize;
use serde_json::value::RawValue;
use std::path::Path;

/// The parts of an earlier `summary.json` that are needed to resume.
#[derive(Default, Deserialize)]
pub(crate) struct PreviousRun {
    /// Empty if there is no earlier run of the scene.
    pub(crate) digest: String,
    /// The studies, each parsed separately: one that cannot be read, such as one with an invalid number, does not
    /// affect the others.
    studies: Vec<Box<RawValue>>,
}

impl PreviousRun {
    /// Reads the earlier run into this folder; the result is empty if there is none or its digest is another one.
    pub(crate) fn read(out: &Path, digest: &str) -> Self {
        from_file(&out.join("summary.json")).filter(|earlier: &Self| earlier.digest == digest).unwrap_or_default()
    }

    /// Returns the summary of a study in the earlier run, and its final state if later studies start from it; `None` if
    /// the study must be computed.
    pub(crate) fn study(
        &self,
        file: &SceneFile,
        (out, files): (&Path, &Belongings),
        study: &StudySpec,
    ) -> Option<(StudySummary, Option<Configuration>)> {
        let name = &study.name.0;
        let mut readable =
            self.studies.iter().filter_map(|study| serde_json::from_str::<StudySummary>(study.get()).ok());
        let found = readable.find(|found| found.name == *name)?;
        if !found.converged || found.result.is_none() || found.files != files.record(name).ok() {
            return None;
        }
        let state = if is_start(file, name) { Some(from_file(&out.join(state_file(name)))?) } else { None };
        Some((found, state))
    }
}

/// Whether a later study starts from this one.
pub(crate) fn is_start(file: &SceneFile, name: &str) -> bool {
    let mut starts = file.scene.studies.iter().filter_map(|study| study.kind.start());
    starts.any(|start| matches!(&**start, StartSpec::Study(start) if start == name))
}

/// Returns the trajectories that a study of an earlier run followed, in the space of lattice strains, read from its
/// table; `None` for studies that follow no trajectories.
pub(crate) fn paths(out: &Path, study: &StudySpec) -> Result<Option<Vec<Vec<TrajectoryPoint>>>, OutputError> {
    const COLUMNS: [&str; 8] = ["branch", "sign", "curvature", "strain11", "strain22", "strain12", "theta1", "theta2"];
    if !matches!(*study.kind, StudyKind::Trace(_)) {
        return Ok(None);
    }
    let path = out.join(format!("{}.csv", study.name.0));
    let text = std::fs::read_to_string(&path).map_err(|source| OutputError::Read { path, source })?;
    let rows = columns_of(&text, &COLUMNS);
    let of_one_ray = |a: &Vec<f64>, b: &Vec<f64>| a[..2] == b[..2];
    let point = |row: &Vec<f64>| TrajectoryPoint::new(Vec3::new(row[3], row[4], row[5]), row[2], [row[6], row[7]]);
    Ok(Some(rows.chunk_by(of_one_ray).map(|rows| rows.iter().map(point).collect()).collect()))
}

/// Returns the name of the file of the state in which a study ended.
pub(crate) fn state_file(name: &str) -> String {
    format!("{name}.state.json")
}

/// Writes the state in which a study ended.
pub(crate) fn write_state(path: &Path, state: &Configuration) -> Result<(), OutputError> {
    // a list of finite numbers, so that serialization cannot fail
    files::write(path, serde_json::to_string(state).unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Memory;

    /// Claim: a state is read back bit by bit, also if its numbers have no short decimal form; a truncated file is
    /// rejected.
    #[test]
    fn a_state_comes_back_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let scene = "[sheet]\nmesh = \"a.fold\"\n[[study]]\nname = \"a\"\nkind = \"relax\"\n[[study]]\nname = \"b\"\n\
                     kind = \"relax\"\nstart = \"a\"\n";
        let file = crate::scene::parse(scene, "s.toml").unwrap();
        let state = Configuration {
            coordinates: vec![0.1 + 0.2, -0.0, 5e-324, 1e300 / 3.0],
            angles: vec![-std::f64::consts::PI],
            tension: Some(vec![1.0 / 3.0, -0.0]),
            memory: vec![Memory { kept: 0.1 + 0.2, gone: 1e300 / 3.0 }],
        };
        let path = folder.path().join(state_file("a"));
        write_state(&path, &state).unwrap();
        let back: Configuration = from_file(&path).unwrap();
        let bits = |state: &Configuration| state.coordinates.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&back), bits(&state));
        assert_eq!(back, state);
        assert_eq!(["a", "b"].map(|name| is_start(&file, name)), [true, false], "nothing starts from the second");
        std::fs::write(&path, "{\"coordinates\":[0.1").unwrap();
        assert_eq!(from_file::<Configuration>(&path), None);
    }
}
