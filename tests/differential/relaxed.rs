//! One relaxation, asked in two ways.

use crate::common::{self, Numbers, Testing};
use crate::report::{ELSEWHERE, Report, SAME};
use crate::trial::{Answer, Trial};
use foldwell::math::Vec3;
use foldwell::model::Gauge;
use foldwell::model::{Boundary, Terms};
use foldwell::solver::Options;
use nalgebra::Rotation3;

/// Steps of a relaxation that starts where another one ended at its rounding errors.
const FEW: usize = 4;

pub fn examine(seed: u64, trial: &Trial, report: &mut Report) {
    let what = format!("seed {seed}, {}", trial.describe());
    let answer = match trial.answer() {
        Ok(answer) => answer,
        Err(message) => {
            return report.unanswered("relaxed", &message);
        }
    };
    report.judge("relaxed", answer.energy.is_finite(), || what.clone());
    let apart = (answer.pictured - answer.energy).abs();
    report.judge("energies in the picture", apart <= 1e-12 * answer.energy, || format!("{what}: {}", answer.pictured));
    // the kinematics knows no stretch
    if let (Some(exact), true) = (answer.exact, trial.bars.is_infinite()) {
        report.judge("exact kinematics", exact <= 1e-7, || format!("{what}: off by {exact:e}"));
    }
    if answer.negative == Some(0) {
        // where rounding left more than the tolerance a few steps are tried again
        let most = if answer.residual <= Options::default().tolerance { 0 } else { FEW };
        let near = |(again, steps): &(f64, usize)| {
            (again - answer.energy).abs() <= SAME * answer.energy + 1e-13 + answer.open && *steps <= most
        };
        let ok = answer.again.as_ref().is_ok_and(near);
        report.judge("once more", ok, || format!("{what}: {:e} and {:?}", answer.energy, answer.again));
    }
    moved(trial, &answer, seed, report, &what);
    nested(trial, &answer, report, &what);
    nearly_rigid(trial, &answer, report, &what);
    eigenvalues(trial, report, &what);
}

/// Units, mirrored, elsewhere, turned, redrawn.
fn moved(trial: &Trial, answer: &Answer, seed: u64, report: &mut Report, what: &str) {
    let mut numbers = Numbers::new(seed + 1_000_000);
    for unit in [2.0, 1024.0, 1.0 / 1024.0, 0.9, 1000.0] {
        let what = format!("{what}, unit {unit}");
        let other = trial.in_unit(unit).answer().map(|answer| answer.mapped(|p| p / unit));
        report.compare("another unit", (trial, answer), &other, unit, &what);
    }
    let mirror = |p: Vec3| Vec3::new(p.x, p.y, -p.z);
    let mirrored = trial.mapped(mirror, mirror, -1.0).answer().map(|answer| answer.mapped(mirror));
    report.compare("mirrored", (trial, answer), &mirrored, 1.0, what);
    let far = Vec3::from_iterator(numbers.many(3, 3.0));
    let moved = trial.mapped(|p| p + far, |l| l, 1.0).answer().map(|answer| answer.mapped(|p| p - far));
    report.compare("elsewhere", (trial, answer), &moved, 1.0, what);
    let turn = Rotation3::new(Vec3::from_iterator(numbers.many(3, 2.0)));
    let turned = trial.mapped(|p| turn * p, |l| turn * l, 1.0).answer();
    let turned = turned.map(|answer| answer.mapped(|p| turn.inverse() * p));
    report.compare("turned", (trial, answer), &turned, 1.0, what);
    if trial.boundary == Boundary::Patch {
        return;
    }
    for (kind, basis) in
        [("renumbered", [[1, 0], [0, 1]]), ("another cell", [[1, 0], [1, 1]]), ("another cell", [[2, 1], [1, 1]])]
    {
        match trial.redrawn(&mut numbers, basis) {
            Some(other) => report.compare(kind, (trial, answer), &other.answer(), 1.0, &format!("{what}, {basis:?}")),
            None => report.count("not redrawn", false),
        }
    }
}

/// A sheet on a domain that leaves it more freedom costs no more: a patch of a screw, a screw of a torus, a free torus
/// of a fixed one. More cells of a torus cost no more than so many times one.
fn nested(trial: &Trial, answer: &Answer, report: &mut Report, what: &str) {
    use Boundary::{FixedTorus, FreeTorus, Patch, Screw};
    if !trial.loads.is_empty() || answer.negative != Some(0) {
        return;
    }
    let wider = match (trial.boundary, trial.cells) {
        (Screw, _) => vec![(Patch, [2, 2]), (Patch, [1, 1])],
        (FreeTorus, [1, 1]) => vec![(Screw, [1, 1]), (FreeTorus, [2, 1])],
        (FixedTorus, [1, 1]) => vec![(FreeTorus, [1, 1]), (FixedTorus, [1, 2])],
        (FixedTorus, cells) => vec![(FreeTorus, cells)],
        _ => return,
    };
    let one = answer.energy / (trial.cells[0] * trial.cells[1]) as f64;
    for (boundary, cells) in wider {
        let bound = one * (cells[0] * cells[1]) as f64;
        let trial = Trial { boundary, cells, ..trial.clone() };
        match trial.answer() {
            Ok(freer) => {
                let ok = freer.energy <= bound * (1.0 + SAME) + 1e-13;
                if !ok && (freer.negative != Some(0) || trial.has_equilibrium(|found, _| found <= bound * (1.0 + SAME)))
                {
                    report.count(ELSEWHERE, true);
                } else {
                    report.judge("more freedom", ok, || {
                        format!("{what}, {boundary:?} {cells:?}: {:e} above {bound:e}", freer.energy)
                    });
                }
            }
            Err(message) => report.unanswered("more freedom", &message),
        }
    }
}

