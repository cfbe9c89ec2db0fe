//! How a held sheet settles, to first order, when its hinges and bars are off: the sheet and the rest angles across its modes.

use super::{HeldSheet, LandscapeError};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::least_squares;
use crate::numerics::factor::FactorError;
use crate::solver::saddle::Saddle;
use crate::solver::{Curvature, Linearization, Problem};
use nalgebra::DVector;

/// Accuracy of the linear solves where the response itself is wanted.
pub const FINE: f64 = 1e-13;
/// Residual above which they are refused.
const INACCURATE: f64 = 1e-6;

/// Amounts on every soft hinge and on every stiff measure.
pub type Both = (Vec<f64>, Vec<f64>);

/// How a sheet settles.
#[derive(Clone, Debug)]
pub struct Response {
    /// Motion of the unknowns.
    pub x: Vec<f64>,
    /// How far every soft hinge is off rest.
    pub off: Vec<f64>,
    /// Tensions of the stiff measures.
    pub tension: Vec<f64>,
    /// Rest angles across the modes.
    pub rest: DVector<f64>,
}

/// A held sheet linearized at a state, factored once.
pub struct Settling<'a> {
    held: &'a HeldSheet,
    at: Linearization,
    saddle: Saddle,
    /// Directions of the rest angles across the modes.
    directions: Vec<Both>,
    /// Responses to them.
    free: Vec<Response>,
    /// Energies of pairs of these responses: the Hessian of the energy in the rest angles.
    hessian: DenseMatrix,
    /// Accuracy of the linear solves that is asked for.
    accuracy: f64,
}

impl<'a> Settling<'a> {
    /// At these unknowns and tensions, by linear solves of this accuracy.
    ///
    /// Fails where the sheet is not stable there.
    pub fn new(
        held: &'a HeldSheet,
        (x, tension): (&[f64], &[f64]),
        curvature: Curvature,
        accuracy: f64,
    ) -> Result<Self, LandscapeError> {
        let model = &held.model;
        let mut at = Linearization::new(model.layout());
        model.linearize(x, tension, curvature, &mut at);
        let mut saddle = Saddle::new(model.layout(), &at)?;
        let inertia = saddle.factor(model.layout(), &at, model.compliance(), 0.0)?;
        if inertia.negative > 0 {
            return Err(FactorError::Singular { ratio: inertia.ratio }.into());
        }
        let directions = held.directions();
        let (free, hessian) = (Vec::new(), DenseMatrix::zeros(0, 0));
        let mut settling = Self { held, at, saddle, directions, free, hessian, accuracy };
        settling.free = (0..settling.directions.len())
            .map(|j| {
                let (soft, stiff) = &settling.directions[j];
                let (off, stretch) = (negative(soft), negative(stiff));
                settling.respond((&off, &stretch), None)
            })
            .collect::<Result<_, _>>()?;
        let count = settling.free.len();
        let hessian = DenseMatrix::from_fn(count, count, |i, j| -settling.torque(&settling.free[j], i));
        settling.hessian = 0.5 * (&hessian + hessian.transpose());
        Ok(settling)
    }

    /// Where hinges that are off rest by `off` and stiff measures that are longer by `stretch` settle under these forces on
    /// the unknowns, at given rest angles.
    fn respond(&mut self, (off, stretch): (&[f64], &[f64]), force: Option<&[f64]>) -> Result<Response, LandscapeError> {
        let model = &self.held.model;
        let layout = model.layout();
        let forces: Vec<f64> = self.stiffness().iter().zip(off).map(|(stiffness, off)| -stiffness * off).collect();
        let rows = self.at.soft_rows(layout);
        let mut force = force.map_or_else(|| vec![0.0; layout.unknowns], <[f64]>::to_vec);
        rows.add_transpose_product(&forces, &mut force);
        let missing = negative(stretch);
        let found = self.saddle.solve(layout, &self.at, model.compliance(), (&force, &missing), self.accuracy);
        if !(found.residual <= INACCURATE) {
            return Err(FactorError::Inaccurate { residual: found.residual }.into());
        }
        let mut turned = vec![0.0; off.len()];
        rows.product(&found.dx, &mut turned);
        let off = off.iter().zip(turned).map(|(off, turned)| off + turned).collect();
        Ok(Response { x: found.dx, off, tension: found.dt, rest: DVector::zeros(self.directions.len()) })
    }

