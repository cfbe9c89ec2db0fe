//! One random sheet, and its answers.

use crate::common::{self, Numbers, Testing, on};
use crate::laws::RandomLaws;
use crate::redrawn::redrawn;
use foldwell::analysis::exact::error_to_kinematic;
use foldwell::analysis::relax::relax_from;
use foldwell::analysis::shown_cells::ShownCells;
use foldwell::analysis::wells::starts::{Outcome, Starts, relax_around};
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Boundary, Gauge, Terms};
use foldwell::output::picture::Picture;
use foldwell::sheet::generate::{Eggbox, Miura, Random, RandomDevelopable};
use foldwell::sheet::{EdgeKind, Pattern, Sheet, generate};
use foldwell::solver::{Options, Problem};
use std::f64::consts::PI;

/// Largest part of the energy that open gaps may leave unknown; what is seen in degenerate states is a tenth of it.
const MOST_OPEN: f64 = 1e-4;
/// Largest magnitude of a fold angle, in radians, at which a drawn hinge counts as flat.
const FLAT_RAD: f64 = 1e-9;
/// Distance, in the unit of the sheet, within which two states are one. Those of rigid bars and of bars of 1e13 are
/// nearer, and two branches of a flat sheet farther apart than that.
const SAME_PLACE: f64 = 1e-6;
/// Random starts where nothing else is said.
const STARTS: usize = 150;

/// A sheet, what it is made of, and what acts on it.
#[derive(Clone)]
pub struct Trial {
    pub sheet: Sheet,
    pub boundary: Boundary,
    pub cells: [usize; 2],
    pub bars: f64,
    pub facets: f64,
    pub laws: RandomLaws,
    /// Rest angle less the drawn one of each edge of the cell.
    pub off: Vec<f64>,
    /// A locked edge of the cell, and its angle less the drawn one.
    pub lock: Option<(usize, f64)>,
    /// Forces on vertices of the tiling.
    pub loads: Vec<(usize, Vec3)>,
    pub pins: Vec<(usize, [bool; 3])>,
    /// Random starts from which another equilibrium is sought, of each size.
    pub starts: usize,
}

pub struct Answer {
    pub energy: f64,
    /// Twice what the gaps that are left open store at their tensions. Where rigid measures come to depend on each
    /// other an angle goes as the root of a gap `g`, and so does the energy, `E0 - a sqrt(g)`: the tension is
    /// `t = a / (2 sqrt(g))`, and the energy is off by `2 t g`. Elsewhere it is off by `t g`, which is nothing beside
    /// the tolerance.
    pub open: f64,
    /// All coordinates, as this sheet is drawn.
    pub coordinates: Vec<f64>,
    /// Fold angles of the tiling's edges.
    pub angles: Vec<f64>,
    pub negative: Option<usize>,
    /// The same, asked again from the answer.
    pub again: Result<(f64, usize), String>,
    pub residual: f64,
    /// `t^2 / 2` and `1 / k` of every stiff measure.
    pub halves: Vec<f64>,
    pub compliance: Vec<f64>,
    /// Distance to the exact kinematics, where that says something.
    pub exact: Option<f64>,
    /// The sum of the energies of all lines of the picture.
    pub pictured: f64,
}

impl Answer {
    /// The same with its vertices mapped. Coordinates that all points share stay as they are: only patches, which have
    /// none, are asked for them.
    pub fn mapped(mut self, map: impl Fn(Vec3) -> Vec3) -> Self {
        for point in self.coordinates.chunks_exact_mut(3) {
            point.copy_from_slice(map(Vec3::from_column_slice(point)).as_slice());
        }
        self
    }
}

impl Trial {
    pub fn new(seed: u64) -> Self {
        let mut numbers = Numbers::new(seed);
        let mut pick = |n: usize| ((numbers.within(0.5) + 0.5) * n as f64) as usize % n;
        let size = [[2, 2], [2, 3], [3, 2]][pick(3)];
        let mut others = Numbers::new(!seed);
        let mut of = |size| others.within(size);
        let sheet = generate(&match pick(6) {
            0 => Pattern::RandomDevelopable(RandomDevelopable { size, seed, ..RandomDevelopable::default() }),
            1 => Pattern::Miura(Miura {
                a: 1.0 + of(0.3),
                b: 1.0 + of(0.3),
                sector: PI / 3.0 + of(0.2),
                fold: 0.3 + of(0.2),
            }),
            2 => Pattern::Eggbox(Eggbox {
                a: 1.0 + of(0.3),
                b: 1.0 + of(0.3),
                sector: PI / 3.0 + of(0.1),
                fold: PI / 4.0 + of(0.1),
            }),
            _ => Pattern::Random(Random { size, seed, ..Random::default() }),
        })
        .unwrap();
        Self::around(sheet, &mut numbers)
    }

