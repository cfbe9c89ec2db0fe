//! The keys of a FOLD file that define the sheet, as unparsed text.

use serde::Deserialize;
use serde_json::value::RawValue;

/// Values of the keys that are read, not parsed yet.
#[derive(Deserialize)]
#[serde(expecting = "a FOLD file, one JSON object in braces")]
pub(super) struct Keys<'a> {
    #[serde(borrow)]
    pub(super) file_title: Option<&'a RawValue>,
    #[serde(borrow)]
    pub(super) file_description: Option<&'a RawValue>,
    #[serde(borrow)]
    pub(super) vertices_coords: Option<&'a RawValue>,
    #[serde(borrow)]
    pub(super) faces_vertices: Option<&'a RawValue>,
    #[serde(borrow)]
    pub edges_vertices: Option<&'a RawValue>,
    #[serde(borrow)]
    pub edges_assignment: Option<&'a RawValue>,
    #[serde(borrow, rename = "edges_foldAngle")]
    pub edges_fold_angle: Option<&'a RawValue>,
    #[serde(borrow, rename = "foldwell:lattice")]
    pub(super) lattice: Option<&'a RawValue>,
    #[serde(borrow, rename = "foldwell:holes")]
    pub(super) holes: Option<&'a RawValue>,
    #[serde(borrow, rename = "foldwell:stiffness")]
    pub(super) stiffness: Option<&'a RawValue>,
    #[serde(borrow, rename = "foldwell:bar_stiffness")]
    pub(super) bar_stiffness: Option<&'a RawValue>,
    #[serde(borrow, rename = "foldwell:names")]
    pub(super) names: Option<&'a RawValue>,
}
