//! The embedding: where the vertices are, and how cells follow each other, from fold angles alone.
//!
//! **Frame.** Vertex 0 of cell (0, 0) is the origin, and the first face that has this vertex stays turned as it is drawn:
//! the drawn fold angles give the drawn sheet, moved so that vertex 0 is at the origin. A walk over the faces gives
//! everything else as products of rigid motions; the copy in the cell `(n1, n2)` of the point `x` is at
//! `A1^n1 A2^n2 x`, with the lattice motions `A_a x = S_a x + l_a`. So `l_a` is the chord from vertex 0 to its copy. A
//! finite sheet has positions only.

use super::motion::{Motion, Rigid};
use super::walk::{FaceWalk, Walked, relative};
use super::{KinematicsError, drawn_fold_angles};
use crate::math::Vec3;
use crate::sheet::{Corner, EdgeKey, Sheet};

/// What is needed of a sheet to place it at any fold angles; made once.
#[derive(Clone, Debug)]
pub struct Embedding {
    pub(super) walk: FaceWalk,
    pub(super) seats: Vec<Seat>,
    pub(super) faces: Vec<DrawnFace>,
    /// Lattice vectors as drawn.
    pub(super) lattice: Option<[Vec3; 2]>,
    drawn_angles: Vec<f64>,
    edges: Vec<EdgeKey>,
    lengths: Vec<f64>,
    longest: f64,
}

/// A vertex as a corner of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seat {
    pub(super) face: usize,
    /// Where the corner is drawn.
    pub(super) drawn: Vec3,
    /// The cell in which it stands.
    pub(super) cell: [i32; 2],
}

/// A face as drawn, in the cell in which the walk meets it.
#[derive(Clone, Copy, Debug)]
pub(super) struct DrawnFace {
    pub(super) corners: [Corner; 3],
    /// Area times unit normal.
    pub(super) area: Vec3,
    pub(super) centroid: Vec3,
}

/// A sheet at some fold angles; see the module for the frame.
#[derive(Clone, Debug)]
pub struct Placement {
    /// The vertices of cell (0, 0).
    pub positions: Vec<Vec3>,
    /// The lattice motions; `None` for a finite sheet.
    pub lattice: Option<[Motion; 2]>,
    /// How well the angles close.
    pub compatibility: Compatibility,
    pub(super) walked: Walked<Motion>,
}

/// How far different ways over the faces lead apart; all zero but for rounding where the angles close.
///
/// Lengths count in units of the longest edge, rotations by their largest matrix entry.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Compatibility {
    /// `S1 S2 - S2 S1`.
    pub rotations: f64,
    /// `S1 l2 + l1 - S2 l1 - l2`.
    pub positions: f64,
    /// Every edge that the walk has not crossed: the motion of the way over it, less the one the lattice motions give.
    pub ways: f64,
}

impl Compatibility {
    /// The largest of the three; not a number where one of them is none.
    pub fn largest(&self) -> f64 {
        [self.rotations, self.positions, self.ways].into_iter().fold(0.0, larger)
    }
}

impl Embedding {
    /// Plans how to place a sheet.
    ///
    /// Fails with [`KinematicsError::Disconnected`] where the walk does not reach all faces and vertices, in both
    /// directions of the lattice where there is one.
    pub fn new(sheet: &Sheet) -> Result<Self, KinematicsError> {
        let walk = FaceWalk::new(sheet)?;
        let faces: Vec<DrawnFace> = (0..walk.cells.len()).map(|face| DrawnFace::new(sheet, &walk, face)).collect();
        let seats = seats(sheet, &faces).ok_or(KinematicsError::Disconnected { faces: faces.len() })?;
        let edges: Vec<EdgeKey> = sheet.edges.iter().map(|edge| edge.key).collect();
        let length = |key: &EdgeKey| {
            let [i, j] = key.ends().map(|end| sheet.position(end));
            (j - i).norm()
        };
        let lengths: Vec<f64> = edges.iter().map(length).collect();
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        let drawn_angles = drawn_fold_angles(sheet);
        Ok(Self { walk, seats, faces, lattice: sheet.lattice, drawn_angles, edges, lengths, longest })
    }

    /// Number of edges, which is the number of fold angles.
    pub fn edges(&self) -> usize {
        self.edges.len()
    }

    /// The fold angles of the drawn sheet, zero on the rim.
    pub fn drawn_angles(&self) -> &[f64] {
        &self.drawn_angles
    }

