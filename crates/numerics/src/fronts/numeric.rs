//! The factorization: fronts are assembled and eliminated from the leaves to the roots.

use super::dense::{self, DenseFront, Kernels, ZeroPivot};
use super::symbolic::{AssemblyTree, Room, RowRun, TreeBranch};
use faer::MatMut;
use std::ops::Range;

/// Numbers of a front to which the children's update matrices are added at once.
const NUMBERS_AT_ONCE: usize = 1 << 15;

/// The data of one factorization.
pub(super) struct Factorization<'a> {
    /// The assembly tree.
    pub tree: &'a AssemblyTree,
    /// Entries of the lower triangle of the matrix, in the order of its pattern.
    pub input: &'a [f64],
    /// Whether there is more than one thread.
    pub shared: bool,
}

/// The memory that a part of the tree writes to: its panels, and its room on the two stacks of update matrices.
pub(super) struct Space<'a> {
    pub panels: &'a mut [f64],
    pub even: &'a mut [f64],
    pub odd: &'a mut [f64],
}

/// Consecutive columns of a front, without the rows above, as contiguous numbers.
struct Columns<'a> {
    range: Range<usize>,
    /// Number of rows of the front that are left out: none, or those of the pivots.
    above: usize,
    numbers: &'a mut [f64],
}

/// The memory of one front.
struct FrontMemory<'a> {
    panel: &'a mut [f64],
    /// The children's update matrices, from the start on.
    children: &'a [f64],
    /// Receives its own update matrix at the start.
    own: &'a mut [f64],
    /// Room for copies of pivots' columns.
    room: &'a mut [f64],
}

impl<'a> Space<'a> {
    /// Returns the spaces of two parts, of which the first has these counts of numbers.
    fn split(self, panels: usize, even: usize, odd: usize) -> (Space<'a>, Space<'a>) {
        let (panels, even, odd) =
            (self.panels.split_at_mut(panels), self.even.split_at_mut(even), self.odd.split_at_mut(odd));
        (Space { panels: panels.0, even: even.0, odd: odd.0 }, Space { panels: panels.1, even: even.1, odd: odd.1 })
    }
}

