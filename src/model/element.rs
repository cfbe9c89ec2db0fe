//! Terms of the energy: lists of elements with the same measure; and the elements of a model, each with a spring law.

use super::domain::{Domain, Site};
use super::law::{Memory, Spring, Stored};
use super::measure::Measure;
use crate::math::Vec3;
use crate::math::taylor::Taylor;
use std::f64::consts::{PI, TAU};

/// The kind of the elements of a term. Code that treats kinds differently must match all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TermKind {
    /// Bars, one along every edge.
    Bars,
    /// Hinges at creases.
    Creases,
    /// Hinges at the diagonals of polygons.
    Facets,
    /// Hinges locked at a given angle.
    Locks,
    /// Elements of a term of one's own.
    Own,
    /// Faces under pressure, which are loaded and store nothing.
    Pressure,
    /// Parts under a torque, which do the same.
    Torque,
}

impl TermKind {
    /// All kinds, in the order in which a scene lists them.
    pub(crate) const ALL: [Self; 7] =
        [Self::Bars, Self::Creases, Self::Facets, Self::Locks, Self::Own, Self::Pressure, Self::Torque];

    /// Returns the name of this kind in a scene.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bars => "bars",
            Self::Creases => "creases",
            Self::Facets => "facets",
            Self::Locks => "locks",
            Self::Own => "own terms",
            Self::Pressure => "pressure",
            Self::Torque => "torque",
        }
    }

    /// Whether it is a load, whose potential is no energy of the sheet.
    pub(super) fn is_load(self) -> bool {
        matches!(self, Self::Pressure | Self::Torque)
    }
}

/// The kind, name, edges and laws of the elements of a term: all of it but their measures.
#[derive(Clone, Debug)]
pub(super) struct Head {
    pub kind: TermKind,
    pub name: String,
    /// Whether the values are angles.
    pub is_angle: bool,
    /// Whether the elements are hinges; see [`Measure::HINGE`].
    pub is_hinge: bool,
    /// The number of the edge to which each element belongs; `None` if it lies on none.
    pub edges: Vec<Option<usize>>,
    /// How each element stores energy.
    pub stored: Vec<Stored>,
}

impl Head {
    /// Whether the energy of each element is a multiple of its value.
    pub fn is_energy(&self) -> bool {
        matches!(self.stored.first(), Some(Stored::Value))
    }
}

/// A term: a list of elements with a measure `M` of `N` points, which have `D = 3 N` coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Term<M, const N: usize, const D: usize> {
    head: Head,
    /// The measure of each element, or one for all.
    measures: Vec<M>,
    /// The points of each element, in the order of the measure's arguments.
    sites: Vec<[Site; N]>,
}

/// The measure of one element with its derivatives in the element's coordinates: those of its points, then the shared
/// ones.
#[derive(Default)]
pub struct Local {
    /// Value of the measure.
    pub value: f64,
    /// Gradient in the element's coordinates.
    pub gradient: Vec<f64>,
    /// Lower triangle of the Hessian of the measure, row by row; empty if it was not asked for.
    pub hessian: Vec<f64>,
}

impl Local {
    /// Converts the derivatives by the last coordinates, those shared or all, to derivatives by their unknowns. `units`
    /// holds the size of each of these unknowns in its coordinate; an empty list leaves everything as it is.
    pub(crate) fn measure_in(&mut self, units: &[f64]) {
        if units.is_empty() {
            return;
        }
        let points = self.gradient.len() - units.len();
        self.gradient[points..].iter_mut().zip(units).for_each(|(g, unit)| *g *= unit);
        if self.hessian.is_empty() {
            return;
        }
        for (k, unit) in units.iter().enumerate() {
            let first = (points + k) * (points + k + 1) / 2;
            let (by_points, by_shared) = self.hessian[first..first + points + k + 1].split_at_mut(points);
            by_points.iter_mut().for_each(|h| *h *= unit);
            by_shared.iter_mut().zip(units).for_each(|(h, other)| *h *= unit * other);
        }
    }
}

