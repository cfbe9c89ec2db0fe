//! The embedding: positions of the vertices and motions from cell to cell, computed from fold angles alone.
//!
//! **Frame.** Vertex 0 of cell (0, 0) is the origin, and the first face that has this vertex keeps its drawn
//! orientation: the drawn fold angles give the drawn sheet, translated so that vertex 0 is at the origin. All other
//! positions are products of rigid motions along a walk over the faces. The copy in the cell `(n1, n2)` of the point
//! `x` is at `A1^n1 A2^n2 x`, with the lattice motions `A_a x = S_a x + l_a`, so that `l_a` is the chord from vertex 0
//! to its copy. A finite sheet has positions only.

use super::motion::{Motion, Rigid};
use super::walk::{FaceWalk, Walked, relative};
use super::{KinematicsError, drawn_fold_angles};
use crate::math::Vec3;
use crate::numerics::larger;
use crate::sheet::{Corner, Sheet};

/// The precomputed data from which a sheet is placed at any fold angles.
#[derive(Clone, Debug)]
pub struct Embedding {
    pub(super) walk: FaceWalk,
    pub(super) seats: Vec<Seat>,
    /// Lattice vectors as drawn, or chords of the screw motions that repeat the drawn cell.
    pub(super) lattice: Option<[Vec3; 2]>,
    /// Sum of the drawn areas of the faces times their normals.
    pub(super) drawn_area: Vec3,
    drawn_angles: Vec<f64>,
    longest: f64,
}

/// A vertex as a corner of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seat {
    pub(super) face: usize,
    /// Drawn position of the corner.
    pub(super) drawn: Vec3,
    /// The cell of the corner.
    pub(super) cell: [i32; 2],
}

/// A sheet at some fold angles, in the frame defined on the [module](self)'s page.
#[derive(Clone, Debug)]
pub struct Placement {
    /// Positions of the vertices of cell (0, 0).
    pub positions: Vec<Vec3>,
    /// The lattice motions; `None` for a finite sheet.
    pub lattice: Option<[Motion; 2]>,
    /// The error of closure of the angles: the largest difference between different paths over the faces, zero except
    /// for rounding if the angles close. It is that of `S1 S2` and `S2 S1`, of `S1 l2 + l1` and `S2 l1 + l2`, and, over
    /// the edges that the walk does not cross, of the motion of the path across the edge and the one that the lattice
    /// motions give. Lengths are in units of the longest edge; the difference of rotations is that of their largest
    /// matrix entry. NaN if one of them is NaN.
    pub compatibility: f64,
}

impl Embedding {
    /// Plans the placement of a sheet.
    ///
    /// # Errors
    /// [`KinematicsError::Disconnected`] if the walk does not reach all faces and vertices, or, on a periodic sheet,
    /// not both directions of the lattice.
    pub fn new(sheet: &Sheet) -> Result<Self, KinematicsError> {
        let walk = FaceWalk::new(sheet)?;
        let corners = |face: usize| sheet.triangles[face].corners.map(|corner| corner.translated(walk.cells[face]));
        let faces: Vec<[Corner; 3]> = (0..walk.cells.len()).map(corners).collect();
        let area = |corners: &[Corner; 3]| {
            let [a, b, c] = corners.map(|corner| relative(sheet, corner));
            0.5 * (b - a).cross(&(c - a))
        };
        let drawn_area = faces.iter().map(area).sum();
        let seats = seats(sheet, &faces).ok_or(KinematicsError::Disconnected { faces: faces.len() })?;
        let longest = sheet.edges.iter().map(|edge| sheet.length(edge.key)).fold(0.0, f64::max);
        let drawn_angles = drawn_fold_angles(sheet);
        Ok(Self { walk, seats, lattice: sheet.chords(), drawn_area, drawn_angles, longest })
    }

    /// Number of edges, which is the number of fold angles.
    pub(crate) fn edges(&self) -> usize {
        self.drawn_angles.len()
    }

    /// Returns the fold angles of the drawn sheet in radians, valley positive; zero on the rim.
    pub fn drawn_angles(&self) -> &[f64] {
        &self.drawn_angles
    }

