//! Shared helpers of the tests: sheets with boundary conditions, terms with random rest angles, and dense matrices.
#![allow(dead_code, unused_imports)] // each test file uses a part

mod folder;
mod run;

pub use folder::{Files, Folder, Said, Table, signal};
pub use run::{Ran, Scene, case_folder};

use foldwell::analysis::modes::{Modes, ModesError, modes};
use foldwell::analysis::relax::{RelaxError, Relaxed, relax_from};
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Bars, Boundary, Drawn, Gauge, Hinges, Model, Terms};
use foldwell::numerics::{DenseMatrix, dense};
use foldwell::sheet::generate::FourParallelogram;
use foldwell::sheet::{EdgeKind, Pattern, Sheet, fold, generate};
use foldwell::solver::{HessianKind, Linearization, Options, Problem};
use nalgebra::Matrix3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::PathBuf;

/// A generator of random numbers, which are the same on every machine.
pub struct Numbers(ChaCha8Rng);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Returns a number between `-size` and `size`.
    pub fn within(&mut self, size: f64) -> f64 {
        size * (2.0 * self.0.random::<f64>() - 1.0)
    }

    pub fn many(&mut self, count: usize, size: f64) -> Vec<f64> {
        (0..count).map(|_| self.within(size)).collect()
    }
}

/// Returns the folder of the repository's meshes and scenes.
pub fn mesh_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("meshes")
}

pub fn mesh(name: &str) -> Sheet {
    let path = mesh_folder().join(format!("{name}.fold"));
    fold::read(&path).expect("the repository's meshes can be read")
}

/// Returns the sheet in another unit of length.
pub fn scaled(mut sheet: Sheet, by: f64) -> Sheet {
    sheet.vertices.iter_mut().for_each(|p| *p *= by);
    sheet.lattice = sheet.lattice.map(|lattice| lattice.map(|l| l * by));
    sheet
}

/// Returns the sheet turned about the origin by this rotation.
pub fn turned(mut sheet: Sheet, turn: &Matrix3<f64>) -> Sheet {
    sheet.vertices.iter_mut().for_each(|p| *p = turn * *p);
    sheet.lattice = sheet.lattice.map(|lattice| lattice.map(|l| turn * l));
    sheet
}

/// Generates the cell of four parallelograms with sides `a`, `b` along the first direction and `c`, `d` along the
/// second, turned into the plane. `a` and `b` point to the same side of the plane of `c` and `d`.
pub fn four_parallelograms([a, b, c, d]: [Vec3; 4]) -> Sheet {
    let along = (c.normalize() + d.normalize()).normalize();
    let across = c.cross(&d).normalize();
    let across = if a.dot(&across) > 0.0 { across } else { -across };
    assert!(b.dot(&across) > 0.0, "a and b point to different sides");
    let fold = (-c.dot(&across.cross(&along))).atan2(c.dot(&along));
    let cell = FourParallelogram {
        a: a.norm(),
        b: b.norm(),
        c: c.norm(),
        d: d.norm(),
        ac: a.angle(&c),
        ad: a.angle(&d),
        bc: b.angle(&c),
        bd: b.angle(&d),
        fold,
    };
    generate(&Pattern::FourParallelogram(cell)).unwrap()
}

/// Assembles a sheet with boundary conditions, without energy terms.
pub fn on(sheet: Sheet, cells: [usize; 2], boundary: Boundary) -> Assembly {
    Assembly::without_terms(sheet, cells, boundary).expect("a sheet that can have these boundary conditions")
}

/// Assembles a patch of cells of a mesh of the repository, without energy terms.
pub fn patch(name: &str, cells: [usize; 2]) -> Assembly {
    on(mesh(name), cells, Boundary::Patch)
}

/// Methods of a sheet with boundary conditions for tests.
pub trait Testing {
    fn count(&self, kind: EdgeKind) -> usize;
    /// Returns rest angles that differ from the drawn angles by random numbers of at most `size`, one for each hinge.
    fn rest_per_hinge(&self, size: f64, seed: u64) -> Vec<f64>;
    /// Returns rest angles that differ from the drawn angles by random numbers of at most `size`, one for each crease
    /// of the cell.
    fn rest_per_cell(&self, size: f64, seed: u64) -> Vec<f64>;
    /// Returns facets of this stiffness with the drawn angles as rest angles.
    fn facets(&self, stiffness: f64) -> Option<Hinges>;
    fn model_of(&self, terms: &Terms, gauge: Gauge) -> Model;
    fn modes_of(&self, terms: &Terms, eigenvalues: usize) -> Result<Modes, ModesError>;
    /// Returns the same assembly with all bars of one stiffness, at the rest lengths that they have.
    fn with_bars(&self, stiffness: f64) -> Assembly;
    /// Returns the same assembly without the coordinates that screw boundary conditions hold against drift, so that
    /// its models have all rigid motions.
    fn with_free_coordinates(&self) -> Assembly;
    /// Relaxes the sheet from the drawn state.
    fn relax(&self, terms: &Terms) -> Result<Relaxed, Box<RelaxError>>;
}

impl Testing for Assembly {
    fn count(&self, kind: EdgeKind) -> usize {
        self.tiling().edges.iter().filter(|edge| edge.kind == kind).count()
    }

    fn rest_per_hinge(&self, size: f64, seed: u64) -> Vec<f64> {
        let mut numbers = Numbers::new(seed);
        self.drawn_angles().iter().map(|angle| angle + numbers.within(size)).collect()
    }

