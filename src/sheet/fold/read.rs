//! Reading sheets from FOLD files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::value::RawValue;

use super::edges::{self, Edges};
use super::keys::Keys;
use super::locate::Source;
use super::{record, stiffness};
use crate::math::Vec3;
use crate::sheet::assignment::Assignment;
use crate::sheet::build::{Drawing, build_identified, planar};
use crate::sheet::cell::Sheet;
use crate::sheet::error::{Defect, MeshPart, Problem, SheetError};
use crate::sheet::text;

/// The parts of the mesh as they stand in the text, for the line of messages.
#[derive(Default)]
struct Rows<'a> {
    vertices: Vec<&'a RawValue>,
    faces: Vec<&'a RawValue>,
    holes: Vec<&'a RawValue>,
}

/// Reads the sheet of the file at `path`.
///
/// # Errors
/// [`SheetError::Read`] if the file does not exist or cannot be read, otherwise as [`parse`].
pub fn read(path: &Path) -> Result<Sheet, SheetError> {
    let text = text::read_text(path).map_err(|source| SheetError::Read { path: path.to_owned(), source })?;
    parse(&text, &path.display().to_string())
}

/// Reads the sheet of a FOLD text. `name` is the name of its file: it appears in messages, and is the title if the
/// file has none.
///
/// # Errors
/// [`SheetError::Bad`] with line, column, and the vertex, face or edge that is wrong.
pub fn parse(text: &str, name: &str) -> Result<Sheet, SheetError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let source = Source { name, text };
    let keys: Keys = serde_json::from_str(text).map_err(|e| source.syntax(&e))?;
    let mut rows = Rows::default();
    let mut drawn = head(&source, &keys)?;
    read_vertices(&source, &keys, &mut drawn, &mut rows)?;
    let edges = edges::read(&source, &keys, drawn.coords.len())?;
    drawn.assignments = edges.ends.iter().copied().zip(edges.assignments.iter().copied()).collect();
    drawn.fold_angles = edges.fold_angles();
    read_faces(&source, &keys, &mut drawn, &mut rows, &edges)?;
    read_holes(&source, &keys, &mut drawn, &mut rows)?;
    drawn.names = read_names(&source, &keys, drawn.coords.len())?;
    let locate = |defect| located(&source, &keys, &rows, &edges, defect);
    if keys.faces_vertices.is_none() {
        drawn.faces = planar::faces_of(&drawn, &edges.ends).map_err(locate)?;
        drop_openings(&mut drawn);
        drop_holes(&mut drawn);
    }
    let (mut sheet, identified) = build_identified(&drawn).map_err(locate)?;
    edges::check(&source, &edges, &sheet, &identified)?;
    sheet.stiffness = stiffness::read(&source, &keys, &edges, &sheet, &identified)?;
    sheet.record = record::read(&source)?;
    Ok(sheet)
}

fn head(source: &Source, keys: &Keys) -> Result<Drawing, SheetError> {
    let string = |value: Option<&RawValue>, key: &str| -> Result<Option<String>, SheetError> {
        value.map(|v| source.typed(v, || format!("`{key}`"), "a text in quotes")).transpose()
    };
    let stem = || Path::new(source.name).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(Drawing {
        title: string(keys.file_title, "file_title")?.unwrap_or_else(stem),
        description: string(keys.file_description, "file_description")?.unwrap_or_default(),
        lattice: keys.lattice.map(|value| lattice(source, value)).transpose()?,
        ..Drawing::default()
    })
}

fn lattice(source: &Source, value: &RawValue) -> Result<[Vec3; 2], SheetError> {
    let right = "two lists of three numbers, [[x, y, z], [x, y, z]]";
    let [l1, l2]: [[f64; 3]; 2] = source.typed(value, || "`foldwell:lattice`".into(), right)?;
    Ok([l1.into(), l2.into()])
}

fn read_vertices<'a>(
    source: &Source<'a>,
    keys: &Keys<'a>,
    drawn: &mut Drawing,
    rows: &mut Rows<'a>,
) -> Result<(), SheetError> {
    let right = "a list of points, [[x, y, z], ...]";
    let missing =
        || source.at_start(Problem::Missing { key: "vertices_coords", right: "it should be a list of points" });
    rows.vertices = source.list(keys.vertices_coords.ok_or_else(missing)?, || "`vertices_coords`".into(), right)?;
    let mut dimension = None;
    for (v, row) in rows.vertices.iter().enumerate() {
        let point = source.list(row, || format!("vertex {v}"), "a list of 2 or 3 numbers")?;
        let numbers =
            point.iter().map(|c| source.typed(c, || format!("a coordinate of vertex {v}"), "a finite number"));
        let numbers: Vec<f64> = numbers.collect::<Result<_, _>>()?;
        let first = *dimension.get_or_insert(if numbers.len() == 2 { 2 } else { 3 });
        if numbers.len() != first {
            let problem = Problem::Dimension { vertex: v, found: numbers.len(), right: first };
            return Err(source.at(row, problem));
        }
        drawn.coords.push(Vec3::new(numbers[0], numbers[1], numbers.get(2).copied().unwrap_or(0.0)));
    }
    drawn.planar = dimension == Some(2);
    Ok(())
}

