//! The points of the grid: the scenes, how far their rest values go, and the stiffnesses of their bars.

use crate::common::{Testing, mesh_folder};
use foldwell::analysis::relax::relax_from;
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Gauge, Hinges, Terms};
use foldwell::run::read_scene;
use foldwell::scene::{Setting, build::assembly};
use foldwell::solver::Options;

/// Parts of the way from the drawn state, where all is at rest, to the rest values of the scene. For rest angles by
/// letters the whole way is the flat fold, so that the part is the `fraction` of the scene; of a mode it is that of its
/// `amplitude`.
pub const PARTS: [f64; 10] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
/// Stiffnesses EA of the bars.
pub const BARS: [f64; 7] = [30.0, 1e2, 3e2, 1e3, 1e4, 1e6, f64::INFINITY];

/// A scene with all of its rest values.
pub struct Whole {
    pub name: String,
    assembly: Assembly,
}

/// A scene at one part of its way and with one stiffness of its bars.
#[derive(Clone)]
pub struct Point {
    pub scene: String,
    pub part: f64,
    pub bars: f64,
    pub assembly: Assembly,
}

impl Point {
    /// Returns the seed of its drawings, which no other scene changes: the hash FNV-1a of its names.
    pub fn seed(&self) -> u64 {
        let named = format!("{} {} {}", self.scene, self.bars, self.part);
        named.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }
}

/// Equilibrium that a relaxation reaches; the energy is that of the springs less the work of the loads.
#[derive(Clone, Copy)]
pub struct Answer {
    pub energy: f64,
    pub iterations: usize,
    pub factorizations: usize,
}

/// Returns the scenes of the repository that relax a sheet with bars, each problem once: some scenes differ in what
/// they show alone.
pub fn scenes() -> Vec<Whole> {
    let files = std::fs::read_dir(mesh_folder()).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<_> = files.filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect();
    scenes.sort();
    let mut found: Vec<Whole> = Vec::new();
    for path in scenes {
        let text = std::fs::read_to_string(&path).unwrap();
        if !text.contains("kind = \"relax\"") {
            continue;
        }
        let all: Option<Setting> = text.contains("fraction = ").then(|| "energy.creases.fraction=1".parse().unwrap());
        let file = read_scene(&path, &Vec::from_iter(all)).unwrap();
        let whole =
            Whole { name: path.file_stem().unwrap().to_str().unwrap().to_owned(), assembly: assembly(&file).unwrap() };
        if !found.iter().any(|other| same_problem(&whole, other)) {
            found.push(whole);
        }
    }
    found
}

/// Whether two scenes differ at most in the stiffness of their bars and in how many cells are shown.
fn same_problem(one: &Whole, other: &Whole) -> bool {
    let [a, b] = [one, other].map(|whole| &whole.assembly);
    let same_sheet = a.sheet().vertices == b.sheet().vertices && a.sheet().polygons == b.sheet().polygons;
    same_sheet
        && a.domain() == b.domain()
        && a.tiling().cells == b.tiling().cells
        && a.with_bars(1.0).terms() == b.with_bars(1.0).terms()
}

impl Whole {
    /// Returns the points of the scene, the parts of a stiffness after each other. One part is all where nothing is off
    /// its rest value.
    pub fn points(&self) -> Vec<Point> {
        let still = self.at(0.5, 1.0).terms() == self.at(1.0, 1.0).terms();
        let parts = if still { &PARTS[9..] } else { &PARTS[..] };
        let point =
            |bars: f64, part: f64| Point { scene: self.name.clone(), part, bars, assembly: self.at(part, bars) };
        BARS.iter().flat_map(|&bars| parts.iter().map(move |&part| (bars, part))).map(|(b, p)| point(b, p)).collect()
    }

    /// Returns the sheet with its rest angles, locked angles and loads at a part of the way from the drawn state.
    fn at(&self, part: f64, bars: f64) -> Assembly {
        let (whole, drawn) = (&self.assembly, self.assembly.drawn_angles());
        let between = |edge: usize, rest: f64| {
            if drawn[edge].is_nan() { rest } else { drawn[edge] + part * (rest - drawn[edge]) }
        };
        let hinges = |hinges: &Option<Hinges>| {
            let Hinges { stiffness, rest } = hinges.clone()?;
            Some(Hinges { stiffness, rest: rest.iter().enumerate().map(|(k, rest)| between(k, *rest)).collect() })
        };
        let terms = whole.terms();
        let terms = Terms {
            creases: hinges(&terms.creases),
            facets: hinges(&terms.facets),
            locks: terms.locks.iter().map(|&(edge, angle)| (edge, between(edge, angle))).collect(),
            loads: terms.loads.iter().map(|(vertex, force)| (*vertex, force * part)).collect(),
            ..terms.clone()
        };
        whole.with_terms(terms).with_bars(bars)
    }
}

/// Relaxes a sheet from its drawn state. What is no minimum is no answer.
pub fn relaxed(assembly: &Assembly) -> Result<Answer, String> {
    let model = assembly.with_best_axis().model(Gauge::Held);
    let found =
        relax_from(&model, model.start(), Options::default(), &mut |_| true).map_err(|error| error.to_string())?;
    match found.negative_eigenvalues {
        Some(0) => {}
        Some(count) => return Err(format!("a saddle with {count} negative eigenvalues")),
        None => return Err("negative eigenvalues cannot be counted".to_owned()),
    }
    let energy = found.state.total() - work_of_loads(assembly, &found.state.coordinates);
    Ok(Answer { energy, iterations: found.iterations, factorizations: found.factorizations })
}

/// Returns the work of the loads from the drawn state to one with these coordinates.
fn work_of_loads(assembly: &Assembly, coordinates: &[f64]) -> f64 {
    let drawn = &assembly.drawn().coordinates;
    let moved = |vertex: usize, axis: usize| coordinates[3 * vertex + axis] - drawn[3 * vertex + axis];
    let work = |(vertex, force): &(usize, Vec3)| (0..3).map(|axis| force[axis] * moved(*vertex, axis)).sum::<f64>();
    assembly.terms().loads.iter().map(work).sum()
}
