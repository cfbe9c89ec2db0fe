//! The number of negative eigenvalues on what rigid measures leave free, counted by the program and on a dense null
//! space.
//!
//! Random assemblies whose rigid rows nearly depend on each other: strips, columns, prisms, drums, rolled-up tubes,
//! pins that are nearly on a line, rigid parts and locks, drawn or disturbed, under loads from none to half as much
//! again as the first critical one, and just below and above that. The dense count knows nothing of the program but its
//! derivatives: singular values and eigenvalues are those of nalgebra. It has no opinion where a singular value is
//! neither rounding error nor clearly above it, or where an eigenvalue is within rounding errors of zero.

use crate::common::{Numbers, Testing, jacobian, linearized, mesh, on};
use crate::report::Report;
use foldwell::analysis::relax::relax_from;
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Boundary, Gauge, Hinges, Model, Part, Terms};
use foldwell::numerics::DenseMatrix;
use foldwell::sheet::build::{Drawing, build};
use foldwell::sheet::generate::{Kresling, Random};
use foldwell::sheet::{EdgeKind, Pattern, SeamKept, Sheet, generate};
use foldwell::solver::{HessianKind, Linearization, Options, Problem, Tangent};
use foldwell::{RIGID, rolled_up};
use std::f64::consts::TAU;

/// Comparisons of counts, and those in which the program or the dense count has no opinion.
pub const COUNTED: &str = "negative eigenvalues";
pub const UNKNOWN: &str = "negative eigenvalues not known to the program";
/// Comparisons for each one in which the program does not know.
pub const MOST_UNKNOWN: usize = 50;
pub const UNSTABLE: &str = "of these unstable";
const UNDECIDED: &str = "negative eigenvalues within rounding errors of the dense count";

/// Singular values relative to the largest one between which nobody can tell whether they are zero.
const DOUBTFUL: std::ops::Range<f64> = 1e-12..1e-9;
/// Rounding errors of eigenvalues relative to the largest entry, and of motions relative to the smallest singular
/// value.
const ROUNDING: [f64; 2] = [1e-12, 1e-14];
/// Loads over the first critical one besides a random one.
const NEAR_CRITICAL: [f64; 2] = [1.0 - 1e-3, 1.0 + 1e-3];
/// Largest random load over the first critical one.
const LARGEST_LOAD: f64 = 1.5;
/// Stiffnesses of bars and facets; creases have 1.
const STIFFNESS: [f64; 4] = [1e3, 1e6, 1e8, RIGID];

/// A sheet with terms, and how it was made.
struct Case {
    what: String,
    assembly: Assembly,
}

/// One random assembly, at three loads and relaxed under the first.
pub fn examine(seed: u64, report: &mut Report) {
    let mut numbers = Numbers::new(seed);
    let case = Case::new(&mut numbers);
    let what = format!("seed {seed}, {}", case.what);
    let mut model = case.assembly.model(Gauge::Held);
    let mut x = model.start();
    if numbers.within(1.0) > 0.0 {
        let size = 10f64.powf(-4.0 + numbers.within(2.0));
        x.iter_mut().for_each(|x| *x += numbers.within(size));
    }
    let Some(tension) = tensions(&model, &x, &mut numbers) else {
        return report.unanswered(COUNTED, "the loads cannot be carried");
    };
    let dense = Projection::new(&model, &x);
    let critical = dense.first_critical(&model, &x, &tension).unwrap_or(1.0);
    let some = LARGEST_LOAD * (0.5 + numbers.within(0.5));
    for load in [some].into_iter().chain(NEAR_CRITICAL) {
        let tension: Vec<f64> = tension.iter().map(|t| load * critical * t).collect();
        let mut tangent = Tangent::at_state(&model, &x, &tension, HessianKind::Full).unwrap();
        let counted = tangent.negative_eigenvalues().unwrap();
        judge(report, counted, (&dense, &tangent.at), &format!("{what}, load {load}"));
    }
    if case.assembly.terms().loads.is_empty() {
        return;
    }
    let mut terms = case.assembly.terms().clone();
    terms.loads.iter_mut().for_each(|(_, force)| *force *= some * critical);
    model = case.assembly.with_terms(terms).model(Gauge::Held);
    x = model.start();
    match relax_from(&model, x, Options::default(), &mut |_| true) {
        Ok(found) => {
            let x = model.enter(&found.configuration).x;
            let at = linearized(&model, &x, found.configuration.tensions());
            let dense = Projection::new(&model, &x);
            judge(report, found.negative_eigenvalues, (&dense, &at), &format!("{what}, relaxed at load {some}"));
        }
        Err(error) => report.unanswered("relaxed under load", &error.to_string()),
    }
}

