//! Flat crease patterns of FOLD files whose vertices are merged and whose edges are split before faces are found.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Rotation3};
use serde_json::value::RawValue;

use super::edges::Edges;
use super::frames::FoldFrame;
use super::locate::Source;
use super::read::{RawMesh, ReadFrame};
use super::record;
use crate::math::{Vec3, bounds};
use crate::numerics::dense::small::symmetric_eigen_3;
use crate::sheet::assignment::Assignment;
use crate::sheet::build::{Drawing, sides_seen};
use crate::sheet::cell::Sheet;
use crate::sheet::error::SheetError;
use crate::sheet::pattern::{Cleanup, PatternLine, sheet_of_lines};
use crate::sheet::pattern_fault::PatternFault;
use crate::sheet::record::FileRecord;
use crate::sheet::sides::{sides, sorted};

/// Largest difference in z, relative to the extent, of a drawing that counts as flat.
const FLAT: f64 = 1e-9;

/// Distance, relative to the extent, within which vertices of a file that is read as it is listed are one.
const ONE_PLACE: f64 = 1e-9;

/// Keys of the sheet that are not kept where vertices and edges get other numbers.
const LOST: [&str; 4] = ["foldwell:stiffness", "foldwell:bar_stiffness", "foldwell:glue", "foldwell:names"];

/// Returns the sheet of a flat crease pattern in any plane, with its vertices merged and its edges split.
pub(super) fn sheet(
    source: &Source,
    frame: &FoldFrame,
    (mut drawn, rows, mut edges): ReadFrame,
    cleanup: &Cleanup,
) -> Result<Sheet, SheetError> {
    let turn = laid_flat(&drawn).map_err(|found| source.at_value(None, PatternFault::NotFlat { found }.into()))?;
    drawn.coords.iter_mut().for_each(|x| *x = turn * *x);
    let (parts, places): (Vec<LetteredEdge>, Vec<&RawValue>) = parts(&drawn, &edges, &rows).into_iter().unzip();
    // faces are found anew, and look up
    let is_behind = sides_seen(&drawn) == [false, true];
    let line = |part: &LetteredEdge| {
        let ends = part.ends.map(|v| drawn.coords[v].xy());
        let LetteredEdge { mut letter, mut angle, auxiliary, .. } = *part;
        if is_behind {
            (letter, angle) = (letter.seen_from_behind(), angle.map(|angle| -angle));
        }
        PatternLine { ends, letter, angle, auxiliary, contour: false, at: 0, flipped: false }
    };
    let lines: Vec<PatternLine> = parts.iter().map(line).collect();
    let head = Drawing { title: drawn.title.clone(), description: drawn.description.clone(), ..Drawing::default() };
    let mut sheet = sheet_of_lines(&lines, cleanup, &head)
        .map_err(|(line, problem)| source.at_value(line.map(|line| places[line]), *problem))?;
    let height = Vec3::new(0.0, 0.0, drawn.coords[0].z);
    sheet.vertices.iter_mut().for_each(|x| *x = turn.inverse() * (*x + height));
    edges.rebuilt = true;
    sheet.record = FileRecord { redrawing: sheet.record.redrawing, ..record::record(frame, &edges, false) };
    let lost = LOST.into_iter().filter(|key| frame.values.get(key).is_some());
    sheet.record.left_out.extend(lost.map(str::to_owned));
    Ok(sheet)
}

