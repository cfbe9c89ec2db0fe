//! Relaxes a patch of Miura-ori at several stiffnesses of its bars, up to exactly rigid ones, and writes what ParaView
//! opens.
//!
//! ```text
//! cargo run --release --example relax
//! ```

use foldwell::{Assembly, Pattern, Picture, RIGID, Rest, generate, relax, write_vtu};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let sheet = generate(&Pattern::named("miura")?)?;
    // creases that want to be folded half as far as they are drawn; polygons bend, but not easily
    let drawn = Assembly::patch(sheet.clone(), [4, 4]).build()?;
    let rest: Vec<f64> = drawn.drawn_angles().iter().map(|angle| 0.5 * angle).collect();
    println!("{:>10} {:>14} {:>6}", "EA", "energy", "steps");
    for stiffness in [1e2, 1e4, 1e8, RIGID] {
        let assembly = Assembly::patch(sheet.clone(), [4, 4])
            .bars(stiffness)
            .creases(1.0)
            .facets(10.0)
            .rest(Rest::PerEdge(rest.clone()))
            .build()?;
        let relaxed = relax(&assembly)?;
        println!("{stiffness:10.0e} {:14.9} {:6}", relaxed.state.total(), relaxed.iterations);
        let file = std::env::temp_dir().join(format!("miura-{stiffness:.0e}.vtu"));
        write_vtu(&file, &Picture::new(&assembly, &relaxed.state))?;
        println!("           {}", file.display());
    }
    Ok(())
}