/// A number is right, or not given.
fn judge(report: &mut Report, counted: Option<usize>, (dense, at): (&Projection, &Linearization), what: &str) {
    let Some(expected) = dense.count(at, 0.0) else { return report.count(UNDECIDED, true) };
    let Some(counted) = counted else { return report.count(UNKNOWN, true) };
    if expected > 0 {
        report.count(UNSTABLE, true);
    }
    report.judge(COUNTED, counted == expected, || {
        let (size, shift) = (at.pattern().to_dense(&at.hessian).amax(), dense.shift(at, counted));
        format!("{what}: counted {counted}, dense {expected}, which a shift of {shift:e} makes up, Hessian {size:e}")
    });
}

/// Tensions that carry the loads at a state, to first order; random ones where there are no loads.
fn tensions(model: &Model, x: &[f64], numbers: &mut Numbers) -> Option<Vec<f64>> {
    let none = vec![0.0; model.compliance().len()];
    let mut tangent = Tangent::at_state(model, x, &none, HessianKind::Full).ok()?;
    if tangent.at.gradient.iter().all(|force| force.abs() < 1e-9) {
        return Some(numbers.many(none.len(), 1.0));
    }
    tangent.factor(0.0).ok()?;
    let force: Vec<f64> = tangent.at.gradient.iter().map(|slope| -slope).collect();
    let found = tangent.solve(&force, &none, 1e-10);
    (found.residual <= 1e-6).then_some(found.dt)
}

/// Motions that rigid measures leave free at a state, and the finite measures along them.
struct Projection {
    /// Orthonormal motions, in columns; `None` where their number is in doubt.
    free: Option<DenseMatrix>,
    /// Gradients of the finite measures along them, and their compliances, in natural sizes.
    rows: DenseMatrix,
    compliance: Vec<f64>,
    /// Errors of eigenvalues relative to the largest entry of the Hessian.
    error: f64,
}

impl Projection {
    fn new(model: &Model, x: &[f64]) -> Self {
        let at = linearized(model, x, &vec![0.0; model.compliance().len()]);
        let mut rows = jacobian(model, &at);
        let unknowns = rows.ncols();
        rows.row_iter_mut().zip(&at.sizes).for_each(|(mut row, size)| row /= *size);
        let natural: Vec<f64> = model.compliance().iter().zip(&at.sizes).map(|(c, size)| c / (size * size)).collect();
        let (rigid, finite): (Vec<usize>, Vec<usize>) = (0..natural.len()).partition(|&row| natural[row] == 0.0);
        let compliance = finite.iter().map(|&row| natural[row]).collect();
        let finite = rows.select_rows(&finite);
        if rigid.is_empty() {
            let free = Some(DenseMatrix::identity(unknowns, unknowns));
            return Self { free, rows: finite, compliance, error: ROUNDING[0] };
        }
        // a matrix with as many rows as columns has all right singular vectors
        let mut square = DenseMatrix::zeros(rigid.len().max(unknowns), unknowns);
        square.rows_mut(0, rigid.len()).copy_from(&rows.select_rows(&rigid));
        let found = square.svd(false, true);
        let relative = &found.singular_values / found.singular_values.amax();
        let null: Vec<usize> = (0..unknowns).filter(|&k| relative[k] < DOUBTFUL.start).collect();
        let least = relative.iter().copied().filter(|value| *value >= DOUBTFUL.start).fold(1.0, f64::min);
        let free = found.v_t.unwrap().select_rows(&null).transpose();
        let rows = finite * &free;
        let doubtful = relative.iter().any(|value| DOUBTFUL.contains(value));
        let error = ROUNDING[0].max(ROUNDING[1] / least);
        Self { free: (!doubtful).then_some(free), rows, compliance, error }
    }

