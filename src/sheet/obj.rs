//! Wavefront OBJ files: vertices and faces, with the lattice kept in comments.
//!
//! Lines `v x y z` and `f a b c ...` are read, also corners `a/t/n` and negative numbers, which count back from the
//! last vertex. Other keywords are ignored. What OBJ cannot express is kept in comments:
//!
//! ```text
//! # foldwell:lattice x y z            (twice, for the two lattice vectors)
//! # foldwell:hole a b c ...           (once for every opening of a periodic sheet)
//! # foldwell:assignment a b C        (of an edge, where the drawing does not show it; the letters are those of FOLD)
//! # foldwell:fold_angle a b 90.0     (target angle of an edge in degrees, if the drawing does not show it)
//! # foldwell:metadata key value       (of FOLD, about the file and its frame; the value is JSON)
//! # foldwell:description "text"
//! ```

use std::borrow::Cow;
use std::fmt::Write;
use std::path::Path;

use super::angle::in_degrees;
use super::assignment::Assignment;
use super::build::{Drawing, build, draw};
use super::cell::Sheet;
use super::error::{Defect, MeshPart, MeshProblem, SheetError};
use super::pattern_fault::PatternFault;
use super::text;
use crate::math::Vec3;

/// Reads the sheet of the file at `path`.
///
/// # Errors
/// [`SheetError::Read`] if the file does not exist or cannot be read, otherwise as [`parse`].
pub fn read(path: &Path) -> Result<Sheet, SheetError> {
    let text = text::read_drawing(path).map_err(|source| SheetError::Read { path: path.to_owned(), source })?;
    parse(&text, &path.display().to_string())
}

/// Reads the sheet of an OBJ text. `name` is the name of its file: it appears in messages, and is the title if the
/// file has no `o` line. Messages number vertices and faces from 1, as OBJ does.
///
/// # Errors
/// [`SheetError::Bad`] with the line, and the vertex, face or edge that is wrong.
pub fn parse(text: &str, name: &str) -> Result<Sheet, SheetError> {
    let stem = Path::new(name).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let mut reader = Reader { drawn: Drawing { title: stem, first: 1, ..Drawing::default() }, ..Reader::default() };
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    for (number, line) in joined_lines(text) {
        reader.line = number;
        reader.read(&line).map_err(|problem| SheetError::bad(name, [number, 1], problem))?;
    }
    let last = [reader.line.max(1), 1];
    reader.drawn.lattice = reader.lattice().map_err(|problem| SheetError::bad(name, last, problem))?;
    let mut sheet = build(&reader.drawn).map_err(|defect| reader.located(name, defect))?;
    sheet.record.metadata = reader.metadata;
    Ok(sheet)
}

/// Returns the lines with their numbers; a line that ends in a backslash continues in the next one.
fn joined_lines(text: &str) -> Vec<(usize, Cow<'_, str>)> {
    let mut lines: Vec<(usize, Cow<str>)> = Vec::new();
    let mut goes_on = false;
    for (number, line) in text.lines().enumerate() {
        let (here, continued) = line.trim_end().strip_suffix('\\').map_or((line, false), |here| (here, true));
        match lines.last_mut() {
            Some((_, whole)) if goes_on => {
                whole.to_mut().push(' ');
                whole.to_mut().push_str(here);
            }
            _ => lines.push((number + 1, here.into())),
        }
        goes_on = continued;
    }
    lines
}

/// The mesh read so far, and the line numbers of its parts.
#[derive(Default)]
struct Reader {
    line: usize,
    drawn: Drawing,
    lattice_vectors: Vec<Vec3>,
    lines: Vec<(MeshPart, usize)>,
    metadata: Vec<(String, String)>,
}

