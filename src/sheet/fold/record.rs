//! The keys of a FOLD file that do not define its sheet.

use std::collections::BTreeMap;

use serde_json::Value;
use serde_json::value::RawValue;

use super::locate::Source;
use super::stiffness::{BARS, HINGES};
use crate::sheet::error::SheetError;
use crate::sheet::record::FileRecord;

/// Keys about the file and its frame, whose values are kept.
const KEPT: [&str; 8] = [
    "file_author",
    "file_classes",
    "frame_author",
    "frame_title",
    "frame_description",
    "frame_classes",
    "frame_attributes",
    "frame_unit",
];

/// Keys that define the sheet, or that are written anew.
const USED: [&str; 14] = [
    "file_spec",
    "file_creator",
    "file_title",
    "file_description",
    "vertices_coords",
    "faces_vertices",
    "edges_vertices",
    "edges_assignment",
    "edges_foldAngle",
    "foldwell:lattice",
    "foldwell:holes",
    HINGES,
    BARS,
    "foldwell:names",
];

/// Keys whose values follow from other keys.
const DERIVED: [&str; 9] = [
    "vertices_vertices",
    "vertices_edges",
    "vertices_faces",
    "edges_faces",
    "edges_length",
    "faces_edges",
    "faces_faces",
    "frame_inherit",
    "frame_parent",
];

/// Values of two [`KEPT`] keys in every file that this program writes; they carry no information.
pub(super) const CLASSES: &str = "[\"singleModel\"]";
pub(super) const ATTRIBUTES: &str = "[\"3D\"]";

/// Reads the content of the text other than the shape of its sheet.
pub(super) fn read(source: &Source) -> Result<FileRecord, SheetError> {
    let keys: BTreeMap<String, &RawValue> = serde_json::from_str(source.text).map_err(|e| source.syntax(&e))?;
    let mut record = FileRecord::default();
    for (key, value) in keys {
        let name = key.as_str();
        if name == "file_frames" {
            record.further_frames = serde_json::from_str(value.get()).map_or(0, |frames: Vec<&RawValue>| frames.len());
        } else if KEPT.contains(&name) {
            let text = kept(name, value.get());
            if !text.is_empty() {
                record.metadata.push((key, text));
            }
        } else if !USED.contains(&name) && !DERIVED.contains(&name) {
            record.left_out.push(key);
        }
    }
    Ok(record)
}

/// Returns the value as it is to be written again; empty if every written file has it. The attribute `2D` becomes
/// `3D`, since coordinates are always written in three dimensions.
fn kept(key: &str, text: &str) -> String {
    let Ok(mut value) = serde_json::from_str::<Value>(text) else { return String::new() };
    if key == "frame_attributes"
        && let Value::Array(list) = &mut value
    {
        list.retain(|word| *word != "2D" && *word != "3D");
        list.insert(0, "3D".into());
    }
    let usual = match key {
        "file_classes" => CLASSES,
        "frame_attributes" => ATTRIBUTES,
        _ => "",
    };
    let text = value.to_string();
    if text == usual { String::new() } else { text }
}
