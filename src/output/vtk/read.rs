//! Reader of VTU files: the mesh of a sheet, or the picture of a state.

use std::collections::BTreeMap;
use std::path::Path;

use vtkio::model::{Attribute, Attributes, CellType, Cells, DataSet, UnstructuredGridPiece, Vtk};

use super::appended::inlined;
use crate::analysis::state::REMEMBERED;
use crate::math::Vec3;
use crate::output::OutputError;
use crate::output::error::VtuFault;
use crate::output::picture::Picture;
use crate::sheet::{Assignment, EdgeKind, text};

/// The mesh of a sheet read from a VTU file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VtuMesh {
    /// Positions of the points.
    pub points: Vec<Vec3>,
    /// Points at the corners of each triangle.
    pub triangles: Vec<[usize; 3]>,
    /// Points at the corners of each quadrangle and polygon.
    pub polygons: Vec<Vec<usize>>,
    /// Points at the ends of each edge.
    pub lines: Vec<[usize; 2]>,
    /// Fold angle of each line in radians; `None` if the file has no such array.
    pub fold_angle: Option<Vec<f64>>,
    /// Letter of each line; `None` if the file has no such array, or other numbers in it.
    pub letters: Option<Vec<Assignment>>,
    /// Force along each line, positive in tension; `None` if the file has no such array.
    pub tension: Option<Vec<f64>>,
    /// Torque of the hinge on each line; `None` if the file has no such array.
    pub torque: Option<Vec<f64>>,
    /// What elements remember that yield, on each line, by name; see [`crate::analysis::state::State::memory`].
    pub memory: BTreeMap<&'static str, Vec<f64>>,
}

/// Reads a VTU file of triangles, polygons and lines, uncompressed or compressed with zlib or LZMA. The points of all
/// its pieces are numbered one piece after the other, and arrays are read that all pieces have.
///
/// # Errors
/// [`OutputError::Read`] if the file cannot be read, [`OutputError::Vtu`] if its content is not valid.
pub fn read_vtu(path: &Path) -> Result<VtuMesh, OutputError> {
    let bytes = text::read_bytes(path).map_err(|source| OutputError::Read { path: path.into(), source })?;
    parse_vtu(&bytes).map_err(|fault| OutputError::Vtu { path: path.into(), fault })
}

/// Reads the picture of a state from a VTU file that [`write_vtu`] has written. Arrays that the file lacks are NaN, or
/// 0 for marks and displacements; edges are numbered by their lines where the file has no numbers.
///
/// Without letters in the file, lines without a fold angle are boundaries and all others creases.
pub(crate) fn read_picture(path: &Path) -> Result<Picture, OutputError> {
    let bytes = text::read_bytes(path).map_err(|source| OutputError::Read { path: path.into(), source })?;
    parse_picture(&bytes).map_err(|fault| OutputError::Vtu { path: path.into(), fault })
}

/// Reads the picture of a state from the bytes of a VTU file that [`vtu`](super::vtu) has made.
///
/// # Errors
/// [`VtuFault`] if they are not valid.
pub fn parse_picture(bytes: &[u8]) -> Result<Picture, VtuFault> {
    let pieces = <[UnstructuredGridPiece; 1]>::try_from(guarded_pieces(bytes)?);
    let [piece] = pieces.map_err(|all| VtuFault::Format(format!("it has {} pieces, expected one", all.len())))?;
    let mut mesh = VtuMesh { points: points(&piece)?, ..<_>::default() };
    let types = piece.cells.types.clone();
    let line_cells = mesh.add_cells(piece.cells)?;
    if let Some(cell) = types.iter().position(|kind| ![CellType::Triangle, CellType::Line].contains(kind)) {
        return Err(VtuFault::CellKind { cell, kind: format!("{:?}", types[cell]) });
    }
    let face_cells: Vec<usize> = (0..types.len()).filter(|&cell| types[cell] == CellType::Triangle).collect();
    let lines = mesh.lines.len();
    let on_lines = |name: &str| numbers_on(name, &piece.data, &line_cells).unwrap_or_else(|| vec![f64::NAN; lines]);
    let marks = numbers_on("self_intersecting", &piece.data, &face_cells);
    let edges = numbers_on("edge", &piece.data, &line_cells);
    let fold_angle = on_lines("fold_angle");
    let letters = numbers_on("assignment", &piece.data, &line_cells);
    let letters = letters.and_then(|numbers| numbers.into_iter().map(Assignment::from_number).collect());
    let letters: Vec<Assignment> =
        letters.unwrap_or_else(|| fold_angle.iter().map(|angle| Assignment::of_angle(*angle)).collect());
    Ok(Picture {
        places: places(&piece.data, mesh.points.len()),
        displacement: displacements(&piece.data, mesh.points.len()),
        self_intersecting: marks
            .map_or(vec![0; mesh.triangles.len()], |marks| marks.iter().map(|&mark| u8::from(mark > 0.0)).collect()),
        line_kinds: letters.iter().map(|&letter| kind(letter)).collect(),
        letters,
        line_edges: edges.map_or((0..lines as i32).collect(), |edges| edges.iter().map(|&edge| edge as i32).collect()),
        rest_angle: on_lines("rest_angle"),
        strain: on_lines("strain"),
        energy: on_lines("energy"),
        tension: on_lines("tension"),
        torque: on_lines("torque"),
        memory: memory_on(&piece.data, &line_cells),
        fold_angle,
        points: mesh.points,
        triangles: mesh.triangles,
        lines: mesh.lines,
    })
}

