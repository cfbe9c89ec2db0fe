//! Values of single elements: from tables with a row per edge, by the letters of edges, and from the mesh.

use super::error::TableFault;
use super::forms::FileName;
use super::rows::{self, ColumnQuantity, TableRow};
use super::stiffness::{RestLengthSpec, StiffnessSpec};
use super::{Located, SceneError, SceneFile};
use crate::model::{Assembly, RestLengths, Stiffness};
use crate::sheet::angle::Angle;
use crate::sheet::{Assignment, EdgeKey, EdgeKind, Sheet, Tiling};
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The elements of a term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ElementKind {
    /// Bars, along all edges.
    Bars,
    /// Hinges at creases.
    Creases,
    /// Hinges at diagonals of polygons.
    Facets,
}

impl ElementKind {
    /// Returns the name of one element in messages.
    fn word(self) -> &'static str {
        match self {
            Self::Bars => "bar",
            Self::Creases => "crease",
            Self::Facets => "facet",
        }
    }

    /// Whether an edge of this kind has an element.
    pub(super) fn is_at(self, kind: EdgeKind) -> bool {
        matches!((self, kind), (Self::Bars, _) | (Self::Creases, EdgeKind::Crease) | (Self::Facets, EdgeKind::Facet))
    }

    /// Returns the letters of which another one counts as well if a table does not give them: a diagonal is flat, and a
    /// cut is a boundary.
    fn substitute(letter: Assignment) -> Assignment {
        match letter {
            Assignment::Join => Assignment::Flat,
            Assignment::Cut => Assignment::Boundary,
            other => other,
        }
    }

    /// Whether a table may give this letter.
    fn may_have(self, letter: Assignment) -> bool {
        match letter {
            Assignment::Boundary | Assignment::Cut => self == Self::Bars,
            Assignment::Join => self != Self::Creases,
            Assignment::Mountain | Assignment::Valley | Assignment::Flat | Assignment::Unassigned => true,
        }
    }
}

/// The elements of a scene's sheet, by the names of their edges.
pub(super) struct ElementValues<'a> {
    file: &'a SceneFile,
    sheet: &'a Sheet,
    tiling: &'a Tiling,
    /// The kinds of each edge of the cell, one for each hinge, by the name of the edge.
    kinds: HashMap<EdgeKey, Vec<EdgeKind>>,
}

impl<'a> ElementValues<'a> {
    pub(super) fn new(file: &'a SceneFile, assembly: &'a Assembly) -> Self {
        let (sheet, tiling) = (assembly.sheet(), assembly.tiling());
        let mut kinds: HashMap<EdgeKey, Vec<EdgeKind>> = HashMap::new();
        sheet.edges.iter().for_each(|edge| kinds.entry(edge.key.whole()).or_default().push(edge.kind));
        Self { file, sheet, tiling, kinds }
    }

    /// Whether the cell has this edge, and it is of one of these kinds.
    pub(super) fn has(&self, key: EdgeKey, is_wanted: impl Fn(EdgeKind) -> bool) -> bool {
        self.kinds.get(&key).is_some_and(|kinds| kinds.iter().any(|kind| is_wanted(*kind)))
    }

    /// Returns the stiffness of the elements of a term.
    pub(super) fn stiffness(&self, spec: &Located<StiffnessSpec>, of: ElementKind) -> Result<Stiffness, SceneError> {
        match &**spec {
            StiffnessSpec::Number(stiffness) => Ok((*stiffness).into()),
            StiffnessSpec::File(name) => Ok(self.file_values(name, ColumnQuantity::Stiffness, of)?.into()),
            StiffnessSpec::Letters(letters) => {
                Ok(self.each_by_letter((letters, "stiffness"), of, spec.span(), (f64::NAN, |_| None))?.into())
            }
            StiffnessSpec::Mesh => self.given_by_mesh(of, spec.span()),
        }
    }

    /// Returns the rest lengths of the bars.
    pub(super) fn lengths(&self, spec: Option<&Located<RestLengthSpec>>) -> Result<RestLengths, SceneError> {
        match spec.map(|spec| &**spec) {
            None | Some(RestLengthSpec::Drawn) => Ok(RestLengths::Drawn),
            Some(RestLengthSpec::Factor(factor)) => Ok(RestLengths::Factor(*factor)),
            Some(RestLengthSpec::File(name)) => {
                self.file_values(name, ColumnQuantity::Length, ElementKind::Bars).map(RestLengths::PerEdge)
            }
        }
    }

    /// Returns the values that a file gives the elements of a term, one for each edge of the tiling.
    pub(super) fn file_values(
        &self,
        name: &FileName,
        column: ColumnQuantity,
        of: ElementKind,
    ) -> Result<Vec<f64>, SceneError> {
        self.named_values(&name.file, column, (of, of))
    }

