//! The assembly: a sheet with its boundary conditions and terms, the input of every study.

use super::assemble::assemble;
use super::assembly_error::AssemblyError;
use super::boundary::{Boundary, Drawn};
use super::domain::{Domain, OwnDomain};
use super::own_term::OwnTerm;
use super::problem::{Gauge, Model};
use super::roll::Roll;
use super::stiffness::Stiffness;
use super::terms::{Hinges, RIGID, RestLengths, Terms};
use crate::sheet::cell::is_folded_flat;
use crate::sheet::{EdgeKind, Sheet, TiledEdge, Tiling, tile};
use std::collections::HashSet;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Largest change of a rest length from the drawn length, relative to it, that counts as rounding.
const SAME_LENGTH: f64 = 1e-12;
/// Largest difference of a rest angle from the drawn angle, in radians, that counts as rounding.
const SAME_ANGLE_RAD: f64 = 1e-9;

/// A sheet with its boundary conditions and terms.
///
/// [`Assembly::patch`], [`Assembly::torus`], [`Assembly::fixed_torus`] and [`Assembly::screw`] begin a
/// [`Builder`](super::Builder); facets are rigid unless [`Builder::facets`](super::Builder::facets) gives them a
/// stiffness. Clones share the sheet.
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

/// The sheet and its tiling, which do not depend on the terms.
#[derive(Clone, Debug)]
struct Geometry {
    sheet: Sheet,
    tiling: Tiling,
    /// Numbers of cells along the two lattice vectors that pictures show.
    shown: [usize; 2],
    /// Fold angles of the drawn state, one for each edge of the tiling, in radians; NaN where there is no hinge.
    angles: Vec<f64>,
    /// Those of the start, which is another state on a tube.
    start_angles: Vec<f64>,
}

impl Assembly {
    /// Makes an assembly of a sheet with boundary conditions and no terms. `cells` counts the cells along the two
    /// lattice vectors: those of the tiling, or, for screw boundary conditions, those that pictures show. A sheet
    /// without lattice has one cell, whatever `cells` says.
    ///
    /// # Errors
    /// [`AssemblyError::NoLattice`] for periodic boundary conditions on a sheet without lattice,
    /// [`AssemblyError::DrawnAsTube`] for them on a cell that screw motions repeat, and
    /// [`AssemblyError::NoCells`] if a number of cells is zero.
    pub fn without_terms(sheet: Sheet, cells: [usize; 2], boundary: Boundary) -> Result<Self, AssemblyError> {
        let periodic = boundary != Boundary::Patch;
        if periodic && sheet.lattice.is_none() {
            let drawn_as_tube = sheet.screws.is_some();
            return Err(if drawn_as_tube { AssemblyError::DrawnAsTube } else { AssemblyError::NoLattice });
        }
        if cells.contains(&0) {
            return Err(AssemblyError::NoCells);
        }
        let repeated = if boundary == Boundary::Screw { [1, 1] } else { cells };
        let tiling = tile(&sheet, repeated, periodic);
        let drawn = Drawn::new(&sheet, &tiling, boundary, 0.0);
        let angles = on_sides_of_sheet(drawn.fold_angles(&tiling), &sheet, &tiling);
        let start_angles = angles.clone();
        Ok(Self::of(Geometry { sheet, tiling, shown: cells, angles, start_angles }, drawn))
    }

    fn of(geometry: Geometry, drawn: Drawn) -> Self {
        Self { geometry: Arc::new(geometry), drawn: Arc::new(drawn), terms: Arc::default() }
    }

    /// Makes an assembly of a tube that was [rolled up](Roll) or is drawn as one, without terms. `cells` counts the
    /// strands and the rows of cells that pictures show.
    ///
    /// # Errors
    /// [`AssemblyError::NoLattice`] for a sheet without lattice, and [`AssemblyError::NoCells`] if a number of cells is
    /// zero.
    pub fn tube_without_terms(sheet: Sheet, roll: &Roll, cells: [usize; 2]) -> Result<Self, AssemblyError> {
        let (tiling, drawn) = (one_cell(&sheet, cells)?, roll.drawn(&sheet));
        let of_file = |tiled: &TiledEdge| sheet.drawn_angle(&sheet.edges[tiled.edge]).unwrap_or(f64::NAN);
        let angles = tiling.edges.iter().map(of_file).collect();
        let start_angles = tiling.edges.iter().map(|tiled| roll.angles[tiled.edge]).collect();
        Ok(Self::of(Geometry { sheet, tiling, shown: cells, angles, start_angles }, drawn))
    }

