//! A patch whose rest angles are the same in every cell, held along the linear folding modes and free otherwise.

use super::LandscapeError;
use crate::kinematics::{Displacement, Embedding, FoldingModes, KinematicsError, folding_modes_with_locked};
use crate::model::assemble::{Drawn, Recipe, Surroundings, assemble};
use crate::model::{Gauge, Model};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::null_space;
use crate::numerics::factor::FactorError;
use crate::numerics::sparse::Rows;
use crate::sheet::{Corner, EdgeKind, Sheet, Tiling};
use crate::solver::saddle::Saddle;
use crate::solver::{Curvature, Linearization, Problem};

/// Accuracy of the linear solves that is asked for, and the residual above which they are refused.
const ACCURACY: f64 = 1e-13;
const INACCURATE: f64 = 1e-6;

/// A patch and its modes.
pub struct Patch {
    /// The linear folding modes of a cell.
    pub modes: FoldingModes,
    /// Bars and hinges of the patch.
    pub model: Model,
    /// Orthonormal directions of uniform rest angles across the modes, as columns: `Ne x m`, zero for rigid hinges.
    pub free: DenseMatrix,
    /// Velocities of all coordinates along each mode.
    pub motions: Vec<Vec<f64>>,
    /// Edge of the cell of every hinge that is not rigid, in the order of the model's elements, soft ones first; `None` for
    /// all other elements.
    cell_edge: Vec<Option<usize>>,
    /// Rest values as drawn, in the same order.
    rests: Vec<f64>,
    edges: usize,
}

impl Patch {
    /// The patch of a recipe; its rest angles are not read, those drawn take their place.
    ///
    /// Fails where the modes are not known.
    pub fn new(sheet: &Sheet, tiling: &Tiling, recipe: &Recipe, drawn: &[f64]) -> Result<Self, LandscapeError> {
        let rigid = recipe.facets.as_ref().is_some_and(|hinges| hinges.stiffness.is_infinite());
        let facets = (0..sheet.edges.len()).filter(|&edge| sheet.edges[edge].kind == EdgeKind::Facet);
        let locked: Vec<usize> = if rigid { facets.collect() } else { Vec::new() };
        let modes = folding_modes_with_locked(sheet, &locked)?;
        let mut recipe = recipe.clone();
        for hinges in [&mut recipe.creases, &mut recipe.facets].into_iter().flatten() {
            hinges.rest = drawn.to_vec();
        }
        let model = assemble(&Drawn::new(sheet, tiling, Surroundings::Patch), tiling, &recipe, Gauge::Held);
        let terms = model.soft().iter().chain(model.stiff());
        let floats = |term: &dyn crate::model::Elements, k: usize| {
            let soft = term.is_angle() && term.spring(k).stiffness.is_finite();
            soft.then(|| tiling.edges[term.edge(k)].edge)
        };
        let cell_edge = terms
            .flat_map(|term| (0..term.len()).map(|k| floats(term.as_ref(), k)).collect::<Vec<_>>())
            .collect::<Vec<_>>();
        let edges = sheet.edges.len();
        let free = across(&modes, &locked, edges)?;
        let motions = motions(sheet, tiling.cells, &modes)?;
        Ok(Self { free, motions, cell_edge, rests: model.rests(), edges, modes, model })
    }

    /// Number of edges of a cell.
    pub fn edges(&self) -> usize {
        self.edges
    }

    /// Stiffness of the hinge over every edge of the cell, per radian; zero where none is soft.
    pub fn stiffness(&self) -> Vec<f64> {
        let mut all = vec![0.0; self.edges];
        let terms = self.model.soft().iter().chain(self.model.stiff());
        let springs = terms.flat_map(|term| (0..term.len()).map(|k| term.spring(k).stiffness));
        for (edge, stiffness) in self.cell_edge.iter().zip(springs) {
            edge.iter().for_each(|&edge| all[edge] = stiffness);
        }
        all
    }

    /// An amount per edge of the cell for every soft element and every stiff measure; zero where rest values do not float.
    pub fn spread(&self, per_edge: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let of = |edge: &Option<usize>| edge.map_or(0.0, |edge| per_edge[edge]);
        let all: Vec<f64> = self.cell_edge.iter().map(of).collect();
        let (soft, stiff) = all.split_at(self.model.layout().soft.len());
        (soft.to_vec(), stiff.to_vec())
    }

