//! Builds the model of a sheet from its terms; no other place decides what a model contains.
//!
//! A term that is absent is not built. Bars always have tensions as unknowns. Hinges have tensions too if they are
//! rigid, or so much stiffer than the softest term that the rounding errors of `k (angle - rest)` would hide their
//! forces.

use super::boundary::Drawn;
use super::element::{Element, Elements, Spring, Term, TermKind};
use super::measure::{FoldAngle, Length};
use super::problem::{Gauge, Model, Parts};
use super::terms::{Hinges, Terms};
use crate::sheet::EdgeKind;
use crate::sheet::tiling::{TiledEdge, Tiling};

/// Ratio of a hinge's stiffness to the softest stiffness above which hinges have tensions as unknowns.
const STIFF_RATIO: f64 = 1e4;

type Elementwise = Vec<Box<dyn Elements>>;

/// Builds the model of a tiling, without the kinds of hinges that `terms` does not have.
pub(super) fn assemble(drawn: &Drawn, tiling: &Tiling, terms: &Terms, gauge: Gauge) -> Model {
    let (mut soft, mut stiff): (Elementwise, Elementwise) = (vec![], vec![]);
    let mean_edge = drawn.mean_edge(tiling);
    if let Some(stiffness) = terms.bars {
        stiff.push(Box::new(bars(drawn, tiling, stiffness)));
    }
    let given = [terms.creases.as_ref().map(|h| h.stiffness), terms.facets.as_ref().map(|h| h.stiffness), terms.bars];
    let softest = given.into_iter().flatten().fold(f64::INFINITY, f64::min);
    let kinds =
        [(TermKind::Creases, EdgeKind::Crease, &terms.creases), (TermKind::Facets, EdgeKind::Facet, &terms.facets)];
    for (term, kind, hinges) in kinds {
        let Some(hinges) = hinges else { continue };
        let term = Box::new(hinge_term(term, drawn, tiling, |edge| tiling.edges[edge].kind == kind, hinges));
        let list = if hinges.stiffness > STIFF_RATIO * softest || hinges.stiffness.is_infinite() {
            &mut stiff
        } else {
            &mut soft
        };
        if !term.is_empty() {
            list.push(term);
        }
    }
    if !terms.locks.is_empty() {
        let mut rest = vec![f64::NAN; tiling.edges.len()];
        terms.locks.iter().for_each(|&(edge, angle)| rest[edge] = angle);
        let locked: Vec<bool> = rest.iter().map(|angle| !angle.is_nan()).collect();
        let rigid = Hinges { stiffness: f64::INFINITY, rest };
        stiff.push(Box::new(hinge_term(TermKind::Locks, drawn, tiling, |edge| locked[edge], &rigid)));
    }
    let pins = terms.pins.iter().flat_map(|(v, axes)| (0..3).filter(|&a| axes[a]).map(move |a| 3 * v + a));
    let pinned: Vec<usize> = drawn.held.iter().copied().chain(pins).collect();
    let loads = net_loads(terms, drawn.coordinates.len(), &pinned);
    Model::new(Parts {
        domain: drawn.domain.clone(),
        drawn: drawn.coordinates.clone(),
        soft,
        stiff,
        pinned,
        loads,
        edges: tiling.edges.len(),
        mean_edge,
        gauge,
    })
}

/// Returns the force on every coordinate, zero where a pin takes it up. The list is empty if all forces are zero, so
/// that a load without effect gives the same model as no load.
fn net_loads(terms: &Terms, coordinates: usize, pinned: &[usize]) -> Vec<f64> {
    let mut loads = vec![0.0; coordinates];
    terms.loads.iter().for_each(|(v, f)| (0..3).for_each(|axis| loads[3 * v + axis] += f[axis]));
    pinned.iter().for_each(|&k| loads[k] = 0.0);
    if loads.iter().all(|force| *force == 0.0) { vec![] } else { loads }
}

fn bars(drawn: &Drawn, tiling: &Tiling, stiffness: f64) -> Term<Length, 2, 6> {
    let element = |(edge, tiled): (usize, &TiledEdge)| {
        let rest = drawn.distance(&tiled.ends);
        Element { sites: tiled.ends, spring: Spring { stiffness: stiffness / rest, rest }, edge }
    };
    let elements = tiling.edges.iter().enumerate().map(element).collect();
    Term::new(TermKind::Bars, elements, &drawn.domain, &drawn.coordinates)
}

fn hinge_term(
    kind: TermKind,
    drawn: &Drawn,
    tiling: &Tiling,
    wanted: impl Fn(usize) -> bool,
    hinges: &Hinges,
) -> Term<FoldAngle, 4, 12> {
    let element = |edge: usize| {
        let sites = tiling.edges[edge].hinge()?;
        let spring =
            Spring { stiffness: hinges.stiffness * drawn.distance(&tiling.edges[edge].ends), rest: hinges.rest[edge] };
        Some(Element { sites, spring, edge })
    };
    let elements = (0..tiling.edges.len()).filter(|&edge| wanted(edge)).filter_map(element).collect();
    Term::new(kind, elements, &drawn.domain, &drawn.coordinates)
}
