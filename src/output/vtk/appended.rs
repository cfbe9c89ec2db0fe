//! Arrays of a VTU file that the XML reader does not know, put into their elements as base64 that it does: raw bytes
//! that follow the file, as ParaView saves them, and arrays that are compressed with LZMA.
//!
//! A file with raw bytes is no XML. Behind `<AppendedData encoding="raw">_` stand the bytes of the arrays in a row,
//! each after its length, or compressed after the number and lengths of its blocks. The offsets of `DataArray` elements
//! count from the underscore. In base64 the header of a compressed array and its blocks are encoded apart ("VTK XML
//! formats", Kitware).

use std::borrow::Cow;
use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use lzma_rust2::XzReader;

use crate::output::error::VtuFault;

/// The compression that VTK has beside zlib.
const LZMA: &str = "vtkLZMADataCompressor";

/// How the arrays of a file are to be read.
struct ArrayEncoding<'b> {
    /// The bytes of the appended data, from behind the underscore on.
    appended: &'b [u8],
    is_raw: bool,
    /// Bytes of a number of the headers of arrays.
    width: usize,
    big_endian: bool,
    compressed: bool,
    lzma: bool,
}

/// Returns a file with its raw arrays and those compressed with LZMA as base64 in their elements; other files remain.
pub(super) fn inlined(bytes: &[u8]) -> Result<Cow<'_, [u8]>, VtuFault> {
    let start = position(bytes, b"<AppendedData").unwrap_or(bytes.len());
    let appended = tag(&bytes[start..]);
    let begin = start + appended.len();
    let begin = begin + position(&bytes[begin..], b"_").map_or(0, |at| at + 1);
    let head = String::from_utf8_lossy(&bytes[..start]);
    let file = head.find("<VTKFile").map_or("", |at| &head[at..]);
    let file = &file[..file.find('>').unwrap_or(file.len())];
    let compressor = attribute(file, "compressor");
    let arrays = ArrayEncoding {
        appended: &bytes[begin..],
        is_raw: attribute(&appended, "encoding") == Some("raw"),
        width: if attribute(file, "header_type") == Some("UInt64") { 8 } else { 4 },
        big_endian: attribute(file, "byte_order") == Some("BigEndian"),
        compressed: compressor.is_some(),
        lzma: compressor == Some(LZMA),
    };
    if !arrays.is_raw && !arrays.lzma {
        return Ok(bytes.into());
    }
    let mut text = String::with_capacity(2 * bytes.len());
    let mut rest = &head[..];
    while let Some(at) = rest.find("<DataArray") {
        text.push_str(&rest[..at]);
        rest = &rest[at..];
        let end = rest.find('>').ok_or_else(|| VtuFault::Format("an element of it has no end".into()))? + 1;
        let (tag, after) = rest.split_at(end);
        let content = &after[..after.find('<').unwrap_or(after.len())];
        let Some(stored) = arrays.stored(tag, content) else {
            text.push_str(tag);
            rest = after;
            continue;
        };
        let inner = tag.trim_end_matches('>').trim_end_matches('/');
        text.push_str(&inner.replace("\"appended\"", "\"binary\""));
        text.push('>');
        text.push_str(&arrays.encoded(&stored?)?);
        text.push_str("</DataArray>");
        let closing = "</DataArray>";
        let is_closed = tag.ends_with("/>");
        rest = if is_closed { after } else { after.find(closing).map_or("", |at| &after[at + closing.len()..]) };
    }
    text.push_str(rest);
    if start < bytes.len() {
        text.push_str("</VTKFile>");
    }
    let compressed_no_more = |text: String| text.replacen(&format!(" compressor=\"{LZMA}\""), "", 1);
    Ok(if arrays.lzma { compressed_no_more(text) } else { text }.into_bytes().into())
}

/// The fault of an array that a file does not have whole.
fn beyond() -> VtuFault {
    VtuFault::Format("an array is beyond its end".into())
}

