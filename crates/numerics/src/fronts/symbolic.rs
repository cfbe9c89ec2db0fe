//! The assembly tree of a supernodal factorization, and where everything goes in it.

use super::dense::PIVOTS_AT_ONCE;
use super::supernodes::{NONE, Supernodes};
use crate::order::inverse;
use crate::sparse::SparsityPattern;
use crate::sparse::incidence::group;
use faer::sparse::linalg::cholesky::SymbolicCholesky;
use std::ops::Range;

/// The assembly tree. Fronts are numbered in postorder, and unknowns so that those of a front are consecutive: all that
/// belongs to a subtree is contiguous.
#[derive(Debug)]
pub(crate) struct AssemblyTree {
    /// The unknown of the matrix that is eliminated at each place.
    pub order: Vec<u32>,
    /// The fronts, children before their parent.
    pub fronts: Vec<Front>,
    /// The tasks of which the forest consists.
    pub branches: Vec<TreeBranch>,
    /// The rows below the pivots of each front, front by front, in runs that are consecutive in the parent's front too.
    pub runs: Vec<RowRun>,
    /// Entries of the matrix, front by front: the place in the input, and the place in the panel.
    pub entries: Vec<[u32; 2]>,
}

/// A front: the pivots of a supernode, and the rows below them.
#[derive(Debug)]
pub(crate) struct Front {
    /// Places in the order of the unknowns that are eliminated.
    pub pivots: Range<usize>,
    /// Range of its rows in a list of those of all fronts.
    pub rows: Range<usize>,
    /// Range of its runs of rows in the list of them.
    pub runs: Range<usize>,
    /// Range of its entries of the matrix in the list of them.
    pub entries: Range<usize>,
    /// Range of its panel, the columns of its pivots, among the numbers of the factor.
    pub panel: Range<usize>,
    /// The first front of its subtree.
    pub first: usize,
    /// The parent, or the number of fronts for a root.
    pub parent: usize,
    /// Number of fronts above it.
    pub depth: usize,
    /// The tasks into which its subtree below it is divided.
    pub branches: Vec<TreeBranch>,
    /// First place of its update matrix among those of the parent's children.
    pub update: usize,
}

/// Rows that are consecutive in the update matrix of a front, and in the parent's front as well: either all among the
/// parent's pivots or all below them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowRun {
    /// The first of them in the update matrix.
    pub start: u32,
    /// Its place in the parent's front.
    pub place: u32,
    /// Number of rows.
    pub count: u32,
}

/// A part of the tree that is worked on as one: consecutive subtrees of one parent that are one task, or one subtree
/// that is divided further.
#[derive(Debug, Clone)]
pub(crate) struct TreeBranch {
    /// Its fronts, the root or roots of it last.
    pub fronts: Range<usize>,
    /// Whether it is one subtree that is divided further.
    pub divided: bool,
    /// Room on the stacks that it needs.
    pub room: Room,
    /// Part of the room for copies of pivots' columns.
    pub copy: usize,
}

/// Counts of numbers on two stacks of update matrices: the one for the roots of a part of the tree, and for fronts an
/// even number of levels below them, and the one for the other fronts. A front takes its children's from one stack and
/// puts its own on the other.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Room {
    /// Count on the stack for its roots.
    pub even: usize,
    /// Count on the other stack.
    pub odd: usize,
}

impl Front {
    /// Returns the number of pivots.
    pub fn width(&self) -> usize {
        self.pivots.len()
    }

    /// Returns the number of rows below the pivots, the size of the update matrix.
    pub fn below(&self) -> usize {
        self.rows.len()
    }

    /// Returns the number of all rows.
    pub fn height(&self) -> usize {
        self.pivots.len() + self.rows.len()
    }

    /// Returns its update matrix among those of the parent's children.
    pub fn matrix<'a>(&self, siblings: &'a [f64]) -> &'a [f64] {
        &siblings[self.update..self.update + self.below().pow(2)]
    }

    /// Returns the count of numbers in a copy of the pivots' columns that are eliminated at once.
    fn copy(&self) -> usize {
        self.height() * self.width().min(PIVOTS_AT_ONCE)
    }
}

impl Room {
    /// Returns the room for all of these branches.
    pub fn sum(branches: &[TreeBranch]) -> Self {
        let rooms = branches.iter().map(|branch| branch.room);
        rooms.fold(Self::default(), |sum, room| Self { even: sum.even + room.even, odd: sum.odd + room.odd })
    }
}

