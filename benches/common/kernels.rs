//! The two factorizations of `numerics::factor`, each at any size, to find the size at which they are equally fast.

use super::seconds;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::solvers::{Lblt, Solve};
use faer::perm::PermRef;
use faer::prelude::{ReborrowMut, default};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, MatRef, Par, Side};
use foldwell::numerics::{order, sparse::SparsityPattern};
use foldwell::solver::Layout;

/// Supernodal `L D L^T` with nested dissection, on one thread.
pub struct Sparse {
    columns: Vec<u32>,
    rows: Vec<u32>,
    symbolic: SymbolicCholesky<u32>,
    stored: Vec<f64>,
    memory: MemBuffer,
}

impl Sparse {
    /// Analyses a pattern.
    pub fn new(pattern: &SparsityPattern, layout: &Layout) -> Self {
        let n = pattern.size();
        let (mut columns, mut rows) = (vec![0u32], Vec::new());
        for k in 0..n {
            rows.extend_from_slice(pattern.column(k));
            columns.push(rows.len() as u32);
        }
        let order = order::nested_dissection(&layout.node, &[&layout.soft, &layout.stiff]);
        let mut inverse = vec![0u32; n];
        order.iter().enumerate().for_each(|(new, &old)| inverse[old as usize] = new as u32);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..default()
        };
        let ordering = SymmetricOrdering::Custom(PermRef::new_checked(&order, &inverse, n));
        let structure = SymbolicSparseColMatRef::new_checked(n, n, &columns, None, &rows);
        let symbolic = factorize_symbolic_cholesky(structure, Side::Lower, ordering, params).unwrap();
        let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, default());
        let memory = MemBuffer::new(scratch.or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)));
        Self { stored: vec![0.0; symbolic.len_val()], columns, rows, symbolic, memory }
    }

    /// Returns the time in seconds of one factorization and one solve.
    pub fn factor_and_solve(&mut self, values: &[f64], right: &[f64]) -> f64 {
        let n = right.len();
        let mut x = right.to_vec();
        seconds(|| {
            let structure = SymbolicSparseColMatRef::new_checked(n, n, &self.columns, None, &self.rows);
            let matrix = SparseColMatRef::new(structure, values);
            let stack = MemStack::new(&mut self.memory);
            self.symbolic
                .factorize_numeric_ldlt(&mut self.stored, matrix, Side::Lower, default(), Par::Seq, stack, default())
                .unwrap();
            let mut x = MatMut::from_column_major_slice_mut(&mut x, n, 1);
            let stack = MemStack::new(&mut self.memory);
            LdltRef::new(&self.symbolic, &self.stored).solve_in_place_with_conj(Conj::No, x.rb_mut(), Par::Seq, stack);
        })
    }
}

/// Returns the time in seconds of one Bunch-Kaufman factorization and one solve.
pub fn dense_factor_and_solve(pattern: &SparsityPattern, values: &[f64], right: &[f64]) -> f64 {
    let n = right.len();
    let mut x = right.to_vec();
    seconds(|| {
        let dense = pattern.to_dense(values);
        let factor = Lblt::new(MatRef::from_column_major_slice(dense.as_slice(), n, n), Side::Lower);
        factor.solve_in_place(MatMut::from_column_major_slice_mut(&mut x, n, 1));
    })
}
