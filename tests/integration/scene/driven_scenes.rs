//! Scenes with parts, drives and sets of vertices: what they mean, and what is refused, with the place of the fault.

use crate::common::{Folder, Scene};
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Drive, Driven, TermKind};
use foldwell::scene::{SceneError, build};
use foldwell::sheet::fold;
use miette::Diagnostic;

/// Four vertices of a square of side 1 at height 0 and one at height 0.5 in the middle, with names.
const ROOF: &str = r#"{ "file_spec": 1.2, "foldwell:names": { "rim": [0, 1, 2, 3], "top": [4] },
  "vertices_coords": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 0.5]],
  "faces_vertices": [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]] }"#;

/// Returns the assembly of a scene with the roof, or with another mesh, and these tables.
fn assembled(sheet: &str, tables: &str) -> Result<(foldwell::scene::SceneFile, Assembly), SceneError> {
    let energy = "[energy]\nbars = { stiffness = 1.0 }\ncreases = { stiffness = 0.1 }";
    Scene::on(sheet, &format!("{energy}\n{tables}")).with("roof.fold", ROOF).assembled()
}

fn on_roof(tables: &str) -> Result<(foldwell::scene::SceneFile, Assembly), SceneError> {
    assembled("mesh = \"roof.fold\"", tables)
}

/// Returns the vertices of a part with this set on the roof.
fn set(words: &str) -> Vec<usize> {
    let (_, assembly) = on_roof(&format!("[[part]]\nname = \"p\"\nfree = []\nvertices = {words}\n")).unwrap();
    assembly.terms().parts[0].vertices.clone()
}

/// Claim: every form of a set names the vertices that it says. Source: the coordinates of the roof, by hand.
#[test]
fn sets_of_vertices() {
    assert_eq!(set("[3, [1, 0, 0]]"), [3, 1]);
    assert_eq!(set("\"rim\""), [0, 1, 2, 3]);
    assert_eq!(set("{ where = { z = \"max\" } }"), [4]);
    assert_eq!(set("{ where = { x = \"min\", y = 1 } }"), [3]);
    assert_eq!(set("{ where = { z = 1e-7 } }"), [0, 1, 2, 3]);
    assert_eq!(set("{ box = [[0.4, 0.4, 0], [1, 1, 1]] }"), [2, 4]);
    assert_eq!(set("{ box = [[1, inf, 1], [0.4, 0.6, -1]] }"), [2]);
}

/// Claim: on a patch of cells a set counts cells as the tiling does, and `where` looks at the whole patch.
#[test]
fn sets_on_cells() {
    let sheet = "generate = { pattern = \"miura\" }\ncells = [3, 2]";
    let (_, assembly) = assembled(
        sheet,
        "[[pin]]\nvertices = [[1, 2, 1]]\n[[pin]]\nvertices = { where = { x = \"max\" } }\naxes = \"x\"\n",
    )
    .unwrap();
    let count = assembly.sheet().vertices.len();
    let (terms, positions) = (assembly.terms(), &assembly.tiling().positions);
    assert_eq!(terms.pins[0], ((3 + 2) * count + 1, [true; 3]));
    let largest = positions.iter().map(|x| x.x).fold(f64::MIN, f64::max);
    let there: Vec<usize> = (0..positions.len()).filter(|&v| positions[v].x > largest - 1e-9).collect();
    let found: Vec<usize> =
        terms.pins.iter().filter(|(v, _)| positions[*v].x > largest - 1e-9).map(|pin| pin.0).collect();
    assert!(!there.is_empty() && there.iter().all(|v| found.contains(v)), "{there:?} {found:?}");
}

/// Claim: pins of one vertex are joined, a normal becomes a guide of unit length, a load on a set acts on each vertex.
#[test]
fn pins_guides_and_loads() {
    let tables = "[[pin]]\nvertices = \"rim\"\naxes = \"z\"\n[[pin]]\nvertices = { where = { x = 0 } }\naxes = \"x\"\n\
                  [[pin]]\nvertices = \"top\"\nnormal = [3, 0, 4]\n[[load]]\nvertices = [0, 1]\nforce = [0, 0, -2]\n";
    let (_, assembly) = on_roof(tables).unwrap();
    let terms = assembly.terms();
    let pins = [(0, true), (1, false), (2, false), (3, true)].map(|(vertex, x)| (vertex, [x, false, true]));
    assert_eq!(terms.pins, pins);
    assert_eq!(terms.guides.len(), 1);
    assert!(terms.guides[0].0 == 4 && (terms.guides[0].1 - Vec3::new(0.6, 0.0, 0.8)).norm() < 1e-15);
    assert_eq!(terms.loads, [(0, Vec3::new(0.0, 0.0, -2.0)), (1, Vec3::new(0.0, 0.0, -2.0))]);
}

