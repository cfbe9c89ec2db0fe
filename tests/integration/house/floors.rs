//! The layers of the library: a module imports only from lower layers, and modules of one layer do not import from each
//! other.
//!
//! The sources are read as words, so that comments and strings do not count and every notation of a path is found: `use
//! crate::a::b`, `use crate::{a, b}`, an inline `crate::a::b`, `super::super::a`, `foldwell::a` in the binary.

use std::fs;
use std::path::{Path, PathBuf};

/// Modules and their layers; two modules of one layer do not import from each other.
const FLOORS: &[(&str, u8)] = &[
    ("math", 0),
    ("numerics", 0),
    ("sheet", 1),
    ("solver", 1),
    ("model", 2),
    ("kinematics", 2),
    ("analysis", 3),
    ("scene", 4),
    ("output", 4),
    ("study", 5),
    ("run", 6),
    ("parameters", 7),
    ("describe", 7),
    ("progress", 7),
    ("cli", 8),
    ("main", 9),
];

/// Crates that are used in one place only, and that place: a prefix of the path under `src`.
const OWNED: &[(&str, &[&str])] = &[
    ("faer", &[]),
    ("parry3d_f64", &["analysis/intersections/"]),
    ("robust", &["analysis/intersections/contact.rs", "sheet/pattern/arrangement.rs"]),
    ("roxmltree", &["sheet/pattern/"]),
    ("simplecss", &["sheet/pattern/svg_style.rs"]),
    ("svgtypes", &["sheet/pattern/svg"]),
    ("vtkio", &["output/vtk.rs", "output/vtk/"]),
    ("base64", &["output/html/", "output/vtk/appended.rs"]),
    ("kurbo", &["sheet/pattern/"]),
    ("tiny_skia", &["output/film.rs"]),
    ("gif", &["output/film.rs"]),
    ("clap", &["cli.rs", "parameters.rs"]),
    ("clap_complete", &["cli.rs"]),
];

/// Decompositions that nalgebra offers as methods and as types. They are called through `numerics::dense`, which
/// chooses the library.
const DECOMPOSITIONS: &[&str] = &[
    "svd",
    "lu",
    "full_piv_lu",
    "qr",
    "col_piv_qr",
    "cholesky",
    "symmetric_eigen",
    "symmetric_eigenvalues",
    "singular_values",
    "try_inverse",
    "pseudo_inverse",
    "schur",
    "hessenberg",
    "SVD",
    "LU",
    "FullPivLU",
    "QR",
    "Cholesky",
    "SymmetricEigen",
    "Schur",
];

/// All entries at the root except those that begin with a dot.
const ROOT: &[&str] = &[
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "CITATION.cff",
    "CONTRIBUTING.md",
    "Cargo.lock",
    "Cargo.toml",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "benches",
    "crates",
    "docs",
    "examples",
    "meshes",
    "pyproject.toml",
    "python",
    "src",
    "tests",
    "validation",
];

fn floor(module: &str) -> Option<u8> {
    FLOORS.iter().find(|(name, _)| *name == module).map(|(_, floor)| *floor)
}

/// Returns all `.rs` files below `folder`, as paths relative to it.
pub(crate) fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            match path.extension() {
                _ if path.is_dir() => folders.push(path),
                Some(ending) if ending == "rs" => found.push(path.strip_prefix(folder).unwrap().to_path_buf()),
                _ => {}
            }
        }
    }
    found.sort();
    found
}

/// Returns the names, `::` and other signs of a source, without comments, strings and characters.
pub(crate) fn words(text: &str) -> Vec<String> {
    let letters: Vec<char> = text.chars().collect();
    let starts = |at: usize, what: &str| what.chars().enumerate().all(|(k, c)| letters.get(at + k) == Some(&c));
    let name = |c: char| c.is_alphanumeric() || c == '_';
    let (mut words, mut at) = (Vec::new(), 0);
    while at < letters.len() {
        let rest = &letters[at..];
        let length = if starts(at, "//") {
            rest.iter().position(|c| *c == '\n').unwrap_or(rest.len())
        } else if starts(at, "/*") {
            after(&letters, at, "*/") - at
        } else if starts(at, "r\"")
            || starts(at, "r#") && rest.iter().skip_while(|c| **c != '#').find(|c| **c != '#') == Some(&'"')
        {
            let hashes = rest[1..].iter().take_while(|c| **c == '#').count();
            let end = format!("\"{}", "#".repeat(hashes));
            after(&letters, at + 2 + hashes, &end) - at
        } else if starts(at, "\"") {
            string(rest, '"')
        } else if starts(at, "'") && (rest.get(1) == Some(&'\\') || rest.get(2) == Some(&'\'')) {
            string(rest, '\'')
        } else if name(rest[0]) {
            let length = rest.iter().take_while(|c| name(**c)).count();
            words.push(rest[..length].iter().collect());
            length
        } else {
            let length = if starts(at, "::") { 2 } else { 1 };
            if !rest[0].is_whitespace() {
                words.push(rest[..length].iter().collect());
            }
            length
        };
        at += length;
    }
    words
}

