//! The two-dimensional surface of folded states of one cell, repeated by screw motions, as triangles.
//!
//! Where `modes - quadrics` of the drawn state is two (a generic periodic cell: 3 and 1; a flat one: `Nv + 2` and `Nv`)
//! the folded states are a surface in the space of fold angles: at cylinders closure has a null space of dimension two,
//! and the drawn state is the tip of a cone, at which two nappes or more meet. [`crate::solver::atlas`] covers them
//! with charts, from a state on each (`starts`), until they close modulo 2 pi or the curvature is met. The hole that
//! charts leave around the tip is closed with triangles to the drawn state (`tip`). Where the surface comes to other
//! spatially periodic states, these are tips as well, and the nappes behind them are covered in turn (`behind`).
//!
//! Where that difference is one, or the drawn state has but one real direction, the folded states are a curve, which is
//! followed (`curve`).
//!
//! Nappes of a flat cell come close to each other where its directions nearly meet, closer than the smallest charts;
//! there the coverage stays open, and says so.

mod behind;
mod cell;
mod covered;
mod crossing;
mod curve;
mod error;
mod folding;
mod sign;
mod starts;
mod tip;

use crate::kinematics::KinematicsError;
use crate::model::Assembly;
use crate::numerics::GoOn;
use crate::solver::atlas::{self, Atlas, Chart, Coverage};
pub use covered::{FoldedSurface, Negative, SeamState, SurfaceOptions, SurfacePoint};
pub use crossing::Lowest;
pub use error::SurfaceError;
use folding::SurfaceClosure;

/// Largest angle between the tangent planes of neighbouring charts, in radians.
const MAX_TURN: f64 = 0.4;

/// The observer is asked after so many states.
const OBSERVED: usize = 256;
/// Charts are no larger than this part of the way at which half of the largest curvature is met.
const REACH: f64 = 2.0;

/// Covers the surface, or follows the curve where the folded states are one; no points where no direction is real.
/// `observe` is told the number of charts and returns false to stop.
///
/// # Errors
/// [`SurfaceError`] where the folded states are neither, or their directions are not established.
pub fn surface(
    assembly: &Assembly,
    options: &SurfaceOptions,
    observe: GoOn<'_>,
) -> Result<FoldedSurface, SurfaceError> {
    match on_surface(assembly, options, observe) {
        Err(SurfaceError::Curve) => curve::curve(assembly, options, observe),
        found => found,
    }
}

/// Covers the surface as [`surface`] does.
pub(super) fn on_surface(
    assembly: &Assembly,
    options: &SurfaceOptions,
    observe: GoOn<'_>,
) -> Result<FoldedSurface, SurfaceError> {
    let (closure, embedding, second_order) = cell::of(assembly)?;
    let (modes, quadrics) = (second_order.count(), second_order.quadrics.len());
    if modes == quadrics + 1 {
        return Err(SurfaceError::Curve);
    }
    if modes != quadrics + 2 {
        let left = modes as i64 - quadrics as i64;
        return Err(SurfaceError::NotTwoDimensional { modes, quadrics, left });
    }
    let mut folding = SurfaceClosure::new(&closure, &embedding, options.max_curvature);
    let mut starts = match starts::starts(&mut folding, &second_order, options)? {
        Ok(starts) => starts,
        Err(Negative::OneDirection) => return Err(SurfaceError::Curve),
        Err(negative) => return Ok(FoldedSurface::nothing(Some(negative), options.radius)),
    };
    let charts = atlas::CoverOptions {
        tolerance: options.tolerance,
        radius: options.radius.min(REACH * starts.reach),
        max_turn: MAX_TURN,
        max_charts: options.max_points,
    };
    folding.crossing = starts.crossing;
    let atlas = cover(&mut folding, (&mut starts, options), charts, observe)?;
    let radius = charts.radius;
    let found = FoldedSurface { radius, ..put_together(&folding, atlas, &starts, observe)? };
    if found.points.is_empty() && found.coverage != Coverage::Interrupted {
        return Err(SurfaceError::NothingWithin { max_curvature: options.max_curvature, reach: starts.reach });
    }
    Ok(found)
}

