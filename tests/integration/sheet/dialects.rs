//! Drawings as other programs write them: SVG with invisible shapes, inner viewports and relative units, DXF with heights,
//! old encodings of texts, and mountain and valley letters on the rim of a sheet.

use crate::common::Folder;
use foldwell::sheet::pattern::{self, Format};
use foldwell::sheet::{Assignment, Sheet, SheetError, fold};
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::PI;

/// A square with sides of length 100 and its diagonal.
const SQUARE: &str = r##"<rect width="100" height="100" stroke="#000"/><path d="M 0 0 L 100 100" stroke="#f00"/>"##;

fn svg(inner: &str) -> Result<Sheet, SheetError> {
    let foreign = r#"xmlns="http://www.w3.org/2000/svg" xmlns:i="urn:i""#;
    pattern::parse(&format!("<svg {foreign}>{inner}</svg>"), "a", Format::Svg)
}

/// Claim: what browsers do not draw is no line of the pattern: strokes without a width, shapes without a size, elements
/// and attributes of other programs, and of a `switch` what needs them. Source: SVG 2, 13.5.3, 10.2 - 10.4, 5.9.2.
#[test]
fn what_draws_nothing_is_no_line() {
    let plain = svg(SQUARE).unwrap();
    for nothing in [
        r#"<path d="M 9 50 L 9 70" stroke="blue" stroke-width="0"/>"#,
        r#"<path d="M 9 50 L 9 70" style="stroke: blue; stroke-width: 0px"/>"#,
        r#"<g stroke-width="0"><path d="M 9 50 L 9 70" stroke="blue"/></g>"#,
        r#"<style>.a { stroke: blue; stroke-width: 0 }</style><path class="a" d="M 9 50 L 9 70"/>"#,
        r#"<rect x="9" y="50" width="30" stroke="blue"/><rect width="-3" height="9" stroke="blue"/>"#,
        r#"<circle cx="9" cy="50" stroke="blue"/><ellipse cx="9" cy="50" rx="3" stroke="blue"/>"#,
        r#"<line x1="9" y1="50" x2="9" y2="50" stroke="blue"/><path d="M 9 50" stroke="blue"/>"#,
        r#"<i:path d="M 9 50 L 9 70" stroke="blue"/><line xmlns="urn:x" x2="9" y2="50" stroke="blue"/>"#,
        r#"<g i:stroke="mauve" i:transform="warp(3)"/>"#,
    ] {
        assert_eq!(svg(&format!("{SQUARE}{nothing}")).unwrap(), plain, "{nothing}");
    }
    let for_others = r#"<foreignObject requiredExtensions="urn:i"/>"#;
    assert_eq!(svg(&format!("<switch>{for_others}<g>{SQUARE}</g></switch>")).unwrap(), plain);
    let wide = r#"<g stroke-width="0"><path d="M 100 0 L 0 100" stroke="blue" stroke-width="1e-3"/></g>"#;
    assert_eq!(svg(&format!("{SQUARE}{wide}")).unwrap().polygons.len(), 4);
}

