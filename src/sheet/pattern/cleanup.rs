//! Conversion of the lines of a crease pattern to the mesh that they draw.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::arrangement::{Arrangement, Piece, arrange};
use super::line::Line;
use crate::math::{Vec2, Vec3};
use crate::sheet::build::{Drawing, build_identified, listed_order, rebuild_faces};
use crate::sheet::cell::Sheet;
use crate::sheet::error::{Defect, MeshPart, Problem};
use crate::sheet::pattern_fault::PatternFault;

/// Distance within which points of a drawing of lines are one point, relative to its extent: drawing programs write two
/// decimals of a point or pixel, 1e-5 of a usual page.
const SAME_POINT: f64 = 1e-4;

/// Largest distance of merging, relative to the extent.
const COARSEST: f64 = 0.1;

/// Largest difference of two fold angles in degrees that lines on each other may have.
const SAME_ANGLE_DEG: f64 = 1e-3;

/// Options for the clean-up of vertices and edges of a flat crease pattern, before its faces are found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cleanup {
    /// Distance within which vertices are merged, in units of the drawing; `None` for 1e-4 of its extent, the larger
    /// one of width and height.
    pub merge: Option<f64>,
    /// Whether edges are split where they cross or touch each other.
    pub split: bool,
}

/// A problem together with the number of the line that has it; `None` for the pattern as a whole.
pub(crate) type Misdrawn = (Option<usize>, Box<Problem>);

/// Returns the sheet whose creases and rim are `lines`, with the title and description of `head`. Its vertices are
/// numbered in the order of the lines.
pub(crate) fn sheet(lines: &[Line], cleanup: &Cleanup, head: Drawing) -> Result<Sheet, Misdrawn> {
    let tolerance = tolerance(lines, cleanup)?;
    let ends: Vec<[Vec2; 2]> = lines.iter().map(|line| line.ends).collect();
    let Arrangement { points, pieces } = arrange(&ends, tolerance, cleanup.split);
    let pieces = without_dangling(lines, &points, without_doubles(lines, &pieces)?);
    let (coords, pieces) = renumbered(&points, &pieces);
    let mut drawn = Drawing { coords, planar: true, ..head };
    let of = |piece: &Piece| &lines[piece.segment];
    let edges: Vec<[usize; 2]> = pieces.iter().map(|piece| piece.ends).collect();
    drawn.assignments = pieces.iter().map(|piece| (piece.ends, of(piece).letter)).collect();
    let angle = |piece: &Piece| (piece.ends, of(piece).angle.map(f64::to_radians));
    if pieces.iter().any(|piece| of(piece).angle.is_some()) {
        drawn.fold_angles = pieces.iter().map(angle).collect();
    }
    let located = |defect: Defect| located(lines, &pieces, defect);
    rebuild_faces(&mut drawn, &edges).map_err(located)?;
    let (mut sheet, identified) = build_identified(&drawn).map_err(located)?;
    let order = listed_order(&drawn, &edges);
    sheet.listed_edges = order.into_iter().map(|ends| ends.map(|v| identified.corner[v])).collect();
    Ok(sheet)
}

/// Returns the distance within which points are merged.
fn tolerance(lines: &[Line], cleanup: &Cleanup) -> Result<f64, Misdrawn> {
    let wild = |line: &Line| line.ends.iter().flat_map(|end| end.iter()).any(|c| !(0.0..=1e50).contains(&c.abs()));
    if let Some(k) = lines.iter().position(wild) {
        return Err((Some(k), PatternFault::Coordinate { line: lines[k].name() }.into()));
    }
    let Some(first) = lines.first().map(|line| line.ends[0]) else {
        return Err((None, PatternFault::Empty { right: "draw mountains, valleys and the boundary as lines" }.into()));
    };
    let ends = || lines.iter().flat_map(|line| line.ends);
    let [low, high] = ends().fold([first; 2], |[low, high], end| [low.inf(&end), high.sup(&end)]);
    let extent = (high - low).max();
    if extent == 0.0 {
        return Err((Some(0), PatternFault::Empty { right: "all lines have the length 0" }.into()));
    }
    match cleanup.merge {
        None => Ok(SAME_POINT * extent),
        Some(found) if found > 0.0 && found <= COARSEST * extent => Ok(found),
        Some(found) => Err((None, PatternFault::Tolerance { found, extent }.into())),
    }
}

