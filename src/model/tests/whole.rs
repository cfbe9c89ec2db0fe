//! Tests of the whole model on every domain: gradient, Jacobian and Hessian against its own energy and gaps.

use super::RandomNumbers;
use crate::math::Vec3;
use crate::model::{Assembly, Boundary, Gauge, Hinges, Laws, Model, OfStrain, Ogden, RIGID, Stiffening, Terms};
use crate::numerics::dense;
use crate::numerics::derivatives::{TOLERANCE, check_gradient, check_jacobian};
use crate::sheet::generate::{Miura, MiuraPatch, Pattern};
use crate::sheet::{EdgeKind, generate};
use crate::solver::{HessianKind, Linearization, Problem};

/// Miura-ori with the given boundary conditions: the smallest tiling that has creases and facets.
fn sheet(boundary: Boundary) -> Assembly {
    let pattern = match boundary {
        Boundary::Patch => Pattern::MiuraPatch(MiuraPatch { cells: [1, 1], fold: 0.4, ..MiuraPatch::default() }),
        _ => Pattern::Miura(Miura { fold: 0.4, ..Miura::default() }),
    };
    let sheet = generate(&pattern).unwrap();
    let cells = if boundary == Boundary::FreeTorus { [2, 1] } else { [1, 1] };
    Assembly::without_terms(sheet, cells, boundary).unwrap()
}

/// Terms with bars, creases, facets and two locks, and on a patch a pin and loads.
fn terms(assembly: &Assembly, numbers: &mut RandomNumbers, creases: f64, facets: f64) -> Terms {
    let (tiling, angles) = (assembly.tiling(), assembly.drawn_angles());
    let rest: Vec<f64> = angles.iter().map(|angle| angle + numbers.within(0.2)).collect();
    let hinges = |stiffness: f64| Some(Hinges { stiffness: stiffness.into(), rest: rest.clone() });
    let folding = (0..tiling.edges.len()).filter(|&e| tiling.edges[e].kind == EdgeKind::Crease);
    let patch = !tiling.periodic;
    Terms {
        bars: Some(30.0f64.into()),
        creases: hinges(creases),
        facets: hinges(facets),
        locks: folding.take(2).map(|edge| (edge, angles[edge] + 0.1)).collect(),
        pins: if patch { vec![(4, [true, false, true])] } else { vec![] },
        loads: if patch { vec![(0, Vec3::new(0.1, 0.2, -0.3)), (8, Vec3::new(-0.1, -0.2, 0.3))] } else { vec![] },
        guides: if patch { vec![(2, Vec3::new(0.6, 0.0, 0.8))] } else { vec![] },
        parts: vec![],
        mass: None,
        ..Terms::default()
    }
}

/// Laws of bars, creases and facets, whose limits lie among the angles of the states that are looked at.
fn laws() -> Laws {
    Laws {
        bars: Some(OfStrain(Ogden { exponents: [5.0, 1.0] }).into()),
        creases: Some(Stiffening { limits: [-0.3, 0.9] }.into()),
        facets: Some(Stiffening { limits: [-0.01, 0.01] }.into()),
    }
}

fn linearized(model: &Model, x: &[f64], tension: &[f64], kind: HessianKind) -> Linearization {
    let mut at = Linearization::new(model.layout());
    model.linearize(x, tension, kind, &mut at);
    at
}

pub(super) fn check(model: &mut Model, numbers: &mut RandomNumbers, what: &str) {
    let x: Vec<f64> = model.start().iter().map(|x| x + numbers.within(0.05)).collect();
    // the sizes of a screw's unknowns belong to this state
    let x = model.start_from(model.coordinates(&x));
    let model = &*model;
    let rows = model.layout().stiff.len();
    let tension = numbers.many(rows, 1.0);
    let at = linearized(model, &x, &tension, HessianKind::Full);
    let energy = |x: &[f64]| model.energy(x);
    assert!((at.energy - energy(&x)).abs() <= 1e-14 * at.energy.abs(), "{what}: two functions, one energy");
    check_gradient(energy, &x, &at.gradient, TOLERANCE).unwrap_or_else(|e| panic!("{what}, gradient: {e}"));
    let gaps = |x: &[f64]| model.gaps(x);
    assert_eq!(at.gaps, gaps(&x), "{what}: two functions, one gap");
    let jacobian = dense::from_rows(&at.rows(), model.layout().unknowns);
    check_jacobian(gaps, &x, &jacobian, TOLERANCE).unwrap_or_else(|e| panic!("{what}, Jacobian: {e}"));
    let pull = |x: &[f64]| {
        let at = linearized(model, x, &tension, HessianKind::Full);
        at.force(&tension).iter().map(|f| -f).collect()
    };
    let hessian = at.pattern().to_dense(&at.hessian);
    check_jacobian(pull, &x, &hessian, TOLERANCE).unwrap_or_else(|e| panic!("{what}, Hessian: {e}"));
}

