//! The builder of assemblies: sets stiffnesses, rest angles, locks, pins and loads, and names edges and vertices as
//! the sheet does.

use super::assembly::Assembly;
use super::assembly_error::AssemblyError;
use super::boundary::Boundary;
use super::terms::{Hinges, RIGID, Terms};
use crate::math::Vec3;
use crate::sheet::{EdgeKey, Sheet};

/// The rest angles of the creases, in radians.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Rest {
    /// The drawn fold angles.
    #[default]
    Drawn,
    /// Zero for every crease.
    Flat,
    /// The same angle for every crease.
    Angle(f64),
    /// One angle for each edge of the tiling, in the tiling's order; only those of creases are used.
    PerEdge(Vec<f64>),
}

impl Assembly {
    /// Begins a patch with free edges: `cells[0] x cells[1]` cells of a sheet with lattice, or a whole finite sheet.
    pub fn patch(sheet: Sheet, cells: [usize; 2]) -> Builder {
        Builder::new(sheet, cells, Boundary::Patch)
    }

    /// Begins a torus of `cells[0] x cells[1]` cells with free lattice vectors.
    pub fn torus(sheet: Sheet, cells: [usize; 2]) -> Builder {
        Builder::new(sheet, cells, Boundary::FreeTorus)
    }

    /// Begins a torus of `cells[0] x cells[1]` cells with the lattice vectors held as drawn.
    pub fn fixed_torus(sheet: Sheet, cells: [usize; 2]) -> Builder {
        Builder::new(sheet, cells, Boundary::FixedTorus)
    }

    /// Begins one cell repeated by two screw motions about a common axis, a cylinder of any curvature; pictures show
    /// `cells[0] x cells[1]` copies of it.
    pub fn screw(sheet: Sheet, cells: [usize; 2]) -> Builder {
        Builder::new(sheet, cells, Boundary::Screw)
    }
}

/// An assembly under construction; [`Assembly::patch`] and the similar functions begin one and [`Builder::build`]
/// ends it.
#[derive(Clone, Debug)]
pub struct Builder {
    sheet: Sheet,
    cells: [usize; 2],
    boundary: Boundary,
    bars: Option<f64>,
    creases: Option<f64>,
    facets: f64,
    rest: Option<Rest>,
    locks: Vec<(EdgeKey, Option<f64>)>,
    pins: Vec<(usize, [usize; 2], [bool; 3])>,
    loads: Vec<(usize, [usize; 2], Vec3)>,
}

impl Builder {
    pub(super) fn new(sheet: Sheet, cells: [usize; 2], boundary: Boundary) -> Self {
        let (locks, pins, loads) = Default::default();
        Self { sheet, cells, boundary, bars: None, creases: None, facets: RIGID, rest: None, locks, pins, loads }
    }

    /// Gives every edge a bar of stiffness `EA`, in force per strain; [`RIGID`] keeps its length exactly.
    #[must_use]
    pub fn bars(self, stiffness: f64) -> Self {
        Self { bars: Some(stiffness), ..self }
    }

    /// Gives every crease this stiffness, in torque per radian and length.
    #[must_use]
    pub fn creases(self, stiffness: f64) -> Self {
        Self { creases: Some(stiffness), ..self }
    }

    /// Gives the diagonals of polygons this stiffness, in torque per radian and length, with the drawn angles as rest
    /// angles. Without this call polygons are rigid.
    #[must_use]
    pub fn facets(self, stiffness: f64) -> Self {
        Self { facets: stiffness, ..self }
    }

    /// Sets the rest angles of the creases. Without this call they are the drawn angles.
    #[must_use]
    pub fn rest(self, rest: Rest) -> Self {
        Self { rest: Some(rest), ..self }
    }

    /// Locks a crease of the cell, in all its copies, at a fold angle in radians; `None` locks it at the drawn angle.
    #[must_use]
    pub fn lock(mut self, crease: EdgeKey, angle: Option<f64>) -> Self {
        self.locks.push((crease, angle));
        self
    }

    /// Pins a vertex of a cell: its coordinates along the axes (x, y, z) that are true keep their drawn values.
    #[must_use]
    pub fn pin(mut self, vertex: usize, cell: [usize; 2], axes: [bool; 3]) -> Self {
        self.pins.push((vertex, cell, axes));
        self
    }

