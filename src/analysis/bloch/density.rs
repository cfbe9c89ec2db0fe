//! The density of states: how many frequencies lie in an interval, over all wavenumbers of the Brillouin zone.
//!
//! Each square of a grid of wavenumbers is cut into two triangles, in which a band is taken as linear. The part of a
//! triangle with values up to `w` is then known in closed form, from the ascending values `a <= b <= c` at its corners:
//!
//! ```text
//! 0 for w < a;   (w - a)^2 / ((b - a) (c - a)) up to b;   1 - (c - w)^2 / ((c - a) (c - b)) up to c;   1 from c on
//! ```
//!
//! Numbers in bins are differences of it at the edges of the bins, so that they add up to the number of bands exactly,
//! whatever the grid. Source: G. Lehmann, M. Taut, Phys. Status Solidi B 54, 469 (1972), there with tetrahedra in three
//! dimensions.

/// The density of states per cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Density {
    /// Edges of the bins, ascending and equally far apart, from 0 to the largest frequency on the grid.
    pub edges: Vec<f64>,
    /// Number of states of a cell with frequencies in each bin, over the width of the bin: the integral is the number
    /// of bands.
    pub values: Vec<f64>,
}

impl Density {
    /// Returns the density of bands, which are not negative, on a periodic grid of wavenumbers: one list of values,
    /// ascending, for each wavenumber, the first one running faster. All lists have the same length.
    ///
    /// ```
    /// use foldwell::analysis::bloch::Density;
    ///
    /// // one band, the same at all wavenumbers
    /// let density = Density::new(&vec![vec![2.0]; 9], [3, 3], 4);
    /// assert_eq!(density.edges, [0.0, 0.5, 1.0, 1.5, 2.0]);
    /// assert_eq!(density.values, [0.0, 0.0, 0.0, 2.0]); // all of it in the last bin, of width 1/2
    /// ```
    ///
    /// # Panics
    /// If there are no bins, or not as many lists as wavenumbers.
    pub fn new(bands: &[Vec<f64>], grid: [usize; 2], bins: usize) -> Self {
        assert!(bins > 0 && bands.len() == grid[0] * grid[1], "a list of values for each wavenumber, and a bin");
        let largest = bands.iter().flatten().copied().fold(0.0, f64::max);
        let width = if largest > 0.0 { largest } else { 1.0 } / bins as f64;
        let mut edges: Vec<f64> = (0..=bins).map(|k| k as f64 * width).collect();
        edges[bins] = edges[bins].max(largest);
        let mut counts = vec![0.0; bins];
        for [p, q, r] in triangles(grid) {
            for ((a, b), c) in bands[p].iter().zip(&bands[q]).zip(&bands[r]) {
                let mut corners = [*a, *b, *c];
                corners.sort_by(f64::total_cmp);
                // one bin more to both sides, since the division may round
                let bin = |value: f64| (value / width) as usize;
                let mut before = 0.0;
                for k in bin(corners[0]).saturating_sub(1)..=(bin(corners[2]) + 1).min(bins - 1) {
                    let below = below(edges[k + 1], corners);
                    counts[k] += below - before;
                    before = below;
                }
            }
        }
        // each triangle is half of a square
        let states = |count: &f64| 0.5 * count / bands.len() as f64;
        Self { values: counts.iter().map(|count| states(count) / width).collect(), edges }
    }

    /// Returns the integral over all frequencies.
    pub fn integral(&self) -> f64 {
        self.values.iter().zip(self.edges.windows(2)).map(|(value, ends)| value * (ends[1] - ends[0])).sum()
    }
}

/// Returns the numbers of the wavenumbers at the corners of the triangles, two for each square of the grid.
fn triangles([n1, n2]: [usize; 2]) -> impl Iterator<Item = [usize; 3]> {
    let at = move |i: usize, j: usize| j % n2 * n1 + i % n1;
    let squares = (0..n2).flat_map(move |j| (0..n1).map(move |i| (i, j)));
    squares.flat_map(move |(i, j)| {
        let [low, right, up, high] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
        [[low, right, high], [low, high, up]]
    })
}

