//! The cell whose folded states are sought.

use super::error::SurfaceError;
use crate::kinematics::{Closure, Embedding, SecondOrder};
use crate::model::{Assembly, Domain};

/// The cell of a sheet, and what second order says of its drawn state.
pub(super) fn of(assembly: &Assembly) -> Result<(Closure, Embedding, SecondOrder), SurfaceError> {
    let sheet = assembly.sheet();
    if *assembly.domain() != Domain::Screw {
        return Err(SurfaceError::NotScrew);
    }
    let closure = Closure::of_cell(sheet)?.with_locked(&assembly.locked_edges());
    closure.is_complete()?;
    let embedding = Embedding::new(sheet)?;
    let second_order = SecondOrder::new(&closure, embedding.drawn_angles())?;
    Ok((closure, embedding, second_order))
}
