//! Files that appear whole or not at all.
//!
//! A file is written beside its place under a name of its own and then renamed, which is one step for whoever looks at
//! the folder. What is on its way when a write fails is removed. (Nothing is forced to the disk: this guards against
//! programs that stop, not against a loss of power.) Who writes a file holds a lock on it, which ends with the program,
//! so that what a stopped program left can be told from what another one writes just now.

use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use tempfile::NamedTempFile;

use super::OutputError;

/// The ending of files on their way.
const DRAFT_ENDING: &str = ".part";

/// Writes a file, with the folders it needs.
///
/// # Errors
/// [`OutputError::Write`]; then the file is as it was before.
pub fn write(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), OutputError> {
    write_with(path, |file| file.write_all(contents.as_ref()))
}

/// Writes what `fill` puts into a file, with the folders it needs.
///
/// # Errors
/// [`OutputError::Write`], also where `fill` fails; then the file is as it was before.
pub(crate) fn write_with(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), OutputError> {
    replace(path, fill).map_err(|source| OutputError::Write { path: path.into(), source })
}

fn replace(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let draft = draft(path)?;
    let mut file = BufWriter::new(draft.as_file());
    fill(&mut file)?;
    file.into_inner().map_err(io::IntoInnerError::into_error)?;
    draft.persist(path)?;
    Ok(())
}

/// A locked file beside `path`, with a name that nobody else uses; it is removed when dropped. Between its creation and its
/// lock [`remove_drafts`] may take it: then there is another.
fn draft(path: &Path) -> io::Result<NamedTempFile> {
    let name = path.file_name().ok_or_else(|| io::Error::from(io::ErrorKind::InvalidFilename))?;
    let prefix = format!(".{}.{}-", name.to_string_lossy(), std::process::id());
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(DRAFT_ENDING);
    // files of results are for everybody whom the user lets read them
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    loop {
        let draft = builder.tempfile_in(path.parent().unwrap_or(Path::new("")))?;
        let taken = matches!(draft.as_file().try_lock(), Err(TryLockError::WouldBlock));
        if !taken && draft.path().exists() {
            return Ok(draft);
        }
    }
}

/// Removes what programs that were stopped have left in a folder on its way; nothing else, and no folder is no fault. Where
/// files cannot be locked, it stays.
pub(crate) fn remove_drafts(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if is_draft(&entry.file_name().to_string_lossy()) {
            let _ = remove_unlocked(&entry.path());
        }
    }
}

/// Removes what this program itself has on its way in a folder, before it ends without waiting for its other threads.
pub(crate) fn remove_own_drafts(folder: &Path) {
    let own = format!(".{}-", std::process::id());
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if is_draft(&name) && name.contains(&own) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Removes a file that no program holds a lock on.
fn remove_unlocked(path: &Path) -> io::Result<()> {
    let file = File::open(path)?;
    file.try_lock()?;
    fs::remove_file(path)
}

/// Whether a name is one of [`draft`].
fn is_draft(name: &str) -> bool {
    let all = |text: &str, kind: fn(&u8) -> bool| !text.is_empty() && text.as_bytes().iter().all(kind);
    let middle = name.strip_prefix('.').and_then(|name| name.strip_suffix(DRAFT_ENDING));
    let parts = middle.and_then(|name| name.rsplit_once('.')).and_then(|(_, parts)| parts.split_once('-'));
    parts.is_some_and(|(process, random)| all(process, u8::is_ascii_digit) && all(random, u8::is_ascii_alphanumeric))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    /// A write makes its folders and leaves one file.
    #[test]
    fn a_file_appears_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b.txt");
        write(&path, "one").unwrap();
        write(&path, "two").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "two");
        assert_eq!(names(&folder.path().join("a")), ["b.txt"]);
    }

    /// A write that fails half-way leaves the old file and nothing else.
    #[test]
    fn a_failed_write_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("b.txt");
        write(&path, "old").unwrap();
        let result = write_with(&path, |file| {
            file.write_all(&[b'x'; 100_000])?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        });
        assert!(matches!(result, Err(OutputError::Write { .. })));
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(names(folder.path()), ["b.txt"]);
    }

    /// What a stopped program leaves is removed, and nothing that only looks like it.
    #[test]
    fn drafts_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let (_, draft) = draft(&folder.path().join("b.txt")).unwrap().keep().unwrap();
        let others = [".b.txt.part", "b.txt.1-2.part", ".b.txt.x-1.part", ".b.1-2.txt"];
        for name in others {
            fs::write(folder.path().join(name), "").unwrap();
        }
        remove_drafts(folder.path());
        remove_drafts(&folder.path().join("none"));
        assert!(!draft.exists());
        assert_eq!(names(folder.path()).len(), others.len());
    }

    /// What is written just now is not removed, at whatever moment somebody clears the folder.
    #[test]
    fn drafts_of_others_stay() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("b.txt");
        write_with(&path, |file| {
            remove_drafts(folder.path());
            file.write_all(b"whole")
        })
        .unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "whole");
        let done = AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while !done.load(Ordering::Relaxed) {
                    remove_drafts(folder.path());
                }
            });
            let faults = (0..10_000).filter(|round: &u32| write(&path, round.to_string()).is_err()).count();
            done.store(true, Ordering::Relaxed);
            assert_eq!(faults, 0);
        });
        assert_eq!(names(folder.path()), ["b.txt"]);
    }

    /// A folder in the place of the file, and a file in the place of a folder, are errors that name the file.
    #[test]
    fn places_that_cannot_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let message = write(folder.path(), "x").unwrap_err().to_string();
        assert!(message.contains(folder.path().to_str().unwrap()), "{message}");
        write(&folder.path().join("file"), "x").unwrap();
        assert!(write(&folder.path().join("file/below"), "x").is_err());
        assert_eq!(names(folder.path()), ["file"]);
    }
}
