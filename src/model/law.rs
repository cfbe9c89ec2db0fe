//! Springs and other laws: how the energy of an element depends on the value of its measure.

use std::fmt;
use std::sync::Arc;

/// The spring of an element, `E = stiffness (value - rest)^2 / 2`, also that of its [law](Law) near rest; infinite
/// stiffness means `value = rest` exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Spring constant: force per length for a bar, torque per radian for a hinge; may be infinite.
    pub stiffness: f64,
    /// Value without force: a length, or an angle in radians.
    pub rest: f64,
}

/// A law `phi` of an element: its energy is `k phi(m, rest)`, `k` the spring constant, `m` the value of its measure, a
/// length or an angle in radians.
///
/// Near rest a law is a spring of constant `k`: `phi = phi' = 0` and `phi'' = 1` at `m = rest`, unless rest is beyond
/// a limit; powers have no stiffness there. Derivatives are by `m`. Where a value cannot be reached, as a fold angle beyond pi, the energy is
/// infinite. A law is one file of a user's own: a type with this trait, given to
/// [`Builder::bar_law`](super::Builder::bar_law).
///
/// ```
/// use foldwell::model::Law;
/// use foldwell::{Assembly, Pattern, Rest, generate, relax};
///
/// /// Creases that become stiffer with the square of how far they are folded.
/// #[derive(Debug)]
/// struct Hardening;
///
/// impl Law for Hardening {
///     fn at(&self, angle: f64, rest: f64) -> [f64; 3] {
///         let off = angle - rest;
///         [0.5 * off.powi(2) + 0.25 * off.powi(4), off + off.powi(3), 1.0 + 3.0 * off.powi(2)]
///     }
/// }
///
/// let sheet = generate(&Pattern::named("miura")?)?;
/// let linear = Assembly::patch(sheet, [2, 2]).bars(1e3).creases(1.0).rest(Rest::Angle(0.5));
/// let hardening = linear.clone().crease_law(Hardening).build()?;
/// assert!(relax(&hardening)?.state.total() > relax(&linear.build()?)?.state.total());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Law: fmt::Debug + Send + Sync {
    /// Returns `phi`, `phi'` and `phi''` at a value.
    fn at(&self, value: f64, rest: f64) -> [f64; 3];

    /// Returns derivatives by the rest value while `m` is fixed: the first of `phi`, the first of `phi'`, and the
    /// second of `phi`. The default is right for functions of `m - rest`.
    fn by_rest(&self, value: f64, rest: f64) -> [f64; 3] {
        let [_, force, stiffness] = self.at(value, rest);
        [-force, -stiffness, stiffness]
    }
}

/// Laws are equal where they are the same object.
impl PartialEq for dyn Law {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::addr_eq(self, other)
    }
}

/// The laws of the terms; `None` is a linear spring.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Laws {
    /// That of the bars.
    pub bars: Option<Arc<dyn Law>>,
    /// That of the creases.
    pub creases: Option<Arc<dyn Law>>,
    /// That of the facets.
    pub facets: Option<Arc<dyn Law>>,
}

impl Laws {
    /// Returns the name of the first term that has a law; `None` if all are springs.
    pub fn first(&self) -> Option<&'static str> {
        let all = [("bars", &self.bars), ("creases", &self.creases), ("facets", &self.facets)];
        all.into_iter().find(|(_, law)| law.is_some()).map(|(name, _)| name)
    }
}

/// The way in which the elements of a term store energy.
#[derive(Clone, Debug)]
pub(super) enum Stored {
    /// The energy of a spring.
    Spring,
    /// The energy of a law.
    Law(Arc<dyn Law>),
    /// The energy of a law less that of a spring. The spring is an element of its own, with a tension as unknown, so
    /// that the sum loses no digits however stiff it is.
    BeyondSpring(Arc<dyn Law>),
}

impl Stored {
    /// Whether a law is part of the energy.
    pub(super) fn is_law(&self) -> bool {
        !matches!(self, Self::Spring)
    }

    /// Returns energy, force and stiffness at a value.
    pub(super) fn at(&self, value: f64, spring: Spring) -> [f64; 3] {
        let off = value - spring.rest;
        let scaled = |unit: [f64; 3]| unit.map(|part| spring.stiffness * part);
        match self {
            Self::Spring => {
                let force = spring.stiffness * off;
                [0.5 * force * off, force, spring.stiffness]
            }
            Self::Law(law) => scaled(law.at(value, spring.rest)),
            Self::BeyondSpring(law) => scaled(beyond(law.at(value, spring.rest), [0.5 * off * off, off, 1.0])),
        }
    }

    /// Returns the derivatives of energy and force by the rest value, and the second one of the energy.
    pub(super) fn by_rest(&self, value: f64, spring: Spring) -> [f64; 3] {
        let linear = [spring.rest - value, -1.0, 1.0];
        let unit = match self {
            Self::Spring => linear,
            Self::Law(law) => law.by_rest(value, spring.rest),
            Self::BeyondSpring(law) => beyond(law.by_rest(value, spring.rest), linear),
        };
        unit.map(|part| spring.stiffness * part)
    }
}

fn beyond(law: [f64; 3], spring: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| law[k] - spring[k])
}