    fn rest_per_cell(&self, size: f64, seed: u64) -> Vec<f64> {
        let off = Numbers::new(seed).many(self.sheet().edges.len(), size);
        self.tiling().edges.iter().zip(self.drawn_angles()).map(|(edge, angle)| angle + off[edge.edge]).collect()
    }

    fn facets(&self, stiffness: f64) -> Option<Hinges> {
        Some(Hinges { stiffness: stiffness.into(), rest: self.drawn_angles().to_vec() })
    }

    fn model_of(&self, terms: &Terms, gauge: Gauge) -> Model {
        self.with_terms(terms.clone()).model(gauge)
    }

    fn modes_of(&self, terms: &Terms, eigenvalues: usize) -> Result<Modes, ModesError> {
        modes(&self.with_terms(terms.clone()), eigenvalues, &mut || true)
    }

    fn with_bars(&self, stiffness: f64) -> Assembly {
        let rest = self.terms().bars.as_ref().map(|bars| bars.rest.clone()).unwrap_or_default();
        let bars = Bars { stiffness: stiffness.into(), rest };
        self.with_terms(Terms { bars: Some(bars), ..self.terms().clone() })
    }

    fn with_free_coordinates(&self) -> Assembly {
        self.with_drawn(Drawn { held: vec![], ..self.drawn().clone() })
    }

    fn relax(&self, terms: &Terms) -> Result<Relaxed, Box<RelaxError>> {
        let model = self.model_of(terms, Gauge::Held);
        relax_from(&model, model.start(), Options::default(), &mut |_| true)
    }
}

pub fn linearized(model: &Model, x: &[f64], tension: &[f64]) -> Linearization {
    let mut at = Linearization::new(model.layout());
    model.linearize(x, tension, HessianKind::Full, &mut at);
    at
}

/// Returns the Jacobian of the stiff terms.
pub fn jacobian(model: &Model, at: &Linearization) -> DenseMatrix {
    dense::from_rows(&at.rows(), model.layout().unknowns)
}

/// Returns the Hessian of the whole energy at a state without tensions, as [`stressed_hessian`].
pub fn energy_hessian(model: &Model, x: &[f64]) -> DenseMatrix {
    stressed_hessian(model, x, &vec![0.0; model.layout().stiff.len()])
}

/// Returns the Hessian of the whole energy, `H + R^T k R`, with these tensions in `H`. All stiffnesses must be finite.
pub fn stressed_hessian(model: &Model, x: &[f64], tension: &[f64]) -> DenseMatrix {
    let at = linearized(model, x, tension);
    let mut rows = jacobian(model, &at);
    let weights = model.compliance().iter().map(|c| c.recip().sqrt());
    rows.row_iter_mut().zip(weights).for_each(|(mut row, weight)| row *= weight);
    at.pattern().to_dense(&at.hessian) + rows.tr_mul(&rows)
}

/// Returns the eigenvalues of a symmetric matrix in ascending order, by nalgebra, which the program does not use for
/// this.
pub fn eigenvalues(matrix: DenseMatrix) -> Vec<f64> {
    let mut values: Vec<f64> = matrix.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Returns the largest absolute difference of two lists over the entries where both are numbers.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).filter(|d| !d.is_nan()).fold(0.0, f64::max)
}

/// Force and energy along a path, from its table.
pub struct ForceCurve {
    /// Drive, reaction and energy of every state of the first branch.
    pub states: Vec<[f64; 3]>,
}

impl ForceCurve {
    /// Reads the table of a path.
    pub fn of(table: &Table) -> Self {
        let rows = (0..table.len()).filter(|&row| table.rows[row][0] == "0");
        let states = rows.map(|row| ["drive", "reaction", "energy_total"].map(|column| table.at(row, column)));
        let states: Vec<[f64; 3]> = states.collect();
        assert!(states.iter().flatten().all(|number| !number.is_nan()), "{states:?}");
        Self { states }
    }

    /// Returns the energy where the drive has this value, by a cubic whose slopes are the reactions.
    pub fn energy_at(&self, drive: f64) -> f64 {
        let pair = self.states.windows(2).find(|pair| (pair[0][0] - drive) * (pair[1][0] - drive) <= 0.0);
        let pair = pair.expect("the path passes that value");
        let size = pair[1][0] - pair[0][0];
        let part = (drive - pair[0][0]) / size;
        Self::between(pair, part)
    }

    /// Returns the energy where the reaction first changes its sign after the beginning, in the same way.
    pub fn energy_without_force(&self) -> f64 {
        let pair = self.states.windows(2).skip(1).find(|pair| pair[0][1] * pair[1][1] < 0.0);
        let pair = pair.expect("the reaction changes its sign");
        let ([x, f, e], [y, g, u]) = (pair[0], pair[1]);
        let slope = |t: f64| {
            6.0 * t * (1.0 - t) * (u - e) / (y - x) + (1.0 - t) * (1.0 - 3.0 * t) * f + t * (3.0 * t - 2.0) * g
        };
        let (mut a, mut b) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if slope(a) * slope(middle) <= 0.0 { b = middle } else { a = middle }
        }
        Self::between(pair, a)
    }

    fn between(pair: &[[f64; 3]], t: f64) -> f64 {
        let ([x, f, e], [y, g, u], r) = (pair[0], pair[1], 1.0 - t);
        (1.0 + 2.0 * t) * r * r * e + t * t * (3.0 - 2.0 * t) * u + (y - x) * (t * r * r * f - t * t * r * g)
    }
}
