//! Builds the model of a sheet from its terms; no other place decides what a model contains.
//!
//! A term that is absent is not built. Bars always have tensions as unknowns. A hinge has a tension too if it is rigid,
//! or so much stiffer than the softest element that the rounding errors of `k (angle - rest)` would hide its torque;
//! the hinges of one kind may be of both sorts. An element that has a law and a tension is two: a spring with that
//! tension, and what the law stores beyond it.

use super::boundary::Drawn;
use super::element::{Elements, Term, TermKind};
use super::law::{Law, Spring, Stored, TermLaw};
use super::measure::{FoldAngle, Length};
use super::problem::{Bodies, Equations, Gauge, Model, Support};
use super::stiffness::Stiffness;
use super::terms::{Bars, Hinges, Terms};
use crate::math::Vec3;
use crate::sheet::EdgeKind;
use crate::sheet::tiling::{TiledEdge, Tiling};
use std::sync::Arc;

/// Ratio of a hinge's stiffness to the softest stiffness above which the hinge has a tension as unknown.
const STIFF_RATIO: f64 = 1e4;

/// Terms, and the springs of all their elements.
#[derive(Default)]
struct Listed {
    terms: Vec<Arc<dyn Elements>>,
    springs: Vec<Spring>,
}

impl Listed {
    fn push(&mut self, (term, springs): (impl Elements + 'static, Vec<Spring>)) {
        if !springs.is_empty() {
            self.terms.push(Arc::new(term));
            self.springs.extend(springs);
        }
    }
}

/// Builds the model of a tiling, without the kinds of hinges that `terms` does not have.
pub(super) fn assemble(drawn: &Drawn, tiling: &Tiling, terms: &Terms, gauge: Gauge) -> Model {
    let bodies = Bodies::new(&terms.parts, &drawn.coordinates);
    let [soft, stiff] = listed(drawn, tiling, terms, &bodies);
    let pins = terms.pins.iter().flat_map(|(v, axes)| (0..3).filter(|&a| axes[a]).map(move |a| 3 * v + a));
    let pinned: Vec<usize> = drawn.held.iter().copied().chain(pins).collect();
    let loads = net_loads(terms, drawn.coordinates.len(), &pinned);
    let equations = Equations {
        domain: drawn.domain.clone(),
        drawn: drawn.coordinates.clone(),
        bodies,
        soft: soft.terms,
        stiff: stiff.terms,
        edges: tiling.edges.len(),
        mean_edge: drawn.mean_edge(tiling),
        gauge,
    };
    let supports = terms.guides.iter().map(|(vertex, direction)| guide(drawn, *vertex, direction)).collect();
    Model::new(equations, [soft.springs, stiff.springs].concat(), pinned, supports, loads)
}

/// Returns the terms whose elements enter with their energy, and those whose elements have tensions.
fn listed(drawn: &Drawn, tiling: &Tiling, terms: &Terms, bodies: &Bodies) -> [Listed; 2] {
    let (mut soft, mut stiff) = (Listed::default(), Listed::default());
    let moves = |edge: usize| tiling.edges[edge].hinge().is_some_and(|sites| !bodies.hold(&sites));
    if let Some(given) = &terms.bars {
        let moves = |edge: usize| !bodies.hold(&tiling.edges[edge].ends);
        let law = |edge| law_of(&terms.laws.bars, edge);
        let there = |edge| moves(edge) && !given.stiffness.of(edge).is_nan();
        stiff.push(bars(drawn, tiling, given, there, |_| Stored::Spring));
        let beyond = |edge| moves(edge) && given.stiffness.of(edge).is_finite() && law(edge).is_some();
        soft.push(bars(drawn, tiling, given, beyond, |edge| stored(law(edge), Stored::BeyondSpring)));
    }
    let softest = softest(terms);
    let kinds = [
        (TermKind::Creases, EdgeKind::Crease, &terms.creases, &terms.laws.creases),
        (TermKind::Facets, EdgeKind::Facet, &terms.facets, &terms.laws.facets),
    ];
    for (term, kind, hinges, laws) in kinds {
        let Some(hinges) = hinges else { continue };
        let has_tension = |edge: usize| {
            let stiffness = hinges.stiffness.of(edge);
            stiffness > STIFF_RATIO * softest || stiffness.is_infinite()
        };
        let here = |edge: usize| tiling.edges[edge].kind == kind && moves(edge) && !hinges.stiffness.of(edge).is_nan();
        let law = |edge| law_of(laws, edge);
        let (alone, tensed) = (|edge| here(edge) && !has_tension(edge), |edge| here(edge) && has_tension(edge));
        soft.push(hinge_term(term, drawn, tiling, alone, hinges, |edge| stored(law(edge), Stored::Law)));
        stiff.push(hinge_term(term, drawn, tiling, tensed, hinges, |_| Stored::Spring));
        let beyond = |edge| tensed(edge) && hinges.stiffness.of(edge).is_finite() && law(edge).is_some();
        soft.push(hinge_term(term, drawn, tiling, beyond, hinges, |edge| stored(law(edge), Stored::BeyondSpring)));
    }
    if !terms.locks.is_empty() {
        let mut rest = vec![f64::NAN; tiling.edges.len()];
        terms.locks.iter().for_each(|&(edge, angle)| rest[edge] = angle);
        let rigid = Hinges { stiffness: f64::INFINITY.into(), rest };
        let locked = |edge: usize| !rigid.rest[edge].is_nan() && moves(edge);
        stiff.push(hinge_term(TermKind::Locks, drawn, tiling, locked, &rigid, |_| Stored::Spring));
    }
    for own in &terms.own {
        let list = if own.has_tensions { &mut stiff } else { &mut soft };
        list.terms.push(own.elements.clone());
        list.springs.extend(&own.springs);
    }
    [soft, stiff]
}

/// Returns the law of the element at an edge; `None` if it is a linear spring.
fn law_of(laws: &Option<TermLaw>, edge: usize) -> Option<&Arc<dyn Law>> {
    laws.as_ref().and_then(|laws| laws.of(edge))
}

/// Returns how an element of this law stores energy, which is a linear spring without one.
fn stored(law: Option<&Arc<dyn Law>>, of_law: fn(Arc<dyn Law>) -> Stored) -> Stored {
    law.cloned().map_or(Stored::Spring, of_law)
}

/// Returns the force on every coordinate, zero where a pin takes it up. The list is empty if all forces are zero, so
/// that a load without effect gives the same model as no load.
fn net_loads(terms: &Terms, coordinates: usize, pinned: &[usize]) -> Vec<f64> {
    let mut loads = vec![0.0; coordinates];
    terms.loads.iter().for_each(|(v, f)| (0..3).for_each(|axis| loads[3 * v + axis] += f[axis]));
    pinned.iter().for_each(|&k| loads[k] = 0.0);
    if loads.iter().all(|force| *force == 0.0) { vec![] } else { loads }
}

/// Returns the support that keeps the drawn coordinate of a vertex along a direction.
fn guide(drawn: &Drawn, vertex: usize, direction: &Vec3) -> Support {
    let terms: Vec<(usize, f64)> = (0..3).map(|axis| (3 * vertex + axis, direction[axis])).collect();
    let rest = terms.iter().map(|(k, factor)| factor * drawn.coordinates[*k]).sum();
    Support { terms, rest, is_angle: false }
}

/// Returns the smallest stiffness of all terms.
fn softest(terms: &Terms) -> f64 {
    let hinges = [&terms.creases, &terms.facets].map(|hinges| hinges.as_ref().map(|hinges| &hinges.stiffness));
    let given = hinges.into_iter().chain([terms.bar_stiffness()]).flatten();
    given.map(Stiffness::softest).fold(f64::INFINITY, f64::min)
}

/// Returns the same for elements that may lie on no edge, which are springs.
fn of_edge(stored: impl Fn(usize) -> Stored) -> impl Fn(Option<usize>) -> Stored {
    move |edge| edge.map_or(Stored::Spring, &stored)
}

fn bars(
    drawn: &Drawn,
    tiling: &Tiling,
    bars: &Bars,
    wanted: impl Fn(usize) -> bool,
    stored: impl Fn(usize) -> Stored,
) -> (Term<Length, 2, 6>, Vec<Spring>) {
    let edges = tiling.edges.iter().enumerate();
    let there = edges.filter(|(edge, tiled)| tiled.bar && wanted(*edge));
    let bar = |(edge, tiled): (usize, &TiledEdge)| {
        let rest = bars.rest.of(edge, drawn.distance(&tiled.ends));
        ((tiled.ends, Some(edge)), Spring { stiffness: bars.stiffness.of(edge) / rest, rest })
    };
    let (elements, springs) = there.map(bar).unzip();
    (Term::new((TermKind::Bars, TermKind::Bars.name()), Length, elements, of_edge(stored)), springs)
}

fn hinge_term(
    kind: TermKind,
    drawn: &Drawn,
    tiling: &Tiling,
    wanted: impl Fn(usize) -> bool,
    hinges: &Hinges,
    stored: impl Fn(usize) -> Stored,
) -> (Term<FoldAngle, 4, 12>, Vec<Spring>) {
    let hinge = |edge: usize| {
        let sites = tiling.edges[edge].hinge()?;
        let stiffness = hinges.stiffness.of(edge) * drawn.distance(&tiling.edges[edge].ends);
        Some(((sites, Some(edge)), Spring { stiffness, rest: hinges.rest[edge] }))
    };
    let (elements, springs) = (0..tiling.edges.len()).filter(|&edge| wanted(edge)).filter_map(hinge).unzip();
    (Term::new((kind, kind.name()), FoldAngle, elements, of_edge(stored)), springs)
}
