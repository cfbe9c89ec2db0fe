//! A sheet whose rest angles are held along its modes and free otherwise.

use super::{HeldState, LandscapeError};
use crate::kinematics::FoldingModes;
use crate::model::{Assembly, Configuration, Domain, Element, Gauge, Model};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::{least_squares, null_space};
use crate::solver::Problem;
use nalgebra::DVector;

/// Largest difference between the rates that were asked for and those of a mode, over the largest rate.
const OFF: f64 = 1e-6;

/// A sheet and its modes.
///
/// Rest angles are named by the edges of the piece of sheet that repeats: the edges of a cell on a patch, where all
/// cells have the same, and all edges on a torus.
#[derive(Clone)]
pub struct HeldSheet {
    /// The modes: orthonormal rates of rest angles as columns, a row for each edge of the piece that repeats.
    pub basis: DenseMatrix,
    /// Velocities of all coordinates along each of them.
    pub motions: Vec<Vec<f64>>,
    /// Orthonormal directions of rest angles across the modes, as columns; zero for rigid hinges.
    pub free: DenseMatrix,
    /// Bars and hinges.
    pub model: Model,
    /// The modes of a cell by the curvatures they make; `None` on a torus, which has none.
    pub bending: Option<FoldingModes>,
    /// Edge of the repeating piece of every hinge that is not rigid, in the order of the model's elements, soft ones
    /// first; `None` for all other elements.
    repeating: Vec<Option<usize>>,
    /// Rest values as drawn, in the same order.
    rests: Vec<f64>,
    /// The drawn state.
    drawn: Configuration,
}

impl HeldSheet {
    /// The sheet of an assembly held along its folding modes, at rest as drawn: those of a cell on a patch, all that
    /// stretch no bar on a torus.
    pub(crate) fn new(assembly: &Assembly) -> Result<Self, LandscapeError> {
        if let Some(term) = assembly.terms().uneven_term() {
            return Err(LandscapeError::Uneven { term });
        }
        if let Some(term) = assembly.terms().first_not_linear() {
            return Err(LandscapeError::NotLinear { term: term.to_owned() });
        }
        if !assembly.has_drawn_lengths() {
            return Err(LandscapeError::OffRest { bars: assembly.bars_off_rest() });
        }
        match assembly.domain() {
            Domain::Patch => Self::patch(assembly),
            Domain::Own(_) => Err(LandscapeError::OwnDomain),
            _ => Self::torus(assembly),
        }
    }

    /// A model held along these modes, `locked` being the edges of the repeating piece that are rigid. `repeating`
    /// gives the edge of the repeating piece of every edge of the tiling.
    pub(super) fn at_drawn_angles(
        assembly: &Assembly,
        (basis, motions): (DenseMatrix, Vec<Vec<f64>>),
        locked: &[usize],
        repeating: impl Fn(usize) -> usize,
    ) -> Result<Self, LandscapeError> {
        let terms = assembly.terms().resting_at(assembly.drawn_angles());
        let model = assembly.with_terms(terms).model(Gauge::Held);
        let floats = |element: Element<'_>| element.edge().filter(|_| element.is_elastic_hinge()).map(&repeating);
        let repeating = model.elements().map(floats).collect();
        let free = across(&basis, locked)?;
        let motions = motions.iter().map(|motion| model.without_drift(motion)).collect();
        let (rests, drawn) = (model.rests(), model.configuration(&model.start(), None));
        Ok(Self { basis, motions, free, repeating, rests, drawn, bending: None, model })
    }

    /// Rates of the rest angles of the mode that makes the curvature tensor `[k11, k22, k12]`.
    ///
    /// # Errors
    /// [`LandscapeError`] where curvatures name no modes: on a torus, and as [`FoldingModes::named`].
    pub fn named(&self, curvature: [f64; 3]) -> Result<Vec<f64>, LandscapeError> {
        let modes = self.bending.as_ref().ok_or(LandscapeError::NoCurvatures)?;
        Ok(modes.named(curvature)?)
    }

