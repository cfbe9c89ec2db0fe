//! The matrices of effective moduli, and principal strains and bendings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Second derivatives of the energy per area, by the components 11, 22, 12: force per length, force, and force times
/// length; in the limit of stiff bars over `EA`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "RigidLimitSummary")]
pub struct ModuliMatrices {
    /// Second derivatives of the energy per area by two components of the strain.
    pub stretching: [[f64; 3]; 3],
    /// Second derivatives by a component of the strain (row) and one of the curvature (column).
    pub coupling: [[f64; 3]; 3],
    /// Second derivatives by two components of the curvature.
    pub bending: [[f64; 3]; 3],
}

/// A principal strain and bending, of norm 1 in `e11^2 + e22^2 + 2 e12^2 + A (k11^2 + k22^2 + 2 k12^2)`, `A` the area
/// of the cell: an eigenvector of the moduli.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "PrincipalSummary")]
pub struct Principal {
    /// Strain `[e11, e22, e12]`.
    pub strain: [f64; 3],
    /// Curvature tensor `[k11, k22, k12]`.
    pub curvature: [f64; 3],
    /// Its stiffness, twice its energy per area: force per length.
    pub stiffness: f64,
    /// Its stiffness over that of the rigid mode of the same number; null where that is 0.
    pub ratio: Option<f64>,
}