    /// The same with the rest angles across the modes settling too.
    pub fn settle(&mut self, off: (&[f64], &[f64]), force: Option<&[f64]>) -> Result<Response, LandscapeError> {
        let mut response = self.respond(off, force)?;
        let torques = DVector::from_fn(self.free.len(), |j, _| self.torque(&response, j));
        response.rest = self.absorb(&torques)?;
        for (part, free) in response.rest.iter().zip(&self.free) {
            let add = |to: &mut Vec<f64>, from: &[f64]| to.iter_mut().zip(from).for_each(|(to, v)| *to += part * v);
            add(&mut response.x, &free.x);
            add(&mut response.off, &free.off);
            add(&mut response.tension, &free.tension);
        }
        Ok(response)
    }

    /// The rest angles across the modes that take these torques away.
    pub fn absorb(&self, torques: &DVector<f64>) -> Result<DVector<f64>, LandscapeError> {
        if torques.is_empty() {
            return Ok(torques.clone());
        }
        let right = DenseMatrix::from_column_slice(torques.len(), 1, torques.as_slice());
        Ok(least_squares(&self.hessian, &right)?.solution.column(0).into_owned())
    }

    /// Motion of the unknowns and change of the tensions that go with these rest angles across the modes.
    fn motion(&self, rest: &DVector<f64>) -> Both {
        let layout = self.held.model.layout();
        let (mut x, mut tension) = (vec![0.0; layout.unknowns], vec![0.0; layout.stiff.len()]);
        for (part, free) in rest.iter().zip(&self.free) {
            x.iter_mut().zip(&free.x).for_each(|(sum, d)| *sum += part * d);
            tension.iter_mut().zip(&free.tension).for_each(|(sum, d)| *sum += part * d);
        }
        (x, tension)
    }

    /// Newton's step for unknowns, tensions and rest angles together, from a state of these tensions that is no equilibrium yet; the
    /// Hessian of the energy in the rest angles is that of equilibria near it. `longest` bounds what rest angles move by.
    pub fn joint(&mut self, x: &[f64], tension: &[f64], longest: f64) -> Result<(DVector<f64>, Both), LandscapeError> {
        let model = &self.held.model;
        let (layout, compliance) = (model.layout(), model.compliance());
        let open: Vec<f64> =
            self.at.gaps.iter().zip(tension).zip(compliance).map(|((gap, t), c)| c * t - gap).collect();
        let force = self.at.force(layout, tension);
        let found = self.saddle.solve(layout, &self.at, compliance, (&force, &open), self.accuracy);
        let rows = Rows { cliques: &layout.soft, values: &self.at.soft_gradients };
        let mut off = vec![0.0; layout.soft.len()];
        rows.product(&found.dx, &mut off);
        for ((off, value), rest) in off.iter_mut().zip(model.values(x)).zip(model.rests()) {
            *off += value - rest;
        }
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect::<Vec<f64>>();
        let tension = sum(tension, &found.dt);
        let settled = Response { x: found.dx, off, tension, rest: DVector::zeros(0) };
        let torques = DVector::from_fn(self.directions.len(), |j, _| self.torque(&settled, j));
        let factor = nalgebra::Cholesky::new(self.hessian.clone()).ok_or(FactorError::Singular { ratio: 0.0 })?;
        let step = factor.solve(&torques);
        let step = &step * (longest / step.amax()).min(1.0);
        let (motion, pull) = self.motion(&step);
        Ok((step, (sum(&settled.x, &motion), sum(&found.dt, &pull))))
    }

    /// Torque of a response on a direction of the rest angles.
    fn torque(&self, response: &Response, direction: usize) -> f64 {
        let (soft, stiff) = &self.directions[direction];
        let hinges = soft.iter().zip(&response.off).zip(self.stiffness()).map(|((c, off), k)| k * c * off);
        hinges.sum::<f64>() + stiff.iter().zip(&response.tension).map(|(c, t)| c * t).sum::<f64>()
    }

    /// Twice the energy of a pair of responses.
    pub fn product(&self, a: &Response, b: &Response) -> f64 {
        let hinges = a.off.iter().zip(&b.off).zip(self.stiffness()).map(|((a, b), k)| k * a * b);
        let bars = a.tension.iter().zip(&b.tension).zip(self.held.model.compliance()).map(|((a, b), c)| c * a * b);
        hinges.sum::<f64>() + bars.sum::<f64>()
    }

    /// Stiffness of every soft hinge.
    pub fn stiffness(&self) -> &[f64] {
        &self.at.soft_stiffness
    }
}

fn negative(list: &[f64]) -> Vec<f64> {
    list.iter().map(|value| -value).collect()
}
