//! `L D L^T` factorization of symmetric matrices, with inertia, for one pattern and many sets of numbers.
//!
//! Sparse: multifrontal, without pivoting, on all of the caller's threads ([`super::fronts`]). The pattern is analysed
//! once ([`Symbolic`]). Small matrices go through a dense Bunch-Kaufman factorization, which pivots. Sylvester's law of
//! inertia: the signs of D are the signs of the eigenvalues, and that is how an indefinite Hessian is recognised.

pub use super::factor_error::FactorError;
use super::fronts::{AssemblyTree, Fronts};
use super::sparse::{Cliques, SparsityPattern};
use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::lblt;
use faer::perm::{Perm, PermRef};
use faer::prelude::default;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{CholeskySymbolicParams, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::{Conj, Mat, MatMut, MatRef, Par, Side};
use std::sync::Arc;

/// Matrices up to this size are factored dense. It is no faster (`cargo bench --bench iteration -- dense`: 1.4 times as
/// long up to 42 unknowns), but single cells are small enough to afford pivoting.
pub const DENSE_LIMIT: usize = 64;

/// Signs and range of the pivots of the last factorization.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// Number of negative eigenvalues.
    pub negative: usize,
    /// Smallest pivot in magnitude over the largest.
    pub ratio: f64,
}

/// The symbolic analysis of a pattern: the order of elimination and the pattern of the factor. Shared by all its
/// factorizations.
#[derive(Clone, Debug)]
pub(crate) struct Symbolic {
    size: usize,
    /// `None` for a small matrix, which is factored dense.
    sparse: Option<Arc<AssemblyTree>>,
}

/// A factorization of one pattern, refilled with numbers as often as wanted.
pub struct Factor {
    kind: Kind,
    size: usize,
}

enum Kind {
    Dense(Option<Box<Dense>>),
    Sparse(Box<Fronts>),
}

impl Factor {
    /// Analyses a pattern and makes room for its factorizations. `node` groups unknowns into blocks, see
    /// [`super::order`]; `cliques` are those of which the pattern is made.
    ///
    /// # Errors
    /// [`FactorError::TooLarge`] where memory or indices run out.
    pub fn new(pattern: &SparsityPattern, node: &[u32], cliques: &[&Cliques]) -> Result<Self, FactorError> {
        Self::of(&Symbolic::new(pattern, node, cliques)?)
    }

    /// Makes room for a factorization of a pattern that was analysed.
    pub(crate) fn of(symbolic: &Symbolic) -> Result<Self, FactorError> {
        let kind = match &symbolic.sparse {
            None => Kind::Dense(None),
            Some(sparse) => Kind::Sparse(Box::new(Fronts::new(sparse)?)),
        };
        Ok(Self { kind, size: symbolic.size })
    }

    /// Factors the matrix with these values, the entries of its lower triangle in the pattern. Returns the inertia.
    ///
    /// # Errors
    /// [`FactorError::NotFinite`] and [`FactorError::Singular`].
    pub fn factor(&mut self, pattern: &SparsityPattern, values: &[f64]) -> Result<Inertia, FactorError> {
        if values.iter().any(|v| !v.is_finite()) {
            return Err(FactorError::NotFinite);
        }
        let inertia = match &mut self.kind {
            Kind::Dense(factor) => {
                let (made, inertia) = Dense::new(pattern, values);
                *factor = Some(Box::new(made));
                Ok(inertia)
            }
            Kind::Sparse(sparse) => sparse.factor(values).map(|()| inertia(sparse.pivots())),
        }?;
        let singular = !(inertia.ratio > f64::EPSILON * f64::EPSILON);
        if singular { Err(FactorError::Singular { ratio: inertia.ratio }) } else { Ok(inertia) }
    }

    /// Solves with the last factorization, in place.
    pub fn solve(&mut self, x: &mut [f64]) {
        match &mut self.kind {
            Kind::Dense(Some(factor)) => factor.solve(x),
            Kind::Dense(None) => unreachable!("solve is called after factor"),
            Kind::Sparse(sparse) => sparse.solve(x),
        }
    }

    /// Count of numbers stored in the factor.
    pub fn stored(&self) -> usize {
        match &self.kind {
            Kind::Dense(_) => self.size * (self.size + 1) / 2,
            Kind::Sparse(sparse) => sparse.stored(),
        }
    }
}

impl Symbolic {
    /// Analyses a pattern. `node` groups unknowns into blocks for the ordering, see [`super::order`].
    pub(crate) fn new(pattern: &SparsityPattern, node: &[u32], cliques: &[&Cliques]) -> Result<Self, FactorError> {
        Self::ordered(pattern, || super::order::nested_dissection(node, cliques))
    }