/// Claim: an inner `svg` and a `symbol` are drawn in their own viewport, percentages are parts of the one around them,
/// and letters have the size that is given. Source: the corners, by SVG 2, 7.8, 7.10 and 8.3, counted by hand.
#[test]
fn viewports_and_units() {
    let view = r#"viewBox="0 0 100 100""#;
    let far = "x=\"10\" y=\"20\" width=\"200\" height=\"100\"";
    for (drawing, corners) in [
        (format!(r#"<svg x="10" y="20">{SQUARE}</svg>"#), [10.0, 20.0, 110.0, 120.0]),
        (format!("<svg {far} {view}>{SQUARE}</svg>"), [60.0, 20.0, 160.0, 120.0]),
        (format!(r#"<svg {far} {view} preserveAspectRatio="xMaxYMid">{SQUARE}</svg>"#), [110.0, 20.0, 210.0, 120.0]),
        (format!(r#"<svg {far} {view} preserveAspectRatio="none">{SQUARE}</svg>"#), [10.0, 20.0, 210.0, 120.0]),
        (
            format!(r#"<svg {far} {view} preserveAspectRatio="xMidYMin slice">{SQUARE}</svg>"#),
            [10.0, 20.0, 210.0, 220.0],
        ),
        (
            format!(r##"<symbol id="s" {view}>{SQUARE}</symbol><use href="#s" x="5" width="50" height="50"/>"##),
            [5.0, 0.0, 55.0, 50.0],
        ),
        (
            r#"<svg width="300" height="80"><rect width="50%" height="25%" stroke="black"/></svg>"#.into(),
            [0.0, 0.0, 150.0, 20.0],
        ),
        (
            r#"<g font-size="10"><g font-size="2em"><rect width="2em" height="3ex" stroke="black"/></g></g>"#.into(),
            [0.0, 0.0, 40.0, 30.0],
        ),
    ] {
        let sheet = svg(&drawing).unwrap();
        let range = |axis: usize, sign: f64| {
            let along = sheet.vertices.iter().map(|x| sign * x[axis]);
            along.fold([f64::MAX, f64::MIN], |[low, high], x| [low.min(x), high.max(x)])
        };
        let ([left, right], [top, bottom]) = (range(0, 1.0), range(1, -1.0));
        assert_eq!([left, top, right, bottom], corners, "{drawing}");
    }
    for (drawing, message) in [
        (r#"<rect width="50%" height="9" stroke="black"/>"#, "`50%` is no length"),
        (r#"<svg viewBox="0 0 1 1"/>"#, "`0 0 1 1` is no `viewBox` that is read"),
    ] {
        let found = svg(drawing).unwrap_err().to_string();
        assert!(found.contains(message), "{found}");
    }
}

/// Claim: drawings are read in UTF-8 and UTF-16 with their marks, with words in Latin-1 and Shift-JIS, and with every end
/// of line. Source: the same drawing as plain text; the words are in the encodings' own bytes.
#[test]
fn old_encodings_and_ends_of_lines() {
    let cp = "1 0 0 9 0\n1 9 0 9 9\n1 9 9 0 9\n1 0 9 0 0\n2 0 0 9 9\n".to_owned();
    let sides = ["0 0 9 0", "9 0 9 9", "9 9 0 9", "0 9 0 0", "0 0 9 9"].map(|row| row.split(' ').collect::<Vec<_>>());
    let layer = |k: usize| if k < 4 { "cut" } else { "mountain" };
    let line = |(k, c): (usize, &Vec<&str>)| {
        format!("0\nLINE\n8\n{}\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", layer(k), c[0], c[1], c[2], c[3])
    };
    let lines: String = sides.iter().enumerate().map(line).collect();
    let dxf = format!("999\nWORD\n0\nSECTION\n2\nENTITIES\n{lines}0\nENDSEC\n");
    let segment = |(k, c): (usize, &Vec<&str>)| {
        let colour = if k < 4 { "BLACK_0" } else { "RED_1" };
        format!("{{\"a\":\"{},{}\",\"b\":\"{},{}\",\"color\":\"{colour}\"}}", c[0], c[1], c[2], c[3])
    };
    let segments: Vec<String> = sides.iter().enumerate().map(segment).collect();
    let ori = format!("{{\"title\":\"WORD\",\n\"lineSegments\":[{}]}}", segments.join(","));
    let svg = format!("<?xml version=\"1.0\"?>\n<svg><!-- WORD -->{SQUARE}</svg>");
    for (name, text) in [("a.cp", cp), ("a.dxf", dxf), ("a.ori", ori), ("a.svg", svg)] {
        let read = |bytes: Vec<u8>| {
            let folder = Folder::new().with(name, bytes);
            let path = folder.file(name);
            pattern::read(&path, Format::of(&path).unwrap(), &pattern::Cleanup::default())
                .unwrap_or_else(|error| panic!("{error}"))
        };
        let plain = read(text.clone().into_bytes());
        assert_eq!(plain.polygons.len(), 2, "{name}");
        let utf16 = |bytes: fn(u16) -> [u8; 2]| format!("\u{feff}{text}").encode_utf16().flat_map(bytes).collect();
        let [before, after] = text.split_once("WORD").map_or(["", &text], |(before, after)| [before, after]);
        let word = |word: &[u8]| [before.as_bytes(), word, after.as_bytes()].concat();
        for bytes in [
            format!("\u{feff}{text}").into_bytes(),
            utf16(u16::to_le_bytes),
            utf16(u16::to_be_bytes),
            text.replace('\n', "\r\n").into_bytes(),
            text.replace('\n', "\r").into_bytes(),
            if before.is_empty() { text.clone().into_bytes() } else { word(b"caf\xe9") },
            if before.is_empty() { text.clone().into_bytes() } else { word(b"\x90\xdc\x82\xe8\x95\x5c") },
        ] {
            let is_japanese = bytes.windows(2).any(|pair| pair == b"\x95\x5c");
            let found = read(bytes);
            assert!(!is_japanese || name != "a.ori" || found.title == "折り表", "{name}: {}", found.title);
            assert_eq!((found.vertices, found.edges), (plain.vertices.clone(), plain.edges.clone()), "{name}");
        }
    }
}

/// Claim: a DXF drawing at another height is read as at height 0; a line that rises, as one or as a side of a polyline, and
/// an arc in a tilted plane are refused and not seen shortened. Source: the heights.
#[test]
fn rising_lines_of_dxf_are_refused() {
    let points = ["0 0", "9 0", "9 9", "0 9", "0 0", "9 9"].map(|row| row.split_once(' ').unwrap());
    let drawing = |heights: [f64; 6], rest: &str| {
        let line = |k: usize, layer: &str| {
            let [(x1, y1), (x2, y2)] = [points[k], points[k + 1]];
            let [z1, z2] = [heights[k], heights[k + 1]];
            format!("0\nLINE\n8\n{layer}\n10\n{x1}\n20\n{y1}\n30\n{z1}\n11\n{x2}\n21\n{y2}\n31\n{z2}\n")
        };
        let lines: String = (0..5).map(|k| line(k, if k < 4 { "cut" } else { "mountain" })).collect();
        pattern::parse(&format!("0\nSECTION\n2\nENTITIES\n{lines}{rest}0\nENDSEC\n"), "a.dxf", Format::Dxf)
    };
    assert_eq!(drawing([5.0; 6], "").unwrap().vertices, drawing([0.0; 6], "").unwrap().vertices);
    assert_eq!(drawing([0.0, 1e-9, 0.0, 0.0, 0.0, 0.0], "").unwrap().polygons.len(), 2);
    let corner = |x: f64, z: f64| format!("0\nVERTEX\n8\ncut\n10\n{x}\n20\n3\n30\n{z}\n");
    let polyline =
        format!("0\nPOLYLINE\n8\ncut\n10\n0\n20\n0\n30\n0\n{}{}0\nSEQEND\n", corner(0.0, 0.0), corner(9.0, 4.0));
    let arc = "0\nCIRCLE\n8\ncut\n10\n3\n20\n3\n40\n1\n210\n1\n220\n0\n230\n0\n";
    for (found, message) in [
        (drawing([0.0, 0.0, 5.0, 0.0, 0.0, 5.0], ""), "from the height z = 0 to 5"),
        (drawing([0.0; 6], &polyline), "from the height z = 0 to 4"),
        (drawing([0.0; 6], arc), "a CIRCLE in a plane that is tilted"),
    ] {
        let found = found.unwrap_err().to_string();
        assert!(found.contains(message), "{found}");
    }
}

/// Claim: a DXF drawing in the planes of the front view and of the view from the right is the one that is seen there. Source:
/// the same lines in the plane of x and y; for flat entities the axes of planes in the DXF reference (the arbitrary axis
/// algorithm), by which x points the other way seen from behind.
#[test]
fn upright_dxf_drawings() {
    let sides = [[0, 0, 9, 0], [9, 0, 9, 9], [9, 9, 0, 9], [0, 9, 0, 0]];
    type Place = fn(i32, i32) -> [i32; 3];
    let drawing = |place: Place, normal: [i32; 3], is_behind: bool| {
        let line = |[a, b, c, d]: [i32; 4]| {
            let ([x1, y1, z1], [x2, y2, z2]) = (place(a, b), place(c, d));
            format!("0\nLINE\n8\ncut\n10\n{x1}\n20\n{y1}\n30\n{z1}\n11\n{x2}\n21\n{y2}\n31\n{z2}\n")
        };
        let lines: String = sides.into_iter().map(line).collect();
        let [x, y, z] = normal;
        let normal = format!("210\n{x}\n220\n{y}\n230\n{z}\n");
        let (side, angles) = if is_behind { (-1, [0, 90]) } else { (1, [90, 180]) };
        let diagonal = format!("0\nLWPOLYLINE\n8\nmountain\n{normal}10\n0\n20\n0\n10\n{}\n20\n9\n", 9 * side);
        let arc = format!(
            "0\nARC\n8\nvalley\n{normal}10\n{}\n20\n0\n40\n4\n50\n{}\n51\n{}\n",
            9 * side,
            angles[0],
            angles[1]
        );
        let text = format!("0\nSECTION\n2\nENTITIES\n{lines}{diagonal}{arc}0\nENDSEC\n");
        pattern::parse(&text, "a.dxf", Format::Dxf).unwrap_or_else(|error| panic!("{error}"))
    };
    // arcs drawn the other way round number their vertices the other way round
    let shape = |sheet: &Sheet| {
        let mut points: Vec<[i64; 2]> =
            sheet.vertices.iter().map(|x| [x.x, x.y].map(|x| (1e6 * x).round() as i64)).collect();
        points.sort_unstable();
        let letters = [Assignment::Mountain, Assignment::Valley, Assignment::Boundary];
        let count = |letter| sheet.edges.iter().filter(|edge| sheet.assignment(edge) == letter).count();
        (points, letters.map(count))
    };
    let top = shape(&drawing(|x, y| [x, y, 5], [0, 0, 1], false));
    let views: [(Place, _, _); 4] = [
        (|x, y| [x, 5, y], [0, -1, 0], false),
        (|x, y| [x, 5, y], [0, 1, 0], true),
        (|x, y| [5, x, y], [1, 0, 0], false),
        (|x, y| [5, x, y], [-1, 0, 0], true),
    ];
    for (place, normal, is_behind) in views {
        assert_eq!(shape(&drawing(place, normal, is_behind)), top, "{normal:?}");
    }
}

/// Claim: a flat sheet whose faces look down is written, and cleaned up, as it is seen from above, with mountains for its
/// valleys; a crease that is to fold by an angle and has the letter of a facet or of a hinge is drawn as the mountain or valley
/// that it becomes. Source: a mountain seen from the other side is a valley (FOLD 1.2, `edges_assignment`).
#[test]
fn what_is_seen_from_above() {
    let pattern = |face: [[usize; 3]; 2], letter: &str, angle: f64| {
        format!(
            "{{\"vertices_coords\": [[0,0],[1,0],[1,1],[0,1]], \"faces_vertices\": {face:?}, \"edges_vertices\": \
             [[0,1],[1,2],[2,3],[3,0],[0,2]], \"edges_assignment\": [\"B\",\"B\",\"B\",\"B\",\"{letter}\"], \
             \"edges_foldAngle\": [null,null,null,null,{angle:?}]}}"
        )
    };
    let (above, below) = ([[0, 1, 2], [0, 2, 3]], [[2, 1, 0], [3, 2, 0]]);
    for (faces, letter, angle, side) in [
        (above, "M", -60.0, -1.0),
        (below, "M", -60.0, 1.0),
        (below, "V", 60.0, -1.0),
        (above, "F", 60.0, 1.0),
        (above, "U", -60.0, -1.0),
        (below, "U", -60.0, 1.0),
    ] {
        let folder = Folder::new().with("a.fold", pattern(faces, letter, angle));
        let letter_of = |name: &str| {
            let path = folder.file(name);
            let sheet = match Format::of(&path) {
                Some(format) => pattern::read(&path, format, &pattern::Cleanup::default()).unwrap(),
                None => fold::read(&path).unwrap(),
            };
            let edge = sheet.edges.iter().find(|edge| edge.wings.iter().all(Option::is_some)).unwrap();
            let target = sheet.targets.get(&edge.key).copied().unwrap_or_default();
            (sheet.assignment(edge), target.to_degrees())
        };
        let expected = if side > 0.0 { Assignment::Valley } else { Assignment::Mountain };
        for name in ["b.svg", "b.cp", "b.dxf"] {
            folder.foldwell(&format!("convert a.fold {name}")).well();
            let (found, target) = letter_of(name);
            assert_eq!(found, expected, "{name} of {letter} {faces:?}");
            assert!(name != "b.svg" || (target - 60.0 * side).abs() < 1e-12, "{letter} {faces:?}: {target}");
        }
        folder.foldwell("convert a.fold c.fold --split").well();
        let (found, target) = letter_of("c.fold");
        assert!(
            (target - 60.0 * side).abs() < 1e-12 && (letter == "F" || letter == "U" || found == expected),
            "{found:?}"
        );
    }
}

/// Claim: a crease pattern in any plane is split where its creases cross, and stays in its plane, with its letters; one in
/// no plane is refused. Source: the diagonals of a square, which a rotation and a shift have moved.
#[test]
fn tilted_patterns_are_split() {
    let edges = "\"edges_vertices\": [[0,1],[1,2],[2,3],[3,0],[0,2],[1,3]], \"edges_assignment\": [\"B\",\"B\",\"B\",\"B\",\"M\",\"V\"]";
    let shift = Vector3::new(3.0, -2.0, 5.0);
    for [about_x, about_y] in [[0.0, 0.0], [0.7, 0.3], [PI / 2.0, 0.0], [0.0, PI / 2.0], [-1.2, 0.9]] {
        let turn = Rotation3::from_euler_angles(about_x, about_y, 0.2);
        let place = |x: f64, y: f64| turn * Vector3::new(x, y, 0.0) + shift;
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| <[f64; 3]>::from(place(x, y)));
        let folder = Folder::new().with("a.fold", format!("{{\"vertices_coords\": {corners:?}, {edges}}}"));
        folder.foldwell("convert a.fold c.fold --split").well();
        let sheet = fold::read(&folder.file("c.fold")).unwrap();
        assert_eq!((sheet.vertices.len(), sheet.polygons.len()), (5, 4));
        let middle = sheet.vertices.iter().map(|v| (v - place(0.5, 0.5)).norm()).fold(f64::INFINITY, f64::min);
        assert!(middle < 1e-12, "{about_x}, {about_y}: {middle:e}");
        // seen from above, where its plane has an up
        let count = |letter| sheet.edges.iter().filter(|edge| sheet.assignment(edge) == letter).count();
        assert_eq!([count(Assignment::Mountain), count(Assignment::Valley)], [2, 2]);
    }
    let bent = format!("{{\"vertices_coords\": [[0,0,0],[1,0,0.3],[1,1,0],[0,1,0]], {edges}}}");
    Folder::new().with("a.fold", bent).foldwell("convert a.fold c.fold --split").refused("lie in no plane");
}

/// Claim: lines that vanish, since they are shorter than the distance within which points are one, are counted. Source:
/// eight creases of 0.3 that end inside a face of 1000, which no smaller distance makes a pattern.
#[test]
fn lines_that_vanish_are_said() {
    let specks: String = (1..9).map(|k| format!("2 {0}00 200 {0}00.3 200\n", k)).collect();
    let rim = "1 0 0 1000 0\n1 1000 0 1000 1000\n1 1000 1000 0 1000\n1 0 1000 0 0\n2 0 500 1000 500\n";
    let said = Folder::new().with("a.cp", format!("{rim}{specks}")).foldwell("info a.cp").well();
    assert!(said.all().contains("8 lines are left out that are shorter than"), "{}", said.all());
}

/// Claim: M and V on the rim are kept and said to fold nothing; a truss of bars without faces is told what lets it be read,
/// and is read with that; faults of an ORI file have one place. Source: counted by hand.
#[test]
fn letters_of_rims_and_bars_without_faces() {
    let rim = r#"{"vertices_coords": [[0, 0], [1, 0], [1, 1], [0, 1]],
        "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]], "edges_assignment": ["M", "V", "B", "B", "M"]}"#;
    let bars = r#""edges_vertices": [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]]}"#;
    let truss = format!(r#"{{"vertices_coords": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], {bars}"#);
    let listed = truss.replace("\"edges", "\"faces_vertices\": [], \"edges");
    let ori = "{\"lineSegments\": [\n{\"a\": 3}]}";
    let files = [("rim.fold", rim), ("truss.fold", &*truss), ("listed.fold", &*listed), ("a.ori", ori)];
    let folder = files.into_iter().fold(Folder::new(), |folder, (name, text)| folder.with(name, text));
    let said = folder.foldwell("info rim.fold").well().all();
    assert!(said.contains("2 edges of the rim have the letter M or V"), "{said}");
    let sheet = fold::parse(rim, "rim.fold").unwrap();
    let letter = |letter| sheet.edges.iter().filter(|edge| sheet.assignment(edge) == letter).count();
    assert_eq!([Assignment::Mountain, Assignment::Valley].map(letter), [2, 1]);
    folder.foldwell("info truss.fold").refused("`faces_vertices`, which cannot be rebuilt for it, or [] for a truss");
    assert!(folder.foldwell("info listed.fold").well().all().contains("bars without faces     6"));
    let empty = rim.replace("\"edges_vertices", "\"faces_vertices\": [], \"edges_vertices");
    folder.write("empty.fold", empty);
    let said = folder.foldwell("info empty.fold").well().all();
    assert!(said.contains("leave it out to have the faces found") && !said.contains("of the rim"), "{said}");
    folder.foldwell("info a.ori").refused("a.ori:2:1: not an ORI file of Oriedita, which is JSON: invalid type: ");
    assert!(!folder.foldwell("info a.ori").all().contains(" at line "));
}
