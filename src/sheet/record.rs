//! Content of a mesh file other than the shape of the sheet.

use super::redrawing::Redrawing;

/// Content of a mesh file other than the shape of the sheet: the keys that are kept, and the names of those that are
/// not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileRecord {
    /// Keys that are kept, such as `file_author`, with their values as JSON text.
    pub metadata: Vec<(String, String)>,
    /// Keys that are neither used nor kept.
    pub left_out: Vec<String>,
    /// Whether all faces were turned over, since the letters of the file are those of the other side.
    pub turned_over: bool,
    /// Number of the frame that is read: 0 is the top of the file.
    pub frame: usize,
    /// Number of the other frames of the file, which are not read.
    pub further_frames: usize,
    /// The text of `file_frames`, if the frames can be kept beside the one that is read.
    pub frames: Option<String>,
    /// What was done to a drawing of lines.
    pub redrawing: Redrawing,
}
