//! Bands of relaxed states, whose bars and hinges carry forces, and of cylinders.
//!
//! Sources: waves that repeat after some cells are vibrations of the torus of these cells (its Hessian is assembled by
//! the model); rigid motions of a cylinder are waves without energy, translations across the axis at the wavenumbers of
//! the lattice rotations.

use crate::common::{mesh, stressed_hessian};
use foldwell::analysis::bloch::BlochError;
use foldwell::analysis::bloch::bands::DynamicalMatrix;
use foldwell::analysis::modes::modes_at;
use foldwell::analysis::relax::{Relaxed, relax_from};
use foldwell::model::Configuration;
use foldwell::model::{Assembly, Builder, Gauge, Mass, Model};
use foldwell::sheet::generate::Random;
use foldwell::solver::Options;
use foldwell::{Pattern, RIGID, Rest, Sheet, generate};

/// Relaxes an assembly; returns its model with the angles of the state.
fn relaxed(assembly: &Assembly) -> (Relaxed, Model) {
    let model = assembly.model(Gauge::Held);
    let relaxed = relax_from(&model, model.start(), Options::default(), &mut |_| true).unwrap();
    let mut free = assembly.model(Gauge::Free);
    free.enter(&relaxed.configuration);
    (relaxed, free)
}

fn springs(builder: Builder) -> Assembly {
    builder.bars(1e3).creases(1.0).rest(Rest::Flat).mass(Mass::Area(0.2)).build().unwrap()
}

fn cells() -> [Sheet; 2] {
    [mesh("open-star"), generate(&Pattern::Random(Random { seed: 6, ..Random::default() })).unwrap()]
}

/// Returns the state of several cells that are all in the state of one.
fn repeated(one: &Assembly, many: &Assembly, coordinates: &[f64]) -> Configuration {
    let drawn = &one.drawn().coordinates;
    let moved: Vec<f64> = coordinates.iter().zip(drawn).map(|(x, drawn)| x - drawn).collect();
    let coordinates: Vec<f64> =
        many.drawn().coordinates.iter().enumerate().map(|(k, x)| x + moved[k % moved.len()]).collect();
    let model = many.model(Gauge::Free);
    let tension = Some(model.stiff().map(|element| element.response(element.value(&coordinates))[1]).collect());
    let angles = model.angles();
    Configuration::new(coordinates, angles, tension)
}

/// Claim: the squared frequencies of waves in a relaxed, stressed state of a fixed torus of one cell are, at the
/// wavenumbers of 2 x 3 cells together, those of the torus of 2 x 3 cells in the same state. Tolerance: 1e-10 of the
/// largest, from states that agree to 1e-12.
#[test]
fn bands_of_stressed_states_are_those_of_tori() {
    for sheet in cells() {
        let one = springs(Assembly::fixed_torus(sheet.clone(), [1, 1]));
        let (state, model) = relaxed(&one);
        assert!(state.state.total() > 1e-2, "stressed: {}", state.state.total());
        let masses = Mass::Area(0.2).of_cell(&sheet);
        let matrix = DynamicalMatrix::of_state(&model, &state.state.coordinates).unwrap().with_masses(&masses);
        let bands = matrix.on_grid([2, 3], |_| true).unwrap().concat();
        let mut squares: Vec<f64> = bands.iter().map(|band| band * band.abs()).collect();
        squares.sort_by(f64::total_cmp);

        // relaxed, these cells may leave the state of one cell, which can be unstable against a wave
        let many = springs(Assembly::fixed_torus(sheet, [2, 3]));
        let start = repeated(&one, &many, &state.state.coordinates);
        let found = modes_at(&many, &start, squares.len(), &mut || true).unwrap().vibrations.unwrap().squares;
        let largest = found[found.len() - 1];
        assert_eq!(found.len(), squares.len());
        for (band, square) in squares.iter().zip(&found) {
            assert!((band - square).abs() <= 1e-10 * largest, "{band} for {square}");
        }
        let zeros = squares.iter().filter(|square| **square == 0.0).count();
        assert_eq!(zeros, 3, "translations of the whole torus");
    }
}

/// Claim: on a cylinder `D(0)` is the Hessian of the model by the vertices of its cell; two waves with `q = 0` cost
/// nothing, the translation along the axis and the rotation about it, and one at `q = (theta1, theta2)`, translations
/// across the axis. Tolerance: rounding, and of zeros 1e-9 of the largest, from residuals of 1e-12 over bars of 1e3.
#[test]
fn waves_on_a_cylinder() {
    let [sheet, _] = cells();
    let assembly = springs(Assembly::screw(sheet, [4, 4]));
    let (state, model) = relaxed(&assembly);
    let coordinates = &state.state.coordinates;
    let matrix = DynamicalMatrix::of_state(&model, coordinates).unwrap();
    // direction of the axis, curvature, and both lattice vectors in the plane: the rotations by the chart's definition
    let [direction, kappa, y1, y2, x1, x2] = *coordinates.last_chunk().unwrap();
    let theta = [(x1, y1), (x2, y2)].map(|(x, y)| kappa * (direction.cos() * y - direction.sin() * x));
    assert!(kappa.abs() > 0.05, "rolled up: {kappa}");

    // vertex 0 is none of the model's unknowns
    let count = coordinates.len() - 6 - 3;
    let expected = stressed_hessian(&model, &model.unknowns(coordinates), state.configuration.tensions());
    let at_zero = matrix.at([0.0; 2]);
    let largest = expected.amax();
    for (row, column) in (0..count).flat_map(|row| (0..count).map(move |column| (row, column))) {
        assert!((at_zero[(3 + row, 3 + column)].re - expected[(row, column)]).abs() <= 1e-12 * largest);
    }

    let zeros = |q: [f64; 2]| {
        let bands = matrix.bands(q).unwrap();
        bands.iter().filter(|band| band.abs() <= 1e-9 * largest).count()
    };
    assert_eq!(zeros([0.0; 2]), 2);
    assert_eq!(zeros(theta), 1);
    assert_eq!(zeros(theta.map(|theta| -theta)), 1);
    assert_eq!(zeros([theta[0] + 0.3, theta[1]]), 0);
}

/// Claim: a state with rigid bars has no bands of springs, and says which element is rigid.
#[test]
fn rigid_states_have_no_bands() {
    let assembly = Assembly::screw(mesh("open-star"), [4, 4]).bars(RIGID).creases(1.0).build().unwrap();
    let model = assembly.model(Gauge::Free);
    let refused = DynamicalMatrix::of_state(&model, &model.coordinates(&model.start()));
    assert!(matches!(refused, Err(BlochError::RigidElement { kind: "bars" })), "{refused:?}");
}
