//! Projection from space to the figure: an oblique parallel view of a sheet along its principal axes.

use nalgebra::Matrix3;

use crate::math::Vec3;
use crate::numerics::dense::small::symmetric_eigen_3;

/// An orthographic projection; `right`, `up` and `toward` are orthonormal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// Direction in space that points to the right in the figure.
    pub right: Vec3,
    /// Direction in space that points upwards in the figure.
    pub up: Vec3,
    /// Direction from the sheet to the eye.
    pub toward: Vec3,
    /// Mean normal of the sheet.
    pub normal: Vec3,
}

impl Projection {
    /// Returns the view from the side of the face normals in which the longer side of the sheet runs across the figure.
    ///
    /// The view direction has the angle `ELEVATION` to the mean plane of the sheet; its part in that plane has the
    /// angle `TURN` to the second principal axis. Both are in radians.
    pub(crate) fn of(points: &[Vec3], triangles: &[[usize; 3]]) -> Self {
        const ELEVATION: f64 = 0.82;
        const TURN: f64 = 0.5;
        let [across, along, normal] = principal_axes(points, triangles);
        let level = across * TURN.sin() - along * TURN.cos();
        let toward = normal * ELEVATION.sin() + level * ELEVATION.cos();
        let up = normal * ELEVATION.cos() - level * ELEVATION.sin();
        Self { right: up.cross(&toward), up, toward, normal }
    }

    /// Returns the view from above of a box along the coordinate axes. `x` and `y` (1 or -1) are the sides on which the
    /// eye is.
    pub(crate) fn axonometric([x, y]: [f64; 2]) -> Self {
        const ELEVATION: f64 = 0.42;
        const TURN: f64 = 0.95;
        let level = Vec3::new(x * TURN.cos(), y * TURN.sin(), 0.0);
        let toward = Vec3::z() * ELEVATION.sin() + level * ELEVATION.cos();
        let up = Vec3::z() * ELEVATION.cos() - level * ELEVATION.sin();
        Self { right: up.cross(&toward), up, toward, normal: Vec3::z() }
    }

    /// Returns the coordinates `[right, up, toward]` of a point.
    pub(crate) fn place(&self, point: &Vec3) -> [f64; 3] {
        [point.dot(&self.right), point.dot(&self.up), point.dot(&self.toward)]
    }
}

/// Returns the principal axes of a sheet, a right-handed orthonormal frame: the directions of the largest and second
/// largest extent, and the normal.
///
/// The normal is the direction of least extent, oriented like the mean of the face normals. If the sheet is about as
/// long as wide, its other two axes are not well defined (they would change with rounding errors); then the first axis
/// is the direction in the plane nearest to x.
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

/// Returns twice the sum of the area vectors of the triangles.
fn mean_normal(points: &[Vec3], triangles: &[[usize; 3]]) -> Vec3 {
    let area = |&[a, b, c]: &[usize; 3]| (points[b] - points[a]).cross(&(points[c] - points[a]));
    triangles.iter().map(area).filter(|normal| normal.iter().all(|x| x.is_finite())).sum()
}

/// Returns the axis or its opposite, whichever has a positive component along `side`; if both are perpendicular to
/// `side`, the one that points to +z, or else to +y, or else to +x.
fn upright(axis: Vec3, side: Vec3) -> Vec3 {
    let told = axis.dot(&side);
    let sense = if told.abs() > 1e-6 * side.norm() && told != 0.0 {
        told
    } else {
        axis.iter().rev().copied().find(|x| x.abs() > 1e-6).unwrap_or(1.0)
    };
    axis * sense.signum()
}

/// Returns the unit vector perpendicular to `normal` that is nearest to x; `None` if `normal` is nearly parallel to x.
fn level_x(normal: Vec3) -> Option<Vec3> {
    (Vec3::x() - normal * normal.x).try_normalize(0.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For a sheet of length 4 in y and width 1 in x, with face normals downwards, the long side runs across the figure
    /// and the eye is below. Exact up to rounding of the eigenvectors.
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

    /// Sheets of no point, one point or points that are not finite have a view as well.
    #[test]
    fn a_view_of_nothing() {
        for points in [vec![], vec![Vec3::zeros()], vec![Vec3::repeat(f64::NAN), Vec3::x()], vec![Vec3::repeat(1e300)]]
        {
            let view = Projection::of(&points, &[]);
            assert!((view.toward.norm() - 1.0).abs() < 1e-12, "{view:?}");
        }
    }
}
