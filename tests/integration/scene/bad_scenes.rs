//! Malformed scenes, each with its message: position (`scene.toml:line:column`), fault and remedy.

use crate::common::Folder;
use foldwell::scene::{SceneError, parse};
use miette::Diagnostic;
use proptest::prelude::*;

/// A valid scene with every table and every kind of study.
const GOOD: &str = r#"title = "every key"
[sheet]
mesh = "star.fold"
domain = "patch"
cells = [4, 6]
[energy]
bars = { stiffness = inf }
creases = { stiffness = 1.0, rest = { mode = [1, 0, 0], amplitude = 0.1 } }
facets = { stiffness = 10 }
[[lock]]
crease = [0, 1, 0, 0]
angle = 0.3
[[load]]
vertex = 0
cell = [2, 3]
force = [0.0, 0.0, -1.0]
[[pin]]
vertex = 1
axes = "xz"
[[study]]
name = "first"
kind = "relax"
start = { random = 0.1, seed = 7 }
tolerance = 1e-12
[[study]]
name = "second"
kind = "relax"
start = "first"
check = ["self-intersection"]
draw = []
[[study]]
name = "third"
kind = "relax"
start = "old/first.vtu"
[[study]]
name = "loop"
kind = "trace"
engine = "both"
branch = "all"
max_step = 0.1
stop = { arc_length = 10.0, crease_angle = { crease = [0, 1, 0, 0], angle = 1 } }
[[study]]
name = "modes"
kind = "modes"
eigenvalues = 12
[[study]]
name = "well"
kind = "landscape"
modes = [[1, 1, 0], { rates = "mode.csv" }]
amplitudes = [0.01, 0.02]
[[study]]
name = "waves"
kind = "bloch"
grid = [32, 32]
q1 = [0.5]
[[study]]
name = "rays"
kind = "branches"
[[study]]
name = "sheet"
kind = "surface"
resolution = 20
max_curvature = 3
"#;

/// Returns the message and the help for a scene that must be refused.
fn refusal(text: &str) -> (String, String) {
    let error = parse(text, "scene.toml").expect_err("the scene should be refused");
    assert!(matches!(error, SceneError::At { .. }), "{error}");
    (error.to_string(), error.help().map(|help| help.to_string()).unwrap_or_default())
}

/// A fault in an otherwise valid scene: the line that is replaced, its replacement, and the expected message.
struct Fault {
    line: usize,
    new: &'static str,
    at: &'static str,
    message: &'static str,
    help: &'static str,
}

const fn fault(line: usize, new: &'static str, at: &'static str, message: &'static str, help: &'static str) -> Fault {
    Fault { line, new, at, message, help }
}

