//! The frames of a FOLD file: frame 0 is the top of the file, and `file_frames` lists the others, which may inherit the
//! keys of a parent.

use serde_json::value::RawValue;

use super::keys::Values;
use super::locate::Source;
use crate::sheet::error::{MeshProblem, SheetError};

/// The frame that is read, with the keys that it inherits.
pub(super) struct FoldFrame<'a> {
    /// Its keys.
    pub values: Values<'a>,
    /// Its number.
    pub number: usize,
    /// Number of other frames of the file.
    pub others: usize,
}

/// Returns the frame of this number; if none is given, the first one that has vertices.
pub(super) fn choose<'a>(source: &Source<'a>, number: Option<usize>) -> Result<FoldFrame<'a>, SheetError> {
    let top: Values<'a> = read(source, source.text)?;
    let list = top.get("file_frames");
    let rows = list.map(|list| source.typed(list, || "`file_frames`".into(), "a list of frames, [{..}, ...]"));
    let rows: Vec<&RawValue> = rows.transpose()?.unwrap_or_default();
    let further = rows.iter().enumerate().map(|(k, row)| {
        let what = || format!("frame {} of `file_frames`", k + 1);
        source.typed(row, what, "an object of keys and values, {..}")
    });
    let further: Vec<Values> = further.collect::<Result<_, _>>()?;
    let frames = Frames { source, top: &top, further: &further };
    let number = match number {
        Some(number) => number,
        None if has_mesh(&top) => 0,
        None => frames.first_with_mesh()?.unwrap_or(0),
    };
    let values = frames.resolved(number)?;
    let others = if number == 0 { further.len() } else { further.len() - 1 + usize::from(has_mesh(&top)) };
    Ok(FoldFrame { values, number, others })
}

fn read<'a>(source: &Source<'a>, text: &'a str) -> Result<Values<'a>, SheetError> {
    serde_json::from_str(text).map_err(|error| source.syntax(&error))
}

fn has_mesh(values: &Values) -> bool {
    ["faces_vertices", "edges_vertices"].iter().any(|key| values.get(key).is_some())
        && values.get("vertices_coords").is_some()
}

/// All frames of a file.
struct Frames<'f, 'a> {
    source: &'f Source<'a>,
    top: &'f Values<'a>,
    further: &'f [Values<'a>],
}

impl<'a> Frames<'_, 'a> {
    /// Returns the number of the first of the further frames that has a mesh.
    fn first_with_mesh(&self) -> Result<Option<usize>, SheetError> {
        for number in 1..=self.further.len() {
            if has_mesh(&self.resolved(number)?) {
                return Ok(Some(number));
            }
        }
        Ok(None)
    }

    /// Returns the keys of a frame, with those that it inherits.
    fn resolved(&self, number: usize) -> Result<Values<'a>, SheetError> {
        let last = self.further.len();
        if number > last {
            return Err(self.source.at_value(None, MeshProblem::NoFrame { frame: number, last }));
        }
        let (mut values, mut at, mut seen) = (Values::default(), number, vec![number]);
        loop {
            let own = if at == 0 { self.top } else { &self.further[at - 1] };
            for (key, value) in &own.0 {
                // keys about the file belong to the top alone, which every frame has
                if at == 0 || !key.starts_with("file_") {
                    values.0.entry(key.clone()).or_insert(*value);
                }
            }
            let Some(parent) = self.parent(own, at)? else { break };
            if seen.contains(&parent) {
                let problem = MeshProblem::FrameCycle { frame: number };
                return Err(self.source.at_value(own.get("frame_parent"), problem));
            }
            seen.push(parent);
            at = parent;
        }
        let about_the_file = self.top.0.iter().filter(|(key, _)| key.starts_with("file_"));
        values.0.extend(about_the_file.map(|(key, value)| (key.clone(), *value)));
        Ok(values)
    }

    /// Returns the number of the frame from which a frame inherits.
    fn parent(&self, own: &Values<'a>, number: usize) -> Result<Option<usize>, SheetError> {
        let inherits = own.get("frame_inherit");
        let inherits = inherits.map(|value| self.source.typed(value, || "`frame_inherit`".into(), "true or false"));
        if !inherits.transpose()?.unwrap_or(false) || number == 0 {
            return Ok(None);
        }
        let Some(value) = own.get("frame_parent") else { return Ok(Some(0)) };
        let parent: usize = self.source.typed(value, || "`frame_parent`".into(), "the number of a frame")?;
        let last = self.further.len();
        if parent > last {
            let problem = MeshProblem::NoParent { frame: number, parent, last };
            return Err(self.source.at(value, problem));
        }
        Ok(Some(parent))
    }
}