    /// Number of negative eigenvalues. Finite measures keep their tensions as unknowns, of which each adds one: the
    /// matrix has the rows `[H, R^T], [R, -C]`, in units in which the largest entry of the Hessian is 1. A multiple of
    /// the identity is added to the Hessian.
    fn count(&self, at: &Linearization, shift: f64) -> Option<usize> {
        let free = self.free.as_ref()?;
        let mut hessian = at.pattern().to_dense(&at.hessian);
        (0..hessian.nrows()).for_each(|k| hessian[(k, k)] += shift);
        let size = hessian.amax();
        let (motions, tensions) = (free.ncols(), self.compliance.len());
        let mut whole = DenseMatrix::zeros(motions + tensions, motions + tensions);
        whole.view_mut((0, 0), (motions, motions)).copy_from(&(free.transpose() * (hessian / size) * free));
        whole.view_mut((motions, 0), (tensions, motions)).copy_from(&self.rows);
        whole.view_mut((0, motions), (motions, tensions)).copy_from(&self.rows.transpose());
        for (k, c) in self.compliance.iter().enumerate() {
            whole[(motions + k, motions + k)] = -c * size;
        }
        if whole.is_empty() {
            return Some(0);
        }
        let values = whole.symmetric_eigenvalues();
        let decided = values.iter().all(|value| value.abs() > self.error);
        decided.then(|| values.iter().filter(|value| **value < 0.0).count() - tensions)
    }

    /// The smallest multiple of the identity, to a factor of two, with which the Hessian has so many negative
    /// eigenvalues.
    fn shift(&self, at: &Linearization, wanted: usize) -> f64 {
        let fits = |shift: &f64| self.count(at, *shift) == Some(wanted);
        let sizes = (-60..20).map(|k| 2f64.powi(k)).flat_map(|size| [size, -size]);
        sizes.into_iter().find(fits).unwrap_or(f64::NAN)
    }

    /// Factor of tensions at which the least eigenvalue is first zero; `None` where there is none, or the state is
    /// unstable without tensions. Finite stiffnesses enter with their multiples: rounding errors of a load do not
    /// matter.
    fn first_critical(&self, model: &Model, x: &[f64], tension: &[f64]) -> Option<f64> {
        let free = self.free.as_ref().filter(|free| !free.is_empty())?;
        let projected = |tension: &[f64]| {
            let at = linearized(model, x, tension);
            free.transpose() * at.pattern().to_dense(&at.hessian) * free
        };
        let (without, with) = (projected(&vec![0.0; tension.len()]), projected(tension));
        let difference = &with - &without;
        let mut stiff = self.rows.clone();
        stiff.row_iter_mut().zip(&self.compliance).for_each(|(mut row, c)| row /= c.sqrt());
        let lower = (without + stiff.tr_mul(&stiff)).cholesky()?.l();
        let half = lower.solve_lower_triangular(&difference)?;
        let both = lower.solve_lower_triangular(&half.transpose())?;
        let least = (0.5 * (&both + both.transpose())).symmetric_eigenvalues().min();
        (least < -1e-12).then_some(-1.0 / least)
    }
}

impl Case {
    fn new(numbers: &mut Numbers) -> Self {
        let mut pick = |n: usize| ((numbers.within(0.5) + 0.5) * n as f64) as usize % n;
        let (kind, bars, facets) = (pick(8), STIFFNESS[pick(4)], STIFFNESS[pick(4)]);
        let (name, assembly) = match kind {
            0 => ("column", column(numbers)),
            1 => ("strip", cantilever(numbers)),
            2 => ("prism", prism(numbers)),
            3 => ("drum", drum(numbers)),
            4 => ("rolled-up tube", tube(numbers)),
            5 => ("pins nearly on a line", hung(numbers)),
            6 => ("column between rigid parts", between_parts(numbers)),
            _ => ("locked column", locked(numbers)),
        };
        let drawn = assembly.start_angles().to_vec();
        let given = assembly.terms().clone();
        let facet_terms = assembly.facets(facets).filter(|_| assembly.count(EdgeKind::Facet) > 0);
        let facet_terms = facet_terms.map(|hinges| Hinges { rest: drawn.clone(), ..hinges });
        let Terms { locks, pins, loads, guides, parts, .. } = given;
        let terms = Terms {
            facets: facet_terms,
            locks,
            pins,
            loads,
            guides,
            parts,
            ..Terms::bars_and_creases(bars, 1.0, drawn)
        };
        let assembly = assembly.with_terms(terms);
        let unknowns = assembly.model(Gauge::Held).layout().unknowns;
        Self { what: format!("{name}, {unknowns} unknowns, bars {bars:e}, facets {facets:e}"), assembly }
    }
}

