//! Edge assignments: the letters of `edges_assignment` are interpreted as in FOLD 1.2, are refused with their edge if
//! they contradict the mesh, and are kept by `convert` together with the metadata of the file.

use crate::common::Folder;
use foldwell::sheet::{Assignment, EdgeKind, Info, Sheet, fold, obj};

/// Returns four unit squares around vertex 4. The ends of the edges are on line 4, their letters on the line below.
///
/// ```text
/// 6 7 8
/// 3 4 5
/// 0 1 2
/// ```
fn squares(edges: &[([usize; 2], &str)], more: &str) -> String {
    let ends: Vec<_> = edges.iter().map(|(ends, _)| format!("{ends:?}")).collect();
    let letters: Vec<_> = edges.iter().map(|(_, letter)| format!("\"{letter}\"")).collect();
    let (ends, letters) = (ends.join(",\n"), letters.join(", "));
    format!(
        "{{\"vertices_coords\": [[0,0],[1,0],[2,0],[0,1],[1,1],[2,1],[0,2],[1,2],[2,2]],{more}\n\
         \"faces_vertices\": [[0,1,4,3],[1,2,5,4],[3,4,7,6],[4,5,8,7]],\n\"edges_vertices\": [\n{ends}],\n\
         \"edges_assignment\": [{letters}]}}"
    )
}

fn count(sheet: &Sheet, kind: EdgeKind) -> usize {
    sheet.edges.iter().filter(|edge| edge.kind == kind).count()
}

/// Claim (FOLD 1.2, `edges_assignment`): the two sides of C are separate boundaries. A cut from the rim to the middle
/// adds one vertex and leaves a disc with one crease less; a cut right through makes two pieces. Counted by hand.
#[test]
fn a_cut_parts_the_sheet() {
    let whole = fold::parse(&squares(&[], ""), "a.fold").unwrap();
    assert_eq!((whole.vertices.len(), count(&whole, EdgeKind::Crease), count(&whole, EdgeKind::Boundary)), (9, 4, 8));
    let slit = fold::parse(&squares(&[([1, 4], "C")], ""), "a.fold").unwrap();
    assert_eq!((slit.vertices.len(), count(&slit, EdgeKind::Crease), count(&slit, EdgeKind::Boundary)), (10, 3, 10));
    assert_eq!(
        (slit.cut_from.as_slice(), Info::new(&slit).euler_characteristic, Info::new(&slit).cut),
        (&[1][..], 1, 2)
    );
    let halves = fold::parse(&squares(&[([1, 4], "C"), ([7, 4], "C")], ""), "a.fold").unwrap();
    assert_eq!((halves.vertices.len(), count(&halves, EdgeKind::Crease)), (12, 2));
    assert_eq!(Info::new(&halves).euler_characteristic, 2);
    // the second face, on the right, has the new vertices
    assert!(halves.polygons[1].iter().any(|corner| corner.vertex >= 9));
    assert!(halves.polygons[0].iter().all(|corner| corner.vertex < 9));
}

/// Claim (FOLD 1.2): J is not a crease, and its faces are parts of one polygon; U and F are creases; all letters are
/// kept.
#[test]
fn joined_faces_have_no_crease() {
    let edges = [([1, 4], "J"), ([4, 7], "U"), ([3, 4], "F"), ([4, 5], "M")];
    let sheet = fold::parse(&squares(&edges, ""), "a.fold").unwrap();
    // four diagonals and the joined edge
    assert_eq!((count(&sheet, EdgeKind::Crease), count(&sheet, EdgeKind::Facet)), (3, 5));
    let letter = |i, j| {
        let edge = sheet.edges.iter().find(|edge| (edge.key.i, edge.key.j) == (i, j)).unwrap();
        (edge.kind, sheet.assignment(edge))
    };
    assert_eq!(letter(1, 4), (EdgeKind::Facet, Assignment::Join));
    assert_eq!(letter(4, 7), (EdgeKind::Crease, Assignment::Unassigned));
    assert_eq!(letter(3, 4), (EdgeKind::Crease, Assignment::Flat));
    assert_eq!(letter(4, 5), (EdgeKind::Crease, Assignment::Mountain));
    assert_eq!(letter(0, 1), (EdgeKind::Boundary, Assignment::Boundary));
}

