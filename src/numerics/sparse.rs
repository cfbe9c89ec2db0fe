//! Symmetric sparse matrices and sparse rows, both made of cliques.
//!
//! A finite element couples all its unknowns with each other: they form a clique. A symmetric matrix is the sum of
//! small dense blocks, one a clique; its pattern and the place of every block entry (its slot) are found once, after
//! that blocks are added in place. [`Rows`] keeps one row a clique: the Jacobian of scalar measures.

use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};

/// Marks a member that is held fixed: its rows and columns do not exist.
pub const FIXED: u32 = u32::MAX;
const TWICE: u32 = 1 << 31;

/// Lists of unknowns that are coupled with each other, one list an element.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cliques {
    starts: Vec<usize>,
    members: Vec<u32>,
}

impl Cliques {
    /// No cliques yet.
    pub fn new() -> Self {
        Self { starts: vec![0], members: Vec::new() }
    }

    /// Appends a clique. Members are numbers of unknowns, or [`FIXED`]; an unknown may occur several times.
    pub fn push(&mut self, members: impl IntoIterator<Item = u32>) {
        self.members.extend(members);
        self.starts.push(self.members.len());
    }

    /// Number of cliques.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Members of clique `k`.
    pub fn members(&self, k: usize) -> &[u32] {
        &self.members[self.range(k)]
    }

    /// Where the members of clique `k` stand in an array that has one number for each member of each clique.
    pub fn range(&self, k: usize) -> std::ops::Range<usize> {
        self.starts[k]..self.starts[k + 1]
    }

    /// Number of members of all cliques together.
    pub fn total(&self) -> usize {
        self.members.len()
    }

    /// Iterates over the cliques.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        (0..self.len()).map(|k| self.members(k))
    }
}

/// The lower triangle of a symmetric matrix by columns, with the diagonal first in each column.
#[derive(Clone, Debug)]
pub struct Pattern {
    n: usize,
    columns: Vec<u32>,
    rows: Vec<u32>,
}

impl Pattern {
    /// Pattern of the sum of all cliques' blocks; every diagonal entry is there.
    pub fn new(n: usize, cliques: &[&Cliques]) -> Self {
        let mut counts = vec![1usize; n];
        for_pairs(cliques, |_, column| counts[column as usize] += 1);
        let mut fill: Vec<usize> = Vec::with_capacity(n + 1);
        fill.push(0);
        for count in &counts {
            fill.push(fill[fill.len() - 1] + count);
        }
        let starts = fill.clone();
        let mut entries = vec![0u32; starts[n]];
        let mut put = |row: u32, column: u32| {
            entries[fill[column as usize]] = row;
            fill[column as usize] += 1;
        };
        (0..n as u32).for_each(|k| put(k, k));
        for_pairs(cliques, &mut put);
        let (mut columns, mut rows) = (vec![0u32], Vec::new());
        for column in 0..n {
            let list = &mut entries[starts[column]..starts[column + 1]];
            list.sort_unstable();
            let mut last = None;
            for &row in list.iter() {
                if last != Some(row) {
                    rows.push(row);
                    last = Some(row);
                }
            }
            columns.push(rows.len() as u32);
        }
        Self { n, columns, rows }
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

    /// Adds `amount` to every diagonal entry.
    pub fn add_to_diagonal(&self, values: &mut [f64], amount: f64) {
        self.diagonal().for_each(|slot| values[slot] += amount);
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
    pub fn to_dense(&self, values: &[f64]) -> super::DenseMatrix {
        let mut matrix = super::DenseMatrix::zeros(self.n, self.n);
        let mut value = values.iter();
        for column in 0..self.n {
            for (&row, &value) in self.column(column).iter().zip(&mut value) {
                matrix[(row as usize, column)] = value;
                matrix[(column, row as usize)] = value;
            }
        }
        matrix
    }

    /// Slots of the lower triangles of all cliques' blocks, row by row.
    fn slots(&self, cliques: &Cliques) -> Vec<u32> {
        let total = cliques.iter().map(|c| c.len() * (c.len() + 1) / 2).sum();
        let mut slots = Vec::with_capacity(total);
        for members in cliques.iter() {
            for (p, &row) in members.iter().enumerate() {
                for (q, &column) in members[..=p].iter().enumerate() {
                    slots.push(self.slot(row, column, p != q));
                }
            }
        }
        slots
    }

    fn slot(&self, row: u32, column: u32, off_diagonal: bool) -> u32 {
        if row == FIXED || column == FIXED {
            return FIXED;
        }
        let (row, column) = (row.max(column), row.min(column));
        let start = self.columns[column as usize];
        let found = self.column(column as usize).binary_search(&row);
        let slot = start + found.expect("the pattern holds every pair of every clique") as u32;
        if off_diagonal && row == column { slot | TWICE } else { slot }
    }

    pub(super) fn symbolic(&self) -> SymbolicSparseColMatRef<'_, u32> {
        SymbolicSparseColMatRef::new_checked(self.n, self.n, &self.columns, None, &self.rows)
    }

    pub(super) fn with_values<'a>(&'a self, values: &'a [f64]) -> SparseColMatRef<'a, u32, f64> {
        SparseColMatRef::new(self.symbolic(), values)
    }
}

/// Calls `visit(row, column)` with `row > column` for every pair of different unknowns of every clique.
fn for_pairs(cliques: &[&Cliques], mut visit: impl FnMut(u32, u32)) {
    for members in cliques.iter().flat_map(|list| list.iter()) {
        for (p, &a) in members.iter().enumerate() {
            for &b in &members[..p] {
                if a != b && a != FIXED && b != FIXED {
                    visit(a.max(b), a.min(b));
                }
            }
        }
    }
}

/// Where the entries of every clique's block stand in the values of a matrix.
#[derive(Clone, Debug)]
pub struct Slots {
    starts: Vec<usize>,
    slots: Vec<u32>,
}

impl Slots {
    /// Slots of `cliques` in `pattern`, which must hold all their pairs.
    pub fn new(pattern: &Pattern, cliques: &Cliques) -> Self {
        let mut starts = vec![0];
        for members in cliques.iter() {
            starts.push(starts[starts.len() - 1] + members.len() * (members.len() + 1) / 2);
        }
        Self { starts, slots: pattern.slots(cliques) }
    }

