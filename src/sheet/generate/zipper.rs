//! Two Miura tubes coupled as a zipper: the walls that touch lie on each other and zigzag in opposite ways.

use super::error::{GenerateError, between};
use super::parts::Parts;
use super::tubes::{CoupledTube, MiuraTubes, SOURCE};
use crate::math::Vec3;
use crate::sheet::build::GluedEdge;
use crate::sheet::cell::{Corner, Glue, Sheet};

/// Number of vertices of a ring: four of each tube, the wall that touches the other tube first.
const RING: usize = 8;

impl MiuraTubes {
    /// The second tube is the first one turned by 180 degrees about the side `u` of the wall where they touch. There
    /// both have the same ridges. The ends of those of the second tube are moved by `b cos t` along them, forwards on even
    /// rings and backwards on odd ones. Between two ridges the faces of both lie in one plane, and their zigzags cross
    /// halfway: a hexagon is common to both, two triangles belong to each tube alone. Both fold together without
    /// stretching.
    pub(super) fn zipper(&self) -> Result<Sheet, GenerateError> {
        let tube = self.tube()?;
        between("b", self.b, 0.0, self.a / libm::cos(self.sector))?;
        let rings: Vec<[Vec3; RING]> = (0..=tube.pieces).map(|r| ring(self, &tube, r)).collect();
        let halfway = |r: usize, k: usize| (rings[r][k] + rings[r + 1][k]) / 2.0;
        let mut vertices: Vec<Vec3> = rings.concat();
        vertices.extend((0..tube.pieces).flat_map(|r| [halfway(r, 0), halfway(r, 1)]));
        let faces: Vec<Vec<usize>> = (0..tube.pieces).flat_map(|r| faces(r, tube.pieces)).collect();
        let glue = (0..tube.pieces).flat_map(|r| glue(&faces[FACES * r], &vertices)).collect();
        let parts = Parts {
            title: "zipper-tubes",
            source: SOURCE,
            vertices,
            lattice: None,
            polygons: faces.iter().map(|face| face.iter().map(|&vertex| Corner::home(vertex)).collect()).collect(),
        };
        parts.glued(tube.words, glue)
    }
}

/// The vertices of a ring.
fn ring(tubes: &MiuraTubes, tube: &CoupledTube, r: usize) -> [Vec3; RING] {
    let [u, v] = tube.sides;
    let along = u / tubes.a;
    // the side v of the second tube, turned by 180 degrees about u
    let w = along * (2.0 * v.dot(&along)) - v;
    let way = if r.is_multiple_of(2) { 1.0 } else { -1.0 };
    let first = tube.place(r);
    let second = first + along * (way * tubes.b * libm::cos(tubes.sector));
    [first, first + u, first + u + v, first + v, second, second + u, second + u + w, second + w]
}

/// Number of faces between two rings.
const FACES: usize = 11;

/// The faces between two rings: what the tubes share of the wall where they touch, what each has of it alone, and the
/// other walls.
fn faces(r: usize, pieces: usize) -> Vec<Vec<usize>> {
    let (near, far) = (|k: usize| RING * r + k, |k: usize| RING * (r + 1) + k);
    let [m, n] = [0, 1].map(|k| RING * (pieces + 1) + 2 * r + k);
    // along a ridge, the ends of both tubes alternate
    let ridge = |r: usize| if r.is_multiple_of(2) { [0, 4, 1, 5] } else { [4, 0, 5, 1] };
    let [p, q] = [ridge(r).map(near), ridge(r + 1).map(far)];
    let walls = |k: usize| {
        [
            vec![near(k), m, far(k), far(k + 3), near(k + 3)],
            vec![near(k + 2), far(k + 2), far(k + 1), n, near(k + 1)],
            vec![near(k + 3), far(k + 3), far(k + 2), near(k + 2)],
        ]
    };
    let common = vec![p[1], p[2], n, q[2], q[1], m];
    let alone = [[p[0], p[1], m], [m, q[1], q[0]], [p[2], p[3], n], [n, q[3], q[2]]].map(Vec::from);
    [vec![common], alone.to_vec(), walls(0).to_vec(), walls(4).to_vec()].concat()
}

/// The joints at the four edges of the face that both tubes share, where three faces meet: a weld to the triangle beside it,
/// which belongs to one of the tubes, and a crease to the wall of the other tube. Triangle and wall are not joined.
fn glue(common: &[usize], vertices: &[Vec3]) -> [GluedEdge; 4] {
    let centre = common.iter().map(|&vertex| vertices[vertex]).sum::<Vec3>() / common.len() as f64;
    let &[near, near_too, n, far_too, far, m] = common else { return Default::default() };
    [[near, m], [near_too, n], [far, m], [far_too, n]].map(|[end, middle]| {
        let along = vertices[middle] - vertices[end];
        let wall = vertices[end / 4 * 4 + 3] - vertices[end / 4 * 4];
        // the order round the edge begins at the common face
        let wall_is_next = along.dot(&(centre - vertices[end]).cross(&wall)) > 0.0;
        let words = [Glue::Fold, Glue::Free, Glue::Weld];
        let words = if wall_is_next { words } else { [words[2], words[1], words[0]] };
        ([end, middle], words.to_vec())
    })
}
