//! Quantities along a trajectory whose sign changes are events: curvature, strains, crease angles, crossing faces.

use super::state::{Folded, Intersects, Stop};
use crate::analysis::tube::SeamPlace;
use crate::kinematics::tube::Condition;
use crate::kinematics::{Closing, Displacement, Embedding, Shape};
use crate::sheet::Seam;
use crate::solver::continuation::CurvePoint;
use std::f64::consts::TAU;

/// Rates of strains, per arc length, up to which they are rounding errors: such a strain has no turning points.
const NO_RATE: f64 = 1e-12;
/// States between two questions whether to go on.
const OBSERVED: usize = 256;
/// Quantities whose turning points are reported, in the order of their indicators.
pub(crate) const TURNING: [&str; 4] = ["curvature", "strain11", "strain22", "strain12"];
/// The indicators after these.
pub(super) const CURVATURE: usize = TURNING.len();
pub(super) const CREASE_ANGLE: usize = CURVATURE + 1;
pub(super) const INTERSECTION: usize = CURVATURE + 2;
/// Number of the indicator of a closed tube: the defect of the condition that is not kept.
pub(super) const CLOSED: usize = CURVATURE + 3;

/// The quantities of a folding sheet whose sign changes along a trajectory are located.
pub(super) struct Watched<'a, 'b> {
    pub embedding: &'a Embedding,
    pub periodic: bool,
    /// Whether the first state is spatially periodic, without curvature.
    pub starts_straight: bool,
    /// The seam of a tube, and the closing condition that it keeps.
    pub tube: Option<(Seam, Condition)>,
    /// The seam of the first state, if the sheet is drawn rolled up.
    pub drawn: Option<SeamPlace>,
    /// States of the trajectory that are known, by rising arc length: near them curvatures keep their sign, and seams
    /// their direction.
    pub known: Vec<Known>,
    pub stop: Stop,
    pub intersects: Option<Intersects<'b>>,
    /// Whether faces of the first state pass through each other; false also where that is not asked.
    pub crosses: bool,
}

/// A state from which the sign of the curvature and the direction of the seam are carried on.
pub(super) struct Known {
    arc_length: f64,
    angles: Vec<f64>,
    shape: Shape,
    seam: Option<SeamPlace>,
}

impl Watched<'_, '_> {
    /// Asks whether faces of the first state pass through each other.
    pub fn look_at_start(&mut self, closing: &Closing<'_>, x: Vec<f64>) {
        let start = CurvePoint { arc_length: 0.0, tangent: vec![0.0; x.len()], x, residual: 0.0, corrections: 0 };
        let state = self.folded(closing, &start);
        self.crosses = self.intersects.as_mut().is_some_and(|intersects| intersects(&state));
    }

    pub fn folded(&mut self, closing: &Closing<'_>, point: &CurvePoint) -> Folded {
        let (angles, rates) = (closing.angles(&point.x), closing.rates(&point.tangent));
        let placement = self.embedding.place(&angles);
        let positions = placement.positions.clone();
        let mut shape = Shape::of(self.embedding, placement).ok();
        let turning = shape.as_mut().filter(|shape| shape.turns());
        let seam = turning.and_then(|shape| self.carry_on(point.arc_length, &angles, shape));
        Folded { arc_length: point.arc_length, angles, rates, shape, seam, positions, residual: point.residual }
    }

    /// The states at these points; fewer where `go_on` says to stop.
    pub fn states(
        &mut self,
        closing: &Closing<'_>,
        points: &[CurvePoint],
        go_on: &mut dyn FnMut() -> bool,
    ) -> Vec<Folded> {
        let goes_on = |(k, _): &(usize, &CurvePoint)| *k == 0 || k % OBSERVED > 0 || go_on();
        points.iter().enumerate().take_while(goes_on).map(|(_, point)| self.folded(closing, point)).collect()
    }

    /// Gives a state's curvature the sign that it has next to the nearest known one, and makes it known. Returns the
    /// seam of a tube.
    fn carry_on(&mut self, arc_length: f64, angles: &[f64], shape: &mut Shape) -> Option<SeamPlace> {
        let after = self.known.partition_point(|known| known.arc_length < arc_length);
        let beside = [after.checked_sub(1), (after < self.known.len()).then_some(after)];
        let away = |k: &usize| (self.known[*k].arc_length - arc_length).abs();
        let nearest = beside.into_iter().flatten().min_by(|a, b| away(a).total_cmp(&away(b)));
        let last = nearest.map(|k| &self.known[k]);
        let place =
            |seam: Seam| SeamPlace::new(shape, &seam, last.map_or(self.drawn.as_ref(), |last| last.seam.as_ref()));
        let seam = self.tube.and_then(|(seam, _)| place(seam));
        if let Some(last) = last {
            shape.continue_over(self.embedding, &last.shape, [&last.angles, angles]);
            if last.arc_length == arc_length {
                return seam;
            }
        }
        if shape.curvature.is_finite() {
            self.known.insert(after, Known { arc_length, angles: angles.to_vec(), shape: shape.clone(), seam });
        }
        seam
    }

    /// Defect of the closing condition that a tube does not keep, a length or an angle: zero where the tube is closed;
    /// NaN for other sheets.
    fn opening(&self, state: &Folded) -> f64 {
        let opening = |(seam, (_, kept)): (SeamPlace, (Seam, Condition))| match kept {
            Condition::Turn => seam.rise,
            Condition::Rise => seam.turn - TAU,
        };
        state.seam.zip(self.tube).map_or(f64::NAN, opening)
    }

    /// Rates of curvature and strains; that of the curvature is NaN without rotation.
    fn rates(&self, state: &Folded) -> [f64; 4] {
        let moving = Displacement::new(self.embedding, &state.angles, &state.rates).lattice;
        let Some((shape, moving)) = state.shape.as_ref().zip(moving) else { return [f64::NAN; 4] };
        let curvature = shape.turns().then(|| shape.curvature_rate(&moving)).flatten().unwrap_or(f64::NAN);
        let strain = shape.strain_rate(self.embedding, &moving).unwrap_or([f64::NAN; 3]);
        let [strain11, strain22, strain12] = strain.map(|rate| if rate.abs() <= NO_RATE { 0.0 } else { rate });
        [curvature, strain11, strain22, strain12]
    }

    /// Appends the values whose sign changes are located.
    pub fn indicators(&mut self, closing: &Closing<'_>, point: &CurvePoint, out: &mut Vec<f64>) {
        let state = self.folded(closing, point);
        let curvature = state.shape.as_ref().map_or(f64::NAN, |shape| shape.curvature.abs());
        // what a straight state has of curvature is rounding
        let straight = self.starts_straight && point.arc_length == 0.0 && curvature.is_finite();
        let curvature = if straight { 0.0 } else { curvature };
        out.extend(if self.periodic { self.rates(&state) } else { [f64::NAN; 4] });
        out.push(self.stop.curvature.map_or(f64::NAN, |most| curvature - most));
        out.push(self.stop.crease_angle.map_or(f64::NAN, |(edge, angle)| state.angles[edge] - angle));
        let crosses = self.intersects.as_mut().map(|intersects| intersects(&state));
        out.push(crosses.map_or(f64::NAN, |crosses| if crosses { 1.0 } else { -1.0 }));
        // the first state of a tube is closed
        out.push(if point.arc_length == 0.0 { f64::NAN } else { self.opening(&state) });
    }
}
