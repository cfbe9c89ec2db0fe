//! Symmetric sparse matrices and sparse rows, both made of cliques.
//!
//! A finite element couples all its unknowns with each other: they form a clique. A symmetric matrix is the sum of
//! small dense blocks, one a clique; its pattern and the place of every block entry (its slot) are found once, after
//! that blocks are added in place. [`Rows`] keeps one row a clique: the Jacobian of scalar measures.

use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use std::ops::Range;

/// Marks a member that is held fixed: its rows and columns do not exist.
pub const FIXED: u32 = u32::MAX;
const TWICE: u32 = 1 << 31;
/// Places of the coordinates of a hinge's wings among the members of its clique.
pub const LEFT: Range<usize> = 6..9;
/// See [`LEFT`].
pub const RIGHT: Range<usize> = 9..12;

/// Lists of unknowns that are coupled with each other, one list an element.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cliques {
    starts: Vec<usize>,
    members: Vec<u32>,
    hinges: Vec<bool>,
}

impl Cliques {
    /// No cliques yet.
    pub fn new() -> Self {
        Self { starts: vec![0], members: Vec::new(), hinges: Vec::new() }
    }

    /// Appends a clique. Members are numbers of unknowns, or [`FIXED`]; an unknown may occur several times.
    pub fn push(&mut self, members: impl IntoIterator<Item = u32>) {
        self.members.extend(members);
        self.starts.push(self.members.len());
        self.hinges.push(false);
    }

    /// Appends the clique of a hinge: the coordinates of its ends, of its left wing ([`LEFT`]) and of its right wing ([`RIGHT`]),
    /// then any others. Of its block only the outer product of the gradient may couple one wing with the other.
    pub fn push_hinge(&mut self, members: impl IntoIterator<Item = u32>) {
        self.push(members);
        if let Some(last) = self.hinges.last_mut() {
            *last = true;
        }
    }