const PARTS: &str = "[[part]]\nname = \"lid\"\nvertices = [0, 1, 2]\nfree = [\"z\", \"rz\"]\n";

/// Returns the drive of a scene with a part, a lock and a load.
fn drive(words: &str) -> Drive {
    let lock = "[[lock]]\ncrease = [0, 4, 0, 0]\n[[load]]\nvertex = 4\nforce = [0, 0, 0]\n";
    let (file, assembly) = on_roof(&format!("{PARTS}{lock}[[drive]]\nname = \"d\"\n{words}\n")).unwrap();
    build::drive(&file, &assembly, "d").unwrap()
}

/// Claim: every kind of drive is read as what it says.
#[test]
fn drives() {
    let part = drive("part = \"lid\"\naxis = \"rz\"\nto = 1");
    assert_eq!(part, Drive { quantity: Driven::Part { part: 0, axis: 5 }, to: 1.0 });
    assert_eq!(drive("part = \"lid\"\naxis = \"rz\"\nto = \"90 deg\"").to, std::f64::consts::FRAC_PI_2);
    let up = drive("vertices = \"top\"\naxis = \"z\"\nto = -0.5");
    assert_eq!(up, Drive { quantity: Driven::Vertices { vertices: vec![4], direction: Vec3::z() }, to: -0.5 });
    let Driven::Vertices { direction, .. } = drive("vertices = [3]\naxis = [0, 3, 4]\nto = 1").quantity else {
        panic!()
    };
    assert!((direction - Vec3::new(0.0, 0.6, 0.8)).norm() < 1e-15);
    assert_eq!(drive("load = true\nto = 0.0").quantity, Driven::Loads);
    assert_eq!(drive("rest = true\nto = 1").quantity, Driven::Rest);
    let stiff = drive("stiffness = \"bars\"\nto = inf");
    assert_eq!(stiff, Drive { quantity: Driven::Stiffness(TermKind::Bars), to: f64::INFINITY });
    let Driven::Lock(edges) = drive("lock = [4, 0, 0, 0]\nto = 1.5").quantity else { panic!() };
    assert_eq!(edges.len(), 1);
}

/// Returns position, message and help of a refusal; the position counts lines of the tables from 1.
fn refusal(sheet: &str, tables: &str) -> (usize, String, String) {
    let error = assembled(sheet, tables).expect_err(tables);
    let help = error.help().map(|help| help.to_string()).unwrap_or_default();
    let SceneError::At { line, message, .. } = error else { panic!("{error}") };
    (line - 4 - sheet.lines().count(), message, help)
}

/// Checks that each of these tables is refused at its line, with this message and this help.
fn assert_refused(cases: &[(String, usize, &str, &str)]) {
    for (tables, line, message, help) in cases {
        let found = refusal("mesh = \"roof.fold\"", tables);
        assert!(found.0 == *line && found.1.contains(message) && found.2.contains(help), "{tables}\n{found:?}");
    }
}

fn with_part(more: &str) -> String {
    format!("{PARTS}{more}")
}

fn with_drive(more: &str) -> String {
    format!("[[drive]]\nname = \"d\"\n{more}")
}

