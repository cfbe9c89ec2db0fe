//! The distance within which points of a drawing of lines are merged.
//!
//! Without a distance of its own a drawing is read with a small one. Where the lines are no crease pattern with it, or
//! where points are left that are close to each other, larger ones are tried step by step. One of them is taken if its
//! mesh leaves no doubt: all points that are left are far apart in comparison to it, no line vanished but those far
//! shorter than all that is left, and none came to lie on another that was drawn beside it. So good drawings keep their
//! details, and careless ones are read. Where a pair of points is left that is much nearer than all others, and a larger
//! distance makes it one point, that is taken. Where there is doubt about points alone, the first one that makes a pattern is
//! taken, and they are named. Where no larger one helps either, points may be nearer to each other than the first: smaller
//! ones are tried then.

use super::line::PatternLine;
use super::mesh::{Meshed, Misdrawn, mesh};
use crate::math::Vec2;
use crate::sheet::build::Drawing;
use crate::sheet::cell::Sheet;
use crate::sheet::error::MeshProblem;
use crate::sheet::pattern_fault::PatternFault;
use std::iter;

/// Distance within which points of a drawing of lines are one point, relative to its extent: drawing programs write two
/// decimals of a point or pixel, 1e-5 of a usual page.
const SAME_POINT: f64 = 1e-4;

/// Factor from one distance that is tried to the next: lines whose ends are off by up to a tenth of the shortest edge
/// are read within at least one of them.
const STEP: f64 = 1.5;

/// Largest distance that is tried without being asked for, relative to the extent; Origami Simulator's, 3 units, is
/// 0.005 of a usual drawing.
const COARSEST_TRIED: f64 = 0.03;

/// Smaller distances that are tried last, relative to the first: exact drawings of many crossings have points near to
/// each other.
const FINER: [f64; 3] = [1e-1, 1e-2, 1e-3];

/// Largest distance of merging that may be asked for, relative to the extent.
const COARSEST: f64 = 0.1;

/// Pairs of lines that are compared before no further distance is tried: about two seconds.
const MOST_COMPARED: usize = 30_000_000;

/// Distance between lines that may be one drawn twice, over the first distance.
const DRAWN_TWICE: f64 = 10.0;

/// Length of the lines that may vanish where points are merged within more than the first distance, in lengths of the
/// shortest edge that is left.
const SCRAP: f64 = 0.1;

/// Shortest edge over the distance of merging from which on no larger one is tried; and the factor by which a larger one
/// makes it longer where two points that were meant as one had been left.
const CLEAR: f64 = 10.0;
const CLEARER: f64 = 1.5;

/// Options for the clean-up of vertices and edges of a flat crease pattern, before its faces are found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cleanup {
    /// Distance within which vertices are merged, in units of the drawing; `None` for 1e-4 of its extent, the larger
    /// one of width and height, or more where lines end beside each other otherwise.
    pub merge: Option<f64>,
    /// Whether edges are split where they cross or touch each other.
    pub split: bool,
}

