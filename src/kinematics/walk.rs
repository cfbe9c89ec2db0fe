//! A walk over the faces: the rigid motions of every face and from one cell to the next, computed from fold angles.
//!
//! Every face is moved from its drawn position to its present one by a rigid motion `M`. Across an edge with the fold
//! angle `rho`, drawn with `rho0`, the next face is rotated in addition by `rho - rho0` about the edge as drawn:
//! `M_next = M * turn(edge, rho - rho0)` (valley positive; counter-clockwise about the edge from its first to its
//! second end if the step is from the right to the left face). A tree of such steps reaches every face of the cell
//! once. Each remaining edge leads from a face `f` to the copy of a face `g` in the cell `n`, and closes a loop: the
//! motion from the sheet to its copy there is `A = M_f * turn * D_n * M_g^-1`, with the motion `D_n` of the drawing
//! from cell (0, 0) to the cell `n`: a translation, or a screw motion where the sheet is drawn rolled up. Products of a
//! few loops give the two lattice motions; all other loops must agree with them, which is the compatibility of the
//! angles.

use super::KinematicsError;
use super::error::check_surface;
use super::motion::{Line, Motion, Rigid};
use crate::math::{Vec3, rotation};
use crate::sheet::{Corner, EdgeKey, Sheet};
use std::collections::{HashMap, VecDeque};

/// The step from a face across an edge to the next face, with the edge as drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// Number of the edge.
    pub edge: usize,
    /// Faces before and behind the edge.
    pub faces: [usize; 2],
    /// The line of the edge; a counter-clockwise rotation about it folds the edge to a valley.
    pub line: Line,
}

/// An edge that is not in the tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Loop {
    /// The step across the edge.
    pub crossing: Crossing,
    /// Cell of the copy of the face behind the edge.
    pub cell: [i32; 2],
    /// Drawn motion from cell (0, 0) to that cell.
    pub drawn: Motion,
}

/// The tree, the loops, and the products of loops that give the lattice motions. Drawn positions have vertex 0 as
/// origin.
#[derive(Clone, Debug)]
pub(crate) struct FaceWalk {
    /// Cell into which every face of the sheet's list is translated so that the faces are connected. The walk starts at
    /// the first face with vertex 0, translated so that this vertex is in cell (0, 0).
    pub cells: Vec<[i32; 2]>,
    /// Steps of the tree, ordered so that a face is reached before steps start from it.
    pub steps: Vec<Crossing>,
    /// Edges that are not in the tree.
    pub loops: Vec<Loop>,
    /// Loops whose product, from left to right, is a lattice motion; `true` denotes the inverse of a loop.
    words: Option<[Vec<(usize, bool)>; 2]>,
}

/// The result of a walk.
#[derive(Clone, Debug)]
pub(crate) struct Walked<M> {
    /// Motions from the drawn to the present position, for every face.
    pub faces: Vec<M>,
    /// Motions from the sheet to its copy, for every loop.
    pub loops: Vec<M>,
    /// Motions from a cell to the next, along both lattice vectors; `None` for a finite sheet.
    pub lattice: Option<[M; 2]>,
}

/// A face at an edge, and the cell of the edge's first vertex if the face is in the position of the sheet's list.
#[derive(Clone, Copy)]
struct FaceAtEdge {
    face: usize,
    base: [i32; 2],
}

impl FaceWalk {
    /// Plans a walk over a sheet.
    ///
    /// Fails if the faces are not connected, or, on a periodic sheet, not along both directions of the lattice.
    pub(crate) fn new(sheet: &Sheet) -> Result<Self, KinematicsError> {
        check_surface(sheet)?;
        let faces = sheet.triangles.len();
        let disconnected = || KinematicsError::Disconnected { faces };
        let (root, start) = first_with_vertex_0(sheet).ok_or_else(disconnected)?;
        let seats = seats(sheet);
        let mut plan = WalkBuilder { sheet, seats: &seats, cells: vec![None; faces], steps: Vec::new() };
        plan.cells[root] = Some(start);
        plan.spread(root);
        let loops = plan.loops();
        let steps = plan.steps;
        let cells: Vec<[i32; 2]> = plan.cells.into_iter().collect::<Option<_>>().ok_or_else(disconnected)?;
        let shifts: Vec<[i32; 2]> = loops.iter().map(|closing| closing.cell).collect();
        let word = |cell: [i32; 2]| word(&shifts, cell).ok_or_else(disconnected);
        let words = if sheet.is_repeated() { Some([word([1, 0])?, word([0, 1])?]) } else { None };
        Ok(Self { cells, steps, loops, words })
    }

