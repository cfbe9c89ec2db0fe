//! Substitution with a factor: forward from the leaves to the roots, and back.
//!
//! With the rows of a front in two parts, its pivots and those below, forward substitution solves `L_1 y_1 = b_1` and
//! leaves `b_2 - L_2 y_1` to its parent; back substitution solves `L_1^T x_1 = D^-1 y_1 - L_2^T x_2` with the `x_2`
//! that the parent knows.

use super::dense::join;
use super::symbolic::{AssemblyTree, Front, TreeBranch};
use crate::vector::dot;

/// The data of one substitution.
pub(super) struct Substitution<'a> {
    /// The assembly tree.
    pub tree: &'a AssemblyTree,
    /// The factor.
    pub panels: &'a [f64],
    /// Whether there is more than one thread.
    pub shared: bool,
}

/// The numbers of consecutive fronts: of the unknowns that are their pivots, and of the rows below them, which are what
/// the parent receives in forward substitution and the unknowns of those rows in back substitution.
pub(super) struct FrontNumbers<'a> {
    /// Numbers of the pivots.
    pub unknowns: &'a mut [f64],
    /// Numbers of the rows below.
    pub rows: &'a mut [f64],
}

/// A part that is not written to.
#[derive(Clone, Copy)]
struct KnownFrontNumbers<'a> {
    /// Numbers of the pivots.
    unknowns: &'a [f64],
    /// Numbers of the rows below.
    rows: &'a [f64],
}

impl<'a> FrontNumbers<'a> {
    /// Splits it in two, of which the first has these counts of numbers.
    fn split(self, unknowns: usize, rows: usize) -> (FrontNumbers<'a>, FrontNumbers<'a>) {
        let (unknowns, rows) = (self.unknowns.split_at_mut(unknowns), self.rows.split_at_mut(rows));
        (FrontNumbers { unknowns: unknowns.0, rows: rows.0 }, FrontNumbers { unknowns: unknowns.1, rows: rows.1 })
    }

    /// Returns what is before the last front, and the part of that front.
    fn split_last(self, front: &Front) -> (FrontNumbers<'a>, FrontNumbers<'a>) {
        let (unknowns, rows) = (self.unknowns.len() - front.width(), self.rows.len() - front.below());
        self.split(unknowns, rows)
    }
}

