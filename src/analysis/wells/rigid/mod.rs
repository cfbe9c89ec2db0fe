//! Wells and passes of exactly rigid sheets, in fold angles alone: no bar, no random start.
//!
//! The folded states of one cell, or of a small finite sheet, are curves or a surface that leave the drawn state
//! (`curves`, `surface`). On states sampled there wells are the lowest of their neighbours and passes are found by
//! flooding (`flood`); each is then made exact by Newton's method for the energy of the creases along the closed states
//! ([`crate::analysis::exact`]), and its index counted. States at which a crease is folded by more than `pi`, where
//! panels have gone through each other, do not belong to this landscape, unless its rest angle is beyond that too
//! (`extent`).
//!
//! The drawn state itself may be a pass: branches cross there, and no Hessian says so. Its energy is the height all the
//! same.

mod curves;
mod extent;
mod flood;
mod surface;

use super::merge::are_close;
use crate::analysis::exact::{Springs, Stationary};
use crate::analysis::surface::{FoldedSurface, Lowest, Negative, SurfaceError};
use crate::kinematics::KinematicsError;
use crate::model::{Assembly, Domain, Gauge};
use crate::numerics::vector::distance;
use extent::{Extent, SAME_STATE_ANGLE_RAD};
use flood::Merge;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// How far, in fold angles, a sampled state may be from the stationary one next to it, in distances of neighbours.
const NEIGHBOUR_DISTANCES: f64 = 4.0;

/// How finely and how far the folded states are sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Distance of neighbours in fold angles.
    pub step: f64,
    /// Magnitude of the curvature at which a surface ends.
    pub max_curvature: f64,
}

/// Sampled states that hang together.
pub(super) struct StateGraph {
    /// Fold angles of all edges.
    pub angles: Vec<Vec<f64>>,
    /// Neighbours.
    pub links: Vec<[usize; 2]>,
    /// Whether branches cross at a state: it has no tangents of its own.
    pub singular: Vec<bool>,
    /// Whether the landscape ends at a state.
    pub border: Vec<bool>,
    /// Dimension: 1 or 2.
    pub dimension: usize,
    /// Number of the first spatially periodic state among those of a curve of such states: that on which two surfaces
    /// cross, or the whole net, then 0; where there is no such curve, as large as the number of states or larger.
    pub seam: usize,
    /// Places beyond which the states go on that were not found.
    pub open: usize,
}

/// A pass of a rigid sheet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "RigidPassSummary")]
pub struct RigidPass {
    /// The lowest wells on its sides.
    pub joins: [usize; 2],
    /// Energy.
    pub energy: f64,
    /// Fold angles of all edges; summaries are without them.
    #[serde(skip)]
    pub angles: Vec<f64>,
    /// Whether branches cross there; otherwise its Hessian has one negative eigenvalue.
    pub singular: bool,
}

/// Wells and passes.
#[derive(Clone, Debug, Default)]
pub struct RigidLandscape {
    /// Dimension of the folded states: 1 or 2.
    pub dimension: usize,
    /// Sampled states.
    pub states: usize,
    /// Wells, by energy.
    pub wells: Vec<Stationary>,
    /// Energies of the ends of curves where a crease is folded by `pi` and the torque folds it further: states that the
    /// contact of two panels holds. They are no equilibria of the creases alone, and not among the wells.
    pub contacts: Vec<f64>,
    /// Passes by energy, from each the two sides of which were not joined below it.
    pub passes: Vec<RigidPass>,
    /// Wells and passes of the sampled states that could not be made exact.
    pub lost: usize,
    /// Places beyond which the folded states go on, or may, and were not sampled: wells and passes may lie there.
    pub open: usize,
}

/// Why there is no landscape of this kind.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum RigidError {
    #[error("the rigid states have {dimension} dimensions: wells are counted on curves and surfaces only")]
    Dimension { dimension: i64 },
    #[error("the rigid landscape is that of one cell, or of a small sheet, with creases and nothing else")]
    NotOfHinges,
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    #[error("{0}")]
    NoFolding(Negative),
    #[error("only {states} states of the rigid surface were covered: wells and passes may lie on the rest of it")]
    Partial { states: usize },
    #[error("interrupted")]
    Interrupted,
}

