//! Displacement fields of linear foldings: from rates of fold angles to velocities, and back.
//!
//! The walk over the faces is differentiated by the product rule of motions ([`Moving`]): every face gets its twist, the
//! lattice motions get theirs, and a vertex `x` of the cell `n` moves with the derivative of `A1^n1 A2^n2 x`, in
//! spatially periodic and in screw-periodic states alike. Back again, the velocities of its three corners give the
//! angular velocity of a face, and the difference of those on both sides of an edge, along the edge, is the rate of its
//! fold angle. For rates in the null space of closure this way round changes nothing.

use super::embedding::{Embedding, larger};
use super::motion::{Moving, Rigid};
use super::walk::{Crossing, Walked};
use crate::math::Vec3;
use crate::sheet::Corner;

/// Velocities of a sheet whose fold angles change at some rates, per unit of these, in the frame of the
/// [embedding](super::embedding): vertex 0 and the first face with it stand still.
#[derive(Clone, Debug)]
pub struct Displacement {
    /// Vertices of cell (0, 0).
    pub positions: Vec<Vec3>,
    /// Their velocities.
    pub velocities: Vec<Vec3>,
    /// The lattice motions with their twists; `None` for a finite sheet. The twist of the first has the angular velocity
    /// `Omega_1` at which a cell turns against the one before.
    pub lattice: Option<[Moving; 2]>,
    /// Largest difference, over the edges that the walk has not crossed, between the angular velocity of the way over the
    /// edge and the one that the lattice motions give: zero but for rounding where the rates close.
    pub disagreement: f64,
    walked: Walked<Moving>,
}

impl Displacement {
    /// The velocities at fold angles, for rates of them; both one number per edge, in radians.
    ///
    /// Angles and rates that do not close are walked along the tree.
    /// # Panics
    /// Where one of the two has another length than the edges.
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
        let apart = ways.map(|(closing, way)| way.twist - Moving::lattice_power(lattice, closing.cell).twist);
        let disagreement = apart.map(|twist| twist.angular.amax()).fold(0.0, larger);
        Self { positions, velocities, lattice: walked.lattice, disagreement, walked }
    }

    /// Where a corner is, and its velocity; of a finite sheet only in cell (0, 0).
    pub fn corner(&self, corner: Corner) -> (Vec3, Vec3) {
        let (place, velocity) = (&self.positions[corner.vertex], &self.velocities[corner.vertex]);
        let there = self.to_cell(corner.shift);
        (there.motion.apply(place), there.carry(place, velocity))
    }

    /// Angular velocity of a triangle of the sheet, moved by `cell` from where the sheet lists it.
    pub fn angular_velocity(&self, embedding: &Embedding, face: usize, cell: [i32; 2]) -> Vec3 {
        let home = embedding.walk.cells[face];
        let there = self.to_cell([cell[0] - home[0], cell[1] - home[1]]);
        (there * self.walked.faces[face]).twist.angular
    }

    /// The rates of all fold angles, from the velocities of the vertices and of the lattice alone; zero on the rim.
    pub fn fold_rates(&self, embedding: &Embedding) -> Vec<f64> {
        let spins: Vec<Vec3> = embedding.faces.iter().map(|face| self.spin(&face.corners)).collect();
        let mut rates = vec![0.0; embedding.edges()];
        let steps = embedding.walk.steps.iter().map(|step| (step, [0, 0]));
        let loops = embedding.walk.loops.iter().map(|closing| (&closing.crossing, closing.cell));
        for (step, cell) in steps.chain(loops) {
            let ([from, to], there) = (step.faces, self.to_cell(cell));
            let behind = there.twist.angular + there.motion.rotation * spins[to];
            let edge = self.walked.faces[from].motion.rotation * step.line.direction;
            rates[step.edge] = edge.dot(&(behind - spins[from]));
        }
        rates
    }

    /// From cell (0, 0) to another; a finite sheet has no other.
    fn to_cell(&self, cell: [i32; 2]) -> Moving {
        self.lattice.as_ref().map_or_else(Moving::identity, |lattice| Moving::lattice_power(lattice, cell))
    }

    fn spin(&self, corners: &[Corner; 3]) -> Vec3 {
        let [a, b, c] = corners.map(|corner| self.corner(corner));
        angular_velocity([b.0 - a.0, c.0 - a.0], [b.1 - a.1, c.1 - a.1])
    }
}

/// The `w` with `w x p = dp` and `w x q = dq`, for two sides of a triangle and their rates.
fn angular_velocity([p, q]: [Vec3; 2], [dp, dq]: [Vec3; 2]) -> Vec3 {
    let normal = p.cross(&q);
    (dq.dot(&normal) * p - dp.dot(&normal) * q + dp.dot(&q) * normal) / normal.norm_squared()
}
