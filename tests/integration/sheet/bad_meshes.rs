//! Malformed meshes: each is refused with file, line, fault and remedy, and no file makes the reader panic.

use crate::common::Folder;
use foldwell::sheet::{Assignment, Pattern, SheetError, fold, generate, obj};
use proptest::prelude::*;

/// The unit square of two triangles: vertices on lines 3 to 6, faces on lines 9 and 10, other keys from line 12.
const SQUARE: [&[&str]; 2] = [&["[0, 0, 0]", "[1, 0, 0]", "[1, 1, 0]", "[0, 1, 0]"], &["[0, 1, 2]", "[0, 2, 3]"]];
const UNIT_LATTICE: &str = "\"foldwell:lattice\": [[1, 0, 0], [0, 1, 0]]";

/// Returns a FOLD text with one vertex, face or other key on each line.
fn mesh(vertices: &[&str], faces: &[&str], others: &[&str]) -> String {
    let (vertices, faces) = (vertices.join(",\n"), faces.join(",\n"));
    let others: String = others.iter().map(|other| format!(", {other}\n")).collect();
    format!("{{\n\"vertices_coords\": [\n{vertices}\n],\n\"faces_vertices\": [\n{faces}\n]\n{others}}}\n")
}

fn square(others: &[&str]) -> String {
    mesh(SQUARE[0], SQUARE[1], others)
}

/// Returns a FOLD text without faces: vertices from line 3, edges from line `5 + vertices`.
fn wires(vertices: &[&str], edges: &[&str]) -> String {
    mesh(vertices, edges, &[]).replace("faces_vertices", "edges_vertices")
}