/// Returns the clean-up of a flat pattern with auxiliary edges that end inside a face, or with cuts of one edge; `None`
/// if it has none of these.
pub(super) fn needed((drawn, rows, edges): &ReadFrame) -> Option<Cleanup> {
    if edges.ends.is_empty() || laid_flat(drawn).is_err() {
        return None;
    }
    let parts = parts(drawn, edges, rows);
    let degrees = |counts: fn(&LetteredEdge) -> bool| {
        let mut degrees = vec![0; drawn.coords.len()];
        let counted = parts.iter().filter(|(part, _)| counts(part));
        counted.flat_map(|(part, _)| part.ends).for_each(|v| degrees[v] += 1);
        degrees
    };
    let (all, open) = (degrees(|_| true), degrees(LetteredEdge::is_open));
    let is_loose = |part: &LetteredEdge| part.auxiliary && part.ends.iter().any(|&v| all[v] == 1);
    let is_slit = |part: &LetteredEdge| part.letter == Assignment::Cut && part.ends.iter().all(|&v| open[v] == 1);
    let extent = drawn.coords.iter().map(|x| (x - drawn.coords[0]).amax()).fold(0.0, f64::max);
    let needed = parts.iter().any(|(part, _)| is_loose(part) || is_slit(part));
    needed.then_some(Cleanup { merge: Some(ONE_PLACE * extent), split: false })
}

/// Returns the rotation that lays a flat crease pattern into a plane of constant z; what the drawing is if it is none.
fn laid_flat(drawn: &Drawing) -> Result<Rotation3<f64>, &'static str> {
    let [low, high] = bounds(&drawn.coords);
    let thin = FLAT * (high - low).max();
    if drawn.is_repeated() {
        return Err("this sheet is periodic");
    } else if drawn.folded {
        return Err("this frame is a folded form");
    } else if high.z - low.z <= thin {
        return Ok(Rotation3::identity());
    }
    let centre = drawn.coords.iter().sum::<Vec3>() / drawn.coords.len() as f64;
    let moments: Matrix3<f64> = drawn.coords.iter().map(|x| (x - centre) * (x - centre).transpose()).sum();
    let (values, vectors) = symmetric_eigen_3(moments);
    let normal: Vec3 = vectors.column(values.imin()).into();
    let lies_in_plane = drawn.coords.iter().all(|x| (x - centre).dot(&normal).abs() <= thin);
    let turn = Rotation3::rotation_between(&(normal * normal[normal.iamax()].signum()), &Vec3::z());
    turn.filter(|_| lies_in_plane).ok_or("the vertices of this mesh lie in no plane")
}

/// An edge of a drawing.
struct LetteredEdge {
    ends: [usize; 2],
    letter: Assignment,
    angle: Option<f64>,
    auxiliary: bool,
}

impl LetteredEdge {
    /// Whether the sheet ends at the edge, on one side of it or on both.
    fn is_open(&self) -> bool {
        matches!(self.letter, Assignment::Cut | Assignment::Boundary)
    }
}

/// Returns the edges of a drawing, each with its place in the text; sides of faces that are not listed have the letter
/// B or U.
fn parts<'a>(drawn: &Drawing, edges: &Edges<'a>, rows: &RawMesh<'a>) -> Vec<(LetteredEdge, &'a RawValue)> {
    let listed = edges.ends.iter().enumerate().map(|(e, &ends)| {
        let given = edges.assignments.get(e).copied();
        let letter = given.unwrap_or(Assignment::Unassigned);
        let angle = edges.angles.get(e).and_then(|(_, angle)| *angle);
        let auxiliary = matches!(given, Some(Assignment::Flat | Assignment::Unassigned));
        (LetteredEdge { ends, letter, angle, auxiliary }, edges.rows[e])
    });
    let mut unlisted: BTreeMap<[usize; 2], (usize, usize)> = BTreeMap::new();
    for (f, face) in drawn.faces.iter().enumerate() {
        sides(face).for_each(|side| unlisted.entry(sorted(side)).or_insert((f, 0)).1 += 1);
    }
    for ends in &edges.ends {
        unlisted.remove(&sorted(*ends));
    }
    let others = unlisted.into_iter().map(|(ends, (face, count))| {
        let letter = if count == 1 { Assignment::Boundary } else { Assignment::Unassigned };
        (LetteredEdge { ends, letter, angle: None, auxiliary: false }, rows.faces[face])
    });
    listed.chain(others).collect()
}
