//! The loops of a patch: one round every interior vertex, and one along the rim of every opening.

use crate::math::Vec3;
use crate::math::pieces::pieces;
use std::collections::{HashMap, HashSet};
use thiserror::Error;

/// Why a model has no intrinsic form.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum Unsupported {
    #[error("only patches are solved in fold angles")]
    Domain,
    #[error("pins that hold more than rigid motions, held values and rigid parts act on positions")]
    Pins,
    #[error("bars or hinges have a law, or there are terms of one's own")]
    Law,
    #[error("edge {edge} has no bar")]
    NoBar { edge: usize },
    #[error("edge {edge} has no stiffness against folding")]
    NoHinge { edge: usize },
    #[error("the faces do not form one sheet with simple rims")]
    Topology,
}

/// An edge seen from one of its ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Directed {
    /// Number of the edge in the tiling.
    pub edge: usize,
    /// The vertex opposite to the edge in the triangle on its left.
    pub left: Option<usize>,
}

/// Edges and triangles of a patch by their vertices.
#[derive(Debug)]
pub(super) struct Topology {
    directed: HashMap<[usize; 2], Directed>,
    /// The vertices joined to each vertex by an edge of a triangle.
    neighbours: Vec<Vec<usize>>,
    /// Edges of no triangle.
    pub(super) loose: Vec<[usize; 2]>,
}

/// A step of a loop at a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LoopStep {
    /// Over an edge, from its right to its left seen from the vertex; `-1` for the other way.
    Cross { edge: usize, sign: f64 },
    /// Through a triangle with these edges, between the first and the second of them; `-1` for clockwise.
    Sector { edges: [usize; 3], sign: f64 },
    /// Along an edge to the next vertex of a rim, and half a turn.
    Along { edge: usize },
}

/// A rim: its edges as directed with the triangles on their left, and the steps to the end of each from that of the one
/// before.
#[derive(Clone, Debug, Default)]
pub(super) struct Rim {
    edges: Vec<[usize; 2]>,
    steps: Vec<Vec<LoopStep>>,
}

/// The steps of a condition on angles and lengths, and what has to come of them.
#[derive(Clone, Debug)]
pub(super) struct LoopCondition {
    pub steps: Vec<LoopStep>,
    /// The edge without face whose length the steps have to bridge; `None` for a loop that has to close.
    pub bridge: Option<usize>,
}

impl Rim {
    /// Returns the number of edges.
    pub(super) fn len(&self) -> usize {
        self.edges.len()
    }

    /// Returns the steps once round.
    pub(super) fn round(&self) -> Vec<LoopStep> {
        self.steps.concat()
    }

    /// Returns the steps from a vertex to another, which begin with a step along an edge.
    fn way(&self, from: usize, to: usize) -> Option<Vec<LoopStep>> {
        let first = self.edges.iter().position(|edge| edge[0] == from)?;
        let last = self.edges.iter().position(|edge| edge[1] == to)?;
        let count = (last + self.len() - first) % self.len() + 1;
        let along = self.steps[first].last().copied();
        let others = (1..count).flat_map(|k| self.steps[(first + k) % self.len()].iter().copied());
        Some(along.into_iter().chain(others).collect())
    }
}

