//! Closing round the openings of a finite sheet: a tube, a ring, a closed surface with handles.
//!
//! The faces round its interior vertices may close while those round an opening do not. A loop leads over the faces
//! round the opening and back to the first. From the drawn sheet, which closes, folding turns the faces behind each
//! edge on the way by `rho - rho0` about the edge as drawn, and the product of these motions is the identity: six
//! conditions for each opening. What changes with an angle is the twist of the edge where the motions before it have
//! taken it, `(w, u)`; of two edges `j` before `k` the rotation vector changes in addition by `1/2 w_j x w_k`, and the
//! translation by `w_j x u_k`.

use crate::kinematics::motion::{Line, Motion, Rigid, Twist};
use crate::math::fold_angle::fold_angle;
use crate::math::{Vec3, rotation};
use crate::numerics::DenseMatrix;
use crate::sheet::{Corner, TiledEdge};
use std::collections::{HashMap, VecDeque};

/// Number of conditions for each opening: a rotation vector, and a translation relative to the size of the loop.
pub(super) const ROWS: usize = 6;

/// A loop over the faces.
#[derive(Clone, Debug)]
pub(super) struct Opening {
    turns: Vec<Turn>,
    /// Unit of length: the largest distance of an edge of the loop from their centre.
    unit: f64,
}

/// An edge on a loop.
#[derive(Clone, Copy, Debug)]
struct Turn {
    edge: usize,
    /// Column of the Jacobian; `None` if the edge is locked.
    column: Option<usize>,
    /// The edge as drawn, from the centre of the loop; a larger fold angle turns the faces behind it counter-clockwise
    /// about it.
    line: Line,
    /// Fold angle as drawn.
    drawn: f64,
}

impl Opening {
    /// Gives every edge of the loop its column.
    pub(super) fn set_columns(&mut self, columns: &[Option<usize>]) {
        self.turns.iter_mut().for_each(|turn| turn.column = columns[turn.edge]);
    }

    /// Goes round the opening, and calls `visit` with every edge and its twist; returns the product of the motions.
    fn walk(&self, angles: &[f64], mut visit: impl FnMut(&Turn, Twist)) -> Motion {
        let mut motion = Motion::identity();
        for turn in &self.turns {
            visit(turn, Twist::about(&turn.line, 1.0).carried_by(&motion));
            motion = motion * Motion::about(&turn.line, angles[turn.edge] - turn.drawn);
        }
        motion
    }

    /// Writes the six values that vanish where the loop closes.
    pub(super) fn residual_into(&self, angles: &[f64], rows: &mut [f64]) {
        self.put(&self.walk(angles, |_, _| {}), rows);
    }

    fn put(&self, product: &Motion, rows: &mut [f64]) {
        rows[..3].copy_from_slice(rotation::log(&product.rotation).as_slice());
        rows[3..].copy_from_slice((product.translation / self.unit).as_slice());
    }

    /// Writes the values and their derivatives, from this row of the Jacobian on.
    pub(super) fn linearize_into(&self, angles: &[f64], rows: &mut [f64], (jacobian, row): (&mut DenseMatrix, usize)) {
        let mut twists = Vec::with_capacity(self.turns.len());
        let product = self.walk(angles, |turn, twist| twists.push((turn.column, twist)));
        self.put(&product, rows);
        let chart = rotation::inverse_left_jacobian(&rotation::log(&product.rotation));
        for (column, twist) in twists.into_iter().filter_map(|(column, twist)| Some((column?, twist))) {
            let mut place = jacobian.fixed_view_mut::<3, 1>(row, column);
            place += chart * twist.angular;
            let mut place = jacobian.fixed_view_mut::<3, 1>(row + 3, column);
            place += twist.at(&product.translation) / self.unit;
        }
    }

    /// Adds the second-order parts along motions, as `Closure::second_order` does.
    pub(super) fn add_second_order(&self, angles: &[f64], modes: &DenseMatrix, parts: &mut [DenseMatrix]) {
        let mut before = vec![Vec3::zeros(); modes.ncols()];
        self.walk(angles, |turn, Twist { angular, linear }| {
            let rates: Vec<f64> = modes.row(turn.edge).iter().copied().collect();
            let turns: Vec<Vec3> = rates.iter().map(|rate| *rate * angular).collect();
            let shifts: Vec<Vec3> = rates.iter().map(|rate| (*rate / self.unit) * linear).collect();
            add_products(&mut parts[..3], (&before, &turns), 0.25);
            before.iter_mut().zip(&turns).for_each(|(sum, turn)| *sum += 0.5 * turn);
            add_products(&mut parts[3..], (&before, &shifts), 0.5);
            before.iter_mut().zip(&turns).for_each(|(sum, turn)| *sum += 0.5 * turn);
        });
    }
}

/// A step from a face over an edge to the next.
#[derive(Clone, Copy)]
struct FaceStep {
    edge: usize,
    to: usize,
    /// Whether the step leads from the right to the left face.
    leftwards: bool,
}

