//! Files for ParaView: VTU (one state), VTP (a surface of states, or curves), VTI (a map), PVD (the files of a study in
//! their order).
//!
//! Arrays are written uncompressed, because ParaView has failed to open compressed files of several writers. Their
//! lengths are checked first, because ParaView crashes on an array that is too short.

mod appended;
mod read;

use std::fmt::Write as _;
use std::io;
use std::path::Path;

use vtkio::IOBuffer;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataArray, DataSet, ElementType, Extent, ImageDataPiece, Piece,
    PolyDataPiece, UnstructuredGridPiece, Version, VertexNumbers, Vtk,
};

use super::error::ShapeError;
use super::net::{Grid, Net};
use super::picture::Picture;
use super::strain_space::StrainSurface;
use super::{OutputError, files};
use crate::math::Vec3;

pub(crate) use read::read_picture;
pub use read::{VtuMesh, parse_picture, read_vtu};

/// Writes a state as a VTU file; its cells are the triangles, followed by the lines.
///
/// Point arrays: `displacement`, and `vertex`, `cell1`, `cell2`, the vertex of the sheet's cell and the cell of which
/// each point is the copy. Cell arrays: `fold_angle`, `rest_angle`, `strain`, `energy`, `tension`, `torque` (NaN on
/// triangles), `self_intersecting` (0 on lines), `edge`, the index of the edge of the cell of which the line is a copy,
/// and `assignment`, 0 to 6 for the letters B, M, V, F, U, C, J (both -1 on triangles).
///
/// # Errors
/// [`OutputError::Shape`] if the arrays of the picture are inconsistent, [`OutputError::Write`].
pub fn write_vtu(path: &Path, picture: &Picture) -> Result<(), OutputError> {
    files::write(path, vtu(path, picture)?)
}

/// Returns the bytes of the file that [`write_vtu`] writes; `path` is for messages.
///
/// # Errors
/// [`OutputError::Shape`].
pub fn vtu(path: &Path, picture: &Picture) -> Result<Vec<u8>, OutputError> {
    picture.check().map_err(|fault| OutputError::Shape { path: path.into(), fault })?;
    let piece = UnstructuredGridPiece {
        points: coordinates(&picture.points),
        cells: cells(picture),
        data: attributes(picture),
    };
    bytes(path, DataSet::inline(piece))
}

/// Numbers of vertices of polygons or lines.
fn numbers<'a>(lists: impl Iterator<Item = &'a [usize]>) -> VertexNumbers {
    let (mut connectivity, mut offsets) = (Vec::new(), Vec::new());
    for list in lists {
        connectivity.extend(list.iter().map(|&point| point as u64));
        offsets.push(connectivity.len() as u64);
    }
    VertexNumbers::XML { connectivity, offsets }
}

/// Returns a VTP file of a surface of states, of triangles in the space of lattice strains, a curve as one of lines.
///
/// Point arrays: `curvature`, `theta` (2 components), one for each edge of the cell named like its column in the table
/// (`fold_i_j_n1_n2`), and, if they were computed, `energy` and `self_intersecting`.
pub(crate) fn vtp(path: &Path, surface: &StrainSurface) -> Result<Vec<u8>, OutputError> {
    surface.check().map_err(|fault| OutputError::Shape { path: path.into(), fault })?;
    let lines = numbers(surface.segments.iter().map(|segment| segment.as_slice()));
    let pair = ElementType::Scalars { num_comp: 2, lookup_table: None };
    let theta: Vec<f64> = surface.theta.iter().flatten().copied().collect();
    let mut point = vec![scalars("curvature", surface.curvature.clone()), array("theta", pair, theta)];
    point.extend(surface.folds.iter().map(|(name, angles)| scalars(name, angles.clone())));
    point.extend(surface.energy.iter().map(|energy| scalars("energy", energy.clone())));
    point.extend(surface.self_intersecting.iter().map(|marks| scalars("self_intersecting", marks.clone())));
    let piece = PolyDataPiece {
        points: coordinates(&surface.points),
        lines: (!surface.segments.is_empty()).then_some(lines),
        polys: Some(numbers(surface.triangles.iter().map(|triangle| triangle.as_slice()))),
        data: Attributes { point, cell: vec![] },
        ..PolyDataPiece::default()
    };
    bytes(path, DataSet::inline(piece))
}

