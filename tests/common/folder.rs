//! Temporary folders, what the program says in them, and the tables there.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::Arc;
use tempfile::TempDir;

/// Paths below a folder and the bytes of the files there; of `summary.json` without times.
pub type Files = BTreeMap<PathBuf, Vec<u8>>;

/// A temporary folder, or one inside it; it is removed with its last copy.
#[derive(Clone)]
pub struct Folder {
    kept: Arc<TempDir>,
    path: PathBuf,
}

impl Folder {
    pub fn new() -> Self {
        let kept = Arc::new(tempfile::tempdir().unwrap());
        Self { path: kept.path().to_owned(), kept }
    }

    /// Returns the folder with a file more.
    pub fn with(self, name: &str, content: impl AsRef<[u8]>) -> Self {
        self.write(name, content);
        self
    }

    /// Returns the folder of this name inside it.
    pub fn inner(&self, name: &str) -> Self {
        Self { kept: self.kept.clone(), path: self.file(name) }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the path of a file.
    pub fn file(&self, name: impl AsRef<Path>) -> PathBuf {
        self.path.join(name)
    }

    pub fn has(&self, name: impl AsRef<Path>) -> bool {
        self.file(name).exists()
    }

    pub fn write(&self, name: impl AsRef<Path>, content: impl AsRef<[u8]>) {
        fs::write(self.file(name), content).unwrap();
    }

    pub fn bytes(&self, name: impl AsRef<Path>) -> Vec<u8> {
        let path = self.file(name);
        fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    pub fn text(&self, name: impl AsRef<Path>) -> String {
        String::from_utf8(self.bytes(name)).unwrap()
    }

    pub fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.bytes(name)).unwrap()
    }

    /// Returns the studies of `summary.json`.
    pub fn studies(&self) -> Vec<Value> {
        self.json("summary.json")["studies"].as_array().unwrap().clone()
    }

    pub fn table(&self, name: &str) -> Table {
        Table::new(&self.text(name))
    }

    /// Returns the names in the folder, in order.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.path).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Returns all files below the folder; none if it does not exist.
    pub fn files(&self) -> Files {
        let (mut found, mut folders) = (Files::new(), vec![self.path.clone()]);
        while let Some(folder) = folders.pop() {
            for path in fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()) {
                if path.is_dir() {
                    folders.push(path);
                    continue;
                }
                let bytes = fs::read(&path).unwrap();
                let bytes = if path.ends_with("summary.json") { timeless(&bytes) } else { bytes };
                found.insert(path.strip_prefix(&self.path).unwrap().to_owned(), bytes);
            }
        }
        found
    }

    /// Checks that another folder has the same files.
    pub fn assert_same(&self, other: &Self, what: &str) {
        let (found, expected) = (self.files(), other.files());
        assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>(), "{what}");
        for (name, bytes) in &expected {
            assert!(found[name] == *bytes, "{what}: {} differs", name.display());
        }
    }

    /// Runs the program here with these words, which spaces divide.
    pub fn foldwell(&self, words: &str) -> Said {
        self.program(&words.split_whitespace().collect::<Vec<_>>())
    }

    pub fn program(&self, words: &[&str]) -> Said {
        Said::by(self.command(words).stdin(Stdio::null()), self)
    }

    /// Returns the program with these words, not yet started.
    pub fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_foldwell"));
        command.current_dir(&self.path).args(words).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }
}

/// Returns a summary without the lines of the times of its studies.
fn timeless(bytes: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(bytes);
    let is_time = |line: &&str| line.trim_start().starts_with("\"seconds\"");
    let (times, kept): (Vec<&str>, Vec<&str>) = text.split_inclusive('\n').partition(is_time);
    let mut numbers = times.iter().map(|line| line.trim().trim_start_matches("\"seconds\": ").trim_end_matches(','));
    assert!(numbers.all(|number| number.parse::<f64>().is_ok_and(|time| time >= 0.0)), "{times:?}");
    kept.concat().into_bytes()
}

/// What the program said, and where it ran.
#[derive(Debug)]
pub struct Said {
    pub status: Option<i32>,
    pub out: String,
    pub err: String,
    /// The folder with the files of a run of a [`Scene`], otherwise the current one of the program.
    pub folder: Folder,
}

impl std::fmt::Debug for Folder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.path.fmt(f)
    }
}

impl Said {
    /// Runs a command to its end.
    pub fn by(command: &mut Command, folder: &Folder) -> Self {
        Self::of(command.output().unwrap(), folder)
    }

    /// Waits for a program that has been started in a folder.
    pub fn last(child: Child, folder: &Folder) -> Self {
        Self::of(child.wait_with_output().unwrap(), folder)
    }

    fn of(output: Output, folder: &Folder) -> Self {
        let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        Self { status: output.status.code(), out, err, folder: folder.clone() }
    }

    /// Returns standard output and standard error.
    pub fn all(&self) -> String {
        format!("{}{}", self.out, self.err)
    }

    /// Checks the exit status.
    pub fn ends(self, status: i32) -> Self {
        assert_eq!(self.status, Some(status), "{}", self.all());
        self
    }

    /// Checks that it ended with status 0.
    pub fn well(self) -> Self {
        self.ends(0)
    }

    /// Checks that it ended with status 2 and this in its message.
    pub fn refused(self, part: &str) -> Self {
        assert!(self.status == Some(2) && self.err.contains(part), "{part}: {:?} {}", self.status, self.err);
        self
    }

    /// Returns its standard output as JSON.
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|error| panic!("{error}: {}", self.out))
    }
}

/// Sends a signal to a program.
pub fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

/// A table that a study has written.
#[derive(Clone, Debug)]
pub struct Table {
    pub header: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub fn new(text: &str) -> Self {
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect());
        Self { header: lines.next().expect("a header"), rows: lines.collect() }
    }

    pub fn len(&self) -> usize {
        self.rows.len()
    }

    pub fn place(&self, column: &str) -> usize {
        let place = self.header.iter().position(|name| name == column);
        place.unwrap_or_else(|| panic!("no column {column} among {:?}", self.header))
    }

    pub fn field(&self, row: usize, column: &str) -> &str {
        &self.rows[row][self.place(column)]
    }

    /// Returns the number in a row of a column; not a number where there is none.
    pub fn at(&self, row: usize, column: &str) -> f64 {
        self.field(row, column).parse().unwrap_or(f64::NAN)
    }

    pub fn last(&self, column: &str) -> f64 {
        self.at(self.len() - 1, column)
    }

    pub fn column(&self, name: &str) -> Vec<f64> {
        (0..self.len()).map(|row| self.at(row, name)).collect()
    }

    /// Returns all numbers, row by row.
    pub fn numbers(&self) -> Vec<Vec<f64>> {
        let row = |row: &Vec<String>| row.iter().map(|field| field.parse().unwrap_or(f64::NAN)).collect();
        self.rows.iter().map(row).collect()
    }
}
