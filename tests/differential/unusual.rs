//! Random sheets of kinds that [`Trial::new`] does not make: cells of one and two vertices, triangles of small height,
//! cells with axes of three, four and six, closed rings, sheets of two pieces, and rolled-up tubes.

use crate::common::{Numbers, scaled};
use crate::report::{ELSEWHERE, Report, SAME};
use crate::trial::{Answer, Trial};
use foldwell::analysis::relax::relax_from;
use foldwell::analysis::wells::starts::{Outcome, Starts, relax_around};
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Gauge, Terms};
use foldwell::rolled_up;
use foldwell::sheet::build::{build, draw};
use foldwell::sheet::generate::{Kresling, Random, RandomDevelopable};
use foldwell::sheet::{Corner, EdgeKey, Pattern, SeamKept, Sheet, generate};
use foldwell::solver::Options;
use nalgebra::Rotation3;
use std::f64::consts::{FRAC_PI_3, TAU};

/// Random starts from which another equilibrium is sought, of each size: locked cells on screws take a tenth of a
/// second for each.
const STARTS: usize = 30;

/// A sheet of one of these kinds, and what acts on it.
pub fn trial(seed: u64) -> Trial {
    let mut numbers = Numbers::new(seed ^ 0x7551_u64.rotate_left(32));
    let sheet = match whole(&mut numbers, 5) {
        0 => small(seed, [1, 1]),
        1 => small(seed, [[1, 2], [2, 1]][whole(&mut numbers, 2)]),
        2 => sliver(seed, &mut numbers),
        3 => turning(&mut numbers),
        _ => ring(&mut numbers),
    };
    Trial { starts: STARTS, ..Trial::around(sheet, &mut numbers) }
}

/// A whole number below `end`.
fn whole(numbers: &mut Numbers, end: usize) -> usize {
    ((numbers.within(0.5) + 0.5) * end as f64) as usize % end
}

/// A random cell of few vertices, one in four flat.
fn small(seed: u64, size: [usize; 2]) -> Sheet {
    let flat = seed.is_multiple_of(4);
    generate(&if flat {
        Pattern::RandomDevelopable(RandomDevelopable { size, seed, ..RandomDevelopable::default() })
    } else {
        Pattern::Random(Random { size, seed, ..Random::default() })
    })
    .unwrap()
}

/// A random cell in which a vertex has come near the opposite side of one of its triangles.
fn sliver(seed: u64, numbers: &mut Numbers) -> Sheet {
    let mut sheet = generate(&Pattern::Random(Random { size: [2, 2], seed, ..Random::default() })).unwrap();
    let triangle = sheet.polygons[whole(numbers, sheet.polygons.len())].clone();
    let [a, b, c] = [0, 1, 2].map(|k| sheet.position(triangle[k]));
    let along = (c - b).normalize();
    let away = (a - b) - along * along.dot(&(a - b));
    let height = 10f64.powf(-2.5 + numbers.within(0.5));
    sheet.vertices[triangle[0].vertex] += away.normalize() * height - away;
    Sheet { title: "sliver".to_owned(), ..sheet }
}