impl AssemblyTree {
    /// Builds the tree of a pattern that faer analysed.
    pub fn new(pattern: &SparsityPattern, analysis: &SymbolicCholesky<u32>) -> Self {
        let nodes = Supernodes::new(analysis);
        let order = nodes.postorder();
        let mut tree = Self { order: vec![], fronts: vec![], branches: vec![], runs: vec![], entries: vec![] };
        // faer's columns, and then unknowns
        let columns: Vec<u32> = order.iter().flat_map(|&k| nodes.columns(k)).collect();
        let place_of_column = inverse(&columns);
        let Some(order_of_faer) = analysis.perm() else { unreachable!("an order is given to faer") };
        tree.order = columns.iter().map(|&column| order_of_faer.arrays().0[column as usize]).collect();
        let rows = tree.lay_out(&nodes, &order, &place_of_column);
        tree.place_rows(&rows, &nodes, &order);
        tree.place_entries(pattern, &rows);
        for k in (0..order.len()).filter(|k| nodes.divided[order[*k]]) {
            tree.fronts[k].branches = tree.divide(tree.fronts[k].first..k, &nodes, &order);
        }
        tree.branches = tree.divide(0..order.len(), &nodes, &order);
        tree
    }

    /// Makes the fronts. Returns their rows, by their places in the order.
    fn lay_out(&mut self, nodes: &Supernodes<'_>, order: &[usize], place_of_column: &[u32]) -> Vec<u32> {
        let (mut rows, mut pivots, mut stored) = (Vec::with_capacity(nodes.rows.len()), 0, 0);
        let mut size = vec![1; order.len()];
        for (number, &k) in order.iter().enumerate() {
            let first_row = rows.len();
            // rows of ancestors: they follow each other in both orders
            rows.extend(nodes.rows(k).iter().map(|&row| place_of_column[row as usize]));
            let (width, below) = (nodes.columns(k).len(), rows.len() - first_row);
            let panel = stored..stored + width * (width + below);
            self.fronts.push(Front {
                pivots: pivots..pivots + width,
                rows: first_row..rows.len(),
                runs: 0..0,
                entries: 0..0,
                panel: panel.clone(),
                first: number + 1 - size[k],
                parent: order.len(),
                depth: nodes.depth[k],
                branches: vec![],
                update: 0,
            });
            (pivots, stored) = (pivots + width, panel.end);
            if nodes.parent[k] != NONE {
                size[nodes.parent[k]] += size[k];
            }
        }
        rows
    }

    /// Finds the place of every row in the parent's front.
    fn place_rows(&mut self, rows: &[u32], nodes: &Supernodes<'_>, order: &[usize]) {
        let number: Vec<u32> = inverse(&order.iter().map(|&k| k as u32).collect::<Vec<_>>());
        for k in (0..order.len()).filter(|k| nodes.parent[order[*k]] != NONE) {
            let parent = number[nodes.parent[order[k]]] as usize;
            self.fronts[k].parent = parent;
            let parent = &self.fronts[parent];
            let (first, width, end) = (parent.pivots.start as u32, parent.width() as u32, parent.pivots.end as u32);
            let mut others = (0..).zip(&rows[parent.rows.clone()]);
            let first_run = self.runs.len();
            for (start, &row) in (0..).zip(&rows[self.fronts[k].rows.clone()]) {
                let place = if row < end {
                    row - first
                } else {
                    let found = others.find(|(_, other)| **other == row);
                    found.map_or_else(|| unreachable!("a parent has its children's rows"), |found| width + found.0)
                };
                match self.runs[first_run..].last_mut() {
                    Some(run) if run.place + run.count == place && place != width => run.count += 1,
                    _ => self.runs.push(RowRun { start, place, count: 1 }),
                }
            }
            self.fronts[k].runs = first_run..self.runs.len();
        }
    }

