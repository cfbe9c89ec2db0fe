//! Sheets for the tests of this module.

use super::Closure;
use crate::math::Vec3;
use crate::numerics::DenseMatrix;
use crate::numerics::dense::least_squares;
use crate::sheet::generate::Random;
use crate::sheet::{Corner, Edge, EdgeKey, EdgeKind, Pattern, Sheet, Triangle, generate};
use rand::{RngExt, SeedableRng};
use serde_json::Value;
use std::collections::{HashMap, VecDeque};

/// Fold angles, curvature, rotation angles and strain of a folded cylinder.
pub(crate) type Cylinder = (Vec<f64>, f64, Vec<f64>, Vec<f64>);

/// Returns random numbers in [-1, 1).
pub(crate) fn random_numbers(seed: u64, count: usize) -> Vec<f64> {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    (0..count).map(|_| rng.random_range(-1.0..1.0)).collect()
}

pub(crate) fn open_star() -> Sheet {
    from_fold(include_str!("../../tests/cases/open-star.fold"))
}

/// A cell that two screw motions repeat.
pub(crate) fn kresling_cell() -> Sheet {
    crate::sheet::fold::parse(include_str!("../../meshes/kresling-cell.fold"), "kresling-cell.fold").unwrap()
}

pub(crate) fn open_flat() -> Sheet {
    from_fold(include_str!("../../tests/cases/open-flat.fold"))
}

/// Returns Miura-ori, one cell of four triangulated parallelograms (sides 2, angle 60 degrees, folded by 15 degrees).
pub(crate) fn miura() -> Sheet {
    let (a, t, g) = (2.0, 60f64.to_radians(), 15f64.to_radians());
    let (q, h) = ((1.0 + (g.cos() * t.tan()).powi(2)).sqrt(), a * t.sin() * g.sin());
    let (s, v, l) = (a * g.cos() * t.tan() / q, a / q, a * (1.0 - (g.sin() * t.sin()).powi(2)).sqrt());
    let place = |i: usize, j: usize| Vec3::new(s * i as f64, l * j as f64 + v * (i % 2) as f64, h * (j % 2) as f64);
    let vertices = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, j]| place(i, j)).to_vec();
    let corner = |[i, j]: [usize; 2]| Corner { vertex: i % 2 + 2 * (j % 2), shift: [(i / 2) as i32, (j / 2) as i32] };
    let mut faces = Vec::new();
    for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let quad = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(corner);
        let shorter = if i % 2 == 0 { [[1, 2, 3], [1, 3, 0]] } else { [[0, 1, 2], [0, 2, 3]] };
        faces.extend(shorter.map(|face| face.map(|k: usize| quad[k])));
    }
    sheet("miura", vertices, Some([place(2, 0), place(0, 2)]), &faces)
}

/// Returns `m` x `n` squares, each of two triangles, with random heights; no lattice.
pub(crate) fn finite_grid(m: usize, n: usize, height: f64) -> Sheet {
    let heights = random_numbers(5, (m + 1) * (n + 1));
    let number = |i: usize, j: usize| i + (m + 1) * j;
    let place = |k: usize| Vec3::new((k % (m + 1)) as f64, (k / (m + 1)) as f64, height * heights[k]);
    let mut faces = Vec::new();
    for (i, j) in (0..m * n).map(|k| (k % m, k / m)) {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)].map(Corner::home);
        faces.extend([[a, b, c], [a, c, d]]);
    }
    sheet("grid", (0..(m + 1) * (n + 1)).map(place).collect(), None, &faces)
}

/// Returns a random cell one vertex wide: some of its edges join copies of the same vertex in two cells.
pub(crate) fn narrow() -> Sheet {
    let pattern = Random { size: [1, 3], height: 0.4, ..Random::default() };
    generate(&Pattern::Random(pattern)).unwrap()
}

/// Returns a column with five sides and two rows of triangles, in general position.
pub(crate) fn column() -> Sheet {
    let moved = random_numbers(8, 45);
    let place = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * (k % 5) as f64 / 5.0).sin_cos();
        Vec3::new(cos, sin, (k / 5) as f64) + 0.1 * Vec3::from_column_slice(&moved[3 * k..3 * k + 3])
    };
    let mut faces = Vec::new();
    for (row, k) in (0..10).map(|face| (face / 5, face % 5)) {
        let [a, b] = [5 * row + k, 5 * row + (k + 1) % 5];
        let [a, b, c, d] = [a, b, b + 5, a + 5].map(Corner::home);
        faces.extend([[a, b, c], [a, c, d]]);
    }
    sheet("column", (0..15).map(place).collect(), None, &faces)
}

