//! Random triangulated cells.

use super::error::{GenerateError, between, count, from};
use super::parts::{Parts, VertexGrid, parameters};
use crate::math::Vec3;
use crate::numerics::random::symmetric;
use crate::sheet::cell::{Corner, Sheet};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const SOURCE: &str = "Random triangulated cell as in J. McInerney, B. G. Chen, L. Theran, C. D. Santangelo, \
                      D. Z. Rocklin, PNAS 117, 30252 (2020).";

parameters! {
    /// A generic random cell that cannot be flattened: `size[0] x size[1]` vertices on a skew lattice of unit spacing.
    /// Each is displaced in the plane by at most `jitter` of the spacing along both lattice directions and by at most
    /// `height` along z; then all are translated so that vertex 0 is at the origin. Quadrilaterals are split along a
    /// random diagonal.
    Random {
        /// Vertices along the two lattice vectors, 1 to 1000 each. Default `[2, 2]`.
        size: [usize; 2] = [2, 2],
        /// Largest displacement along z, in `[0, 100)`. Default 0.3.
        height: f64 = 0.3,
        /// Largest displacement in the plane, in `[0, 0.25)`: below a quarter every triangle has a positive area seen
        /// from above, whichever diagonal splits its quadrilateral. Default 0.2.
        jitter: f64 = 0.2,
        /// Displacement of each row along x relative to the row below, in `(-10, 10)`. Default 0.3.
        skew: f64 = 0.3,
        /// Seed of the random numbers. Default 0.
        seed: u64 = 0,
    }
}

parameters! {
    /// A generic random flat cell: as [`Random`] with height 0.
    RandomDevelopable {
        /// Vertices along the two lattice vectors, 1 to 1000 each. Default `[2, 2]`.
        size: [usize; 2] = [2, 2],
        /// Largest displacement in the plane, in `[0, 0.25)`. Default 0.2.
        jitter: f64 = 0.2,
        /// Displacement of each row along x relative to the row below, in `(-10, 10)`. Default 0.3.
        skew: f64 = 0.3,
        /// Seed of the random numbers. Default 0.
        seed: u64 = 0,
    }
}

impl RandomDevelopable {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let Self { size, jitter, skew, seed } = self.clone();
        Random { size, height: 0.0, jitter, skew, seed }.titled("random-developable")
    }
}

impl Random {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        self.titled("random")
    }

    fn titled(&self, title: &'static str) -> Result<Sheet, GenerateError> {
        let [m1, m2] = [count("size[0]", self.size[0], 1, 1000)?, count("size[1]", self.size[1], 1, 1000)?];
        let height = from("height", self.height, 0.0, 100.0)?;
        let jitter = from("jitter", self.jitter, 0.0, 0.25)?;
        let skew = between("skew", self.skew, -10.0, 10.0)?;
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let grid = VertexGrid { size: [m1, m2] };
        let place = |u: f64, v: f64, z: f64| Vec3::new(u + skew * v, v, z);
        let mut vertices: Vec<Vec3> = Vec::with_capacity(m1 * m2);
        for [i, j] in grid.all() {
            let [u, v, z] = [(); 3].map(|()| symmetric(&mut random));
            vertices.push(place(i as f64 + jitter * u, j as f64 + jitter * v, height * z));
        }
        let origin = vertices[0];
        vertices.iter_mut().for_each(|x| *x -= origin);
        let polygons = grid.all().flat_map(|at| split(grid.quad(at), random.next_u64() >> 63 == 0)).collect();
        let lattice = Some([place(m1 as f64, 0.0, 0.0), place(0.0, m2 as f64, 0.0)]);
        let Self { size, seed, .. } = self;
        Parts { title, source: SOURCE, vertices, lattice, polygons }
            .sheet(format!("size = {size:?}, height = {height}, jitter = {jitter}, skew = {skew}, seed = {seed}."))
    }
}

pub(super) fn split([a, b, c, d]: [Corner; 4], rising: bool) -> [Vec<Corner>; 2] {
    if rising { [vec![a, b, c], vec![a, c, d]] } else { [vec![a, b, d], vec![b, c, d]] }
}
