//! Logs: files that grow by a line for each finished step of a long study, so that a run that is ended at any moment
//! can go on from the last one.
//!
//! The first line is the digest of the run's input. Every other line begins with a check sum of the digest and of all
//! lines up to this one: a log is good up to the first line that was changed, lost, moved or written by another run. A
//! line that a run was writing when it ended has no line break and does not count.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::PathBuf;

use crate::output::{OutputError, files};
use crate::scene::Fingerprint;

/// A log that is being written.
#[derive(Debug)]
pub(super) struct Log {
    path: PathBuf,
    /// Check sum of all lines so far.
    sum: Fingerprint,
}

impl Log {
    /// Begins a log and returns the lines with which it begins: if `resumed`, the good lines of an earlier run with
    /// this digest.
    pub(super) fn begin(path: PathBuf, digest: &str, resumed: bool) -> Result<(Self, Vec<String>), OutputError> {
        let old = if resumed { fs::read(&path).unwrap_or_default() } else { Vec::new() };
        let old = String::from_utf8_lossy(&old);
        let complete = old.rsplit_once('\n').map_or("", |(complete, _)| complete);
        let mut log = Self { path, sum: Fingerprint::default() };
        log.sum.add(digest.as_bytes());
        let (mut text, mut kept) = (format!("{digest}\n"), Vec::new());
        let after_digest = complete.strip_prefix(&text).unwrap_or_default();
        for (sum, line) in after_digest.split('\n').map_while(|written| written.split_once(' ')) {
            let before = log.sum;
            let summed = log.summed(line);
            if summed.split_once(' ').is_none_or(|(expected, _)| expected != sum) {
                log.sum = before;
                break;
            }
            text += &summed;
            kept.push(line.to_owned());
        }
        files::write(&log.path, text)?;
        Ok((log, kept))
    }

    /// Appends a line.
    pub(super) fn append(&mut self, line: &str) -> Result<(), OutputError> {
        let summed = self.summed(line);
        let written =
            OpenOptions::new().append(true).open(&self.path).and_then(|mut file| file.write_all(summed.as_bytes()));
        written.map_err(|source| OutputError::Write { path: self.path.clone(), source })
    }

    /// Adds a line to the check sum; returns it as it is written.
    fn summed(&mut self, line: &str) -> String {
        self.sum.add(line.as_bytes());
        format!("{} {line}\n", self.sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// Begins a log of a resumed run; returns the lines that it keeps.
    fn kept(path: &Path, digest: &str) -> Vec<String> {
        Log::begin(path.into(), digest, true).unwrap().1
    }

    /// A log of some lines in a folder.
    fn log_of(path: &Path, lines: &[&str]) -> Vec<u8> {
        let (mut log, none) = Log::begin(path.into(), "d", false).unwrap();
        assert!(none.is_empty());
        lines.iter().for_each(|line| log.append(line).unwrap());
        fs::read(path).unwrap()
    }

    /// Claim: a log gives back its complete lines, goes on behind them, and is empty for another input.
    #[test]
    fn incomplete_lines_do_not_count() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.jsonl");
        assert!(kept(&path, "d").is_empty());
        let whole = log_of(&path, &["one", "two"]);
        for end in 0..whole.len() {
            fs::write(&path, &whole[..end]).unwrap();
            let breaks = whole[..end].iter().filter(|byte| **byte == b'\n').count();
            assert_eq!(kept(&path, "d"), ["one", "two"][..breaks.saturating_sub(1)], "{end}");
            fs::write(&path, &whole[..end]).unwrap();
            assert!(kept(&path, "e").is_empty());
        }
        fs::write(&path, &whole[..whole.len() - 1]).unwrap();
        let (mut log, lines) = Log::begin(path.clone(), "d", true).unwrap();
        assert_eq!(lines, ["one"]);
        log.append("three").unwrap();
        assert_eq!(kept(&path, "d"), ["one", "three"]);
    }

    /// Claim: a log in which any byte was changed, or a line was taken out, doubled, moved or put in by another run of
    /// the same input, is good up to the line before that.
    #[test]
    fn a_damaged_log_ends_before_the_damage() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.jsonl");
        let lines = ["0.25 a", "0.5 b", "0.75 c"];
        let whole = log_of(&path, &lines);
        for at in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[at] ^= 1;
            fs::write(&path, &bytes).unwrap();
            let breaks = whole[..at].iter().filter(|byte| **byte == b'\n').count();
            assert_eq!(kept(&path, "d"), lines[..breaks.saturating_sub(1)], "byte {at}");
        }
        let text = String::from_utf8(whole).unwrap();
        let written: Vec<&str> = text.lines().collect();
        for (order, good) in
            [([0, 2, 3, 3], 0), ([0, 1, 3, 3], 1), ([0, 2, 1, 3], 0), ([0, 1, 1, 2], 1), ([0, 1, 2, 2], 2)]
        {
            let damaged: String = order.iter().map(|&k| format!("{}\n", written[k])).collect();
            fs::write(&path, damaged).unwrap();
            assert_eq!(kept(&path, "d"), lines[..good], "{order:?}");
        }
    }
}
