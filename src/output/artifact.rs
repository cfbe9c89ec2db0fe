//! The files of a study before they are written: tables, states, surfaces, maps and drawings.

use super::error::ShapeError;
use super::figure::canvas::Canvas;
use super::picture::Picture;
use super::strain_space::StrainSurface;
use super::table::Table;
use super::{OutputError, files, vtk};
use crate::math::Vec3;
use std::path::Path;

/// The content of one output file.
#[derive(Clone, Debug)]
pub enum Artifact {
    /// A table (`.csv`).
    Table(Table),
    /// A state of a sheet (`.vtu`).
    State(Picture),
    /// A surface of states in the space of lattice strains (`.vtp`).
    Surface(StrainSurface),
    /// Triangles and curves between points, with arrays of numbers at the points and for the curves (`.vtp`).
    Net(Net),
    /// Values at the points of a grid in the plane (`.vti`).
    Grid {
        /// Numbers of points along the two axes.
        size: [usize; 2],
        /// Coordinates of the first point.
        origin: [f64; 2],
        /// Distances between neighbouring points along the two axes.
        spacing: [f64; 2],
        /// Name of each array, and its values at the points; the first axis runs faster.
        arrays: Vec<(&'static str, Vec<f64>)>,
    },
    /// A list of pairs of a time and a file, with increasing times (`.pvd`).
    Series(Vec<(f64, String)>),
    /// A script for ParaView (`.py`).
    Script(String),
    /// A drawing (`.svg`), or the inconsistency that prevented it.
    Svg(Result<String, ShapeError>),
    /// A page to look at (`.html`).
    Page(String),
}

/// Triangles and curves between common points.
#[derive(Clone, Debug, Default)]
pub struct Net {
    /// Positions of the points.
    pub points: Vec<Vec3>,
    /// Points at the corners of each triangle.
    pub triangles: Vec<[usize; 3]>,
    /// Points of each curve.
    pub curves: Vec<Vec<usize>>,
    /// Name of each array, and its numbers at the points.
    pub arrays: Vec<(&'static str, Vec<f64>)>,
    /// Name of each array of curves, and its number for each of them.
    pub of_curves: Vec<(&'static str, Vec<i32>)>,
}

impl Artifact {
    /// Writes the file.
    ///
    /// # Errors
    /// [`OutputError::Shape`] if the parts of the content are inconsistent, [`OutputError::Write`] if the file cannot
    /// be written.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        files::write(path, self.bytes(path)?)
    }

    /// Returns the bytes of the file; `path` is for messages.
    ///
    /// # Errors
    /// [`OutputError::Shape`] if the parts of the content are inconsistent.
    pub fn bytes(&self, path: &Path) -> Result<Vec<u8>, OutputError> {
        let inconsistent = |fault| OutputError::Shape { path: path.into(), fault };
        match self {
            Self::Table(table) => table.to_csv().map(String::into_bytes).map_err(inconsistent),
            Self::State(picture) => vtk::vtu(path, picture),
            Self::Surface(surface) => vtk::vtp(path, surface),
            Self::Net(Net { points, triangles, curves, arrays, of_curves }) => {
                vtk::vtp_of_net(path, points, (triangles, curves), arrays, of_curves)
            }
            Self::Grid { size, origin, spacing, arrays } => vtk::vti(path, *size, [*origin, *spacing], arrays),
            Self::Series(states) => Ok(vtk::pvd(states).into_bytes()),
            Self::Script(text) | Self::Page(text) => Ok(text.clone().into_bytes()),
            Self::Svg(svg) => svg.clone().map(String::into_bytes).map_err(inconsistent),
        }
    }
}

impl From<Table> for Artifact {
    fn from(table: Table) -> Self {
        Self::Table(table)
    }
}

impl From<Canvas> for Artifact {
    fn from(canvas: Canvas) -> Self {
        Self::Svg(Ok(canvas.finish()))
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
