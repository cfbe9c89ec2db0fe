//! Files of runs that are killed, or find no room: whole, or not there; and a resumed run ends as an undisturbed one does.

use super::super::experiment::{Bench, ExperimentError, Findings};
use super::super::library;
use foldwell::output::{OutputError, files};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Runs that are killed.
const QUICK: usize = 12;
const LONG: usize = 100;
/// Runs without room.
const CRAMPED: usize = 6;
/// Bytes in the unit of the shell's limit on files.
const BLOCK: usize = 512;
/// Exit status of a run that could not write.
const BROKEN_PLACE: i32 = 3;
/// A scene of several studies, each with files of all kinds, half a second in all.
const SCENE: &str = "[sheet]\nmesh = \"open-star.fold\"\ndomain = \"screw\"\ncells = [8, 4]\n[energy]\n\
    bars = { stiffness = 1e8 }\ncreases = { stiffness = 1.0 }\n[[lock]]\ncrease = [0, 1, 0, 0]\n\
    [[study]]\nname = \"first\"\nkind = \"trace\"\n[[study]]\nname = \"both\"\nkind = \"trace\"\nengine = \"both\"\n\
    [[study]]\nname = \"last\"\nkind = \"relax\"\n";

/// Every file below a folder.
type Files = BTreeMap<PathBuf, Vec<u8>>;

/// What a run that nothing disturbs writes, and how long it takes.
struct Undisturbed<'a> {
    folder: &'a Path,
    files: Files,
    time: Duration,
}

/// How disturbed runs ended.
#[derive(Default)]
struct Ends {
    /// Files that are not whole.
    broken: usize,
    /// Resumed runs that end with other bytes than the undisturbed one.
    different: usize,
    /// Runs that left fewer files than the undisturbed one.
    unfinished: usize,
}

/// Kills a run at random moments (SIGKILL, which nobody can handle), or leaves it no room for its larger files; looks at every
/// file it left, resumes it, and compares with an undisturbed run byte by byte; `seconds` in the summary, which no two runs
/// share, is left out. Then two runs go into one folder at once, and one into places where nothing can be written.
pub fn measure(bench: &Bench) -> Result<Findings, ExperimentError> {
    let folder = &bench.folder;
    files::write(&folder.join("open-star.fold"), library::mesh("open-star.fold").unwrap_or_default())?;
    files::write(&folder.join("scene.toml"), SCENE)?;
    let clock = Instant::now();
    finish(start(folder, "undisturbed", false)?)?;
    let undisturbed = Undisturbed { folder, time: clock.elapsed(), files: read(&folder.join("undisturbed"))? };
    let killed = undisturbed.killed(bench)?;
    let cramped = undisturbed.cramped(bench)?;
    let both = [start(folder, "shared", false)?, start(folder, "shared", false)?];
    both.into_iter().try_for_each(finish)?;
    let shared = usize::from(!same(&read(&folder.join("shared"))?, &undisturbed.files));
    let values = json!({
        "killed in the middle": killed.unfinished,
        "broken files": killed.broken,
        "different after resuming": killed.different,
        "different after two at once": shared,
        "out of room": cramped.unfinished,
        "broken or different without room": cramped.broken + cramped.different,
        "unusable places accepted": unusable_places_accepted(folder)?,
    });
    Ok(Findings { values, ..Findings::default() })
}