    /// Makes an assembly of one cell on a domain of one's own, without terms. The drawn state has these coordinates: x,
    /// y and z of every vertex of the cell, then the shared ones. `cells` counts the cells that pictures show.
    pub(crate) fn own_without_terms(
        sheet: Sheet,
        (domain, coordinates): (OwnDomain, Vec<f64>),
        cells: [usize; 2],
    ) -> Result<Self, AssemblyError> {
        let (tiling, drawn) = (one_cell(&sheet, cells)?, Drawn::of(Domain::Own(domain), coordinates));
        let needed = 3 * sheet.vertices.len() + drawn.domain.shared();
        if drawn.coordinates.len() != needed {
            let given = drawn.coordinates.len();
            return Err(AssemblyError::Coordinates { given, needed });
        }
        let angles = drawn.fold_angles(&tiling);
        let start_angles = angles.clone();
        Ok(Self::of(Geometry { sheet, tiling, shown: cells, angles, start_angles }, drawn))
    }

    /// Returns the same sheet with other terms, in the same drawn state. Stiffnesses that are given for each edge and
    /// are equal on all elements of their term become one number.
    ///
    /// # Panics
    /// If stiffnesses, rest lengths or rest angles that are given for each edge are not one for each edge of the
    /// tiling. A lock, pin or load whose edge or vertex number is outside the tiling panics later, when the model is
    /// built.
    pub fn with_terms(&self, mut terms: Terms) -> Self {
        let (edges, tiling) = (self.edges(), self.tiling());
        let at_elements = |stiffness: &Stiffness, kind: Option<EdgeKind>| {
            if let Stiffness::PerEdge(each) = stiffness {
                assert!(each.len() == edges, "one stiffness for each of {edges} edges");
            }
            stiffness.at_elements(|edge| kind.is_none_or(|kind| tiling.edges[edge].kind == kind))
        };
        for (hinges, kind) in [(&mut terms.creases, EdgeKind::Crease), (&mut terms.facets, EdgeKind::Facet)] {
            if let Some(hinges) = hinges {
                assert!(hinges.rest.len() == edges, "one rest angle for each of {edges} edges");
                hinges.stiffness = at_elements(&hinges.stiffness, Some(kind));
            }
        }
        if let Some(bars) = &mut terms.bars {
            let lengths = if let RestLengths::PerEdge(lengths) = &bars.rest { lengths.len() } else { edges };
            assert!(lengths == edges, "one rest length for each of {edges} edges");
            bars.stiffness = at_elements(&bars.stiffness, None);
        }
        Self { terms: Arc::new(terms), ..self.clone() }
    }

    /// Returns the same assembly with no bar stiffer than this; see [`Terms::with_bars_at_most`].
    pub fn with_bars_at_most(&self, stiffness: f64) -> Self {
        self.with_terms(self.terms().with_bars_at_most(stiffness))
    }

    /// Returns the same assembly with a term of one's own beside the others.
    pub fn with_own_term(&self, term: OwnTerm) -> Self {
        let mut terms = self.terms().clone();
        terms.own.push(term);
        self.with_terms(terms)
    }

    /// Returns the same assembly with the axis of its screw motions at `angle` (radians) from the first lattice
    /// vector. Other boundary conditions have no axis and are returned unchanged.
    pub fn with_axis(&self, angle: f64) -> Self {
        if *self.domain() != Domain::Screw {
            return self.clone();
        }
        self.with_drawn(Drawn::new(self.sheet(), self.tiling(), Boundary::Screw, angle))
    }

    /// Returns the same assembly in another drawn state, with its domain.
    pub fn with_drawn(&self, drawn: Drawn) -> Self {
        Self { drawn: Arc::new(drawn), ..self.clone() }
    }

    /// Returns the cell of the sheet.
    pub fn sheet(&self) -> &Sheet {
        &self.geometry.sheet
    }

    /// Returns the tiling, the copies of the cell; with screw boundary conditions it has one cell.
    pub fn tiling(&self) -> &Tiling {
        &self.geometry.tiling
    }

    /// Returns the domain: the boundary conditions, and where points come from.
    pub fn domain(&self) -> &Domain {
        &self.drawn.domain
    }

