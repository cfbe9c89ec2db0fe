//! Content of a mesh file other than the shape of the sheet, and what was done to the lines of a drawing so that they
//! make a crease pattern.

use super::pattern_fault::LineName;

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

/// A record of how the lines of a drawing were made a crease pattern: what was joined, cut and left out, and what remains
/// in doubt. Lengths are in units of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Redrawing {
    /// Distance within which points were merged, and the first one that was tried, with which the lines were no crease
    /// pattern or had points close to each other; `None` where the first distance was kept.
    pub merged: Option<[f64; 2]>,
    /// Two vertices that are close enough to be meant as one.
    pub gap: Option<Gap>,
    /// Number of curves, and the distance within which polylines follow them.
    pub curves: Option<(usize, f64)>,
    /// Number of grey lines, which are read as auxiliary ones.
    pub grey: usize,
    /// Number of lines without a finite length, which are left out.
    pub not_finite: usize,
    /// Number of auxiliary lines of which a part bounds no face and is left out.
    pub dropped: usize,
    /// Number of lines shorter than the distance within which points were merged, which are left out.
    pub vanished: usize,
    /// Number of cuts between two vertices inside the sheet; each has got a third vertex in its middle, where it opens.
    pub slits: usize,
    /// Number of faces that are holes: all their sides are boundaries, with faces all round.
    pub holes: usize,
    /// Number of creases without a letter, in a drawing of lines of which none has the colour or the layer of a crease.
    pub unlettered: usize,
}

/// Two vertices of a drawing of lines that are close enough to be meant as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Their places.
    pub ends: LineName,
    /// Their distance.
    pub distance: f64,
    /// The smaller distance within which points were merged.
    pub merged: f64,
}

impl Redrawing {
    /// Returns a sentence for each thing that was done or is in doubt.
    pub(crate) fn said(&self) -> Vec<String> {
        let mut said = Vec::new();
        if let Some([distance, default]) = self.merged {
            said.push(format!(
                "points up to {distance:.3e} from each other, or from a line, were joined: with {default:.3e} {}; `merge` \
                 in [sheet] of a scene and `foldwell convert --merge` set the distance",
                if distance > default { "lines end beside each other" } else { "others would be one that are two" }
            ));
        }
        if let Some(Gap { ends, distance, merged }) = self.gap {
            said.push(format!(
                "two vertices are {distance:.3e} apart, {ends}, and points are merged up to {merged:.3e}; if they are meant \
                 as one, `merge` in [sheet] of a scene and `foldwell convert --merge` merge within more"
            ));
        }
        if let Some((curves, distance)) = self.curves {
            said.push(format!("{curves} curved shapes are polylines that stay within {distance:.3e} of the curves"));
        }
        let counts = [
            (self.grey, "grey lines are read as auxiliary: flat, and left out where they end in a face"),
            (self.not_finite, "lines with a coordinate that is not a finite number are left out"),
            (self.dropped, "auxiliary lines are left out where they end in a face"),
            (self.vanished, "lines are left out that are shorter than the distance within which points are one"),
            (self.slits, "cuts of one edge have got a vertex in their middle, where they open"),
            (self.holes, "faces with boundaries all round and other faces beyond them are left out as holes"),
            (
                self.unlettered,
                "lines between two faces are creases without a letter: no line has the colour of a crease, such as \
                 red for mountains and blue for valleys, or a DXF layer with such a name, mountain or valley",
            ),
        ];
        said.extend(counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")));
        said
    }
}
