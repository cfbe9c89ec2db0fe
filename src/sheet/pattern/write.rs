//! Writing flat sheets as crease patterns of lines.

use std::fmt::Write;

use super::colour;
use super::cp::TYPES;
use super::flat::{NotFlat, edges};
use super::line::flip;
use crate::math::bounds;
use crate::sheet::angle::shortest;
use crate::sheet::assignment::Assignment;
use crate::sheet::cell::Sheet;

/// Returns a flat sheet as an SVG drawing with the colours of Origami Simulator, y downwards; mountains and valleys
/// have the opacity of their target angles, or 1 where the sheet has none. [`parse`](super::parse) reads it back with
/// the same lines.
///
/// # Errors
/// [`NotFlat`] if the sheet is folded or periodic.
pub fn write_svg(sheet: &Sheet) -> Result<String, NotFlat> {
    let edges = edges(sheet)?;
    let [low, high] = bounds(&sheet.vertices);
    let size = high - low;
    let extent = size.x.max(size.y);
    let margin = 0.02 * extent;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:?} {:?} {:?} {:?}\">\n",
        low.x - margin,
        flip(high.y) - margin,
        size.x + 2.0 * margin,
        size.y + 2.0 * margin,
    );
    let _ = writeln!(text, "<title>{}</title>", escaped(&sheet.title));
    let _ = writeln!(text, "<g fill=\"none\" stroke-width=\"{:?}\">", 0.003 * extent);
    for edge in edges {
        let [[x1, y1], [x2, y2]] = edge.ends.map(|[x, y]| [x, flip(y)]);
        let colour = colour::of_letter(edge.letter);
        let _ = write!(text, "<line x1=\"{x1:?}\" y1=\"{y1:?}\" x2=\"{x2:?}\" y2=\"{y2:?}\" stroke=\"{colour}\"");
        let _ = match edge.target.filter(|_| matches!(edge.letter, Assignment::Mountain | Assignment::Valley)) {
            Some(target) if opacity(target) != 1.0 => writeln!(text, " opacity=\"{:?}\"/>", opacity(target)),
            _ => writeln!(text, "/>"),
        };
    }
    text.push_str("</g>\n</svg>\n");
    Ok(text)
}

/// Returns the opacity that is read as exactly this target angle: the shortest of the numbers next to it that are.
fn opacity(target: f64) -> f64 {
    let target = target.abs();
    shortest(target.to_degrees() / 180.0, |opacity| (opacity * 180.0).to_radians() == target)
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Returns a flat sheet as a `.cp` file of ORIPA, y downwards, which has no target angles; and the number of edges
/// whose letter it does not have: hinges, facets and joints become auxiliary lines. Cuts have the type of the boundary,
/// as in ORIPA.
///
/// # Errors
/// [`NotFlat`] if the sheet is folded or periodic.
pub fn write_cp(sheet: &Sheet) -> Result<(String, usize), NotFlat> {
    let (mut text, mut changed) = (String::new(), 0);
    for edge in edges(sheet)? {
        let [[x1, y1], [x2, y2]] = edge.ends.map(|[x, y]| [x, flip(y)]);
        let letter = if edge.letter == Assignment::Cut { Assignment::Boundary } else { edge.letter };
        let known = TYPES.iter().rfind(|(_, known, ..)| *known == letter).map(|(number, ..)| *number);
        changed += usize::from(known.is_none());
        let number = known.unwrap_or(4);
        let _ = writeln!(text, "{number} {x1:?} {y1:?} {x2:?} {y2:?}");
    }
    Ok((text, changed))
}

/// Layers of DXF files, with their letters and the numbers of their colours; their names are those by which
/// [`parse`](super::parse) knows them.
const LAYERS: [(Assignment, &str, u8); 7] = [
    (Assignment::Boundary, "Boundary", 7),
    (Assignment::Mountain, "Mountain", 1),
    (Assignment::Valley, "Valley", 5),
    (Assignment::Flat, "Facet", 2),
    (Assignment::Unassigned, "Hinge", 6),
    (Assignment::Cut, "Cut", 3),
    (Assignment::Join, "Joint", 4),
];

/// Returns a flat sheet as a DXF drawing of lines for CAD programs and laser cutters, with a layer for each letter and
/// without target angles.
///
/// # Errors
/// [`NotFlat`] if the sheet is folded or periodic.
pub fn write_dxf(sheet: &Sheet) -> Result<String, NotFlat> {
    let mut text = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n".to_owned();
    text.push_str("0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n7\n");
    for (_, name, colour) in LAYERS {
        let _ = writeln!(text, "0\nLAYER\n2\n{name}\n70\n0\n62\n{colour}\n6\nCONTINUOUS");
    }
    text.push_str("0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n");
    for edge in edges(sheet)? {
        let [[x1, y1], [x2, y2]] = edge.ends;
        let layer = LAYERS.iter().find(|(letter, ..)| *letter == edge.letter).map_or("Boundary", |(_, name, _)| name);
        let _ = writeln!(text, "0\nLINE\n8\n{layer}\n10\n{x1:?}\n20\n{y1:?}\n11\n{x2:?}\n21\n{y2:?}");
    }
    text.push_str("0\nENDSEC\n0\nEOF\n");
    Ok(text)
}
