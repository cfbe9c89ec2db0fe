//! Assemblies: sheets with boundary conditions and terms, and the studies of them.

use crate::answer::{Answer, answers};
use crate::arrays::{Array2, KeptArrays, kept, rows, unkept};
use crate::errors::{ARGUMENTS, argument, raise, refused};
use crate::forms::Forms;
use crate::run::Given;
use crate::sheet::Sheet;
use crate::term::CalledTerm;
use crate::values::{scene_of, text};
use crate::watch::watched;
use foldwell::model::Domain;
use foldwell::run::{self, RunError};
use foldwell::scene::{Arrays, SceneFile, build, parse};
use foldwell::study::PreviousAnswers;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use toml::{Table, Value};

/// A sheet with its boundary conditions and terms; see `foldwell.Assembly`.
#[pyclass(frozen, module = "foldwell._foldwell", subclass)]
pub(crate) struct Assembly {
    pub assembly: foldwell::Assembly,
    /// The scene of the assembly without studies.
    scene: Table,
    /// The path of the scene, to which paths in it are relative.
    path: PathBuf,
    /// The arrays in the scene.
    arrays: Arrays,
    /// The terms whose energy is a function in Python.
    called: Vec<CalledTerm>,
}

/// Content of a pickled assembly: text of the scene, its path, the sheet, arrays by name, and terms.
type Kept<'py> = (String, PathBuf, Sheet, KeptArrays<'py>, Vec<KeptTerm>);
/// Content of a pickled term: name, vertices of each element, function.
type KeptTerm = (String, Vec<Vec<usize>>, Py<PyAny>);

impl Assembly {
    /// Builds the assembly of a scene, of which `sheet`, if there is one, replaces the mesh.
    pub(crate) fn of(py: Python<'_>, file: SceneFile, sheet: Option<&Bound<'_, Sheet>>) -> PyResult<Self> {
        let sheet = sheet.map(|sheet| sheet.get().sheet.clone());
        let mut scene: Table = file.text().parse().unwrap_or_default(); // it was read before
        scene.retain(|key, _| key != "study" && key != "sweep");
        let stem = file.path().file_stem().unwrap_or_default().to_string_lossy().into_owned();
        scene.entry("title").or_insert_with(|| stem.into());
        let (path, arrays) = (file.path().to_owned(), file.arrays().clone());
        let built = watched(py, None, move |_| match sheet {
            Some(sheet) => build::assembly_of(&file, sheet),
            None => build::assembly(&file),
        })?;
        let assembly = built.map_err(|error| raise(py, &error.into()))?;
        Ok(Self { assembly, scene, path, arrays, called: Vec::new() })
    }

    /// Returns the same assembly with one more term.
    fn with_called(&self, py: Python<'_>, term: CalledTerm) -> PyResult<Self> {
        let assembly = term.added_to(py, &self.assembly)?;
        let called = self.called.iter().map(|term| term.clone_ref(py)).chain([term]).collect();
        let Self { scene, path, arrays, .. } = self;
        Ok(Self { assembly, scene: scene.clone(), path: path.clone(), arrays: arrays.clone(), called })
    }

    /// Raises the exception that has ended a function of the terms.
    pub(crate) fn raise_failures(&self) -> PyResult<()> {
        self.called.iter().try_for_each(CalledTerm::raise)
    }
}

/// Whether the coordinates of a state of one assembly are those of a state of the other: the same vertices, joined in
/// the same way.
fn has_same_coordinates(one: &foldwell::Assembly, other: &foldwell::Assembly) -> bool {
    let seam = |assembly: &foldwell::Assembly| match assembly.domain() {
        Domain::Tube { seam, .. } => Some(*seam),
        _ => None,
    };
    let joined = |assembly: &foldwell::Assembly| (assembly.drawn().coordinates.len(), seam(assembly));
    let (of_one, of_other) = (one.tiling(), other.tiling());
    joined(one) == joined(other) && (&of_one.edges, &of_one.triangles) == (&of_other.edges, &of_other.triangles)
}

#[pymethods]
impl Assembly {
    /// Builds the assembly of a scene.
    #[new]
    fn new(py: Python<'_>, scene: Given<'_>, base: PathBuf, settings: &Bound<'_, PyDict>) -> PyResult<Self> {
        Self::of(py, scene.read(py, &base, settings)?, None)
    }

    /// Builds the assembly of a sheet with the terms and boundary conditions of a scene that is made of arguments.
    #[staticmethod]
    fn of_arguments(py: Python<'_>, scene: &Bound<'_, PyDict>, sheet: &Bound<'_, Sheet>) -> PyResult<Self> {
        let (table, arrays) = scene_of(scene, argument)?;
        let file = parse(&text(&table)?, ARGUMENTS).map_err(|error| raise(py, &error.into()))?;
        Self::of(py, file.with_arrays(arrays), Some(sheet))
    }

