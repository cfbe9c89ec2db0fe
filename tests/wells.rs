//! Wells and barriers.
#![allow(clippy::unwrap_used)] // in helpers of tests as in tests

mod common;

use common::{Case, Numbers};
use foldwell::analysis::wells::merge::{Translations, wells};
use foldwell::analysis::wells::rigid::{Sampling, landscape};
use foldwell::analysis::wells::starts::{Outcome, Starts, relax_all};
use foldwell::analysis::wells::{Question, barrier};
use foldwell::model::assemble::Surroundings;
use foldwell::sheet::fold;
use foldwell::solver::Options;
use std::f64::consts::{PI, TAU};

fn fan(directions: &[f64; 4]) -> foldwell::sheet::Sheet {
    let points: Vec<[f64; 3]> =
        std::iter::once([0.0; 3]).chain(directions.iter().map(|a| [a.cos(), a.sin(), 0.0])).collect();
    let text =
        format!(r#"{{"vertices_coords": {points:?}, "faces_vertices": [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]}}"#);
    fold::parse(&text, "fan.fold").unwrap()
}

#[test]
#[ignore]
fn explore() {
    let mut numbers = Numbers::new(3);
    let mut counts = [0; 8];
    for number in 0..300 {
        let mut directions = [0.0; 4];
        loop {
            let mut a: Vec<f64> = (0..4).map(|_| PI + numbers.within(PI)).collect();
            a.sort_by(f64::total_cmp);
            directions.copy_from_slice(&a);
            let sectors: Vec<f64> = (0..4).map(|k| (a[(k + 1) % 4] - a[k]).rem_euclid(TAU)).collect();
            if sectors.iter().all(|s| *s > 0.3 && *s < PI - 0.1) {
                break;
            }
        }
        let case = Case::new(fan(&directions), [1, 1], Surroundings::Patch);
        let rest = numbers.many(case.edges(), PI);
        let recipe = case.recipe(f64::INFINITY, 1.0, rest);
        let question = Question {
            sheet: &case.sheet,
            tiling: &case.tiling,
            surroundings: case.surroundings,
            drawn: &case.drawn,
            recipe: &recipe,
        };
        let sampling = Sampling { step: 0.05, max_curvature: 1.0 };
        let rigid = landscape(&question, &sampling, &mut || true).unwrap();
        counts[rigid.wells.len()] += 1;
        if number < 12 || rigid.wells.len() > 4 {
            println!("{number} rigid: {} wells {:?}, passes {:?} lost {}", rigid.wells.len(),
                rigid.wells.iter().map(|w| w.energy).collect::<Vec<_>>(),
                rigid.passes.iter().map(|p| (p.joins, p.energy, p.singular)).collect::<Vec<_>>(), rigid.lost);
            let starts = Starts { count: 64, seed: 1, spread: PI, options: Options::default() };
            let found = relax_all(&question, &starts, &|| true);
            let failed = found.iter().filter(|f| matches!(f, Outcome::Failed(_))).count();
            let saddles = found.iter().filter(|f| matches!(f, Outcome::Saddle)).count();
            let first = found.iter().find_map(|f| if let Outcome::Failed(w) = f { Some(w.to_string()) } else { None });
            let minima = found.into_iter().filter_map(|f| if let Outcome::Well(w) = f { Some(*w) } else { None });
            let wells = wells(minima, &Translations::new(&question));
            println!("   starts: {} wells {:?}, failed {failed} saddles {saddles} {first:?}", wells.len(),
                wells.iter().map(|w| (w.settled.energy, w.reached, w.settled.rho.iter().any(|r| r.abs() > PI))).collect::<Vec<_>>());
            for other in 1..wells.len().min(3) {
                match barrier::barrier(&question, &wells, [0, other], &mut || true) {
                    Ok(b) => println!("   barrier {:?} joins {:?} {} heights {:?} path {:?}", b.between, b.joins, b.pass.energy, b.heights.iter().map(|h| (h.stiffness, h.energy)).collect::<Vec<_>>(), b.path),
                    Err(e) => println!("   barrier 0 {other}: {e}"),
                }
            }
        }
    }
    println!("{counts:?}");
}

#[test]
#[ignore]
fn scan() {
    let env = |name: &str, default: f64| std::env::var(name).map_or(default, |v| v.parse().unwrap());
    let mut numbers = Numbers::new(env("SEED", 5.0) as u64);
    let mut counts = [0; 8];
    for number in 0..env("N", 2000.0) as usize {
        let mut directions = [0.0; 4];
        loop {
            let mut a: Vec<f64> = (0..4).map(|_| PI + numbers.within(PI)).collect();
            a.sort_by(f64::total_cmp);
            directions.copy_from_slice(&a);
            let sectors: Vec<f64> = (0..4).map(|k| (a[(k + 1) % 4] - a[k]).rem_euclid(TAU)).collect();
            if sectors.iter().all(|s| *s > env("LEAST", 0.2) && *s < PI - env("LEAST", 0.2)) {
                break;
            }
        }
        let case = Case::new(fan(&directions), [1, 1], Surroundings::Patch);
        for _ in 0..env("RESTS", 4.0) as usize {
            let rest = numbers.many(case.edges(), PI);
            let recipe = case.recipe(f64::INFINITY, 1.0, rest.clone());
            let question = Question {
                sheet: &case.sheet,
                tiling: &case.tiling,
                surroundings: case.surroundings,
                drawn: &case.drawn,
                recipe: &recipe,
            };
            let sampling = Sampling { step: 0.1, max_curvature: 1.0 };
            let Ok(rigid) = landscape(&question, &sampling, &mut || true) else { println!("{number} none"); continue };
            counts[rigid.wells.len()] += 1;
            if rigid.wells.len() > 3 {
                println!("{number}: {} wells {:?} passes {:?} lost {} directions {directions:?} rest {:?}", rigid.wells.len(),
                    rigid.wells.iter().map(|w| w.energy).collect::<Vec<_>>(),
                    rigid.passes.iter().map(|p| (p.joins, p.energy, p.singular)).collect::<Vec<_>>(), rigid.lost,
                    case.sheet.edges.iter().zip(&rest).filter(|(e, _)| e.key.i == 0).map(|(e, r)| (e.key.j, *r)).collect::<Vec<_>>());
            }
        }
    }
    println!("{counts:?}");
}
