//! Tests of reading and writing whole files.

use super::*;
use crate::sheet::cell::{EdgeKind, Sheet};

const STAR: &str = include_str!("../../../tests/cases/open-star.fold");
const FLAT: &str = include_str!("../../../tests/cases/open-flat.fold");

fn edge_list(case: &str) -> Vec<[i64; 4]> {
    let case: serde_json::Value = serde_json::from_str(case).unwrap();
    serde_json::from_value(case["edge_list"].clone()).unwrap()
}

fn names(sheet: &Sheet) -> Vec<[i64; 4]> {
    let name = |k: crate::sheet::EdgeKey| [k.i as i64, k.j as i64, k.shift[0].into(), k.shift[1].into()];
    sheet.edges.iter().map(|e| name(e.key)).collect()
}

/// Claim: vertices and edges are numbered as in the reference's list for these cells, since other programs name them
/// by these numbers. Source: `open-star.json` and `open-flat.json`.
#[test]
fn edges_are_numbered_as_in_the_reference() {
    let star = parse(STAR, "open-star.fold").unwrap();
    assert_eq!((star.vertices.len(), star.triangles.len()), (4, 8));
    assert_eq!(names(&star), edge_list(include_str!("../../../tests/cases/open-star.json")));
    let flat = parse(FLAT, "open-flat.fold").unwrap();
    assert_eq!(names(&flat), edge_list(include_str!("../../../tests/cases/open-flat.json")));
    assert!(star.edges.iter().all(|e| e.kind == EdgeKind::Crease));
}

/// Claim: the drawn fold angles are those of the reference, valley positive. Source: `rest_fold_angles` of the case,
/// computed by closure of vertices. Tolerance: a few roundings of the same coordinates.
#[test]
fn drawn_angles_are_the_references() {
    let case: serde_json::Value = serde_json::from_str(include_str!("../../../tests/cases/open-star.json")).unwrap();
    let star = parse(STAR, "open-star.fold").unwrap();
    for (e, edge) in star.edges.iter().enumerate() {
        let expected = case["rest_fold_angles"][e].as_f64().unwrap();
        assert!((star.drawn_angle(edge).unwrap() - expected).abs() < 1e-13, "edge {e}");
    }
}

/// Claim: a written sheet reads as the same sheet, bit by bit.
#[test]
fn round_trip() {
    for text in [STAR, FLAT] {
        let sheet = parse(text, "open.fold").unwrap();
        let written = write(&sheet);
        assert_eq!(parse(&written, "again.fold").unwrap(), sheet, "{written}");
    }
}

/// Claim: named lists of vertices are read as corners of the cell, copies included, and written again. Source: vertex 4
/// of the file is the first copy that the file draws, whose corner is known by its position.
#[test]
fn names_are_kept() {
    let named = STAR.trim_start().replacen('{', r#"{ "foldwell:names": {"rim": [4, 0], "tip": [2]},"#, 1);
    let sheet = parse(&named, "star.fold").unwrap();
    let place = |corner: &crate::sheet::Corner| sheet.position(*corner);
    let file: serde_json::Value = serde_json::from_str(STAR).unwrap();
    let drawn = |v: usize| [0, 1, 2].map(|k| file["vertices_coords"][v][k].as_f64().unwrap());
    assert_eq!(sheet.names["tip"].len(), 1);
    for (corner, v) in sheet.names["rim"].iter().zip([4, 0]).chain([(&sheet.names["tip"][0], 2)]) {
        let apart = place(corner) - crate::math::Vec3::from(drawn(v));
        assert!(apart.norm() < 1e-12, "vertex {v}: {apart}");
    }
    assert_eq!(parse(&write(&sheet), "again.fold").unwrap(), sheet);
    for (wrong, message) in [
        (r#"{ "foldwell:names": [1],"#, "`foldwell:names` is `[1]`; it should be an object"),
        (r#"{ "foldwell:names": {"rim": [99]},"#, "the list `rim` of `foldwell:names` names vertex 99"),
    ] {
        let error = parse(&STAR.trim_start().replacen('{', wrong, 1), "star.fold").unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
}

/// Claim: the faces rebuilt from the edges of a drawing are its faces, up to order and first corner.
#[test]
fn faces_rebuilt_from_edges() {
    let sheet = parse(&write(&parse(STAR, "open-star.fold").unwrap()), "open-star.fold").unwrap();
    let written = write(&sheet);
    let start = written.find("  \"faces_vertices\"").unwrap();
    let without = format!("{}}}", written[..start].trim_end().trim_end_matches(','));
    let rebuilt = parse(&without, "rebuilt.fold").unwrap();
    let keys = |s: &Sheet| s.edges.iter().map(|e| (e.key, e.wings)).collect::<std::collections::BTreeMap<_, _>>();
    assert_eq!(keys(&rebuilt), keys(&sheet));
    assert_eq!(rebuilt.triangles.len(), 8);
}
