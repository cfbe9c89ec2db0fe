//! Tilings: `n1 x n2` cells of a sheet, as a patch with free edges or as a torus.

use super::cell::{Corner, Edge, EdgeKey, EdgeKind, Sheet, TriangleSide};
use crate::math::Vec3;
use std::collections::HashMap;

/// A vertex of a [`Tiling`], by its number in [`Tiling::positions`], together with the translation of the copy that is
/// meant in superlattice vectors `(n1 l1, n2 l2)`, always `[0, 0]` on a patch.
pub type Site = Corner;

/// An edge of a [`Tiling`], which carries a bar, unless it is a further hinge of an edge, and a hinge if it has both
/// wings.
#[derive(Clone, Debug, PartialEq)]
pub struct TiledEdge {
    /// Number of the cell's edge of which it is a copy.
    pub edge: usize,
    /// Cell of its first vertex `i`.
    pub cell: [usize; 2],
    /// Kind of the edge: that of the cell's edge, but a crease that lacks a wing is a boundary. A diagonal always has
    /// both wings.
    pub kind: EdgeKind,
    /// The ends `i`, `j`.
    pub ends: [Site; 2],
    /// Opposite vertices of the left and the right triangle; `None` if the triangle is missing.
    pub wings: [Option<Site>; 2],
    /// Whether the bar of the edge is here: an edge of more than two faces is listed for each of its hinges.
    pub bar: bool,
}

impl TiledEdge {
    /// Returns the sites of the hinge: the two ends, then the opposite vertices of the left and the right triangle.
    /// `None` if a triangle is missing.
    pub fn hinge(&self) -> Option<[Site; 4]> {
        Some([self.ends[0], self.ends[1], self.wings[0]?, self.wings[1]?])
    }
}

/// A triangle of a [`Tiling`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TiledTriangle {
    /// Number of the cell's triangle of which it is a copy.
    pub triangle: usize,
    /// Translation in cells from the triangle of the sheet; it puts the first corner of the triangle's polygon into
    /// the patch.
    pub cell: [i32; 2],
    /// The corners, counter-clockwise.
    pub corners: [Site; 3],
}

/// `n1 x n2` cells of a sheet.
///
/// **Patch**: exactly `n1 n2 Nv` vertices and no copies. An edge exists if both its vertices do; a polygon exists,
/// with its diagonals and triangles, if all its vertices do; a wing exists if its polygon does. A panel is one polygon:
/// where it does not exist its centre is a vertex without edges. **Torus**: everything exists, and vertices beyond the
/// last cell are copies, translated by superlattice vectors. A finite sheet is a patch of one cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Tiling {
    /// Numbers of cells `[n1, n2]` along the two lattice vectors.
    pub cells: [usize; 2],
    /// Whether the tiling is a torus; otherwise it is a patch.
    pub periodic: bool,
    /// Drawn positions of the vertices; vertex `v` of cell `(c1, c2)` has the number `(c2 n1 + c1) Nv + v`.
    pub positions: Vec<Vec3>,
    /// The edges, cell by cell (`c1` runs faster), in each cell in the order of the sheet.
    pub edges: Vec<TiledEdge>,
    /// The triangles, cell by cell in the same way.
    pub triangles: Vec<TiledTriangle>,
}

/// Makes `cells[0] x cells[1]` cells of `sheet`, joined to a torus if `periodic`. A sheet without lattice gives one
/// cell that is not periodic, whatever the arguments say.
pub fn tile(sheet: &Sheet, cells: [usize; 2], periodic: bool) -> Tiling {
    let finite = !sheet.is_repeated();
    let grid = CellGrid {
        cells: if finite { [1, 1] } else { cells },
        periodic: periodic && !finite,
        vertices: sheet.vertices.len(),
    };
    let (edges, triangles) = if grid.cells.contains(&0) { Default::default() } else { grid.elements(sheet) };
    Tiling { cells: grid.cells, periodic: grid.periodic, positions: grid.positions(sheet), edges, triangles }
}

impl Tiling {
    /// Whether an edge has no face: then vertices hang on the sheet that no fold angle moves.
    pub fn has_bars_alone(&self) -> bool {
        self.edges.iter().any(|edge| edge.wings == [None; 2])
    }

    /// Returns the numbers of the edges that are diagonals of polygons.
    pub fn facets(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.edges.len()).filter(|&edge| self.edges[edge].kind == EdgeKind::Facet)
    }
}

