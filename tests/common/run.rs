//! Runs of scenes, through the library and by the program, and what tests ask of them.

use super::mesh_folder;
use foldwell::Assembly;
use foldwell::run::{Progress, RunError, RunOptions, RunReport, run_scene};
use foldwell::scene::{SceneError, SceneFile, build, parse};
use foldwell::study::bloch::BlochSummary;
use foldwell::study::landscape::LandscapeSummary;
use foldwell::study::modes::ModesSummary;
use foldwell::study::path::PathSummary;
use foldwell::study::relax::RelaxSummary;
use foldwell::study::response::ResponseSummary;
use foldwell::study::wells::WellsSummary;
use foldwell::study::{StudyResult, StudySummary};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tempfile::TempDir;

/// Returns the folder of the cases of tests.
pub fn case_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/cases")
}

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

    /// Returns a scene in this folder.
    pub fn scene(&self, text: impl Into<String>) -> Scene {
        Scene { folder: self.clone(), ..Scene::new(text) }
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

/// A scene that is to be run: by default in a folder of its own, into `out`. Files of `meshes`, and those of `tests`
/// that it names as `cases/..`, are copied there.
#[derive(Clone)]
pub struct Scene {
    folder: Folder,
    name: String,
    text: String,
    out: String,
    threads: Option<usize>,
    resume: bool,
    most_steps: usize,
}

impl Scene {
    pub fn new(text: impl Into<String>) -> Self {
        let (folder, name, out) = (Folder::new(), "scene".into(), "out".into());
        Self { folder, name, text: text.into(), out, threads: None, resume: false, most_steps: usize::MAX }
    }

    /// Returns a scene of `meshes`.
    pub fn of(name: &str) -> Self {
        let text = fs::read_to_string(mesh_folder().join(format!("{name}.toml"))).unwrap();
        Self { name: name.into(), ..Self::new(text) }
    }

    /// Returns a scene of one sheet with these further lines.
    pub fn on(sheet: &str, rest: &str) -> Self {
        Self::new(format!("[sheet]\n{sheet}\n{rest}\n"))
    }

    /// Checks that it has these words.
    pub fn saying(self, part: &str) -> Self {
        assert!(self.text.contains(part), "{part}");
        self
    }

    pub fn replaced(mut self, old: &str, new: &str) -> Self {
        assert!(self.text.contains(old), "{old}");
        self.text = self.text.replace(old, new);
        self
    }

    /// Adds lines at its end.
    pub fn then(self, lines: &str) -> Self {
        Self { text: self.text + lines, ..self }
    }

    /// Puts a file beside the scene.
    pub fn with(self, name: &str, content: impl AsRef<[u8]>) -> Self {
        self.folder.write(name, content);
        self
    }

    /// Returns the folder in which it is run.
    pub fn folder(&self) -> Folder {
        self.folder.clone()
    }

    pub fn within(self, folder: &Folder) -> Self {
        Self { folder: folder.clone(), ..self }
    }

    /// Gives the file of the scene another name, without its ending.
    pub fn named(self, name: &str) -> Self {
        Self { name: name.into(), ..self }
    }

    pub fn out(self, name: impl Into<String>) -> Self {
        Self { out: name.into(), ..self }
    }

    pub fn threads(self, threads: usize) -> Self {
        Self { threads: Some(threads), ..self }
    }

    pub fn resumed(self) -> Self {
        Self { resume: true, ..self }
    }

    pub fn resumed_if(self, resume: bool) -> Self {
        Self { resume, ..self }
    }

    /// Stops the run after so many reports of its progress.
    pub fn stopped_after(self, steps: usize) -> Self {
        Self { most_steps: steps, ..self }
    }

    /// Writes the scene, and the files that it names; returns its path.
    pub fn written(&self) -> PathBuf {
        for name in self.text.split('"').filter(|word| !word.contains(char::is_whitespace)) {
            let case = name.strip_prefix("cases/").map(|name| case_folder().join(name));
            let source = case.unwrap_or_else(|| mesh_folder().join(name));
            if source.is_file() && !self.folder.has(name) {
                fs::create_dir_all(self.folder.file(name).parent().unwrap()).unwrap();
                self.folder.write(name, fs::read(source).unwrap());
            }
        }
        let file = format!("{}.toml", self.name);
        self.folder.write(&file, &self.text);
        self.folder.file(file)
    }

    /// Writes the scene, and the files that it names; returns their folder.
    pub fn placed(&self) -> Folder {
        self.written();
        self.folder()
    }

    pub fn options(&self) -> RunOptions {
        RunOptions { out: Some(self.folder.file(&self.out)), threads: self.threads, resume: self.resume }
    }

    pub fn observed(&self, observer: &(dyn Fn(&Progress) -> ControlFlow<()> + Sync)) -> Result<Ran, RunError> {
        let report = run_scene(&self.written(), &self.options(), observer)?;
        assert!(self.resume || report.kept.is_empty(), "{:?}", report.kept);
        Ok(Ran { report, out: self.folder.inner(&self.out), folder: self.folder.clone() })
    }

    /// Runs it through the library.
    pub fn tried(&self) -> Result<Ran, RunError> {
        let seen = AtomicUsize::new(0);
        self.observed(&|_| {
            let go_on = seen.fetch_add(1, Ordering::Relaxed) < self.most_steps;
            if go_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        })
    }

    /// Runs it through the library, which does not refuse it.
    pub fn ran(&self) -> Ran {
        self.tried().unwrap_or_else(|error| panic!("{error}"))
    }

    /// Runs it through the library; every study converges.
    pub fn converged(&self) -> Ran {
        let ran = self.ran();
        for study in &ran.report.summary.studies {
            assert!(study.converged, "{}: {:?}", study.name, study.reason);
        }
        ran
    }

    /// Checks that it is refused with this message and status 2, and that nothing is written; returns the message.
    pub fn refused(&self, expected: &str) -> String {
        let Err(error) = self.tried() else { panic!("not refused: {expected}") };
        assert!(error.to_string().contains(expected), "{expected}: {error}");
        assert!(error.exit_status() == 2 && !self.folder.has(&self.out), "{error}");
        error.to_string()
    }

    /// Returns the scene as it is read, and its assembly.
    pub fn assembled(&self) -> Result<(SceneFile, Assembly), SceneError> {
        let file = parse(&self.text, self.written())?;
        let assembly = build::assembly(&file)?;
        Ok((file, assembly))
    }

    /// Runs it by the program, with these further words.
    pub fn program(&self, words: &str) -> Said {
        self.written();
        let file = format!("{}.toml", self.name);
        let first = ["run", &file, "--out", &self.out].into_iter().chain(self.resume.then_some("--resume"));
        let said = self.folder.program(&first.chain(words.split_whitespace()).collect::<Vec<_>>());
        Said { folder: self.folder.inner(&self.out), ..said }
    }
}

/// A run through the library.
pub struct Ran {
    pub report: RunReport,
    /// The folder of its files.
    pub out: Folder,
    /// The folder of the scene.
    pub folder: Folder,
}

impl Ran {
    pub fn study(&self, name: &str) -> &StudySummary {
        let found = self.report.summary.studies.iter().find(|study| study.name == name);
        found.unwrap_or_else(|| panic!("no study {name}"))
    }

    /// Returns the studies as `summary.json` has them.
    pub fn json(&self) -> Value {
        serde_json::from_str::<Value>(&self.report.summary.to_json()).unwrap()["studies"].take()
    }
}

/// Defines methods that return the results of a study of one kind.
macro_rules! results {
    ($($name:ident: $variant:ident($summary:ty)),* $(,)?) => {
        impl Ran {
            $(pub fn $name(&self, study: &str) -> &$summary {
                match &self.study(study).result {
                    Some(StudyResult::$variant(found)) => found,
                    other => panic!("{study}: {other:?}, {:?}", self.study(study).reason),
                }
            })*
        }
    };
}
results! {
    bloch: Bloch(BlochSummary),
    landscape: Landscape(LandscapeSummary),
    modes: Modes(ModesSummary),
    path: Path(PathSummary),
    relaxed: Relax(RelaxSummary),
    response: Response(ResponseSummary),
    wells: Wells(WellsSummary),
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