    /// Analyses a pattern whose unknowns are numbered in the order of elimination.
    pub(super) fn in_order(pattern: &SparsityPattern) -> Result<Self, FactorError> {
        Self::ordered(pattern, || (0..pattern.size() as u32).collect())
    }

    /// Analyses a pattern for this order of elimination; a small matrix is factored dense and needs none.
    fn ordered(pattern: &SparsityPattern, order: impl FnOnce() -> Vec<u32>) -> Result<Self, FactorError> {
        let size = pattern.size();
        if size <= DENSE_LIMIT {
            return Ok(Self { size, sparse: None });
        }
        let order = order();
        let inverse = super::order::inverse(&order);
        let ordering = SymmetricOrdering::Custom(PermRef::new_checked(&order, &inverse, size));
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..default()
        };
        let found = factorize_symbolic_cholesky(pattern.symbolic(), Side::Lower, ordering, params);
        let found = found.map_err(|_| FactorError::TooLarge { size })?;
        Ok(Self { size, sparse: Some(Arc::new(AssemblyTree::new(pattern, &found))) })
    }
}

fn inertia(pivots: impl Iterator<Item = f64>) -> Inertia {
    let (mut negative, mut least, mut most) = (0, f64::INFINITY, 0.0f64);
    for pivot in pivots {
        negative += usize::from(pivot < 0.0);
        least = if pivot.is_nan() { 0.0 } else { least.min(pivot.abs()) };
        most = most.max(pivot.abs());
    }
    let ratio = least / most;
    Inertia { negative, ratio: if ratio.is_nan() { 0.0 } else { ratio } }
}

/// A Bunch-Kaufman factorization `P A P^T = L B L^T` with a diagonal `B` of 1 x 1 and 2 x 2 blocks.
///
/// faer's own type for it asks a setting of the process how many threads to use; this one uses the calling thread.
struct Dense {
    lower: Mat<f64>,
    diagonal: Diag<f64>,
    subdiagonal: Diag<f64>,
    permutation: Perm<usize>,
    memory: MemBuffer,
}

impl Dense {
    fn new(pattern: &SparsityPattern, values: &[f64]) -> (Self, Inertia) {
        let n = pattern.size();
        let dense = pattern.to_dense(values);
        let mut lower = Mat::zeros(n, n);
        lower.copy_from_triangular_lower(MatRef::from_column_major_slice(dense.as_slice(), n, n));
        let (mut diagonal, mut subdiagonal) = (Diag::zeros(n), Diag::zeros(n));
        let (mut forward, mut backward) = (vec![0; n], vec![0; n]);
        let mut memory = MemBuffer::new(
            lblt::factor::cholesky_in_place_scratch::<usize, f64>(n, Par::Seq, default())
                .or(lblt::solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq)),
        );
        let stack = MemStack::new(&mut memory);
        let (matrix, below) = (lower.as_mut(), subdiagonal.as_mut());
        lblt::factor::cholesky_in_place(matrix, below, &mut forward, &mut backward, Par::Seq, stack, default());
        diagonal.copy_from(lower.diagonal());
        lower.diagonal_mut().fill(1.0);
        let permutation = Perm::new_checked(forward.into(), backward.into(), n);
        let made = Self { lower, diagonal, subdiagonal, permutation, memory };
        let inertia = inertia(made.pivots().into_iter());
        (made, inertia)
    }

    /// The eigenvalues of the diagonal blocks.
    fn pivots(&self) -> Vec<f64> {
        let (diagonal, below) = (self.diagonal.column_vector(), self.subdiagonal.column_vector());
        let n = diagonal.nrows();
        let mut pivots = Vec::with_capacity(n);
        let mut k = 0;
        while k < n {
            if k + 1 < n && below[k] != 0.0 {
                let (mean, half) = ((diagonal[k] + diagonal[k + 1]) / 2.0, (diagonal[k] - diagonal[k + 1]) / 2.0);
                let spread = half.hypot(below[k]);
                pivots.extend([mean - spread, mean + spread]);
                k += 2;
            } else {
                pivots.push(diagonal[k]);
                k += 1;
            }
        }
        pivots
    }

    fn solve(&mut self, x: &mut [f64]) {
        let n = x.len();
        let (x, stack) = (MatMut::from_column_major_slice_mut(x, n, 1), MemStack::new(&mut self.memory));
        let (lower, order) = (self.lower.as_ref(), self.permutation.as_ref());
        let (diagonal, below) = (self.diagonal.as_ref(), self.subdiagonal.as_ref());
        lblt::solve::solve_in_place_with_conj(lower, diagonal, below, Conj::No, order, x, Par::Seq, stack);
    }
}
