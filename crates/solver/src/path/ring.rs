//! The half branches that leave a double branch point.
//!
//! Where two eigenvalues vanish at once, as by symmetry, other equilibria leave along some of the directions between
//! two null vectors `n1` and `n2`. On a ring `a = r (cos phi, sin phi)` in their plane all equations of equilibrium are
//! solved but the tangential one: unknowns are the part of the state across the null space, the parameter, which the
//! radial equation determines, and a tangential force `T`. Half branches pass the ring at the zeros of `T(phi)`. No
//! derivatives beyond those of Newton's method are needed, and the answer does not depend on the null vectors' choice
//! (the reduction is that of Lyapunov and Schmidt: M. Golubitsky, I. Stewart, D. Schaeffer, "Singularities and Groups
//! in Bifurcation Theory", 1988).
//!
//! The force `T` shrinks with the radius as `r^(N - 1)` where the sheet has a symmetry of order `N`. On a small ring it
//! is lost in rounding errors: the ring is widened until it is well above them. Where another branch point is near, no
//! states are found on a wide ring: it is narrowed.

use super::bordered::{Hyperplane, Planes, REFUSED_RESIDUAL};
use super::follower::Follower;
use super::outcome::Found;
use super::problem::{ParametrizedProblem, PathState, Rates};
use foldwell_numerics::vector::{add_scaled, dot, larger, max_abs, norm_blocked};
use std::f64::consts::TAU;

/// Radius of the first ring in arc length, the factor to the next one, and the number of wider rings and of narrower
/// ones.
const FIRST_RADIUS: f64 = 0.01;
const WIDER: f64 = std::f64::consts::SQRT_2;
const WIDER_RINGS: i32 = 10;
const NARROWER_RINGS: i32 = 10;
/// Number of states on a ring on which half branches are sought, a multiple of that on one that is only tried.
const STATES: usize = 144;
const TRIED: usize = 36;
/// Angle of the first state, so that no symmetry puts states on half branches.
const FIRST_ANGLE: f64 = 0.017;
/// Largest tangential force on a ring that is wide enough, over the bound on residuals; and that between two zeros.
const CLEAR: f64 = 1e2;
const CLEAR_BETWEEN: f64 = 1e1;
/// Newton steps to a state on a ring, the length relative to the radius of one after which there is none (the next
/// would be its square, and what is left is in the residual), and the largest contraction.
const MOST_STEPS: usize = 12;
const LAST_STEP: f64 = 1e-7;
const SLOWEST_CONTRACTION: f64 = 0.6;
/// Rounds in which a zero is located.
const MOST_ROUNDS: usize = 40;
/// Distance of an equilibrium from the zero of the tangential force that led to it, relative to the radius.
const NEAR: f64 = 0.1;

/// A ring about a branch point.
struct Ring<'a> {
    point: &'a PathState,
    nulls: &'a [Rates; 2],
    planes: [Hyperplane; 2],
    radius: f64,
}

/// A state on a ring, with the tangential force and the largest other residual, both relative to the largest force.
#[derive(Clone)]
struct OnRing {
    angle: f64,
    at: Rates,
    pull: f64,
    residual: f64,
}

/// The half branches that pass a ring, or why they are not known.
enum Passing {
    /// Their number, and the first states of those that are found.
    Known(usize, Vec<PathState>),
    /// The tangential forces are rounding errors.
    TooNarrow,
    /// Newton's method finds no state at some angle.
    TooWide,
}

impl Ring<'_> {
    fn place(&self, angle: f64) -> [f64; 2] {
        let (sin, cos) = angle.sin_cos();
        [self.radius * cos, self.radius * sin]
    }

    /// A guess moved to another angle.
    fn turned(&self, mut at: Rates, [from, to]: [[f64; 2]; 2]) -> Rates {
        for (null, (from, to)) in self.nulls.iter().zip(from.into_iter().zip(to)) {
            at.add(to - from, null);
        }
        at
    }
}