/// Loops round the openings of a finite sheet, `inside` being its interior vertices; none where its faces do not hang
/// together by edges.
///
/// A tree of steps reaches every face. Each edge that is not in it closes a loop; those of a forest of such edges that
/// joins every interior vertex to a rim follow from the closure of these vertices, and the others are the loops round
/// openings.
pub(super) fn openings(edges: &[TiledEdge], inside: &[usize], position: &impl Fn(Corner) -> Vec3) -> Vec<Opening> {
    let (beside, faces) = faces_beside(edges);
    let mut steps: Vec<Vec<FaceStep>> = vec![Vec::new(); faces];
    for (edge, [left, right]) in beside.iter().enumerate().filter_map(|(edge, pair)| Some((edge, (*pair)?))) {
        steps[right].push(FaceStep { edge, to: left, leftwards: true });
        steps[left].push(FaceStep { edge, to: right, leftwards: false });
    }
    let Some(ways) = ways(&steps) else { return Vec::new() };
    let vertices = edges.iter().flat_map(|edge| edge.ends).map(|end| end.vertex + 1).max().unwrap_or(0);
    // all rims are one place, the last; a closed sheet has the first vertex there
    let mut place = vec![vertices; vertices];
    inside.iter().filter(|&&vertex| inside.len() < vertices || vertex > 0).for_each(|&vertex| place[vertex] = vertex);
    let in_tree: Vec<usize> = ways.iter().filter_map(|way| Some(way.last()?.edge)).collect();
    let mut loops = Vec::new();
    for (edge, pair) in beside.iter().enumerate() {
        let Some([left, right]) = pair.filter(|_| !in_tree.contains(&edge)) else { continue };
        let [a, b] = edges[edge].ends.map(|end| place[end.vertex]);
        if a == b {
            loops.push(round(&ways, edge, [left, right]));
        } else {
            place.iter_mut().filter(|place| **place == a.min(b)).for_each(|place| *place = a.max(b));
        }
    }
    loops.into_iter().map(|steps| Opening::new(&steps, edges, position)).collect()
}

/// The left and the right face of every edge that has both, and the number of faces.
fn faces_beside(edges: &[TiledEdge]) -> (Vec<Option<[usize; 2]>>, usize) {
    let mut numbers = HashMap::new();
    let mut face = |edge: &TiledEdge, side: usize| {
        let mut corners = [edge.ends[0].vertex, edge.ends[1].vertex, edge.wings[side]?.vertex];
        corners.sort_unstable();
        let next = numbers.len();
        Some(*numbers.entry(corners).or_insert(next))
    };
    let beside = edges.iter().map(|edge| [face(edge, 0), face(edge, 1)]).collect::<Vec<_>>();
    let both = beside.into_iter().map(|[left, right]| Some([left?, right?])).collect();
    (both, numbers.len())
}

/// The shortest way from the first face to each; `None` where a face is not reached.
fn ways(steps: &[Vec<FaceStep>]) -> Option<Vec<Vec<FaceStep>>> {
    let mut ways: Vec<Option<Vec<FaceStep>>> = vec![None; steps.len()];
    *ways.first_mut()? = Some(Vec::new());
    let mut waiting = VecDeque::from([0]);
    while let Some(face) = waiting.pop_front() {
        for step in &steps[face] {
            if ways[step.to].is_none() {
                ways[step.to] = ways[face].as_ref().map(|way| way.iter().chain([step]).copied().collect());
                waiting.push_back(step.to);
            }
        }
    }
    ways.into_iter().collect()
}

/// The loop over an edge from its right to its left face and back along the tree, without what both ways share.
fn round(ways: &[Vec<FaceStep>], edge: usize, [left, right]: [usize; 2]) -> Vec<FaceStep> {
    let [there, back] = [&ways[right], &ways[left]];
    let shared = there.iter().zip(back).take_while(|(a, b)| a.edge == b.edge).count();
    let across = FaceStep { edge, to: left, leftwards: true };
    let reversed = back[shared..].iter().rev().map(|step| FaceStep { leftwards: !step.leftwards, ..*step });
    there[shared..].iter().copied().chain([across]).chain(reversed).collect()
}

impl Opening {
    fn new(steps: &[FaceStep], edges: &[TiledEdge], position: &impl Fn(Corner) -> Vec3) -> Self {
        let ends: Vec<[Vec3; 2]> = steps.iter().map(|step| edges[step.edge].ends.map(position)).collect();
        let centre = ends.iter().flatten().sum::<Vec3>() / (2 * ends.len()) as f64;
        let unit = ends.iter().flatten().map(|end| (end - centre).norm()).fold(0.0, f64::max);
        let turn = |(step, [from, to]): (&FaceStep, &[Vec3; 2])| {
            let edge = &edges[step.edge];
            let drawn = match edge.wings {
                [Some(left), Some(right)] => fold_angle([*from, *to, position(left), position(right)]),
                _ => 0.0,
            };
            let along = (to - from).normalize();
            let direction = if step.leftwards { along } else { -along };
            Turn { edge: step.edge, column: None, line: Line { point: from - centre, direction }, drawn }
        };
        Self { turns: steps.iter().zip(&ends).map(turn).collect(), unit }
    }
}

/// Adds the symmetric part of `2 half before_a x turns_b` to the matrices of its three components.
pub(super) fn add_products(parts: &mut [DenseMatrix], (before, turns): (&[Vec3], &[Vec3]), half: f64) {
    for (a, before) in before.iter().enumerate() {
        for (b, turn) in turns.iter().enumerate() {
            let product = half * before.cross(turn);
            for (part, component) in parts.iter_mut().zip(product.iter()) {
                part[(a, b)] += component;
                part[(b, a)] += component;
            }
        }
    }
}
