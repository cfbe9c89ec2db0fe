//! A digest of the input of a run: of the scene and the files that it names.

use std::fmt;
use std::path::PathBuf;

use super::forms::{Mode, StartSpec};
use super::rest::RestSpec;
use super::spec::{BarsSpec, CreasesSpec, StudyKind, SweepValues};
use super::stiffness::{RestLengthSpec, StiffnessSpec};
use super::{Located, SceneError, SceneFile};
use crate::sheet::text::read_bytes;

/// Returns sixteen hexadecimal digits that change with the version of this program, the text of the scene and the bytes
/// of every file that the scene names: the mesh, tables of angles and rates, states to start from; and with arrays in
/// their place.
///
/// The digest detects edited input, by the 64-bit hash FNV-1a; it does not protect against forgery.
pub(crate) fn digest(file: &SceneFile) -> Result<String, SceneError> {
    let mut hash = Fingerprint::default();
    hash.add(env!("CARGO_PKG_VERSION").as_bytes());
    hash.add(file.text().as_bytes());
    for path in named_files(file) {
        hash.add(&read_bytes(&path).map_err(|source| SceneError::Read { path, source })?);
    }
    for (name, array) in file.arrays().iter() {
        hash.add(name.as_os_str().as_encoded_bytes());
        hash.add(&array.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<_>>());
    }
    Ok(hash.to_string())
}

/// The 64-bit hash FNV-1a, written as sixteen hexadecimal digits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fingerprint {
    /// Adds bytes to the hash, preceded by their number, so that moving bytes from one file to the next changes it.
    pub(crate) fn add(&mut self, bytes: &[u8]) {
        for &byte in (bytes.len() as u64).to_le_bytes().iter().chain(bytes) {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

/// Returns the files that a scene names, in the order in which it names them.
pub(crate) fn named_files(file: &SceneFile) -> Vec<PathBuf> {
    let scene = &file.scene;
    let rates = |mode: &Mode| match mode {
        Mode::Rates(name) => Some(name.rates.to_path_buf()),
        Mode::Curvature(_) | Mode::Wave(_) => None,
    };
    let mut found: Vec<PathBuf> = scene.sheet.mesh.iter().map(|mesh| mesh.to_path_buf()).collect();
    let hinges = |spec: &CreasesSpec| {
        let angles = match spec.rest.as_deref() {
            Some(RestSpec::File(name)) => Some(name.file.to_path_buf()),
            Some(RestSpec::Mode(mode)) => rates(&mode.mode),
            _ => None,
        };
        [stiffness_table(&spec.stiffness), angles]
    };
    let bars = scene.energy.bars.iter();
    found.extend(bars.flat_map(|spec| [stiffness_table(&spec.stiffness), length_table(spec)]).flatten());
    found.extend(scene.energy.hinges().into_iter().flatten().flat_map(hinges).flatten());
    found.extend(scene.energy.law_tables().map(|table| table.file.to_path_buf()));
    found.extend(scene.energy.curves().into_iter().filter_map(|curve| curve.file.clone()));
    for study in &scene.studies {
        if let Some(StartSpec::File(path)) = study.kind.start().map(|start| &**start) {
            found.push(path.clone());
        }
        if let StudyKind::Bloch(spec) = &*study.kind {
            found.extend(spec.strip.iter().filter_map(|strip| strip.other.clone()));
        }
        if let StudyKind::Landscape(spec) = &*study.kind {
            found.extend(spec.modes.iter().filter_map(|mode| rates(mode)));
        }
    }
    let axes = scene.sweep.iter().flat_map(|sweep| &sweep.axes);
    found.extend(
        axes.filter_map(|axis| if let SweepValues::File(path) = &*axis.values { Some(path.clone()) } else { None }),
    );
    found.into_iter().filter(|path| file.array(path).is_none()).map(|path| file.resolve(&path)).collect()
}

fn stiffness_table(spec: &Option<Located<StiffnessSpec>>) -> Option<PathBuf> {
    if let Some(StiffnessSpec::File(name)) = spec.as_deref() { Some(name.file.to_path_buf()) } else { None }
}

fn length_table(bars: &BarsSpec) -> Option<PathBuf> {
    if let Some(RestLengthSpec::File(name)) = bars.rest.as_deref() { Some(name.file.to_path_buf()) } else { None }
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::*;
    use std::fs;

    /// Claim: the digest changes with every additional letter in the scene and every changed byte in a file that the
    /// scene names, and with nothing else.
    #[test]
    fn every_byte_counts() {
        let folder = tempfile::tempdir().unwrap();
        let text = "[sheet]\nmesh = \"a.fold\"\n[energy]\ncreases = { stiffness = 1, rest = { file = \"b.csv\" } }\n";
        let digest_of = |text: &str, mesh: &str, angles: &str| {
            fs::write(folder.path().join("a.fold"), mesh).unwrap();
            fs::write(folder.path().join("b.csv"), angles).unwrap();
            digest(&parse(text, folder.path().join("s.toml")).unwrap()).unwrap()
        };
        let first = digest_of(text, "mesh", "angles");
        assert_eq!(first, digest_of(text, "mesh", "angles"));
        let others = [
            digest_of(&format!("{text}#"), "mesh", "angles"),
            digest_of(text, "mesH", "angles"),
            digest_of(text, "mesh", "angle"),
            digest_of(text, "mesha", "ngles"),
        ];
        assert!(others.iter().all(|other| *other != first), "{first} {others:?}");
        fs::remove_file(folder.path().join("b.csv")).unwrap();
        let missing = digest(&parse(text, folder.path().join("s.toml")).unwrap()).unwrap_err();
        assert!(missing.to_string().contains("b.csv"), "{missing}");
    }

    /// Claim: the files that a scene names are found in every place in which it can name one.
    #[test]
    fn all_tables_are_named() {
        let text = "[sheet]\nmesh = \"a.fold\"\n[energy]\n\
                    bars = { stiffness = { file = \"b.csv\" }, rest = { file = \"c.csv\" }, \
                    law = { kind = \"table\", file = \"h.csv\" } }\n\
                    creases = { stiffness = { file = \"d.csv\" }, rest = { mode = { rates = \"e.csv\" }, amplitude = 1 } }\n\
                    facets = { stiffness = { file = \"f.csv\" }, rest = { file = \"g.csv\" }, \
                    law = { kind = \"table\", file = \"i.csv\" } }\n";
        let found = named_files(&parse(text, "s.toml").unwrap());
        let expected =
            ["a.fold", "b.csv", "c.csv", "d.csv", "e.csv", "f.csv", "g.csv", "h.csv", "i.csv"].map(PathBuf::from);
        assert_eq!(found, expected);
    }
}
