//! Energy wells of folding sheets.
//!
//! A triangulated origami sheet is a network of bars (its edges) and hinges (its creases, and the diagonals of its
//! polygons, called facets). `foldwell` computes the equilibria of such a network with a Newton method that works for
//! every stiffness, including the exactly rigid sheet, and compares them with the theory of rigid folding.
//!
//! The following program relaxes nine cells of Miura-ori with rigid bars whose creases are flat at rest, and writes a
//! file that ParaView opens:
//!
//! ```
//! use foldwell::{Assembly, Pattern, Picture, RIGID, Rest, generate, relax, write_vtu};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let sheet = generate(&Pattern::named("miura")?)?;
//!     let assembly = Assembly::patch(sheet, [3, 3]).bars(RIGID).creases(1.0).rest(Rest::Flat).build()?;
//!     let relaxed = relax(&assembly)?;
//!     println!("energy {:.3e} after {} steps", relaxed.state.total(), relaxed.iterations);
//!     write_vtu(&std::env::temp_dir().join("miura.vtu"), &Picture::new(&assembly, &relaxed.state))?;
//!     Ok(())
//! }
//! ```
//!
//! Lengths are in the unit of the sheet, angles in radians, valley folds positive. A crease of stiffness `k` and length
//! `l` has the energy `k l (angle - rest)^2 / 2`, a bar of stiffness `EA` and rest length `L` the energy
//! `EA L strain^2 / 2`. The folder `examples` has longer programs: a relaxation, a trajectory of rigid folding until it
//! closes, an energy landscape, a map of Bloch modes, a law and a term of one's own, and a custom energy.
//!
//! # Where to begin
//!
//! | to | see |
//! |---|---|
//! | read a mesh or a crease pattern | [`sheet::fold::read`], [`sheet::obj::read`], [`sheet::pattern::read`]; [`generate()`] makes one |
//! | give it stiffnesses, rest angles, locks, pins and loads | [`Assembly::patch`], [`Assembly::torus`], [`Assembly::screw`] and the builder they return |
//! | add a law, a term or a domain of your own | [`model::Law`], [`model::OwnTerm`], [`model::CellMaps`] |
//! | relax it | [`relax()`]; from another start, or step by step, [`analysis::relax::relax_from`] |
//! | read fold angles, strains, tensions and energies edge by edge | [`analysis::state::State`] |
//! | find zero modes, self stresses and eigenvalues | [`analysis::modes::modes`] |
//! | find the branches of rigid folding and follow them | [`analysis::branches`], [`analysis::trace`] |
//! | drive a displacement, a load or an angle | [`analysis::path`] |
//! | find stable states and barriers | [`analysis::wells`] |
//! | measure what modes cost, or find spatially varying ones | [`analysis::landscape`], [`analysis::bloch`] |
//! | run a scene file as the program does | [`run::run_scene`] |
//! | write a state for ParaView | [`Picture`], [`write_vtu`] |
//!
//! # Terms
//!
//! Each concept has one name in code, messages and documents:
//!
//! | term | meaning |
//! |---|---|
//! | sheet, cell | one period of a triangulated surface with its two lattice vectors, or a finite piece |
//! | tiling | the cells of a sheet that a study uses |
//! | boundary conditions | patch (free edges), torus (periodic), screw (one cell repeated by screw motions), tube (the same, closed), or one's own |
//! | assembly | a sheet with its boundary conditions and terms |
//! | terms | stiffnesses and rest angles of bars, creases and facets; locks, pins, loads |
//! | bar, crease, facet, hinge | an edge; an edge between polygons; a diagonal of a polygon; a crease or a facet |
//! | drawn state | the positions in the file |
//! | state | positions with the fold angle, strain, force and energy of every edge |
//! | equilibrium, minimum, saddle point | a state without net force; with no negative eigenvalue; with at least one |
//! | tension | force of a bar or torque of a hinge that is an unknown itself |
//! | rigid | a bar that keeps its length, a facet that keeps its angle: infinite stiffness |
//! | closure | the condition that rotations by the fold angles around a vertex multiply to the identity |
//! | trajectory, branch | a curve of rigidly folded states; a trajectory that leaves the drawn state |
//! | well, barrier | a minimum; the lowest saddle point between two minima |
//! | residual, tolerance | the error of an equation; its largest value at which a solver stops |
//!
//! # Modules
//!
//! The modules form layers; each imports only from lower ones. [`numerics`] and [`solver`] are crates of their own,
//! which know no sheet:
//!
//! | layer | modules | content |
//! |---|---|---|
//! | 6 | [`run`] | the pipeline: reads a scene, computes its studies, writes their files |
//! | 5 | [`study`] | the kinds of study, each of which computes an answer and writes no file |
//! | 4 | [`scene`], [`output`] | the input files and the output files |
//! | 3 | [`analysis`] | analyses of states: equilibria, modes, spectra |
//! | 2 | [`model`], [`kinematics`] | energies of bars and hinges; exact folding by closure of vertices |
//! | 1 | [`sheet`], [`solver`] | cells, lattices and files of sheets; a Newton method independent of origami |
//! | 0 | [`math`], [`numerics`] | rotations and the sinc family; sparse matrices and factorizations |
#![cfg_attr(test, allow(clippy::unwrap_used))]
// pages of public modules link to private items too, which `cargo doc --document-private-items` shows
#![allow(rustdoc::private_intra_doc_links)]

pub mod analysis;
pub mod kinematics;
pub mod math;
pub mod model;
pub mod output;
pub mod run;
pub mod scene;
pub mod sheet;
pub mod study;

pub use foldwell_numerics as numerics;
pub use foldwell_solver as solver;

pub use analysis::relax::{Relaxed, relax};
pub use analysis::tube::rolled_up;
pub use model::{Assembly, Boundary, RIGID, Rest, Roll, Terms};
pub use output::{picture::Picture, vtk::write_vtu};
pub use sheet::{Pattern, Sheet, generate};