/// Returns the position after the next `end`.
fn after(letters: &[char], from: usize, end: &str) -> usize {
    let end: Vec<char> = end.chars().collect();
    let at = letters[from..].windows(end.len()).position(|window| window == end);
    at.map_or(letters.len(), |at| from + at + end.len())
}

/// Returns the length of a quoted text that starts here.
fn string(letters: &[char], quote: char) -> usize {
    let mut at = 1;
    while at < letters.len() && letters[at] != quote {
        at += if letters[at] == '\\' { 2 } else { 1 };
    }
    (at + 1).min(letters.len())
}

/// Returns the modules under the root of the crate that a source names. `depth` is the number of `super` that lead to
/// the root.
fn named_modules(words: &[String], depth: usize) -> Vec<String> {
    let mut found = Vec::new();
    let word = |at: usize| words.get(at).map(String::as_str);
    for start in 0..words.len() {
        let mut at = start;
        if matches!(word(at), Some("crate" | "foldwell")) && word(at + 1) == Some("::") {
            at += 2;
        } else if word(at) == Some("super") && (start == 0 || word(start - 1) != Some("::")) {
            let mut supers = 0;
            while word(at) == Some("super") && word(at + 1) == Some("::") {
                (supers, at) = (supers + 1, at + 2);
            }
            if supers < depth {
                continue;
            }
        } else {
            continue;
        }
        found.extend(heads(&words[at.min(words.len())..]));
    }
    found
}

/// Returns the first names of the paths that start here: one, or those of a group `{a::b, c}`.
fn heads(words: &[String]) -> Vec<String> {
    if words.first().map(String::as_str) != Some("{") {
        return words.first().cloned().into_iter().collect();
    }
    let (mut found, mut level, mut head) = (Vec::new(), 0, false);
    for word in words {
        match word.as_str() {
            "{" => (level, head) = (level + 1, level == 0),
            "}" if level == 1 => break,
            "}" => level -= 1,
            "," => head = level == 1,
            name if head => {
                found.push(name.to_owned());
                head = false;
            }
            _ => {}
        }
    }
    found
}

/// Returns everything in the sources below `folder` that breaks the rules.
fn violations(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for path in sources(folder) {
        let words = words(&fs::read_to_string(folder.join(&path)).unwrap());
        let name = path.to_string_lossy().replace('\\', "/");
        found.extend(out_of_place(&name, &words));
        let module = name.split('/').next().unwrap_or_default().trim_end_matches(".rs");
        if module == "lib" {
            continue;
        }
        let Some(own) = floor(module) else {
            found.push(format!("{name} stands on no floor"));
            continue;
        };
        // src/a.rs and src/a/mod.rs are one `super` below the root, src/a/b.rs two; inline modules lie deeper
        let depth = path.components().count() - usize::from(name.ends_with("/mod.rs"));
        for other in named_modules(&words, depth) {
            if other != module && floor(&other).is_some_and(|other| other >= own) {
                found.push(format!("{name} sees {other}"));
            }
        }
    }
    found
}

/// Returns the crates that a file names and does not own, and its decompositions.
fn out_of_place(name: &str, words: &[String]) -> Vec<String> {
    let is_elsewhere = |places: &[&str]| !places.iter().any(|place| name.starts_with(place));
    let owned = OWNED.iter().filter(|(owned, places)| is_elsewhere(places) && words.iter().any(|word| word == owned));
    let named = owned.map(|(owned, _)| format!("{name} names {owned}"));
    let decomposed = decompositions(words).map(|word| format!("{name} decomposes by {word}"));
    named.chain(decomposed.filter(|_| !name.contains("tests"))).collect()
}

/// Returns decompositions outside of test modules: methods that are called, `.lu()`, and types that are named. Some
/// functions of `numerics` have such names too, but no dot before them; fields have no parenthesis after them.
fn decompositions(words: &[String]) -> impl Iterator<Item = &str> {
    let word = |at: usize| words.get(at).map_or("", String::as_str);
    let tests = (0..words.len()).find(|&at| (word(at), word(at + 1)) == ("mod", "tests")).unwrap_or(words.len());
    (1..tests).filter_map(move |at| {
        let named = DECOMPOSITIONS.contains(&word(at));
        let method = word(at - 1) == "." && ["(", "::"].contains(&word(at + 1));
        let a_type = word(at).starts_with(char::is_uppercase);
        (named && (method || a_type)).then(|| word(at))
    })
}

pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Claim: no source names a module of the same or a higher layer, nor a crate that belongs elsewhere; every module has
/// a layer.
#[test]
fn modules_see_only_lower_floors() {
    assert!(sources(&root().join("src")).len() > 50, "the sources are there");
    let found = violations(&root().join("src"));
    assert!(found.is_empty(), "{found:#?}");
}

