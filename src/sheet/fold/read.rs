//! Reading sheets from FOLD files.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::edges::{self, Edges};
use super::frames::FoldFrame;
use super::keys::Values;
use super::locate::Source;
use super::{record, stiffness};
use crate::math::Vec3;
use crate::sheet::ScrewLattice;
use crate::sheet::build::{Drawing, rebuild_faces};
use crate::sheet::cell::Sheet;
use crate::sheet::error::{Defect, MeshPart, MeshProblem, SheetError};
use crate::sheet::listed::{bars_alone, build_listed, check_ends};
use crate::sheet::record::FileRecord;

/// The parts of the mesh as they stand in the text, for the line of messages.
#[derive(Default)]
pub(super) struct RawMesh<'a> {
    vertices: Vec<&'a RawValue>,
    pub(super) faces: Vec<&'a RawValue>,
    holes: Vec<&'a RawValue>,
}

/// A frame as it is read: the drawing, the places of its parts in the text, and its edges.
pub(super) type ReadFrame<'a> = (Drawing, RawMesh<'a>, Edges<'a>);

/// Returns the sheet that a frame draws, with the numbers of its vertices and edges.
pub(super) fn sheet<'a>(
    source: &Source<'a>,
    frame: &FoldFrame<'a>,
    (mut drawn, mut rows, mut edges): ReadFrame<'a>,
) -> Result<Sheet, SheetError> {
    let keys = &frame.values;
    check_ends(&edges.ends, drawn.coords.len()).map_err(|(e, problem)| source.at(edges.rows[e], problem))?;
    drawn.assignments = edges.ends.iter().copied().zip(edges.assignments.iter().copied()).collect();
    drawn.fold_angles = edges.fold_angles();
    if let Some(value) = keys.get("foldwell:holes") {
        rows.holes = source.typed(value, || "`foldwell:holes`".into(), "a list of openings, [[0, 1, 2], ...]")?;
        drawn.holes = polygons(source, &rows.holes, "opening", drawn.coords.len())?;
    }
    drawn.glue = edges::glue(source, keys, &edges.ends)?;
    drawn.names = read_names(source, keys, drawn.coords.len())?;
    edges.rebuilt = keys.get("faces_vertices").is_none();
    let locate = |defect| located(source, keys, &rows, &edges, defect);
    let holes = if edges.rebuilt { rebuild_faces(&mut drawn, &edges.ends).map_err(locate)? } else { 0 };
    drawn.bars = bars_alone(&drawn, &edges.ends);
    let (mut sheet, identified) = build_listed(&drawn, &edges.ends).map_err(locate)?;
    sheet.stiffness = stiffness::read(source, keys, &edges, &sheet, &identified)?;
    sheet.record = FileRecord { turned_over: sheet.record.turned_over, ..record::read(frame, &drawn, &edges) };
    sheet.record.redrawing.holes = holes;
    Ok(sheet)
}

/// Reads title, vertices, edges and faces of a frame.
pub(super) fn read_drawing<'a>(source: &Source<'a>, keys: &Values<'a>) -> Result<ReadFrame<'a>, SheetError> {
    let mut rows = RawMesh::default();
    let mut drawn = head(source, keys)?;
    read_vertices(source, keys, &mut drawn, &mut rows)?;
    let edges = edges::read(source, keys, drawn.coords.len())?;
    if let Some(value) = keys.get("faces_vertices") {
        rows.faces = source.typed(value, || "`faces_vertices`".into(), "a list of faces, [[0, 1, 2], ...]")?;
        drawn.faces = polygons(source, &rows.faces, "face", drawn.coords.len())?;
    } else if edges.ends.is_empty() {
        let right = "it, or at least `edges_vertices`, should list the faces";
        return Err(source.at_value(None, MeshProblem::Missing { key: "faces_vertices", right }));
    }
    Ok((drawn, rows, edges))
}

fn head(source: &Source, keys: &Values) -> Result<Drawing, SheetError> {
    let string = |key: &str| -> Result<Option<String>, SheetError> {
        keys.get(key).map(|v| source.typed(v, || format!("`{key}`"), "a text in quotes")).transpose()
    };
    let stem = || Path::new(source.name).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    // screw motions are objects
    let (rolled, in_plane) = match keys.get("foldwell:lattice") {
        Some(value) if value.get().contains('{') => (Some(value), None),
        other => (None, other),
    };
    Ok(Drawing {
        title: string("file_title")?.unwrap_or_else(stem),
        description: string("file_description")?.unwrap_or_default(),
        folded: keys.get("frame_classes").is_some_and(|classes| classes.get().contains("\"foldedForm\"")),
        lattice: in_plane.map(|value| lattice(source, value)).transpose()?,
        screws: rolled.map(|value| screws(source, value)).transpose()?,
        ..Drawing::default()
    })
}

