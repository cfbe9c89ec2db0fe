//! The parts of a model that one parameter can drive.

use crate::model::drive::DriveError;
use crate::model::element::{Spring, TermKind};
use crate::model::problem::Model;

/// The parts of a model that can change with a parameter.
pub(super) enum Effect {
    /// Prescribed values of the stiff measures with these numbers: the parameter plus an offset for each.
    Prescribed(Vec<(usize, f64)>),
    /// The factor of the loads.
    Loads {
        /// Displacement of the loads at the beginning.
        origin: f64,
    },
    /// Rest values between those of the drawn state and the given ones, for soft and stiff elements by number.
    Rest { drawn: Vec<f64>, given: Vec<f64> },
    /// Compliances of the stiff measures with these numbers, for a reciprocal stiffness of 1.
    Compliance(Vec<(usize, f64)>),
    /// Spring constants of the soft elements with these numbers, for a stiffness of 1.
    Stiffness(Vec<(usize, f64)>),
}

impl Effect {
    pub(super) fn prescribed(model: &Model, measures: std::ops::Range<usize>) -> Self {
        let first = model.compliance.len() - model.supports.len();
        Self::Prescribed(measures.map(|k| (k, model.supports[k - first].rest)).collect())
    }

    /// Rest values as given, and those of the drawn state; locks and supports keep theirs.
    pub(super) fn rest(model: &Model, mut drawn: Vec<f64>) -> Self {
        let given = model.rests();
        let kinds = model.terms().flat_map(|term| (0..term.len()).map(|_| term.kind()));
        let kept = kinds.map(|kind| kind == TermKind::Locks).chain(model.supports.iter().map(|_| true));
        drawn.resize(given.len(), 0.0);
        kept.enumerate().filter(|(_, kept)| *kept).for_each(|(k, _)| drawn[k] = given[k]);
        Self::Rest { drawn, given }
    }

    pub(super) fn stiffness(model: &Model, kind: TermKind, to: f64) -> Result<(Self, f64, f64), DriveError> {
        let stiff = model.numbered_stiff(kind, |_| true);
        let mut soft = vec![];
        for (number, (term, k)) in
            model.soft.iter().flat_map(|term| (0..term.len()).map(move |k| (term, k))).enumerate()
        {
            if term.kind() == kind {
                soft.push((number, term.spring(k).stiffness / model.length_of(term.as_ref(), k)));
            }
        }
        let lengths = |numbers: &[(usize, Spring)]| -> Vec<f64> {
            numbers.iter().map(|(k, _)| model.length_of_stiff(*k)).collect()
        };
        match (&stiff[..], &soft[..]) {
            ([], []) => Err(DriveError::NoTerm(kind)),
            (stiff, []) => {
                let lengths = lengths(stiff);
                let of = |k: usize| match kind {
                    TermKind::Bars => stiff[k].1.stiffness * stiff[k].1.rest,
                    _ => stiff[k].1.stiffness / lengths[k],
                };
                let from = of(0);
                if (1..stiff.len()).any(|k| of(k) != from && !((of(k) - from).abs() <= 1e-12 * from)) {
                    return Err(DriveError::NotUniform(kind));
                }
                // a bar of stiffness EA has the compliance L0 / EA, a hinge 1 / (stiffness L0)
                let unit = |k: usize| if kind == TermKind::Bars { stiff[k].1.rest } else { 1.0 / lengths[k] };
                let units = (0..stiff.len()).map(|k| (stiff[k].0, unit(k))).collect();
                Ok((Self::Compliance(units), from.recip(), to.recip()))
            }
            ([], soft) => {
                let from = soft[0].1;
                if soft.iter().any(|(_, k)| !((k - from).abs() <= 1e-12 * from)) || to.is_infinite() {
                    return Err(if to.is_infinite() {
                        DriveError::TooStiff(kind)
                    } else {
                        DriveError::NotUniform(kind)
                    });
                }
                let terms = model.soft.iter().flat_map(|term| (0..term.len()).map(move |k| (term, k))).enumerate();
                let of_kind = terms.filter(|(_, (term, _))| term.kind() == kind);
                let units = of_kind.map(|(n, (term, k))| (n, model.length_of(term.as_ref(), k))).collect();
                Ok((Self::Stiffness(units), from, to))
            }
            _ => Err(DriveError::NotUniform(kind)),
        }
    }
}