/// Claim: the solver leaves decompositions to the crate of numerics. That it sees no sheet, and no other crate than its
/// own ones, its manifest says.
#[test]
fn the_solver_decomposes_nothing() {
    let folder = root().join("crates/solver/src");
    let files = sources(&folder);
    assert!(files.len() > 30, "the sources are there");
    let found = files.iter().flat_map(|path| {
        out_of_place(&path.to_string_lossy(), &words(&fs::read_to_string(folder.join(path)).unwrap()))
    });
    assert_eq!(found.collect::<Vec<_>>(), [""; 0]);
}

fn copy(from: &Path, to: &Path) {
    for path in sources(from) {
        fs::create_dir_all(to.join(&path).parent().unwrap()).unwrap();
        fs::copy(from.join(&path), to.join(&path)).unwrap();
    }
}

/// Claim: this test finds violations. One violation at a time is planted in a copy of the sources, each in another
/// notation; exactly that one is found, and none in sources that only look similar.
#[test]
fn planted_violations_are_found() {
    let plants = [
        ("math/sinc.rs", "use crate::model::Model;", "math/sinc.rs sees model"),
        ("model/gauge.rs", "use crate::kinematics::closure;", "model/gauge.rs sees kinematics"),
        ("kinematics/closure.rs", "use crate::{math::Vec3, model::{Model, term}};", "kinematics/closure.rs sees model"),
        ("model/measure.rs", "fn f() { let x = crate::analysis::state::f(); }", "model/measure.rs sees analysis"),
        ("model/roll.rs", "fn f(m: DMatrix<f64>) { m.lu(); }", "model/roll.rs decomposes by lu"),
        ("sheet/cell.rs", "use nalgebra::{Matrix2, SVD};", "sheet/cell.rs decomposes by SVD"),
        ("scene/build.rs", "use super::super::output;", "scene/build.rs sees output"),
        ("sheet/fold/read.rs", "use super::super::super::{run::RunError};", "sheet/fold/read.rs sees run"),
        ("math/mod.rs", "pub use crate :: numerics :: larger;", "math/mod.rs sees numerics"),
        ("analysis/modes.rs", "use faer::Mat;", "analysis/modes.rs names faer"),
        ("output/plot.rs", "type V = vtkio::Vtk;", "output/plot.rs names vtkio"),
        ("analysis/view.rs", "use parry3d_f64::math::Vector;", "analysis/view.rs names parry3d_f64"),
        ("run.rs", "use clap::Parser;", "run.rs names clap"),
        ("new.rs", "", "new.rs stands on no floor"),
    ];
    let harmless = "// use crate::run;\n/* crate::run */ const A: &str = \"crate::run\"; fn f() { dense::symmetric_eigen(x.singular_values) } const B: char = '\"'; use super::run;";
    let folder = tempfile::tempdir().unwrap();
    copy(&root().join("src"), folder.path());
    let before = violations(folder.path());
    for (file, text, expected) in plants {
        let path = folder.path().join(file);
        let old = fs::read_to_string(&path);
        let kept = old.as_deref().unwrap_or_default();
        fs::write(&path, format!("{kept}\n{text}\n")).unwrap();
        let new: Vec<_> = violations(folder.path()).into_iter().filter(|found| !before.contains(found)).collect();
        assert_eq!(new, [expected], "{text}");
        // `super` of a folder's `mod.rs` is the library itself
        let module = if file.ends_with("mod.rs") { "self" } else { "super" };
        let harmless = harmless.replace("use super", &format!("use {module}"));
        fs::write(&path, format!("{kept}\n{harmless}\n")).unwrap();
        if file != "new.rs" {
            assert_eq!(violations(folder.path()), before, "{file}: {harmless}");
        }
        match old {
            Ok(old) => fs::write(&path, old).unwrap(),
            Err(_) => fs::remove_file(&path).unwrap(),
        }
    }
}

/// Returns the names at the root: those of the repository if there is one, otherwise those of the folder.
fn names_at_root() -> Vec<String> {
    let listed = std::process::Command::new("git").args(["ls-files", "--full-name"]).current_dir(root()).output();
    let first = |path: &str| path.split('/').next().unwrap_or_default().to_owned();
    let mut names: Vec<String> = match listed {
        Ok(output) if output.status.success() && !output.stdout.is_empty() => {
            String::from_utf8_lossy(&output.stdout).lines().map(first).collect()
        }
        _ => {
            let files = fs::read_dir(root()).unwrap().map(|entry| entry.unwrap());
            let files = files.filter(|entry| entry.file_type().unwrap().is_file());
            files.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
        }
    };
    names.sort();
    names.dedup();
    names
}

/// Claim: the root has the expected files, and no others.
#[test]
fn nothing_lies_about_at_the_root() {
    let names = names_at_root();
    let strange: Vec<_> =
        names.iter().filter(|name| !name.starts_with('.') && !ROOT.contains(&name.as_str())).collect();
    assert!(strange.is_empty(), "{strange:?}");
    assert!(names.iter().any(|name| name == "Cargo.toml"), "{names:?}");
}
