//! STL files: the triangles of a sheet, for programs that show, slice and print them.
//!
//! STL has no shared vertices, letters or lattice vectors: corners of triangles that stand in one place are one vertex
//! of the sheet that is read, and all its edges are creases. Files are read as text or bytes, and written as text.

use std::fmt::Write;
use std::path::Path;

use super::build::{Drawing, build, merged};
use super::cell::Sheet;
use super::error::{Defect, MeshPart, MeshProblem, SheetError};
use super::pattern_fault::PatternFault;
use super::text;
use crate::math::Vec3;

/// Bytes before the triangles of a binary file, the last four of which are their number; and those of a triangle: its
/// normal and corners as twelve numbers, and two more bytes.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Reads the sheet of the file at `path`.
///
/// # Errors
/// [`SheetError::Read`] if the file does not exist or cannot be read, otherwise as [`parse`].
pub fn read(path: &Path) -> Result<Sheet, SheetError> {
    let bytes = text::read_bytes(path).map_err(|source| SheetError::Read { path: path.to_owned(), source })?;
    parse(&bytes, &path.display().to_string())
}

/// Reads the sheet of an STL file, binary or text. `name` is the name of its file: it appears in messages, and is the
/// title.
///
/// # Errors
/// [`SheetError::Bad`] with what is wrong, and in a text its line.
pub fn parse(bytes: &[u8], name: &str) -> Result<Sheet, SheetError> {
    let corners = binary(bytes).map_or_else(|| ascii(bytes), Ok);
    let corners = corners.map_err(|(line, problem)| SheetError::bad(name, [line, 1], problem))?;
    let coords: Vec<Vec3> = corners.iter().map(|(_, x)| *x).collect();
    let (coords, number) = merged(&coords);
    let title = Path::new(name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let faces = number.chunks_exact(3).map(<[usize]>::to_vec).collect();
    let drawn = Drawing { title, coords, faces, ..Drawing::default() };
    let line = |defect: &Defect| match defect.place {
        MeshPart::Face(face) => corners.get(3 * face).map_or(1, |(line, _)| *line),
        _ => 1,
    };
    build(&drawn).map_err(|defect| SheetError::bad(name, [line(&defect), 1], defect.problem))
}

/// A corner of a triangle, and its line in a text.
type LineCorner = (usize, Vec3);

/// Returns the corners of all triangles of a binary file; `None` if its length is not that of its triangles.
fn binary(bytes: &[u8]) -> Option<Vec<LineCorner>> {
    let count = u32::from_le_bytes(bytes.get(HEADER - 4..HEADER)?.try_into().ok()?) as usize;
    let triangles = bytes.get(HEADER..)?;
    if triangles.len() != count.checked_mul(TRIANGLE)? {
        return None;
    }
    let number = |four: &[u8; 4]| f64::from(f32::from_le_bytes(*four));
    let corners = triangles.chunks_exact(TRIANGLE).flat_map(|triangle| {
        let numbers: Vec<f64> = triangle[12..48].as_chunks::<4>().0.iter().map(number).collect();
        numbers.chunks_exact(3).map(|x| (1, Vec3::from_column_slice(x))).collect::<Vec<_>>()
    });
    Some(corners.collect())
}

/// Returns the corners of all triangles of a text.
fn ascii(bytes: &[u8]) -> Result<Vec<LineCorner>, (usize, MeshProblem)> {
    let wrong = |line: usize, found: &str, what: &'static str, right: &'static str| {
        (line, PatternFault::value(found, what, right).into())
    };
    let text = String::from_utf8_lossy(bytes);
    if !text.trim_start().starts_with("solid") {
        return Err(wrong(1, &text, "STL file", "a text that begins with `solid`, or as long as its triangles say"));
    }
    let mut corners = Vec::new();
    for (row, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        if words.next() != Some("vertex") {
            continue;
        }
        let numbers: Option<Vec<f64>> = words.map(|word| word.parse().ok().filter(|x: &f64| x.is_finite())).collect();
        match numbers.as_deref() {
            Some(&[x, y, z]) => corners.push((row + 1, Vec3::new(x, y, z))),
            _ => return Err(wrong(row + 1, line.trim(), "corner", "three finite numbers, `vertex x y z`")),
        }
    }
    match corners.len() % 3 {
        0 => Ok(corners),
        _ => Err(wrong(text.lines().count(), "the last triangle", "triangle", "three lines `vertex x y z`")),
    }
}

/// Returns the triangles of the cell as an STL text, with unit normals on the side of the face normals. The title is
/// not in it: some readers take the words of a name for those of the format.
pub fn write(sheet: &Sheet) -> String {
    let mut text = "solid foldwell\n".to_owned();
    for triangle in &sheet.triangles {
        let [a, b, c] = triangle.corners.map(|corner| sheet.position(corner));
        // zero is written without a sign
        let normal = (b - a).cross(&(c - a)).normalize().add_scalar(0.0);
        let _ = writeln!(text, "facet normal {:?} {:?} {:?}\n  outer loop", normal.x, normal.y, normal.z);
        for x in [a, b, c] {
            let _ = writeln!(text, "    vertex {:?} {:?} {:?}", x.x, x.y, x.z);
        }
        text.push_str("  endloop\nendfacet\n");
    }
    text.push_str("endsolid foldwell\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::{Pattern, generate};

    /// Claim: the text has a facet for each triangle, whose normal is the unit vector of its corners in their order.
    #[test]
    fn facets() {
        let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
        let text = write(&sheet);
        let numbers =
            |line: &str| -> Vec<f64> { line.split_whitespace().filter_map(|word| word.parse().ok()).collect() };
        let normals: Vec<_> = text.lines().filter(|line| line.starts_with("facet")).map(numbers).collect();
        let vertices: Vec<_> = text.lines().filter(|line| line.contains("vertex")).map(numbers).collect();
        assert_eq!((normals.len(), vertices.len()), (sheet.triangles.len(), 3 * sheet.triangles.len()));
        for (normal, corners) in normals.iter().zip(vertices.chunks(3)) {
            let [a, b, c] = [0, 1, 2].map(|k| Vec3::new(corners[k][0], corners[k][1], corners[k][2]));
            let right = (b - a).cross(&(c - a)).normalize();
            assert!((right - Vec3::new(normal[0], normal[1], normal[2])).norm() < 1e-15);
        }
    }

    /// Claim: a sheet that is written as text, and the same triangles as bytes in single precision, are read with its
    /// vertices and triangles; other bytes are refused. Tolerance: single precision.
    #[test]
    fn text_and_bytes_are_read() {
        let sheet = generate(&Pattern::named("miura-patch").unwrap()).unwrap();
        let text = write(&sheet);
        let again = parse(text.as_bytes(), "a.stl").unwrap();
        assert_eq!((again.vertices.len(), again.triangles.len()), (sheet.vertices.len(), sheet.triangles.len()));
        let mut bytes = vec![b' '; HEADER - 4];
        bytes.extend((sheet.triangles.len() as u32).to_le_bytes());
        for triangle in &sheet.triangles {
            bytes.extend([0; 12]);
            let corners = triangle.corners.map(|corner| sheet.position(corner));
            corners.iter().flat_map(|x| x.iter()).for_each(|x| bytes.extend((*x as f32).to_le_bytes()));
            bytes.extend([0; 2]);
        }
        let single = parse(&bytes, "a.stl").unwrap();
        assert_eq!(single.vertices.len(), sheet.vertices.len());
        for (a, b) in single.vertices.iter().zip(&again.vertices) {
            assert!((a - b).norm() < 1e-6, "{a} {b}");
        }
        let refused = parse(&bytes[..bytes.len() - 1], "a.stl").unwrap_err().to_string();
        assert!(refused.starts_with("a.stl:1:1: ") && refused.contains("is no STL file"), "{refused}");
        let short = parse(b"solid\nvertex 1 2\n", "a.stl").unwrap_err().to_string();
        assert!(short.starts_with("a.stl:2:1: `vertex 1 2` is no corner"), "{short}");
    }
}