/// Claim: each fault in a set of vertices, a pin or a load is refused at its line, with what would be right.
#[test]
#[rustfmt::skip]
fn faults_of_sets() {
    assert_refused(&[
        ("[[pin]]\nvertices = \"rmi\"".to_owned(), 2, "the mesh names no vertices `rmi`", "did you mean `rim`? there are `rim`, `top`"),
        ("[[pin]]\nvertices = [7]".into(), 2, "there is no vertex 7", "the vertices of a cell are 0 to 4"),
        ("[[pin]]\nvertices = [[1, 1, 0]]".into(), 2, "there is no cell [1, 0]", "[0, 0]"),
        ("[[pin]]\nvertices = [1, 2, 1]".into(), 2, "vertex 1 is listed twice", "once"),
        ("[[pin]]\nvertices = []".into(), 2, "this set has no vertices", "z from 0.000000 to 0.500000"),
        ("[[pin]]\nvertices = { where = { z = 3 } }".into(), 2, "this set has no vertices", "z from 0.000000 to 0.500000"),
        ("[[pin]]\nvertices = { where = {} }".into(), 2, "`where` is empty", "one or more of x, y, z"),
        ("[[pin]]\nvertices = { where = { z = \"top\" } }".into(), 2, "\"top\"", "\"min\", \"max\" or a finite number"),
        ("[[pin]]\nvertices = {}".into(), 2, "the table is empty", "where"),
        ("[[pin]]\nvertices = { box = [[0, 0, nan], [1, 1, 1]] }".into(), 2, "not a number", "[[x, y, z], [x, y, z]]"),
        ("[[pin]]\nvertices = 3".into(), 2, "the value is `3`", "a list of vertices"),
        ("[[pin]]\nvertices = [-1]".into(), 2, "the value is `-1`", "counted from 0"),
        ("[[pin]]\naxes = \"z\"".into(), 1, "the pin names no vertex", "vertices = [..]"),
        ("[[pin]]\nvertex = 1\nvertices = [2]".into(), 3, "both `vertex` and `vertices`", "vertex = n"),
        ("[[load]]\nvertices = [2]\ncell = [0, 0]\nforce = [0, 0, 1]".into(), 3, "`cell` belongs to `vertex`", "[v, c1, c2]"),
        ("[[pin]]\nvertex = 1\nnormal = [0, 0, 0]".into(), 3, "the normal is zero", "[0, 0, 1]"),
        ("[[pin]]\nvertex = 1\naxes = \"z\"\nnormal = [0, 0, 1]".into(), 4, "both `axes` and `normal`", "one direction"),
        ("[[pin]]\nvertex = 1\n[[pin]]\nvertices = [1]\nnormal = [0, 0, 1]".into(), 5, "vertex 1 is held twice", "once"),
    ]);
}

/// Claim: each fault in a part is refused at its line, with what would be right.
#[test]
#[rustfmt::skip]
fn faults_of_parts() {
    assert_refused(&[
        (with_part(PARTS), 6, "two parts have the name `lid`", "line"),
        (with_part("[[part]]\nname = \"b\"\nvertices = [2, 3, 4]"), 7, "vertex 2 of part `b` is in part `lid` too", "one part at most"),
        (with_part("[[pin]]\nvertex = 1"), 3, "vertex 1 of part `lid` is pinned", "`free`"),
        (with_part("[[pin]]\nvertex = 1\nnormal = [1, 1, 0]"), 3, "vertex 1 of part `lid` is pinned", "`free`"),
        ("[[part]]\nname = \"b\"\nvertices = [2, 3]".into(), 3, "lie on a line", "free"),
        ("[[part]]\nname = \"b\"\nvertices = [2, 3]\nfree = [\"x\", \"rx\"]".into(), 4, "lie on a line", "free"),
        ("[[part]]\nname = \"b\"\nvertices = [4]\nfree = [\"rx\"]".into(), 4, "lie on a line", "free"),
        ("[[part]]\nname = \"b\"\nvertices = [2, 3]\nfree = [\"w\"]".into(), 4, "`w` is no motion", "\"rz\""),
        ("[[part]]\nname = \"b\"\nvertices = [2, 3]\nfree = [\"z\", \"z\"]".into(), 4, "`z` is no motion, or is listed twice", "once"),
        ("[[part]]\nname = \"b c\"\nvertices = [2, 3]".into(), 2, "`b c` is not a name", "letters"),
        ("[[part]]\nvertices = [0, 1, 2]".into(), 1, "missing key `name`", ""),
        ("[[part]]\nname = 3\nvertices = [0, 1, 2]".into(), 2, "the value is `3`", ""),
        ("[[part]]\nname = \"b\"".into(), 1, "missing key `vertices`", ""),
        ("[[part]]\nname = \"b\"\nvertices = \"rmi\"".into(), 3, "the mesh names no vertices `rmi`", "`rim`"),
        ("[[part]]\nname = \"b\"\nvertices = [9]".into(), 3, "there is no vertex 9", "0 to 4"),
        ("[[part]]\nname = \"b\"\nvertices = [0, 1, 2]\nfree = \"z\"".into(), 4, "the value is \"z\"", ""),
        ("[[part]]\nname = \"b\"\nvertices = [0, 1, 2]\nfree = [1]".into(), 4, "the value is `1`", ""),
        ("[[part]]\nname = \"b\"\nvertices = [0, 1, 2]\naxis = \"z\"".into(), 4, "unknown key `axis`", ""),
    ]);
}