impl<'b> ArrayEncoding<'b> {
    /// Returns the bytes from where an array begins, as a raw one has them; `None` if the array remains as it is.
    fn stored(&self, tag: &str, content: &str) -> Option<Result<Cow<'b, [u8]>, VtuFault>> {
        let text = match attribute(tag, "format") {
            Some("appended") => {
                let offset = attribute(tag, "offset").and_then(|offset| offset.parse().ok()).unwrap_or(usize::MAX);
                let found = self.appended.get(offset..);
                if self.is_raw {
                    return Some(found.map(Cow::from).ok_or_else(beyond));
                }
                found.unwrap_or_default()
            }
            Some("binary") if self.lzma => content.trim().as_bytes(),
            _ => return None,
        };
        Some(self.decoded(text).map(Cow::from).ok_or_else(beyond))
    }

    /// Returns the header and the blocks of a compressed array in base64.
    fn decoded(&self, text: &[u8]) -> Option<Vec<u8>> {
        let part = |from: usize, count: usize| {
            let letters = text.get(from..from.checked_add(count.div_ceil(3).checked_mul(4)?)?)?;
            STANDARD.decode(letters).ok()
        };
        let blocks = self.number(&part(0, self.width)?, 0)?;
        let header = blocks.checked_add(3)?.checked_mul(self.width)?;
        let mut found = part(0, header)?;
        let length = self.length(&found, blocks)?;
        found.extend(part(4 * header.div_ceil(3), length)?);
        Some(found)
    }

    /// Returns number `k` of a header.
    fn number(&self, array: &[u8], k: usize) -> Option<usize> {
        let bytes = array.get(k * self.width..(k + 1) * self.width)?;
        let mut eight = [0; 8];
        for (place, byte) in bytes.iter().enumerate() {
            eight[if self.big_endian { self.width - 1 - place } else { place }] = *byte;
        }
        usize::try_from(u64::from_le_bytes(eight)).ok()
    }

    /// Returns the number of bytes of all blocks of a compressed array.
    fn length(&self, array: &[u8], blocks: usize) -> Option<usize> {
        (0..blocks).try_fold(0usize, |sum, block| sum.checked_add(self.number(array, 3 + block)?))
    }

    /// Returns an array as the text of an element.
    fn encoded(&self, array: &[u8]) -> Result<String, VtuFault> {
        if !self.compressed {
            let end = self.number(array, 0).and_then(|length| length.checked_add(self.width));
            return Ok(STANDARD.encode(end.and_then(|end| array.get(..end)).ok_or_else(beyond)?));
        }
        let parts = || {
            let blocks = self.number(array, 0)?;
            let header = blocks.checked_add(3)?.checked_mul(self.width)?;
            let content = array.get(header..header.checked_add(self.length(array, blocks)?)?)?;
            Some((blocks, array.get(..header)?, content))
        };
        let (blocks, header, content) = parts().ok_or_else(beyond)?;
        if !self.lzma {
            return Ok(STANDARD.encode(header) + &STANDARD.encode(content));
        }
        let mut plain = vec![0; self.width];
        let mut rest = content;
        for block in 0..blocks {
            let (compressed, others) = rest.split_at(self.number(array, 3 + block).unwrap_or(0));
            rest = others;
            let damaged = |error: std::io::Error| VtuFault::Format(format!("an array is no LZMA data: {error}"));
            XzReader::new(compressed, false).read_to_end(&mut plain).map_err(damaged)?;
        }
        let length = ((plain.len() - self.width) as u64).to_le_bytes();
        let length = &length[..self.width];
        let in_order =
            length.iter().rev().filter(|_| self.big_endian).chain(length.iter().filter(|_| !self.big_endian));
        plain.iter_mut().zip(in_order).for_each(|(byte, of_length)| *byte = *of_length);
        Ok(STANDARD.encode(plain))
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
