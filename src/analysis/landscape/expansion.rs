//! What one mode costs, to the sixth power of its amplitude, from linear solves alone.
//!
//! The sheet moves by `a x1 + a^2 x2 + a^3 x3 + ...` and its rest angles by `a phi + a^2 p2 + ...`, so hinges are off
//! by `a^2 h2 + a^3 h3 + ...` and bars have the tensions `a^2 t2 + a^3 t3 + ...`. With `m3`, `m4` the third and fourth
//! powers of all measures along `x0 + a x1 + a^2 x2`, `f2` the forces of `h2` and `t2`, which balance, and `p2` the
//! same in every cell and orthogonal to the modes,
//!
//! `E4 = sum (K/2) h2^2 + sum t2^2 / 2k`,  `E5 = f2 . m3`,
//! `E6 = f2 . m4 + min over x3, p3 of  sum (K/2) h3^2 + sum t3^2 / 2k + f2 . D^2 m [x1, x3]`.
//!
//! A mode that is rigid to second order has `h2 = t2 = 0`: then the sixth power leads, and `E6` tells whether it is
//! rigid to third order.

use super::settling::{self, Settling, TermValues};
use super::taylor_path::HeldState;
use super::{HeldSheet, LandscapeError, TaylorPath};
use crate::model::{Element, Local, Model};
use crate::numerics::vector::dot;
use crate::solver::{HessianKind, Problem};

/// Coefficients of the powers of the amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expansion {
    /// Of the fourth.
    pub fourth: f64,
    /// Of the fifth.
    pub fifth: f64,
    /// Of the sixth.
    pub sixth: f64,
}

impl Expansion {
    /// Returns the expansion, at the drawn state, of the energy along the mode that has these rates of the rest angles, and
    /// the path on which the sheet follows them, to third order.
    ///
    /// # Errors
    /// [`LandscapeError`] where the response of the sheet cannot be computed.
    pub fn with_course(held: &HeldSheet, rates: &[f64]) -> Result<(Self, TaylorPath), LandscapeError> {
        Self::at(held, &mut drawn(held)?, rates)
    }

    /// The same, the sheet being linearized in the drawn state already.
    pub(super) fn at(
        held: &HeldSheet,
        settling: &mut Settling<'_>,
        rates: &[f64],
    ) -> Result<(Self, TaylorPath), LandscapeError> {
        let model = &held.model;
        let (x0, x1) = (model.coordinates(&model.start()), held.motion(rates));
        let still = vec![0.0; x0.len()];
        let [second, _, _] = powers(model, &[&x0, &x1, &still])?;
        let at_second = settling.settle((&second.0, &second.1), None)?;
        let torques: Vec<f64> = settling.stiffness().iter().zip(&at_second.off).map(|(k, off)| k * off).collect();
        let work = |(soft, stiff): &TermValues| dot(&torques, soft) + dot(&at_second.place.tension, stiff);

        let [_, third, fourth] = powers(model, &[&x0, &x1, &model.velocity(&at_second.place.x)])?;
        let bent = model.unknowns(&curvature_forces(model, &x1, (&torques, &at_second.place.tension)));
        let against: Vec<f64> = bent.iter().map(|force| -force).collect();
        let at_third = settling.settle((&third.0, &third.1), Some(&against))?;
        let expansion = Self {
            fourth: 0.5 * settling.product(&at_second, &at_second),
            fifth: work(&third),
            sixth: work(&fourth) + 0.5 * settling.product(&at_third, &at_third) + dot(&bent, &at_third.place.x),
        };
        let first = HeldState { x: model.unknowns(&x1), ..held.still() };
        Ok((expansion, TaylorPath { rates: rates.to_vec(), orders: [first, at_second.place, at_third.place] }))
    }
}

/// The second, third and fourth powers of all measures, soft ones and stiff ones, along a path of all coordinates.
fn powers(model: &Model, path: &[&[f64]; 3]) -> Result<[TermValues; 3], LandscapeError> {
    let no_series = |element: &Element<'_>| LandscapeError::NotLinear { term: element.name().to_owned() };
    let series = model.elements().map(|element| element.along(path).ok_or_else(|| no_series(&element)));
    let series: Vec<[f64; 5]> = series.map(|found| Ok(found?.0)).collect::<Result<_, LandscapeError>>()?;
    let (soft, stiff) = series.split_at(model.soft_elements());
    let of = |power: usize, series: &[[f64; 5]]| series.iter().map(|series| series[power]).collect();
    Ok([2, 3, 4].map(|power| (of(power, soft), of(power, stiff))))
}

/// The sheet linearized in the drawn state.
pub(super) fn drawn(held: &HeldSheet) -> Result<Settling<'_>, LandscapeError> {
    let model = &held.model;
    let still = vec![0.0; model.compliance().len()];
    Settling::new(held, (&model.start(), &still), HessianKind::GaussNewton, settling::FINE)
}

/// `sum f H v` on all coordinates, `f` the forces of the soft elements and of the stiff measures, `H` their second
/// derivatives in the drawn state.
fn curvature_forces(model: &Model, v: &[f64], (soft, stiff): (&[f64], &[f64])) -> Vec<f64> {
    let x = model.coordinates(&model.start());
    let shared = x.len() - model.domain().shared()..x.len();
    let (mut all, mut local) = (vec![0.0; v.len()], Local::default());
    for element in model.elements() {
        element.local(&x, true, &mut local);
        let vertices = element.sites().iter().flat_map(|site| 3 * site.vertex..3 * site.vertex + 3);
        let places: Vec<usize> = vertices.chain(shared.clone()).collect();
        let moving: Vec<f64> = places.iter().map(|&place| v[place]).collect();
        let number = element.number;
        let force = soft.get(number).copied().unwrap_or_else(|| stiff[number - soft.len()]);
        let product = product(&local.hessian, &moving);
        places.iter().zip(&product).for_each(|(&place, h)| all[place] += force * h);
    }
    all
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