    /// Applies a force (x, y, z) to a vertex of a cell.
    #[must_use]
    pub fn load(mut self, vertex: usize, cell: [usize; 2], force: [f64; 3]) -> Self {
        self.loads.push((vertex, cell, Vec3::from(force)));
        self
    }

    /// Builds the assembly.
    ///
    /// # Errors
    /// [`AssemblyError`] if the sheet cannot have these boundary conditions, a stiffness is not a positive number,
    /// rest angles are given without a stiffness of creases or their number does not match the tiling, a crease or a
    /// vertex does not exist, or loads do not balance along an axis without pins.
    pub fn build(self) -> Result<Assembly, AssemblyError> {
        let Self { sheet, cells, boundary, bars, creases, facets, rest, locks, pins, loads } = self;
        let bare = Assembly::without_terms(sheet, cells, boundary)?;
        for (term, stiffness) in [("bars", bars), ("creases", creases), ("facets", Some(facets))] {
            if let Some(stiffness) = stiffness.filter(|stiffness| !(*stiffness > 0.0)) {
                return Err(AssemblyError::Stiffness { term, stiffness });
            }
        }
        let creases = match (creases, rest) {
            (None, Some(_)) => return Err(AssemblyError::RestWithoutCreases),
            (None, None) => None,
            (Some(stiffness), rest) => Some(Hinges { stiffness, rest: angles(&bare, rest.unwrap_or_default())? }),
        };
        let facets = Hinges { stiffness: facets, rest: bare.drawn_angles().to_vec() };
        let facets = bare.tiling().facets().next().map(|_| facets);
        let mut terms = Terms { bars, creases, facets, ..Terms::default() };
        for (crease, angle) in locks {
            terms
                .locks
                .extend(copies(&bare, crease)?.into_iter().map(|k| (k, angle.unwrap_or(bare.drawn_angles()[k]))));
        }
        for (vertex, cell, axes) in pins {
            terms.pins.push((numbered(&bare, vertex, cell)?, axes));
        }
        for (vertex, cell, force) in loads {
            terms.loads.push((numbered(&bare, vertex, cell)?, force));
        }
        match terms.unbalanced_axis() {
            Some((axis, force)) => Err(AssemblyError::Unbalanced { axis, force }),
            None => Ok(bare.with_terms(terms).with_best_axis()),
        }
    }
}

/// Returns the rest angles, one for each edge of the tiling.
fn angles(assembly: &Assembly, rest: Rest) -> Result<Vec<f64>, AssemblyError> {
    let edges = assembly.edges();
    match rest {
        Rest::Drawn => Ok(assembly.drawn_angles().to_vec()),
        Rest::Flat => Ok(vec![0.0; edges]),
        Rest::Angle(angle) => Ok(vec![angle; edges]),
        Rest::PerEdge(angles) if angles.len() == edges => Ok(angles),
        Rest::PerEdge(angles) => Err(AssemblyError::RestAngles { given: angles.len(), edges }),
    }
}

/// Returns the numbers of the tiling's edges that are copies of this crease and have a hinge.
fn copies(assembly: &Assembly, crease: EdgeKey) -> Result<Vec<usize>, AssemblyError> {
    let (sheet, tiling, angles) = (assembly.sheet(), assembly.tiling(), assembly.drawn_angles());
    let edge = sheet.crease(crease).ok_or(AssemblyError::NoCrease { key: crease })?;
    Ok((0..tiling.edges.len()).filter(|&k| tiling.edges[k].edge == edge && !angles[k].is_nan()).collect())
}

/// Returns the number that a cell's vertex has in the tiling.
fn numbered(assembly: &Assembly, vertex: usize, cell: [usize; 2]) -> Result<usize, AssemblyError> {
    let (count, cells) = (assembly.sheet().vertices.len(), assembly.tiling().cells);
    let there = vertex < count && cell[0] < cells[0] && cell[1] < cells[1];
    if there {
        Ok((cell[1] * cells[0] + cell[0]) * count + vertex)
    } else {
        Err(AssemblyError::NoVertex { vertex, cell })
    }
}
