//! First use of the library: the names at its root, rigid facets, and short errors.

use foldwell::sheet::generate::SquareTwist;
use foldwell::solver::NewtonError;
use foldwell::{Assembly, Pattern, Picture, RIGID, Relaxed, Rest, generate, relax, write_vtu};
use std::error::Error;

/// Largest number of characters of an error that `main` returns: half a screen.
const MOST_CHARACTERS: usize = 500;

/// Claim: twelve lines that use only names of the root relax a Miura-ori of 3 x 3 cells, with rigid bars and other rest
/// angles than the drawn ones, and write a VTU file that can be read back. Facets that are not mentioned are rigid: the
/// polygons stay flat, and the sheet then unfolds to zero energy. Tolerances: those of the solver, 1e-12 of the forces.
#[test]
fn twelve_lines_relax_a_miura_ori() {
    fn program(file: &std::path::Path) -> Result<(Assembly, Relaxed), Box<dyn Error>> {
        let sheet = generate(&Pattern::named("miura")?)?;
        let assembly = Assembly::patch(sheet, [3, 3]).bars(RIGID).creases(1.0).rest(Rest::Flat).build()?;
        let relaxed = relax(&assembly)?;
        write_vtu(file, &Picture::new(&assembly, &relaxed.state))?;
        Ok((assembly, relaxed))
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("miura.vtu");
    let (assembly, relaxed) = program(&file).unwrap();
    assert!(assembly.terms().has_rigid_facets() && relaxed.state.total() < 1e-12 && relaxed.iterations > 1);
    for facet in assembly.tiling().facets() {
        assert!(relaxed.state.fold_angle[facet].abs() < 1e-9, "facet {facet}: {}", relaxed.state.fold_angle[facet]);
    }
    let read = foldwell::output::vtk::read_vtu(&file).unwrap();
    assert_eq!(read.points.len(), assembly.tiling().positions.len());
}

/// Claim: the error of a relaxation that fails has less than 500 characters, also by `{:?}`, with which `main` prints
/// it: its state and history are not printed.
#[test]
fn failures_print_few_characters() {
    let sheet = generate(&Pattern::SquareTwist(SquareTwist::default())).unwrap();
    let rest = Rest::Angle(3.0); // mountains to valleys and beyond, in a sheet that folds in one way only
    let assembly = Assembly::patch(sheet, [2, 2]).bars(RIGID).creases(1.0).facets(1e-9).rest(rest).build().unwrap();
    let model = assembly.model(foldwell::model::Gauge::Held);
    let few_steps = foldwell::solver::Options { iterations: 3, ..foldwell::solver::Options::default() };
    let failed = foldwell::analysis::relax::relax_from(&model, model.start(), few_steps, &mut |_| true).unwrap_err();
    assert!(!failed.configuration.coordinates.is_empty(), "the last state goes along");
    for text in [format!("{failed:?}"), format!("{failed}"), format!("{:?}", failed as Box<dyn Error>)] {
        assert!((10..MOST_CHARACTERS).contains(&text.len()), "{text}");
    }
    let newton = NewtonError {
        failure: foldwell::solver::Failure::Interrupted,
        x: vec![0.5; 10_000],
        tension: vec![0.5; 10_000],
        history: Vec::new(),
    };
    assert!(format!("{newton:?}").len() < MOST_CHARACTERS, "{newton:?}");
}
