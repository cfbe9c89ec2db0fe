//! Which copies of the cell a picture shows, and where they are in a state.

mod strip;

use crate::math::Vec3;
use crate::model::{Assembly, Domain, Drawn, Site};
use crate::sheet::sides::sorted;
use crate::sheet::tiling::{TiledEdge, TiledTriangle};
use crate::sheet::{Assignment, EdgeKind, Sheet, Tiling, tile};
use std::collections::HashMap;
use strip::strip;

/// The cells on which a state is shown: a patch, one period of a torus, some cells of a screw, some rows of a tube.
///
/// Every edge and every triangle of the cells is there once. Those of a torus or a screw that reach beyond the last
/// cell end at images, which are points like others and stand after the vertices of the cells; a patch has none.
pub struct ShownCells {
    /// The cells shown, with their elements.
    pub patch: Tiling,
    /// Points at the corners of each triangle of the patch.
    pub triangles: Vec<[usize; 3]>,
    /// Points at the ends of each edge of the patch: beside a triangle that has it, wherever that is.
    pub lines: Vec<[usize; 2]>,
    /// The triangles on the sides of each edge of the patch, also where they are drawn at another image of it.
    pub beside: Vec<Vec<usize>>,
    /// Edge of the model's tiling of which each line of the patch is a copy.
    pub edges: Vec<usize>,
    /// Letter of each edge of the patch; a crease at the rim, which lacks a face, is a boundary.
    pub letters: Vec<Assignment>,
    /// Vertex of the sheet's cell, and the cell counted from the first one shown, at each point.
    pub places: Vec<(usize, [i32; 2])>,
    /// Vertex of the model, and the copy of it, at each point.
    sites: Vec<Site>,
}

/// Two ends up to translation: vertices, and how many periods the second is further than the first.
type Ends = (usize, usize, [i32; 2]);

/// The ends up to translation, the same in both directions, and where the first of them is.
fn up_to_translation([a, b]: [Site; 2]) -> (Ends, [i32; 2]) {
    let from = |a: Site, b: Site| ((a.vertex, b.vertex, [0, 1].map(|k| b.shift[k] - a.shift[k])), a.shift);
    from(a, b).min(from(b, a))
}

/// The sides of triangles: which triangles they belong to, and at which image.
fn sides(patch: &Tiling) -> HashMap<Ends, Vec<(usize, [i32; 2])>> {
    let mut sides: HashMap<Ends, Vec<(usize, [i32; 2])>> = HashMap::new();
    for (triangle, TiledTriangle { corners: [a, b, c], .. }) in patch.triangles.iter().enumerate() {
        for ends in [[*a, *b], [*b, *c], [*c, *a]] {
            let (ends, at) = up_to_translation(ends);
            sides.entry(ends).or_default().push((triangle, at));
        }
    }
    sides
}

/// The image of an edge that lies beside a triangle which is drawn: where the edge is, if there is one there.
fn beside_a_triangle(ends: [Site; 2], sides: &[(usize, [i32; 2])]) -> [Site; 2] {
    let (_, at) = up_to_translation(ends);
    let moves = sides.iter().map(|(_, there)| [there[0] - at[0], there[1] - at[1]]);
    let by = moves.min_by_key(|by| (*by != [0, 0], *by)).unwrap_or([0, 0]);
    ends.map(|site| Site { shift: [0, 1].map(|k| site.shift[k] + by[k]), ..site })
}

impl ShownCells {
    /// The view of the cells that pictures of an assembly show.
    pub fn new(assembly: &Assembly) -> Self {
        let (sheet, cells) = (assembly.sheet(), assembly.shown());
        match assembly.domain() {
            Domain::Tube { seam, kept, .. } => {
                let basis = seam.basis();
                Self::of_patch(sheet, assembly.tiling(), strip(sheet, seam, *kept, cells), ([0, 0], basis))
            }
            _ => Self::of_cells(sheet, assembly.tiling(), cells, [0, 0]),
        }
    }

    /// The view of `cells`, beginning at the cell `first` of a tiling; a periodic one goes on beyond its last cell.
    pub(crate) fn of_cells(sheet: &Sheet, tiling: &Tiling, cells: [usize; 2], first: [i32; 2]) -> Self {
        Self::of_patch(sheet, tiling, tile(sheet, cells, tiling.periodic), (first, [[1, 0], [0, 1]]))
    }