    /// Returns the numbers of cells that pictures show along the two lattice vectors: those of the tiling, or, for
    /// screw boundary conditions and tubes, those given to the builder; of a tube strands and rows of cells.
    pub fn shown(&self) -> [usize; 2] {
        if self.domain().is_one_cell() { self.geometry.shown } else { self.tiling().cells }
    }

    /// Returns the terms: stiffnesses and rest angles, locks, pins, loads and mass.
    pub fn terms(&self) -> &Terms {
        &self.terms
    }

    /// Returns the stiffness `EA` of the bars, of the stiffest one if they differ; infinite if the assembly has no
    /// bars.
    pub fn bar_stiffness(&self) -> f64 {
        self.terms.bar_stiffness().map_or(RIGID, Stiffness::stiffest)
    }

    /// Returns the stiffness of the creases that are not rigid, torque per radian and length, the median one if they
    /// differ; 1 if the assembly has no crease energy.
    pub fn crease_stiffness(&self) -> f64 {
        self.terms.creases.as_ref().map_or(1.0, |creases| creases.stiffness.median())
    }

    /// Whether all bars are at rest at their drawn lengths, up to rounding; also true if there are none.
    pub fn has_drawn_lengths(&self) -> bool {
        self.bars_off_rest() == 0
    }

    /// Returns the number of bars whose rest lengths are not the drawn ones.
    pub fn bars_off_rest(&self) -> usize {
        let Some(bars) = &self.terms.bars else { return 0 };
        let bars_there = self.tiling().edges.iter().enumerate().filter(|(_, edge)| edge.bar);
        let drawn = bars_there.map(|(number, edge)| (number, self.drawn.distance(&edge.ends)));
        drawn.filter(|&(edge, length)| !((bars.rest.of(edge, length) / length - 1.0).abs() <= SAME_LENGTH)).count()
    }

    /// Returns the number of an edge with a rigid crease or facet whose rest angle is not that of the state from which
    /// studies start; `None` if there is none. Locks are not looked at.
    pub fn rigid_hinge_off_rest(&self) -> Option<usize> {
        let off = |&(edge, angle): &(usize, f64)| (angle - self.start_angles()[edge]).abs() > SAME_ANGLE_RAD;
        self.rigid_creases_beside_soft().chain(self.rigid_facets()).find(off).map(|(edge, _)| edge)
    }

    /// Returns edge and rest angle of the rigid creases, if there are soft creases too.
    fn rigid_creases_beside_soft(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let creases = self.terms.creases.as_ref().filter(|creases| creases.stiffness.uniform().is_none());
        self.rigid(creases, EdgeKind::Crease)
    }

    /// Returns edge and rest angle of the rigid facets.
    fn rigid_facets(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.rigid(self.terms.facets.as_ref(), EdgeKind::Facet)
    }

    fn rigid<'a>(&'a self, hinges: Option<&'a Hinges>, kind: EdgeKind) -> impl Iterator<Item = (usize, f64)> + use<'a> {
        let edges = self.tiling().edges.iter().enumerate().filter(move |(_, edge)| edge.kind == kind);
        hinges.into_iter().flat_map(move |hinges| {
            let rigid = edges.clone().filter(|(edge, _)| hinges.stiffness.of(*edge).is_infinite());
            rigid.map(|(edge, _)| (edge, hinges.rest[edge]))
        })
    }

    /// Returns the drawn state.
    pub fn drawn(&self) -> &Drawn {
        &self.drawn
    }

    /// Returns the fold angles of the drawn state, one for each edge of the tiling, in radians; NaN where there is no
    /// hinge.
    pub fn drawn_angles(&self) -> &[f64] {
        &self.geometry.angles
    }

    /// Returns the fold angles of the sheet folded flat by its letters, one for each edge of the tiling, in radians:
    /// -pi for mountains, pi for valleys and 0 for all others.
    pub fn assigned_angles(&self) -> Vec<f64> {
        let sheet = self.sheet();
        let letters: Vec<_> = sheet.edges.iter().map(|edge| sheet.assignment(edge)).collect();
        let edges = self.tiling().edges.iter();
        edges.map(|tiled| letters[tiled.edge].flat_folded_angle().unwrap_or(0.0)).collect()
    }

