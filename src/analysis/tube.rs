//! Tubes: periodic sheets rolled up until they close, and their states in the coordinates of the model.

use crate::kinematics::{Embedding, KinematicsError, Motion, Shape, Tube};
use crate::math::Vec3;
use crate::model::Roll;
use crate::sheet::{ScrewLattice, Seam, SeamKept, Sheet};
use nalgebra::Matrix3;
use std::f64::consts::TAU;

/// Rolls a periodic sheet up to a tube in which cell `seam` coincides with cell (0, 0), towards its face normals
/// (`inwards`) or away from them. Every edge folds, diagonals of polygons included.
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
    let axis = SeamPlace::new(&shape, &number, None).map_or_else(Vec3::zeros, |place| place.axis);
    let coordinates = coordinates(&shape, &axis, &number, kept);
    let hinge = |edge: usize| sheet.drawn_angle(&sheet.edges[edge]).map_or(f64::NAN, |_| angles[edge]);
    let angles = (0..sheet.edges.len()).map(hinge).collect();
    Ok(Roll { seam: number, kept, coordinates, angles })
}

/// The seam of a tube on a trajectory, along which all this is continuous.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeamPlace {
    /// Turn of the seam in radians, `n1 theta1 + n2 theta2`.
    pub turn: f64,
    /// Translation along the axis from the beginning of the seam to its end, `n1 h1 + n2 h2`.
    pub rise: f64,
    /// Direction of the axis in the frame of the embedding; the seam of the first state turns by a positive angle about
    /// it.
    pub axis: Vec3,
    /// Rotation angles about it of the two lattice motions in radians, continued through pi.
    theta: [f64; 2],
}

impl SeamPlace {
    /// Returns the seam of a tube as a mesh draws it rolled up.
    pub(super) fn drawn(screws: &ScrewLattice, seam: &Seam) -> Self {
        let cell = seam.lattice_vector();
        let sign = 1f64.copysign(screws.turn_of(cell));
        let [turn, rise] = [screws.turn_of(cell), screws.rise_of(cell)].map(|amount| sign * amount);
        Self { turn, rise, axis: sign * Vec3::z(), theta: screws.turn.map(|angle| sign * angle) }
    }

    /// Returns the seam of a shape, continued from that of a shape near by; `None` for one without rotation as the
    /// first.
    pub(super) fn new(shape: &Shape, seam: &Seam, last: Option<&Self>) -> Option<Self> {
        let (screw, cell) = (&shape.screw, seam.lattice_vector());
        let along = screw.axis.or(last.map(|last| last.axis))?;
        let mut screws = ScrewLattice { turn: screw.theta, rise: screw.chords.map(|chord| along.dot(&chord)) };
        let positive = screws.turn_of(cell) >= 0.0;
        let same = last.map_or(positive, |last| last.axis.dot(&along) >= 0.0);
        let sign = if same { 1.0 } else { -1.0 };
        screws.turn = screw.theta.map(|angle| sign * angle);
        if let Some(last) = last {
            let near = |(angle, last): (&mut f64, f64)| *angle += TAU * ((last - *angle) / TAU).round();
            screws.turn.iter_mut().zip(last.theta).for_each(near);
        }
        let rise = sign * screws.rise_of(cell);
        Some(Self { turn: screws.turn_of(cell), rise, axis: sign * along, theta: screws.turn })
    }
}

/// Returns the coordinates of a shape about its axis, which is z and has the direction of `axis`, about which the seam
/// turns by a positive angle up to whole turns; vertex 0 is at height 0 in the half-plane `y = 0`, `x > 0`.
pub(super) fn coordinates(shape: &Shape, axis: &Vec3, seam: &Seam, kept: SeamKept) -> Vec<f64> {
    let screw = &shape.screw;
    let sign = if screw.axis.is_some_and(|own| own.dot(axis) < 0.0) { -1.0 } else { 1.0 };
    let screws = ScrewLattice { turn: screw.theta.map(|turn| sign * turn), rise: screw.rise().map(|rise| sign * rise) };
    let towards = screw.towards_axis();
    let (x, z) = (-towards.normalize(), screw.axis.unwrap_or_else(Vec3::zeros) * sign);
    let rotation = Matrix3::from_rows(&[x.transpose(), z.cross(&x).transpose(), z.transpose()]);
    let frame = Motion { rotation, translation: Vec3::new(1.0 / towards.norm(), 0.0, 0.0) };
    let mut found: Vec<f64> =
        shape.positions.iter().flat_map(|p| <[f64; 3]>::from(frame.apply(&(p - shape.positions[0])))).collect();
    found.extend(screws.shared(seam, kept));
    found
}
