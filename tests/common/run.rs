//! Runs of scenes, through the library and by the program, and what tests ask of them.

use super::folder::{Folder, Said};
use super::mesh_folder;
use foldwell::Assembly;
use foldwell::output::json::to_json;
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
use std::fs;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Returns the folder of the cases of tests.
pub fn case_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/cases")
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

impl Folder {
    /// Returns a scene in this folder.
    pub fn scene(&self, text: impl Into<String>) -> Scene {
        Scene::new(text).within(self)
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
        serde_json::from_str::<Value>(&to_json(&self.report.summary)).unwrap()["studies"].take()
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
