//! Folded states that are a surface: one periodic cell, repeated by screw motions.

use super::{Net, RigidError, Sampling};
use crate::analysis::surface::{Seam, Surface, SurfaceOptions, SurfacePoint, on_surface};
use crate::model::Assembly;
use crate::solver::atlas::Coverage;
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// Bound on the closure residual.
const TOLERANCE: f64 = 3e-14;
/// States beyond which a surface is given up.
const MOST_POINTS: usize = 300_000;

/// States of the curve on which surfaces cross, and those on the rims of holes, are neighbours up to this distance, in distances of
/// neighbours on a surface.
const BESIDE: f64 = 1.5;
/// States whose curvature is the largest to this part of it are on the border where it is met.
const AT_LIMIT: f64 = 1e-6;
/// Largest difference of an angle between two tips in one state.
const ONE: f64 = 1e-9;

/// How the surface is covered that is sampled.
pub(super) fn options(sampling: &Sampling) -> SurfaceOptions {
    SurfaceOptions {
        radius: sampling.step,
        tolerance: TOLERANCE,
        max_curvature: sampling.max_curvature,
        max_points: MOST_POINTS,
    }
}

/// Adds the states of the curve on which surfaces cross, between those whose edge goes over it, and next to each other.
fn sew(net: &mut Net, seam: Vec<Seam>, step: f64) {
    let over: BTreeSet<[usize; 2]> = seam.iter().map(|on| on.between).collect();
    net.links.retain(|link| !over.contains(link));
    let first = net.angles.len();
    for Seam { angles, between } in seam {
        let at = net.angles.len();
        net.links.extend(between.map(|beside| [beside, at]));
        for other in first..at {
            let square: f64 = net.angles[other].iter().zip(&angles).map(|(a, b)| (a - b).powi(2)).sum();
            if square <= (BESIDE * step).powi(2) {
                net.links.push([other, at]);
            }
        }
        net.border.push(angles.iter().any(|angle| angle.abs() > PI));
        net.singular.push(true);
        net.angles.push(angles);
    }
    net.seam = first;
}

/// Samples the surface.
pub(super) fn net(
    assembly: &Assembly,
    sampling: &Sampling,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Net, RigidError> {
    let found = on_surface(assembly, &options(sampling), &mut |_| go_on())?;
    let Surface { points, triangles, coverage, negative, seam, lost, .. } = found;
    if let Some(negative) = negative {
        return Err(RigidError::NoFolding(negative));
    }
    let mut open = lost;
    match coverage {
        Coverage::Interrupted => return Err(RigidError::Interrupted),
        Coverage::TooManyCharts | Coverage::GivenUp { .. } => return Err(RigidError::Partial { states: points.len() }),
        Coverage::Complete => {}
        Coverage::Open { charts } => open += charts,
    }
    let inside: Vec<bool> = points.iter().map(|point| point.angles.iter().all(|angle| angle.abs() <= PI)).collect();
    let mut count: std::collections::BTreeMap<[usize; 2], usize> = Default::default();
    for &[a, b, c] in &triangles {
        for [a, b] in [[a, b], [b, c], [c, a]] {
            *count.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let at_limit = |at: usize| !(points[at].shape.curvature.abs() < (1.0 - AT_LIMIT) * sampling.max_curvature);
    let mut border: Vec<bool> = inside.iter().map(|inside| !inside).collect();
    let mut rim = BTreeSet::new();
    for (&[a, b], triangles) in &count {
        for (at, other) in [(a, b), (b, a)] {
            border[at] |= !inside[other] || (*triangles == 1 && at_limit(at));
            rim.extend((*triangles == 1 && inside[at] && !at_limit(at)).then_some(at));
        }
    }
    // neighbours across the end of a period are none here: a turn more is another state
    let near = |a: usize, b: usize| points[a].angles.iter().zip(&points[b].angles).all(|(a, b)| (a - b).abs() <= PI);
    let mut links: BTreeSet<[usize; 2]> =
        count.into_keys().filter(|&[a, b]| inside[a] && inside[b] && near(a, b)).collect();
    links.extend(tips(&points));
    links.extend(across(&points, &rim, sampling.step));
    let mut net = Net {
        seam: points.len(),
        singular: points.iter().map(|point| point.radius == 0.0).collect(),
        angles: points.into_iter().map(|point| point.angles).collect(),
        links: links.into_iter().collect(),
        border,
        dimension: 2,
        open,
    };
    sew(&mut net, seam, sampling.step);
    Ok(net)
}

/// Links between states on the rims of holes that the triangles leave where the surface goes on: without them lakes on both sides of
/// a slit would not meet.
fn across(points: &[SurfacePoint], rim: &BTreeSet<usize>, step: f64) -> Vec<[usize; 2]> {
    let rim: Vec<usize> = rim.iter().copied().collect();
    let pairs = rim.iter().enumerate().flat_map(|(k, &a)| rim[..k].iter().map(move |&b| [b, a]));
    let square = |[a, b]: [usize; 2]| -> f64 {
        points[a].angles.iter().zip(&points[b].angles).map(|(a, b)| (a - b).powi(2)).sum()
    };
    pairs.filter(|pair| square(*pair) <= (BESIDE * step).powi(2)).collect()
}

/// Every nappe has a tip of its own; those in one state hang together.
fn tips(points: &[SurfacePoint]) -> Vec<[usize; 2]> {
    let tips: Vec<usize> = (0..points.len()).filter(|&k| points[k].radius == 0.0).collect();
    let pairs = tips.iter().enumerate().flat_map(|(k, &a)| tips[..k].iter().map(move |&b| [b, a]));
    let same = |a: usize, b: usize| points[a].angles.iter().zip(&points[b].angles).all(|(a, b)| (a - b).abs() <= ONE);
    pairs.filter(|&[a, b]| same(a, b)).collect()
}
