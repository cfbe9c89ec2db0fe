//! Reads the list of edges of a FOLD file, with their fold angles and assignments.

use serde_json::value::RawValue;

use super::keys::{GLUE, Values};
use super::locate::Source;
use crate::sheet::assignment::Assignment;
use crate::sheet::build::GluedEdge;
use crate::sheet::cell::Glue;
use crate::sheet::error::{MeshProblem, SheetError};

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
pub(super) fn read<'a>(source: &Source<'a>, keys: &Values<'a>, count: usize) -> Result<Edges<'a>, SheetError> {
    let mut edges = Edges::default();
    if let Some(value) = keys.get("edges_vertices") {
        edges.rows = source.typed(value, || "`edges_vertices`".into(), "a list of edges, [[0, 1], ...]")?;
    }
    edges.ends = edges.rows.iter().enumerate().map(|(e, row)| ends(source, row, e, count)).collect::<Result<_, _>>()?;
    edges.angles = angles(source, keys, edges.rows.len())?;
    edges.assignments = assignments(source, keys, edges.rows.len())?;
    Ok(edges)
}

fn ends(source: &Source, row: &RawValue, e: usize, count: usize) -> Result<[usize; 2], SheetError> {
    let what = || format!("edge {e} of the list");
    match source.indices(row, what, count)?[..] {
        [a, b] => Ok([a, b]),
        _ => Err(source.mistyped(row, what(), "a pair of vertex numbers")),
    }
}

fn angles<'a>(
    source: &Source<'a>,
    keys: &Values<'a>,
    count: usize,
) -> Result<Vec<(&'a RawValue, Option<f64>)>, SheetError> {
    let rows = per_edge(source, keys, ("edges_foldAngle", "a list of degrees and nulls"), count)?;
    let read = |(e, row): (usize, &&'a RawValue)| {
        let right = "a number of degrees or null";
        Ok((*row, source.typed(row, || format!("the fold angle of edge {e} of the list"), right)?))
    };
    rows.iter().enumerate().map(read).collect()
}

fn assignments(source: &Source, keys: &Values, count: usize) -> Result<Vec<Assignment>, SheetError> {
    let rows = per_edge(source, keys, ("edges_assignment", "a list of letters"), count)?;
    let read = |(e, row): (usize, &&RawValue)| {
        let right = "one of the capital letters \"B\", \"M\", \"V\", \"F\", \"U\", \"C\", \"J\"";
        let what = || format!("the assignment of edge {e} of the list");
        let letter: Option<String> = serde_json::from_str(row.get()).ok();
        letter.and_then(|letter| Assignment::from_letter(&letter)).ok_or_else(|| source.mistyped(row, what(), right))
    };
    rows.iter().enumerate().map(read).collect()
}

/// Reads the joints between the faces of edges of more than two faces, an entry for each edge: no word, one, or one for each
/// face.
pub(super) fn glue(source: &Source, keys: &Values, ends: &[[usize; 2]]) -> Result<Vec<GluedEdge>, SheetError> {
    let rows = per_edge(source, keys, (GLUE, "a list of words, lists of words, and nulls"), ends.len())?;
    let read = |(e, (row, ends)): (usize, (&&RawValue, &[usize; 2]))| {
        let right = "\"fold\", \"weld\", \"free\", a list of these, one for each face of the edge, or null";
        let one = serde_json::from_str::<Option<Glue>>(row.get()).map(|word| word.into_iter().collect());
        let words: Result<Vec<Glue>, _> = one.or_else(|_| serde_json::from_str(row.get()));
        words.map(|words| (*ends, words)).map_err(|_| source.mistyped(row, format!("entry {e} of `{GLUE}`"), right))
    };
    rows.iter().zip(ends).enumerate().map(read).collect()
}

/// Reads a list with an entry for each of `count` edges; an empty one if the frame does not have the key.
pub(super) fn per_edge<'a>(
    source: &Source<'a>,
    keys: &Values<'a>,
    (key, right): (&'static str, &'static str),
    count: usize,
) -> Result<Vec<&'a RawValue>, SheetError> {
    let Some(value) = keys.get(key) else { return Ok(vec![]) };
    let rows: Vec<&RawValue> = source.typed(value, || format!("`{key}`"), right)?;
    let wrong = MeshProblem::Length { key, found: rows.len(), right: count };
    if rows.len() == count { Ok(rows) } else { Err(source.at(value, wrong)) }
}

impl Edges<'_> {
    /// Returns the ends and the fold angle in radians of each edge; an empty list if the file gives no fold angles.
    pub(super) fn fold_angles(&self) -> Vec<([usize; 2], Option<f64>)> {
        let in_radians =
            |(ends, (_, degrees)): (&[usize; 2], &(&RawValue, Option<f64>))| (*ends, degrees.map(f64::to_radians));
        self.ends.iter().zip(&self.angles).map(in_radians).collect()
    }
}
