//! The step from a sheet back to a mesh that draws its cell in full.

use std::collections::{BTreeMap, BTreeSet};

use super::Drawing;
use crate::sheet::assignment::Assignment;
use crate::sheet::cell::{Corner, Edge, EdgeKey, EdgeKind, Sheet};
use crate::sheet::sides::sides;

/// Returns the mesh that draws `sheet`: its vertices in their order, then the copies that faces and openings need, by
/// first appearance. [`build`](super::build) makes the same sheet from it.
pub fn draw(sheet: &Sheet) -> Drawing {
    let drawn_count = sheet.vertices.len() - sheet.cut_from.len();
    let mut numbers: BTreeMap<Corner, usize> = (0..drawn_count).map(|v| (Corner::home(v), v)).collect();
    let mut coords = sheet.vertices[..drawn_count].to_vec();
    let mut number = |corner: &Corner| {
        let corner = sheet.uncut(*corner);
        *numbers.entry(corner).or_insert_with(|| {
            coords.push(sheet.position(corner));
            coords.len() - 1
        })
    };
    let mut lists = |of: &[Vec<Corner>]| -> Vec<Vec<usize>> {
        of.iter().map(|corners| corners.iter().map(&mut number).collect()).collect()
    };
    let (faces, holes) = (lists(&sheet.polygons), lists(&sheet.holes));
    let bars = sheet.bars_alone().map(|edge| edge.key.ends().map(|end| number(&end))).collect();
    let named = |(name, corners): (&String, &Vec<Corner>)| {
        let list = corners.iter().filter_map(|corner| numbers.get(&sheet.uncut(*corner)).copied());
        (name.clone(), list.collect())
    };
    let names = sheet.names.iter().map(named).collect();
    let (assignments, fold_angles) = (assignments(sheet, &faces), fold_angles(sheet, &faces));
    let glue = on_sides(sheet, &faces, &sheet.glue);
    Drawing {
        title: sheet.title.clone(),
        description: sheet.description.clone(),
        coords,
        faces,
        lattice: sheet.lattice,
        screws: sheet.screws,
        holes,
        assignments,
        fold_angles,
        names,
        glue,
        bars,
        ..Drawing::default()
    }
}

/// Returns the sides of faces whose assignment cannot be seen in the drawing, with that assignment.
fn assignments(sheet: &Sheet, faces: &[Vec<usize>]) -> Vec<([usize; 2], Assignment)> {
    let joined = |edge: &&Edge| edge.kind == EdgeKind::Facet || sheet.assignments.contains_key(&edge.key);
    let told = sheet.edges.iter().filter(joined).map(|edge| (edge.key, sheet.assignment(edge))).collect();
    on_sides(sheet, faces, &told)
}

/// Returns the sides of faces that have target angles, with these angles.
fn fold_angles(sheet: &Sheet, faces: &[Vec<usize>]) -> Vec<([usize; 2], Option<f64>)> {
    on_sides(sheet, faces, &sheet.targets).into_iter().map(|(ends, angle)| (ends, Some(angle))).collect()
}

/// Returns each drawn side whose edge has a value once, with that value.
fn on_sides<T: Clone>(sheet: &Sheet, faces: &[Vec<usize>], told: &BTreeMap<EdgeKey, T>) -> Vec<([usize; 2], T)> {
    let mut seen = BTreeSet::new();
    let mut values = Vec::new();
    for (polygon, face) in sheet.polygons.iter().zip(faces) {
        for ([a, b], ends) in sides(polygon).zip(sides(face)) {
            let key = EdgeKey::new(a, b).0;
            let [i, j] = key.ends().map(|end| sheet.uncut(end));
            if let Some(value) = told.get(&key)
                && seen.insert(EdgeKey::new(i, j).0)
            {
                values.push((ends, value.clone()));
            }
        }
    }
    values
}
