//! Questions about states: equilibria, modes and spectra. State in, result out; nothing here reads or writes files.

pub mod along;
pub mod bloch;
pub mod branches;
pub mod chart;
pub mod exact;
pub mod intersections;
pub mod landscape;
pub mod modes;
pub mod path;
pub mod relax;
pub mod response;
pub mod restored;
pub mod shown_cells;
pub mod state;
pub mod surface;
pub mod trace;
pub mod tube;
pub mod wells;