    /// Moves the rest angles of every cell off the drawn ones.
    pub fn set_rest(&mut self, per_edge: &[f64]) {
        let (soft, stiff) = self.spread(per_edge);
        let rests: Vec<f64> =
            self.rests.iter().zip(soft.iter().chain(&stiff)).map(|(rest, moved)| rest + moved).collect();
        self.model.set_rests(&rests, &rests, 1.0);
    }
}

/// Directions of rest angles across the modes.
fn across(modes: &FoldingModes, locked: &[usize], edges: usize) -> Result<DenseMatrix, LandscapeError> {
    let mut held = modes.basis.clone().resize_horizontally(modes.count() + locked.len(), 0.0);
    locked.iter().enumerate().for_each(|(k, &edge)| held[(edge, modes.count() + k)] = 1.0);
    if held.ncols() == edges {
        return Ok(DenseMatrix::zeros(edges, 0));
    }
    Ok(null_space(&held.transpose())?.basis)
}

/// Velocities of all coordinates of the patch, for every mode.
fn motions(sheet: &Sheet, cells: [usize; 2], modes: &FoldingModes) -> Result<Vec<Vec<f64>>, KinematicsError> {
    let embedding = Embedding::new(sheet)?;
    let corner = |k: usize| {
        let (cell, vertex) = (k / sheet.vertices.len(), k % sheet.vertices.len());
        Corner { vertex, shift: [(cell % cells[0]) as i32, (cell / cells[0]) as i32] }
    };
    let count = cells[0] * cells[1] * sheet.vertices.len();
    let motion = |rates: &[f64]| {
        let moving = Displacement::new(&embedding, embedding.drawn_angles(), rates);
        (0..count).flat_map(|k| <[f64; 3]>::from(moving.corner(corner(k)).1)).collect()
    };
    Ok(modes.basis.column_iter().map(|mode| motion(mode.as_slice())).collect())
}

/// A patch linearized at a state, factored once.
pub struct Linear {
    at: Linearization,
    saddle: Saddle,
}

/// How a linearized patch settles.
pub struct Response {
    /// Motion of the unknowns.
    pub x: Vec<f64>,
    /// How far every soft hinge is off rest.
    pub off: Vec<f64>,
    /// Tensions of the stiff measures.
    pub tension: Vec<f64>,
}

impl Linear {
    /// At these unknowns and tensions.
    ///
    /// Fails where the patch is not stable there.
    pub fn new(model: &Model, x: &[f64], tension: &[f64], curvature: Curvature) -> Result<Self, LandscapeError> {
        let mut at = Linearization::new(model.layout());
        model.linearize(x, tension, curvature, &mut at);
        let mut saddle = Saddle::new(model.layout(), &at)?;
        let inertia = saddle.factor(model.layout(), &at, model.compliance(), 0.0)?;
        if inertia.negative > 0 {
            return Err(FactorError::Singular { ratio: inertia.ratio }.into());
        }
        Ok(Self { at, saddle })
    }

    /// Stiffness of every soft hinge.
    pub fn stiffness(&self) -> &[f64] {
        &self.at.soft_stiffness
    }

    /// Where soft hinges that are off rest by `off` and stiff measures that are longer by `stretch` settle.
    pub fn respond(&mut self, model: &Model, off: &[f64], stretch: &[f64]) -> Result<Response, LandscapeError> {
        let layout = model.layout();
        let forces: Vec<f64> =
            self.at.soft_stiffness.iter().zip(off).map(|(stiffness, off)| -stiffness * off).collect();
        let rows = Rows { cliques: &layout.soft, values: &self.at.soft_gradients };
        let mut force = vec![0.0; layout.unknowns];
        rows.add_transpose_product(&forces, &mut force);
        let missing: Vec<f64> = stretch.iter().map(|stretch| -stretch).collect();
        let found = self.saddle.solve(layout, &self.at, model.compliance(), (&force, &missing), ACCURACY);
        if !(found.residual <= INACCURATE) {
            return Err(FactorError::Inaccurate { residual: found.residual }.into());
        }
        let mut turned = vec![0.0; off.len()];
        rows.product(&found.dx, &mut turned);
        let off = off.iter().zip(turned).map(|(off, turned)| off + turned).collect();
        Ok(Response { x: found.dx, off, tension: found.dt })
    }
}
