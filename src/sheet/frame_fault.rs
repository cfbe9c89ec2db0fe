//! Frames of a FOLD file that cannot be read.

/// A frame that does not exist, or whose parents do not lead to the file's first frame; the message says how to correct
/// it. Frame 0 is the top of the file, and those of `file_frames` are numbered from 1.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)] // the messages say it
pub enum FrameFault {
    #[error("there is no frame {frame}; {}", numbering(*last))]
    NoFrame { frame: usize, last: usize },
    #[error("`frame_parent` of frame {frame} is {parent}; {}", numbering(*last))]
    NoParent { frame: usize, parent: usize, last: usize },
    #[error("frame {frame} inherits from itself by way of `frame_parent`; parents should lead to frame 0")]
    Cycle { frame: usize },
}

fn numbering(last: usize) -> String {
    if last == 0 {
        "the file has frame 0 only".to_owned()
    } else {
        format!("frames are 0, the top of the file, and 1 to {last}, those of `file_frames`")
    }
}
