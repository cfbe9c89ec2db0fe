//! The two engines of trajectories beside each other.

mod common;

use common::Case;
use foldwell::analysis::branches;
use foldwell::analysis::drive::{Drive, Question, drive};
use foldwell::analysis::trace::{self, Stop, Traced};
use foldwell::model::assemble::{Drawn, Hinges, Recipe, Surroundings, drawn_angles};
use foldwell::sheet::EdgeKey;
use foldwell::solver::Options;

#[test]
fn try_out() {
    let sheet = common::mesh("open-star");
    let tiling = foldwell::sheet::tile(&sheet, [1, 1], true);
    let drawn = Drawn::new(&sheet, &tiling, Surroundings::Screw);
    let angles = drawn_angles(&drawn, &tiling);
    let lock = sheet.edges.iter().position(|edge| edge.key == EdgeKey { i: 0, j: 1, shift: [0, 0] }).unwrap();
    for k in [f64::INFINITY, 1e4, 1e6, 1e8] {
        let creases = Some(Hinges { stiffness: 1.0, rest: angles.clone() });
        let recipe = Recipe { bars: Some(k), creases, locks: vec![(lock, angles[lock])], ..Recipe::default() };
        let start = branches::Question {
            sheet: &sheet,
            tiling: &tiling,
            surroundings: Surroundings::Screw,
            angles: &angles,
            recipe: &recipe,
        };
        let question = trace::Question { start, max_step: 0.25, tolerance: 3e-14, branch: None, stop: Stop::default() };
        for traced in trace::trace(&question, None, &mut |_, _| true).unwrap() {
            let clock = std::time::Instant::now();
            let question = Question { tiling: &tiling, drawn: &drawn, recipe: &recipe, options: Options::default() };
            let drive: Drive = drive(&question, &traced, &mut |_| true);
            let its: usize = drive.states.iter().map(|state| state.relaxed.iterations).sum();
            println!(
                "k {k:e} {:?} states {} of {} error {:.2e} its {its} {:?} {:?}",
                traced.branch,
                drive.states.len(),
                traced.states.len() - 1,
                drive.error(),
                drive.failure,
                clock.elapsed()
            );
            if let Some(next) = traced.states.get(drive.states.len() + 1) {
                println!(
                    "   next {} {:?} driven {:?} rates {:.3?} angles {:.3?}",
                    next.arc_length,
                    next.shape.as_ref().map(|s| (s.curvature, s.theta)),
                    drive.states.last().map(|s| s.crease),
                    next.rates,
                    next.angles
                );
                for d in drive.states.iter().rev().take(4) {
                    println!(
                        "   {} {:.1e} its {} res {:.1e} {:.1e} coords {:.3?}",
                        d.crease,
                        d.error,
                        d.relaxed.iterations,
                        d.relaxed.residual_force,
                        d.relaxed.residual_length,
                        d.relaxed.state.coordinates
                    );
                }
            }
            let mut errors: Vec<(f64, f64, f64)> = drive
                .states
                .iter()
                .zip(&traced.states[1..])
                .map(|(d, t)| (d.error, t.arc_length, t.shape.as_ref().unwrap().curvature))
                .collect();
            errors.sort_by(|a, b| b.0.total_cmp(&a.0));
            println!("   {:.3?}", &errors[..errors.len().min(4)]);
        }
    }
}
