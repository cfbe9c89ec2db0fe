//! A lower bound of the memory that a scene needs, from its numbers alone, before anything is built.

use std::ops::Range;

use super::spec::{DensitySpec, MapSpec, StudyKind, StudySpec};
use super::values::{Cells, Count};
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
    file.error_if(vertices > MOST_VERTICES, span(), &what, format!("at most {MOST_VERTICES} can be indexed"))?;
    let relaxed = !spec.is_one_cell() && file.scene.studies.iter().any(|study| relaxes(&study.kind));
    let each = TILED_VERTEX + if relaxed { RELAXED_VERTEX } else { 0.0 };
    let free = free_memory();
    fits(file, Need { what, bytes: vertices * each, key: "cells", span: span() }, free)?;
    let mut needs = file.scene.studies.iter().flat_map(|study| of_study(study, sheet.vertices.len()));
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

/// Returns the memory that a study needs for the numbers among its own settings; a density of states has three
/// frequencies for each vertex at its wavenumbers.
fn of_study(study: &StudySpec, vertices: usize) -> impl Iterator<Item = Need> {
    let name = &study.name.0;
    let grid = |given: &Option<Located<Cells>>, whose: &str, each: f64| {
        let grid = given.as_ref()?;
        let count: f64 = grid.0.iter().map(|&n| n as f64).product();
        let what = format!("the {whose} of `{name}` has {} wavenumbers", shown(count));
        Some(Need { what, bytes: count * each, key: "grid", span: grid.span() })
    };
    let number = |given: &Option<Located<Count>>, what: String, key: &'static str, each: f64| {
        let number = given.as_ref()?;
        let what = format!("{what} {} {key}", number.0);
        Some(Need { what, bytes: f64::from(number.0) * each, key, span: number.span() })
    };
    let needs = match &*study.kind {
        StudyKind::Bloch(bloch) => {
            let density = bloch.density.as_deref();
            let each = WAVENUMBER + 3.0 * FREQUENCY * vertices as f64;
            let bins = |density: &DensitySpec| {
                number(&density.bins, format!("the density of states of `{name}` has"), "bins", BIN)
            };
            let of_density = density.and_then(|density| grid(&density.grid, "density of states", each));
            vec![grid(&bloch.grid, "grid", WAVENUMBER), of_density, density.and_then(bins)]
        }
        StudyKind::Wells(wells) => vec![number(&wells.starts, format!("`{name}` has"), "starts", START)],
        StudyKind::Response(response) => {
            vec![number(&response.directions, format!("the ratios of `{name}` have"), "directions", DIRECTION)]
        }
        StudyKind::Landscape(landscape) => vec![landscape.map.as_ref().and_then(|map| of_map(name, map))],
        _ => vec![],
    };
    needs.into_iter().flatten()
}

fn of_map(name: &str, map: &MapSpec) -> Option<Need> {
    let rings = map.rings.as_ref()?;
    let samples = 8.0 * f64::from(rings.0) * f64::from(rings.0);
    let what = format!("the map of `{name}` has {} samples", shown(samples));
    Some(Need { what, bytes: samples * SAMPLE, key: "rings", span: rings.span() })
}
