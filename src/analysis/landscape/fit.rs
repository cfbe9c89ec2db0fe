//! Leading coefficient and exponent of a landscape from its samples.

use super::Expansion;
use crate::numerics::DenseMatrix;
use crate::numerics::dense::small::inverse;

/// The samples that the exponent is taken from, at most: those of smallest amplitude.
const SMALLEST: usize = 3;

/// A number with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// One standard error; `None` where as many numbers were fitted as there are samples: then nothing tells it.
    pub error: Option<f64>,
}

/// The coefficient `c4` of `energy = c4 a^4 + c5 a^5 + c6 a^6`, fitted to `(amplitude, energy)`; with fewer than three
/// samples the last terms are left out. `None` without samples.
pub fn coefficient(samples: &[(f64, f64)]) -> Option<Estimate> {
    let terms = samples.len().min(3);
    let largest = samples.iter().map(|(a, _)| a.abs()).fold(0.0, f64::max);
    let rows: Vec<(Vec<f64>, f64)> = samples
        .iter()
        .map(|(a, energy)| ((0..terms).map(|k| (a / largest).powi(k as i32)).collect(), energy / a.powi(4)))
        .collect();
    first(&rows, terms)
}

/// Whether a fitted coefficient is the predicted one within three of its standard errors and what the series leaves out
/// at the largest amplitude: not more than its fifth and sixth orders, and a thousandth for what linear solves lose.
pub fn agrees(samples: &[(f64, f64)], fitted: Estimate, predicted: Expansion) -> bool {
    let largest = samples.iter().map(|(a, _)| a.abs()).fold(0.0, f64::max);
    let next = predicted.fifth.abs() * largest + predicted.sixth.abs() * largest.powi(2);
    (fitted.value - predicted.fourth).abs() <= 3.0 * fitted.error.unwrap_or(0.0) + 1e-3 * predicted.fourth.abs() + next
}

/// The slope of log energy against log amplitude, from the three samples of smallest amplitude. `None` with fewer than
/// two, or where an energy is not positive.
pub fn exponent(samples: &[(f64, f64)]) -> Option<Estimate> {
    let mut smallest: Vec<(f64, f64)> = samples.to_vec();
    smallest.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    smallest.truncate(SMALLEST);
    if smallest.len() < 2 || smallest.iter().any(|(_, energy)| !(*energy > 0.0)) {
        return None;
    }
    let rows: Vec<(Vec<f64>, f64)> =
        smallest.iter().map(|(a, energy)| (vec![a.abs().ln(), 1.0], energy.ln())).collect();
    first(&rows, 2)
}

/// The first unknown of a least-squares fit.
fn first(rows: &[(Vec<f64>, f64)], unknowns: usize) -> Option<Estimate> {
    if rows.len() < unknowns || unknowns == 0 {
        return None;
    }
    let matrix = DenseMatrix::from_fn(rows.len(), unknowns, |row, column| rows[row].0[column]);
    let right = DenseMatrix::from_fn(rows.len(), 1, |row, _| rows[row].1);
    let normal = inverse(matrix.transpose() * &matrix)?;
    let solution = &normal * matrix.transpose() * &right;
    let left = (&matrix * &solution - right).norm_squared();
    let spare = rows.len() - unknowns;
    let error = (spare > 0).then(|| (left / spare as f64 * normal[(0, 0)]).sqrt());
    Some(Estimate { value: solution[0], error })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: polynomials of the fitted form give their coefficients back, and powers their exponents, with no error
    /// left. Tolerance: rounding, times the condition of the fit.
    #[test]
    fn what_was_put_in_comes_out() {
        let energy = |a: f64| 7.0 * a.powi(4) - 3.0 * a.powi(5) + 2.0 * a.powi(6);
        let samples: Vec<(f64, f64)> = [0.1, 0.2, 0.05, 0.3].iter().map(|&a| (a, energy(a))).collect();
        let found = coefficient(&samples).unwrap();
        assert!((found.value - 7.0).abs() <= 1e-11 && found.error.unwrap() <= 1e-11, "{found:?}");
        let powers: Vec<(f64, f64)> = [0.1, 0.2, 0.05, 3.0].iter().map(|&a: &f64| (a, 5.0 * a.powi(6))).collect();
        let slope = exponent(&powers).unwrap();
        assert!((slope.value - 6.0).abs() <= 1e-12 && slope.error.unwrap() <= 1e-12, "{slope:?}");
        let predicted = |fourth: f64| Expansion { fourth, fifth: -3.0, sixth: 2.0 };
        assert!(agrees(&samples[2..3], found, predicted(7.0)) && !agrees(&samples[2..3], found, predicted(7.2)));
        assert_eq!(exponent(&[(0.1, 0.0), (0.2, 1.0)]), None);
        assert_eq!(coefficient(&[]), None);
        let alone = coefficient(&[(0.5, 0.25)]).unwrap();
        assert!((alone.value - 4.0).abs() <= 1e-14);
        // as many samples as numbers: any would be met without an error
        assert_eq!((alone.error, exponent(&powers[..2]).unwrap().error), (None, None));
    }
}