/// A text, the line of its fault, and a part of the message.
type Case = (String, usize, &'static str);

fn check(cases: Vec<Case>, name: &str, parse: fn(&str, &str) -> Result<foldwell::sheet::Sheet, SheetError>) {
    for (text, line, words) in cases {
        let message = match parse(&text, name) {
            Ok(_) => panic!("accepted, though it should say: {words}\n{text}"),
            Err(error) => error.to_string(),
        };
        assert!(message.starts_with(&format!("{name}:{line}:")), "line {line} is to blame: {message}\n{text}");
        assert!(message.contains(words), "it should say: {words}\nit says: {message}\n{text}");
    }
}

/// Claim: the meshes from which the cases below are made are valid, so that each case has exactly one fault.
#[test]
fn the_unspoilt_meshes_are_accepted() {
    fold::parse(&square(&[]), "good.fold").unwrap();
    fold::parse(&square(&[UNIT_LATTICE]), "good.fold").unwrap();
    fold::parse(&wires(SQUARE[0], &["[0, 1]", "[1, 2]", "[2, 3]", "[3, 0]", "[0, 2]"]), "good.fold").unwrap();
    fold::parse(&ring(&[RING_HOLE]), "good.fold").unwrap();
    let angles = ["\"edges_vertices\": [[0, 2], [0, 1]]", "\"edges_foldAngle\": [0.0, null]"];
    fold::parse(&square(&angles), "good.fold").unwrap();
    obj::parse(OBJ, "good.obj").unwrap();
}

/// Claim: a text that is not FOLD, or has values of a wrong type, is refused at the value.
#[test]
fn wrong_texts_and_types() {
    let cases = vec![
        ("".into(), 1, "not a FOLD file: EOF while parsing"),
        ("[1, 2]".into(), 1, "a FOLD file is one JSON object"),
        (square(&[]).replace("],\n[1, 1", "]\n[1, 1"), 5, "not a FOLD file: expected `,` or `]`"),
        (square(&[]).replace("[1, 1, 0]", "[1, NaN, 0]"), 5, "not a FOLD file: expected value"),
        (square(&["\"faces_vertices\": []"]), 12, "duplicate field `faces_vertices`"),
        ("{\n\"file_title\": 3\n}".into(), 2, "`file_title` is `3`; it should be a text in quotes"),
        ("{\n}".into(), 1, "`vertices_coords` is missing"),
        ("{\n\"vertices_coords\": {}\n}".into(), 2, "`vertices_coords` is `{}`; it should be a list of points"),
        (
            square(&[]).replace("[1, 1, 0]", "[1, \"1\", 0]"),
            5,
            "a coordinate of vertex 2 is `\"1\"`; it should be a finite",
        ),
        (
            square(&[]).replace("[1, 1, 0]", "[1, 1e999, 0]"),
            5,
            "a coordinate of vertex 2 is `1e999`; it should be a finite",
        ),
        (square(&[]).replace("[1, 1, 0]", "[1, null, 0]"), 5, "a coordinate of vertex 2 is `null`"),
        (square(&[]).replace("[1, 1, 0]", "7"), 5, "vertex 2 is `7`; it should be a list of 2 or 3 numbers"),
        (square(&[]).replace("faces_vertices", "faces"), 1, "`faces_vertices` is missing"),
        (
            square(&[]).replace("[0, 2, 3]", "[0, 2.5, 3]"),
            10,
            "a vertex number of face 1 is `2.5`; it should be a whole",
        ),
        (square(&[]).replace("[0, 2, 3]", "{}"), 10, "face 1 is `{}`; it should be a list of vertex numbers"),
        (square(&["\"foldwell:lattice\": [[1, 0], [0, 1]]"]), 12, "it should be two lists of three numbers"),
        (square(&["\"foldwell:lattice\": [[1, 0, 0]]"]), 12, "it should be two lists of three numbers"),
        (square(&["\"foldwell:holes\": [0, 1]"]), 12, "opening 0 is `0`; it should be a list of vertex numbers"),
        (square(&["\"edges_vertices\": [[0, 1, 2]]"]), 12, "edge 0 of the list is `[0, 1, 2]`; it should be a pair"),
        (square(&["\"edges_vertices\": [[0, 1]]", "\"edges_assignment\": [\"X\"]"]), 13, "assignment of edge 0"),
        (square(&["\"edges_vertices\": [[0, 1]]", "\"edges_assignment\": [\"b\"]"]), 13, "one of the capital letters"),
        (square(&["\"edges_vertices\": [[0, 1]]", "\"edges_assignment\": []"]), 13, "`edges_assignment` has 0 entries"),
        (square(&["\"edges_vertices\": [[0, 1]]", "\"edges_foldAngle\": [\"90\"]"]), 13, "the fold angle of edge 0"),
    ];
    check(cases, "bad.fold", fold::parse);
}

/// Claim: indices without a vertex, coincident points and coordinates that are not finite numbers are refused.
#[test]
fn wrong_vertices() {
    let [vertices, faces] = SQUARE;
    let with = |more: &str| mesh(&[vertices, &[more]].concat(), faces, &[]);
    let cases = vec![
        (mesh(&[], faces, &[]), 6, "face 0 names vertex 0"),
        (mesh(&[], &[], &[]), 5, "the mesh has no vertices"),
        (mesh(vertices, &[], &[]), 8, "the mesh has no faces"),
        (
            square(&[]).replace("[1, 1, 0]", "[1, 1]"),
            5,
            "vertex 2 has 2 coordinates where the vertices before it have 3",
        ),
        (square(&[]).replace("[0, 0, 0]", "[0, 0, 0, 0]"), 3, "vertex 0 has 4 coordinates"),
        (square(&[]).replace("[1, 1, 0]", "[1, 1e60, 0]"), 5, "vertex 2 has the coordinate 1e60"),
        (with("[5, 5, 5]"), 7, "vertex 4 belongs to no face"),
        (square(&[]).replace("[1, 1, 0]", "[1, 0, 0]"), 5, "vertex 2 stands where vertex 1 stands"),
        (
            square(&["\"foldwell:lattice\": [[9, 0, 0], [0, 9, 0]]"]).replace("[1, 1, 0]", "[1, 0, 0]"),
            5,
            "vertex 2 stands",
        ),
        (
            wires(&["[0, 0]", "[1, 0]", "[0, 1]", "[1, 0]"], &["[0, 1]", "[1, 2]", "[2, 0]", "[0, 3]"]),
            6,
            "vertex 3 stands where vertex 1 stands",
        ),
        (square(&[]).replace("[0, 2, 3]", "[0, 2, 4]"), 10, "face 1 names vertex 4; vertices are numbered 0 to 3"),
        (square(&[]).replace("[0, 2, 3]", "[0, 2, -1]"), 10, "face 1 names vertex -1"),
        (square(&[]).replace("3]", "99999999999999999999999]"), 10, "face 1 names vertex 99999999999999999999999"),
        (square(&["\"edges_vertices\": [[0, 9]]"]), 12, "edge 0 of the list names vertex 9"),
        (bow(), 5, "vertex 2 joins separate fans of faces"),
        (square(&["\"foldwell:lattice\": [[1e-9, 0, 0], [0, 1, 0]]"]), 4, "is a copy of vertex 0 in cell (1e9, 0e0)"),
    ];
    check(cases, "bad.fold", fold::parse);
}

/// Returns two triangles that share only a vertex.
fn bow() -> String {
    mesh(&["[0, 0, 0]", "[1, 0, 0]", "[1, 1, 0]", "[2, 1, 0]", "[2, 2, 0]"], &["[0, 1, 2]", "[2, 3, 4]"], &[])
}

/// Claim: faces that are not polygons, or that do not fit together, are refused with their numbers.
#[test]
fn wrong_faces() {
    let [vertices, faces] = SQUARE;
    let with = |more: &str| mesh(vertices, &[faces, &[more]].concat(), &[]);
    let cases = vec![
        (square(&[]).replace("[0, 2, 3]", "[0, 2]"), 10, "face 1 has 2 corners; it should have at least 3"),
        (square(&[]).replace("[0, 2, 3]", "[0, 2, 3, 2]"), 10, "face 1 names vertex 2 twice"),
        (with("[2, 0, 1]"), 11, "face 2 is face 0 again"),
        (with("[1, 0, 2]"), 11, "face 2 is face 0 again"),
        (square(&[]).replace("[0, 2, 3]", "[0, 3, 2]"), 10, "faces [0, 1] run along edge [2, 0] in the same direction"),
        (square(&[]).replace("[0, 1, 0]", "[2, 2, 0]"), 10, "face 1 has a triangle [0, 2, 3] of area 0e0"),
        (mesh(vertices, &["[0, 2, 1, 3]"], &[]), 9, "face 0 crosses itself or has no area"),
        (
            mesh(
                &["[0, 0]", "[1, 0]", "[1, 1]", "[0, 1]", "[0.5, 0.2]", "[2, 0.3]"],
                &["[0, 1, 2, 3]", "[4, 5, 2]"],
                &[],
            ),
            11,
            "edges [4, 5] and [1, 2] cross",
        ),
    ];
    check(cases, "bad.fold", fold::parse);
}

/// Returns a 3 x 3 cell of squares with an opening in the middle; the faces are on lines 21 to 28, other keys from line
/// 30.
fn ring(others: &[&str]) -> String {
    let vertices: Vec<String> = (0..16).map(|v| format!("[{}, {}, 0]", v % 4, v / 4)).collect();
    let corners = [0, 1, 2, 4, 6, 8, 9, 10];
    let faces: Vec<String> = corners.map(|c| format!("[{}, {}, {}, {}]", c, c + 1, c + 5, c + 4)).into();
    let lattice = "\"foldwell:lattice\": [[3, 0, 0], [0, 3, 0]]";
    let others: Vec<&str> = [&[lattice], others].concat();
    let (vertices, faces): (Vec<&str>, Vec<&str>) =
        (vertices.iter().map(String::as_str).collect(), faces.iter().map(String::as_str).collect());
    mesh(&vertices, &faces, &others)
}

const RING_HOLE: &str = "\"foldwell:holes\": [[5, 6, 10, 9]]";

/// Claim: a degenerate lattice, edges without a partner, and invalid openings are refused.
#[test]
fn wrong_lattices() {
    let lattice = |l: &str| square(&[&format!("\"foldwell:lattice\": {l}")]);
    let cases = vec![
        (lattice("[[1, 0, 0], [2, 0, 0]]"), 12, "the lattice vectors span an area of 0e0"),
        (lattice("[[0, 0, 0], [0, 1, 0]]"), 12, "with lengths [0.0, 1.0]"),
        (lattice("[[1e200, 0, 0], [0, 1, 0]]"), 12, "between 1e-50 and 1e50 long"),
        (lattice("[[1, 0, 0], [0, 1.1, 0]]"), 9, "edge [0, 1] has only face 0"),
        (lattice("[[1, 0, 0], [0, 1.00001, 0]]"), 9, "edge [0, 1] has only face 0; with `foldwell:lattice` every edge"),
        (mesh(SQUARE[0], &["[0, 1, 2]"], &[UNIT_LATTICE]), 9, "edge [0, 1] has only face 0"),
        (
            mesh(
                &[SQUARE[0], &["[2, 0, 0]", "[2, 1, 0]"]].concat(),
                &["[0, 1, 2]", "[0, 2, 3]", "[1, 4, 5]"],
                &[UNIT_LATTICE],
            ),
            13,
            "face 2 is face 0 again, 1 and 0 cells further",
        ),
        (ring(&[]), 22, "edge [6, 5] has only face 1"),
        (
            ring(&["\"foldwell:holes\": [[5, 6, 10]]"]),
            31,
            "opening 0 passes along [10, 5], which is an edge of 0 faces",
        ),
        (
            ring(&["\"foldwell:holes\": [[0, 1, 5, 4]]"]),
            31,
            "opening 0 passes along [0, 1], which is an edge of 2 faces",
        ),
        (ring(&["\"foldwell:holes\": [[5, 6, 10, 99]]"]), 31, "opening 0 names vertex 99"),
        (ring(&["\"foldwell:holes\": [[]]"]), 31, "opening 0 has 0 corners"),
        (square(&["\"foldwell:holes\": [[0, 1, 2]]"]), 12, "a finite sheet needs no list of its openings"),
    ];
    check(cases, "bad.fold", fold::parse);
}

/// Claim: edges that contradict the faces, or from which no faces can be rebuilt, are refused with their numbers.
#[test]
fn wrong_edges() {
    let vertices = SQUARE[0];
    let listed = |edges: &str| square(&[&format!("\"edges_vertices\": {edges}")]);
    let angle = |a: &str| square(&["\"edges_vertices\": [[0, 2]]", &format!("\"edges_foldAngle\": [{a}]")]);
    let island = ["[0.6, 0.2, 0]", "[0.8, 0.2, 0]", "[0.8, 0.3, 0]"];
    let cases = vec![
        (listed("[[0, 1], [2, 2]]"), 12, "edge 1 of the list runs from vertex 2 to itself"),
        (listed("[[0, 1], [1, 0]]"), 12, "edge 1 of the list is edge 0 again, [1, 0]"),
        (listed("[[1, 3]]"), 12, "edge 0 of the list, [1, 3], is a side of no face"),
        (
            angle("270"),
            13,
            "edge 0 of the list, [0, 2], has the fold angle 270 degrees; a target angle should be between",
        ),
        (
            wires(vertices, &["[0, 1]", "[1, 2]", "[2, 3]", "[3, 0]", "[0, 2]", "[1, 3]"]),
            14,
            "edges [0, 2] and [1, 3] cross",
        ),
        (
            wires(vertices, &["[0, 1]", "[1, 2]", "[2, 0]", "[2, 3]"]),
            12,
            "edge 3 of the list, [2, 3], is a side of no face",
        ),
        (
            wires(&[vertices, &island].concat(), &["[0, 1]", "[1, 2]", "[2, 0]", "[4, 5]", "[5, 6]", "[6, 4]"]),
            15,
            "edge 3 of the list, [4, 5], belongs to edges inside a face",
        ),
        (
            wires(&["[0, 0, 0]", "[0, 0, 1]", "[1, 0, 0]", "[1, 1, 0]"], &["[0, 1]", "[1, 2]", "[2, 3]", "[3, 0]"]),
            9,
            "edge [0, 1] has no length",
        ),
    ];
    check(cases, "bad.fold", fold::parse);
}

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

/// Claim: OBJ files are checked in the same way; their messages count from 1 as OBJ does.
#[test]
fn wrong_obj_files() {
    let line = |more: &str| format!("{OBJ}{more}\n");
    let cases = vec![
        (line("v 1 2"), 7, "`1 2` is no point; it should be three finite numbers"),
        (line("v 1 inf 0"), 7, "`1 inf 0` is no point"),
        (line("f 1 2 x"), 7, "`x` is no vertex number"),
        (line("f 1 2 5"), 7, "face 3 names vertex 5; vertices are numbered 1 to 4"),
        (line("f 1 2 0"), 7, "face 3 names vertex 0"),
        (line("f 1 2 -5"), 7, "face 3 names vertex -5"),
        (line("f 1 2"), 7, "face 3 has 2 corners"),
        (line("f 2 3 1"), 7, "face 3 is face 1 again"),
        (line("v 9 9 9"), 7, "vertex 5 belongs to no face"),
        (line("# foldwell:lattice 1 0 0"), 7, "it should be two lines, one for each lattice vector"),
        (line("# foldwell:lattice 1 0 0\n# foldwell:lattice 0 2 0"), 5, "edge [1, 2] has only face 1"),
        (OBJ.replace("f 1 3 4", "f 1 4 3"), 6, "faces [1, 2] run along edge [3, 1] in the same direction"),
        (String::new(), 1, "the mesh has no vertices"),
    ];
    check(cases, "bad.obj", obj::parse);
}

/// Claim: a missing file gives another error than a malformed one.
#[test]
fn missing_file() {
    let error = fold::read(std::path::Path::new("no/such/file.fold")).unwrap_err();
    assert!(matches!(error, SheetError::Read { .. }));
    assert!(error.to_string().starts_with("no/such/file.fold: "), "{error}");
}

/// A random change of a text.
#[derive(Clone, Debug)]
enum Damage {
    Flip(usize, u8),
    Delete(usize, usize),
    Repeat(usize, usize),
    Swap(usize, usize),
    Number(usize, &'static str),
}

const NUMBERS: [&str; 14] =
    ["0", "-0", "1", "2", "3", "-1", "1e300", "-1e-300", "1e999", "18446744073709551616", "0.1", "null", "[]", "1e49"];

fn damage() -> impl Strategy<Value = Damage> {
    prop_oneof![
        (any::<usize>(), 0u8..128).prop_map(|(at, byte)| Damage::Flip(at, byte)),
        (any::<usize>(), 1usize..40).prop_map(|(at, n)| Damage::Delete(at, n)),
        (any::<usize>(), 1usize..40).prop_map(|(at, n)| Damage::Repeat(at, n)),
        (any::<usize>(), any::<usize>()).prop_map(|(a, b)| Damage::Swap(a, b)),
        (any::<usize>(), 0usize..NUMBERS.len()).prop_map(|(at, n)| Damage::Number(at, NUMBERS[n])),
        (any::<usize>(), 0usize..NUMBERS.len()).prop_map(|(at, n)| Damage::Number(at, NUMBERS[n])),
    ]
}

/// Returns the positions of the numbers in a text.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let part = |c: char| c.is_ascii_digit() || ".-+e".contains(c);
    let mut ranges: Vec<std::ops::Range<usize>> = Vec::new();
    for (k, _) in text.char_indices().filter(|(_, c)| part(*c)) {
        match ranges.last_mut() {
            Some(last) if last.end == k => last.end = k + 1,
            _ => ranges.push(k..k + 1),
        }
    }
    ranges
}

fn spoil(text: &mut String, damage: &Damage) {
    let n = text.len().max(1);
    let places = numbers(text);
    match *damage {
        Damage::Flip(at, byte) => {
            text.replace_range(at % n..(at % n + 1).min(text.len()), &char::from(byte).to_string())
        }
        Damage::Delete(at, size) => text.replace_range(at % n..(at % n + size).min(text.len()), ""),
        Damage::Repeat(at, size) => {
            let piece = text[at % n..(at % n + size).min(text.len())].to_owned();
            text.insert_str(at % n, &piece);
        }
        Damage::Swap(a, b) if !places.is_empty() => {
            let (a, b) = (places[a % places.len()].clone(), places[b % places.len()].clone());
            let (first, last) = if a.start <= b.start { (a, b) } else { (b, a) };
            if first.end <= last.start {
                let (x, y) = (text[first.clone()].to_owned(), text[last.clone()].to_owned());
                text.replace_range(last, &x);
                text.replace_range(first, &y);
            }
        }
        Damage::Number(at, value) if !places.is_empty() => {
            text.replace_range(places[at % places.len()].clone(), value);
        }
        _ => {}
    }
}

/// Returns valid files to damage: a cell of triangles, polygons of several sizes, a finite sheet, an opening, and a
/// file with edges only.
fn good_files(n: usize) -> String {
    let of = |name: &str| fold::write(&generate(&Pattern::named(name).unwrap()).unwrap());
    match n % 6 {
        0 => of("random"),
        1 => of("square-twist"),
        2 => of("kresling"),
        3 => ring(&[RING_HOLE]),
        4 => wires(SQUARE[0], &["[0, 1]", "[1, 2]", "[2, 3]", "[3, 0]", "[0, 2]"]),
        _ => mesh(&["[0, 0]", "[3, 0]", "[4, 1]", "[2, 3]", "[1, 1]", "[0, 2]"], &["[0, 1, 2, 3, 4, 5]"], &[]),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Claim: no damage to a file makes the readers panic; a file that is still accepted can be written and read again.
    #[test]
    fn damaged_files_never_panic(n in 0usize..6, kinds in proptest::collection::vec(damage(), 1..4), as_obj in any::<bool>()) {
        let mut text = good_files(n);
        if as_obj {
            text = obj::write(&fold::parse(&text, "good.fold").unwrap());
        }
        kinds.iter().for_each(|kind| spoil(&mut text, kind));
        let read = if as_obj { obj::parse(&text, "damaged") } else { fold::parse(&text, "damaged") };
        match read {
            Ok(sheet) => prop_assert_eq!(fold::parse(&fold::write(&sheet), "again").unwrap().edges.len(), sheet.edges.len()),
            Err(error) => prop_assert!(error.to_string().starts_with("damaged:")),
        }
    }
}

/// Claim: creases of a file with fold angles and without letters take the letters of their targets where these are on
/// the other side than the drawing, so that the file written of the sheet is read as the same sheet.
#[test]
fn targets_on_the_other_side_without_letters() {
    let text = |angles: &str| {
        let others = [r#""edges_vertices": [[0, 2], [0, 1]]"#, &format!(r#""edges_foldAngle": [{angles}, null]"#)];
        square(&others).replace("[0, 1, 0]", "[0.5, 0.5, 0.5]")
    };
    for (drawn, target) in [("90.0", "-90.0"), ("90.0", "-180.0"), ("90.0", "45.0"), ("90.0", "0.0")] {
        let sheet = fold::parse(&text(target), "targets.fold").unwrap();
        let crease = sheet.edges.iter().find(|edge| sheet.targets.contains_key(&edge.key)).unwrap();
        let letter = if target.starts_with('-') { Assignment::Mountain } else { Assignment::Valley };
        assert_eq!(sheet.assignment(crease), letter, "{target}");
        assert_eq!(fold::parse(&fold::write(&sheet), "again.fold").unwrap(), sheet, "{target}");
        assert!(fold::parse(&text(drawn), "drawn.fold").unwrap().targets.is_empty());
    }
}

/// Claim: OBJ files of other programs are read: with byte order marks, comments at the end of a line, lines continued
/// after a backslash, and comments in Latin-1. A byte order mark is also accepted in FOLD.
#[test]
fn texts_of_other_programs() {
    let plain = obj::parse(OBJ, "a.obj").unwrap();
    let marked = format!("\u{feff}{}", OBJ.replace("v 0 0 0", "v 0 0 0 # corner"));
    let other = marked.replace("f 1 2 3\n", "f 1 2 \\\n 3 # first\n");
    assert_eq!(obj::parse(&other, "a.obj").unwrap(), plain);
    fold::parse(&format!("\u{feff}{}", square(&[])), "a.fold").unwrap();
    let folder = Folder::new().with("a.obj", [b"# caf\xe9\n", OBJ.as_bytes()].concat());
    assert_eq!(obj::read(&folder.file("a.obj")).unwrap(), plain);
    let before = obj::parse("f 1 2 3\nv 0 0 0\n", "a.obj").unwrap_err().to_string();
    assert!(before.contains("face 1 names vertex 1; no vertices stand before it"), "{before}");
}

/// Claim: a text that is not UTF-8 is refused with its line, and a device is not read at all.
#[test]
fn files_that_are_no_texts() {
    let folder = Folder::new().with("a.fold", b"{\n\"file_title\": \"caf\xe9\"}");
    let message = fold::read(&folder.file("a.fold")).unwrap_err().to_string();
    assert!(message.contains("line 2 is not UTF-8"), "{message}");
    let zero = std::path::Path::new("/dev/zero");
    if zero.exists() {
        let message = fold::read(zero).unwrap_err().to_string();
        assert!(message.contains("a device or a pipe"), "{message}");
    }
}
