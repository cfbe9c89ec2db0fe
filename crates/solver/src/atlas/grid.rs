//! Points near a point, modulo periods.
//!
//! A periodic unknown is seen as a point of a circle of that circumference; everything is projected onto a few
//! orthonormal directions, and by the first three of these sorted into cubes. Circle and projection only shorten
//! distances, so all points within the side of a cube are in the 27 cubes around, and those whose projections are
//! further apart are not near.

use foldwell_numerics::DenseMatrix;
use foldwell_numerics::dense::small::orthonormal_triangular;
use foldwell_numerics::vector::dot;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Number of directions of the projection, and of those of them that make the cubes.
const DIRECTIONS: usize = 6;
const CUBE: usize = 3;

/// Numbered points, sorted into cubes.
#[derive(Clone, Debug)]
pub(super) struct PointIndex {
    side: f64,
    periods: Vec<Option<f64>>,
    /// Orthonormal directions, one behind the other; fewer for few coordinates.
    directions: Vec<f64>,
    cubes: HashMap<[i32; CUBE], Vec<(usize, [f64; DIRECTIONS])>>,
    seen: Vec<f64>,
}

impl PointIndex {
    /// A grid of cubes of this side, for points with these periods.
    pub fn new(side: f64, periods: Vec<Option<f64>>) -> Self {
        let coordinates: usize = periods.iter().map(|period| if period.is_some() { 2 } else { 1 }).sum();
        let directions = directions(coordinates);
        Self { side, periods, directions, cubes: HashMap::new(), seen: vec![0.0; coordinates] }
    }

    /// Adds a point.
    pub fn insert(&mut self, x: &[f64], number: usize) {
        let place = self.project(x);
        self.cubes.entry(self.cube(&place)).or_default().push((number, place));
    }

    /// Returns the numbers of all points within `reach`, at most the side of a cube, and of some others.
    pub fn near(&mut self, x: &[f64], reach: f64) -> Vec<usize> {
        let (mut found, place) = (Vec::new(), self.project(x));
        let cube = self.cube(&place);
        let close = |other: &[f64; DIRECTIONS]| {
            place.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() <= reach * reach
        };
        for around in 0..27 {
            let shift = [around % 3 - 1, around / 3 % 3 - 1, around / 9 - 1];
            if let Some(points) = self.cubes.get(&[0, 1, 2].map(|axis| cube[axis] + shift[axis])) {
                found.extend(points.iter().filter(|(_, other)| close(other)).map(|(number, _)| number));
            }
        }
        found
    }

    fn cube(&self, place: &[f64; DIRECTIONS]) -> [i32; CUBE] {
        std::array::from_fn(|axis| (place[axis] / self.side).floor() as i32)
    }

    fn project(&mut self, x: &[f64]) -> [f64; DIRECTIONS] {
        self.seen.clear();
        for (x, period) in x.iter().zip(&self.periods) {
            match period {
                Some(period) => {
                    let (sine, cosine) = (x / period * TAU).sin_cos();
                    self.seen.extend([cosine, sine].map(|part| part * period / TAU));
                }
                None => self.seen.push(*x),
            }
        }
        let mut place = [0.0; DIRECTIONS];
        for (place, direction) in place.iter_mut().zip(self.directions.chunks_exact(self.seen.len())) {
            *place = dot(direction, &self.seen);
        }
        place
    }
}

/// Orthonormal directions in general position: fractional parts of multiples of square roots, made orthonormal.
fn directions(coordinates: usize) -> Vec<f64> {
    let count = coordinates.min(DIRECTIONS);
    let general = |k: usize| (k as f64 * std::f64::consts::SQRT_2 + (k * k) as f64 * 0.618_033_988_75).fract() - 0.5;
    let general = DenseMatrix::from_iterator(coordinates, count, (1..=count * coordinates).map(general));
    let [directions, _] = orthonormal_triangular(general);
    directions.as_slice().to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: every pair within the side is found, also across the end of a period, in 1 to 5 unknowns with and without
    /// periods; and most far ones are not looked at.
    #[test]
    fn all_near_points_are_found() {
        for unknowns in 1..=5 {
            let periods: Vec<Option<f64>> = (0..unknowns).map(|k| (k % 2 == 0).then_some(TAU)).collect();
            let mut grid = PointIndex::new(0.4, periods.clone());
            let value = |point: usize, k: usize| 20.0 * ((point * 7 + k * 13) as f64 * 0.754_877_666).fract() - 10.0;
            let points: Vec<Vec<f64>> = (0..400).map(|p| (0..unknowns).map(|k| value(p, k)).collect()).collect();
            points.iter().enumerate().for_each(|(number, x)| grid.insert(x, number));
            let (mut looked, mut pairs) = (0, 0);
            for x in &points {
                let found = grid.near(x, 0.4);
                looked += found.len();
                for (number, y) in points.iter().enumerate() {
                    let away = |k: usize| {
                        let d = y[k] - x[k];
                        periods[k].map_or(d, |period| d - period * (d / period).round())
                    };
                    if (0..unknowns).map(|k| away(k).powi(2)).sum::<f64>().sqrt() < 0.4 {
                        pairs += 1;
                        assert!(found.contains(&number));
                    }
                }
            }
            assert!(pairs >= points.len() && looked < points.len() * points.len() / 2, "{unknowns}: {looked}");
        }
    }
}
