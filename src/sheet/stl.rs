//! STL files: the triangles of a sheet as text, for programs that show, slice and print them.
//!
//! STL has no shared vertices, letters or lattice vectors, and is only written.

use std::fmt::Write;

use super::cell::Sheet;

/// Returns the triangles of the cell as an STL text, with unit normals on the side of the face normals.
pub fn write(sheet: &Sheet) -> String {
    let name = sheet.title.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut text = format!("solid {name}\n");
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
    let _ = writeln!(text, "endsolid {name}");
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
            let [a, b, c] = [0, 1, 2].map(|k| crate::math::Vec3::new(corners[k][0], corners[k][1], corners[k][2]));
            let right = (b - a).cross(&(c - a)).normalize();
            assert!((right - crate::math::Vec3::new(normal[0], normal[1], normal[2])).norm() < 1e-15);
        }
    }
}
