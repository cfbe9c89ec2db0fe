//! Tests of the chain rule of every domain: gradient and Hessian in an element's coordinates.

use super::{RandomNumbers, symmetric};
use crate::math::Vec3;
use crate::model::gauge::{choose, rigid_motions};
use crate::model::measure::{FoldAngle, Length, Measure};
use crate::model::problem::{LEFT_WING, RIGHT_WING};
use crate::model::{Affine, CellMap, CellMaps, Domain, OwnDomain, Site};
use crate::numerics::derivatives::{TOLERANCE, check_gradient, check_jacobian};
use crate::sheet::{Seam, SeamKept};
use nalgebra::{Matrix3, Rotation3};
use std::f64::consts::{PI, TAU};

/// The coordinates of four vertices of a cell, followed by the shared coordinates.
fn state(numbers: &mut RandomNumbers, domain: &Domain, kappa: f64) -> Vec<f64> {
    let mut x: Vec<f64> = [0.0, 0.0, 0.0, 0.9, 0.1, 0.2, 0.2, 0.8, -0.1, 1.1, 1.0, 0.1].to_vec();
    x.iter_mut().for_each(|c| *c += numbers.within(0.1));
    match domain {
        Domain::Patch | Domain::FixedTorus(_) => {}
        Domain::Own(_) => x.extend([0.7, 0.4]),
        Domain::FreeTorus => x.extend([2.0, 0.1, 0.05, 0.3, 1.9, -0.1]),
        Domain::Screw => x.extend([numbers.within(3.0), kappa, 0.2, 1.9, 2.0, 0.3]),
        Domain::Tube { kept, .. } => {
            x.chunks_exact_mut(3).for_each(|point| point[0] += 2.0);
            x.extend([0.7, 0.4]);
            x.extend([0.2, 0.9].iter().take(kept.free()));
        }
    }
    x
}

/// The element's coordinates: those of its points in their order, then the shared ones.
fn local<const N: usize>(domain: &Domain, x: &[f64], sites: &[Site; N]) -> Vec<f64> {
    let points = sites.iter().flat_map(|site| x[3 * site.vertex..3 * site.vertex + 3].to_vec());
    points.chain(x[x.len() - domain.shared()..].to_vec()).collect()
}

/// Checks gradient and Hessian of a measure through a domain, and that the Hessian of a hinge does not couple its
/// wings. Every point of the element gets a vertex of its own, since element coordinates are one triple for each
/// point.
fn check<M: Measure<N, D> + Default, const N: usize, const D: usize>(
    domain: &Domain,
    x: &[f64],
    sites: [Site; N],
    what: &str,
) {
    let local = local(domain, x, &sites);
    let mut own = sites;
    own.iter_mut().enumerate().for_each(|(k, site)| site.vertex = k);
    let home = M::default().value(&domain.points(&local, &own));
    let value = |x: &[f64]| {
        let value = M::default().value(&domain.points(x, &own));
        if M::ANGLE { value + TAU * ((home - value) / TAU).round() } else { value }
    };
    let placed = |x: &[f64], sites: &[Site; N]| sites.map(|site| domain.place(x, site));
    let gradient = |x: &[f64]| {
        let mut pulled = Vec::new();
        domain.pull_gradient(&placed(x, &own), &M::default().gradient(&domain.points(x, &own)).1, &mut pulled);
        pulled
    };
    let (mut lower, mut in_place) = (Vec::new(), Vec::new());
    let (_, g) = M::default().hessian(&domain.points(&local, &own), &mut lower);
    domain.pull_hessian(&placed(&local, &own), &g, &mut lower);
    domain.pull_gradient(&placed(x, &sites), &g, &mut in_place);
    let hessian = symmetric(local.len(), &lower);
    if M::HINGE {
        let wings =
            hessian.view((RIGHT_WING.start as usize, LEFT_WING.start as usize), (RIGHT_WING.len(), LEFT_WING.len()));
        assert!(
            wings.iter().all(|entry| *entry == 0.0),
            "{what}: torn factorizations leave out what couples the wings"
        );
    }
    assert_eq!(gradient(&local), in_place, "{what}: vertices of its own change nothing");
    check_gradient(value, &local, &gradient(&local), TOLERANCE).unwrap_or_else(|error| panic!("{what}: {error}"));
    check_jacobian(gradient, &local, &hessian, TOLERANCE).unwrap_or_else(|e| panic!("{what}, Hessian: {e}"));
}

