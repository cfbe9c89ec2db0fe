//! Spatially varying modes of periodic sheets: displacements that are multiplied by `z1` and `z2` from a cell to the next.
//!
//! `z = exp(i q)` with wavenumbers `q` in radians per cell, which may be complex. The bars keep their lengths where the
//! rigidity matrix `R(z1, z2)` is singular (McInerney, Chen, Theran, Santangelo, Rocklin, PNAS 117, 30252 (2020), last
//! section and appendix J; C. L. Kane, T. C. Lubensky, Nature Physics 10, 39 (2014)).

pub mod rigidity;

pub use rigidity::Rigidity;

use thiserror::Error;

/// Why there is no answer about spatially varying modes.
#[derive(Debug, Error)]
pub enum BlochError {
    /// A finite sheet has no wavenumbers.
    #[error("a sheet without lattice vectors has no spatially varying modes")]
    NoLattice,
    /// As many equations as unknowns are needed for a determinant.
    #[error("{rows} conditions (bars and rigid facets) for {columns} coordinates of a cell: no determinant")]
    NotSquare {
        /// Bars and rigid facets of a cell.
        rows: usize,
        /// Coordinates of a cell.
        columns: usize,
    },
}