/// Returns a VTP file of triangles and curves between common points, with arrays of numbers at the points, and of one
/// number for each curve.
pub(crate) fn vtp_of_net(path: &Path, net: &Net) -> Result<Vec<u8>, OutputError> {
    let Net { points, triangles, curves, arrays, of_curves } = net;
    let point = checked_scalars(path, arrays, points.len())?;
    let cell = checked_scalars(path, of_curves, curves.len())?;
    let piece = PolyDataPiece {
        points: coordinates(points),
        lines: Some(numbers(curves.iter().map(Vec::as_slice))),
        polys: (!triangles.is_empty()).then(|| numbers(triangles.iter().map(|triangle| triangle.as_slice()))),
        data: Attributes { point, cell },
        ..PolyDataPiece::default()
    };
    bytes(path, DataSet::inline(piece))
}

/// Returns a VTI file of a map: values at the points of a grid.
pub(crate) fn vti(path: &Path, grid: &Grid) -> Result<Vec<u8>, OutputError> {
    let Grid { size, origin, spacing, arrays } = grid;
    let point = checked_scalars(path, arrays, size[0] * size[1])?;
    let [last1, last2] = size.map(|n| n as i32 - 1);
    let extent = Extent::Ranges([0..=last1, 0..=last2, 0..=0]);
    let piece = ImageDataPiece { extent: extent.clone(), data: Attributes { point, cell: vec![] } };
    let place = |[x, y]: &[f64; 2], z: f32| [*x as f32, *y as f32, z];
    let (origin, spacing) = (place(origin, 0.0), place(spacing, 1.0));
    let pieces = vec![Piece::Inline(Box::new(piece))];
    bytes(path, DataSet::ImageData { extent, origin, spacing, meta: None, pieces })
}

