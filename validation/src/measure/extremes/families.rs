//! The families of extreme cases, each with a reference for its results.

use super::super::trial::{Trial, TrialVerdict, distance, judge, within};
use crate::findings::ExperimentError;
use crate::{library, star};
use foldwell::math::Vec3;
use foldwell::model::Boundary;
use foldwell::sheet::build::{self, Drawing};
use foldwell::sheet::generate::{MiuraPatch, Random};
use foldwell::sheet::{EdgeKind, Pattern, Sheet, fold, generate};
use std::f64::consts::{FRAC_PI_3, PI, TAU};

/// A trial that has not been run yet.
pub type Attempt = Box<dyn FnOnce() -> TrialVerdict>;
/// Name of a case, and its trial.
pub type Named = (String, Attempt);

const POWERS: [i32; 8] = [-150, -100, -60, -30, 30, 60, 100, 150];

/// A family of similar cases.
pub struct Family {
    /// Description of the extreme quantity.
    pub name: &'static str,
    /// Reference with which the results are compared.
    pub compared: &'static str,
    /// The cases.
    pub cases: Vec<Named>,
}

/// Returns all families; the largest patch is left out if `quick`.
pub fn families(quick: bool) -> Result<Vec<Family>, ExperimentError> {
    let cell = star::cell()?;
    Ok(vec![
        stiffness(&cell)?,
        both_stiffnesses(&cell)?,
        units(&cell)?,
        screw_units(&cell)?,
        stretched(&cell, "needles: 3 x 3 cells, drawn narrower", |a| Vec3::new(1.0, a, a)),
        stretched(&cell, "nearly flat: 3 x 3 cells, drawn lower", |a| Vec3::new(1.0, 1.0, a)),
        skewed(&cell),
        flat()?,
        folded()?,
        vertices()?,
        degrees()?,
        patches(&cell, quick),
    ])
}

fn case(name: impl Into<String>, attempt: impl FnOnce() -> TrialVerdict + 'static) -> Named {
    (name.into(), Box::new(attempt))
}

fn reference(trial: &Trial) -> Result<Vec<f64>, ExperimentError> {
    let found = trial.run().map_err(|_| ExperimentError::Other("the ordinary case does not converge".into()))?;
    match found.to_kinematic {
        Some(error) if error <= 1e-10 => Ok(found.angles),
        _ if trial.stiffness[0].is_finite() => Ok(found.angles),
        _ => Err(ExperimentError::Other("the ordinary case is not that of the exact kinematics".into())),
    }
}

/// Ratios of stiffnesses: the state differs from the rigid one by as much as one over the stiffness, and by more for
/// soft bars.
fn stiffness(cell: &Sheet) -> Result<Family, ExperimentError> {
    let trial = |k: f64| Trial { stiffness: [k, 1.0], ..Trial::rigid(cell.clone(), [3, 3], 0.1) };
    let exact = reference(&trial(f64::INFINITY))?;
    let scaled = 1e10 * distance(&reference(&trial(1e10))?, &exact);
    let ratios = [1.0, 1e2, 1e4, 1e6, 1e8, 1e10, 1e16, 1e50, 1e100, 1e200, 1e300, f64::INFINITY].into_iter();
    let cases = ratios.map(|k| {
        let (exact, trial) = (exact.clone(), trial(k));
        case(format!("{k:e}"), move || {
            judge(|found| {
                let off = distance(&found.angles, &exact);
                match k {
                    // from here on the law of one over the stiffness holds to a tenth
                    1e7.. => within((off - scaled / k).abs(), 0.1 * scaled / k + 1e-12),
                    // soft bars are compared with the augmented form
                    _ => found.to_augmented.map_or(TrialVerdict::Unjudged, |error| within(error, 1e-6)),
                }
            })(&trial)
        })
    });
    Ok(Family {
        name: "stiffness of bars over that of creases",
        compared: "the augmented form; from 1e7 on, one over k",
        cases: cases.collect(),
    })
}

/// Large and small stiffnesses at a constant ratio, on which alone the state depends.
fn both_stiffnesses(cell: &Sheet) -> Result<Family, ExperimentError> {
    let trial = |scale: f64| Trial { stiffness: [1e6 * scale, scale], ..Trial::rigid(cell.clone(), [3, 3], 0.1) };
    let expected = reference(&trial(1.0))?;
    let cases = POWERS.into_iter().chain([-290, 290]).map(|power| {
        let (expected, trial) = (expected.clone(), trial(10f64.powi(power)));
        case(format!("1e{power}"), move || trial.against(&expected, 1e-9))
    });
    Ok(Family { name: "both stiffnesses huge or tiny", compared: "the same at 1", cases: cases.collect() })
}

