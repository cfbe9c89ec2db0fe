//! Questions about states: equilibria, modes and spectra. State in, result out; nothing here reads or writes files.


pub mod relax;
pub mod state;