/// Returns the kind of an edge with this letter.
fn kind(letter: Assignment) -> EdgeKind {
    match letter {
        Assignment::Boundary | Assignment::Cut => EdgeKind::Boundary,
        Assignment::Join => EdgeKind::Facet,
        Assignment::Mountain | Assignment::Valley | Assignment::Flat | Assignment::Unassigned => EdgeKind::Crease,
    }
}

/// Returns the vertices and cells of which the points are copies; each point is a vertex of its own if the file does
/// not say.
fn places(data: &Attributes, points: usize) -> Vec<(usize, [i32; 2])> {
    let numbers = |name: &str| numbers_of(name, &data.point).filter(|found| found.len() == points);
    match ["vertex", "cell1", "cell2"].map(numbers) {
        [Some(vertex), Some(c1), Some(c2)] => {
            (0..points).map(|k| (vertex[k] as usize, [c1[k] as i32, c2[k] as i32])).collect()
        }
        _ => (0..points).map(|point| (point, [0, 0])).collect(),
    }
}

/// Returns the numbers of an array; `None` if there is no such array.
fn numbers_of(name: &str, arrays: &[Attribute]) -> Option<Vec<f64>> {
    arrays.iter().find_map(|attribute| match attribute {
        Attribute::DataArray(array) if array.name == name => array.data.cast_into(),
        _ => None,
    })
}

/// Returns the displacements of all points; zero if the file has no such array, or one of another length.
fn displacements(data: &Attributes, points: usize) -> Vec<Vec3> {
    let found = numbers_of("displacement", &data.point);
    match found {
        Some(numbers) if numbers.len() == 3 * points => numbers.chunks_exact(3).map(Vec3::from_column_slice).collect(),
        _ => vec![Vec3::zeros(); points],
    }
}

fn points(piece: &UnstructuredGridPiece) -> Result<Vec<Vec3>, VtuFault> {
    let coordinates: Vec<f64> = piece.points.cast_into().ok_or(VtuFault::Coordinates)?;
    Ok(coordinates.chunks_exact(3).map(Vec3::from_column_slice).collect())
}

pub(super) fn parse_vtu(bytes: &[u8]) -> Result<VtuMesh, VtuFault> {
    let mut pieces = guarded_pieces(bytes)?;
    let has_cells = |piece: &UnstructuredGridPiece| !piece.cells.types.is_empty();
    if pieces.iter().any(has_cells) {
        // a piece without cells may lack the arrays that the others have
        pieces.retain(has_cells);
    }
    let meshes: Vec<VtuMesh> = pieces.into_iter().map(mesh_of).collect::<Result<_, _>>()?;
    Ok(meshes.into_iter().reduce(VtuMesh::joined).unwrap_or_default())
}

fn mesh_of(piece: UnstructuredGridPiece) -> Result<VtuMesh, VtuFault> {
    let mut mesh = VtuMesh { points: points(&piece)?, ..<_>::default() };
    let line_cells = mesh.add_cells(piece.cells)?;
    let on_lines = |name: &str| numbers_on(name, &piece.data, &line_cells);
    (mesh.fold_angle, mesh.tension, mesh.torque) = (on_lines("fold_angle"), on_lines("tension"), on_lines("torque"));
    mesh.memory = memory_on(&piece.data, &line_cells);
    let letters = on_lines("assignment");
    mesh.letters = letters.and_then(|numbers| numbers.into_iter().map(Assignment::from_number).collect());
    Ok(mesh)
}

