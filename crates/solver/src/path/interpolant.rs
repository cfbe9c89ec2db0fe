//! States between two states of a path, and beyond them: cubic Hermite interpolation in arc length.

use super::problem::{PathState, Rates};
use foldwell_numerics::vector::moved;

/// The cubic between two states.
pub(super) struct Cubic<'a> {
    from: &'a PathState,
    to: &'a PathState,
    length: f64,
}

impl<'a> Cubic<'a> {
    pub fn new(from: &'a PathState, to: &'a PathState) -> Self {
        Self { from, to, length: to.arc_length - from.arc_length }
    }

    /// The combination of both states and their tangents with these weights.
    fn mixed(&self, [a, u, b, v]: [f64; 4]) -> Rates {
        let mix = |p: f64, rate_p: f64, q: f64, rate_q: f64| a * p + u * rate_p + b * q + v * rate_q;
        let many = |p: &[f64], rate_p: &[f64], q: &[f64], rate_q: &[f64]| -> Vec<f64> {
            (0..p.len()).map(|k| mix(p[k], rate_p[k], q[k], rate_q[k])).collect()
        };
        let ([from, to], [s, t]) = ([self.from, self.to], [&self.from.tangent, &self.to.tangent]);
        Rates {
            x: many(&from.x, &s.x, &to.x, &t.x),
            tension: many(&from.tension, &s.tension, &to.tension, &t.tension),
            parameter: mix(from.parameter, s.parameter, to.parameter, t.parameter),
        }
    }

    /// The combination of the conjugate quantities and their rates with these weights.
    fn conjugate(&self, [a, u, b, v]: [f64; 4]) -> f64 {
        let [from, to] = [self.from, self.to].map(|state| state.conjugate);
        a * from[0] + u * from[1] + b * to[0] + v * to[1]
    }

    /// The state at this part of the way; beyond the second state for parts above 1.
    pub fn at(&self, part: f64) -> Rates {
        self.mixed(weights(part, self.length))
    }

    /// The rates along the way at this part of it, and the rate of the conjugate quantity.
    pub fn tangent(&self, part: f64) -> (Rates, f64) {
        let slopes = slopes(part, self.length).map(|slope| slope / self.length);
        (self.mixed(slopes), self.conjugate(slopes))
    }

    /// The differences from the first state to the second.
    pub fn chord(&self) -> Rates {
        Rates {
            x: moved(&self.to.x, -1.0, &self.from.x),
            tension: moved(&self.to.tension, -1.0, &self.from.tension),
            parameter: self.to.parameter - self.from.parameter,
        }
    }

    /// The integral of the conjugate over the parameter between the two states, exact for cubics (Gauss, three points).
    pub fn work(&self) -> f64 {
        let [from, to] = [self.from, self.to];
        let rate = |[a, u, b, v]: [f64; 4]| {
            a * from.parameter + u * from.tangent.parameter + b * to.parameter + v * to.tangent.parameter
        };
        let half = 0.6f64.sqrt();
        let points = [(0.5 - 0.5 * half, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + 0.5 * half, 5.0 / 18.0)];
        let parts = points.map(|(part, weight)| {
            weight * self.conjugate(weights(part, self.length)) * rate(slopes(part, self.length))
        });
        parts.iter().sum()
    }
}

/// Weights of the first value, its rate, the second value and its rate at a part of an interval of this length.
fn weights(part: f64, length: f64) -> [f64; 4] {
    let (t, rest) = (part, 1.0 - part);
    [(1.0 + 2.0 * t) * rest * rest, length * t * rest * rest, t * t * (3.0 - 2.0 * t), -length * t * t * rest]
}

/// Derivatives of the weights by the part.
fn slopes(t: f64, length: f64) -> [f64; 4] {
    let turn = 6.0 * t * (1.0 - t);
    [-turn, length * (1.0 - t) * (1.0 - 3.0 * t), turn, length * t * (3.0 * t - 2.0)]
}
