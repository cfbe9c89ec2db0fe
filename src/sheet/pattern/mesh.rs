//! Conversion of the lines of a crease pattern to the mesh that they draw, with points merged within one distance.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

use super::arrangement::{Arrangement, Disorder, arrange};
use super::auxiliary::without_loose;
use super::line::PatternLine;
use super::piece::SegmentPiece;
use crate::math::{Vec2, Vec3};
use crate::sheet::assignment::Assignment;
use crate::sheet::boxes::{around, for_pairs_that_meet};
use crate::sheet::build::{Drawing, build_identified, listed_order, rebuild_faces};
use crate::sheet::cell::Sheet;
use crate::sheet::error::{Defect, MeshPart, MeshProblem};
use crate::sheet::pattern_fault::PatternFault;
use crate::sheet::record::{Gap, Redrawing};
use crate::sheet::sides::{sorted, uses_of_sides};

/// Distance, in distances of merging, below which two points may be meant as one: ends drawn with an error a little
/// above that distance are this far apart.
const CLOSE: f64 = 3.0;

/// Largest difference of two fold angles in degrees that lines on each other may have.
const SAME_ANGLE_DEG: f64 = 1e-3;

/// A problem together with the number of the line that has it; `None` for the pattern as a whole.
pub(crate) type Misdrawn = (Option<usize>, Box<MeshProblem>);

/// The sheet that lines draw.
pub(super) struct Meshed {
    pub sheet: Sheet,
    /// Length of the longest line that is shorter than the distance of merging and has become a point.
    pub vanished: f64,
    /// Largest distance between lines as they are drawn of which one has come to lie on the other.
    pub doubled: f64,
    /// Length of the shortest edge.
    pub shortest: f64,
}

/// Returns the sheet whose creases and rim are `lines`, split where they meet if `split` says so, with points merged
/// within `tolerance`; adds the number of pairs of lines that were compared to `compared`.
pub(super) fn mesh(
    lines: &[PatternLine],
    tolerance: f64,
    split: bool,
    head: &Drawing,
    compared: &mut usize,
) -> Result<Meshed, Misdrawn> {
    let ends: Vec<[Vec2; 2]> = lines.iter().map(|line| line.ends).collect();
    let arranged = arrange(&ends, tolerance, split, compared).map_err(|disorder| untidy(lines, disorder, tolerance))?;
    let Arrangement { mut points, mut straight, pieces } = arranged;
    let (lost, doubled) = (vanished(lines, &pieces), doubled(lines, &points, &pieces));
    let conflicting = |(piece, fault): (SegmentPiece, Box<PatternFault>)| {
        let fault = gap(&points, &pieces, Some(piece), tolerance).map_or(*fault, |ends| apart(lines, ends, tolerance));
        (Some(piece.segment), fault.into())
    };
    let single = without_doubles(lines, &pieces).map_err(conflicting)?;
    let (kept, dropped) = without_loose(lines, points.len(), single);
    let (arranged, slits) = with_open_slits(lines, [&mut points, &mut straight], kept);
    let (coords, pieces) = renumbered(&straight, &arranged);
    let located = |defect: Defect| {
        let number = piece_of(&pieces, &defect);
        match gap(&points, &arranged, number.map(|k| arranged[k]), tolerance) {
            Some(ends) => (number.map(|k| arranged[k].segment), apart(lines, ends, tolerance).into()),
            None => located(lines, number.map(|k| arranged[k].segment), defect),
        }
    };
    let mut sheet = built(lines, coords, &pieces, head).map_err(located)?;
    sheet.record.redrawing.dropped = dropped;
    sheet.record.redrawing.slits = slits;
    sheet.record.redrawing.vanished = lost.len();
    let close = gap(&straight, &arranged, None, tolerance);
    sheet.record.redrawing.gap = close.map(|ends| Gap {
        ends: named(lines, ends).name(),
        distance: (ends[1] - ends[0]).norm(),
        merged: tolerance,
    });
    let lengths = arranged.iter().map(|piece| (straight[piece.ends[1]] - straight[piece.ends[0]]).norm());
    let shortest = lengths.fold(f64::INFINITY, f64::min);
    let vanished = lost.into_iter().fold(0.0, f64::max);
    Ok(Meshed { sheet, vanished, doubled, shortest })
}

fn untidy(lines: &[PatternLine], disorder: Disorder, tolerance: f64) -> Misdrawn {
    match disorder {
        Disorder::Tangled(k) => {
            (Some(k), PatternFault::Tangled { line: lines[k].name(), tolerance, cure: None }.into())
        }
        Disorder::TooMany(points) => (None, PatternFault::TooMany { points }.into()),
    }
}

