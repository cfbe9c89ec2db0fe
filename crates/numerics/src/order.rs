//! Fill-reducing order: nested dissection of the graph of blocks of unknowns.
//!
//! Unknowns that always stand together (the three coordinates of a vertex) form one node of the graph, so the graph
//! is a third of the size and blocks stay whole. Nodes coupled with a large part of all others (lattice vectors,
//! tensions of a global measure) would join everything: they are eliminated last.

use super::sparse::{Cliques, FIXED};

/// The order of elimination of a matrix that is a sum of these cliques' blocks: `order[new] = old`.
///
/// `node[k]` is the block to which unknown `k` belongs; blocks are numbered from 0 without gaps.
pub fn nested_dissection(node: &[u32], cliques: &[&Cliques]) -> Vec<u32> {
    let neighbours = neighbours(node, cliques, |_| None);
    let unknowns = unknowns(node);
    nodes(&neighbours).iter().flat_map(|&block| unknowns[block as usize].iter().copied()).collect()
}

/// Order of elimination of the nodes of this graph.
pub(super) fn nodes(neighbours: &[Vec<u32>]) -> Vec<u32> {
    let limit = 40 + 10 * (neighbours.len() as f64).sqrt() as usize;
    let (light, heavy): (Vec<u32>, Vec<u32>) =
        (0..neighbours.len() as u32).partition(|&k| neighbours[k as usize].len() < limit);
    let mut order = dissect(&light, neighbours);
    order.extend(heavy);
    order
}

/// The neighbours of each node, in ascending order: the nodes that a clique couples with it. `apart((list, clique))`
/// are two nodes that this clique does not couple.
pub(super) fn neighbours(
    node: &[u32],
    cliques: &[&Cliques],
    apart: impl Fn((usize, usize)) -> Option<[u32; 2]>,
) -> Vec<Vec<u32>> {
    let mut lists = vec![Vec::new(); count(node)];
    let mut distinct = Vec::new();
    for (list, clique) in places(cliques) {
        let members = cliques[list].members(clique).iter().filter(|m| **m != FIXED);
        distinct.clear();
        distinct.extend(members.map(|&m| node[m as usize]));
        distinct.sort_unstable();
        distinct.dedup();
        let apart = apart((list, clique));
        for &a in &distinct {
            let other = apart.filter(|pair| pair.contains(&a)).map_or(a, |[b, c]| if a == b { c } else { b });
            lists[a as usize].extend(distinct.iter().filter(|b| **b != a && **b != other));
        }
    }
    for list in &mut lists {
        list.sort_unstable();
        list.dedup();
    }
    lists
}

/// The inverse of a permutation.
pub(super) fn inverse(order: &[u32]) -> Vec<u32> {
    let mut inverse = vec![0; order.len()];
    (0..).zip(order).for_each(|(place, &old)| inverse[old as usize] = place);
    inverse
}

/// List and number of every clique.
pub(super) fn places<'a>(cliques: &'a [&Cliques]) -> impl Iterator<Item = (usize, usize)> + 'a {
    cliques.iter().enumerate().flat_map(|(list, cliques)| (0..cliques.len()).map(move |clique| (list, clique)))
}

/// Number of nodes.
pub(super) fn count(node: &[u32]) -> usize {
    node.iter().max().map_or(0, |&last| last as usize + 1)
}

/// The unknowns of each node.
pub(super) fn unknowns(node: &[u32]) -> Vec<Vec<u32>> {
    let mut unknowns = vec![Vec::new(); count(node)];
    (0..).zip(node).for_each(|(unknown, &block)| unknowns[block as usize].push(unknown));
    unknowns
}

/// Nested dissection of the subgraph of the nodes in `chosen`; their natural order where that fails.
fn dissect(chosen: &[u32], neighbours: &[Vec<u32>]) -> Vec<u32> {
    let mut number = vec![FIXED; neighbours.len()];
    for (new, &old) in chosen.iter().enumerate() {
        number[old as usize] = new as u32;
    }
    let (mut starts, mut columns) = (vec![0i32], Vec::new());
    for &old in chosen {
        let list = neighbours[old as usize].iter().map(|&k| number[k as usize]);
        columns.extend(list.filter(|k| *k != FIXED).map(|k| k as i32));
        starts.push(columns.len() as i32);
    }
    let found = feral_ordering_core::CscPattern::new(chosen.len(), &starts, &columns)
        .map(|graph| feral_metis::metis_order_full(&graph, &options()));
    match found {
        Some(Ok((order, ..))) => order.iter().map(|&k| chosen[k as usize]).collect(),
        _ => chosen.to_vec(),
    }
}

/// The effort of nested dissection (measured for matrices of triangulated surfaces with 2,000 to 40,000 unknowns): one
/// first bisection is tried instead of several, which makes the factor no larger, and parts are bisected down to fewer
/// nodes than by default, which makes it smaller by a twentieth.
fn options() -> feral_metis::MetisOptions {
    feral_metis::MetisOptions { niparts: 1, nd_to_amd_switch: 50, ..Default::default() }
}