/// The polygon on one side of an edge, with cells counted from that of the edge's first vertex.
struct Flank {
    polygon: usize,
    /// Translation of the polygon when the edge's first vertex is in cell (0, 0).
    frame: [i32; 2],
    opposite: Corner,
}

struct CellGrid {
    cells: [usize; 2],
    periodic: bool,
    vertices: usize,
}

impl CellGrid {
    fn positions(&self, sheet: &Sheet) -> Vec<Vec3> {
        let of_cell = |shift| (0..self.vertices).map(move |vertex| sheet.position(Corner { vertex, shift }));
        self.all_cells().flat_map(of_cell).collect()
    }

    fn all_cells(&self) -> impl Iterator<Item = [i32; 2]> + use<> {
        let [n1, n2] = self.cells.map(|n| n as i32);
        (0..n2).flat_map(move |c2| (0..n1).map(move |c1| [c1, c2]))
    }

    /// Returns the site of a corner that is translated by `cell`; `None` if it is outside a patch.
    fn site(&self, corner: Corner, cell: [i32; 2]) -> Option<Site> {
        let at = corner.translated(cell).shift;
        let n = self.cells.map(|n| n as i32);
        let [in1, in2] = [0, 1].map(|k| at[k].rem_euclid(n[k]) as usize);
        let shift = [0, 1].map(|k| at[k].div_euclid(n[k]));
        let site = Site { vertex: (in2 * self.cells[0] + in1) * self.vertices + corner.vertex, shift };
        (self.periodic || shift == [0, 0]).then_some(site)
    }

    fn exists(&self, polygon: &[Corner], cell: [i32; 2]) -> bool {
        self.periodic || polygon.iter().all(|&c| self.site(c, cell).is_some())
    }

    fn elements(&self, sheet: &Sheet) -> (Vec<TiledEdge>, Vec<TiledTriangle>) {
        let (flanks, outlines) = (&flanks(sheet), &sheet.outlines());
        let edges = self.all_cells().flat_map(|cell| {
            let numbered = sheet.edges.iter().zip(flanks).enumerate();
            numbered.filter_map(move |(e, (edge, flank))| {
                self.edge((sheet, outlines), e, (edge.key, edge.kind), flank, cell)
            })
        });
        let edges = edges.collect();
        let triangles = self.all_cells().flat_map(|cell| {
            let moved = sheet.triangles.iter().enumerate().map(move |(triangle, t)| {
                let first = sheet.polygons[t.polygon][0].shift;
                (triangle, t, [cell[0] - first[0], cell[1] - first[1]])
            });
            let there = moved.filter(|(_, t, frame)| self.exists(&outlines[t.polygon], *frame));
            there.filter_map(|(triangle, t, cell)| {
                let [a, b, c] = t.corners.map(|corner| self.site(corner, cell));
                Some(TiledTriangle { triangle, cell, corners: [a?, b?, c?] })
            })
        });
        (edges, triangles.collect())
    }

    fn edge(
        &self,
        (sheet, outlines): (&Sheet, &[Vec<Corner>]),
        edge: usize,
        (key, kind): (EdgeKey, EdgeKind),
        flanks: &[Option<Flank>; 2],
        cell: [i32; 2],
    ) -> Option<TiledEdge> {
        let [i, j] = key.ends().map(|end| self.site(end, cell));
        let wings = [0, 1].map(|side| {
            let flank = flanks[side].as_ref()?;
            let frame = [cell[0] + flank.frame[0], cell[1] + flank.frame[1]];
            let exists = self.exists(&outlines[flank.polygon], frame);
            if exists { self.site(flank.opposite, cell) } else { None }
        });
        let kind = match (kind, wings) {
            (EdgeKind::Facet, [Some(_), Some(_)]) => EdgeKind::Facet,
            (EdgeKind::Facet, [None, None]) if !sheet.glue.contains_key(&key.whole()) => return None,
            (EdgeKind::Crease, [Some(_), Some(_)]) => EdgeKind::Crease,
            _ if !key.has_bar() => return None,
            _ => EdgeKind::Boundary,
        };
        Some(TiledEdge { edge, cell: cell.map(|c| c as usize), kind, ends: [i?, j?], wings, bar: key.has_bar() })
    }
}

