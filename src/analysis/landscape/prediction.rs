//! The leading coefficient of a landscape, from linear solves alone.
//!
//! Along a linear mode the sheet moves by `x = x0 + a x1 + a^2 x2` and its rest angles by `p = p0 + a phi + a^2 p2`.
//! Bars stretch by `a^2 (R x2 + e2)` and hinges are off by `a^2 (G x2 + r2 - p2)`, with `e2`, `r2` the second
//! derivatives of length and fold angle along `x1`. The energy is `a^4` times
//!
//! `min over x2, p2 of  sum (K/2) (G x2 + r2 - p2)^2 + sum t^2 / 2k,   R x2 + e2 = t / k,`
//!
//! `p2` the same in every cell and orthogonal to the modes. Rigid bars are the case `1/k = 0`. The sources are
//! quadratic in the mode, so the coefficient is a quartic form: one linear solve for each pair of modes and one for
//! each direction of `p2` give it for all modes at once.

use super::settling::{self, Settling, TermValues};
use super::{HeldSheet, LandscapeError};
use crate::model::Model;
use crate::numerics::DenseMatrix;
use crate::solver::{HessianKind, Problem};
use nalgebra::DVector;

/// The landscape's leading coefficient, for every mode of a sheet.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// Coefficient as a quadratic form in the products `a_i a_j`, `i <= j`, of the amplitudes along the modes' basis.
    form: DenseMatrix,
    /// The modes' basis.
    basis: DenseMatrix,
}

impl Prediction {
    /// Of a sheet in the drawn state.
    ///
    /// # Errors
    /// [`LandscapeError`] where the modes of the sheet are not known, or its linear algebra fails.
    pub fn new(held: &HeldSheet) -> Result<Self, LandscapeError> {
        let mut settling = drawn(held)?;
        let mut responses = Vec::new();
        for (i, j) in pairs(held.basis.ncols()) {
            let weight = if i == j { 0.5 } else { 1.0 };
            let (off, stretch) = second_order(&held.model, [&held.motions[i], &held.motions[j]], weight);
            responses.push(settling.settle((&off, &stretch), None)?);
        }
        let product = |i: usize, j: usize| 0.5 * settling.product(&responses[i], &responses[j]);
        let form = DenseMatrix::from_fn(responses.len(), responses.len(), product);
        Ok(Self { form, basis: held.basis.clone() })
    }

    /// The coefficient of `amplitude^4` of the mode with these fold rates.
    pub fn coefficient(&self, rates: &[f64]) -> f64 {
        let products = self.products(rates);
        products.dot(&(&self.form * &products))
    }

    /// The largest coefficient that a mode of the same size could have.
    pub fn largest(&self, rates: &[f64]) -> f64 {
        self.form.norm() * self.products(rates).norm_squared()
    }

    fn products(&self, rates: &[f64]) -> DVector<f64> {
        let a = self.basis.tr_mul(&DVector::from_column_slice(rates));
        DVector::from_iterator(self.form.nrows(), pairs(a.len()).map(|(i, j)| a[i] * a[j]))
    }
}

/// The sheet linearized in the drawn state.
pub(super) fn drawn(held: &HeldSheet) -> Result<Settling<'_>, LandscapeError> {
    let model = &held.model;
    let still = vec![0.0; model.compliance().len()];
    Settling::new(held, (&model.start(), &still), HessianKind::GaussNewton, settling::FINE)
}

/// Pairs of modes, each once.
fn pairs(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(move |j| (0..=j).map(move |i| (i, j)))
}

/// `weight v^T H w` of every soft element and of every stiff measure, `H` its second derivative in the drawn state.
fn second_order(model: &Model, [v, w]: [&[f64]; 2], weight: f64) -> TermValues {
    let mut found: (Vec<f64>, Vec<f64>) = Default::default();
    each_curvature(model, v, |element, places, product| {
        let value = weight * places.iter().zip(product).map(|(&place, h)| w[place] * h).sum::<f64>();
        if element < model.layout().soft.len() { found.0.push(value) } else { found.1.push(value) }
    });
    found
}

/// `sum f H v` on all coordinates, `f` the forces of the soft elements and of the stiff measures.
pub(super) fn curvature_forces(model: &Model, v: &[f64], (soft, stiff): (&[f64], &[f64])) -> Vec<f64> {
    let mut all = vec![0.0; v.len()];
    each_curvature(model, v, |element, places, product| {
        let force = soft.get(element).copied().unwrap_or_else(|| stiff[element - soft.len()]);
        places.iter().zip(product).for_each(|(&place, h)| all[place] += force * h);
    });
    all
}

/// Calls with the number of every element (soft ones first), the coordinates it depends on, and `H v` there: `H` its
/// second derivative in the drawn state.
fn each_curvature(model: &Model, v: &[f64], mut call: impl FnMut(usize, &[usize], &[f64])) {
    let x = model.coordinates(&model.start());
    let shared = x.len() - model.domain().shared()..x.len();
    let mut local = Default::default();
    for element in model.elements() {
        element.local(&x, true, &mut local);
        let vertices = element.sites().iter().flat_map(|site| 3 * site.vertex..3 * site.vertex + 3);
        let places: Vec<usize> = vertices.chain(shared.clone()).collect();
        let moving: Vec<f64> = places.iter().map(|&place| v[place]).collect();
        call(element.number, &places, &product(&local.hessian, &moving));
    }
}

/// `H v` from the lower triangle of `H`, row by row.
fn product(lower: &[f64], v: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; v.len()];
    let mut entries = lower.iter();
    for row in 0..v.len() {
        for (column, entry) in (0..=row).zip(entries.by_ref()) {
            product[row] += entry * v[column];
            if column < row {
                product[column] += entry * v[row];
            }
        }
    }
    product
}
