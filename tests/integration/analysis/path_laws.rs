//! Laws of driven paths: the reaction is the force that the rest of the sheet feels, states do not depend on the way
//! that led to them, a relaxation finds them too, and a drum has the states of its closed form at every stiffness of
//! its creases, and stiffer and stiffer bars lead to the rigid limit.

use foldwell::analysis::path::{PathBranch, PathEnd, PathEvent, PathOptions, PathPoint, follow_path};
use foldwell::analysis::relax::relax_from;
use foldwell::kinematics::folding_modes;
use foldwell::math::Vec3;
use foldwell::model::{Drive, Driven, Gauge, TermKind};
use foldwell::sheet::fold;
use foldwell::solver::{Options, Start};
use foldwell::{Assembly, Pattern, RIGID, Rest, generate, relax};
use std::f64::consts::FRAC_PI_3;

const HEIGHT: f64 = 1.2;
const TWIST: f64 = 1.9;
/// Height and twist of the state without energy beside the drawn one, and of the pass between both: theory of the drum.
const SECOND: [f64; 2] = [0.877_968_604, 2.288_790_20];
const PASS: [f64; 2] = [1.055_483_23, 2.0 * FRAC_PI_3];
const PASS_ENERGY: f64 = 9.354_503_16e-5;

/// The drum of six sides between a fixed plate and one that moves along z and turns about it.
fn drum(creases: Option<f64>) -> Assembly {
    let mut pattern = Pattern::named("kresling").unwrap();
    if let Pattern::Kresling(kresling) = &mut pattern {
        (kresling.height, kresling.twist, kresling.closed) = (HEIGHT, TWIST, true);
    }
    let plate = |first: usize| (first..first + 6).map(|vertex| (vertex, [0, 0]));
    let builder = Assembly::patch(generate(&pattern).unwrap(), [1, 1]).bars(1.0);
    let builder = builder.part(plate(0), [false; 6]).part(plate(6), [false, false, true, false, false, true]);
    creases.map_or(builder.clone(), |stiffness| builder.creases(stiffness)).build().unwrap()
}

fn press(to: f64) -> Drive {
    Drive { quantity: Driven::Part { part: 1, axis: 2 }, to }
}

fn followed(assembly: &Assembly, drive: &Drive, start: Option<&PathPoint>) -> PathBranch {
    let start = start.map(PathPoint::configuration);
    let branch = follow_path(assembly, drive, start, &PathOptions::default(), &mut |_, _| true).unwrap().remove(0);
    assert_eq!(branch.end, PathEnd::Arrived);
    branch
}

fn last(branch: &PathBranch) -> &PathPoint {
    branch.points.last().unwrap()
}

/// Height of the upper plate, and its twist against the lower one, modulo a sixth of a turn.
fn shape(point: &PathPoint) -> [f64; 2] {
    let vertex = |k: usize| Vec3::from_column_slice(&point.state.coordinates[3 * k..3 * k + 3]);
    let (below, above) = (vertex(0), vertex(6));
    [above.z - below.z, above.y.atan2(above.x) - below.y.atan2(below.x)]
}

/// The state of a path at which the reaction vanishes between two of its states, by false position on short paths.
fn without_reaction(assembly: &Assembly, branch: &PathBranch) -> PathPoint {
    let pair = branch.points.windows(2).skip(1).find(|pair| pair[0].reaction * pair[1].reaction < 0.0).unwrap();
    let (mut from, other) = (pair[0].clone(), &pair[1]);
    let slope = (other.reaction - from.reaction) / (other.drive - from.drive);
    for _ in 0..20 {
        if from.reaction.abs() < 1e-10 {
            break;
        }
        from = last(&followed(assembly, &press(-from.reaction / slope), Some(&from))).clone();
    }
    from
}

