//! Energies of bars and hinges, boundary conditions, and what the equations of a sheet have in common.

mod bent;
mod elements;
mod loads_and_units;
mod material;
mod miura;
mod own_domain;
mod periodic;
mod redundant;
mod rest_lengths;
mod rigid_motions;
mod sparse_spectra;
mod spectra;
mod stiffness;
mod tubes;
mod unstressed;
