//! Problems at the edge of the solver: no soft energy at all, no energy at the minimum, an unstable equilibrium.

#[path = "common/textbook.rs"]
mod textbook;

use textbook::{Textbook, length, linear, steps};

/// Claim: a stiff measure in place of the steep wall of the valley changes nothing but the path: `sqrt(200) (y - x^2)`
/// with compliance 1 has the same minimum and the same energy, and with compliance 0 the minimum of `(1 - x)^2` on the
/// parabola. From compliance 1 down to 0.
#[test]
fn the_valley_with_a_stiff_wall() {
    for compliance in [1.0 / 200.0, 1e-6, 1e-12, 0.0] {
        let wall = |x: &[f64]| (x[1] - x[0] * x[0], vec![-2.0 * x[0], 1.0], vec![-2.0, 0.0, 0.0]);
        let mut problem =
            Textbook::new(2).soft(&[0], 2.0, linear(&[1.0], 1.0)).stiff(&[0, 1], compliance, Box::new(wall));
        let found = problem.run(&[-1.2, 1.0]).unwrap();
        assert!(found.x.iter().all(|x| (x - 1.0).abs() < 1e-9), "c = {compliance:e}: {:?}", found.x);
        assert!(steps(&found) <= 30, "c = {compliance:e}: {} steps", steps(&found));
    }
}

/// Claim: a pendulum on a rigid bar of length 2 under a weight of 3 hangs straight down with the weight as tension,
/// from the side and from nearly the top; from exactly the top it is an equilibrium with one negative eigenvalue.
#[test]
fn a_pendulum() {
    let pendulum = || Textbook::new(2).load(&[0.0, -3.0]).stiff(&[0, 1], 0.0, length(Some([0.0, 0.0]), 2.0));
    for start in [[2.0, 0.0], [1.0, -1.0], [-1.2, 1.6], [0.1, 2.0]] {
        let found = pendulum().run(&start).unwrap_or_else(|error| panic!("from {start:?}: {error}"));
        assert!(found.x[0].abs() < 1e-10 && (found.x[1] + 2.0).abs() < 1e-12, "{:?}", found.x);
        assert!((found.tension[0] - 3.0).abs() < 1e-11);
        assert_eq!(found.negative_eigenvalues, 0);
    }
    let top = pendulum().run(&[0.0, 2.0]).unwrap();
    assert_eq!(top.negative_eigenvalues, 1);
    assert!((top.x[1] - 2.0).abs() < 1e-15);
    assert!((top.tension[0] + 3.0).abs() < 1e-12, "at the top the bar is pressed");
}

/// The hanging chain: horizontal force at which `n` bars of length `l`, weights `w` on the joints between, span `d`.
/// Bar `k` pulls with `(H, V_k)`, `V_k = w (k - (n - 1)/2)`.
fn chain_force(n: usize, l: f64, w: f64, d: f64) -> f64 {
    let span = |h: f64| (0..n).map(|k| l * h / h.hypot(w * (k as f64 - (n as f64 - 1.0) / 2.0))).sum::<f64>();
    let (mut low, mut high) = (1e-9, 1e6);
    for _ in 0..200 {
        let middle: f64 = 0.5 * (low + high);
        if span(middle) < d { low = middle } else { high = middle }
    }
    low
}

/// Lower end of bar `k`.
fn next(place: [f64; 2], k: usize, n: usize, (l, w, d): (f64, f64, f64)) -> [f64; 2] {
    let (force, vertical) = (chain_force(n, l, w, d), w * (k as f64 - (n as f64 - 1.0) / 2.0));
    let tension = force.hypot(vertical);
    [place[0] + l * force / tension, place[1] + l * vertical / tension]
}

