//! Patches of the reference cell with given rest angles, on which run times and errors are measured.

use super::findings::ExperimentError;
use super::library;
use foldwell::analysis::relax::{RelaxError, RelaxOptions, Relaxed, relax_from};
use foldwell::analysis::trace::{Stop, TraceOptions, Traced, trace};
use foldwell::model::{Assembly, Boundary, Gauge, Model, Terms};
use foldwell::numerics::random::numbers;
use foldwell::sheet::{Sheet, SheetError, fold};
use foldwell::solver::Problem;

/// A patch of `meshes/open-star.fold` with rest angles.
pub struct Star {
    /// The patch, without energy terms.
    pub assembly: Assembly,
    /// Rest angle of every edge, in radians; NaN for edges without a hinge.
    pub rest: Vec<f64>,
}

/// Returns the reference cell.
///
/// # Errors
/// None for the mesh of the repository.
pub fn cell() -> Result<Sheet, SheetError> {
    fold::read(&library::mesh("open-star.fold"))
}

impl Star {
    /// Makes `n1 x n2` cells. The rest angles differ from the drawn angles by random numbers of at most `most` radians,
    /// which are the same on every machine.
    ///
    /// # Errors
    /// None for the mesh of the repository.
    pub fn new(cells: [usize; 2], most: f64) -> Result<Self, ExperimentError> {
        let mut star = Self::drawn(cells)?;
        star.rest.iter_mut().zip(numbers(1)).for_each(|(angle, number)| *angle += most * number);
        Ok(star)
    }

    /// Makes `n1 x n2` cells whose rest angles are the same in every cell; `angles` has one for each edge of the cell.
    ///
    /// # Errors
    /// None for the mesh of the repository.
    pub fn resting(cells: [usize; 2], angles: &[f64]) -> Result<Self, ExperimentError> {
        let mut star = Self::drawn(cells)?;
        for (rest, edge) in star.rest.iter_mut().zip(&star.assembly.tiling().edges).filter(|(rest, _)| !rest.is_nan()) {
            *rest = angles[edge.edge];
        }
        Ok(star)
    }

    fn drawn(cells: [usize; 2]) -> Result<Self, ExperimentError> {
        let assembly = Assembly::without_terms(cell()?, cells, Boundary::Patch)?;
        let rest = assembly.drawn_angles().to_vec();
        Ok(Self { assembly, rest })
    }

    /// Returns the trajectories of the cell with its first edge, (0, 1, 0, 0), locked, followed with steps of at most
    /// `max_step` (arc length in radians).
    ///
    /// # Errors
    /// [`ExperimentError::Trace`] if there are none.
    pub fn traced(max_step: f64, stop: Stop) -> Result<Vec<Traced>, ExperimentError> {
        let drawn = Assembly::without_terms(cell()?, [1, 1], Boundary::Screw)?;
        let locked = Terms { locks: vec![(0, drawn.drawn_angles()[0])], ..Terms::default() };
        let options = TraceOptions { max_step, tolerance: 3e-14, branch: None, stop };
        Ok(trace(&drawn.with_terms(locked), &options, None, &mut |_, _| true)?)
    }

    /// Returns the fold angles of the cell after folding along its first ray by this arc length: an exact cylinder.
    ///
    /// # Errors
    /// [`ExperimentError::Trace`] if there is no trajectory.
    pub fn cylinder(arc_length: f64) -> Result<Vec<f64>, ExperimentError> {
        let all = Self::traced(0.25, Stop { arc_length: Some(arc_length), ..Stop::default() })?;
        let last = all.first().and_then(|traced| traced.states.last());
        Ok(last.ok_or(ExperimentError::Other("there is no ray".into()))?.angles.clone())
    }

    /// Returns the model with bars of the stiffness `EA`, and creases of stiffness 1 (torque per radian and length).
    pub fn model(&self, stiffness: f64) -> Model {
        let terms = Terms::bars_and_creases(stiffness, 1.0, self.rest.clone());
        self.assembly.with_terms(terms).model(Gauge::Held)
    }

    /// Relaxes `model` from the drawn state.
    ///
    /// # Errors
    /// [`RelaxError`] if it does not converge.
    pub fn relax(&self, model: &Model, options: impl Into<RelaxOptions>) -> Result<Relaxed, Box<RelaxError>> {
        relax_from(model, model.start(), options, &mut |_| true)
    }
}

/// Returns the numbers of unknowns and of stiff elements of a model.
pub fn size(model: &Model) -> (usize, usize) {
    (model.layout().unknowns, model.layout().stiff.len())
}