    /// Places the sheet. `angles` holds the fold angle of every edge in radians, valley positive; those of the rim are
    /// not read.
    ///
    /// Angles that do not close are accepted: the positions are those along the tree of the walk, and
    /// [`compatibility`](Placement::compatibility) holds the errors.
    /// # Panics
    /// If the length of `angles` is not the number of edges.
    pub fn place(&self, angles: &[f64]) -> Placement {
        assert_eq!(angles.len(), self.edges(), "one fold angle for every edge");
        let walked = self.walk.walk(|step| Motion::about(&step.line, self.turn(step.edge, angles)));
        let position = |seat: &Seat| {
            let there = walked.faces[seat.face].apply(&seat.drawn);
            match &walked.lattice {
                Some(lattice) if seat.cell != [0, 0] => {
                    Motion::lattice_power(lattice, seat.cell).inverse().apply(&there)
                }
                _ => there,
            }
        };
        let positions = self.seats.iter().map(position).collect();
        Placement { positions, lattice: walked.lattice, compatibility: self.compatibility(&walked) }
    }

    /// Returns the difference of the fold angle of an edge from the drawn one, in radians.
    pub(super) fn turn(&self, edge: usize, angles: &[f64]) -> f64 {
        angles[edge] - self.drawn_angles[edge]
    }

    fn compatibility(&self, walked: &Walked<Motion>) -> f64 {
        let still = [Motion::identity(); 2];
        let lattice @ [first, second] = walked.lattice.as_ref().unwrap_or(&still);
        let apart = |a: &Motion, b: &Motion| {
            let turned = (a.rotation - b.rotation).iter().map(|entry| entry.abs()).fold(0.0, larger);
            [turned, (a.translation - b.translation).norm() / self.longest]
        };
        let orders = apart(&(*first * *second), &(*second * *first));
        let ways = self.walk.loops.iter().zip(&walked.loops);
        let ways = ways.flat_map(|(closing, motion)| apart(motion, &Motion::lattice_power(lattice, closing.cell)));
        orders.into_iter().chain(ways).fold(0.0, larger)
    }
}

impl Placement {
    /// Returns the position of a corner, by applying the lattice motions one by one; for a finite sheet only in cell
    /// (0, 0).
    pub fn corner(&self, corner: Corner) -> Vec3 {
        let home = self.positions[corner.vertex];
        match &self.lattice {
            Some(lattice) if corner.shift != [0, 0] => Motion::lattice_power(lattice, corner.shift).apply(&home),
            _ => home,
        }
    }
}

