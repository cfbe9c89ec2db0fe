//! The curve of spatially periodic states along which two surfaces of folded states cross.
//!
//! On it the lattice rotations vanish beside closure, and together these leave one tangent. Where an edge of the
//! triangulation goes over the curve, the vector from vertex 0 to the axis turns round; the state on the curve is found
//! by Newton's method from between. An energy is lowest along the curve where its slope along the tangent vanishes, and
//! is lowest on both surfaces there when it rises along each of the four ways that leave the curve.

use super::covered::{FoldedSurface, Negative, SeamState, SurfaceOptions, SurfacePoint};
use super::folding::SurfaceClosure;
use super::starts::starts;
use super::tip::periodic_near;
use crate::kinematics::{Closure, Embedding, SecondOrder};
use crate::model::Assembly;
use crate::numerics::dense::{full_svd, null_space, rank_at_largest_gap};
use crate::sheet::sides::uses_of_sides;

/// Distance over which slopes are compared first, and at which the energy beside the curve is asked.
const ASIDE: f64 = 1e-3;
/// Longest and last step along the curve, and most of them.
const LONGEST_CURVE_STEP: f64 = 0.1;
const LAST_STEP: f64 = 1e-11;
const STEPS: usize = 40;
/// Half the distance over which the slope of a quadratic energy is taken.
const SLOPE: f64 = 0.1;

/// The state of the curve at which an energy is lowest along it.
#[derive(Clone, Debug)]
pub struct Lowest {
    /// Fold angles of all edges.
    pub angles: Vec<f64>,
    /// Largest component of the closure residual.
    pub residual: f64,
    /// How far off the angles may be: the residual over the smallest singular value of closure and lattice rotations.
    pub error: f64,
    /// Whether the energy rises along all four ways that leave the curve.
    pub well: bool,
}

/// The states of the curve on the edges of a triangulation that go over it.
pub(super) fn seam(folding: &SurfaceClosure<'_>, points: &[SurfacePoint], triangles: &[[usize; 3]]) -> Vec<SeamState> {
    let on_edge = |between: [usize; 2]| {
        let [a, b] = between.map(|k| &points[k]);
        let [from, to] = [a, b].map(|point| point.shape.screw.towards_axis());
        let far = a.angles.iter().zip(&b.angles).any(|(a, b)| (a - b).abs() > std::f64::consts::PI);
        if far || !(from.dot(&to) < 0.0) {
            return None;
        }
        let part = from.norm() / (from.norm() + to.norm());
        let middle: Vec<f64> = a.angles.iter().zip(&b.angles).map(|(a, b)| a + part * (b - a)).collect();
        let x = periodic_near(folding, folding.folding(&middle))?;
        Some(SeamState { angles: folding.all(&x), between })
    };
    uses_of_sides(triangles).into_keys().filter_map(on_edge).collect()
}

impl FoldedSurface {
    /// Where a quadratic energy is lowest along the curve on which two surfaces cross, near a state of it; `None` where
    /// that is not found.
    pub(crate) fn lowest_on_crossing(
        assembly: &Assembly,
        options: &SurfaceOptions,
        angles: &[f64],
        energy: &dyn Fn(&[f64]) -> f64,
    ) -> Option<Lowest> {
        let closure = Closure::of_cell(assembly.sheet()).ok()?.with_locked(&assembly.locked_edges());
        let embedding = Embedding::new(assembly.sheet()).ok()?;
        let folding = SurfaceClosure::new(&closure, &embedding, options.max_curvature);
        let x = descend(&folding, folding.folding(angles), &|x| energy(&folding.all(x)))?;
        let angles = folding.all(&x);
        let singular = full_svd(&folding.periodic(&x).1).ok()?.singular_values;
        let least = singular[rank_at_largest_gap(&singular).ok()?.rank - 1];
        let residual = folding.residual(&x);
        let well = rises(options, (&closure, &embedding), &angles, energy)?;
        Some(Lowest { residual, error: residual / least, well, angles })
    }
}

/// Along the curve to where the slope of the energy vanishes and rises, by the secant method.
fn descend(folding: &SurfaceClosure<'_>, start: Vec<f64>, energy: &dyn Fn(&[f64]) -> f64) -> Option<Vec<f64>> {
    let moved = |x: &[f64], by: f64, t: &[f64]| -> Vec<f64> { x.iter().zip(t).map(|(x, t)| x + by * t).collect() };
    let tangent = |x: &[f64], like: &[f64]| -> Option<Vec<f64>> {
        let basis = null_space(&folding.periodic(x).1).ok()?.basis;
        let along: f64 = basis.iter().zip(like).map(|(a, b)| a * b).sum();
        (basis.ncols() == 1).then(|| basis.iter().map(|t| t * if along < 0.0 { -1.0 } else { 1.0 }).collect())
    };
    let slope = |x: &[f64], t: &[f64]| (energy(&moved(x, SLOPE, t)) - energy(&moved(x, -SLOPE, t))) / (2.0 * SLOPE);
    let mut x = periodic_near(folding, start)?;
    let mut t = tangent(&x, &vec![0.0; x.len()])?;
    let (mut before, mut step) = (slope(&x, &t), ASIDE);
    for _ in 0..STEPS {
        x = periodic_near(folding, moved(&x, step, &t))?;
        t = tangent(&x, &t)?;
        let now = slope(&x, &t);
        let bend = (now - before) / step;
        if !(bend > 0.0) {
            return None;
        }
        (before, step) = (now, (-now / bend).clamp(-LONGEST_CURVE_STEP, LONGEST_CURVE_STEP));
        if step.abs() <= LAST_STEP {
            return Some(x);
        }
    }
    None
}

/// Whether an energy is higher a little away along each of the four ways that leave the curve at a state of it; so it
/// is where none leaves it, as the quadratic condition is definite across the curve.
fn rises(
    options: &SurfaceOptions,
    (closure, embedding): (&Closure, &Embedding),
    angles: &[f64],
    energy: &dyn Fn(&[f64]) -> f64,
) -> Option<bool> {
    let second_order = SecondOrder::new(closure, angles).ok()?;
    let mut folding = SurfaceClosure::at(closure, embedding, (angles, f64::INFINITY));
    let near = SurfaceOptions { radius: ASIDE, max_curvature: f64::INFINITY, ..*options };
    let found = match starts(&mut folding, &second_order, &near).ok()? {
        Ok(found) => found,
        Err(Negative::OneDirection) => return Some(true),
        Err(Negative::NoDirection | Negative::NoRay) => return None,
    };
    let here = energy(angles);
    (found.crossing && found.lost == 0).then(|| found.list.iter().all(|way| energy(&folding.all(&way.x)) > here))
}
