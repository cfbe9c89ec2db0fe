//! Claims on folders: of several programs that would write into one folder at the same time, one writes and the others
//! are told.
//!
//! A claim is a draft that never becomes a file. Its name has its purpose, and its lock ends with its program: the
//! claim of a program that was killed keeps nobody out, and is removed like any other draft. (On disks without file
//! locks nobody is kept out.)

use std::fs::{self, File, OpenOptions, TryLockError};
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use tempfile::NamedTempFile;

use super::OutputError;
use super::files::{draft, process_of};

/// Ending of the names of claims, before the process.
const CLAIM_ENDING: &str = ".claim";
/// The purpose of a claim that bears no other claim.
const ALONE: &str = "alone";
/// Number of attempts to be the only program that claims a folder at this moment, and the time between two of them. The
/// lock of the folder is one that a user may hold for reasons of their own.
const ATTEMPTS: usize = 1000;
const BETWEEN_ATTEMPTS: Duration = Duration::from_millis(1);

/// A claim on a folder, which ends when it is dropped.
#[derive(Debug)]
pub(crate) struct Claim {
    _draft: NamedTempFile,
}

impl Claim {
    /// Claims a folder, which is created if it does not exist: alone, or together with all claims for the same
    /// `purpose`.
    pub(crate) fn on(folder: &Path, purpose: Option<&str>) -> Result<Self, OutputError> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let failed = |source| OutputError::Write { path: folder.into(), source };
        fs::create_dir_all(folder).map_err(failed)?;
        let _turn = turn(folder);
        let own = draft(&folder.join(format!("{}{CLAIM_ENDING}", purpose.unwrap_or(ALONE)))).map_err(failed)?;
        for entry in fs::read_dir(folder).map_err(failed)?.flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            let Some((for_what, process)) = parts(&name) else { continue };
            let is_own = own.path().file_name().is_some_and(|own| *own == *name);
            if !is_own && purpose != Some(for_what) && is_locked(&entry.path()) {
                return Err(OutputError::Claimed { path: folder.into(), process });
            }
        }
        Ok(Self { _draft: own })
    }
}

/// Waits for the turn to claim a folder: of two programs that do so at the same moment one has it, and not none.
fn turn(folder: &Path) -> Option<File> {
    let folder = File::open(folder).ok()?;
    let has_turn = |attempt: usize| {
        sleep(if attempt == 0 { Duration::ZERO } else { BETWEEN_ATTEMPTS });
        folder.try_lock().is_ok()
    };
    (0..ATTEMPTS).any(has_turn).then_some(folder)
}

/// Returns the purpose of a claim and the number of its process from the name of its file; `None` for other files.
fn parts(name: &str) -> Option<(&str, u32)> {
    let purpose = name.strip_prefix('.')?.split_once(&format!("{CLAIM_ENDING}."))?.0;
    Some((purpose, process_of(name)?.parse().ok()?))
}

/// Whether a program holds a lock on a file.
fn is_locked(path: &Path) -> bool {
    // some network disks lock only files that are open for writing
    let file = OpenOptions::new().write(true).open(path);
    file.is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
}

#[cfg(test)]
mod tests {
    use super::super::files::remove_drafts;
    use super::*;

    /// Claim: a folder has one claim alone, or several for one purpose; the error names folder and process, and leaves
    /// no file; a claim that has ended, or whose program was killed, keeps nobody out, and stays while it is held.
    #[test]
    fn a_folder_has_claims_of_one_purpose() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("a/b");
        let claims = || fs::read_dir(&folder).unwrap().count();
        let alone = Claim::on(&folder, None).unwrap();
        for purpose in [None, Some("one")] {
            let message = Claim::on(&folder, purpose).unwrap_err().to_string();
            let words = [folder.display().to_string(), std::process::id().to_string()];
            assert!(words.iter().all(|word| message.contains(word)), "{message}");
        }
        remove_drafts(&folder);
        assert_eq!(claims(), 1);
        drop(alone);
        let shared = [Claim::on(&folder, Some("one")).unwrap(), Claim::on(&folder, Some("one")).unwrap()];
        assert!(Claim::on(&folder, None).is_err() && Claim::on(&folder, Some("two")).is_err());
        assert_eq!(claims(), 2);
        drop(shared);
        let killed = draft(&folder.join(format!("{ALONE}{CLAIM_ENDING}"))).unwrap().keep().unwrap();
        drop(killed); // the lock ends, the file stays
        assert_eq!(claims(), 1);
        drop(Claim::on(&folder, Some("two")).unwrap());
        remove_drafts(&folder);
        assert_eq!(claims(), 0);
    }

    /// Claim: of several threads that claim one folder alone at the same moment, exactly one has it.
    #[test]
    fn one_of_many_has_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        for _ in 0..20 {
            let start = std::sync::Barrier::new(4);
            let claims = std::thread::scope(|scope| {
                let claim = || {
                    start.wait();
                    Claim::on(folder.path(), None).ok()
                };
                let threads: Vec<_> = (0..4).map(|_| scope.spawn(claim)).collect();
                threads.into_iter().map(|thread| thread.join().unwrap()).collect::<Vec<_>>()
            });
            assert_eq!(claims.iter().flatten().count(), 1);
        }
    }
}
