//! Questions about states: equilibria, modes and spectra. State in, result out; nothing here reads or writes files.

pub mod along;
mod apex;
pub mod bloch;
pub mod branches;
mod certainty;
pub mod chart;
pub mod exact;
mod fallback;
pub mod intersections;
pub mod landscape;
pub mod method;
pub mod modes;
pub mod path;
pub mod recorder;
pub mod relax;
pub mod response;
pub mod restored;
mod rigid_forces;
pub mod shown_cells;
pub mod singular_start;
pub mod start_state;
pub mod state;
mod straight;
pub mod surface;
pub mod trace;
pub mod tube;
pub mod wells;
