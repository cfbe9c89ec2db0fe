//! The errors of building an assembly.

use crate::sheet::EdgeKey;
use thiserror::Error;

/// The reason why an assembly cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum AssemblyError {
    /// Periodic boundary conditions were asked of a sheet without lattice.
    #[error("the sheet has no lattice: it can only be a patch")]
    NoLattice,
    /// A tube was asked of a sheet that is not drawn as one and was not rolled up.
    #[error("the sheet is not drawn as a tube: roll it up first")]
    NotRolled,
    /// A domain of one's own was asked for without giving one.
    #[error("the boundary conditions are those of a domain of one's own, which is not given")]
    NoDomain,
    /// A drawn state on a domain of one's own has another number of coordinates than the domain.
    #[error("{given} coordinates were given: the vertices and the domain have {needed}")]
    Coordinates {
        /// Number of coordinates that were given.
        given: usize,
        /// Three for each vertex, and the shared ones.
        needed: usize,
    },
    /// Lattice vectors were asked of a cell that screw motions repeat.
    #[error("the sheet is drawn as a tube: it is a tube or a patch")]
    DrawnAsTube,
    /// A number of cells is zero.
    #[error("there is at least one cell along each lattice vector")]
    NoCells,
    /// A stiffness is negative, zero or not a number.
    #[error("the stiffness of the {term} is {stiffness}, not a positive number")]
    Stiffness {
        /// Name of the term: bars, creases or facets.
        term: &'static str,
        /// The stiffness that was given.
        stiffness: f64,
    },
    /// The mass is not a positive finite number.
    #[error("the mass is {mass}, not a positive number")]
    Mass {
        /// The mass that was given.
        mass: f64,
    },
    /// Rest angles were given, but no stiffness of the creases.
    #[error("rest angles are those of creases: give these a stiffness")]
    RestWithoutCreases,
    /// Rest lengths were given, but no stiffness of the bars.
    #[error("rest lengths are those of bars: give these a stiffness")]
    RestWithoutBars,
    /// A rest length, or the factor of all rest lengths, is not a positive finite number.
    #[error("a rest length, or the factor of all, is {length}, not a positive number")]
    RestLength {
        /// The length or the factor.
        length: f64,
    },
    /// A list has not one entry for each edge of the tiling.
    #[error("{given} {what} were given for {edges} edges of the tiling")]
    Count {
        /// Name of the entries of the list.
        what: &'static str,
        /// Number of entries that were given.
        given: usize,
        /// Number of edges of the tiling.
        edges: usize,
    },
    /// The sheet has no such edge, or the edge is not a crease.
    #[error("the sheet has no crease [{}, {}, {}, {}]", key.i, key.j, key.shift[0], key.shift[1])]
    NoCrease {
        /// The name of the edge that was given.
        key: EdgeKey,
    },
    /// An angle is given for the lock of a crease at which more than two faces meet.
    #[error(
        "the crease [{}, {}, {}, {}] has {hinges} hinges: a lock without an angle keeps all of them",
        key.i, key.j, key.shift[0], key.shift[1]
    )]
    SeveralHinges {
        /// The name of the edge that was given.
        key: EdgeKey,
        /// Number of its hinges.
        hinges: usize,
    },
    /// No copy of a crease is between two faces of the tiling.
    #[error(
        "no copy of the crease [{}, {}, {}, {}] folds in a patch of {} x {} cells",
        key.i, key.j, key.shift[0], key.shift[1], cells[0], cells[1]
    )]
    NoCopy {
        /// The name of the crease in the sheet.
        key: EdgeKey,
        /// Numbers of cells along the two lattice vectors.
        cells: [usize; 2],
    },
    /// The tiling has no such vertex or no such cell.
    #[error("there is no vertex {vertex} of cell {cell:?}")]
    NoVertex {
        /// Number of the vertex in the cell.
        vertex: usize,
        /// The cell, counted along the two lattice vectors.
        cell: [usize; 2],
    },
    /// The sheet has weight and no mass.
    #[error("the sheet has weight and no mass")]
    WeightWithoutMass,
    /// Faces are under pressure and enclose nothing.
    #[error(
        "faces are under pressure and do not close: the side between vertices {} and {} belongs to one of them only",
        vertices[0],
        vertices[1]
    )]
    Open {
        /// The ends of the side, vertices of the tiling.
        vertices: [usize; 2],
    },
    /// Faces of another domain than a patch are under pressure.
    #[error("only faces of a patch have a pressure")]
    NoPatch,
    /// The loads have a resultant force along an axis on which no vertex is pinned.
    #[error("the loads push the whole sheet along {} with a force of {force}", ["x", "y", "z"][*axis])]
    Unbalanced {
        /// The axis: 0, 1, 2 for x, y, z.
        axis: usize,
        /// Sum of the loads along the axis.
        force: f64,
    },
}
