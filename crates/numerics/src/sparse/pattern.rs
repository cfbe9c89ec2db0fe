//! The sparsity pattern of a symmetric matrix.

use super::cliques::{Cliques, FIXED};
use super::incidence::{Incidence, group};
use crate::DenseMatrix;
use faer::sparse::SymbolicSparseColMatRef;

/// The lower triangle of a symmetric matrix by columns, with the diagonal first in each column.
#[derive(Clone, Debug)]
pub struct SparsityPattern {
    n: usize,
    columns: Vec<u32>,
    rows: Vec<u32>,
}

impl SparsityPattern {
    /// SparsityPattern of the sum of all cliques' blocks; every diagonal entry is there.
    pub fn new(n: usize, cliques: &[&Cliques]) -> Self {
        let lists: Vec<(&Cliques, Incidence)> = cliques.iter().map(|&list| (list, Incidence::new(n, list))).collect();
        let (mut columns, mut rows) = (vec![0u32], Vec::new());
        let mut reached = vec![FIXED; n];
        for column in 0..n as u32 {
            let start = rows.len();
            rows.push(column);
            let mut reach = |member: u32| {
                if member != FIXED && member > column && reached[member as usize] != column {
                    reached[member as usize] = column;
                    rows.push(member);
                }
            };
            for (list, incidence) in &lists {
                let met = incidence.of(column).iter().map(|&(clique, _)| list.members(clique as usize));
                met.for_each(|members| members.iter().for_each(|&member| reach(member)));
            }
            rows[start..].sort_unstable();
            columns.push(rows.len() as u32);
        }
        Self { n, columns, rows }
    }

    /// This pattern with unknown `k` numbered `number[k]`, without the pairs of unknowns that are `apart`, and with
    /// `more` unknowns: the number of each and the unknowns, as they are numbered here, with which it is coupled. Also
    /// the slot that each entry of this pattern has there, or [`FIXED`].
    pub fn renumbered(
        &self,
        number: &[u32],
        more: &[(u32, Vec<u32>)],
        apart: impl Fn(u32, u32) -> bool,
    ) -> (Self, Vec<u32>) {
        let n = self.n + more.len();
        let lower = |a: u32, b: u32| (a.max(b), a.min(b));
        let mut entries = Vec::with_capacity(self.entries());
        for column in 0..self.n as u32 {
            entries.extend(self.column(column as usize).iter().map(|&row| {
                let taken_out = apart(row, column);
                if taken_out { (FIXED, FIXED) } else { lower(number[row as usize], number[column as usize]) }
            }));
        }
        for (new, coupled) in more {
            entries.push((*new, *new));
            entries.extend(coupled.iter().map(|&k| lower(*new, number[k as usize])));
        }
        // by columns, and by rows in each
        let (_, by_row) = group(n, (0..).zip(&entries).map(|(entry, &(row, _))| (row, entry)));
        let (columns, order) = group(n, by_row.iter().map(|&entry| (entries[entry as usize].1, entry)));
        let mut slots = vec![FIXED; entries.len()];
        (0..).zip(&order).for_each(|(slot, &entry)| slots[entry as usize] = slot);
        slots.truncate(self.entries());
        (Self { n, columns, rows: order.iter().map(|&entry| entries[entry as usize].0).collect() }, slots)
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.n
    }

    /// Stored entries.
    pub fn entries(&self) -> usize {
        self.rows.len()
    }

    /// Rows of the entries of a column, ascending, the diagonal first.
    pub fn column(&self, k: usize) -> &[u32] {
        &self.rows[self.columns[k] as usize..self.columns[k + 1] as usize]
    }

    /// The slot of the first entry of a column, its diagonal one.
    pub(crate) fn first_slot(&self, k: usize) -> u32 {
        self.columns[k]
    }

    /// Adds `amount` to every diagonal entry.
    pub fn add_to_diagonal(&self, values: &mut [f64], amount: f64) {
        self.diagonal().for_each(|slot| values[slot] += amount);
    }

    /// Adds a number to one diagonal entry.
    pub fn add_to_one(&self, values: &mut [f64], k: usize, amount: f64) {
        values[self.columns[k] as usize] += amount;
    }

    /// Multiplies every entry by the factors of its row and of its column: `A` becomes `D A D`, `D` the diagonal matrix
    /// of these factors.
    pub fn scale(&self, values: &mut [f64], factors: &[f64]) {
        let mut value = values.iter_mut();
        for (column, by_column) in factors.iter().enumerate() {
            for (&row, value) in self.column(column).iter().zip(&mut value) {
                *value *= factors[row as usize] * by_column;
            }
        }
    }

    /// Largest magnitude on the diagonal.
    pub fn largest_diagonal(&self, values: &[f64]) -> f64 {
        self.diagonal().map(|slot| values[slot].abs()).fold(0.0, f64::max)
    }

    /// Slots of the diagonal: the first of every column.
    fn diagonal(&self) -> impl Iterator<Item = usize> + '_ {
        self.columns[..self.n].iter().map(|&slot| slot as usize)
    }

    /// The whole symmetric matrix with these values.
    pub fn to_dense(&self, values: &[f64]) -> DenseMatrix {
        let mut matrix = DenseMatrix::zeros(self.n, self.n);
        let mut value = values.iter();
        for column in 0..self.n {
            for (&row, &value) in self.column(column).iter().zip(&mut value) {
                matrix[(row as usize, column)] = value;
                matrix[(column, row as usize)] = value;
            }
        }
        matrix
    }

    pub(crate) fn symbolic(&self) -> SymbolicSparseColMatRef<'_, u32> {
        SymbolicSparseColMatRef::new_checked(self.n, self.n, &self.columns, None, &self.rows)
    }
}

/// `y = A x` for the symmetric matrix with this lower triangle.
pub fn symmetric_product(pattern: &SparsityPattern, values: &[f64], x: &[f64], y: &mut [f64]) {
    y.fill(0.0);
    for column in 0..pattern.n {
        let start = pattern.columns[column] as usize;
        let rows = pattern.column(column);
        let values = &values[start..start + rows.len()];
        // two sums, so that an addition need not wait for the last one
        let mut sums = [values[0] * x[column], 0.0];
        let mut entry = |row: u32, value: f64, sum: &mut f64| {
            y[row as usize] += value * x[column];
            *sum += value * x[row as usize];
        };
        let (row_pairs, value_pairs) = (rows[1..].chunks_exact(2), values[1..].chunks_exact(2));
        if let ([row], [value]) = (row_pairs.remainder(), value_pairs.remainder()) {
            entry(*row, *value, &mut sums[0]);
        }
        for (rows, values) in row_pairs.zip(value_pairs) {
            entry(rows[0], values[0], &mut sums[0]);
            entry(rows[1], values[1], &mut sums[1]);
        }
        y[column] += sums[0] + sums[1];
    }
}
