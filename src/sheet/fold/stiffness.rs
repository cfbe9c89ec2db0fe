//! Reads the stiffnesses that a FOLD file gives its edges: `foldwell:stiffness` and `foldwell:bar_stiffness`.

use std::collections::BTreeMap;

use serde_json::value::RawValue;

use super::edges::{Edges, per_edge};
use super::keys::Values;
use super::locate::Source;
use crate::sheet::build::{Identified, edges_by_drawn_name};
use crate::sheet::cell::{EdgeKey, MeshStiffness, Sheet};
use crate::sheet::error::{DrawnEdge, MeshProblem, SheetError};

/// Keys of the stiffnesses of hinges and of bars.
pub(super) const HINGES: &str = "foldwell:stiffness";
pub(super) const BARS: &str = "foldwell:bar_stiffness";

/// Reads the stiffnesses of the edges of `sheet`.
pub(super) fn read(
    source: &Source,
    keys: &Values,
    edges: &Edges,
    sheet: &Sheet,
    identified: &Identified,
) -> Result<MeshStiffness, SheetError> {
    let known = edges_by_drawn_name(sheet);
    let list = |key: &'static str| -> Result<BTreeMap<EdgeKey, f64>, SheetError> {
        let mut found = BTreeMap::new();
        let rows = per_edge(source, keys, (key, "a list of numbers and nulls"), edges.ends.len())?;
        for (e, (row, ends)) in rows.iter().zip(&edges.ends).enumerate() {
            let Some(given) = number(source, row, || format!("entry {e} of `{key}`"))? else { continue };
            let [a, b] = ends.map(|v| identified.corner[v]);
            for &edge in known.get(&EdgeKey::new(a, b).0).into_iter().flatten() {
                let before = found.insert(sheet.edges[edge].key, given);
                if let Some(before) = before.filter(|before| *before != given) {
                    let ends = DrawnEdge(ends[0], ends[1]);
                    return Err(source.at(row, MeshProblem::StiffnessOfCopies { key, edge: e, ends, given, before }));
                }
            }
        }
        Ok(found)
    };
    Ok(MeshStiffness { hinges: list(HINGES)?, bars: list(BARS)? })
}

/// Reads a positive number, `"inf"` or null; JSON has no infinite numbers.
fn number(source: &Source, row: &RawValue, what: impl Fn() -> String) -> Result<Option<f64>, SheetError> {
    match row.get() {
        "null" => Ok(None),
        "\"inf\"" => Ok(Some(f64::INFINITY)),
        text => {
            let number = text.parse().ok().filter(|k: &f64| *k > 0.0 && k.is_finite());
            let right = "a positive number, \"inf\" (exactly rigid) or null";
            number.map(Some).ok_or_else(|| source.mistyped(row, what(), right))
        }
    }
}
