//! A sheet with its boundary conditions and what it is made of: what every study is asked about.

use super::assemble::assemble;
use super::assembly_error::AssemblyError;
use super::boundary::{Boundary, Drawn};
use super::problem::{Gauge, Model};
use super::terms::{RIGID, Terms};
use crate::sheet::{Sheet, Tiling, tile};
use std::sync::Arc;

/// A sheet, its boundary conditions and its terms.
///
/// [`Assembly::patch`] and its siblings begin a [`Builder`](super::Builder); facets are rigid unless it is told otherwise. Clones share the
/// sheet.
///
/// ```
/// use foldwell::{Assembly, Pattern, RIGID, Rest, generate};
///
/// let sheet = generate(&Pattern::named("miura")?)?;
/// let assembly = Assembly::patch(sheet, [3, 3]).bars(RIGID).creases(1.0).rest(Rest::Flat).build()?;
/// assert_eq!(assembly.tiling().positions.len(), 3 * 3 * assembly.sheet().vertices.len());
/// assert!(assembly.terms().has_rigid_facets());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Assembly {
    geometry: Arc<Geometry>,
    drawn: Arc<Drawn>,
    terms: Arc<Terms>,
}

/// The part of an assembly that no terms change.
#[derive(Debug)]
struct Geometry {
    sheet: Sheet,
    tiling: Tiling,
    boundary: Boundary,
    /// Cells that pictures show.
    shown: [usize; 2],
    /// Fold angles of the drawn state.
    angles: Vec<f64>,
}

impl Assembly {
    /// A sheet with boundary conditions and no terms. On a screw, `cells` are those that pictures show; a sheet without
    /// lattice is one cell.
    ///
    /// # Errors
    /// [`AssemblyError::NoLattice`] where a sheet without lattice is to be periodic, and [`AssemblyError::NoCells`].
    pub fn without_terms(sheet: Sheet, cells: [usize; 2], boundary: Boundary) -> Result<Self, AssemblyError> {
        if boundary.is_periodic() && sheet.lattice.is_none() {
            return Err(AssemblyError::NoLattice);
        }
        if cells.contains(&0) {
            return Err(AssemblyError::NoCells);
        }
        let repeated = if boundary == Boundary::Screw { [1, 1] } else { cells };
        let tiling = tile(&sheet, repeated, boundary.is_periodic());
        let drawn = Drawn::new(&sheet, &tiling, boundary, 0.0);
        let angles = drawn.fold_angles(&tiling);
        let geometry = Geometry { sheet, tiling, boundary, shown: cells, angles };
        Ok(Self { geometry: Arc::new(geometry), drawn: Arc::new(drawn), terms: Arc::default() })
    }

    /// The same sheet with other terms, in the same drawn state.
    ///
    /// # Panics
    /// Where rest angles are not one for each edge of the tiling, or a lock, pin or load names what the tiling has not.
    pub fn with_terms(&self, terms: Terms) -> Self {
        let edges = self.edges();
        let rests = [&terms.creases, &terms.facets].into_iter().flatten().map(|hinges| hinges.rest.len());
        assert!(rests.into_iter().all(|count| count == edges), "one rest angle for each of {edges} edges");
        Self { terms: Arc::new(terms), ..self.clone() }
    }

    /// The same sheet with bars of another stiffness `EA`.
    pub fn with_bars(&self, stiffness: f64) -> Self {
        self.with_terms(Terms { bars: Some(stiffness), ..self.terms().clone() })
    }

    /// The same sheet; the axis of a screw makes this angle with the first lattice vector, in radians.
    pub fn with_axis(&self, angle: f64) -> Self {
        let Geometry { sheet, tiling, boundary, .. } = &*self.geometry;
        let drawn = match boundary {
            Boundary::Screw => Arc::new(Drawn::new(sheet, tiling, *boundary, angle)),
            _ => Arc::clone(&self.drawn),
        };
        Self { drawn, ..self.clone() }
    }

    /// The same sheet without what the coordinates of a screw hold against drift: models of it have every rigid motion.
    pub fn with_free_coordinates(&self) -> Self {
        Self { drawn: Arc::new(Drawn { held: vec![], ..Drawn::clone(&self.drawn) }), ..self.clone() }
    }

    /// The cell.
    pub fn sheet(&self) -> &Sheet {
        &self.geometry.sheet
    }

    /// Its copies: one cell of a screw.
    pub fn tiling(&self) -> &Tiling {
        &self.geometry.tiling
    }

    /// The boundary conditions.
    pub fn boundary(&self) -> Boundary {
        self.geometry.boundary
    }

    /// The cells that pictures show: those of the tiling, or as many of a screw as it was given.
    pub fn shown(&self) -> [usize; 2] {
        if self.boundary() == Boundary::Screw { self.geometry.shown } else { self.tiling().cells }
    }

    /// The terms of the energy and the conditions on the sheet.
    pub fn terms(&self) -> &Terms {
        &self.terms
    }

    /// Stiffness `EA` of the bars; infinite where there are none to stretch.
    pub fn bar_stiffness(&self) -> f64 {
        self.terms.bars.unwrap_or(RIGID)
    }

    /// Stiffness of the creases; 1 where they have none.
    pub fn crease_stiffness(&self) -> f64 {
        self.terms.creases.as_ref().map_or(1.0, |creases| creases.stiffness)
    }

    /// The drawn state.
    pub fn drawn(&self) -> &Drawn {
        &self.drawn
    }

    /// Fold angles of the drawn state, one for each edge of the tiling, in radians; NaN where there is no hinge.
    pub fn drawn_angles(&self) -> &[f64] {
        &self.geometry.angles
    }

    /// The same angles, zero where there is no hinge.
    pub fn drawn_angles_or_zero(&self) -> Vec<f64> {
        self.drawn_angles().iter().map(|angle| if angle.is_nan() { 0.0 } else { *angle }).collect()
    }

    /// Fold angles of a state with these coordinates, between -pi and pi, one for each edge of the tiling; NaN where there is
    /// no hinge.
    pub fn fold_angles_at(&self, coordinates: &[f64]) -> Vec<f64> {
        let state = Drawn { coordinates: coordinates.to_vec(), ..Drawn::clone(&self.drawn) };
        state.fold_angles(self.tiling())
    }

    /// Number of edges of the tiling: the length of every list that has a value for each edge.
    pub fn edges(&self) -> usize {
        self.tiling().edges.len()
    }

    /// Mean length of the edges of the tiling.
    pub fn mean_edge(&self) -> f64 {
        self.drawn.mean_edge(self.tiling())
    }

    /// Edges of the tiling that keep their angle: locked ones, and diagonals of polygons where these are rigid.
    pub fn locked_edges(&self) -> Vec<usize> {
        let facets = self.tiling().facets().filter(|_| self.terms.has_rigid_facets());
        self.terms.locks.iter().map(|(edge, _)| *edge).chain(facets).collect()
    }

    /// Diagonals of the polygons of the cell where these are rigid, as numbers of the sheet's edges.
    pub fn rigid_facets_of_cell(&self) -> Vec<usize> {
        let rigid = self.terms.has_rigid_facets();
        self.sheet().facets().filter(|_| rigid).collect()
    }

    /// The model of the bars and hinges, in the drawn state.
    pub fn model(&self, gauge: Gauge) -> Model {
        assemble(&self.drawn, self.tiling(), &self.terms, gauge)
    }
}
