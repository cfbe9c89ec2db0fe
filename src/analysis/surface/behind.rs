//! The nappes behind other spatially periodic states than the drawn one.
//!
//! At each of them the surface is as singular as at the drawn state: nappes meet there in pairs, and that on the other
//! side may hang together with what is covered nowhere else within the largest curvature.

use super::SurfaceOptions;
use super::folding::SurfaceClosure;
use super::starts::{self, SurfaceStart, SurfaceStarts};
use super::tip;
use crate::solver::atlas::Chart;

/// States on all nappes that meet in the spatially periodic states within the holes of a triangulation, except for
/// those states that are known already. They are added to the starts, and to what is lost where second order does not
/// tell the nappes.
pub(super) fn starts(
    folding: &SurfaceClosure<'_>,
    known: &mut SurfaceStarts,
    options: &SurfaceOptions,
    (charts, triangles): (&[Chart], &[[usize; 3]]),
) -> Vec<Vec<f64>> {
    let before = known.list.len();
    for tip in tip::in_holes(folding, charts, triangles) {
        if known.tips.iter().any(|other| tip::are_one(other, &tip)) {
            continue;
        }
        match of_tip(folding, &tip, options) {
            Some(SurfaceStarts { list, lost, .. }) => {
                known.lost += lost;
                let first = known.list.iter().map(|start| start.line + 1).max().unwrap_or(0);
                let added = list.into_iter().enumerate();
                known.list.extend(added.map(|(k, start)| SurfaceStart { line: first + k, ..start }));
            }
            None => known.lost += 1,
        }
        known.tips.push(tip);
    }
    known.list[before..].iter().map(|start| start.x.clone()).collect()
}

/// A state on every nappe of a spatially periodic state that is the tip of a cone; `None` where it is something else.
fn of_tip(folding: &SurfaceClosure<'_>, tip: &[f64], options: &SurfaceOptions) -> Option<SurfaceStarts> {
    let (mut folding, second_order) = folding.leaving(tip).ok()?;
    let cone = second_order.count() == second_order.quadrics.len() + 2 && !second_order.quadrics.is_empty();
    let found = starts::starts(&mut folding, &second_order, options).ok()?.ok()?;
    (cone && !found.crossing).then_some(found)
}