/// Returns the part of a triangle in which a linear function is at most `value`; `a`, `b`, `c` are its values at the
/// corners, ascending.
fn below(value: f64, [a, b, c]: [f64; 3]) -> f64 {
    if value >= c {
        1.0
    } else if value < a {
        0.0
    } else if value < b {
        (value - a).powi(2) / ((b - a) * (c - a))
    } else {
        1.0 - (c - value).powi(2) / ((c - a) * (c - b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    /// Bands on a grid of `n x n + 3` wavenumbers.
    fn sampled(n: usize, band: impl Fn(f64, f64) -> Vec<f64>) -> (Vec<Vec<f64>>, [usize; 2]) {
        let grid = [n, n + 3];
        let at = |k: usize, n: usize| TAU * k as f64 / n as f64;
        let all = (0..grid[1]).flat_map(|j| (0..n).map(move |i| (i, j)));
        (all.map(|(i, j)| band(at(i, grid[0]), at(j, grid[1]))).collect(), grid)
    }

    /// Claim: the part of a triangle below a value is that of the area of the triangle in the plane whose heights are
    /// the values: by counting points for a general one, in closed form where corners agree. Tolerance: of counting.
    #[test]
    fn parts_of_triangles() {
        let (corners, n) = ([0.3, 0.5, 1.1], 1000);
        for value in [0.2, 0.35, 0.5, 0.8, 1.0, 1.1] {
            let points = (0..n).flat_map(|i| (0..n - i).map(move |j| (i as f64 / n as f64, j as f64 / n as f64)));
            let height =
                |(x, y): (f64, f64)| corners[0] + x * (corners[1] - corners[0]) + y * (corners[2] - corners[0]);
            let (under, all) =
                points.fold((0, 0), |(under, all), p| (under + usize::from(height(p) <= value), all + 1));
            assert!((under as f64 / all as f64 - below(value, corners)).abs() <= 3e-3, "{value}");
        }
        assert_eq!([0.9, 1.0].map(|value| below(value, [1.0; 3])), [0.0, 1.0]);
        assert_eq!([0.5, 1.0].map(|value| below(value, [0.0, 0.0, 1.0])), [0.75, 1.0]);
        assert_eq!([0.5, 1.0].map(|value| below(value, [0.0, 1.0, 1.0])), [0.25, 1.0]);
    }

    /// Claim: the integral is the number of bands to rounding on any grid and for any number of bins, with flat bands,
    /// one of them at zero and one at the largest value.
    #[test]
    fn the_integral_is_the_number_of_bands() {
        for (n, bins) in [(1, 1), (2, 7), (5, 3), (16, 100), (31, 1000)] {
            let (bands, grid) = sampled(n, |p, q| vec![0.0, (1.5 - p.cos() - 0.3 * q.sin()).abs(), 3.0, 3.0]);
            let density = Density::new(&bands, grid, bins);
            assert_eq!((density.values.len(), density.edges[0], density.edges[bins]), (bins, 0.0, 3.0));
            assert!((density.integral() - 4.0).abs() <= 1e-12, "{n}, {bins}: {}", density.integral());
            assert!(density.values.iter().all(|value| *value >= -1e-12));
        }
    }

    /// Claim: of the frequencies `2 |sin(q1 / 2)|` of a chain of unit masses and springs, the number up to `w` is
    /// `(2 / pi) asin(w / 2)` (textbook), with an error that falls as the square of the mesh.
    #[test]
    fn a_chain_of_springs() {
        let error = |n: usize| {
            let (bands, grid) = sampled(n, |p, _| vec![2.0 * (0.5 * p).sin().abs()]);
            let density = Density::new(&bands, grid, 50);
            let mut sum = 0.0;
            let sums = density.values.iter().zip(&density.edges[1..]).map(|(value, &edge)| {
                sum += value * (density.edges[1] - density.edges[0]);
                (sum - 2.0 / PI * (0.5 * edge.min(2.0)).asin()).abs()
            });
            // the square root at the upper end of the band is not smooth
            sums.take(40).fold(0.0, f64::max)
        };
        let errors = [32, 128].map(error);
        assert!(errors[0] < 3e-3 && errors[1] < errors[0] / 8.0, "{errors:?}");
    }
}