/// Returns the sheet whose creases and rim are `lines`, with the title and description of `head`. Its vertices are
/// numbered in the order of the lines.
pub(crate) fn sheet(lines: &[PatternLine], cleanup: &Cleanup, head: &Drawing) -> Result<Sheet, Misdrawn> {
    let extent = extent(lines)?;
    let first = match cleanup.merge {
        None => SAME_POINT * extent,
        Some(found) if found > 0.0 && found <= COARSEST * extent => found,
        Some(found) => return Err((None, PatternFault::Tolerance { found, extent }.into())),
    };
    let mut compared = 0;
    let found = mesh(lines, first, cleanup.split, head, &mut compared);
    if found.as_ref().is_ok_and(|meshed| meshed.sheet.record.redrawing.gap.is_none() || cleanup.merge.is_some()) {
        return found.map(|meshed| meshed.sheet);
    }
    if found.as_ref().is_err_and(|(_, problem)| matches!(**problem, MeshProblem::Pattern(PatternFault::TooMany { .. })))
    {
        return found.map(|meshed| meshed.sheet);
    }
    let coarser = iter::successors(Some(first * STEP), |distance| Some(distance * STEP));
    let coarser = coarser.take_while(|distance| *distance <= COARSEST_TRIED * extent);
    let finer = FINER.map(|part| part * first).into_iter().filter(|_| found.is_err());
    let (mut cure, mut doubtful) = (None::<(f64, Meshed)>, None);
    for distance in coarser.chain(finer) {
        let is_clear = |(within, meshed): &(f64, Meshed)| meshed.shortest >= CLEAR * within || distance < first;
        if compared > MOST_COMPARED || cure.as_ref().is_some_and(is_clear) {
            break;
        }
        let meshed = mesh(lines, distance, cleanup.split, head, &mut compared).ok();
        let Some(meshed) = meshed.filter(|meshed| keeps_lines(meshed, first)) else { continue };
        if meshed.sheet.record.redrawing.gap.is_none() {
            let is_clearer = |best: &(f64, Meshed)| is_clearer((distance, &meshed), (best.0, &best.1));
            if cure.as_ref().is_none_or(is_clearer) {
                cure = Some((distance, meshed));
            }
        } else if found.is_err() && doubtful.is_none() {
            doubtful = Some((distance, meshed.sheet));
        }
    }
    let cure = cure.map(|(distance, meshed)| (distance, meshed.sheet)).or(doubtful);
    match (found, cure) {
        (_, Some((distance, mut sheet))) if cleanup.merge.is_none() => {
            sheet.record.redrawing.merged = Some([distance, first]);
            Ok(sheet)
        }
        (Ok(meshed), _) => Ok(meshed.sheet),
        (Err((line, problem)), cure) => Err((line, cured(problem, cure.map(|(distance, _)| distance)))),
    }
}

/// Whether a mesh leaves no doubt that the lines that have vanished in points, or in other lines, were meant to.
fn keeps_lines(meshed: &Meshed, first: f64) -> bool {
    meshed.vanished <= SCRAP * meshed.shortest && meshed.doubled <= DRAWN_TWICE * first
}

/// Whether a larger distance of merging leaves points that are farther apart in comparison to it, since those that were
/// nearest to each other have become one, and no line more has vanished.
fn is_clearer((larger, meshed): (f64, &Meshed), (within, before): (f64, &Meshed)) -> bool {
    let apart = meshed.shortest / larger > CLEARER * before.shortest / within;
    apart && meshed.vanished <= before.vanished && meshed.doubled <= before.doubled
}

/// Returns a problem with the distance of merging that makes a crease pattern of the lines, if it names a gap.
fn cured(mut problem: Box<MeshProblem>, distance: Option<f64>) -> Box<MeshProblem> {
    if let MeshProblem::Pattern(PatternFault::Apart { cure, .. } | PatternFault::Tangled { cure, .. }) = &mut *problem {
        *cure = distance;
    }
    problem
}

/// Returns the larger one of width and height of a drawing.
fn extent(lines: &[PatternLine]) -> Result<f64, Misdrawn> {
    let wild =
        |line: &PatternLine| line.ends.iter().flat_map(|end| end.iter()).any(|c| !(0.0..=1e50).contains(&c.abs()));
    if let Some(k) = lines.iter().position(wild) {
        return Err((Some(k), PatternFault::Coordinate { line: lines[k].name() }.into()));
    }
    let Some(first) = lines.first().map(|line| line.ends[0]) else {
        return Err((None, PatternFault::Empty { right: "draw mountains, valleys and the boundary as lines" }.into()));
    };
    let ends = || lines.iter().flat_map(|line| line.ends);
    let [low, high]: [Vec2; 2] = ends().fold([first; 2], |[low, high], end| [low.inf(&end), high.sup(&end)]);
    match (high - low).max() {
        0.0 => Err((Some(0), PatternFault::Empty { right: "all lines have the length 0" }.into())),
        extent => Ok(extent),
    }
}
