//! Reads the list of edges of a FOLD file, with their fold angles and assignments.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::value::RawValue;

use super::keys::Keys;
use super::locate::Source;
use crate::sheet::assignment::Assignment;
use crate::sheet::build::{Identified, edges_by_drawn_name};
use crate::sheet::cell::{Corner, EdgeKey, Sheet};
use crate::sheet::error::{DrawnEdge, Problem, SheetError};

/// The edges of a file; the lists are empty if the file does not have the keys.
#[derive(Default)]
pub(super) struct Edges<'a> {
    /// Each edge as it stands in the text, for the line of messages.
    pub rows: Vec<&'a RawValue>,
    /// Numbers of the two vertices of each edge.
    pub ends: Vec<[usize; 2]>,
    /// Fold angle in degrees of each edge, `None` for null, together with its place in the text.
    pub angles: Vec<(&'a RawValue, Option<f64>)>,
    /// Whether the faces are rebuilt from the edges.
    pub rebuilt: bool,
    /// Assignment of each edge.
    pub assignments: Vec<Assignment>,
}

/// Reads the list of edges of a mesh with `count` drawn vertices.
pub(super) fn read<'a>(source: &Source<'a>, keys: &Keys<'a>, count: usize) -> Result<Edges<'a>, SheetError> {
    let mut edges = Edges::default();
    if let Some(value) = keys.edges_vertices {
        edges.rows = source.list(value, || "`edges_vertices`".into(), "a list of edges, [[0, 1], ...]")?;
    }
    let mut seen = BTreeMap::new();
    for (e, row) in edges.rows.iter().enumerate() {
        let [a, b] = ends(source, row, e, count)?;
        if let Some(other) = seen.insert([a.min(b), a.max(b)], e) {
            let problem = Problem::DuplicateEdge { edge: e, other, ends: DrawnEdge(a, b) };
            return Err(source.at(row, problem));
        }
        edges.ends.push([a, b]);
    }
    edges.angles = angles(source, keys, edges.rows.len())?;
    edges.assignments = assignments(source, keys, edges.rows.len())?;
    Ok(edges)
}

fn ends(source: &Source, row: &RawValue, e: usize, count: usize) -> Result<[usize; 2], SheetError> {
    let what = || format!("edge {e} of the list");
    match source.indices(row, what, count)?[..] {
        [a, b] if a == b => Err(source.at(row, Problem::Loop { edge: e, vertex: a })),
        [a, b] => Ok([a, b]),
        _ => Err(source.mistyped(row, what(), "a pair of vertex numbers")),
    }
}

fn angles<'a>(
    source: &Source<'a>,
    keys: &Keys<'a>,
    count: usize,
) -> Result<Vec<(&'a RawValue, Option<f64>)>, SheetError> {
    let Some(value) = keys.edges_fold_angle else { return Ok(Vec::new()) };
    let rows = source.list(value, || "`edges_foldAngle`".into(), "a list of degrees and nulls")?;
    check_length(source, value, "edges_foldAngle", rows.len(), count)?;
    let read = |(e, row): (usize, &&'a RawValue)| {
        let right = "a number of degrees or null";
        Ok((*row, source.typed(row, || format!("the fold angle of edge {e} of the list"), right)?))
    };
    rows.iter().enumerate().map(read).collect()
}

fn assignments(source: &Source, keys: &Keys, count: usize) -> Result<Vec<Assignment>, SheetError> {
    let Some(value) = keys.edges_assignment else { return Ok(Vec::new()) };
    let rows = source.list(value, || "`edges_assignment`".into(), "a list of letters")?;
    check_length(source, value, "edges_assignment", rows.len(), count)?;
    let read = |(e, row): (usize, &&RawValue)| {
        let right = "one of \"B\", \"M\", \"V\", \"F\", \"U\", \"C\", \"J\"";
        let what = || format!("the assignment of edge {e} of the list");
        let letter: Option<String> = serde_json::from_str(row.get()).ok();
        letter.and_then(|letter| Assignment::from_letter(&letter)).ok_or_else(|| source.mistyped(row, what(), right))
    };
    rows.iter().enumerate().map(read).collect()
}

pub(super) fn check_length(
    source: &Source,
    value: &RawValue,
    key: &'static str,
    found: usize,
    right: usize,
) -> Result<(), SheetError> {
    if found == right { Ok(()) } else { Err(source.at(value, Problem::Length { key, found, right })) }
}

impl Edges<'_> {
    /// Returns the ends and the fold angle in radians of each edge; an empty list if the file gives no fold angles.
    pub(super) fn fold_angles(&self) -> Vec<([usize; 2], Option<f64>)> {
        let in_radians =
            |(ends, (_, degrees)): (&[usize; 2], &(&RawValue, Option<f64>))| (*ends, degrees.map(f64::to_radians));
        self.ends.iter().zip(&self.angles).map(in_radians).collect()
    }
}

/// Checks that every listed edge is a side of a face.
pub(super) fn check(source: &Source, edges: &Edges, sheet: &Sheet, identified: &Identified) -> Result<(), SheetError> {
    let known = edges_by_drawn_name(sheet);
    let sides = sides(sheet);
    for (e, (row, ends)) in edges.rows.iter().zip(&edges.ends).enumerate() {
        let [a, b] = ends.map(|v| identified.corner[v]);
        let found = known.get(&EdgeKey::new(a, b).0).and_then(|numbers| numbers.first()).map(|&n| &sheet.edges[n]);
        if !found.is_some_and(|edge| sides.contains(&edge.key)) {
            let ends = DrawnEdge(ends[0], ends[1]);
            return Err(source.at(row, Problem::LooseEdge { edge: e, ends }));
        }
    }
    Ok(())
}

/// Returns the edges that are sides, and not diagonals, of polygons.
fn sides(sheet: &Sheet) -> BTreeSet<EdgeKey> {
    let sides = |polygon: &Vec<Corner>| {
        (0..polygon.len()).map(|k| EdgeKey::new(polygon[k], polygon[(k + 1) % polygon.len()]).0).collect::<Vec<_>>()
    };
    sheet.polygons.iter().flat_map(sides).collect()
}