/// A whole number from `least` up to, not including, `end`.
fn whole(numbers: &mut Numbers, least: usize, end: usize) -> usize {
    least + ((numbers.within(0.5) + 0.5) * (end - least) as f64) as usize % (end - least)
}

/// A finite sheet of these faces.
fn finite(title: &str, coords: Vec<Vec3>, faces: Vec<Vec<usize>>) -> Sheet {
    build(&Drawing { title: title.to_owned(), coords, faces, ..Drawing::default() }).unwrap()
}

/// A straight strip of rectangles of one random shape, in the plane, along x.
fn strip(numbers: &mut Numbers) -> (Assembly, usize) {
    let (rectangles, length) = (whole(numbers, 3, 36), 0.6 + numbers.within(0.3));
    let coords = (0..=rectangles).flat_map(|k| [0.0, 1.0].map(|y| Vec3::new(length * k as f64, y, 0.0))).collect();
    let faces = (0..rectangles).map(|k| [0, 2, 3, 1].map(|corner| 2 * k + corner).to_vec()).collect();
    (on(finite("strip", coords, faces), [1, 1], Boundary::Patch), 2 * rectangles)
}

/// A strip hinged at both ends, and pressed.
fn column(numbers: &mut Numbers) -> Assembly {
    let (case, last) = strip(numbers);
    let pins = [0, 1].map(|v| (v, [true; 3])).into_iter().chain([last, last + 1].map(|v| (v, [false, true, true])));
    let loads = [last, last + 1].map(|v| (v, Vec3::new(-0.5, 0.0, 0.0))).to_vec();
    let terms = Terms { pins: pins.collect(), loads, ..Terms::default() };
    case.with_terms(terms)
}

/// A column in which one hinge keeps its angle.
fn locked(numbers: &mut Numbers) -> Assembly {
    let column = column(numbers);
    let creases: Vec<usize> =
        (0..column.edges()).filter(|&k| column.tiling().edges[k].kind == EdgeKind::Crease).collect();
    let locked = creases[whole(numbers, 0, creases.len())];
    let locks = vec![(locked, column.drawn_angles()[locked])];
    column.with_terms(Terms { locks, ..column.terms().clone() })
}

/// A strip clamped at one end, and pressed at the other, nearly along its length.
fn cantilever(numbers: &mut Numbers) -> Assembly {
    let (case, last) = strip(numbers);
    let pins = (0..4).map(|v| (v, [true; 3])).collect();
    let aside = numbers.within(0.1);
    let loads = [last, last + 1].map(|v| (v, Vec3::new(-0.5, 0.0, aside))).to_vec();
    case.with_terms(Terms { pins, loads, ..Terms::default() })
}

/// A column whose ends are rigid bodies, the lower one held, the upper one free along the axis and in some other ways.
fn between_parts(numbers: &mut Numbers) -> Assembly {
    let (case, last) = strip(numbers);
    let body = |first: usize, free| Part { vertices: (first..first + 4).collect(), free };
    let others: Vec<bool> = (0..5).map(|_| numbers.within(1.0) > 0.5).collect();
    let parts =
        vec![body(0, [false; 6]), body(last - 2, [true, others[0], others[1], others[2], others[3], others[4]])];
    let loads = [last, last + 1].map(|v| (v, Vec3::new(-0.5, 0.0, 0.0))).to_vec();
    case.with_terms(Terms { parts, loads, ..Terms::default() })
}

