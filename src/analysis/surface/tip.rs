//! Spatially periodic states as the tips of the surface.
//!
//! Charts shrink towards a tip and end near it, so that a small hole is left on every nappe. The drawn state is a tip;
//! others are further spatially periodic states of the cell, such as the drawn one inside out. Newton's method looks
//! for one in every hole, as a solution of closure together with lattice rotations that are the identity, and joins the
//! rim to it. Every nappe has a tip of its own.

use super::folding::SurfaceClosure;
use crate::numerics::root::Search;
use crate::numerics::vector::distance;
use crate::sheet::sides::{open_sides, uses_of_sides};
use crate::solver::atlas::{Atlas, Chart};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

/// Limits of charts on the border of the surface are zero up to this.
const BORDER: f64 = 1e-9;
/// Largest residual of a tip, and steps to get there.
const TIP_RESIDUAL: f64 = 1e-13;
const STEPS: usize = 20;
/// A tip is no further from a point of the rim than this times the largest distance of two of its points.
const TIP_REACH: f64 = 1.5;

/// Largest difference of an angle, modulo 2 pi, between two tips in one state: both are solved to [`TIP_RESIDUAL`].
const ONE_STATE_RAD: f64 = 1e-7;

/// The border of an atlas, and its tips.
pub(super) struct Left {
    /// Charts on it.
    pub border: usize,
    /// Those of them that are not at the limit.
    pub open: usize,
    /// Number of nappes that were joined to each spatially periodic state.
    pub nappes: Vec<usize>,
}

/// Joins rims to the tips in their holes.
pub(super) fn close(folding: &SurfaceClosure<'_>, atlas: &mut Atlas) -> Left {
    let mut tips: Vec<(Vec<f64>, usize)> = Vec::new();
    for (rim, chart) in tips_of_rims(folding, &atlas.charts, &atlas.triangles) {
        match tips.iter_mut().find(|(known, _)| are_one(known, &chart.x)) {
            Some((_, nappes)) => *nappes += 1,
            None => tips.push((chart.x.clone(), 1)),
        }
        let tip = atlas.charts.len();
        atlas.charts.push(chart);
        atlas.triangles.extend((0..rim.len()).map(|k| [rim[k], rim[(k + 1) % rim.len()], tip]));
    }
    let rims = uses_of_sides(&atlas.triangles).into_iter().filter(|&(_, uses)| uses == 1);
    let border: BTreeSet<usize> = rims.flat_map(|(edge, _)| edge).collect();
    let open = border.iter().filter(|&&k| atlas.charts[k].limit.abs() > BORDER).count();
    Left { border: border.len(), open, nappes: tips.into_iter().map(|(_, nappes)| nappes).collect() }
}

/// The spatially periodic states within the holes of a triangulation, one for each hole that has one.
pub(super) fn in_holes(folding: &SurfaceClosure<'_>, charts: &[Chart], triangles: &[[usize; 3]]) -> Vec<Vec<f64>> {
    tips_of_rims(folding, charts, triangles).into_iter().map(|(_, tip)| tip.x).collect()
}

/// Whether two spatially periodic states are one, modulo 2 pi.
pub(super) fn are_one(a: &[f64], b: &[f64]) -> bool {
    let apart = |(a, b): (&f64, &f64)| (a - b - TAU * ((a - b) / TAU).round()).abs();
    a.iter().zip(b).map(apart).all(|apart| apart <= ONE_STATE_RAD)
}

/// The rims within the limit, with the tip in the hole of each.
fn tips_of_rims(folding: &SurfaceClosure<'_>, charts: &[Chart], triangles: &[[usize; 3]]) -> Vec<(Vec<usize>, Chart)> {
    let within = |rim: &Vec<usize>| rim.iter().all(|&k| charts[k].limit < -BORDER);
    let rims = rims(triangles).into_iter().filter(within);
    rims.filter_map(|rim| tip(folding, charts, &rim).map(|chart| (rim, chart))).collect()
}

/// The spatially periodic state within a rim, as a chart without extent.
fn tip(folding: &SurfaceClosure<'_>, charts: &[Chart], rim: &[usize]) -> Option<Chart> {
    let beside = &charts[rim[0]];
    let image = |(x, beside): (&f64, &f64)| x - TAU * ((x - beside) / TAU).round();
    let places: Vec<Vec<f64>> = rim.iter().map(|&k| charts[k].x.iter().zip(&beside.x).map(image).collect()).collect();
    let mut x = vec![0.0; beside.x.len()];
    places.iter().for_each(|place| x.iter_mut().zip(place).for_each(|(x, p)| *x += p / rim.len() as f64));
    let size = places.iter().map(|place| distance(place, &beside.x)).fold(0.0, f64::max);
    let near = |x: &[f64]| distance(x, &beside.x) <= TIP_REACH * size;
    let chart = |x: Vec<f64>| Chart {
        residual: folding.residual(&x),
        frame: vec![0.0; 2 * x.len()],
        x,
        radius: 0.0,
        limit: f64::NEG_INFINITY,
        start: beside.start,
    };
    let drawn: Vec<f64> = folding.drawn.iter().zip(&beside.x).map(image).collect();
    if near(&drawn) {
        return Some(chart(drawn));
    }
    let x = periodic_near(folding, x)?;
    near(&x).then(|| chart(x))
}

/// The spatially periodic state to which Newton's method leads, by shortest steps.
pub(super) fn periodic_near(folding: &SurfaceClosure<'_>, x: Vec<f64>) -> Option<Vec<f64>> {
    Search { most_steps: STEPS, residual: TIP_RESIDUAL, terms: 0.0 }.root(x, |x| folding.periodic(x))
}

/// The closed rims of a triangulation, each with the hole on its left.
fn rims(triangles: &[[usize; 3]]) -> Vec<Vec<usize>> {
    let mut next: BTreeMap<usize, usize> = open_sides(triangles).into_iter().map(|[a, b]| (b, a)).collect();
    let mut rims = Vec::new();
    while let Some((first, mut at)) = next.pop_first() {
        let mut rim = vec![first];
        while at != first {
            rim.push(at);
            let Some(to) = next.remove(&at) else { break };
            at = to;
        }
        if at == first {
            rims.push(rim);
        }
    }
    rims
}