/// Returns a ring of six triangles, with an opening that no vertex closes.
pub(crate) fn ring() -> Sheet {
    let place = |k: usize| {
        let turn = std::f64::consts::TAU * k as f64 / 6.0;
        Vec3::new(turn.cos(), turn.sin(), 0.0) * if k.is_multiple_of(2) { 1.0 } else { 2.0 }
    };
    let face = |k: usize| {
        let [a, b, c] = [k, (k + 1) % 6, (k + 2) % 6].map(Corner::home);
        if k.is_multiple_of(2) { [a, b, c] } else { [b, a, c] }
    };
    sheet("ring", (0..6).map(place).collect(), None, &[0, 1, 2, 3, 4, 5].map(face))
}

/// Returns a sheet of triangles.
pub fn sheet(title: &str, vertices: Vec<Vec3>, lattice: Option<[Vec3; 2]>, faces: &[[Corner; 3]]) -> Sheet {
    let triangles: Vec<Triangle> =
        faces.iter().enumerate().map(|(polygon, &corners)| Triangle { corners, polygon }).collect();
    let mut edges: Vec<Edge> = Vec::new();
    for side in triangles.iter().flat_map(Triangle::sides) {
        let number = edges.iter().position(|edge| edge.key == side.key).unwrap_or_else(|| {
            edges.push(Edge { key: side.key, kind: EdgeKind::Boundary, wings: [None; 2] });
            edges.len() - 1
        });
        edges[number].wings[side.side] = Some(side.opposite);
        if edges[number].wings.iter().all(Option::is_some) {
            edges[number].kind = EdgeKind::Crease;
        }
    }
    let polygons = faces.iter().map(|face| face.to_vec()).collect();
    let (title, description) = (title.to_string(), String::new());
    Sheet { title, description, vertices, lattice, polygons, triangles, edges, ..Sheet::default() }
}

fn from_fold(text: &str) -> Sheet {
    let file: Value = serde_json::from_str(text).unwrap();
    let drawn: Vec<Vec3> = points(&file["vertices_coords"]);
    let lattice: [Vec3; 2] = points(&file["foldwell:lattice"]).try_into().unwrap();
    let mut vertices: Vec<Vec3> = Vec::new();
    let corners: Vec<Corner> = drawn.iter().map(|point| identify(&mut vertices, *point, &lattice)).collect();
    let faces: Vec<[Corner; 3]> = file["faces_vertices"]
        .as_array()
        .unwrap()
        .iter()
        .map(|face| [0, 1, 2].map(|k| corners[face[k].as_u64().unwrap() as usize]))
        .collect();
    sheet(file["file_title"].as_str().unwrap(), vertices, Some(lattice), &faces)
}

fn identify(vertices: &mut Vec<Vec3>, point: Vec3, lattice: &[Vec3; 2]) -> Corner {
    for (vertex, home) in vertices.iter().enumerate() {
        for shift in (-1..=1).flat_map(|n1| [-1, 0, 1].map(|n2| [n1, n2])) {
            let copy = home + lattice[0] * f64::from(shift[0]) + lattice[1] * f64::from(shift[1]);
            if (copy - point).norm() < 1e-6 {
                return Corner { vertex, shift };
            }
        }
    }
    vertices.push(point);
    Corner::home(vertices.len() - 1)
}

fn points(value: &Value) -> Vec<Vec3> {
    value.as_array().unwrap().iter().map(|point| Vec3::from_row_slice(&floats(point))).collect()
}

