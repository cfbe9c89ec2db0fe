//! Projection from space to the figure: an oblique parallel view of a sheet along its principal axes; of a sheet that
//! is closed round an axis with that axis upright, and of a plane one that stands as it stands.

use nalgebra::Matrix3;

use crate::math::Vec3;
use crate::numerics::dense::small::symmetric_eigen_3;

/// Most that the face normals of a closed sheet sum up to, over the sum of their sizes.
const CANCELLED: f64 = 0.15;
/// Least part of the faces of a closed sheet, by volume to its middle, that is turned outwards more than inwards.
const OUTWARD: f64 = 0.7;
/// Least extent of a closed sheet over its largest, squared.
const THICK: f64 = 0.05;
/// Two extents, squared, are about equal if the smaller one is more than this part of the larger one.
const EQUAL: f64 = 0.7;
/// Most height of the normal of a plane sheet that stands: 30 degrees from the level.
const STANDING: f64 = 0.5;
/// Least extent over the largest, squared, up to which a sheet is plane.
const PLANE: f64 = 1e-4;

/// An orthographic projection; `right`, `up` and `toward` are orthonormal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// Direction in space that points to the right in the figure.
    pub right: Vec3,
    /// Direction in space that points upwards in the figure.
    pub up: Vec3,
    /// Direction from the sheet to the eye.
    pub toward: Vec3,
    /// Mean normal of the sheet; of a closed one, its axis; of a plane one that stands, z.
    pub normal: Vec3,
}