impl Reader {
    fn read(&mut self, line: &str) -> Result<(), MeshProblem> {
        let (word, rest) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
        let uncommented = rest.split('#').next().unwrap_or_default();
        match word {
            "v" => {
                self.lines.push((MeshPart::Vertex(self.drawn.coords.len()), self.line));
                self.drawn.coords.push(point(uncommented)?);
            }
            "f" => {
                self.lines.push((MeshPart::Face(self.drawn.faces.len()), self.line));
                self.drawn.faces.push(self.corners(uncommented, "face", self.drawn.faces.len() + 1)?);
            }
            "o" => self.drawn.title = rest.trim().to_owned(),
            "#" => self.read_comment(rest.trim())?,
            _ => {}
        }
        Ok(())
    }

    fn read_comment(&mut self, comment: &str) -> Result<(), MeshProblem> {
        let (word, rest) = comment.split_once(char::is_whitespace).unwrap_or((comment, ""));
        match word {
            "foldwell:lattice" => {
                self.lines.push((MeshPart::Lattice, self.line));
                self.lattice_vectors.push(point(rest)?);
            }
            "foldwell:hole" => {
                self.lines.push((MeshPart::Hole(self.drawn.holes.len()), self.line));
                self.drawn.holes.push(self.corners(rest, "opening", self.drawn.holes.len())?);
            }
            "foldwell:assignment" => {
                let (ends, letter) = rest.trim().rsplit_once(char::is_whitespace).unwrap_or(("", rest));
                let ends = self.corners(ends, "edge", self.drawn.assignments.len())?;
                let (&[a, b], Some(assignment)) = (&ends[..], Assignment::from_letter(letter)) else {
                    return Err(wrong(rest, "assignment", "two vertex numbers and a letter of FOLD, `1 2 C`"));
                };
                self.lines.push((MeshPart::Edge(self.drawn.assignments.len()), self.line));
                self.drawn.assignments.push(([a, b], assignment));
            }
            "foldwell:fold_angle" => {
                let (ends, degrees) = rest.trim().rsplit_once(char::is_whitespace).unwrap_or(("", rest));
                let ends = self.corners(ends, "edge", self.drawn.fold_angles.len())?;
                let degrees = degrees.parse().ok().filter(|degrees: &f64| degrees.is_finite());
                let (&[a, b], Some(degrees)) = (&ends[..], degrees) else {
                    return Err(wrong(rest, "fold angle", "two vertex numbers and degrees, `1 2 90.0`"));
                };
                self.lines.push((MeshPart::FoldAngle(self.drawn.fold_angles.len()), self.line));
                self.drawn.fold_angles.push(([a, b], Some(degrees.to_radians())));
            }
            "foldwell:metadata" => {
                let (key, value) = rest.trim().split_once(char::is_whitespace).unwrap_or((rest, ""));
                let value: serde_json::Value = serde_json::from_str(value)
                    .map_err(|_| wrong(rest, "metadata", "a key and a JSON value, `file_author \"A. B.\"`"))?;
                self.metadata.push((key.to_owned(), value.to_string()));
            }
            "foldwell:description" => {
                self.drawn.description = serde_json::from_str(rest)
                    .map_err(|_| wrong(rest, "description", "one text in quotes, with quotes inside as \\\""))?;
            }
            _ => {}
        }
        Ok(())
    }

    /// Returns the vertices of a face or an opening, counted from 0.
    fn corners(&self, list: &str, what: &str, number: usize) -> Result<Vec<usize>, MeshProblem> {
        let count = self.drawn.coords.len();
        let corner = |word: &str| {
            let first = word.split('/').next().unwrap_or_default();
            let right = "a whole number, such as 3, -1 or 3/1/2";
            let n: i128 = first.parse().map_err(|_| wrong(word, "vertex number", right))?;
            let from_zero = if n < 0 { n + count as i128 } else { n - 1 };
            usize::try_from(from_zero).ok().filter(|v| *v < count).ok_or_else(|| MeshProblem::Index {
                what: format!("{what} {number}"),
                found: first.to_owned(),
                first: 1,
                last: count,
            })
        };
        list.split_whitespace().map(corner).collect()
    }