    /// Returns the values of the array or the file of this name; as [`table`](Self::table).
    pub(super) fn named_values(
        &self,
        name: &Located<PathBuf>,
        column: ColumnQuantity,
        of: (ElementKind, ElementKind),
    ) -> Result<Vec<f64>, SceneError> {
        if let Some(array) = self.file.array(name) {
            return self.array(array, name, column, of);
        }
        let path = self.file.resolve(name);
        self.table(&path, &rows::read(&path, column)?, of, name.span())
    }

    /// Returns the values of an array on the edges of the tiling; NaN where no element is. Every element of the first
    /// term must have a value, elements of the second may.
    fn array(
        &self,
        array: &[f64],
        name: &Located<PathBuf>,
        column: ColumnQuantity,
        (needed, also): (ElementKind, ElementKind),
    ) -> Result<Vec<f64>, SceneError> {
        let refused = |message, help: &str| Err(self.file.error_at(name.span(), message, help));
        let (shown, cell, tiling) = (name.display(), self.sheet.edges.len(), self.tiling.edges.len());
        if ![cell, tiling].contains(&array.len()) {
            let message = format!("{shown} has shape ({},), expected ({cell},) or ({tiling},)", array.len());
            return refused(message, "give one number for each edge of the cell, or of the model");
        }
        let of_cell = array.len() == cell;
        let kind = |k: usize| if of_cell { self.sheet.edges[k].kind } else { self.tiling.edges[k].kind };
        let mut values = vec![f64::NAN; array.len()];
        for (k, &number) in array.iter().enumerate() {
            if needed.is_at(kind(k)) || (also.is_at(kind(k)) && !number.is_nan()) {
                match column.checked(number, number) {
                    Ok(number) => values[k] = number,
                    Err(fault) => {
                        return refused(format!("{shown}[{k}]: {fault}"), "numbers of other edges are not read");
                    }
                }
            }
        }
        Ok(if of_cell { self.tiling.edges.iter().map(|tiled| values[tiled.edge]).collect() } else { values })
    }

    /// Checks an array of rest angles of creases, if there is one of this name: it has no angle at these edges of the
    /// cell, which are diagonals of rigid polygons.
    pub(super) fn flat_at(&self, rigid: &[usize], name: &Located<PathBuf>) -> Result<(), SceneError> {
        let Some(array) = self.file.array(name) else { return Ok(()) };
        let cell = self.sheet.edges.len();
        let mut is_rigid = vec![false; cell];
        rigid.iter().for_each(|&edge| is_rigid[edge] = true);
        let of_cell = |k: usize| if array.len() == cell { k } else { self.tiling.edges[k].edge };
        let folded = |&k: &usize| is_rigid[of_cell(k)] && !array[k].is_nan() && array[k] != 0.0;
        let Some(k) = (0..array.len()).find(folded) else { return Ok(()) };
        let edge = self.sheet.edges[of_cell(k)].key;
        let message = format!("{}[{k}] is {:?}, but edge {edge} is a facet, which is rigid", name.display(), array[k]);
        Err(self.file.error_at(name.span(), message, "give 0 or nan there, or `facets` a stiffness"))
    }

    /// Returns the values of a table on the edges of the tiling; NaN where it has none. Every element of the first term
    /// must have a value; rows may also name elements of the second.
    pub(super) fn table(
        &self,
        path: &Path,
        rows: &[TableRow],
        (needed, also): (ElementKind, ElementKind),
        span: Range<usize>,
    ) -> Result<Vec<f64>, SceneError> {
        let (mut values, word) = (vec![f64::NAN; self.tiling.edges.len()], needed.word());
        let mut copies: HashMap<(EdgeKey, Option<[usize; 2]>), Vec<usize>> = HashMap::new();
        for (k, tiled) in self.tiling.edges.iter().enumerate() {
            copies.entry((self.key(k).whole(), None)).or_default().push(k);
            copies.entry((self.key(k).whole(), Some(tiled.cell))).or_default().push(k);
        }
        for row in rows {
            let fault = |fault| SceneError::Table { path: path.into(), line: row.line, fault };
            if !self.has(row.key, |kind| needed.is_at(kind) || also.is_at(kind)) {
                let message = format!("the sheet has no {word} {}", row.key);
                return Err(fault(TableFault::Edge(message)));
            }
            match (copies.get(&(row.key, row.cell)), row.cell) {
                (Some(found), _) => found.iter().for_each(|&k| values[k] = row.value),
                // a patch need not have a copy of every edge of its cell
                (None, None) => {}
                (None, Some([c1, c2])) => {
                    let message = format!("there is no {word} {} in cell [{c1}, {c2}]", row.key);
                    return Err(fault(TableFault::Edge(message)));
                }
            }
        }
        let missing = |k: &usize| needed.is_at(self.tiling.edges[*k].kind) && values[*k].is_nan();
        let Some(k) = (0..values.len()).find(missing) else { return Ok(values) };
        let (key, cell) = (self.key(k), self.tiling.edges[k].cell);
        let message = format!("{} has no row for {word} {key} of cell {cell:?}", path.display());
        Err(self.file.error_at(span, message, format!("give one row for each {word}")))
    }