impl Topology {
    /// Collects edges and triangles: the ends of every edge, and the four vertices of every hinge (ends, left and right
    /// opposite vertex), which are those of two triangles.
    pub(super) fn new(vertices: usize, edges: &[[usize; 2]], hinges: &[[usize; 4]]) -> Result<Self, Unsupported> {
        let mut directed = HashMap::with_capacity(2 * edges.len());
        for (edge, &[i, j]) in edges.iter().enumerate() {
            for ends in [[i, j], [j, i]] {
                if directed.insert(ends, Directed { edge, left: None }).is_some() {
                    return Err(Unsupported::Topology);
                }
            }
        }
        let triangles = hinges.iter().flat_map(|&[i, j, left, right]| [[i, j, left], [j, i, right]]);
        for [a, b, c] in triangles {
            for (ends, opposite) in [([a, b], c), ([b, c], a), ([c, a], b)] {
                let found = directed.get_mut(&ends).ok_or(Unsupported::Topology)?;
                if found.left.replace(opposite).is_some_and(|before| before != opposite) {
                    return Err(Unsupported::Topology);
                }
            }
        }
        let mut neighbours = vec![Vec::new(); vertices];
        let (mut loose, has_face) = (vec![], |a: usize, b: usize| directed[&[a, b]].left.is_some());
        for &[i, j] in edges {
            if has_face(i, j) || has_face(j, i) {
                neighbours[i].push(j);
                neighbours[j].push(i);
            } else {
                loose.push([i, j]);
            }
        }
        Ok(Self { directed, neighbours, loose })
    }

    /// Returns the edge from `a` to `b`.
    pub(super) fn edge(&self, a: usize, b: usize) -> Result<Directed, Unsupported> {
        self.directed.get(&[a, b]).copied().ok_or(Unsupported::Topology)
    }

    /// Returns the edge from `a` to `b`, if there is one.
    pub(super) fn get(&self, a: usize, b: usize) -> Option<Directed> {
        self.directed.get(&[a, b]).copied()
    }