/// Claim: on every domain, with held or free coordinates, with soft hinges and with hinges that carry tensions, the
/// gradient is the derivative of the energy, the Jacobian that of the gaps, and the Hessian that of gradient plus
/// tensions. Source: extrapolated differences.
#[test]
fn derivatives_on_every_domain() {
    use Boundary::{FixedTorus, FreeTorus, Patch, Screw};
    for boundary in [Patch, FixedTorus, FreeTorus, Screw] {
        let assembly = sheet(boundary);
        for (creases, facets) in [(1.0, 3.0), (1.0, f64::INFINITY), (1e7f64, 1.0)] {
            for (gauge, laws) in
                [Gauge::Held, Gauge::Free].into_iter().flat_map(|gauge| [(gauge, Laws::default()), (gauge, laws())])
            {
                let mut numbers = RandomNumbers::new(7);
                // what a law stores beyond a much stiffer spring is too large for differences
                let creases = if laws.first().is_some() { creases.min(2e4) } else { creases };
                let terms = Terms { laws: laws.clone(), ..terms(&assembly, &mut numbers, creases, facets) };
                let mut model = assembly.with_terms(terms).model(gauge);
                let what = format!("{boundary:?}, {gauge:?}, creases {creases:e}, facets {facets:e}, {laws:?}");
                check(&mut model, &mut numbers, &what);
            }
        }
    }
}

/// Claim: the same holds for a curved screw, whose kappa is moved from the drawn 0 so far that cells rotate visibly.
#[test]
fn derivatives_on_a_curved_screw() {
    let assembly = sheet(Boundary::Screw);
    for kappa in [1e-9, 0.2, -0.6] {
        let mut curved = assembly.drawn().coordinates.clone();
        let shared = curved.len() - 5;
        curved[shared] = kappa;
        let mut numbers = RandomNumbers::new(8);
        let terms = terms(&assembly, &mut numbers, 1.0, 3.0);
        let mut model = assembly.with_terms(terms).model(Gauge::Held);
        model.rebase_gauge(curved);
        check(&mut model, &mut numbers, &format!("kappa {kappa:e}"));
    }
}

/// Claim: with rest angles equal to those of the state, the Gauss-Newton Hessian is the full Hessian, since it is the
/// sum of `k g g^T` over the soft hinges plus the part of the tensions, which are zero here. Tolerance: rounding.
#[test]
fn gauss_newton_is_exact_at_rest() {
    let assembly = sheet(Boundary::FreeTorus);
    let terms = Terms::bars_and_creases(1.0, 2.0, assembly.drawn_angles().to_vec());
    let model = assembly.with_terms(terms).model(Gauge::Free);
    let none = vec![0.0; model.layout().stiff.len()];
    let full = linearized(&model, &model.start(), &none, HessianKind::Full);
    let half = linearized(&model, &model.start(), &none, HessianKind::GaussNewton);
    assert!(full.hessian.iter().zip(&half.hessian).all(|(a, b)| (a - b).abs() < 1e-13));
    assert!(full.hessian.iter().any(|h| *h > 1.0));
    let mut metric = vec![0.0; half.hessian.len()];
    half.add_metric(1.0, &mut metric);
    assert_eq!(metric, half.hessian);
}

/// Claim: gaps of bars are relative to the mean edge and gaps of hinges in radians; forces are relative to that of
/// the most loaded element, but at least to that of a hinge that is off by a milliradian, so that a sheet at rest has
/// a unit too. With all rest angles off by the same angle, the unit does not change below a milliradian, and at 0.1
/// rad it is a hundred times as large. Tolerance: rounding, of a difference of angles where the unit depends on them.
#[test]
fn residuals_have_their_units() {
    let oblong = MiuraPatch { cells: [1, 1], fold: 0.4, a: 1.5, ..MiuraPatch::default() };
    let sheet = generate(&Pattern::MiuraPatch(oblong)).unwrap();
    let assembly = Assembly::without_terms(sheet, [1, 1], Boundary::Patch).unwrap();
    let tiling = assembly.tiling();
    let model_with_rest = |off: f64| {
        let rest: Vec<f64> = assembly.drawn_angles().iter().map(|angle| angle + off).collect();
        let hinges = |stiffness: f64| Some(Hinges { stiffness: stiffness.into(), rest: rest.clone() });
        let (creases, facets) = (hinges(2.0), hinges(RIGID));
        let terms = Terms { bars: Some(RIGID.into()), creases, facets, ..Terms::default() };
        assembly.with_terms(terms).model(Gauge::Held)
    };
    let unit = |off: f64| {
        let model = model_with_rest(off);
        linearized(&model, &model.start(), &vec![0.0; model.layout().stiff.len()], HessianKind::Full).largest_force
    };
    let least = unit(0.0);
    assert!(least > 1e-4);
    for (off, expected) in [(1e-9, 1.0), (-1e-3, 1.0), (0.1, 100.0)] {
        assert!((unit(off) / least / expected - 1.0).abs() < 1e-11, "{off}: {} of {least}", unit(off));
    }
    let position = |site: crate::model::Site| tiling.positions[site.vertex];
    let lengths = tiling.edges.iter().map(|edge| (position(edge.ends[0]) - position(edge.ends[1])).norm());
    let mean = lengths.sum::<f64>() / tiling.edges.len() as f64;
    let model = model_with_rest(0.0);
    let (bars, hinges) = model.gap_scale().split_at(tiling.edges.len());
    assert!((mean - 1.0).abs() > 1e-3 && bars.iter().all(|scale| (scale / mean - 1.0).abs() < 1e-14), "{bars:?}");
    assert!(!hinges.is_empty() && hinges.iter().all(|scale| *scale == 1.0));
}
