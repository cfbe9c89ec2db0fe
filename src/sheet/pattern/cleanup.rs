//! Conversion of the lines of a crease pattern to the mesh that they draw.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

use super::arrangement::{Arrangement, Piece, arrange};
use super::line::Line;
use crate::math::{Vec2, Vec3};
use crate::sheet::boxes::{around, for_pairs_that_meet};
use crate::sheet::build::{Drawing, build_identified, listed_order, rebuild_faces};
use crate::sheet::cell::Sheet;
use crate::sheet::error::{Defect, MeshPart, Problem};
use crate::sheet::pattern_fault::PatternFault;

/// Distance within which points of a drawing of lines are one point, relative to its extent: drawing programs write two
/// decimals of a point or pixel, 1e-5 of a usual page.
const SAME_POINT: f64 = 1e-4;

/// Largest distance of merging, relative to the extent.
const COARSEST: f64 = 0.1;

/// Distance, in distances of merging, below which two points may be meant as one: ends drawn with an error a little
/// above that distance are this far apart.
const CLOSE: f64 = 3.0;

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
    let tangled = |k: usize| (Some(k), PatternFault::Tangled { line: lines[k].name(), tolerance }.into());
    let Arrangement { points, pieces } = arrange(&ends, tolerance, cleanup.split).map_err(tangled)?;
    let gap = |pieces: &[Piece], at: Option<Piece>| gap(&points, pieces, at, tolerance);
    let doubled = |(piece, fault): (Piece, Box<PatternFault>)| {
        let fault = gap(&pieces, Some(piece)).map_or(*fault, |ends| apart(lines, ends, tolerance));
        (Some(piece.segment), fault.into())
    };
    let arranged = without_dangling(lines, &points, without_doubles(lines, &pieces).map_err(doubled)?);
    let (coords, pieces) = renumbered(&points, &arranged);
    let mut drawn = Drawing { coords, planar: true, ..head };
    let of = |piece: &Piece| &lines[piece.segment];
    let edges: Vec<[usize; 2]> = pieces.iter().map(|piece| piece.ends).collect();
    drawn.assignments = pieces.iter().map(|piece| (piece.ends, of(piece).letter)).collect();
    let angle = |piece: &Piece| (piece.ends, of(piece).angle.map(f64::to_radians));
    if pieces.iter().any(|piece| of(piece).angle.is_some()) {
        drawn.fold_angles = pieces.iter().map(angle).collect();
    }
    let located = |defect: Defect| {
        let number = piece_of(&pieces, &defect);
        match gap(&arranged, number.map(|k| arranged[k])) {
            Some(ends) => (number.map(|k| arranged[k].segment), apart(lines, ends, tolerance).into()),
            None => located(lines, number.map(|k| arranged[k].segment), defect),
        }
    };
    rebuild_faces(&mut drawn, &edges).map_err(located)?;
    let (mut sheet, identified) = build_identified(&drawn).map_err(located)?;
    sheet.record.gap = gap(&arranged, None).map(|[a, b]| [(b - a).norm(), tolerance]);
    let order = listed_order(&drawn, &edges);
    sheet.listed_edges = order.into_iter().map(|ends| ends.map(|v| identified.corner[v])).collect();
    Ok(sheet)
}

/// Returns the nearest two of the points of `pieces`, one of them an end of the piece `at` if one is given, if they are
/// so close that they may be meant as one.
fn gap(points: &[Vec2], pieces: &[Piece], at: Option<Piece>, tolerance: f64) -> Option<[Vec2; 2]> {
    let used: BTreeSet<usize> = pieces.iter().flat_map(|piece| piece.ends).collect();
    let used: Vec<usize> = used.into_iter().collect();
    let (close, mut nearest) = (CLOSE * tolerance, None);
    let mut least = close;
    let boxes: Vec<[Vec2; 2]> = used.iter().map(|&v| around([points[v]; 2], close / 2.0)).collect();
    let _: ControlFlow<()> = for_pairs_that_meet(&boxes, |p, q| {
        let [p, q] = [used[p.min(q)], used[p.max(q)]];
        let distance = (points[q] - points[p]).norm();
        if distance < least && at.is_none_or(|piece| piece.ends.iter().any(|end| [p, q].contains(end))) {
            (least, nearest) = (distance, Some([points[p], points[q]]));
        }
        ControlFlow::Continue(())
    });
    nearest
}

/// Returns the fault of two ends that are a little too far apart to be one point.
fn apart(lines: &[Line], ends: [Vec2; 2], tolerance: f64) -> PatternFault {
    let distance = (ends[1] - ends[0]).norm();
    PatternFault::Apart { gap: Line { ends, ..lines[0] }.name(), distance, tolerance }
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
fn without_doubles(lines: &[Line], pieces: &[Piece]) -> Result<Vec<Piece>, (Piece, Box<PatternFault>)> {
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
                    return Err((*piece, fault.into()));
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

/// Returns the number of a piece at a defect of the mesh.
fn piece_of(pieces: &[Piece], defect: &Defect) -> Option<usize> {
    match defect.place {
        MeshPart::Edge(e) | MeshPart::FoldAngle(e) => Some(e).filter(|&e| e < pieces.len()),
        MeshPart::Vertex(v) => pieces.iter().position(|piece| piece.ends.contains(&v)),
        _ => None,
    }
}

/// Says a defect of the mesh in terms of the lines, of which one has it.
fn located(lines: &[Line], number: Option<usize>, defect: Defect) -> Misdrawn {
    let problem = match (*defect.problem, number.map(|k| lines[k].name())) {
        (Problem::LooseEdge { .. }, Some(line)) => PatternFault::Loose { line }.into(),
        (Problem::Pieces { pieces }, _) => PatternFault::Pieces { pieces }.into(),
        (problem, Some(line)) => PatternFault::Line { line, problem: problem.to_string() }.into(),
        (problem, None) => Box::new(problem),
    };
    (number, problem)
}