    /// Computes studies, given as the list `study` of a scene. `earlier` are answers from which they start, by the
    /// names of their studies, which are among them too. Returns the summary as JSON, the answers, and whether the run
    /// was interrupted.
    fn compute(
        slf: &Bound<'_, Self>,
        studies: &Bound<'_, PyDict>,
        earlier: Vec<(String, Py<Answer>)>,
        threads: Option<usize>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(String, Vec<Answer>, bool)> {
        let (py, this) = (slf.py(), slf.get());
        let mut states = HashMap::new();
        for (name, answer) in &earlier {
            let Answer { saved, assembly, .. } = answer.get();
            let Some(saved) = saved else {
                let help = "studies that find an equilibrium or follow a path end in one";
                return Err(refused(py, "the start is a study that ended in no state".to_owned(), help));
            };
            if !has_same_coordinates(&assembly.get().assembly, &this.assembly) {
                let help = "vertices, edges, cells and boundary conditions are the same; stiffnesses, rest angles and locks may \
                            be others";
                return Err(refused(py, "the start is a state of another assembly".to_owned(), help));
            }
            states.insert(name.clone(), saved.carried(&assembly.get().assembly, &this.assembly));
        }
        let earlier = PreviousAnswers { states, ..PreviousAnswers::default() };
        let (studies, arrays) = scene_of(studies, argument)?;
        let mut scene = this.scene.clone();
        scene.extend(studies);
        let file = parse(&text(&scene)?, this.path.with_file_name(ARGUMENTS));
        let file = file.map_err(|error| raise(py, &error.into()))?.with_arrays(arrays);
        let assembly = this.assembly.clone();
        let work = move |observer: run::Observer<'_>| run::compute(&file, &assembly, earlier, threads, observer);
        let computed: Result<_, RunError> = watched(py, progress, work)?;
        this.raise_failures()?;
        answers(py, slf.as_unbound(), computed)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Kept<'py>)> {
        let (py, Self { assembly, scene, path, arrays, called }) = (slf.py(), slf.get());
        let sheet = Sheet { sheet: assembly.sheet().clone() };
        let of_term = |term: &CalledTerm| (term.name.clone(), term.elements.clone(), term.function.clone_ref(py));
        let called = called.iter().map(of_term).collect();
        let state = (text(scene)?, std::path::absolute(path)?, sheet, kept(py, arrays), called);
        Ok((slf.get_type().getattr("restore")?, state))
    }

    /// Makes the assembly of what a pickle has kept.
    #[staticmethod]
    fn restore(
        py: Python<'_>,
        scene: &str,
        path: PathBuf,
        sheet: &Bound<'_, Sheet>,
        arrays: KeptArrays<'_>,
        called: Vec<KeptTerm>,
    ) -> PyResult<Self> {
        let file = parse(scene, &path).map_err(|error| raise(py, &error.into()))?;
        let bare = Self::of(py, file.with_arrays(unkept(arrays)?), Some(sheet))?;
        let mut terms = called.into_iter().map(|(name, elements, function)| CalledTerm::new(name, elements, function));
        terms.try_fold(bare, |assembly, term| assembly.with_called(py, term))
    }

    /// Returns the same assembly with a term whose energy is a function of the positions of the vertices of each
    /// element.
    fn with_term(
        &self,
        py: Python<'_>,
        name: String,
        elements: Vec<Vec<usize>>,
        function: Py<PyAny>,
    ) -> PyResult<Self> {
        self.with_called(py, CalledTerm::new(name, elements, function))
    }

    /// Returns the energy as a function of the unknowns.
    fn forms(&self, py: Python<'_>) -> Forms {
        let called = self.called.iter().map(|term| term.clone_ref(py)).collect();
        py.detach(|| Forms::new(&self.assembly, called))
    }

    /// The sheet.
    #[getter]
    fn sheet(&self) -> Sheet {
        Sheet { sheet: self.assembly.sheet().clone() }
    }

    /// The edges of the model: cell and name of each.
    #[getter]
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, i64>> {
        let (sheet, tiling) = (self.assembly.sheet(), self.assembly.tiling());
        let row = |edge: &foldwell::sheet::TiledEdge| {
            let [i, j, n1, n2] = crate::sheet::name(sheet.edges[edge.edge].key);
            [edge.cell[0] as i64, edge.cell[1] as i64, i, j, n1, n2]
        };
        rows(py, tiling.edges.iter().flat_map(row).collect(), 6)
    }

    /// The kinds of the edges of the model.
    #[getter]
    fn kinds(&self) -> Vec<&'static str> {
        self.assembly.tiling().edges.iter().map(|edge| edge.kind.word()).collect()
    }

    /// The names of units that the scene gives.
    #[getter]
    fn units(&self) -> BTreeMap<String, String> {
        let given = self.scene.get("units").and_then(Value::as_table);
        let names = given.into_iter().flatten();
        names.filter_map(|(key, name)| Some((key.clone(), name.as_str()?.to_owned()))).collect()
    }

    /// The numbers of cells of the model.
    #[getter]
    fn cells(&self) -> [usize; 2] {
        self.assembly.tiling().cells
    }
}
