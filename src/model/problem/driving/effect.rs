//! The parts of a model that one parameter can drive.

use crate::model::drive::DriveError;
use crate::model::element::{Element, TermKind};
use crate::model::problem::Model;
use crate::solver::{HessianKind, Linearization, Problem};
use std::collections::BTreeMap;

/// Difference of two stiffnesses, relative to them, that counts as rounding.
const SAME_STIFFNESS: f64 = 1e-12;
/// Rate of an angle by displacements in units of length that counts as rounding.
const NO_RATE: f64 = 1e-9;
/// Difference of two rest values, relative to them, that counts as rounding.
const SAME_REST: f64 = 1e-9;

/// The parts of a model that can change with a parameter.
pub(super) enum Effect {
    /// Prescribed values of the stiff measures with these numbers: the parameter plus an offset for each.
    Prescribed(Vec<(usize, f64)>),
    /// The factor of loads.
    Loads {
        /// Whether the forces on vertices are among them.
        forces: bool,
        /// Displacement of the loads at the beginning.
        origin: f64,
        /// Soft elements that are faces under pressure, by number, with that for a factor of 1.
        pressures: Vec<(usize, f64)>,
    },
    /// Rest values between those of the drawn state and the given ones, for soft and stiff elements by number.
    Rest { drawn: Vec<f64>, given: Vec<f64> },
    /// Compliances of the stiff measures with these numbers, for a reciprocal stiffness of 1.
    Compliance(Vec<(usize, f64)>),
    /// Spring constants of the soft elements with these numbers, for a stiffness of 1.
    Stiffness(Vec<(usize, f64)>),
}

impl Effect {
    /// Fold angles of the locks on these edges, of which the first, returned too, is the parameter.
    pub(super) fn locks(model: &Model, edges: &[usize]) -> Result<(Self, f64), DriveError> {
        let is_meant = |lock: &Element<'_>| lock.edge().is_some_and(|edge| edges.contains(&edge));
        let locks: Vec<_> = model.stiff_of(TermKind::Locks).filter(|(_, lock)| is_meant(lock)).collect();
        let from = locks.first().map(|(_, lock)| lock.spring.rest).ok_or(DriveError::NotLocked)?;
        let mut at = Linearization::new(model.layout());
        model.linearize(&model.start(), &vec![0.0; model.compliance.len()], HessianKind::Full, &mut at);
        let moves = |k: usize| {
            // one vertex may be several corners of the hinge, by its images
            let mut rates = BTreeMap::new();
            let members = model.layout().stiff.members(k).iter().zip(&at.jacobian[model.layout().stiff.range(k)]);
            members.for_each(|(unknown, rate)| *rates.entry(unknown).or_insert(0.0) += rate);
            rates.values().any(|rate: &f64| rate.abs() > NO_RATE * at.sizes[k])
        };
        if !locks.iter().any(|(k, _)| moves(*k)) {
            return Err(DriveError::NoMotion);
        }
        Ok((Self::Prescribed(locks.iter().map(|(k, lock)| (*k, lock.spring.rest - from)).collect()), from))
    }

    /// Loads with the displacement that they have in the reference state.
    pub(super) fn loads(model: &Model, forces: bool, pressures: Vec<(usize, f64)>) -> Self {
        let origin = model.loaded_along(forces, &pressures, &model.base);
        Self::Loads { forces, origin, pressures }
    }

    /// Rest values as given, and those of the drawn state, from which some differ; locks and supports keep theirs.
    pub(super) fn rest(model: &Model, mut drawn: Vec<f64>) -> Result<Self, DriveError> {
        let given = model.rests();
        let locked = model.elements().map(|element| element.kind() == TermKind::Locks || element.is_load());
        let kept = locked.chain(model.supports.iter().map(|_| true));
        drawn.resize(given.len(), 0.0);
        kept.enumerate().filter(|(_, kept)| *kept).for_each(|(k, _)| drawn[k] = given[k]);
        let is_same = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME_REST * a.abs().max(b.abs());
        if drawn.iter().zip(&given).all(is_same) {
            return Err(DriveError::RestAsDrawn);
        }
        Ok(Self::Rest { drawn, given })
    }

    /// Returns the stiffness of all elements of a kind, with the parameter at the beginning and at the end.
    pub(super) fn stiffness(model: &Model, kind: TermKind, to: f64) -> Result<(Self, f64, f64), DriveError> {
        // stiffness over spring constant: EA = k L0 of a bar, k / L0 of a hinge
        let scale = |element: &Element<'_>| match kind {
            TermKind::Bars => element.spring.rest,
            _ => model.length_of(element).recip(),
        };
        let stiff: Vec<_> =
            model.stiff_of(kind).map(|(measure, found)| (measure, scale(&found), found.spring)).collect();
        let soft = model.soft().filter(|element| element.kind() == kind);
        let soft: Vec<_> = soft.map(|found| (found.number, scale(&found), found.spring)).collect();
        let all = stiff.iter().chain(&soft).map(|(_, scale, spring)| spring.stiffness * scale);
        let from = all.clone().next().ok_or(DriveError::NoTerm(kind))?;
        let is_first = |k: f64| k == from || (k - from).abs() <= SAME_STIFFNESS * from;
        let keeps = |element: &Element<'_>| element.remembers() || (element.has_law() && !stiff.is_empty());
        if model.soft().any(|element| element.kind() == kind && keeps(&element)) {
            return Err(DriveError::HasLaw(kind));
        }
        if !all.clone().all(is_first) || !(stiff.is_empty() || soft.is_empty()) {
            return Err(DriveError::NotUniform(kind));
        }
        if soft.is_empty() {
            let units = stiff.iter().map(|(measure, scale, _)| (*measure, *scale)).collect();
            return Ok((Self::Compliance(units), from.recip(), to.recip()));
        }
        if to.is_infinite() {
            return Err(DriveError::TooStiff(kind));
        }
        Ok((Self::Stiffness(soft.iter().map(|(number, scale, _)| (*number, scale.recip())).collect()), from, to))
    }
}
