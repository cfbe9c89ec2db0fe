//! Lists of unknowns that are coupled with each other.

use std::ops::Range;

/// Marks a member that is held fixed: its rows and columns do not exist.
pub const FIXED: u32 = u32::MAX;

/// Lists of unknowns that are coupled with each other, one list an element.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cliques {
    starts: Vec<usize>,
    /// The members of all cliques, one behind the other.
    pub(super) members: Vec<u32>,
    splits: Vec<Option<[Range<u32>; 2]>>,
}

impl Cliques {
    /// An empty list of cliques.
    pub fn new() -> Self {
        Self { starts: vec![0], members: Vec::new(), splits: Vec::new() }
    }

    /// Appends a clique. Members are numbers of unknowns, or [`FIXED`]; an unknown may occur several times.
    pub fn push(&mut self, members: impl IntoIterator<Item = u32>) {
        self.members.extend(members);
        self.starts.push(self.members.len());
        self.splits.push(None);
    }

    /// Appends a clique two blocks of which, the members at the places `left` and `right`, meet in a rank-one term
    /// alone: in the matrix of this clique, only the outer product of a gradient couples one block with the other. A
    /// factorization can take such blocks apart, see [`tearing`](crate::tearing).
    pub fn push_split(&mut self, members: impl IntoIterator<Item = u32>, left: Range<u32>, right: Range<u32>) {
        self.push(members);
        if let Some(last) = self.splits.last_mut() {
            *last = Some([left, right]);
        }
    }

    /// The places of the two blocks of clique `k` that meet in a rank-one term alone, if it has such blocks.
    pub fn split(&self, k: usize) -> Option<[Range<usize>; 2]> {
        self.splits[k].as_ref().map(|blocks| blocks.each_ref().map(|block| block.start as usize..block.end as usize))
    }

    /// Number of cliques.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there is no clique.
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

    /// Iterates over the members of each clique.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> + Clone {
        (0..self.len()).map(|k| self.members(k))
    }

    /// Where the members of each clique stand, as [`range`](Self::range), clique by clique.
    pub(super) fn ranges(&self) -> impl Iterator<Item = Range<usize>> {
        self.starts.windows(2).map(|ends| ends[0]..ends[1])
    }
}