/// The landscape of a sheet. `go_on` returns false to stop.
///
/// # Errors
/// [`RigidError`] where the sheet has no surface or curve of rigidly folded states, or `go_on` returned false.
pub fn landscape(
    assembly: &Assembly,
    sampling: &Sampling,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<RigidLandscape, RigidError> {
    let (sheet, tiling) = (assembly.sheet(), assembly.tiling());
    let model = assembly.model(Gauge::Held);
    let springs = Springs::new(sheet, tiling, &model, assembly.drawn_angles()).ok_or(RigidError::NotOfHinges)?;
    let extent = Extent::new(&springs);
    let net = match assembly.domain() {
        Domain::Screw => match surface::net(assembly, (sampling, &extent), go_on) {
            Err(RigidError::Surface(SurfaceError::Curve)) => curves::net(assembly, (sampling, &extent), go_on)?,
            net => net?,
        },
        _ => curves::net(assembly, (sampling, &extent), go_on)?,
    };
    let options = surface::options(sampling);
    let lowest = |angles: &[f64], sign: f64| {
        FoldedSurface::lowest_on_crossing(assembly, &options, angles, &|angles| sign * springs.energy(angles))
    };
    let reach = NEIGHBOUR_DISTANCES * sampling.step;
    Ok(Sampled { springs: &springs, extent: &extent, net: &net, reach, lowest: &lowest }.polished())
}

/// A net, and what makes its states exact.
struct Sampled<'a> {
    springs: &'a Springs,
    extent: &'a Extent,
    net: &'a StateGraph,
    /// Largest distance of an exact state from a sampled one.
    reach: f64,
    /// The lowest state, for the sign 1, or the highest one, for the sign -1, near a state of the curve of spatially
    /// periodic states.
    lowest: &'a dyn Fn(&[f64], f64) -> Option<Lowest>,
}

