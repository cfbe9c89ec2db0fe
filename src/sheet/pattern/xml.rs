//! XML documents and places in them.

use roxmltree::{Document, Node, ParsingOptions};

use super::line::Misread;
use crate::sheet::pattern_fault::PatternFault;

/// Parses a text as the XML of `format`. SVG files of Illustrator have a document type with entities.
pub(super) fn document<'t>(text: &'t str, format: &'static str) -> Result<Document<'t>, Misread> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        let at = error.pos();
        let message = error.to_string();
        ([at.row as usize, at.col as usize], PatternFault::Syntax { format, message }.into())
    })
}

/// Returns the line and column at which an element begins.
pub(super) fn place(document: &Document, node: Node) -> [usize; 2] {
    let at = document.text_pos_at(node.range().start);
    [at.row as usize, at.col as usize]
}
