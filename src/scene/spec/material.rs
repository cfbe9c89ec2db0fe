//! `[units]` and `[material]`: what a sheet is measured in, and what it is made of.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::scene::values::{PoissonRatio, Positive};

/// `[units]`: names of units for axes, tables and summaries.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UnitsSpec {
    /// The unit of lengths, as "mm".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<String>,
    /// The unit of forces, as "N".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<String>,
}

impl UnitsSpec {
    /// Returns a quantity with its unit in parentheses: these powers of the units of force and length. Without names of
    /// these units the quantity alone.
    pub(crate) fn label(&self, quantity: &str, force: i32, length: i32) -> String {
        let mut unit = String::new();
        for (power, name) in [(force, &self.force), (length, &self.length)].into_iter().filter(|(power, _)| *power != 0)
        {
            let Some(name) = name else { return quantity.to_owned() };
            let sign = if power < 0 {
                "/"
            } else if unit.is_empty() {
                ""
            } else {
                " "
            };
            unit += &match power.abs() {
                1 => format!("{sign}{name}"),
                power => format!("{sign}{name}^{power}"),
            };
        }
        if unit.is_empty() { quantity.to_owned() } else { format!("{quantity} ({unit})") }
    }

    /// Returns the name of an axis of energies.
    pub(crate) fn energy(&self) -> String {
        let unnamed = self.force.is_none() || self.length.is_none();
        if unnamed { "energy (unit of the scene)".to_owned() } else { self.label("energy", 1, 1) }
    }
}

/// `[material]`: an elastic sheet of uniform thickness.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialSpec {
    /// Young's modulus, force per area.
    pub young: Positive,
    /// Poisson's ratio.
    pub poisson: PoissonRatio,
    /// Thickness of the sheet.
    pub thickness: Positive,
    /// Length scale of the creases: the width of the strip of sheet that bends as one of them. Left out: `energy` gives
    /// the stiffness of creases, or there are none.
    pub crease_length: Option<Positive>,
}
