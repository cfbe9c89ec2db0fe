//! Poisson's ratios of the states of a table, where a study asks for them.

use super::{Context, StudyError};
use crate::analysis::response::ratios_at;
use crate::model::{Assembly, Domain};
use crate::scene::Located;
use crate::scene::spec::RatioColumns;

/// Checks that the states of a study have ratios: those of one periodic cell.
pub(crate) fn check(context: &Context<'_>, columns: Option<&Located<RatioColumns>>) -> Result<(), StudyError> {
    let Some(columns) = columns else { return Ok(()) };
    let assembly = context.assembly;
    let refuse = |message: &str, help: &str| Err(context.file.error_at(columns.span(), message, help).into());
    if matches!(assembly.drawn().domain, Domain::Patch) || assembly.tiling().cells != [1, 1] {
        let help = "give domain = \"screw\", or domain = \"torus\" with cells = [1, 1]";
        return refuse("Poisson's ratios are those of one cell of a periodic sheet", help);
    }
    if matches!(assembly.domain(), Domain::Tube { .. }) {
        return refuse("Poisson's ratios of a sheet that is rolled up are not known", "leave out `response`");
    }
    Ok(())
}

/// Returns the ratios in the plane and of bending, along the first lattice vector, of a state; `None` if the study does
/// not ask for them. A state that is rolled up, or whose modes are not clear, has none.
pub(crate) fn of_state(
    assembly: &Assembly,
    columns: Option<&Located<RatioColumns>>,
    coordinates: &[f64],
) -> Option<[Option<f64>; 2]> {
    columns.map(|columns| ratios_at(assembly, coordinates, **columns == RatioColumns::Bending).unwrap_or_default())
}
