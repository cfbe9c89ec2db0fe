//! Tori: every crease has its own rest angle, held along the motions that stretch no bar.
//!
//! Such a motion is a Bloch mode at a wavenumber that fits the torus, or one that is the same in every cell. At nonzero
//! wavenumbers modes come as pairs of waves, a quarter of a wavelength apart; all of them are held, so that the one
//! that was asked for neither turns into its partner nor is hindered by the creases.

use super::{HeldSheet, LandscapeError};
use crate::math::fold_angle::fold_angle_gradient;
use crate::model::{Assembly, Drawn, Gauge, Hinges, Model, RIGID, Terms};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::small::{orthonormal_triangular, solve_square};
use crate::numerics::dense::{null_space_of_rows, rank_at_largest_gap, singular_values, symmetric_eigen};
use crate::sheet::{TiledEdge, Tiling};
use crate::solver::{HessianKind, Linearization, Problem};
use nalgebra::{Complex, DVector};
use std::f64::consts::TAU;

/// Most unknowns: their null space is found dense.
const MOST_UNKNOWNS: usize = 1500;
/// Part of a mode that may belong to other wavenumbers.
const IMPURE: f64 = 1e-6;

impl HeldSheet {
    /// A torus; the rest angles of its terms are not read, those drawn take their place.
    ///
    /// # Errors
    /// [`LandscapeError`] where no motion but the rigid ones leaves all bars as they are, and where the torus is too
    /// large to tell.
    pub fn torus(assembly: &Assembly) -> Result<Self, LandscapeError> {
        let (locked, angles) = (assembly.rigid_facet_edges(), assembly.drawn_angles());
        let facets = Hinges { stiffness: RIGID.into(), rest: angles.to_vec() };
        let facets = assembly.terms().has_rigid_facets().then_some(facets);
        let bars = assembly.with_terms(Terms { bars: Some(RIGID.into()), facets, ..Terms::default() });
        let motions = zero_modes(&bars.model(Gauge::Held))?;
        let rates: Vec<_> = motions.iter().map(|motion| fold_rates(assembly, motion)).collect();
        let modes = orthonormal(DenseMatrix::from_columns(&rates), &motions)?;
        Self::at_drawn_angles(assembly, modes, &locked, |edge| edge)
    }

    /// Another sheet of the same topology on the same torus, held along the modes of this one, which cost it energy.
    ///
    /// Its rest angles are those drawn.
    ///
    /// # Errors
    /// [`LandscapeError`] where the linear algebra fails.
    pub fn for_sheet(&self, assembly: &Assembly) -> Result<Self, LandscapeError> {
        let locked = assembly.rigid_facet_edges();
        Self::at_drawn_angles(assembly, (self.basis.clone(), self.motions.clone()), &locked, |edge| edge)
    }

    /// Rates of the mode of a torus that goes as `cos(2 pi (m1 c1 / n1 + m2 c2 / n2) + phase)` from cell to cell: the
    /// mean square over the cells, summed over the edges of a cell, is 1, and the edge that turns most has the phase
    /// zero.
    ///
    /// # Errors
    /// [`LandscapeError`] where no mode has this wavenumber.
    pub fn wave(&self, tiling: &Tiling, wave: [i32; 2]) -> Result<Vec<f64>, LandscapeError> {
        let cells = tiling.cells[0] * tiling.cells[1];
        let edges = self.basis.nrows() / cells;
        let amplitudes = amplitudes(&self.basis, tiling, wave);
        let power = DenseMatrix::from_fn(self.basis.ncols(), self.basis.ncols(), |i, j| {
            amplitudes.column(i).iter().zip(amplitudes.column(j).iter()).map(|(a, b)| (a.conj() * b).re).sum()
        });
        let eigen = symmetric_eigen(&power)?;
        let alone = (0..2).all(|a| (2 * wave[a]).rem_euclid(tiling.cells[a] as i32) == 0);
        let pure = cells as f64 * if alone { 1.0 } else { 0.5 };
        let there: Vec<usize> = (0..power.nrows()).filter(|&k| eigen.values[k] > (1.0 - IMPURE) * pure).collect();
        if there.is_empty() {
            return Err(LandscapeError::NoSuchWave { wave });
        }
        let space = eigen.vectors.select_columns(&there);
        let turning =
            |edge: usize| (0..space.ncols()).map(|k| along(&amplitudes, &space, edge, k).norm_sqr()).sum::<f64>();
        let most = (0..edges).max_by(|a, b| turning(*a).total_cmp(&turning(*b))).unwrap_or(0);
        let phase = DVector::from_fn(space.ncols(), |k, _| along(&amplitudes, &space, most, k).re);
        let rates = &self.basis * (&space * phase).normalize() * (cells as f64).sqrt();
        Ok(rates.as_slice().to_vec())
    }
}

