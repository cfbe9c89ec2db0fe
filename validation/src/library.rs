//! The claims of `validation/claims`, and the scenes and meshes of the repository that they are about.

use super::ValidationError;
use super::claim::Claim;
use std::path::{Path, PathBuf};

/// Returns all claims, by name.
///
/// # Errors
/// [`ValidationError`] where the folder cannot be read, and of the first file that is not a valid claim.
pub fn claims() -> Result<Vec<Claim>, ValidationError> {
    let folder = repository().join("validation/claims");
    let read = |source| ValidationError::Read { path: folder.clone(), source };
    let mut files: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(read)? {
        files.push(entry.map_err(read)?.path());
    }
    files.sort();
    files.iter().map(|path| claim(path, &path.file_stem().unwrap_or_default().to_string_lossy())).collect()
}

/// Reads a claim, which gets this name.
///
/// # Errors
/// [`ValidationError`] where the file cannot be read or is not a valid claim.
pub fn claim(path: &Path, name: &str) -> Result<Claim, ValidationError> {
    let text = std::fs::read_to_string(path).map_err(|source| ValidationError::Read { path: path.into(), source })?;
    Ok(Claim::parse(name, &text)?)
}

/// Returns the path of a mesh or scene of the repository.
pub fn mesh(name: &str) -> PathBuf {
    repository().join("meshes").join(name)
}

fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claim::Experiment;
    use crate::measure;

    /// Claim: each file of the folder is a valid claim, and the scene or measurement that it names exists.
    #[test]
    fn every_file_is_a_claim() {
        let claims = claims().unwrap();
        assert!(claims.len() > 40, "{} claims", claims.len());
        for claim in claims {
            match &claim.experiment {
                Experiment::Scene(scene) => assert!(mesh(scene).exists(), "{}: {scene}", claim.name),
                Experiment::Measurement(name) => assert!(measure::find(name).is_some(), "{}: {name}", claim.name),
            }
        }
    }
}