    /// The mode that has these rates on the edges of the repeating piece; NaN: not known there.
    pub(crate) fn with_rates(&self, rates: &[f64]) -> Result<Vec<f64>, LandscapeError> {
        let known: Vec<usize> = (0..rates.len()).filter(|&edge| !rates[edge].is_nan()).collect();
        let right = DenseMatrix::from_fn(known.len(), 1, |row, _| rates[known[row]]);
        let fit = least_squares(&self.basis.select_rows(&known), &right)?;
        if right.amax() == 0.0 {
            return Err(LandscapeError::NoRates);
        }
        let off = fit.residual.amax() / right.amax();
        if !(off <= OFF) {
            return Err(LandscapeError::NoSuchMode { off });
        }
        let modes = self.basis.ncols();
        if fit.rank.rank < modes {
            return Err(LandscapeError::ManyModes { open: modes - fit.rank.rank, modes });
        }
        Ok((&self.basis * fit.solution).as_slice().to_vec())
    }

    /// The curvature tensor `[k11, k22, k12]` of a mode with these rates; `None` on a torus.
    pub fn curvature(&self, rates: &[f64]) -> Option<[f64; 3]> {
        let tensor = &self.bending.as_ref()?.curvatures * self.amplitudes(rates);
        Some([tensor[0], tensor[1], tensor[2]])
    }

    /// Amplitudes along the basis of the modes.
    pub(crate) fn amplitudes(&self, rates: &[f64]) -> DVector<f64> {
        self.basis.tr_mul(&DVector::from_column_slice(rates))
    }

    /// Velocities of all coordinates for rates along the modes.
    pub(crate) fn motion(&self, rates: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.motions.first().map_or(0, Vec::len)];
        for (amplitude, motion) in self.amplitudes(rates).iter().zip(&self.motions) {
            all.iter_mut().zip(motion).for_each(|(sum, v)| *sum += amplitude * v);
        }
        all
    }

    /// Stiffness of the hinge over every edge of the repeating piece, per radian; zero where none is soft.
    pub fn stiffness(&self) -> Vec<f64> {
        let mut all = vec![0.0; self.basis.nrows()];
        for (edge, element) in self.repeating.iter().zip(self.model.elements()) {
            edge.iter().for_each(|&edge| all[edge] = element.spring.stiffness);
        }
        all
    }

    /// The unknowns of the drawn state, made the one from which angles continue.
    pub fn drawn(&mut self) -> Vec<f64> {
        self.model.enter(&self.drawn).x
    }

    /// No change of place.
    pub fn still(&self) -> HeldState {
        let layout = self.model.layout();
        HeldState {
            x: vec![0.0; layout.unknowns],
            tension: vec![0.0; layout.stiff.len()],
            rest: DVector::zeros(self.free.ncols()),
        }
    }

    /// An amount per edge of the repeating piece for every soft element and every stiff measure; zero where rest values
    /// do not float.
    pub(crate) fn spread(&self, per_edge: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let of = |edge: &Option<usize>| edge.map_or(0.0, |edge| per_edge[edge]);
        let all: Vec<f64> = self.repeating.iter().map(of).collect();
        let (soft, stiff) = all.split_at(self.model.layout().soft.len());
        (soft.to_vec(), stiff.to_vec())
    }

    /// What the directions of rest angles across the modes are for every soft element and every stiff measure.
    pub(crate) fn directions(&self) -> Vec<(Vec<f64>, Vec<f64>)> {
        self.free.column_iter().map(|direction| self.spread(direction.as_slice())).collect()
    }

    /// Moves the rest angles off the drawn ones.
    pub(crate) fn set_rest(&mut self, per_edge: &[f64]) {
        let (soft, stiff) = self.spread(per_edge);
        let rests: Vec<f64> =
            self.rests.iter().zip(soft.iter().chain(&stiff)).map(|(rest, moved)| rest + moved).collect();
        self.model.set_rests(&rests, &rests, 1.0);
    }
}

/// Directions of rest angles across the modes.
fn across(basis: &DenseMatrix, locked: &[usize]) -> Result<DenseMatrix, LandscapeError> {
    let (edges, modes) = basis.shape();
    let mut held = basis.clone().resize_horizontally(modes + locked.len(), 0.0);
    locked.iter().enumerate().for_each(|(k, &edge)| held[(edge, modes + k)] = 1.0);
    if held.ncols() == edges { Ok(DenseMatrix::zeros(edges, 0)) } else { Ok(null_space(&held.transpose())?.basis) }
}
