//! Flooding: the minima of numbers on a net, and where the lakes around them meet as the water rises.
//!
//! Nodes are taken by rising number and joined to their lower neighbours (union-find). A node without lower neighbours
//! is a minimum; one whose lower neighbours belong to several lakes is a pass between them. A lake is named by its
//! lowest minimum; one that lies on the border gives way to any other, so that passes are found also between lakes that
//! meet below a low border.

use crate::math::pieces::find;

/// Minima, and where lakes meet.
pub(super) struct Flood {
    /// Nodes without lower neighbours.
    pub minima: Vec<usize>,
    /// By rising number.
    pub merges: Vec<Merge>,
}

/// Two lakes meet.
pub(super) struct Merge {
    /// The lowest nodes of the two.
    pub lower: [usize; 2],
    /// Where.
    pub at: usize,
}

/// Floods a net with a border.
pub(super) fn flood(heights: &[f64], links: &[[usize; 2]], border: &[bool]) -> Flood {
    let mut beside = vec![Vec::new(); heights.len()];
    for &[a, b] in links {
        beside[a].push(b);
        beside[b].push(a);
    }
    let mut order: Vec<usize> = (0..heights.len()).collect();
    order.sort_by(|&a, &b| heights[a].total_cmp(&heights[b]));
    // a node of the same lake, itself where the node is its lowest
    let mut lake: Vec<usize> = (0..heights.len()).collect();
    let mut flooded = vec![false; heights.len()];
    let mut found = Flood { minima: Vec::new(), merges: Vec::new() };
    for at in order {
        let wet = beside[at].iter().filter(|&&other| flooded[other]);
        let mut lakes: Vec<usize> = wet.map(|&other| find(&mut lake, other)).collect();
        lakes.sort_by(|&a, &b| border[a].cmp(&border[b]).then(heights[a].total_cmp(&heights[b])).then(a.cmp(&b)));
        lakes.dedup();
        flooded[at] = true;
        let Some((&deepest, others)) = lakes.split_first() else {
            found.minima.push(at);
            continue;
        };
        lake[at] = deepest;
        for &other in others {
            found.merges.push(Merge { lower: [deepest, other], at });
            lake[other] = deepest;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: on a line with three lakes the shallower one of each pair joins the deeper one at the ridge between them,
    /// the lower ridge first; the ends count as lakes where they are low.
    #[test]
    fn lakes_on_a_line() {
        let heights = [3.0, 1.0, 4.0, 0.0, 5.0, 2.0, 6.0];
        let links: Vec<[usize; 2]> = (1..heights.len()).map(|k| [k - 1, k]).collect();
        let found = flood(&heights, &links, &[false; 7]);
        assert_eq!(found.minima, [3, 1, 5]);
        let merges: Vec<_> = found.merges.iter().map(|merge| (merge.lower, merge.at)).collect();
        assert_eq!(merges, [([3, 1], 2), ([3, 5], 4)]);
    }

    /// Claim: two lakes that meet by way of a third one, whose lowest node lies on the border, are joined at the higher
    /// of the ridges.
    #[test]
    fn lakes_behind_a_border() {
        let heights = [1.0, 3.0, 0.0, 4.0, 2.0];
        let links: Vec<[usize; 2]> = (1..heights.len()).map(|k| [k - 1, k]).collect();
        let found = flood(&heights, &links, &[false, false, true, false, false]);
        let merges: Vec<_> = found.merges.iter().map(|merge| (merge.lower, merge.at)).collect();
        assert_eq!(merges, [([0, 2], 1), ([0, 4], 3)]);
    }

    /// Claim: three lakes that meet in one node are joined there by two passes, and what hangs together nowhere stays
    /// apart.
    #[test]
    fn lakes_at_a_crossing() {
        let heights = [9.0, 1.0, 2.0, 3.0, 0.5];
        let found = flood(&heights, &[[0, 1], [0, 2], [0, 3]], &[false; 5]);
        assert_eq!(found.minima, [4, 1, 2, 3]);
        assert!(found.merges.iter().all(|merge| merge.at == 0 && merge.lower[0] == 1) && found.merges.len() == 2);
    }
}
