//! The linear response of a periodic sheet: what its folding modes do to the sheet as a whole.
//!
//! Every linear folding mode of a state makes an in-plane strain and a curvature tensor, three numbers each: the table
//! of the modes. A generic cell has three modes, and the table has rank 3: of the six strains and bendings of a thin
//! sheet three cost no stretching. On a cylinder there are two modes.
//!
//! | file | content |
//! |---|---|
//! | `result` | what a response is |
//! | `cell` | the cell in a spatially periodic state |
//! | `periodic` | the modes of a spatially periodic state |
//! | `cylinder` | the modes of a state that is rolled up |
//! | `mode` | a mode, and the table of the modes |
//! | `tensors` | spaces of symmetric tensors and their Poisson's ratios |
//! | `poisson` | both Poisson's ratios of a sheet, and whether they are opposite |
//! | `compatibility` | rates of lengths and angles under strains and bendings of the lattice |
//! | `moduli` | effective moduli of a sheet at rest |
//! | `moduli_matrices` | the matrices of the moduli, and principal strains and bendings |
//! | `condensed` | the condensation of the springs of a cell |
//! | `symmetry_types` | modes and self stresses that are even and odd under the symmetries of the sheet |
//! | `stresses` | self stresses, and the forces and moments that they put on the lattice |
//!
//! **Conventions.** x is along the first lattice vector of the state, y in the plane of the lattice towards the second,
//! the normal is on the side of the face normals. A strain is the rate of `a^-T g a^-1` with the metric `g` of the
//! chords from vertex 0 and `a` that of the state itself: no factor of a half, so that it is the rate of the strain in
//! the tables of other studies where the state is the drawn one. A curvature tensor is that of
//! [`mod@crate::kinematics::folding_modes`]. Components are 11, 22, 12.

mod cell;
mod compatibility;
mod condensed;
mod cylinder;
mod error;
mod mode;
mod moduli;
mod periodic;
mod poisson;
mod result;
mod stresses;
mod symmetry_types;
mod tensors;

pub use condensed::{ModuliMatrices, Principal};
pub use error::ResponseError;
pub use mode::{Field, LinearMode, ModeTable};
pub use moduli::{Moduli, moduli_at};
pub use poisson::{Poisson, Relation};
pub use result::{LatticeMotions, Response};
pub use stresses::SelfStress;
pub use symmetry_types::SymmetryTypes;
pub use tensors::{NoRatio, TensorSpace};

use super::modes::modes_at;
use super::restored;
use crate::model::{Assembly, Configuration, Gauge, RIGID, Terms};
use cell::PeriodicCell;
use std::collections::BTreeSet;

/// Computes the linear response of the drawn state; see [`response_at`].
///
/// ```
/// use foldwell::analysis::response::response;
/// use foldwell::{Assembly, Pattern, RIGID, generate};
///
/// // triangulated Miura-ori: its polygons bend
/// let miura = generate(&Pattern::named("miura")?)?;
/// let assembly = Assembly::torus(miura, [1, 1]).bars(RIGID).facets(1.0).build()?;
/// let response = response(&assembly)?;
/// assert_eq!((response.modes.len(), response.table.rank), (3, 3));
/// let poisson = response.poisson.ok_or("a sheet that is not rolled up has ratios")?;
/// let [in_plane, bending] = [poisson.in_plane.ratio(0.0), poisson.bending.ratio(0.0)];
/// let sum = in_plane.and_then(|ratio| bending.map(|other| ratio + other));
/// assert!(sum.is_ok_and(|sum| sum.abs() < 1e-10), "one planar mode and two bending modes");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`response_at`].
pub fn response(assembly: &Assembly) -> Result<Response, ResponseError> {
    let assembly = assembly.with_axis(0.0);
    response_at(&assembly, &restored::drawn(&assembly))
}

/// Computes the linear response of a state of a periodic assembly.
///
/// The modes keep the lengths of all bars, the angles of locks and the shape of rigid polygons, whatever the stiffness
/// of the bars.
///
/// # Errors
/// [`ResponseError`] for a patch, for a state of several cells that is not the drawn one, and where the number of modes
/// or the rank of the table is not clear.
pub fn response_at(assembly: &Assembly, state: &Configuration) -> Result<Response, ResponseError> {
    let rigid = assembly.with_terms(rigid_terms(assembly));
    let cell = PeriodicCell::of_state(&rigid, &state.coordinates, rigid.model(Gauge::Free))?;
    let mut response = match cell {
        Some(cell) => periodic::response(&rigid, &cell)?,
        None => cylinder::response(&rigid, &state.coordinates)?,
    };
    response.self_stresses = modes_at(assembly, state, 0, &mut || true)?.self_stresses;
    Ok(response)
}

/// Returns rigid bars, and locks of all hinges that keep their angles.
fn rigid_terms(assembly: &Assembly) -> Terms {
    let locked: BTreeSet<usize> = assembly.locked_edges().into_iter().collect();
    let locks = locked.into_iter().map(|edge| (edge, assembly.drawn_angles()[edge])).collect();
    Terms { bars: Some(RIGID.into()), locks, ..Terms::default() }
}

/// Returns Poisson's ratios in the plane and of bending, along the first lattice vector, of a state; `None` for one
/// that does not exist, as for a state that is rolled up.
///
/// The argument `bending` says which modes are meant: if it is true, all polygons bend and locks are released;
/// otherwise rigid polygons and locks keep their angles.
pub(crate) fn ratios_at(
    assembly: &Assembly,
    coordinates: &[f64],
    bending: bool,
) -> Result<[Option<f64>; 2], ResponseError> {
    let locks = if bending { vec![] } else { rigid_terms(assembly).locks };
    let free = assembly.with_terms(Terms { locks, bars: Some(RIGID.into()), ..Terms::default() });
    let cell = PeriodicCell::of_state(&free, coordinates, free.model(Gauge::Free))?;
    let modes = cell.map(|cell| periodic::modes_of(&free, &cell)).transpose()?;
    let poisson = modes.and_then(|modes| modes.poisson);
    Ok(poisson.map_or([None; 2], |found| [found.in_plane, found.bending].map(|space| space.ratio(0.0).ok())))
}

/// Finds the effective moduli of the drawn state; see [`moduli_at`].
///
/// # Errors
/// As [`moduli_at`].
pub fn moduli(assembly: &Assembly) -> Result<Moduli, ResponseError> {
    moduli_at(assembly, &restored::drawn(assembly))
}