fn read_faces<'a>(
    source: &Source<'a>,
    keys: &Keys<'a>,
    drawn: &mut Drawing,
    rows: &mut Rows<'a>,
    edges: &Edges<'a>,
) -> Result<(), SheetError> {
    match keys.faces_vertices {
        Some(value) => {
            rows.faces = source.list(value, || "`faces_vertices`".into(), "a list of faces, [[0, 1, 2], ...]")?;
            let count = drawn.coords.len();
            let faces =
                rows.faces.iter().enumerate().map(|(f, row)| source.indices(row, || format!("face {f}"), count));
            drawn.faces = faces.collect::<Result<_, _>>()?;
            Ok(())
        }
        None if edges.ends.is_empty() => Err(source.at_start(Problem::Missing {
            key: "faces_vertices",
            right: "it, or at least `edges_vertices`, should list the faces",
        })),
        None => Ok(()),
    }
}

fn read_holes<'a>(
    source: &Source<'a>,
    keys: &Keys<'a>,
    drawn: &mut Drawing,
    rows: &mut Rows<'a>,
) -> Result<(), SheetError> {
    let Some(value) = keys.holes else { return Ok(()) };
    rows.holes = source.list(value, || "`foldwell:holes`".into(), "a list of openings, [[0, 1, 2], ...]")?;
    let count = drawn.coords.len();
    let holes = rows.holes.iter().enumerate().map(|(h, row)| source.indices(row, || format!("opening {h}"), count));
    drawn.holes = holes.collect::<Result<_, _>>()?;
    Ok(())
}

/// Reads the named lists of vertices of a mesh with `count` drawn vertices.
fn read_names(source: &Source, keys: &Keys, count: usize) -> Result<BTreeMap<String, Vec<usize>>, SheetError> {
    let Some(value) = keys.names else { return Ok(BTreeMap::new()) };
    let right = "an object of names and lists of vertices, {\"top\": [0, 1, 2], ...}";
    let lists: BTreeMap<String, &RawValue> = source.typed(value, || "`foldwell:names`".into(), right)?;
    let read = |(name, list): (String, &RawValue)| {
        let vertices = source.indices(list, || format!("the list `{name}` of `foldwell:names`"), count)?;
        Ok((name, vertices))
    };
    lists.into_iter().map(read).collect()
}

/// Removes rebuilt faces that are listed as openings.
fn drop_openings(drawn: &mut Drawing) {
    let sorted = |list: &Vec<usize>| {
        let mut list = list.clone();
        list.sort_unstable();
        list
    };
    let holes: Vec<_> = drawn.holes.iter().map(sorted).collect();
    drawn.faces.retain(|face| !holes.contains(&sorted(face)));
}

/// Removes rebuilt faces that the assignments show to be holes: all their sides are boundaries, and every side has a
/// face on its other side.
fn drop_holes(drawn: &mut Drawing) {
    let sorted = |[a, b]: [usize; 2]| [a.min(b), a.max(b)];
    let boundary = drawn.assignments.iter().filter(|(_, assignment)| *assignment == Assignment::Boundary);
    let boundary: BTreeSet<[usize; 2]> = boundary.map(|(ends, _)| sorted(*ends)).collect();
    let sides = |face: &Vec<usize>| -> Vec<[usize; 2]> {
        (0..face.len()).map(|k| sorted([face[k], face[(k + 1) % face.len()]])).collect()
    };
    let mut faces: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    drawn.faces.iter().flat_map(sides).for_each(|side| *faces.entry(side).or_default() += 1);
    drawn.faces.retain(|face| !sides(face).iter().all(|side| boundary.contains(side) && faces[side] == 2));
}

/// Adds to a defect of the mesh the line of the text that has the defective part.
fn located(source: &Source, keys: &Keys, rows: &Rows, edges: &Edges, defect: Defect) -> SheetError {
    let row = match defect.place {
        MeshPart::Mesh => None,
        MeshPart::Vertex(v) => rows.vertices.get(v).copied(),
        MeshPart::Face(f) => rows.faces.get(f).copied(),
        MeshPart::Edge(e) => edges.rows.get(e).copied(),
        MeshPart::FoldAngle(e) => edges.angles.get(e).map(|(row, _)| *row),
        MeshPart::Lattice => keys.lattice,
        MeshPart::Hole(h) => rows.holes.get(h).copied(),
    };
    let whole = keys.faces_vertices.or(keys.edges_vertices).or(keys.vertices_coords);
    match row.or(whole) {
        Some(value) => source.at(value, *defect.problem),
        None => source.at_start(*defect.problem),
    }
}