/// A prism of rectangles, closed to a ring, its bottom pinned and its top pressed.
fn prism(numbers: &mut Numbers) -> Assembly {
    let (sides, storeys, height) = (whole(numbers, 3, 9), whole(numbers, 1, 8), 0.8 + numbers.within(0.4));
    let corner = |k: usize, j: usize| {
        let (sin, cos) = (TAU * k as f64 / sides as f64).sin_cos();
        Vec3::new(cos, sin, height * j as f64)
    };
    let coords = (0..=storeys).flat_map(|j| (0..sides).map(move |k| corner(k, j))).collect();
    let at = |k: usize, j: usize| j * sides + k % sides;
    let faces = (0..storeys)
        .flat_map(|j| (0..sides).map(move |k| vec![at(k, j), at(k + 1, j), at(k + 1, j + 1), at(k, j + 1)]))
        .collect();
    pressed_ring(finite("prism", coords, faces), sides)
}

/// Kresling's pattern with random twist, pressed.
fn drum(numbers: &mut Numbers) -> Assembly {
    let (sides, levels, height) = (whole(numbers, 3, 9), whole(numbers, 1, 8), 0.8 + numbers.within(0.4));
    let twist = 0.4 + numbers.within(0.35);
    let pattern = Kresling { sides, levels: Some(levels), height, twist, ..Kresling::default() };
    pressed_ring(generate(&Pattern::Kresling(pattern)).unwrap(), sides)
}

/// A ring whose first vertices are pinned and whose last ones are pressed down, along z alone.
fn pressed_ring(sheet: Sheet, sides: usize) -> Assembly {
    let top = sheet.vertices.len() - sides;
    let pins = (0..sides).map(|v| (v, [true; 3])).collect();
    let loads = (top..top + sides).map(|v| (v, Vec3::new(0.0, 0.0, -1.0 / sides as f64))).collect();
    on(sheet, [1, 1], Boundary::Patch).with_terms(Terms { pins, loads, ..Terms::default() })
}

/// A cell rolled up to a tube, which keeps some of its closing conditions.
fn tube(numbers: &mut Numbers) -> Assembly {
    let (seed, sheet) = (whole(numbers, 0, 1000) as u64, whole(numbers, 0, 2));
    let cell = if sheet == 0 {
        mesh("open-star")
    } else {
        generate(&Pattern::Random(Random { seed, size: [2, 3], ..Random::default() })).unwrap()
    };
    let seam = [[0, 8], [1, 8], [8, 0], [7, -3]][whole(numbers, 0, 4)];
    let kept = [SeamKept::BOTH, SeamKept { turn: true, rise: false }, SeamKept { turn: false, rise: true }];
    let kept = kept[whole(numbers, 0, 3)];
    match rolled_up(&cell, seam, kept, true) {
        Ok(roll) => Assembly::tube(cell, roll, [1, 1]).build().unwrap(),
        Err(_) => on(cell, [1, 1], Boundary::Screw),
    }
}

/// A random sheet of quadrilaterals that hangs on pins along one side, which are off a line by a random small number.
fn hung(numbers: &mut Numbers) -> Assembly {
    let [columns, rows] = [(); 2].map(|()| whole(numbers, 2, 7));
    let (off, height) = (10f64.powf(-4.0 + numbers.within(3.0)), 0.2 * (numbers.within(0.5) + 0.5));
    let mut coords = vec![];
    for (j, i) in (0..=rows).flat_map(|j| (0..=columns).map(move |i| (j, i))) {
        let along = if j == 0 { [off, off] } else { [0.2, height] }.map(|size| numbers.within(size));
        coords.push(Vec3::new(i as f64, j as f64 + along[0], along[1]));
    }
    let at = |i: usize, j: usize| j * (columns + 1) + i;
    let faces = (0..rows)
        .flat_map(|j| (0..columns).map(move |i| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]))
        .collect();
    let pins = (0..=columns).map(|v| (v, [true; 3])).collect();
    let loads = (0..=columns).map(|i| (at(i, rows), Vec3::new(0.0, -1.0, 0.0))).collect();
    on(finite("hung", coords, faces), [1, 1], Boundary::Patch).with_terms(Terms { pins, loads, ..Terms::default() })
}