/// The same with bars that are next to rigid. The energy falls with their compliance, by `t^2 / 2` of each, and
/// tensions fall with it: the energy is less than that of rigid bars by at least what they store, and at most what the
/// rigid bars' tensions would.
fn nearly_rigid(trial: &Trial, answer: &Answer, report: &mut Report, what: &str) {
    if trial.bars.is_finite() || answer.negative != Some(0) {
        return;
    }
    let softer = Trial { bars: 1e13, ..trial.clone() };
    let Ok(nearly) = softer.answer() else {
        return report.count("nearly rigid", false);
    };
    let stored = |halves: &[f64]| halves.iter().zip(&nearly.compliance).map(|(t, c)| t * c).sum::<f64>();
    let (least, most) = (stored(&nearly.halves), stored(&answer.halves));
    let agree = |rigid: (f64, &[f64]), nearly: (f64, &[f64])| {
        let (less, rounding) = (rigid.0 - nearly.0, SAME * rigid.0 + 1e-13);
        less >= 0.9 * stored(nearly.1) - rounding && less <= 1.1 * stored(rigid.1) + rounding
    };
    let (of_rigid, of_nearly) = ((answer.energy, &answer.halves[..]), (nearly.energy, &nearly.halves[..]));
    let is_close = agree(of_rigid, of_nearly);
    let apart = common::distance(&nearly.angles, &answer.angles);
    // a parallelogram may be split along either diagonal at the same cost
    let sizes = |angles: &[f64]| {
        let mut sizes: Vec<f64> = angles.iter().map(|angle| angle.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        sizes
    };
    let mirrored = apart > 1e-4 && common::distance(&sizes(&nearly.angles), &sizes(&answer.angles)) <= 1e-4;
    // a well of strained bars, which rigid ones do not have
    let strained = least > 0.5 * nearly.energy;
    let elsewhere = || {
        trial.starts_flat()
            && trial.has_minimum_at(&nearly.coordinates, |found, halves| agree((found, halves), of_nearly))
            || trial.has_equilibrium(|energy, halves| agree((energy, halves), of_nearly))
            || softer.has_equilibrium(|energy, halves| agree(of_rigid, (energy, halves)))
    };
    if strained || is_close && mirrored || !is_close && elsewhere() {
        return report.count(ELSEWHERE, true);
    }
    report.judge("nearly rigid", is_close, || {
        format!("{what}: {:e} and {:e}, less {least:e} to {most:e}", answer.energy, nearly.energy)
    });
    // next to singular states even such bars are soft
    if most <= SAME * answer.energy {
        report.judge("nearly rigid angles", apart <= 1e-4, || {
            format!("{what}: {apart:e}, energies {:e} less {:e}", answer.energy, answer.energy - nearly.energy)
        });
    }
}

/// Eigenvalues of the drawn state: the program's and those of a dense matrix by another library.
fn eigenvalues(trial: &Trial, report: &mut Report, what: &str) {
    if trial.bars.is_infinite()
        || trial.bars > 1e4
        || trial.facets.is_infinite()
        || trial.lock.is_some()
        || !trial.pins.is_empty()
    {
        return;
    }
    let case = trial.case();
    let terms = Terms { loads: vec![], ..Terms::bars_and_creases(trial.bars, 1.0, case.drawn_angles().to_vec()) };
    let terms = Terms { facets: trial.terms(&case).facets, ..terms };
    let model = case.model_of(&terms, Gauge::Free);
    let (mut hessian, units) = (common::energy_hessian(&model, &model.start()), model.units_of_length());
    for (k, unit) in units.into_iter().enumerate() {
        hessian.row_mut(k).scale_mut(unit);
        hessian.column_mut(k).scale_mut(unit);
    }
    let expected = common::eigenvalues(hessian);
    let Ok(found) = case.modes_of(&terms, 10) else { return report.count("eigenvalues", false) };
    // a lattice that is fixed holds the only vertex of a cell: then all vanish but for rounding errors of the bars'
    // stiffness
    let largest = expected.last().copied().unwrap_or(1.0).max(1e-2 * trial.bars);
    let off = found.eigenvalues.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    report.judge("eigenvalues", off <= 1e-12 * largest, || format!("{what}: off by {off:e} of {largest:e}"));
}