/// Claim: letters that contradict the mesh are refused with the line and the number of their edge.
#[test]
fn contradictions_are_refused() {
    let lattice = "\"foldwell:lattice\": [[2,0,0],[0,2,0]],";
    let cases = [
        (squares(&[([0, 1], "B"), ([1, 4], "B")], ""), 5, "edge 1 of the list, [1, 4], is assigned B, a boundary, but"),
        (squares(&[([0, 1], "J")], ""), 4, "edge 0 of the list, [0, 1], is assigned J, which joins two faces"),
        (squares(&[([1, 4], "C")], lattice), 4, "a periodic sheet cannot be cut along an edge"),
        (valley("M"), 4, "is assigned M, but the vertices draw a fold angle of 45 degrees"),
    ];
    for (text, line, words) in cases {
        let message = fold::parse(&text, "a.fold").unwrap_err().to_string();
        assert!(message.starts_with(&format!("a.fold:{line}:")) && message.contains(words), "{message}\n{text}");
    }
    let slit = fold::parse(&inner_slit(), "a.fold").unwrap();
    assert_eq!((slit.vertices.len(), slit.record.redrawing.slits), (8, 1), "a cut of one edge opens in its middle");
    for letter in ["V", "U", "F"] {
        fold::parse(&valley(letter), "a.fold").unwrap();
    }
    // B on the outline of a drawn cell is not a contradiction
    fold::parse(&squares(&[([0, 1], "B"), ([7, 6], "B")], lattice), "a.fold").unwrap();
}

/// Claim: a mesh all of whose folded creases have the letter of the other side is that sheet seen from its other side:
/// its faces are turned over, which is said, and the letters stay. FOLD's own `box.fold` is such a file. With one
/// letter of this side, or with fold angles that say what is meant, nothing is turned.
#[test]
fn letters_of_the_other_side_turn_the_sheet_over() {
    let valleys = include_str!("../../cases/fold/box.fold");
    let mountains = valleys.replace("\"V\"", "\"M\"").replace("edges_foldAngle", "old:foldAngle");
    let [before, after] = [valleys, &mountains].map(|text| fold::parse(text, "box.fold").unwrap());
    let [before_info, after_info] = [&before, &after].map(Info::new);
    assert!(!before_info.turned_over && after_info.turned_over && after_info.to_string().contains("turned over"));
    for (sheet, letter, sign) in [(&before, Assignment::Valley, 1.0), (&after, Assignment::Mountain, -1.0)] {
        let creases = sheet.edges.iter().filter(|edge| edge.kind == EdgeKind::Crease);
        let right =
            creases.filter(|edge| sheet.assignment(edge) == letter && sheet.drawn_angle(edge).unwrap() * sign > 1.0);
        assert_eq!(right.count(), 4);
    }
    assert_eq!(fold::parse(&fold::write(&after), "b.fold").unwrap().edges, after.edges);
    for text in [mountains.replacen("\"M\"", "\"V\"", 1), mountains.replace("old:foldAngle", "edges_foldAngle")] {
        let message = fold::parse(&text, "box.fold").unwrap_err().to_string();
        assert!(message.contains("is assigned M"), "{message}");
    }
}

/// Returns two triangles that fold up by 45 degrees; the edge between them is on line 4.
fn valley(letter: &str) -> String {
    format!(
        "{{\"vertices_coords\": [[0,0,0],[1,0,0],[0,1,0],[0,-1,1]],\n\"faces_vertices\": [[0,1,2],[1,0,3]],\n\
         \"edges_vertices\": [\n[0,1]], \"edges_assignment\": [\"{letter}\"]}}"
    )
}

/// Returns a cut of one edge between two inner vertices, with a triangle fan around each.
fn inner_slit() -> String {
    String::from(
        "{\"vertices_coords\": [[0,0],[3,0],[3,3],[0,3],[1,1],[2,2]],\n\
         \"faces_vertices\": [[0,1,4],[1,5,4],[1,2,5],[2,3,5],[3,4,5],[3,0,4]],\n\"edges_vertices\": [\n[4,5]],\n\
         \"edges_assignment\": [\"C\"]}",
    )
}

/// Claim: a hole that is drawn with B edges stays a hole if the faces are rebuilt from the edges: a ring of four
/// polygons, whose Euler characteristic is 0.
#[test]
fn holes_are_not_filled() {
    let text = "{\"vertices_coords\": [[0,0],[3,0],[3,3],[0,3],[1,1],[2,1],[2,2],[1,2]],\n\
        \"edges_vertices\": [[0,1],[1,2],[2,3],[3,0],[4,5],[5,6],[6,7],[7,4],[0,4],[1,5],[2,6],[3,7]],\n\
        \"edges_assignment\": [\"B\",\"B\",\"B\",\"B\",\"B\",\"B\",\"B\",\"B\",\"M\",\"V\",\"M\",\"V\"]}";
    let ring = fold::parse(text, "ring.fold").unwrap();
    assert_eq!((ring.polygons.len(), count(&ring, EdgeKind::Boundary)), (4, 8));
    assert_eq!(Info::new(&ring).euler_characteristic, 0);
}

