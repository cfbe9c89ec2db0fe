//! Writing sheets to FOLD files.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{Display, Write};

use super::keys::GLUE;
use super::record::{ATTRIBUTES, CLASSES};
use super::stiffness::{BARS, HINGES};
use crate::sheet::angle::in_degrees;
use crate::sheet::assigned::FLAT;
use crate::sheet::assignment::Assignment;
use crate::sheet::build::{Drawing, draw, drawn_sides, edges_by_drawn_name};
use crate::sheet::cell::{Corner, Edge, EdgeKey, EdgeKind, Glue, Sheet};
use crate::sheet::sides::sorted;

/// Returns `sheet` as a FOLD text: the whole cell with the copies of vertices that its faces need, edges with
/// assignment and drawn fold angle, lattice and openings. Coordinates are always three-dimensional, since the edges
/// of a sheet folded flat cross each other. [`parse`](super::parse) reads the text as the same sheet, bit by bit.
pub fn write(sheet: &Sheet) -> String {
    let drawn = draw(sheet);
    let mut text = String::from("{\n");
    field(&mut text, "file_spec", "1.2");
    field(&mut text, "file_creator", &quoted("foldwell"));
    field(&mut text, "file_title", &quoted(&drawn.title));
    if !drawn.description.is_empty() {
        field(&mut text, "file_description", &quoted(&drawn.description));
    }
    let kept =
        |key: &str| sheet.record.metadata.iter().find(|(known, _)| known == key).map(|(_, value)| value.as_str());
    field(&mut text, "file_classes", kept("file_classes").unwrap_or(CLASSES));
    field(&mut text, "frame_attributes", kept("frame_attributes").unwrap_or(ATTRIBUTES));
    for (key, value) in &sheet.record.metadata {
        if !["file_classes", "frame_attributes"].contains(&key.as_str()) {
            field(&mut text, key, value);
        }
    }
    if let Some(lattice) = drawn.lattice {
        field(&mut text, "foldwell:lattice", &rows(lattice.iter().map(|l| numbers(l.iter()))));
    }
    if let Some(screws) = &drawn.screws {
        let screw =
            |a: usize| format!("{{ \"turn\": {:?}, \"rise\": {:?} }}", in_degrees(screws.turn[a]), screws.rise[a]);
        field(&mut text, "foldwell:lattice", &rows([0, 1].map(screw).into_iter()));
    }
    if !drawn.holes.is_empty() {
        field(&mut text, "foldwell:holes", &rows(drawn.holes.iter().map(numbers)));
    }
    if !drawn.names.is_empty() {
        let list = |(name, list): (&String, &Vec<usize>)| format!("{}: {}", quoted(name), numbers(list));
        let lists = drawn.names.iter().map(list).collect::<Vec<_>>().join(",\n    ");
        field(&mut text, "foldwell:names", &format!("{{\n    {lists}\n  }}"));
    }
    field(&mut text, "vertices_coords", &rows(drawn.coords.iter().map(|x| numbers(x.iter()))));
    write_edges(&mut text, sheet, &drawn);
    if let Some(frames) = &sheet.record.frames {
        field(&mut text, "file_frames", frames);
    }
    let _ = write!(text, "  \"faces_vertices\": {}\n}}\n", rows(drawn.faces.iter().map(numbers)));
    text
}

fn write_edges(text: &mut String, sheet: &Sheet, drawn: &Drawing) {
    let known = edges_by_drawn_name(sheet);
    let corners = corners(sheet, drawn);
    let sides = listed(sheet, drawn, &corners);
    let edge = |ends: [usize; 2]| {
        let numbers = known.get(&EdgeKey::new(corners[ends[0]], corners[ends[1]]).0);
        numbers.and_then(|numbers| numbers.first()).map(|&number| &sheet.edges[number])
    };
    let edges: Vec<Option<&Edge>> = sides.iter().map(|&ends| edge(ends)).collect();
    let further: BTreeSet<EdgeKey> =
        sheet.edges.iter().map(|edge| edge.key).filter(|key| !key.has_bar()).map(EdgeKey::whole).collect();
    // an edge of more than two faces has neither a letter nor an angle
    let lettered: Vec<Option<&Edge>> =
        edges.iter().map(|edge| edge.filter(|edge| !further.contains(&edge.key))).collect();
    let letters = lettered.iter().map(|edge| edge.map_or(Assignment::Unassigned, |edge| sheet.assignment(edge)));
    let letters: Vec<_> = letters.map(|assignment| format!("\"{assignment}\"")).collect();
    let angle = |edge: &Edge| match sheet.targets.get(&edge.key) {
        Some(target) => Some(in_degrees(*target)),
        None if sheet.targets.is_empty() => degrees(sheet, edge),
        None => None,
    };
    let angles = lettered.iter().map(|edge| edge.and_then(angle));
    let angles: Vec<_> = angles.map(|angle| angle.map_or("null".to_owned(), |a| format!("{a:?}"))).collect();
    field(text, "edges_vertices", &rows(sides.iter().map(numbers)));
    field(text, "edges_assignment", &format!("[{}]", letters.join(", ")));
    field(text, "edges_foldAngle", &format!("[{}]", angles.join(", ")));
    if !sheet.glue.is_empty() {
        let words = edges.iter().map(|edge| glue(edge.and_then(|edge| sheet.glue.get(&edge.key))));
        field(text, GLUE, &format!("[{}]", words.collect::<Vec<_>>().join(", ")));
    }
    for (key, given) in [(HINGES, &sheet.stiffness.hinges), (BARS, &sheet.stiffness.bars)] {
        if !given.is_empty() {
            let values = edges.iter().map(|edge| stiffness(edge.and_then(|edge| given.get(&edge.key).copied())));
            field(text, key, &format!("[{}]", values.collect::<Vec<_>>().join(", ")));
        }
    }
}

