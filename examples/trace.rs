//! Follows the rigid folding of a random cell with one locked crease along all branches, until each trajectory closes.
//!
//! ```text
//! cargo run --release --example trace
//! ```

use foldwell::analysis::trace::{Stop, TraceOptions, trace};
use foldwell::sheet::EdgeKey;
use foldwell::{Assembly, Sheet};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let sheet: Sheet = foldwell::sheet::fold::parse(include_str!("../meshes/open-star.fold"), "open-star.fold")?;
    let lock = EdgeKey { i: 0, j: 1, shift: [0, 0], round: 0 };
    let assembly = Assembly::screw(sheet, [6, 6]).lock(lock, None).build()?;
    let stop = Stop { arc_length: Some(60.0), ..Stop::default() };
    let options = TraceOptions { max_step: 0.1, tolerance: 3e-14, branch: None, stop };
    for traced in trace(&assembly, &options, None, &mut |_, _| true)? {
        let (branch, sign) = traced.branch;
        let last = traced.states.last().ok_or("a trajectory without states")?;
        let curvatures = traced.states.iter().filter_map(|state| state.shape.as_ref()).map(|shape| shape.curvature);
        let most = curvatures.fold(0.0, |most: f64, curvature| most.max(curvature.abs()));
        println!(
            "branch {branch}, sign {sign:+}: {} states over {:.4} rad, ends {:?}; largest curvature {most:.4}",
            traced.states.len(),
            last.arc_length,
            traced.ends_at.map_or("elsewhere".to_owned(), |(branch, sign)| format!("at ray ({branch}, {sign:+})")),
        );
    }
    Ok(())
}
