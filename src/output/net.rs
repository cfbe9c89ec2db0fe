//! Points of two kinds of files: triangles and curves between common points, and a grid in the plane.

use crate::math::Vec3;

/// Triangles and curves between common points.
#[derive(Clone, Debug, Default)]
pub struct Net {
    /// Positions of the points.
    pub points: Vec<Vec3>,
    /// Points at the corners of each triangle.
    pub triangles: Vec<[usize; 3]>,
    /// Points of each curve.
    pub curves: Vec<Vec<usize>>,
    /// Name of each array, and its numbers at the points.
    pub arrays: Vec<(&'static str, Vec<f64>)>,
    /// Name of each array of curves, and its number for each of them.
    pub of_curves: Vec<(&'static str, Vec<i32>)>,
}

/// Values at the points `origin + (k1, k2) * spacing` of a grid in the plane.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Numbers of points along the two axes.
    pub size: [usize; 2],
    /// Coordinates of the first point.
    pub origin: [f64; 2],
    /// Distances between neighbouring points along the two axes.
    pub spacing: [f64; 2],
    /// Name of each array, and its values at the points; the first axis runs faster.
    pub arrays: Vec<(&'static str, Vec<f64>)>,
}
