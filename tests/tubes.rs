//! Tubes: screw-periodic sheets that close on themselves, their seams and their ends.
#![allow(clippy::unwrap_used)] // in helpers of tests as in tests

mod common;

use common::{Case, jacobian, linearized, mesh};
use foldwell::analysis::chart::coordinates;
use foldwell::analysis::trace::Folded;
use foldwell::kinematics::tube::{BOTH, Condition};
use foldwell::kinematics::{Embedding, Shape, Tube};
use foldwell::model::Gauge;
use foldwell::model::assemble::{Recipe, Surroundings};
use foldwell::numerics::DenseMatrix;
use foldwell::numerics::dense::null_space;
use foldwell::sheet::generate::Random;
use foldwell::sheet::{Pattern, Sheet, fold, generate};
use foldwell::solver::continuation::End;
use std::f64::consts::TAU;

fn dump(label: &str, tube: &Tube, sheet: &Sheet, angles: &[f64]) {
    let shape = Shape::at(&Embedding::new(sheet).unwrap(), angles).unwrap();
    let biggest = angles.iter().fold(0.0f64, |m, a| m.max(a.abs()));
    println!(
        "{label}: kappa {:.4} theta {:?} rise {:?} strain {:?} largest fold {biggest:.3} compat {:e} defects {:?}",
        shape.curvature,
        shape.theta,
        shape.screw.rise(),
        shape.strain,
        shape.compatibility.largest(),
        tube.defects(angles)
    );
}

#[test]
fn explore() {
    for (name, sheet) in [
        ("star", mesh("open-star")),
        ("random3", generate(&Pattern::Random(Random { seed: 3, size: [2, 3], ..Random::default() })).unwrap()),
    ] {
        for seam in [[0, 6], [0, 8], [1, 8], [8, 0], [8, 1], [7, -3], [2, 8], [0, 12]] {
            let tube = Tube::new(&sheet, seam).unwrap();
            for inwards in [true, false] {
                match tube.rolled_up(inwards) {
                    Err(e) => println!("{name} {seam:?} {inwards}: {e}"),
                    Ok(angles) => {
                        dump(&format!("{name} {seam:?} {inwards}"), &tube, &sheet, &angles);
                        for kept in [&BOTH[..0], &BOTH[..1], &BOTH[1..], &BOTH[..]] {
                            let null = null_space(&tube.jacobian(&angles, kept)).unwrap();
                            print!(
                                "  {} ({:.1e}, smallest {:.3e})",
                                null.basis.ncols(),
                                null.gap,
                                null.singular_values[null.rank - 1]
                            );
                        }
                        println!();
                        for rows in [2, 4, 6] {
                            let g = if seam[0] == 0 { 1 } else { 6 };
                            match tube.cut(&angles, rows * g) {
                                Err(e) => println!("   {rows}: {e:?}"),
                                Ok(cut) => {
                                    let case = Case::new(cut, [1, 1], Surroundings::Patch);
                                    let m = case.modes(&Recipe { bars: Some(1.0), ..Recipe::default() }, 0).unwrap();
                                    println!(
                                        "   {} V {} E {} zero {} ss {} rigid {} maxwell {} gap {:.1e}",
                                        rows,
                                        case.sheet.vertices.len(),
                                        case.edges(),
                                        m.zero_modes,
                                        m.self_stresses,
                                        m.rigid_motions,
                                        m.maxwell_count,
                                        m.gap
                                    );
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}