/// Claim: with bars of EA = 1 and creases of none or 1e-12 of it, the drum has both limit points, the unstable state
/// and the second state of its closed form; with more crease energy the limit force tends to it in proportion. Source:
/// bars of lengths `sqrt(h^2 + 2 - 2 cos t)` and `sqrt(h^2 + 2 - 2 cos(t - pi/3))`, minimised over the twist, in 40
/// digits; states in nine. Tolerance: 1e-8, as the digits of the states allow.
#[test]
fn a_drum_has_the_states_of_its_closed_form() {
    let limits = [[1.145_092_671_426_46, -1.015_608_266_287_35e-3], [0.962_532_976_931_361, 8.030_698_430_453_93e-4]];
    for creases in [None, Some(1e-12)] {
        let assembly = drum(creases);
        let branch = followed(&assembly, &press(-0.36), None);
        let found: Vec<&PathPoint> = branch.points.iter().filter(|p| p.event == Some(PathEvent::LimitLoad)).collect();
        assert_eq!(found.len(), 2);
        for (point, [height, force]) in found.iter().zip(limits) {
            assert!((HEIGHT + point.drive - height).abs() <= 1e-8, "{creases:?} {}", point.drive);
            assert!((point.reaction - force).abs() <= 1e-10, "{creases:?} {}", point.reaction);
        }
        let pass = without_reaction(&assembly, &branch);
        let [height, twist] = shape(&pass);
        assert!((height - PASS[0]).abs() <= 1e-8 && (twist - PASS[1]).abs() <= 1e-8, "{creases:?} {height} {twist}");
        assert!((pass.state.total() - PASS_ENERGY).abs() <= 1e-8 * PASS_ENERGY + 1e-11, "{}", pass.state.total());
        let rest = PathBranch { points: branch.points[branch.points.len() / 2..].to_vec(), end: PathEnd::Arrived };
        let second = without_reaction(&assembly, &rest);
        let [height, twist] = shape(&second);
        assert!((height - SECOND[0]).abs() <= 1e-8 && (twist - SECOND[1]).abs() <= 1e-8, "{height} {twist}");
        assert!(second.state.total() <= 1e-10);
    }
    let limit_force = |creases: f64| {
        let branch = followed(&drum(Some(creases)), &press(-0.1), None);
        branch.points.iter().find(|p| p.event == Some(PathEvent::LimitLoad)).unwrap().reaction
    };
    let [a, b] = [1e-7, 1e-8].map(|creases| (limit_force(creases) - limits[0][1]) / creases);
    assert!((a / b - 1.0).abs() <= 1e-2, "{a} {b}");
}

/// Claim: the reaction on the driven plate is the vertical force of the bars between both plates, at every state.
/// Tolerance: 1e-10 of the largest.
#[test]
fn reactions_balance_the_bars() {
    let assembly = drum(None);
    let branch = followed(&assembly, &press(-0.4), None);
    let largest = branch.points.iter().map(|point| point.reaction.abs()).fold(0.0, f64::max);
    let edges = &assembly.tiling().edges;
    for point in &branch.points {
        let z = |vertex: usize| point.state.coordinates[3 * vertex + 2];
        let vertex = |k: usize| Vec3::from_column_slice(&point.state.coordinates[3 * k..3 * k + 3]);
        let mut force = 0.0;
        for (edge, tension) in edges.iter().zip(&point.state.tension) {
            let [a, b] = edge.ends.map(|site| site.vertex);
            if (a < 6) != (b < 6) {
                force += tension * (z(a) - z(b)).abs() / (vertex(a) - vertex(b)).norm();
            }
        }
        assert!((force - point.reaction).abs() <= 1e-10 * largest, "{force} {}", point.reaction);
    }
}