/// Units of length, on which fold angles do not depend.
fn units(cell: &Sheet) -> Result<Family, ExperimentError> {
    let expected = reference(&Trial::rigid(cell.clone(), [3, 3], 0.1))?;
    let cases = POWERS.into_iter().flat_map(|power| {
        [f64::INFINITY, 1e12].map(|bars| {
            let unit = 10f64.powi(power);
            let sheet = mapped(cell, |p| p * unit);
            let trial = Trial { stiffness: [bars, 1.0], ..Trial::rigid(sheet, [3, 3], 0.1) };
            let expected = expected.clone();
            case(format!("unit 1e{power}, bars {bars:e}"), move || trial.against(&expected, 1e-9))
        })
    });
    Ok(Family { name: "units of length", compared: "the same at 1", cases: cases.collect() })
}

/// Units of length of a screw-periodic cell. Curvature and direction of the axis are scaled to lengths, so that the
/// results do not depend on the unit here either.
fn screw_units(cell: &Sheet) -> Result<Family, ExperimentError> {
    let trial = |sheet: Sheet| Trial { boundary: Boundary::Screw, ..Trial::rigid(sheet, [1, 1], 0.1) };
    let expected = reference(&trial(cell.clone()))?;
    let cases = POWERS.into_iter().chain([-12, -3, 3, 12]).map(|power| {
        let unit = 10f64.powi(power);
        let (trial, expected) = (trial(mapped(cell, |p| p * unit)), expected.clone());
        case(format!("unit 1e{power}"), move || trial.against(&expected, 1e-9))
    });
    Ok(Family { name: "units of length, screw-periodic cell", compared: "the same at 1", cases: cases.collect() })
}

fn mapped(sheet: &Sheet, map: impl Fn(&Vec3) -> Vec3) -> Sheet {
    let mut sheet = sheet.clone();
    sheet.vertices = sheet.vertices.iter().map(&map).collect();
    sheet.lattice = sheet.lattice.map(|lattice| lattice.map(|vector| map(&vector)));
    sheet
}

fn stretched(cell: &Sheet, name: &'static str, factors: fn(f64) -> Vec3) -> Family {
    let cases = [1, 2, 3, 4, 6, 8, 10, 12, 15].map(|power| {
        let by = factors(10f64.powi(-power));
        let sheet = mapped(cell, |p| p.component_mul(&by));
        // both computations know the sector angles of needles to a rounding error divided by their width
        let allowed = f64::max(1e-6, 1e-15 * 10f64.powi(power));
        case(format!("1e-{power}"), move || Trial::rigid(sheet, [3, 3], 1e-3).judged(allowed))
    });
    Family { name, compared: "the exact kinematics", cases: cases.into() }
}

fn skewed(cell: &Sheet) -> Family {
    let cases = [1, 2, 3, 4, 6, 8].map(|power| {
        let by = 10f64.powi(power);
        let sheet = mapped(cell, |p| Vec3::new(p.x + by * p.y, p.y, p.z));
        case(format!("x + 1e{power} y"), move || Trial::rigid(sheet, [3, 3], 1e-3).judged(1e-6))
    });
    Family {
        name: "nearly singular lattices: 3 x 3 cells, sheared",
        compared: "the exact kinematics",
        cases: cases.into(),
    }
}

/// Flat cells, and cells so close to flat that double precision may not resolve the difference.
fn flat() -> Result<Family, ExperimentError> {
    let sheet = fold::read(&library::mesh("open-flat.fold"))?;
    let cases = [None, Some(300), Some(200), Some(100), Some(20), Some(10), Some(6)].map(|power| {
        let height = power.map_or(0.0, |power: i32| 10f64.powi(-power));
        let mut sheet = sheet.clone();
        let places = sheet.vertices.iter_mut().enumerate().skip(1);
        places.for_each(|(k, p)| p.z += height * (k as f64 * 0.618).fract());
        let name = power.map_or("flat".into(), |power| format!("1e-{power} from flat"));
        case(name, move || Trial::rigid(sheet, [2, 2], 0.1).judged(1e-6))
    });
    Ok(Family { name: "flat cells whose creases rest folded", compared: "the exact kinematics", cases: cases.into() })
}

