//! The vertices and edges of a sheet as tables, for the numbers and names that a scene refers to.

use crate::output::table::{Table, Value};
use crate::sheet::{Edge, EdgeKind, Sheet};

/// Returns a table of the vertices of a cell: number and coordinates.
pub(super) fn vertices(sheet: &Sheet) -> Table {
    let mut table = Table::new(["vertex", "x", "y", "z"].map(str::to_owned).to_vec());
    for (number, position) in sheet.vertices.iter().enumerate() {
        let coordinates = [position.x, position.y, position.z].map(Value::Number);
        table.push([Value::Whole(number as i64)].into_iter().chain(coordinates).collect());
    }
    table
}

/// Returns a table of the edges of a cell: number, name `[i, j, n1, n2]`, kind, assignment as a letter of FOLD, length,
/// and drawn fold angle in radians, which is empty for edges of one face.
pub(super) fn edges(sheet: &Sheet) -> Table {
    let header = ["edge", "i", "j", "n1", "n2", "kind", "assignment", "length", "angle"];
    let mut table = Table::new(header.map(str::to_owned).to_vec());
    for (number, edge) in sheet.edges.iter().enumerate() {
        let key = edge.key;
        let [i, j] = [key.i, key.j].map(|vertex| vertex as i64);
        let [n1, n2] = key.shift.map(i64::from);
        let name = [number as i64, i, j, n1, n2].map(Value::Whole);
        let words = [kind(edge), sheet.assignment(edge).letter()].map(Value::Word);
        let [start, end] = key.ends().map(|corner| sheet.position(corner));
        let numbers = [Value::Number((end - start).norm()), sheet.drawn_angle(edge).into()];
        table.push(name.into_iter().chain(words).chain(numbers).collect());
    }
    table
}

fn kind(edge: &Edge) -> &'static str {
    match edge.kind {
        EdgeKind::Crease => "crease",
        EdgeKind::Facet => "facet",
        EdgeKind::Boundary => "boundary",
    }
}
