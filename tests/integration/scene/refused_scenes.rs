//! Meaningless scenes end with status 2 and write nothing: no study, degrees instead of radians, sizes beyond the
//! memory.

use crate::common::{Folder, Said, Scene};
use std::process::Command;

const ENERGY: &str = "[energy]\nbars = { stiffness = 1e4 }\ncreases = { stiffness = 1.0 }\n";

/// Returns exit status and standard error of `foldwell run` for a scene of the open star cell with these lines.
fn run(sheet: &str, more: &str) -> (Option<i32>, String) {
    let scene = Scene::on(&format!("mesh = \"open-star.fold\"\n{sheet}"), more);
    let said = scene.with("t.csv", "i,j,n1,n2,angle\n0,1,0,0,30\n").program("");
    let written = said.folder.path().exists();
    assert_eq!(written, said.status != Some(2), "nothing is written where the input is wrong");
    (said.status, said.err)
}

fn study(keys: &str) -> String {
    format!("{ENERGY}[[study]]\nname = \"a\"\n{keys}")
}

/// Claim: a scene without studies gives no result.
#[test]
fn no_study() {
    let (status, said) = run("", ENERGY);
    assert!(status == Some(2) && said.contains("there is nothing to compute"), "{said}");
}

/// Claim: sizes beyond any memory are refused by one estimate, with the key to make smaller, before anything is built.
/// Studies may use 24 GiB, and models the free memory: the two large ones need over 260 GB. Each number is accepted by
/// the type of its key.
#[test]
fn sizes_beyond_the_memory() {
    let wells = study("kind = \"wells\"\nstarts = 4294967295");
    let map = study(
        "kind = \"landscape\"\nmodes = [[1,1,0]]\namplitudes = [0.001]\nmap = { amplitude = 0.02, rings = 4000000000 }",
    );
    let relax = study("kind = \"relax\"");
    let cases = [
        ("", study("kind = \"bloch\"\ngrid = [46340, 46340]"), "2147395600 wavenumbers", "`grid`"),
        ("", study("kind = \"bloch\"\ndensity = { grid = [46340, 46340] }"), "2147395600 wavenumbers", "`grid`"),
        ("", study("kind = \"bloch\"\ndensity = { bins = 4294967295 }"), "4294967295 bins", "`bins`"),
        ("domain = \"screw\"", wells, "4294967295 starts", "`starts`"),
        ("cells = [2, 2]", map, "has 1.3e20 samples", "`rings`"),
        (
            "domain = \"torus\"",
            study("kind = \"response\"\ndirections = 4294967295"),
            "4294967295 directions",
            "`directions`",
        ),
        ("domain = \"torus\"\ncells = [2700, 2700]", relax.clone(), "29160000 vertices", "`cells`"),
        ("cells = [1, 7000000]", relax.clone(), "28000000 vertices", "`cells`"),
        ("domain = \"screw\"\ncells = [40000, 40000]", relax, "the pictures have 6400000000 vertices", "at most"),
    ];
    for (sheet, more, what, key) in cases {
        let (status, said) = run(sheet, &more);
        assert!(status == Some(2) && said.contains(what) && said.contains(key), "{status:?}: {said}");
    }
}

/// Claim: a model that fits the machine and not the limit of the process is refused in the same way. Source: 360,000
/// vertices that are relaxed need 3 GB.
#[test]
#[cfg(target_os = "linux")]
fn sizes_beyond_the_limit_of_the_process() {
    let sheet = "generate = { pattern = \"miura\" }\ncells = [300, 300]";
    let folder = Folder::new();
    Scene::on(sheet, &study("kind = \"relax\"")).within(&folder).written();
    let limited = format!("ulimit -v 2000000; exec {} run scene.toml --out out", env!("CARGO_BIN_EXE_foldwell"));
    let mut shell = Command::new("sh");
    Said::by(shell.args(["-c", &limited]).current_dir(folder.path()), &folder).refused("there is room for 2 GB");
}

/// Claim: a pattern that does not fit the limit of the process is refused before its sheet is made. Source: a vertex
/// needs 2.3 kB.
#[test]
#[cfg(target_os = "linux")]
fn patterns_beyond_the_limit_of_the_process() {
    let folder = Folder::new();
    let program = env!("CARGO_BIN_EXE_foldwell");
    let limited = format!("ulimit -v 1000000; exec {program} new random --size 900,900 -o a.fold");
    let mut shell = Command::new("sh");
    let said = Said::by(shell.args(["-c", &limited]).current_dir(folder.path()), &folder);
    said.refused("which need at least 1.6 GB; there is room for 1.0 GB");
    assert!(folder.names().is_empty());
}

/// Claim: angles of more than a turn are taken for degrees, and are refused with their value in radians: 60 degrees are
/// 1.047198.
#[test]
fn degrees_are_refused() {
    let relax = "[[study]]\nname = \"a\"\nkind = \"relax\"";
    let rest = |rest: &str| {
        format!("[energy]\nbars = {{ stiffness = 1e4 }}\ncreases = {{ stiffness = 1.0, rest = {rest} }}\n{relax}")
    };
    let lock =
        |angle: f64| format!("{}\n[[lock]]\ncrease = [0, 1, 0, 0]\nangle = {angle:?}", study("kind = \"relax\""));
    let stop = "kind = \"trace\"\nstop = { crease_angle = { crease = [0, 1, 0, 0], angle = 90 } }";
    let cases = [
        (rest("60"), "did you mean \"60 deg\", 1.047198 rad?"),
        (rest("4"), "written with its unit, \"4 rad\""),
        (rest("inf"), "expected a finite number"),
        (rest("'60 grad'"), "`60 grad` is no angle"),
        (rest("'400 deg'"), "more than a whole turn"),
        (rest("{ file = \"t.csv\" }"), "t.csv:2: the angle 30 is more than a whole turn"),
        (lock(-10.0), "did you mean \"-10 deg\", -0.174533 rad?"),
        (study(stop), "did you mean \"90 deg\", 1.570796 rad?"),
    ];
    for (more, words) in cases {
        let (status, said) = run("domain = \"screw\"", &more);
        assert!(status == Some(2) && said.contains(words), "{status:?}: {said}");
    }
    let (_, said) = run("domain = \"screw\"", &rest("'3.2 rad'"));
    assert!(said.contains("note: ") && said.contains("rest angles are beyond pi"), "{said}");
    let (status, said) = run("domain = \"screw\"", &rest("0.1"));
    assert!(status != Some(2) && !said.contains("note: "), "{said}");
}

/// Claim: a fault on a line of 100 kB is reported without the line, at its own position; formulas are not numbers.
#[test]
fn messages_are_short() {
    let long = format!("# {}\n[[lock]]\ncrease = [0, 1, 0, 0]\nangle = np.float64(0.1)", "x".repeat(100_000));
    let (status, said) = run("", &long);
    assert!(status == Some(2) && said.contains("this is no number") && said.len() < 2000, "{}", said.len());
    let list = format!("x = [{}]", "1, ".repeat(40_000));
    let (status, said) = run("", &list);
    assert!(status == Some(2) && said.contains("unknown key `x`") && said.len() < 3000, "{}", said.len());
}