/// Claim: each fault in a drive is refused at its line, with what would be right.
#[test]
#[rustfmt::skip]
fn faults_of_drives() {
    assert_refused(&[
        (with_drive("to = 1"), 2, "the drive drives nothing", "one of part, vertices"),
        (with_drive("load = true\nrest = true\nto = 1"), 4, "the drive drives two quantities", "one of part"),
        (with_drive("load = false\nto = 1"), 3, "false drives nothing", "true"),
        (with_drive("load = true\nto = 1"), 3, "the scene has no loads to drive", "[[load]]"),
        (with_drive("part = \"lit\"\naxis = \"z\"\nto = 1"), 3, "no part is called `lit`", "no [[part]]"),
        (with_part(&with_drive("part = \"lit\"\naxis = \"z\"\nto = 1")), 7, "no part is called `lit`", "did you mean `lid`? there are `lid`"),
        (with_part(&with_drive("part = \"lid\"\naxis = \"x\"\nto = 1")), 8, "part `lid` is held in \"x\"", "add \"x\""),
        (with_part(&with_drive("part = \"lid\"\naxis = [0, 0, 1]\nto = 1")), 8, "a direction as the axis of a part", "\"rz\""),
        (with_part(&with_drive("part = \"lid\"\nto = 1")), 6, "the drive has no axis", "axis = \"z\""),
        (with_part(&with_drive("vertices = [1]\naxis = \"z\"\nto = 1")), 7, "vertex 1 is in part `lid`", "part = \"lid\""),
        (with_drive("vertices = [1]\naxis = \"rz\"\nto = 1"), 4, "a rotation as the axis of vertices", "[[part]]"),
        (with_drive("vertices = [1]\naxis = [0, 0, 0]\nto = 1"), 4, "the direction is zero", "[x, y, z]"),
        (with_drive("vertices = [1]\naxis = \"z\"\nto = 0"), 5, "ends where it begins", "from where a path begins"),
        (with_drive("vertices = [1]\naxis = \"z\"\nto = inf"), 5, "the number is inf", "finite"),
        (format!("[[pin]]\nvertex = 1\naxes = \"z\"\n{}", with_drive("vertices = [1]\naxis = [0, 1, 1]\nto = 1")), 6, "vertex 1 is pinned along the axis", "leave out the pin"),
        (with_drive("rest = true\naxis = \"z\"\nto = 1"), 4, "`axis` belongs to `part` or `vertices`", "leave it out"),
        (with_drive("lock = [0, 4, 0, 0]\nto = 1"), 3, "crease [0, 4, 0, 0] is not locked", "[[lock]]"),
        (format!("[[lock]]\ncrease = [0, 4, 0, 0]\nangle = 0.5\n{}", with_drive("lock = [0, 4, 0, 0]\nto = 0.5")), 7, "locked at 0.5 already", "another angle"),
        (with_drive("stiffness = \"facets\"\nto = 1"), 3, "the sheet has no facets", "[energy]"),
        (with_drive("stiffness = \"bars\"\nto = \"60 deg\""), 4, "an angle at the end of a drive that turns nothing", "a number"),
        (with_drive("vertices = [1]\naxis = \"z\"\nto = \"60 deg\""), 5, "an angle at the end of a drive that turns nothing", "a number"),
        (with_part(&with_drive("part = \"lid\"\naxis = \"z\"\nto = \"1 rad\"")), 9, "an angle at the end of a drive that turns nothing", "a number"),
        (with_part(&with_drive("part = \"lid\"\naxis = \"rz\"\nto = \"1 turn\"")), 9, "this is no end of a drive", "60 deg"),
        (format!("[[lock]]\ncrease = [0, 4, 0, 0]\n{}", with_drive("lock = [0, 4, 0, 0]\nto = 60")), 6, "the angle 60 is beyond pi", "did you mean \"60 deg\""),
        (with_drive("stiffness = \"bars\"\nto = 0"), 4, "the stiffness is 0", "positive"),
        (with_drive("stiffness = \"plates\"\nto = 1"), 3, "unknown word `plates`", "bars"),
        (with_drive("stiffness = \"creases\"\nto = inf"), 4, "only bars are driven to exactly rigid", "finite"),
        ("[[drive]]\nrest = true\nto = 1".into(), 1, "missing key `name`", ""),
        ("[[drive]]\nname = \"d e\"\nrest = true\nto = 1".into(), 2, "`d e` is not a name", "letters"),
        (with_drive("rest = true"), 1, "missing key `to`", ""),
        (with_drive("rest = true\nto = \"a\""), 4, "this is no end of a drive", "expected a number"),
        (with_drive("rest = true\nto = nan"), 4, "NaN", ""),
        (with_drive("rest = true\nto = 1\nfrom = 0"), 5, "unknown key `from`", ""),
        (with_drive("rest = \"flat\"\nto = 1"), 3, "the value is \"flat\"", ""),
        (with_drive("load = 1\nto = 1"), 3, "the value is `1`", ""),
        (with_drive("part = 1\naxis = \"z\"\nto = 1"), 3, "the value is `1`", ""),
        (with_drive("vertices = [9]\naxis = \"z\"\nto = 1"), 3, "there is no vertex 9", "0 to 4"),
        (with_drive("vertices = [3]\nto = 1"), 2, "the drive has no axis", ""),
        (with_drive("vertices = [3]\naxis = \"w\"\nto = 1"), 4, "the value is \"w\"", ""),
        (with_drive("vertices = [3]\naxis = [0, 1]\nto = 1"), 4, "the list has 2 values", ""),
        (with_drive("vertices = [3]\naxis = [0, 0, nan]\nto = 1"), 4, "NaN", ""),
        (with_drive("lock = [0, 4]\nto = 1"), 3, "the list has 2 values", ""),
        (with_drive("lock = [0, 4, 0, 0.5]\nto = 1"), 3, "the value is `0.5`", ""),
        (with_drive("stiffness = 3\nto = 1"), 3, "", ""),
        (with_drive("stiffness = \"bars\"\nto = nan"), 4, "NaN", "positive"),
        (format!("{}\n{}", with_drive("rest = true\nto = 1"), with_drive("rest = true\nto = 2")), 6, "two drives have the name `d`", "line"),
    ]);
}

