//! Logs: files that grow by a line for each finished step of a long study, so that a run that is ended at any moment can go
//! on from the last one.
//!
//! The first line is the digest of the run's input. A line that a run was writing when it ended has no line break and does
//! not count.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;

use crate::output::{OutputError, files};

/// Returns the complete lines of a log after the first; none if there is no log, or if it is that of another input.
pub(super) fn lines(path: &Path, digest: &str) -> Vec<String> {
    let text = fs::read(path).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let Some((complete, _)) = text.rsplit_once('\n') else { return vec![] };
    let mut lines = complete.split('\n').map(str::to_owned);
    if lines.next().is_some_and(|first| first == digest) { lines.collect() } else { vec![] }
}

/// Begins a log with these lines.
pub(super) fn begin(path: &Path, digest: &str, lines: &[String]) -> Result<(), OutputError> {
    let text: String =
        std::iter::once(digest).chain(lines.iter().map(String::as_str)).flat_map(|l| [l, "\n"]).collect();
    files::write(path, text)
}

/// Appends a line.
pub(super) fn append(path: &Path, line: &str) -> Result<(), OutputError> {
    let written =
        OpenOptions::new().append(true).open(path).and_then(|mut file| file.write_all(format!("{line}\n").as_bytes()));
    written.map_err(|source| OutputError::Write { path: path.into(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: a log gives back its complete lines, goes on behind them, and is empty for another input.
    #[test]
    fn incomplete_lines_do_not_count() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.jsonl");
        assert!(lines(&path, "d").is_empty());
        begin(&path, "d", &[]).unwrap();
        append(&path, "one").unwrap();
        append(&path, "two").unwrap();
        let whole = fs::read(&path).unwrap();
        for end in 0..whole.len() {
            fs::write(&path, &whole[..end]).unwrap();
            let found = lines(&path, "d");
            let breaks = whole[..end].iter().filter(|byte| **byte == b'\n').count();
            assert_eq!(found, ["one", "two"][..breaks.saturating_sub(1)], "{end}");
            assert!(lines(&path, "e").is_empty());
        }
        begin(&path, "d", &lines(&path, "d")).unwrap();
        append(&path, "three").unwrap();
        assert_eq!(lines(&path, "d"), ["one", "three"]);
    }
}
