//! Triangles of neighbouring charts.
//!
//! A corner of a chart's polygon is where three balls meet: a triangle of the chart and of two neighbours that follow
//! each other in its ring. In a plane all three see the same triangle. On a curved surface charts may disagree where
//! four balls meet almost in a point; triangles that all three see are kept, and what is left are small holes, each
//! with one closed rim, which are filled with the shortest diagonals. Triangles kept are sectors of the rings of their
//! charts, so that no edge has more than two and the sheet is a manifold.

use std::collections::HashSet;

/// Largest number of edges of the rim of a hole that is closed.
const MOST_RIM_EDGES: usize = 12;

/// Neighbours around every chart; `None` where it is open.
pub(super) type Rings = [Vec<Option<usize>>];

/// The triangles of charts with these rings, counter-clockwise as the rings; holes are closed with short diagonals.
pub(super) fn triangles(rings: &Rings, distance: &dyn Fn(usize, usize) -> f64) -> Vec<[usize; 3]> {
    let mut found = agreed(rings);
    let mut edges: HashSet<[usize; 2]> = found.iter().flat_map(sides).collect();
    for rim in rims(rings, &edges) {
        fill(rim, distance, &mut edges, &mut found);
    }
    found
}

/// The triangles that all three charts see.
fn agreed(rings: &Rings) -> Vec<[usize; 3]> {
    let all = rings.iter().enumerate().flat_map(|(chart, ring)| pairs(ring).map(move |(a, b)| [chart, a, b]));
    let is_agreed = |&[chart, a, b]: &[usize; 3]| {
        chart < a && chart < b && follows(&rings[a], b, chart) && follows(&rings[b], chart, a)
    };
    all.filter(is_agreed).collect()
}

/// Neighbours that follow each other.
fn pairs(ring: &[Option<usize>]) -> impl Iterator<Item = (usize, usize)> + '_ {
    (0..ring.len()).filter_map(|k| Some((ring[k]?, ring[(k + 1) % ring.len()]?)))
}

fn follows(ring: &[Option<usize>], first: usize, second: usize) -> bool {
    pairs(ring).any(|pair| pair == (first, second))
}

fn sides(triangle: &[usize; 3]) -> [[usize; 2]; 3] {
    let [a, b, c] = *triangle;
    [[a, b], [b, c], [c, a]]
}

/// The rims of the holes in which no chart is open, the hole on the left.
fn rims(rings: &Rings, edges: &HashSet<[usize; 2]>) -> Vec<Vec<usize>> {
    let mut left: Vec<[usize; 2]> = edges.iter().map(|[a, b]| [*b, *a]).filter(|edge| !edges.contains(edge)).collect();
    left.sort_unstable();
    let (mut done, mut rims) = (HashSet::new(), Vec::new());
    for edge in left {
        let (mut rim, mut at, mut closed) = (Vec::new(), edge, true);
        while done.insert(at) {
            rim.push(at[0]);
            match next_on_rim(&rings[at[1]], at, edges) {
                Some((to, whole)) => {
                    closed &= whole;
                    at = [at[1], to];
                }
                None => closed = false,
            }
        }
        if closed && at == edge && rim.len() >= 3 {
            rims.push(rim);
        }
    }
    rims
}

/// The next chart of the rim after `at[1]`: clockwise from the neighbour it comes from to the next one with a triangle
/// on the far side; and whether the ring is closed in between.
fn next_on_rim(ring: &[Option<usize>], at: [usize; 2], edges: &HashSet<[usize; 2]>) -> Option<(usize, bool)> {
    let count = ring.len();
    let from = ring.iter().position(|neighbour| *neighbour == Some(at[0]))?;
    let mut closed = true;
    for back in 1..=count {
        match ring[(from + count - back) % count] {
            None => closed = false,
            Some(to) if edges.contains(&[to, at[1]]) && !edges.contains(&[at[1], to]) => return Some((to, closed)),
            Some(_) => {}
        }
    }
    None
}

/// Fills a hole, ear by ear, the shortest new edge first.
fn fill(
    mut rim: Vec<usize>,
    distance: &dyn Fn(usize, usize) -> f64,
    edges: &mut HashSet<[usize; 2]>,
    found: &mut Vec<[usize; 3]>,
) {
    if rim.len() > MOST_RIM_EDGES {
        return;
    }
    while rim.len() >= 3 {
        let count = rim.len();
        let ear = |k: usize| [rim[(k + count - 1) % count], rim[k], rim[(k + 1) % count]];
        let fits = |k: &usize| {
            let [a, _, c] = ear(*k);
            count == 3 || (a != c && !edges.contains(&[a, c]) && !edges.contains(&[c, a]))
        };
        let length = |k: &usize| distance(ear(*k)[0], ear(*k)[2]);
        let best = (0..count).filter(fits).min_by(|a, b| length(a).total_cmp(&length(b)));
        let Some(best) = best else { return };
        let triangle = ear(best);
        found.push(triangle);
        edges.extend(sides(&triangle));
        if count == 3 {
            return;
        }
        rim.remove(best);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring<const N: usize>(neighbours: [usize; N]) -> Vec<Option<usize>> {
        neighbours.into_iter().map(Some).collect()
    }

    /// Claim: a wheel around chart 0 is six triangles; where two rim charts disagree with the hub about a diagonal, the
    /// hole of four is closed with the shorter diagonal, and no edge has more than one triangle on a side.
    #[test]
    fn disagreement_is_a_hole_that_is_filled() {
        // An octahedron: 0 north, 5 south, 1 to 4 around.
        let octahedron = [
            ring([1, 2, 3, 4]),
            ring([0, 4, 5, 2]),
            ring([0, 1, 5, 3]),
            ring([0, 2, 5, 4]),
            ring([0, 3, 5, 1]),
            ring([4, 3, 2, 1]),
        ];
        assert_eq!(triangles(&octahedron, &|_, _| 1.0).len(), 8);
        // Chart 0 thinks that 1 is no neighbour: the hole has the rim 0, 4, 1, 2 and the diagonals 0-1 and 2-4.
        let mut disputed = octahedron.clone();
        disputed[0] = ring([2, 3, 4]);
        for long in [[0, 1], [2, 4]] {
            let found = triangles(&disputed, &|a, b| if [a.min(b), a.max(b)] == long { 2.0 } else { 1.0 });
            let edges: HashSet<[usize; 2]> = found.iter().flat_map(sides).collect();
            assert!(found.len() == 8 && edges.len() == 24, "{found:?}");
            assert!(!edges.contains(&long) && edges.iter().all(|[a, b]| edges.contains(&[*b, *a])));
        }
        let mut open = octahedron;
        open[0] = vec![Some(1), Some(2), None, Some(4)];
        assert_eq!(triangles(&open, &|_, _| 1.0).len(), 6, "an open chart leaves its hole");
    }
}
