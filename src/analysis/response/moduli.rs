//! Effective moduli of a sheet at rest: its energy per area under small strains and bendings of the lattice, minimised
//! over the vertices of the cell.
//!
//! `energy / area = E S E / 2 + E C K + K B K / 2` with the strain `E` of the chords from vertex 0 and the curvature
//! tensor `K`, both as lists of the components 11, 22, 12. The energy of a state at rest is quadratic in the rates of
//! lengths and angles ([`super::compatibility`]); under stress it would depend on second derivatives of motions that
//! bend the sheet in two directions, which have none.

use super::cell::{CellElement, PeriodicCell};
use super::condensed::{CellSprings, Condensed, ModuliMatrices, Principal};
use super::error::ResponseError;
use crate::model::{Assembly, Configuration, Gauge};

/// Largest distance of a hinge from its rest angle in radians, and of a bar from its rest length relative to that
/// length, in a state at rest.
const AT_REST: f64 = 1e-9;

/// The effective moduli of a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Moduli {
    /// The moduli; `None` where rigid elements make some of them infinite.
    pub matrices: Option<ModuliMatrices>,
    /// Moduli of the bars alone, with hinges of no stiffness and the stiffest bar of `EA = 1`: the limit of the moduli
    /// over `EA` for stiff bars. Their null space are the rigid modes. `None` where rigid polygons or locks make some
    /// of them infinite.
    pub rigid_limit: Option<ModuliMatrices>,
    /// Principal strains and bendings of the rigid modes alone, in the limit of rigid bars, by rising stiffness.
    pub rigid_modes: Vec<Principal>,
    /// The softest principal strains and bendings of all, as many as there are rigid modes, by rising stiffness.
    pub softest: Vec<Principal>,
}

/// Finds the effective moduli of a state of a periodic assembly: of the stretching, bending and their coupling.
///
/// # Errors
/// [`ResponseError`] for one that is not periodic, or whose cells differ, for a state that has no moduli, and where a
/// decomposition fails.
pub fn moduli_at(assembly: &Assembly, state: &Configuration) -> Result<Moduli, ResponseError> {
    if assembly.terms().bars.is_none() {
        return Err(ResponseError::NoBars);
    }
    if !assembly.terms().own.is_empty() {
        return Err(ResponseError::OwnTerms);
    }
    let mut model = assembly.model(Gauge::Free);
    model.enter(state);
    let cell = PeriodicCell::of_state(assembly, &state.coordinates, model)?.ok_or(ResponseError::RolledUp)?;
    let elements = cell.elements(assembly, &cell.model);
    let off = elements.iter().map(|element| off_rest(&cell, element)).fold(0.0, f64::max);
    if !(off <= AT_REST) {
        return Err(ResponseError::UnderStress { off });
    }
    let springs = CellSprings::new(&cell, &elements);
    let own = Condensed::new(&springs)?;
    let limit = Condensed::new(&springs.of_bars())?;
    let (mut rigid_modes, mut softest) = (own.rigid_modes()?, own.softest()?);
    let rigid: Vec<f64> = rigid_modes.iter().map(|mode| mode.stiffness).collect();
    for principals in [&mut rigid_modes, &mut softest] {
        for (principal, rigid) in principals.iter_mut().zip(&rigid) {
            principal.ratio = Some(principal.stiffness / rigid).filter(|ratio| ratio.is_finite());
        }
    }
    let (matrices, rigid_limit) = (own.matrices(), limit.matrices());
    Ok(Moduli { matrices, rigid_limit, rigid_modes, softest })
}

/// Returns how far an element of finite stiffness is off its rest value: an angle in radians, or a length relative to
/// it.
fn off_rest(cell: &PeriodicCell, CellElement { element, .. }: &CellElement<'_>) -> f64 {
    let spring = element.spring;
    if spring.stiffness.is_infinite() {
        return 0.0;
    }
    let off = element.value(&cell.coordinates) - spring.rest;
    if element.is_angle() { off.abs() } else { off.abs() / spring.rest }
}
