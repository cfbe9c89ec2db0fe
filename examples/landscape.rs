//! The energy of a patch that is bent along one of its folding modes: fourth order where it is bent both ways, next to
//! none where it is bent to a cylinder.
//!
//! ```text
//! cargo run --release --example landscape
//! ```

use foldwell::analysis::landscape::HeldSheet;
use foldwell::analysis::landscape::samples::landscape;
use foldwell::{Assembly, RIGID};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let sheet = foldwell::sheet::fold::parse(include_str!("../meshes/open-star.fold"), "open-star.fold")?;
    let assembly = Assembly::patch(sheet, [6, 6]).bars(RIGID).creases(1.0).build()?;
    let held = HeldSheet::patch(&assembly)?;
    for curvature in [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, -1.0, 0.0]] {
        let rates = held.named(curvature)?;
        let found = landscape(&held, rates, &[0.005, 0.01, 0.02], &mut |_| true)?;
        println!(
            "curvatures k11, k22, k12 in the ratio {curvature:?}: predicted E/a^4 = {:.6e}",
            found.predicted.fourth
        );
        for sample in &found.samples {
            let (a, energy) = (sample.amplitude, sample.relaxed.state.total());
            println!("  a = {a:5.3}: E = {energy:.6e}, E/a^4 = {:.6e}", energy / a.powi(4));
        }
    }
    Ok(())
}
