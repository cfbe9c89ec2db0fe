//! Surfaces of folded states.
#![allow(clippy::unwrap_used)] // in helpers of tests as in tests

mod common;

use foldwell::analysis::branches;
use foldwell::analysis::surface::{Question, Surface, SurfaceError, surface};
use foldwell::kinematics::drawn_fold_angles;
use foldwell::model::assemble::{Recipe, Surroundings};
use foldwell::sheet::{Sheet, tile};

fn run(sheet: &Sheet, radius: f64, max_curvature: f64, max_points: usize) -> Result<Surface, SurfaceError> {
    let tiling = tile(sheet, [1, 1], true);
    let angles = drawn_fold_angles(sheet);
    let start = branches::Question {
        sheet,
        tiling: &tiling,
        surroundings: Surroundings::Screw,
        angles: &angles,
        recipe: &Recipe::default(),
    };
    surface(&Question { start, radius, tolerance: 1e-13, max_curvature, max_points }, &mut |_| true)
}

#[test]
fn trial() {
    let sheet = common::mesh("open-star");
    for (radius, k) in [(0.2, 0.5), (0.2, 1.0), (0.2, 2.0)] {
        let clock = std::time::Instant::now();
        let found = run(&sheet, radius, k, 200_000).unwrap();
        println!(
            "{radius} {k}: {} points {} triangles {:?} oriented {} {:?} {:?}",
            found.points.len(),
            found.triangles.len(),
            found.coverage,
            found.oriented,
            found.branches,
            clock.elapsed()
        );
        for b in &found.branches {
            let n = found.points.iter().filter(|p| p.branch == *b).count();
            let tips = found.points.iter().filter(|p| p.branch == *b && p.radius == 0.0).count();
            let range = |f: &dyn Fn(&foldwell::kinematics::Shape) -> f64| {
                found
                    .points
                    .iter()
                    .filter(|p| p.branch == *b)
                    .map(|p| f(&p.shape))
                    .fold((9e9f64, -9e9f64), |a, x| (a.0.min(x), a.1.max(x)))
            };
            println!(
                "   {b:?} {n} tips {tips} curvature {:?} strain {:?} {:?} {:?} angles {:.2}",
                range(&|s| s.curvature),
                range(&|s| s.strain[0]),
                range(&|s| s.strain[1]),
                range(&|s| s.strain[2]),
                found
                    .points
                    .iter()
                    .filter(|p| p.branch == *b)
                    .flat_map(|p| p.angles.clone())
                    .fold(0.0f64, |m, a| m.max(a.abs()))
            );
        }
    }
}
