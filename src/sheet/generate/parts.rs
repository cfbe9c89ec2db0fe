//! The step from the vertices and polygons of a generator to a sheet.

use super::error::GenerateError;
use crate::math::Vec3;
use crate::sheet::build::{Drawing, build, draw};
use crate::sheet::cell::{Corner, Sheet};

/// The parts of a sheet that a generator gives; edges and triangles are computed from them.
pub(super) struct Parts {
    pub title: &'static str,
    /// Literature from which the pattern is taken.
    pub source: &'static str,
    pub vertices: Vec<Vec3>,
    pub lattice: Option<[Vec3; 2]>,
    pub polygons: Vec<Vec<Corner>>,
}

impl Parts {
    pub(crate) fn sheet(self, parameters: String) -> Result<Sheet, GenerateError> {
        let Self { title, source, vertices, lattice, polygons } = self;
        let bare = Sheet {
            title: title.to_owned(),
            description: format!("{source} {parameters} Unit of length: any."),
            vertices,
            lattice,
            polygons,
            ..Sheet::default()
        };
        let drawn: Drawing = draw(&bare);
        Ok(build(&drawn)?)
    }
}
