//! The spatially varying modes of a periodic sheet: where in the zone of wavenumbers bars keep their lengths, and how
//! fast such modes decay.
//!
//! ```text
//! cargo run --release --example bloch_map
//! ```

use foldwell::analysis::bloch::{Rigidity, SurveyOptions, survey};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let sheet = foldwell::sheet::fold::parse(include_str!("../meshes/open-star.fold"), "open-star.fold")?;
    let options = SurveyOptions { grid: [48, 24], ..SurveyOptions::default() };
    let found = survey(&Rigidity::of_sheet(&sheet, false)?, &options, &mut |_| true)?;
    println!("sign of the determinant over q1 (across) and q2 (upwards), both from -pi to pi:");
    for row in found.map[0].chunks(48).rev() {
        println!("  {}", row.iter().map(|value| if *value < 0.0 { '-' } else { '+' }).collect::<String>());
    }
    if let Some(lines) = found.lines() {
        println!("{} lines of zero modes; decay rates per cell at q1 = 0.79:", lines.lines.len());
    }
    let decay = found.decays.iter().min_by(|a, b| (a.q - 0.79).abs().total_cmp(&(b.q - 0.79).abs()));
    for root in decay.iter().flat_map(|decay| &decay.roots) {
        println!("  {:+.9}", root.kappa());
    }
    Ok(())
}