/// Returns the pieces without those that lie on earlier ones, which have to mean the same.
fn without_doubles(lines: &[Line], pieces: &[Piece]) -> Result<Vec<Piece>, Misdrawn> {
    let mut known: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    let mut kept: Vec<Piece> = Vec::new();
    for piece in pieces {
        let [a, b] = piece.ends;
        match known.entry([a.min(b), a.max(b)]) {
            Entry::Vacant(free) => {
                free.insert(kept.len());
                kept.push(*piece);
            }
            Entry::Occupied(taken) => {
                let before = &mut kept[*taken.get()];
                let [first, second] = [before.segment, piece.segment].map(|k| &lines[k]);
                if first.auxiliary && !second.auxiliary {
                    before.segment = piece.segment;
                } else if !second.auxiliary && !agree(first, second) {
                    let meanings = [first, second].map(|line| (line.letter, line.angle));
                    let fault = PatternFault::Overlap { a: first.name(), b: second.name(), meanings };
                    return Err((Some(piece.segment), fault.into()));
                }
            }
        }
    }
    Ok(kept)
}

fn agree(a: &Line, b: &Line) -> bool {
    let same_angle = match (a.angle, b.angle) {
        (Some(a), Some(b)) => (a - b).abs() <= SAME_ANGLE_DEG,
        (a, b) => a == b,
    };
    a.letter == b.letter && same_angle
}

/// Returns the pieces without auxiliary ones that end where nothing else is.
fn without_dangling(lines: &[Line], points: &[Vec2], mut pieces: Vec<Piece>) -> Vec<Piece> {
    loop {
        let mut degree = vec![0; points.len()];
        pieces.iter().flat_map(|piece| piece.ends).for_each(|v| degree[v] += 1);
        let before = pieces.len();
        pieces.retain(|piece| !lines[piece.segment].auxiliary || piece.ends.iter().all(|&v| degree[v] > 1));
        if pieces.len() == before {
            return pieces;
        }
    }
}

/// Returns the points that pieces have, in the order of the pieces, and the pieces with their numbers.
fn renumbered(points: &[Vec2], pieces: &[Piece]) -> (Vec<Vec3>, Vec<Piece>) {
    let mut numbers: Vec<Option<usize>> = vec![None; points.len()];
    let mut coords = Vec::new();
    let mut number = |v: usize| {
        *numbers[v].get_or_insert_with(|| {
            coords.push(points[v].push(0.0));
            coords.len() - 1
        })
    };
    let pieces = pieces.iter().map(|piece| Piece { ends: piece.ends.map(&mut number), ..*piece }).collect();
    (coords, pieces)
}

/// Says a defect of the mesh in terms of the lines.
fn located(lines: &[Line], pieces: &[Piece], defect: Defect) -> Misdrawn {
    let piece = match defect.place {
        MeshPart::Edge(e) | MeshPart::FoldAngle(e) => pieces.get(e),
        MeshPart::Vertex(v) => pieces.iter().find(|piece| piece.ends.contains(&v)),
        _ => None,
    };
    let number = piece.map(|piece| piece.segment);
    let problem = match (*defect.problem, number.map(|k| lines[k].name())) {
        (Problem::LooseEdge { .. }, Some(line)) => PatternFault::Loose { line }.into(),
        (Problem::Pieces { pieces }, _) => PatternFault::Pieces { pieces }.into(),
        (problem, Some(line)) => PatternFault::Line { line, problem: problem.to_string() }.into(),
        (problem, None) => Box::new(problem),
    };
    (number, problem)
}
