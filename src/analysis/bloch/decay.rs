//! Inverse decay rates: the roots `z_b` of the determinant at a real wavenumber `q_a`.
//!
//! A mode with root `z` is multiplied by `z` from a cell to the next and grows by `kappa = log|z|` per cell. On a sheet
//! without openings a root `z` at wavenumber `q` has the partner `1/conj(z)`: decay rates come in pairs of opposite
//! sign.

use super::root::Root;
use super::singular::SingularSearch;
use super::{BlochError, Determinant, Laurent, Rigidity, cluster};
use crate::numerics::polynomial::{Roots, roots, value_and_slope};
use crate::numerics::{larger, worst};
use nalgebra::Complex;

/// Roots of a larger condition number are left out of the pairing: they are known to less than ten digits.
pub const WELL_CONDITIONED: f64 = 1e5;
/// Roots of a larger condition number are corrected on the matrix.
const WELL_KNOWN: f64 = 1e3;
/// Coefficients at a wavenumber below this part of the terms that cancel in them are rounding.
const CANCELLED: f64 = 1e-13;

/// All roots at one wavenumber.
#[derive(Clone, Debug, PartialEq)]
pub struct Decay {
    /// The given wavenumber.
    pub q: f64,
    /// Its direction, 0 or 1; the roots are factors along the other.
    pub along: usize,
    /// The roots neither zero nor infinite, by ascending `kappa`.
    pub roots: Vec<Root>,
    /// Roots that are zero: modes of the first cell alone.
    pub at_zero: usize,
    /// Roots that are infinite: modes of the last cell alone.
    pub at_infinity: usize,
    /// Whether the determinant vanishes at this wavenumber for every factor along the other direction: then there are
    /// no roots.
    pub vanishes: bool,
}

/// How well decay rates of opposite sign pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pairing {
    /// Largest `|kappa + kappa'|` of the k-th smallest and the k-th largest; `None` where all were left out.
    pub error: Option<f64>,
    /// The largest condition number of a root that was compared.
    pub condition: Option<f64>,
    /// Roots left out because their condition is too large.
    pub left_out: usize,
}

impl Decay {
    /// The roots `z2` at `z1 = exp(i q)` (`a` = 0), or `z1` at `z2 = exp(i q)` (`a` = 1).
    ///
    /// # Errors
    /// [`BlochError`] where the wavenumber is not finite, and where no roots are found.
    pub fn new(determinant: &Determinant, a: usize, q: f64) -> Result<Self, BlochError> {
        let polynomial = &determinant.polynomial;
        let (coefficients, sizes) = (polynomial.along(a, q), polynomial.sizes(a));
        let largest = polynomial.largest();
        let left = coefficients.iter().zip(&sizes).all(|(c, size)| c.norm() <= CANCELLED * size.max(largest));
        if left {
            return Ok(Self { q, along: a, roots: Vec::new(), at_zero: 0, at_infinity: 0, vanishes: true });
        }
        let Roots { finite, at_zero, at_infinity } = roots(&coefficients)?;
        let condition = |z: Complex<f64>| {
            // every coefficient carries the rounding of the largest
            let size: f64 = sizes
                .iter()
                .map(|size| size.max(largest))
                .enumerate()
                .map(|(k, size)| size * z.norm().powi(k as i32))
                .sum();
            size / (z * value_and_slope(&coefficients, z)[1]).norm()
        };
        let mut roots: Vec<Root> =
            finite.into_iter().map(|z| Root { z, condition: condition(z), multiplicity: 1 }).collect();
        roots.sort_by(|a, b| a.kappa().total_cmp(&b.kappa()));
        Ok(Self { q, along: a, roots, at_zero, at_infinity, vanishes: false })
    }

    /// The roots corrected on the matrix of which they are, those that the polynomial knows to less than twelve digits:
    /// the condition is then that of the matrix. Roots that coincide are corrected together. A root to which the matrix
    /// leads from two others stays as it is, and so does one from which it leads nowhere.
    pub fn refined(mut self, determinant: &Determinant, rigidity: &Rigidity) -> Self {
        let together = self.refine_clusters(&determinant.polynomial, rigidity);
        let mut search = SingularSearch::new(rigidity);
        let corrected = |(k, root): (usize, &Root)| {
            let wanted = root.condition > WELL_KNOWN && !together.contains(&k);
            if wanted { search.root(self.at(root.z), 1 - self.along) } else { None }
        };
        let found: Vec<Option<Root>> = self.roots.iter().enumerate().map(corrected).collect();
        let now: Vec<Root> = found.iter().zip(&self.roots).map(|(new, old)| new.unwrap_or(*old)).collect();
        for (k, new) in found.iter().enumerate() {
            let same = |j: usize| j != k && new.is_some_and(|new| (now[j].z / new.z - 1.0).norm() <= new.rounding());
            if let (Some(new), false) = (new, (0..now.len()).any(same)) {
                self.roots[k] = *new;
            }
        }
        self.roots.sort_by(|a, b| a.kappa().total_cmp(&b.kappa()));
        self
    }

    /// Both Bloch factors at a root.
    fn at(&self, root: Complex<f64>) -> [Complex<f64>; 2] {
        let mut z = [Complex::from_polar(1.0, self.q); 2];
        z[1 - self.along] = root;
        z
    }

    /// Corrects roots that coincide, and says which were corrected.
    fn refine_clusters(&mut self, polynomial: &Laurent, rigidity: &Rigidity) -> Vec<usize> {
        let mut done = Vec::new();
        for cluster in cluster::clusters(&self.roots) {
            // the sum of the roots of a cluster is known to all digits where each by itself is not
            let first = self.roots[cluster[0]].z;
            let ways = cluster.iter().map(|&k| (self.roots[k].z / first).ln());
            let middle = first * (ways.sum::<Complex<f64>>() / cluster.len() as f64).exp();
            let found = cluster::on_matrix(rigidity, self.at(middle), 1 - self.along, cluster.len());
            let found = found.or_else(|| {
                let root = cluster::of_polynomial(polynomial, (self.along, self.q), middle, cluster.len())?;
                cluster::is_singular(rigidity, self.at(root.z)).then(|| vec![root; cluster.len()])
            });
            for (k, root) in cluster.into_iter().zip(found.into_iter().flatten()) {
                self.roots[k] = root;
                done.push(k);
            }
        }
        done
    }

    /// How well the rates of the finite roots pair.
    pub fn pairing(&self) -> Pairing {
        let mut found = Pairing::default();
        for (low, high) in self.roots.iter().zip(self.roots.iter().rev()) {
            let condition = larger(low.condition, high.condition);
            if condition <= WELL_CONDITIONED {
                let error = (low.kappa() + high.kappa()).abs();
                found.error = worst(found.error.into_iter().chain([error]));
                found.condition = worst(found.condition.into_iter().chain([condition]));
            } else {
                found.left_out += 1;
            }
        }
        found
    }
}