/// Returns the drawn sides of faces in the order of the file from which the sheet was read.
fn listed(sheet: &Sheet, drawn: &Drawing, corners: &[Corner]) -> Vec<[usize; 2]> {
    let sides = drawn_sides(drawn).into_iter().map(|(ends, _)| ends).chain(drawn.bars.iter().copied());
    if sheet.listed_edges.is_empty() {
        return sides.collect();
    }
    let number: BTreeMap<Corner, usize> = corners.iter().enumerate().map(|(v, corner)| (*corner, v)).collect();
    let mut left: BTreeMap<[usize; 2], usize> = sides.enumerate().map(|(k, ends)| (sorted(ends), k)).collect();
    let in_file = sheet.listed_edges.iter().filter_map(|[a, b]| Some([*number.get(a)?, *number.get(b)?]));
    let mut list: Vec<[usize; 2]> = in_file.filter(|ends| left.remove(&sorted(*ends)).is_some()).collect();
    let mut others: Vec<(usize, [usize; 2])> = left.into_iter().map(|(ends, k)| (k, ends)).collect();
    others.sort_unstable();
    list.extend(others.into_iter().map(|(_, ends)| ends));
    list
}

/// Returns the joints between the faces of an edge as JSON text.
fn glue(words: Option<&Vec<Glue>>) -> String {
    serde_json::json!(words).to_string()
}

/// Returns a stiffness as JSON text, which has no infinite numbers.
fn stiffness(given: Option<f64>) -> String {
    match given {
        None => "null".to_owned(),
        Some(rigid) if rigid.is_infinite() => "\"inf\"".to_owned(),
        Some(stiffness) => format!("{stiffness:?}"),
    }
}

/// Returns the corner that each drawn vertex represents.
fn corners(sheet: &Sheet, drawn: &Drawing) -> Vec<Corner> {
    let mut corners: Vec<_> = (0..drawn.coords.len()).map(Corner::home).collect();
    let lists = drawn.faces.iter().chain(&drawn.holes).zip(sheet.polygons.iter().chain(&sheet.holes));
    for (numbers, there) in lists {
        numbers.iter().zip(there).for_each(|(&v, &corner)| corners[v] = sheet.uncut(corner));
    }
    for (ends, edge) in drawn.bars.iter().zip(sheet.bars_alone()) {
        ends.iter().zip(edge.key.ends()).for_each(|(&v, corner)| corners[v] = corner);
    }
    corners
}

/// Returns the drawn fold angle in degrees, rounded to 9 decimals: finer than the reader's tolerance, and coarser
/// than the differences between mathematical libraries. `None` for a boundary edge.
fn degrees(sheet: &Sheet, edge: &Edge) -> Option<f64> {
    let angle = sheet.drawn_angle(edge).filter(|_| edge.kind != EdgeKind::Boundary)?.to_degrees();
    Some(if angle.abs() < FLAT { 0.0 } else { (angle * 1e9).round() / 1e9 })
}

fn field(text: &mut String, key: &str, value: &str) {
    let _ = writeln!(text, "  {}: {value},", quoted(key));
}

fn rows(rows: impl Iterator<Item = String>) -> String {
    format!("[\n    {}\n  ]", rows.collect::<Vec<_>>().join(",\n    "))
}

fn numbers<'n, T: std::fmt::Debug + 'n>(list: impl IntoIterator<Item = &'n T>) -> String {
    format!("[{}]", list.into_iter().map(|n| format!("{n:?}")).collect::<Vec<_>>().join(", "))
}

fn quoted(text: impl Display) -> String {
    serde_json::Value::String(text.to_string()).to_string()
}
