//! Time from Ctrl-C to the end of the program, for each kind of study, at sizes at which single steps take long.
//!
//! `cargo bench --bench stopping` prints a row for each case; with `-- --test` only the shortest case is run.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const RELAXED: &str = "[energy]\nbars = { stiffness = inf }\ncreases = { stiffness = 1, rest = { mode = [0, 0.05, 0], amplitude = 1 } }\n";
const DRAWN: &str = "[energy]\nbars = { stiffness = inf }\ncreases = { stiffness = 1 }\n";

/// Name, `[sheet]`, energy or lock, and study of each case, and the seconds until Ctrl-C.
const CASES: [(&str, &str, &str, &str, f64); 7] = [
    ("bloch, grid 16000 x 16000", "", DRAWN, "kind = \"bloch\"\ngrid = [16000, 16000]", 3.0),
    ("relax, 158 x 158 cells", "cells = [158, 158]", RELAXED, "kind = \"relax\"", 6.0),
    ("building, 1 x 3000000 cells", "cells = [1, 3000000]", RELAXED, "kind = \"relax\"", 5.0),
    ("modes, 100 x 100 cells", "cells = [100, 100]", DRAWN, "kind = \"modes\"\neigenvalues = 10", 4.0),
    ("surface, resolution 400", "domain = \"screw\"", DRAWN, "kind = \"surface\"\nresolution = 400", 4.0),
    (
        "trace, steps of 1e-5",
        "domain = \"screw\"",
        "[[lock]]\ncrease = [0, 1, 0, 0]\n",
        "kind = \"trace\"\nmax_step = 1e-5",
        4.0,
    ),
    (
        "wells, rigid, resolution 800",
        "domain = \"screw\"",
        DRAWN,
        "kind = \"wells\"\nstarts = 4\nrigid = true\nresolution = 800",
        4.0,
    ),
];

fn main() {
    let only_one = std::env::args().any(|word| word == "--test");
    for (name, sheet, energy, study, seconds) in CASES.into_iter().take(if only_one { 1 } else { CASES.len() }) {
        let folder = tempfile::tempdir().unwrap();
        let mesh = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("meshes/open-star.fold");
        let mesh = mesh.display().to_string();
        let text = format!("[sheet]\nmesh = {mesh:?}\n{sheet}\n{energy}[[study]]\nname = \"a\"\n{study}\n");
        std::fs::write(folder.path().join("scene.toml"), text).unwrap();
        println!("{name:32} {}", stopped(folder.path(), seconds));
    }
}

/// Returns the time from the signal to the end, and the exit status.
fn stopped(folder: &Path, seconds: f64) -> String {
    let mut program = Command::new(env!("CARGO_BIN_EXE_foldwell"));
    program.current_dir(folder).args(["run", "scene.toml", "--quiet"]).stderr(Stdio::null()).stdout(Stdio::null());
    let mut child = program.spawn().unwrap();
    std::thread::sleep(Duration::from_secs_f64(seconds));
    if let Some(status) = child.try_wait().unwrap() {
        return format!("ended before the signal, {status}");
    }
    let since = Instant::now();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let status = child.wait().unwrap();
    format!("{:.2} s, {status}", since.elapsed().as_secs_f64())
}
