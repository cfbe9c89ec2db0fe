//! Tubes: periodic sheets rolled up until they close, and their states in the coordinates of the model.

use crate::kinematics::{Embedding, KinematicsError, Motion, Shape, Tube};
use crate::math::Vec3;
use crate::model::Roll;
use crate::sheet::{Seam, SeamKept, Sheet};
use nalgebra::Matrix3;

/// Rolls a periodic sheet up to a tube in which cell `seam` coincides with cell (0, 0), towards its face normals (`inwards`) or
/// away from them. Every edge folds, diagonals of polygons included.
///
/// The drawn sheet must be spatially periodic and not flat. The tube may intersect itself.
///
/// ```
/// use foldwell::sheet::SeamKept;
/// use foldwell::{Assembly, RIGID, Sheet, relax, rolled_up};
///
/// let sheet = foldwell::sheet::fold::read(concat!(env!("CARGO_MANIFEST_DIR"), "/meshes/open-star.fold").as_ref())?;
/// let roll = rolled_up(&sheet, [0, 8], SeamKept::BOTH, true)?;
/// let tube = Assembly::tube(sheet, roll, [8, 6]).bars(RIGID).creases(1.0).build()?;
/// // a closed tube is rigid: nothing moves
/// assert!(relax(&tube)?.iterations <= 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`KinematicsError`] for a finite sheet, for the seam `[0, 0]`, and if the sheet cannot be rolled up so far.
pub fn rolled_up(sheet: &Sheet, seam: [i32; 2], kept: SeamKept, inwards: bool) -> Result<Roll, KinematicsError> {
    let number = Seam::new(seam).ok_or(KinematicsError::NoSeam)?;
    let angles = Tube::new(sheet, seam)?.rolled_up(inwards)?;
    let shape = Shape::at(&Embedding::new(sheet)?, &angles)?;
    let coordinates = coordinates(&shape, &number, kept);
    let hinge = |edge: usize| sheet.drawn_angle(&sheet.edges[edge]).map_or(f64::NAN, |_| angles[edge]);
    let angles = (0..sheet.edges.len()).map(hinge).collect();
    Ok(Roll { seam: number, kept, coordinates, angles, frame: Matrix3::identity(), origin: Vec3::zeros() })
}

/// Returns the coordinates of a shape about its axis, which is z and directed so that the seam turns by a positive angle; vertex
/// 0 is at height 0 in the half-plane `y = 0`, `x > 0`.
pub(super) fn coordinates(shape: &Shape, seam: &Seam, kept: SeamKept) -> Vec<f64> {
    let screw = &shape.screw;
    let along = |[n1, n2]: [i32; 2], each: [f64; 2]| f64::from(n1) * each[0] + f64::from(n2) * each[1];
    let sign = if along(seam.lattice_vector(), screw.theta) < 0.0 { -1.0 } else { 1.0 };
    let (turns, rises) = (screw.theta.map(|turn| sign * turn), screw.rise().map(|rise| sign * rise));
    let towards = screw.towards_axis();
    let (x, z) = (-towards.normalize(), screw.axis.unwrap_or_else(Vec3::zeros) * sign);
    let rotation = Matrix3::from_rows(&[x.transpose(), z.cross(&x).transpose(), z.transpose()]);
    let frame = Motion { rotation, translation: Vec3::new(1.0 / towards.norm(), 0.0, 0.0) };
    let mut found: Vec<f64> =
        shape.positions.iter().flat_map(|p| <[f64; 3]>::from(frame.apply(&(p - shape.positions[0])))).collect();
    let [strand, row] = seam.basis();
    found.extend([along(row, turns), along(row, rises)]);
    if !kept.rise {
        found.push(along(strand, rises));
    }
    if !kept.turn {
        found.push(along(strand, turns));
    }
    found
}