    /// Places the sheet: `angles` holds the fold angle of every edge in radians, valley positive; those of the rim are
    /// not read.
    ///
    /// Angles that do not close are placed too, by the walk's tree, and
    /// [`compatibility`](Placement::compatibility) tells.
    /// # Panics
    /// Where `angles` has another length than the edges.
    pub fn place(&self, angles: &[f64]) -> Placement {
        let walked = Walked { faces: Vec::new(), loops: Vec::new(), lattice: None };
        let compatibility = Compatibility::default();
        let mut placement = Placement { positions: Vec::new(), lattice: None, compatibility, walked };
        self.place_into(angles, &mut placement);
        placement
    }

    /// The same into a placement of an earlier call, which is overwritten; nothing is allocated.
    /// # Panics
    /// As [`place`](Self::place).
    pub fn place_into(&self, angles: &[f64], placement: &mut Placement) {
        assert_eq!(angles.len(), self.edges(), "one fold angle for every edge");
        let walked = &mut placement.walked;
        self.walk.walk_into(|step| Motion::about(&step.line, self.turn(step.edge, angles)), walked);
        placement.lattice = walked.lattice;
        placement.positions.clear();
        placement.positions.extend(self.seats.iter().map(|seat| {
            let there = walked.faces[seat.face].apply(&seat.drawn);
            match &walked.lattice {
                Some(lattice) if seat.cell != [0, 0] => {
                    Motion::lattice_power(lattice, seat.cell).inverse().apply(&there)
                }
                _ => there,
            }
        }));
        placement.compatibility = self.compatibility(walked);
    }

    /// Largest relative error of the length of an edge, against the drawn one.
    pub fn bar_error(&self, placement: &Placement) -> f64 {
        let bars = self.edges.iter().zip(&self.lengths);
        let errors = bars.map(|(key, length)| {
            let [i, j] = key.ends().map(|end| placement.corner(end));
            ((j - i).norm() - length).abs() / length
        });
        errors.fold(0.0, larger)
    }

    /// How far an edge has turned since it was drawn.
    pub(super) fn turn(&self, edge: usize, angles: &[f64]) -> f64 {
        angles[edge] - self.drawn_angles[edge]
    }

    fn compatibility(&self, walked: &Walked<Motion>) -> Compatibility {
        let still = [Motion::identity(); 2];
        let lattice @ [first, second] = walked.lattice.as_ref().unwrap_or(&still);
        let apart = |a: &Motion, b: &Motion| {
            let turned = (a.rotation - b.rotation).iter().map(|entry| entry.abs()).fold(0.0, larger);
            [turned, (a.translation - b.translation).norm() / self.longest]
        };
        let [rotations, positions] = apart(&(*first * *second), &(*second * *first));
        let ways = self.walk.loops.iter().zip(&walked.loops);
        let ways = ways.flat_map(|(closing, motion)| apart(motion, &Motion::lattice_power(lattice, closing.cell)));
        Compatibility { rotations, positions, ways: ways.fold(0.0, larger) }
    }
}

impl Placement {
    /// Where a corner is, by doing the lattice motions one by one; of a finite sheet only in cell (0, 0).
    pub fn corner(&self, corner: Corner) -> Vec3 {
        let home = self.positions[corner.vertex];
        match &self.lattice {
            Some(lattice) if corner.shift != [0, 0] => Motion::lattice_power(lattice, corner.shift).apply(&home),
            _ => home,
        }
    }
}

impl DrawnFace {
    fn new(sheet: &Sheet, walk: &FaceWalk, face: usize) -> Self {
        let corners = sheet.triangles[face].corners.map(|corner| corner.translated(walk.cells[face]));
        let [a, b, c] = corners.map(|corner| relative(sheet, corner));
        Self { corners, area: 0.5 * (b - a).cross(&(c - a)), centroid: (a + b + c) / 3.0 }
    }
}

/// A seat for every vertex, in cell (0, 0) where the walk passes there; `None` where a vertex has no face.
fn seats(sheet: &Sheet, faces: &[DrawnFace]) -> Option<Vec<Seat>> {
    let far = |cell: [i32; 2]| cell.map(i32::abs).iter().sum::<i32>();
    let mut seats: Vec<Option<Seat>> = vec![None; sheet.vertices.len()];
    for (face, drawn) in faces.iter().enumerate() {
        for &corner in &drawn.corners {
            let nearer = seats[corner.vertex].is_none_or(|seat| far(corner.shift) < far(seat.cell));
            if nearer {
                seats[corner.vertex] = Some(Seat { face, drawn: relative(sheet, corner), cell: corner.shift });
            }
        }
    }
    seats.into_iter().collect()
}

/// The larger of two numbers, or not a number where one of them is none.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a >= b { a } else { b + 0.0 * a }
}
