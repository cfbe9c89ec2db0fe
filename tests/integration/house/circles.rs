//! No cyclic imports: if one file imports from another, no chain of imports leads back.
//!
//! A file imports from another one if one of its `use` items, or a path in the code (`crate::..`, `super::..`,
//! `self::..`, or one that begins with a module of its own), leads to it. Re-exports are followed to the file of the
//! item, so that a file with only re-exports connects nothing. `mod x;` is not an import, and test modules do not
//! count.

use crate::house::floors::{root, sources, words};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The path of a module; modules of the program are below `main`.
type Module = Vec<String>;

/// Modules that belong to the program, not to the library.
const OF_THE_PROGRAM: &[&str] = &["cli", "describe", "parameters", "progress"];
/// Length of the longest chain of re-exports.
const LONGEST_CHAIN: usize = 6;

/// The imports of a module: paths from the root, and the names under which some of them are known in it.
#[derive(Default)]
struct Imports {
    paths: Vec<Module>,
    names: BTreeMap<String, Module>,
}

/// Returns the module of a source file; `None` for tests.
fn module(path: &Path) -> Option<Module> {
    let parts = path.with_extension("");
    let mut names: Module = parts.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if names.iter().any(|name| name.contains("test")) {
        return None;
    }
    if ["mod", "lib", "main"].contains(&names.last()?.as_str()) {
        let last = names.pop()?;
        return Some(if last == "main" { vec![last] } else { with_crate(names) });
    }
    Some(with_crate(names))
}

/// Returns the path from the root of the library, or below `main` if it begins with a module of the program.
fn with_crate(mut names: Module) -> Module {
    if names.first().is_some_and(|first| OF_THE_PROGRAM.contains(&first.as_str())) {
        names.insert(0, "main".into());
    }
    names
}

/// Returns the words before the first module that is compiled for tests only.
pub(super) fn without_tests(words: &[String]) -> &[String] {
    let is = |at: usize, expected: &[&str]| {
        expected.iter().enumerate().all(|(k, e)| words.get(at + k).is_some_and(|w| w == e))
    };
    let module = |at: usize| (7..12).any(|k| is(at + k, &["mod"]) && is(at + k + 2, &["{"]));
    let end = (0..words.len()).find(|&at| is(at, &["#", "[", "cfg", "(", "test", ")", "]"]) && module(at));
    &words[..end.unwrap_or(words.len())]
}

/// Reads the tree of a `use` item from `at`; returns its end.
fn tree(words: &[String], mut at: usize, prefix: &[String], found: &mut Vec<(Module, Option<String>)>) -> usize {
    let mut path = prefix.to_vec();
    loop {
        match words[at].as_str() {
            "{" => {
                at += 1;
                while words[at] != "}" {
                    at = tree(words, at, &path, found);
                    at += usize::from(words[at] == ",");
                }
                return at + 1;
            }
            "*" => {
                found.push((path, None));
                return at + 1;
            }
            name => path.push(name.to_owned()),
        }
        at += 1;
        if words[at] == "::" {
            at += 1;
            continue;
        }
        if path.last().is_some_and(|last| last == "self") && path.len() > 1 {
            path.pop();
        }
        let renamed = words[at] == "as";
        let name = if renamed { words.get(at + 1) } else { path.last() }.cloned();
        found.push((path, name));
        return if renamed { at + 2 } else { at };
    }
}

/// Returns the path from the root for a path in a module; `None` if it leads out of the sources.
fn from_root(from: &Module, path: &[String], modules: &BTreeSet<Module>) -> Option<Module> {
    let of_program = from.first().is_some_and(|first| first == "main");
    match path[0].as_str() {
        "crate" if of_program => Some([&["main".to_owned()], &path[1..]].concat()),
        "crate" | "foldwell" => Some(path[1..].to_vec()),
        "self" => Some([from, &path[1..]].concat()),
        "super" => {
            let up = path.iter().take_while(|name| *name == "super").count();
            Some([&from[..from.len().checked_sub(up)?], &path[up..]].concat())
        }
        first => {
            let own = [from, &[first.to_owned()][..]].concat();
            modules.contains(&own).then(|| [from, path].concat())
        }
    }
}

fn imports(from: &Module, words: &[String], modules: &BTreeSet<Module>) -> Imports {
    let (mut found, mut at) = (Imports::default(), 0);
    let begins = |word: &str| ["crate", "super", "self", "foldwell"].contains(&word);
    while at < words.len() {
        if words[at] == "use" {
            let mut items = Vec::new();
            at = tree(words, at + 1, &[], &mut items);
            for (path, name) in items {
                if let Some(path) = from_root(from, &path, modules) {
                    found.names.extend(name.map(|name| (name, path.clone())));
                    found.paths.push(path);
                }
            }
        } else if begins(&words[at]) && words.get(at + 1).is_some_and(|next| next == "::") && words[at - 1] != "::" {
            let mut path = vec![words[at].clone()];
            while words.get(at + 1).is_some_and(|next| next == "::") && words.get(at + 2).is_some() {
                path.push(words[at + 2].clone());
                at += 2;
            }
            found.paths.extend(from_root(from, &path, modules));
        } else {
            at += 1;
        }
    }
    found
}

