//! What a mesh file says beside the shape of the sheet.

/// What a mesh file says beside the shape of the sheet: what is kept of it, and what is not.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileRecord {
    /// Keys about the file and its frame, such as `file_author`, with their values as JSON text.
    pub metadata: Vec<(String, String)>,
    /// Keys that are neither used nor kept.
    pub left_out: Vec<String>,
    /// Frames of the file beyond the first one, which alone is read.
    pub further_frames: usize,
}
