//! The gauge: the choice of coordinates that are held so that a free sheet cannot drift, without constraining its
//! shape.
//!
//! Rigid motions that no pin prevents cost no energy, so the Hessian of the energy is singular along them. Holding
//! one coordinate for each of them removes the drift and changes no shape. The coordinates are chosen greedily so
//! that they separate the rigid motions well (Gram-Schmidt with pivoting on the rows of the matrix of rigid motions).

use super::domain::{Domain, Site};
use crate::math::{Vec3, point};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::small::{reciprocal_condition, symmetric_eigen_3};
use crate::numerics::dense::{NullSpace, null_space_of_sums};
use nalgebra::{Matrix3, Rotation3, SMatrix, SVector};

/// Largest number of Newton steps towards the orientation in which the loads do the most work.
const TURNS: usize = 30;
/// Bounds relative to the sum of the products of forces and lever arms: torques below `BALANCED` and rotational
/// stiffnesses below `NEUTRAL` count as rounding errors.
const BALANCED: f64 = 1e-15;
const NEUTRAL: f64 = 1e-9;

/// Rates of one coordinate under the six rigid motions.
pub(crate) type Motion = SVector<f64, 6>;

/// Returns the rates of every coordinate under the rigid motions: translations in columns 0 to 2, rotations about the
/// centroid, divided by the size of the sheet, in columns 3 to 5. The columns of rotations are zero if `rotations` is
/// false or the domain does not allow them. A screw can rotate only in the plane of its axis; the coordinates against
/// that rotation, like those of vertex 0, are held by the drawn state itself.
pub(crate) fn rigid_motions(domain: &Domain, x: &[f64], rotations: bool) -> Vec<Motion> {
    let vertices = (x.len() - domain.shared()) / 3;
    match domain {
        Domain::Tube { .. } => return tube_motions(x, domain.shared(), rotations),
        Domain::Own(_) => return kept_motions(domain, x, rotations),
        _ => {}
    }
    let (centre, size) = centre_and_size(domain, x);
    let turns = rotations && matches!(domain, Domain::Patch | Domain::FreeTorus);
    let turn = if turns { 1.0 / size } else { 0.0 };
    let mut rows: Vec<Motion> = (0..vertices).flat_map(|k| rows_of(1.0, turn * (point(x, k) - centre))).collect();
    // of a screw nothing turns
    rows.extend(x[3 * vertices..].chunks_exact(3).flat_map(|l| rows_of(0.0, turn * Vec3::from_column_slice(l))));
    rows
}

/// Returns the same of any domain: the rigid motions with which all copies of the vertices move alike, for some rates
/// of the shared coordinates; each column is one of a basis of them.
///
/// They are the null space of what a rigid motion of the vertices, with those rates, makes of a copy, less the same
/// motion of the copy. It is asked at four points, as far apart as the sheet is large, in the two next cells: maps are
/// affine. Where its singular values leave the dimension of the null space open, no motion is held, and the
/// solver reports a singular system.
fn kept_motions(domain: &Domain, x: &[f64], rotations: bool) -> Vec<Motion> {
    let vertices = (x.len() - domain.shared()) / 3;
    let ((centre, size), shared) = (centre_and_size(domain, x), &x[3 * vertices..]);
    let (motions, turn) = if rotations { (6, 1.0 / size) } else { (3, 0.0) };
    let units = domain.units(x, size);
    let velocity = |point: Vec3| {
        SMatrix::<f64, 3, 6>::from_rows(&rows_of(1.0, turn * (point - centre)).map(|row| row.transpose()))
    };
    let mut differences = DenseMatrix::zeros(0, motions + shared.len());
    for arm in [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()] {
        for shift in [[1, 0], [0, 1]] {
            let corner = centre + size * arm;
            let copy = domain.place(&[corner.as_slice(), shared].concat(), Site { vertex: 0, shift });
            let off = copy.by_vertex * velocity(corner) - velocity(copy.point);
            let row = differences.nrows();
            differences = differences.resize_vertically(row + 3, 0.0);
            differences.view_mut((row, 0), (3, motions)).copy_from(&off.columns(0, motions));
            for (k, unit) in units.iter().enumerate() {
                let rate = copy.by_shared.map_or(Vec3::zeros(), |by_shared| *unit * by_shared.column(k));
                differences.view_mut((row, motions + k), (3, 1)).copy_from(&rate);
            }
        }
    }
    let Ok(NullSpace { basis, .. }) = null_space_of_sums(&differences, 1.0) else {
        return vec![Motion::zeros(); x.len()];
    };
    let mut rates = DenseMatrix::zeros(x.len(), motions + shared.len());
    for vertex in 0..vertices {
        let of_vertex = velocity(point(x, vertex));
        rates.view_mut((3 * vertex, 0), (3, motions)).copy_from(&of_vertex.columns(0, motions));
    }
    units.iter().enumerate().for_each(|(k, unit)| rates[(3 * vertices + k, motions + k)] = *unit);
    let kept = rates * basis;
    kept.row_iter().map(|row| Motion::from_fn(|motion, _| row.get(motion).copied().unwrap_or(0.0))).collect()
}

