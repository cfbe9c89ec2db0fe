//! The places of small dense blocks in the values of a sparse matrix.

use super::cliques::{Cliques, FIXED};
use super::incidence::Incidence;
use super::pattern::SparsityPattern;

/// Marks the slot of an entry that is counted twice.
const TWICE: u32 = 1 << 31;

/// The outer product `weight * g g^T` of a gradient `g` by the members of a clique.
#[derive(Clone, Copy, Debug)]
pub struct RankOne<'a> {
    /// Factor of the product.
    pub weight: f64,
    /// One number for each member.
    pub gradient: &'a [f64],
}

/// What an element adds to a matrix: an outer product and a multiple of a symmetric block.
#[derive(Clone, Copy, Debug)]
pub struct ElementBlock<'a> {
    /// The outer product.
    pub outer: RankOne<'a>,
    /// Factor of the block.
    pub scale: f64,
    /// Lower triangle of the block, row by row; empty for a block of zeros.
    pub block: &'a [f64],
}

/// Where the entries of every clique's block stand in the values of a matrix.
#[derive(Clone, Debug)]
pub struct Slots {
    starts: Vec<usize>,
    slots: Vec<u32>,
}

impl Slots {
    /// Finds the slots of `cliques` in `pattern`. Couplings that the pattern does not contain are left out.
    pub fn new(pattern: &SparsityPattern, cliques: &Cliques) -> Self {
        let mut starts = vec![0];
        for members in cliques.iter() {
            starts.push(starts[starts.len() - 1] + members.len() * (members.len() + 1) / 2);
        }
        let mut slots = vec![FIXED; starts[cliques.len()]];
        let incidence = Incidence::new(pattern.size(), cliques);
        let mut slot_of_row = vec![FIXED; pattern.size()];
        for column in 0..pattern.size() as u32 {
            let rows = pattern.column(column as usize);
            let first = pattern.first_slot(column as usize);
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

    /// Adds an outer product and a multiple of a block to the values.
    pub fn add_element(&self, clique: usize, element: &ElementBlock<'_>, values: &mut [f64]) {
        let ElementBlock { outer, scale, block } = *element;
        if block.is_empty() {
            return self.add_outer(clique, outer, values);
        }
        let g = outer.gradient;
        let mut entries = self.slots[self.starts[clique]..self.starts[clique + 1]].iter().zip(block);
        for p in 0..g.len() {
            let scaled = outer.weight * g[p];
            for (factor, (&slot, entry)) in g[..=p].iter().zip(&mut entries) {
                add(values, slot, scaled * factor + scale * entry);
            }
        }
    }

    /// Adds an outer product to the values.
    pub fn add_outer(&self, clique: usize, outer: RankOne<'_>, values: &mut [f64]) {
        let g = outer.gradient;
        let mut slots = self.slots[self.starts[clique]..self.starts[clique + 1]].iter();
        for p in 0..g.len() {
            let scaled = outer.weight * g[p];
            for (entry, &slot) in g[..=p].iter().zip(&mut slots) {
                add(values, slot, scaled * entry);
            }
        }
    }
}

/// Puts the slots of a clique's block in place that stand in the column of the matrix to which the member at `place`
/// belongs.
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