    /// The view of the cells of a patch, which begins at the cell `first` of a tiling and whose cells `(a, b)` are the
    /// cells `first + a p + b m` of the sheet, with the basis `p`, `m`.
    fn of_patch(sheet: &Sheet, tiling: &Tiling, patch: Tiling, (first, basis): ([i32; 2], [[i32; 2]; 2])) -> Self {
        let sides = sides(&patch);
        let beside = |ends: [Site; 2]| sides.get(&up_to_translation(ends).0).map_or(&[][..], Vec::as_slice);
        let placed: Vec<[Site; 2]> =
            patch.edges.iter().map(|edge| beside_a_triangle(edge.ends, beside(edge.ends))).collect();
        let (images, point) = images(&patch, &placed);
        let (vertices, across) = (sheet.vertices.len(), patch.cells[0]);
        let home = (0..patch.positions.len()).map(|vertex| Site { vertex, shift: [0, 0] });
        let place = |site: Site| {
            let (vertex, cell) = (site.vertex % vertices, site.vertex / vertices);
            let cell = [cell % across, cell / across];
            (vertex, [0, 1].map(|k| cell[k] as i32 + site.shift[k] * patch.cells[k] as i32))
        };
        let places: Vec<(usize, [i32; 2])> = home.chain(images).map(place).collect();
        let number: HashMap<(usize, [usize; 2]), usize> =
            tiling.edges.iter().enumerate().map(|(k, edge)| ((edge.edge, edge.cell), k)).collect();
        let [p, m] = basis;
        let of_sheet = |[a, b]: [i32; 2]| [0, 1].map(|k| a * p[k] + b * m[k]);
        let edge = |e: &TiledEdge| number[&(e.edge, in_tiling(tiling, first, of_sheet(e.cell.map(|c| c as i32))).0)];
        let site = |&(vertex, cell): &(usize, [i32; 2])| {
            let ([c1, c2], shift) = in_tiling(tiling, first, of_sheet(cell));
            Site { vertex: (c2 * tiling.cells[0] + c1) * vertices + vertex, shift }
        };
        Self {
            triangles: patch.triangles.iter().map(|t| t.corners.map(&point)).collect(),
            lines: placed.iter().map(|ends| ends.map(&point)).collect(),
            beside: patch.edges.iter().map(|e| beside(e.ends).iter().map(|(face, _)| *face).collect()).collect(),
            edges: patch.edges.iter().map(edge).collect(),
            letters: letters(sheet, &patch),
            sites: places.iter().map(site).collect(),
            places,
            patch,
        }
    }

    /// Positions of all points in the frame of the mesh file, vertex 0 of a screw where it was drawn.
    pub(crate) fn positions(&self, drawn: &Drawn, coordinates: &[f64]) -> Vec<Vec3> {
        let back = drawn.frame.transpose();
        let centre = match drawn.domain {
            Domain::Screw => Vec3::from_column_slice(&coordinates[..3]),
            _ => Vec3::zeros(),
        };
        self.sites.iter().map(|&site| back * (drawn.domain.point(coordinates, site) - centre) + drawn.origin).collect()
    }

    /// Velocities of all points when the coordinates, which have these values, have these rates; by central
    /// differences.
    pub(crate) fn velocities(&self, drawn: &Drawn, coordinates: &[f64], rates: &[f64]) -> Vec<Vec3> {
        let step = 1e-5;
        let moved = |sign: f64| {
            let x: Vec<f64> = coordinates.iter().zip(rates).map(|(x, v)| x + sign * step * v).collect();
            self.positions(drawn, &x)
        };
        moved(1.0).iter().zip(moved(-1.0)).map(|(a, b)| (a - b) / (2.0 * step)).collect()
    }

    /// Values of the edges of the model from values of lines between the points of the patch; NaN where no line is a
    /// copy of the edge.
    pub(crate) fn on_edges(&self, edges: usize, lines: &[[usize; 2]], values: &[f64]) -> Vec<f64> {
        let given: HashMap<[usize; 2], f64> =
            lines.iter().map(|line| sorted(*line)).zip(values.iter().copied()).collect();
        let mut found = vec![f64::NAN; edges];
        for (line, &edge) in self.lines.iter().zip(&self.edges) {
            if let Some(value) = given.get(&sorted(*line)) {
                found[edge] = *value;
            }
        }
        found
    }

    /// The coordinates of a state whose points are these; `None` where points do not say all (a free lattice, a screw)
    /// or their number is another one. Images may be left out.
    pub(crate) fn coordinates(&self, drawn: &Drawn, points: &[Vec3]) -> Option<Vec<f64>> {
        let home = self.patch.positions.len();
        let fits = drawn.domain.is_fixed_translation() && [home, self.sites.len()].contains(&points.len());
        let place = |p: &Vec3| <[f64; 3]>::from(p - drawn.origin);
        fits.then(|| points[..home].iter().flat_map(place).collect())
    }
}

/// The letter of each edge of the patch.
fn letters(sheet: &Sheet, patch: &Tiling) -> Vec<Assignment> {
    let of_cell: Vec<Assignment> = sheet.edges.iter().map(|edge| sheet.assignment(edge)).collect();
    let letter = |tiled: &TiledEdge| match (tiled.kind, of_cell[tiled.edge]) {
        (EdgeKind::Boundary, Assignment::Cut) => Assignment::Cut,
        (EdgeKind::Boundary, _) => Assignment::Boundary,
        (_, letter) => letter,
    };
    patch.edges.iter().map(letter).collect()
}

/// The images that elements end at, in a fixed order, and the number of the point at a site.
fn images(patch: &Tiling, lines: &[[Site; 2]]) -> (Vec<Site>, impl Fn(Site) -> usize + use<>) {
    let corners = patch.triangles.iter().flat_map(|t| t.corners);
    let used = corners.chain(lines.iter().flatten().copied());
    let mut images: Vec<Site> = used.filter(|site| site.shift != [0, 0]).collect();
    images.sort_unstable_by_key(|site| (site.shift, site.vertex));
    images.dedup();
    let home = patch.positions.len();
    let numbers: HashMap<Site, usize> = images.iter().enumerate().map(|(k, site)| (*site, home + k)).collect();
    (images, move |site| numbers.get(&site).copied().unwrap_or(site.vertex))
}

/// The cell of the tiling that a cell is, counted from `first`, and the copy of it.
fn in_tiling(tiling: &Tiling, first: [i32; 2], cell: [i32; 2]) -> ([usize; 2], [i32; 2]) {
    let (at, period) = ([0, 1].map(|k| cell[k] + first[k]), tiling.cells.map(|n| n as i32));
    ([0, 1].map(|k| at[k].rem_euclid(period[k]) as usize), [0, 1].map(|k| at[k].div_euclid(period[k])))
}
