//! Terms of the energy: lists of elements with the same measure, each element with a spring law.

use super::domain::{Domain, Site};
use super::measure::Measure;
use crate::math::Vec3;
use crate::math::taylor::Taylor;
use std::f64::consts::{PI, TAU};
use std::marker::PhantomData;

/// The spring law `E = stiffness (value - rest)^2 / 2`; infinite stiffness means `value = rest` exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Spring constant: force per length for a bar, torque per radian for a hinge; may be infinite.
    pub stiffness: f64,
    /// Value without force: a length, or an angle in radians.
    pub rest: f64,
}

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
}

impl TermKind {
    /// All kinds, in the order in which a scene lists them.
    pub(crate) const ALL: [Self; 4] = [Self::Bars, Self::Creases, Self::Facets, Self::Locks];

    /// Returns the name of this kind in a scene.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Bars => "bars",
            Self::Creases => "creases",
            Self::Facets => "facets",
            Self::Locks => "locks",
        }
    }
}

/// One element: its points, its spring law, and the edge of the sheet to which it belongs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Element<const N: usize> {
    /// The points, in the order of the measure's arguments.
    pub sites: [Site; N],
    /// The spring law.
    pub spring: Spring,
    /// Number of the element's edge in the tiling.
    pub edge: usize,
}

/// A term: a list of elements with the same measure `M` of `N` points, which have `D = 3 N` coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Term<M, const N: usize, const D: usize> {
    /// The kind of the elements.
    pub kind: TermKind,
    /// The elements.
    pub elements: Vec<Element<N>>,
    /// Values in the last accepted state, from which angles continue; empty for lengths.
    last: Vec<f64>,
    measure: PhantomData<M>,
}

/// The measure of one element with its derivatives in the element's coordinates: those of its points, then the shared
/// ones.
#[derive(Default)]
pub struct Local {
    /// Value of the measure, continued from the last accepted state.
    pub value: f64,
    /// Gradient in the element's coordinates.
    pub gradient: Vec<f64>,
    /// Lower triangle of the Hessian of the measure, row by row; empty if it was not asked for.
    pub hessian: Vec<f64>,
}

impl Local {
    /// Converts the derivatives by the shared coordinates to derivatives by the shared unknowns. `units` holds the
    /// size of each shared unknown in its coordinate; an empty list leaves everything as it is.
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

/// The interface of a term to the model, independent of its measure.
pub trait Elements: Send + Sync {
    /// Returns a copy.
    fn boxed(&self) -> Box<dyn Elements>;
    /// Returns the kind of the elements.
    fn kind(&self) -> TermKind;
    /// Returns the name of the kind in a scene.
    fn name(&self) -> &'static str {
        self.kind().name()
    }
    /// Returns the number of elements.
    fn len(&self) -> usize;
    /// Whether there are no elements.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// Whether the values are angles.
    fn is_angle(&self) -> bool;
    /// Whether the elements are hinges; see [`Measure::HINGE`].
    fn is_hinge(&self) -> bool;
    /// Returns the points of element `k`.
    fn sites(&self, k: usize) -> &[Site];
    /// Returns the spring law of element `k`.
    fn spring(&self, k: usize) -> Spring;
    /// Replaces the spring law of element `k`.
    fn set_spring(&mut self, k: usize, spring: Spring);
    /// Returns the number of the edge to which element `k` belongs.
    fn edge(&self, k: usize) -> usize;
    /// Returns the value of element `k` at the coordinates `x`; angles continue from the last accepted state.
    fn value(&self, k: usize, domain: &Domain, x: &[f64]) -> f64;
    /// Puts value and gradient of element `k` at the coordinates `x` into `out`, and its Hessian if it is wanted.
    fn local(&self, k: usize, domain: &Domain, x: &[f64], want_hessian: bool, out: &mut Local);
    /// Returns the Taylor series of element `k` along the path `x[0] + a x[1] + a^2 x[2]` of all coordinates; not
    /// valid for screws.
    fn along(&self, k: usize, domain: &Domain, x: &[&[f64]; 3]) -> Taylor;
    /// Makes `x` the accepted state, from which angles continue.
    fn accept(&mut self, domain: &Domain, x: &[f64]);
    /// Returns the angles of the last accepted state; empty for lengths.
    fn angles(&self) -> &[f64];
    /// Sets the angles from which values continue.
    fn set_angles(&mut self, angles: &[f64]);
}

impl<M: Measure<N, D>, const N: usize, const D: usize> Term<M, N, D> {
    /// Makes a term of these elements; angles continue from their values at the coordinates `x`.
    pub(crate) fn new(kind: TermKind, elements: Vec<Element<N>>, domain: &Domain, x: &[f64]) -> Self {
        let mut term = Self { kind, elements, last: Vec::new(), measure: PhantomData };
        if M::ANGLE {
            term.last = term.elements.iter().map(|e| M::value(&domain.points(x, &e.sites))).collect();
        }
        term
    }

    fn continued(&self, k: usize, value: f64) -> f64 {
        match self.last.get(k) {
            Some(last) if (last - value).abs() > PI => value + TAU * ((last - value) / TAU).round(),
            _ => value,
        }
    }
}

impl Clone for Box<dyn Elements> {
    fn clone(&self) -> Self {
        self.boxed()
    }
}

impl<M: Measure<N, D> + Clone + Send + Sync + 'static, const N: usize, const D: usize> Elements for Term<M, N, D> {
    fn boxed(&self) -> Box<dyn Elements> {
        Box::new(self.clone())
    }

    fn kind(&self) -> TermKind {
        self.kind
    }

    fn len(&self) -> usize {
        self.elements.len()
    }

    fn is_angle(&self) -> bool {
        M::ANGLE
    }

    fn is_hinge(&self) -> bool {
        M::HINGE
    }

    fn sites(&self, k: usize) -> &[Site] {
        &self.elements[k].sites
    }

    fn spring(&self, k: usize) -> Spring {
        self.elements[k].spring
    }

    fn set_spring(&mut self, k: usize, spring: Spring) {
        self.elements[k].spring = spring;
    }

    fn edge(&self, k: usize) -> usize {
        self.elements[k].edge
    }

    fn value(&self, k: usize, domain: &Domain, x: &[f64]) -> f64 {
        self.continued(k, M::value(&domain.points(x, &self.elements[k].sites)))
    }

    fn local(&self, k: usize, domain: &Domain, x: &[f64], want_hessian: bool, out: &mut Local) {
        let sites = &self.elements[k].sites;
        out.gradient.clear();
        out.hessian.clear();
        let mut measure =
            |points: &[Vec3; N]| if want_hessian { M::hessian(points, &mut out.hessian) } else { M::gradient(points) };
        let value = if domain.shared() == 0 {
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
        out.value = self.continued(k, value);
    }

    fn along(&self, k: usize, domain: &Domain, x: &[&[f64]; 3]) -> Taylor {
        M::along(&self.elements[k].sites.map(|site| domain.path(x, site)))
    }

    fn accept(&mut self, domain: &Domain, x: &[f64]) {
        for k in 0..self.last.len() {
            self.last[k] = self.value(k, domain, x);
        }
    }

    fn angles(&self) -> &[f64] {
        &self.last
    }

    fn set_angles(&mut self, angles: &[f64]) {
        self.last.copy_from_slice(angles);
    }
}
