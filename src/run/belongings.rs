//! The files of each study in the folder of a run: removal of those of an earlier run, and a record of those that
//! exist.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::folder::files_of;
use crate::output::{OutputError, files};
use crate::scene::outputs::outputs;
use crate::scene::{Fingerprint, SceneFile};
use crate::study::Files;

/// The assignment of files to studies.
pub(crate) struct Belongings {
    out: PathBuf,
    /// Name of the study that can write a file, for files outside the folders of studies.
    writers: HashMap<String, String>,
    /// Files that the scene reads; they belong to no study.
    read: HashSet<PathBuf>,
}

impl Belongings {
    /// Collects the files of the studies of a scene in the folder `out`.
    pub(crate) fn new(file: &SceneFile, out: &Path) -> Self {
        let studies = file.scene.studies.iter();
        let writers =
            studies.flat_map(|study| outputs(study).into_iter().map(|file| (file, study.name.0.clone()))).collect();
        Self { out: out.into(), writers, read: super::inputs::real_paths(file) }
    }

    /// Returns the existing files that a study of this name has written, in order.
    fn present(&self, name: &str) -> Vec<String> {
        let is_own = |file: &String| {
            let path = self.out.join(file);
            self.writers.get(file).is_none_or(|writer| writer == name)
                && path.is_file()
                && fs::canonicalize(path).is_ok_and(|real| !self.read.contains(&real))
        };
        files_of(&self.out, name).into_iter().filter(is_own).collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// Removes the files that an earlier run wrote for a study of this name and this run did not write, and the study's
    /// folder if it is then empty.
    pub(crate) fn remove_others(&self, name: &str, written: &BTreeSet<PathBuf>) -> Result<(), OutputError> {
        let old = self.present(name).into_iter().map(|file| self.out.join(file));
        let old: Vec<PathBuf> = old.filter(|path| !written.contains(path)).collect();
        old.iter().try_for_each(|path| files::remove(path))?;
        if !old.is_empty() {
            // fails, as intended, if the folder is not empty
            let _ = fs::remove_dir(self.out.join(name));
        }
        Ok(())
    }

    /// Returns the record of the files of a study, which changes if any of them is missing, truncated or changed.
    pub(crate) fn record(&self, name: &str) -> Result<Files, OutputError> {
        let (mut digest, mut files) = (Fingerprint::default(), Files::default());
        for file in self.present(name) {
            let path = self.out.join(&file);
            let bytes = fs::read(&path).map_err(|source| OutputError::Read { path, source })?;
            digest.add(file.as_bytes());
            digest.add(&bytes);
            files.count += 1;
            files.bytes += bytes.len() as u64;
        }
        files.digest = digest.to_string();
        Ok(files)
    }
}
