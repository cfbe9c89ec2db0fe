//! Files of runs that are killed: whole, or not there; and a resumed run ends as an undisturbed one does.

use super::super::experiment::{Bench, ExperimentError, Findings};
use super::super::library;
use crate::output::{OutputError, files};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Instant;

/// Runs that are killed.
const QUICK: usize = 12;
const LONG: usize = 100;
/// A scene of several studies, each with files of all kinds, half a second in all.
const SCENE: &str = "[sheet]\nmesh = \"open-star.fold\"\ndomain = \"screw\"\ncells = [8, 4]\n[energy]\n\
    bars = { stiffness = 1e8 }\ncreases = { stiffness = 1.0 }\n[[lock]]\ncrease = [0, 1, 0, 0]\n\
    [[study]]\nname = \"first\"\nkind = \"trace\"\n[[study]]\nname = \"both\"\nkind = \"trace\"\nengine = \"both\"\n\
    [[study]]\nname = \"last\"\nkind = \"relax\"\n";

/// Every file below a folder.
type Files = BTreeMap<PathBuf, Vec<u8>>;

/// Kills a run at random moments (SIGKILL, which nobody can handle), looks at every file it left, resumes it, and compares with an
/// undisturbed run byte by byte; `seconds` in the summary, which no two runs share, is left out. Then two runs go into one folder
/// at once.
pub fn measure(bench: &Bench) -> Result<Findings, ExperimentError> {
    let folder = &bench.folder;
    files::write(&folder.join("open-star.fold"), library::mesh("open-star.fold").unwrap_or_default())?;
    files::write(&folder.join("scene.toml"), SCENE)?;
    let clock = Instant::now();
    finish(start(folder, "undisturbed", false)?)?;
    let whole = clock.elapsed();
    let expected = read(&folder.join("undisturbed"))?;
    let mut numbers = ChaCha8Rng::seed_from_u64(5);
    let count = if bench.quick { QUICK } else { LONG };
    let (mut broken, mut different, mut unfinished) = (0, 0, 0);
    for round in 0..count {
        bench.step(round, count)?;
        let out = format!("killed-{round}");
        let _ = std::fs::remove_dir_all(folder.join(&out));
        let mut child = start(folder, &out, false)?;
        sleep(whole.mul_f64(numbers.random::<f64>()));
        child.kill().and_then(|()| child.wait()).map_err(|error| failed(&error.to_string()))?;
        let left = read(&folder.join(&out))?;
        unfinished += usize::from(left.len() < expected.len());
        broken += left.iter().filter(|(path, bytes)| !whole_file(path, bytes, &expected)).count();
        finish(start(folder, &out, true)?)?;
        different += usize::from(!same(&read(&folder.join(&out))?, &expected));
        let _ = std::fs::remove_dir_all(folder.join(&out));
    }
    let both = [start(folder, "shared", false)?, start(folder, "shared", false)?];
    both.into_iter().try_for_each(finish)?;
    let shared = usize::from(!same(&read(&folder.join("shared"))?, &expected));
    let values = json!({
        "killed": count,
        "killed in the middle": unfinished,
        "broken files": broken,
        "different after resuming": different,
        "different after two at once": shared,
    });
    Ok(Findings { values, ..Findings::default() })
}

fn failed(message: &str) -> ExperimentError {
    ExperimentError::Child { words: "run scene.toml".into(), message: message.into() }
}

fn start(folder: &Path, out: &str, resume: bool) -> Result<Child, ExperimentError> {
    let program = std::env::current_exe().map_err(|error| failed(&error.to_string()))?;
    let mut command = Command::new(program);
    command.current_dir(folder).args(["run", "scene.toml", "--quiet", "--out", out]).stdout(Stdio::null());
    if resume {
        command.arg("--resume");
    }
    command.spawn().map_err(|error| failed(&error.to_string()))
}

fn finish(mut child: Child) -> Result<(), ExperimentError> {
    let status = child.wait().map_err(|error| failed(&error.to_string()))?;
    if status.success() { Ok(()) } else { Err(failed(&status.to_string())) }
}

/// All files below a folder, those on their way left out; none where there is no folder yet.
fn read(root: &Path) -> Result<Files, ExperimentError> {
    let (mut found, mut folders) = (Files::new(), vec![root.to_path_buf()]);
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
            let name = path.strip_prefix(root).unwrap_or(&path).to_path_buf();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_none_or(|ending| ending != "part") {
                let bytes = std::fs::read(&path).map_err(|source| OutputError::Read { path, source })?;
                found.insert(name, bytes);
            }
        }
    }
    Ok(found)
}

/// Whether a file is what the undisturbed run has; a summary need only be whole, since it grows with the studies.
fn whole_file(path: &Path, bytes: &[u8], expected: &Files) -> bool {
    match path.extension() {
        Some(ending) if ending == "json" => serde_json::from_slice::<Value>(bytes).is_ok(),
        _ => expected.get(path).is_some_and(|expected| expected == bytes),
    }
}

fn same(found: &Files, expected: &Files) -> bool {
    let equal = |(path, bytes): (&PathBuf, &Vec<u8>)| {
        let there = &expected[path];
        if path.ends_with("summary.json") { timeless(bytes) == timeless(there) } else { bytes == there }
    };
    found.keys().eq(expected.keys()) && found.iter().all(equal)
}

/// A summary without its times.
fn timeless(bytes: &[u8]) -> Option<Value> {
    let mut summary: Value = serde_json::from_slice(bytes).ok()?;
    for study in summary["studies"].as_array_mut()? {
        study["seconds"].take();
    }
    Some(summary)
}