impl Projection {
    /// Returns the view from the side of the face normals in which the longer side of the sheet runs across the figure.
    /// A sheet that is closed round an axis, such as a tube or a drum, stands upright and is seen from less high above;
    /// so is one in an upright plane, as a truss in x and z, with z upwards.
    ///
    /// The view direction has the angle `ELEVATION` to the mean plane of the sheet, `OF_UPRIGHT` to the level of one
    /// that stands; its part in that plane has the angle `TURN` to the second principal axis. All are in radians.
    pub(crate) fn of(points: &[Vec3], triangles: &[[usize; 3]]) -> Self {
        const ELEVATION: f64 = 0.82;
        const OF_UPRIGHT: f64 = 0.4;
        const TURN: f64 = 0.5;
        let spread = Spread::of(points);
        let normals = Normals::of(&spread.places, triangles);
        let (axes, elevation) = match spread.axis(&normals) {
            Some(axis) => ([level_x(axis), axis.cross(&level_x(axis)), axis], OF_UPRIGHT),
            None => match spread.principal_axes(&normals) {
                [.., normal] if normal.z.abs() < STANDING && spread.extents[2] <= PLANE * spread.extents[0] => {
                    let along = -Vec3::new(normal.x, normal.y, 0.0).normalize();
                    ([along.cross(&Vec3::z()), along, Vec3::z()], OF_UPRIGHT)
                }
                axes => (axes, ELEVATION),
            },
        };
        let [across, along, normal] = axes;
        let level = across * TURN.sin() - along * TURN.cos();
        let toward = normal * elevation.sin() + level * elevation.cos();
        let up = normal * elevation.cos() - level * elevation.sin();
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

/// The points of a sheet about their mean in units of their largest distance from it, and how far they are spread.
struct Spread {
    places: Vec<Vec3>,
    /// Sums of squares along the directions of largest, second largest and least extent, and these directions.
    extents: [f64; 3],
    directions: [Vec3; 3],
}

/// Sums over the faces of a sheet.
#[derive(Default)]
struct Normals {
    /// Their area vectors, and the lengths of these.
    vectors: Vec3,
    sizes: f64,
    /// Their volumes to the middle of the sheet, positive where a face is turned outwards, and the sizes of these.
    volume: f64,
    volumes: f64,
}

impl Spread {
    fn of(points: &[Vec3]) -> Self {
        let finite: Vec<Vec3> = points.iter().copied().filter(|p| p.iter().all(|x| x.is_finite())).collect();
        let mean = finite.iter().sum::<Vec3>() / finite.len().max(1) as f64;
        let size = finite.iter().map(|p| (p - mean).amax()).fold(f64::MIN_POSITIVE, f64::max);
        let spread: Matrix3<f64> = finite.iter().map(|p| (p - mean) / size).map(|d| d * d.transpose()).sum();
        let (values, vectors) = symmetric_eigen_3(spread);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
        Self {
            places: points.iter().map(|p| (p - mean) / size).collect(),
            extents: order.map(|axis| values[axis]),
            directions: order.map(|axis| vectors.column(axis).into_owned()),
        }
    }

    /// Returns the principal axes of a sheet, a right-handed orthonormal frame: the directions of the largest and
    /// second largest extent, and the normal.
    ///
    /// The normal is the direction of least extent, oriented like the mean of the face normals. If the sheet is about
    /// as long as wide, its other two axes are not well defined (they would change with rounding errors); then the
    /// first axis is the direction in the plane nearest to x.
    fn principal_axes(&self, normals: &Normals) -> [Vec3; 3] {
        let [long, _, thin] = self.directions;
        let normal = upright(thin, normals.vectors);
        let square = self.extents[1] > EQUAL * self.extents[0];
        let first = if square { level_x(normal) } else { upright(long, Vec3::x()) };
        [first, normal.cross(&first), normal]
    }

    /// Returns the axis round which a sheet is closed, upwards; `None` if it is not closed.
    ///
    /// The face normals of a closed sheet cancel, and nearly all of its faces are turned outwards, or nearly all
    /// inwards. Its extents across the axis are about equal, so that the axis is the direction of the third. A sheet
    /// that is as long as wide and high stands as it is drawn.
    fn axis(&self, normals: &Normals) -> Option<Vec3> {
        let [most, middle, least] = self.extents;
        let cancelled = normals.vectors.norm() <= CANCELLED * normals.sizes;
        let outward = normals.volume.abs() >= OUTWARD * normals.volumes;
        if !(cancelled && outward && least > THICK * most) {
            return None;
        }
        let axis = match (least > EQUAL * most, middle * middle > most * least) {
            (true, _) => Vec3::z(),
            (false, true) => self.directions[2],
            (false, false) => self.directions[0],
        };
        Some(upright(axis, Vec3::z()))
    }
}

impl Normals {
    fn of(places: &[Vec3], triangles: &[[usize; 3]]) -> Self {
        let mut sum = Self::default();
        for corners in triangles {
            let [a, b, c] = corners.map(|corner| places[corner]);
            let vector = (b - a).cross(&(c - a));
            let volume = vector.dot(&(a + b + c));
            if volume.is_finite() {
                sum.vectors += vector;
                sum.sizes += vector.norm();
                sum.volume += volume;
                sum.volumes += volume.abs();
            }
        }
        sum
    }
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

/// Returns the unit vector perpendicular to `normal` that is nearest to x, or to y if `normal` is nearly parallel to x.
fn level_x(normal: Vec3) -> Vec3 {
    let level = |axis: Vec3| axis - normal * normal.dot(&axis);
    level(Vec3::x()).try_normalize(0.1).unwrap_or_else(|| level(Vec3::y()).normalize())
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

    /// Claim: a sheet in an upright plane is seen with z upwards, from the side of its normals, whichever that is.
    #[test]
    fn upright_sheets_stand() {
        for turn in [0.0, 1.0, 2.5, -2.0] {
            let out = Vec3::new(f64::sin(turn), f64::cos(turn), 0.1).normalize();
            let across = out.cross(&Vec3::z()).normalize();
            let points =
                [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]].map(|[s, t]| across * s - out.cross(&across) * t);
            let normal = (points[1] - points[0]).cross(&(points[2] - points[0]));
            let view = Projection::of(&points, &[[0, 1, 2], [0, 2, 3]]);
            assert!(
                view.up.z > 0.9 && view.right.z.abs() < 1e-12 && view.toward.dot(&normal) > 0.0,
                "{turn}: {view:?}"
            );
        }
    }

    /// Claim: the side of a prism of six faces stands upright whatever its axis and its height, and a zigzag of as many
    /// faces, folded until their normals cancel, does not.
    #[test]
    fn tubes_stand() {
        let turns = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
        for (axes, height) in turns.iter().flat_map(|axes| [0.7, 5.0].map(|height| (axes, height))) {
            let corner = |k: usize, level: f64| {
                let angle = (k % 6) as f64 * std::f64::consts::FRAC_PI_3;
                let place = [angle.cos(), angle.sin(), level * height];
                Vec3::new(place[axes[0]], place[axes[1]], place[axes[2]])
            };
            let points: Vec<Vec3> = [0.0, 1.0].iter().flat_map(|level| (0..6).map(|k| corner(k, *level))).collect();
            let side = |k: usize| [[k, (k + 1) % 6, 6 + k], [(k + 1) % 6, 6 + (k + 1) % 6, 6 + k]];
            let triangles: Vec<_> = (0..6).flat_map(side).collect();
            let axis = axes.iter().position(|axis| *axis == 2).unwrap();
            let view = Projection::of(&points, &triangles);
            assert!((view.normal[axis] - 1.0).abs() < 1e-9 && view.up[axis] > 0.9, "{axes:?} {height} {view:?}");
        }
        let points: Vec<Vec3> =
            (0..14).map(|k| Vec3::new(0.1 * (k / 2) as f64, (k % 2) as f64, (k / 2 % 2) as f64)).collect();
        let strip = |k: usize| [[2 * k, 2 * k + 2, 2 * k + 1], [2 * k + 1, 2 * k + 2, 2 * k + 3]];
        let zigzag = Spread::of(&points);
        assert!(zigzag.axis(&Normals::of(&zigzag.places, &(0..6).flat_map(strip).collect::<Vec<_>>())).is_none());
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
