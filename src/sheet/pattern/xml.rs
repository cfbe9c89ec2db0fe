//! XML documents and places in them.

use roxmltree::{Document, Node, ParsingOptions};

use super::line::Misread;
use crate::sheet::pattern_fault::PatternFault;

/// Most bytes that the entities of a document may stand for.
const MOST_OF_ENTITIES: usize = 1 << 26;

/// Most entities in each other that the parser reads for one that a text names.
const MOST_INNER: usize = 255;

/// Parses a text as the XML of `format`. SVG files of Illustrator have a document type with entities; of those that
/// make a short file long none is read.
pub(super) fn document<'t>(text: &'t str, format: &'static str) -> Result<Document<'t>, Misread> {
    if entities(text) > MOST_OF_ENTITIES {
        let message = "its entities may stand for more than 64 MiB of text; write out what they stand for".into();
        return Err(([1, 1], PatternFault::Syntax { format, message }.into()));
    }
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        let at = error.pos();
        let message = error.to_string();
        ([at.row as usize, at.col as usize], PatternFault::Syntax { format, message }.into())
    })
}

/// Returns an upper bound of the bytes for which the entities that a text defines stand.
fn entities(text: &str) -> usize {
    let value = |definition: &'_ str| {
        let from = definition.find(['"', '\''])?;
        let quoted = definition.get(from + 1..)?;
        let value = quoted.get(..quoted.find(definition.get(from..=from)?)?)?;
        Some(value.len().saturating_mul(if value.contains('&') { MOST_INNER } else { 1 }))
    };
    let longest = text.split("<!ENTITY").skip(1).filter_map(value).max().unwrap_or(0);
    longest.saturating_mul(text.matches('&').count())
}

/// Returns the line and column at which an element begins.
pub(super) fn place(document: &Document, node: Node) -> [usize; 2] {
    let at = document.text_pos_at(node.range().start);
    [at.row as usize, at.col as usize]
}
