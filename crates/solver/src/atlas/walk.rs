//! The way from a chart to the rim of its disc, followed as a curve.
//!
//! Next to a curve along which a surface crosses another, Newton's method from a point of the tangent plane may lead to
//! the other surface, and tangents are those of one surface only exactly on it. On the hyperplane across the disc the
//! surface is a curve; followed in steps, each predicted by those before ([`crate::continuation`]), it goes straight
//! over such a crossing.

use super::surface::{Chart, Surface};
use crate::continuation::{CurveOptions, CurvePoint, End, follow};
use crate::implicit::{Corrector, Implicit};
use foldwell_numerics::DenseMatrix;

/// Most steps to a rim: a few do mostly, and next to singular points they would get shorter without end.
const MOST_STEPS: usize = 60;

/// Follows the surface from a chart in the direction of a place in its tangent plane, as far as that is. Returns the point
/// there and two orthonormal tangents, turned as little as possible from those of the chart; `None` where it cannot be
/// followed.
pub(super) fn to_rim<S: Surface>(
    surface: &mut S,
    (chart, at): (&Chart, [f64; 2]),
    corrector: &mut Corrector,
    tolerance: f64,
) -> Option<(CurvePoint, Vec<f64>)> {
    let length = at[0].hypot(at[1]);
    let [cos, sin] = at.map(|along| along / length);
    let (first, second) = chart.frame.split_at(chart.x.len());
    let turned =
        |c: f64, s: f64, [a, b]: [&[f64]; 2]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| c * a + s * b).collect() };
    let (along, across) = (turned(cos, sin, [first, second]), turned(-sin, cos, [first, second]));
    let options = CurveOptions { tolerance, length, max_step: length, steps: MOST_STEPS, ..CurveOptions::default() };
    let mut section = HyperplaneSection::new(surface, chart.x.clone(), across.clone());
    let found = follow(&mut section, chart.x.clone(), along, &options, &mut |_, _, _| {}, &mut |_| true);
    let last = found.points.into_iter().next_back().filter(|_| found.end == End::Length)?;
    let mut tangents = [&last.tangent[..], &across].concat();
    corrector.turn(surface, &last.x, &mut tangents)?;
    let (t, n) = tangents.split_at(last.x.len());
    let frame = [turned(cos, -sin, [t, n]), turned(sin, cos, [t, n])].concat();
    Some((last, frame))
}

/// The points of a surface on a hyperplane.
pub struct HyperplaneSection<'a, S> {
    /// The surface.
    pub surface: &'a mut S,
    through: Vec<f64>,
    normal: Vec<f64>,
    residual: Vec<f64>,
    jacobian: DenseMatrix,
}

impl<'a, S: Implicit> HyperplaneSection<'a, S> {
    /// On the hyperplane through a point that has this normal.
    pub fn new(surface: &'a mut S, through: Vec<f64>, normal: Vec<f64>) -> Self {
        let (rows, columns) = (surface.equations(), surface.unknowns());
        Self { surface, through, normal, residual: vec![0.0; rows], jacobian: DenseMatrix::zeros(rows, columns) }
    }
}

impl<S: Implicit> Implicit for HyperplaneSection<'_, S> {
    fn unknowns(&self) -> usize {
        self.surface.unknowns()
    }

    fn equations(&self) -> usize {
        self.surface.equations() + 1
    }

    fn linearize(&mut self, x: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix) {
        self.surface.linearize(x, &mut self.residual, &mut self.jacobian);
        let rows = self.residual.len();
        residual[..rows].copy_from_slice(&self.residual);
        jacobian.rows_mut(0, rows).copy_from(&self.jacobian);
        residual[rows] = x.iter().zip(&self.through).zip(&self.normal).map(|((x, o), n)| (x - o) * n).sum();
        self.normal.iter().enumerate().for_each(|(column, n)| jacobian[(rows, column)] = *n);
    }
}
