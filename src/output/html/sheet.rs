//! The states of a study on a page: a mesh for all of them, and positions and cell arrays for each.

use serde::Serialize;

use super::numbers::{Arrays, scale};
use crate::math::{Vec3, bounds};
use crate::output::figure::projection::Projection;
use crate::output::picture::{OnLines, Picture};
use crate::output::sequence::{Sequence, places, sequences};

/// A state of a study: the row of its table that describes it, if one does, and its picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Numbered<'a> {
    pub row: Option<usize>,
    pub picture: &'a Picture,
}

/// The states of a study.
#[derive(Debug, Serialize)]
pub(super) struct SheetData {
    /// The unit of positions: half of the diagonal of the box around the largest state.
    size: f64,
    /// Direction from the sheet to the eye, and normal of the sheet, of the first view.
    toward: [f64; 3],
    normal: [f64; 3],
    /// Whether the displacements are velocities of a mode, to be shown with an amplitude.
    moving: bool,
    meshes: Vec<Mesh>,
    fields: Vec<LineQuantity>,
    states: Vec<StateData>,
    sequences: Vec<Sequence>,
}

/// Triangles and lines between points; all numbers are places of arrays.
#[derive(Debug, PartialEq, Serialize)]
struct Mesh {
    triangles: usize,
    lines: usize,
    /// Edge of the cell of which each line is a copy.
    edges: usize,
    /// 0 for creases, 1 for facets, 2 for boundaries.
    kinds: usize,
    /// Letters by their numbers: 1 for M, 2 for V.
    letters: usize,
}

/// A quantity on the lines, and its range over all states.
#[derive(Debug, Serialize)]
struct LineQuantity {
    name: &'static str,
    scale: f64,
    low: f64,
    high: f64,
}

#[derive(Debug, Serialize)]
struct StateData {
    row: Option<usize>,
    mesh: usize,
    /// The middle of the box around this state, relative to that of the first one. Positions are relative to it.
    offset: [f64; 3],
    /// Places of the positions and, of a mode, of the displacements.
    points: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    displacement: Option<usize>,
    /// Place of the marks of triangles that pass through others; absent if there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    crossing: Option<usize>,
    /// The values of each field.
    values: Vec<ValuePlaces>,
}

/// The places of the values of a field: one value for each line, or, where all copies of an edge have the same, one for
/// each edge of the cell.
#[derive(Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
enum ValuePlaces {
    Line(usize),
    Edge(usize),
}

