//! `foldwell film`: an animated GIF of the states of a study, or an MP4 by ffmpeg.

use crate::common::{Folder, Said, Scene};
use foldwell::math::Vec3;
use foldwell::sheet::{Assignment, EdgeKind};
use foldwell::{Picture, write_vtu};
use std::fs;
use std::path::Path;

/// Runs a scene with a trajectory `t` of both directions of branch 0, and a study `n` without pictures, into `out`.
fn ran() -> Folder {
    let sheet = "mesh = \"open-star.fold\"\ndomain = \"screw\"";
    let trace = "[[study]]\nname = \"t\"\nkind = \"trace\"\nbranch = 0\nstop = { arc_length = 0.5 }\n";
    let table = "[[study]]\nname = \"n\"\nkind = \"branches\"\n";
    Scene::on(sheet, &format!("[[lock]]\ncrease = [0, 1, 0, 0]\n{trace}{table}")).converged().folder
}

/// Returns the size of a GIF, and the delay and pixels of its frames.
fn decoded(path: &Path) -> ([u16; 2], Vec<(u16, Vec<u8>)>) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut reader = options.read_info(fs::File::open(path).unwrap()).unwrap();
    let size = [reader.width(), reader.height()];
    let mut frames = Vec::new();
    while let Some(frame) = reader.read_next_frame().unwrap() {
        frames.push((frame.delay, frame.buffer.to_vec()));
    }
    (size, frames)
}

/// A square of this side.
fn square(side: f64) -> Picture {
    let points: Vec<Vec3> =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x * side, y * side, 0.0)).to_vec();
    let none = vec![f64::NAN; 4];
    Picture {
        displacement: vec![Vec3::zeros(); 4],
        places: (0..4).map(|vertex| (vertex, [0, 0])).collect(),
        letters: vec![Assignment::Boundary; 4],
        points,
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        self_intersecting: vec![0; 2],
        lines: vec![[0, 1], [1, 2], [2, 3], [3, 0]],
        line_kinds: vec![EdgeKind::Boundary; 4],
        line_edges: vec![0, 1, 2, 3],
        fold_angle: none.clone(),
        rest_angle: none.clone(),
        strain: none.clone(),
        energy: none.clone(),
        tension: none.clone(),
        torque: none,
        memory: std::collections::BTreeMap::new(),
    }
}

/// Claim: the film of a trajectory runs from the end of the negative direction over the drawn state, which is there
/// once, to the end of the positive one. Here the states are squares that grow along the positive direction and shrink
/// along the negative one: in the order of the film each has more pixels than the one before, all in one scale.
#[test]
fn a_trajectory_runs_in_one_direction() {
    let folder = Folder::new();
    let rows = [(1, 1.0), (1, 1.2), (1, 1.5), (-1, 1.0), (-1, 0.8), (-1, 0.5)];
    let mut table = String::from("branch,sign,step\n");
    for (row, (sign, side)) in rows.iter().enumerate() {
        table += &format!("0,{sign},{}\n", row % 3);
        write_vtu(&folder.file(format!("t/t_{row:04}.vtu")), &square(*side)).unwrap();
    }
    folder.write("t.csv", table);
    folder.write("t.pvd", "");
    folder.foldwell("film t.pvd --size 200").well();
    let (_, frames) = decoded(&folder.file("t.gif"));
    let sheet = |pixels: &[u8]| pixels.chunks(4).filter(|pixel| *pixel != &pixels[..4]).count();
    let counts: Vec<usize> = frames.iter().map(|(_, pixels)| sheet(pixels)).collect();
    assert!(counts.len() == 5 && counts.windows(2).all(|pair| pair[1] > pair[0]), "{counts:?}");
    let growth = counts[4] as f64 / counts[0] as f64;
    assert!((growth / 9.0 - 1.0).abs() < 0.1, "three times the side, nine times the pixels: {growth}");
}

/// Claim: the folder and the series make the same film, of the size and the pace that were asked for, and the drawn
/// state is on it once: it has a frame less than there are pictures.
#[test]
fn a_trajectory_of_a_run() {
    let folder = ran();
    let said = folder.foldwell("film out --size 200 --fps 20").well();
    assert_eq!(said.out, "out/t.gif\n");
    let out = folder.inner("out");
    let ([width, _], frames) = decoded(&out.file("t.gif"));
    let pictures = out.inner("t").names().len();
    assert_eq!((width, frames.len()), (200, pictures - 1));
    assert!(frames.iter().all(|(delay, _)| *delay == 5));
    out.foldwell("film t.pvd -o again.gif --size 200 --fps 20 --branch 0").well();
    assert!(out.bytes("again.gif") == out.bytes("t.gif"));
}

/// Claim: what cannot be filmed is refused with status 2 and a message that says what would be right, and nothing is
/// written: a folder of no run, a series that does not exist, a study without pictures, a branch that there is not, an
/// ending that is unknown, a size and a pace out of range, and an MP4 where there is no ffmpeg.
#[test]
fn what_cannot_be_filmed() {
    let folder = ran();
    fs::create_dir(folder.file("empty")).unwrap();
    let before = folder.inner("out").names().len();
    folder.write("out/n.pvd", "");
    let cases = [
        ("film empty", "not the folder of a run"),
        ("film out/none.pvd", "out/none.pvd: cannot be read"),
        ("film out/n.pvd", "no study with two states"),
        ("film out/t.pvd --branch 7", "the branches are 0"),
        ("film out -o out/a.avi", "expected one of .gif or .mp4"),
        ("film out --size 10", "64..=4096"),
        ("film out --fps 0", "1..=50"),
        ("film out -o out/a.mp4", "install ffmpeg"),
    ];
    for (words, expected) in cases {
        let mut command = folder.command(&words.split(' ').collect::<Vec<_>>());
        Said::by(command.env("PATH", folder.path()), &folder).refused(expected);
    }
    assert_eq!(folder.inner("out").names().len(), before + 1);
}