/// Claim: parts and driven vertices are for patches; locks, rest angles and stiffnesses are driven on every sheet.
#[test]
fn patches_only() {
    let vertices = "[[drive]]\nname = \"d\"\nvertices = [0]\naxis = \"z\"\nto = 1";
    for domain in ["screw", "torus"] {
        let sheet = format!("generate = {{ pattern = \"miura\" }}\ndomain = \"{domain}\"");
        for (tables, at) in [(PARTS, 2), (vertices, 4)] {
            let (line, message, help) = refusal(&sheet, tables);
            assert!(line == at && message.contains("is no patch") && help.contains("\"patch\""), "{line} {message}");
        }
        for tables in ["rest = true\nto = 1", "stiffness = \"bars\"\nto = 2"] {
            assert!(assembled(&sheet, &format!("[[drive]]\nname = \"d\"\n{tables}")).is_ok(), "{tables}");
        }
    }
}

/// Claim: paths name a drive where there are several, and a patch has no curvature to stop at; a path starts where an
/// earlier study ended.
#[test]
fn studies() {
    let two = "[[drive]]\nname = \"a\"\nrest = true\nto = 1\n[[drive]]\nname = \"b\"\nstiffness = \"bars\"\nto = 2\n";
    let study = |more: &str| format!("{two}[[study]]\nname = \"s\"\nkind = \"path\"\n{more}\n");
    let cases = [
        (study(""), 11, "there are 2 drives, and this path names none", "give `drive`; there are `a`, `b`"),
        (study("drive = \"c\""), 12, "no drive is called `c`", "there are `a`, `b`"),
        (
            study("drive = \"a\"\nstop = { curvature = 1 }"),
            13,
            "a path of this sheet does not stop at a curvature",
            "arc length",
        ),
        (study("drive = \"b\"").replace(two, ""), 3, "a path follows a drive, and there is none", "add a [[drive]]"),
        (study("drive = \"a\"\nstop = {}"), 13, "no condition to stop at", "arc_length"),
        (study("drive = \"a\"\nstart = \"t\""), 13, "no earlier study is called `t`", "earlier study"),
        (
            study("drive = \"a\"\nstop = { crease_angle = { crease = [0, 1, 0, 0], angle = 60 } }"),
            13,
            "the angle 60 is beyond pi",
            "did you mean \"60 deg\"",
        ),
    ];
    for (tables, line, message, help) in cases {
        let found = refusal("mesh = \"roof.fold\"", &tables);
        assert!(found.0 == line && found.1.contains(message) && found.2.contains(help), "{tables}\n{found:?}");
    }
    let after = study("drive = \"a\"\nstart = \"t\"")
        .replace("[[study]]", "[[study]]\nname = \"t\"\nkind = \"relax\"\n[[study]]");
    assert!(on_roof(&after).is_ok());
}