/// Claim: a chain of rigid bars between two points a distance of 0.7 times its length apart hangs in the closed form
/// above, forces and places, for 4, 10 and 40 bars (the last beyond the dense factorization), from a V.
/// Springs that are slack in the closed form hold the joints on their way and change nothing at the end.
#[test]
fn a_hanging_chain_from_a_v() {
    for n in [4, 10, 40] {
        let (l, w) = (1.0, 0.5);
        let d = 0.7 * n as f64;
        let joints = n - 1;
        let mut problem = Textbook::new(2 * joints).load(&[0.0, -w].repeat(joints));
        problem = problem.stiff(&[0, 1], 0.0, length(Some([0.0, 0.0]), l));
        for k in 1..joints as u32 {
            problem = problem.stiff(&[2 * k - 2, 2 * k - 1, 2 * k, 2 * k + 1], 0.0, length(None, l));
        }
        let last = 2 * joints as u32 - 2;
        problem = problem.stiff(&[last, last + 1], 0.0, length(Some([d, 0.0]), l));
        let mut place = [0.0, 0.0];
        for k in 0..joints {
            let [place_x, place_y] = next(place, k, n, (l, w, d));
            problem = problem.soft(&[2 * k as u32], 0.1, linear(&[1.0], place_x)).soft(
                &[2 * k as u32 + 1],
                0.1,
                linear(&[1.0], place_y),
            );
            place = [place_x, place_y];
        }
        let start: Vec<f64> =
            (1..n).flat_map(|k| [0.7 * l * k as f64, -(1.0f64 - 0.49).sqrt() * l * k.min(n - k) as f64]).collect();
        let found = problem.run(&start).unwrap_or_else(|error| panic!("{n} bars: {error}"));
        let force = chain_force(n, l, w, d);
        let mut place = [0.0, 0.0];
        for k in 0..n {
            let vertical = w * (k as f64 - (n as f64 - 1.0) / 2.0);
            let tension = force.hypot(vertical);
            assert!((found.tension[k] - tension).abs() < 1e-9 * tension, "{n} bars, bar {k}: {}", found.tension[k]);
            if k < joints {
                place = next(place, k, n, (l, w, d));
                let off = (found.x[2 * k] - place[0]).hypot(found.x[2 * k + 1] - place[1]);
                assert!(off < 1e-9, "{n} bars, joint {k}: off by {off:e}");
            }
        }
        assert_eq!(found.negative_eigenvalues, 0);
        println!("{n} bars: {} steps", steps(&found));
    }
}

/// Claim: a chain of rigid bars between two points a distance of 0.7 times its length apart hangs in the closed form
/// above, forces and places, for 4, 10 and 40 bars (the last beyond the dense factorization), from a V.
#[test]
fn a_hanging_chain_without_springs() {
    for n in [4, 10, 40] {
        let (l, w) = (1.0, 0.5);
        let d = 0.7 * n as f64;
        let joints = n - 1;
        let mut problem = Textbook::new(2 * joints).load(&[0.0, -w].repeat(joints));
        problem = problem.stiff(&[0, 1], 0.0, length(Some([0.0, 0.0]), l));
        for k in 1..joints as u32 {
            problem = problem.stiff(&[2 * k - 2, 2 * k - 1, 2 * k, 2 * k + 1], 0.0, length(None, l));
        }
        let last = 2 * joints as u32 - 2;
        problem = problem.stiff(&[last, last + 1], 0.0, length(Some([d, 0.0]), l));
        let start: Vec<f64> =
            (1..n).flat_map(|k| [0.7 * l * k as f64, -(1.0f64 - 0.49).sqrt() * l * k.min(n - k) as f64]).collect();
        let found = problem.run(&start).unwrap_or_else(|error| panic!("{n} bars: {error}"));
        let force = chain_force(n, l, w, d);
        let mut place = [0.0, 0.0];
        for k in 0..n {
            let vertical = w * (k as f64 - (n as f64 - 1.0) / 2.0);
            let tension = force.hypot(vertical);
            assert!((found.tension[k] - tension).abs() < 1e-9 * tension, "{n} bars, bar {k}: {}", found.tension[k]);
            if k < joints {
                place = [place[0] + l * force / tension, place[1] + l * vertical / tension];
                let off = (found.x[2 * k] - place[0]).hypot(found.x[2 * k + 1] - place[1]);
                assert!(off < 1e-9, "{n} bars, joint {k}: off by {off:e}");
            }
        }
        assert_eq!(found.negative_eigenvalues, 0);
        println!("{n} bars: {} steps", steps(&found));
    }
}