fn site(vertex: usize, shift: [i32; 2]) -> Site {
    Site { vertex, shift }
}

/// Checks a bar and a hinge inside the cell, across its sides, far away, and with one vertex in two of its copies.
fn check_all(domain: &Domain, x: &[f64], what: &str) {
    let copies = !matches!(domain, Domain::Patch);
    let shift = |n: [i32; 2]| if copies { n } else { [0, 0] };
    for n in [[0, 0], [1, 0], [-1, 1], [2, 3]] {
        check::<Length, 2, 6>(domain, x, [site(0, [0, 0]), site(3, shift(n))], &format!("bar to {n:?}, {what}"));
        let sites = [site(0, [0, 0]), site(3, [0, 0]), site(2, [0, 0]), site(1, shift(n))];
        check::<FoldAngle, 4, 12>(domain, x, sites, &format!("hinge to {n:?}, {what}"));
    }
    if copies {
        check::<Length, 2, 6>(domain, x, [site(1, [0, 0]), site(1, [0, 1])], &format!("bar to its copy, {what}"));
        let sites = [site(0, [0, 0]), site(0, [1, 0]), site(2, [0, 0]), site(2, [1, -1])];
        check::<FoldAngle, 4, 12>(domain, x, sites, &format!("hinge over two copies, {what}"));
    }
}

/// Claim: gradient and Hessian of bars and hinges are right on a patch and on both tori. Source: extrapolated
/// differences.
#[test]
fn patch_and_tori() {
    let lattice = [Vec3::new(2.0, 0.1, 0.05), Vec3::new(0.3, 1.9, -0.1)];
    for domain in [Domain::Patch, Domain::FixedTorus(lattice), Domain::FreeTorus] {
        for seed in 0..6 {
            let x = state(&mut RandomNumbers::new(seed), &domain, 0.0);
            check_all(&domain, &x, &format!("{domain:?}, seed {seed}"));
        }
    }
}

/// Cells along a helix about the z axis; turn and rise of a cell are shared.
struct Helix;

impl CellMaps for Helix {
    fn shared(&self) -> usize {
        2
    }

    fn map(&self, shared: &[f64], cell: [i32; 2]) -> CellMap {
        let number = f64::from(cell[0] + 3 * cell[1]);
        let turn = |quarters: f64| Rotation3::new(Vec3::z() * (number * shared[0] + quarters * 0.5 * PI)).into_inner();
        let across = Matrix3::from_diagonal(&Vec3::new(1.0, 1.0, 0.0));
        let still = Affine { linear: Matrix3::zeros(), shift: Vec3::zeros() };
        let by_turn =
            |times: i32| Affine { linear: number.powi(times) * turn(f64::from(times)) * across, ..still.clone() };
        CellMap {
            map: Affine { linear: turn(0.0), shift: number * shared[1] * Vec3::z() },
            first: vec![by_turn(1), Affine { shift: number * Vec3::z(), ..still.clone() }],
            second: vec![by_turn(2), still.clone(), still.clone()],
        }
    }
}

/// Claim: gradient and Hessian of bars and hinges are right on a domain of one's own whose maps depend on shared
/// coordinates to every order. Source: extrapolated differences. Its rigid motions are those of a helix: along the axis
/// and about it; the latter is none where loads may turn the sheet.
#[test]
fn a_domain_of_ones_own() {
    let domain = Domain::Own(OwnDomain::new(Helix));
    for seed in 0..6 {
        let x = state(&mut RandomNumbers::new(seed), &domain, 0.0);
        check_all(&domain, &x, &format!("a helix, seed {seed}"));
        let motions = rigid_motions(&domain, &x, true);
        assert_eq!(choose(&motions, &vec![false; x.len()]).len(), 2);
        let along = rigid_motions(&domain, &x, false);
        assert_eq!(choose(&along, &vec![false; x.len()]).len(), 1);
    }
}

/// Every set of closing conditions.
const KEPT: [SeamKept; 4] = [
    SeamKept::BOTH,
    SeamKept { turn: true, rise: false },
    SeamKept { turn: false, rise: true },
    SeamKept { turn: false, rise: false },
];

