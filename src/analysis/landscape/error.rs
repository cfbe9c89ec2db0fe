//! Why there is no landscape.

use crate::analysis::bloch::BlochError;
use crate::kinematics::KinematicsError;
use crate::numerics::dense::DenseError;
use crate::numerics::factor::FactorError;
use thiserror::Error;

/// Why there is no landscape.
#[derive(Debug, Error)]
pub enum LandscapeError {
    /// The modes are not known, or not three that curvatures name.
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    /// The patch cannot be factored, or is not stable, or a linear solve loses too many digits.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// The modes of a cell are those of a patch or a torus.
    #[error("a landscape is that of a patch or a torus, not of a domain of one's own")]
    OwnDomain,
    /// The elements of a term differ, and the expansion is that of equal cells.
    #[error("a landscape is that of equal cells, and the {term} have more than one stiffness")]
    Uneven {
        /// Name of the term.
        term: &'static str,
    },
    /// A term is not made of linear springs along edges.
    #[error("a landscape needs linear bars and hinges and no other terms, and here is another: {term}")]
    NotLinear {
        /// Name of the term.
        term: String,
    },
    /// Bars are not at rest as drawn.
    #[error(
        "a landscape is that of a sheet drawn at rest, and {bars} bars have other rest lengths than the drawn ones"
    )]
    OffRest {
        /// Number of these bars.
        bars: usize,
    },
    /// Curvatures name no modes here.
    #[error("curvatures name no modes of a torus")]
    NoCurvatures,
    /// There is no determinant to tune.
    #[error(transparent)]
    Bloch(#[from] BlochError),
    /// Waves go round tori.
    #[error("a patch has no waves")]
    NoWaves,
    /// The torus is rigid to first order.
    #[error("every motion of this torus stretches a bar, but for the rigid ones")]
    NoZeroModes,
    /// The torus has zero modes, but none of this wavenumber.
    #[error("no zero mode goes {wave:?} times round the torus")]
    NoSuchWave {
        /// Waves round the torus, along both directions.
        wave: [i32; 2],
    },
    /// Pieces of the torus move against each other without folding: fold rates do not name such motions.
    #[error("{motions} motion(s) of this torus turn no crease: its faces do not hang together at their edges")]
    Unfolding {
        /// How many, linearly independent.
        motions: usize,
    },
    /// Rates that are no mode.
    #[error("no mode has these rates: the nearest one is off by {off:.1e} of the largest")]
    NoSuchMode {
        /// Largest difference over the largest rate.
        off: f64,
    },
    /// Rates that are all zero name no mode.
    #[error("the rates are all zero: they name no mode")]
    NoRates,
    /// Rates that several modes have.
    #[error(
        "the rates given leave {open} of {modes} modes open: modes that differ have the same rates there; give the rates of \
         the facets too, in rows as those of creases"
    )]
    ManyModes {
        /// Modes that have no rates where rates are given.
        open: usize,
        /// All modes.
        modes: usize,
    },
    /// The modes of so large a torus are not computed.
    #[error("a torus of {unknowns} unknowns is too large: at most {most}")]
    TooLarge {
        /// Its unknowns.
        unknowns: usize,
        /// Most of them.
        most: usize,
    },
    /// A rank is not clear.
    #[error(transparent)]
    Dense(#[from] DenseError),
}