/// The measures of a term, independent of the number of their points. They never change: springs and the angles from
/// which values continue belong to a [`Model`](super::Model).
pub(super) trait Elements: Send + Sync {
    /// Returns what else there is to say of the elements.
    fn head(&self) -> &Head;
    /// Returns the points of element `k`.
    fn sites(&self, k: usize) -> &[Site];
    /// Returns the value of element `k` at the coordinates `x`; angles are between -pi and pi.
    fn value(&self, k: usize, domain: &Domain, x: &[f64]) -> f64;
    /// Puts value and gradient of element `k` at the coordinates `x` into `out`, and its Hessian if it is wanted.
    fn local(&self, k: usize, domain: &Domain, x: &[f64], want_hessian: bool, out: &mut Local);
    /// Returns the Taylor series of element `k` along the path `x[0] + a x[1] + a^2 x[2]` of all coordinates; not
    /// valid for screws.
    fn along(&self, k: usize, domain: &Domain, x: &[&[f64]; 3]) -> Option<Taylor>;

    /// Returns the number of elements.
    fn len(&self) -> usize {
        self.head().stored.len()
    }
}

impl<M: Measure<N, D>, const N: usize, const D: usize> Term<M, N, D> {
    /// Makes a term of elements, each given by its points and its edge, and by `stored` of its edge.
    pub(super) fn new(
        name: (TermKind, &str),
        measure: M,
        elements: Vec<([Site; N], Option<usize>)>,
        stored: impl Fn(Option<usize>) -> Stored,
    ) -> Self {
        let (sites, edges): (_, Vec<_>) = elements.into_iter().unzip();
        let stored = edges.iter().map(|edge| stored(*edge)).collect();
        Self::storing(name, vec![measure], sites, (edges, stored))
    }

    /// Makes a term of springs, each with a measure of its own.
    pub(super) fn of_each(name: (TermKind, &str), elements: Vec<(M, [Site; N])>) -> Self {
        let count = elements.len();
        let (measures, sites) = elements.into_iter().unzip();
        Self::storing(name, measures, sites, (vec![None; count], vec![Stored::Spring; count]))
    }

    fn storing(
        (kind, name): (TermKind, &str),
        measures: Vec<M>,
        sites: Vec<[Site; N]>,
        (edges, stored): (Vec<Option<usize>>, Vec<Stored>),
    ) -> Self {
        let head = Head { kind, name: name.to_owned(), is_angle: M::ANGLE, is_hinge: M::HINGE, edges, stored };
        Self { head, measures, sites }
    }

    fn measure(&self, k: usize) -> &M {
        if let [all] = &self.measures[..] { all } else { &self.measures[k] }
    }
}

impl<M: Measure<N, D>, const N: usize, const D: usize> Elements for Term<M, N, D> {
    fn head(&self) -> &Head {
        &self.head
    }

    fn sites(&self, k: usize) -> &[Site] {
        &self.sites[k]
    }

    fn value(&self, k: usize, domain: &Domain, x: &[f64]) -> f64 {
        self.measure(k).value(&domain.points(x, &self.sites[k]))
    }

    fn local(&self, k: usize, domain: &Domain, x: &[f64], want_hessian: bool, out: &mut Local) {
        let sites = &self.sites[k];
        out.gradient.clear();
        out.hessian.clear();
        let of = self.measure(k);
        let mut measure = |points: &[Vec3; N]| {
            if want_hessian { of.hessian(points, &mut out.hessian) } else { of.gradient(points) }
        };
        out.value = if domain.is_fixed_translation() {
            let (value, gradient) = measure(&domain.points(x, sites));
            out.gradient.extend_from_slice(gradient.as_slice());
            value
        } else {
            let placed = sites.map(|site| domain.place(x, site));
            let (value, gradient) = measure(&std::array::from_fn(|n| placed[n].point));
            if want_hessian {
                domain.pull_hessian(&placed, &gradient, &mut out.hessian);
            }
            domain.pull_gradient(&placed, &gradient, &mut out.gradient);
            value
        };
    }

    fn along(&self, k: usize, domain: &Domain, x: &[&[f64]; 3]) -> Option<Taylor> {
        self.measure(k).along(&self.sites[k].map(|site| domain.path(x, site)))
    }
}

