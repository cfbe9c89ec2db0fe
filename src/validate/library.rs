//! The claims, scenes and meshes of the repository, embedded in the program so that it can validate itself wherever it
//! is installed.

use super::claim::{Claim, ClaimError};

/// Names and texts of files in a folder of the repository.
macro_rules! files {
    ($folder:literal, $ending:literal: $($name:literal)*) => {
        &[$(($name, include_str!(concat!("../../", $folder, "/", $name, $ending)))),*]
    };
}

/// Files of `validation/claims` without extension, in the order of checks and reports.
const CLAIMS: &[(&str, &str)] = files!("validation/claims", ".toml":
    "loops-of-open-star"
    "loops-close"
    "loops-stay-closed"
    "engines-agree"
    "sixteen-solutions"
    "twenty-eight-rays"
    "miura-spectrum"
    "frequencies-scale"
    "frequencies-zeros"
    "torus-self-stresses"
    "screw-modes"
    "tube-motions"
    "tube-rigid"
    "helical-miura-folds"
    "helical-miura-rigid"
    "strip-rates"
    "strip-count"
    "interface-modes"
    "landscape-coefficients"
    "landscape-exponents"
    "landscape-fits"
    "landscape-cylinder"
    "landscape-cone"
    "eggbox-curvature"
    "wave-fixed"
    "wave-free"
    "tolerance-finest"
    "tolerance-is-kept"
    "stiffness-residuals"
    "stiffness-iterations"
    "stiffness-penalty-fails"
    "stiffness-rigid-limit"
    "stiffness-one-over-k"
    "rigid-limit-distance"
    "rigid-limit-farthest"
    "rigid-limit-energy"
    "rigid-limit-bars"
    "steps-order"
    "steps-default"
    "sizes-exact"
    "sizes-growth"
    "sizes-intrinsic"
    "extremes-nothing-wrong"
    "extremes-mostly-right"
    "cells-closed-form"
    "cells-residuals"
    "response-miura"
    "response-opposite"
);

/// Files of `meshes` that claims need.
const MESHES: &[(&str, &str)] = files!("meshes", "":
    "eggbox-dome.csv"
    "eggbox-landscape.toml"
    "eggbox-twist.csv"
    "eggbox.fold"
    "flat-branches.toml"
    "helical-miura.fold"
    "helical-miura.toml"
    "kirigami-interface.toml"
    "kirigami-polarized.fold"
    "kirigami-reversed.fold"
    "miura-response.toml"
    "miura-spectrum.toml"
    "open-flat.fold"
    "open-star.fold"
    "star-engines.toml"
    "star-landscape.toml"
    "star-map.toml"
    "star-screw.toml"
    "star-strip.toml"
    "star-tube.toml"
    "star-torus-fixed.toml"
    "star-trace.toml"
    "star-wave-fixed.toml"
    "star-wave-free.toml"
    "star-wave.fold"
);

/// Returns all claims.
///
/// # Errors
/// [`ClaimError`] of the first file that is not a valid claim.
pub(crate) fn claims() -> Result<Vec<Claim>, ClaimError> {
    CLAIMS.iter().map(|(name, text)| Claim::parse(name, text)).collect()
}

/// Returns names and texts of the scenes and meshes.
pub(crate) fn meshes() -> &'static [(&'static str, &'static str)] {
    MESHES
}

/// Returns the text of a mesh or scene; `None` if there is none of this name.
pub(crate) fn mesh(name: &str) -> Option<&'static str> {
    MESHES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

#[cfg(test)]
mod tests {
    use super::super::claim::Experiment;
    use super::super::measure;
    use super::*;

    /// Claim: every file of the folder is embedded, each claim is valid, and the scene or measurement that it names
    /// exists.
    #[test]
    fn every_file_is_a_claim() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/claims");
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
            .collect();
        let mut known: Vec<String> = CLAIMS.iter().map(|(name, _)| (*name).to_owned()).collect();
        files.sort();
        known.sort();
        assert_eq!(files, known);
        for claim in claims().unwrap() {
            match &claim.experiment {
                Experiment::Scene(scene) => assert!(mesh(scene).is_some(), "{}: {scene}", claim.name),
                Experiment::Measurement(name) => assert!(measure::find(name).is_some(), "{}: {name}", claim.name),
            }
        }
    }
}