impl Factorization<'_> {
    /// Eliminates all fronts of these branches.
    pub fn branches(&self, branches: &[TreeBranch], space: Space<'_>) -> Result<(), ZeroPivot> {
        match branches {
            [] => Ok(()),
            [branch] if branch.divided => self.divided(branch.fronts.end - 1, space),
            [branch] => self.task(branch, space),
            _ => {
                let (first, second) = branches.split_at(branches.len() / 2);
                let panels = self.start(second) - self.start(first);
                let Room { even, odd } = Room::sum(first);
                if self.shared {
                    let (a, b) = space.split(panels, even, odd);
                    let (a, b) = rayon::join(|| self.branches(first, a), || self.branches(second, b));
                    return a.and(b);
                }
                // one after the other they share what nothing is left in
                let Space { panels: all, even: roots, odd: others } = space;
                let ((a, b), (c, d)) = (all.split_at_mut(panels), roots.split_at_mut(even));
                self.branches(first, Space { panels: a, even: c, odd: &mut *others })?;
                self.branches(second, Space { panels: b, even: d, odd: others })
            }
        }
    }

    /// Returns the place at which the panels of these branches start.
    fn start(&self, branches: &[TreeBranch]) -> usize {
        self.tree.fronts[branches[0].fronts.start].panel.start
    }

    /// Eliminates a subtree whose branches are tasks of their own.
    fn divided(&self, k: usize, space: Space<'_>) -> Result<(), ZeroPivot> {
        let front = &self.tree.fronts[k];
        let Space { panels, even, odd } = space;
        let (below, panel) = panels.split_at_mut(panels.len() - front.panel.len());
        if !front.branches.is_empty() {
            self.branches(&front.branches, Space { panels: below, even: &mut *odd, odd: &mut *even })?;
        }
        let (own, room) = even.split_at_mut(front.below().pow(2));
        self.front(k, FrontMemory { panel, children: odd, own, room }, &mut Kernels::new(), self.shared)
    }

    /// Eliminates consecutive subtrees, one front after the other.
    fn task(&self, branch: &TreeBranch, space: Space<'_>) -> Result<(), ZeroPivot> {
        let fronts = &self.tree.fronts;
        let level = fronts[branch.fronts.end - 1].depth;
        let (start, mut kernels, mut used) = (fronts[branch.fronts.start].panel.start, Kernels::new(), [0; 2]);
        let Space { panels, even, odd } = space;
        let (even, room) = even.split_at_mut(branch.room.even - branch.copy);
        for k in branch.fronts.clone() {
            let front = &fronts[k];
            let children: usize = self.tree.children(k).map(|child| child.below().pow(2)).sum();
            let panel = &mut panels[front.panel.start - start..front.panel.end - start];
            let mine = (front.depth - level) % 2;
            let (own, others) = if mine == 0 { (&mut *even, &mut *odd) } else { (&mut *odd, &mut *even) };
            used[1 - mine] -= children;
            let (own, children) = (&mut own[used[mine]..], &others[used[1 - mine]..]);
            self.front(k, FrontMemory { panel, children, own, room: &mut *room }, &mut kernels, false)?;
            used[mine] += front.below().pow(2);
        }
        Ok(())
    }

    /// Assembles and eliminates a front.
    ///
    /// The children's update matrices are added to the panel before and to the update matrix after the elimination,
    /// which does not read that: so it need not be set to zero.
    fn front(&self, k: usize, memory: FrontMemory<'_>, kernels: &mut Kernels, shared: bool) -> Result<(), ZeroPivot> {
        let front = &self.tree.fronts[k];
        let FrontMemory { panel, children, own, room } = memory;
        let (width, below, height) = (front.width(), front.below(), front.height());
        self.add_children(k, children, Columns { range: 0..width, above: 0, numbers: panel }, shared);
        for &[slot, place] in &self.tree.entries[front.entries.clone()] {
            panel[place as usize] += self.input[slot as usize];
        }
        let update = &mut own[..below * below];
        let dense = DenseFront {
            panel: MatMut::from_column_major_slice_mut(panel, height, width),
            room,
            update: MatMut::from_column_major_slice_mut(update, below, below),
        };
        dense.eliminate(kernels, shared)?;
        self.add_children(k, children, Columns { range: width..height, above: width, numbers: update }, shared);
        Ok(())
    }

    /// Adds the children's update matrices to some columns of a front; those of its pivots are set to zero before.
    fn add_children(&self, k: usize, children: &[f64], columns: Columns<'_>, shared: bool) {
        let Columns { range, above, numbers } = columns;
        let height = self.tree.fronts[k].height() - above;
        if numbers.len() > NUMBERS_AT_ONCE && range.len() > 1 {
            let half = range.len() / 2;
            let (first, second) = numbers.split_at_mut(half * height);
            let first = Columns { range: range.start..range.start + half, above, numbers: first };
            let second = Columns { range: range.start + half..range.end, above, numbers: second };
            dense::join(
                shared,
                || self.add_children(k, children, first, shared),
                || self.add_children(k, children, second, shared),
            );
            return;
        }
        if above == 0 {
            numbers.fill(0.0);
        }
        for child in self.tree.children(k) {
            let (size, matrix) = (child.below(), child.matrix(children));
            let runs = &self.tree.runs[child.runs.clone()];
            for (n, run) in runs.iter().enumerate() {
                let [start, end] = [range.start, range.end].map(|end| (end as u32).saturating_sub(run.place));
                for k in start..end.min(run.count) {
                    let (column, place) = ((run.start + k) as usize, (run.place + k) as usize - range.start);
                    let target = &mut numbers[place * height..(place + 1) * height];
                    add_column(&runs[n..], k, &matrix[column * size..(column + 1) * size], above as u32, target);
                }
            }
        }
    }
}

/// Adds a column to another one, from the row `k` of the first run on; places in the target are `shift` less.
fn add_column(runs: &[RowRun], k: u32, column: &[f64], shift: u32, target: &mut [f64]) {
    let mut skipped = k;
    for run in runs {
        let (start, place) = ((run.start + skipped) as usize, (run.place + skipped - shift) as usize);
        let count = (run.count - skipped) as usize;
        let entries = column[start..start + count].iter();
        target[place..place + count].iter_mut().zip(entries).for_each(|(sum, entry)| *sum += entry);
        skipped = 0;
    }
}