    /// Adds `scale` times the lower triangle of a block, given row by row, to the values.
    pub fn add_block(&self, clique: usize, scale: f64, block: &[f64], values: &mut [f64]) {
        let slots = &self.slots[self.starts[clique]..self.starts[clique + 1]];
        for (&slot, &entry) in slots.iter().zip(block) {
            add(values, slot, scale * entry);
        }
    }

    /// Adds `weight * g g^T + scale * block` to the values, the block as in [`add_block`](Self::add_block) or empty.
    pub fn add_curvature(
        &self,
        clique: usize,
        (weight, g): (f64, &[f64]),
        (scale, block): (f64, &[f64]),
        values: &mut [f64],
    ) {
        if block.is_empty() {
            return self.add_outer(clique, weight, g, values);
        }
        let mut entries = self.slots[self.starts[clique]..self.starts[clique + 1]].iter().zip(block);
        for p in 0..g.len() {
            let scaled = weight * g[p];
            for (factor, (&slot, entry)) in g[..=p].iter().zip(&mut entries) {
                add(values, slot, scaled * factor + scale * entry);
            }
        }
    }

    /// Adds `weight * g g^T` to the values.
    pub fn add_outer(&self, clique: usize, weight: f64, g: &[f64], values: &mut [f64]) {
        let mut slots = self.slots[self.starts[clique]..self.starts[clique + 1]].iter();
        for p in 0..g.len() {
            let scaled = weight * g[p];
            for (entry, &slot) in g[..=p].iter().zip(&mut slots) {
                add(values, slot, scaled * entry);
            }
        }
    }
}

fn add(values: &mut [f64], slot: u32, entry: f64) {
    if slot & TWICE == 0 {
        values[slot as usize] += entry;
    } else if slot != FIXED {
        values[(slot & !TWICE) as usize] += 2.0 * entry;
    }
}

/// `y = A x` for the symmetric matrix with this lower triangle.
pub fn symmetric_product(pattern: &Pattern, values: &[f64], x: &[f64], y: &mut [f64]) {
    y.fill(0.0);
    for column in 0..pattern.n {
        let start = pattern.columns[column] as usize;
        let rows = pattern.column(column);
        let values = &values[start..start + rows.len()];
        let mut sum = values[0] * x[column];
        for (&row, &value) in rows[1..].iter().zip(&values[1..]) {
            y[row as usize] += value * x[column];
            sum += value * x[row as usize];
        }
        y[column] += sum;
    }
}

/// A sparse matrix with one row a clique; an unknown that occurs twice in a clique has the sum of its entries.
#[derive(Clone, Debug)]
pub struct Rows<'a> {
    /// Which unknowns each row has.
    pub cliques: &'a Cliques,
    /// One number for each member of each clique.
    pub values: &'a [f64],
}

impl Rows<'_> {
    /// `y = R x`.
    pub fn product(&self, x: &[f64], y: &mut [f64]) {
        for (row, out) in y.iter_mut().enumerate() {
            let range = self.cliques.range(row);
            let members = self.cliques.members(row);
            *out = members
                .iter()
                .zip(&self.values[range])
                .filter(|(m, _)| **m != FIXED)
                .map(|(&m, v)| v * x[m as usize])
                .sum();
        }
    }

    /// `y += R^T t`.
    pub fn add_transpose_product(&self, t: &[f64], y: &mut [f64]) {
        for (row, &tension) in t.iter().enumerate() {
            let range = self.cliques.range(row);
            for (&member, value) in self.cliques.members(row).iter().zip(&self.values[range]) {
                if member != FIXED {
                    y[member as usize] += value * tension;
                }
            }
        }
    }
}
