//! Folded states that are curves: trajectories along every ray of the drawn state, until they come back or a crease is
//! folded by `pi`. Where the drawn state of a periodic cell has but one real direction, that of planar folding, the
//! curve is that of its spatially periodic states.

use super::extent::Extent;
use super::{RigidError, Sampling, StateGraph};
use crate::kinematics::{
    Closing, Closure, Embedding, KinematicsError, Rays, RealDirections, SecondOrder, SpatiallyPeriodic,
};
use crate::model::{Assembly, Domain};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::full_svd;
use crate::solver::continuation::{CurveOptions, CurvePoint, End, follow};
use std::f64::consts::TAU;

/// Steps on curves over those on surfaces: they cost next to nothing.
const FINER: f64 = 0.25;

/// Samples the trajectories; they hang together in the drawn state.
pub(super) fn net(
    assembly: &Assembly,
    (sampling, extent): (&Sampling, &Extent),
    go_on: &mut dyn FnMut() -> bool,
) -> Result<StateGraph, RigidError> {
    let closure = Closure::of_tiling(assembly.sheet(), assembly.tiling())?.with_locked(&assembly.locked_edges());
    closure.is_complete()?;
    let drawn = assembly.drawn_angles_or_zero();
    let second_order = SecondOrder::new(&closure, &drawn)?;
    let dimension = second_order.count() as i64 - second_order.quadrics.len() as i64;
    let planar = *assembly.domain() == Domain::Screw && second_order.one_direction_is_real()?;
    if dimension != 1 && !planar {
        return Err(RigidError::Dimension { dimension });
    }
    let Rays { rays, directions, .. } = Rays::new(&second_order)?;
    let embedding = if planar { Some(Embedding::new(assembly.sheet())?) } else { None };
    let planar = embedding.as_ref().map(SpatiallyPeriodic);
    let mut folding = Closing::new(&closure, drawn.clone()).keeping(planar.as_ref());
    // the curve ends where an angle leaves the landscape
    let mut excess = |folding: &mut Closing<'_>, point: &CurvePoint, out: &mut Vec<f64>| {
        out.push(extent.excess(&folding.angles(&point.x)));
    };
    let crossing = rays.len() > 2;
    let mut net = StateGraph {
        angles: vec![drawn.clone()],
        links: vec![],
        singular: vec![crossing],
        border: vec![false],
        dimension: 1,
        seam: if planar.is_some() { 0 } else { usize::MAX },
        open: usize::from(directions != RealDirections::Listed),
    };
    let options =
        CurveOptions { max_step: FINER * sampling.step, period: Some(TAU), stops: vec![0], ..CurveOptions::default() };
    for ray in &rays {
        let [x, tangent] = [&drawn, &ray.direction].map(|all| folding.folding(all));
        let found = follow(&mut folding, x, tangent, &options, &mut excess, &mut |_| go_on());
        if found.end == End::Interrupted {
            return Err(RigidError::Interrupted);
        }
        net.open += usize::from(matches!(found.end, End::Failed | End::Steps));
        net.open += meetings(&mut folding, &found.points)?;
        let back = matches!(found.end, End::Closed(_));
        let last = found.points.len() - 1;
        let mut before = 0;
        for (k, point) in found.points.iter().enumerate().skip(1) {
            if back && k == last {
                net.links.push([before, 0]);
                continue;
            }
            net.links.push([before, net.angles.len()]);
            before = net.angles.len();
            net.angles.push(folding.angles(&point.x));
            net.singular.push(false);
            net.border.push(k == last);
        }
    }
    Ok(net)
}

/// Number of states, not the first or last, at which other folded states leave a curve: there singular values of the
/// Jacobian pass zero. Between two points next to such a state the Jacobian turns round along their singular vectors.
fn meetings(folding: &mut Closing<'_>, points: &[CurvePoint]) -> Result<usize, KinematicsError> {
    let (mut found, mut last) = (0, None::<DenseMatrix>);
    for point in points.get(1..points.len() - 1).unwrap_or_default() {
        let (_, next) = folding.linearized(&point.x);
        if let Some(last) = &last {
            let across = full_svd(last)?.v;
            let turned = |k: usize| (last * across.column(k)).dot(&(&next * across.column(k))) < 0.0;
            found += usize::from((0..next.ncols() - 1).any(turned));
        }
        last = Some(next);
    }
    Ok(found)
}
