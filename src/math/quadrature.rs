//! Integrals of smooth functions, and of those with a few kinks.

/// Nodes and weights of the Gauss-Legendre rule of eight points on [-1, 1]; the other four are their mirror images.
const RULE: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
];

/// Error of an interval, relative to what rounding errors of the variable make of the whole integral, with which it is
/// not halved any more.
const ENOUGH: f64 = 0.5 * f64::EPSILON;

/// Largest number of intervals: a kink takes two of them for each binary digit of its place.
const MOST: usize = 150;

/// Returns the integrals of several functions from one value to another by one rule, exact for polynomials of degree 15.
pub(crate) fn by_rule<const N: usize>(mut f: impl FnMut(f64) -> [f64; N], [from, to]: [f64; 2]) -> [f64; N] {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut sum = [0.0; N];
    for [node, weight] in RULE {
        for values in [f(middle - half * node), f(middle + half * node)] {
            sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += half * weight * value);
        }
    }
    sum
}

/// Returns the integrals of several functions from one value to another: intervals are halved until that changes
/// nothing.
pub(crate) fn integral<const N: usize>(f: impl Fn(f64) -> [f64; N], from: f64, to: f64) -> [f64; N] {
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; N];
    let mut on = |ends: [f64; 2]| {
        let seen = |x: f64| {
            let values = f(x);
            for ([low, high], value) in range.iter_mut().zip(values) {
                (*low, *high) = (low.min(value), high.max(value));
            }
            values
        };
        (by_rule(seen, ends), range)
    };
    let [length, furthest] = [(to - from).abs(), from.abs().max(to.abs())];
    let (mut total, mut used) = ([0.0; N], 1);
    let mut open = vec![([from, to], on([from, to]).0)];
    while let Some(([a, b], whole)) = open.pop() {
        let middle = 0.5 * (a + b);
        let ((left, _), (right, range)) = (on([a, middle]), on([middle, b]));
        let is_rough = |k: usize| {
            let [low, high] = range[k];
            let rounding = length * low.abs().max(high.abs()) + furthest * (high - low);
            (left[k] + right[k] - whole[k]).abs() > ENOUGH * rounding
        };
        used += 2;
        if used < MOST && (0..N).any(is_rough) {
            open.extend([([a, middle], left), ([middle, b], right)]);
        } else {
            (0..N).for_each(|k| total[k] += left[k] + right[k]);
        }
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: integrals are right to the last digits, backwards and across kinks too. Source: closed forms.
    #[test]
    fn integrals_are_right() {
        type Integral = (fn(f64) -> f64, f64, f64, f64);
        let cases: [Integral; 5] = [
            (|x| x.exp(), 0.0, 2.0, 2f64.exp() - 1.0),
            (|x| x.tan(), 0.0, 1.5, -1.5f64.cos().ln()),
            (|x| 1.0 / (1.0 + 25.0 * x * x), -1.0, 1.0, 0.4 * 5f64.atan()),
            (|x| (x - 0.3).max(0.0), 2.0, -1.0, -0.5 * 1.7 * 1.7),
            (|x| x.abs().cbrt(), 0.0, 1.0, 0.75),
        ];
        for (k, (f, from, to, expected)) in cases.into_iter().enumerate() {
            let [found] = integral(|x| [f(x)], from, to);
            assert!((found - expected).abs() < 4e-15 * expected.abs().max(1.0), "{k}: {found} {expected}");
        }
        assert!(integral(|_| [f64::NAN], 0.0, 1.0)[0].is_nan());
    }
}
