//! How a held sheet settles, to first order, when its hinges and bars are off: the sheet and the rest angles across its
//! modes.

use super::taylor_path::HeldState;
use super::{HeldSheet, LandscapeError};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::least_squares;
use crate::numerics::dense::small::cholesky;
use crate::numerics::factor::FactorError;
use crate::numerics::vector::add_scaled;
use crate::solver::{HessianKind, Problem, Tangent};
use nalgebra::DVector;

/// Accuracy of the linear solves where the response itself is wanted.
pub(crate) const FINE: f64 = 1e-13;
/// Residual above which they are refused.
const INACCURATE: f64 = 1e-6;

/// Amounts on every soft hinge and on every stiff measure.
pub(crate) type TermValues = (Vec<f64>, Vec<f64>);

/// How a sheet settles.
#[derive(Clone, Debug)]
pub(crate) struct SettlingResponse {
    /// What unknowns, tensions and rest angles across the modes move by.
    pub place: HeldState,
    /// How far every soft hinge is off rest.
    pub off: Vec<f64>,
    /// What stiff measures are longer than their tensions make them: what linear solves have left.
    open: Vec<f64>,
}

impl SettlingResponse {
    /// How far hinges are off, and tensions.
    fn parts(&self) -> (&[f64], &[f64]) {
        (&self.off, &self.place.tension)
    }

    fn add(&mut self, factor: f64, other: &Self) {
        self.place.add(factor, &other.place);
        add_scaled(&mut self.off, factor, &other.off);
        add_scaled(&mut self.open, factor, &other.open);
    }
}

/// A held sheet linearized at a state, factored once.
pub(crate) struct Settling<'a> {
    held: &'a HeldSheet,
    tangent: Tangent,
    /// Directions of the rest angles across the modes.
    directions: Vec<TermValues>,
    /// Responses to them.
    free: Vec<SettlingResponse>,
    /// Energies of pairs of these responses: the Hessian of the energy in the rest angles.
    hessian: DenseMatrix,
    /// Accuracy of the linear solves that is asked for.
    accuracy: f64,
}

impl<'a> Settling<'a> {
    /// At these unknowns and tensions, by linear solves of this accuracy.
    ///
    /// Fails where the sheet is not stable there.
    pub(crate) fn new(
        held: &'a HeldSheet,
        (x, tension): (&[f64], &[f64]),
        kind: HessianKind,
        accuracy: f64,
    ) -> Result<Self, LandscapeError> {
        let mut tangent = Tangent::at_state(&held.model, x, tension, kind)?;
        let inertia = tangent.factor(0.0)?;
        if inertia.negative > 0 {
            return Err(FactorError::Singular { ratio: inertia.ratio }.into());
        }
        let directions = held.directions();
        let (free, hessian) = (Vec::new(), DenseMatrix::zeros(0, 0));
        let mut settling = Self { held, tangent, directions, free, hessian, accuracy };
        settling.free = (0..settling.directions.len())
            .map(|j| {
                let (soft, stiff) = &settling.directions[j];
                let (off, stretch) = (negative(soft), negative(stiff));
                settling.respond((&off, &stretch), None)
            })
            .collect::<Result<_, _>>()?;
        let count = settling.free.len();
        let hessian = DenseMatrix::from_fn(count, count, |i, j| -settling.torque(settling.free[j].parts(), i));
        settling.hessian = 0.5 * (&hessian + hessian.transpose());
        Ok(settling)
    }

    /// Where hinges that are off rest by `off` and stiff measures that are longer by `stretch` settle under these
    /// forces on the unknowns, at given rest angles.
    fn respond(
        &mut self,
        (off, stretch): (&[f64], &[f64]),
        force: Option<&[f64]>,
    ) -> Result<SettlingResponse, LandscapeError> {
        let model = &self.held.model;
        let forces: Vec<f64> = self.stiffness().iter().zip(off).map(|(stiffness, off)| -stiffness * off).collect();
        let mut force = force.map_or_else(|| vec![0.0; model.layout().unknowns], <[f64]>::to_vec);
        self.tangent.at.soft_rows().add_transpose_product(&forces, &mut force);
        let found = self.tangent.solve(&force, &negative(stretch), self.accuracy);
        if !(found.residual <= INACCURATE) {
            return Err(FactorError::Inaccurate { residual: found.residual }.into());
        }
        let mut turned = vec![0.0; off.len()];
        self.tangent.at.soft_rows().product(&found.dx, &mut turned);
        let off = off.iter().zip(turned).map(|(off, turned)| off + turned).collect();
        let mut open = vec![0.0; stretch.len()];
        self.tangent.at.rows().product(&found.dx, &mut open);
        for (((open, stretch), t), c) in open.iter_mut().zip(stretch).zip(&found.dt).zip(model.compliance()) {
            *open += stretch - c * t;
        }
        Ok(SettlingResponse { place: HeldState { x: found.dx, tension: found.dt, ..self.held.still() }, off, open })
    }

