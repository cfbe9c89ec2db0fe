//! Folded states of a periodic cell that are a curve: the planar folding of a triangulated Miura-ori, as a surface
//! study, a trajectory and a landscape of rigid wells see it, compared with rigid parallelograms and with the closed
//! form of the generator.

use crate::common::{on, turned};
use foldwell::analysis::surface::{FoldedSurface, SurfaceOptions, surface};
use foldwell::analysis::trace::{Folded, Stop, TraceOptions, Traced, trace};
use foldwell::analysis::wells::rigid::{RigidLandscape, Sampling, landscape};
use foldwell::kinematics::Closure;
use foldwell::math::{Vec3, rotation};
use foldwell::model::{Assembly, Boundary, Hinges, Terms};
use foldwell::sheet::generate::{Eggbox, Miura};
use foldwell::sheet::{EdgeKind, Pattern, Sheet, generate};
use foldwell::solver::atlas::Coverage;
use foldwell::solver::continuation::End;
use std::f64::consts::{PI, TAU};

fn miura(fold: f64) -> Sheet {
    generate(&Pattern::Miura(Miura { a: 1.0, b: 1.3, sector: 1.1, fold })).unwrap()
}

/// Returns the cell with facets of this stiffness, and creases that rest at these angles.
fn cell(sheet: Sheet, facets: f64, rest: &[f64]) -> Assembly {
    let facets = Some(Hinges { stiffness: facets.into(), rest: vec![0.0; sheet.edges.len()] });
    let terms = Terms { facets, ..Terms::bars_and_creases(f64::INFINITY, 1.0, rest.to_vec()) };
    on(sheet, [1, 1], Boundary::Screw).with_terms(terms)
}

fn drawn(sheet: &Sheet) -> Vec<f64> {
    sheet.edges.iter().map(|edge| sheet.drawn_angle(edge).unwrap()).collect()
}

/// Returns the rest angles: those of a crease at another fold, NaN on facets.
fn rest(sheet: &Sheet, fold: f64) -> Vec<f64> {
    let angles = drawn(&miura(fold));
    let of =
        |(edge, angle): (&foldwell::sheet::Edge, f64)| if edge.kind == EdgeKind::Crease { angle } else { f64::NAN };
    sheet.edges.iter().zip(angles).map(of).collect()
}

fn covered(assembly: &Assembly) -> FoldedSurface {
    let options = SurfaceOptions { radius: 0.2, tolerance: 3e-14, max_curvature: 1.0, max_points: 10_000 };
    surface(assembly, &options, &mut |_| true).unwrap()
}

fn traced(assembly: &Assembly) -> Vec<Traced> {
    let options = TraceOptions { max_step: 0.25, tolerance: 3e-14, branch: None, stop: Stop::default() };
    trace(assembly, &options, None, &mut |_, _| true).unwrap()
}

fn wells(assembly: &Assembly) -> RigidLandscape {
    landscape(assembly, &Sampling { step: 0.1, max_curvature: 1.0 }, &mut || true).unwrap()
}

/// Claim: all folded states of a Miura-ori whose facets fold are those of its planar folding, in which no facet folds:
/// one closed curve without curvature, the same as that of rigid parallelograms up to whole turns, with the fold angles
/// of the closed form, tan(s/2) = cos(sector) tan(z/2) between straight and zigzag creases. Tolerance: closure to 3e-14
/// over the smallest singular value along the curve, about 1e-2 next to the flat state; a point lies within half a step
/// of one of the other curve.
#[test]
fn all_folded_states_of_miura_ori() {
    let sheet = miura(0.4);
    let rest = rest(&sheet, 0.4);
    let found = covered(&cell(sheet.clone(), 1.0, &rest));
    assert_eq!((found.dimension, found.coverage, found.closed, found.lost), (1, Coverage::Complete, true, 0));
    let facets: Vec<usize> = (0..sheet.edges.len()).filter(|&k| sheet.edges[k].kind == EdgeKind::Facet).collect();
    let closure = Closure::of_cell(&sheet).unwrap();
    let number = |i: usize, j: usize| {
        sheet.edges.iter().position(|edge| (edge.key.i, edge.key.j, edge.key.shift) == (i, j, [0, 0])).unwrap()
    };
    let (zigzag, straight) = (number(0, 1), number(1, 3));
    for point in &found.points {
        let [(sz, cz), (ss, cs)] = [zigzag, straight].map(|edge| (0.5 * point.angles[edge]).sin_cos());
        assert!(
            (ss * cz - 1.1f64.cos() * cs * sz).abs() <= 1e-11,
            "{} {}",
            point.angles[zigzag],
            point.angles[straight]
        );
        assert!(
            facets.iter().all(|&facet| point.angles[facet].abs() <= 1e-11) && !(point.shape.curvature.abs() > 1e-12)
        );
        assert!(closure.residual(&point.angles).amax() <= 1e-13);
    }
    let stiff = covered(&cell(sheet.clone(), f64::INFINITY, &rest));
    assert_eq!((stiff.dimension, stiff.closed), (1, true));
    let wrapped = |off: f64| off - TAU * (off / TAU).round();
    let far = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| wrapped(a - b).powi(2)).sum::<f64>().sqrt();
    for point in &found.points {
        let nearest = stiff.points.iter().map(|other| far(&point.angles, &other.angles)).fold(f64::INFINITY, f64::min);
        assert!(nearest <= 0.1 + 1e-9, "{nearest} {:?}", point.angles);
    }
}

