//! All complex solutions of homogeneous quadrics, with multiplicity.
//!
//! `m` quadrics in `m + 1` homogeneous unknowns have `2^m` solutions in projective space, each counted with its
//! multiplicity, or infinitely many (Bezout). They are followed along `2^m` paths from a system whose solutions are
//! known (`system`), by a predictor and corrector with step control (`track`), through an endgame that finds multiple
//! solutions as well (`endgame`). In projective space nothing goes to infinity, so no path may be lost.
//!
//! What the paths find is not taken on trust. Simple solutions are proved by Smale's criterion, and two paths must not
//! end at one of them; the multiplicity of the others is computed from the equations around them (`multiplicity`) and
//! has to be the number of paths that end there; what is not real has to come in conjugate pairs. Where all agrees the
//! multiplicities add up to `2^m`, so nothing is missing, whatever a path did on its way. Where it does not, everything
//! is done again with smaller steps and other random numbers (`square`). Quadrics of other numbers than unknowns less
//! one are reduced to such systems (`sections`, `singular`).

mod elimination;
mod endgame;
mod error;
mod multiplicity;
mod sections;
mod series;
mod singular;
mod solutions;
mod square;
mod system;
mod track;

#[cfg(test)]
mod tests;

pub use error::HomotopyError;
pub use sections::{Section, meets_real_points, solve_any};
pub use singular::{SingularPoint, real_singular_points};
pub use solutions::Solution;
