//! GLB files, binary glTF 2.0: a state of a sheet for viewers, presentations and web pages.
//!
//! One mesh has the triangles, which have two sides, and the edges that are no diagonals, mountains red and valleys
//! blue. Positions are those of the state in single precision; a node turns z, which is up in the sheet, to y, which is
//! up in glTF.

use super::picture::Picture;
use crate::sheet::EdgeKind;
use serde_json::{Value, json};

/// Fold angle in radians from which an edge is drawn as a mountain or a valley.
const FOLDED_RAD: f64 = 1e-6;
/// Colours of the faces, and of edges that are mountains, valleys or neither, as red, green, blue and opacity in linear
/// light.
const COLOURS: [[f64; 4]; 4] =
    [[0.81, 0.76, 0.66, 1.0], [0.53, 0.04, 0.02, 1.0], [0.02, 0.13, 0.41, 1.0], [0.26, 0.23, 0.18, 1.0]];
/// Codes of glTF: the numbers of an array, what it is for, and what indices draw.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;
const LINES: u32 = 1;
const TRIANGLES: u32 = 4;

/// Returns the state as the bytes of a GLB file.
pub(crate) fn bytes(picture: &Picture) -> Vec<u8> {
    let points: Vec<[f32; 3]> = picture.points.iter().map(|p| [p.x as f32, p.y as f32, p.z as f32]).collect();
    let bound =
        |of: fn(f32, f32) -> f32| [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).reduce(of).unwrap_or(0.0));
    let mut binary: Vec<u8> = points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let mut views = vec![json!({ "buffer": 0, "byteOffset": 0, "byteLength": binary.len(), "target": VERTICES })];
    let mut accessors = vec![json!({
        "bufferView": 0, "componentType": FLOAT, "count": points.len(), "type": "VEC3", "min": bound(f32::min), "max": bound(f32::max),
    })];
    let mut primitives: Vec<Value> = Vec::new();
    let groups = [picture.triangles.as_flattened().to_vec(), edges(picture, -1), edges(picture, 1), edges(picture, 0)];
    for (material, indices) in groups.into_iter().enumerate().filter(|(_, indices)| !indices.is_empty()) {
        let (view, mode) = (views.len(), if material == 0 { TRIANGLES } else { LINES });
        views.push(
            json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": 4 * indices.len(), "target": INDICES }),
        );
        accessors.push(
            json!({ "bufferView": view, "componentType": UNSIGNED_INT, "count": indices.len(), "type": "SCALAR" }),
        );
        primitives
            .push(json!({ "attributes": { "POSITION": 0 }, "indices": view, "material": material, "mode": mode }));
        binary.extend(indices.iter().flat_map(|&point| (point as u32).to_le_bytes()));
    }
    let material = |colour| json!({ "doubleSided": true, "pbrMetallicRoughness": { "baseColorFactor": colour, "metallicFactor": 0 } });
    let header = json!({
        "asset": { "version": "2.0", "generator": "foldwell" },
        "scene": 0, "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "rotation": [-std::f64::consts::FRAC_1_SQRT_2, 0, 0, std::f64::consts::FRAC_1_SQRT_2] }],
        "meshes": [{ "primitives": primitives }],
        "materials": COLOURS.map(material),
        "buffers": [{ "byteLength": binary.len() }], "bufferViews": views, "accessors": accessors,
    });
    let mut text = header.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + binary.len();
    let number = |number: usize| (number as u32).to_le_bytes();
    let head = [b"glTF".as_slice(), &number(2), &number(length), &number(text.len()), b"JSON"].concat();
    [head, text, [&number(binary.len()), b"BIN\0".as_slice()].concat(), binary].concat()
}

/// Returns the ends of the edges that fold to this side: -1 for mountains, 1 for valleys, 0 for neither.
fn edges(picture: &Picture, side: i32) -> Vec<usize> {
    let side_of = |angle: f64| i32::from(angle > FOLDED_RAD) - i32::from(angle < -FOLDED_RAD);
    let edges = picture.lines.iter().zip(&picture.line_kinds).zip(&picture.fold_angle);
    let wanted = edges.filter(|((_, kind), angle)| **kind != EdgeKind::Facet && side_of(**angle) == side);
    wanted.flat_map(|((ends, _), _)| *ends).collect()
}