/// Builds the sheet of pieces between these points.
fn built(lines: &[PatternLine], coords: Vec<Vec3>, pieces: &[SegmentPiece], head: &Drawing) -> Result<Sheet, Defect> {
    // whether edges cross is checked where the faces are made
    let mut drawn = Drawing { coords, planar: false, ..head.clone() };
    let of = |piece: &SegmentPiece| &lines[piece.segment];
    let edges: Vec<[usize; 2]> = pieces.iter().map(|piece| piece.ends).collect();
    drawn.assignments = pieces.iter().map(|piece| (piece.ends, of(piece).letter)).collect();
    if pieces.iter().any(|piece| of(piece).angle.is_some()) {
        let angle = |piece: &SegmentPiece| (piece.ends, of(piece).angle.map(f64::to_radians));
        drawn.fold_angles = pieces.iter().map(angle).collect();
    }
    let holes = rebuild_faces(&mut drawn, &edges)?;
    let unlettered = letter_contours(lines, pieces, &mut drawn);
    let (mut sheet, identified) = build_identified(&drawn)?;
    sheet.record.redrawing = Redrawing { holes, unlettered, ..Redrawing::default() };
    let order = listed_order(&drawn, &edges);
    sheet.listed_edges = order.into_iter().map(|ends| ends.map(|v| identified.corner[v])).collect();
    Ok(sheet)
}

/// Gives contours that a face is beside the letter of the rim, and those between two faces that of a cut, unless they
/// are plain: the number of these is returned.
fn letter_contours(lines: &[PatternLine], pieces: &[SegmentPiece], drawn: &mut Drawing) -> usize {
    let mut plain = 0;
    let faces = uses_of_sides(&drawn.faces);
    for (piece, (ends, letter)) in pieces.iter().zip(&mut drawn.assignments) {
        let line = &lines[piece.segment];
        match faces.get(&sorted(*ends)) {
            Some(2) if line.is_plain() => plain += 1,
            Some(2) if line.contour => *letter = Assignment::Cut,
            Some(1) if line.contour => *letter = Assignment::Boundary,
            _ => {}
        }
    }
    plain
}

/// Returns the lengths of lines that have no piece and are not auxiliary.
fn vanished(lines: &[PatternLine], pieces: &[SegmentPiece]) -> Vec<f64> {
    let mut is_drawn = vec![false; lines.len()];
    pieces.iter().for_each(|piece| is_drawn[piece.segment] = true);
    let lost = lines.iter().zip(is_drawn).filter(|(line, is_drawn)| !is_drawn && !line.auxiliary);
    lost.map(|(line, _)| (line.ends[1] - line.ends[0]).norm()).filter(|length| *length > 0.0).collect()
}

/// Returns the largest distance between lines, as they are drawn, of which pieces lie on each other; auxiliary ones are
/// left out.
fn doubled(lines: &[PatternLine], points: &[Vec2], pieces: &[SegmentPiece]) -> f64 {
    let mut known: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    let apart = |piece: &SegmentPiece| {
        let first = *known.entry(sorted(piece.ends)).or_insert(piece.segment);
        let [a, b] = piece.ends.map(|v| points[v]);
        let beside = [first, piece.segment].map(|k| foot(lines[k].ends, (a + b) / 2.0));
        (beside[1] - beside[0]).norm()
    };
    pieces.iter().filter(|piece| !lines[piece.segment].auxiliary).map(apart).fold(0.0, f64::max)
}

/// Returns the point of a line that is nearest to `x`.
fn foot([a, b]: [Vec2; 2], x: Vec2) -> Vec2 {
    let along = b - a;
    a + along * ((x - a).dot(&along) / along.norm_squared())
}

