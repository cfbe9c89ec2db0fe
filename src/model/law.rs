//! Springs and other laws: how the energy of an element depends on the value of its measure.

use super::assembly_error::AssemblyError;
use super::stiffness::Stiffness;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// Values on both sides of a rest value of 1 at which the force of a law is asked for.
const BESIDE_ONE: [f64; 2] = [1.0 - 1e-3, 1.0 + 1e-3];

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

    /// Returns this law for an element with this memory, if the law has one, as plasticity has; the law itself is that
    /// of an element that nothing has happened to, whose memory is zero. Its energy is then what the element stores
    /// *and* has dissipated where its memory is that [after](Law::after) the value.
    fn remembering(&self, _memory: Memory) -> Option<Box<dyn Law>> {
        None
    }

    /// Whether its stiffness jumps at some values: a path may have a kink there.
    fn has_kinks(&self) -> bool {
        false
    }

    /// Returns the memory of an element that has gone to a value, steadily from the one at which it got its memory, and
    /// what it has dissipated up to there, over the spring constant.
    fn after(&self, _value: f64, _rest: f64) -> (Memory, f64) {
        (Memory::default(), 0.0)
    }
}

/// The memory of an element: the value off rest that it keeps where nothing pulls at it, and the sum of the sizes of all
/// changes of that value; angles in radians, or strains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// The plastic strain or angle: the value off rest without force.
    pub kept: f64,
    /// The sum of the sizes of all changes of the plastic strain or angle.
    pub gone: f64,
}

/// Laws are equal where they are the same object.
impl PartialEq for dyn Law {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::addr_eq(self, other)
    }
}

/// The laws of the elements of a term.
#[derive(Clone, Debug, PartialEq)]
pub enum TermLaw {
    /// The same for all elements.
    Uniform(Arc<dyn Law>),
    /// One for each edge of the tiling; `None` is a linear spring.
    PerEdge(Vec<Option<Arc<dyn Law>>>),
}

impl<L: Law + 'static> From<L> for TermLaw {
    fn from(law: L) -> Self {
        Self::Uniform(Arc::new(law))
    }
}

impl From<Vec<Option<Arc<dyn Law>>>> for TermLaw {
    fn from(each: Vec<Option<Arc<dyn Law>>>) -> Self {
        Self::PerEdge(each)
    }
}

impl TermLaw {
    /// Returns the law of the element at an edge of the tiling; `None` if it is a linear spring.
    pub fn of(&self, edge: usize) -> Option<&Arc<dyn Law>> {
        match self {
            Self::Uniform(law) => Some(law),
            Self::PerEdge(each) => each[edge].as_ref(),
        }
    }

    /// Whether the law of a rigid element has no force on one side of rest: a rigid cable, which would be slack there and
    /// is no element that keeps its rest value.
    pub(crate) fn slackens_rigid(&self, stiffness: &Stiffness) -> bool {
        let is_slack = |law: &Arc<dyn Law>| BESIDE_ONE.into_iter().any(|value| law.at(value, 1.0)[1] == 0.0);
        match self {
            Self::Uniform(law) => stiffness.stiffest().is_infinite() && is_slack(law),
            Self::PerEdge(each) => {
                let mut laws = each.iter().enumerate();
                laws.any(|(edge, law)| stiffness.of(edge).is_infinite() && law.as_ref().is_some_and(is_slack))
            }
        }
    }

    /// Whether any of the laws has a memory.
    fn remembers(&self) -> bool {
        let remembers = |law: &Arc<dyn Law>| law.remembering(Memory::default()).is_some();
        match self {
            Self::Uniform(law) => remembers(law),
            Self::PerEdge(each) => each.iter().flatten().any(remembers),
        }
    }
}

/// The laws of the terms; `None` is a linear spring.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Laws {
    /// That of the bars.
    pub bars: Option<TermLaw>,
    /// That of the creases.
    pub creases: Option<TermLaw>,
    /// That of the facets.
    pub facets: Option<TermLaw>,
}

impl Laws {
    pub(super) fn all(&self) -> [(&'static str, &Option<TermLaw>); 3] {
        [("bars", &self.bars), ("creases", &self.creases), ("facets", &self.facets)]
    }

    /// Returns the laws if every list has one for each of this many edges.
    pub(super) fn for_edges(self, edges: usize) -> Result<Self, AssemblyError> {
        for (_, law) in self.all() {
            if let Some(TermLaw::PerEdge(each)) = law
                && each.len() != edges
            {
                return Err(AssemblyError::Count { what: "laws", given: each.len(), edges });
            }
        }
        Ok(self)
    }

    /// Returns the name of the first term that has a law; `None` if all are springs.
    pub fn first(&self) -> Option<&'static str> {
        self.all().into_iter().find(|(_, law)| law.is_some()).map(|(name, _)| name)
    }

    /// Returns the name of the first term of which a law has a memory; `None` if there is none.
    pub fn first_with_memory(&self) -> Option<&'static str> {
        let remembers = |law: &Option<TermLaw>| law.as_ref().is_some_and(TermLaw::remembers);
        self.all().into_iter().find(|(_, law)| remembers(law)).map(|(name, _)| name)
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
    /// The stiffness times the value: a measure that is an energy.
    Value,
}