/// A screw motion in a file: its angle in degrees, and its translation.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScrewText {
    turn: f64,
    rise: f64,
}

fn screws(source: &Source, value: &RawValue) -> Result<ScrewLattice, SheetError> {
    let right = "two screw motions about z, [{ \"turn\": degrees, \"rise\": length }, { .. }], turns of -360 to 360";
    let both: [ScrewText; 2] = source.typed(value, || "`foldwell:lattice`".into(), right)?;
    if both.iter().any(|screw| screw.turn.abs() > 360.0) {
        return Err(source.mistyped(value, "`foldwell:lattice`".into(), right));
    }
    let [first, second] = both.map(|ScrewText { turn, rise }| (turn.to_radians(), rise));
    Ok(ScrewLattice { turn: [first.0, second.0], rise: [first.1, second.1] })
}

fn lattice(source: &Source, value: &RawValue) -> Result<[Vec3; 2], SheetError> {
    let right = "two lists of three numbers, [[x, y, z], [x, y, z]]";
    let [l1, l2]: [[f64; 3]; 2] = source.typed(value, || "`foldwell:lattice`".into(), right)?;
    Ok([l1.into(), l2.into()])
}

fn read_vertices<'a>(
    source: &Source<'a>,
    keys: &Values<'a>,
    drawn: &mut Drawing,
    rows: &mut RawMesh<'a>,
) -> Result<(), SheetError> {
    let missing = MeshProblem::Missing { key: "vertices_coords", right: "it should be a list of points" };
    let value = keys.get("vertices_coords").ok_or_else(|| source.at_value(None, missing))?;
    let right = "a list of points, [[x, y, z], ...]";
    rows.vertices = source.typed(value, || "`vertices_coords`".into(), right)?;
    let mut dimension = None;
    for (v, row) in rows.vertices.iter().enumerate() {
        let point: Vec<&RawValue> = source.typed(row, || format!("vertex {v}"), "a list of 2 or 3 numbers")?;
        let numbers =
            point.iter().map(|c| source.typed(c, || format!("a coordinate of vertex {v}"), "a finite number"));
        let numbers: Vec<f64> = numbers.collect::<Result<_, _>>()?;
        let first = *dimension.get_or_insert(if numbers.len() == 2 { 2 } else { 3 });
        if numbers.len() != first {
            let problem = MeshProblem::Dimension { vertex: v, found: numbers.len(), right: first };
            return Err(source.at(row, problem));
        }
        drawn.coords.push(Vec3::new(numbers[0], numbers[1], numbers.get(2).copied().unwrap_or(0.0)));
    }
    drawn.planar = dimension == Some(2);
    Ok(())
}

/// Reads a list of vertices for each polygon, which messages call `one` with its number.
fn polygons<'a>(
    source: &Source<'a>,
    rows: &[&'a RawValue],
    one: &str,
    count: usize,
) -> Result<Vec<Vec<usize>>, SheetError> {
    let read = |(k, row): (usize, &&'a RawValue)| source.indices(row, || format!("{one} {k}"), count);
    rows.iter().enumerate().map(read).collect()
}

/// Reads the named lists of vertices of a mesh with `count` drawn vertices.
fn read_names(source: &Source, keys: &Values, count: usize) -> Result<BTreeMap<String, Vec<usize>>, SheetError> {
    let Some(value) = keys.get("foldwell:names") else { return Ok(BTreeMap::new()) };
    let right = "an object of names and lists of vertices, {\"top\": [0, 1, 2], ...}";
    let lists: BTreeMap<String, &RawValue> = source.typed(value, || "`foldwell:names`".into(), right)?;
    let read = |(name, list): (String, &RawValue)| {
        let vertices = source.indices(list, || format!("the list `{name}` of `foldwell:names`"), count)?;
        Ok((name, vertices))
    };
    lists.into_iter().map(read).collect()
}

/// Adds to a defect of the mesh the line of the text that has the defective part.
fn located(source: &Source, keys: &Values, rows: &RawMesh, edges: &Edges, defect: Defect) -> SheetError {
    let row = match defect.place {
        MeshPart::Mesh => None,
        MeshPart::Vertex(v) => rows.vertices.get(v).copied(),
        MeshPart::Face(f) => rows.faces.get(f).copied(),
        MeshPart::Edge(e) => edges.rows.get(e).copied(),
        MeshPart::FoldAngle(e) => edges.angles.get(e).map(|(row, _)| *row),
        MeshPart::Lattice => keys.get("foldwell:lattice"),
        MeshPart::Hole(h) => rows.holes.get(h).copied(),
    };
    let whole = keys.get("faces_vertices").or(keys.get("edges_vertices")).or(keys.get("vertices_coords"));
    source.at_value(row.or(whole), *defect.problem)
}