/// The atlas of all starts; of surfaces that cross, an atlas of each, so that at small crossing angles the charts of
/// one are not taken for neighbours of those of the other.
fn cover(
    folding: &mut SurfaceClosure<'_>,
    (starts, options): (&mut starts::SurfaceStarts, &SurfaceOptions),
    mut charts: atlas::CoverOptions,
    observe: GoOn<'_>,
) -> Result<Atlas, atlas::AtlasError> {
    let lines = if starts.crossing { starts.list.iter().map(|start| start.line).max().unwrap_or(0) } else { 0 };
    let mut whole: Option<Atlas> = None;
    for line in 0..=lines {
        let on_line = |k: &usize| !starts.crossing || starts.list[*k].line == line;
        let numbers: Vec<usize> = (0..starts.list.len()).filter(on_line).collect();
        let states: Vec<Vec<f64>> = numbers.iter().map(|&k| starts.list[k].x.clone()).collect();
        let before = whole.as_ref().map_or(0, |atlas| atlas.charts.len());
        let mut further = |folding: &mut SurfaceClosure<'_>, charts: &[Chart], triangles: &[[usize; 3]]| {
            if starts.crossing { Vec::new() } else { behind::starts(folding, starts, options, (charts, triangles)) }
        };
        let mut next = atlas::cover(folding, &states, charts, &mut further, &mut |count| observe(before + count))?;
        if starts.crossing {
            let number = |start: &mut usize| *start = numbers[*start];
            next.charts.iter_mut().for_each(|chart| number(&mut chart.start));
            next.reached.iter_mut().flatten().for_each(number);
        }
        charts.max_charts = charts.max_charts.saturating_sub(next.charts.len());
        let stopped = !next.coverage.is_whole();
        whole = Some(match whole {
            Some(atlas) => atlas.and(next),
            None => next,
        });
        if stopped {
            break;
        }
    }
    whole.ok_or(atlas::AtlasError::Start { start: 0 })
}

/// The states of an atlas, the hole around the drawn state closed where it is a tip.
fn put_together(
    folding: &SurfaceClosure<'_>,
    mut atlas: Atlas,
    starts: &starts::SurfaceStarts,
    observe: GoOn<'_>,
) -> Result<FoldedSurface, KinematicsError> {
    let branch = starts::branches(&atlas, &starts.list);
    let tip::Left { border, open, nappes } = tip::close(folding, &mut atlas);
    let coverage = match atlas.coverage {
        Coverage::Open { .. } if open == 0 => Coverage::Complete,
        Coverage::Open { .. } => Coverage::Open { charts: open },
        other => other,
    };
    let gaps = if coverage == Coverage::Complete { open } else { 0 };
    let Atlas { triangles, oriented, reached, .. } = atlas;
    let (tips, crossing) = (nappes.len(), starts.crossing);
    // nappes meet in pairs: where one has none opposite, that is missing
    let odd = nappes.iter().filter(|count| *count % 2 == 1 && coverage.is_whole() && !crossing).count();
    let lost = starts.lost + reached.iter().filter(|start| start.is_none()).count() + odd;
    let mut surface = FoldedSurface {
        triangles,
        coverage,
        gaps,
        oriented,
        closed: border == 0,
        tips,
        lost,
        crossing,
        ..FoldedSurface::nothing(None, 0.0)
    };
    for (k, chart) in atlas.charts.iter().enumerate() {
        let stopped = surface.coverage == Coverage::Interrupted;
        if !stopped && k % OBSERVED == 0 && !observe(atlas.charts.len()) {
            surface.coverage = Coverage::Interrupted;
        }
        if k >= atlas::KEPT && surface.coverage == Coverage::Interrupted {
            break;
        }
        surface.points.push(folding.point(&chart.x, branch[chart.start], [chart.residual, chart.radius])?);
    }
    surface.truncate(surface.points.len());
    let from: Vec<usize> = atlas.charts.iter().take(surface.points.len()).map(|chart| chart.start).collect();
    let sides = surface.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    sign::carry(folding.embedding, &mut surface.points, sides, &from);
    if starts.crossing {
        surface.seam = crossing::seam(folding, &surface.points, &surface.triangles);
        // charts go over the curve along which surfaces cross, to the other sign
        let sides = surface.points.iter_mut().filter(|point| point.shape.turns());
        sides.for_each(|point| point.branch.1 = if point.shape.curvature < 0.0 { -1 } else { 1 });
    }
    surface.name_branches();
    Ok(surface)
}
