//! Wells of trusses along which the truss moves at no cost: states of a family, any number of which may be found.

use super::settle::Settled;
use crate::analysis::modes::{ModesError, modes_at};
use crate::model::{Assembly, Domain, Stiffness};

/// Stiffness of a motion, over that of the median crease, or without creases of the median bar, of mean length, up to
/// which it costs nothing: rounding errors of equilibria.
const COSTS_NOTHING: f64 = 1e-9;

/// Whether fold angles alone do not tell the shape of a patch: there are bars without faces, or no creases.
pub(crate) fn is_truss(assembly: &Assembly) -> bool {
    let (terms, tiling) = (assembly.terms(), assembly.tiling());
    *assembly.domain() == Domain::Patch && (terms.creases.is_none() || tiling.has_bars_alone())
}

/// Whether a well of a truss has a motion, other than rigid ones, that costs nothing, by the lowest eigenvalues of its
/// stiffness; other sheets are not asked.
///
/// # Errors
/// [`ModesError`] where they are not found.
pub(crate) fn is_in_family(assembly: &Assembly, well: &Settled) -> Result<bool, ModesError> {
    if !is_truss(assembly) {
        return Ok(false);
    }
    let terms = assembly.terms();
    let of = |eigenvalues| modes_at(assembly, &well.place, eigenvalues, &mut || true);
    let rigid = of(0)?.rigid_motions;
    let first = of(rigid + 1)?.eigenvalues.get(rigid).copied();
    let springs = terms.creases.as_ref().map(|creases| &creases.stiffness).or(terms.bar_stiffness());
    let least = COSTS_NOTHING * springs.map_or(0.0, Stiffness::median) / assembly.mean_edge();
    Ok(first.is_some_and(|first| first <= least))
}
