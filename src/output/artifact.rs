//! The files of a study before they are written: tables, states, surfaces, maps and drawings.

use super::error::ShapeError;
use super::figure::canvas::Canvas;
use super::net::{Grid, Net};
use super::picture::Picture;
use super::strain_space::StrainSurface;
use super::table::Table;
use super::{OutputError, files, vtk};
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
    Grid(Grid),
    /// A list of pairs of a time and a file, with increasing times (`.pvd`).
    Series(Vec<(f64, String)>),
    /// A script for ParaView (`.py`).
    Script(String),
    /// A drawing (`.svg`), or the inconsistency that prevented it.
    Svg(Result<String, ShapeError>),
    /// A page to look at (`.html`).
    Page(String),
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
            Self::Net(net) => vtk::vtp_of_net(path, net),
            Self::Grid(grid) => vtk::vti(path, grid),
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