/// Returns a corner of a face for every vertex, in cell (0, 0) if the walk has it there; `None` if a vertex has no
/// face.
fn seats(sheet: &Sheet, faces: &[[Corner; 3]]) -> Option<Vec<Seat>> {
    let far = |cell: [i32; 2]| cell.map(i32::abs).iter().sum::<i32>();
    let mut seats: Vec<Option<Seat>> = vec![None; sheet.vertices.len()];
    for (face, corners) in faces.iter().enumerate() {
        for &corner in corners {
            let nearer = seats[corner.vertex].is_none_or(|seat| far(corner.shift) < far(seat.cell));
            if nearer {
                seats[corner.vertex] = Some(Seat { face, drawn: relative(sheet, corner), cell: corner.shift });
            }
        }
    }
    seats.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::super::test_sheets::*;
    use super::super::{Closure, Displacement};
    use super::*;
    use crate::math::fold_angle::fold_angle;
    use crate::numerics::DenseMatrix;
    use crate::numerics::dense::null_space;
    use crate::numerics::derivatives::{TOLERANCE, check_jacobian};
    use std::f64::consts::TAU;

    /// Returns the largest error of the length of an edge, relative to the drawn length.
    fn bar_error(sheet: &Sheet, placement: &Placement) -> f64 {
        let errors = sheet.edges.iter().map(|edge| {
            let [i, j] = edge.key.ends().map(|end| placement.corner(end));
            ((j - i).norm() / sheet.length(edge.key) - 1.0).abs()
        });
        errors.fold(0.0, larger)
    }

    /// Claim: the drawn fold angles give the drawn sheet with vertex 0 at the origin and translations as lattice
    /// motions, for periodic and finite sheets, also for sheets with openings. Tolerance: rounding of positions.
    #[test]
    fn drawn_angles_give_the_drawn_sheet() {
        for sheet in [open_star(), open_flat(), miura(), finite_grid(3, 4, 0.3), narrow(), ring()] {
            let embedding = Embedding::new(&sheet).unwrap();
            let placement = embedding.place(embedding.drawn_angles());
            let drawn = sheet.vertices.iter().map(|x| x - sheet.vertices[0]);
            assert!(drawn.zip(&placement.positions).all(|(drawn, x)| (drawn - x).norm() <= 1e-15));
            assert!(placement.compatibility <= 1e-15);
            assert!(bar_error(&sheet, &placement) <= 2e-15);
            let lattice = placement.lattice.map(|lattice| lattice.map(|motion| motion.translation));
            assert_eq!(lattice.is_some(), sheet.lattice.is_some());
            let pairs = sheet.lattice.into_iter().flatten().zip(lattice.into_iter().flatten());
            assert!(pairs.into_iter().all(|(drawn, chord)| (drawn - chord).norm() <= 1e-15));
        }
    }

    /// Folded states of several sheets, closed up to rounding.
    fn folded() -> Vec<(Sheet, Vec<f64>)> {
        let star = open_star();
        let states = open_star_reference().cylinders(&star);
        let (flat, finite, slim) = (open_flat(), finite_grid(3, 4, 0.3), narrow());
        let bent = |sheet: &Sheet, size: f64| {
            let numbers = random_numbers(3, sheet.edges.len());
            drawn_fold_angles(sheet).iter().zip(numbers).map(|(angle, r)| angle + size * r).collect::<Vec<_>>()
        };
        let [flat_bent, finite_bent, slim_bent] = [bent(&flat, 0.3), bent(&finite, 0.2), bent(&slim, 0.1)];
        let open = states.into_iter().map(|angles| (star.clone(), angles));
        let open: Vec<_> = open.chain([(flat, flat_bent), (finite, finite_bent), (slim, slim_bent)]).collect();
        let close = |(sheet, angles): (Sheet, Vec<f64>)| {
            let angles = closed(&Closure::of_cell(&sheet).unwrap(), angles);
            (sheet, angles)
        };
        open.into_iter().map(close).collect()
    }

    /// Claim: if the angles close, all paths over the faces agree, bars keep their lengths, and the fold angles of the
    /// placed vertices are the given ones up to multiples of 2 pi. Tolerances: 1e-13, that of the project; the fold
    /// angle of four points has the rounding error of positions divided by the height of a face.
    #[test]
    fn closed_angles_are_compatible() {
        for (sheet, angles) in folded() {
            let embedding = Embedding::new(&sheet).unwrap();
            let placement = embedding.place(&angles);
            assert!(placement.compatibility <= 1e-13, "{:?}", placement.compatibility);
            assert!(bar_error(&sheet, &placement) <= 1e-13);
            for (edge, angle) in sheet.edges.iter().zip(&angles) {
                let (Some(left), Some(right)) = (edge.wings[0], edge.wings[1]) else { continue };
                let [i, j] = edge.key.ends();
                let found = fold_angle([i, j, left, right].map(|corner| placement.corner(corner)));
                let turns = ((found - angle) / TAU).round();
                assert!((found - angle - turns * TAU).abs() <= 1e-13, "{found} for {angle}");
            }
        }
    }

    /// Claim: the vertices of cells -2 to 2 are at the positions found by attaching faces one by one, from points and
    /// not from motions. Both constructions begin with face 0 as drawn. Tolerance: rounding over some twenty faces.
    #[test]
    fn faces_put_together_one_by_one_agree() {
        for (sheet, angles) in folded() {
            let placement = Embedding::new(&sheet).unwrap().place(&angles);
            let places = put_together(&sheet, &angles);
            assert!(places.len() >= sheet.vertices.len());
            for (corner, place) in places {
                let error = (placement.corner(corner) + sheet.vertices[0] - place).norm();
                assert!(error <= 1e-12, "{corner:?}: {error:e}");
            }
        }
    }

    /// Claim: the cell in which a vertex is drawn has no influence. If a vertex is listed two cells away, so that no
    /// face of the walk has it in cell (0, 0), the same fold angles give the same positions and velocities. Tolerance:
    /// stored angles close to 1e-12, and the two walks differ.
    #[test]
    fn vertices_may_be_drawn_far_away() {
        let star = open_star();
        let [l1, l2] = star.lattice.unwrap();
        let (mut vertices, far) = (star.vertices.clone(), Corner { vertex: 3, shift: [2, 1] });
        vertices[3] += 2.0 * l1 + l2;
        let listed = |corner: Corner| if corner.vertex == 3 { corner.translated([-2, -1]) } else { corner };
        let faces: Vec<[Corner; 3]> = star.triangles.iter().map(|face| face.corners.map(listed)).collect();
        let moved = sheet("moved", vertices, star.lattice, &faces);
        let (embedding, original) = (Embedding::new(&moved).unwrap(), Embedding::new(&star).unwrap());
        assert_ne!(embedding.seats[3].cell, [0, 0]);
        for angles in open_star_reference().cylinders(&star) {
            let (placement, expected) = (embedding.place(&angles), original.place(&angles));
            assert!((placement.positions[3] - expected.corner(far)).norm() <= 1e-11);
            assert!((placement.positions[1] - expected.positions[1]).norm() <= 1e-11);
            let null = null_space(&Closure::of_cell(&star).unwrap().jacobian(&angles)).unwrap().basis;
            let rates = null.column(0);
            let [found, expected] = [&embedding, &original].map(|e| Displacement::new(e, &angles, rates.as_slice()));
            assert!((found.positions[3] - placement.positions[3]).norm() <= 1e-14);
            assert!((found.velocities[3] - expected.corner(far).1).norm() <= 1e-11);
        }
    }

    /// Claim: angles that do not close are reported: a change of one of them by 1e-6 gives errors of that size.
    #[test]
    fn open_angles_are_reported() {
        for (sheet, angles) in folded() {
            let embedding = Embedding::new(&sheet).unwrap();
            let closure = Closure::of_cell(&sheet).unwrap();
            let edge = embedding.walk.loops[0].crossing.edge;
            let mut wrong = angles.clone();
            wrong[edge] += 1e-6;
            let (found, residual) = (embedding.place(&wrong).compatibility, closure.residual(&wrong).amax());
            assert!(found > 0.1 * residual && found < 1e-4 && residual > 1e-8, "{found:e} {residual:e}");
        }
    }

    /// Claim: every entry of the derivative of positions, lattice rotations and chords by the fold angles is that of
    /// the displacement with that rate, also if the angles do not close.
    #[test]
    fn displacements_are_the_derivative() {
        for (sheet, angles) in folded() {
            let embedding = Embedding::new(&sheet).unwrap();
            let numbers = random_numbers(8, angles.len());
            let point: Vec<f64> = angles.iter().zip(numbers).map(|(angle, r)| angle + 0.2 * r).collect();
            let place = |angles: &[f64]| {
                let placement = embedding.place(angles);
                let lattice = placement.lattice.iter().flatten();
                let motions = lattice.flat_map(|m| m.rotation.iter().chain(m.translation.iter()).copied());
                placement.positions.iter().flat_map(|x| x.iter().copied()).chain(motions).collect::<Vec<f64>>()
            };
            let column = |edge: usize| {
                let mut rates = vec![0.0; angles.len()];
                rates[edge] = 1.0;
                let moved = Displacement::new(&embedding, &point, &rates);
                let lattice = moved.lattice.iter().flatten().flat_map(|m| {
                    let turned = m.twist.angular.cross_matrix() * m.motion.rotation;
                    turned.iter().copied().chain(m.twist.at(&m.motion.translation).iter().copied()).collect::<Vec<_>>()
                });
                moved.velocities.iter().flat_map(|v| v.iter().copied()).chain(lattice).collect::<Vec<f64>>()
            };
            let columns: Vec<f64> = (0..angles.len()).flat_map(column).collect();
            let jacobian = DenseMatrix::from_vec(columns.len() / angles.len(), angles.len(), columns);
            check_jacobian(place, &point, &jacobian, TOLERANCE).unwrap();
        }
    }

    /// Claim: sheets that are not connected are refused: separate faces, rows of faces that meet along one lattice
    /// vector only, a vertex without face.
    #[test]
    fn what_does_not_hang_together() {
        let refused = |sheet: &Sheet, faces: usize| {
            assert_eq!(Embedding::new(sheet).unwrap_err(), KinematicsError::Disconnected { faces });
        };
        let whole = finite_grid(3, 1, 0.3);
        let faces: Vec<[Corner; 3]> = whole.triangles.iter().map(|face| face.corners).collect();
        refused(&sheet("apart", whole.vertices.clone(), None, &[faces[0], faces[5]]), 2);
        refused(&sheet("loose vertex", whole.vertices.clone(), None, &faces[..4]), 4);
        let corner = |vertex: usize, n1: i32| Corner { vertex, shift: [n1, 0] };
        let row = [[corner(0, 0), corner(0, 1), corner(1, 0)], [corner(0, 1), corner(1, 1), corner(1, 0)]];
        let lattice = Some([Vec3::x(), 3.0 * Vec3::y()]);
        refused(&sheet("row", vec![Vec3::zeros(), Vec3::y()], lattice, &row), 2);
    }
}