fn tube(seam: [i32; 2], kept: SeamKept) -> Domain {
    Domain::Tube { seam: Seam::new(seam).unwrap(), kept, counterclockwise: true }
}

/// Claim: they are right for tubes with every set of closing conditions, with one strand and with several. Source:
/// extrapolated differences.
#[test]
fn tubes_with_every_condition() {
    for seam in [[0, 5], [1, 4], [4, -2]] {
        for kept in KEPT {
            let domain = tube(seam, kept);
            for seed in 0..3 {
                let x = state(&mut RandomNumbers::new(seed), &domain, 0.0);
                check_all(&domain, &x, &format!("seam {seam:?}, {kept:?}, seed {seed}"));
            }
        }
    }
}

/// Claim: on a closed tube the copy of a point in the cell of the seam is the point itself, to the last bit; motions to
/// cells commute and add. Tolerance of the second part: rounding of numbers of size 5.
#[test]
fn a_closed_tube_comes_back_to_itself() {
    for seam in [[0, 5], [1, 4], [4, -2], [-6, 3]] {
        let domain = tube(seam, SeamKept::BOTH);
        let x = state(&mut RandomNumbers::new(3), &domain, 0.0);
        for n in [[0, 0], [1, 0], [2, -1], [-3, 4]] {
            let around = [n[0] + seam[0], n[1] + seam[1]];
            assert_eq!(domain.point(&x, site(1, n)), domain.point(&x, site(1, around)), "{seam:?} {n:?}");
            let mut there = x.clone();
            let first: [f64; 3] = domain.point(&x, site(1, [1, 0])).into();
            there[3..6].copy_from_slice(&first);
            let sum = domain.point(&x, site(1, [n[0] + 1, n[1]]));
            assert!((domain.point(&there, site(1, n)) - sum).norm() < 1e-13, "{seam:?} {n:?}");
        }
    }
}

/// Claim: they are right for screw motions of every curvature: zero, where the chart's formulas are 0/0, 1e-9, 1e-4,
/// moderate values of both signs, and one at which a cell rotates by 2 rad and its third copy by a whole turn.
/// Source: extrapolated differences.
#[test]
fn screws_of_any_curvature() {
    for kappa in [0.0, 1e-9, -1e-9, 1e-4, 0.07, -0.3, 0.8, 1.1] {
        for seed in 0..4 {
            let x = state(&mut RandomNumbers::new(seed), &Domain::Screw, kappa);
            check_all(&Domain::Screw, &x, &format!("kappa {kappa:e}, seed {seed}"));
        }
    }
}

/// Claim: for `kappa != 0` every map is the rotation by `kappa b` about the line along the axis at the height
/// `1/kappa` with the translation `h`, and at `kappa = 0` the translation by the lattice. Source: theory of the screw
/// chart. Tolerance: rounding of the radius.
#[test]
fn screws_turn_about_their_axis() {
    let mut numbers = RandomNumbers::new(9);
    for kappa in [0.0, 1e-3, 0.2, -0.7] {
        let x = state(&mut numbers, &Domain::Screw, kappa);
        let s = &x[12..];
        for n in [[1, 0], [0, 1], [-2, 3]] {
            let [n1, n2] = n.map(f64::from);
            let lattice = Vec3::new(n1 * s[4] + n2 * s[5], n1 * s[2] + n2 * s[3], 0.0);
            let along = Vec3::new(s[0].cos(), s[0].sin(), 0.0);
            let (b, h) = (Vec3::z().cross(&along).dot(&lattice), along.dot(&lattice));
            let home = Vec3::from_column_slice(&x[3..6]);
            let expected = if kappa == 0.0 {
                home + lattice
            } else {
                let axis = Vec3::new(0.0, 0.0, 1.0 / kappa);
                nalgebra::Rotation3::new(along * (kappa * b)) * (home - axis) + axis + along * h
            };
            let found = Domain::Screw.point(&x, site(1, n));
            assert!(
                (found - expected).norm()
                    < 1e-15 * (10.0 + 4.0 / kappa.abs().max(0.1)).max(1e3 * f64::from(kappa == 1e-3))
            );
        }
    }
}