impl SheetData {
    /// Collects states; `None` if there is none. `table` is the text of the table of the study, whose columns `branch`
    /// and `sign` tell trajectories apart.
    pub(super) fn new(arrays: &mut Arrays, states: &[Numbered<'_>], table: Option<&str>, moving: bool) -> Option<Self> {
        let first = states.first()?.picture;
        let extents: Vec<(Vec3, f64)> = states.iter().map(|state| extent(&state.picture.points)).collect();
        let size = scale(extents.iter().map(|(_, size)| *size));
        let view = Projection::of(&first.points, &first.triangles);
        let fields: Vec<_> = Picture::FIELDS
            .iter()
            .filter_map(|&(name, get)| Some((LineQuantity::new(name, get, states)?, get)))
            .collect();
        let mut meshes: Vec<Mesh> = Vec::new();
        let mut state = |(&Numbered { row, picture }, &(centre, _)): (&Numbered<'_>, &(Vec3, f64))| {
            let mesh = Mesh::new(arrays, picture);
            let known = meshes.iter().position(|other| *other == mesh).unwrap_or(meshes.len());
            if known == meshes.len() {
                meshes.push(mesh);
            }
            let crosses = picture.self_intersecting.iter().any(|&mark| mark > 0);
            StateData {
                row,
                mesh: known,
                offset: ((centre - extents[0].0) / size).into(),
                points: vectors(arrays, picture.points.iter().map(|point| (point - centre) / size)),
                displacement: moving.then(|| vectors(arrays, picture.displacement.iter().map(|point| point / size))),
                crossing: crosses.then(|| arrays.marks(&picture.self_intersecting)),
                values: fields
                    .iter()
                    .map(|(field, get)| ValuePlaces::new(arrays, picture, get(picture), field.scale))
                    .collect(),
            }
        };
        let data = states.iter().zip(&extents).map(&mut state).collect();
        Some(Self {
            size,
            toward: view.toward.into(),
            normal: view.normal.into(),
            moving,
            states: data,
            meshes,
            fields: fields.into_iter().map(|(field, _)| field).collect(),
            sequences: orders(states, table),
        })
    }
}

/// Returns the sequences in which the states are shown.
fn orders(states: &[Numbered<'_>], table: Option<&str>) -> Vec<Sequence> {
    let places = places(table, states.iter().map(|state| state.row));
    let placed: Vec<_> = places.into_iter().zip(states.iter().map(|state| state.picture.points.as_slice())).collect();
    sequences(&placed)
}

/// Returns the middle of the box around points, and half of its diagonal; points that are not finite are left out.
fn extent(points: &[Vec3]) -> (Vec3, f64) {
    let finite = points.iter().filter(|point| point.iter().all(|x| x.is_finite()));
    let [low, high] = bounds(finite);
    if low.x > high.x {
        return (Vec3::zeros(), 0.0);
    }
    // halved before they are added or squared, so that coordinates of any size have a middle and a size
    let (low, high) = (low * 0.5, high * 0.5);
    let half = scale((high - low).iter().copied());
    (low + high, half * ((high - low) / half).norm())
}

fn vectors(arrays: &mut Arrays, points: impl Iterator<Item = Vec3>) -> usize {
    arrays.floats(points.flat_map(|point| [point.x, point.y, point.z]).map(|x| x as f32))
}

impl Mesh {
    fn new(arrays: &mut Arrays, picture: &Picture) -> Self {
        Self {
            triangles: arrays.indices(picture.triangles.iter().flatten().copied()),
            lines: arrays.indices(picture.lines.iter().flatten().copied()),
            edges: arrays.indices(picture.line_edges.iter().map(|&edge| edge.max(0) as usize)),
            kinds: arrays.indices(picture.line_kinds.iter().map(|kind| *kind as usize)),
            letters: arrays.indices(picture.letters.iter().map(|letter| letter.number())),
        }
    }
}

impl LineQuantity {
    /// Returns a field with its range over all states; `None` if it has no finite value.
    fn new(name: &'static str, get: OnLines, states: &[Numbered<'_>]) -> Option<Self> {
        let values = || states.iter().flat_map(|state| get(state.picture)).copied().filter(|value| value.is_finite());
        let low = values().min_by(f64::total_cmp)?;
        let high = values().max_by(f64::total_cmp)?;
        Some(Self { name, scale: scale(values()), low, high })
    }
}

impl ValuePlaces {
    fn new(arrays: &mut Arrays, picture: &Picture, values: &[f64], scale: f64) -> Self {
        let on_lines: Vec<f32> = values.iter().map(|value| (value / scale) as f32).collect();
        let count = picture.line_edges.iter().map(|&edge| edge.max(0) as usize + 1).max().unwrap_or(0);
        let mut on_edges = vec![None; count];
        let alike =
            picture.line_edges.iter().zip(&on_lines).all(|(&edge, &value)| {
                on_edges[edge.max(0) as usize].get_or_insert(value).to_bits() == value.to_bits()
            });
        if alike && count < on_lines.len() {
            Self::Edge(arrays.floats(on_edges.into_iter().map(|value| value.unwrap_or(f32::NAN))))
        } else {
            Self::Line(arrays.floats(on_lines.into_iter()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::test_samples as samples;

    fn data(pictures: &[Picture]) -> (SheetData, Vec<String>) {
        let states: Vec<Numbered<'_>> =
            pictures.iter().enumerate().map(|(row, picture)| Numbered { row: Some(row), picture }).collect();
        let mut arrays = Arrays::default();
        (SheetData::new(&mut arrays, &states, None, false).unwrap(), arrays.into_texts())
    }

    /// Claim: states of one sheet share a mesh, fields have the range of all states, and marks are there only where a
    /// face passes through another one.
    #[test]
    fn states_share_their_mesh() {
        let flat = Picture { self_intersecting: vec![0, 0], ..samples::hinge(0.0) };
        let (sheet, _) = data(&[flat, samples::hinge(-0.5), samples::hinge(0.25)]);
        assert_eq!((sheet.meshes.len(), sheet.states.len(), sheet.sequences.len()), (1, 3, 1));
        let angle = sheet.fields.iter().find(|field| field.name == "fold_angle").unwrap();
        assert_eq!((angle.low, angle.high, angle.scale), (-0.5, 0.25, 0.5));
        assert_eq!(sheet.states.iter().map(|state| state.crossing.is_some()).collect::<Vec<_>>(), [false, true, true]);
    }

    /// Claim: a quantity that all copies of an edge share is stored once for each edge of the cell, and one that they
    /// do not share for each line.
    #[test]
    fn copies_of_an_edge_share_their_values() {
        let mut picture = samples::hinge(0.5);
        picture.line_edges = vec![0, 1, 1, 1, 1];
        picture.strain = vec![0.1, 0.2, 0.2, 0.2, 0.2];
        picture.energy = vec![0.1, 0.2, 0.2, 0.2, 0.3];
        let mut arrays = Arrays::default();
        let mut of = |values: &[f64]| ValuePlaces::new(&mut arrays, &picture, values, 1.0);
        assert!(
            matches!(of(&picture.strain), ValuePlaces::Edge(_)) && matches!(of(&picture.energy), ValuePlaces::Line(_))
        );
        assert!(matches!(of(&picture.fold_angle), ValuePlaces::Edge(_)));
    }

    /// Claim: every state is in its own middle, and knows how far that is from the middle of the first one.
    #[test]
    fn states_are_about_their_middles() {
        let mut moved = samples::hinge(0.5);
        moved.points.iter_mut().for_each(|point| point.x += 8.0);
        let (sheet, arrays) = data(&[samples::hinge(0.5), moved]);
        assert_eq!(sheet.states[0].points, sheet.states[1].points, "{arrays:?}");
        assert_eq!((sheet.states[0].offset, sheet.states[1].offset), ([0.0; 3], [8.0 / sheet.size, 0.0, 0.0]));
    }

    /// Claim: sheets far from the origin and of any size keep their shape in single precision, since positions are
    /// relative to their middle and their size; points that are not finite do not spoil the others. Tolerance: rounding
    /// of coordinates of 1e6 times the size in double precision, 1e-9.
    #[test]
    fn any_place_and_any_size() {
        for (far, unit) in [(0.0, 1e-200), (0.0, 1e200), (1e6, 1.0), (0.0, 8e307)] {
            let mut picture = samples::hinge(0.5);
            picture.points.iter_mut().for_each(|point| *point = *point * unit + Vec3::repeat(far));
            let plain = extent(&samples::hinge(0.5).points);
            let (centre, size) = extent(&picture.points);
            assert!((size / unit / plain.1 - 1.0).abs() <= 1e-9, "{size}");
            assert!(((centre - Vec3::repeat(far)) / unit - plain.0).norm() <= 1e-9, "{centre}");
            picture.points.push(Vec3::repeat(f64::NAN));
            assert_eq!(extent(&picture.points), (centre, size));
        }
        assert_eq!(extent(&[]), (Vec3::zeros(), 0.0));
        let (_, arrays) = data(&[Picture::default()]);
        assert!(!arrays.is_empty());
    }
}