/// Claim: what a guide, a held part or a driven vertex keeps supports loads along it, and nothing else does.
#[test]
fn supported_loads() {
    let load = "[[load]]\nvertex = 4\nforce = [0, 0, -1]\n";
    let along = |normal: &str| format!("{load}[[pin]]\nvertex = 0\nnormal = {normal}\n");
    let held = |free: &str| format!("{load}[[part]]\nname = \"p\"\nvertices = \"rim\"\nfree = {free}\n");
    let driven = |axis: &str| format!("{load}[[drive]]\nname = \"d\"\nvertices = [0]\naxis = {axis}\nto = 1\n");
    for supported in [along("[0, 0, 1]"), held("[]"), held("[\"x\", \"y\"]"), driven("\"z\"")] {
        assert!(on_roof(&supported).is_ok(), "{supported}");
    }
    for slides in [load.to_owned(), along("[0, 1, 1]"), along("[1, 0, 0]"), held("[\"z\"]"), driven("\"x\"")] {
        let (_, message, _) = refusal("mesh = \"roof.fold\"", &slides);
        assert!(message.contains("push the whole sheet"), "{slides}: {message}");
    }
    let both = format!("{}[[pin]]\nvertex = 1\nnormal = [0, -1, 2]\n", along("[0, 1, 1]"));
    assert!(on_roof(&both).is_ok(), "two inclined planes carry a load between them");
}

/// Claim: loads have to balance on each connected piece that nothing holds; pins, springs and drives hold the piece that they
/// act on and no other. Source: a free body under a force has no equilibrium.
#[test]
fn loads_balance_on_each_piece() {
    let roofs = "{\"vertices_coords\": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.3], [5, 0, 0], [6, 0, 0], [5, 1, 0], [6, 1, 0.3]], \
                 \"faces_vertices\": [[0, 1, 2], [1, 3, 2], [4, 5, 6], [5, 7, 6]]}";
    let text =
        |tables: &str| format!("[energy]\nbars = {{ stiffness = 1.0 }}\ncreases = {{ stiffness = 0.1 }}\n{tables}");
    let said = |tables: &str| {
        let scene = Scene::on("mesh = \"roofs.fold\"", &text(tables)).with("roofs.fold", roofs);
        scene.assembled().err().map(|error| error.to_string())
    };
    let load = |vertex: usize, force: f64| format!("[[load]]\nvertex = {vertex}\nforce = [0, 0, {force:?}]\n");
    let pin = |vertex: usize| format!("[[pin]]\nvertex = {vertex}\n");
    let drive = |vertex: usize| format!("[[drive]]\nname = \"d\"\nvertices = [{vertex}]\naxis = \"z\"\nto = 1\n");
    let spring = "[[spring]]\nvertices = [3, 7]\nstiffness = 1.0\n";
    let free = [
        load(0, 0.1) + &load(4, -0.1),
        pin(0) + &load(7, 0.1),
        drive(0) + &load(7, 0.1),
        pin(0) + "[mass]\nvertex = 1.0\n[[load]]\nweight = [0, 0, -1]\n",
    ];
    for tables in free {
        let message = said(&tables).unwrap_or_else(|| panic!("{tables}"));
        assert!(message.contains("push the piece of the sheet with vertex"), "{tables}: {message}");
    }
    let held = [
        load(0, 0.1) + &load(3, -0.1),
        pin(4) + &load(7, 0.1),
        drive(4) + &load(7, 0.1),
        pin(0) + &load(7, 0.1) + spring,
    ];
    for tables in held {
        assert_eq!(said(&tables), None, "{tables}");
    }
}

