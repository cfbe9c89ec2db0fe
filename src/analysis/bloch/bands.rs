//! Bands: the stiffness of a periodic sheet against waves, from the energies of its bars and hinges.
//!
//! In the drawn state, at rest, the energy of a wave `u exp(i q . n)` is half of `u^H D(q) u` per cell, with the
//! dynamical matrix `D = sum over elements of k g g^H`, `g` the gradient of a length or of a fold angle at the Bloch
//! factors, `k` its spring constant: `EA / L0` of a bar, stiffness times `L0` of a hinge. Its eigenvalues are squared
//! frequencies for unit masses on the vertices. Three of them vanish at `q = 0`; zero modes of the bars cost only what
//! their creases do.

use super::BlochError;
use super::rigidity::power;
use crate::math::Vec3;
use crate::math::fold_angle::fold_angle_gradient;
use crate::numerics::complex::{ComplexMatrix, hermitian_eigenvalues};
use crate::sheet::{Corner, EdgeKind, Sheet};
use nalgebra::Complex;

/// The dynamical matrix as a function of the wavenumbers.
#[derive(Clone, Debug)]
pub struct DynamicalMatrix {
    vertices: usize,
    elements: Vec<Element>,
}

/// A spring, its gradient and its constant.
#[derive(Clone, Debug)]
struct Element {
    stiffness: f64,
    terms: Vec<(Corner, Vec3)>,
}

/// Stiffnesses of the energy's terms, finite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stiffnesses {
    /// `EA` of bars, a force.
    pub bars: f64,
    /// Of creases, torque per radian and length.
    pub creases: f64,
    /// Of facets.
    pub facets: f64,
}

impl DynamicalMatrix {
    /// The dynamical matrix of a sheet as drawn, which is its state of rest.
    ///
    /// # Errors
    /// [`BlochError`] for a finite sheet.
    pub fn new(sheet: &Sheet, stiffnesses: Stiffnesses) -> Result<Self, BlochError> {
        if sheet.lattice.is_none() {
            return Err(BlochError::NoLattice);
        }
        let mut elements = Vec::new();
        for edge in &sheet.edges {
            let [i, j] = edge.key.ends();
            let along = sheet.position(j) - sheet.position(i);
            let (length, direction) = (along.norm(), along.normalize());
            elements
                .push(Element { stiffness: stiffnesses.bars / length, terms: vec![(i, -direction), (j, direction)] });
            let hinge = match edge.kind {
                EdgeKind::Crease => stiffnesses.creases,
                EdgeKind::Facet => stiffnesses.facets,
                EdgeKind::Boundary => 0.0,
            };
            if let ([Some(left), Some(right)], true) = (edge.wings, hinge > 0.0) {
                let corners = [i, j, left, right];
                let gradient = fold_angle_gradient(&corners.map(|corner| sheet.position(corner))).1;
                let terms = (0..4).map(|k| (corners[k], gradient.fixed_rows::<3>(3 * k).into_owned())).collect();
                elements.push(Element { stiffness: hinge * length, terms });
            }
        }
        Ok(Self { vertices: sheet.vertices.len(), elements })
    }

    /// `D(q)`, Hermitian, over `(u_0x, u_0y, u_0z, u_1x, ..)`; force per length.
    pub fn at(&self, q: [f64; 2]) -> ComplexMatrix {
        let z = q.map(|q| Complex::from_polar(1.0, q));
        let mut matrix = ComplexMatrix::zeros(3 * self.vertices, 3 * self.vertices);
        for element in &self.elements {
            for (a, from) in &element.terms {
                for (b, to) in &element.terms {
                    let phase = power(z, a.shift).conj() * power(z, b.shift) * element.stiffness;
                    for (row, x) in from.iter().enumerate() {
                        for (column, y) in to.iter().enumerate() {
                            matrix[(3 * a.vertex + row, 3 * b.vertex + column)] += phase * (x * y);
                        }
                    }
                }
            }
        }
        matrix
    }

    /// Eigenvalues of `D(q)`, ascending.
    ///
    /// # Errors
    /// [`BlochError`] where the eigenvalues cannot be computed.
    pub fn bands(&self, q: [f64; 2]) -> Result<Vec<f64>, BlochError> {
        Ok(hermitian_eigenvalues(&self.at(q))?)
    }
}

/// Wavenumbers along the straight lines between corners of a path, `steps` of them from each to the next, the last
/// corner too.
pub fn along_path(corners: &[[f64; 2]], steps: usize) -> Vec<[f64; 2]> {
    let between =
        |pair: &[[f64; 2]], k: usize| [0, 1].map(|a| pair[0][a] + (pair[1][a] - pair[0][a]) * k as f64 / steps as f64);
    let lines = corners.windows(2).flat_map(|pair| (0..steps).map(move |k| between(pair, k)));
    lines.chain(corners.last().copied()).collect()
}
