//! A separable quadratic function under local constraints, and its numbers at one state.

use foldwell_numerics::parallel;
use foldwell_numerics::sparse::Cliques;
use std::ops::Range;

/// Minimise `sum_i (z_i - a_i)^2 / (2 c_i)` under the constraints `F(z) = 0`, which come in small blocks.
///
/// A block has one to six rows and depends on few variables. A variable of compliance zero keeps its target.
pub trait ConstrainedProblem: Sync {
    /// Returns the rows and the variables of each block, the same at every state.
    fn blocks(&self) -> &Blocks;

    /// Returns the target `a_i` of each variable.
    fn target(&self) -> &[f64];

    /// Returns the compliance `c_i > 0` of each variable.
    fn compliance(&self) -> &[f64];

    /// Puts the values and the Jacobian of block `number` at `z` into `out`, and, if multipliers of its rows are
    /// given, the Hessian of `multipliers . F`.
    fn linearize(&self, number: usize, z: &[f64], multipliers: Option<&[f64]>, out: &mut Block);
}

/// The rows of each block of constraints and the variables on which it depends.
#[derive(Clone, Debug)]
pub struct Blocks {
    /// Variables of each block, each listed once.
    pub variables: Cliques,
    /// Number of the first row of each block, and the number of all rows.
    starts: Vec<usize>,
    /// Start of each block's Jacobian, and the number of all entries.
    entries: Vec<usize>,
    /// Start of each block's Hessian, and the number of all entries.
    squares: Vec<usize>,
}

/// One block of constraints at one state.
#[derive(Clone, Debug, Default)]
pub struct Block {
    /// Values of the rows.
    pub values: Vec<f64>,
    /// Derivatives of the rows by the variables of the block, variable by variable.
    pub jacobian: Vec<f64>,
    /// Lower triangle of the Hessian of `multipliers . F` by the variables of the block, row by row; empty without
    /// multipliers.
    pub hessian: Vec<f64>,
}

impl Default for Blocks {
    fn default() -> Self {
        Self { variables: Cliques::new(), starts: vec![0], entries: vec![0], squares: vec![0] }
    }
}

impl Blocks {
    /// Appends a block of `rows` constraints on these variables.
    pub fn push(&mut self, rows: usize, variables: &[u32]) {
        self.variables.push(variables.iter().copied());
        let count = variables.len();
        let extend = |starts: &mut Vec<usize>, by: usize| starts.push(starts[starts.len() - 1] + by);
        extend(&mut self.starts, rows);
        extend(&mut self.entries, rows * count);
        extend(&mut self.squares, count * (count + 1) / 2);
    }

    /// Returns the number of blocks.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there is no block.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the numbers of the rows of a block.
    pub fn rows(&self, block: usize) -> Range<usize> {
        self.starts[block]..self.starts[block + 1]
    }

    /// Returns the number of rows of all blocks.
    pub fn total_rows(&self) -> usize {
        self.starts[self.len()]
    }

    fn jacobian(&self, block: usize) -> Range<usize> {
        self.entries[block]..self.entries[block + 1]
    }

    fn hessian(&self, block: usize) -> Range<usize> {
        self.squares[block]..self.squares[block + 1]
    }
}

/// The constraints at one state: values, Jacobian `J`, and the Hessian `W` of `multipliers . F`.
#[derive(Clone, Debug)]
pub(super) struct Derivatives {
    pub(super) values: Vec<f64>,
    jacobian: Vec<f64>,
    /// Empty unless asked for.
    hessian: Vec<f64>,
}

impl Derivatives {
    /// Makes room for the constraints of a problem.
    pub(super) fn new(blocks: &Blocks) -> Self {
        let entries = blocks.entries[blocks.len()];
        Self { values: vec![0.0; blocks.total_rows()], jacobian: vec![0.0; entries], hessian: vec![] }
    }

    /// Evaluates the constraints at `z`, with their Hessian if multipliers are given.
    pub(super) fn evaluate<P: ConstrainedProblem>(&mut self, problem: &P, z: &[f64], multipliers: Option<&[f64]>) {
        let blocks = problem.blocks();
        let squares = if multipliers.is_some() { blocks.squares[blocks.len()] } else { 0 };
        self.hessian.resize(squares, 0.0);
        let compute = |k: usize, out: &mut Block| {
            problem.linearize(k, z, multipliers.map(|all| &all[blocks.rows(k)]), out);
        };
        parallel::compute_and_consume(blocks.len(), compute, |k, block| {
            self.values[blocks.rows(k)].copy_from_slice(&block.values);
            self.jacobian[blocks.jacobian(k)].copy_from_slice(&block.jacobian);
            if multipliers.is_some() {
                self.hessian[blocks.hessian(k)].copy_from_slice(&block.hessian);
            }
        });
    }

    /// Returns the derivatives of the rows of a block by the variable at `place` in its list.
    pub(super) fn column(&self, blocks: &Blocks, block: usize, place: usize) -> &[f64] {
        let (start, rows) = (blocks.entries[block], blocks.rows(block).len());
        &self.jacobian[start + place * rows..start + (place + 1) * rows]
    }

    /// Returns `J v`.
    pub(super) fn product(&self, blocks: &Blocks, v: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; blocks.total_rows()];
        for block in 0..blocks.len() {
            let out = &mut out[blocks.rows(block)];
            let columns = self.jacobian[blocks.jacobian(block)].chunks_exact(out.len());
            for (&variable, column) in blocks.variables.members(block).iter().zip(columns) {
                out.iter_mut().zip(column).for_each(|(out, entry)| *out += entry * v[variable as usize]);
            }
        }
        out
    }

    /// Adds `J^T multipliers` to `out`.
    pub(super) fn add_transpose_product(&self, blocks: &Blocks, multipliers: &[f64], out: &mut [f64]) {
        for block in 0..blocks.len() {
            let multipliers = &multipliers[blocks.rows(block)];
            let columns = self.jacobian[blocks.jacobian(block)].chunks_exact(multipliers.len());
            for (&variable, column) in blocks.variables.members(block).iter().zip(columns) {
                out[variable as usize] += column.iter().zip(multipliers).map(|(a, b)| a * b).sum::<f64>();
            }
        }
    }

    /// Adds `W v` to `out`, if the Hessian was asked for.
    pub(super) fn add_hessian_product(&self, blocks: &Blocks, v: &[f64], out: &mut [f64]) {
        if self.hessian.is_empty() {
            return;
        }
        for block in 0..blocks.len() {
            let mut entries = self.hessian[blocks.hessian(block)].iter();
            let variables = blocks.variables.members(block);
            for (place, &row) in variables.iter().enumerate() {
                for (&column, &entry) in variables[..=place].iter().zip(&mut entries) {
                    out[row as usize] += entry * v[column as usize];
                    if row != column {
                        out[column as usize] += entry * v[row as usize];
                    }
                }
            }
        }
    }
}
