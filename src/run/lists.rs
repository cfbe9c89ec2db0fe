//! The vertices and edges of a sheet as tables, for the numbers and names that a scene refers to.

use crate::output::table::{Table, Value};
use crate::sheet::{Edge, EdgeKind, Sheet};

/// Returns a table of the vertices of a cell: number and coordinates.
pub(super) fn vertices(sheet: &Sheet) -> Table {
    let mut table = Table::new("vertex,x,y,z");
    for (number, position) in sheet.vertices.iter().enumerate() {
        table.push([number.into(), position.x.into(), position.y.into(), position.z.into()]);
    }
    table
}

/// Returns a table of the edges of a cell: number, name `[i, j, n1, n2]`, kind, assignment as a letter of FOLD, length,
/// and drawn fold angle in radians, which is empty for edges of one face.
pub(super) fn edges(sheet: &Sheet) -> Table {
    let mut table = Table::new("edge,i,j,n1,n2,kind,assignment,length,angle");
    for (number, edge) in sheet.edges.iter().enumerate() {
        let key = edge.key;
        let place =
            [number, key.i, key.j].map(Value::from).into_iter().chain(key.shift.map(i64::from).map(Value::from));
        let words = [kind(edge), sheet.assignment(edge).letter()].map(Value::Word);
        let [start, end] = key.ends().map(|corner| sheet.position(corner));
        let numbers = [Value::Number((end - start).norm()), sheet.drawn_angle(edge).into()];
        table.push(place.chain(words).chain(numbers));
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
