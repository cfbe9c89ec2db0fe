//! Torn factorization: cliques are opened where they would widen the separators of nested dissection.
//!
//! The block of a *split* clique couples two blocks of its unknowns by an outer product alone, `k g g^T` with the
//! gradient `g = (g_o, g_l, g_r)` by the other members, the left and the right block ([`Cliques::push_split`]). The
//! hinge between two triangles is one: only its stiffness couples the two opposite vertices. Such a coupling makes
//! separators two vertices wide.
//!
//! With `d = (g_o, g_l, -g_r)` the sum `k (g g^T + d d^T)` does not couple the blocks. So an open clique gets an
//! unknown `y` of its own, which costs `k (d.x - y)^2 / 2`: nothing at its best value, `y = d.x`. The matrix with these
//! unknowns has the first one, `S`, as its Schur complement, the same solutions, and as many negative eigenvalues:
//!
//! `[ S + sum k d d^T   -sum k d ]`
//! `[ -sum k d^T         diag(k) ]`.
//!
//! To add an unknown that takes a coupling out is tearing (G. Kron, Diakoptics, 1963). An open clique stands in a
//! separator with one unknown, a second line of vertices would with three. Only cliques between two branches of the
//! elimination tree are opened, one in ten, and a factorization takes 0.84, 0.70 and 0.66 of the time for sheets of 24,
//! 48 and 96 cells a side (`cargo bench --bench systems`).

use super::factor::{DENSE_LIMIT, Factor, FactorError, Inertia, Symbolic};
use super::order;
use super::sparse::{Cliques, FIXED, RankOne, Slots, SparsityPattern};
use std::ops::Range;
use std::sync::Arc;

/// Number of nodes up to which a part of the elimination tree is too small for an open clique to save anything.
const MOST_NODES_OF_A_SMALL_PART: usize = 20;
/// No node: the root of a tree, or one that was not found.
const NONE: usize = usize::MAX;

/// The analysis of a sum of cliques' blocks: which cliques are open, where the entries go, and the order of
/// elimination.
#[derive(Debug)]
pub struct Tearing {
    torn: Vec<Torn>,
    /// Number of every unknown of the whole matrix in the torn one, which is in the order of elimination.
    numbers: Vec<u32>,
    /// SparsityPattern of the torn matrix.
    pattern: SparsityPattern,
    /// Where the entries of the torn matrix stand in the whole one, or [`FIXED`] for those that it has not.
    sources: Vec<u32>,
    /// Where the members of every torn clique, and then its own unknown, stand in the torn matrix.
    slots: Slots,
    symbolic: Symbolic,
}

/// A clique that is open.
#[derive(Debug)]
struct Torn {
    /// List in which it is, and its number there.
    place: (usize, usize),
    /// Places of its right block among its members.
    right: Range<usize>,
}

/// A torn factorization, refilled with numbers as often as wanted.
pub struct TornFactor {
    tearing: Arc<Tearing>,
    factor: Factor,
    values: Vec<f64>,
    solution: Vec<f64>,
}

impl Tearing {
    /// Analyses the pattern of the sum of these cliques' blocks. `node` groups unknowns into blocks, see
    /// [`super::order`].
    ///
    /// # Errors
    /// [`FactorError::TooLarge`] where memory or indices run out.
    pub fn new(whole: &SparsityPattern, node: &[u32], cliques: &[&Cliques]) -> Result<Self, FactorError> {
        if whole.size() <= DENSE_LIMIT {
            let as_they_are = Numbers { open: vec![], whole: (0..whole.size() as u32).collect() };
            return Self::torn(whole, node, cliques, vec![], as_they_are);
        }
        let blocks = |(list, clique): (usize, usize)| separable_blocks(cliques[list], clique, node);
        let graph = order::neighbours(node, cliques, blocks);
        let tree = EliminationTree::new(order::nodes(&graph), &graph);
        let separated = |place: &(usize, usize)| blocks(*place).is_some_and(|nodes| tree.separates(nodes));
        let torn: Vec<_> = order::places(cliques).filter(separated).collect();
        let numbers = tree.numbers(node, torn.iter().map(|&(list, clique)| (cliques[list], clique)));
        Self::torn(whole, node, cliques, torn, numbers)
    }