    /// Returns this part of the target angles of the file, one for each edge of the tiling, in radians; the drawn angle
    /// of an edge for which it gives none.
    pub fn target_angles(&self, part: f64) -> Vec<f64> {
        let target = |edge: usize| self.sheet().targets.get(&self.sheet().edges[edge].key);
        let edges = self.tiling().edges.iter().zip(self.drawn_angles());
        edges.map(|(tiled, drawn)| target(tiled.edge).map_or(*drawn, |angle| part * angle)).collect()
    }

    /// Returns the fold angles of the state from which studies start, in the same way: the drawn ones, or those of the
    /// sheet rolled up to a tube.
    pub fn start_angles(&self) -> &[f64] {
        &self.geometry.start_angles
    }

    /// Returns [`Assembly::drawn_angles`] with zero where there is no hinge.
    pub fn drawn_angles_or_zero(&self) -> Vec<f64> {
        self.drawn_angles().iter().map(|angle| if angle.is_nan() { 0.0 } else { *angle }).collect()
    }

    /// Returns the fold angles of the state with these coordinates, in `[-pi, pi]`, one for each edge of the tiling;
    /// NaN where there is no hinge.
    pub fn fold_angles_at(&self, coordinates: &[f64]) -> Vec<f64> {
        let state = Drawn { coordinates: coordinates.to_vec(), ..Drawn::clone(&self.drawn) };
        state.fold_angles(self.tiling())
    }

    /// Returns the number of edges of the tiling, which is the length of every list with one value for each edge.
    pub fn edges(&self) -> usize {
        self.tiling().edges.len()
    }

    /// Returns the mean length of the edges of the tiling.
    pub fn mean_edge(&self) -> f64 {
        self.drawn.mean_edge(self.tiling())
    }

    /// Returns the numbers of the edges of the tiling whose fold angle is kept: locked edges, rigid creases beside soft
    /// ones, and the diagonals of rigid polygons.
    pub fn locked_edges(&self) -> Vec<usize> {
        let rigid = self.rigid_creases_beside_soft().chain(self.rigid_facets());
        let locks = self.terms.locks.iter().map(|(edge, _)| *edge);
        locks.chain(rigid.map(|(edge, _)| edge)).collect()
    }

    /// Returns the numbers of the edges of the tiling that are rigid diagonals of polygons.
    pub fn rigid_facet_edges(&self) -> Vec<usize> {
        self.rigid_facets().map(|(edge, _)| edge).collect()
    }

    /// Returns the numbers of the sheet's edges that are rigid diagonals of polygons in every cell.
    pub fn rigid_facets_of_cell(&self) -> Vec<usize> {
        let Some(facets) = &self.terms.facets else { return vec![] };
        let tiled = self.tiling().edges.iter().enumerate();
        let soft: HashSet<usize> =
            tiled.filter(|(k, _)| facets.stiffness.of(*k).is_finite()).map(|(_, edge)| edge.edge).collect();
        self.sheet().facets().filter(|edge| !soft.contains(edge)).collect()
    }

    /// Returns the mass at every vertex of the tiling; `None` if the sheet has no mass.
    pub fn masses(&self) -> Option<Vec<f64>> {
        Some(self.terms.mass?.of_tiling(&self.drawn, self.tiling()))
    }

    /// Builds the model of the bars and hinges, in the drawn state.
    pub fn model(&self, gauge: Gauge) -> Model {
        let mut model = assemble(&self.drawn, self.tiling(), &self.terms, gauge);
        model.continue_from(self.start_angles());
        model
    }
}

/// Returns the tiling of one cell of a sheet that is repeated, of which pictures show so many.
fn one_cell(sheet: &Sheet, shown: [usize; 2]) -> Result<Tiling, AssemblyError> {
    if !sheet.is_repeated() {
        return Err(AssemblyError::NoLattice);
    }
    if shown.contains(&0) { Err(AssemblyError::NoCells) } else { Ok(tile(sheet, [1, 1], true)) }
}

/// Returns the fold angles of a tiling with edges that are folded flat on the side that they have in the sheet: pi and
/// -pi are drawn alike.
fn on_sides_of_sheet(mut angles: Vec<f64>, sheet: &Sheet, tiling: &Tiling) -> Vec<f64> {
    for (angle, tiled) in angles.iter_mut().zip(&tiling.edges).filter(|(angle, _)| is_folded_flat(**angle)) {
        let side = sheet.drawn_angle(&sheet.edges[tiled.edge]).unwrap_or(*angle);
        if side * *angle < 0.0 {
            *angle += TAU.copysign(side);
        }
    }
    angles
}
