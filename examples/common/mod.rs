//! The steps that the examples of laws, terms and domains share: a relaxation, its VTU file, a path, and the wells.

use foldwell::analysis::path::{PathOptions, follow_path};
use foldwell::analysis::wells::merge::{Comparison, wells};
use foldwell::analysis::wells::starts::{Outcome, Starts, relax_around};
use foldwell::model::Drive;
use foldwell::solver::Options;
use foldwell::{Assembly, Picture, relax, write_vtu};
use std::error::Error;

/// Relaxes a sheet and writes the state as VTU, follows a path, and lists the wells that 8 random starts find.
pub fn use_it(name: &str, assembly: &Assembly, drive: &Drive) -> Result<(), Box<dyn Error>> {
    let state = relax(assembly)?.state;
    let file = std::env::temp_dir().join(format!("{name}.vtu"));
    write_vtu(&file, &Picture::new(assembly, &state))?;
    println!("{name}: energy {:.9}, of the creases {:.9}; {}", state.total(), state.energy_creases, file.display());

    let path = follow_path(assembly, drive, None, &PathOptions::default(), &mut |_, _| true)?;
    println!("  a path to {}: {} states, {:?}", drive.to, path[0].points.len(), path[0].end);

    let starts = Starts { count: 8, seed: 0, spread: 0.8, options: Options::default() };
    let ends = relax_around(assembly, None, &starts, &|| true).into_iter();
    let minima = ends.filter_map(|end| if let Outcome::Well(well) = end { Some(*well) } else { None });
    for well in wells(minima, &Comparison::new(assembly)) {
        println!("  a well of energy {:.9}, reached {} times", well.settled.energy, well.reached);
    }
    Ok(())
}
