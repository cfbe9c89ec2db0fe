//! The solver on problems without sheets.

mod hanging_chain;
mod solver_limits;
mod solver_textbook;