    /// The same with the rest angles across the modes settling too.
    pub(crate) fn settle(
        &mut self,
        off: (&[f64], &[f64]),
        force: Option<&[f64]>,
    ) -> Result<SettlingResponse, LandscapeError> {
        let mut response = self.respond(off, force)?;
        let torques = DVector::from_fn(self.free.len(), |j, _| self.torque(response.parts(), j));
        let rest = self.absorb(&torques)?;
        for (part, free) in rest.iter().zip(&self.free) {
            response.add(*part, free);
        }
        response.place.rest = rest;
        Ok(response)
    }

    /// The rest angles across the modes that take these torques away.
    pub(crate) fn absorb(&self, torques: &DVector<f64>) -> Result<DVector<f64>, LandscapeError> {
        if torques.is_empty() {
            return Ok(torques.clone());
        }
        let right = DenseMatrix::from_column_slice(torques.len(), 1, torques.as_slice());
        Ok(least_squares(&self.hessian, &right)?.solution.column(0).into_owned())
    }

    /// Newton's step for unknowns, tensions and rest angles together, at `(x, tension)`, which need not be an
    /// equilibrium; the Hessian of the energy in the rest angles is that of equilibria near it. `longest` bounds what
    /// rest angles move by.
    ///
    /// Fails where the energy is not convex in the rest angles.
    pub(crate) fn joint(&mut self, (x, tension): (&[f64], &[f64]), longest: f64) -> Result<HeldState, LandscapeError> {
        let model = &self.held.model;
        let found = self.tangent.newton_step(tension, self.accuracy);
        let mut off = vec![0.0; model.layout().soft.len()];
        self.tangent.at.soft_rows().product(&found.dx, &mut off);
        for ((off, value), rest) in off.iter_mut().zip(model.values(x)).zip(model.rests()) {
            *off += value - rest;
        }
        let pull: Vec<f64> = tension.iter().zip(&found.dt).map(|(t, dt)| t + dt).collect();
        let torques = DVector::from_fn(self.free.len(), |j, _| self.torque((&off, &pull), j));
        let factor = cholesky(self.hessian.clone()).ok_or(FactorError::Singular { ratio: 0.0 })?;
        let rest = factor.solve(&torques);
        let rest = &rest * (longest / rest.amax()).min(1.0);
        let mut step = HeldState { x: found.dx, tension: found.dt, ..self.held.still() };
        rest.iter().zip(&self.free).for_each(|(part, free)| step.add(*part, &free.place));
        Ok(HeldState { rest, ..step })
    }

    /// Torque of hinges that are off and of tensions on a direction of the rest angles.
    fn torque(&self, (off, tension): (&[f64], &[f64]), direction: usize) -> f64 {
        let (soft, stiff) = &self.directions[direction];
        let hinges = soft.iter().zip(off).zip(self.stiffness()).map(|((c, off), k)| k * c * off);
        hinges.sum::<f64>() + stiff.iter().zip(tension).map(|(c, t)| c * t).sum::<f64>()
    }

    /// Twice the energy of a pair of responses. With the work of tensions on what is left open it is stationary where
    /// they are exact: the error is of second order in what linear solves have left.
    pub(crate) fn product(&self, a: &SettlingResponse, b: &SettlingResponse) -> f64 {
        let hinges = a.off.iter().zip(&b.off).zip(self.stiffness()).map(|((a, b), k)| k * a * b);
        let bars =
            a.place.tension.iter().zip(&b.place.tension).zip(self.held.model.compliance()).map(|((a, b), c)| c * a * b);
        let work = |a: &SettlingResponse, b: &SettlingResponse| -> f64 {
            a.place.tension.iter().zip(&b.open).map(|(t, open)| t * open).sum()
        };
        hinges.sum::<f64>() + bars.sum::<f64>() + work(a, b) + work(b, a)
    }

    /// Stiffness of every soft hinge.
    pub(crate) fn stiffness(&self) -> &[f64] {
        &self.tangent.at.soft_stiffness
    }
}

fn negative(list: &[f64]) -> Vec<f64> {
    list.iter().map(|value| -value).collect()
}