    /// Whether clique `k` was appended as that of a hinge.
    pub fn is_hinge(&self, k: usize) -> bool {
        self.hinges[k]
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
    pub fn range(&self, k: usize) -> Range<usize> {
        self.starts[k]..self.starts[k + 1]
    }

    /// Number of members of all cliques together.
    pub fn total(&self) -> usize {
        self.members.len()
    }

    /// Iterates over the cliques.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> + Clone {
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

    /// This pattern with unknown `k` numbered `number[k]`, without the pairs of unknowns that are `apart`, and with `more` unknowns:
    /// the number of each and the unknowns, as they are numbered here, with which it is coupled. Also the slot that each entry of
    /// this pattern has there, or [`FIXED`].
    pub(super) fn renumbered(
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

    /// The upper triangle by columns: starts of the columns, and rows.
    pub(super) fn upper(&self) -> (Vec<u32>, Vec<u32>) {
        let columns = (0..self.n).flat_map(|column| self.column(column).iter().map(move |&row| (row, column as u32)));
        group(self.n, columns)
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

    /// Adds a number to one diagonal entry.
    pub fn add_to_one(&self, values: &mut [f64], k: usize, amount: f64) {
        values[self.columns[k] as usize] += amount;
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

    pub(super) fn symbolic(&self) -> SymbolicSparseColMatRef<'_, u32> {
        SymbolicSparseColMatRef::new_checked(self.n, self.n, &self.columns, None, &self.rows)
    }

    pub(super) fn with_values<'a>(&'a self, values: &'a [f64]) -> SparseColMatRef<'a, u32, f64> {
        SparseColMatRef::new(self.symbolic(), values)
    }
}

/// The items with each key from 0 to `n - 1`, one key after the other, in the order in which they come; and where those of each key
/// begin. Items with the key [`FIXED`] are left out.
fn group<T: Copy + Default>(n: usize, items: impl Iterator<Item = (u32, T)> + Clone) -> (Vec<u32>, Vec<T>) {
    let items = items.filter(|(key, _)| *key != FIXED);
    let mut starts = vec![0u32; n + 1];
    items.clone().for_each(|(key, _)| starts[key as usize + 1] += 1);
    (0..n).for_each(|key| starts[key + 1] += starts[key]);
    let (mut next, mut grouped) = (starts.clone(), vec![T::default(); starts[n] as usize]);
    for (key, item) in items {
        grouped[next[key as usize] as usize] = item;
        next[key as usize] += 1;
    }
    (starts, grouped)
}

/// Where every unknown stands: cliques in ascending order, and its place in each.
struct Incidence {
    starts: Vec<u32>,
    places: Vec<(u32, u32)>,
}

impl Incidence {
    fn new(n: usize, cliques: &Cliques) -> Self {
        let members = (0..).zip(cliques.iter());
        let places = members.flat_map(|(clique, list)| (0..).zip(list).map(move |(place, &m)| (m, (clique, place))));
        let (starts, places) = group(n, places);
        Self { starts, places }
    }

    fn of(&self, unknown: u32) -> &[(u32, u32)] {
        &self.places[self.starts[unknown as usize] as usize..self.starts[unknown as usize + 1] as usize]
    }
}

/// Where the entries of every clique's block stand in the values of a matrix.
#[derive(Clone, Debug)]
pub struct Slots {
    starts: Vec<usize>,
    slots: Vec<u32>,
}

impl Slots {
    /// Slots of `cliques` in `pattern`. What they couple that the pattern does not hold is left out.
    pub fn new(pattern: &Pattern, cliques: &Cliques) -> Self {
        let mut starts = vec![0];
        for members in cliques.iter() {
            starts.push(starts[starts.len() - 1] + members.len() * (members.len() + 1) / 2);
        }
        let mut slots = vec![FIXED; starts[cliques.len()]];
        let incidence = Incidence::new(pattern.n, cliques);
        let mut slot_of_row = vec![FIXED; pattern.n];
        for column in 0..pattern.n as u32 {
            let rows = pattern.column(column as usize);
            let first = pattern.columns[column as usize];
            rows.iter().zip(first..).for_each(|(&row, slot)| slot_of_row[row as usize] = slot);
            for &(clique, place) in incidence.of(column) {
                let clique = clique as usize;
                let block = &mut slots[starts[clique]..starts[clique + 1]];
                fill_column(block, cliques.members(clique), place as usize, &slot_of_row);
            }
            rows.iter().for_each(|&row| slot_of_row[row as usize] = FIXED);
        }
        Self { starts, slots }
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

/// Puts the slots of a clique's block in place that stand in the column of the matrix to which the member at `place` belongs.
fn fill_column(block: &mut [u32], members: &[u32], place: usize, slot_of_row: &[u32]) {
    for (other, &row) in members.iter().enumerate().filter(|(_, row)| **row != FIXED && **row >= members[place]) {
        let (high, low) = (place.max(other), place.min(other));
        let twice = if place != other && row == members[place] { TWICE } else { 0 };
        block[high * (high + 1) / 2 + low] = slot_of_row[row as usize] | twice;
    }
}

fn add(values: &mut [f64], slot: u32, entry: f64) {
    // one question for all slots but the few that are counted twice or missing, which are beyond the last
    if let Some(value) = values.get_mut(slot as usize) {
        *value += entry;
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

/// A sparse matrix with one row a clique; an unknown that occurs twice in a clique has the sum of its entries.
#[derive(Clone, Debug)]
pub struct Rows<'a> {
    /// Which unknowns each row has.
    pub cliques: &'a Cliques,
    /// One number for each member of each clique.
    pub values: &'a [f64],
}

impl Rows<'_> {
    /// The entries of each row: unknowns and numbers.
    fn entries(&self) -> impl Iterator<Item = impl Iterator<Item = (u32, f64)>> {
        let ranges = self.cliques.starts.windows(2).map(|ends| ends[0]..ends[1]);
        ranges.map(|range| self.cliques.members[range.clone()].iter().copied().zip(self.values[range].iter().copied()))
    }

    /// `y = R x`.
    pub fn product(&self, x: &[f64], y: &mut [f64]) {
        for (row, out) in self.entries().zip(y) {
            *out = row.map(|(member, value)| if member == FIXED { 0.0 } else { value * x[member as usize] }).sum();
        }
    }

    /// `y += R^T t`.
    pub fn add_transpose_product(&self, t: &[f64], y: &mut [f64]) {
        for (row, tension) in self.entries().zip(t) {
            for (member, value) in row {
                if member != FIXED {
                    y[member as usize] += value * tension;
                }
            }
        }
    }
}