/// One element of a model: its measure, its spring law, and the angle from which its own continues.
#[derive(Clone, Copy)]
pub struct Element<'a> {
    /// Its number among the elements of the model, soft ones first.
    pub number: usize,
    /// Its spring law.
    pub spring: Spring,
    /// Its angle in the last accepted state, in radians; not a number for a length.
    pub(super) last: f64,
    /// Plastic strain or angle, and the sum of its changes; zero where the law has no memory.
    pub(super) memory: Memory,
    pub(super) domain: &'a Domain,
    pub(super) term: &'a dyn Elements,
    /// Its number in the term.
    pub(super) index: usize,
}

impl<'a> Element<'a> {
    /// Returns the kind of the element.
    pub fn kind(&self) -> TermKind {
        self.term.head().kind
    }

    /// Whether its value is an angle.
    pub fn is_angle(&self) -> bool {
        self.term.head().is_angle
    }

    /// Whether it is a hinge, whose points are its two ends and then its left and right wing.
    pub(crate) fn is_hinge(&self) -> bool {
        self.term.head().is_hinge
    }

    /// Whether it is a hinge of finite stiffness.
    pub(crate) fn is_elastic_hinge(&self) -> bool {
        self.is_hinge() && self.spring.stiffness.is_finite()
    }

    /// Returns its points: the two ends of a bar, or the two ends of a hinge and then its left and right wing.
    pub fn sites(&self) -> &'a [Site] {
        self.term.sites(self.index)
    }

    /// Returns the name of its term.
    pub fn name(&self) -> &'a str {
        &self.term.head().name
    }

    /// Returns the number of its edge in the tiling; `None` for elements of a term of one's own.
    pub fn edge(&self) -> Option<usize> {
        self.term.head().edges[self.index]
    }

    pub(super) fn stored(&self) -> &'a Stored {
        &self.term.head().stored[self.index]
    }

    /// Returns its value at the coordinates `x`, a length or an angle in radians, which continues from the last
    /// accepted state.
    pub fn value(&self, x: &[f64]) -> f64 {
        continued(self.last, self.term.value(self.index, self.domain, x))
    }

    /// Returns its stiffness in the metric of the solver, which must not be negative: that at rest.
    pub(super) fn metric(&self) -> f64 {
        if self.is_beyond_spring() || self.is_load() || self.term.head().is_energy() {
            0.0
        } else {
            self.spring.stiffness
        }
    }

    /// Whether it stores what a law has beyond a spring, which is another element.
    pub(crate) fn is_beyond_spring(&self) -> bool {
        matches!(self.stored(), Stored::BeyondSpring(_))
    }

    /// Whether it is a load, whose potential is no energy of the sheet.
    pub(crate) fn is_load(&self) -> bool {
        self.kind().is_load()
    }

    /// Whether it has another law than a spring.
    pub(crate) fn has_law(&self) -> bool {
        !matches!(self.stored(), Stored::Spring)
    }

    /// Puts value and gradient at the coordinates `x` into `out`, and the Hessian if it is wanted.
    pub(crate) fn local(&self, x: &[f64], want_hessian: bool, out: &mut Local) {
        self.term.local(self.index, self.domain, x, want_hessian, out);
        out.value = continued(self.last, out.value);
    }

    /// Returns the Taylor series of its value along the path `x[0] + a x[1] + a^2 x[2]` of all coordinates; not valid
    /// for screws, and `None` for measures without series.
    pub(crate) fn along(&self, x: &[&[f64]; 3]) -> Option<Taylor> {
        self.term.along(self.index, self.domain, x)
    }

    /// The same element where another domain gives the points.
    pub(crate) fn on(self, domain: &'a Domain) -> Self {
        Self { domain, ..self }
    }
}

/// An angle continued without a jump from the last one; other values, which have none, stay as they are.
pub(super) fn continued(last: f64, value: f64) -> f64 {
    if (last - value).abs() > PI { value + TAU * ((last - value) / TAU).round() } else { value }
}