    /// A sheet with random boundary conditions and terms. A finite sheet is a patch.
    pub fn around(sheet: Sheet, numbers: &mut Numbers) -> Self {
        let mut pick = |n: usize| ((numbers.within(0.5) + 0.5) * n as f64) as usize % n;
        use Boundary::{FixedTorus, FreeTorus, Patch, Screw};
        let boundary = [Patch, FixedTorus, FreeTorus, Screw, Screw][pick(5)];
        let boundary = if sheet.lattice.is_none() { Patch } else { boundary };
        let cells = if boundary == Screw { [1, 1] } else { [[1, 1], [2, 2]][pick(2)] };
        let cells = if sheet.lattice.is_none() { [1, 1] } else { cells };
        let bars = [1e2, 1e4, 1e6, f64::INFINITY, f64::INFINITY][pick(5)];
        let facets = [1.0, 10.0, f64::INFINITY][pick(3)];
        let (with_lock, with_loads, pinned) = (pick(3) == 0, pick(2) == 0, pick(4));
        let hinges: Vec<usize> = (0..sheet.edges.len()).filter(|&e| sheet.edges[e].kind == EdgeKind::Crease).collect();
        let locked = hinges[pick(hinges.len())];
        let off = numbers.many(sheet.edges.len(), 0.05);
        let lock = with_lock.then(|| (locked, numbers.within(0.05)));
        let (loads, pins, laws) = (vec![], vec![], RandomLaws::default());
        let mut trial = Self { sheet, boundary, cells, bars, facets, laws, off, lock, loads, pins, starts: STARTS };
        if boundary == Patch && with_loads {
            trial.load(numbers, pinned);
        }
        trial
    }

    /// Balanced loads of some size between 1e-9 and 1e-1 and up to three pinned vertices.
    pub fn load(&mut self, numbers: &mut Numbers, pinned: usize) {
        let count = self.sheet.vertices.len() * self.cells[0] * self.cells[1];
        let size = 10f64.powf(-5.0 + numbers.within(4.0));
        let force = Vec3::from_iterator(numbers.many(3, size));
        self.loads = vec![(0, force), (count - 1, -force)];
        self.pins = (1..=pinned.min(count.saturating_sub(2)).min(3)).map(|vertex| (vertex, [true; 3])).collect();
    }

    pub fn describe(&self) -> String {
        let Self { boundary, cells, bars, facets, laws, lock, loads, pins, sheet, .. } = self;
        let (lock, pins) = (lock.is_some(), pins.len());
        let force = loads.first().map_or(0.0, |(_, f)| f.norm());
        let title = &sheet.title;
        let case = format!("{title} {boundary:?} {cells:?} bars {bars:e} facets {facets}");
        format!("{case} lock {lock} load {force:.0e} pins {pins} {laws:?}")
    }

    pub fn terms(&self, case: &Assembly) -> Terms {
        let rest =
            case.tiling().edges.iter().zip(case.drawn_angles()).map(|(e, angle)| angle + self.off[e.edge]).collect();
        let hinge = |k: &usize| !case.drawn_angles()[*k].is_nan();
        let mut locks = vec![];
        if let Some((edge, off)) = self.lock {
            let copies = (0..case.edges()).filter(|&k| case.tiling().edges[k].edge == edge).filter(hinge);
            locks.extend(copies.map(|k| (k, case.drawn_angles()[k] + off)));
        }
        let facets = if case.count(EdgeKind::Facet) > 0 { case.facets(self.facets) } else { None };
        let (loads, pins, laws) = (self.loads.clone(), self.pins.clone(), self.laws.of_terms());
        Terms { facets, locks, loads, pins, laws, ..Terms::bars_and_creases(self.bars, 1.0, rest) }
    }

    pub fn case(&self) -> Assembly {
        on(self.sheet.clone(), self.cells, self.boundary)
    }

