//! Flat crease patterns of FOLD files whose vertices are merged and whose edges are split before faces are found.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::value::RawValue;

use super::edges::Edges;
use super::keys::Keys;
use super::locate::Source;
use super::read::{Rows, read_drawing};
use super::{frames, record};
use crate::sheet::assignment::Assignment;
use crate::sheet::build::Drawing;
use crate::sheet::cell::Sheet;
use crate::sheet::error::SheetError;
use crate::sheet::pattern::{Cleanup, Line, sheet_of_lines};
use crate::sheet::pattern_fault::PatternFault;
use crate::sheet::record::FileRecord;
use crate::sheet::text;

/// Largest difference in z, relative to the extent, of a drawing that counts as flat.
const FLAT: f64 = 1e-9;

/// Keys of the sheet that are not kept where vertices and edges get other numbers.
const LOST: [&str; 3] = ["foldwell:stiffness", "foldwell:bar_stiffness", "foldwell:names"];

/// Reads one frame of the file at `path` as [`parse_cleaned`] does.
///
/// # Errors
/// [`SheetError::Read`] if the file does not exist or cannot be read, otherwise as [`parse_cleaned`].
pub fn read_cleaned(path: &Path, frame: Option<usize>, cleanup: &Cleanup) -> Result<Sheet, SheetError> {
    let text = text::read_text(path).map_err(|source| SheetError::Read { path: path.to_owned(), source })?;
    parse_cleaned(&text, &path.display().to_string(), frame, cleanup)
}

/// Reads one frame of a FOLD text, a flat crease pattern, with its vertices merged and its edges split. The faces are
/// found from the edges; keys about the file and its frame are kept, with the letters and target angles of the edges.
///
/// # Errors
/// As [`parse_frame`](super::parse_frame); also if the pattern is folded or periodic, or edges that lie on each other
/// have different letters or angles.
pub fn parse_cleaned(text: &str, name: &str, frame: Option<usize>, cleanup: &Cleanup) -> Result<Sheet, SheetError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let source = Source { name, text };
    let frame = frames::choose(&source, frame)?;
    let keys = Keys::new(&frame.values);
    let (drawn, rows, mut edges) = read_drawing(&source, &keys)?;
    if let Some(found) = no_flat_pattern(&drawn) {
        return Err(source.at_start(PatternFault::NotFlat { found }.into()));
    }
    let (lines, places): (Vec<Line>, Vec<&RawValue>) = lines(&drawn, &edges, &rows).into_iter().unzip();
    let title = Drawing { title: drawn.title.clone(), description: drawn.description.clone(), ..Drawing::default() };
    let mut sheet = sheet_of_lines(&lines, cleanup, title).map_err(|(line, problem)| match line {
        Some(line) => source.at(places[line], *problem),
        None => source.at_start(*problem),
    })?;
    edges.rebuilt = true;
    sheet.record = FileRecord { gap: sheet.record.gap, ..record::read_renumbered(&frame, &edges) };
    let lost = LOST.into_iter().filter(|key| frame.values.get(key).is_some());
    sheet.record.left_out.extend(lost.map(str::to_owned));
    Ok(sheet)
}

/// Returns what a drawing is if it is not a flat crease pattern.
fn no_flat_pattern(drawn: &Drawing) -> Option<&'static str> {
    let first = drawn.coords.first().copied().unwrap_or_default();
    let [low, high] = drawn.coords.iter().fold([first; 2], |[low, high], x| [low.inf(x), high.sup(x)]);
    if drawn.is_repeated() {
        Some("this sheet is periodic")
    } else if drawn.folded {
        Some("this frame is a folded form")
    } else if high.z - low.z > FLAT * (high - low).max() {
        Some("the vertices of this mesh differ in z")
    } else {
        None
    }
}

/// Returns the edges of a drawing as lines, each with its place in the text; sides of faces that are not listed have
/// the letter B or U.
fn lines<'a>(drawn: &Drawing, edges: &Edges<'a>, rows: &Rows<'a>) -> Vec<(Line, &'a RawValue)> {
    let sorted = |[a, b]: [usize; 2]| [a.min(b), a.max(b)];
    let line = |ends: [usize; 2], letter: Assignment, angle: Option<f64>| {
        let ends = ends.map(|v| drawn.coords[v].xy());
        Line { ends, letter, angle, auxiliary: false, place: [1, 1], flipped: false }
    };
    let listed = edges.ends.iter().enumerate().map(|(e, ends)| {
        let letter = edges.assignments.get(e).copied().unwrap_or(Assignment::Unassigned);
        let angle = edges.angles.get(e).and_then(|(_, angle)| *angle);
        (line(*ends, letter, angle), edges.rows[e])
    });
    let mut sides: BTreeMap<[usize; 2], (usize, usize)> = BTreeMap::new();
    for (f, face) in drawn.faces.iter().enumerate() {
        for (k, &a) in face.iter().enumerate() {
            sides.entry(sorted([a, face[(k + 1) % face.len()]])).or_insert((f, 0)).1 += 1;
        }
    }
    for ends in &edges.ends {
        sides.remove(&sorted(*ends));
    }
    let others = sides.into_iter().map(|(ends, (face, count))| {
        let letter = if count == 1 { Assignment::Boundary } else { Assignment::Unassigned };
        (line(ends, letter, None), rows.faces[face])
    });
    listed.chain(others).collect()
}
