//! Bands: the stiffness of a periodic sheet against waves, from the energies of its bars and hinges.
//!
//! In the drawn state, at rest, the energy of a wave `u exp(i q . n)` is half of `u^H D(q) u` per cell, with the
//! dynamical matrix `D = sum over elements of k g g^H`, `g` the gradient of a length or of a fold angle at the Bloch
//! factors, `k` its spring constant: `EA / L0` of a bar, stiffness times `L0` of a hinge. Three eigenvalues vanish at
//! `q = 0`; zero modes of the bars cost only what their creases do. With masses `m` of the vertices the squared
//! frequencies are the eigenvalues of `M^(-1/2) D M^(-1/2)`: every row and column of a vertex is divided by `sqrt(m)`.
//!
//! In another state in balance bars and hinges carry forces `f`, and an element adds `f` times the second derivative of
//! its measure. Such a state can be unstable against a wave, whose eigenvalue then is negative. On a cylinder the
//! copies of a vertex move along with the lattice rotations, so that a wave with `q = 0` is the same in every cell as
//! seen from the axis.

use super::BlochError;
use super::rigidity::power;
use crate::math::{fold_angle::fold_angle_gradient, in_lower_triangle};
use crate::model::{Local, Model};
use crate::numerics::DenseMatrix;
use crate::numerics::complex::ComplexMatrix;
use crate::numerics::dense::{eigenvalue_rounding, symmetric_eigenvalues};
use crate::sheet::{Corner, EdgeKind, Sheet};
use nalgebra::Complex;
use std::f64::consts::TAU;

/// The dynamical matrix as a function of the wavenumbers.
#[derive(Clone, Debug)]
pub struct DynamicalMatrix {
    vertices: usize,
    elements: Vec<ElementStiffness>,
}

/// The second derivatives of the energy of a bar or hinge by the coordinates of its points, row by row.
#[derive(Clone, Debug)]
struct ElementStiffness {
    corners: Vec<Corner>,
    hessian: DenseMatrix,
}

impl ElementStiffness {
    /// A spring at rest, with the gradient of its measure.
    fn at_rest(corners: Vec<Corner>, gradient: &[f64], stiffness: f64) -> Self {
        let n = gradient.len();
        Self {
            corners,
            hessian: DenseMatrix::from_fn(n, n, |row, column| stiffness * (gradient[row] * gradient[column])),
        }
    }

