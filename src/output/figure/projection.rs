//! From space to paper: an oblique view of a sheet along directions of its own.

use nalgebra::Matrix3;

use crate::math::Vec3;
use crate::numerics::dense::small::symmetric_eigen_3;

/// An orthographic view; the three directions are orthonormal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// Direction on the paper to the right.
    pub right: Vec3,
    /// Direction on the paper upwards.
    pub up: Vec3,
    /// Direction from the sheet to the eye.
    pub toward: Vec3,
    /// The normal of the sheet as a whole.
    pub normal: Vec3,
}

impl Projection {
    /// Looks down on the side of the face normals, with the longer side of the sheet across the paper.
    ///
    /// The eye stands `ELEVATION` above the mean plane of the sheet and `TURN` beside its second principal axis.
    pub(crate) fn of(points: &[Vec3], triangles: &[[usize; 3]]) -> Self {
        const ELEVATION: f64 = 0.82;
        const TURN: f64 = 0.5;
        let [across, along, normal] = principal_axes(points, triangles);
        let level = across * TURN.sin() - along * TURN.cos();
        let toward = normal * ELEVATION.sin() + level * ELEVATION.cos();
        let up = normal * ELEVATION.cos() - level * ELEVATION.sin();
        Self { right: up.cross(&toward), up, toward, normal }
    }

    /// Looks at a box along the axes, from above, the eye on these sides (1 or -1) of x and y.
    pub(crate) fn axonometric([x, y]: [f64; 2]) -> Self {
        const ELEVATION: f64 = 0.42;
        const TURN: f64 = 0.95;
        let level = Vec3::new(x * TURN.cos(), y * TURN.sin(), 0.0);
        let toward = Vec3::z() * ELEVATION.sin() + level * ELEVATION.cos();
        let up = Vec3::z() * ELEVATION.cos() - level * ELEVATION.sin();
        Self { right: up.cross(&toward), up, toward, normal: Vec3::z() }
    }

    /// Right, up and towards the eye.
    pub(crate) fn place(&self, point: &Vec3) -> [f64; 3] {
        [point.dot(&self.right), point.dot(&self.up), point.dot(&self.toward)]
    }
}

/// Longest extent, second extent and normal of a sheet: a right-handed orthonormal frame.
///
/// The normal is the direction of least extent, towards the mean of the face normals. Where the sheet is about as long
/// as wide its two other axes say nothing (and would turn with the last digit); then x of space is the first.
fn principal_axes(points: &[Vec3], triangles: &[[usize; 3]]) -> [Vec3; 3] {
    let finite: Vec<Vec3> = points.iter().copied().filter(|p| p.iter().all(|x| x.is_finite())).collect();
    let mean = finite.iter().sum::<Vec3>() / finite.len().max(1) as f64;
    let size = finite.iter().map(|p| (p - mean).amax()).fold(f64::MIN_POSITIVE, f64::max);
    let spread: Matrix3<f64> = finite.iter().map(|p| (p - mean) / size).map(|d| d * d.transpose()).sum();
    let (values, vectors) = symmetric_eigen_3(spread);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    let [long, _, thin] = order.map(|axis| vectors.column(axis).into_owned());
    let square = values[order[1]] > 0.7 * values[order[0]];
    let normal = upright(thin, mean_normal(points, triangles));
    let first = if square { level_x(normal).unwrap_or(long) } else { upright(long, Vec3::x()) };
    let second = normal.cross(&first);
    [first, second, normal]
}

/// The sum of the area vectors of the triangles.
fn mean_normal(points: &[Vec3], triangles: &[[usize; 3]]) -> Vec3 {
    let area = |&[a, b, c]: &[usize; 3]| (points[b] - points[a]).cross(&(points[c] - points[a]));
    triangles.iter().map(area).filter(|normal| normal.iter().all(|x| x.is_finite())).sum()
}

/// The axis or its opposite, whichever agrees with `side`; where `side` does not tell, the one that points to +z, +y,
/// +x.
fn upright(axis: Vec3, side: Vec3) -> Vec3 {
    let told = axis.dot(&side);
    let sense = if told.abs() > 1e-6 * side.norm() && told != 0.0 {
        told
    } else {
        axis.iter().rev().copied().find(|x| x.abs() > 1e-6).unwrap_or(1.0)
    };
    axis * sense.signum()
}

/// The direction in the plane across `normal` that is nearest to x, if there is one.
fn level_x(normal: Vec3) -> Option<Vec3> {
    (Vec3::x() - normal * normal.x).try_normalize(0.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet 4 long in y and 1 wide in x, its faces seen from below: the long side goes across the paper and the eye
    /// is below. Exact up to rounding of the eigenvectors.
    #[test]
    fn the_eye_is_on_the_side_of_the_normals() {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 4.0], [0.0, 4.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
        let view = Projection::of(&points, &[[0, 2, 1], [0, 3, 2]]);
        assert!((view.normal + Vec3::z()).norm() < 1e-12, "{view:?}");
        assert!(view.toward.dot(&view.normal) > 0.5);
        assert!(view.right.y.abs() > 0.85, "{view:?}");
        let frame = Matrix3::from_columns(&[view.right, view.up, view.toward]);
        assert!((frame.transpose() * frame - Matrix3::identity()).norm() < 1e-12);
        assert!((frame.determinant() - 1.0).abs() < 1e-12);
    }

    /// No points, one point and points that are not finite give a view as well.
    #[test]
    fn a_view_of_nothing() {
        for points in [vec![], vec![Vec3::zeros()], vec![Vec3::repeat(f64::NAN), Vec3::x()], vec![Vec3::repeat(1e300)]]
        {
            let view = Projection::of(&points, &[]);
            assert!((view.toward.norm() - 1.0).abs() < 1e-12, "{view:?}");
        }
    }
}
