//! The mass of a sheet, concentrated at its vertices.
//!
//! Motions of the vertices with velocities `v` have the kinetic energy `sum m |v|^2 / 2`: the mass matrix is diagonal
//! (lumped). A mass per area is shared out by triangles, a third of each to each corner; the sum is the mass of the
//! sheet exactly, and its centre is that of the sheet. Source: T. J. R. Hughes, The Finite Element
//! Method (1987), chapter 7, lumped mass matrices by nodal quadrature, here of linear triangles.

use super::boundary::Drawn;
use crate::math::Vec3;
use crate::sheet::tiling::{Site, Tiling};
use crate::sheet::{Corner, Sheet};

/// The mass of a sheet, which it has in every state.
///
/// ```
/// use foldwell::model::Mass;
/// use foldwell::{Assembly, Pattern, generate};
///
/// let sheet = generate(&Pattern::named("miura")?)?;
/// let assembly = Assembly::patch(sheet, [2, 2]).mass(Mass::Vertex(0.5)).build()?;
/// assert_eq!(assembly.masses(), Some(vec![0.5; assembly.tiling().positions.len()]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mass {
    /// This mass at every vertex that is on an edge.
    Vertex(f64),
    /// This mass per area: every triangle of the drawn state gives a third of its mass to each corner. A vertex without
    /// triangles has none.
    Area(f64),
}

impl Mass {
    /// Returns the number that was given: a mass, or a mass per area.
    pub(super) fn amount(self) -> f64 {
        let (Self::Vertex(amount) | Self::Area(amount)) = self;
        amount
    }

    /// Returns the mass at every vertex of a cell of a periodic sheet, or of a finite sheet.
    pub fn of_cell(self, sheet: &Sheet) -> Vec<f64> {
        let triangles = sheet.triangles.iter().map(|triangle| triangle.corners);
        let point = |corner: Corner| sheet.position(corner);
        self.lumped(
            sheet.vertices.len(),
            triangles.map(|corners| (corners.map(|corner| corner.vertex), corners.map(point))),
        )
    }

    /// Returns the mass at every vertex of a tiling.
    pub(super) fn of_tiling(self, drawn: &Drawn, tiling: &Tiling) -> Vec<f64> {
        let triangles = tiling.triangles.iter().map(|triangle| triangle.corners);
        let point = |site: Site| drawn.domain.point(&drawn.coordinates, site);
        let count = tiling.positions.len();
        let masses = self.lumped(count, triangles.map(|sites| (sites.map(|site| site.vertex), sites.map(point))));
        // the centre of a polygon that reaches over the rim of a patch is on no edge: the patch has lost it
        let mut has_edges = vec![false; count];
        tiling.edges.iter().flat_map(|edge| edge.ends).for_each(|site| has_edges[site.vertex] = true);
        masses.into_iter().zip(has_edges).map(|(mass, has_edges)| if has_edges { mass } else { 0.0 }).collect()
    }

    /// Returns the mass at every vertex, given the vertices of the triangles and their places.
    fn lumped(self, vertices: usize, triangles: impl Iterator<Item = ([usize; 3], [Vec3; 3])>) -> Vec<f64> {
        let density = match self {
            Self::Vertex(mass) => return vec![mass; vertices],
            Self::Area(density) => density,
        };
        let mut masses = vec![0.0; vertices];
        for (corners, [a, b, c]) in triangles {
            let area = 0.5 * (b - a).cross(&(c - a)).norm();
            corners.into_iter().for_each(|vertex| masses[vertex] += density * area / 3.0);
        }
        masses
    }
}
