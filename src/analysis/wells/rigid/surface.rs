//! Folded states that are a surface: one periodic cell, repeated by screw motions.

use super::extent::Extent;
use super::{RigidError, Sampling, StateGraph};
use crate::analysis::surface::{FoldedSurface, SeamState, SurfaceOptions, on_surface};
use crate::model::Assembly;
use crate::numerics::vector::distance;
use crate::sheet::sides::uses_of_sides;
use crate::solver::atlas::Coverage;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Bound on the closure residual.
const TOLERANCE: f64 = 3e-14;
/// States beyond which a surface is given up.
const MOST_POINTS: usize = 300_000;

/// States of the curve on which surfaces cross, and those on the rims of holes, are neighbours up to this distance, in
/// distances of neighbours on a surface.
const BESIDE: f64 = 1.5;
/// States whose curvature is the largest to this part of it are on the border where it is met.
const AT_LIMIT: f64 = 1e-6;
/// Largest distance between two tips in one state.
const ONE: f64 = 1e-7;

/// How the surface is covered that is sampled.
pub(super) fn options(sampling: &Sampling) -> SurfaceOptions {
    let Sampling { step: radius, max_curvature } = *sampling;
    SurfaceOptions { radius, tolerance: TOLERANCE, max_curvature, max_points: MOST_POINTS }
}

/// The images of the surface's states that belong to the landscape, as nodes of a net.
struct Nodes<'a> {
    extent: &'a Extent,
    /// Fold angles of all nodes.
    angles: Vec<Vec<f64>>,
    /// Number of the state of each node.
    states: Vec<usize>,
    /// Nodes of each state.
    of_state: Vec<Vec<usize>>,
}

impl<'a> Nodes<'a> {
    fn new<'b>(states: impl Iterator<Item = &'b Vec<f64>>, extent: &'a Extent) -> Self {
        let mut nodes = Self { extent, angles: Vec::new(), states: Vec::new(), of_state: Vec::new() };
        states.for_each(|angles| nodes.add(angles));
        nodes
    }

    /// Adds the images of one more state.
    fn add(&mut self, angles: &[f64]) {
        let (first, state) = (self.angles.len(), self.of_state.len());
        self.angles.extend(self.extent.images(angles));
        self.of_state.push((first..self.angles.len()).collect());
        self.states.resize(self.angles.len(), state);
    }

    /// The image of a state that is next to a node; `None` where it does not belong to the landscape.
    fn next_to(&self, node: usize, state: usize) -> Option<usize> {
        let near = |&other: &usize| {
            let mut pairs = self.angles[node].iter().zip(&self.angles[other]);
            pairs.all(|(a, b)| (a - b).abs() <= 0.5 * TAU)
        };
        self.of_state[state].iter().copied().find(near)
    }

    /// Distance of two nodes.
    fn apart(&self, [a, b]: [usize; 2]) -> f64 {
        distance(&self.angles[a], &self.angles[b])
    }
}

/// Adds the states of the curve on which surfaces cross, between those whose edge goes over it, and next to each other;
/// returns the number of the first.
fn sew(nodes: &mut Nodes<'_>, links: &mut BTreeSet<[usize; 2]>, seam: &[SeamState], step: f64) -> usize {
    let first = nodes.angles.len();
    for SeamState { angles, between: [a, b] } in seam {
        nodes.add(angles);
        for at in nodes.of_state[nodes.of_state.len() - 1].clone() {
            let ends = [*a, *b].map(|state| nodes.next_to(at, state));
            if let [Some(a), Some(b)] = ends {
                links.remove(&[a.min(b), a.max(b)]);
            }
            links.extend(ends.into_iter().flatten().map(|end| [end, at]));
            links.extend((first..at).map(|other| [other, at]).filter(|pair| nodes.apart(*pair) <= BESIDE * step));
        }
    }
    first
}

/// Samples the surface.
pub(super) fn net(
    assembly: &Assembly,
    (sampling, extent): (&Sampling, &Extent),
    go_on: &mut dyn FnMut() -> bool,
) -> Result<StateGraph, RigidError> {
    let found = on_surface(assembly, &options(sampling), &mut |_| go_on())?;
    let FoldedSurface { points, triangles, coverage, negative, seam, lost, .. } = found;
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
    let count = uses_of_sides(&triangles);
    let at_limit = |at: usize| !(points[at].shape.curvature.abs() < (1.0 - AT_LIMIT) * sampling.max_curvature);
    let mut nodes = Nodes::new(points.iter().map(|point| &point.angles), extent);
    let mut border = vec![false; nodes.angles.len()];
    let (mut rim, mut links) = (BTreeSet::new(), BTreeSet::new());
    for (&[a, b], triangles) in &count {
        for (state, other) in [(a, b), (b, a)] {
            for &at in &nodes.of_state[state] {
                let next = nodes.next_to(at, other);
                border[at] |= next.is_none() || (*triangles == 1 && at_limit(state));
                rim.extend((*triangles == 1 && !at_limit(state)).then_some(at));
                links.extend(next.map(|next| [at.min(next), at.max(next)]));
            }
        }
    }
    let tips: Vec<usize> = (0..nodes.angles.len()).filter(|&node| points[nodes.states[node]].radius == 0.0).collect();
    // every nappe has a tip of its own; those in one state hang together
    links.extend(pairs(&tips).filter(|pair| nodes.apart(*pair) <= ONE));
    // without links between the rims of holes lakes on both sides of a slit would not meet
    let rim: Vec<usize> = rim.into_iter().collect();
    links.extend(pairs(&rim).filter(|pair| nodes.apart(*pair) <= BESIDE * sampling.step));
    let mut singular = vec![false; nodes.angles.len()];
    tips.iter().for_each(|&tip| singular[tip] = true);
    let seam = sew(&mut nodes, &mut links, &seam, sampling.step);
    border.resize(nodes.angles.len(), false);
    singular.resize(nodes.angles.len(), true);
    let links = links.into_iter().collect();
    Ok(StateGraph { angles: nodes.angles, links, singular, border, dimension: 2, seam, open })
}

/// All pairs of nodes.
fn pairs(nodes: &[usize]) -> impl Iterator<Item = [usize; 2]> + '_ {
    nodes.iter().enumerate().flat_map(move |(k, &a)| nodes[..k].iter().map(move |&b| [b, a]))
}
