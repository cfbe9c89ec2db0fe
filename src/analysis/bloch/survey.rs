//! All that is asked of the spatially varying modes of one state: decay rates, polarization, lines of zero modes, a
//! map.

use super::laurent::wavenumber;
use super::{BlochError, Decay, Determinant, ModeShape, Polarization, Rigidity, Root, ZeroLines, Zone};
use crate::numerics::GoOn;
use nalgebra::Complex;

/// Steps of a survey, after each of which its observer is asked.
pub(crate) const STEPS: usize = 4;

/// What is looked at.
#[derive(Clone, Debug)]
pub struct SurveyOptions {
    /// Wavenumbers `q1`, in radians per cell, at which decay rates along the second lattice vector are wanted.
    pub wavenumbers: Vec<f64>,
    /// Number of wavenumbers over which the polarization is averaged.
    pub averaged: usize,
    /// Number of wavenumbers of the map along each direction.
    pub grid: [usize; 2],
    /// Wavenumber `q1` and decay rate of the modes whose displacements are wanted; the nearest root is taken.
    pub modes: Vec<[f64; 2]>,
}

/// Thirty-two decay rates, sixty-four wavenumbers for the polarization, a map of 256 x 256, and no displacements.
impl Default for SurveyOptions {
    fn default() -> Self {
        let wavenumbers = (0..32).map(|k| wavenumber(k, 32)).collect();
        Self { wavenumbers, averaged: 64, grid: [256, 256], modes: Vec::new() }
    }
}

/// The spatially varying modes of a state.
pub struct Survey {
    /// The determinant of the rigidity matrix as a polynomial of the Bloch factors.
    pub determinant: Determinant,
    /// Decay rates at each wavenumber.
    pub decays: Vec<Decay>,
    /// Numbers of modes that decay to either side.
    pub polarization: Polarization,
    /// The zone of real determinants, and the lines on which it vanishes or why they could not be followed; `None`
    /// where the determinant is not real.
    pub real: Option<(Zone, Result<ZeroLines, BlochError>)>,
    /// Real and imaginary parts of the determinant on the grid, the first wavenumber running faster.
    pub map: [Vec<f64>; 2],
    /// Displacements of the modes that were named.
    pub modes: Vec<ModeShape>,
}

impl Survey {
    /// Returns the lines of zero modes; `None` where the determinant is not real, or they could not be followed.
    pub fn lines(&self) -> Option<&ZeroLines> {
        self.real.as_ref().and_then(|(_, lines)| lines.as_ref().ok())
    }
}

/// Surveys the spatially varying modes of bars; `go_on` is told the number of each finished step.
///
/// ```
/// use foldwell::analysis::bloch::{Rigidity, SurveyOptions, survey};
/// use foldwell::sheet::generate::{Pattern, Random, generate};
///
/// let sheet = generate(&Pattern::Random(Random::default()))?;
/// let survey = survey(&Rigidity::of_sheet(&sheet, false)?, &SurveyOptions::default(), &mut |_| true)?;
/// assert!(survey.determinant.error < 1e-8 && survey.map[0].len() == 256 * 256);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`BlochError`] where there is no determinant, where a decomposition fails, and where `go_on` asks to stop.
pub fn survey(rigidity: &Rigidity, options: &SurveyOptions, go_on: GoOn<'_>) -> Result<Survey, BlochError> {
    let determinant = Determinant::new(rigidity)?;
    BlochError::unless(go_on(1))?;
    let decay = |q1: &f64| Decay::new(&determinant, 0, *q1).map(|decay| decay.refined(&determinant, rigidity));
    let decays = options.wavenumbers.iter().map(decay).collect::<Result<_, _>>()?;
    BlochError::unless(go_on(2))?;
    let polarization = Polarization::new(&determinant, options.averaged)?;
    BlochError::unless(go_on(3))?;
    let real = match Zone::new(&determinant) {
        Ok(zone) => {
            let lines = ZeroLines::new(&zone).map(|lines| lines.refined(&zone, rigidity));
            Some((zone, lines))
        }
        Err(BlochError::NotSymmetric { .. }) => None,
        Err(error) => return Err(error),
    };
    let values = determinant.polynomial.map(options.grid);
    let map = [values.iter().map(|value| value.re).collect(), values.iter().map(|value| value.im).collect()];
    let modes = shapes(rigidity, &options.modes, &determinant)?;
    BlochError::unless(go_on(STEPS))?;
    Ok(Survey { determinant, decays, polarization, real, map, modes })
}

/// The modes at these wavenumbers, each of the root nearest to its decay rate.
fn shapes(rigidity: &Rigidity, named: &[[f64; 2]], determinant: &Determinant) -> Result<Vec<ModeShape>, BlochError> {
    let mut found = Vec::new();
    for [q1, kappa2] in named {
        let decay = Decay::new(determinant, 0, *q1)?.refined(determinant, rigidity);
        let away = |root: &Root| (root.kappa() - kappa2).abs();
        if let Some(root) = decay.roots.iter().min_by(|a, b| away(a).total_cmp(&away(b))) {
            found.push(ModeShape::new(rigidity, [Complex::from_polar(1.0, *q1), root.z])?);
        }
    }
    Ok(found)
}