    /// Walks over the faces; `turn` returns the motion of the rotation about a drawn edge.
    pub(crate) fn walk<M: Rigid>(&self, turn: impl Fn(&Crossing) -> M) -> Walked<M> {
        let mut faces = vec![M::identity(); self.cells.len()];
        for step in &self.steps {
            let [from, to] = step.faces;
            faces[to] = faces[from] * turn(step);
        }
        let closing = |Loop { crossing, drawn, .. }: &Loop| {
            let [from, to] = crossing.faces.map(|face| faces[face]);
            from * turn(crossing) * M::constant(*drawn) * to.inverse()
        };
        let loops: Vec<M> = self.loops.iter().map(closing).collect();
        let product = |word: &Vec<(usize, bool)>| {
            let factors = word.iter().map(|&(k, back)| if back { loops[k].inverse() } else { loops[k] });
            factors.reduce(|done, next| done * next).unwrap_or_else(M::identity)
        };
        let lattice = self.words.as_ref().map(|[first, second]| [product(first), product(second)]);
        Walked { faces, loops, lattice }
    }
}

/// A plan under construction.
struct WalkBuilder<'a> {
    sheet: &'a Sheet,
    seats: &'a [[Option<FaceAtEdge>; 2]],
    cells: Vec<Option<[i32; 2]>>,
    steps: Vec<Crossing>,
}

impl WalkBuilder<'_> {
    /// Extends the tree breadth first from a face to all faces that are connected with it.
    fn spread(&mut self, root: usize) {
        let mut doors = vec![Vec::new(); self.cells.len()];
        for (edge, sides) in self.seats.iter().enumerate() {
            for side in [0, 1] {
                if let (Some(here), Some(there)) = (sides[side], sides[1 - side]) {
                    doors[here.face].push((edge, side, here, there));
                }
            }
        }
        let mut queue = VecDeque::from([root]);
        while let Some(face) = queue.pop_front() {
            for &(edge, side, here, there) in &doors[face] {
                if let (Some(cell), None) = (self.cells[face], self.cells[there.face]) {
                    let base = sum(cell, here.base);
                    self.cells[there.face] = Some(difference(base, there.base));
                    self.steps.push(self.crossing(edge, side, base, [face, there.face]));
                    queue.push_back(there.face);
                }
            }
        }
    }

    /// Returns the edges with two faces that are not in the tree, with steps from right to left.
    fn loops(&self) -> Vec<Loop> {
        let mut used = vec![false; self.seats.len()];
        self.steps.iter().for_each(|step| used[step.edge] = true);
        let mut loops = Vec::new();
        for (edge, sides) in self.seats.iter().enumerate().filter(|(edge, _)| !used[*edge]) {
            let [Some(left), Some(right)] = *sides else { continue };
            let (Some(to), Some(from)) = (self.cells[left.face], self.cells[right.face]) else { continue };
            let base = sum(from, right.base);
            let crossing = self.crossing(edge, 1, base, [right.face, left.face]);
            let cell = difference(difference(base, left.base), to);
            loops.push(Loop { crossing, cell, drawn: drawn_motion(self.sheet, cell) });
        }
        loops
    }

    /// Returns the step across an edge from its left (0) or right (1) side, with its first vertex in the cell `base`.
    fn crossing(&self, edge: usize, side: usize, base: [i32; 2], faces: [usize; 2]) -> Crossing {
        let [i, j] = self.sheet.edges[edge].key.ends().map(|end| relative(self.sheet, end.translated(base)));
        let along = (j - i).normalize();
        Crossing { edge, faces, line: Line { point: i, direction: if side == 1 { along } else { -along } } }
    }
}

