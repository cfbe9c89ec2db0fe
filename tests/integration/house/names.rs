//! A name has one meaning in the whole tree: no two types of the library, its crates and the program share one.
//!
//! Who reads `Frame` or `Step` need not ask which of several is meant, and a search for a name finds one type. Structs,
//! enums and traits count, whoever sees them and however deep they are; types of test modules do not.

use crate::house::circles::without_tests;
use crate::house::floors::{root, sources, words};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Folders with sources.
const FOLDERS: &[&str] = &["src", "crates"];
/// Names that every study may give to a type of its own, below [`STUDIES`].
const OF_EVERY_STUDY: &[&str] = &["Options", "Answer"];
/// The folder of the studies.
const STUDIES: &str = "src/study/";

/// Returns the names of the types that a source defines outside of test modules.
fn types(words: &[String]) -> Vec<String> {
    let is_definition = |word: &String| matches!(word.as_str(), "struct" | "enum" | "trait");
    let pairs = without_tests(words).windows(2).filter(|pair| is_definition(&pair[0]));
    pairs.map(|pair| pair[1].clone()).filter(|name| name.starts_with(char::is_uppercase)).collect()
}

/// Returns the types of all sources below `root`: their names, each with the files that define it.
fn homes(root: &Path) -> BTreeMap<String, Vec<String>> {
    let mut homes: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for folder in FOLDERS {
        for path in sources(&root.join(folder)) {
            let file = format!("{folder}/{}", path.to_string_lossy().replace('\\', "/"));
            if file.contains("test") {
                continue;
            }
            for name in types(&words(&fs::read_to_string(root.join(&file)).unwrap())) {
                if !(file.starts_with(STUDIES) && OF_EVERY_STUDY.contains(&name.as_str())) {
                    homes.entry(name).or_default().push(file.clone());
                }
            }
        }
    }
    homes
}

/// Returns the names with more than one meaning: each with the files of its types.
fn doubles(root: &Path) -> BTreeMap<String, Vec<String>> {
    homes(root).into_iter().filter(|(_, files)| files.len() > 1).collect()
}

/// Claim: a name of a type has one meaning in the whole tree, since a reader who knows it from one file takes it for the
/// same in the next.
#[test]
fn every_type_has_a_name_of_its_own() {
    assert!(homes(root()).len() > 500, "the sources are there");
    let found = doubles(root());
    assert!(found.is_empty(), "{found:#?}");
}

/// Claim: this test finds names with two meanings. One at a time is planted in a small tree of sources, each in another
/// notation; exactly that one is found, and none in sources that only look similar.
#[test]
fn planted_doubles_are_found() {
    let base = [("src/a.rs", "pub struct Line;"), ("src/study/b.rs", "struct Options;"), ("crates/c/src/lib.rs", "")];
    let plants: [(&str, &str, &[&str]); 12] = [
        ("src/a.rs", "mod inner { struct Line; }", &["src/a.rs", "src/a.rs"]),
        ("src/d.rs", "pub(crate) struct Line<'a>(&'a str);", &["src/a.rs", "src/d.rs"]),
        ("src/d.rs", "pub(in crate::d) enum Line {}", &["src/a.rs", "src/d.rs"]),
        ("src/d.rs", "fn f() { struct Line; }", &["src/a.rs", "src/d.rs"]),
        ("crates/c/src/lib.rs", "pub unsafe trait Line {}", &["src/a.rs", "crates/c/src/lib.rs"]),
        ("src/d.rs", "struct Options;", &[]),
        ("src/study/d.rs", "pub struct Options;", &[]),
        ("src/d/tests.rs", "struct Line;", &[]),
        ("crates/c/tests/d.rs", "struct Line;", &[]),
        ("src/d.rs", "#[cfg(test)]\nmod tests { struct Line; }", &[]),
        ("src/d.rs", "// struct Line;\nconst S: &str = \"struct Line;\";", &[]),
        ("src/d.rs", "use crate::a::Line; enum Kind { Line(Line) } struct Lines;", &[]),
    ];
    for (file, text, expected) in plants {
        let folder = tempfile::tempdir().unwrap();
        for (path, source) in base.into_iter().chain([(file, text)]) {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            let kept = fs::read_to_string(&path).unwrap_or_default();
            fs::write(path, format!("{kept}\n{source}\n")).unwrap();
        }
        let found: Vec<_> = doubles(folder.path()).into_values().flatten().collect();
        assert_eq!(found, expected, "{text}");
    }
}
