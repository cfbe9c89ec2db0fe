//! Branch points of drums against group theory: which multiplicities they may have, and how many half branches leave.
//!
//! A drum of N sides on a pinned ring under equal loads has the N rotations about its axis for symmetries, and, where
//! its triangles are isosceles, N planes of reflection besides. Null vectors at a branch point of the symmetric path
//! are an irreducible representation of this group (M. Golubitsky, I. Stewart, D. Schaeffer, "Singularities and Groups
//! in Bifurcation Theory", volume 2, 1988): wave number `k = N/2` (neighbours move alternately, N even) is simple,
//! `0 < k < N/2` double, and `k = 0` keeps the symmetry and is no branch point. With an energy the reduced equations
//! for a double one are the gradient of `f(|z|^2) + Re(q z^m) + ...`, `m = N / gcd(N, k)`, also where rotations alone
//! are symmetries and `q` is complex: `2 m` half branches leave, and two at a simple one.

use crate::common::stressed_hessian;
use foldwell::Assembly;
use foldwell::analysis::path::{HalfBranches, PathEvent, PathOptions, PathPoint, PathStop, follow_path};
use foldwell::math::Vec3;
use foldwell::model::{Drive, Driven, Gauge};
use foldwell::numerics::DenseMatrix;
use foldwell::sheet::generate::Kresling;
use foldwell::sheet::{Pattern, generate};
use nalgebra::Rotation3;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

/// Eigenvalues relative to the largest one below which they vanish at a branch point, and the least ratio of the next
/// one to them.
const VANISHES: f64 = 1e-7;
const NEXT: f64 = 1e2;
/// Largest error of the number of times that a representation occurs: symmetry of states to the tolerance of a path,
/// enlarged by the softest eigenvalues.
const WHOLE: f64 = 1e-3;

/// Length of paths.
const ARC: f64 = 3.0;
/// Branch points of a drum whose half branches are counted, and how far the path and the branches go beyond the last
/// one.
const FEW: usize = 3;
const BEYOND: f64 = 0.02;
/// Pairs of sides and wave numbers for which all half branches must be found.
const LEAST_TOLD: usize = 9;

/// A drum: sides, storeys, their twist in parts of the turn by one side, and their height. With a twist of a half the
/// triangles are isosceles.
#[derive(Clone, Copy, Debug)]
struct Drum {
    sides: usize,
    levels: usize,
    twist: f64,
    height: f64,
}

/// Drums that have branch points.
fn drums() -> Vec<Drum> {
    let of = |levels, twist, height, sides: &'static [usize]| {
        sides.iter().map(move |&sides| Drum { sides, levels, twist, height })
    };
    of(1, 1.2, 0.4, &[3])
        .chain(of(1, 1.5, 0.4, &[5, 6]))
        .chain(of(1, 1.8, 0.4, &[6, 7, 8]))
        .chain(of(1, 0.5, 0.7, &[4, 6, 8]))
        .chain(of(2, 0.5, 1.2, &[4, 6, 7]))
        .chain(of(2, 1.5, 0.7, &[5]))
        .chain(of(2, 1.8, 0.4, &[4]))
        .chain(of(2, 1.8, 1.2, &[6, 7, 8]))
        .collect()
}

impl Drum {
    fn assembly(&self) -> Assembly {
        let Self { sides, levels, twist, height } = *self;
        let twist = twist * TAU / sides as f64;
        let pattern = Kresling { sides, levels: Some(levels), height, twist, ..Kresling::default() };
        let sheet = generate(&Pattern::Kresling(pattern)).unwrap();
        let mut builder = Assembly::patch(sheet, [1, 1]).bars(500.0).creases(0.001);
        for k in 0..sides {
            builder = builder.pin(k, [0, 0], [true; 3]).load(levels * sides + k, [0, 0], [0.0, 0.0, -1.0]);
        }
        builder.build().unwrap()
    }

    /// The branch points of the path under growing loads; where it ends at a length, with the branches that leave
    /// there.
    fn branch_points(self, assembly: &Assembly, branches_to: Option<f64>) -> Vec<PathPoint> {
        let stop = PathStop { arc_length: Some(branches_to.unwrap_or(ARC)), ..PathStop::default() };
        let options = PathOptions { switch: branches_to.is_some(), stop, ..PathOptions::default() };
        let drive = Drive { quantity: Driven::Loads, to: 1.0 };
        let path = follow_path(assembly, &drive, None, &options, &mut |_, _| true).unwrap().remove(0);
        path.points.into_iter().filter(|point| point.event == Some(PathEvent::BranchPoint)).collect()
    }

    /// Rates of all coordinates turned by one side: vertex `k` moves as its neighbour `k - 1` did.
    fn turned(&self, rates: &[f64]) -> Vec<f64> {
        let turn = Rotation3::from_axis_angle(&Vec3::z_axis(), TAU / self.sides as f64);
        let vertices = rates.len() / 3;
        let before = |v: usize| v / self.sides * self.sides + (v + self.sides - 1) % self.sides;
        (0..vertices)
            .flat_map(|v| <[f64; 3]>::from(turn * Vec3::from_column_slice(&rates[3 * before(v)..3 * before(v) + 3])))
            .collect()
    }