impl Sampled<'_> {
    /// Wells and passes of the net, made exact.
    fn polished(&self) -> RigidLandscape {
        let (springs, net) = (self.springs, self.net);
        let energies: Vec<f64> = net.angles.iter().map(|angles| springs.energy(angles)).collect();
        let flood::Flood { minima, merges } = flood::flood(&energies, &net.links, &net.border);
        let (dimension, states) = (net.dimension, net.angles.len());
        let mut landscape = RigidLandscape { dimension, states, open: net.open, ..RigidLandscape::default() };
        // the well of each minimum; none where the landscape ends there, or where it is no well
        let mut well = vec![None; states];
        for &at in &minima {
            match self.well(at) {
                Some(found) => well[at] = Some(known(&mut landscape.wells, found)),
                // a curve ends there because a crease is shut
                None if net.border[at] => {
                    let touches = dimension == 1 && self.extent.excess(&net.angles[at]).abs() <= SAME_STATE_ANGLE_RAD;
                    landscape.contacts.extend(touches.then_some(energies[at]));
                }
                // where branches cross nothing is stationary: the state is the lowest of the samples only
                None => landscape.lost += usize::from(!net.singular[at] || at >= net.seam),
            }
        }
        // wells so near to where branches cross that no sample lies between
        for at in (0..states).filter(|&at| net.singular[at] && dimension == 1) {
            for found in net.beside(at).filter_map(|other| self.between([at, other])) {
                known(&mut landscape.wells, found);
            }
        }
        for Merge { lower, at } in merges {
            if let [Some(a), Some(b)] = lower.map(|minimum| well[minimum])
                && a != b
            {
                match self.pass(at) {
                    Some((angles, singular)) => {
                        let energy = springs.energy(&angles);
                        landscape.passes.push(RigidPass { joins: [a, b], energy, angles, singular });
                    }
                    None => landscape.lost += 1,
                }
            }
        }
        landscape.sort();
        landscape
    }

    /// The well at a minimum of the samples.
    fn well(&self, at: usize) -> Option<Stationary> {
        let net = self.net;
        self.well_on_seam(at).or_else(|| match net.seam {
            0 => None,
            _ if net.border[at] || net.singular[at] => net.beside(at).find_map(|other| self.between([at, other])),
            _ => self.exact(at, 0),
        })
    }

    /// The well on the curve on which surfaces cross, next to a state of it or beside it.
    fn well_on_seam(&self, at: usize) -> Option<Stationary> {
        let net = self.net;
        let mut on = [at].into_iter().chain(net.beside(at)).filter(|&at| at >= net.seam);
        let Lowest { angles, residual, error, well } = (self.lowest)(&net.angles[on.next()?], 1.0)?;
        let apart = distance(&angles, &net.angles[at]);
        let inside = self.extent.holds(&angles);
        let energy = self.springs.energy(&angles);
        let found = Stationary { angles, energy, negative_eigenvalues: 0, residual, error };
        (well && inside && apart <= self.reach).then_some(found)
    }

    /// The well between two neighbours, the first of which has no tangents or lies on the border.
    fn between(&self, ends: [usize; 2]) -> Option<Stationary> {
        let [here, there] = ends.map(|state| &self.net.angles[state]);
        let most = (1.0 + SAME_STATE_ANGLE_RAD) * distance(here, there);
        let found = self.springs.stationary(there)?;
        let inside = [here, there].iter().all(|end| distance(&found.angles, end) <= most);
        (found.negative_eigenvalues == 0 && inside && self.extent.holds(&found.angles)).then_some(found)
    }

    /// The stationary state of this index next to a sampled one.
    fn exact(&self, at: usize, index: usize) -> Option<Stationary> {
        let angles = &self.net.angles[at];
        let found = self.springs.stationary(angles)?;
        let near = distance(&found.angles, angles) <= self.reach;
        (found.negative_eigenvalues == index && near && self.extent.holds(&found.angles)).then_some(found)
    }

    /// The angles of the pass at a state, and whether it is singular.
    fn pass(&self, at: usize) -> Option<(Vec<f64>, bool)> {
        let angles = &self.net.angles[at];
        if at >= self.net.seam {
            // where two surfaces cross it is the lowest state of the curve, and on the curve alone the highest
            let (sign, singular) = if self.net.dimension == 2 { (1.0, true) } else { (-1.0, false) };
            return Some(((self.lowest)(angles, sign)?.angles, singular));
        }
        if self.net.singular[at] { Some((angles.clone(), true)) } else { Some((self.exact(at, 1)?.angles, false)) }
    }
}

impl StateGraph {
    /// Neighbours of a state.
    fn beside(&self, at: usize) -> impl Iterator<Item = usize> + '_ {
        self.links.iter().filter(move |link| link.contains(&at)).map(move |[a, b]| a + b - at)
    }
}

/// The number of a well, which is added where it is new.
fn known(wells: &mut Vec<Stationary>, found: Stationary) -> usize {
    let same = |well: &Stationary| are_close(&well.angles, &found.angles, SAME_STATE_ANGLE_RAD);
    wells.iter().position(same).unwrap_or_else(|| {
        wells.push(found);
        wells.len() - 1
    })
}

impl RigidLandscape {
    /// Wells and passes by energy.
    fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.wells.len()).collect();
        order.sort_by(|&a, &b| self.wells[a].energy.total_cmp(&self.wells[b].energy));
        let place = |old: usize| order.iter().position(|&well| well == old).unwrap_or(old);
        self.passes.iter_mut().for_each(|pass| pass.joins = pass.joins.map(place));
        self.wells = order.iter().map(|&well| self.wells[well].clone()).collect();
        self.passes.sort_by(|a, b| a.energy.total_cmp(&b.energy));
        self.contacts.sort_by(f64::total_cmp);
    }

    /// The lowest pass that has to be crossed between two wells; `None` where none joins them.
    pub fn between(&self, a: usize, b: usize) -> Option<&RigidPass> {
        let mut side: Vec<usize> = (0..self.wells.len()).collect();
        for pass in &self.passes {
            let [one, other] = pass.joins.map(|well| side[well]);
            side.iter_mut().filter(|side| **side == other).for_each(|side| *side = one);
            if side[a] == side[b] {
                return Some(pass);
            }
        }
        None
    }
}
