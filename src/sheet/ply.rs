//! PLY files: the vertices and faces of a sheet as text, for programs that show and measure meshes.
//!
//! Polygons stay whole. PLY has no letters, angles or lattice vectors, and is only written (G. Turk, "The PLY polygon
//! file format", 1994).

use std::fmt::Write;

use super::build::draw;
use super::cell::Sheet;

/// Returns the faces of the cell as a PLY text.
pub fn write(sheet: &Sheet) -> String {
    let drawn = draw(sheet);
    let mut text = format!(
        "ply\nformat ascii 1.0\ncomment foldwell\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {}\nproperty list uint int vertex_indices\nend_header\n",
        drawn.coords.len(),
        drawn.faces.len()
    );
    for x in &drawn.coords {
        let _ = writeln!(text, "{:?} {:?} {:?}", x.x, x.y, x.z);
    }
    for face in &drawn.faces {
        let numbers: Vec<String> = face.iter().map(usize::to_string).collect();
        let _ = writeln!(text, "{} {}", face.len(), numbers.join(" "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::{Pattern, generate};

    /// Claim: the header counts the lines that follow, and every face names vertices that are there.
    #[test]
    fn counts_and_indices() {
        let sheet = generate(&Pattern::named("miura-patch").unwrap()).unwrap();
        let text = write(&sheet);
        let (header, body) = text.split_once("end_header\n").unwrap();
        let [vertices, faces] = [sheet.vertices.len(), sheet.polygons.len()];
        assert!(header.contains(&format!("element vertex {vertices}\n")));
        assert!(header.contains(&format!("element face {faces}\n")));
        let rows: Vec<Vec<f64>> =
            body.lines().map(|row| row.split(' ').map(|word| word.parse().unwrap()).collect()).collect();
        assert_eq!(rows.len(), vertices + faces);
        for (row, x) in rows.iter().zip(&sheet.vertices) {
            assert_eq!(row[..], [x.x, x.y, x.z]);
        }
        for row in &rows[vertices..] {
            assert_eq!(row.len(), 1 + row[0] as usize);
            assert!(row[1..].iter().all(|&v| (v as usize) < vertices), "{row:?}");
        }
    }
}