/// Claim: a written file is read back as the same sheet, including cuts, joins and letters, in FOLD and in OBJ.
#[test]
fn letters_come_back() {
    let edges = [([1, 4], "C"), ([4, 7], "J"), ([3, 4], "M"), ([4, 5], "V"), ([0, 1], "C")];
    let metadata = "\"file_title\": \"t\", \"file_author\": \"A. B.\", \"frame_unit\": \"mm\", ";
    for edges in [&edges[..], &[([1, 4], "C"), ([7, 4], "C")]] {
        let sheet = fold::parse(&squares(edges, metadata), "a.fold").unwrap();
        assert_eq!(fold::parse(&fold::write(&sheet), "b.fold").unwrap(), sheet);
        // OBJ has no list of edges, whose order it could keep
        assert_eq!(obj::parse(&obj::write(&sheet), "b.obj").unwrap(), Sheet { listed_edges: vec![], ..sheet });
    }
}

/// Claim: keys of other programs come back whatever characters they have. Found in files with one damaged letter.
#[test]
fn keys_of_other_programs_come_back() {
    for key in [r"\frame_title", r#"other:\"a\" \\"#, r"other:\n"] {
        let faces = r#""vertices_coords": [[0, 0], [1, 0], [0, 1], [1, 1]], "faces_vertices": [[0, 1, 2], [1, 3, 2]]"#;
        let sheet = fold::parse(&format!("{{ {faces}, \"{key}\": 1 }}"), "a.fold").unwrap();
        assert_eq!(sheet.record.metadata.len(), 1, "{key}");
        assert_eq!(fold::parse(&fold::write(&sheet), "a.fold").unwrap(), sheet, "{key}");
    }
}

fn convert(folder: &Folder, from: &str, to: &str) -> (String, String) {
    let said = folder.foldwell(&format!("convert {from} {to}")).well();
    (said.err, String::from_utf8_lossy(&folder.bytes(to)).into_owned())
}

/// Claim: `convert` keeps the mountains and valleys of a flat pattern, its author and the metadata of its frame, and
/// reports on standard error which frames and keys it does not keep.
#[test]
fn convert_keeps_letters_and_says_what_it_drops() {
    let edges = [([1, 4], "M"), ([4, 7], "V"), ([3, 4], "U"), ([4, 5], "M")];
    let more = "\"file_author\": \"A. B.\", \"frame_title\": \"f\", \"faceOrders\": [], \"file_frames\": [{}, {}], ";
    let folder = Folder::new().with("a.fold", squares(&edges, more));
    let (said, text) = convert(&folder, "a.fold", "b.fold");
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    let letters: Vec<_> = value["edges_assignment"].as_array().unwrap().iter().map(|l| l.as_str().unwrap()).collect();
    let of = |letter: &str| letters.iter().filter(|l| **l == letter).count();
    assert_eq!((of("M"), of("V"), of("U"), of("B"), of("F")), (2, 1, 1, 8, 0));
    assert_eq!((&value["file_author"], &value["frame_title"]), (&"A. B.".into(), &"f".into()));
    assert!(said.contains("2 other frames") && said.contains("`faceOrders`") && !said.contains("author"), "{said}");
    let (said, _) = convert(&folder, "a.fold", "b.vtu");
    assert!(said.contains("`file_author`"), "{said}");
    let info = Info::new(&fold::read(&folder.file("a.fold")).unwrap());
    assert_eq!(info.further_frames, 2);
    assert!(info.to_string().contains("frame 0 is read; 2 others are not"));
}

/// Claim: a file that was written by this program is converted without any message.
#[test]
fn nothing_is_said_where_nothing_is_lost() {
    let folder = Folder::new().with("a.fold", include_str!("../../../meshes/kirigami-polarized.fold"));
    let (said, text) = convert(&folder, "a.fold", "b.fold");
    assert_eq!(said, "");
    assert_eq!(convert(&folder, "b.fold", "c.fold"), (String::new(), text));
}