    fn lattice(&self) -> Result<Option<[Vec3; 2]>, MeshProblem> {
        match self.lattice_vectors[..] {
            [] => Ok(None),
            [l1, l2] => Ok(Some([l1, l2])),
            _ => {
                let found = format!("{} lines `# foldwell:lattice`", self.lattice_vectors.len());
                Err(wrong(&found, "lattice", "two lines, one for each lattice vector"))
            }
        }
    }

    fn located(&self, name: &str, defect: Defect) -> SheetError {
        let listed = self.lines.iter().rfind(|(part, _)| *part == defect.place);
        let line = listed.map_or(self.line, |(_, line)| *line);
        SheetError::bad(name, [line.max(1), 1], defect.problem)
    }
}

fn wrong(found: &str, what: &'static str, right: &'static str) -> MeshProblem {
    PatternFault::value(found, what, right).into()
}

fn point(words: &str) -> Result<Vec3, MeshProblem> {
    let bad = || wrong(words.trim(), "point", "three finite numbers, `x y z`");
    let numbers: Vec<f64> = words.split_whitespace().map(str::parse).collect::<Result<_, _>>().map_err(|_| bad())?;
    match numbers[..] {
        [x, y, z, ..] if numbers.iter().all(|n| n.is_finite()) => Ok(Vec3::new(x, y, z)),
        _ => Err(bad()),
    }
}

/// Returns `sheet` as an OBJ text, one cell drawn in full. [`parse`] gives the same sheet back, except that white
/// space in the title becomes single spaces.
pub fn write(sheet: &Sheet) -> String {
    let drawn = draw(sheet);
    let mut text = format!("o {}\n", drawn.title.split_whitespace().collect::<Vec<_>>().join(" "));
    if !drawn.description.is_empty() {
        let quoted = serde_json::Value::String(drawn.description);
        let _ = writeln!(text, "# foldwell:description {quoted}");
    }
    for (key, value) in &sheet.record.metadata {
        let _ = writeln!(text, "# foldwell:metadata {key} {value}");
    }
    for l in drawn.lattice.iter().flatten() {
        let _ = writeln!(text, "# foldwell:lattice {:?} {:?} {:?}", l.x, l.y, l.z);
    }
    for x in &drawn.coords {
        let _ = writeln!(text, "v {:?} {:?} {:?}", x.x, x.y, x.z);
    }
    for (word, lists) in [("# foldwell:hole", &drawn.holes), ("f", &drawn.faces)] {
        for list in lists {
            let numbers: Vec<_> = list.iter().map(|v| (v + 1).to_string()).collect();
            let _ = writeln!(text, "{word} {}", numbers.join(" "));
        }
    }
    for ([a, b], assignment) in &drawn.assignments {
        let _ = writeln!(text, "# foldwell:assignment {} {} {assignment}", a + 1, b + 1);
    }
    for ([a, b], angle) in &drawn.fold_angles {
        let degrees = in_degrees(angle.unwrap_or_default());
        let _ = writeln!(text, "# foldwell:fold_angle {} {} {degrees:?}", a + 1, b + 1);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::{Pattern, fold, generate};

    /// Claim: writing and reading gives the same sheet, bit by bit, also with polygons and for finite sheets.
    #[test]
    fn round_trip() {
        let star = fold::parse(include_str!("../../tests/cases/open-star.fold"), "open-star.fold").unwrap();
        let mut sheets = vec![star];
        sheets.extend(["miura", "kresling"].map(|name| generate(&Pattern::named(name).unwrap()).unwrap()));
        for sheet in sheets {
            assert_eq!(parse(&write(&sheet), "again.obj").unwrap(), sheet);
        }
    }

    /// Claim: texture and normal numbers, negative numbers and unknown keywords are read as OBJ defines them.
    #[test]
    fn forms_of_corners() {
        let text = "mtllib a.mtl\nv 0 0 0 1.0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1/1 -2//1 3/2/1\nv 1 1 0\nf 2 -1 -2\n";
        let sheet = parse(text, "dir/two.obj").unwrap();
        let plain = parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n", "two.obj").unwrap();
        assert_eq!(sheet, plain);
        assert_eq!(sheet.title, "two");
    }
}
