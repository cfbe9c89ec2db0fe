//! All pairs of faces that cross, found by a tree of boxes.

use super::contact::{Triangle, cross};
use super::depth::depth;
use crate::math::Vec3;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};

/// Rounding errors that [`apart`] allows for, over the size of what is added up: several times what there can be.
const ROUNDING: f64 = 1e-15;

/// Pairs of faces that cross.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Crossings {
    /// For each triangle whether it crosses another one.
    pub faces: Vec<bool>,
    /// The pairs, ascending, the smaller number first.
    pub pairs: Vec<[usize; 2]>,
}

impl Crossings {
    /// The crossings of `faces` triangles, given the pairs in any order.
    fn new(faces: usize, mut pairs: Vec<[usize; 2]>) -> Self {
        pairs.iter_mut().for_each(|pair| pair.sort_unstable());
        pairs.sort_unstable();
        pairs.dedup();
        let mut marks = vec![false; faces];
        pairs.iter().flatten().for_each(|&face| marks[face] = true);
        Self { faces: marks, pairs }
    }
}

/// All pairs that cross, by the coordinates alone. See [`Finder`] for many states of one sheet.
///
/// # Panics
/// Where a triangle names a point that is not there.
pub fn crossings(positions: &[Vec3], triangles: &[[usize; 3]]) -> Crossings {
    Finder::new(triangles.to_vec()).crossings(positions, 0.0)
}

/// Finds crossings in states of one sheet. The tree is built for the first state and refitted to the others.
pub struct Finder {
    triangles: Vec<[usize; 3]>,
    tree: Option<Bvh>,
    workspace: BvhWorkspace,
}

impl Finder {
    /// For these triangles.
    pub fn new(triangles: Vec<[usize; 3]>) -> Self {
        Self { triangles, tree: None, workspace: BvhWorkspace::default() }
    }

    /// All pairs that cross and are deeper than `margin` in each other, in the unit of the positions. Faces with a
    /// corner that is not finite cross nothing.
    ///
    /// # Panics
    /// Where a triangle names a point that is not there.
    pub fn crossings(&mut self, positions: &[Vec3], margin: f64) -> Crossings {
        let faces: Vec<Triangle> = self.triangles.iter().map(|t| t.map(|point| positions[point])).collect();
        let tree = fitted(self.tree.take(), &faces);
        let mut pairs = Vec::new();
        tree.traverse_bvtt_single_tree::<false>(&mut self.workspace, &mut |i, j| {
            let pair = [i as usize, j as usize];
            if crosses(pair.map(|k| &self.triangles[k]), pair.map(|k| &faces[k]), margin) {
                pairs.push(pair);
            }
        });
        self.tree = Some(tree);
        Crossings::new(faces.len(), pairs)
    }
}

/// The tree of the boxes of these faces: an old one of as many faces refitted, or a new one.
fn fitted(old: Option<Bvh>, faces: &[Triangle]) -> Bvh {
    let boxes = faces.iter().map(around);
    match old {
        Some(mut tree) => {
            for (face, around) in boxes.enumerate() {
                tree.insert_or_update_partially(around, face as u32, 0.0);
            }
            tree.refit_without_opt();
            tree
        }
        None => Bvh::from_iter(BvhBuildStrategy::Binned, boxes.enumerate()),
    }
}

/// The box around a face; one at the origin for a face that is not finite, which crosses nothing.
fn around(face: &Triangle) -> Aabb {
    let finite = face.iter().flatten().all(|x| x.is_finite());
    let corners = if finite { face.map(Into::<[f64; 3]>::into) } else { [[0.0; 3]; 3] };
    Aabb::from_points(corners.map(Into::into))
}

/// Whether two faces, named by their points and given by their corners, cross.
fn crosses(names: [&[usize; 3]; 2], [a, b]: [&Triangle; 2], margin: f64) -> bool {
    let common = names[0].iter().filter(|point| names[1].contains(point)).count();
    // a depth is rounded: with margin 0 the exact verdict stands alone
    common < 2 && !apart(a, b) && cross(a, b) && (margin <= 0.0 || depth(a, b) > margin)
}

/// Whether a plane across the line of the centres leaves the triangles on different sides, rounding errors allowed for;
/// a common corner may lie in it. Such triangles do not cross. In a sheet that is nearly flat this spares most pairs
/// determinants that are nearly zero, which take long.
fn apart(a: &Triangle, b: &Triangle) -> bool {
    let centre = |t: &Triangle| t[0] + t[1] + t[2];
    let way = centre(b) - centre(a);
    let common = a.iter().find(|corner| b.contains(corner));
    let origin = common.unwrap_or(&a[0]);
    let (mut last_a, mut first_b) = (f64::NEG_INFINITY, f64::INFINITY);
    for corner in a {
        let arm = corner - origin;
        last_a = last_a.max(way.dot(&arm) + ROUNDING * way.abs().dot(&arm.abs()));
    }
    for corner in b {
        let arm = corner - origin;
        first_b = first_b.min(way.dot(&arm) - ROUNDING * way.abs().dot(&arm.abs()));
    }
    last_a <= first_b
}
