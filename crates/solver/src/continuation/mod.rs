//! Continuation: follows a curve `F(x) = 0` from a point on it, in arc length.
//!
//! Predictor: the Hermite interpolant of the last points and their tangents, read beyond the last one. Corrector:
//! Newton's method across the predicted tangent ([`super::implicit`]); redundant equations are welcome. The step
//! follows the error of the prediction. Where branches cross, the Jacobian loses rank at one point; steps go over such
//! points, and the predicted tangent keeps the trajectory on the smooth branch. Arc length is the integral of the
//! interpolant's speed.
//!
//! Along the way the curve's *indicators* are watched: where one changes sign the point is located on the curve. Some
//! of them end the trajectory. Given a period, the trajectory ends where it comes back to its start (`closing`).

mod closing;
mod curve;
mod follower;
mod hermite;
#[cfg(test)]
mod tests;

pub use curve::{CurveOptions, CurvePoint, End, Event, Return, Trajectory};
pub use follower::follow;
