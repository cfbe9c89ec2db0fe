//! Flat crease patterns, folded by their letters from the exactly flat state in which they are drawn.

use foldwell::analysis::relax::{RelaxError, Relaxed};
use foldwell::sheet::{Assignment, EdgeKind, Sheet, fold};
use foldwell::{Assembly, Pattern, RIGID, Rest, generate, relax};
use std::f64::consts::PI;
use std::fmt::Write;

use crate::common::Scene;
use crate::sheet::targets::FLAT as WATERBOMB;

const BIRD_BASE: &str = include_str!("../../cases/fold/bird-base.fold");
const CRANE: &str = include_str!("../../../meshes/crane.fold");
const TWIST: &str = include_str!("../../cases/fold/square-twist.fold");
const RIGID_TWIST: &str = include_str!("../../cases/fold/square-twist-rigid.fold");

/// Returns the crease pattern of `n x n` parallelograms of Miura-ori, without faces: rows of zigzags alternate, and the
/// straight lines change their letter at every vertex.
fn miura(n: usize) -> String {
    let number = |i: usize, j: usize| j * (n + 1) + i;
    let (mut points, mut edges) = (vec![], vec![]);
    for j in 0..=n {
        for i in 0..=n {
            points.push(format!("[{:?},{:?}]", i as f64 * 0.75f64.sqrt(), j as f64 + 0.5 * (i % 2) as f64));
            let rim = |at: usize, letter: &'static str| if at == 0 || at == n { "B" } else { letter };
            if i < n {
                edges.push(([number(i, j), number(i + 1, j)], rim(j, ["V", "M"][j % 2])));
            }
            if j < n {
                edges.push(([number(i, j), number(i, j + 1)], rim(i, ["M", "V"][(i + j) % 2])));
            }
        }
    }
    let list = |each: Vec<String>| each.join(",");
    let mut text = format!("{{\"vertices_coords\": [{}],\n", list(points));
    let ends = edges.iter().map(|(ends, _)| format!("{ends:?}")).collect();
    let letters = edges.iter().map(|(_, letter)| format!("{letter:?}")).collect();
    write!(text, "\"edges_vertices\": [{}],\n\"edges_assignment\": [{}]}}", list(ends), list(letters)).unwrap();
    text
}

fn read(text: &str) -> Sheet {
    fold::parse(text, "pattern.fold").unwrap()
}

/// Relaxes a pattern with rigid faces whose creases rest at 0.2 of the flat fold.
fn folded(text: &str, bars: f64) -> Result<Relaxed, Box<RelaxError>> {
    let pattern = Assembly::patch(read(text), [1, 1]).bars(bars).creases(1.0);
    relax(&pattern.rest(Rest::Assigned(0.2)).build().unwrap())
}

/// Claim: patterns that fold rigidly leave the flat state on the branch of their letters, with all creases on the side
/// of their rest angles, with bars of 1e4 and rigid ones, and the energy with stiff bars tends to that with rigid ones.
/// Tolerance: the energy of bars of EA is off by E^2/EA and a factor of their number, at 1e7 below 1e-4; a flat pattern
/// has the energy of all rest angles, which is more than four times that of the folded one.
#[test]
fn rigidly_foldable_patterns_fold_by_their_letters() {
    for (name, text) in [("waterbomb", WATERBOMB), ("twist", RIGID_TWIST), ("miura", &miura(2)), ("miura", &miura(6))] {
        let [rigid, soft, stiff] = [RIGID, 1e4, 1e7].map(|bars| folded(text, bars).unwrap());
        for found in [&rigid, &soft, &stiff] {
            assert!(found.residual_force < 1e-11 && found.residual_length < 1e-11, "{name}");
            assert_eq!(found.negative_eigenvalues, Some(0), "{name}");
            let choice = found.branch_choice.unwrap();
            assert!(choice.hinges >= 4 && choice.on_rest_side == choice.hinges, "{name}: {choice:?}");
        }
        let [rigid, soft, stiff] = [rigid, soft, stiff].map(|found| found.state.total());
        assert!((rigid - stiff).abs() < 1e-4 * rigid, "{name}: {rigid} {stiff}");
        assert!(soft < stiff && soft > 0.9 * rigid, "{name}: {soft} {stiff} {rigid}");
        let sheet = read(text);
        let flat: f64 = sheet
            .edges
            .iter()
            .filter(|edge| matches!(sheet.assignment(edge), Assignment::Mountain | Assignment::Valley))
            .map(|edge| {
                let [a, b] = edge.key.ends().map(|end| sheet.position(end));
                0.5 * (b - a).norm() * (0.2 * PI).powi(2)
            })
            .sum();
        assert!(rigid < 0.25 * flat, "{name}: {rigid} of {flat}");
    }
}

