//! The elimination of the pivots of one front.
//!
//! Large fronts are worked on in tiles, which threads share out. The tiles depend on the size of the front alone, and
//! so do the sums and their rounding.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::{matmul::matmul, triangular_solve::solve_unit_lower_triangular_in_place};
use faer::prelude::{Reborrow, ReborrowMut, default};
use faer::{Accum, MatMut, MatRef, Par};

/// Number of pivots that are eliminated at once.
pub(super) const PIVOTS_AT_ONCE: usize = 128;
/// Rows and columns of a tile.
const TILE: usize = 128;
/// Multiplications of a product from which it is worked on in tiles.
const FEWEST_TILED: usize = 1 << 23;

/// Memory for the kernels, for one thread.
pub(super) struct Kernels(MemBuffer);

/// A pivot that is zero or not finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ZeroPivot;

/// An assembled front, as dense matrices.
pub(super) struct DenseFront<'a> {
    /// The columns of the pivots, with all rows.
    pub panel: MatMut<'a, f64>,
    /// Room for a copy of [`PIVOTS_AT_ONCE`] columns of the panel.
    pub room: &'a mut [f64],
    /// The update matrix; what it contains is not read.
    pub update: MatMut<'a, f64>,
}

impl Kernels {
    /// Allocates the memory.
    pub fn new() -> Self {
        Self(MemBuffer::new(cholesky_in_place_scratch::<f64>(PIVOTS_AT_ONCE, Par::Seq, default())))
    }
}

impl DenseFront<'_> {
    /// Replaces the panel by `L` and `D`, and the update matrix by `-L D L^T` of the rows below, the lower triangle.
    pub fn eliminate(self, kernels: &mut Kernels, shared: bool) -> Result<(), ZeroPivot> {
        let DenseFront { mut panel, room, mut update } = self;
        let (height, width) = (panel.nrows(), panel.ncols());
        for start in (0..width).step_by(PIVOTS_AT_ONCE) {
            let count = PIVOTS_AT_ONCE.min(width - start);
            let rest = panel.rb_mut().submatrix_mut(start, start, height - start, width - start);
            let (mut pivots, _, mut below, trailing) = rest.split_at_mut(count, count);
            let stack = MemStack::new(&mut kernels.0);
            cholesky_in_place(pivots.rb_mut(), default(), Par::Seq, stack, default()).map_err(|_| ZeroPivot)?;
            let rows = below.nrows();
            let mut copy = MatMut::from_column_major_slice_mut(&mut room[..rows * count], rows, count);
            divide(pivots.rb(), below.rb_mut(), copy.rb_mut(), shared);
            let inner = width - start - count;
            subtract(trailing, below.rb(), copy.rb(), Accum::Add, shared);
            let accum = if start == 0 { Accum::Replace } else { Accum::Add };
            let [below, copy] = [below.rb(), copy.rb()].map(|all| all.subrows(inner, rows - inner));
            subtract(update.rb_mut(), below, copy, accum, shared);
        }
        Ok(())
    }
}

/// `below := below L^-T D^-1` with the `L` and `D` of the pivots, and `copy := below D`.
fn divide(pivots: MatRef<'_, f64>, below: MatMut<'_, f64>, copy: MatMut<'_, f64>, shared: bool) {
    if below.nrows() > 2 * TILE {
        let half = halved(below.nrows());
        let ((top, bottom), (copy_top, copy_bottom)) = (below.split_at_row_mut(half), copy.split_at_row_mut(half));
        join(shared, || divide(pivots, top, copy_top, shared), || divide(pivots, bottom, copy_bottom, shared));
        return;
    }
    let (mut below, mut copy) = (below, copy);
    solve_unit_lower_triangular_in_place(pivots, below.rb_mut().transpose_mut(), Par::Seq);
    for k in 0..pivots.ncols() {
        let inverse = pivots[(k, k)].recip();
        let columns = [below.rb_mut().col_mut(k), copy.rb_mut().col_mut(k)].map(|c| c.try_as_col_major_mut());
        let [Some(column), Some(copy)] = columns else { unreachable!("columns are contiguous") };
        for (entry, copy) in column.as_slice_mut().iter_mut().zip(copy.as_slice_mut()) {
            *copy = *entry;
            *entry *= inverse;
        }
    }
}

/// `target := target - left right^T` in the lower trapezoid of the target.
fn subtract(target: MatMut<'_, f64>, left: MatRef<'_, f64>, right: MatRef<'_, f64>, accum: Accum, shared: bool) {
    let (rows, columns) = (target.nrows(), target.ncols());
    if rows == 0 || columns == 0 {
        return;
    }
    if columns > TILE && rows * columns * left.ncols() > FEWEST_TILED {
        let half = halved(columns);
        let (top, _, bottom, rest) = target.split_at_mut(half, half);
        let (above, below) = left.split_at_row(half);
        let (first, second) = right.split_at_row(half);
        join(
            shared,
            || {
                subtract(top, above, first, accum, shared);
                subtract(rest, below, second, accum, shared);
            },
            || multiply(bottom, below, first.subrows(0, half), accum, shared),
        );
        return;
    }
    let (mut top, bottom) = target.split_at_row_mut(columns);
    let (above, below) = left.split_at_row(columns);
    let right = right.subrows(0, columns);
    let [lower, whole] = [BlockStructure::TriangularLower, BlockStructure::Rectangular];
    triangular::matmul(top.rb_mut(), lower, accum, above, whole, right.transpose(), whole, -1.0, Par::Seq);
    multiply(bottom, below, right, accum, shared);
}

/// `target := target - left right^T`.
fn multiply(target: MatMut<'_, f64>, left: MatRef<'_, f64>, right: MatRef<'_, f64>, accum: Accum, shared: bool) {
    let (rows, columns) = (target.nrows(), target.ncols());
    if rows == 0 {
        return;
    }
    if (rows > 2 * TILE || columns > 2 * TILE) && rows * columns * left.ncols() > FEWEST_TILED {
        if rows > columns {
            let half = halved(rows);
            let (top, bottom) = target.split_at_row_mut(half);
            let (above, below) = left.split_at_row(half);
            join(
                shared,
                || multiply(top, above, right, accum, shared),
                || multiply(bottom, below, right, accum, shared),
            );
        } else {
            let half = halved(columns);
            let (first, second) = target.split_at_col_mut(half);
            let (above, below) = right.split_at_row(half);
            join(
                shared,
                || multiply(first, left, above, accum, shared),
                || multiply(second, left, below, accum, shared),
            );
        }
        return;
    }
    matmul(target, accum, left, right.transpose(), -1.0, Par::Seq);
}

/// Returns about half of a count of rows, a multiple of 16.
fn halved(count: usize) -> usize {
    (count / 2).next_multiple_of(16)
}

/// Does both, at the same time where work is `shared` between threads.
pub(super) fn join<A: Send, B: Send>(
    shared: bool,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if shared { rayon::join(a, b) } else { (a(), b()) }
}