    /// Returns an edge with a triangle on its left, at the vertex that is closest to the mean of these positions.
    pub(super) fn middle(&self, positions: &[Vec3]) -> Option<[usize; 2]> {
        let mean = positions.iter().sum::<Vec3>() / positions.len() as f64;
        let with_triangle = |v: usize| {
            let mut around = self.neighbours[v].iter();
            around.find(|&&u| self.directed[&[v, u]].left.is_some()).map(|&u| [v, u])
        };
        let distance = |edge: &[usize; 2]| (positions[edge[0]] - mean).norm_squared();
        (0..self.vertices()).filter_map(with_triangle).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// Whether a vertex is a corner of a triangle.
    pub(super) fn is_in_triangle(&self, v: usize) -> bool {
        !self.neighbours[v].is_empty()
    }

    /// Whether the triangles form one piece whose Euler characteristic is that of a disk with openings.
    pub(super) fn is_disk(&self, rims: usize) -> bool {
        let used = (0..self.vertices()).filter(|&v| self.is_in_triangle(v));
        let edges = self.directed.len() / 2 - self.loose.len();
        let triangles = self.directed.values().filter(|directed| directed.left.is_some()).count() / 3;
        let links = self.neighbours.iter().enumerate().flat_map(|(v, around)| around.iter().map(move |&u| [v, u]));
        let connected = pieces(self.vertices(), links, used.clone()).len() == 1;
        connected && rims > 0 && used.count() + triangles + rims == edges + 2
    }

    /// Returns the number of vertices.
    pub(super) fn vertices(&self) -> usize {
        self.neighbours.len()
    }

    fn number(&self, a: usize, b: usize) -> Result<usize, Unsupported> {
        self.edge(a, b).map(|directed| directed.edge)
    }

    /// Returns the edges of the triangle `(at, next, other)`: from `at` to both others, and the opposite one.
    fn triangle(&self, at: usize, next: usize, other: usize) -> Result<[usize; 3], Unsupported> {
        Ok([self.number(at, next)?, self.number(at, other)?, self.number(next, other)?])
    }

    /// Returns the loops round all interior vertices.
    pub(super) fn rounds(&self) -> Result<Vec<Vec<LoopStep>>, Unsupported> {
        let interior = |v: &usize| {
            let mut around = self.neighbours[*v].iter();
            let closed = |&u: &usize| [[*v, u], [u, *v]].iter().all(|ends| self.directed[ends].left.is_some());
            !self.neighbours[*v].is_empty() && around.all(closed)
        };
        (0..self.vertices()).filter(interior).map(|v| self.round(v)).collect()
    }

    fn round(&self, v: usize) -> Result<Vec<LoopStep>, Unsupported> {
        let first = self.neighbours[v][0];
        let (mut at, mut steps) = (first, vec![]);
        for count in 1.. {
            let Directed { edge, left } = self.edge(v, at)?;
            let next = left.ok_or(Unsupported::Topology)?;
            steps.push(LoopStep::Cross { edge, sign: 1.0 });
            steps.push(LoopStep::Sector { edges: self.triangle(v, at, next)?, sign: 1.0 });
            at = next;
            if at == first {
                let whole = count == self.neighbours[v].len();
                return if whole { Ok(steps) } else { Err(Unsupported::Topology) };
            }
        }
        unreachable!("a loop over finitely many triangles comes back")
    }

    /// Returns all rims.
    pub(super) fn rims(&self) -> Result<Vec<Rim>, Unsupported> {
        let mut starts: Vec<[usize; 2]> = self.directed.keys().copied().filter(|ends| self.is_rim(*ends)).collect();
        starts.sort_unstable();
        let (mut visited, mut rims) = (HashSet::new(), vec![]);
        for start in starts {
            if visited.contains(&start) {
                continue;
            }
            let (mut ends, mut rim) = (start, Rim::default());
            while visited.insert(ends) {
                let mut steps = vec![];
                ends = self.along_rim(ends, &mut steps)?;
                rim.edges.push(ends);
                rim.steps.push(steps);
            }
            if ends != start {
                return Err(Unsupported::Topology);
            }
            rims.push(rim);
        }
        Ok(rims)
    }

    /// Returns the ways along a rim from one end to the other of the edges without face that join two vertices of
    /// triangles. Other edges without face have to hold a vertex of no triangle, alone or in pairs.
    pub(super) fn bridges(&self, rims: &[Rim]) -> Result<Vec<LoopCondition>, Unsupported> {
        let (mut bridges, mut held) = (vec![], vec![0; self.vertices()]);
        for &[i, j] in &self.loose {
            match [i, j].map(|v| self.is_in_triangle(v)) {
                [true, true] => {
                    let ways = rims.iter().flat_map(|rim| [rim.way(i, j), rim.way(j, i)]).flatten();
                    let steps = ways.min_by_key(Vec::len).ok_or(Unsupported::Topology)?;
                    bridges.push(LoopCondition { steps, bridge: Some(self.number(i, j)?) });
                }
                [true, false] => held[j] += 1,
                [false, true] => held[i] += 1,
                [false, false] => return Err(Unsupported::Topology),
            }
        }
        let hangs = |v: usize| self.is_in_triangle(v) || (1..=2).contains(&held[v]);
        if (0..self.vertices()).all(hangs) { Ok(bridges) } else { Err(Unsupported::Topology) }
    }

    /// Whether a triangle lies on the left of the edge between these ends and none on its right.
    fn is_rim(&self, [a, b]: [usize; 2]) -> bool {
        self.directed[&[a, b]].left.is_some() && self.directed[&[b, a]].left.is_none()
    }

    /// Adds the steps from one edge of a rim to the next, clockwise through the triangles at the vertex between them.
    fn along_rim(&self, [from, at]: [usize; 2], steps: &mut Vec<LoopStep>) -> Result<[usize; 2], Unsupported> {
        let mut spoke = from;
        loop {
            // the triangle on the right of the spoke, seen from `at`
            let next = self.edge(spoke, at)?.left.ok_or(Unsupported::Topology)?;
            steps.push(LoopStep::Sector { edges: self.triangle(at, spoke, next)?, sign: -1.0 });
            let edge = self.number(at, next)?;
            spoke = next;
            if self.edge(next, at)?.left.is_none() {
                steps.push(LoopStep::Along { edge });
                return Ok([at, next]);
            }
            steps.push(LoopStep::Cross { edge, sign: -1.0 });
        }
    }
}