/// Returns arrays of one number for each point or cell, of which there are `expected`; `path` is for messages.
fn checked_scalars<T: Clone>(
    path: &Path,
    arrays: &[(&'static str, Vec<T>)],
    expected: usize,
) -> Result<Vec<Attribute>, OutputError>
where
    IOBuffer: From<Vec<T>>,
{
    let lengths = arrays.iter().map(|(array, values)| (*array, values.len(), expected));
    ShapeError::check(lengths, [], 0).map_err(|fault| OutputError::Shape { path: path.into(), fault })?;
    Ok(arrays.iter().map(|(array, values)| scalars(array, values.clone())).collect())
}

/// Returns the bytes of the file of a data set; `path` is for messages.
fn bytes(path: &Path, data: DataSet) -> Result<Vec<u8>, OutputError> {
    let (version, byte_order) = (Version::Auto, ByteOrder::LittleEndian);
    let vtk = Vtk { version, title: String::new(), byte_order, file_path: None, data };
    let mut text = Vec::new();
    let written = vtk.write_xml(&mut text).map_err(io::Error::other);
    let text = written.and_then(|()| String::from_utf8(text).map_err(io::Error::other));
    text.map(with_signed_indices).map_err(|source| OutputError::Write { path: path.into(), source })
}

/// Returns the file with the type of the arrays of connectivity and offsets changed to `Int64`, which VTK itself
/// writes; the bytes of the numbers are the same.
///
/// vtkio writes `UInt64`; meshio adds signed numbers to these, which makes them floating-point numbers.
fn with_signed_indices(text: String) -> Vec<u8> {
    let tag = |kind: &str, name: &str| format!("<DataArray type=\"{kind}\" Name=\"{name}\"");
    let signed = |text: String, name: &str| text.replace(&tag("UInt64", name), &tag("Int64", name));
    ["connectivity", "offsets"].into_iter().fold(text, signed).into_bytes()
}

fn coordinates(points: &[Vec3]) -> IOBuffer {
    IOBuffer::F64(points.iter().flat_map(|p| [p.x, p.y, p.z]).collect())
}

fn cells(picture: &Picture) -> Cells {
    let types = [vec![CellType::Triangle; picture.triangles.len()], vec![CellType::Line; picture.lines.len()]];
    let triangles = picture.triangles.iter().map(|triangle| triangle.as_slice());
    let cell_verts = numbers(triangles.chain(picture.lines.iter().map(|line| line.as_slice())));
    Cells { cell_verts, types: types.concat() }
}

fn attributes(picture: &Picture) -> Attributes {
    let faces = picture.triangles.len();
    let on_lines = |values: &[f64]| [&vec![f64::NAN; faces], values].concat();
    let crossing = [&picture.self_intersecting[..], &vec![0; picture.lines.len()]].concat();
    let edges = [&vec![-1; faces], &picture.line_edges[..]].concat();
    let vertex: Vec<i32> = picture.places.iter().map(|(vertex, _)| *vertex as i32).collect();
    let cell = |axis: usize| picture.places.iter().map(|(_, cell)| cell[axis]).collect::<Vec<i32>>();
    let letters = picture.letters.iter().map(|letter| letter.number() as i32);
    let letters: Vec<i32> = vec![-1; faces].into_iter().chain(letters).collect();
    let fields = Picture::FIELDS.iter().map(|(name, get)| scalars(name, on_lines(get(picture))));
    let others = [scalars("self_intersecting", crossing), scalars("edge", edges), scalars("assignment", letters)];
    let remembered = picture.memory.iter().map(|(name, values)| scalars(name, on_lines(values)));
    Attributes {
        point: vec![
            array("displacement", ElementType::Vectors, coordinates(&picture.displacement)),
            scalars("vertex", vertex),
            scalars("cell1", cell(0)),
            scalars("cell2", cell(1)),
        ],
        cell: fields.chain(others).chain(remembered).collect(),
    }
}

fn scalars(name: &str, data: impl Into<IOBuffer>) -> Attribute {
    array(name, ElementType::Scalars { num_comp: 1, lookup_table: None }, data)
}

fn array(name: &str, elem: ElementType, data: impl Into<IOBuffer>) -> Attribute {
    Attribute::DataArray(DataArray { name: name.into(), elem, data: data.into() })
}

/// Returns a PVD collection. `states` holds pairs of a time (any increasing numbers) and the path of a file relative to
/// the collection.
pub(crate) fn pvd(states: &[(f64, String)]) -> String {
    let mut text = String::from("<?xml version=\"1.0\"?>\n");
    text.push_str("<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  <Collection>\n");
    for (time, file) in states {
        let file = file.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        // writing to a string does not fail
        let _ = writeln!(text, "    <DataSet timestep=\"{time:?}\" group=\"\" part=\"0\" file=\"{file}\"/>");
    }
    text.push_str("  </Collection>\n</VTKFile>\n");
    text
}

#[cfg(test)]
mod tests {
    use super::super::error::{ShapeError, VtuFault};
    use super::super::test_samples as samples;
    use super::read::{parse_picture, parse_vtu};
    use super::*;
    use proptest::prelude::*;

    fn written(picture: &Picture) -> Vec<u8> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.vtu");
        write_vtu(&path, picture).unwrap();
        std::fs::read(path).unwrap()
    }

    /// A state is read back bit for bit.
    #[test]
    fn a_state_reads_back() {
        let picture = samples::hinge(0.3);
        let mesh = parse_vtu(&written(&picture)).unwrap();
        assert_eq!((&mesh.points, &mesh.triangles, &mesh.lines), (&picture.points, &picture.triangles, &picture.lines));
        let bits = |angles: &[f64]| angles.iter().map(|a| a.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&mesh.fold_angle.unwrap()), bits(&picture.fold_angle));
        assert_eq!(mesh.letters.unwrap(), picture.letters);
        assert_eq!(bits(&mesh.tension.unwrap()), bits(&picture.tension));
        assert_eq!(bits(&mesh.torque.unwrap()), bits(&picture.torque));
    }

    /// Claim: the picture of a state is read back with all its arrays, bit for bit; one of a file that has no arrays,
    /// as other programs write it, has no fold angles and no marks.
    #[test]
    fn a_picture_reads_back() {
        let picture = samples::hinge(0.3);
        let text = written(&picture);
        // NaN is not equal to itself: the texts of the two are compared
        assert_eq!(format!("{:?}", parse_picture(&text).unwrap()), format!("{picture:?}"));
        let bare = String::from_utf8(text).unwrap().replace("fold_angle", "f").replace("\"edge", "\"e");
        let bare = bare.replace("self_intersecting", "s").replace("displacement", "d");
        let found = parse_picture(bare.as_bytes()).unwrap();
        assert!(found.fold_angle.iter().all(|angle| angle.is_nan()) && found.self_intersecting == [0, 0]);
        assert_eq!((found.line_edges, found.displacement), (vec![0, 1, 2, 3, 4], vec![Vec3::zeros(); 4]));
    }

    /// Claim: `vertex`, `cell1` and `cell2` say of which vertex and cell each point is the copy.
    #[test]
    fn points_have_their_vertex_and_cell() {
        let places = vec![(3, [0, 0]), (1, [2, -1]), (0, [-4, 5]), (2, [7, 7])];
        let picture = Picture { places: places.clone(), ..samples::hinge(0.3) };
        assert_eq!(parse_picture(&written(&picture)).unwrap().places, places);
        let vtk = Vtk::parse_xml(&written(&picture)[..]).unwrap();
        let piece = UnstructuredGridPiece::try_from(vtk.data).unwrap();
        let numbers = |name: &str| -> Vec<i32> {
            let named = |attribute: &Attribute| match attribute {
                Attribute::DataArray(array) if array.name == name => array.data.cast_into(),
                _ => None,
            };
            piece.data.point.iter().find_map(named).unwrap()
        };
        assert_eq!(numbers("vertex"), [3, 1, 0, 2]);
        assert_eq!(numbers("cell1"), [0, 2, -4, 7]);
        assert_eq!(numbers("cell2"), [0, -1, 5, 7]);
    }

    /// Every documented array is present, with a value for every cell.
    #[test]
    fn every_array_has_its_length() {
        let picture = samples::hinge(0.3);
        let vtk = Vtk::parse_xml(&written(&picture)[..]).unwrap();
        let piece = UnstructuredGridPiece::try_from(vtk.data).unwrap();
        let lengths = |attributes: &[Attribute]| -> Vec<(String, usize)> {
            let length = |a: &Attribute| match a {
                Attribute::DataArray(array) => (array.name.clone(), array.data.len()),
                Attribute::Field { .. } => panic!("no fields are written"),
            };
            attributes.iter().map(length).collect()
        };
        let points = [("displacement", 12), ("vertex", 4), ("cell1", 4), ("cell2", 4)];
        assert_eq!(lengths(&piece.data.point), points.map(|(name, length)| (name.to_owned(), length)));
        let names = [
            "fold_angle",
            "rest_angle",
            "strain",
            "energy",
            "tension",
            "torque",
            "self_intersecting",
            "edge",
            "assignment",
        ];
        assert_eq!(lengths(&piece.data.cell), names.map(|name| (name.to_owned(), 7)));
    }

    /// Returns the names and types of the arrays of indices in a file.
    fn index_types(path: &Path) -> Vec<(String, String)> {
        let text = String::from_utf8_lossy(&std::fs::read(path).unwrap()).into_owned();
        let value = |tag: &str, key: &str| Some(tag.split_once(&format!("{key}=\""))?.1.split_once('"')?.0.to_owned());
        let tags = text.split("<DataArray ").skip(1).filter_map(|tag| tag.split_once('>'));
        let types = tags.filter_map(|(tag, _)| Some((value(tag, "Name")?, value(tag, "type")?)));
        types.filter(|(name, _)| ["connectivity", "offsets"].contains(&name.as_str())).collect()
    }

    /// Claim: the arrays of connectivity and offsets have the type `Int64` in every kind of file, as in the files of
    /// VTK's own writers: meshio turns `UInt64` into floating-point numbers, which cannot be used as indices.
    #[test]
    fn indices_are_signed() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let points = vec![Vec3::zeros(), Vec3::x(), Vec3::y()];
        write_vtu(&path("a.vtu"), &samples::hinge(0.3)).unwrap();
        files::write(&path("b.vtp"), vtp(&path("b.vtp"), &samples::cap(5)).unwrap()).unwrap();
        let face = Net { points, triangles: vec![[0, 1, 2]], curves: vec![vec![0, 1, 2, 0]], ..Net::default() };
        files::write(&path("c.vtp"), vtp_of_net(&path("c.vtp"), &face).unwrap()).unwrap();
        let line = Net { triangles: vec![], curves: vec![vec![0, 1]], ..face };
        files::write(&path("d.vtp"), vtp_of_net(&path("d.vtp"), &line).unwrap()).unwrap();
        for (name, arrays) in [("a.vtu", 2), ("b.vtp", 2), ("c.vtp", 4), ("d.vtp", 2)] {
            let types = index_types(&path(name));
            assert!(types.len() >= arrays && types.iter().all(|(_, kind)| kind == "Int64"), "{name}: {types:?}");
        }
    }

    /// A picture with inconsistent arrays is not written.
    #[test]
    fn a_short_array_is_not_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.vtu");
        let mut picture = samples::hinge(0.3);
        picture.energy.pop();
        let error = write_vtu(&path, &picture).unwrap_err();
        let expected = ShapeError::Length { array: "energy", found: 4, expected: 5 };
        assert!(matches!(error, OutputError::Shape { fault, .. } if fault == expected));
        assert!(!path.exists());
    }

    /// A picture without points is written and read back like any other.
    #[test]
    fn an_empty_picture_reads_back() {
        assert_eq!(
            parse_vtu(&written(&Picture::default())).unwrap(),
            VtuMesh {
                fold_angle: Some(vec![]),
                letters: Some(vec![]),
                tension: Some(vec![]),
                torque: Some(vec![]),
                ..<_>::default()
            }
        );
    }

    /// Collections are XML files that list the states in their order; names are escaped.
    #[test]
    fn collections_list_their_states() {
        let text = pvd(&[(0.0, "a/0.vtu".into()), (0.5, "a/<&\".vtu".into())]);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[3], "    <DataSet timestep=\"0.0\" group=\"\" part=\"0\" file=\"a/0.vtu\"/>");
        assert!(lines[4].contains("file=\"a/&lt;&amp;&quot;.vtu\""), "{}", lines[4]);
    }

    /// Files that are not VTU files of an unstructured grid are refused with an error.
    #[test]
    fn other_files_are_refused() {
        for bad in ["", "solid", "<VTKFile/>", "<VTKFile type=\"UnstructuredGrid\"></VTKFile>"] {
            assert!(parse_vtu(bad.as_bytes()).is_err(), "{bad}");
        }
        let text = String::from_utf8(written(&samples::hinge(0.3))).unwrap();
        let fault = parse_vtu(text.replace("UnstructuredGrid", "PolyData").as_bytes()).unwrap_err();
        assert!(matches!(fault, VtuFault::Format(_) | VtuFault::NotUnstructured), "{fault}");
    }

    /// Claim: a surface is read back with its triangles, and every array has a value for every point; quantities that
    /// were not computed have no array; inconsistent arrays are not written.
    #[test]
    fn a_surface_reads_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.vtp");
        let mut surface = samples::cap(5);
        let read = |path: &Path| match Vtk::parse_xml(&std::fs::read(path).unwrap()[..]).unwrap().data {
            data @ DataSet::PolyData { .. } => PolyDataPiece::try_from(data).unwrap(),
            other => panic!("{other:?}"),
        };
        let names = |piece: &PolyDataPiece| -> Vec<(String, usize)> {
            let name = |a: &Attribute| match a {
                Attribute::DataArray(array) => (array.name.clone(), array.data.len()),
                Attribute::Field { .. } => panic!("no fields are written"),
            };
            piece.data.point.iter().map(name).collect()
        };
        files::write(&path, vtp(&path, &surface).unwrap()).unwrap();
        let piece = read(&path);
        let (corners, ends) = piece.polys.clone().unwrap().into_xml();
        assert_eq!(corners, surface.triangles.iter().flatten().map(|&p| p as u64).collect::<Vec<_>>());
        assert_eq!((ends.len(), piece.num_points()), (surface.triangles.len(), 25));
        let expected =
            [("curvature", 25), ("theta", 50), ("fold_0_1_0_0", 25), ("energy", 25), ("self_intersecting", 25)];
        assert_eq!(names(&piece), expected.map(|(name, length)| (name.to_owned(), length)));
        (surface.energy, surface.self_intersecting) = (None, None);
        files::write(&path, vtp(&path, &surface).unwrap()).unwrap();
        assert_eq!(names(&read(&path)).len(), 3);
        surface.folds[0].1.pop();
        let error = vtp(&path, &surface).unwrap_err();
        let fault = ShapeError::Length { array: "fold", found: 24, expected: 25 };
        assert!(matches!(error, OutputError::Shape { fault: found, .. } if found == fault));
    }

    /// Claim: curves and maps are read back with their points, arrays, origin and spacing; arrays that are too short
    /// are not written.
    #[test]
    fn curves_and_maps_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.vtp");
        let points: Vec<Vec3> = (0..5).map(|k| Vec3::new(f64::from(2 * k), f64::from(2 * k + 1), 0.0)).collect();
        let net = Net { points, curves: vec![vec![0, 1, 2], vec![3, 4]], ..Net::default() };
        let vtp = |winding| vtp_of_net(&path, &Net { of_curves: vec![("winding1", winding)], ..net.clone() });
        files::write(&path, vtp(vec![2, -1]).unwrap()).unwrap();
        let read = |path: &Path| Vtk::parse_xml(&std::fs::read(path).unwrap()[..]).unwrap().data;
        let piece = PolyDataPiece::try_from(read(&path)).unwrap();
        assert_eq!((piece.num_points(), piece.num_lines()), (5, 2));
        assert_eq!(piece.lines.unwrap().into_xml(), (vec![0, 1, 2, 3, 4], vec![3, 5]));
        assert!(vtp(vec![2]).is_err());
        let path = folder.path().join("a.vti");
        let values = vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let arrays = vec![("determinant", values)];
        let grid = Grid { size: [3, 2], origin: [-1.0, -2.0], spacing: [0.5, 0.25], arrays };
        files::write(&path, vti(&path, &grid).unwrap()).unwrap();
        let DataSet::ImageData { extent, origin, spacing, .. } = read(&path) else { panic!("a map is an image") };
        assert_eq!((extent, origin), (Extent::Ranges([0..=2, 0..=1, 0..=0]), [-1.0, -2.0, 0.0]));
        assert_eq!(spacing, [0.5, 0.25, 1.0]);
        assert!(vti(&path, &Grid { size: [3, 3], ..grid }).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// A file with random changes is read or refused; the reader does not panic.
        #[test]
        fn spoiled_files_do_not_panic(start in 0..6000usize, length in 0..30usize, new in "[0-9A-Za-z<>/=\" ]{0,12}") {
            let bytes = written(&samples::hinge(0.3));
            let start = start % bytes.len();
            let end = (start + length).min(bytes.len());
            let _ = parse_vtu(&[&bytes[..start], new.as_bytes(), &bytes[end..]].concat());
        }

        /// The same for changes of the numbers and types in the headers of the arrays.
        #[test]
        fn wrong_counts_do_not_panic(which in 0..6usize, count in proptest::num::u64::ANY) {
            let text = String::from_utf8(written(&samples::hinge(0.3))).unwrap();
            let old = ["NumberOfPoints=\"4\"", "NumberOfCells=\"7\"", "NumberOfComponents=\"3\"", "Int64", "Float64", "Points"];
            let (name, _) = old[which].split_once('=').unwrap_or((old[which], ""));
            let new = if which < 3 { format!("{name}=\"{count}\"") } else { ["Int8", "UInt8", "Float32", ""][count as usize % 4].into() };
            prop_assert!(text.contains(old[which]));
            let _ = parse_vtu(text.replace(old[which], &new).as_bytes());
        }
    }
}
