//! Hermite interpolation of a curve: the polynomial through points with their tangents, by divided differences.

use super::curve::CurvePoint;
use foldwell_numerics::vector::norm;

/// Largest number of points of an interpolant.
pub(crate) const MOST: usize = 4;
/// Nodes and weights of the Gauss-Legendre rule of five points on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// A polynomial of degree `2 m - 1` in arc length through `m` points and tangents.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hermite {
    /// Arc lengths of the points, each twice.
    nodes: Vec<f64>,
    /// Newton's coefficients, one vector after the other.
    coefficients: Vec<f64>,
    size: usize,
}

impl Hermite {
    /// Interpolates at most [`MOST`] points of different arc length.
    pub(crate) fn fit(&mut self, points: &[&CurvePoint]) {
        let count = 2 * points.len();
        self.size = points[0].x.len();
        self.nodes.clear();
        self.nodes.extend(points.iter().flat_map(|point| [point.arc_length; 2]));
        self.coefficients.resize(count * self.size, 0.0);
        for component in 0..self.size {
            let mut table = [0.0; 2 * MOST];
            for (k, point) in points.iter().enumerate() {
                (table[2 * k], table[2 * k + 1]) = (point.x[component], point.x[component]);
            }
            self.coefficients[component] = table[0];
            for order in 1..count {
                for k in 0..count - order {
                    let width = self.nodes[k + order] - self.nodes[k];
                    let slope = points[k / 2].tangent[component];
                    table[k] = if width == 0.0 { slope } else { (table[k + 1] - table[k]) / width };
                }
                self.coefficients[order * self.size + component] = table[0];
            }
        }
    }

    /// The point at an arc length and its derivative.
    pub(crate) fn at(&self, s: f64, x: &mut [f64], slope: &mut [f64]) {
        let last = self.nodes.len() - 1;
        x.copy_from_slice(&self.coefficients[last * self.size..]);
        slope.fill(0.0);
        for order in (0..last).rev() {
            let away = s - self.nodes[order];
            let coefficients = &self.coefficients[order * self.size..][..self.size];
            for ((x, slope), c) in x.iter_mut().zip(slope.iter_mut()).zip(coefficients) {
                *slope = *slope * away + *x;
                *x = *x * away + c;
            }
        }
    }

    /// Length of the polynomial's curve between two values of its parameter.
    pub(crate) fn length(&self, from: f64, to: f64, x: &mut [f64], slope: &mut [f64]) -> f64 {
        let half = 0.5 * (to - from);
        let speed = |&(node, weight): &(f64, f64)| {
            self.at(from + half * (1.0 + node), x, slope);
            weight * norm(slope)
        };
        half * GAUSS.iter().map(speed).sum::<f64>()
    }
}