impl Substitution<'_> {
    /// Returns a front by its number.
    fn front(&self, k: usize) -> &Front {
        &self.tree.fronts[k]
    }

    /// Splits a part between these two groups of branches.
    fn split<'p>(
        &self,
        part: FrontNumbers<'p>,
        first: &[TreeBranch],
        second: &[TreeBranch],
    ) -> (FrontNumbers<'p>, FrontNumbers<'p>) {
        let [a, b] = [first, second].map(|branches| self.front(branches[0].fronts.start));
        part.split(b.pivots.start - a.pivots.start, b.rows.start - a.rows.start)
    }

    /// Substitutes forward in these branches.
    pub fn forward(&self, branches: &[TreeBranch], part: FrontNumbers<'_>) {
        match branches {
            [] => {}
            [branch] if branch.divided => {
                let k = branch.fronts.end - 1;
                let (below, last) = part.split_last(self.front(k));
                let FrontNumbers { unknowns, rows } = below;
                self.forward(&self.front(k).branches, FrontNumbers { unknowns, rows: &mut *rows });
                let start = self.front(self.front(k).first).rows.start;
                self.forward_front(k, last, rows, start, &mut vec![]);
            }
            [branch] => {
                let first = self.front(branch.fronts.start);
                let (mut work, mut part) = (vec![], part);
                for k in branch.fronts.clone() {
                    let front = self.front(k);
                    let FrontNumbers { unknowns, rows } = &mut part;
                    let (before, rest) = rows.split_at_mut(front.rows.start - first.rows.start);
                    let unknowns = &mut unknowns[front.pivots.start - first.pivots.start..][..front.width()];
                    let own = FrontNumbers { unknowns, rows: &mut rest[..front.below()] };
                    self.forward_front(k, own, before, first.rows.start, &mut work);
                }
            }
            _ => {
                let (first, second) = branches.split_at(branches.len() / 2);
                let (a, b) = self.split(part, first, second);
                join(self.shared, || self.forward(first, a), || self.forward(second, b));
            }
        }
    }

    /// Substitutes forward in one front; `before` are the rows of the fronts before it, of which the first has this
    /// number.
    fn forward_front(&self, k: usize, own: FrontNumbers<'_>, before: &[f64], first: usize, work: &mut Vec<f64>) {
        let front = self.front(k);
        work.clear();
        work.extend_from_slice(own.unknowns);
        work.resize(front.height(), 0.0);
        for child in self.tree.children(k) {
            let rows = &before[child.rows.start - first..child.rows.end - first];
            for run in &self.tree.runs[child.runs.clone()] {
                let (start, place, count) = (run.start as usize, run.place as usize, run.count as usize);
                let target = work[place..place + count].iter_mut();
                target.zip(&rows[start..start + count]).for_each(|(sum, entry)| *sum += entry);
            }
        }
        solve_lower(&self.panels[front.panel.clone()], front.width(), work);
        own.unknowns.copy_from_slice(&work[..front.width()]);
        own.rows.copy_from_slice(&work[front.width()..]);
    }

    /// Substitutes back in these branches of the whole forest.
    pub fn back(&self, branches: &[TreeBranch], part: FrontNumbers<'_>) {
        self.back_below(branches, part, KnownFrontNumbers { unknowns: &[], rows: &[] });
    }

    /// Substitutes back in these branches below a front.
    fn back_below(&self, branches: &[TreeBranch], part: FrontNumbers<'_>, parent: KnownFrontNumbers<'_>) {
        match branches {
            [] => {}
            [branch] if branch.divided => {
                let k = branch.fronts.end - 1;
                let (below, last) = part.split_last(self.front(k));
                let FrontNumbers { unknowns, rows } = last;
                self.back_front(k, FrontNumbers { unknowns: &mut *unknowns, rows: &mut *rows }, parent, &mut vec![]);
                self.back_below(&self.front(k).branches, below, KnownFrontNumbers { unknowns, rows });
            }
            [branch] => self.back_task(branch, part, parent),
            _ => {
                let (first, second) = branches.split_at(branches.len() / 2);
                let (a, b) = self.split(part, first, second);
                join(self.shared, || self.back_below(first, a, parent), || self.back_below(second, b, parent));
            }
        }
    }

    /// Substitutes back in consecutive subtrees below one front.
    fn back_task(&self, branch: &TreeBranch, part: FrontNumbers<'_>, parent: KnownFrontNumbers<'_>) {
        let (first, mut work) = (self.front(branch.fronts.start), vec![]);
        let FrontNumbers { unknowns, rows } = part;
        for k in branch.fronts.clone().rev() {
            let front = self.front(k);
            let (pivot, row) = (front.pivots.start - first.pivots.start, front.rows.start - first.rows.start);
            let (own, later) = unknowns[pivot..].split_at_mut(front.width());
            let (own_rows, later_rows) = rows[row..].split_at_mut(front.below());
            let parent = if front.parent < branch.fronts.end {
                let other = self.front(front.parent);
                KnownFrontNumbers {
                    unknowns: &later[other.pivots.start - front.pivots.end..][..other.width()],
                    rows: &later_rows[other.rows.start - front.rows.end..][..other.below()],
                }
            } else {
                parent
            };
            self.back_front(k, FrontNumbers { unknowns: own, rows: own_rows }, parent, &mut work);
        }
    }

    /// Substitutes back in one front, with what its parent knows.
    fn back_front(&self, k: usize, own: FrontNumbers<'_>, parent: KnownFrontNumbers<'_>, work: &mut Vec<f64>) {
        let front = self.front(k);
        work.clear();
        work.resize(front.height(), 0.0);
        let width = parent.unknowns.len();
        for run in &self.tree.runs[front.runs.clone()] {
            let (start, place, count) = (run.start as usize, run.place as usize, run.count as usize);
            let known = if place < width { &parent.unknowns[place..] } else { &parent.rows[place - width..] };
            own.rows[start..start + count].copy_from_slice(&known[..count]);
        }
        work[..front.width()].copy_from_slice(own.unknowns);
        work[front.width()..].copy_from_slice(own.rows);
        solve_upper(&self.panels[front.panel.clone()], front.width(), work);
        own.unknowns.copy_from_slice(&work[..front.width()]);
    }
}

