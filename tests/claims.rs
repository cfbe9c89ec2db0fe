//! Statements about exact folding in closed form, along whole trajectories.
#![allow(clippy::unwrap_used)] // in helpers of tests as in tests

mod common;

use common::{distance, mesh};
use foldwell::analysis::branches;
use foldwell::analysis::trace::{Folded, Question, Stop, Traced, trace};
use foldwell::kinematics::{Displacement, Embedding, Shape, drawn_fold_angles};
use foldwell::model::assemble::{Hinges, Recipe, Surroundings};
use foldwell::sheet::generate::RandomDevelopable;
use foldwell::sheet::{EdgeKey, EdgeKind, Pattern, Sheet, generate, tile};
use foldwell::solver::continuation::End;

/// Follows every ray of a sheet, its polygons rigid and these edges locked.
fn run(sheet: &Sheet, locks: &[usize], stop: Stop, max_step: f64) -> Vec<Traced> {
    let periodic = sheet.lattice.is_some();
    let tiling = tile(sheet, [1, 1], periodic);
    let angles = drawn_fold_angles(sheet);
    let locks = locks.iter().map(|&edge| (edge, angles[edge])).collect();
    let facets = Some(Hinges { stiffness: f64::INFINITY, rest: angles.clone() });
    let recipe = Recipe { locks, facets, ..Recipe::default() };
    let surroundings = if periodic { Surroundings::Screw } else { Surroundings::Patch };
    let start = branches::Question { sheet, tiling: &tiling, surroundings, angles: &angles, recipe: &recipe };
    let question = Question { start, max_step, tolerance: 3e-14, branch: None, stop };
    trace(&question, None, &mut |_, _| true).unwrap()
}

#[test]
fn explore_strain() {
    let mut cells = vec![(mesh("open-flat"), "open-flat".to_owned(), (0..12).collect::<Vec<_>>()), (mesh("flat-quad"), "flat-quad".to_owned(), vec![999])];
    for seed in 0..30u64 {
        let s = generate(&Pattern::RandomDevelopable(RandomDevelopable { size: [2, 2], seed, ..RandomDevelopable::default() })).unwrap();
        let n = s.edges.len();
        cells.push((s, format!("random {seed}"), vec![seed as usize % n]));
    }
    let (mut total, mut bad, mut close) = (0, 0, 0);
    let mut first: Vec<(f64, f64, f64, String)> = vec![];
    let mut bad11 = 0;
    for (sheet, name, locks) in cells {
        for lock in locks {
            let locked = if lock == 999 { vec![] } else { vec![lock] };
            for one in run(&sheet, &locked, Stop { arc_length: Some(8.0), ..Stop::default() }, 0.1) {
                total += 1;
                if !matches!(one.end, End::Length) { println!("{name} {lock} {:?} {:?} {} {}", one.branch, match one.end { End::Closed(_) => "closed", End::Failed => "failed", _ => "other" }, one.states.last().unwrap().arc_length, one.states.len()); if matches!(one.end, End::Failed) {close += 1;} }
                bad11 += usize::from(one.states[1..].iter().any(|s| s.shape.as_ref().unwrap().strain[0] >= 0.0));
                if let Some(s) = one.states[1..].iter().find(|s| s.shape.as_ref().unwrap().strain[1] >= 0.0) {
                    bad += 1;
                    let largest = s.angles.iter().fold(0.0f64, |m, a| m.max(a.abs()));
                    let sh = s.shape.as_ref().unwrap();
                    let turn = sh.theta.iter().fold(0.0f64, |m, a| m.max(a.abs()));
                    first.push((s.arc_length, largest, turn, format!("{name} {lock} {:?} strain {:?} kappa {}", one.branch, sh.strain, sh.curvature)));
                }
            }
        }
    }
    first.sort_by(|a, b| a.0.total_cmp(&b.0));
    println!("{total} trajectories, failed {close}, strain11 bad {bad11}, strain22 bad {bad}");
    for f in first.iter().take(25) { println!("{f:?}"); }
    println!("smallest largest-fold {:?}", first.iter().map(|f| f.1).fold(f64::INFINITY, f64::min));
    println!("smallest turn {:?}", first.iter().map(|f| f.2).fold(f64::INFINITY, f64::min));
    let _ = (distance(&[], &[]), EdgeKind::Crease, EdgeKey { i: 0, j: 0, shift: [0, 0] });
    let _: Option<(Folded, Displacement, Embedding, Shape)> = None;
}