/// A random triangulated cell with an axis of three, four or six through its first vertex.
fn turning(numbers: &mut Numbers) -> Sheet {
    let order = [3, 4, 6][whole(numbers, 3)];
    let size = if order == 4 { 2 } else { 2 + whole(numbers, 2) as i32 };
    let (second, turn) = if order == 4 { (TAU / 4.0, TAU / 4.0) } else { (FRAC_PI_3, TAU / f64::from(order)) };
    let basis = [Vec3::x(), Vec3::new(second.cos(), second.sin(), 0.0)];
    let image = |[i, j]: [i32; 2]| match order {
        3 => [-i - j, i],
        4 => [-j, i],
        _ => [-j, i + j],
    };
    let number = |[i, j]: [i32; 2]| (j.rem_euclid(size) * size + i.rem_euclid(size)) as usize;
    let turn = Rotation3::from_axis_angle(&Vec3::z_axis(), turn);
    let places: Vec<[i32; 2]> = (0..size).flat_map(|j| (0..size).map(move |i| [i, j])).collect();
    let mut moved = vec![Vec3::zeros(); places.len()];
    for place in &places {
        let mut step = Vec3::new(numbers.within(0.15), numbers.within(0.15), numbers.within(0.3));
        let mut at = *place;
        for _ in 0..order {
            moved[number(at)] += step / f64::from(order).sqrt();
            (at, step) = (image(at), turn * step);
        }
    }
    let place = |[i, j]: [i32; 2]| basis[0] * f64::from(i) + basis[1] * f64::from(j);
    let vertices = places.iter().map(|at| place(*at) + moved[number(*at)]).collect();
    let corner = |[i, j]: [i32; 2]| Corner { vertex: number([i, j]), shift: [i.div_euclid(size), j.div_euclid(size)] };
    // a quarter turn exchanges the diagonals of the squares that it exchanges
    let rising = |[i, j]: [i32; 2]| order == 4 && (i + j) % 2 == 0;
    let split = |&[i, j]: &[i32; 2]| {
        let [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(corner);
        if rising([i, j]) { [vec![a, b, c], vec![a, c, d]] } else { [vec![a, b, d], vec![b, c, d]] }
    };
    let lattice = Some(basis.map(|vector| vector * f64::from(size)));
    let polygons = places.iter().flat_map(split).collect();
    built(Sheet { title: format!("p{order}"), vertices, lattice, polygons, ..Sheet::default() })
}

/// A sheet of these vertices, polygons and lattice vectors, with its edges.
fn built(bare: Sheet) -> Sheet {
    build(&draw(&bare)).unwrap()
}

/// A ring of Kresling's pattern that is closed on itself and open at its ends.
fn ring(numbers: &mut Numbers) -> Sheet {
    let (sides, levels) = (3 + whole(numbers, 5), 1 + whole(numbers, 2));
    let (height, twist) = (0.8 + numbers.within(0.3), 0.5 + numbers.within(0.3));
    generate(&Pattern::Kresling(Kresling { sides, levels: Some(levels), height, twist, ..Kresling::default() }))
        .unwrap()
}

/// Two random sheets, and both side by side as one: energies add.
pub fn pieces(seed: u64, report: &mut Report) {
    let mut numbers = Numbers::new(!seed);
    let cells = [2 * seed, 2 * seed + 1].map(|seed| {
        let size = [[2, 2], [1, 2], [1, 1]][whole(&mut numbers, 3)];
        without_lattice(&generate(&Pattern::Random(Random { size, seed, ..Random::default() })).unwrap())
    });
    let mut one = Trial::around(cells[0].clone(), &mut numbers);
    (one.loads, one.pins, one.lock) = (vec![], vec![], None);
    let off = numbers.many(cells[1].edges.len(), 0.1);
    let other = Trial { sheet: cells[1].clone(), off, ..one.clone() };
    let both = side_by_side(&one, &other);
    let what = format!("piece {seed}, {}", both.describe());
    let (one, other) = match (one.answer(), other.answer()) {
        (Ok(one), Ok(other)) => (one, other),
        (Err(message), _) | (_, Err(message)) => return report.unanswered("pieces", &message),
    };
    let negative = one.negative.zip(other.negative).map(|(one, other)| one + other);
    let apart = Ok(Answer { energy: one.energy + other.energy, negative, ..one });
    match both.answer() {
        Ok(together) => report.compare("pieces", (&both, &together), &apart, 1.0, &what),
        Err(message) => report.unanswered("pieces", &message),
    }
}

/// One cell as a finite sheet.
fn without_lattice(cell: &Sheet) -> Sheet {
    let mut corners: Vec<Corner> = cell.polygons.iter().flatten().copied().collect();
    corners.sort_unstable();
    corners.dedup();
    let number = |corner: &Corner| Corner::home(corners.binary_search(corner).unwrap());
    let vertices = corners.iter().map(|corner| cell.position(*corner)).collect();
    let polygons = cell.polygons.iter().map(|polygon| polygon.iter().map(number).collect()).collect();
    built(Sheet { title: cell.title.clone(), vertices, polygons, ..Sheet::default() })
}

/// Both finite sheets as one, the second ten units away.
fn side_by_side(one: &Trial, other: &Trial) -> Trial {
    let first = one.sheet.vertices.len();
    let vertices = one.sheet.vertices.iter().copied();
    let vertices = vertices.chain(other.sheet.vertices.iter().map(|p| p + Vec3::new(10.0, 0.0, 0.0))).collect();
    let later = |polygon: &Vec<Corner>| polygon.iter().map(|c| Corner::home(c.vertex + first)).collect();
    let polygons = one.sheet.polygons.iter().cloned().chain(other.sheet.polygons.iter().map(later)).collect();
    let sheet = built(Sheet { title: "pieces".to_owned(), vertices, polygons, ..Sheet::default() });
    let off = |key: &EdgeKey| {
        let (trial, less) = if key.i < first { (one, 0) } else { (other, first) };
        let key = EdgeKey { i: key.i - less, j: key.j - less, shift: key.shift, round: 0 };
        trial.off[trial.sheet.edges.iter().position(|edge| edge.key == key).unwrap()]
    };
    let off = sheet.edges.iter().map(|edge| off(&edge.key)).collect();
    Trial { sheet, off, ..one.clone() }
}

/// A cell rolled up to a tube.
#[derive(Clone)]
struct TubeTrial {
    cell: Sheet,
    seam: [i32; 2],
    kept: SeamKept,
    inwards: bool,
    bars: f64,
    /// Rest angles less those of the tube rolled up.
    off: Vec<f64>,
}

impl TubeTrial {
    fn new(seed: u64) -> Self {
        let mut numbers = Numbers::new(seed.wrapping_mul(3) ^ 0x70be);
        let size = [[2, 2], [2, 3]][whole(&mut numbers, 2)];
        let cell = generate(&Pattern::Random(Random { size, seed, ..Random::default() })).unwrap();
        let seam = [[0, 8], [1, 8], [8, 0], [7, -3], [2, 6]][whole(&mut numbers, 5)];
        let kept = [SeamKept::BOTH, SeamKept { turn: true, rise: false }, SeamKept { turn: false, rise: true }];
        let kept = kept[whole(&mut numbers, 3)];
        let bars = [1e2, 1e4, 1e6, f64::INFINITY][whole(&mut numbers, 4)];
        let off = numbers.many(cell.edges.len(), 0.05);
        Self { cell, seam, kept, inwards: numbers.within(1.0) > 0.0, bars, off }
    }

    fn assembly(&self) -> Result<Assembly, String> {
        let roll = rolled_up(&self.cell, self.seam, self.kept, self.inwards).map_err(|error| error.to_string())?;
        let bare = Assembly::tube_without_terms(self.cell.clone(), &roll, [1, 1]).map_err(|error| error.to_string())?;
        let rest = bare.start_angles().iter().zip(&self.off).map(|(angle, off)| angle + off).collect();
        Ok(bare.with_terms(Terms::bars_and_creases(self.bars, 1.0, rest)))
    }

    /// The energy, and the negative eigenvalues.
    fn answer(&self) -> Result<(f64, Option<usize>), String> {
        let model = self.assembly()?.model(Gauge::Held);
        let found = relax_from(&model, model.start(), Options::default(), &mut |_| true).map_err(|e| e.to_string())?;
        Ok((found.state.total(), found.negative_eigenvalues))
    }

    /// Whether random starts reach such an energy.
    fn has_equilibrium(&self, such: impl Fn(f64) -> bool) -> bool {
        let Ok(assembly) = self.assembly() else { return false };
        [0.05, 0.3].into_iter().any(|spread| {
            let starts = Starts { count: STARTS, seed: 1, spread, options: Options::default() };
            let outcomes = relax_around(&assembly, None, &starts, &|| true);
            outcomes.iter().any(|outcome| matches!(outcome, Outcome::Well(found) if such(found.energy)))
        })
    }
}

/// A tube, in another unit, mirrored, with its seam the other way round, and with fewer conditions.
pub fn tubes(seed: u64, report: &mut Report) {
    let tube = TubeTrial::new(seed);
    let TubeTrial { seam, kept, bars, .. } = tube;
    let what = format!("tube {seed}, seam {seam:?}, {kept:?}, bars {bars:e}");
    let (energy, negative) = match tube.answer() {
        Ok(answer) => answer,
        Err(message) => return report.unanswered("tube", &message),
    };
    report.judge("tube", energy.is_finite(), || what.clone());
    let scaled_by = |unit: f64| TubeTrial { cell: scaled(tube.cell.clone(), unit), ..tube.clone() };
    let mut mirrored = tube.clone();
    mirrored.cell.vertices.iter_mut().for_each(|p| p.z = -p.z);
    mirrored.off.iter_mut().for_each(|off| *off = -*off);
    mirrored.inwards = !tube.inwards;
    let reversed = TubeTrial { seam: seam.map(|n| -n), ..tube.clone() };
    let others = [
        ("tube in another unit", scaled_by(1000.0), 1000.0),
        ("tube in another unit", scaled_by(0.9), 0.9),
        ("tube mirrored", mirrored, 1.0),
        ("tube with its seam reversed", reversed, 1.0),
    ];
    for (kind, other, unit) in others {
        let (found, other_negative) = match other.answer() {
            Ok(answer) => answer,
            Err(message) => {
                report.unanswered(kind, &message);
                continue;
            }
        };
        let same = |found: f64| (found - energy).abs() <= SAME * energy + 1e-13;
        let close = same(found / unit);
        let stable = [negative, other_negative] == [Some(0); 2];
        if !close && (!stable || tube.has_equilibrium(|energy| (energy - found / unit).abs() <= 10.0 * SAME * energy)) {
            report.count(ELSEWHERE, true);
            continue;
        }
        report.judge(kind, close, || format!("{what}: {energy:e} and {:e}", found / unit));
    }
    for kept in [SeamKept { turn: true, rise: false }, SeamKept { turn: false, rise: true }] {
        freer(&tube, (energy, negative), kept, report, &what);
    }
}

/// A closed tube that gives up a condition costs no more.
fn freer(tube: &TubeTrial, (energy, negative): (f64, Option<usize>), kept: SeamKept, report: &mut Report, what: &str) {
    if tube.kept != SeamKept::BOTH || negative != Some(0) {
        return;
    }
    let other = TubeTrial { kept, ..tube.clone() };
    match other.answer() {
        Ok((found, negative)) => {
            let low = |found: f64| found <= energy * (1.0 + SAME) + 1e-13;
            if !low(found) && (negative != Some(0) || other.has_equilibrium(low)) {
                return report.count(ELSEWHERE, true);
            }
            report.judge("tube of fewer conditions", low(found), || format!("{what}: {found:e} above {energy:e}"));
        }
        Err(message) => report.unanswered("tube of fewer conditions", &message),
    }
}