/// Claim: the trajectory of a Miura-ori whose facets fold leaves the drawn state without a lock, and comes back after
/// the arc length of rigid parallelograms; only the strains of its sides turn, where they do, and neither curvature nor
/// shear, which stay zero. Tolerance 1e-8: closing is found on the interpolant between states.
#[test]
fn its_trajectory_needs_no_lock() {
    let sheet = miura(0.4);
    let rest = rest(&sheet, 0.4);
    let [soft, stiff] = [1.0, f64::INFINITY].map(|facets| traced(&cell(sheet.clone(), facets, &rest)));
    assert_eq!((soft.len(), stiff.len()), (2, 2));
    for one in &soft {
        assert!(matches!(one.end, End::Closed(_)), "{:?}", one.end);
        let [length, other] = [one, &stiff[0]].map(|one| one.states.last().unwrap().arc_length);
        assert!((length - other).abs() <= 1e-8, "{length} {other}");
        let turned: Vec<usize> = one.turning_points.iter().map(|(quantity, _)| *quantity).collect();
        assert!(!turned.is_empty() && turned.iter().all(|quantity| [1, 2].contains(quantity)), "{turned:?}");
    }
}

/// Claim: along the planar folding of rigid parallelograms both strains of the sides turn at two states half a loop
/// apart, at which all creases are at multiples of pi, and nowhere else, however the sheet is drawn: at what fold, at
/// what angle. A state without any rotation of the lattice, or with one of rounding errors, is nothing special. Source:
/// the closed forms of both generators, whose lengths are monotonous between these states. Tolerance 1e-3: other folded
/// states cross the curve there, so that states beside them are not found.
#[test]
fn strains_turn_at_flat_and_stacked_states() {
    let miura = |fold: f64| Pattern::Miura(Miura { fold, ..Miura::default() });
    let eggbox = |fold: f64| Pattern::Eggbox(Eggbox { fold, ..Eggbox::default() });
    let mut exactly_straight = 0;
    for (pattern, k) in
        (0..8).flat_map(|k| [(miura(0.3 + 0.11 * f64::from(k)), k), (eggbox(0.6 + 0.11 * f64::from(k)), k)])
    {
        let turn = rotation::exp(&(0.4 * f64::from(k) * Vec3::new(0.9, -0.5, 0.7)));
        let sheet = turned(generate(&pattern).unwrap(), &turn);
        let unrested = vec![f64::NAN; sheet.edges.len()];
        for one in traced(&cell(sheet.clone(), f64::INFINITY, &unrested)) {
            assert!(matches!(one.end, End::Closed(_)), "{:?}", one.end);
            let half = 0.5 * one.states.last().unwrap().arc_length;
            let is_straight = |state: &&Folded| state.shape.as_ref().is_some_and(|shape| shape.screw.axis.is_none());
            exactly_straight += one.states.iter().filter(is_straight).count();
            let [a, b, c, d] = &one.turning_points[..] else { panic!("{pattern:?}: {}", one.turning_points.len()) };
            for (first, second) in [(a, b), (c, d)] {
                assert_eq!(first.0 + second.0, 3, "one of strain11 and one of strain22");
                assert!((first.1.arc_length - second.1.arc_length).abs() <= 1e-3);
            }
            assert!((c.1.arc_length - a.1.arc_length - half).abs() <= 1e-3);
            let folded = |angle: &f64| (angle / PI - (angle / PI).round()).abs() <= 1e-3;
            assert!([a, b, c, d].iter().all(|(_, state)| state.angles.iter().all(folded)), "{pattern:?}");
        }
    }
    assert!(exactly_straight >= 10, "{exactly_straight}");
}

/// Claim: creases that rest at the angles of another fold have one rigid well, there, with energy 0; the flat state, at
/// which other folded states leave the curve, is counted as a place beyond which nothing was sampled. Source: the
/// closed form of the generator. Tolerance: the error that the landscape states, about 1e-13.
#[test]
fn rigid_wells_on_the_curve() {
    for (drawn_at, resting) in [(0.4, 0.9), (1.2, 0.3)] {
        let sheet = miura(drawn_at);
        let found = wells(&cell(sheet.clone(), 0.5, &rest(&sheet, resting)));
        assert_eq!((found.dimension, found.wells.len(), found.lost, found.open), (1, 1, 0, 1), "{found:?}");
        let well = &found.wells[0];
        let off = well.angles.iter().zip(drawn(&miura(resting))).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off <= 1e-11 && well.energy <= 1e-22, "{off:e} {:e}", well.energy);
    }
}

