//! The files that a study writes, by its name and kind: the only list of the files that belong to a study.
//!
//! Names are relative to the folder of the run, with `/` between folder and file; `#` is a number of four or more
//! digits.

use super::spec::{StudyKind, StudySpec};

/// Names of the files that a study of any kind may write; `@` is the name of the study.
const ANY: [&str; 7] = ["@.csv", "@.svg", "@.html", "@.pvd", "@-paraview.py", "@.state.json", "@/@_#.vtu"];
const TRACE: &[&str] = &["@-strain.svg", "@-closed-tubes.csv"];
const SURFACE: &[&str] = &["@/@_#.vtp"];
const MAP: &[&str] = &["@-map.csv", "@-map.svg", "@/@_map.vtp", "@.map.jsonl"];
const BLOCH: &[&str] = &["@/@_determinant.vti", "@/@_zero_lines.vtp", "@/@_mode_#.vtu"];
const BANDS: &[&str] = &["@_bands.csv", "@-bands.svg", "@-density.csv", "@-strip.csv", "@-modes.csv"];
const MODES: &[&str] = &[
    "@-frequencies.csv",
    "@-vibrations.pvd",
    "@/@_vibration_#.vtu",
    "@-buckling.csv",
    "@-buckling.svg",
    "@-buckling.pvd",
    "@/@_buckling_#.vtu",
];
const WELLS: &[&str] = &["@-barriers.csv"];
const RESPONSE: &[&str] = &["@-ratios.csv", "@-ratios.svg", "@-stresses.csv"];
const PATH: &[&str] = &["@-reaction.svg", "@.path.jsonl"];

/// Returns the files that a study with these settings can write.
pub(crate) fn outputs(study: &StudySpec) -> Vec<String> {
    let own: [&[&str]; 2] = match &*study.kind {
        StudyKind::Trace(_) => [TRACE, &[]],
        StudyKind::Surface(_) => [SURFACE, &[]],
        StudyKind::Landscape(spec) if spec.map.is_some() => [MAP, &[]],
        StudyKind::Bloch(_) => [BLOCH, BANDS],
        StudyKind::Wells(_) => [WELLS, &[]],
        StudyKind::Path(_) | StudyKind::Fold(_) => [PATH, &[]],
        StudyKind::Response(_) => [RESPONSE, &[]],
        StudyKind::Modes(_) => [MODES, &[]],
        StudyKind::Relax(_) | StudyKind::Branches(_) | StudyKind::Landscape(_) => [&[], &[]],
    };
    named(&study.name.0, ANY.iter().chain(own[0]).chain(own[1]))
}

/// Returns the files that a study of this name can have written, whatever its kind was.
pub(crate) fn owned(name: &str) -> Vec<String> {
    let others = [TRACE, SURFACE, MODES, MAP, BLOCH, BANDS, WELLS, RESPONSE, PATH].into_iter().flatten();
    named(name, ANY.iter().chain(others))
}

fn named<'a>(name: &str, files: impl Iterator<Item = &'a &'a str>) -> Vec<String> {
    files.map(|file| file.replace('@', name)).collect()
}

/// Whether a file is in a list, with a number instead of `#`.
pub(crate) fn is_one_of(files: &[String], file: &str) -> bool {
    files.iter().any(|listed| match listed.split_once('#') {
        None => listed == file,
        Some((start, end)) => {
            let number = file.strip_prefix(start).and_then(|rest| rest.strip_suffix(end));
            number.is_some_and(|number| number.len() >= 4 && number.bytes().all(|byte| byte.is_ascii_digit()))
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: only numbers match `#`; the files that a study writes are always among those that belong to its name.
    #[test]
    fn names_are_told_apart() {
        let own = owned("a");
        for file in
            ["a.csv", "a/a_0000.vtu", "a/a_12345.vtp", "a-map.csv", "a/a_mode_0001.vtu", "a/a_buckling_0000.vtu"]
        {
            assert!(is_one_of(&own, file), "{file}");
        }
        for file in ["b.csv", "a/a_1.vtu", "a/a_x000.vtu", "a/b_0000.vtu", "a.toml", "a/a_.vtu", "summary.json"] {
            assert!(!is_one_of(&own, file), "{file}");
        }
        let scene = "[sheet]\nmesh = \"m.fold\"\n[[study]]\nname = \"a\"\nkind = \"trace\"\n";
        let file = super::super::parse(scene, "s.toml").unwrap();
        let written = outputs(&file.scene.studies[0]);
        assert!(written.contains(&"a-strain.svg".to_owned()) && written.iter().all(|file| own.contains(file)));
    }
}
