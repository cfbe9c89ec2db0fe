//! Exact folding: closure of vertices, branches, theorems.

mod branches;
mod exact_folding;
mod folding_theory;