    /// How often each wave number occurs among null vectors, columns of rates: the mean over the rotations of their
    /// trace times the character.
    fn wave_numbers(&self, nulls: &DenseMatrix) -> Vec<f64> {
        let (sides, mut image) = (self.sides, nulls.clone());
        let mut traces = vec![];
        for _ in 0..sides {
            traces.push(nulls.dot(&image));
            for mut column in image.column_iter_mut() {
                let turned = self.turned(column.as_slice());
                column.copy_from_slice(&turned);
            }
        }
        (0..=sides / 2)
            .map(|k| {
                let character = |n: usize| (TAU * (k * n) as f64 / sides as f64).cos();
                traces.iter().enumerate().map(|(n, trace)| character(n) * trace).sum::<f64>() / sides as f64
            })
            .collect()
    }
}

/// Null vectors of the whole stiffness at a branch point, as orthonormal rates of all coordinates, by dense
/// eigenvectors.
fn null_vectors(assembly: &Assembly, point: &PathPoint) -> DenseMatrix {
    let mut model = assembly.model(Gauge::Held);
    let x = model.enter(&point.configuration()).x;
    let found = stressed_hessian(&model, &x, &point.tension).symmetric_eigen();
    let largest = found.eigenvalues.amax();
    let mut order: Vec<usize> = (0..found.eigenvalues.len()).collect();
    order.sort_by(|a, b| found.eigenvalues[*a].abs().total_cmp(&found.eigenvalues[*b].abs()));
    let size = |k: usize| found.eigenvalues[order[k]].abs() / largest;
    let count = (0..order.len()).take_while(|&k| size(k) <= VANISHES).count();
    assert!(count > 0 && size(count) >= NEXT * size(count - 1), "{:?}", (0..4).map(size).collect::<Vec<_>>());
    let columns = order[..count].iter().map(|&k| model.velocity(found.eigenvectors.column(k).as_slice()));
    let columns: Vec<Vec<f64>> = columns.collect();
    DenseMatrix::from_fn(columns[0].len(), count, |i, j| columns[j][i])
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

/// The wave number at a branch point by its dense null vectors, which are one irreducible representation.
fn wave_number(drum: &Drum, assembly: &Assembly, point: &PathPoint) -> usize {
    let nulls = null_vectors(assembly, point);
    let known = point.branch_point.unwrap().multiplicity;
    let occurs = drum.wave_numbers(&nulls);
    let what = format!("{drum:?} at {}: multiplicity {known}, wave numbers {occurs:?}", point.drive);
    assert_eq!(known, nulls.ncols(), "{what}");
    assert!(occurs.iter().all(|times| (times - times.round()).abs() <= WHOLE), "{what}");
    let present: Vec<usize> = (0..occurs.len()).filter(|&k| occurs[k].round() != 0.0).collect();
    assert!(present.len() == 1 && occurs[present[0]].round() == 1.0, "{what}");
    assert!(present[0] > 0, "{what}: the symmetry is kept");
    assert_eq!(known, if 2 * present[0] == drum.sides { 1 } else { 2 }, "{what}");
    present[0]
}

/// Claim: null vectors at every branch point of drums of 3 to 8 sides, of one and two storeys, are one irreducible
/// representation of the rotations, other than the trivial one, and the multiplicity that is reported is its dimension:
/// only drums of an even number of sides have simple ones. Source: representations of cyclic groups; null vectors by
/// dense eigenvectors of another library. Tolerance: that of the located states, see the constants.
#[test]
fn multiplicities_are_dimensions_of_representations() {
    let mut found = BTreeMap::new();
    for drum in drums() {
        let assembly = drum.assembly();
        for point in drum.branch_points(&assembly, None) {
            *found.entry((drum.sides, wave_number(&drum, &assembly, &point))).or_insert(0) += 1;
        }
    }
    println!("branch points by sides and wave number: {found:?}");
    assert!((3..=8).all(|sides| found.keys().any(|(of, _)| *of == sides)), "{found:?}");
    assert!(found.len() >= 10, "{found:?}");
}

/// Claim: two half branches leave a simple branch point of a drum, and `2 N / gcd(N, k)` a double one of wave number
/// `k`, with and without planes of reflection, wherever the program says that it found all. Source and tolerance: see
/// above; on rings that are too narrow for the force between half branches, which falls as the power `m - 1` of their
/// radius, nothing is said.
#[test]
fn half_branches_of_drums_are_those_of_group_theory() {
    let mut told = BTreeSet::new();
    let mut untold = 0;
    for drum in drums() {
        let assembly = drum.assembly();
        let all = drum.branch_points(&assembly, None);
        let Some(last) = all.iter().take(FEW).next_back() else { continue };
        for point in drum.branch_points(&assembly, Some(last.arc_length + BEYOND)) {
            let k = wave_number(&drum, &assembly, &point);
            let expected =
                if 2 * k == drum.sides { 2 } else { 2 * drum.sides / greatest_common_divisor(drum.sides, k) };
            match point.branch_point.unwrap().half_branches {
                Some(known @ HalfBranches { expected: Some(_), .. }) => {
                    let right = HalfBranches { found: expected, expected: Some(expected), ..known };
                    assert_eq!(known, right, "{drum:?} at {}, wave number {k}", point.drive);
                    told.insert((drum.sides, k));
                }
                _ => untold += 1,
            }
        }
    }
    println!("all half branches found, by sides and wave number: {told:?}; {untold} points without a number");
    assert!(told.len() >= LEAST_TOLD, "{told:?}");
}
