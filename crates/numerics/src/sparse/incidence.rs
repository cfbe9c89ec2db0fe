//! Sorting items by small keys, and finding where an unknown occurs.

use super::cliques::{Cliques, FIXED};

/// The items with each key from 0 to `n - 1`, one key after the other, in the order in which they come; and where those
/// of each key begin. Items with the key [`FIXED`] are left out.
pub(crate) fn group<T: Copy + Default>(n: usize, items: impl Iterator<Item = (u32, T)> + Clone) -> (Vec<u32>, Vec<T>) {
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

/// For every unknown the cliques of which it is a member, in ascending order, and its places in them.
pub(super) struct Incidence {
    starts: Vec<u32>,
    places: Vec<(u32, u32)>,
}

impl Incidence {
    pub(super) fn new(n: usize, cliques: &Cliques) -> Self {
        let members = (0..).zip(cliques.iter());
        let places = members.flat_map(|(clique, list)| (0..).zip(list).map(move |(place, &m)| (m, (clique, place))));
        let (starts, places) = group(n, places);
        Self { starts, places }
    }

    pub(super) fn of(&self, unknown: u32) -> &[(u32, u32)] {
        &self.places[self.starts[unknown as usize] as usize..self.starts[unknown as usize + 1] as usize]
    }
}
