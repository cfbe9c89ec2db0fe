//! Rigid Miura-ori compared with its closed form.

use crate::common::{Testing, on};
use foldwell::math::fold_angle::fold_angle;
use foldwell::model::{Assembly, Boundary, Terms};
use foldwell::sheet::generate::{MiuraPatch, Pattern};
use foldwell::sheet::{EdgeKind, generate};
use std::f64::consts::PI;

fn miura(cells: [usize; 2]) -> Assembly {
    let pattern = Pattern::MiuraPatch(MiuraPatch { a: 2.0, b: 2.0, cells, ..MiuraPatch::default() });
    on(generate(&pattern).unwrap(), [1, 1], Boundary::Patch)
}

/// Whether a crease of Miura-ori runs along the zigzags (x changes), not along the straight lines.
fn zigzag(case: &Assembly, edge: usize) -> bool {
    let [a, b] = case.tiling().edges[edge].ends.map(|site| case.tiling().positions[site.vertex]);
    (a.x - b.x).abs() > 1e-9
}

/// Returns the fold angle of an edge in a state, also if the model has no hinge there.
fn fold_angle_at(case: &Assembly, coordinates: &[f64], edge: usize) -> f64 {
    let sites = case.tiling().edges[edge].hinge().unwrap();
    fold_angle(case.drawn().domain.points(coordinates, &sites))
}

/// Claim: folded by a lock on one crease, every crease of a rigid Miura-ori follows the closed form `tan(straight/2) =
/// cos(sector) tan(zigzag/2)`, from nearly flat to nearly folded, with the signs of the drawn state; with an energy of
/// the creases, and without any energy, where only the lock determines the direction. Source: flat-foldable vertices of
/// degree four, e.g. T. Tachi, "Generalization of rigid-foldable quadrilateral-mesh origami", 2009, eq. (1), both
/// sectors equal. Tolerance: residual 1e-12 divided by the softest singular value, which is least near the flat state.
#[test]
fn miura_follows_its_closed_form() {
    let case = miura([5, 5]);
    let creases: Vec<usize> =
        (0..case.edges()).filter(|&edge| case.tiling().edges[edge].kind == EdgeKind::Crease).collect();
    let locks = [true, false].map(|class| *creases.iter().find(|&&edge| zigzag(&case, edge) == class).unwrap());
    let mut failed = Vec::new();
    for (angle, energy) in [0.05, 0.1, 0.3, 0.6, 1.0, 1.5, 2.0, 2.5, 3.0].map(|a| [(a, true), (a, false)]).concat() {
        for lock in locks {
            let mut terms =
                Terms { bars: Some(f64::INFINITY.into()), facets: case.facets(f64::INFINITY), ..Terms::default() };
            terms.locks = vec![(lock, case.drawn_angles()[lock].signum() * angle)];
            if energy {
                terms.creases = Terms::bars_and_creases(1.0, 1.0, case.drawn_angles().to_vec()).creases;
            }
            let found = match case.relax(&terms) {
                Ok(found) => found,
                Err(error) => {
                    failed.push(format!("edge {lock} at {angle}, creases {energy}: {error}"));
                    continue;
                }
            };
            assert!(found.residual_force <= 1e-12 && found.residual_length <= 1e-12);
            assert_eq!(found.self_stresses, Some(64), "a lock takes the only folding away and adds no self stress");
            let half = (angle / 2.0).tan();
            let half = if zigzag(&case, lock) { half } else { half / (PI / 3.0).cos() };
            let [along, straight] = [2.0 * half.atan(), 2.0 * ((PI / 3.0).cos() * half).atan()];
            for &edge in &creases {
                let expected = case.drawn_angles()[edge].signum() * if zigzag(&case, edge) { along } else { straight };
                let off = (fold_angle_at(&case, &found.state.coordinates, edge) - expected).abs();
                assert!(off < 1e-9, "edge {lock} at {angle}, edge {edge}: off by {off:e}");
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Claim: the drawn angles themselves satisfy the closed form, so that the test above compares with the drawn sheet.
#[test]
fn miura_is_drawn_by_its_closed_form() {
    let case = miura([2, 2]);
    let of = |class: bool| {
        (0..case.edges())
            .filter(|&e| case.tiling().edges[e].kind == EdgeKind::Crease && zigzag(&case, e) == class)
            .map(|e| case.drawn_angles()[e].abs())
            .collect::<Vec<f64>>()
    };
    let (zigzags, straights) = (of(true), of(false));
    assert!(zigzags.iter().all(|angle| (angle - zigzags[0]).abs() < 1e-13));
    let expected = 2.0 * ((PI / 3.0).cos() * (zigzags[0] / 2.0).tan()).atan();
    assert!(straights.iter().all(|angle| (angle - expected).abs() < 1e-13));
}