/// Claim: the Miura pattern folds as Miura-ori: along every line of the pattern the fold angles have one magnitude,
/// and a zigzag's `z` and a straight line's `s` obey `tan(z/2) = tan(s/2) cos(60 degrees)` in the ratio of their half
/// tangents, one way or the other. Source: T. Tachi, "Generalization of rigid foldable quadrilateral mesh origami", J.
/// IASS 50 (2009), eq. 1: half tangents of opposite creases of a flat-foldable vertex are equal, the others have the
/// ratio `cos((a - b)/2) / cos((a + b)/2)` or its inverse, here with angles of 60 degrees 1/2. Tolerance: the solver's.
#[test]
fn the_miura_pattern_folds_as_miura_ori() {
    let found = folded(&miura(4), RIGID).unwrap();
    let sheet = read(&miura(4));
    let half = |zigzag: bool| -> Vec<f64> {
        let edges = sheet.edges.iter().zip(&found.state.fold_angle).filter(|(_, angle)| angle.abs() > 1e-6);
        let is_zigzag = |edge: &foldwell::sheet::Edge| edge.key.j == edge.key.i + 1;
        edges.filter(|(edge, _)| is_zigzag(edge) == zigzag).map(|(_, angle)| (angle / 2.0).tan().abs()).collect()
    };
    let [zigzag, straight] = [true, false].map(half);
    assert_eq!((zigzag.len(), straight.len()), (12, 12));
    for list in [&zigzag, &straight] {
        assert!(list.iter().all(|t| (t - list[0]).abs() < 1e-9), "{list:?}");
    }
    let ratio = zigzag[0] / straight[0];
    assert!((ratio - 2.0).abs() < 1e-9 || (ratio - 0.5).abs() < 1e-9, "{ratio}");
}

/// Claim: patterns that do not fold rigidly, or only in part, come to rest out of the plane with bars of 1e4 and, where
/// some rigid folding is left, with rigid ones; most creases are on the side of their rest angles.
#[test]
fn other_patterns_fold_as_far_as_they_can() {
    for (text, least) in [(BIRD_BASE, 0.7), (TWIST, 0.7)] {
        for bars in [1e4, RIGID] {
            let found = folded(text, bars).unwrap();
            assert!(found.residual_force < 1e-11 && found.negative_eigenvalues == Some(0));
            let choice = found.branch_choice.unwrap();
            assert!(choice.on_rest_side as f64 >= least * choice.hinges as f64, "{choice:?}");
            assert_eq!(choice.soft_bars, bars.is_infinite());
        }
    }
}

/// Claim: the summary and the printed line say how the flat start was left; the rows of the history that were made with
/// bars that stretch are marked. A start that is not flat has no such choice, nor one that stays flat: a torus whose creases
/// all want to fold to one side, which cannot.
#[test]
fn the_branch_is_said() {
    let scene = "[sheet]\nmesh = \"a.fold\"\n[energy]\nbars = { stiffness = inf }\n\
                 creases = { stiffness = 1.0, rest = \"assigned\", fraction = 0.2 }\n\
                 [[study]]\nname = \"a\"\nkind = \"relax\"\n[[study]]\nname = \"b\"\nkind = \"relax\"\nstart = \"a\"\n";
    let said = Scene::new(scene).with("a.fold", WATERBOMB).program("").well();
    let studies = said.folder.studies();
    let choice = serde_json::json!({ "hinges": 6, "on_rest_side": 6, "soft_bars": true });
    assert_eq!((&studies[0]["branch_choice"], &studies[1]["branch_choice"]), (&choice, &serde_json::Value::Null));
    let methods: Vec<_> = studies[0]["history"].as_array().unwrap().iter().map(|row| &row["method"]).collect();
    assert!(
        methods.first().is_some_and(|method| *method == "soft-bars")
            && methods.last().is_some_and(|m| *m == "vertices")
    );
    assert!(
        said.out.contains("the start was left with 6 of 6 hinges on the side of their rest angles, by bars that"),
        "{said:?}"
    );
    let rest = "[energy]\nbars = { stiffness = inf }\ncreases = { stiffness = 1.0, rest = 0.5 }\n\
                [[study]]\nname = \"a\"\nkind = \"relax\"\n[[study]]\nname = \"b\"\nkind = \"relax\"\nstart = \"a\"\n";
    let torus = "generate = { pattern = \"miura\", fold = 0.9 }\ndomain = \"torus\"";
    let flat = Scene::on(torus, rest).program("").well();
    assert_eq!(flat.folder.studies()[1]["branch_choice"], serde_json::Value::Null);
    assert!(!flat.out.contains("the start was left"), "{flat:?}");
}

