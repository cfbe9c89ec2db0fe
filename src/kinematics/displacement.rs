//! Displacement fields of linear foldings: the velocities that belong to rates of fold angles.
//!
//! The walk over the faces is differentiated by the product rule of motions ([`Moving`]): every face and both lattice
//! motions have their twist, and a vertex `x` of the cell `n` moves with the derivative of `A1^n1 A2^n2 x`, in
//! spatially periodic and in screw-periodic states. Conversely, the velocities of its three corners give the angular
//! velocity of a face, and the component along an edge of the difference between the angular velocities on both sides
//! is the rate of the fold angle. For rates in the null space of closure the two maps are inverse to each other.

use super::embedding::Embedding;
use super::motion::{Moving, Rigid};
use super::walk::{Crossing, Loop, Walked};
use crate::math::Vec3;
use crate::numerics::larger;
use crate::sheet::Corner;

/// Velocities of a sheet per unit of the given rates of its fold angles, in the frame of the
/// [embedding](super::embedding): vertex 0 and the first face that has it do not move.
#[derive(Clone, Debug)]
pub struct Displacement {
    /// Positions of the vertices of cell (0, 0).
    pub positions: Vec<Vec3>,
    /// Velocities of these vertices.
    pub velocities: Vec<Vec3>,
    /// The lattice motions with their twists; `None` for a finite sheet. The twist of the first has the angular
    /// velocity `Omega_1` of a cell relative to the previous one.
    pub lattice: Option<[Moving; 2]>,
    /// Largest difference, over the edges that the walk does not cross, between the angular velocity along the path
    /// across the edge and the one that the lattice motions give: zero except for rounding if the rates close.
    pub disagreement: f64,
}

impl Displacement {
    /// Computes the velocities at given fold angles and rates, each with one number per edge, in radians.
    ///
    /// For angles and rates that do not close, the velocities are those along the tree of the walk.
    /// # Panics
    /// If the length of `angles` or `rates` is not the number of edges.
    pub fn new(embedding: &Embedding, angles: &[f64], rates: &[f64]) -> Self {
        assert!(angles.len() == embedding.edges() && rates.len() == embedding.edges(), "one number for every edge");
        let turn = |step: &Crossing| Moving::about(&step.line, embedding.turn(step.edge, angles), rates[step.edge]);
        let walked: Walked<Moving> = embedding.walk.walk(turn);
        let still = [Moving::identity(); 2];
        let lattice = walked.lattice.as_ref().unwrap_or(&still);
        let homes = embedding.seats.iter().map(|seat| {
            let home = Moving::lattice_power(lattice, seat.cell).inverse() * walked.faces[seat.face];
            (home.motion.apply(&seat.drawn), home.carry(&seat.drawn, &Vec3::zeros()))
        });
        let (positions, velocities) = homes.unzip();
        let ways = embedding.walk.loops.iter().zip(&walked.loops);
        let spin = |closing: &Loop| Moving::lattice_power(lattice, closing.cell).twist.angular;
        let apart = ways.map(|(closing, way)| (way.twist.angular - spin(closing)).amax());
        let disagreement = apart.fold(0.0, larger);
        Self { positions, velocities, lattice: walked.lattice, disagreement }
    }

    /// Calls `visit` with every edge and the lattice motions, with their rates if this edge alone folds at rate 1.
    pub(super) fn for_each_edge(
        embedding: &Embedding,
        angles: &[f64],
        mut visit: impl FnMut(usize, &Option<[Moving; 2]>),
    ) {
        let mut moving = vec![0.0; angles.len()];
        for edge in 0..angles.len() {
            moving[edge] = 1.0;
            visit(edge, &Self::new(embedding, angles, &moving).lattice);
            moving[edge] = 0.0;
        }
    }

    /// Returns position and velocity of a corner; for a finite sheet only in cell (0, 0).
    pub fn corner(&self, corner: Corner) -> (Vec3, Vec3) {
        let (place, velocity) = (&self.positions[corner.vertex], &self.velocities[corner.vertex]);
        let there = self.to_cell(corner.shift);
        (there.motion.apply(place), there.carry(place, velocity))
    }

