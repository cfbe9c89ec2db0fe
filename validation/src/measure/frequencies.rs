//! How frequencies depend on mass and stiffness.

use super::super::findings::{ExperimentError, Findings};
use foldwell::analysis::modes::{Vibrations, modes};
use foldwell::model::Mass;
use foldwell::numerics::worst;
use foldwell::sheet::generate::{MiuraPatch, Pattern};
use foldwell::{Assembly, generate};
use serde_json::json;

/// Factors of the mass per area and of all stiffnesses.
const FACTORS: [[f64; 2]; 6] = [[4.0, 1.0], [1e-6, 1.0], [1e6, 1.0], [1.0, 1e-2], [1.0, 1e6], [7.3, 0.3]];
/// Number of vibrations, the six rigid motions among them.
const COUNT: usize = 24;
const RIGID_MOTIONS: usize = 6;

/// Finds the slowest vibrations of Miura-ori, 3 x 3 cells with soft facets and free edges, with mass and stiffnesses
/// multiplied by factors. The error of scaling is the largest relative difference of a frequency from
/// `sqrt(stiffness / mass)` times that without factors.
pub fn measure(_quick: bool) -> Result<Findings, ExperimentError> {
    let reference = slowest([1.0, 1.0])?;
    let (mut errors, mut zeros) = (Vec::new(), Vec::new());
    for factors in FACTORS {
        let found = slowest(factors)?;
        let expected = (factors[1] / factors[0]).sqrt();
        zeros.push(found.iter().filter(|frequency| **frequency == 0.0).count());
        let pairs = found.iter().zip(&reference).skip(RIGID_MOTIONS);
        errors.extend(pairs.map(|(found, reference)| (found / (expected * reference) - 1.0).abs()));
    }
    let values = json!({ "scaling error": worst(errors), "zeros": zeros });
    Ok(Findings { values, ..Findings::default() })
}

/// Returns the lowest frequencies with these factors of mass and stiffness; not a number for motions that grow.
fn slowest([mass, stiffness]: [f64; 2]) -> Result<Vec<f64>, ExperimentError> {
    let failed = |reason: String| ExperimentError::Other(reason);
    let pattern = Pattern::MiuraPatch(MiuraPatch { cells: [3, 3], ..MiuraPatch::default() });
    let sheet = generate(&pattern).map_err(|error| failed(error.to_string()))?;
    let energy = Assembly::patch(sheet, [1, 1]).bars(1e3 * stiffness).creases(0.1 * stiffness).facets(stiffness);
    let assembly = energy.mass(Mass::Area(0.1 * mass)).build()?;
    let found = modes(&assembly, COUNT, &mut || true).map_err(|error| failed(error.to_string()))?;
    let frequencies = found.vibrations.as_ref().map(Vibrations::frequencies).unwrap_or_default();
    Ok(frequencies.into_iter().map(|frequency| frequency.unwrap_or(f64::NAN)).collect())
}
