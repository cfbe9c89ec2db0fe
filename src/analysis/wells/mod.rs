//! Wells and barriers: the stable states of a sheet whose creases do not rest as drawn, and the passes between them.
//!
//! Wells are reached from random starts ([`starts`]), are minima by inertia, and are told apart by their fold angles
//! ([`merge`]). A path between two of them is found by the string method ([`string`]) and its highest state made a
//! saddle by Newton's method ([`pass`]), which then is followed to the stiffness of the bars that is asked for
//! ([`barrier`]). Beside this, without any bar: the energy of the creases on the folded states of the exact kinematics,
//! on curves and on surfaces ([`rigid`]).

pub mod barrier;
pub(crate) mod families;
pub mod limit;
pub mod merge;
pub(crate) mod pass;
pub mod placement;
pub mod rigid;
pub mod settle;
pub mod starts;
pub(crate) mod string;
pub(crate) mod work;