    /// A spring that carries a force, with the first and second derivatives of its measure.
    fn stretched(element: &crate::model::Element<'_>, local: &Local) -> Self {
        let [_, force, stiffness] = element.response(local.value);
        let corners = element.sites().to_vec();
        let second = |row: usize, column: usize| local.hessian[in_lower_triangle(row, column)];
        let n = local.gradient.len();
        let hessian = DenseMatrix::from_fn(n, n, |row, column| {
            stiffness * (local.gradient[row] * local.gradient[column]) + force * second(row, column)
        });
        Self { corners, hessian }
    }
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
            let gradient: Vec<f64> = (-direction).iter().chain(direction.iter()).copied().collect();
            if edge.key.has_bar() {
                elements.push(ElementStiffness::at_rest(vec![i, j], &gradient, stiffnesses.bars / length));
            }
            let hinge = match edge.kind {
                EdgeKind::Crease => stiffnesses.creases,
                EdgeKind::Facet => stiffnesses.facets,
                EdgeKind::Boundary => 0.0,
            };
            if let ([Some(left), Some(right)], true) = (edge.wings, hinge > 0.0) {
                let corners = [i, j, left, right];
                let gradient = fold_angle_gradient(&corners.map(|corner| sheet.position(corner))).1;
                elements.push(ElementStiffness::at_rest(corners.to_vec(), gradient.as_slice(), hinge * length));
            }
        }
        Ok(Self { vertices: sheet.vertices.len(), elements })
    }

    /// The dynamical matrix of a state of a model of one cell, periodic or a cylinder, from all its coordinates: with
    /// the forces that bars and hinges carry there. Angles continue from those of the model.
    ///
    /// # Errors
    /// [`BlochError::RigidElement`] where an element has no finite stiffness.
    pub fn of_state(model: &Model, coordinates: &[f64]) -> Result<Self, BlochError> {
        let (mut elements, mut local) = (Vec::new(), Local::default());
        for element in model.elements() {
            if element.spring.stiffness.is_infinite() {
                return Err(BlochError::RigidElement { kind: element.kind().name() });
            }
            element.local(coordinates, true, &mut local);
            elements.push(ElementStiffness::stretched(&element, &local));
        }
        Ok(Self { vertices: (coordinates.len() - model.domain().shared()) / 3, elements })
    }

    /// The same with the mass of each vertex of the cell, positive: its eigenvalues are squared angular frequencies.
    #[must_use]
    pub fn with_masses(mut self, masses: &[f64]) -> Self {
        for ElementStiffness { corners, hessian } in &mut self.elements {
            let per_root = |k: usize| 1.0 / masses[corners[k / 3].vertex].sqrt();
            *hessian = DenseMatrix::from_fn(hessian.nrows(), hessian.ncols(), |row, column| {
                hessian[(row, column)] * per_root(row) * per_root(column)
            });
        }
        self
    }

    /// `D(q)`, Hermitian, over `(u_0x, u_0y, u_0z, u_1x, ..)`; force per length.
    pub fn at(&self, q: [f64; 2]) -> ComplexMatrix {
        let z = q.map(|q| Complex::from_polar(1.0, q));
        let mut matrix = ComplexMatrix::zeros(3 * self.vertices, 3 * self.vertices);
        for ElementStiffness { corners, hessian } in &self.elements {
            for (a, from) in corners.iter().enumerate() {
                for (b, to) in corners.iter().enumerate() {
                    let phase = power(z, from.shift).conj() * power(z, to.shift);
                    for (row, column) in (0..9).map(|k| (k / 3, k % 3)) {
                        let entry = hessian[(3 * a + row, 3 * b + column)];
                        matrix[(3 * from.vertex + row, 3 * to.vertex + column)] += phase * entry;
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
        Ok(symmetric_eigenvalues(&self.at(q))?)
    }

    /// Square roots of the eigenvalues of `D(q)`, ascending: angular frequencies if masses were given. Exactly 0 are
    /// those of eigenvalues that are zero up to rounding, at most `4 sqrt(n) epsilon d` with the size `n` and the
    /// largest diagonal entry `d`. A negative one is minus the rate at which a wave grows, of a state that is not
    /// stable.
    ///
    /// # Errors
    /// [`BlochError`] where the eigenvalues cannot be computed.
    pub fn frequencies(&self, q: [f64; 2]) -> Result<Vec<f64>, BlochError> {
        let matrix = self.at(q);
        let rounding = eigenvalue_rounding(matrix.nrows(), matrix.diagonal().iter().map(|d| d.re).fold(0.0, f64::max));
        let squares = symmetric_eigenvalues(&matrix)?.into_iter();
        Ok(squares
            .map(|square| if square.abs() <= rounding { 0.0 } else { square.abs().sqrt().copysign(square) })
            .collect())
    }

    /// Frequencies at all wavenumbers `2 pi (k1 / n1, k2 / n2)` of a grid, the first one running faster; `go_on` is asked
    /// before each of the `n1 n2` wavenumbers. Those at `-q` are those at `q`.
    ///
    /// # Errors
    /// [`BlochError`] where the eigenvalues cannot be computed, and where `go_on` returns false.
    pub fn on_grid(
        &self,
        [n1, n2]: [usize; 2],
        mut go_on: impl FnMut(usize) -> bool,
    ) -> Result<Vec<Vec<f64>>, BlochError> {
        let mut found: Vec<Vec<f64>> = Vec::with_capacity(n1 * n2);
        for number in 0..n1 * n2 {
            BlochError::unless(go_on(number))?;
            let [k1, k2] = [number % n1, number / n1];
            let opposite = (n2 - k2) % n2 * n1 + (n1 - k1) % n1;
            let known = found.get(opposite).cloned();
            let q = [TAU * k1 as f64 / n1 as f64, TAU * k2 as f64 / n2 as f64];
            found.push(known.map_or_else(|| self.frequencies(q), Ok)?);
        }
        Ok(found)
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