    /// The analysis with these cliques open and the unknowns in this order.
    fn torn(
        whole: &SparsityPattern,
        node: &[u32],
        cliques: &[&Cliques],
        torn: Vec<(usize, usize)>,
        numbers: Numbers,
    ) -> Result<Self, FactorError> {
        let (mut apart, mut more, mut extended) = (vec![Vec::new(); order::count(node)], Vec::new(), Cliques::new());
        for (&(list, clique), &y) in torn.iter().zip(&numbers.open) {
            if let Some([left, right]) = separable_blocks(cliques[list], clique, node) {
                apart[left as usize].push(right);
                apart[right as usize].push(left);
            }
            let members = cliques[list].members(clique);
            let number = |&m: &u32| if m == FIXED { FIXED } else { numbers.whole[m as usize] };
            extended.push(members.iter().map(number).chain([y]));
            let mut coupled: Vec<u32> = members.iter().copied().filter(|m| *m != FIXED).collect();
            coupled.sort_unstable();
            coupled.dedup();
            more.push((y, coupled));
        }
        // nothing else couples these nodes: they would be in one branch of the tree
        let are_apart = |row: u32, column: u32| apart[node[column as usize] as usize].contains(&node[row as usize]);
        let (pattern, places) = whole.renumbered(&numbers.whole, &more, are_apart);
        let (slots, symbolic) = (Slots::new(&pattern, &extended), Symbolic::in_order(&pattern)?);
        let mut sources = vec![FIXED; pattern.entries()];
        let found = (0..).zip(&places).filter(|(_, place)| **place != FIXED);
        found.for_each(|(slot, &place)| sources[place as usize] = slot);
        let right = |(list, clique): (usize, usize)| cliques[list].split(clique).map_or(0..0, |[_, right]| right);
        let torn = torn.into_iter().map(|place| Torn { place, right: right(place) }).collect();
        Ok(Self { torn, numbers: numbers.whole, pattern, sources, slots, symbolic })
    }

    /// Number of open cliques.
    pub fn open(&self) -> usize {
        self.torn.len()
    }
}

impl TornFactor {
    /// Makes room for a factorization.
    ///
    /// # Errors
    /// [`FactorError::TooLarge`] where there is not enough memory.
    pub fn of(tearing: &Arc<Tearing>) -> Result<Self, FactorError> {
        let (values, solution) = (vec![0.0; tearing.pattern.entries()], vec![0.0; tearing.pattern.size()]);
        Ok(Self { factor: Factor::of(&tearing.symbolic)?, tearing: tearing.clone(), values, solution })
    }

    /// Factors the matrix with these values. `outer(list, clique)` is the outer product in the block of a torn clique,
    /// of a weight `k >= 0`; the rest of that block leaves left and right uncoupled. The inertia is that of the matrix
    /// itself.
    ///
    /// # Errors
    /// As [`Factor::factor`].
    pub fn factor<'a>(
        &mut self,
        whole: &SparsityPattern,
        values: &[f64],
        outer: impl Fn(usize, usize) -> RankOne<'a>,
    ) -> Result<Inertia, FactorError> {
        let Tearing { torn, pattern, sources, slots, .. } = &*self.tearing;
        let value = |source: u32| values.get(source as usize).copied().unwrap_or(0.0);
        self.values.iter_mut().zip(sources).for_each(|(to, &from)| *to = value(from));
        // any size of the new unknowns will do; this one leaves the range of the pivots alone
        let size = whole.largest_diagonal(values).sqrt();
        let mut scaled = Vec::new();
        for (y, Torn { place: (list, clique), right }) in torn.iter().enumerate() {
            let RankOne { weight, gradient } = outer(*list, *clique);
            scaled.clear();
            scaled.extend(gradient.iter().map(|g| weight.sqrt() * g));
            scaled[right.clone()].iter_mut().for_each(|g| *g = -*g);
            scaled.push(-size);
            slots.add_outer(y, RankOne { weight: 1.0, gradient: &scaled }, &mut self.values);
        }
        self.factor.factor(pattern, &self.values)
    }

    /// Solves with the last factorization, in place.
    pub fn solve(&mut self, x: &mut [f64]) {
        let numbers = &self.tearing.numbers;
        self.solution.fill(0.0);
        x.iter().zip(numbers).for_each(|(&x, &number)| self.solution[number as usize] = x);
        self.factor.solve(&mut self.solution);
        x.iter_mut().zip(numbers).for_each(|(x, &number)| *x = self.solution[number as usize]);
    }

    /// Count of numbers stored in the factor.
    pub fn stored(&self) -> usize {
        self.factor.stored()
    }
}