#[rustfmt::skip]
const FAULTS: &[Fault] = &[
    // the language
    fault(2, "[sheet", "2:7", "unclosed table", "expected `]`"),
    fault(5, "cells = [4, 6", "6:1", "missing comma between array elements", "expected `,`"),
    fault(1, "title = \"a\"\ntitle = \"b\"", "2:1", "`title` is given a second time", "each key, and each table in brackets, is given once"),
    fault(7, "bars = { stiffness = 1,5 }", "7:26", "this is no TOML", "a number has a decimal point, 1.5; a comma ends it"),
    fault(7, "bars = { stiffness = 1,5, rest = \"drawn\" }", "7:25", "this is no TOML", "a number has a decimal point, 1.5; a comma ends it"),
    fault(7, "bars.stiffness = 1,5", "7:19", "this is no TOML", "a number has a decimal point, 1.5; a comma ends it"),
    fault(4, "domain = \u{201c}patch\u{201d}", "4:10", "this is no TOML", "these are curly quotes; write straight ones, \""),
    fault(24, "title = \"a\"", "24:1", "unknown key `title`", "`title` belongs to the scene itself, above its first table; the keys here are `start`, `tolerance`, `method`, `keep_every`"),
    fault(7, "bars = { stiffness = 2020-01-01 }", "7:22", "the value is a date", "expected a number, or a text in quotes"),
    fault(8, "creases = { stiffness = 1.0, law = { kind = \"bilinear\", ratio = 0.1, at = 30 } }", "8:36", "the angle 30 is beyond pi", "angles are radians; did you mean \"30 deg\", 0.523599 rad?"),
    fault(8, "creases = { stiffness = 1.0, law = { M = { kind = \"bilinear\", ratio = 0.1, at = [-90, inf] } } }", "8:36", "the angle -90 is beyond pi", "angles are radians; did you mean \"-90 deg\", -1.570796 rad?"),
    fault(9, "facets = { stiffness = 1.0, law = { kind = \"table\", points = [[-90.0, -1.0], [0.0, 0.0], [90.0, 1.0]] } }", "9:35", "the angle -90 is more than a whole turn", "angles are radians: -90 degrees are -1.570796 rad"),
    fault(1, "title = 3", "1:9", "the value is `3`", "expected a text in quotes"),
    fault(1, "tittle = \"a\"", "1:1", "unknown key `tittle`", "did you mean `title`? the keys here are `title`, `sheet`, `units`, `material`, `energy`, `mass`, `lock`, `load`, `pressure`, `pin`, `part`, `tie`, `spring`, `drive`, `study`, `sweep`"),
    // the sheet
    fault(3, "", "2:1", "the sheet has neither a mesh nor a pattern", "give one of mesh = \"file.fold\" and generate = { pattern = \"miura\", .. }"),
    fault(3, "mesh = \"a.fold\"\ngenerate = { pattern = \"miura\" }", "4:12", "the sheet has both a mesh and a pattern", "give one of mesh = \"file.fold\" and generate = { pattern = \"miura\", .. }"),
    fault(3, "mesh = 3", "3:8", "the value is `3`", "expected a path in quotes"),
    fault(4, "domain = \"pipe\"", "4:10", "unknown word `pipe`", "expected one of `screw`, `patch`, `torus`, `tube`"),
    fault(5, "cells = [0, 6]", "5:9", "there are 0 x 6 cells", "expected at least 1 in either direction"),
    fault(5, "cells = [4, 6, 2]", "5:9", "the list has 3 values", "expected 2 values"),
    fault(5, "cells = [4000000000, 4000000000]", "5:9", "4000000000 x 4000000000 cells are more than can be numbered", "expected at most 2147483647 in all"),
    fault(5, "cells = [99999999999999999999, 1]", "5:10", "the value is `99999999999999999999`", "expected a whole number"),
    fault(5, "cell = [4, 6]", "5:1", "unknown key `cell`", "did you mean `cells`? the keys here are `mesh`, `merge`, `frame`, `generate`, `domain`, `cells`, `lattice`, `seam`, `closing`, `inwards`"),
    fault(4, "domain = \"tube\"", "4:10", "a tube without a seam", "give seam = [n1, n2], the cell that lies on cell [0, 0] when the sheet is rolled up"),
    fault(4, "domain = \"tube\"\nseam = [0, 0]", "5:8", "there is no tube with the seam [0, 0]", "expected whole numbers of at most 1000, not both 0"),
    fault(4, "domain = \"tube\"\nseam = [0, 1001]", "5:8", "there is no tube with the seam [0, 1001]", "expected whole numbers of at most 1000, not both 0"),
    fault(4, "domain = \"tube\"\nseam = [1, 8]", "6:9", "a tube with the seam [1, 8] has no 4 strands", "the first number is at most 1, the greatest common divisor of the seam"),
    fault(4, "domain = \"tube\"\nseam = [0, 8]\nlattice = \"free\"", "6:11", "`lattice` is given for a tube", "it belongs to domain = \"torus\"; leave it out otherwise"),
    fault(4, "domain = \"torus\"\nseam = [0, 8]", "5:8", "`seam` is given for a torus", "it belongs to domain = \"tube\"; leave it out otherwise"),
    fault(4, "domain = \"screw\"\nclosing = \"turn\"", "5:11", "`closing` is given for a screw domain", "it belongs to domain = \"tube\"; leave it out otherwise"),
    fault(4, "domain = \"patch\"\ninwards = true", "5:11", "`inwards` is given for a patch", "it belongs to domain = \"tube\"; leave it out otherwise"),
    fault(4, "domain = \"tube\"\nseam = [0, 8]\nclosing = \"none\"", "6:11", "unknown word `none`", "expected one of `both`, `turn`, `rise`"),
    fault(5, "cells = [4, 6]\nlattice = \"free\"", "6:11", "`lattice` is given for a patch", "it belongs to domain = \"torus\"; leave it out otherwise"),
    fault(4, "domain = \"screw\"", "14:10", "a load on a screw domain", "loads, pins and springs need domain = \"patch\""),
    // the energy
    fault(7, "bars = { stiffness = 0 }", "7:22", "the stiffness is 0", "expected a positive number or `inf` (exactly rigid), 1e-300 at least"),
    fault(7, "bars = { stiffness = -3.0 }", "7:22", "the stiffness is -3", "expected a positive number or `inf` (exactly rigid), 1e-300 at least"),
    fault(7, "bars = { stiffness = 1e-320 }", "7:22", "the stiffness is 1e-320", "expected a positive number or `inf` (exactly rigid), 1e-300 at least"),
    fault(7, "bars = { stiffness = nan }", "7:22", "the stiffness is NaN", "expected a positive number or `inf` (exactly rigid), 1e-300 at least"),
    fault(7, "bars = { stiffness = \"soft\" }", "7:22", "the value is \"soft\"", "expected a number, `inf`, \"mesh\", { M = 1.0, V = 2.0, .. } or { file = \"k.csv\" }"),
    fault(7, "bars = { stifness = 1 }", "7:10", "unknown key `stifness`", "did you mean `stiffness`? the keys here are `stiffness`, `rest`, `law`, `yield`"),
    fault(7, "bars = {}", "7:8", "missing key `stiffness`", "`stiffness` has to be given here, or follow from [material], for creases with `crease_length`"),
    fault(6, "[material]\nyoung = 3200.0\npoisson = 0.6\nthickness = 0.3\n[energy]", "8:11", "Poisson's ratio is 0.6", "expected a number above -1, and at most 0.5"),
    fault(6, "[material]\nyoung = 3200.0\nthickness = 0.3\n[energy]", "6:1", "missing key `poisson`", "`poisson` has to be given here"),
    fault(6, "[material]\nyoung = 0.0\npoisson = 0.3\nthickness = 0.3\n[energy]", "7:9", "the number is 0", "expected a finite number above 0"),
    fault(8, "creases = { rest = 1.0 }", "8:11", "missing key `stiffness`", "`stiffness` has to be given here, or follow from [material], for creases with `crease_length`"),
    fault(9, "facets = \"N5B9\"", "9:10", "unknown word `N5B9`", "did you mean `N5B8`? expected `N4B5` or `N5B8`"),
    fault(9, "facets = 3", "9:10", "the value is `3`", "expected \"N4B5\", \"N5B8\" or a table { model, stiffness, rest, fraction, law }"),
    fault(6, "[units]\nlong = \"mm\"\n[energy]", "7:1", "unknown key `long`", "the keys here are `length` or `force`"),
    fault(7, "bars = 1000", "7:8", "the value is `1000`", "expected a table, { stiffness = 1.0, .. }"),
    fault(8, "creases = { stiffness = 1.0, rest = \"folded\" }", "8:37", "the value is \"folded\"", "expected \"drawn\", \"flat\", \"target\", \"assigned\", an angle, { M = -1.0, V = 1.0, F = 0.0 }, { mode = [k11, k22, k12], amplitude = e } or { file = \"angles.csv\" }"),
    fault(8, "creases = { stiffness = 1.0, rest = inf }", "8:37", "the number is inf", "expected a finite number"),
    fault(8, "creases = { stiffness = 1.0, rest = true }", "8:37", "the value is `true`", "expected \"drawn\", \"flat\", \"target\", \"assigned\", an angle, { M = -1.0, V = 1.0, F = 0.0 }, { mode = [k11, k22, k12], amplitude = e } or { file = \"angles.csv\" }"),
    fault(8, "creases = { stiffness = 1.0, rest = { mode = [1, 0], amplitude = 0.1 } }", "8:46", "the list has 2 values", "expected 3 values"),
    fault(8, "creases = { stiffness = 1.0, rest = { mode = [0, 0, 0], amplitude = 0.1 } }", "8:46", "the mode is zero", "expected a curvature tensor [k11, k22, k12]"),
    fault(8, "creases = { stiffness = 1.0, rest = { mode = [1, nan, 0], amplitude = 0.1 } }", "8:46", "the number is NaN", "expected a finite number"),
    fault(8, "creases = { stiffness = 1.0, rest = { mode = [1, 0, 0], amplitude = inf } }", "8:69", "the number is inf", "expected a finite number"),
    fault(8, "creases = { stiffness = 1.0, rest = { mode = [1, 0, 0] } }", "8:37", "`amplitude` is missing", "expected { mode = [k11, k22, k12], amplitude = e }"),
    fault(8, "creases = { stiffness = 1.0, rest = { amplitude = 0.1 } }", "8:37", "`mode` is missing", "expected { mode = [k11, k22, k12], amplitude = e }"),
    fault(8, "creases = { stiffness = 1.0, rest = {} }", "8:37", "the table is empty", "expected { M = -1.0, V = 1.0 }, { mode, amplitude } or { file }"),
    fault(8, "creases = { stiffness = 1.0, rest = { file = \"a.csv\", amplitude = 0.1 } }", "8:37", "rest angles come from more than one of letters, a mode and a file", "expected one of the three"),
    fault(8, "creases = { stiffness = 1.0, yield = { moment = -1.0 } }", "8:49", "it yields at -1", "expected a positive number"),
    fault(8, "creases = { stiffness = 1.0, yield = { moment = 1.0, hardening = 1.0 } }", "8:66", "the hardening is 1", "expected a number from 0 to below 1: the slope beyond the bound over the stiffness"),
    fault(8, "creases = { stiffness = 1.0, yield = { moment = 1.0, isotropic = 2 } }", "8:66", "the part is 2", "expected a number from 0 to 1"),
    fault(8, "creases = { stiffness = 1.0, yield = { force = 1.0 } }", "8:40", "unknown key `force`", "the keys here are `moment`, `hardening`, `isotropic`"),
    fault(9, "facets = { stiffness = 10, angle = 1 }", "9:28", "unknown key `angle`", "the keys here are `model`, `stiffness`, `rest`, `fraction`, `law`, `yield`"),
    fault(7, "bars = { stiffness = {} }", "7:22", "the table is empty", "expected { M = 1.0, V = 2.0, .. } or { file }"),
    fault(7, "bars = { stiffness = { M = 1, file = \"k.csv\" } }", "7:22", "stiffnesses come from letters and from a file at once", "expected one of the two"),
    fault(7, "bars = { stiffness = { Q = 1 } }", "7:24", "unknown key `Q`", "the keys here are `M`, `V`, `F`, `U`, `B`, `C`, `J`, `file`"),
    fault(7, "bars = { stiffness = 1, rest = 0 }", "7:32", "the number is 0", "expected a finite number above 0"),
    fault(7, "bars = { stiffness = 1, rest = \"flat\" }", "7:32", "the value is \"flat\"", "expected \"drawn\", a factor on the drawn lengths or { file = \"lengths.csv\" }"),
    // the mass
    fault(1, "mass = { vertex = 0 }", "1:19", "the number is 0", "expected a finite number above 0"),
    fault(1, "mass = { area = -0.1 }", "1:17", "the number is -0.1", "expected a finite number above 0"),
    fault(1, "mass = { area = inf }", "1:17", "the number is inf", "expected a finite number above 0"),
    fault(1, "mass = { vertex = 1, area = 2 }", "1:29", "the sheet has both a mass per vertex and per area", "give one of { vertex = 1.0 }, the mass of each vertex, and { area = 1.0 }, a mass per area"),
    fault(1, "mass = {}", "1:8", "the mass has neither `vertex` nor `area`", "give one of { vertex = 1.0 }, the mass of each vertex, and { area = 1.0 }, a mass per area"),
    fault(1, "mass = 1.0", "1:8", "the value is `1.0`", "expected a table"),
    fault(1, "mass = { edge = 1 }", "1:10", "unknown key `edge`", "the keys here are `vertex` or `area`"),
    // locks, loads, pins
    fault(11, "crease = [0, 1, 0]", "11:10", "the list has 3 values", "expected 4 values"),
    fault(11, "crease = [0, 0.5, 0, 0]", "11:14", "the value is `0.5`", "expected a whole number"),
    fault(11, "crease = [0, -1, 0, 0]", "11:10", "an edge cannot start or end at vertex -1", "expected [i, j, n1, n2] with i and j counted from 0"),
    fault(11, "crease = [1, 1, 0, 0]", "11:10", "the edge runs from vertex 1 to itself", "expected two different ends in [i, j, n1, n2]"),
    fault(11, "crease = [1, 1, 9999999999, 0]", "11:10", "cell 9999999999 of an edge is out of range", "expected n1 and n2 of [i, j, n1, n2] to be small whole numbers"),
    fault(11, "crease = [0, 1, 0, -1]\n[[lock]]\ncrease = [1, 0, 0, 1]", "13:10", "the crease is locked twice", "it is locked in line 11 already; [i, j, n1, n2] and [j, i, -n1, -n2] are the same crease"),
    fault(12, "angle = nan", "12:9", "the number is NaN", "expected a finite number"),
    fault(14, "vertex = -1", "14:10", "the value is `-1`", "expected a whole number, 0 or more"),
    fault(15, "cell = [4, 0]", "15:8", "there is no cell [4, 0]", "cells of this patch run from [0, 0] to [3, 5]"),
    fault(15, "cell = [-1, 0]", "15:9", "the value is `-1`", "expected a whole number, 0 or more"),
    fault(16, "force = [0.0, 0.0, inf]", "16:9", "the number is inf", "expected a finite number"),
    fault(15, "cell = [1, 2, 3]", "15:8", "the list has 3 values", "expected 2 values"),
    fault(16, "force = [0.0, 0.0, 1.0, 2.0]", "16:9", "the list has 4 values", "expected 3 values"),
    fault(16, "weight = [0, 0, -1]", "16:10", "`weight` stands alone in its load", "it is that of the whole sheet; give forces on vertices in a [[load]] of their own"),
    fault(16, "", "13:1", "the load has neither `force` nor `weight`", "give force = [x, y, z] with vertex or vertices, or weight = [x, y, z], the acceleration of gravity"),
    fault(19, "axes = \"xw\"", "19:8", "`xw` names no axes", "expected one or more of the letters x, y, z, each once, as in \"xz\""),
    fault(19, "axes = \"xx\"", "19:8", "`xx` names no axes", "expected one or more of the letters x, y, z, each once, as in \"xz\""),
    fault(19, "axes = \"\"", "19:8", "`` names no axes", "expected one or more of the letters x, y, z, each once, as in \"xz\""),
    fault(19, "[[pin]]\nvertex = 1\ncell = [0, 0]", "20:10", "vertex 1 of cell [0, 0] is pinned twice", "name all its axes in the pin of line 18"),
    // studies
    fault(21, "name = \"a b\"", "21:8", "`a b` is not a name for a study", "expected letters, digits, `_` and `-` only"),
    fault(21, "name = \"\"", "21:8", "`` is not a name for a study", "expected letters, digits, `_` and `-` only"),
    fault(21, "name = \"drawn\"", "21:8", "`drawn` cannot name a study because `start = \"drawn\"` means the drawn state", "expected another name"),
    fault(21, "name = \"second\"", "26:8", "two studies have the name `second`", "choose another: line 21 has it, and it names files"),
    fault(21, "", "20:1", "missing key `name`", "`name` has to be given here"),
    fault(22, "kind = \"relaxx\"", "22:8", "unknown word `relaxx`", "did you mean `relax`? expected one of `relax`, `trace`, `surface`, `modes`, `branches`, `landscape`, `bloch`, `wells`, `path`, `fold`, `response`"),
    fault(22, "kind = { relax = {} }", "22:8", "the kind of a study is a word", "expected one of \"relax\", \"trace\", \"surface\", \"modes\", \"branches\", \"landscape\", \"bloch\", \"wells\", \"path\", \"fold\", \"response\""),
    fault(22, "kind = 3", "22:8", "the kind of a study is a word", "expected one of \"relax\", \"trace\", \"surface\", \"modes\", \"branches\", \"landscape\", \"bloch\", \"wells\", \"path\", \"fold\", \"response\""),
    fault(22, "", "20:1", "missing key `kind`", "`kind` has to be given here"),
    fault(23, "start = { random = 0.1 }", "23:9", "missing key `seed`", "`seed` has to be given here"),
    fault(23, "start = { random = -0.1, seed = 1 }", "23:20", "the number is -0.1", "expected a finite number above 0"),
    fault(23, "start = \"second\"", "23:9", "no earlier study is called `second`", "\"drawn\", the name of an earlier study with states (there are none), { random, seed } or a .vtu file"),
    fault(23, "start = 3", "23:9", "the value is `3`", "expected \"drawn\", the name of an earlier study, { random = amplitude, seed = n } or a .vtu file"),
    fault(24, "tolerance = 0", "24:13", "the number is 0", "expected a finite number above 0"),
    fault(62, "resolution = 0", "62:14", "the number is 0", "expected a whole number from 1 to 4294967295"),
    fault(24, "max_step = 1", "24:1", "unknown key `max_step`", "`max_step` is a key of studies of kind trace, path, fold; the keys here are `start`, `tolerance`, `method`, `keep_every`"),
    fault(28, "start = \"third\"", "28:9", "no earlier study is called `third`", "\"drawn\", the name of an earlier study with states (here \"first\"), { random, seed } or a .vtu file"),
    fault(29, "check = [\"overlap\"]", "29:10", "unknown word `overlap`", "expected `self-intersection`"),
    fault(30, "draw = [\"png\"]", "30:9", "unknown word `png`", "expected one of `vtk`, `svg`, `numbers`, `html`"),
    fault(38, "engine = \"fast\"", "38:10", "unknown word `fast`", "expected one of `kinematic`, `energy`, `both`"),
    fault(39, "branch = -2", "39:10", "the value is `-2`", "expected \"all\" or the number of a branch, counted from 0"),
    fault(41, "stop = {}", "41:8", "no condition to stop at", "give one of arc_length, curvature, crease_angle = { crease, angle }, self_intersection = true; a path also has drive, displacement = { probe, value }, reaction, states and limit_points"),
    fault(41, "stop = { curvature = 0 }", "41:22", "the number is 0", "expected a finite number above 0"),
    fault(45, "[[study]]\nname = \"late\"\nkind = \"relax\"\nstart = \"modes\"", "48:9", "`modes` is a study of kind modes, which ends in no state", "\"drawn\", the name of an earlier study with states (here \"first\", \"second\", \"third\", \"loop\"), { random, seed } or a .vtu file"),
    fault(45, "eigenvalues = 1.5", "45:15", "the value is `1.5`", "expected a whole number, 0 or more"),
    fault(49, "modes = []", "49:9", "no modes", "give at least one, as in [[1, 0, 0]]"),
    fault(50, "amplitudes = []", "50:14", "no amplitudes", "give at least one, as in [0.01]"),
    fault(54, "grid = [0, 4]", "54:8", "there are 0 x 4 cells", "expected at least 1 in either direction"),
    fault(58, "kind = \"branches\"\nstart = \"drawn\"", "59:1", "unknown key `start`", "`start` is a key of studies of kind relax, modes, bloch, wells, path, fold, response; no keys are expected here"),
];