impl Undisturbed<'_> {
    fn killed(&self, bench: &Bench) -> Result<Ends, ExperimentError> {
        let mut numbers = ChaCha8Rng::seed_from_u64(5);
        let count = if bench.quick { QUICK } else { LONG };
        let mut ends = Ends::default();
        for round in 0..count {
            bench.step(round, count)?;
            let out = format!("killed-{round}");
            let _ = std::fs::remove_dir_all(self.folder.join(&out));
            let mut child = start(self.folder, &out, false)?;
            sleep(self.time.mul_f64(numbers.random::<f64>()));
            child.kill().and_then(|()| child.wait()).map_err(|error| failed(&error.to_string()))?;
            self.judge(&out, &mut ends)?;
        }
        Ok(ends)
    }

    /// Files may be at most as large as one of those that the undisturbed run writes, less a block: the shell's `ulimit -f`, whose
    /// signal is ignored, so that writing fails as it does on a full disk.
    fn cramped(&self, bench: &Bench) -> Result<Ends, ExperimentError> {
        let mut sizes: Vec<usize> =
            self.files.values().map(|bytes| bytes.len() / BLOCK).filter(|size| *size > 1).collect();
        sizes.sort_unstable();
        sizes.dedup();
        let mut ends = Ends::default();
        let kept: Vec<usize> = sizes.iter().rev().step_by(sizes.len().div_ceil(CRAMPED)).copied().collect();
        for (round, &size) in kept.iter().enumerate() {
            bench.step(round, kept.len())?;
            let out = format!("cramped-{round}");
            let _ = std::fs::remove_dir_all(self.folder.join(&out));
            let program = program()?;
            let script = format!("trap '' XFSZ; ulimit -f {size}; exec \"$0\" run scene.toml --quiet --out {out}");
            let mut shell = Command::new("sh");
            shell.current_dir(self.folder).args(["-c", &script]).arg(program).stderr(Stdio::null());
            let status = shell.status().map_err(|error| failed(&error.to_string()))?;
            ends.different += usize::from(status.code() != Some(BROKEN_PLACE));
            self.judge(&out, &mut ends)?;
        }
        Ok(ends)
    }

    /// Looks at what a disturbed run left, resumes it, looks again, and clears it away.
    fn judge(&self, out: &str, ends: &mut Ends) -> Result<(), ExperimentError> {
        let place = self.folder.join(out);
        let left = read(&place)?;
        ends.unfinished += usize::from(left.len() < self.files.len());
        ends.broken += left.iter().filter(|(path, bytes)| !whole_file(path, bytes, &self.files)).count();
        finish(start(self.folder, out, true)?)?;
        ends.different += usize::from(!same(&read(&place)?, &self.files));
        let _ = std::fs::remove_dir_all(place);
        Ok(())
    }
}

/// Runs whose folder is a file, or below one, or where nobody may write, and which do not end with the status for that. Where
/// the user may write everywhere (root), the last of them is left out.
fn unusable_places_accepted(folder: &Path) -> Result<usize, ExperimentError> {
    let locked = folder.join("locked");
    let _ = std::fs::create_dir(&locked);
    let closed = std::fs::metadata(&locked).and_then(|data| {
        let mut permissions = data.permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(&locked, permissions)
    });
    let may_write = closed.is_err() || std::fs::write(locked.join("test"), "").is_ok();
    let places = ["scene.toml", "scene.toml/below", "locked/below"];
    let mut accepted = 0;
    for place in &places[..if may_write { 2 } else { 3 }] {
        let status = start(folder, place, false)?.wait().map_err(|error| failed(&error.to_string()))?;
        accepted += usize::from(status.code() != Some(BROKEN_PLACE));
    }
    Ok(accepted)
}

fn program() -> Result<PathBuf, ExperimentError> {
    std::env::current_exe().map_err(|error| failed(&error.to_string()))
}

fn failed(message: &str) -> ExperimentError {
    ExperimentError::Child { words: "run scene.toml".into(), message: message.into() }
}

fn start(folder: &Path, out: &str, resume: bool) -> Result<Child, ExperimentError> {
    let mut command = Command::new(program()?);
    command.current_dir(folder).args(["run", "scene.toml", "--quiet", "--out", out]);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    if resume {
        command.arg("--resume");
    }
    command.spawn().map_err(|error| failed(&error.to_string()))
}

fn finish(child: Child) -> Result<(), ExperimentError> {
    let ended = child.wait_with_output().map_err(|error| failed(&error.to_string()))?;
    let said = || format!("{}: {}", ended.status, String::from_utf8_lossy(&ended.stderr).trim());
    if ended.status.success() { Ok(()) } else { Err(failed(&said())) }
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