    pub fn answer(&self) -> Result<Answer, String> {
        let case = self.case();
        let terms = self.terms(&case);
        let assembly = case.with_terms(terms).with_best_axis();
        let mut model = assembly.model(Gauge::Held);
        let found = relax_from(&model, model.start(), Options::default(), &mut |_| true).map_err(|e| e.to_string())?;
        let exact = error_to_kinematic(case.sheet(), case.tiling(), &model, &found.state.fold_angle);
        let start = model.enter(&found.configuration);
        let (gaps, tension) = (model.gaps(&start.x), found.configuration.tensions());
        let again = relax_from(&model, start, Options::default(), &mut |_| true);
        let again = again.map(|again| (again.state.total(), again.iterations)).map_err(|e| e.to_string());
        let negative = found.negative_eigenvalues;
        let view = ShownCells::new(&assembly);
        let pictured = Picture::of_state(&view, assembly.drawn(), &found.state).energy.iter().sum();
        let (halves, compliance) = (halves(tension), model.compliance().to_vec());
        let works = gaps.iter().zip(tension).zip(&compliance).map(|((gap, t), c)| (t * (gap - c * t)).abs());
        let open = (2.0 * works.sum::<f64>()).min(MOST_OPEN * found.state.total());
        let (energy, angles, residual) = (found.state.total(), found.state.fold_angle, found.residual_force);
        let coordinates = found.state.coordinates;
        Ok(Answer { energy, open, coordinates, angles, negative, again, residual, halves, compliance, exact, pictured })
    }

    /// Whether the sheet is a flat patch. Several branches of rigid folding meet in that state, and which one is taken
    /// is no claim of the program.
    pub fn starts_flat(&self) -> bool {
        let angles = self.case().drawn_angles().to_vec();
        self.boundary == Boundary::Patch && angles.iter().filter(|angle| !angle.is_nan()).all(|a| a.abs() <= FLAT_RAD)
    }

    /// Whether the state with these coordinates is a minimum of such an energy: a relaxation that starts there, without
    /// its tensions, ends there. Told beside the energy are `t^2 / 2` of every stiff measure.
    pub fn has_minimum_at(&self, coordinates: &[f64], such: impl Fn(f64, &[f64]) -> bool) -> bool {
        let case = self.case();
        let terms = self.terms(&case);
        let mut model = case.with_terms(terms).model(Gauge::Held);
        let x = model.start_from(coordinates.to_vec());
        let found = relax_from(&model, x, Options::default(), &mut |_| true);
        found.is_ok_and(|found| {
            let apart = common::distance(&found.state.coordinates, coordinates);
            apart <= SAME_PLACE
                && found.negative_eigenvalues == Some(0)
                && such(found.state.total(), &halves(found.configuration.tensions()))
        })
    }

    /// Whether random starts reach an equilibrium of such an energy; told beside it are `t^2 / 2` of every stiff
    /// measure.
    pub fn has_equilibrium(&self, such: impl Fn(f64, &[f64]) -> bool) -> bool {
        let case = self.case();
        let terms = self.terms(&case);
        let assembly = case.with_terms(terms);
        [0.05, 0.1, 0.3, 1.0].into_iter().any(|spread| {
            let starts = Starts { count: self.starts, seed: 1, spread, options: Options::default() };
            relax_around(&assembly, None, &starts, &|| true).into_iter().any(|outcome| match outcome {
                Outcome::Well(found) => such(found.energy, &halves(found.place.tensions())),
                _ => false,
            })
        })
    }

    /// The same with all points mapped, forces with them, and angles times a sign.
    pub fn mapped(&self, map: impl Fn(Vec3) -> Vec3, linear: impl Fn(Vec3) -> Vec3, sign: f64) -> Self {
        let mut other = self.clone();
        other.sheet.vertices.iter_mut().for_each(|p| *p = map(*p));
        other.sheet.lattice = other.sheet.lattice.map(|lattice| lattice.map(&linear));
        other.loads.iter_mut().for_each(|(_, force)| *force = linear(*force));
        other.off.iter_mut().for_each(|off| *off *= sign);
        if sign < 0.0 {
            other.laws = other.laws.mirrored();
        }
        other.lock = other.lock.map(|(edge, off)| (edge, sign * off));
        other
    }

    /// In another unit of length: stiffnesses of creases are forces, so that torques and energies have the factor.
    pub fn in_unit(&self, unit: f64) -> Self {
        let mut other = self.mapped(|p| unit * p, |l| unit * l, 1.0);
        other.loads.clone_from(&self.loads);
        other
    }

    /// The same sheet with its vertices in another order and other lattice vectors.
    pub fn redrawn(&self, numbers: &mut Numbers, basis: [[i32; 2]; 2]) -> Option<Self> {
        let other = redrawn(&self.sheet, numbers, basis);
        let number = other.edges(&self.sheet)?;
        let off = number.iter().map(|&old| self.off[old]).collect();
        let lock = match self.lock {
            Some((edge, off)) => Some((number.iter().position(|&old| old == edge)?, off)),
            None => None,
        };
        Some(Self { sheet: other.sheet, off, lock, ..self.clone() })
    }
}

fn halves(tension: &[f64]) -> Vec<f64> {
    tension.iter().map(|t| 0.5 * t * t).collect()
}
