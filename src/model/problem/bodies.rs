//! Rigid parts in the unknowns of a model: poses instead of the coordinates of their vertices.
//!
//! The pose of a part has six numbers: the displacement of the centroid of its vertices from the drawn state, and the
//! rotation vector `w` of the part from there. A vertex at the arm `r` from the drawn centroid is at
//! `centroid + displacement + R(w) r`. The *generalised coordinates* of a model are the coordinates of all vertices,
//! followed by six for each part; those of the vertices of a part follow from its pose.

use crate::math::{Vec3, in_lower_triangle, lower_triangle, point, rotation};
use crate::model::element::Local;
use crate::model::terms::Part;
use crate::numerics::dense::small::nearest_rotation;
use crate::sheet::tiling::Site;
use nalgebra::Matrix3;
use std::f64::consts::TAU;

/// Number of coordinates of a pose.
pub(super) const POSE: usize = 6;

/// The parts of a model.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bodies {
    bodies: Vec<Body>,
    /// Number of the part of every vertex; empty without parts.
    part_of: Vec<Option<usize>>,
}

/// A part in the drawn state.
#[derive(Clone, Debug)]
struct Body {
    part: Part,
    centroid: Vec3,
    /// Vectors from the centroid to the vertices.
    arms: Vec<Vec3>,
}

impl Bodies {
    /// Makes the parts of a patch whose vertices have these coordinates in the drawn state.
    pub(crate) fn new(parts: &[Part], drawn: &[f64]) -> Self {
        if parts.is_empty() {
            return Self::default();
        }
        let mut part_of = vec![None; drawn.len() / 3];
        for (number, part) in parts.iter().enumerate() {
            part.vertices.iter().for_each(|&v| part_of[v] = Some(number));
        }
        Self { bodies: parts.iter().map(|part| Body::new(part.clone(), drawn)).collect(), part_of }
    }

    /// Whether there are no parts.
    pub(super) fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Number of coordinates of all poses.
    pub(super) fn coordinates(&self) -> usize {
        POSE * self.bodies.len()
    }

    /// Returns the number of the part to which a vertex belongs.
    pub(super) fn part_of(&self, vertex: usize) -> Option<usize> {
        self.part_of.get(vertex).copied().flatten()
    }

    /// Whether one part has all these sites, so that their measure keeps its value.
    pub(crate) fn hold(&self, sites: &[Site]) -> bool {
        let part = |site: &Site| self.part_of(site.vertex);
        sites.first().and_then(part).is_some_and(|first| sites.iter().all(|site| part(site) == Some(first)))
    }

    /// Whether one of these points belongs to a part.
    pub(super) fn touch(&self, sites: &[Site]) -> bool {
        !self.is_empty() && sites.iter().any(|site| self.part_of(site.vertex).is_some())
    }