    /// Finds the place of every entry of the matrix.
    fn place_entries(&mut self, pattern: &SparsityPattern, rows: &[u32]) {
        let place = inverse(&self.order);
        let mut front_of = vec![0u32; self.order.len()];
        for (k, front) in (0..).zip(&self.fronts) {
            front_of[front.pivots.clone()].fill(k);
        }
        let mut found = Vec::with_capacity(pattern.entries());
        for column in 0..pattern.size() {
            for &row in pattern.column(column) {
                let (a, b) = (place[row as usize], place[column]);
                let (row, column) = (a.max(b), a.min(b));
                let number = front_of[column as usize];
                let front = &self.fronts[number as usize];
                let local = if (row as usize) < front.pivots.end {
                    row as usize - front.pivots.start
                } else {
                    front.width() + rows[front.rows.clone()].partition_point(|other| *other < row)
                };
                let in_panel = local + (column as usize - front.pivots.start) * front.height();
                found.push((number, [found.len() as u32, in_panel as u32]));
            }
        }
        let (starts, entries) = group(self.fronts.len(), found.into_iter());
        for (front, ends) in self.fronts.iter_mut().zip(starts.windows(2)) {
            front.entries = ends[0] as usize..ends[1] as usize;
        }
        self.entries = entries;
    }

    /// Returns the children of a front, the last one first.
    pub fn children(&self, k: usize) -> impl Iterator<Item = &Front> + '_ {
        self.roots_backwards(self.fronts[k].first..k).map(|child| &self.fronts[child])
    }

    /// Returns the roots of the subtrees that make up these consecutive fronts, the last one first.
    fn roots_backwards(&self, fronts: Range<usize>) -> impl Iterator<Item = usize> + '_ {
        let mut end = fronts.end;
        std::iter::from_fn(move || {
            let root = (end > fronts.start).then(|| end - 1)?;
            end = self.fronts[root].first;
            Some(root)
        })
    }

    /// Returns the roots of the subtrees that make up these consecutive fronts, in order.
    fn roots(&self, fronts: Range<usize>) -> Vec<usize> {
        let mut roots: Vec<_> = self.roots_backwards(fronts).collect();
        roots.reverse();
        roots
    }

    /// Returns the tasks for these consecutive fronts, all that is below one front or the whole forest; says where the
    /// update matrices of the roots of these subtrees will be.
    fn divide(&mut self, fronts: Range<usize>, nodes: &Supernodes<'_>, order: &[usize]) -> Vec<TreeBranch> {
        let mut branches: Vec<TreeBranch> = Vec::new();
        let (mut start, mut operations) = (fronts.start, 0.0);
        let roots = self.roots(fronts);
        for (n, &root) in roots.iter().enumerate() {
            operations += nodes.operations[order[root]];
            let divided = |root: usize| nodes.divided[order[root]];
            let full = operations > nodes.share;
            if divided(root) || full || roots.get(n + 1).is_none_or(|next| divided(*next)) {
                let fronts = start..root + 1;
                branches.push(TreeBranch { fronts, divided: divided(root), room: Room::default(), copy: 0 });
                (start, operations) = (root + 1, 0.0);
            }
        }
        let mut before = 0;
        for branch in &mut branches {
            branch.copy = self.fronts[branch.fronts.clone()].iter().map(Front::copy).max().unwrap_or(0);
            branch.room = if branch.divided { self.room_of_divided(branch) } else { self.room_of_task(branch) };
            let mut place = before;
            for root in self.roots(branch.fronts.clone()) {
                self.fronts[root].update = place;
                place += self.fronts[root].below().pow(2);
            }
            before += branch.room.even;
        }
        branches
    }

    /// Returns the room for a subtree whose branches work at the same time.
    fn room_of_divided(&self, branch: &TreeBranch) -> Room {
        let front = &self.fronts[branch.fronts.end - 1];
        let below = Room::sum(&front.branches);
        Room { even: below.odd.max(front.below().pow(2) + front.copy()), odd: below.even }
    }

    /// Returns the room for subtrees that are worked on one front after the other, and the places of update matrices in
    /// it.
    fn room_of_task(&mut self, branch: &TreeBranch) -> Room {
        let level = self.fronts[branch.fronts.end - 1].depth;
        let (mut used, mut room) = ([0; 2], [0; 2]);
        for k in branch.fronts.clone() {
            let mine = (self.fronts[k].depth - level) % 2;
            let mut place = 0;
            for child in self.roots(self.fronts[k].first..k) {
                self.fronts[child].update = place;
                place += self.fronts[child].below().pow(2);
            }
            used[mine] += self.fronts[k].below().pow(2);
            room[mine] = room[mine].max(used[mine]);
            used[1 - mine] -= place;
        }
        Room { even: room[0] + branch.copy, odd: room[1] }
    }
}
