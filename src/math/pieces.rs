//! Connected components of a graph, by union-find: the pieces of a sheet, fans of faces, clusters of roots, lakes.

/// Returns the vertices of every connected piece that has a face, in ascending order. `vertices` is the number of
/// vertices, `edges` gives the two ends of each edge and `faces` one corner of each face; pieces without a face are
/// left out. To group the vertices of a graph that is no sheet, give all of them as `faces`.
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

/// Returns the vertex that stands for the piece of a vertex, and halves the path to it in `root`, which leads from each
/// vertex towards it and from it to itself.
pub(crate) fn find(root: &mut [usize], mut vertex: usize) -> usize {
    while root[vertex] != vertex {
        root[vertex] = root[root[vertex]];
        vertex = root[vertex];
    }
    vertex
}