    /// Returns whether each coordinate of all poses is free.
    pub(super) fn free(&self) -> impl Iterator<Item = bool> + '_ {
        self.bodies.iter().flat_map(|body| body.part.free)
    }

    /// Returns the pivot of a part, the point that its displacement moves.
    pub(super) fn pivot(&self, part: usize, generalised: &[f64]) -> Vec3 {
        self.bodies[part].centroid + self.displacement(part, generalised)
    }

    /// Whether the vertices of a part stand in one place, up to this distance: then its rotation moves nothing.
    pub(super) fn is_point(&self, part: usize, distance: f64) -> bool {
        self.bodies[part].arms.iter().all(|arm| arm.norm() <= distance)
    }

    /// Returns the rotation vector of a part.
    pub(super) fn rotation(&self, part: usize, generalised: &[f64]) -> Vec3 {
        Vec3::from_column_slice(&generalised[self.pose(part, generalised) + 3..][..3])
    }

    fn displacement(&self, part: usize, generalised: &[f64]) -> Vec3 {
        Vec3::from_column_slice(&generalised[self.pose(part, generalised)..][..3])
    }

    /// Returns where the pose of a part begins among the generalised coordinates.
    fn pose(&self, part: usize, generalised: &[f64]) -> usize {
        generalised.len() - self.coordinates() + POSE * part
    }

    /// Puts the vertices of all parts where their poses say.
    pub(super) fn place(&self, generalised: &mut [f64]) {
        for (part, body) in self.bodies.iter().enumerate() {
            let pivot = self.pivot(part, generalised);
            let turn = rotation::exp(&self.rotation(part, generalised));
            for (&vertex, arm) in body.part.vertices.iter().zip(&body.arms) {
                let point = pivot + turn * arm;
                generalised[3 * vertex..3 * vertex + 3].copy_from_slice(point.as_slice());
            }
        }
    }

    /// Sets the poses to those that bring the parts closest to where their vertices are, their coordinates that are not
    /// free to zero. Of the rotation vectors of one rotation the one nearest to that of `before` is taken.
    pub(super) fn find_poses(&self, generalised: &mut [f64], before: &[f64]) {
        self.find_all_poses(generalised, before);
        let first = generalised.len() - self.coordinates();
        let held = self.free().enumerate().filter(|(_, free)| !free);
        held.for_each(|(k, _)| generalised[first + k] = 0.0);
    }

    /// Sets the poses to those that bring the parts closest to where their vertices are, as if all their coordinates
    /// were free.
    pub(super) fn find_all_poses(&self, generalised: &mut [f64], before: &[f64]) {
        for (part, body) in self.bodies.iter().enumerate() {
            let pose = self.pose(part, generalised);
            let count = body.part.vertices.len() as f64;
            let centroid = body.part.vertices.iter().map(|&v| point(generalised, v)).sum::<Vec3>() / count;
            let pairs = body.part.vertices.iter().zip(&body.arms);
            let moment: Matrix3<f64> =
                pairs.map(|(&v, arm)| (point(generalised, v) - centroid) * arm.transpose()).sum();
            let turn = nearest_turn(rotation::log(&nearest_rotation(&moment)), self.rotation(part, before));
            let moved = centroid - body.centroid;
            let found = [moved.x, moved.y, moved.z, turn.x, turn.y, turn.z];
            generalised[pose..pose + POSE].copy_from_slice(&found);
        }
    }

    /// Returns the arm of a vertex of a part, turned as the part is, with its derivatives by the rotation vector.
    fn moved(&self, part: usize, vertex: usize, generalised: &[f64]) -> Option<rotation::Turned> {
        let body = &self.bodies[part];
        let arm = body.part.vertices.iter().position(|v| *v == vertex).map(|k| body.arms[k])?;
        Some(rotation::turned(&self.rotation(part, generalised), &arm))
    }

    /// Converts the derivatives of an element by the coordinates of its points to derivatives by the coordinates of
    /// its members: those of a point, or the pose of its part.
    pub(super) fn pull(&self, sites: &[Site], generalised: &[f64], local: &mut Local) {
        let of_site = |site: &Site| self.moved(self.part_of(site.vertex)?, site.vertex, generalised);
        let turned: Vec<Option<rotation::Turned>> = sites.iter().map(of_site).collect();
        let turns: Vec<Option<Matrix3<f64>>> =
            turned.iter().map(|turned| turned.as_ref().map(|turned| Matrix3::from_columns(&turned.first))).collect();
        let (mut starts, mut gradient) = (vec![], vec![]);
        for (k, turn) in turns.iter().enumerate() {
            let force = point(&local.gradient, k);
            starts.push(gradient.len());
            gradient.extend_from_slice(force.as_slice());
            turn.iter().for_each(|turn| gradient.extend_from_slice(turn.tr_mul(&force).as_slice()));
        }
        if !local.hessian.is_empty() {
            let mut pulled = vec![0.0; lower_triangle(gradient.len()).count()];
            let of_block = |k: usize, l: usize| {
                Matrix3::from_fn(|row, column| local.hessian[in_lower_triangle(3 * k + row, 3 * l + column)])
            };
            for (k, left) in turns.iter().enumerate() {
                for (l, right) in turns[..=k].iter().enumerate() {
                    let (block, [row, column]) = (of_block(k, l), [starts[k], starts[l]]);
                    add_lower(&mut pulled, [row, column], &block);
                    if let Some(left) = left {
                        add_lower(&mut pulled, [row + 3, column], &left.tr_mul(&block));
                    }
                    if let Some(right) = right {
                        let by_turn = block * right;
                        add_lower(&mut pulled, [row, column + 3], &by_turn);
                        if let Some(left) = left {
                            add_lower(&mut pulled, [row + 3, column + 3], &left.tr_mul(&by_turn));
                        }
                    }
                }
                if let Some(turned) = &turned[k] {
                    let curvature = curvature(turned, &point(&local.gradient, k));
                    add_lower(&mut pulled, [starts[k] + 3; 2], &curvature);
                }
            }
            local.hessian = pulled;
        }
        local.gradient = gradient;
    }

    /// Returns the velocities of the vertices of all parts for rates of their poses, in place.
    pub(super) fn set_velocities(&self, generalised: &[f64], rates: &mut [f64]) {
        for (part, body) in self.bodies.iter().enumerate() {
            let [shift, turn] = [self.displacement(part, rates), self.rotation(part, rates)];
            let at = self.rotation(part, generalised);
            for (&vertex, arm) in body.part.vertices.iter().zip(&body.arms) {
                let first = rotation::turned(&at, arm).first;
                let velocity = shift + (0..3).map(|k| first[k] * turn[k]).sum::<Vec3>();
                rates[3 * vertex..3 * vertex + 3].copy_from_slice(velocity.as_slice());
            }
        }
    }

    /// Returns the parts that carry loads, each with its loads as pairs of a vertex and a force.
    pub(super) fn loaded(&self, loads: &[f64]) -> Vec<(usize, Vec<(usize, Vec3)>)> {
        let of = |body: &Body| -> Vec<(usize, Vec3)> {
            body.part.vertices.iter().map(|&v| (v, point(loads, v))).filter(|(_, force)| force.amax() > 0.0).collect()
        };
        let all = self.bodies.iter().map(of).enumerate();
        all.filter(|(_, forces)| !forces.is_empty()).collect()
    }

    /// Puts the potential `-sum f x` of forces on a part, with its derivatives by the pose, into `local`.
    pub(super) fn load(&self, part: usize, forces: &[(usize, Vec3)], generalised: &[f64], local: &mut Local) {
        let (mut gradient, mut hessian) = (vec![0.0; POSE], vec![0.0; lower_triangle(POSE).count()]);
        for (vertex, force) in forces {
            let Some(turned) = self.moved(part, *vertex, generalised) else { continue };
            (0..3).for_each(|k| gradient[k] -= force[k]);
            (0..3).for_each(|k| gradient[3 + k] -= force.dot(&turned.first[k]));
            add_lower(&mut hessian, [3, 3], &curvature(&turned, &-force));
        }
        local.gradient = gradient;
        local.hessian = hessian;
    }
}

