//! A lower bound of the memory that a scene needs, from its numbers alone, before anything is built.

use std::ops::Range;

use super::spec::{DensitySpec, MapSpec, StudyKind, StudySpec};
use super::{Located, SceneError, SceneFile};
use crate::sheet::Sheet;
use crate::sheet::memory::free_memory;

/// Largest number of vertices: more would overflow the indices of the sparse matrices.
const MOST_VERTICES: f64 = 30_000_000.0;

/// Largest number of bytes that the numbers of a study may require on any machine.
const MOST_OF_STUDY: f64 = (24_u64 << 30) as f64;

/// Bytes for each vertex of the model: its edges and triangles, once for the studies and once for pictures.
const TILED_VERTEX: f64 = 1_500.0;
/// Bytes for each vertex of a model whose energy is relaxed: derivatives and their factors. The least of thirteen sheets
/// took 12,500 beside the tiled vertex, others about 20,000.
const RELAXED_VERTEX: f64 = 12_000.0;
/// Bytes for each wavenumber of a grid.
const WAVENUMBER: f64 = 16.0;
/// Bytes for each frequency at a wavenumber.
const FREQUENCY: f64 = 8.0;
/// Bytes for each bin of a density of states: its row of the table.
const BIN: f64 = 160.0;
/// Bytes for each random start.
const START: f64 = 32.0;
/// Bytes for each sample of a map: its direction, its triangles and its row.
const SAMPLE: f64 = 160.0;
/// Bytes for each direction of Poisson's ratios: its row of the table and its line of the file.
const DIRECTION: f64 = 200.0;

/// A part of a scene that needs memory.
struct Need {
    /// Description of the part and its size, for messages.
    what: String,
    /// Number of bytes.
    bytes: f64,
    /// The key whose value would have to be smaller, and its place.
    key: &'static str,
    span: Range<usize>,
}

/// Checks that the scene fits the index range and the free memory of this machine.
pub(super) fn check(file: &SceneFile, sheet: &Sheet) -> Result<(), SceneError> {
    let spec = &file.scene.sheet;
    let span = || spec.cells.as_ref().map_or(0..0, Located::span);
    let cells = if !sheet.is_repeated() { [1, 1] } else { spec.cells() };
    let vertices = cells.iter().fold(sheet.vertices.len() as f64, |product, &n| product * n as f64);
    let whose = if spec.is_one_cell() { "the pictures have" } else { "the model has" };
    let what = format!("{whose} {} vertices", shown(vertices));
    if vertices > MOST_VERTICES {
        return Err(file.error_at(span(), what, format!("at most {MOST_VERTICES} can be indexed")));
    }
    let relaxed = !spec.is_one_cell() && file.scene.studies.iter().any(|study| relaxes(&study.kind));
    let each = TILED_VERTEX + if relaxed { RELAXED_VERTEX } else { 0.0 };
    let free = free_memory();
    fits(file, Need { what, bytes: vertices * each, key: "cells", span: span() }, free)?;
    let densities = file.scene.studies.iter().flat_map(|study| of_density(study, sheet.vertices.len()));
    let mut needs = file.scene.studies.iter().filter_map(of_study).chain(densities);
    needs.try_for_each(|need| fits(file, need, free.min(MOST_OF_STUDY)))
}

/// Returns a whole number as messages show it: in full, or with two digits if it is very large.
fn shown(count: f64) -> String {
    if count < 1e15 { format!("{count:.0}") } else { format!("{count:.1e}") }
}

fn fits(file: &SceneFile, need: Need, room: f64) -> Result<(), SceneError> {
    if need.bytes <= room {
        return Ok(());
    }
    let [needed, room] = [need.bytes, room].map(|bytes| shown(bytes / 1e9));
    let message = format!("{}, which need at least {needed} GB; there is room for {room} GB", need.what);
    Err(file.error_at(need.span, message, format!("make `{}` smaller", need.key)))
}

/// Whether a study relaxes the whole model.
fn relaxes(kind: &StudyKind) -> bool {
    matches!(kind, StudyKind::Relax(_) | StudyKind::Wells(_) | StudyKind::Path(_))
}

/// Returns the memory that a study needs for the numbers among its own settings.
fn of_study(study: &StudySpec) -> Option<Need> {
    let name = &study.name.0;
    match &*study.kind {
        StudyKind::Bloch(bloch) => bloch.grid.as_ref().map(|grid| {
            let count: f64 = grid.0.iter().map(|&n| n as f64).product();
            let what = format!("the grid of `{name}` has {} wavenumbers", shown(count));
            Need { what, bytes: count * WAVENUMBER, key: "grid", span: grid.span() }
        }),
        StudyKind::Wells(wells) => wells.starts.as_ref().map(|starts| {
            let what = format!("`{name}` has {} starts", starts.0);
            Need { what, bytes: f64::from(starts.0) * START, key: "starts", span: starts.span() }
        }),
        StudyKind::Response(response) => response.directions.as_ref().map(|directions| {
            let what = format!("the ratios of `{name}` have {} directions", directions.0);
            let bytes = f64::from(directions.0) * DIRECTION;
            Need { what, bytes, key: "directions", span: directions.span() }
        }),
        StudyKind::Landscape(landscape) => landscape.map.as_ref().and_then(|map| of_map(name, map)),
        _ => None,
    }
}

/// Returns the memory that a density of states needs for its wavenumbers, with three frequencies for each vertex, and
/// its bins.
fn of_density(study: &StudySpec, vertices: usize) -> Vec<Need> {
    let StudyKind::Bloch(bloch) = &*study.kind else { return vec![] };
    let Some(DensitySpec { grid, bins }) = bloch.density.as_deref() else { return vec![] };
    let name = &study.name.0;
    let of_grid = grid.as_ref().map(|grid| {
        let count: f64 = grid.0.iter().map(|&n| n as f64).product();
        let what = format!("the density of states of `{name}` has {} wavenumbers", shown(count));
        let each = WAVENUMBER + 3.0 * FREQUENCY * vertices as f64;
        Need { what, bytes: count * each, key: "grid", span: grid.span() }
    });
    let of_bins = bins.as_ref().map(|bins| {
        let what = format!("the density of states of `{name}` has {} bins", bins.0);
        Need { what, bytes: f64::from(bins.0) * BIN, key: "bins", span: bins.span() }
    });
    of_grid.into_iter().chain(of_bins).collect()
}

fn of_map(name: &str, map: &MapSpec) -> Option<Need> {
    let rings = map.rings.as_ref()?;
    let samples = 8.0 * f64::from(rings.0) * f64::from(rings.0);
    let what = format!("the map of `{name}` has {} samples", shown(samples));
    Some(Need { what, bytes: samples * SAMPLE, key: "rings", span: rings.span() })
}