/// Claim: where no snap lies between, the way back leads through the same states, and the work is given back.
/// Tolerance: 1e-9 of lengths, 1e-8 of the work.
#[test]
fn up_and_down_lead_through_the_same_states() {
    let assembly = drum(Some(1e-6));
    let half = followed(&assembly, &press(-0.1), None);
    let down = followed(&assembly, &press(-0.2), None);
    let up = followed(&assembly, &press(0.1), Some(last(&down)));
    let apart = |a: &PathPoint, b: &PathPoint| {
        let pairs = a.state.coordinates.iter().zip(&b.state.coordinates);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    assert!(apart(last(&up), last(&half)) <= 1e-9, "{}", apart(last(&up), last(&half)));
    let works = [last(&half).work, last(&down).work + last(&up).work];
    let largest = down.points.iter().map(|point| point.work.abs()).fold(0.0, f64::max);
    assert!((works[0] - works[1]).abs() <= 1e-8 * largest, "{works:?}");
}

/// Claim: a relaxation under the force that a path ended with finds the state in which it ended, with its energy: of
/// the two-bar truss before it snaps. Tolerance: 1e-10 of the energy and of the height.
#[test]
fn a_relaxation_finds_the_end_of_a_path() {
    let truss = || {
        let builder = Assembly::patch(generate(&Pattern::named("truss").unwrap()).unwrap(), [1, 1]).bars(1.0);
        builder.pin(0, [0, 0], [true; 3]).pin(2, [0, 0], [true; 3]).pin(1, [0, 0], [false, true, false])
    };
    let quantity = Driven::Vertices { vertices: vec![1], direction: Vec3::z() };
    let assembly = truss().build().unwrap();
    let branch = followed(&assembly, &Drive { quantity, to: -0.1 }, None);
    let end = last(&branch);
    let loaded = truss().pin(1, [0, 0], [true, true, false]).load(1, [0, 0], [0.0, 0.0, end.reaction]).build();
    let model = loaded.unwrap().model(Gauge::Held);
    let start = Start::from(model.start());
    let found = relax_from(&model, start, Options::default(), &mut |_| true).unwrap();
    assert!((found.state.total() - end.state.total()).abs() <= 1e-10 * end.state.total());
    assert!((found.state.coordinates[5] - 0.2).abs() <= 1e-10, "{:?}", found.state.coordinates);
    assert_eq!(found.negative_eigenvalues, Some(0));
}

/// Claim: the stiffness of the bars of a patch is driven from 1e2 to infinity along one branch, whose end is the rigid
/// equilibrium: its energy is the work of making bars stiffer more than that at the beginning. Source: a relaxation
/// with exactly rigid bars. Tolerance: 1e-9 of the energy, and 1e-8 rad, as both are relaxed to 1e-12.
#[test]
fn stiffness_leads_to_the_rigid_limit() {
    let sheet = fold::parse(include_str!("../../../meshes/open-star.fold"), "open-star.fold").unwrap();
    let rates = folding_modes(&sheet).unwrap().named([0.05, 0.05, 0.0]).unwrap();
    let bare = Assembly::patch(sheet.clone(), [4, 4]).build().unwrap();
    let drawn = bare.tiling().edges.iter().zip(bare.drawn_angles());
    let rest: Vec<f64> = drawn.map(|(edge, angle)| angle + rates[edge.edge]).collect();
    let with = |bars: f64| {
        let builder = Assembly::patch(sheet.clone(), [4, 4]).bars(bars).creases(1.0);
        builder.rest(Rest::PerEdge(rest.clone())).build().unwrap()
    };
    let drive = Drive { quantity: Driven::Stiffness(TermKind::Bars), to: RIGID };
    let branch = followed(&with(1e2), &drive, None);
    let end = last(&branch);
    let rigid = relax(&with(RIGID)).unwrap();
    assert!(branch.points.iter().all(|point| point.event.is_none() && point.negative_eigenvalues == Some(0)));
    assert!(end.drive.is_infinite() && branch.points[0].drive == 1e2);
    let [found, expected] = [end.state.total(), rigid.state.total()];
    assert!((found - expected).abs() <= 1e-9 * expected, "{found} {expected}");
    let angles = end.state.fold_angle.iter().zip(&rigid.state.fold_angle).filter(|(a, _)| a.is_finite());
    let apart = angles.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart <= 1e-8, "{apart}");
    let gained = found - branch.points[0].state.total();
    assert!((end.work - gained).abs() <= 1e-8 * found, "{} {gained}", end.work);
}