impl Body {
    fn new(part: Part, drawn: &[f64]) -> Self {
        let centroid = part.vertices.iter().map(|&v| point(drawn, v)).sum::<Vec3>() / part.vertices.len() as f64;
        let arms = part.vertices.iter().map(|&v| point(drawn, v) - centroid).collect();
        Self { part, centroid, arms }
    }
}

/// The second derivative of a point by the rotation vector of its part, times a force.
fn curvature(turned: &rotation::Turned, force: &Vec3) -> Matrix3<f64> {
    Matrix3::from_fn(|k, l| force.dot(&turned.second[k][l]))
}

/// Adds a block that begins at a row and a column to a symmetric matrix of which the lower triangle is stored; what lies
/// above the diagonal is left out.
fn add_lower(lower: &mut [f64], [row, column]: [usize; 2], block: &Matrix3<f64>) {
    for k in 0..3 {
        for l in (0..3).filter(|l| column + l <= row + k) {
            lower[in_lower_triangle(row + k, column + l)] += block[(k, l)];
        }
    }
}

/// Returns the rotation vector of the same rotation as `turn` that is nearest to `near`.
fn nearest_turn(turn: Vec3, near: Vec3) -> Vec3 {
    let angle = turn.norm();
    let axis = if angle > 1e-8 { turn / angle } else { near.try_normalize(0.0).unwrap_or(Vec3::x()) };
    let windings = ((near.dot(&axis) - angle) / TAU).round();
    if windings == 0.0 { turn } else { axis * (angle + TAU * windings) }
}