/// Claim: a flat patch of Resch's pattern folds all the way to its target angles, with soft and with rigid bars; its
/// tiles then lie in one plane, every side of a tile on that of another one, so that the energy vanishes; half way it
/// does not, since no rigid state has half of all these angles. Source: the rotations by these angles close around
/// every vertex (a test of the generator). Tolerance: the energy is quadratic in angles that the solver finds to 1e-8
/// or better.
#[test]
fn resch_folds_to_its_target_angles() {
    for (bars, part) in [(1e3, 1.0), (RIGID, 1.0), (1e3, 0.5)] {
        let sheet = generate(&Pattern::named("resch").unwrap()).unwrap();
        let pattern = Assembly::patch(sheet, [3, 3]).bars(bars).creases(1.0).rest(Rest::Target(part));
        let found = relax(&pattern.build().unwrap()).unwrap();
        let choice = found.branch_choice.unwrap();
        assert!(choice.hinges > 50 && choice.on_rest_side == choice.hinges, "{choice:?}");
        let energy = found.state.total();
        assert_eq!(energy < 1e-16, part == 1.0, "bars {bars}, part {part}: {energy:e}");
    }
}

/// Returns the vertices that no boundary edge reaches, each with the directions of its creases in radians, in order,
/// and their letters.
fn inner_vertices(sheet: &Sheet) -> Vec<Vec<(f64, Assignment)>> {
    let mut creases = vec![Some(vec![]); sheet.vertices.len()];
    for edge in sheet.edges.iter().filter(|edge| edge.kind != EdgeKind::Facet) {
        let [i, j] = edge.key.ends();
        for (from, to) in [(i, j), (j, i)] {
            let way = sheet.position(to) - sheet.position(from);
            match (&mut creases[from.vertex], sheet.assignment(edge)) {
                (rim, Assignment::Boundary) => *rim = None,
                (Some(list), letter) => list.push((way.y.atan2(way.x), letter)),
                (None, _) => {}
            }
        }
    }
    let inner = creases.into_iter().flatten();
    inner
        .map(|mut list| {
            list.sort_by(|a, b| a.0.total_cmp(&b.0));
            list
        })
        .collect()
}

/// Claim: each inner vertex of the crane folds flat: every other angle between its creases adds up to pi, and mountains
/// and valleys differ by two in number. Source: the theorems of Kawasaki and Maekawa (T. Hull, Project Origami, 2nd
/// ed., CRC Press 2013, activities 20 and 21). Tolerance: rounding, over the shortest crease of 0.04.
#[test]
fn the_crane_folds_flat_at_every_vertex() {
    let crane = read(CRANE);
    let inner = inner_vertices(&crane);
    assert_eq!((crane.vertices.len(), crane.polygons.len(), inner.len()), (48, 52, 38));
    for creases in inner {
        let count = creases.len();
        let between = |k: usize| (creases[(k + 1) % count].0 - creases[k].0).rem_euclid(2.0 * PI);
        let every_other: f64 = (0..count).step_by(2).map(between).sum();
        assert!(count % 2 == 0 && (every_other - PI).abs() < 1e-12, "{creases:?}: {every_other}");
        let letters = |letter| creases.iter().filter(|crease| crease.1 == letter).count();
        let [mountains, valleys] = [Assignment::Mountain, Assignment::Valley].map(letters);
        assert!(mountains + valleys == count && mountains.abs_diff(valleys) == 2, "{creases:?}");
    }
}
