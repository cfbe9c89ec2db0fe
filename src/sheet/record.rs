//! Content of a mesh file other than the shape of the sheet.

/// Content of a mesh file other than the shape of the sheet: the keys that are kept, and the names of those that are
/// not.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileRecord {
    /// Keys about the file and its frame, such as `file_author`, with their values as JSON text.
    pub metadata: Vec<(String, String)>,
    /// Keys that are neither used nor kept.
    pub left_out: Vec<String>,
    /// Number of frames of the file after the first one, which alone is read.
    pub further_frames: usize,
}
