//! Terms: elements of one measure, each with a spring law.

use super::domain::{Domain, Site};
use super::measure::Measure;
use crate::math::taylor::Taylor;
use std::f64::consts::{PI, TAU};
use std::marker::PhantomData;

/// The spring law `E = stiffness (value - rest)^2 / 2`; infinite stiffness: `value = rest` exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Spring constant: force per length for a bar, torque per radian for a hinge. May be infinite.
    pub stiffness: f64,
    /// Value without force, in units of the measure.
    pub rest: f64,
}

/// What a term is made of. Whoever treats terms differently names every kind here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TermKind {
    /// The bars, one along every edge.
    Bars,
    /// The hinges over creases.
    Creases,
    /// The hinges over the diagonals of polygons.
    Facets,
    /// The hinges that keep a given angle.
    Locks,
}

impl TermKind {
    /// Every kind, in the order of a scene.
    pub(crate) const ALL: [Self; 4] = [Self::Bars, Self::Creases, Self::Facets, Self::Locks];

    /// The name that the scene has for this kind.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Bars => "bars",
            Self::Creases => "creases",
            Self::Facets => "facets",
            Self::Locks => "locks",
        }
    }
}

/// One element: its points, its law, and the edge of the sheet to which it belongs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Element<const N: usize> {
    /// Its points in the order that the measure wants.
    pub sites: [Site; N],
    /// Its law.
    pub spring: Spring,
    /// Number of the edge in the list of edges of the model.
    pub edge: usize,
}

/// Elements with one measure.
#[derive(Clone, Debug)]
pub(crate) struct Term<M, const N: usize, const D: usize> {
    /// What its elements are.
    pub kind: TermKind,
    /// The elements.
    pub elements: Vec<Element<N>>,
    /// Values in the last accepted state, from which angles continue; empty for lengths.
    last: Vec<f64>,
    measure: PhantomData<M>,
}

/// A measure of one element in the element's coordinates.
#[derive(Default)]
pub struct Local {
    /// Value of the measure, continued from the last accepted state.
    pub value: f64,
    /// Gradient in the element's coordinates.
    pub gradient: Vec<f64>,
    /// Lower triangle of the Hessian of the measure; empty where not asked for.
    pub hessian: Vec<f64>,
}

impl Local {
    /// Derivatives by shared unknowns of these sizes instead of by the shared coordinates; none: as they are.
    pub(crate) fn measure_in(&mut self, units: &[f64]) {
        if units.is_empty() {
            return;
        }
        let points = self.gradient.len() - units.len();
        let unit = |k: usize| if k < points { 1.0 } else { units[k - points] };
        self.gradient.iter_mut().enumerate().for_each(|(k, g)| *g *= unit(k));
        let places = (0..points + units.len()).flat_map(|row| (0..=row).map(move |column| (row, column)));
        self.hessian.iter_mut().zip(places).for_each(|(h, (row, column))| *h = *h * unit(row) * unit(column));
    }
}

/// What the model asks of a term, whatever its measure.
pub trait Elements: Send + Sync {
    /// What its elements are.
    fn kind(&self) -> TermKind;
    /// Gives the name of its kind in the scene.
    fn name(&self) -> &'static str {
        self.kind().name()
    }
    /// Number of elements.
    fn len(&self) -> usize;
    /// Whether there is none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// Whether values are angles.
    fn is_angle(&self) -> bool;
    /// Whether its elements are hinges, see [`Measure::HINGE`].
    fn is_hinge(&self) -> bool;
    /// Points of element `k`.
    fn sites(&self, k: usize) -> &[Site];
    /// Law of element `k`.
    fn spring(&self, k: usize) -> Spring;
    /// Changes the law of element `k`.
    fn set_spring(&mut self, k: usize, spring: Spring);
    /// Number of the edge to which element `k` belongs.
    fn edge(&self, k: usize) -> usize;
    /// Value of element `k`, continued from the last accepted state.
    fn value(&self, k: usize, domain: &Domain, x: &[f64]) -> f64;
    /// Puts value and gradient of element `k` into `out`, and its Hessian where wanted.
    fn local(&self, k: usize, domain: &Domain, x: &[f64], want_hessian: bool, out: &mut Local);
    /// Element `k` on the path `x[0] + a x[1] + a^2 x[2]` of all coordinates; not on screws.
    fn along(&self, k: usize, domain: &Domain, x: &[&[f64]; 3]) -> Taylor;
    /// Makes `x` the state from which angles continue.
    fn accept(&mut self, domain: &Domain, x: &[f64]);
    /// Angles of the last accepted state; empty for lengths.
    fn angles(&self) -> &[f64];
    /// Sets the angles from which values continue.
    fn set_angles(&mut self, angles: &[f64]);
}

impl<M: Measure<N, D>, const N: usize, const D: usize> Term<M, N, D> {
    /// A term of these elements; angles continue from their values at `x`.
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

impl<M: Measure<N, D> + Send + Sync, const N: usize, const D: usize> Elements for Term<M, N, D> {
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
        let points = domain.points(x, sites);
        let (value, gradient) = if want_hessian {
            let (value, gradient) = M::hessian(&points, &mut out.hessian);
            domain.pull_hessian(x, sites, &gradient, &mut out.hessian);
            (value, gradient)
        } else {
            out.hessian.clear();
            M::gradient(&points)
        };
        out.value = self.continued(k, value);
        out.gradient.clear();
        domain.pull_gradient(x, sites, &gradient, &mut out.gradient);
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