/// Velocities of all coordinates that stretch nothing, rigid motions left out.
fn zero_modes(bars: &Model) -> Result<Vec<Vec<f64>>, LandscapeError> {
    let unknowns = bars.layout().unknowns;
    if unknowns > MOST_UNKNOWNS {
        return Err(LandscapeError::TooLarge { unknowns, most: MOST_UNKNOWNS });
    }
    let mut at = Linearization::new(bars.layout());
    bars.linearize(&bars.start(), &vec![0.0; bars.layout().stiff.len()], HessianKind::GaussNewton, &mut at);
    let null = null_space_of_rows(&at.rows(), unknowns)?.basis;
    if null.ncols() == 0 {
        return Err(LandscapeError::NoZeroModes);
    }
    Ok(null.column_iter().map(|mode| bars.velocity(mode.as_slice())).collect())
}

/// Rates of the fold angles of all edges.
fn fold_rates(assembly: &Assembly, motion: &[f64]) -> DVector<f64> {
    let (Drawn { domain, coordinates, .. }, edges) = (assembly.drawn(), &assembly.tiling().edges);
    let rate = |edge: &TiledEdge| {
        let Some(sites) = edge.hinge() else { return 0.0 };
        let gradient = fold_angle_gradient(&domain.points(coordinates, &sites)).1;
        let velocities = sites.iter().flat_map(|site| <[f64; 3]>::from(domain.velocity(coordinates, *site, motion)));
        gradient.iter().zip(velocities).map(|(g, v)| g * v).sum()
    };
    DVector::from_iterator(edges.len(), edges.iter().map(rate))
}

/// Orthonormal rates with the same span, and the motions that go with them. Fails where a motion has no rates of its
/// own.
fn orthonormal(rates: DenseMatrix, motions: &[Vec<f64>]) -> Result<(DenseMatrix, Vec<Vec<f64>>), LandscapeError> {
    let moving = DenseMatrix::from_columns(&motions.iter().map(|m| DVector::from_column_slice(m)).collect::<Vec<_>>());
    let rank = rank_at_largest_gap(&singular_values(&rates)?)?.rank;
    if rank < motions.len() {
        return Err(LandscapeError::Unfolding { motions: motions.len() - rank });
    }
    let [q, r] = orthonormal_triangular(rates);
    let turned = solve_square(r.transpose(), &moving.transpose());
    let turned = turned.ok_or(LandscapeError::Unfolding { motions: 1 })?.transpose();
    Ok((q, turned.column_iter().map(|motion| motion.as_slice().to_vec()).collect()))
}

/// Fourier amplitudes of the basis at a wavenumber: a row for each edge of the cell.
fn amplitudes(basis: &DenseMatrix, tiling: &Tiling, wave: [i32; 2]) -> nalgebra::DMatrix<Complex<f64>> {
    let [n1, n2] = tiling.cells;
    let edges = basis.nrows() / (n1 * n2);
    let mut amplitudes = nalgebra::DMatrix::zeros(edges, basis.ncols());
    for cell in 0..n1 * n2 {
        let turns =
            f64::from(wave[0]) * (cell % n1) as f64 / n1 as f64 + f64::from(wave[1]) * (cell / n1) as f64 / n2 as f64;
        let factor = Complex::from_polar(1.0, -TAU * turns);
        for edge in 0..edges {
            for mode in 0..basis.ncols() {
                amplitudes[(edge, mode)] += factor * basis[(cell * edges + edge, mode)];
            }
        }
    }
    amplitudes
}

/// Amplitude of an edge in the `k`-th mode of a space.
fn along(amplitudes: &nalgebra::DMatrix<Complex<f64>>, space: &DenseMatrix, edge: usize, k: usize) -> Complex<f64> {
    (0..space.nrows()).map(|mode| amplitudes[(edge, mode)] * space[(mode, k)]).sum()
}
