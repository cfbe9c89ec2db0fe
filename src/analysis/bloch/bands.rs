//! Bands: the stiffness of a periodic sheet against waves, from the energies of its bars and hinges.
//!
//! In the drawn state, at rest, the energy of a wave `u exp(i q . n)` is half of `u^H D(q) u` per cell, with the
//! dynamical matrix `D = sum over elements of k g g^H`, `g` the gradient of a length or of a fold angle at the Bloch
//! factors, `k` its spring constant: `EA / L0` of a bar, stiffness times `L0` of a hinge. Three eigenvalues vanish at
//! `q = 0`; zero modes of the bars cost only what their creases do. With masses `m` of the vertices the squared
//! frequencies are the eigenvalues of `M^(-1/2) D M^(-1/2)`: every gradient by a vertex is divided by `sqrt(m)`.

use super::BlochError;
use super::rigidity::power;
use crate::math::Vec3;
use crate::math::fold_angle::fold_angle_gradient;
use crate::numerics::complex::{ComplexMatrix, hermitian_eigenvalues};
use crate::numerics::dense::eigenvalue_rounding;
use crate::sheet::{Corner, EdgeKind, Sheet};
use nalgebra::Complex;
use std::f64::consts::TAU;

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

    /// The same with the mass of each vertex of the cell, positive: its eigenvalues are squared angular frequencies.
    #[must_use]
    pub fn with_masses(mut self, masses: &[f64]) -> Self {
        let terms = self.elements.iter_mut().flat_map(|element| &mut element.terms);
        terms.for_each(|(corner, gradient)| *gradient /= masses[corner.vertex].sqrt());
        self
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

    /// Square roots of the eigenvalues of `D(q)`, ascending: angular frequencies if masses were given. Exactly 0 are those of
    /// eigenvalues that are zero up to rounding, at most `4 sqrt(n) epsilon d` with the size `n` and the largest diagonal entry `d`.
    ///
    /// # Errors
    /// [`BlochError`] where the eigenvalues cannot be computed.
    pub fn frequencies(&self, q: [f64; 2]) -> Result<Vec<f64>, BlochError> {
        let matrix = self.at(q);
        let rounding = eigenvalue_rounding(matrix.nrows(), matrix.diagonal().iter().map(|d| d.re).fold(0.0, f64::max));
        let squares = hermitian_eigenvalues(&matrix)?.into_iter();
        // a sum of squares has no eigenvalue below zero
        Ok(squares.map(|square| if square <= rounding { 0.0 } else { square.sqrt() }).collect())
    }

    /// Frequencies at all wavenumbers `2 pi (k1 / n1, k2 / n2)` of a grid, the first one running faster; `None` if `go_on` returned
    /// false, which is asked before each of the `n1 n2` wavenumbers. Those at `-q` are those at `q`.
    ///
    /// # Errors
    /// [`BlochError`] where the eigenvalues cannot be computed.
    pub fn on_grid(
        &self,
        [n1, n2]: [usize; 2],
        mut go_on: impl FnMut(usize) -> bool,
    ) -> Result<Option<Vec<Vec<f64>>>, BlochError> {
        let mut found: Vec<Vec<f64>> = Vec::with_capacity(n1 * n2);
        for number in 0..n1 * n2 {
            if !go_on(number) {
                return Ok(None);
            }
            let [k1, k2] = [number % n1, number / n1];
            let opposite = (n2 - k2) % n2 * n1 + (n1 - k1) % n1;
            let known = found.get(opposite).cloned();
            let q = [TAU * k1 as f64 / n1 as f64, TAU * k2 as f64 / n2 as f64];
            found.push(known.map_or_else(|| self.frequencies(q), Ok)?);
        }
        Ok(Some(found))
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
