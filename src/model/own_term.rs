//! Terms of a user's own: a measure and a law on chosen points.

use super::domain::Site;
use super::element::{Elements, Term, TermKind};
use super::law::{Law, Spring, Stored};
use super::measure::Measure;
use std::fmt;
use std::sync::Arc;

/// The name of the term of [membranes](OwnTerm::membrane).
pub(super) const MEMBRANE: &str = "membrane";

/// A term of one's own: elements with a measure and a law of one's own, and a name under which their energy is listed.
///
/// Its energy must not change where the whole sheet moves as a rigid body, unless pins prevent that: coordinates are
/// held against such motions. Studies refuse other terms; [`Assembly::check_own_terms`](super::Assembly::check_own_terms)
/// asks.
///
/// ```
/// use foldwell::model::{Length, OwnTerm, RIGID, Site, Spring};
/// use foldwell::{Assembly, Pattern, generate, relax};
///
/// let sheet = generate(&Pattern::named("miura")?)?;
/// let assembly = Assembly::patch(sheet, [2, 2]).bars(RIGID).creases(1.0).build()?;
/// // a rubber band between the first vertex of the first cell and that of the last
/// let ends = [0, 3 * assembly.sheet().vertices.len()].map(|vertex| Site { vertex, shift: [0, 0] });
/// let band = OwnTerm::new("band", Length, [(ends, Spring { stiffness: 2.0, rest: 1.0 })]);
/// let state = relax(&assembly.with_own_term(band))?.state;
/// assert!(state.energy_of_term("band") > 0.0 && state.total() > state.energy_creases);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct OwnTerm {
    pub(super) elements: Arc<dyn Elements>,
    pub(super) springs: Vec<Spring>,
    /// Whether its elements have tensions as unknowns, as is best where they may be much stiffer than others.
    pub(super) has_tensions: bool,
}

impl OwnTerm {
    /// Makes a term of elements with this measure and springs of finite or infinite stiffness. The points are vertices
    /// of the tiling, in the order of the measure's arguments; `shift` is not zero for copies of a periodic sheet.
    pub fn new<M: Measure<N, D> + 'static, const N: usize, const D: usize>(
        name: &str,
        measure: M,
        elements: impl IntoIterator<Item = ([Site; N], Spring)>,
    ) -> Self {
        Self::storing(name, measure, elements, Stored::Spring)
    }

    /// Makes a term of elements with this measure and law.
    ///
    /// # Panics
    /// If a stiffness is infinite: a rigid element has no law.
    pub fn with_law<M: Measure<N, D> + 'static, const N: usize, const D: usize>(
        name: &str,
        measure: M,
        elements: impl IntoIterator<Item = ([Site; N], Spring)>,
        law: impl Law + 'static,
    ) -> Self {
        let term = Self::storing(name, measure, elements, Stored::Law(Arc::new(law)));
        assert!(!term.has_tensions, "a rigid element has no law");
        term
    }

    /// Makes a term of elements whose energy is a multiple of their measure, each with its factor: a potential that is no
    /// spring.
    pub fn energy<M: Measure<N, D> + 'static, const N: usize, const D: usize>(
        name: &str,
        measure: M,
        elements: impl IntoIterator<Item = ([Site; N], f64)>,
    ) -> Self {
        let springs = elements.into_iter().map(|(sites, factor)| (sites, Spring { stiffness: factor, rest: 0.0 }));
        Self::storing(name, measure, springs, Stored::Value)
    }

    fn storing<M: Measure<N, D> + 'static, const N: usize, const D: usize>(
        name: &str,
        measure: M,
        elements: impl IntoIterator<Item = ([Site; N], Spring)>,
        stored: Stored,
    ) -> Self {
        let (sites, springs) = elements.into_iter().map(|(sites, spring)| ((sites, None), spring)).unzip();
        let elements = Arc::new(Term::new((TermKind::Own, name), measure, sites, |_| stored.clone()));
        Self::of(elements, springs)
    }

    /// Makes a term of these elements, which have tensions where one of them is rigid.
    pub(super) fn of(elements: Arc<dyn Elements>, springs: Vec<Spring>) -> Self {
        let has_tensions = springs.iter().any(|spring| spring.stiffness.is_infinite());
        Self { elements, springs, has_tensions }
    }

    /// Returns its name; that of a load is its kind.
    pub fn name(&self) -> &str {
        if self.is_load() { self.elements.head().kind.name() } else { &self.elements.head().name }
    }

    /// Whether it is a load and no energy: the pressure on faces, or a torque.
    pub fn is_load(&self) -> bool {
        self.elements.head().kind.is_load()
    }
}

impl fmt::Debug for OwnTerm {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} ({} elements)", self.name(), self.springs.len())
    }
}

/// Terms are equal where they are the same object.
impl PartialEq for OwnTerm {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.elements, &other.elements) && self.springs == other.springs
    }
}
