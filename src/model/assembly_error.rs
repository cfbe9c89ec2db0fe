//! Why an assembly cannot be put together.

use crate::sheet::EdgeKey;
use thiserror::Error;

/// Why there is no such assembly.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum AssemblyError {
    /// A finite sheet cannot be periodic.
    #[error("the sheet has no lattice: it can only be a patch")]
    NoLattice,
    /// A number of cells is zero.
    #[error("there is at least one cell along each lattice vector")]
    NoCells,
    /// A stiffness is negative, zero or not a number.
    #[error("the stiffness of the {term} is {stiffness}, not a positive number")]
    Stiffness {
        /// Bars, creases or facets.
        term: &'static str,
        /// As given.
        stiffness: f64,
    },
    /// Rest angles without creases.
    #[error("rest angles are those of creases: give these a stiffness")]
    RestWithoutCreases,
    /// A list of rest angles has another length than the list of edges.
    #[error("{given} rest angles were given for {edges} edges of the tiling")]
    RestAngles {
        /// How many were given.
        given: usize,
        /// How many there are.
        edges: usize,
    },
    /// An edge is not there, or does not fold.
    #[error("the sheet has no crease [{}, {}, {}, {}]", key.i, key.j, key.shift[0], key.shift[1])]
    NoCrease {
        /// The name that was given.
        key: EdgeKey,
    },
    /// A vertex or its cell is not there.
    #[error("there is no vertex {vertex} of cell {cell:?}")]
    NoVertex {
        /// Number in the cell.
        vertex: usize,
        /// The cell.
        cell: [usize; 2],
    },
    /// Loads that nothing holds push the whole sheet.
    #[error("the loads push the whole sheet along {} with a force of {force}", ["x", "y", "z"][*axis])]
    Unbalanced {
        /// 0, 1, 2: x, y, z.
        axis: usize,
        /// Their sum.
        force: f64,
    },
}
