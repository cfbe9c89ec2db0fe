//! Relaxations that go on from each other, freely or held near given fold angles.
//!
//! Held is the proximal step (implicit Euler) of the descent in the metric `sum k (d rho)^2` of the creases: the
//! minimum of `E + (m/2) sum k (rho - target)^2`. Up to a constant that is the energy of creases `1 + m` times as stiff
//! with the rest angles `(rest + m target)/(1 + m)`: no other term is needed, and nothing is more difficult for rigid
//! bars.

use super::work::Work;
use crate::analysis::relax::{RelaxError, Relaxed, relax_model};
use crate::analysis::restored;
use crate::model::{Assembly, Configuration, Element, Gauge, Model};
use crate::solver::{Failure, Observe, Options, Problem};

/// When states on the way between wells are converged.
const ON_WAY: Options = Options { tolerance: 1e-10, iterations: 60 };

/// Result of a relaxation between wells.
type SettleResult = Result<Settled, Box<RelaxError>>;

/// A settled state.
#[derive(Clone, Debug)]
pub struct Settled {
    /// Where it is.
    pub place: Configuration,
    /// Fold angles of the elastic hinges.
    pub rho: Vec<f64>,
    /// Elastic energy less the work of loads from the drawn state; what holds it near its target is left out.
    pub energy: f64,
    /// The relaxation.
    pub relaxed: Relaxed,
}

/// A model that can be held near given fold angles.
pub struct MinimumTracker {
    model: Model,
    /// How much stiffer than its creases is what holds the sheet.
    pub strength: f64,
    /// Numbers of the elastic hinges among all elements, their rest angles and stiffnesses.
    hinges: Vec<usize>,
    rest: Vec<f64>,
    /// Stiffness of the elastic hinges: the metric.
    pub(crate) stiffness: Vec<f64>,
    work: Work,
}

impl MinimumTracker {
    /// The settler of an assembly; what holds it near fold angles is `strength` times as stiff as its creases.
    pub fn new(assembly: &Assembly, strength: f64) -> Self {
        let model = assembly.model(Gauge::Held);
        let hinges = model.elastic_hinges().map(|hinge| hinge.number).collect();
        let (rest, stiffness) = model.elastic_hinges().map(|hinge| (hinge.spring.rest, hinge.spring.stiffness)).unzip();
        Self { model, strength, hinges, rest, stiffness, work: Work::new(assembly) }
    }

    /// The drawn state.
    pub(crate) fn drawn(&self) -> Configuration {
        self.model.configuration(&self.model.start(), None)
    }

    /// The state with these coordinates, whose angles continue from these fold angles of all edges.
    pub(crate) fn at(&self, coordinates: Vec<f64>, fold_angle: &[f64]) -> Configuration {
        Configuration::new(coordinates, restored::angles(&self.model, fold_angle), None)
    }

    /// Relaxes from a place, next to its equilibrium where its tensions are known.
    pub(crate) fn free(&self, from: &Configuration, options: Options, observe: Observe<'_>) -> SettleResult {
        self.settled(self.model.clone(), from, options, observe)
    }

    /// The same held near these fold angles of the elastic hinges.
    ///
    /// # Errors
    /// [`RelaxError`] where the relaxation does not converge.
    pub fn near(&self, from: &Configuration, target: &[f64], options: Options, observe: Observe<'_>) -> SettleResult {
        let mut held = self.model.clone();
        held.scale_hinges(1.0 + self.strength);
        let mut rests = held.rests();
        for ((hinge, rest), target) in self.hinges.iter().zip(&self.rest).zip(target) {
            rests[*hinge] = (rest + self.strength * target) / (1.0 + self.strength);
        }
        held.set_rests(&rests, &rests, 1.0);
        self.settled(held, &from.without_tension(), options, observe)
    }

    /// The same to the accuracy of states on a way.
    pub(super) fn step(&self, from: &Configuration, to: &[f64], observe: Observe<'_>) -> Result<Settled, Failure> {
        self.near(from, to, ON_WAY, observe).map_err(|error| error.failure)
    }

    fn settled(&self, mut model: Model, from: &Configuration, options: Options, observe: Observe<'_>) -> SettleResult {
        let start = model.enter(from);
        let (relaxed, model, x) = relax_model(model, start, options, observe)?;
        let (rho, place) = (model.hinge_angles(&x), relaxed.configuration.clone());
        let energy = self.elastic_energy(&model, &place) - self.work.to(&relaxed.state.coordinates);
        Ok(Settled { place, rho, energy, relaxed })
    }

    /// The energy of all elements, with the springs of the sheet itself, in the state of a model that may be held.
    /// Stiff elements other than hinges store it in their tensions.
    fn elastic_energy(&self, held: &Model, state: &Configuration) -> f64 {
        let of_value = |(held, own): (Element<'_>, Element<'_>)| own.response(held.value(&state.coordinates))[0];
        let soft = held.soft().zip(self.model.soft()).filter(|(held, _)| !held.is_load()).map(of_value);
        let stiff = held.stiff().zip(self.model.stiff()).zip(state.tensions().iter().zip(held.compliance()));
        let stiff = stiff.map(|(elements, (tension, compliance))| {
            if elements.1.is_elastic_hinge() { of_value(elements) } else { 0.5 * compliance * tension * tension }
        });
        soft.sum::<f64>() + stiff.sum::<f64>()
    }
}