/// The nodes of the two blocks of a split clique, where they can be taken apart: each block is one node, no other
/// member of the clique is in these nodes, and there is another member.
fn separable_blocks(cliques: &Cliques, clique: usize, node: &[u32]) -> Option<[u32; 2]> {
    let blocks = cliques.split(clique)?;
    let members = cliques.members(clique);
    let [left, right] = blocks.map(|block| the_node(&members[block], node));
    let (left, right) = (left?, right?);
    let joined = other_nodes(cliques, clique, node).next().is_some();
    let apart = left != right && other_nodes(cliques, clique, node).all(|k| k != left && k != right);
    (joined && apart).then_some([left, right])
}

/// The node of these members, if all are in one; members that are held fixed do not count.
fn the_node(members: &[u32], node: &[u32]) -> Option<u32> {
    let first = nodes(members.iter(), node).next()?;
    nodes(members.iter(), node).all(|other| other == first).then_some(first)
}

/// The nodes of the members of a clique that are in neither of its two blocks.
fn other_nodes<'a>(cliques: &'a Cliques, clique: usize, node: &'a [u32]) -> impl Iterator<Item = u32> + 'a {
    let blocks = cliques.split(clique);
    let in_a_block = move |place: usize| blocks.iter().flatten().any(|block| block.contains(&place));
    let others = cliques.members(clique).iter().enumerate().filter(move |(place, _)| !in_a_block(*place));
    nodes(others.map(|(_, member)| member), node)
}

fn nodes<'a>(members: impl Iterator<Item = &'a u32> + 'a, node: &'a [u32]) -> impl Iterator<Item = u32> + 'a {
    members.filter(|member| **member != FIXED).map(|&member| node[member as usize])
}

/// The order of elimination: numbers of the unknowns of the open cliques, and of those of the whole matrix.
struct Numbers {
    open: Vec<u32>,
    whole: Vec<u32>,
}

/// The elimination tree of the nodes of a graph.
struct EliminationTree {
    /// Node at each place of the order, and place of each node.
    order: Vec<u32>,
    place: Vec<usize>,
    /// Place of the parent of each place, or `NONE`.
    parent: Vec<usize>,
    /// Number of places below and at each place.
    size: Vec<usize>,
}

impl EliminationTree {
    fn new(order: Vec<u32>, neighbours: &[Vec<u32>]) -> Self {
        let count = order.len();
        let mut place = vec![NONE; count];
        order.iter().enumerate().for_each(|(k, &node)| place[node as usize] = k);
        // (J. Liu, ACM Trans. Math. Softw. 12, 127 (1986)), with compressed paths
        let (mut parent, mut root) = (vec![NONE; count], vec![NONE; count]);
        for (k, &node) in order.iter().enumerate() {
            for &neighbour in &neighbours[node as usize] {
                let mut below = place[neighbour as usize];
                while below < k {
                    let next = std::mem::replace(&mut root[below], k);
                    if next == NONE {
                        parent[below] = k;
                    }
                    below = next;
                }
            }
        }
        let mut size = vec![1; count];
        (0..count).filter(|k| parent[*k] != NONE).for_each(|k| size[parent[k]] += size[k]);
        Self { order, place, parent, size }
    }

    /// Whether these two nodes, which have a common neighbour, are in different branches of a part that is not small.
    fn separates(&self, nodes: [u32; 2]) -> bool {
        let [mut a, mut b] = nodes.map(|node| self.place[node as usize]);
        let later = a.max(b);
        while a != b {
            if a < b {
                a = self.parent[a];
            } else {
                b = self.parent[b];
            }
        }
        a != later && self.size[a] > MOST_NODES_OF_A_SMALL_PART
    }

    /// The order of elimination of all unknowns: those of these open cliques come first in the separators.
    fn numbers<'a>(&self, node: &[u32], torn: impl Iterator<Item = (&'a Cliques, usize)>) -> Numbers {
        let mut before = vec![Vec::new(); self.order.len()];
        let mut open = Vec::new();
        for (cliques, clique) in torn {
            let first = other_nodes(cliques, clique, node).map(|other| self.place[other as usize]).min();
            before[first.unwrap_or(0)].push(open.len());
            open.push(0);
        }
        let (unknowns, mut whole, mut next) = (order::unknowns(node), vec![0; node.len()], 0..);
        for (torn, &node) in before.iter().zip(&self.order) {
            torn.iter().zip(&mut next).for_each(|(&clique, number)| open[clique] = number);
            unknowns[node as usize].iter().zip(&mut next).for_each(|(&k, number)| whole[k as usize] = number);
        }
        Numbers { open, whole }
    }
}