/// Claim: where creases pull against each other a landscape on the curve has two wells and the pass between them, which
/// is the highest state of the curve there. Source: with tan(s/2) = cos(sector) tan(z/2) the energy is a function of z
/// alone; its stationary states are found on a grid and bisected. Tolerance 1e-9: bisection stops at rounding in z, and
/// a state is as exact as its slope, whose rounding errors are 1e-14 over a second derivative of some 0.1 and more.
#[test]
fn a_pass_between_wells_on_the_curve() {
    let sector = 1.4f64;
    let pattern = |fold| Pattern::Miura(Miura { a: 1.0, b: 1.0, sector, fold });
    let sheet = generate(&pattern(0.7)).unwrap();
    let angles = drawn(&sheet);
    let creases: Vec<usize> = (0..angles.len()).filter(|&k| sheet.edges[k].kind == EdgeKind::Crease).collect();
    let largest = creases.iter().fold(0.0, |most: f64, &k| most.max(angles[k].abs()));
    // the zigzag creases fold more than the straight ones
    let is_zigzag = |k: usize| angles[k].abs() > largest - 1e-9;
    let [zigzag_rest, straight_rest]: [f64; 2] = [0.1, 3.0];
    let mut rest = vec![f64::NAN; angles.len()];
    for &k in &creases {
        rest[k] = if is_zigzag(k) { zigzag_rest } else { straight_rest }.copysign(angles[k]);
    }
    let found = wells(&cell(sheet.clone(), 0.5, &rest));

    let length = |zigzag: bool| -> f64 {
        let of_kind = creases.iter().filter(|&&k| is_zigzag(k) == zigzag);
        let ends = of_kind.map(|&k| sheet.edges[k].key.ends().map(|end| sheet.position(end)));
        ends.map(|[i, j]| (j - i).norm()).sum()
    };
    let (long, short) = (length(true), length(false));
    let straight = |z: f64| 2.0 * (sector.cos() * (0.5 * z).tan()).atan();
    let energy = |z: f64| 0.5 * (long * (z - zigzag_rest).powi(2) + short * (straight(z) - straight_rest).powi(2));
    let slope = |z: f64| {
        let (cos, tan) = (sector.cos(), (0.5 * z).tan());
        let rate = cos * (1.0 + tan * tan) / (1.0 + (cos * tan).powi(2));
        long * (z - zigzag_rest) + short * (straight(z) - straight_rest) * rate
    };
    let grid: Vec<f64> = (1..1000).map(|k| PI * f64::from(k) / 1000.0).collect();
    let crossed = grid.windows(2).filter(|ends| slope(ends[0]).signum() != slope(ends[1]).signum());
    let stationary: Vec<f64> = crossed.map(|ends| bisected(&slope, [ends[0], ends[1]])).collect();
    let &[low, between, high] = stationary.as_slice() else { panic!("{stationary:?}") };
    assert!(energy(between) > energy(low).max(energy(high)) + 0.1);

    assert_eq!((found.dimension, found.wells.len(), found.passes.len(), found.lost), (1, 2, 1, 0), "{found:?}");
    let pass = &found.passes[0];
    assert!(!pass.singular && pass.joins[0] != pass.joins[1]);
    let mut expected = [low, high];
    expected.sort_by(|a, b| energy(*a).total_cmp(&energy(*b)));
    let states = found.wells.iter().map(|well| (well.energy, &well.angles)).chain([(pass.energy, &pass.angles)]);
    for ((height, state), z) in states.zip(expected.into_iter().chain([between])) {
        assert!((height - energy(z)).abs() <= 1e-9 * energy(z), "{height} {}", energy(z));
        for &k in &creases {
            let angle = if is_zigzag(k) { z } else { straight(z) };
            assert!((state[k].abs() - angle).abs() <= 1e-9, "{} {angle}", state[k]);
        }
    }
}

/// The zero of a function between two ends at which its signs differ.
fn bisected(function: &dyn Fn(f64) -> f64, [mut a, mut b]: [f64; 2]) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        let is_before = function(middle).signum() == function(a).signum();
        *(if is_before { &mut a } else { &mut b }) = middle;
    }
    0.5 * (a + b)
}

/// Claim: an eggbox has a surface, not a curve, and its landscape keeps dimension 2.
#[test]
fn an_eggbox_is_no_curve() {
    let sheet = generate(&Pattern::Eggbox(Eggbox { a: 1.0, b: 1.0, sector: PI / 3.0, fold: 0.9 })).unwrap();
    let rest = drawn(&sheet);
    let found = covered(&cell(sheet, 1.0, &rest));
    assert!(found.dimension == 2 && found.segments.is_empty() && !found.triangles.is_empty());
}
