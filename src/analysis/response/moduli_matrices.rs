//! The matrices of effective moduli, and principal strains and bendings.

/// Second derivatives of the energy per area, by the components 11, 22, 12.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModuliMatrices {
    /// Second derivatives of the energy per area by two components of the strain: force per length.
    pub stretching: [[f64; 3]; 3],
    /// Second derivatives by a component of the strain (row) and one of the curvature (column): force.
    pub coupling: [[f64; 3]; 3],
    /// Second derivatives by two components of the curvature: force times length.
    pub bending: [[f64; 3]; 3],
}

/// A principal strain and bending: an eigenvector of the moduli in the norm
/// `e11^2 + e22^2 + 2 e12^2 + A (k11^2 + k22^2 + 2 k12^2)` with the area `A` of the cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principal {
    /// Strain, of norm 1 together with the curvature.
    pub strain: [f64; 3],
    /// Curvature tensor.
    pub curvature: [f64; 3],
    /// Its stiffness: energy per area is half of it. Force per length.
    pub stiffness: f64,
}
