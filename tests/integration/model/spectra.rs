//! Spectra of energies: the numbers of a published program, and the rigid limit.

use crate::common::{Testing, distance, on, patch};
use approx::abs_diff_eq;
use foldwell::model::{Boundary, Terms};
use foldwell::sheet::generate;
use foldwell::sheet::generate::{MiuraPatch, Pattern};

/// Claim: Miura-ori of 5 x 5 cells, EA = 1000, creases 0.1, facets 1, free boundary: six zeros, then the values below,
/// and the largest. Source: MERLIN (K. Liu, G. H. Paulino, Proc. R. Soc. A 473, 20170348, 2017) under Octave 7.3, on
/// the same 11 x 11 vertices. Tolerance: the nine digits recorded there.
#[test]
fn the_spectrum_of_a_published_program() {
    let pattern = Pattern::MiuraPatch(MiuraPatch { a: 2.0, b: 2.0, ..MiuraPatch::default() });
    let case = on(generate(&pattern).unwrap(), [1, 1], Boundary::Patch);
    let mut terms = Terms::bars_and_creases(1000.0, 0.1, case.drawn_angles().to_vec());
    terms.facets = case.facets(1.0);
    let found = case.modes_of(&terms, 363).unwrap().eigenvalues;
    assert_eq!(found.len(), 363);
    assert!(found[..6].iter().all(|value| value.abs() < 1e-11), "{:?}", &found[..6]);
    let expected = [5.97381064e-3, 6.94778873e-3, 2.88042394e-2, 4.28524374e-2];
    for (value, expected) in found[6..10].iter().chain(&found[362..]).zip(expected.iter().chain(&[2.87455173e3])) {
        assert!(abs_diff_eq!(value / expected, 1.0, epsilon = 1e-8), "{value:e} for {expected:e}");
    }
}

/// Claim: with rigid bars the spectrum is the limit of that of stiff ones: the lowest values on the motions that the
/// bars leave free differ from those at EA = 1e5 and 1e6 by amounts that decrease as 1/k.
#[test]
fn rigid_spectra_are_the_limit_of_stiff_ones() {
    let case = patch("open-star", [3, 3]);
    let spectrum = |bars: f64| {
        case.modes_of(&Terms::bars_and_creases(bars, 1.0, case.drawn_angles().to_vec()), 10).unwrap().eigenvalues
    };
    let rigid = spectrum(f64::INFINITY);
    let off = [1e5, 1e6].map(|bars| distance(&spectrum(bars)[6..], &rigid[6..]));
    assert!(off[0] < 1e-2 * rigid[9] && abs_diff_eq!(off[0] / off[1], 10.0, epsilon = 0.5), "{off:?} of {}", rigid[9]);
}
