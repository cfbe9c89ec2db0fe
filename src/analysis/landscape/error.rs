//! Why there is no landscape.

use crate::kinematics::KinematicsError;
use crate::numerics::dense::DenseError;
use crate::numerics::factor::FactorError;
use thiserror::Error;

/// Why there is no landscape.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum LandscapeError {
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    #[error(transparent)]
    Factor(#[from] FactorError),
    #[error("a landscape is that of a patch or a torus, not of a domain of one's own")]
    OwnDomain,
    #[error("a landscape is that of equal cells, and the {term} have more than one stiffness")]
    Uneven { term: &'static str },
    #[error("a landscape needs linear bars and hinges and no other terms, and here is another: {term}")]
    NotLinear { term: String },
    #[error(
        "a landscape is that of a sheet drawn at rest, and {bars} bars have other rest lengths than the drawn ones"
    )]
    OffRest { bars: usize },
    #[error("curvatures name no modes of a torus")]
    NoCurvatures,
    #[error("a patch has no waves")]
    NoWaves,
    #[error("every motion of this torus stretches a bar, but for the rigid ones")]
    NoZeroModes,
    #[error("no zero mode goes {wave:?} times round the torus")]
    NoSuchWave { wave: [i32; 2] },
    #[error("{motions} motion(s) of this torus turn no crease: its faces do not hang together at their edges")]
    Unfolding { motions: usize },
    #[error("no mode has these rates: the nearest one is off by {off:.1e} of the largest")]
    NoSuchMode { off: f64 },
    #[error("the rates are all zero: they name no mode")]
    NoRates,
    #[error(
        "the rates given leave {open} of {modes} modes open: modes that differ have the same rates there; give the rates of \
         the facets too, in rows as those of creases"
    )]
    ManyModes { open: usize, modes: usize },
    #[error("a torus of {unknowns} unknowns is too large: at most {most}")]
    TooLarge { unknowns: usize, most: usize },
    #[error(transparent)]
    Dense(#[from] DenseError),
}
