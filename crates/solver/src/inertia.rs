//! The number of negative eigenvalues of the Hessian `H` on what rigid measures leave free: of `H + R^T C^-1 R`, where
//! a compliance of zero leaves only motions with `R dx = 0`.
//!
//! The factored matrix `S = H + R^T W R` of [`kkt`](super::kkt) has weights `W` that are at most a few million times
//! the Hessian. Its count is an upper bound, since a larger weight can only take negative eigenvalues away. The bound
//! is not always reached: where gradients of rigid measures nearly depend on each other, as those of a compressed
//! column do, a direction that they block is still too soft in `S`; and rounding errors of the weights hide the sign of
//! small eigenvalues, which the bound counts as negative. Motions decide: on the span of any motions that meet the
//! measures, `H` has at most as many eigenvalues below a value as on the whole (Courant and Fischer). These motions are
//! a block Krylov space of the inverse of the true system, which is solved by corrections with the factorization of
//! `S`. Once they are as many as the bound allows, the energies along them, in which no weight stands, tell which are
//! negative. Where they are fewer, heavier weights lower the bound; what then still differs is not known. Small
//! problems are projected on the null space of the rigid measures instead.

use super::kkt::{hessian_size, largest_weighted_entry};
use super::linearization::Linearization;
use super::tangent::Tangent;
use foldwell_numerics::dense::Svd;
use foldwell_numerics::factor::FactorError;
use foldwell_numerics::random::numbers;
use foldwell_numerics::sparse::{Rows, symmetric_product};
use foldwell_numerics::vector::{add_scaled, dot_blocked, larger, norm_blocked};
use foldwell_numerics::{DenseMatrix, dense};

/// Eigenvalues of `S` up to this, relative to its largest diagonal entry, may be zero: rounding errors of the sums in
/// its entries are about as large.
const ZERO_EIGENVALUE: f64 = 1e-14;
/// The same of the Hessian on motions that meet the measures.
const ZERO_IN_PROJECTION: f64 = 1e-12;
/// Problems of at most this many unknowns are projected dense, which takes a few milliseconds.
const DENSE_LIMIT: usize = 120;
/// The same where the bounds do not meet: about a second.
const MOST_PROJECTED: usize = 800;
/// Singular values of the gradients of rigid measures, relative to the largest one, up to which they may be zero:
/// rounding errors, and errors of the state by which they change.
const ZERO_SINGULAR_VALUES: [f64; 2] = [1e-12, 1e-9];
/// Least and largest unit of tensions of finite measures in the dense matrix, relative to the Hessian over a gradient's
/// size.
const UNITS_OF_TENSIONS: [f64; 2] = [1e-3, 1e3];
/// Weights of further counts, relative to the usual ones. Heavier ones lose small eigenvalues to rounding.
const HEAVIER_WEIGHTS: [f64; 3] = [1e2, 1e3, 1e5];
/// Counts above this are not confirmed by motions, which cost about two solves each, but by the count of a heavier
/// weight.
const MOST_CONFIRMED_BY_MOTIONS: usize = 64;
/// Number of motions tried, for every negative eigenvalue that is looked for and besides.
const MOTIONS_PER_EIGENVALUE: usize = 3;
const FURTHER_MOTIONS: usize = 24;
/// Number of motions that one random force leads to, by solving again and again. Repeated eigenvalues, as symmetric
/// sheets have, need several forces.
const MOTIONS_PER_FORCE: usize = 8;
/// Number of motions that are asked whether a state near one that is stable is stable too: next to a critical load the
/// softest motion outweighs all others after two or three solves.
const SOFTEST_MOTIONS: usize = 3;
/// Number of random forces in a row that lead to no new motion after which all motions are taken to be found.
const BARREN_FORCES: usize = 2;
/// Relative residual to which the true system is solved.
const SOLVED: f64 = 1e-12;
/// Largest stretch of a rigid measure by a motion of length 1 that meets the measures, in natural sizes: between
/// rounding errors and the singular values of gradients that nearly depend on each other, which are `P / EA` for a
/// column under a load `P` and smaller for the higher modes of a long one.
const MEETS_MEASURES: f64 = 1e-12;
/// Number of times that a motion is brought onto the measures.
const MOST_CORRECTIONS: usize = 3;
/// Part of a motion that must be new.
const LEAST_NEW_PART: f64 = 1e-6;
/// Seed of the random forces.
const SEED: u64 = 1;