/// Returns what elements on these lines remember that yield.
fn memory_on(data: &Attributes, line_cells: &[usize]) -> BTreeMap<&'static str, Vec<f64>> {
    let names = REMEMBERED.into_iter().flatten();
    names.filter_map(|name| Some((name, numbers_on(name, data, line_cells)?))).collect()
}

/// Returns the pieces of the grid of a VTU file; panics of the parser are errors.
fn guarded_pieces(bytes: &[u8]) -> Result<Vec<UnstructuredGridPiece>, VtuFault> {
    // vtkio panics on a grid without points, which is therefore excluded first; other panics are caught below
    if !bytes.windows(7).any(|tag| tag == b"<Points") {
        return Err(VtuFault::Format("it has no points".into()));
    }
    let whole = inlined(bytes)?;
    let pieces = std::panic::catch_unwind(|| parse_pieces(&whole));
    pieces.unwrap_or_else(|_| Err(VtuFault::Format("the XML is not complete".into())))
}

fn parse_pieces(bytes: &[u8]) -> Result<Vec<UnstructuredGridPiece>, VtuFault> {
    let format = |error: &dyn std::error::Error| VtuFault::Format(error.to_string());
    let vtk = Vtk::parse_xml(bytes).map_err(|error| format(&error))?;
    let DataSet::UnstructuredGrid { pieces, .. } = vtk.data else { return Err(VtuFault::NotUnstructured) };
    let loaded = pieces.into_iter().map(|piece| piece.into_loaded_piece_data(None).map_err(|error| format(&error)));
    loaded.collect()
}

impl VtuMesh {
    /// Returns this mesh with the points and cells of another one after its own.
    fn joined(mut self, other: Self) -> Self {
        fn both<T>(values: Option<Vec<T>>, others: Option<Vec<T>>) -> Option<Vec<T>> {
            Some(values?.into_iter().chain(others?).collect())
        }
        let points = self.points.len();
        self.points.extend(other.points);
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|point| point + points)));
        self.polygons.extend(other.polygons.iter().map(|face| face.iter().map(|point| point + points).collect()));
        self.lines.extend(other.lines.iter().map(|ends| ends.map(|point| point + points)));
        self.fold_angle = both(self.fold_angle, other.fold_angle);
        self.letters = both(self.letters, other.letters);
        self.tension = both(self.tension, other.tension);
        self.torque = both(self.torque, other.torque);
        let memory = other.memory.into_iter();
        self.memory =
            memory.filter_map(|(name, own)| Some((name, both(self.memory.remove(name), Some(own))?))).collect();
        self
    }

    /// Adds the cells to the triangles or the lines; returns the indices of the cells that are lines.
    fn add_cells(&mut self, cells: Cells) -> Result<Vec<usize>, VtuFault> {
        let types = cells.types;
        let (connectivity, offsets) = cells.cell_verts.into_xml();
        let mut line_cells = Vec::new();
        let mut start = 0;
        for (cell, (kind, end)) in types.iter().zip(offsets).enumerate() {
            let end = end as usize;
            let used = connectivity.get(start..end).unwrap_or_default();
            start = end;
            match kind {
                CellType::Triangle => self.triangles.push(self.points_of(cell, used)?),
                CellType::Line => {
                    self.lines.push(self.points_of(cell, used)?);
                    line_cells.push(cell);
                }
                CellType::Quad | CellType::Polygon => self.polygons.push(checked(cell, used, self.points.len())?),
                other => return Err(VtuFault::CellKind { cell, kind: format!("{other:?}") }),
            }
        }
        Ok(line_cells)
    }

    fn points_of<const N: usize>(&self, cell: usize, used: &[u64]) -> Result<[usize; N], VtuFault> {
        let wrong_size = VtuFault::CellSize { cell, found: used.len(), expected: N };
        let used: [u64; N] = used.try_into().map_err(|_| wrong_size)?;
        let used = checked(cell, &used, self.points.len())?;
        Ok(std::array::from_fn(|k| used[k]))
    }
}

/// Returns the points of a cell as indices, of which there are `count`.
fn checked(cell: usize, used: &[u64], count: usize) -> Result<Vec<usize>, VtuFault> {
    match used.iter().find(|&&point| point >= count as u64) {
        Some(&point) => Err(VtuFault::NoSuchPoint { cell, point, count }),
        None => Ok(used.iter().map(|&point| point as usize).collect()),
    }
}

/// Returns the numbers of a cell array on the lines; `None` if the file has no such array.
fn numbers_on(name: &str, data: &Attributes, line_cells: &[usize]) -> Option<Vec<f64>> {
    let array = numbers_of(name, &data.cell)?;
    line_cells.iter().map(|&cell| array.get(cell).copied()).collect()
}
