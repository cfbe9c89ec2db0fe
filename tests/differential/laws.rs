//! Random laws of bars and hinges.

use crate::common::Numbers;
use crate::trial::Trial;
use foldwell::model::{Bilinear, Formula, GreenLagrange, Laws, OfAngle, OfStrain, Ogden, Stiffening, TermLaw};

/// Random starts from which another equilibrium is sought, of each size: with the energies of formulas a start takes up
/// to a second.
const STARTS: usize = 30;

/// The laws of a trial; `None` is a linear spring.
#[derive(Clone, Copy, Debug, Default)]
pub struct RandomLaws {
    bars: Option<BarLaw>,
    hinges: Option<HingeLaw>,
}

#[derive(Clone, Copy, Debug)]
enum BarLaw {
    Ogden([f64; 2]),
    GreenLagrange,
    Bilinear(Bilinear),
}

#[derive(Clone, Copy, Debug)]
enum HingeLaw {
    Stiffening([f64; 2]),
    Bilinear(Bilinear),
    /// A torque `k (d + hardening d^3)` at the distance `d` from rest.
    Cubic(f64),
}

impl RandomLaws {
    /// Laws of both kinds, of hinges alone where bars are rigid.
    fn new(numbers: &mut Numbers, rigid_bars: bool) -> Self {
        let mut of = |from: f64, to: f64| 0.5 * (from + to) + numbers.within(0.5 * (to - from));
        let bilinear = |ratio, size: f64, part: f64| Bilinear { ratio, at: [-size * part, size] };
        let bars = [
            BarLaw::Ogden([of(3.0, 5.0), of(-1.0, 1.0)]),
            BarLaw::GreenLagrange,
            BarLaw::Bilinear(bilinear(of(0.3, 2.0), of(1e-3, 1e-2), of(0.5, 2.0))),
        ];
        let hinges = [
            HingeLaw::Stiffening([of(-2.5, -0.5), of(0.5, 2.5)]),
            HingeLaw::Bilinear(bilinear(of(0.3, 2.0), of(0.01, 0.1), of(0.5, 2.0))),
            HingeLaw::Cubic(of(0.0, 20.0)),
        ];
        let mut pick = || of(0.0, 3.0) as usize % 3;
        let (bar, hinge) = (bars[pick()], hinges[pick()]);
        Self { bars: (!rigid_bars).then_some(bar), hinges: Some(hinge) }
    }

    /// Those of the sheet seen in a mirror, in which fold angles have the other sign.
    pub fn mirrored(self) -> Self {
        let swapped = |[low, high]: [f64; 2]| [-high, -low];
        let hinges = self.hinges.map(|law| match law {
            HingeLaw::Stiffening(limits) => HingeLaw::Stiffening(swapped(limits)),
            HingeLaw::Bilinear(law) => HingeLaw::Bilinear(Bilinear { at: swapped(law.at), ..law }),
            cubic => cubic,
        });
        Self { hinges, ..self }
    }

    /// The laws of the terms.
    pub fn of_terms(self) -> Laws {
        let hinges: Option<TermLaw> = self.hinges.map(|law| match law {
            HingeLaw::Stiffening(limits) => Stiffening { limits }.into(),
            HingeLaw::Bilinear(law) => OfAngle(law).into(),
            HingeLaw::Cubic(hardening) => {
                Formula::of_angle(&format!("k*((m - m0) + {hardening}*(m - m0)^3)")).unwrap().into()
            }
        });
        let bars = self.bars.map(|law| match law {
            BarLaw::Ogden(exponents) => OfStrain(Ogden { exponents }).into(),
            BarLaw::GreenLagrange => OfStrain(GreenLagrange).into(),
            BarLaw::Bilinear(law) => OfStrain(law).into(),
        });
        Laws { bars, creases: hinges.clone(), facets: hinges }
    }
}

/// A sheet as [`Trial::new`] makes it, with random laws. Rigid facets have none.
pub fn trial(seed: u64) -> Trial {
    let (trial, mut numbers) = (Trial::new(seed), Numbers::new(seed ^ 0x1a35));
    let facets = if trial.facets.is_infinite() { 10.0 } else { trial.facets };
    Trial { laws: RandomLaws::new(&mut numbers, trial.bars.is_infinite()), facets, starts: STARTS, ..trial }
}