impl Tangent {
    /// Number of negative eigenvalues of the Hessian on what the rigid measures leave free; `None` where it cannot be
    /// established. Eigenvalues that are zero to rounding error count as positive. Factors anew.
    ///
    /// # Errors
    /// As [`Tangent::factor`].
    pub fn negative_eigenvalues(&mut self) -> Result<Option<usize>, FactorError> {
        let zero = zero_eigenvalue(&self.at, &self.compliance);
        // with those that may be zero
        let in_doubt = self.count_negative([-zero, 1.0])?;
        if self.at.gradient.len() <= DENSE_LIMIT {
            return Ok(negative_by_projection(&self.at, &self.compliance));
        }
        if in_doubt == 0 {
            return Ok(Some(0));
        }
        if in_doubt <= MOST_CONFIRMED_BY_MOTIONS {
            let mut motions = Motions::new(self, -zero);
            if motions.negative(in_doubt) == in_doubt {
                return Ok(Some(motions.falling()));
            }
            if self.at.gradient.len() <= MOST_PROJECTED {
                return Ok(negative_by_projection(&self.at, &self.compliance));
            }
        }
        // too many may be zero, as of a mechanism, or the motions of a large sheet were not found: those that may be zero
        // are left out
        let most = self.count_negative([zero, 1.0])?;
        if most == 0 || self.system.weights_are_exact() {
            return Ok(Some(most));
        }
        let least = if most <= MOST_CONFIRMED_BY_MOTIONS { Motions::new(self, zero).negative(most) } else { most };
        if least == most && most <= MOST_CONFIRMED_BY_MOTIONS {
            return Ok(Some(most));
        }
        for heavier in HEAVIER_WEIGHTS {
            // less what rounding errors of such weights may add to an eigenvalue, so that the count is an upper bound all
            // the same
            if self.count_negative([-zero * heavier, heavier])? == least {
                return Ok(Some(least));
            }
        }
        Ok(if self.at.gradient.len() <= MOST_PROJECTED {
            negative_by_projection(&self.at, &self.compliance)
        } else {
            None
        })
    }

    /// A motion that meets the stiff measures to first order and on which the energy falls to second, rates of the
    /// unknowns of length 1; `None` where none is found. Factors anew.
    ///
    /// # Errors
    /// As [`Tangent::factor`].
    pub fn falling_motion(&mut self) -> Result<Option<Vec<f64>>, FactorError> {
        let zero = zero_eigenvalue(&self.at, &self.compliance);
        let in_doubt = self.count_negative([-zero, 1.0])?;
        let mut motions = Motions::new(self, -zero);
        motions.negative(in_doubt.min(MOST_CONFIRMED_BY_MOTIONS));
        Ok(if motions.falling() > 0 { motions.lowest() } else { None })
    }

    /// Whether the energy falls to second order on one of the softest motions that meet the stiff measures, as the last
    /// factorization shows them; it may have been made at another state near by. Motions are few: a quick look, and no
    /// count.
    pub(super) fn softest_falls(&mut self) -> bool {
        let mut motions = Motions::new(self, 0.0);
        motions.answer(&mut numbers(SEED), SOFTEST_MOTIONS);
        motions.falling() > 0
    }

    fn count_negative(&mut self, zero_and_weight: [f64; 2]) -> Result<usize, FactorError> {
        self.system.count_negative(&self.at, &self.compliance, zero_and_weight)
    }
}

/// Size up to which an eigenvalue of the factored matrix may be zero.
fn zero_eigenvalue(at: &Linearization, compliance: &[f64]) -> f64 {
    larger(ZERO_EIGENVALUE * largest_weighted_entry(at, compliance), ZERO_IN_PROJECTION * at.rest_stiffness)
}

/// Number of negative eigenvalues by a projection on the null space of the rigid measures, dense; `None` where singular
/// values of which it cannot be told whether they are zero make a difference. No weights of rigid measures spoil small
/// eigenvalues here: those above minus [`ZERO_IN_PROJECTION`] of the largest diagonal entry count as zero.
fn negative_by_projection(at: &Linearization, compliance: &[f64]) -> Option<usize> {
    let zero = ZERO_IN_PROJECTION * larger(hessian_size(at), at.rest_stiffness);
    let rows = Rows { cliques: at.rows().cliques, values: &at.scaled_jacobian() };
    let rows = dense::from_rows(&rows, at.gradient.len());
    let rigid: Vec<usize> = (0..compliance.len()).filter(|&row| compliance[row] == 0.0).collect();
    let Svd { v, singular_values, .. } = dense::full_svd(&rows.select_rows(&rigid)).ok()?;
    let largest = singular_values.first().copied().unwrap_or(0.0);
    let counted = ZERO_SINGULAR_VALUES.map(|cut| {
        let rank = singular_values.iter().filter(|value| **value > cut * largest).count();
        let free = v.columns(rank, v.ncols() - rank).into_owned();
        negative_on(at, (compliance, &rows), &free, zero)
    });
    if counted[0] == counted[1] { counted[0] } else { None }
}

