//! Writing of files that appear complete or not at all.
//!
//! A file is written in the folder of its destination under a temporary name, a *draft*, and then renamed in one atomic
//! step. If a write fails, its draft is removed. (Data are not flushed to the disk: this protects against programs that
//! stop, not against a loss of power.) The writer holds a lock on its draft; the lock ends with the program, so that
//! drafts left by a stopped program can be distinguished from those that another program is writing.

use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

use super::OutputError;

/// File name extension of drafts.
const DRAFT_ENDING: &str = ".part";

/// Writes a file, and creates the folders on its path if they do not exist.
///
/// # Errors
/// [`OutputError::Write`]; the file is then as it was before.
pub fn write(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), OutputError> {
    write_with(path, |file| file.write_all(contents.as_ref()))
}

/// Writes the bytes that `fill` writes to its argument into a file, and creates the folders on its path if they do not
/// exist.
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

/// Creates a locked draft in the folder of `path`, with a unique name; it is removed when dropped. If [`remove_drafts`]
/// removes the draft between its creation and its locking, another one is created.
pub(super) fn draft(path: &Path) -> io::Result<NamedTempFile> {
    let name = path.file_name().ok_or_else(|| io::Error::from(io::ErrorKind::InvalidFilename))?;
    let prefix = format!(".{}.{}-", name.to_string_lossy(), std::process::id());
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(DRAFT_ENDING);
    // the final file has these permissions, so that others can read it if the user's umask allows it
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

/// Removes a file, if it is there.
pub(crate) fn remove(path: &Path) -> Result<(), OutputError> {
    match fs::remove_file(path) {
        Err(source) if !matches!(source.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            Err(OutputError::Write { path: path.into(), source })
        }
        _ => Ok(()),
    }
}

/// Returns the drafts in a folder, each with the number of the process that made it; none if there is no folder.
fn drafts(folder: &Path) -> impl Iterator<Item = (PathBuf, String)> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter_map(|entry| Some((entry.path(), process_of(&entry.file_name().to_string_lossy())?.to_owned())))
}

/// Removes the drafts that stopped programs have left in a folder, and no other file. It does nothing if the folder
/// does not exist. On systems without file locks the drafts stay.
pub(crate) fn remove_drafts(folder: &Path) {
    drafts(folder).for_each(|(path, _)| _ = remove_unlocked(&path));
}

/// Removes the drafts of this program in a folder, before it exits without waiting for its other threads.
pub(crate) fn remove_own_drafts(folder: &Path) {
    let own = std::process::id().to_string();
    drafts(folder).filter(|(_, process)| *process == own).for_each(|(path, _)| _ = fs::remove_file(path));
}

/// Removes a file unless a program holds a lock on it.
fn remove_unlocked(path: &Path) -> io::Result<()> {
    let file = File::open(path)?;
    file.try_lock()?;
    fs::remove_file(path)
}

/// Returns the number of the process in a name that [`draft`] made; `None` for names of another form.
pub(super) fn process_of(name: &str) -> Option<&str> {
    let all = |text: &str, kind: fn(&u8) -> bool| !text.is_empty() && text.as_bytes().iter().all(kind);
    let (_, parts) = name.strip_prefix('.')?.strip_suffix(DRAFT_ENDING)?.rsplit_once('.')?;
    let (process, random) = parts.split_once('-')?;
    (all(process, u8::is_ascii_digit) && all(random, u8::is_ascii_alphanumeric)).then_some(process)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    /// A write creates missing folders, replaces an existing file, and leaves no other file.
    #[test]
    fn a_file_appears_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b.txt");
        write(&path, "one").unwrap();
        write(&path, "two").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "two");
        assert_eq!(names(&folder.path().join("a")), ["b.txt"]);
    }

    /// A write that fails half-way leaves the old file unchanged, and no draft.
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

    /// Drafts of a stopped program are removed, and files with similar names are not.
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

    /// A draft that is being written is not removed by a simultaneous `remove_drafts`.
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

    /// A folder at the path of the file, and a file at the path of a folder, are errors; the message names the file.
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
