//! A custom energy on the solver alone: a hanging chain whose bars have logarithmic strains, from soft to exactly
//! rigid.
//!
//! The solver minimises `E(x) + sum_r m_r(x)^2 / (2 c_r)` for any [`Problem`]: here `E` is the weight of the joints,
//! and the stiff measure of a bar of rest length `L` and length `l` is `m = L ln(l / L)`, with the compliance
//! `c = L / EA`. A compliance of zero is a rigid bar; nothing else changes.
//!
//! ```text
//! cargo run --release --example custom_energy
//! ```

use foldwell::numerics::sparse::Cliques;
use foldwell::solver::{HessianKind, Layout, Linearization, NewtonError, Options, Problem, minimize};
use std::sync::Arc;

const BARS: usize = 8;
const REST_LENGTH: f64 = 1.0;
/// Weight of a joint, and the distance between the two supports, which are level.
const WEIGHT: f64 = 1.0;
const SPAN: f64 = 6.0;

/// Bars from the support at the origin over `BARS - 1` joints to the support at `(SPAN, 0)`. Unknowns: `x, y` of each
/// joint.
struct Chain {
    layout: Arc<Layout>,
    compliance: Vec<f64>,
    gap_scale: Vec<f64>,
}

impl Chain {
    fn new(stiffness: f64) -> Self {
        let joints = BARS - 1;
        let mut bars = Cliques::new();
        for bar in 0..BARS {
            let ends = [bar.checked_sub(1), (bar < joints).then_some(bar)]; // the joints that may move
            bars.push(ends.into_iter().flatten().flat_map(|joint| [2 * joint as u32, 2 * joint as u32 + 1]));
        }
        let block_of_unknown = (0..2 * joints as u32).map(|unknown| unknown / 2).collect();
        Self {
            layout: Layout::new(block_of_unknown, Cliques::new(), bars),
            compliance: vec![REST_LENGTH / stiffness; BARS],
            gap_scale: vec![REST_LENGTH; BARS],
        }
    }

    /// From the first to the second end of a bar.
    fn along(x: &[f64], bar: usize) -> [f64; 2] {
        let place = |joint: Option<usize>| match joint {
            None => [0.0, 0.0],
            Some(joint) if joint == BARS - 1 => [SPAN, 0.0],
            Some(joint) => [x[2 * joint], x[2 * joint + 1]],
        };
        let (from, to) = (place(bar.checked_sub(1)), place(Some(bar)));
        [to[0] - from[0], to[1] - from[1]]
    }
}

impl Problem for Chain {
    fn layout(&self) -> &Arc<Layout> {
        &self.layout
    }

    fn compliance(&self) -> &[f64] {
        &self.compliance
    }

    fn gap_scale(&self) -> &[f64] {
        &self.gap_scale
    }

    fn energy(&self, x: &[f64]) -> f64 {
        x.chunks(2).map(|joint| WEIGHT * joint[1]).sum()
    }

    fn gaps(&self, x: &[f64]) -> Vec<f64> {
        let length = |bar| Self::along(x, bar).map(|d| d * d).iter().sum::<f64>().sqrt();
        (0..BARS).map(|bar| REST_LENGTH * (length(bar) / REST_LENGTH).ln()).collect()
    }

    fn linearize(&self, x: &[f64], tension: &[f64], kind: HessianKind, out: &mut Linearization) {
        out.clear(kind);
        out.energy = self.energy(x);
        out.gaps.copy_from_slice(&self.gaps(x));
        out.gradient.iter_mut().skip(1).step_by(2).for_each(|dy| *dy = WEIGHT);
        out.largest_force = tension.iter().fold(WEIGHT, |largest, t| largest.max(t.abs()));
        for (bar, &pull) in tension.iter().enumerate() {
            let d = Self::along(x, bar);
            let square = d[0] * d[0] + d[1] * d[1];
            // m = L ln(l / L): dm/dd = L d / l^2, d2m/dd2 = L (1 - 2 d d^T / l^2) / l^2; the first end counts negative
            let gradient = d.map(|d| REST_LENGTH * d / square);
            let second = |i: usize, j: usize| {
                let same = if i == j { 1.0 } else { 0.0 };
                REST_LENGTH * (same - 2.0 * d[i] * d[j] / square) / square
            };
            let signs: Vec<f64> =
                [(bar > 0).then_some(-1.0), (bar < BARS - 1).then_some(1.0)].into_iter().flatten().collect();
            let unknowns: Vec<(f64, usize)> = signs.iter().flat_map(|sign| [(*sign, 0), (*sign, 1)]).collect();
            let rates: Vec<f64> = unknowns.iter().map(|(sign, axis)| sign * gradient[*axis]).collect();
            let mut lower_triangle = Vec::new();
            for (row, (sign_i, i)) in unknowns.iter().enumerate() {
                lower_triangle.extend(unknowns[..=row].iter().map(|(sign_j, j)| sign_i * sign_j * second(*i, *j)));
            }
            out.jacobian[self.layout.stiff.range(bar)].copy_from_slice(&rates);
            out.add_stiff(bar, pull, &lower_triangle);
        }
    }

    fn accept(&mut self, _x: &mut [f64]) {}
}

fn main() -> Result<(), NewtonError> {
    println!("{:>8} {:>16} {:>16} {:>6}", "EA", "lowest joint", "largest tension", "steps");
    for stiffness in [1e1, 1e2, 1e4, 1e8, f64::INFINITY] {
        let sagging =
            (1..BARS).flat_map(|k| [SPAN * k as f64 / BARS as f64, -1.0 - 0.1 * k as f64]).collect::<Vec<_>>();
        let found = minimize(&mut Chain::new(stiffness), sagging, Options::default(), &mut |_| true)?;
        let lowest = found.x.chunks(2).map(|joint| joint[1]).fold(0.0, f64::min);
        let tension = found.tension.iter().copied().fold(0.0, f64::max);
        println!("{stiffness:8.0e} {lowest:16.12} {tension:16.12} {:6}", found.history.len());
    }
    Ok(())
}