fn with_line(line: usize, new: &str) -> String {
    GOOD.lines().enumerate().map(|(at, old)| if at + 1 == line { new } else { old }).collect::<Vec<_>>().join("\n")
}

/// Each fault is found at its position, with the expected message.
#[test]
fn every_fault_has_its_message() {
    let mut wrong = Vec::new();
    for fault in FAULTS {
        let (message, help) = refusal(&with_line(fault.line, fault.new));
        let expected = format!("scene.toml:{}: {}", fault.at, fault.message);
        if (message.as_str(), help.as_str()) != (expected.as_str(), fault.help) {
            wrong.push((fault.new, message, help));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Faults that are found with the files beside a scene, or in the brackets of a table.
#[test]
fn slips_are_said_in_words() {
    let energy = "[energy]\nbars = { stiffness = inf }\ncreases = { stiffness = 1.0";
    let scene = |mesh: &str, law: &str, study: &str| {
        format!("[sheet]\n{mesh}\n{energy}{law} }}\n{study}\nname = \"a\"\nkind = \"relax\"\n")
    };
    let of_law = |law: &str| format!(", law = {law}");
    let (right, sides) = ("mesh = \"a.fold\"", "generate = { pattern = \"kresling\", sides = \"six\" }");
    let at = |at: &str| of_law(&format!("{{ kind = \"bilinear\", ratio = 0.1, at = {at} }}"));
    let table = of_law("{ kind = \"table\", file = \"a.csv\" }");
    let folder = Folder::new().with("a.fold", FINITE).with("a.csv", "angle,torque\n-90,-1\n0,0\n90,1\n");
    for (name, text, said) in [
        ("mesh", scene("mesh = \"b.fold\"", "", "[[study]]"), "did you mean `a.fold`? paths are relative"),
        ("sides", scene(sides, "", "[[study]]"), "`sides` is \"six\""),
        ("equal", scene(&sides.replace("\"six\"", "2.5, radius = 2.5"), "", "[[study]]"), "`sides` is `2.5`"),
        ("study", scene(right, "", "[study]"), "expected a list of tables, each under [[study]]"),
        ("kind", scene(right, "", "[[study]]").replace("relax", "relx"), "did you mean `relax`?"),
        ("table", scene(right, &table, "[[study]]"), "a.csv:2: the angle -90 is more than a whole turn"),
    ] {
        folder.write(format!("{name}.toml"), text);
        folder.foldwell(&format!("info {name}.toml")).refused(said);
    }
    for right_at in ["\"30 deg\"", "[\"-30 deg\", inf]", "1.5"] {
        folder.write("good.toml", scene(right, &at(right_at), "[[study]]"));
        folder.foldwell("info good.toml").well();
    }
}

/// The scene in which the faults are planted is valid.
#[test]
fn the_good_scene_is_good() {
    let file = parse(GOOD, "scenes/scene.toml").expect("the scene is right");
    assert_eq!(file.scene.studies.len(), 9);
    assert_eq!(file.resolve("star.fold".as_ref()), std::path::Path::new("scenes/star.fold"));
}

/// A check that is made later reports the position in the scene in the same way.
#[test]
fn later_faults_point_at_the_scene() {
    let file = parse(GOOD, "scene.toml").expect("the scene is right");
    let lock = &file.scene.locks[0];
    let error = file.error_at(lock.crease.span(), "edge [0, 1, 0, 0] is no edge of this sheet", "its edges are ..");
    assert_eq!(error.to_string(), "scene.toml:11:10: edge [0, 1, 0, 0] is no edge of this sheet");
}

/// A missing file is an error of reading, with the name of the file.
#[test]
fn a_missing_scene_is_named() {
    let error = foldwell::scene::read("no/such/scene.toml".as_ref()).expect_err("there is no such file");
    assert!(
        matches!(error, SceneError::Read { .. }) && error.to_string().starts_with("no/such/scene.toml: "),
        "{error}"
    );
}

/// A finite sheet of four triangles around a point. The other sheet is the periodic star cell; paths are relative to
/// the scene.
const FINITE: &str = r#"{ "vertices_coords": [[0,0,0],[1,0,0],[0,1,0],[-1,0,0],[0,-1,0.2]],
  "faces_vertices": [[0,1,2],[0,2,3],[0,3,4],[0,4,1]] }"#;

/// A well-formed scene that does not fit its sheet: the scene, the position and the message, and the help.
struct Misfit {
    text: &'static str,
    at: &'static str,
    message: &'static str,
    help: &'static str,
}

const fn misfit(text: &'static str, at: &'static str, message: &'static str, help: &'static str) -> Misfit {
    Misfit { text, at, message, help }
}

#[rustfmt::skip]
const MISFITS: &[Misfit] = &[
    // the sheet
    misfit("[sheet]\nmesh = \"finite.fold\"\ndomain = \"torus\"", "3:10", "the mesh has no lattice", "a finite sheet has domain \"patch\"; a periodic one has the key `foldwell:lattice` in its mesh"),
    misfit("[sheet]\nmesh = \"finite.fold\"\ndomain = \"screw\"", "3:10", "the mesh has no lattice", "a finite sheet has domain \"patch\"; a periodic one has the key `foldwell:lattice` in its mesh"),
    misfit("[sheet]\nmesh = \"finite.OBJ\"\ndomain = \"torus\"", "3:10", "the mesh has no lattice", "a finite sheet has domain \"patch\"; a periodic one has the key `foldwell:lattice` in its mesh, in OBJ as two comments `# foldwell:lattice x y z`"),
    misfit("[sheet]\nmesh = \"finite.OBJ\"\nframe = 1", "3:9", "a mesh of faces has no frames", "frames are those of FOLD files; leave out `frame`"),
    misfit("[sheet]\nmesh = \"finite.OBJ\"\nmerge = 1.0", "3:9", "a mesh of faces has no lines to join", "points are merged in drawings of lines and in flat FOLD files; leave out `merge`"),
    misfit("[sheet]\nmesh = \"sheet.vtu\"", "2:8", "a mesh of a scene is no .vtu file", "convert it to a .fold file; a state to start from is `start`"),
    misfit("[sheet]\nmesh = \"finte.fold\"", "2:8", "there is no file ", "did you mean `finite.fold`? paths are relative to the folder of the scene"),
    misfit("[sheet]\ngenerate = { pattern = \"miura\", fold = 2.0 }", "2:12", "`fold` is 2", "angles are radians, or written as \"60 deg\""),
    misfit("[sheet]\ngenerate = { pattern = \"kresling\", sides = 2 }", "2:12", "`sides` is 2; it should be from 3 to 1000", "the page of the pattern has the ranges"),
    misfit("[sheet]\ngenerate = { pattern = \"miura\", a = 1e300 }", "2:12", "`a` is 1e300; it should be above 0 and below 1000000", "the page of the pattern has the ranges"),
    misfit("[sheet]\ngenerate = { pattern = \"miura\", hight = 1 }", "2:12", "`miura` has no parameter `hight`", "expected one of `a`, `b`, `sector`, `fold`"),
    misfit("[sheet]\ngenerate = { pattern = \"crane\" }", "2:12", "there is no pattern `crane`", "there are `miura`, `miura-patch`, "),
    misfit("[sheet]\ngenerate = { fold = 0.1 }", "2:12", "the table names no pattern: `pattern` is missing", "there are `miura`, "),
    misfit("[sheet]\nmesh = \"star.fold\"\ncells = [40000, 40000]", "3:9", "the model has 6400000000 vertices", "at most 30000000 can be indexed"),
    misfit("[sheet]\nmesh = \"finite.fold\"\ndomain = \"tube\"\nseam = [0, 8]", "3:10", "the mesh has no lattice", "a finite sheet has domain \"patch\""),
    misfit("[sheet]\nmesh = \"star.fold\"\ndomain = \"tube\"\nseam = [0, 1]", "4:8", "no tube along [0, 1]: rolled up as far as it goes", "give a longer seam, or roll it up the other way: inwards = false"),
    misfit("[sheet]\ngenerate = { pattern = \"eggbox\" }\ndomain = \"tube\"\nseam = [0, 8]", "4:8", "curvatures do not name a mode of this sheet", "a tube is made of a periodic sheet that is drawn folded"),
    misfit("[sheet]\ngenerate = { pattern = \"random\", size = [2, 2] }\ndomain = \"tube\"\nseam = [0, 1]\ninwards = false", "4:8", "no tube along [0, 1]", "give a longer seam, or roll it up the other way: inwards = true"),
    // creases, vertices, cells
    misfit("[sheet]\nmesh = \"star.fold\"\n[[lock]]\ncrease = [0, 1, 3, 0]", "4:10", "the sheet has no crease [0, 1, 3, 0]", "the creases are [0, 1, 0, 0], "),
    misfit("[sheet]\nmesh = \"star.fold\"\n[[lock]]\ncrease = [0, 9, 0, 0]", "4:10", "the sheet has no crease [0, 9, 0, 0]", "the creases are [0, 1, 0, 0], "),
    misfit("[sheet]\nmesh = \"star.fold\"\n[[lock]]\ncrease = [0, 1, 0, 0]", "4:10", "no copy of the crease [0, 1, 0, 0] folds in a patch of 1 x 1 cells", "all of them are on its rim or beyond: lock a crease inside, or give more `cells`"),
    misfit("[sheet]\nmesh = \"finite.fold\"\n[[lock]]\ncrease = [1, 2, 0, 0]", "4:10", "the sheet has no crease [1, 2, 0, 0]", "the creases are [0, 1, 0, 0], "),
    misfit("[sheet]\ngenerate = { pattern = \"miura\" }\n[[lock]]\ncrease = [0, 3, 0, 0]", "4:10", "the sheet has no crease [0, 3, 0, 0]", "the creases are [0, 1, 0, 0], "),
    misfit("[sheet]\nmesh = \"star.fold\"\ncells = [2, 2]\n[[pin]]\nvertex = 4", "5:10", "there is no vertex 4", "the vertices of a cell are 0 to 3"),
    misfit("[sheet]\nmesh = \"star.fold\"\ncells = [2, 2]\n[[load]]\nvertex = 7\nforce = [0, 0, 1]", "5:10", "there is no vertex 7", "the vertices of a cell are 0 to 3"),
    misfit("[sheet]\nmesh = \"finite.fold\"\ncells = [2, 2]\n[[pin]]\nvertex = 4\ncell = [1, 0]", "6:8", "there is no cell [1, 0]", "the cells are [0, 0] to [0, 0]"),
    // loads
    misfit("[sheet]\nmesh = \"finite.fold\"\n[[load]]\nweight = [0, 0, -1]", "4:10", "the sheet has weight and no mass", "give mass = { area = 1.0 }, a mass per area, or { vertex = 1.0 }"),
    misfit("mass = { vertex = 1.0 }\n[sheet]\nmesh = \"star.fold\"\ndomain = \"torus\"\n[[load]]\nweight = [0, 0, -1]", "6:10", "only a patch has weight", "give domain = \"patch\""),
    // what yields
    misfit("[sheet]\nmesh = \"finite.fold\"\n[energy]\ncreases = { stiffness = inf, yield = { moment = 1.0 } }", "4:38", "what is rigid does not yield", "give the term a finite stiffness"),
    misfit("[sheet]\nmesh = \"finite.fold\"\n[energy]\nbars = { stiffness = 1.0, yield = { force = 1.0 }, law = { kind = \"green-lagrange\" } }", "4:35", "the term has a law and yields at once", "leave out `law`: what yields is linear up to there"),
    misfit("[sheet]\nmesh = \"finite.fold\"\n[[pressure]]\nvalue = 1.0", "3:1", "faces are under pressure and enclose no volume: at the side between vertices 1 and 2 they do not close", "a pressure has a potential where its faces enclose a volume: name faces that close, or pin their rim"),
    misfit("[sheet]\nmesh = \"finite.fold\"\n[[pressure]]\nvalue = 1.0\nfaces = [0, 9]", "5:9", "there is no face 9", "the faces of the mesh are 0 to 3"),
    misfit("[sheet]\nmesh = \"star.fold\"\ndomain = \"torus\"\n[[pressure]]\nvalue = 1.0", "4:1", "only faces of a patch have a pressure", "give domain = \"patch\""),
    misfit("[sheet]\nmesh = \"finite.fold\"\n[[load]]\nvertex = 0\nforce = [0.0, 0.5, 0.0]", "5:9", "the loads push the whole sheet along y with a force of 0.5", "balance the loads, or pin a vertex along that axis"),
    misfit("[sheet]\nmesh = \"finite.fold\"\n[[pin]]\nvertex = 0\naxes = \"xy\"\n[[load]]\nvertex = 1\nforce = [1, 1, 1]", "8:9", "the loads push the whole sheet along z with a force of 1", "balance the loads, or pin a vertex along that axis"),
    // rest angles
    misfit("[sheet]\ngenerate = { pattern = \"miura\" }\n[energy]\ncreases = { stiffness = 1, rest = { mode = [1, 0, 0], amplitude = 0.1 } }", "4:44", "", "name the mode by its rates: { rates = \"file.csv\" }"),
    misfit("[sheet]\nmesh = \"finite.fold\"\n[energy]\ncreases = { stiffness = 1, rest = { mode = [1, 0, 0], amplitude = 0.1 } }", "4:44", "", "name the mode by its rates: { rates = \"file.csv\" }"),
    misfit("[sheet]\nmesh = \"star.fold\"\n[energy]\ncreases = { stiffness = 1, rest = { file = \"one.csv\" } }", "4:44", "FOLDER/one.csv has no row for crease [", "give one row for each crease"),
    misfit("[sheet]\nmesh = \"star.fold\"\n[energy]\ncreases = { stiffness = 1, rest = { mode = { rates = \"rates.csv\" }, amplitude = 0.1 } }", "4:54", "FOLDER/rates.csv has no row for crease [", "give one row for each crease"),
];

fn folder_of_misfits() -> Folder {
    Folder::new()
        .with("star.fold", include_str!("../../../meshes/open-star.fold"))
        .with("finite.fold", FINITE)
        .with("finite.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        .with("sheet.vtu", "")
        .with("one.csv", "i,j,n1,n2,angle\n0,1,0,0,0.1\n")
        .with("rates.csv", "i,j,n1,n2,rate\n0,1,0,0,0.1\n")
        .with("strange.csv", "i,j,n1,n2,angle\n0,1,0,0,0.1\n0,1,5,0,0.1\n")
        .with("far.csv", "cell1,cell2,i,j,n1,n2,angle\n7,7,0,1,0,0,0.1\n")
        .with("torn.fold", "{ \"vertices_coords\": [[0,0,0],\n")
}

/// Returns the error, the message and the help for a scene that does not fit its sheet; the folder is written as
/// FOLDER.
fn misfit_of(folder: &std::path::Path, text: &str) -> (SceneError, String, String) {
    let file = parse(text, folder.join("scene.toml")).expect("the scene alone is right");
    let Err(error) = foldwell::scene::build::assembly(&file) else { panic!("the sheet should refuse:\n{text}") };
    let plain = |text: String| text.replace(&folder.display().to_string(), "FOLDER");
    let (message, help) = (plain(error.to_string()), error.help().map(|help| help.to_string()).unwrap_or_default());
    (error, message, help)
}

/// Claim: faults that only the sheet shows are refused with the position in the scene, the expected message and help.
#[test]
fn every_misfit_has_its_message() {
    let folder = folder_of_misfits();
    let mut wrong = Vec::new();
    for Misfit { text, at, message, help } in MISFITS {
        let (error, found, found_help) = misfit_of(folder.path(), text);
        assert!(matches!(error, SceneError::At { .. }), "{text}: {found}");
        assert!(fancy(&error).contains("scene.toml"));
        let expected = format!("FOLDER/scene.toml:{at}: {message}");
        if !found.starts_with(&expected) || !found_help.starts_with(help) {
            wrong.push(format!("{text}\nexpected {expected} ({help})\nfound    {found} ({found_help})"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// Claim: a mode that is not determined by its curvature is refused with the reason: Miura-ori has one mode if its
/// polygons are rigid, and three, with a singular map to curvatures, if they bend; a finite sheet has no lattice. The
/// remedy is given once.
#[test]
fn modes_that_no_curvature_names() {
    let folder = folder_of_misfits();
    let mode = "creases = { stiffness = 1, rest = { mode = [1, 0, 0], amplitude = 0.1 } }";
    let of =
        |sheet: &str, more: &str| misfit_of(folder.path(), &format!("[sheet]\n{sheet}\n[energy]\n{mode}\n{more}\n")).1;
    let rigid = of("generate = { pattern = \"miura\" }", "");
    assert!(rigid.contains("this sheet has 1 ("), "{rigid}");
    let bending = of("generate = { pattern = \"miura\" }", "facets = { stiffness = 1 }");
    assert!(bending.contains("not one to one"), "{bending}");
    let finite = of("mesh = \"finite.fold\"", "");
    assert!(finite.contains("lattice"), "{finite}");
    for message in [rigid, bending] {
        assert!(!message.contains("rates"), "{message}");
    }
}

/// Claim: a fault in a file that the scene names is reported with that file, and with the line if there is one.
#[test]
fn faults_of_named_files_name_the_file() {
    let folder = folder_of_misfits();
    let rest = |name: &str| {
        format!(
            "[sheet]\nmesh = \"star.fold\"\n[energy]\ncreases = {{ stiffness = 1, rest = {{ file = \"{name}\" }} }}\n"
        )
    };
    let mesh = |name: &str| format!("[sheet]\nmesh = \"{name}\"\n");
    let cases = [
        (mesh("none.fold"), "FOLDER/scene.toml:2:8: there is no file FOLDER/none.fold"),
        (mesh(""), "FOLDER/scene.toml:2:8: FOLDER/ is a folder"),
        (mesh("."), "FOLDER/scene.toml:2:8: FOLDER/. is a folder"),
        (mesh("torn.fold"), "FOLDER/torn.fold:"),
        (rest(""), "FOLDER/scene.toml:4:44: FOLDER/ is a folder"),
        (rest("."), "FOLDER/scene.toml:4:44: FOLDER/. is a folder"),
        (rest("none.csv"), "FOLDER/scene.toml:4:44: there is no file FOLDER/none.csv"),
        (rest("strange.csv"), "FOLDER/strange.csv:3: the sheet has no crease [0, 1, 5, 0]"),
        (rest("far.csv"), "FOLDER/far.csv:2: there is no crease [0, 1, 0, 0] in cell [7, 7]"),
        (rest("rates.csv"), "FOLDER/rates.csv:1: the header is `i,j,n1,n2,rate`, expected `i,j,n1,n2,angle`"),
    ];
    for (text, expected) in cases {
        let (_, message, _) = misfit_of(folder.path(), &text);
        assert!(message.starts_with(expected), "{message}");
    }
}

/// Claim: a study that is not possible is refused with its position before anything is written.
#[test]
fn studies_that_cannot_be_done() {
    let folder = folder_of_misfits().with("a.vtu", "no picture");
    let scene = |energy: &str, study: &str| {
        format!("[sheet]\nmesh = \"star.fold\"\n[energy]\n{energy}\n[[study]]\nname = \"a\"\n{study}\n")
    };
    let creases = "creases = { stiffness = 1 }";
    let of_tube = |study: &str| {
        let tube = "domain = \"tube\"\nseam = [0, 8]\n[energy]\nbars = { stiffness = 1e3 }";
        scene(creases, study).replace("[energy]", tube)
    };
    let cases = [
        (scene("", "kind = \"relax\""), "scene.toml:7:8: there is no energy to relax"),
        (
            scene("", "kind = \"relax\"").replace("mesh = \"star.fold\"", "generate = { pattern = \"miura\" }"),
            "no energy to relax",
        ),
        (
            scene(creases, "kind = \"modes\"\neigenvalues = 13"),
            "8:15: 13 eigenvalues are too many for a model of 12 coordinates",
        ),
        (
            scene(creases, "kind = \"surface\""),
            "scene.toml:7:8: a surface of folded states is drawn in the space of lattice strains",
        ),
        (
            scene(creases, "kind = \"trace\""),
            "scene.toml:7:8: trajectories of a patch of a periodic sheet are not known",
        ),
        (
            scene("", "kind = \"trace\"\nengine = \"both\"").replace("[energy]", "domain = \"screw\""),
            "scene.toml:7:8: the energy engine relaxes bars, and this scene has none",
        ),
        (
            scene("", "kind = \"trace\"\nstop = { crease_angle = { crease = [0, 1, 7, 0], angle = 1 } }")
                .replace("[energy]", "domain = \"screw\""),
            "the sheet has no crease [0, 1, 7, 0]",
        ),
        (
            scene(creases, "kind = \"bloch\"").replace("mesh = \"star.fold\"", "generate = { pattern = \"miura\" }"),
            "16 conditions (bars and rigid facets) for 12 coordinates of a cell",
        ),
        (of_tube("kind = \"surface\""), "scene.toml:10:8: the folded states of a tube are no surface"),
        (of_tube("kind = \"branches\""), "scene.toml:10:8: branches leave the drawn state, and a tube is another one"),
        (of_tube("kind = \"bloch\""), "scene.toml:10:8: wavenumbers around a closed tube are whole numbers"),
        (
            of_tube("kind = \"response\""),
            "scene.toml:10:8: strains and curvatures of a closed tube are fixed by its seam",
        ),
        (of_tube("kind = \"landscape\"\nmodes = [[1, 0, 0]]\namplitudes = [0.1]"), "scene.toml:10:8: a landscape is"),
        (
            of_tube("kind = \"wells\"\nrigid = true"),
            "scene.toml:10:8: the rigid states of a closed tube are single points",
        ),
        (scene(creases, "kind = \"relax\"\nstart = \"none.vtu\""), "none.vtu: "),
        (scene(creases, "kind = \"relax\"\nstart = \"a.vtu\""), "a.vtu: "),
    ];
    for (text, expected) in cases {
        folder.scene(text).refused(expected);
    }
}

fn fancy(error: &SceneError) -> String {
    let mut text = String::new();
    let handler = miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor());
    handler.render_report(&mut text, error).expect("writing to a string");
    text
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// A scene with a random replacement gives a result or an error that can be displayed.
    #[test]
    fn mutated_scenes_do_not_panic(
        start in 0..GOOD.len(),
        length in 0..40usize,
        new in prop_oneof![
            "\\PC{0,12}",
            r#"[0-9.,\[\]{}="a-z\n# -]{0,12}"#,
            Just("[[study]]\n".to_owned()),
            Just("nan".to_owned()),
            Just("-9223372036854775808".to_owned()),
            Just("\u{feff}\r\n".to_owned()),
        ],
    ) {
        let end = (start + length).min(GOOD.len());
        let text = format!("{}{new}{}", &GOOD[..start], &GOOD[end..]);
        if let Err(error) = parse(&text, "scene.toml") {
            prop_assert!(error.to_string().starts_with("scene.toml:"));
            prop_assert!(!fancy(&error).is_empty());
        }
    }
}
