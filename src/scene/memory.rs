//! A lower bound of the memory that a scene needs, from its numbers alone, before anything is built.

use std::ops::Range;

use super::spec::{DensitySpec, MapSpec, StudyKind, StudySpec};
use super::{Located, SceneError, SceneFile};
use crate::sheet::Sheet;

/// Largest number of vertices: more would overflow the indices of the sparse matrices.
const MOST_VERTICES: u64 = 30_000_000;

/// Bytes that are assumed to be free if the operating system does not report them.
const USUAL_MEMORY: u64 = 16 << 30;

/// Largest number of bytes that the numbers of a study may require on any machine.
const MOST_OF_STUDY: u64 = 24 << 30;

/// Bytes for each vertex of the model: its edges and triangles, once for the studies and once for pictures.
const TILED_VERTEX: u64 = 1_500;
/// Bytes for each vertex of a model whose energy is relaxed: derivatives and their factors.
const RELAXED_VERTEX: u64 = 8_000;
/// Bytes for each wavenumber of a grid.
const WAVENUMBER: u64 = 16;
/// Bytes for each frequency at a wavenumber.
const FREQUENCY: u64 = 8;
/// Bytes for each bin of a density of states: its row of the table.
const BIN: u64 = 160;
/// Bytes for each random start.
const START: u64 = 32;
/// Bytes for each sample of a map: its direction, its triangles and its row.
const SAMPLE: u64 = 160;

/// A part of a scene that needs memory.
struct Need {
    /// Description of the part and its size, for messages.
    what: String,
    /// Number of bytes.
    bytes: u64,
    /// The key whose value would have to be smaller, and its place.
    key: &'static str,
    span: Range<usize>,
}

/// Checks that the scene fits the index range and the free memory of this machine.
pub(super) fn check(file: &SceneFile, sheet: &Sheet) -> Result<(), SceneError> {
    let spec = &file.scene.sheet;
    let span = || spec.cells.as_ref().map_or(0..0, Located::span);
    let cells = if !sheet.is_repeated() { [1, 1] } else { spec.cells() };
    let vertices = cells.iter().fold(sheet.vertices.len() as u64, |product, &n| product.saturating_mul(n as u64));
    let whose = if spec.is_one_cell() { "the pictures have" } else { "the model has" };
    if vertices > MOST_VERTICES {
        let message = format!("{whose} {vertices} vertices");
        return Err(file.error_at(span(), message, format!("at most {MOST_VERTICES} can be indexed")));
    }
    let relaxed = !spec.is_one_cell() && file.scene.studies.iter().any(|study| relaxes(&study.kind));
    let each = TILED_VERTEX + if relaxed { RELAXED_VERTEX } else { 0 };
    let model =
        Need { what: format!("{whose} {vertices} vertices"), bytes: vertices * each, key: "cells", span: span() };
    let free = free_memory();
    fits(file, model, free)?;
    let densities = file.scene.studies.iter().flat_map(|study| of_density(study, sheet.vertices.len()));
    let mut needs = file.scene.studies.iter().filter_map(of_study).chain(densities);
    needs.try_for_each(|need| fits(file, need, free.min(MOST_OF_STUDY)))
}

fn fits(file: &SceneFile, need: Need, room: u64) -> Result<(), SceneError> {
    if need.bytes <= room {
        return Ok(());
    }
    let [needed, room] = [need.bytes, room].map(|bytes| bytes as f64 / 1e9);
    let message = format!("{}, which need at least {needed:.0} GB; there is room for {room:.0} GB", need.what);
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
            let count = grid.0.iter().fold(1u64, |product, &n| product.saturating_mul(n as u64));
            let what = format!("the grid of `{name}` has {count} wavenumbers");
            Need { what, bytes: count.saturating_mul(WAVENUMBER), key: "grid", span: grid.span() }
        }),
        StudyKind::Wells(wells) => wells.starts.as_ref().map(|starts| {
            let count = u64::from(starts.0);
            let what = format!("`{name}` has {count} starts");
            Need { what, bytes: count.saturating_mul(START), key: "starts", span: starts.span() }
        }),
        StudyKind::Landscape(landscape) => landscape.map.as_ref().and_then(|map| of_map(name, map)),
        _ => None,
    }
}

/// Returns the memory that a density of states needs for its wavenumbers, with three frequencies for each vertex, and its bins.
fn of_density(study: &StudySpec, vertices: usize) -> Vec<Need> {
    let StudyKind::Bloch(bloch) = &*study.kind else { return vec![] };
    let Some(DensitySpec { grid, bins }) = bloch.density.as_deref() else { return vec![] };
    let name = &study.name.0;
    let of_grid = grid.as_ref().map(|grid| {
        let count = grid.0.iter().fold(1u64, |product, &n| product.saturating_mul(n as u64));
        let what = format!("the density of states of `{name}` has {count} wavenumbers");
        let each = WAVENUMBER + 3 * FREQUENCY * vertices as u64;
        Need { what, bytes: count.saturating_mul(each), key: "grid", span: grid.span() }
    });
    let of_bins = bins.as_ref().map(|bins| {
        let what = format!("the density of states of `{name}` has {} bins", bins.0);
        Need { what, bytes: u64::from(bins.0).saturating_mul(BIN), key: "bins", span: bins.span() }
    });
    of_grid.into_iter().chain(of_bins).collect()
}

fn of_map(name: &str, map: &MapSpec) -> Option<Need> {
    let rings = map.rings.as_ref()?;
    let samples = u64::from(rings.0).saturating_mul(u64::from(rings.0)).saturating_mul(8);
    let what = format!("the map of `{name}` has {samples} samples");
    Some(Need { what, bytes: samples.saturating_mul(SAMPLE), key: "rings", span: rings.span() })
}

/// Returns the number of bytes of memory that are available to programs.
fn free_memory() -> u64 {
    let text = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    available(&text).unwrap_or(USUAL_MEMORY)
}

/// Reads the line `MemAvailable: N kB` of `/proc/meminfo`.
fn available(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    Some(line.split_whitespace().next()?.parse::<u64>().ok()?.saturating_mul(1024))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: the line of the kernel is read in kB, and other texts give no number.
    #[test]
    fn what_the_kernel_says() {
        assert_eq!(available("MemTotal: 9 kB\nMemAvailable:    2048 kB\n"), Some(2 << 20));
        assert_eq!(available("MemTotal: 9 kB\n"), None);
    }
}