fn floats(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// The numbers that an independent program found for `open-star`.
pub(crate) struct Reference(Value);

pub(crate) fn open_star_reference() -> Reference {
    Reference(serde_json::from_str(include_str!("../../tests/cases/open-star.json")).unwrap())
}

impl Reference {
    pub(crate) fn numbers(&self, key: &str) -> Vec<f64> {
        floats(&self.0[key])
    }

    /// Converts numbers per edge from the order of the reference to that of the sheet.
    pub(crate) fn in_sheet_order(&self, sheet: &Sheet, numbers: &[f64]) -> Vec<f64> {
        let list = self.0["edge_list"].as_array().unwrap();
        let find = |edge: &Edge| {
            let EdgeKey { i, j, shift: [n1, n2], .. } = edge.key;
            let name = serde_json::json!([i, j, n1, n2]);
            numbers[list.iter().position(|entry| *entry == name).unwrap()]
        };
        sheet.edges.iter().map(find).collect()
    }

    /// Returns the folded cylinders.
    pub(crate) fn states(&self, sheet: &Sheet) -> Vec<Cylinder> {
        let read = |state: &Value| {
            let kappa = state["kappa"].as_f64().unwrap();
            let angles = self.in_sheet_order(sheet, &floats(&state["fold_angles"]));
            (angles, kappa, floats(&state["theta"]), floats(&state["strain"]))
        };
        self.0["states"].as_array().unwrap().iter().map(read).collect()
    }

    /// Returns the fold angles of the folded cylinders.
    pub(crate) fn cylinders(&self, sheet: &Sheet) -> Vec<Vec<f64>> {
        let states = self.0["states"].as_array().unwrap();
        states.iter().map(|state| self.in_sheet_order(sheet, &floats(&state["fold_angles"]))).collect()
    }

    /// Returns the directions in which folding leaves the drawn state, with the signs of the curvature to which they
    /// lead.
    pub(crate) fn rays(&self, sheet: &Sheet) -> Vec<(Vec<f64>, f64)> {
        let loops = self.0["loops"].as_array().unwrap();
        let states = self.0["states"].as_array().unwrap();
        let same = |a: &Value, b: &Value| a["branch"] == b["branch"] && a["sign"] == b["sign"];
        let ray = |start: &Value| {
            let state = states.iter().find(|state| same(state, start)).unwrap();
            (self.in_sheet_order(sheet, &floats(&start["start"])), state["kappa"].as_f64().unwrap())
        };
        loops.iter().map(ray).collect()
    }
}

/// A face, and the cell into which it is translated from the sheet's list.
struct PlacedFace {
    face: usize,
    cell: [i32; 2],
}

/// Returns the positions of the vertices of cells -2 to 2, from the shapes of the faces and fold angles alone: each new
/// face is attached to an edge of a placed one, the first face is as drawn. The construction uses points, not motions,
/// and is therefore independent of the program's.
pub(crate) fn put_together(sheet: &Sheet, angles: &[f64]) -> HashMap<Corner, Vec3> {
    let first = sheet.triangles[0];
    let mut places: HashMap<Corner, Vec3> = first.corners.map(|c| (c, sheet.position(c))).into_iter().collect();
    let mut queue = VecDeque::from([PlacedFace { face: 0, cell: [0, 0] }]);
    while let Some(PlacedFace { face, cell }) = queue.pop_front() {
        let corners = sheet.triangles[face].corners.map(|corner| corner.translated(cell));
        for side in 0..3 {
            let [a, b, known] = [0, 1, 2].map(|k| corners[(side + k) % 3]);
            let (key, reversed) = EdgeKey::new(a, b);
            let edge = sheet.edges.iter().position(|edge| edge.key == key).unwrap();
            let home = if reversed { b } else { a };
            let Some(wing) = sheet.edges[edge].wings[usize::from(!reversed)] else { continue };
            let across = wing.translated(home.shift);
            if places.contains_key(&across) || across.shift.iter().any(|n| n.abs() > 2) {
                continue;
            }
            places.insert(across, hinge(sheet, [a, b, known, across], &places, angles[edge]));
            queue.push_back(find_face(sheet, [b, a, across]));
        }
    }
    places
}

/// Returns the position of the vertex `across` if the edge from `a` to `b`, with the known face on its left, has a
/// given fold angle: the foot of the vertex on the edge and its distance are as drawn.
fn hinge(sheet: &Sheet, [a, b, known, across]: [Corner; 4], at: &HashMap<Corner, Vec3>, angle: f64) -> Vec3 {
    let drawn = sheet.position(across) - sheet.position(a);
    let drawn_along = (sheet.position(b) - sheet.position(a)).normalize();
    let (foot, height) = (drawn.dot(&drawn_along), drawn.cross(&drawn_along).norm());
    let along = (at[&b] - at[&a]).normalize();
    let inner = at[&known] - at[&a];
    let inwards = (inner - along * inner.dot(&along)).normalize();
    let normal = along.cross(&inwards);
    at[&a] + along * foot + (normal * angle.sin() - inwards * angle.cos()) * height
}

fn find_face(sheet: &Sheet, corners: [Corner; 3]) -> PlacedFace {
    for (face, triangle) in sheet.triangles.iter().enumerate() {
        for turn in 0..3 {
            let [from, to] = [triangle.corners[turn].shift, corners[0].shift];
            let cell = [to[0] - from[0], to[1] - from[1]];
            if (0..3).all(|k| triangle.corners[(turn + k) % 3].translated(cell) == corners[k]) {
                return PlacedFace { face, cell };
            }
        }
    }
    panic!("no face with corners {corners:?}")
}

/// Returns fold angles brought to closure by steps of least norm, none longer than 0.2.
pub(crate) fn closed(closure: &Closure, mut angles: Vec<f64>) -> Vec<f64> {
    for _ in 0..200 {
        let residual = closure.residual(&angles);
        if residual.amax() <= 2e-15 {
            return angles;
        }
        let right = DenseMatrix::from_column_slice(residual.len(), 1, residual.as_slice());
        let step = least_squares(&closure.jacobian(&angles), &right).unwrap().solution;
        let part = (0.2 / step.norm()).min(1.0);
        closure.folding_edges().iter().zip(step.iter()).for_each(|(&edge, step)| angles[edge] -= part * step);
    }
    panic!("closure is left at {:e}", closure.residual(&angles).amax())
}