/// Number of negative eigenvalues of the Hessian on the span of motions that rigid measures leave free, columns of a
/// matrix. Measures of finite stiffness keep their tensions as unknowns, each of which adds one negative eigenvalue: no
/// stiffness is so large that rounding errors of its multiples matter. Tensions are in units in which compliances are
/// of the size of the Hessian, as far as that leaves the gradients of measures moderate: beside a Hessian of large
/// tensions a small compliance would be lost to rounding.
fn negative_on(
    at: &Linearization,
    (compliance, rows): (&[f64], &DenseMatrix),
    free: &DenseMatrix,
    zero: f64,
) -> Option<usize> {
    let finite: Vec<usize> = (0..compliance.len()).filter(|&row| compliance[row] > 0.0).collect();
    let mut hessian = at.pattern().to_dense(&at.hessian);
    (0..hessian.nrows()).for_each(|k| hessian[(k, k)] += zero);
    let (hessian, rows) = (free.transpose() * hessian * free, rows.select_rows(&finite) * free);
    let (motions, tensions) = (free.ncols(), finite.len());
    let size = if hessian.amax() > 0.0 { hessian.amax() } else { 1.0 };
    let mut whole = DenseMatrix::zeros(motions + tensions, motions + tensions);
    whole.view_mut((0, 0), (motions, motions)).copy_from(&hessian);
    for (k, row) in finite.into_iter().enumerate() {
        let natural = compliance[row] / at.sizes[row].powi(2);
        let unit = size * (natural * size).sqrt().recip().clamp(UNITS_OF_TENSIONS[0], UNITS_OF_TENSIONS[1]);
        whole.view_mut((motions + k, 0), (1, motions)).copy_from(&(rows.row(k) * unit));
        whole[(motions + k, motions + k)] = -natural * unit * unit;
    }
    let negative = dense::symmetric_eigenvalues(&whole).ok()?.iter().filter(|value| **value < 0.0).count();
    negative.checked_sub(tensions)
}

/// A number of negative eigenvalues in a message.
pub fn in_words(count: Option<usize>) -> String {
    count.map_or_else(|| "an unknown number of".to_owned(), |count| count.to_string())
}

/// One motion that meets the stiff measures: `R dx = C dt`.
struct ConstrainedMotion {
    dx: Vec<f64>,
    dt: Vec<f64>,
    /// The Hessian times `dx`.
    force: Vec<f64>,
}

/// Orthonormal motions that meet the stiff measures.
struct Motions<'a> {
    tangent: &'a mut Tangent,
    /// Multiple of the identity that is added to the Hessian.
    zero: f64,
    found: Vec<ConstrainedMotion>,
    /// The lower triangle of `dx H dx + dt C dt` between them.
    energies: Vec<Vec<f64>>,
}

impl<'a> Motions<'a> {
    fn new(tangent: &'a mut Tangent, zero: f64) -> Self {
        Self { tangent, zero, found: vec![], energies: vec![] }
    }

    /// Number of negative eigenvalues on the span of motions, which grows until there are `most`, or until random
    /// forces lead to no new motions.
    fn negative(&mut self, most: usize) -> usize {
        let unknowns = self.tangent.at.gradient.len();
        let enough = unknowns.min(MOTIONS_PER_EIGENVALUE * most + FURTHER_MOTIONS);
        let (mut random, mut negative, mut barren) = (numbers(SEED), 0, 0);
        while negative < most && self.found.len() < enough && barren < BARREN_FORCES {
            let before = self.found.len();
            self.answer(&mut random, MOTIONS_PER_FORCE);
            if self.found.len() > before {
                (negative, barren) = (self.below(0.0), 0);
            } else {
                barren += 1;
            }
        }
        negative
    }

    /// Adds up to this many motions to which a random force leads, each as a force on the next: ever softer ones.
    fn answer(&mut self, random: &mut dyn Iterator<Item = f64>, count: usize) {
        let mut force: Vec<f64> = random.take(self.tangent.at.gradient.len()).collect();
        for _ in 0..count {
            let Some(motion) = self.next_motion(&force) else { break };
            force.clone_from(&motion.dx);
            self.push(motion);
        }
    }

