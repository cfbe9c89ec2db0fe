//! Cost of testing a sheet of 10,082 faces for self-intersection.
//!
//! ```text
//! cargo bench --bench intersections
//! ```
//!
//! `new`: the tree of bounding boxes is built; `again`: it is refitted to another state of the same sheet. All times of
//! a line are medians of runs taken by turns; `crossings` is the number of pairs found.
//!
//! - `corrugated`: a patch with random heights and no crossings.
//! - `flat`: all faces in one plane oblique to the axes, so that the volumes of neighbours are rounding errors.
//! - `rolled`: two and a half turns that pass through each other.
//! - `stacked`: Miura-ori folded to 0.006 rad from flat, with all faces of a row within each other's boxes.
//! - `flat-folded`: the same folded flat and rotated obliquely to the axes: each face lies on many others, up to
//!   rounding errors.
#![allow(clippy::unwrap_used)]

mod common;

use common::{in_turns, measuring, random, seconds, uniform};
use foldwell::analysis::intersections::{Finder, STACKED_LAYERS_MARGIN};
use foldwell::math::Vec3;
use std::f64::consts::FRAC_PI_2;

type Points = Vec<Vec3>;

fn main() {
    let n = if measuring() { 71 } else { 9 };
    let rounds = if measuring() { 21 } else { 1 };
    println!("{:>12} {:>7} {:>9} {:>9} {:>9}", "sheet", "faces", "crossings", "new ms", "again ms");
    for (name, points) in sheets(n) {
        let triangles = triangles(n);
        let moved: Points = points.iter().map(|p| p * 1.01).collect();
        let mut finder = Finder::new(triangles.clone());
        let found = finder.crossings(&points, STACKED_LAYERS_MARGIN).pairs.len();
        let times = in_turns(
            rounds,
            &mut [
                &mut || seconds(|| Finder::new(triangles.clone()).crossings(&points, STACKED_LAYERS_MARGIN)),
                &mut || seconds(|| finder.crossings(&moved, STACKED_LAYERS_MARGIN)),
            ],
        );
        println!("{name:>12} {:>7} {found:>9} {:>9.1} {:>9.1}", triangles.len(), 1e3 * times[0], 1e3 * times[1]);
    }
}

/// Returns the two triangles of each of `n x n` parallelograms.
fn triangles(n: usize) -> Vec<[usize; 3]> {
    let number = |i: usize, j: usize| j * (n + 1) + i;
    let pairs = (0..n * n).map(|k| (k % n, k / n)).map(|(i, j)| {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    pairs.flatten().collect()
}

fn grid(n: usize, mut place: impl FnMut(usize, usize) -> Vec3) -> Points {
    (0..(n + 1) * (n + 1)).map(|k| place(k % (n + 1), k / (n + 1))).collect()
}

fn sheets(n: usize) -> [(&'static str, Points); 5] {
    let mut numbers = random(1);
    let turn = nalgebra::Rotation3::new(Vec3::new(0.3, -1.1, 0.7));
    let turned = |points: Points| points.iter().map(|p| turn * p).collect();
    let flat = |i: usize, j: usize| Vec3::new(i as f64 + 0.3 * j as f64, j as f64, 0.0);
    let corrugated = grid(n, |i, j| flat(i, j) + Vec3::z() * uniform(&mut numbers, 0.5));
    let angle = 5.0 * FRAC_PI_2 * 2.0 / n as f64;
    let rolled = grid(n, |i, j| {
        let (sin, cos) = (i as f64 * angle).sin_cos();
        let radius = (1.0 + 0.05 * (i as f64 * 2.0).sin()) / angle;
        Vec3::new(radius * cos, radius * sin, j as f64)
    });
    [
        ("corrugated", corrugated),
        ("flat", turned(grid(n, flat))),
        ("rolled", rolled),
        ("stacked", miura(n, FRAC_PI_2 - 0.003)),
        ("flat-folded", turned(miura(n, FRAC_PI_2))),
    ]
}

/// Returns the points of Miura-ori with unit sides and an angle of 60 degrees; its faces have the angle `g` to the
/// plane of the sheet.
fn miura(n: usize, g: f64) -> Points {
    let (sine, tangent) = (0.75f64.sqrt(), 3f64.sqrt());
    let q = (1.0 + (g.cos() * tangent).powi(2)).sqrt();
    let (l, h) = ((1.0 - (g.sin() * sine).powi(2)).sqrt(), sine * g.sin());
    grid(n, |i, j| Vec3::new(g.cos() * tangent / q * i as f64, l * j as f64 + (i % 2) as f64 / q, h * (j % 2) as f64))
}
