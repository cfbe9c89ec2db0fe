//! Reading whole files, with a limit on their size and without waiting for devices or pipes.

use encoding_rs::{Encoding, SHIFT_JIS, UTF_8};
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Size in bytes of the longest file that is read.
const MOST_BYTES: u64 = 1 << 30;

/// Returns the bytes of a regular file or of standard input (`/dev/stdin`).
pub(crate) fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    let standard_input = ["/dev/stdin", "/dev/fd/", "/proc/self/fd/"];
    let named = path.to_string_lossy();
    let known = standard_input.iter().any(|start| named.starts_with(start));
    let about = std::fs::metadata(path)?;
    if about.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if !known && !about.is_file() {
        return Err(wrong("this is a device or a pipe, and a regular file is expected"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        Err(wrong("it is longer than 1 GiB, which is the most that is read"))
    } else {
        Ok(bytes)
    }
}

/// Returns the text of a file.
pub(crate) fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read_bytes(path)?).map_err(|error| {
        let good = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..good].iter().filter(|&&byte| byte == b'\n').count() + 1;
        wrong(&format!("line {line} is not UTF-8, the encoding that is expected"))
    })
}

/// Returns the text of a drawing: UTF-8, UTF-16 that begins with its mark, or Shift-JIS, in which a letter may end with the
/// byte of a backslash. In other encodings what is drawn is ASCII, and letters of titles and comments that are not are
/// replacement characters.
pub(crate) fn read_drawing(path: &Path) -> io::Result<String> {
    let bytes = read_bytes(path)?;
    let marked_or_utf8 = Encoding::for_bom(&bytes).is_some() || std::str::from_utf8(&bytes).is_ok();
    let japanese = SHIFT_JIS.decode_without_bom_handling_and_without_replacement(&bytes).filter(|_| !marked_or_utf8);
    Ok(japanese.unwrap_or_else(|| UTF_8.decode(&bytes).0).into_owned())
}

/// Returns the line and column, from 1, of a place in a text, which is given in bytes.
pub(crate) fn line_and_column(text: &str, offset: usize) -> [usize; 2] {
    let before = &text.as_bytes()[..offset.min(text.len())];
    let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |at| at + 1);
    let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
    [line, String::from_utf8_lossy(&before[line_start..]).chars().count() + 1]
}

/// Returns a text that is cut after this number of characters.
pub(crate) fn shortened(text: &str, length: usize) -> String {
    let end = text.char_indices().nth(length);
    end.map_or_else(|| text.to_owned(), |(end, _)| format!("{}...", &text[..end]))
}

fn wrong(message: &str) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, message)
}