    /// The motion that a force makes, without its parts along those already found; `None` where nothing is left of it,
    /// or where it does not meet the measures.
    fn next_motion(&mut self, force: &[f64]) -> Option<ConstrainedMotion> {
        let nothing = vec![0.0; self.tangent.compliance.len()];
        let step = self.tangent.solve(force, &nothing, SOLVED);
        let (mut dx, mut dt) = self.across_the_others(step.dx, step.dt)?;
        for _ in 0..MOST_CORRECTIONS {
            let open = self.open_stretch(&dx, &dt);
            if self.largest_stretch(&open) <= MEETS_MEASURES {
                break;
            }
            // what is left is short, and rounding errors of the whole were not
            let no_force = vec![0.0; dx.len()];
            let back = self.tangent.solve(&no_force, &open, SOLVED);
            add_scaled(&mut dx, -1.0, &back.dx);
            add_scaled(&mut dt, -1.0, &back.dt);
            (dx, dt) = self.across_the_others(dx, dt)?;
        }
        if self.largest_stretch(&self.open_stretch(&dx, &dt)) > MEETS_MEASURES {
            return None;
        }
        let mut product = vec![0.0; dx.len()];
        symmetric_product(self.tangent.at.pattern(), &self.tangent.at.hessian, &dx, &mut product);
        add_scaled(&mut product, self.zero, &dx);
        Some(ConstrainedMotion { dx, dt, force: product })
    }

    /// A motion without its parts along those already found, scaled to length 1; `None` where next to nothing is left.
    fn across_the_others(&self, mut dx: Vec<f64>, mut dt: Vec<f64>) -> Option<(Vec<f64>, Vec<f64>)> {
        let length = norm_blocked(&dx);
        for _ in 0..2 {
            for other in &self.found {
                let part = dot_blocked(&dx, &other.dx);
                add_scaled(&mut dx, -part, &other.dx);
                add_scaled(&mut dt, -part, &other.dt);
            }
        }
        let new = norm_blocked(&dx);
        dx.iter_mut().chain(&mut dt).for_each(|rate| *rate /= new);
        (new > LEAST_NEW_PART * length).then_some((dx, dt))
    }

    /// The stretch `R dx - C dt` of every measure.
    fn open_stretch(&self, dx: &[f64], dt: &[f64]) -> Vec<f64> {
        let mut stretch = vec![0.0; self.tangent.compliance.len()];
        self.tangent.at.rows().product(dx, &mut stretch);
        stretch.iter_mut().zip(&self.tangent.compliance).zip(dt).for_each(|((stretch, c), dt)| *stretch -= c * dt);
        stretch
    }

    /// The largest of these stretches, in natural sizes.
    fn largest_stretch(&self, stretch: &[f64]) -> f64 {
        stretch.iter().zip(&self.tangent.at.sizes).map(|(stretch, size)| (stretch / size).abs()).fold(0.0, larger)
    }

    /// Adds a motion, and its row of `dx H dx + dt C dt`.
    fn push(&mut self, motion: ConstrainedMotion) {
        self.found.push(motion);
        let [.., last] = self.found.as_slice() else { return };
        let entry = |other: &ConstrainedMotion| {
            let stretched = last.dt.iter().zip(&other.dt).zip(&self.tangent.compliance).map(|((a, b), c)| a * b * c);
            dot_blocked(&last.dx, &other.force) + stretched.sum::<f64>()
        };
        self.energies.push(self.found.iter().map(entry).collect());
    }

    /// The motion of the span, of length 1, with the lowest `dx H dx + dt C dt`.
    fn lowest(&self) -> Option<Vec<f64>> {
        let vectors = dense::symmetric_eigen(&self.energies_on_span()).ok()?.vectors;
        let mut lowest = vec![0.0; self.tangent.at.gradient.len()];
        self.found.iter().enumerate().for_each(|(k, motion)| add_scaled(&mut lowest, vectors[(k, 0)], &motion.dx));
        Some(lowest)
    }

    fn energies_on_span(&self) -> DenseMatrix {
        let count = self.found.len();
        DenseMatrix::from_fn(count, count, |i, j| self.energies[i.max(j)][i.min(j)])
    }

    /// Number of independent motions of the span on which the energy itself, without the multiple of the identity,
    /// falls by more than counts as zero.
    fn falling(&self) -> usize {
        self.below(self.zero - ZERO_IN_PROJECTION * hessian_size(&self.tangent.at))
    }

    /// Number of eigenvalues of `dx H dx + dt C dt` on the span of the motions that are smaller than a value; 0 where
    /// they cannot be found.
    fn below(&self, limit: f64) -> usize {
        let values = dense::symmetric_eigenvalues(&self.energies_on_span()).unwrap_or_default();
        values.iter().filter(|value| **value < limit).count()
    }
}