/// Returns the module that contains the item of a path.
fn home(path: &[String], all: &BTreeMap<Module, Imports>, chain: usize) -> Module {
    let length = (0..=path.len()).rev().find(|&k| all.contains_key(&path[..k])).unwrap_or(0);
    let (module, rest) = path.split_at(length);
    let through = rest.first().and_then(|name| all.get(module)?.names.get(name));
    match through {
        Some(other) if chain < LONGEST_CHAIN => home(&[other, &rest[1..]].concat(), all, chain + 1),
        _ => module.to_vec(),
    }
}

/// Returns, for every module, the modules from which it imports.
fn graph(folder: &Path) -> BTreeMap<Module, BTreeSet<Module>> {
    let files = sources(folder).into_iter().filter_map(|path| Some((module(&path)?, path)));
    let texts: BTreeMap<Module, Vec<String>> =
        files.map(|(module, path)| (module, words(&fs::read_to_string(folder.join(path)).unwrap()))).collect();
    let modules: BTreeSet<Module> = texts.keys().cloned().collect();
    let all: BTreeMap<Module, Imports> =
        texts.iter().map(|(from, words)| (from.clone(), imports(from, without_tests(words), &modules))).collect();
    let targets = |from: &Module, imports: &Imports| {
        let homes = imports.paths.iter().map(|path| home(path, &all, 0));
        homes.filter(|home| home != from && !home.is_empty()).collect()
    };
    all.iter().map(|(from, imports)| (from.clone(), targets(from, imports))).collect()
}

/// Returns the modules that can be reached from a module.
fn reachable(graph: &BTreeMap<Module, BTreeSet<Module>>, from: &Module) -> BTreeSet<Module> {
    let (mut seen, mut next) = (BTreeSet::new(), vec![from]);
    while let Some(module) = next.pop() {
        next.extend(graph.get(module).into_iter().flatten().filter(|target| seen.insert((*target).clone())));
    }
    seen
}

/// Returns the cycles: groups of modules in which each can be reached from the others.
fn circles(folder: &Path) -> BTreeSet<Vec<String>> {
    let graph = graph(folder);
    let reach: BTreeMap<_, _> = graph.keys().map(|module| (module, reachable(&graph, module))).collect();
    let round = |module: &Module| -> Vec<String> {
        let others = reach[module].iter().filter(|other| reach.get(other).is_some_and(|back| back.contains(module)));
        others.map(|other| other.join("::")).collect()
    };
    reach.keys().map(|module| round(module)).filter(|group| !group.is_empty()).collect()
}

/// Claim: no file of the crates or the program is part of a cycle.
#[test]
fn no_circle_of_files() {
    for (folder, files) in [("src", 200), ("crates/numerics/src", 30), ("crates/solver/src", 30)] {
        let graph = graph(&root().join(folder));
        let imports: usize = graph.values().map(BTreeSet::len).sum();
        assert!(graph.len() > files && imports > graph.len(), "the sources of {folder} are there");
        assert_eq!(circles(&root().join(folder)), BTreeSet::new(), "{folder}");
    }
}

/// Claim: this test finds cycles. One at a time is planted in a small tree of sources, each in another notation;
/// exactly that one is found, and none in sources that only look similar.
#[test]
fn planted_circles_are_found() {
    let base = [
        ("lib.rs", "pub mod a; pub mod b;"),
        ("a/mod.rs", "mod x; mod y; pub use x::X; pub use y::Y;"),
        ("a/x.rs", "use super::y::Y; pub struct X;"),
        ("a/y.rs", "pub struct Y;"),
        ("b.rs", "use crate::a::X; pub struct B;"),
    ];
    let plants: [(&str, &str, &[&[&str]]); 9] = [
        ("a/y.rs", "use super::x::X;", &[&["a::x", "a::y"]]),
        ("a/y.rs", "use super::X;", &[&["a::x", "a::y"]]),
        ("a/y.rs", "use crate::{a::{self, X as Other}};", &[&["a", "a::x", "a::y"]]),
        ("a/y.rs", "fn f(_: &crate::a::x::X) {}", &[&["a::x", "a::y"]]),
        ("a/y.rs", "use super::super::b::B;", &[&["a::x", "a::y", "b"]]),
        ("a/x.rs", "use foldwell::b;", &[&["a::x", "b"]]),
        ("a/y.rs", "// use super::x::X;\nconst S: &str = \"use super::x::X;\";", &[]),
        ("a/y.rs", "#[cfg(test)]\nmod tests { use super::super::x::X; }", &[]),
        ("b.rs", "use crate::a::Y;", &[]),
    ];
    for (file, text, expected) in plants {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("a")).unwrap();
        for (path, source) in base {
            let planted = if path == file { text } else { "" };
            fs::write(folder.path().join(path), format!("{source}\n{planted}\n")).unwrap();
        }
        let expected = expected.iter().map(|group| group.iter().map(|name| (*name).to_owned()).collect()).collect();
        assert_eq!(circles(folder.path()), expected, "{text}");
    }
}
