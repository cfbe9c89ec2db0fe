//! The files of a study before they are written: tables, states, surfaces, maps, pictures.

use super::fault::ShapeError;
use super::picture::Picture;
use super::strain_space::StrainSurface;
use super::table::Table;
use super::{OutputError, files, vtk};
use crate::math::Vec3;
use std::path::Path;

/// The content of a file.
#[derive(Clone, Debug)]
pub enum Artifact {
    /// A table, `.csv`.
    Table(Table),
    /// A state of a sheet, `.vtu`.
    State(Picture),
    /// A surface of states in the space of lattice strains, `.vtp`.
    Surface(StrainSurface),
    /// Triangles and curves between points, with arrays of numbers at the points, `.vtp`.
    Net(Net),
    /// Curves in the plane, with arrays of numbers that belong to whole curves, `.vtp`.
    Curves {
        /// The curves.
        curves: Vec<Vec<[f64; 2]>>,
        /// Names and numbers.
        arrays: Vec<(&'static str, Vec<i32>)>,
    },
    /// Values on a grid, `.vti`.
    Grid {
        /// Number of points along each direction.
        size: [usize; 2],
        /// Position of the first point.
        origin: [f64; 2],
        /// Distance of points.
        spacing: [f64; 2],
        /// Names and numbers.
        arrays: Vec<(&'static str, Vec<f64>)>,
    },
    /// A list of files with increasing times, `.pvd`.
    Series(Vec<(f64, String)>),
    /// A picture, `.svg`, or what does not fit together in it.
    Svg(Result<String, ShapeError>),
}

/// Triangles and curves between points.
#[derive(Clone, Debug, Default)]
pub struct Net {
    /// Positions.
    pub points: Vec<Vec3>,
    /// Corners of triangles.
    pub triangles: Vec<[usize; 3]>,
    /// Points of curves.
    pub curves: Vec<Vec<usize>>,
    /// Names and numbers at the points.
    pub arrays: Vec<(&'static str, Vec<f64>)>,
}

impl Artifact {
    /// Writes the file.
    ///
    /// # Errors
    /// [`OutputError::Shape`] where parts do not fit together, [`OutputError::Write`] where it cannot be written.
    pub(crate) fn write(&self, path: &Path) -> Result<(), OutputError> {
        match self {
            Self::Table(table) => table.write(path),
            Self::State(picture) => vtk::write_vtu(path, picture),
            Self::Surface(surface) => vtk::write_vtp(path, surface),
            Self::Net(net) => vtk::write_surface(path, &net.points, (&net.triangles, &net.curves), &net.arrays),
            Self::Curves { curves, arrays } => vtk::write_curves(path, curves, arrays),
            Self::Grid { size, origin, spacing, arrays } => vtk::write_vti(path, *size, [*origin, *spacing], arrays),
            Self::Series(states) => vtk::write_pvd(path, states),
            Self::Svg(Ok(text)) => files::write(path, text),
            Self::Svg(Err(fault)) => Err(OutputError::Shape { path: path.into(), fault: fault.clone() }),
        }
    }
}

impl From<Table> for Artifact {
    fn from(table: Table) -> Self {
        Self::Table(table)
    }
}

impl From<String> for Artifact {
    fn from(svg: String) -> Self {
        Self::Svg(Ok(svg))
    }
}

impl From<Result<String, ShapeError>> for Artifact {
    fn from(svg: Result<String, ShapeError>) -> Self {
        Self::Svg(svg)
    }
}

impl From<Picture> for Artifact {
    fn from(picture: Picture) -> Self {
        Self::State(picture)
    }
}
