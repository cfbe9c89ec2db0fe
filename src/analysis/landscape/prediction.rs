//! The leading coefficient of a landscape, from linear solves alone.
//!
//! Along a linear mode the sheet moves by `x = x0 + a x1 + a^2 x2` and its rest angles by `p = p0 + a phi + a^2 p2`. Bars stretch by
//! `a^2 (R x2 + e2)` and hinges are off by `a^2 (G x2 + r2 - p2)`, with `e2`, `r2` the second derivatives of length and fold angle
//! along `x1`. The energy is `a^4` times
//!
//! `min over x2, p2 of  sum (K/2) (G x2 + r2 - p2)^2 + sum t^2 / 2k,   R x2 + e2 = t / k,`
//!
//! `p2` the same in every cell and orthogonal to the modes. Rigid bars are the case `1/k = 0`. The sources are quadratic in
//! the mode, so the coefficient is a quartic form: one linear solve for each pair of modes and one for each direction of
//! `p2` give it for all modes at once.

use super::patch::{Linear, Response};
use super::{LandscapeError, Patch};
use crate::model::{Domain, Elements};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::least_squares;
use crate::solver::{Curvature, Problem};
use nalgebra::DVector;

/// The landscape's leading coefficient, for every mode of a patch.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// Coefficient as a quadratic form in the products `a_i a_j`, `i <= j`, of the amplitudes along the modes' basis.
    form: DenseMatrix,
    /// The modes' basis.
    basis: DenseMatrix,
}

impl Prediction {
    /// Of a patch in the drawn state.
    ///
    /// Fails as [`LandscapeError`] says.
    pub fn new(patch: &Patch) -> Result<Self, LandscapeError> {
        let model = &patch.model;
        let mut linear =
            Linear::new(model, &model.start(), &vec![0.0; model.compliance().len()], Curvature::GaussNewton)?;
        let mut responses = Vec::new();
        for (i, j) in pairs(patch.modes.count()) {
            let weight = if i == j { 0.5 } else { 1.0 };
            let (off, stretch) = second_order(patch, [&patch.motions[i], &patch.motions[j]], weight);
            responses.push(linear.respond(model, &off, &stretch)?);
        }
        for direction in patch.free.column_iter() {
            let (off, stretch) = patch.spread((-direction).as_slice());
            responses.push(linear.respond(model, &off, &stretch)?);
        }
        let form = form(patch, &linear, &responses)?;
        Ok(Self { form, basis: patch.modes.basis.clone() })
    }

    /// The coefficient of `amplitude^4` of the mode with these fold rates.
    pub fn coefficient(&self, rates: &[f64]) -> f64 {
        let a = self.basis.tr_mul(&DVector::from_column_slice(rates));
        let products = DVector::from_iterator(self.form.nrows(), pairs(a.len()).map(|(i, j)| a[i] * a[j]));
        products.dot(&(&self.form * &products))
    }
}

/// Pairs of modes, each once.
fn pairs(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(move |j| (0..=j).map(move |i| (i, j)))
}

/// `weight v^T H w` of every soft element and of every stiff measure, `H` its second derivative in the drawn state.
fn second_order(patch: &Patch, motions: [&[f64]; 2], weight: f64) -> (Vec<f64>, Vec<f64>) {
    let model = &patch.model;
    let x = model.coordinates(&model.start());
    let mut local = Default::default();
    let mut of = |terms: &[Box<dyn Elements>]| -> Vec<f64> {
        let mut found = Vec::new();
        for (term, k) in terms.iter().flat_map(|term| (0..term.len()).map(move |k| (term, k))) {
            term.local(k, &Domain::Patch, &x, true, &mut local);
            let places = term.sites(k).iter().flat_map(|site| 3 * site.vertex..3 * site.vertex + 3);
            let [v, w] = motions.map(|motion| places.clone().map(|place| motion[place]).collect::<Vec<f64>>());
            found.push(weight * bilinear(&local.hessian, &v, &w));
        }
        found
    };
    (of(model.soft()), of(model.stiff()))
}

/// Half of the energy's form on the responses to pairs of modes, minimised over those to rest angles.
fn form(patch: &Patch, linear: &Linear, responses: &[Response]) -> Result<DenseMatrix, LandscapeError> {
    let product = |a: &Response, b: &Response| -> f64 {
        let hinges = a.off.iter().zip(&b.off).zip(linear.stiffness()).map(|((a, b), k)| k * a * b);
        let bars = a.tension.iter().zip(&b.tension).zip(patch.model.compliance()).map(|((a, b), c)| c * a * b);
        hinges.sum::<f64>() + bars.sum::<f64>()
    };
    let count = responses.len();
    let kept = count - patch.free.ncols();
    let all = DenseMatrix::from_fn(count, count, |i, j| product(&responses[i], &responses[j]));
    let pairs = all.view((0, 0), (kept, kept));
    if kept == count {
        return Ok(0.5 * pairs);
    }
    let free = all.view((kept, kept), (count - kept, count - kept)).into_owned();
    let cross = all.view((kept, 0), (count - kept, kept)).into_owned();
    let absorbed = least_squares(&free, &cross)?.solution;
    Ok(0.5 * (pairs - cross.transpose() * absorbed))
}

/// `v^T H w` from the lower triangle of `H`, row by row.
fn bilinear(lower: &[f64], v: &[f64], w: &[f64]) -> f64 {
    let mut sum = 0.0;
    let mut entries = lower.iter();
    for row in 0..v.len() {
        for (column, entry) in (0..=row).zip(entries.by_ref()) {
            let both = if row == column { v[row] * w[row] } else { v[row] * w[column] + v[column] * w[row] };
            sum += entry * both;
        }
    }
    sum
}
