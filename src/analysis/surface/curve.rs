//! Folded states that are a curve: trajectories along every ray of the drawn state.
//!
//! Where one real direction leaves a drawn state whose quadric is definite across it, the states on the curve are
//! spatially periodic, and closure alone has three null vectors at each: the condition that the lattice does not turn
//! leaves one.

use super::covered::{FoldedSurface, Negative, SurfaceOptions};
use super::error::SurfaceError;
use super::folding::SurfaceClosure;
use super::{cell, sign};
use crate::kinematics::{Closing, KinematicsError, Ray, Rays, RealDirections, SpatiallyPeriodic};
use crate::model::Assembly;
use crate::numerics::GoOn;
use crate::solver::atlas::{Coverage, Surface as _};
use crate::solver::continuation::{CurveOptions, CurvePoint, End, follow};
use std::f64::consts::TAU;

/// The curve of folded states; no states where no direction is real.
pub(super) fn curve(
    assembly: &Assembly,
    options: &SurfaceOptions,
    observe: GoOn<'_>,
) -> Result<FoldedSurface, SurfaceError> {
    let (closure, embedding, second_order) = cell::of(assembly)?;
    let Rays { rays, directions, .. } = Rays::new(&second_order)?;
    let periodic = SpatiallyPeriodic(&embedding);
    let planar = second_order.one_direction_is_real()?;
    let mut folding = SurfaceClosure::new(&closure, &embedding, options.max_curvature);
    let closing = Closing::new(&closure, embedding.drawn_angles().to_vec());
    let mut closing = closing.keeping(planar.then_some(&periodic));
    let negative = match directions {
        _ if planar => Some(Negative::OneDirection),
        RealDirections::Listed if rays.is_empty() => Some(Negative::NoRay),
        _ => None,
    };
    let mut found = FoldedSurface { dimension: 1, closed: true, ..FoldedSurface::nothing(negative, options.radius) };
    found.lost = usize::from(directions != RealDirections::Listed);
    let mut from = Vec::new();
    let mut arrived: Vec<usize> = Vec::new();
    for (k, ray) in rays.iter().enumerate() {
        if arrived.contains(&k) || found.coverage == Coverage::Interrupted {
            continue;
        }
        let end = found.follow((&mut closing, &mut folding), (ray, options), observe)?;
        from.resize(found.points.len(), k);
        arrived.extend(match &end {
            End::Closed(back) => rays.iter().position(|ray| back.is_against(&closing.folding(&ray.direction))),
            _ => None,
        });
        found.conclude(&end);
    }
    let segments = found.segments.clone();
    sign::carry(&embedding, &mut found.points, segments.into_iter(), &from);
    found.name_branches();
    Ok(found)
}

impl FoldedSurface {
    /// Adds the states along a ray.
    fn follow(
        &mut self,
        (closing, folding): (&mut Closing<'_>, &mut SurfaceClosure<'_>),
        (ray, options): (&Ray, &SurfaceOptions),
        observe: GoOn<'_>,
    ) -> Result<End, KinematicsError> {
        let before = self.points.len();
        let limits = CurveOptions {
            tolerance: options.tolerance,
            max_step: options.radius,
            steps: options.max_points.saturating_sub(before),
            period: Some(TAU),
            stops: vec![0],
            ..CurveOptions::default()
        };
        let (start, tangent) = (folding.drawn.clone(), closing.folding(&ray.direction));
        let mut count = before;
        let mut observe = |_: &_| {
            count += 1;
            observe(count)
        };
        let mut indicators = |_: &mut _, point: &CurvePoint, out: &mut Vec<f64>| out.push(folding.limit(&point.x));
        let found = follow(closing, start, tangent, &limits, &mut indicators, &mut observe);
        let closed = matches!(found.end, End::Closed(_));
        let inner = found.points.len() - usize::from(closed);
        let mut last = 0;
        // the drawn state is on all of them, once
        for point in found.points[..inner].iter().skip(usize::from(before > 0)) {
            let at = self.points.len();
            self.segments.extend((at > 0).then_some([last, at]));
            last = at;
            self.points.push(folding.point(&point.x, (ray.branch, ray.sign), [point.residual, self.radius])?);
        }
        self.segments.extend((closed && last > 0).then_some([last, 0]));
        Ok(found.end)
    }

    /// Records the end of a trajectory in the coverage, and whether all of them close.
    fn conclude(&mut self, end: &End) {
        self.closed &= matches!(end, End::Closed(_));
        self.coverage = match (end, self.coverage) {
            (End::Interrupted, _) => Coverage::Interrupted,
            (End::Steps, _) => Coverage::TooManyCharts,
            (End::Failed, Coverage::Open { charts }) => Coverage::Open { charts: charts + 1 },
            (End::Failed, Coverage::Complete) => Coverage::Open { charts: 1 },
            (_, before) => before,
        };
    }

    /// Lists the branches of the states.
    pub(super) fn name_branches(&mut self) {
        self.branches = self.points.iter().map(|point| point.branch).collect();
        self.branches.sort_unstable_by_key(|(branch, sign)| (*branch, -sign));
        self.branches.dedup();
    }
}