    /// Returns the motion from cell (0, 0) to another cell; the identity for a finite sheet.
    fn to_cell(&self, cell: [i32; 2]) -> Moving {
        self.lattice.as_ref().map_or_else(Moving::identity, |lattice| Moving::lattice_power(lattice, cell))
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_sheets::*;
    use super::super::{Closure, Shape};
    use super::*;
    use crate::numerics::DenseMatrix;
    use crate::numerics::dense::null_space;
    use crate::numerics::derivatives::{TOLERANCE, check_jacobian};
    use crate::sheet::Sheet;

    impl Displacement {
        /// Returns the angular velocity of a triangle of the sheet, translated by `cell` from the position in the
        /// sheet's list.
        fn angular_velocity(&self, embedding: &Embedding, (face, moving): (usize, &Moving), cell: [i32; 2]) -> Vec3 {
            let home = embedding.walk.cells[face];
            let there = self.to_cell([cell[0] - home[0], cell[1] - home[1]]);
            (there * *moving).twist.angular
        }

        /// Returns the rates of all fold angles, from the velocities of the vertices and of the lattice alone; zero on
        /// the rim.
        fn fold_rates(&self, sheet: &Sheet, embedding: &Embedding, faces: &[Moving]) -> Vec<f64> {
            let spins: Vec<Vec3> = (0..sheet.triangles.len()).map(|face| self.spin(sheet, embedding, face)).collect();
            let mut rates = vec![0.0; embedding.edges()];
            let steps = embedding.walk.steps.iter().map(|step| (step, [0, 0]));
            let loops = embedding.walk.loops.iter().map(|closing| (&closing.crossing, closing.cell));
            for (step, cell) in steps.chain(loops) {
                let ([from, to], there) = (step.faces, self.to_cell(cell));
                let behind = there.twist.angular + there.motion.rotation * spins[to];
                let edge = faces[from].motion.rotation * step.line.direction;
                rates[step.edge] = edge.dot(&(behind - spins[from]));
            }
            rates
        }

        fn spin(&self, sheet: &Sheet, embedding: &Embedding, face: usize) -> Vec3 {
            let home = embedding.walk.cells[face];
            let [a, b, c] = sheet.triangles[face].corners.map(|corner| self.corner(corner.translated(home)));
            angular_velocity([b.0 - a.0, c.0 - a.0], [b.1 - a.1, c.1 - a.1])
        }
    }

    /// Returns the motions of the faces along the walk.
    fn faces(embedding: &Embedding, angles: &[f64], rates: &[f64]) -> Vec<Moving> {
        let turn = |step: &Crossing| Moving::about(&step.line, embedding.turn(step.edge, angles), rates[step.edge]);
        embedding.walk.walk(turn).faces
    }

    /// Returns the `w` with `w x p = dp` and `w x q = dq`, for two sides of a triangle and their rates.
    fn angular_velocity([p, q]: [Vec3; 2], [dp, dq]: [Vec3; 2]) -> Vec3 {
        let normal = p.cross(&q);
        (dq.dot(&normal) * p - dp.dot(&normal) * q + dp.dot(&q) * normal) / normal.norm_squared()
    }

    /// Returns sheets at closed states, with one null vector of closure each: periodic, flat, cylinders, finite.
    fn moving() -> Vec<(Sheet, Vec<f64>, Vec<f64>)> {
        let star = open_star();
        let cylinders = open_star_reference().cylinders(&star).into_iter().map(|angles| (star.clone(), angles));
        let drawn = [open_star(), open_flat(), miura(), finite_grid(3, 4, 0.3)].map(|sheet| {
            let angles = super::super::drawn_fold_angles(&sheet);
            (sheet, angles)
        });
        let states = cylinders.chain(drawn).map(|(sheet, angles)| {
            let closure = Closure::of_cell(&sheet).unwrap();
            let angles = closed(&closure, angles);
            let basis = null_space(&closure.jacobian(&angles)).unwrap().basis;
            let amplitudes = nalgebra::DVector::from_vec(random_numbers(4, basis.ncols()));
            let mut rates = vec![0.0; angles.len()];
            let null = basis * amplitudes;
            closure.folding_edges().iter().zip(null.iter()).for_each(|(&edge, rate)| rates[edge] = *rate);
            (sheet, angles, rates)
        });
        states.collect()
    }

    /// Claim (duality): the maps from fold rates to velocities of vertices, to angular velocities of faces, and back to
    /// fold rates reproduce the null vectors of closure. Tolerance: rounding divided by the height of a face.
    #[test]
    fn there_and_back() {
        for (sheet, angles, rates) in moving() {
            let embedding = Embedding::new(&sheet).unwrap();
            let displacement = Displacement::new(&embedding, &angles, &rates);
            assert!(displacement.disagreement <= 1e-13);
            let back = displacement.fold_rates(&sheet, &embedding, &faces(&embedding, &angles, &rates));
            assert!(rates.iter().any(|rate| rate.abs() > 0.1));
            assert!(rates.iter().zip(&back).all(|(a, b)| (a - b).abs() <= 1e-13), "{}", sheet.title);
        }
    }

    /// Claim: null vectors stretch no bar to first order, and rates that do not close are reported. Tolerance:
    /// rounding.
    #[test]
    fn bars_keep_their_lengths() {
        for (sheet, angles, mut rates) in moving() {
            let embedding = Embedding::new(&sheet).unwrap();
            let displacement = Displacement::new(&embedding, &angles, &rates);
            for edge in &sheet.edges {
                let [i, j] = edge.key.ends().map(|end| displacement.corner(end));
                assert!((j.0 - i.0).dot(&(j.1 - i.1)).abs() <= 1e-13);
            }
            let edge = embedding.walk.loops[0].crossing.edge;
            rates[edge] += 1.0;
            assert!(Displacement::new(&embedding, &angles, &rates).disagreement > 0.1);
        }
    }

    /// Claim: the velocities of vertices in far cells are the derivatives along exact motions (angles moved along the
    /// rates and closed again, positions by the closed sums). Tested at the cylinders, where closure is smooth.
    #[test]
    fn far_cells_move_as_they_should() {
        for (sheet, angles, rates) in moving().into_iter().take(4) {
            let (embedding, closure) = (Embedding::new(&sheet).unwrap(), Closure::of_cell(&sheet).unwrap());
            let displacement = Displacement::new(&embedding, &angles, &rates);
            for shift in [[0, 0], [3, -2], [-5, 4]] {
                let at = |t: &[f64]| {
                    let moved = angles.iter().zip(&rates).map(|(angle, rate)| angle + t[0] * rate).collect();
                    let shape = Shape::at(&embedding, &closed(&closure, moved)).unwrap();
                    let there = shape.screw.motion(shift);
                    shape.positions.iter().flat_map(|x| there.apply(x).as_slice().to_vec()).collect::<Vec<_>>()
                };
                let corners = (0..sheet.vertices.len()).map(|vertex| displacement.corner(Corner { vertex, shift }));
                let found: Vec<f64> = corners.flat_map(|(_, velocity)| velocity.as_slice().to_vec()).collect();
                check_jacobian(at, &[0.0], &DenseMatrix::from_vec(found.len(), 1, found), TOLERANCE).unwrap();
            }
        }
    }

    /// Claim: a face rotates as its corners move, in any cell: `v_b - v_a = w x (b - a)`; and the angular velocity from
    /// the corners alone is that of the walk. Tolerance: rounding at a distance of some ten cells.
    #[test]
    fn faces_turn_as_their_corners_move() {
        for (sheet, angles, rates) in moving().into_iter().filter(|(sheet, ..)| sheet.lattice.is_some()) {
            let embedding = Embedding::new(&sheet).unwrap();
            let displacement = Displacement::new(&embedding, &angles, &rates);
            let faces = faces(&embedding, &angles, &rates);
            for (face, triangle) in sheet.triangles.iter().enumerate() {
                let cell = [2, -3];
                let [a, b, c] = triangle.corners.map(|corner| displacement.corner(corner.translated(cell)));
                let turning = displacement.angular_velocity(&embedding, (face, &faces[face]), cell);
                for far in [b, c] {
                    assert!((far.1 - a.1 - turning.cross(&(far.0 - a.0))).norm() <= 1e-11);
                }
                let spin = displacement.spin(&sheet, &embedding, face);
                assert!((spin - faces[face].twist.angular).norm() <= 1e-12);
            }
        }
    }

    /// Claim (duality): null vectors of closure are self stresses of the bars of the cell, in periodic and in
    /// screw-periodic states: rate times unit direction of the edges adds up to zero around every vertex, if the force
    /// of an edge on a vertex of another cell is rotated back by the lattice rotations. If it is not rotated back, the
    /// sum is not zero on a cylinder. Tolerance: rounding of some six terms.
    #[test]
    fn null_vectors_are_self_stresses() {
        for (sheet, angles, rates) in moving().into_iter().filter(|(sheet, ..)| sheet.lattice.is_some()) {
            let shape = Shape::at(&Embedding::new(&sheet).unwrap(), &angles).unwrap();
            let unbalanced = |turned_back: bool| {
                let mut forces = vec![Vec3::zeros(); sheet.vertices.len()];
                for (edge, rate) in sheet.edges.iter().zip(&rates) {
                    let [i, j] = edge.key.ends();
                    let there = shape.screw.motion(j.shift);
                    let pull =
                        (there.apply(&shape.positions[j.vertex]) - shape.positions[i.vertex]).normalize() * *rate;
                    forces[i.vertex] += pull;
                    forces[j.vertex] -= if turned_back { there.rotation.transpose() * pull } else { pull };
                }
                forces.iter().map(|force| force.norm()).fold(0.0, f64::max)
            };
            assert!(unbalanced(true) <= 1e-13, "{:e}", unbalanced(true));
            assert_eq!(unbalanced(false) > 1e-2, shape.curvature.abs() > 1e-9);
        }
    }
}