/// Returns the nearest two of the points of `pieces`, one of them an end of the piece `at` if one is given, if they are
/// so close that they may be meant as one.
fn gap(points: &[Vec2], pieces: &[SegmentPiece], at: Option<SegmentPiece>, tolerance: f64) -> Option<[Vec2; 2]> {
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

/// Returns a line between two points, with the directions of the file.
fn named(lines: &[PatternLine], ends: [Vec2; 2]) -> PatternLine {
    PatternLine { ends, ..lines[0] }
}

/// Returns the fault of two ends that are a little too far apart to be one point.
fn apart(lines: &[PatternLine], ends: [Vec2; 2], tolerance: f64) -> PatternFault {
    let distance = (ends[1] - ends[0]).norm();
    PatternFault::Apart { gap: named(lines, ends).name(), distance, tolerance, cure: None }
}

/// Returns the pieces without those that lie on earlier ones, which have to mean the same.
fn without_doubles(
    lines: &[PatternLine],
    pieces: &[SegmentPiece],
) -> Result<Vec<SegmentPiece>, (SegmentPiece, Box<PatternFault>)> {
    let mut known: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    let mut kept: Vec<SegmentPiece> = Vec::new();
    for piece in pieces {
        match known.entry(sorted(piece.ends)) {
            Entry::Vacant(free) => {
                free.insert(kept.len());
                kept.push(*piece);
            }
            Entry::Occupied(taken) => {
                let before = &mut kept[*taken.get()];
                let [first, second] = [before.segment, piece.segment].map(|k| &lines[k]);
                if says(first) < says(second) {
                    before.segment = piece.segment;
                } else if says(first) == says(second) && !first.auxiliary && !agree(first, second) {
                    let meanings = [first, second].map(|line| (line.letter, line.angle));
                    let fault = PatternFault::Overlap { a: first.name(), b: second.name(), meanings };
                    return Err((*piece, fault.into()));
                }
            }
        }
    }
    Ok(kept)
}

/// Returns how much a line says: of lines on each other the one that says most counts.
fn says(line: &PatternLine) -> u8 {
    match line {
        line if line.auxiliary => 0,
        line if line.is_plain() => 1,
        _ => 2,
    }
}

fn agree(a: &PatternLine, b: &PatternLine) -> bool {
    let same_angle = match (a.angle, b.angle) {
        (Some(a), Some(b)) => (a - b).abs() <= SAME_ANGLE_DEG,
        (a, b) => a == b,
    };
    a.letter == b.letter && same_angle
}

/// Returns the pieces with cuts of one edge, whose ends no other cut and no rim reaches, split in their middle: there
/// they can open. Also returns their number.
fn with_open_slits(
    lines: &[PatternLine],
    mut places: [&mut Vec<Vec2>; 2],
    pieces: Vec<SegmentPiece>,
) -> (Vec<SegmentPiece>, usize) {
    let opens = |piece: &SegmentPiece| matches!(lines[piece.segment].letter, Assignment::Cut | Assignment::Boundary);
    let mut degree = vec![0; places[0].len()];
    pieces.iter().filter(|piece| opens(piece)).flat_map(|piece| piece.ends).for_each(|v| degree[v] += 1);
    let (mut split, mut slits) = (Vec::with_capacity(pieces.len()), 0);
    for piece in pieces {
        let line = &lines[piece.segment];
        let is_cut = line.letter == Assignment::Cut || (line.contour && !line.is_plain());
        if is_cut && piece.ends.iter().all(|&v| degree[v] == 1) {
            let [a, b] = piece.ends;
            let middle = places[0].len();
            places.iter_mut().for_each(|points| points.push((points[a] + points[b]) / 2.0));
            split.extend([[a, middle], [middle, b]].map(|ends| SegmentPiece { ends, ..piece }));
            slits += 1;
        } else {
            split.push(piece);
        }
    }
    (split, slits)
}

/// Returns the points that pieces have, in the order of the pieces, and the pieces with their numbers.
fn renumbered(points: &[Vec2], pieces: &[SegmentPiece]) -> (Vec<Vec3>, Vec<SegmentPiece>) {
    let mut numbers: Vec<Option<usize>> = vec![None; points.len()];
    let mut coords = Vec::new();
    let mut number = |v: usize| {
        *numbers[v].get_or_insert_with(|| {
            coords.push(points[v].push(0.0));
            coords.len() - 1
        })
    };
    let pieces = pieces.iter().map(|piece| SegmentPiece { ends: piece.ends.map(&mut number), ..*piece }).collect();
    (coords, pieces)
}

/// Returns the number of a piece at a defect of the mesh.
fn piece_of(pieces: &[SegmentPiece], defect: &Defect) -> Option<usize> {
    match defect.place {
        MeshPart::Edge(e) | MeshPart::FoldAngle(e) => Some(e).filter(|&e| e < pieces.len()),
        MeshPart::Vertex(v) => pieces.iter().position(|piece| piece.ends.contains(&v)),
        _ => None,
    }
}

/// Says a defect of the mesh in terms of the lines, of which one has it.
fn located(lines: &[PatternLine], number: Option<usize>, defect: Defect) -> Misdrawn {
    let is_rim = |line: &PatternLine| matches!(line.letter, Assignment::Boundary | Assignment::Cut) || line.contour;
    let problem = match (*defect.problem, number.map(|k| lines[k].name())) {
        (MeshProblem::LooseEdge { .. }, Some(line)) if !lines.iter().any(is_rim) => PatternFault::NoRim { line }.into(),
        (MeshProblem::LooseEdge { .. }, Some(line)) => PatternFault::Loose { line }.into(),
        (MeshProblem::Nested { .. }, Some(line)) => PatternFault::Nested { line }.into(),
        (problem, Some(line)) => PatternFault::Line { line, problem: problem.to_string() }.into(),
        (problem, None) => Box::new(problem),
    };
    (number, problem)
}