/// Miura-ori, with its closed form `tan(straight/2) = cos(sector) tan(zigzag/2)`.
fn folded() -> Result<Family, ExperimentError> {
    let pattern = Pattern::MiuraPatch(MiuraPatch { cells: [2, 2], ..MiuraPatch::default() });
    let sheet = generate(&pattern).map_err(|_| ExperimentError::Other("Miura-ori cannot be generated".into()))?;
    let zigzag = |k: usize| {
        let [a, b] = sheet.edges[k].key.ends().map(|end| sheet.position(end));
        (a.x - b.x).abs() > 1e-9
    };
    let creases: Vec<usize> = (0..sheet.edges.len()).filter(|&k| sheet.edges[k].kind == EdgeKind::Crease).collect();
    let signs: Vec<f64> =
        sheet.edges.iter().map(|edge| sheet.drawn_angle(edge).map_or(f64::NAN, f64::signum)).collect();
    let lock = *creases.iter().find(|&&k| zigzag(k)).ok_or(ExperimentError::Other("Miura-ori has no zigzag".into()))?;
    let angles = [1e-12, 1e-6, 1e-3, 1e-2, 0.05, 0.2].map(|a| (format!("{a:e}"), a));
    let ends = [0.2, 0.05, 1e-2, 1e-3, 1e-6, 1e-12].map(|a| (format!("pi - {a:e}"), PI - a));
    let cases = angles.into_iter().chain(ends).map(|(name, angle)| {
        let straight = 2.0 * (FRAC_PI_3.cos() * (angle / 2.0).tan()).atan();
        let mut expected = vec![f64::NAN; sheet.edges.len()];
        creases.iter().for_each(|&k| expected[k] = signs[k] * if zigzag(k) { angle } else { straight });
        let lock = Some((lock, expected[lock]));
        let trial = Trial { lock, ..Trial::rigid(sheet.clone(), [1, 1], 0.0) };
        expected[lock.map_or(0, |(k, _)| k)] = f64::NAN; // a lock is not a hinge
        case(name, move || judge(|found| within(seen(&found.angles, &expected), 1e-6))(&trial))
    });
    Ok(Family {
        name: "Miura-ori driven nearly flat and nearly shut",
        compared: "its closed form",
        cases: cases.collect(),
    })
}

/// Returns the largest difference over the entries where both are numbers; NaN if there are none.
fn seen(angles: &[f64], expected: &[f64]) -> f64 {
    let both = angles.iter().zip(expected).map(|(a, b)| (a - b).abs()).filter(|off| !off.is_nan());
    both.reduce(f64::max).unwrap_or(f64::NAN)
}

fn vertices() -> Result<Family, ExperimentError> {
    let mut cases = Vec::new();
    for size in [[1, 3], [2, 2], [3, 3], [5, 5], [7, 7], [10, 10], [20, 20]] {
        let pattern = Pattern::Random(Random { size, seed: 2, ..Random::default() });
        let sheet =
            generate(&pattern).map_err(|_| ExperimentError::Other("a random cell cannot be generated".into()))?;
        let trial = Trial { boundary: Boundary::Screw, ..Trial::rigid(sheet, [1, 1], 0.02) };
        cases.push(case(format!("{} vertices", size[0] * size[1]), move || trial.judged(1e-9)));
    }
    Ok(Family { name: "vertices of a screw-periodic cell", compared: "the exact kinematics", cases })
}

/// Single vertices surrounded by triangles, with random heights of the outer vertices.
fn degrees() -> Result<Family, ExperimentError> {
    let mut cases = Vec::new();
    for degree in [3, 4, 5, 6, 8, 12, 20, 40] {
        let rim = (0..degree).map(|k| {
            let turn = TAU * k as f64 / degree as f64;
            Vec3::new(turn.cos(), turn.sin(), 0.4 * ((k + 1) as f64 * 0.618).fract())
        });
        let coords: Vec<Vec3> = [Vec3::zeros()].into_iter().chain(rim).collect();
        let faces = (0..degree).map(|k| vec![0, 1 + k, 1 + (k + 1) % degree]).collect();
        let drawn = Drawing { coords, faces, ..Drawing::default() };
        let sheet = build::build(&drawn).map_err(|_| ExperimentError::Other("a fan cannot be built".into()))?;
        cases.push(case(format!("{degree}"), move || Trial::rigid(sheet, [1, 1], 0.05).judged(1e-9)));
    }
    Ok(Family { name: "degree of a single vertex", compared: "the exact kinematics", cases })
}

fn patches(cell: &Sheet, quick: bool) -> Family {
    let sizes = [[1, 1], [1, 2], [1, 40], [2, 2], [5, 5], [20, 20]].into_iter();
    let sizes = sizes.chain((!quick).then_some([100, 100]));
    let cases = sizes.map(|cells| {
        let sheet = cell.clone();
        let off = if cells[0] * cells[1] > 100 { 1e-3 } else { 0.05 };
        case(format!("{} x {}", cells[0], cells[1]), move || Trial::rigid(sheet, cells, off).judged(1e-9))
    });
    Family { name: "cells of a patch", compared: "the exact kinematics, up to 300 edges", cases: cases.collect() }
}
