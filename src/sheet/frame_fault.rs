//! Frames of a FOLD file that cannot be read.

/// A frame that does not exist, or whose parents do not lead to the file's first frame; the message says how to correct
/// it. Frame 0 is the top of the file, and those of `file_frames` are numbered from 1.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum FrameFault {
    /// The file has no frame of this number.
    #[error("there is no frame {frame}; {}", numbering(*last))]
    NoFrame {
        /// The number.
        frame: usize,
        /// Number of the last frame.
        last: usize,
    },
    /// A frame names a parent that does not exist.
    #[error("`frame_parent` of frame {frame} is {parent}; {}", numbering(*last))]
    NoParent {
        /// The frame.
        frame: usize,
        /// Number of the parent.
        parent: usize,
        /// Number of the last frame.
        last: usize,
    },
    /// A frame inherits from itself by way of its parents.
    #[error("frame {frame} inherits from itself by way of `frame_parent`; parents should lead to frame 0")]
    Cycle {
        /// The frame.
        frame: usize,
    },
}

fn numbering(last: usize) -> String {
    if last == 0 {
        "the file has frame 0 only".to_owned()
    } else {
        format!("frames are 0, the top of the file, and 1 to {last}, those of `file_frames`")
    }
}
