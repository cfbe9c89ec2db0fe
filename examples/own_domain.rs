//! A domain of one's own: a ring-shaped tube of equal sectors, of which one is computed.
//!
//! A domain says where the copies of a cell are: here turned about the z axis by a part of the whole turn. A ring of
//! twelve sectors, each with six vertices around the tube, then has six vertices instead of seventy-two; its energy is
//! that of a sector. Everything else, relaxations, paths, wells, files, goes on as before.
//!
//! ```text
//! cargo run --release --example own_domain
//! ```

mod common;

use foldwell::Assembly;
use foldwell::math::Vec3;
use foldwell::model::{Affine, CellMap, CellMaps, Drive, Driven, OwnDomain};
use foldwell::sheet::build::{Drawing, build};
use nalgebra::Rotation3;
use std::error::Error;
use std::f64::consts::TAU;

/// Numbers of sectors of the ring, and of vertices around the tube.
const SECTORS: usize = 12;
const AROUND: usize = 6;

/// The sectors of a ring: sector `n` is the first one, turned about the z axis by `n` parts of the whole turn. Around
/// the tube, the second direction of the lattice, the sheet comes back to itself. There are no coordinates that all
/// cells share, and so no derivatives by them.
struct Ring;

impl CellMaps for Ring {
    fn shared(&self) -> usize {
        0
    }

    fn map(&self, _: &[f64], [sector, _]: [i32; 2]) -> CellMap {
        let turn = TAU * f64::from(sector) / SECTORS as f64;
        let linear = Rotation3::new(turn * Vec3::z()).into_inner();
        CellMap { map: Affine { linear, shift: Vec3::zeros() }, first: vec![], second: vec![] }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    // the cell as a flat strip of quadrilaterals, each cut into two triangles; it says what is joined to what
    let coords = (0..=AROUND).flat_map(|row| [0.0, 1.0].map(|x| Vec3::new(x, row as f64, 0.0))).collect();
    let triangles = |row: usize| [vec![2 * row, 2 * row + 1, 2 * row + 2], vec![2 * row + 1, 2 * row + 3, 2 * row + 2]];
    let faces = (0..AROUND).flat_map(triangles).collect();
    let lattice = Some([Vec3::x(), AROUND as f64 * Vec3::y()]);
    let sheet = build(&Drawing { coords, faces, lattice, ..Drawing::default() })?;

    // where the vertices of the first sector are
    let (radius, thickness) = (2.0, 0.8);
    let state = (0..AROUND).flat_map(|row| {
        let angle = TAU * row as f64 / AROUND as f64;
        [radius + thickness * angle.cos(), 0.0, thickness * angle.sin()]
    });
    let ring = Assembly::own(sheet, OwnDomain::new(Ring), state.collect(), [SECTORS, 1]);
    let ring = ring.bars(1e2).creases(0.1).rest(foldwell::Rest::Angle(0.5)).build()?;
    let pulled_out = Driven::Vertices { vertices: vec![0], direction: Vec3::x() };
    common::use_it("ring", &ring, &Drive { quantity: pulled_out, to: 0.2 })
}
