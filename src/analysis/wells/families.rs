//! Motions that cost nothing: a truss that has one in a well has a whole family of states at this energy, and any number
//! of them may be found.

use super::placement::{angles_determine_shape, free_rigid_motions};
use super::settle::Settled;
use crate::analysis::modes::{ModesError, modes_at};
use crate::model::{Assembly, Stiffness};

/// Stiffness of a motion, over that of the median crease, or without creases of the median bar, of mean length, up to
/// which it costs nothing: rounding errors of equilibria.
const COSTS_NOTHING: f64 = 1e-9;

/// Whether the sheet has a motion in a well, other than rigid ones, that costs nothing, by the lowest eigenvalues of its
/// stiffness. Only sheets of which fold angles do not determine the shape are asked: their joints move freely most often.
///
/// # Errors
/// [`ModesError`] where they are not found.
pub(crate) fn is_in_family(assembly: &Assembly, well: &Settled) -> Result<bool, ModesError> {
    if angles_determine_shape(assembly) {
        return Ok(false);
    }
    let terms = assembly.terms();
    let of = |eigenvalues| modes_at(assembly, &well.place, eigenvalues, &mut || true);
    // springs join pieces
    let rigid = of(0)?.rigid_motions.min(free_rigid_motions(assembly));
    let first = of(rigid + 1)?.eigenvalues.get(rigid).copied();
    let springs = terms.creases.as_ref().map(|creases| &creases.stiffness).or(terms.bar_stiffness());
    let least = COSTS_NOTHING * springs.map_or(0.0, Stiffness::median) / assembly.mean_edge();
    Ok(first.is_some_and(|first| first <= least))
}
