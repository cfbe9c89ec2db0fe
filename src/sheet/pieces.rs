//! The pieces of a sheet: parts that no edge joins.

/// The vertices of every piece that has a face, given all edges by their ends and all faces by one of their corners. A vertex without an
/// edge, or edges without a face, are no piece.
pub fn pieces(
    vertices: usize,
    edges: impl Iterator<Item = [usize; 2]>,
    faces: impl Iterator<Item = usize>,
) -> Vec<Vec<usize>> {
    let mut root: Vec<usize> = (0..vertices).collect();
    for ends in edges {
        let [a, b] = ends.map(|end| find(&mut root, end));
        root[a.max(b)] = a.min(b);
    }
    let mut has_face = vec![false; vertices];
    faces.for_each(|corner| has_face[find(&mut root, corner)] = true);
    let mut of_root = vec![Vec::new(); vertices];
    (0..vertices).for_each(|vertex| of_root[find(&mut root, vertex)].push(vertex));
    of_root.into_iter().zip(has_face).filter_map(|(piece, face)| face.then_some(piece)).collect()
}

/// The least vertex of the piece of a vertex; halves the way to it.
fn find(root: &mut [usize], mut vertex: usize) -> usize {
    while root[vertex] != vertex {
        root[vertex] = root[root[vertex]];
        vertex = root[vertex];
    }
    vertex
}
