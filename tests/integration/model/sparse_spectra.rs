//! Lowest eigenvalues of large sheets: the sparse method compared with a dense decomposition.

use crate::common::{self, Testing, eigenvalues, energy_hessian, on};
use approx::abs_diff_eq;
use foldwell::analysis::modes::DENSE_LIMIT;
use foldwell::model::Gauge;
use foldwell::model::{Boundary, Terms};
use foldwell::solver::Problem;

/// Claim: the lowest eigenvalues of a sheet just above the limit of the dense method are those of a dense decomposition
/// by another library to eight digits, for a patch and a torus, and their vectors satisfy `H v = lambda v` as well.
#[test]
fn sparse_and_dense_spectra_agree() {
    for boundary in [Boundary::Patch, Boundary::FixedTorus] {
        let case = on(common::mesh("open-star"), [10, 11], boundary);
        let terms = Terms::bars_and_creases(1e3, 1.0, case.drawn_angles().to_vec());
        let model = case.model_of(&terms, Gauge::Free);
        let size = model.layout().unknowns;
        assert!(size > DENSE_LIMIT && size < DENSE_LIMIT + 200, "{size}");
        let hessian = energy_hessian(&model, &model.start());
        let expected = eigenvalues(hessian.clone());
        let largest = expected[size - 1];
        let found = case.modes_of(&terms, 24).unwrap();
        for (k, (value, expected)) in found.eigenvalues.iter().zip(&expected).enumerate() {
            let allowed = 1e-8 * expected.abs() + 1e-13 * largest;
            assert!(abs_diff_eq!(value, expected, epsilon = allowed), "{boundary:?}, {k}: {value:e} for {expected:e}");
        }
        for (value, vector) in found.eigenvalues.iter().zip(&found.vectors) {
            let v = nalgebra::DVector::from_column_slice(vector);
            let off = (&hessian * &v - *value * &v).norm() / v.norm();
            assert!(off < 1e-8 * largest, "{off:e}");
        }
        let zeros = if boundary == Boundary::Patch { 6 } else { 3 };
        assert!(found.eigenvalues[zeros] > 1e-9 * largest);
        assert!(found.eigenvalues[..zeros].iter().all(|v| v.abs() < 1e-12 * largest));
    }
}
