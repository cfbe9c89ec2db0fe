//! Crease patterns drawn as lines: SVG with the colours of Origami Simulator, the files of ORIPA (`.cp`, `.opx`) and
//! Oriedita (`.ori`), and DXF.
//!
//! | line | `.svg`: colour of the stroke | `.cp`, `.opx`: type | letter | target angle |
//! |---|---|---|---|---|
//! | mountain | red | 2 | `M` | -180 degrees times the opacity |
//! | valley | blue | 3 | `V` | 180 degrees times the opacity |
//! | boundary | black | 1 | `B` | |
//! | facet, which stays flat | yellow | | `F` | 0 |
//! | hinge, which is free | magenta | 4 (`.opx`) | `U` | |
//! | cut | green | 1, between two faces | `C` | |
//! | joint of two faces | cyan | | `J` | |
//! | auxiliary | grey | 0, 4 (`.cp`) | `F` | 0 |
//!
//! Lines are split where they cross and touch, points within 1e-4 of the extent, or more where lines end beside each
//! other otherwise, are merged, and lines that lie on each other are one ([`Cleanup`]); faces are what the lines bound.
//! In these files but DXF y points downwards: a point `(x, y)` of the file is the vertex `(x, -y, 0)`, so that a sheet
//! looks as in the program that drew it, seen from the side of its face normals. A closed outline of black lines inside
//! the sheet, with faces all round, is a hole. In SVG and DXF without any crease black lines between two faces are
//! creases without a letter, `U`. What was done is in
//! [`record.redrawing`](crate::sheet::Redrawing) of the sheet.
//!
//! Sources: A. Ghassaei, E. D. Demaine, N. Gershenfeld, "Fast, interactive origami simulation using GPU computation",
//! Origami 7 (2018), and the files that its program Origami Simulator reads and writes, for the colours and the
//! opacity; J. Mitani, ORIPA, and Oriedita, for the types.
//!
//! ```
//! use foldwell::sheet::{Assignment, pattern};
//!
//! let cp = "1 0 0 100 0\n1 100 0 100 100\n1 100 100 0 100\n1 0 100 0 0\n2 0 0 100 100\n";
//! let sheet = pattern::parse(cp, "fold.cp", pattern::Format::Cp)?;
//! assert_eq!((sheet.vertices.len(), sheet.triangles.len()), (4, 2));
//! let letters: Vec<_> = sheet.edges.iter().map(|edge| sheet.assignment(edge)).collect();
//! assert!(letters.contains(&Assignment::Mountain));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arrangement;
mod auxiliary;
mod bspline;
mod cleanup;
mod colour;
mod cp;
mod dxf;
mod dxf_entity;
mod flat;
mod line;
mod mesh;
mod opx;
mod ori;
mod outline;
mod piece;
mod straight;
mod svg;
mod svg_shape;
mod svg_style;
mod write;
mod xml;

use std::borrow::Cow;
use std::path::Path;

pub use cleanup::Cleanup;
pub(crate) use cleanup::sheet as sheet_of_lines;
pub use flat::NotFlat;
pub(crate) use line::PatternLine;
pub use write::{write_cp, write_dxf, write_svg};

use line::DrawnLines;

use super::build::Drawing;
use super::cell::Sheet;
use super::error::{MeshProblem, SheetError};
use super::text;

/// The formats of crease patterns that are read here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A drawing with the colours of Origami Simulator.
    Svg,
    /// Lines of ORIPA: type, x1, y1, x2, y2.
    Cp,
    /// The XML file of ORIPA.
    Opx,
    /// The file of Oriedita.
    Ori,
    /// A drawing of a CAD program.
    Dxf,
}

impl Format {
    /// Returns the format of files with the ending of this path; `None` if they are no crease patterns of lines.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_lowercase().as_str() {
            "svg" => Some(Self::Svg),
            "cp" => Some(Self::Cp),
            "opx" => Some(Self::Opx),
            "ori" => Some(Self::Ori),
            "dxf" => Some(Self::Dxf),
            _ => None,
        }
    }
}

/// Reads the crease pattern of the file at `path`, as [`parse_cleaned`] does.
///
/// # Errors
/// [`SheetError::Read`] if the file does not exist or cannot be read, otherwise as [`parse_cleaned`].
pub fn read(path: &Path, format: Format, cleanup: &Cleanup) -> Result<Sheet, SheetError> {
    let text = text::read_drawing(path).map_err(|source| SheetError::Read { path: path.to_owned(), source })?;
    parse_cleaned(&text, &path.display().to_string(), format, cleanup)
}

/// Reads a crease pattern as a flat sheet with letters and target angles. `name` is the name of its file: it appears in
/// messages, and is the title if the file has none.
///
/// # Errors
/// [`SheetError::Bad`] with line and column of what is wrong.
pub fn parse(text: &str, name: &str, format: Format) -> Result<Sheet, SheetError> {
    parse_cleaned(text, name, format, &Cleanup::default())
}

/// Does the same as [`parse`], with another distance of merging. Lines are split in any case.
///
/// # Errors
/// As [`parse`]; also if the distance is not positive or above a tenth of the extent.
pub fn parse_cleaned(text: &str, name: &str, format: Format, cleanup: &Cleanup) -> Result<Sheet, SheetError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    // old programs end lines by a carriage return alone
    let text = &if text.contains('\n') { Cow::from(text) } else { text.replace('\r', "\n").into() };
    let read = match format {
        Format::Svg => svg::lines(text),
        Format::Cp => cp::lines(text),
        Format::Opx => opx::lines(text),
        Format::Ori => ori::lines(text),
        Format::Dxf => dxf::lines(text),
    };
    let bad = |place: [usize; 2], problem: Box<MeshProblem>| SheetError::bad(name, place, problem);
    let DrawnLines { lines, mut title, redrawing } = read.map_err(|(place, problem)| bad(place, problem))?;
    if title.is_empty() {
        title = Path::new(name).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    }
    let head = Drawing { title, ..Drawing::default() };
    let mut sheet =
        sheet_of_lines(&lines, &Cleanup { split: true, ..*cleanup }, &head).map_err(|(line, problem)| {
            bad(line.map_or([1, 1], |line| text::line_and_column(text, lines[line].at)), problem)
        })?;
    let found = &mut sheet.record.redrawing;
    (found.curves, found.grey, found.not_finite) = (redrawing.curves, redrawing.grey, redrawing.not_finite);
    Ok(sheet)
}