/// Returns the drawn position of a corner relative to vertex 0.
pub(crate) fn relative(sheet: &Sheet, corner: Corner) -> Vec3 {
    sheet.position(corner) - sheet.position(Corner::home(0))
}

/// Returns the motion from cell (0, 0) to another cell as drawn.
fn drawn_motion(sheet: &Sheet, cell: [i32; 2]) -> Motion {
    let turn = sheet.screws.map_or(0.0, |screws| screws.turn_of(cell));
    let translation = relative(sheet, Corner { vertex: 0, shift: cell });
    Motion { rotation: rotation::exp(&(turn * Vec3::z())), translation }
}

/// Returns the first face that has vertex 0, and the cell into which it is translated so that this vertex is in cell
/// (0, 0).
fn first_with_vertex_0(sheet: &Sheet) -> Option<(usize, [i32; 2])> {
    let find = |corners: &[Corner; 3]| corners.iter().find(|corner| corner.vertex == 0).map(|corner| corner.shift);
    let mut faces = sheet.triangles.iter().enumerate();
    faces.find_map(|(face, triangle)| find(&triangle.corners).map(|shift| (face, shift.map(|n| -n))))
}

/// Returns the faces on the left and on the right of every edge.
fn seats(sheet: &Sheet) -> Vec<[Option<FaceAtEdge>; 2]> {
    let number: HashMap<EdgeKey, usize> = sheet.edges.iter().enumerate().map(|(k, edge)| (edge.key, k)).collect();
    let mut seats = vec![[None; 2]; sheet.edges.len()];
    for (face, triangle) in sheet.triangles.iter().enumerate() {
        for side in triangle.sides() {
            if let Some(&edge) = number.get(&side.key) {
                seats[edge][side.side] = Some(FaceAtEdge { face, base: side.base.shift });
            }
        }
    }
    seats
}

/// Returns the shortest sequence of loops that leads to the cell `target`, by a breadth-first search over the cells.
///
/// Steps can be ordered so that they stay as close to the straight line as twice the longest of them.
fn word(shifts: &[[i32; 2]], target: [i32; 2]) -> Option<Vec<(usize, bool)>> {
    let reach = 1 + 2 * shifts.iter().flatten().map(|n| n.abs()).max().unwrap_or(0);
    let mut words = HashMap::from([([0, 0], Vec::new())]);
    let mut queue = VecDeque::from([[0, 0]]);
    while let Some(cell) = queue.pop_front() {
        if cell == target {
            return words.remove(&cell);
        }
        for (k, &shift) in shifts.iter().enumerate() {
            for (next, back) in [(sum(cell, shift), false), (difference(cell, shift), true)] {
                if next.iter().all(|n| n.abs() <= reach) && !words.contains_key(&next) {
                    let longer = words[&cell].iter().copied().chain([(k, back)]).collect();
                    words.insert(next, longer);
                    queue.push_back(next);
                }
            }
        }
    }
    None
}

fn sum(a: [i32; 2], b: [i32; 2]) -> [i32; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

fn difference(a: [i32; 2], b: [i32; 2]) -> [i32; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: if only several loops together reach a neighbour, as few as possible are combined; if they reach only
    /// every other cell, there is no sequence.
    #[test]
    fn words_reach_the_neighbours() {
        assert_eq!(word(&[[0, 0], [1, 0], [0, 1]], [0, 1]), Some(vec![(2, false)]));
        assert_eq!(word(&[[-1, 0]], [1, 0]), Some(vec![(0, true)]));
        let steps = word(&[[2, 0], [5, 0], [3, 1]], [1, 0]).unwrap();
        assert_eq!(steps.len(), 3, "5 - 2 - 2");
        assert_eq!(word(&[[2, 0], [0, 1]], [1, 0]), None);
        assert_eq!(word(&[], [1, 0]), None);
    }
}