impl<P: ParametrizedProblem> Follower<'_, P> {
    /// Number of the half branches that leave along directions between two orthonormal null vectors, and the first
    /// states of those that are found; `None` where the tangential force is rounding error on every ring.
    pub(super) fn half_branches(
        &mut self,
        point: &PathState,
        nulls: &[Rates; 2],
    ) -> Found<Option<(usize, Vec<PathState>)>> {
        let unit = self.bordered.unit;
        let planes = [0, 1].map(|k| Hyperplane { x: nulls[k].x.clone(), parameter: nulls[k].parameter / unit });
        let (mut rung, mut narrow, mut wide) = (0, -NARROWER_RINGS - 1, WIDER_RINGS + 1);
        while narrow + 1 < wide {
            let radius = FIRST_RADIUS * WIDER.powi(rung) * self.bordered.length;
            let ring = Ring { point, nulls, planes: planes.clone(), radius };
            match self.passing(&ring)? {
                Passing::Known(number, firsts) => return Ok(Some((number, firsts))),
                Passing::TooNarrow => (rung, narrow) = (rung + 1, rung),
                Passing::TooWide => (rung, wide) = (rung - 1, rung),
            }
        }
        Ok(None)
    }

    /// Seeks the half branches that pass a ring, at the zeros of the tangential force round it.
    fn passing(&mut self, ring: &Ring<'_>) -> Found<Passing> {
        let Some(tried) = self.round(ring, TRIED)? else { return Ok(Passing::TooWide) };
        if !self.is_clear(&tried, CLEAR) {
            return Ok(Passing::TooNarrow);
        }
        let Some(states) = self.round(ring, STATES)? else { return Ok(Passing::TooWide) };
        let zeros: Vec<usize> = (0..STATES).filter(|&k| crosses(&states, k)).collect();
        let lobe = |k: usize| {
            let (from, to) = (zeros[k] + 1, zeros[(k + 1) % zeros.len()] + 1);
            let count = (to + STATES - from - 1) % STATES + 1;
            (0..count).map(|step| states[(from + step) % STATES].clone()).collect::<Vec<_>>()
        };
        if !(0..zeros.len()).all(|k| self.is_clear(&lobe(k), CLEAR_BETWEEN)) {
            return Ok(Passing::TooNarrow);
        }
        Ok(Passing::Known(zeros.len(), self.equilibria(ring, &states, &zeros)?))
    }

    /// Whether the largest tangential force of these states is clearly not rounding error.
    fn is_clear(&self, states: &[OnRing], times: f64) -> bool {
        let largest = states.iter().fold(0.0, |most, state| larger(most, state.pull.abs()));
        let residual = states.iter().fold(self.settings.tolerance, |most, state| larger(most, state.residual));
        largest >= times * residual
    }

    /// States at evenly spaced angles of a ring; `None` where one is not found.
    fn round(&mut self, ring: &Ring<'_>, count: usize) -> Found<Option<Vec<OnRing>>> {
        let mut states: Vec<OnRing> = vec![];
        for k in 0..count {
            let angle = FIRST_ANGLE + TAU * k as f64 / count as f64;
            let guess = match states.last() {
                None => ring.turned(ring.point.place(), [[0.0; 2], ring.place(angle)]),
                Some(last) => ring.turned(last.at.clone(), [last.angle, angle].map(|angle| ring.place(angle))),
            };
            let Some(state) = self.on_ring(ring, angle, guess)? else { return Ok(None) };
            states.push(state);
        }
        Ok(Some(states))
    }

    /// The state on a ring at this angle, by Newton's method from a guess.
    fn on_ring(&mut self, ring: &Ring<'_>, angle: f64, mut at: Rates) -> Found<Option<OnRing>> {
        let (sin, cos) = angle.sin_cos();
        let mut along: Vec<f64> = ring.nulls[1].x.iter().map(|x| cos * x).collect();
        add_scaled(&mut along, -sin, &ring.nulls[0].x);
        let pulls = [along];
        let (mut pull, mut last) = (0.0, f64::INFINITY);
        for _ in 0..=MOST_STEPS {
            self.problem.set_parameter(at.parameter);
            self.bordered.linearize(self.problem, &at.x, &at.tension);
            let mut force = self.bordered.tangent.at.force(&at.tension);
            add_scaled(&mut force, -pull, &pulls[0]);
            let missing = self.bordered.tangent.at.missing(&at.tension, self.problem.compliance());
            let open = missing.iter().zip(self.problem.gap_scale()).map(|(gap, scale)| gap.abs() / scale);
            let largest = self.bordered.tangent.at.largest_force;
            let residual = open.fold(max_abs(&force) / largest, larger);
            if last <= LAST_STEP * ring.radius {
                return Ok(Some(OnRing { angle, at, pull: pull / largest, residual }));
            }
            self.bordered.factor()?;
            let unit = self.bordered.unit;
            let mut off = at.x.clone();
            add_scaled(&mut off, -1.0, &ring.point.x);
            let way = (at.parameter - ring.point.parameter) / unit;
            let wanted = ring.place(angle);
            let distances = [0, 1].map(|k| wanted[k] - dot(&ring.planes[k].x, &off) - ring.planes[k].parameter * way);
            let planes = [&ring.planes[0], &ring.planes[1]];
            let planes = Planes { planes: &planes, distances: &distances, pulls: &pulls };
            let (step, more, solved) = self.bordered.solve_across(&force, &missing, &planes);
            let length = norm_blocked(&step.x).hypot(step.parameter / unit);
            let contracts = length <= larger(SLOWEST_CONTRACTION * last, LAST_STEP * ring.radius);
            if !(solved <= REFUSED_RESIDUAL && contracts && residual.is_finite()) {
                return Ok(None);
            }
            at.add(1.0, &step);
            pull += more[0];
            last = length;
        }
        Ok(None)
    }

    /// The equilibria between neighbouring states of a ring whose tangential forces have different signs.
    fn equilibria(&mut self, ring: &Ring<'_>, states: &[OnRing], zeros: &[usize]) -> Found<Vec<PathState>> {
        let mut found = vec![];
        for &k in zeros {
            let Some(zero) = self.zero(ring, [&states[k], &states[(k + 1) % states.len()]])? else { continue };
            let (sin, cos) = zero.angle.sin_cos();
            let [one, other] = ring.nulls;
            let mut radial = one.clone().scaled(cos);
            radial.add(sin, other);
            let plane = Hyperplane::across(&radial, self.bordered.unit);
            let away = ring.radius / self.bordered.length;
            found.extend(self.settle(zero.at, &plane, away)?.filter(|(_, off)| *off <= NEAR * ring.radius));
        }
        Ok(found.into_iter().map(|(state, _)| state).collect())
    }

    /// The zero of the tangential force between two states, by false position with halved ends.
    fn zero(&mut self, ring: &Ring<'_>, [from, to]: [&OnRing; 2]) -> Found<Option<OnRing>> {
        let (mut low, mut high) = (from.clone(), to.clone());
        high.angle = low.angle + (high.angle - low.angle).rem_euclid(TAU);
        let (mut best, mut ends) = (low.clone(), [low.pull, high.pull]);
        for _ in 0..MOST_ROUNDS {
            let part = (ends[0] / (ends[0] - ends[1])).clamp(1e-3, 1.0 - 1e-3);
            let angle = low.angle + part * (high.angle - low.angle);
            let guess = ring.turned(low.at.clone(), [low.angle, angle].map(|angle| ring.place(angle)));
            let Some(here) = self.on_ring(ring, angle, guess)? else { return Ok(None) };
            best = here.clone();
            if here.pull.abs() <= here.residual || high.angle - low.angle <= f64::EPSILON * TAU {
                break;
            }
            if here.pull * low.pull > 0.0 {
                (ends, low) = ([here.pull, 0.5 * ends[1]], here);
            } else {
                (ends, high) = ([0.5 * ends[0], here.pull], here);
            }
        }
        Ok(Some(best))
    }
}

/// Whether the tangential force changes its sign from this state of a ring to the next.
fn crosses(states: &[OnRing], k: usize) -> bool {
    states[k].pull * states[(k + 1) % states.len()].pull <= 0.0
}
