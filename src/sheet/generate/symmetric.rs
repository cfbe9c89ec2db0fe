//! Random triangulated cells with one symmetry.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

use super::error::{GenerateError, count, from};
use super::parts::{Parts, VertexGrid, parameters};
use super::random::split;
use crate::math::Vec3;
use crate::numerics::random::symmetric;
use crate::sheet::cell::Sheet;

const SOURCE: &str = "Random triangulated cell with one symmetry, generic otherwise.";

/// The symmetry of a cell. The sheet lies along x and y; its first lattice vector is along x.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CellSymmetry {
    /// A two-fold axis across the sheet, along z.
    #[default]
    TwoFold,
    /// A two-fold screw axis along the sheet: half a turn about x, and half of the first lattice vector.
    Screw,
    /// A mirror plane across the sheet, which contains x and z.
    Mirror,
    /// A glide plane across the sheet: the same reflection, and half of the first lattice vector.
    Glide,
    /// A glide plane along the sheet: up and down exchanged, and half of the first lattice vector.
    GlideAlong,
}

parameters! {
    /// A random cell with one symmetry: as [`Random`](super::Random) without skew, its displacements averaged over the
    /// symmetry.
    Symmetric {
        /// The symmetry. Default `"two-fold"`.
        symmetry: CellSymmetry = CellSymmetry::TwoFold,
        /// Vertices along the two lattice vectors, 1 to 1000 each; even along the first for a screw axis or a glide
        /// plane, along the second for a mirror plane. Default `[4, 4]`.
        size: [usize; 2] = [4, 4],
        /// Largest displacement along z, in `[0, 100)`. Default 0.3.
        height: f64 = 0.3,
        /// Largest displacement in the plane, in `[0, 0.25)`. Default 0.2.
        jitter: f64 = 0.2,
        /// Seed of the random numbers. Default 0.
        seed: u64 = 0,
    }
}

impl CellSymmetry {
    /// Whether it moves by half of the first lattice vector.
    fn is_half(self) -> bool {
        matches!(self, Self::Screw | Self::Glide | Self::GlideAlong)
    }

    /// Returns the signs of x, y and z of the image.
    fn signs(self) -> [f64; 3] {
        match self {
            Self::TwoFold => [-1.0, -1.0, 1.0],
            Self::Screw => [1.0, -1.0, -1.0],
            Self::Mirror | Self::Glide => [1.0, -1.0, 1.0],
            Self::GlideAlong => [1.0, 1.0, -1.0],
        }
    }

    /// Returns the image of the place `(i, j)` of a grid of this size; of a square by its lower left corner if `square`
    /// is 1.
    fn image(self, size: [usize; 2], [i, j]: [usize; 2], square: i64) -> [usize; 2] {
        let [sx, sy, _] = self.signs();
        let half = if self.is_half() { size[0] as i64 / 2 } else { 0 };
        let along = |n: usize, sign: f64| if sign < 0.0 { -(n as i64) - square } else { n as i64 };
        let place = [along(i, sx) + half, along(j, sy)];
        [0, 1].map(|a| place[a].rem_euclid(size[a] as i64) as usize)
    }
}

impl Symmetric {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let size = [count("size[0]", self.size[0], 1, 1000)?, count("size[1]", self.size[1], 1, 1000)?];
        let height = from("height", self.height, 0.0, 100.0)?;
        let jitter = from("jitter", self.jitter, 0.0, 0.25)?;
        let symmetry = self.symmetry;
        let halved = if symmetry.is_half() { Some(0) } else { (symmetry == CellSymmetry::Mirror).then_some(1) };
        if let Some(k) = halved.filter(|&k| size[k] % 2 == 1) {
            return Err(GenerateError::Odd { name: ["size[0]", "size[1]"][k], value: size[k] });
        }
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let grid = VertexGrid { size };
        let number = |[i, j]: [usize; 2]| j * size[0] + i;
        let drawn: Vec<Vec3> = grid.all().map(|_| Vec3::from_fn(|_, _| symmetric(&mut random))).collect();
        let signs = Vec3::from(symmetry.signs());
        let averaged = |at: [usize; 2]| {
            let image = drawn[number(symmetry.image(size, at, 0))].component_mul(&signs);
            (drawn[number(at)] + image) * 0.5
        };
        let place = |at: [usize; 2]| {
            Vec3::new(at[0] as f64, at[1] as f64, 0.0) + averaged(at).component_mul(&Vec3::new(jitter, jitter, height))
        };
        let vertices: Vec<Vec3> = grid.all().map(place).collect();
        // a reflection of the plane exchanges the two diagonals of a square
        let reflects = signs.x * signs.y < 0.0;
        let mut rising: Vec<Option<bool>> = vec![None; drawn.len()];
        for at in grid.all() {
            let own = *rising[number(at)].get_or_insert_with(|| random.next_u64() >> 63 == 0);
            rising[number(symmetry.image(size, at, 1))] = Some(own != reflects);
        }
        let polygons = grid.all().flat_map(|at| split(grid.quad(at), rising[number(at)] == Some(true))).collect();
        let lattice = Some([Vec3::new(size[0] as f64, 0.0, 0.0), Vec3::new(0.0, size[1] as f64, 0.0)]);
        let name = serde_json::to_string(&symmetry).unwrap_or_default();
        Parts { title: "symmetric", source: SOURCE, vertices, lattice, polygons }.sheet(format!(
            "symmetry = {name}, size = {size:?}, height = {height}, jitter = {jitter}, seed = {}.",
            self.seed
        ))
    }
}
