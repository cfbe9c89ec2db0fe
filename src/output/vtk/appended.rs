//! Arrays that follow a VTU file as raw bytes, as ParaView saves them, put into its elements as base64.
//!
//! A file with raw bytes is no XML. Behind `<AppendedData encoding="raw">_` stand the bytes of the arrays in a row,
//! each after its length, or compressed after the number and lengths of its blocks. The offsets of `DataArray` elements
//! count from the underscore ("VTK XML formats", Kitware).

use std::borrow::Cow;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use crate::output::fault::VtuFault;

/// How the raw bytes of a file are to be read.
struct RawArrays<'b> {
    data: &'b [u8],
    /// Bytes of a number of the headers of arrays.
    width: usize,
    big_endian: bool,
    compressed: bool,
}

/// Returns a file with its raw arrays as base64 in their elements; other files remain.
///
/// # Errors
/// [`VtuFault::Format`] if an array is beyond the end of the file.
pub(super) fn inlined(bytes: &[u8]) -> Result<Cow<'_, [u8]>, VtuFault> {
    let Some(start) = position(bytes, b"<AppendedData") else { return Ok(bytes.into()) };
    let tag = tag(&bytes[start..]);
    let begin = start + tag.len() + position(&bytes[start + tag.len()..], b"_").map_or(0, |at| at + 1);
    if attribute(&tag, "encoding") != Some("raw") {
        return Ok(bytes.into());
    }
    let head = String::from_utf8_lossy(&bytes[..start]);
    let file = head.find("<VTKFile").map_or("", |at| &head[at..]);
    let file = &file[..file.find('>').unwrap_or(file.len())];
    let arrays = RawArrays {
        data: &bytes[begin..],
        width: if attribute(file, "header_type") == Some("UInt64") { 8 } else { 4 },
        big_endian: attribute(file, "byte_order") == Some("BigEndian"),
        compressed: attribute(file, "compressor").is_some(),
    };
    let mut text = String::with_capacity(2 * bytes.len());
    let mut rest = &head[..];
    while let Some(at) = rest.find("<DataArray") {
        text.push_str(&rest[..at]);
        rest = &rest[at..];
        let end = rest.find('>').ok_or_else(|| VtuFault::Format("an element of it has no end".into()))? + 1;
        let (tag, after) = rest.split_at(end);
        if attribute(tag, "format") != Some("appended") {
            text.push_str(tag);
            rest = after;
            continue;
        }
        let offset = attribute(tag, "offset").and_then(|offset| offset.parse().ok()).unwrap_or(usize::MAX);
        let inner = tag.trim_end_matches('>').trim_end_matches('/');
        text.push_str(&inner.replace("\"appended\"", "\"binary\""));
        text.push('>');
        text.push_str(&arrays.encoded(offset).ok_or_else(|| VtuFault::Format("an array is beyond its end".into()))?);
        text.push_str("</DataArray>");
        let closing = "</DataArray>";
        let is_closed = tag.ends_with("/>");
        rest = if is_closed { after } else { after.find(closing).map_or("", |at| &after[at + closing.len()..]) };
    }
    text.push_str(rest);
    text.push_str("</VTKFile>");
    Ok(text.into_bytes().into())
}

impl RawArrays<'_> {
    /// Returns the array at an offset as the text of an element; `None` if it is beyond the end.
    fn encoded(&self, offset: usize) -> Option<String> {
        let array = self.data.get(offset..)?;
        let number = |k: usize| -> Option<usize> {
            let bytes = array.get(k * self.width..(k + 1) * self.width)?;
            let mut eight = [0; 8];
            for (place, byte) in bytes.iter().enumerate() {
                eight[if self.big_endian { self.width - 1 - place } else { place }] = *byte;
            }
            usize::try_from(u64::from_le_bytes(eight)).ok()
        };
        if !self.compressed {
            return Some(STANDARD.encode(array.get(..self.width.checked_add(number(0)?)?)?));
        }
        let header = number(0)?.checked_add(3)?.checked_mul(self.width)?;
        let mut length = 0usize;
        for block in 0..number(0)? {
            length = length.checked_add(number(3 + block)?)?;
        }
        let content = array.get(header..header.checked_add(length)?)?;
        Some(STANDARD.encode(array.get(..header)?) + &STANDARD.encode(content))
    }
}

fn position(bytes: &[u8], part: &[u8]) -> Option<usize> {
    bytes.windows(part.len()).position(|window| window == part)
}

/// Returns the tag at the beginning of these bytes.
fn tag(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == b'>').map_or(bytes.len(), |end| end + 1);
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

/// Returns the value of an attribute of a tag.
fn attribute<'t>(tag: &'t str, name: &str) -> Option<&'t str> {
    let start = tag.find(&format!(" {name}=\""))? + name.len() + 3;
    tag[start..].split('"').next()
}
