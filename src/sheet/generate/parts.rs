//! From what a generator knows to a sheet.

use super::error::GenerateError;
use crate::math::Vec3;
use crate::sheet::build::{Drawing, build, draw};
use crate::sheet::cell::{Corner, Sheet};

/// What a generator knows of a sheet; edges and triangles follow.
pub(super) struct Parts {
    pub title: &'static str,
    /// Source of the pattern.
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