/// Columns that are worked on together.
const COLUMNS: usize = 4;

/// `y_1 := L_1^-1 b_1`, `y_2 := b_2 - L_2 y_1` for a panel `(L_1, L_2)` of this width.
fn solve_lower(panel: &[f64], width: usize, y: &mut [f64]) {
    let height = y.len();
    let whole = width - width % COLUMNS;
    for start in (0..whole).step_by(COLUMNS) {
        let columns: [&[f64]; COLUMNS] =
            std::array::from_fn(|k| &panel[(start + k) * height + start..][..height - start]);
        let (head, tail) = y[start..].split_at_mut(COLUMNS);
        for k in 0..COLUMNS {
            for row in k + 1..COLUMNS {
                head[row] -= columns[k][row] * head[k];
            }
        }
        let [a, b, c, d] = columns.map(|column| &column[COLUMNS..]);
        let [p, q, r, s] = [head[0], head[1], head[2], head[3]];
        for ((((y, a), b), c), d) in tail.iter_mut().zip(a).zip(b).zip(c).zip(d) {
            *y -= (a * p + b * q) + (c * r + d * s);
        }
    }
    for k in whole..width {
        let column = &panel[k * height + k..(k + 1) * height];
        let (head, tail) = y[k..].split_at_mut(1);
        tail.iter_mut().zip(&column[1..]).for_each(|(y, a)| *y -= a * head[0]);
    }
}

/// `x_1 := L_1^-T (D^-1 y_1 - L_2^T x_2)` for `y = (y_1, x_2)`.
fn solve_upper(panel: &[f64], width: usize, y: &mut [f64]) {
    let height = y.len();
    let (head, below) = y.split_at_mut(width);
    let whole = width - width % COLUMNS;
    let column = |k: usize| &panel[k * height..(k + 1) * height];
    // what is below first, from the first column to the last: as it stands in memory
    for start in (0..whole).step_by(COLUMNS) {
        let sums = products(std::array::from_fn(|k| &column(start + k)[width..]), below);
        (start..).zip(sums).for_each(|(k, sum)| head[k] = head[k] / column(k)[k] - sum);
    }
    for (k, entry) in head.iter_mut().enumerate().skip(whole) {
        *entry = *entry / column(k)[k] - dot(&column(k)[width..], below);
    }
    for k in (whole..width).rev() {
        head[k] -= dot(&column(k)[k + 1..width], &head[k + 1..]);
    }
    for start in (0..whole).step_by(COLUMNS).rev() {
        let end = start + COLUMNS;
        let sums = products(std::array::from_fn(|k| &column(start + k)[end..width]), &head[end..]);
        for k in (start..end).rev() {
            head[k] -= sums[k - start] + dot(&column(k)[k + 1..end], &head[k + 1..end]);
        }
    }
}

/// Returns the products of columns with a vector, in four interleaved sums each.
fn products(columns: [&[f64]; COLUMNS], y: &[f64]) -> [f64; COLUMNS] {
    let mut sums = [[0.0; 4]; COLUMNS];
    let (chunks, rest) = y.as_chunks::<4>();
    let start = 4 * chunks.len();
    let [a, b, c, d] = columns.map(|column| column[..start].as_chunks::<4>().0);
    for ((((y, a), b), c), d) in chunks.iter().zip(a).zip(b).zip(c).zip(d) {
        for k in 0..4 {
            sums[0][k] += a[k] * y[k];
            sums[1][k] += b[k] * y[k];
            sums[2][k] += c[k] * y[k];
            sums[3][k] += d[k] * y[k];
        }
    }
    std::array::from_fn(|k| {
        let [p, q, r, s] = sums[k];
        (p + q) + (r + s) + dot(&columns[k][start..], rest)
    })
}
