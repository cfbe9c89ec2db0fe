//! The keys of a FOLD file that do not define its sheet.

use serde_json::Value;

use super::edges::Edges;
use super::frames::FoldFrame;
use super::keys::GLUE;
use super::stiffness::{BARS, HINGES};
use crate::sheet::build::{Drawing, drawn_sides};
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
const USED: [&str; 15] = [
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
    GLUE,
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

/// Reads the content of a frame other than the shape of its sheet. All keys are kept of a finite sheet whose vertices,
/// edges and faces keep their numbers when it is written; otherwise only those about the file and its frame.
pub(super) fn read(frame: &FoldFrame, drawn: &Drawing, edges: &Edges) -> FileRecord {
    let all_listed = edges.ends.is_empty() || edges.ends.len() == drawn_sides(drawn).len() + drawn.bars.len();
    record(frame, edges, !drawn.is_repeated() && all_listed)
}

/// Reads the same; `numbered` says whether vertices, edges and faces keep their numbers.
pub(super) fn record(frame: &FoldFrame, edges: &Edges, numbered: bool) -> FileRecord {
    let mut record = FileRecord { frame: frame.number, further_frames: frame.others, ..FileRecord::default() };
    for (key, value) in &frame.values.0 {
        let name = key.as_str();
        let text = if KEPT.contains(&name) { kept(name, value.get()) } else { on_one_line(value.get()) };
        if name == "file_frames" {
            let whole = numbered && frame.number == 0 && frame.others > 0;
            record.frames = whole.then_some(text);
        } else if USED.contains(&name) || DERIVED.contains(&name) || text.is_empty() {
            continue;
        } else if KEPT.contains(&name) || (numbered && !(name.starts_with("faces_") && edges.rebuilt)) {
            record.metadata.push((key.clone(), text));
        } else {
            record.left_out.push(key.clone());
        }
    }
    record
}

/// Returns a JSON text without line breaks, which are white space there.
fn on_one_line(text: &str) -> String {
    text.replace(['\n', '\r'], " ")
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
