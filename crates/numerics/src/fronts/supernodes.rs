//! The supernodes of faer's analysis as a tree.

use faer::sparse::linalg::cholesky::{SymbolicCholesky, SymbolicCholeskyRaw};
use std::ops::Range;

/// No front: the parent of a root.
pub(super) const NONE: usize = usize::MAX;
/// Additions and multiplications of a factorization below which it is one task (measured:
/// `cargo bench --bench systems`; 12 x 12 cells take as long on two threads as on one).
const FEWEST_SHARED_OPERATIONS: f64 = 6e7;
/// Number of tasks at which subtrees are not divided further, where that leaves them within these bounds. The larger
/// the tasks, the less memory is in use at a time.
const TASKS: f64 = 32.0;
const OPERATIONS_OF_A_TASK: [f64; 2] = [1e6, 1.6e7];
/// Depth in the tree below which a subtree is not divided, so that recursion ends.
const DEEPEST_DIVIDED: usize = 200;

/// The supernodes of faer's analysis.
pub(super) struct Supernodes<'a> {
    /// First column of each, and the one after the last.
    begin: &'a [u32],
    end: &'a [u32],
    /// Starts of the lists of rows below, and the rows.
    starts: &'a [u32],
    pub rows: &'a [u32],
    /// The supernode that contains the first row below, or [`NONE`].
    pub parent: Vec<usize>,
    /// Operations of each subtree.
    pub operations: Vec<f64>,
    /// Operations from which a subtree is divided into several tasks.
    pub share: f64,
    /// Number of supernodes above each.
    pub depth: Vec<usize>,
    /// Whether the subtree is divided into several tasks.
    pub divided: Vec<bool>,
}

impl<'a> Supernodes<'a> {
    /// Builds the tree: the parent of a supernode is the one that contains its first row below.
    pub fn new(analysis: &'a SymbolicCholesky<u32>) -> Self {
        let SymbolicCholeskyRaw::Supernodal(nodes) = analysis.raw() else {
            unreachable!("the analysis is forced to be supernodal")
        };
        let (begin, end) = (nodes.supernode_begin(), nodes.supernode_end());
        let (starts, rows) = (nodes.col_ptr_for_row_idx(), nodes.row_idx());
        let (parent, operations, share) = (vec![NONE; begin.len()], vec![], f64::INFINITY);
        let (depth, divided) = (vec![0; begin.len()], vec![false; begin.len()]);
        let mut made = Self { begin, end, starts, rows, parent, operations, share, depth, divided };
        for k in 0..begin.len() {
            if let Some(&row) = made.rows(k).first() {
                made.parent[k] = end.partition_point(|&end| end <= row);
            }
        }
        made.divide();
        made
    }

    /// Counts operations and decides which subtrees are divided.
    fn divide(&mut self) {
        let count = self.count();
        self.operations = (0..count).map(|k| self.own_operations(k)).collect();
        let all: f64 = self.operations.iter().sum();
        if all >= FEWEST_SHARED_OPERATIONS {
            let [least, most] = OPERATIONS_OF_A_TASK;
            self.share = (all / TASKS).clamp(least, most);
        }
        for k in (0..count).filter(|k| self.parent[*k] != NONE) {
            self.operations[self.parent[k]] += self.operations[k];
        }
        for k in (0..count).rev() {
            self.depth[k] = if self.parent[k] == NONE { 0 } else { self.depth[self.parent[k]] + 1 };
            self.divided[k] = self.operations[k] > self.share && self.depth[k] < DEEPEST_DIVIDED;
        }
    }

    /// Returns the number of supernodes.
    fn count(&self) -> usize {
        self.begin.len()
    }

    /// Returns the rows below the pivots.
    pub fn rows(&self, k: usize) -> &'a [u32] {
        &self.rows[self.starts[k] as usize..self.starts[k + 1] as usize]
    }

    /// Returns the columns of the pivots.
    pub fn columns(&self, k: usize) -> Range<u32> {
        self.begin[k]..self.end[k]
    }

    /// Returns the count of additions and multiplications of one elimination.
    fn own_operations(&self, k: usize) -> f64 {
        let (width, below) = (self.columns(k).len(), self.rows(k).len());
        (1..=width).map(|k| ((below + k) as f64).powi(2)).sum()
    }

    /// Returns the postorder in which the children that are not divided come first.
    pub fn postorder(&self) -> Vec<usize> {
        let count = self.count();
        let mut children = vec![Vec::new(); count + 1];
        for divided in [false, true] {
            for k in (0..count).filter(|k| self.divided[*k] == divided) {
                children[self.parent[k].min(count)].push(k);
            }
        }
        let (mut order, mut waiting) = (Vec::with_capacity(count), children[count].clone());
        // parents before children, the last child first, and then all of it in reverse
        while let Some(k) = waiting.pop() {
            order.push(k);
            waiting.extend_from_slice(&children[k]);
        }
        order.reverse();
        order
    }
}