/// Returns the same of a tube, which moves along its axis and turns about it; the shared coordinates stay.
fn tube_motions(x: &[f64], shared: usize, rotations: bool) -> Vec<Motion> {
    let points = || x[..x.len() - shared].chunks_exact(3).map(Vec3::from_column_slice);
    let radius = points().map(|point| point.x.hypot(point.y)).fold(f64::MIN_POSITIVE, f64::max);
    let turn = if rotations { 1.0 / radius } else { 0.0 };
    let of_axis = |mut row: Motion| {
        [0, 1, 3, 4].into_iter().for_each(|motion| row[motion] = 0.0);
        row
    };
    let rows = points().flat_map(|point| rows_of(1.0, turn * point)).map(of_axis);
    rows.chain(std::iter::repeat_n(Motion::zeros(), shared)).collect()
}

/// Returns the centroid of all vertices, and the largest distance of one from it.
pub(crate) fn centre_and_size(domain: &Domain, x: &[f64]) -> (Vec3, f64) {
    let vertices = (x.len() - domain.shared()) / 3;
    let centre = (0..vertices).map(|k| point(x, k)).sum::<Vec3>() / vertices as f64;
    (centre, (0..vertices).map(|k| (point(x, k) - centre).norm()).fold(f64::MIN_POSITIVE, f64::max))
}

/// Returns the velocity of a point, `translation + omega x arm`, as one row for each component.
pub(crate) fn rows_of(translation: f64, arm: Vec3) -> [Motion; 3] {
    let cross = -arm.cross_matrix();
    let rate =
        |axis: usize, k: usize| if k < 3 { translation * f64::from(u8::from(k == axis)) } else { cross[(axis, k - 3)] };
    [0, 1, 2].map(|axis| Motion::from_fn(|k, _| rate(axis, k)))
}

/// Returns the coordinates to hold, in addition to those already `held`, so that no rigid motion remains.
pub(crate) fn choose(motions: &[Motion], held: &[bool]) -> Vec<usize> {
    let mut rows = motions.to_vec();
    let scale = rows.iter().map(|r| r.norm()).fold(0.0, f64::max);
    let mut chosen = Vec::new();
    for wanted in [true, false] {
        while let Some((k, row)) = largest(&rows, held, wanted).filter(|(_, row)| row.norm() > 1e-6 * scale) {
            let unit = row.normalize();
            rows.iter_mut().for_each(|r| *r -= unit * unit.dot(r));
            if !wanted {
                chosen.push(k);
            }
        }
    }
    chosen
}

/// Returns the longest row, and its index, among those whose coordinate is held (`wanted`) or is not held.
fn largest(rows: &[Motion], held: &[bool], wanted: bool) -> Option<(usize, Motion)> {
    let candidates = rows.iter().enumerate().filter(|(k, _)| held[*k] == wanted);
    candidates.max_by(|a, b| a.1.norm().total_cmp(&b.1.norm())).map(|(k, row)| (k, *row))
}

/// Returns how well holding these coordinates separates the rigid motions: the ratio of the least to the largest
/// singular value of their rows, without the motions that the domain does not have.
pub(crate) fn separation(motions: &[Motion], held: &[bool]) -> f64 {
    let had: Vec<usize> = (0..6).filter(|&motion| motions.iter().any(|row| row[motion] != 0.0)).collect();
    let kept: Vec<&Motion> = motions.iter().zip(held).filter_map(|(row, held)| held.then_some(row)).collect();
    let rows = nalgebra::DMatrix::from_fn(kept.len().max(had.len()), had.len(), |row, motion| {
        kept.get(row).map_or(0.0, |rates| rates[had[motion]])
    });
    reciprocal_condition(&rows)
}

/// Returns the nearest rotation about the origin after which the forces do the most work on their arms, by Newton's
/// method. `arms` holds pairs of a lever arm and its force. Directions of rotation without rotational stiffness are
/// left out of the steps. `None` if the forces have no torque.
pub(crate) fn turn_along(mut arms: Vec<(Vec3, Vec3)>) -> Option<Rotation3<f64>> {
    let most: f64 = arms.iter().map(|(arm, force)| arm.norm() * force.norm()).sum();
    let mut turn = None;
    for _ in 0..TURNS {
        let torque: Vec3 = arms.iter().map(|(arm, force)| arm.cross(force)).sum();
        if !(torque.norm() > BALANCED * most) {
            break;
        }
        let stiffness: Matrix3<f64> = arms.iter().map(|(arm, force)| stiffness_of(arm, force)).sum();
        let (values, vectors) = symmetric_eigen_3(stiffness);
        let stiff = (0..3).filter(|&k| values[k].abs() > NEUTRAL * most);
        let about = |k: usize| {
            let axis = vectors.column(k).into_owned();
            axis * (axis.dot(&torque) / values[k].abs())
        };
        let step: Vec3 = stiff.map(about).sum();
        let by = Rotation3::new(step * f64::min(1.0, 1.0 / step.norm().max(f64::MIN_POSITIVE)));
        arms.iter_mut().for_each(|(arm, _)| *arm = by * *arm);
        turn = Some(turn.map_or(by, |turn| by * turn));
    }
    turn
}

/// Returns the rotational stiffness of a force on a lever arm: the second derivative of its potential by a rotation.
fn stiffness_of(arm: &Vec3, force: &Vec3) -> Matrix3<f64> {
    let product = arm * force.transpose();
    Matrix3::identity() * arm.dot(force) - 0.5 * (product + product.transpose())
}
