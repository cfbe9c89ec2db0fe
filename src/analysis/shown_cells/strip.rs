//! Some strands and rows of the cells of a tube, joined at its seam.

use crate::sheet::{Corner, Seam, SeamKept, Sheet, Site, TiledEdge, TiledTriangle, Tiling};

/// Returns `cells[0]` strands and `cells[1]` rows of the cells of a tube: cell `(a, b)` is the cell `a p + b m` of the
/// sheet.
///
/// Everything that begins in these cells is there once. All strands of a closed tube join at the seam; elsewhere,
/// vertices beyond the last cell are copies, translated by the numbers of strands and rows, as on a torus.
pub(super) fn strip(sheet: &Sheet, seam: &Seam, kept: SeamKept, cells: [usize; 2]) -> Tiling {
    let joined = kept.is_closed() && cells[0] == seam.strands() as usize;
    let count = cells.map(|n| n as i32);
    let site = |corner: Corner, [strand, row]: [i32; 2]| {
        let [more, rows] = seam.place(corner.shift);
        let at = [strand + more, row + rows];
        let [a, b] = [0, 1].map(|k| at[k].rem_euclid(count[k]) as usize);
        let shift = [if joined { 0 } else { at[0].div_euclid(count[0]) }, at[1].div_euclid(count[1])];
        Site { vertex: (b * cells[0] + a) * sheet.vertices.len() + corner.vertex, shift }
    };
    let all = || (0..count[1]).flat_map(|row| (0..count[0]).map(move |strand| [strand, row]));
    let edges = all().flat_map(|cell| {
        sheet.edges.iter().enumerate().map(move |(number, edge)| TiledEdge {
            edge: number,
            cell: cell.map(|n| n as usize),
            kind: edge.kind,
            ends: edge.key.ends().map(|end| site(end, cell)),
            wings: edge.wings.map(|wing| wing.map(|corner| site(corner, cell))),
            bar: edge.key.has_bar(),
        })
    });
    let triangles = all().flat_map(|cell| {
        sheet.triangles.iter().enumerate().map(move |(triangle, t)| TiledTriangle {
            triangle,
            cell,
            corners: t.corners.map(|corner| site(corner, cell)),
        })
    });
    let positions = all().flat_map(|[strand, row]| {
        let shift = seam.cell(strand, row);
        (0..sheet.vertices.len()).map(move |vertex| sheet.position(Corner { vertex, shift }))
    });
    Tiling {
        cells,
        periodic: true,
        positions: positions.collect(),
        edges: edges.collect(),
        triangles: triangles.collect(),
    }
}
