//! A builder of assemblies: stiffnesses, rest angles, locks, pins and loads by the names that a sheet gives them.

use super::assembly::Assembly;
use super::assembly_error::AssemblyError;
use super::boundary::Boundary;
use super::terms::{Hinges, RIGID, Terms};
use crate::math::Vec3;
use crate::sheet::{EdgeKey, Sheet};

/// The angles at which creases are at rest, in radians.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Rest {
    /// The drawn fold angles.
    #[default]
    Drawn,
    /// All zero.
    Flat,
    /// The same for all.
    Angle(f64),
    /// One for each edge of the tiling, in its order; read where there is a crease.
    PerEdge(Vec<f64>),
}

impl Assembly {
    /// Begins a patch with free edges: `cells[0] x cells[1]` cells of a sheet, or a finite sheet.
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

    /// Begins one cell repeated by two screw motions, a cylinder of any curvature; pictures show `cells[0] x cells[1]` of it.
    pub fn screw(sheet: Sheet, cells: [usize; 2]) -> Builder {
        Builder::new(sheet, cells, Boundary::Screw)
    }
}

/// An assembly that is being put together; [`Assembly::patch`] and its siblings begin one.
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

    /// Gives every edge a bar of this stiffness `EA`, force per strain; [`RIGID`]: its length is kept.
    #[must_use]
    pub fn bars(self, stiffness: f64) -> Self {
        Self { bars: Some(stiffness), ..self }
    }

    /// Gives every crease this stiffness, torque per radian and length.
    #[must_use]
    pub fn creases(self, stiffness: f64) -> Self {
        Self { creases: Some(stiffness), ..self }
    }

    /// Gives the diagonals of polygons this stiffness, torque per radian and length, at rest as drawn; without this call
    /// polygons are rigid.
    #[must_use]
    pub fn facets(self, stiffness: f64) -> Self {
        Self { facets: stiffness, ..self }
    }

    /// Sets the rest angles of the creases; without this call they rest as drawn.
    #[must_use]
    pub fn rest(self, rest: Rest) -> Self {
        Self { rest: Some(rest), ..self }
    }

    /// Keeps a crease of the cell, in all its copies, at an angle in radians; `None`: as drawn.
    #[must_use]
    pub fn lock(mut self, crease: EdgeKey, angle: Option<f64>) -> Self {
        self.locks.push((crease, angle));
        self
    }

    /// Holds a vertex of a cell along the axes (x, y, z) that are true.
    #[must_use]
    pub fn pin(mut self, vertex: usize, cell: [usize; 2], axes: [bool; 3]) -> Self {
        self.pins.push((vertex, cell, axes));
        self
    }

    /// Pulls at a vertex of a cell with a force.
    #[must_use]
    pub fn load(mut self, vertex: usize, cell: [usize; 2], force: [f64; 3]) -> Self {
        self.loads.push((vertex, cell, Vec3::from(force)));
        self
    }

    /// Puts the assembly together.
    ///
    /// # Errors
    /// [`AssemblyError`]: the sheet cannot have these boundary conditions, a stiffness is no positive number, a crease or
    /// a vertex is not there, rest angles do not fit the tiling, or loads do not balance along an axis without pins.
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

/// The edges of the tiling that are copies of a crease and fold.
fn copies(assembly: &Assembly, crease: EdgeKey) -> Result<Vec<usize>, AssemblyError> {
    let (sheet, tiling, angles) = (assembly.sheet(), assembly.tiling(), assembly.drawn_angles());
    let edge = sheet.crease(crease).ok_or(AssemblyError::NoCrease { key: crease })?;
    Ok((0..tiling.edges.len()).filter(|&k| tiling.edges[k].edge == edge && !angles[k].is_nan()).collect())
}

/// The number of a cell's vertex in the tiling.
fn numbered(assembly: &Assembly, vertex: usize, cell: [usize; 2]) -> Result<usize, AssemblyError> {
    let (count, cells) = (assembly.sheet().vertices.len(), assembly.tiling().cells);
    let there = vertex < count && cell[0] < cells[0] && cell[1] < cells[1];
    if there {
        Ok((cell[1] * cells[0] + cell[0]) * count + vertex)
    } else {
        Err(AssemblyError::NoVertex { vertex, cell })
    }
}
