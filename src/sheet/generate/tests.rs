//! Tests of all patterns, and of the files in `meshes/`.

use crate::math::Vec3;
use std::f64::consts::{FRAC_PI_3, PI};
use std::path::PathBuf;

use super::*;
use crate::sheet::{Assignment, EdgeKind, Info, fold};

fn edge_lengths(sheet: &Sheet) -> Vec<f64> {
    sheet.edges.iter().map(|e| e.key.ends().map(|c| sheet.position(c))).map(|[i, j]| (j - i).norm()).collect()
}

/// Reads a pattern with some of its parameters, as a scene gives them.
fn with(json: &str) -> Pattern {
    serde_json::from_str(json).unwrap()
}

fn sheet(json: &str) -> Sheet {
    generate(&with(json)).unwrap()
}

/// Claim: folding keeps the length of every edge, diagonals included. Tolerance: rounding of coordinates below 10.
#[test]
fn folded_states_are_isometric() {
    for name in ["miura", "waterbomb", "yoshimura", "square-twist", "miura-patch"] {
        let flat = edge_lengths(&sheet(&format!(r#"{{"pattern": "{name}", "fold": 0}}"#)));
        for fold in [1e-6, 0.2, 0.7, 1.2, 1.5] {
            let folded = sheet(&format!(r#"{{"pattern": "{name}", "fold": {fold}}}"#));
            for (k, (a, b)) in flat.iter().zip(edge_lengths(&folded)).enumerate() {
                assert!((a - b).abs() < 1e-13, "{name} at {fold}, edge {k}: {a} {b}");
            }
            assert!(Info::new(&folded).developable, "{name} at {fold}");
        }
    }
}

/// Claim: the polygons but those of thick panels are planar, so that the fold angles of their diagonals vanish.
/// Tolerance: rounding, over heights of 0.1.
#[test]
fn polygons_are_planar() {
    for name in Pattern::names().filter(|name| *name != "thick-miura") {
        let sheet = generate(&Pattern::named(name).unwrap()).unwrap();
        for edge in sheet.edges.iter().filter(|e| e.kind == EdgeKind::Facet) {
            assert!(sheet.drawn_angle(edge).unwrap().abs() < 1e-14, "{name} {edge:?}");
        }
    }
}

/// Claim: the acute angle of every parallelogram is `sector`, its sides `a` and `b`. Tolerance: rounding.
#[test]
fn sector_angles_and_sides() {
    for (name, fold) in [("miura", 0.9), ("eggbox", 1.1)] {
        let sheet = sheet(&format!(r#"{{"pattern": "{name}", "a": 1.3, "b": 0.8, "fold": {fold}}}"#));
        for polygon in &sheet.polygons {
            let x: Vec<Vec3> = polygon.iter().map(|&c| sheet.position(c)).collect();
            let (b, a) = (x[1] - x[0], x[3] - x[0]);
            let (a, b) = if name == "eggbox" { (b, a) } else { (a, b) };
            assert!((a.norm() - 1.3).abs() < 1e-14 && (b.norm() - 0.8).abs() < 1e-14, "{name}");
            let angle = a.angle(&b);
            assert!((angle.min(PI - angle) - FRAC_PI_3).abs() < 1e-14, "{name}: {angle}");
        }
    }
}

/// Claim: the sides of a cell of four parallelograms have their lengths and angles, also of the mirror image, which is
/// the same sheet with z reversed; with the angles of the eggbox it is the eggbox. Tolerance: rounding.
#[test]
fn four_parallelograms_have_their_sides() {
    let json = r#"{"pattern": "four-parallelogram", "a": 1.3, "b": 0.7, "c": 0.6, "d": 1.1, "ac": 1.2, "ad": 1.8, "bc": 1.5,
                   "bd": 1.0, "fold": 0.9}"#;
    let cell = sheet(json);
    let [first, second] = cell.lattice.unwrap();
    let (a, c) = (cell.vertices[1], cell.vertices[2]);
    let (b, d) = (first - a, second - c);
    for (side, length) in [(a, 1.3), (b, 0.7), (c, 0.6), (d, 1.1)] {
        assert!((side.norm() - length).abs() < 1e-14, "{length}");
    }
    for (pair, angle) in [([a, c], 1.2), ([a, d], 1.8), ([b, c], 1.5), ([b, d], 1.0), ([c, d], 1.8)] {
        assert!((pair[0].angle(&pair[1]) - angle).abs() < 1e-14, "{angle}");
    }
    assert!(first.x > 0.0 && second.y > 0.0 && first.yz().norm() + second.z.abs() < 1e-15);
    let mirrored = sheet(&json.replace("0.9}", "-0.9}"));
    for (one, other) in cell.vertices.iter().zip(&mirrored.vertices) {
        assert!((one - Vec3::new(other.x, other.y, -other.z)).norm() < 1e-14);
    }
    let (t, f) = (FRAC_PI_3, 0.9f64);
    let eggbox = sheet(&format!(r#"{{"pattern": "eggbox", "fold": {}}}"#, (t.cos() / f.sin()).asin()));
    let same = sheet(&format!(
        r#"{{"pattern": "four-parallelogram", "a": 1, "b": 1, "c": 1, "d": 1, "ac": {t}, "ad": {s}, "bc": {s}, "bd": {t},
            "fold": {f}}}"#,
        s = PI - t
    ));
    assert!(eggbox.vertices.iter().zip(&same.vertices).all(|(a, b)| (a - b).norm() < 1e-14));
    assert_eq!(eggbox.edges, same.edges);
}

/// Claim: the creases around the square of a rigidly folded square twist are neither flat nor all equal, and `fold`
/// is the angle of the right one.
#[test]
fn square_twist_folds() {
    let sheet = sheet(r#"{"pattern": "square-twist", "fold": 0.5}"#);
    let angles: Vec<f64> = sheet.edges[..4].iter().map(|e| sheet.drawn_angle(e).unwrap()).collect();
    assert!((angles[1] - 0.5).abs() < 1e-14, "{angles:?}");
    assert!(angles.iter().all(|a| a.abs() > 0.1), "{angles:?}");
}

/// Returns the letters of the creases at each vertex that no boundary edge reaches, as numbers of mountains and
/// valleys.
fn letters_at_vertices(sheet: &Sheet) -> Vec<[usize; 2]> {
    let mut letters = vec![Some([0, 0]); sheet.vertices.len()];
    for edge in &sheet.edges {
        for end in [edge.key.i, edge.key.j] {
            letters[end] = match (letters[end], sheet.assignment(edge)) {
                (_, Assignment::Boundary) | (None, _) => None,
                (Some([m, v]), Assignment::Mountain) => Some([m + 1, v]),
                (Some([m, v]), Assignment::Valley) => Some([m, v + 1]),
                (unchanged, _) => unchanged,
            };
        }
    }
    letters.into_iter().flatten().collect()
}

/// Claim: at the inner vertices of the hypar but its centre, mountains and valleys differ by two in number. Source:
/// Maekawa's theorem. At the centre all creases have one letter, as the pattern is folded by hand.
#[test]
fn the_hypar_has_letters_of_flat_folding() {
    for (sides, pleats) in [(3, 2), (4, 6), (6, 5)] {
        let hypar = sheet(&format!(r#"{{"pattern": "hypar", "sides": {sides}, "pleats": {pleats}}}"#));
        let letters = letters_at_vertices(&hypar);
        assert_eq!((hypar.vertices.len(), letters.len()), (1 + sides * pleats, 1 + sides * (pleats - 1)));
        assert_eq!(letters[0], [0, sides]);
        assert!(letters[1..].iter().all(|[m, v]| m.abs_diff(*v) == 2 && m + v == 4), "{letters:?}");
    }
}

/// Claim: around each vertex of Resch's pattern the rotations about the creases by their target angles, in order, give
/// the identity, which is the condition for rigid faces to meet. Source: S.-M. belcastro, T. Hull, Linear Algebra Appl.
/// 348, 273 (2002), theorem 2. Tolerance: rounding of six products.
#[test]
fn the_target_angles_of_resch_close_around_every_vertex() {
    for a in [1.0, 2.5] {
        let cell = sheet(&format!(r#"{{"pattern": "resch", "a": {a}}}"#));
        assert_eq!((cell.vertices.len(), cell.edges.len(), cell.triangles.len()), (4, 12, 8));
        for vertex in 0..4 {
            let mut creases: Vec<(f64, Vec3, f64)> = vec![];
            for edge in &cell.edges {
                let [i, j] = edge.key.ends().map(|end| cell.position(end));
                let ways = [(edge.key.i, j - i), (edge.key.j, i - j)];
                let from_here = ways.into_iter().filter(|(end, _)| *end == vertex);
                creases
                    .extend(from_here.map(|(_, way)| (way.y.atan2(way.x), way.normalize(), cell.targets[&edge.key])));
            }
            assert_eq!(creases.len(), 6);
            creases.sort_by(|a, b| a.0.total_cmp(&b.0));
            let turn = |(_, way, angle): &(f64, Vec3, f64)| nalgebra::Rotation3::new(way * *angle);
            let product = creases.iter().map(turn).fold(nalgebra::Rotation3::identity(), |all, one| all * one);
            let error = (product.matrix() - nalgebra::Matrix3::identity()).norm();
            assert!(error < 1e-14, "vertex {vertex}: {error:e}");
        }
    }
}

/// Claim: random cells are triangulated, generic or flat as their pattern says, differ by seed, and have positive
/// areas seen from above up to the largest jitter.
#[test]
fn random_cells() {
    for seed in 0..50 {
        let cell = sheet(&format!(
            r#"{{"pattern": "random", "size": [3, 4], "height": 0.5, "jitter": 0.2499, "seed": {seed}}}"#
        ));
        assert_eq!((cell.vertices.len(), cell.edges.len(), cell.triangles.len()), (12, 36, 24));
        for t in &cell.triangles {
            let [a, b, c] = t.corners.map(|c| cell.position(c).xy());
            assert!((b - a).perp(&(c - a)) > 0.0, "seed {seed}");
        }
        assert!(!Info::new(&cell).developable);
        let flat = sheet(&format!(r#"{{"pattern": "random-developable", "size": [1, 1], "seed": {seed}}}"#));
        assert!(Info::new(&flat).developable);
    }
    assert_ne!(sheet(r#"{"pattern": "random", "seed": 1}"#).vertices, sheet(r#"{"pattern": "random"}"#).vertices);
}

/// Claim: every pattern has the Euler characteristic of its surface: 0 for a torus and a ring, 1 for a disc, 2
/// for a closed drum, -1 for two coupled tubes, 9 - 12 = -3 for the lines and walls of a block of four,
/// -4 for a torus with four openings.
#[test]
fn euler_characteristics() {
    for name in Pattern::names() {
        let info = Info::new(&generate(&Pattern::named(name).unwrap()).unwrap());
        let expected = match name {
            "miura-patch" | "truss" | "hypar" => 1,
            "aligned-tubes" | "zipper-tubes" => -1,
            "tube-block" => -3,
            "thick-miura" => -4,
            _ => 0,
        };
        assert_eq!(info.euler_characteristic, expected, "{name}");
        assert_eq!(info.maxwell_count_screw.is_some(), info.periodic);
    }
    let drum = Info::new(&sheet(r#"{"pattern": "kresling", "closed": true, "levels": 2}"#));
    assert_eq!((drum.euler_characteristic, drum.boundary, drum.polygons), (2, 0, 26));
}

/// Claim: the closed drum has its polygons at both ends with normals that point outwards, and the bars between them
/// have the lengths `sqrt(h^2 + 2 r^2 (1 - cos t))` and the same with `t - 2 pi / n`. Source: chord of a circle and
/// Pythagoras' theorem. Tolerance: rounding of coordinates below 4.
#[test]
fn closed_drums_have_the_lengths_of_their_parameters() {
    for (n, r, h, t) in [(6, 1.0, 1.2, 1.9), (5, 2.5, 0.7, -0.4), (3, 1.0, 1.0, 0.5)] {
        let json = format!(
            r#"{{"pattern": "kresling", "closed": true, "sides": {n}, "radius": {r}, "height": {h}, "twist": {t}}}"#
        );
        let drum = sheet(&json);
        assert_eq!((drum.vertices.len(), drum.polygons.len()), (2 * n, 2 * n + 2));
        let chord = |angle: f64| 2.0 * r * r * (1.0 - libm::cos(angle));
        let side = 2.0 * PI / n as f64;
        for edge in &drum.edges {
            let [i, j] = [edge.key.i, edge.key.j];
            let length = (drum.vertices[j] - drum.vertices[i]).norm();
            let expected = match (i < n, j < n) {
                (true, false) if j - n == i => (h * h + chord(t)).sqrt(),
                (true, false) => (h * h + chord(t - side)).sqrt(),
                (false, true) => panic!("edges run upwards"),
                // sides and diagonals of the end polygons
                _ => chord(side * (j as f64 - i as f64)).sqrt(),
            };
            assert!((length - expected).abs() < 1e-14 * (1.0 + r + h), "{n} sides, edge {i} {j}: {length} {expected}");
        }
        for (polygon, up) in [(2 * n, -1.0), (2 * n + 1, 1.0)] {
            let x: Vec<Vec3> = drum.polygons[polygon].iter().map(|&c| drum.position(c)).collect();
            assert_eq!(x.len(), n);
            assert!((x[1] - x[0]).cross(&(x[2] - x[1])).normalize().z * up > 1.0 - 1e-12);
        }
    }
    assert_eq!(sheet(r#"{"pattern": "kresling", "closed": true, "levels": 2}"#).vertices.len(), 18);
}

/// Claim: the truss has two bars of length `sqrt(w^2 + h^2)` and one of `2 w` between its supports. Tolerance:
/// rounding.
#[test]
fn the_truss_has_three_bars() {
    let cases: [(&str, f64, f64); 2] =
        [(r#"{"pattern": "truss"}"#, 1.0, 0.3), (r#"{"pattern": "truss", "half_span": 2.0, "height": 1.5}"#, 2.0, 1.5)];
    for (json, w, h) in cases {
        let truss = sheet(json);
        assert_eq!((truss.vertices.len(), truss.edges.len(), truss.triangles.len()), (3, 3, 1));
        for edge in &truss.edges {
            let length = (truss.vertices[edge.key.j] - truss.vertices[edge.key.i]).norm();
            let expected = if [edge.key.i, edge.key.j] == [0, 2] { 2.0 * w } else { w.hypot(h) };
            assert!((length - expected).abs() < 1e-15 * expected, "{edge:?}");
            assert_eq!(edge.kind, EdgeKind::Boundary);
        }
    }
}

/// Claim: every listed name is that of a pattern, and the pattern writes the same name.
#[test]
fn names() {
    for name in Pattern::names() {
        let json = serde_json::to_value(Pattern::named(name).unwrap()).unwrap();
        assert_eq!(json["pattern"], *name);
    }
    let unknown = Pattern::named("no-such-pattern").unwrap_err();
    assert_eq!(unknown.to_string(), "there is no pattern `no-such-pattern`");
    assert!(unknown.help().starts_with("there are `miura`, "), "{}", unknown.help());
    assert!(Pattern::named("muira").unwrap_err().help().starts_with("did you mean `miura`? there are "));
    assert!(serde_json::from_str::<Pattern>(r#"{"pattern": "miura", "angle": 1}"#).is_err());
}

/// Claim: parameters outside their range are refused with the number and the range.
#[test]
fn bad_parameters() {
    let cases = [
        (r#"{"pattern": "miura", "a": -1}"#, "`a` is -1; it should be above 0 and below 1000000"),
        (r#"{"pattern": "miura", "fold": 2}"#, "`fold` is 2 rad; it should be at least 0 and below 1.57"),
        (r#"{"pattern": "miura-patch", "cells": [5, 0]}"#, "`cells[1]` is 0; it should be from 1 to 500"),
        (r#"{"pattern": "eggbox", "fold": 0.1}"#, "`fold` is 0.1 rad; it should be above 0.5235"),
        (
            r#"{"pattern": "four-parallelogram", "fold": 0.3}"#,
            "`fold` is 0.3 rad; it should be above 0.39269908 and below 1.4",
        ),
        (r#"{"pattern": "four-parallelogram", "fold": -0.3}"#, "`fold` is -0.3 rad; it should be above -1.4"),
        (
            r#"{"pattern": "four-parallelogram", "ac": 0.1, "bc": 2.9, "bd": 2.9}"#,
            "no cell has these angles `ac`, `ad`, `bc`",
        ),
        (r#"{"pattern": "waterbomb", "b": 0}"#, "`b` is 0; it should be above 0"),
        (r#"{"pattern": "yoshimura", "fold": -0.1}"#, "`fold` is -0.1 rad; it should be at least 0"),
        (r#"{"pattern": "kresling", "sides": 2}"#, "`sides` is 2; it should be from 3 to 1000"),
        (r#"{"pattern": "kresling", "closed": true, "levels": 0}"#, "`levels` is 0; it should be from 1 to 1000"),
        (r#"{"pattern": "truss", "height": 0}"#, "`height` is 0; it should be above 0"),
        (r#"{"pattern": "square-twist", "twist": 0}"#, "`twist` is 0 rad; it should be above 0"),
        (r#"{"pattern": "resch", "a": 0}"#, "`a` is 0; it should be above 0"),
        (r#"{"pattern": "hypar", "pleats": 1}"#, "`pleats` is 1; it should be from 2 to 200"),
        (r#"{"pattern": "hypar", "sides": 2}"#, "`sides` is 2; it should be from 3 to 100"),
        (r#"{"pattern": "random", "jitter": 0.25}"#, "`jitter` is 0.25; it should be at least 0 and below 0.25"),
        (r#"{"pattern": "symmetric", "symmetry": "glide", "size": [3, 2]}"#, "`size[0]` is 3; it should be even"),
        (r#"{"pattern": "symmetric", "symmetry": "mirror", "size": [3, 3]}"#, "`size[1]` is 3; it should be even"),
        (r#"{"pattern": "random-developable", "size": [0, 2]}"#, "`size[0]` is 0; it should be from 1 to 1000"),
    ];
    for (json, message) in cases {
        let found = generate(&with(json)).unwrap_err().to_string();
        assert!(found.starts_with(message), "{json}: {found}");
    }
}

fn mesh_path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("meshes/{name}.fold"))
}

/// Claim: the files in `meshes/` are equal to what the generators make, byte by byte, and read back as the same
/// sheets.
#[test]
fn mesh_files_are_up_to_date() {
    for name in Pattern::names() {
        let sheet = generate(&Pattern::named(name).unwrap()).unwrap();
        let text = std::fs::read_to_string(mesh_path(name)).unwrap();
        assert_eq!(text, fold::write(&sheet), "{name}: run `cargo test write_mesh_files -- --ignored`");
        assert_eq!(fold::parse(&text, name).unwrap(), sheet);
    }
}

/// Rewrites the files in `meshes/`.
#[test]
#[ignore = "changes files of the repository"]
fn write_mesh_files() {
    for name in Pattern::names() {
        let sheet = generate(&Pattern::named(name).unwrap()).unwrap();
        std::fs::write(mesh_path(name), fold::write(&sheet)).unwrap();
    }
}

/// Returns the keys of a page of help with their defaults, as values of TOML.
fn documented(page: &str) -> Vec<(String, toml::Value)> {
    let entries = page.split("\n  --").skip(1);
    let parts = entries.map(|entry| {
        let (key, _) = entry.split_once(' ').unwrap();
        let (_, rest) = entry.split_once("[default: ").unwrap_or_else(|| panic!("{key} has no default"));
        (key.replace('-', "_"), rest.split([']', ';']).next().unwrap().split(", closed").next().unwrap().to_owned())
    });
    let value = |text: String| match text.strip_suffix(" deg") {
        Some(degrees) => degrees.parse::<f64>().unwrap().to_radians().into(),
        None if text.contains(',') => format!("[{text}]").parse().unwrap(),
        None => text.parse().unwrap(),
    };
    parts.map(|(key, text)| (key, value(text))).collect()
}

/// Claim: the page about a pattern names each of its parameters once, with the default that it has. Tolerance: that of
/// degrees and radians.
#[test]
fn help_names_every_parameter() {
    for name in Pattern::names() {
        let page = Pattern::help(name).unwrap();
        let mut defaults = toml::Table::try_from(Pattern::named(name).unwrap()).unwrap();
        defaults.remove("pattern");
        if name == "kresling" {
            defaults.insert("levels".into(), 3.into()); // depends on `closed`
        }
        assert!(page.lines().all(|line| line.chars().count() <= 100), "{name}: a line is too long");
        for (key, documented) in documented(page) {
            let default =
                defaults.remove(&key).unwrap_or_else(|| panic!("{name} has no parameter {key}, or names it twice"));
            let number = |value: &toml::Value| value.as_float().or(value.as_integer().map(|n| n as f64));
            match (number(&documented), number(&default)) {
                (Some(a), Some(b)) => assert!((a - b).abs() < 1e-15, "{name}, {key}: {a} {b}"),
                _ => assert_eq!(documented, default, "{name}, {key}"),
            }
        }
        assert!(defaults.is_empty(), "{name} does not document {defaults:?}");
    }
}

/// Claim: angles of patterns may have a unit, and degrees without one are refused with what they would be.
#[test]
fn angles_have_units() {
    let with_unit = sheet(r#"{"pattern": "miura", "sector": "60 deg", "fold": "0.25 rad"}"#);
    assert_eq!(with_unit, sheet(r#"{"pattern": "miura", "fold": 0.25}"#));
    let refused = generate(&with(r#"{"pattern": "miura", "sector": 60}"#)).unwrap_err().to_string();
    assert!(refused.contains("`sector` is 60 rad") && refused.contains("did you mean \"60 deg\"?"), "{refused}");
    let refused = generate(&with(r#"{"pattern": "miura", "fold": -0.5}"#)).unwrap_err().to_string();
    assert!(refused.contains("at least 0") && !refused.contains("did you mean"), "{refused}");
}