/// Claim: the names of a mesh are in its copies that `convert` writes.
#[test]
fn names_are_converted() {
    let folder = Folder::new().with("roof.fold", ROOF);
    let [from, to] = ["roof.fold", "copy.fold"].map(|name| folder.file(name));
    let notes = foldwell::run::convert(&from, &to, None, None).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    assert_eq!(fold::read(&to).unwrap().names, fold::read(&from).unwrap().names);
}

/// Claim: studies that cannot begin are refused before anything is computed or written: relaxations whose loads only a
/// drive supports, drives that end where they begin, driven stiffnesses that are not one number, paths without energy,
/// paths from random displacements, and studies other than relax, path and wells with rigid parts or pins along a
/// direction.
#[test]
fn studies_that_cannot_begin() {
    let energy = "[energy]\nbars = { stiffness = 1.0 }\n";
    let load = "[[load]]\nvertex = 4\nforce = [0, 0, -1]\n";
    let up = with_drive("vertices = [0]\naxis = \"z\"\nto = 1\n");
    let factor = format!("[[pin]]\nvertex = 0\n{}", with_drive("load = true\nto = 0\n"));
    let study = |keys: &str| format!("[[study]]\nname = \"a\"\n{keys}\n");
    let path = study("kind = \"path\"");
    let cases = [
        (format!("{energy}{load}{up}{}", study("kind = \"relax\"")), "only a drive supports the loads"),
        (format!("{energy}{load}{factor}{path}"), "the path of study `a` ends where it begins"),
        (
            format!("{energy}{}{path}", with_drive("stiffness = \"bars\"\nto = 1\n")),
            "the driven stiffness is 1 at the beginning already",
        ),
        (
            format!("[energy]\nbars = {{ stiffness = inf }}\n{}{path}", with_drive("stiffness = \"bars\"\nto = inf\n")),
            "the driven stiffness is inf at the beginning already",
        ),
        (
            format!(
                "[energy]\nbars = {{ stiffness = {{ V = 1, B = 2, M = 1, F = 1 }} }}\n{}{path}",
                with_drive("stiffness = \"bars\"\nto = 3\n")
            ),
            "the bars do not all have the same stiffness",
        ),
        (format!("{up}{path}"), "there is no energy whose equilibria a path could follow"),
        (
            format!("{energy}{up}{}", study("kind = \"path\"\nstart = { random = 0.1, seed = 1 }")),
            "a path does not start there",
        ),
        (
            format!("{energy}{PARTS}{}", study("kind = \"branches\"")),
            "studies of kind branches do not know rigid parts",
        ),
        (
            format!("{energy}[[pin]]\nvertex = 0\nnormal = [0, 0, 1]\n{}", study("kind = \"branches\"")),
            "studies of kind branches do not know pins along a direction",
        ),
    ];
    for (tables, message) in cases {
        Scene::on("mesh = \"roof.fold\"", &tables).with("roof.fold", ROOF).refused(message);
    }
}

/// Claim: a driven lock of a crease that no motion folds is refused: its angle has no rate. Source: the crease runs
/// straight through the period of a strip, so that both faces have the same normal in every state.
#[test]
fn creases_that_cannot_fold_are_not_driven() {
    let strip = "{\"vertices_coords\": [[0, 0, 0], [0.3, 0.9, 0.2], [1, 0, 0], [1.3, 0.9, 0.2], [1.8, 1.7, 0], [0.8, 1.7, 0]], \
                 \"faces_vertices\": [[0, 2, 1], [2, 3, 1], [1, 3, 4], [1, 4, 5]], \
                 \"foldwell:lattice\": [[1, 0, 0], [0.8, 1.7, 0]]}";
    let text = "[energy]\nbars = { stiffness = 30.0 }\ncreases = { stiffness = 1.0 }\n[[lock]]\ncrease = [0, 1, 0, 0]\n\
                [[drive]]\nname = \"d\"\nlock = [0, 1, 0, 0]\nto = 2.0\n[[study]]\nname = \"p\"\nkind = \"path\"\ndraw = []";
    let said = Scene::on("mesh = \"strip.fold\"\ndomain = \"torus\"", text).with("strip.fold", strip).program("");
    assert!(said.status == Some(2) && said.err.contains("no motion of the sheet changes the angle"), "{}", said.err);
}