/// Returns the polygons beside every edge: those with the triangles of its wings.
fn flanks(sheet: &Sheet) -> Vec<[Option<Flank>; 2]> {
    let mut at: HashMap<(EdgeKey, Corner), (usize, [i32; 2])> = HashMap::new();
    for triangle in &sheet.triangles {
        for TriangleSide { key, base, opposite, .. } in triangle.sides() {
            at.insert((key, opposite), (triangle.polygon, base.shift.map(|n| -n)));
        }
    }
    let beside = |edge: &Edge, opposite: Corner| {
        let &(polygon, frame) = at.get(&(edge.key.whole(), opposite))?;
        Some(Flank { polygon, frame, opposite })
    };
    sheet.edges.iter().map(|edge| edge.wings.map(|wing| beside(edge, wing?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::fold;

    fn star() -> Sheet {
        fold::parse(include_str!("../../tests/cases/open-star.fold"), "open-star.fold").unwrap()
    }

    fn place(tiling: &Tiling, sheet: &Sheet, site: Site) -> Vec3 {
        let [l1, l2] = sheet.lattice.unwrap();
        let [s1, s2] = [0, 1].map(|k| (site.shift[k] * tiling.cells[k] as i32) as f64);
        tiling.positions[site.vertex] + l1 * s1 + l2 * s2
    }

    /// Claim: on a torus, also of cells narrower than a face, every cell has all its edges and triangles, and each is
    /// a translated copy of the sheet's: ends and wings are where the lattice puts them. Tolerance: sums of a few
    /// vectors of length 10.
    #[test]
    fn torus_is_complete_and_in_place() {
        let sheet = star();
        for cells in [[1, 1], [2, 3], [4, 1]] {
            let tiling = tile(&sheet, cells, true);
            let count = cells[0] * cells[1];
            assert_eq!(
                (tiling.positions.len(), tiling.edges.len(), tiling.triangles.len()),
                (4 * count, 12 * count, 8 * count)
            );
            for edge in &tiling.edges {
                let drawn = &sheet.edges[edge.edge];
                let [i, j] = drawn.key.ends();
                let corners = [i, j, drawn.wings[0].unwrap(), drawn.wings[1].unwrap()];
                let sites = [edge.ends[0], edge.ends[1], edge.wings[0].unwrap(), edge.wings[1].unwrap()];
                for (corner, site) in corners.into_iter().zip(sites) {
                    let there = sheet.position(corner.translated(edge.cell.map(|c| c as i32)));
                    assert!((place(&tiling, &sheet, site) - there).norm() < 1e-13);
                }
            }
            for t in &tiling.triangles {
                for (corner, site) in sheet.triangles[t.triangle].corners.iter().zip(t.corners) {
                    assert!((place(&tiling, &sheet, site) - sheet.position(corner.translated(t.cell))).norm() < 1e-13);
                }
            }
        }
    }

    /// Claim: a patch has the triangles whose corners all exist, an edge has a wing exactly if that triangle exists,
    /// and the patch satisfies V - E + F = 1. Source: Euler's formula of a disc; loose edges at the corners do not
    /// change it.
    #[test]
    fn patch_is_a_disc() {
        let sheet = star();
        for n in [1, 2, 5] {
            let tiling = tile(&sheet, [n, n], false);
            let (v, e, f) = (tiling.positions.len(), tiling.edges.len(), tiling.triangles.len());
            assert_eq!(v + f, e + 1, "{n}");
            let wings = tiling.edges.iter().flat_map(|e| e.wings).flatten().count();
            assert_eq!(wings, 3 * f);
            assert!(tiling.edges.iter().all(|e| (e.kind == EdgeKind::Boundary) == e.wings.contains(&None)));
        }
    }

    /// Claim: a triangle exists only with its whole polygon. Here three corners of each parallelogram are in the
    /// patch and the fourth is not, so that three sides remain as bars and there is no diagonal, no triangle and no
    /// wing.
    #[test]
    fn a_polygon_is_whole_or_absent() {
        let text = r#"{"vertices_coords": [[0, 0, 0], [1, 0, 0], [1.2, 1, 0], [0.2, 1, 0]],
            "faces_vertices": [[0, 1, 2, 3]], "foldwell:lattice": [[1, 0, 0], [-0.8, 1, 0]]}"#;
        let sheet = fold::parse(text, "leaning.fold").unwrap();
        assert_eq!(sheet.edges[2].key.shift, [0, 1]);
        let tiling = tile(&sheet, [2, 2], false);
        assert!(tiling.triangles.is_empty());
        assert_eq!(tiling.edges.len(), 3);
        assert!(tiling.edges.iter().all(|e| e.kind == EdgeKind::Boundary && e.wings == [None, None]));
    }
}