    /// Returns the name of the cell's edge of which an edge of the tiling is a copy.
    fn key(&self, edge: usize) -> EdgeKey {
        self.sheet.edges[self.tiling.edges[edge].edge].key
    }

    /// Returns the numbers of the tiling's edges that have an element of this term.
    fn edges(&self, of: ElementKind) -> impl Iterator<Item = usize> + '_ {
        (0..self.tiling.edges.len()).filter(move |&k| of.is_at(self.tiling.edges[k].kind))
    }

    /// Returns the rest angle of each hinge by the letter of its edge: 0 for creases that are flat or unassigned and
    /// for diagonals, if the table does not give another.
    pub(super) fn angles_by_letter(
        &self,
        letters: &BTreeMap<Assignment, Angle>,
        of: ElementKind,
        span: Range<usize>,
    ) -> Result<Vec<f64>, SceneError> {
        let letters = letters.iter().map(|(letter, angle)| (*letter, angle.radians)).collect();
        let folds = |letter| matches!(letter, Assignment::Mountain | Assignment::Valley);
        self.each_by_letter((&letters, "angle"), of, span, (f64::NAN, |letter| (!folds(letter)).then_some(0.0)))
    }

    /// Returns the value of each element by the letter of its edge, or by the substitute of that letter, and `absent`
    /// for edges without element; `default` returns the value of a letter that the table does not have.
    pub(super) fn each_by_letter<T: Clone>(
        &self,
        (letters, value): (&BTreeMap<Assignment, T>, &str),
        of: ElementKind,
        span: Range<usize>,
        (absent, default): (T, impl Fn(Assignment) -> Option<T>),
    ) -> Result<Vec<T>, SceneError> {
        let word = of.word();
        if let Some(letter) = letters.keys().find(|letter| !of.may_have(**letter)) {
            let help = "creases have the letters M, V, F and U; facets J (or F); bars all of these, B and C";
            return Err(self.file.error_at(span, format!("no {word} has the letter {letter}"), help));
        }
        let mut each = vec![absent; self.tiling.edges.len()];
        let mut missing: BTreeMap<Assignment, usize> = BTreeMap::new();
        for k in self.edges(of) {
            let letter = self.letter(k);
            let given = letters.get(&letter).or_else(|| letters.get(&ElementKind::substitute(letter)));
            match given.cloned().or_else(|| default(letter)) {
                Some(value) => each[k] = value,
                None => *missing.entry(letter).or_default() += 1,
            }
        }
        if missing.is_empty() {
            return Ok(each);
        }
        let counts: Vec<String> = missing.iter().map(|(letter, count)| format!("{letter} ({count} {word}s)")).collect();
        let message = format!("the table has no {value} for the letters {}", counts.join(", "));
        Err(self.file.error_at(span, message, format!("give a value for every letter that a {word} has")))
    }

    /// Returns the letter of the edge of which an edge of the tiling is a copy.
    fn letter(&self, edge: usize) -> Assignment {
        self.sheet.assignment(&self.sheet.edges[self.tiling.edges[edge].edge])
    }

    /// Returns the stiffness that the mesh file gives each element.
    fn given_by_mesh(&self, of: ElementKind, span: Range<usize>) -> Result<Stiffness, SceneError> {
        let (given, key) = match of {
            ElementKind::Bars => (&self.sheet.stiffness.bars, "foldwell:bar_stiffness"),
            _ => (&self.sheet.stiffness.hinges, "foldwell:stiffness"),
        };
        let word = of.word();
        if given.is_empty() {
            let help = format!("`{key}` in the FOLD file has one number, \"inf\" or null for each of `edges_vertices`");
            return Err(self.file.error_at(span, format!("the mesh has no `{key}`"), help));
        }
        let mut each = vec![f64::NAN; self.tiling.edges.len()];
        for k in self.edges(of) {
            let edge = self.key(k);
            each[k] = *given.get(&edge).ok_or_else(|| {
                let message = format!("`{key}` of the mesh has no value for {word} {edge}");
                let help =
                    format!("give each {word} a number or \"inf\"; diagonals of polygons have to be listed with J");
                self.file.error_at(span.clone(), message, help)
            })?;
        }
        Ok(each.into())
    }
}
