//! Power series in a few unknowns, cut off at a degree.

use super::system::C;
use std::collections::HashMap;

/// The monomials up to a degree, by ascending degree, and their products.
pub(super) struct Monomials {
    pub degrees: Vec<usize>,
    products: Vec<Option<usize>>,
}

/// Coefficients in the order of the monomials.
pub(super) type Series = Vec<C>;

impl Monomials {
    pub fn new(unknowns: usize, degree: usize) -> Self {
        let mut exponents: Vec<Vec<usize>> = vec![vec![]];
        for _ in 0..unknowns {
            let longer = |known: &Vec<usize>| {
                let left = degree - known.iter().sum::<usize>();
                (0..=left).map(|power| [&known[..], &[power]].concat()).collect::<Vec<_>>()
            };
            exponents = exponents.iter().flat_map(longer).collect();
        }
        exponents
            .sort_by_key(|powers| (powers.iter().sum::<usize>(), powers.iter().rev().copied().collect::<Vec<_>>()));
        let number: HashMap<&Vec<usize>, usize> = exponents.iter().enumerate().map(|(k, powers)| (powers, k)).collect();
        let product = |a: &Vec<usize>, b: &Vec<usize>| {
            let powers: Vec<usize> = a.iter().zip(b).map(|(a, b)| a + b).collect();
            number.get(&powers).copied()
        };
        let products = exponents.iter().flat_map(|a| exponents.iter().map(move |b| (a, b)));
        let products = products.map(|(a, b)| product(a, b)).collect();
        Self { degrees: exponents.iter().map(|powers| powers.iter().sum()).collect(), products }
    }

    /// Number of monomials of `unknowns` unknowns of at most a degree: `(unknowns + degree)! / (unknowns! degree!)`.
    pub fn count(unknowns: usize, degree: usize) -> usize {
        (1..=unknowns).fold(1, |count, k| count * (degree + k) / k)
    }

    pub fn zero(&self) -> Series {
        vec![C::default(); self.degrees.len()]
    }

    /// Adds `factor * monomial * series`, as far as the degrees reach.
    pub fn add_shifted(&self, sum: &mut Series, factor: C, monomial: usize, series: &Series) {
        let places = &self.products[monomial * self.degrees.len()..];
        for (place, coefficient) in places.iter().zip(series) {
            if let Some(place) = place {
                sum[*place] += factor * coefficient;
            }
        }
    }

    /// Adds the product of two series.
    pub fn add_product(&self, sum: &mut Series, a: &Series, b: &Series) {
        for (monomial, coefficient) in a.iter().enumerate().filter(|(_, c)| **c != C::default()) {
            self.add_shifted(sum, *coefficient, monomial, b);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: `(1 + x + y)^2 = 1 + 2x + 2y + x^2 + 2xy + y^2`, and degrees beyond the last are cut off.
    #[test]
    fn products_are_cut_off() {
        let monomials = Monomials::new(2, 2);
        assert_eq!((monomials.degrees.clone(), Monomials::count(2, 2)), (vec![0, 1, 1, 2, 2, 2], 6));
        let [one, two] = [1.0, 2.0].map(|x| C::new(x, 0.0));
        let line = vec![one, one, one, C::default(), C::default(), C::default()];
        let (mut square, mut cube) = (monomials.zero(), monomials.zero());
        monomials.add_product(&mut square, &line, &line);
        assert_eq!(square, [one, two, two, one, two, one]);
        monomials.add_product(&mut cube, &square, &line);
        assert_eq!(cube[3..], [3.0, 6.0, 3.0].map(|x| C::new(x, 0.0)));
    }
}
