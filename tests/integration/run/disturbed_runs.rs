//! Runs that are killed, have no space on the disk, or write into the folder of another run: files are complete or
//! missing, and a resumed run ends with the same bytes as an undisturbed one.
#![cfg(unix)]

use crate::common::{Files, Folder, Said, Scene};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Number of runs that are killed; `FOLDWELL_KILLS=100` kills more.
const KILLS: usize = 6;
/// Number of file sizes at which the disk is full.
const FULL_DISKS: usize = 4;
/// Unit in bytes of the shell's limit on file sizes.
const BLOCK: usize = 512;
/// Exit status of a run that could not write.
const CANNOT_WRITE: i32 = 3;
/// A scene of several studies with files of all kinds, which takes half a second in total.
const SCENE: &str = "[sheet]\nmesh = \"open-star.fold\"\ndomain = \"screw\"\ncells = [8, 4]\n[energy]\n\
    bars = { stiffness = 1e8 }\ncreases = { stiffness = 1.0 }\n[[lock]]\ncrease = [0, 1, 0, 0]\n\
    [[study]]\nname = \"first\"\nkind = \"trace\"\n[[study]]\nname = \"both\"\nkind = \"trace\"\nengine = \"both\"\n\
    [[study]]\nname = \"last\"\nkind = \"relax\"\n";

/// A folder with the scene, the files of an undisturbed run, and the duration of that run.
struct Undisturbed {
    folder: Folder,
    files: Files,
    time: Duration,
}

impl Undisturbed {
    fn new() -> Self {
        let folder = Scene::new(SCENE).placed();
        let clock = Instant::now();
        finish(&folder, start(&folder, "undisturbed", false));
        let (time, files) = (clock.elapsed(), read(&folder, "undisturbed"));
        Self { folder, files, time }
    }

    /// Checks the files left by a disturbed run, resumes it, and checks again. Returns whether the disturbed run was
    /// incomplete.
    fn check(&self, out: &str) -> bool {
        let left = read(&self.folder, out);
        for (path, bytes) in &left {
            // a summary must only be complete JSON, since it grows with the studies
            let summary = path.extension().is_some_and(|ending| ending == "json");
            let whole =
                if summary { serde_json::from_slice::<Value>(bytes).is_ok() } else { self.files[path] == *bytes };
            assert!(whole, "{out}: {} is broken", path.display());
        }
        finish(&self.folder, start(&self.folder, out, true));
        self.assert_same(&read(&self.folder, out), out);
        left.len() < self.files.len()
    }

    fn assert_same(&self, found: &Files, out: &str) {
        assert!(found.keys().eq(self.files.keys()), "{out}: {:?}", found.keys());
        for (path, bytes) in found {
            assert!(*bytes == self.files[path], "{out}: {} differs", path.display());
        }
    }
}

fn start(folder: &Folder, out: &str, resume: bool) -> Child {
    let mut command = folder.command(&["run", "scene.toml", "--quiet", "--out", out]);
    command.args(resume.then_some("--resume")).spawn().unwrap()
}

fn finish(folder: &Folder, child: Child) {
    Said::last(child, folder).well();
}

/// Returns all files of a run without drafts; none if its folder does not exist.
fn read(folder: &Folder, out: &str) -> Files {
    let mut files = folder.inner(out).files();
    files.retain(|path, _| path.extension().is_none_or(|ending| ending != "part"));
    files
}

/// Claim: runs that are killed at random moments (SIGKILL, which no program can handle) leave complete files or none,
/// and resumed they end with the bytes of an undisturbed run. Source: the rules for files. At least one run is killed
/// before it is complete, so that the test is not empty.
#[test]
fn killed_runs_leave_whole_files_and_resume_to_the_same_bytes() {
    let undisturbed = Undisturbed::new();
    let kills = std::env::var("FOLDWELL_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(KILLS);
    let mut numbers = ChaCha8Rng::seed_from_u64(5);
    let unfinished = (0..kills).filter(|round| {
        let out = format!("killed-{round}");
        let mut child = start(&undisturbed.folder, &out, false);
        sleep(undisturbed.time.mul_f64(numbers.random::<f64>()));
        child.kill().unwrap();
        child.wait().unwrap();
        undisturbed.check(&out)
    });
    assert!(unfinished.count() > 0, "no run was killed in the middle");
}

/// Claim: if there is no space for a file the run ends with status 3, no file is damaged, and resumed with space it
/// ends like an undisturbed run. The shell's `ulimit -f` limits files to the size of one of those that are written,
/// minus a block; its signal is ignored, so that writing fails as on a full disk.
#[test]
fn runs_without_room_say_so_and_break_nothing() {
    let undisturbed = Undisturbed::new();
    let mut sizes: Vec<usize> = undisturbed.files.values().map(|bytes| bytes.len() / BLOCK).collect();
    sizes.retain(|size| *size > 1);
    sizes.sort_unstable();
    sizes.dedup();
    for size in sizes.iter().rev().step_by(sizes.len().div_ceil(FULL_DISKS)) {
        let out = format!("full-{size}");
        let script = format!("trap '' XFSZ; ulimit -f {size}; exec \"$0\" run scene.toml --quiet --out {out}");
        let mut shell = Command::new("sh");
        shell.current_dir(undisturbed.folder.path()).args(["-c", &script]).arg(env!("CARGO_BIN_EXE_foldwell"));
        assert_eq!(shell.stderr(Stdio::null()).status().unwrap().code(), Some(CANNOT_WRITE), "{out}");
        assert!(undisturbed.check(&out), "{out}: there was room");
    }
}

/// Claim: two simultaneous runs into one folder leave the files of one run, and one of them at least has its answer;
/// the other, if the first has not ended before it begins, says that another run is at work and ends with status 3.
#[test]
fn two_runs_in_one_folder_leave_what_one_leaves() {
    let undisturbed = Undisturbed::new();
    let folder = &undisturbed.folder;
    let runs = [start(folder, "shared", false), start(folder, "shared", false)];
    let ended = runs.map(|run| Said::last(run, folder));
    assert!(ended.iter().any(|said| said.status == Some(0)));
    for said in ended.into_iter().filter(|said| said.status != Some(0)) {
        assert!(said.status == Some(CANNOT_WRITE) && said.err.contains("another run"), "{said:?}");
    }
    undisturbed.assert_same(&read(folder, "shared"), "shared");
}

/// Claim: a run into a file, below a file, or into a folder without write permission ends with status 3: the fault is
/// in the destination, not in the input. The last case is skipped for a user who may write everywhere.
#[test]
fn places_where_nothing_can_be_written_end_with_status_3() {
    let undisturbed = Undisturbed::new();
    let folder = &undisturbed.folder;
    let locked = folder.file("locked");
    std::fs::create_dir(&locked).unwrap();
    let mut permissions = std::fs::metadata(&locked).unwrap().permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&locked, permissions).unwrap();
    let may_write = std::fs::write(locked.join("test"), "").is_ok();
    let places = ["scene.toml", "scene.toml/below", "locked/below"];
    for place in &places[..if may_write { 2 } else { 3 }] {
        let status = start(folder, place, false).wait().unwrap();
        assert_eq!(status.code(), Some(CANNOT_WRITE), "{place}");
    }
}
