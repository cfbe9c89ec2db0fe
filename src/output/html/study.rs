//! One study on a page.

use serde::Serialize;
use serde_json::{Map, Value};

use super::content::Content;
use super::numbers::Arrays;
use super::sheet::{Numbered, SheetData};
use super::table::{Fact, TableData, results};

/// Kinds of study whose states are modes: their displacements are velocities.
pub(crate) const MODES: [&str; 3] = ["modes", "bloch", "response"];

/// A study and its files.
#[derive(Debug)]
pub(crate) struct StudyFiles<'a> {
    /// The study's part of `summary.json`.
    summary: Map<String, Value>,
    /// The files: names relative to the folder of the run, and contents.
    files: Vec<(String, Content<'a>)>,
}

/// The data of a study on a page.
#[derive(Debug, Serialize)]
pub(super) struct StudyData {
    name: String,
    kind: String,
    converged: bool,
    reason: Option<String>,
    facts: Vec<Fact>,
    tables: Vec<TableData>,
    figures: Vec<Figure>,
    /// Names of the files that the page does not show.
    others: Vec<String>,
    sheet: Option<SheetData>,
}

#[derive(Debug, Serialize)]
struct Figure {
    name: String,
    svg: String,
}

impl<'a> StudyFiles<'a> {
    /// Collects a study and its files, whose order has no meaning.
    pub(crate) fn new(summary: Map<String, Value>, files: impl IntoIterator<Item = (String, Content<'a>)>) -> Self {
        let mut files: Vec<_> = files.into_iter().collect();
        put_in_order(&mut files);
        Self { summary, files }
    }
}

impl StudyData {
    pub(super) fn new(arrays: &mut Arrays, StudyFiles { summary, files }: &StudyFiles<'_>) -> Self {
        let word = |key: &str| summary.get(key).and_then(Value::as_str).map(str::to_owned);
        let (name, kind) = (word("name").unwrap_or_default(), word("kind").unwrap_or_default());
        let (mut tables, mut figures, mut others) = (Vec::new(), Vec::new(), Vec::new());
        for (file, content) in files {
            match content {
                Content::Table(text) => tables.push(TableData::of_text(arrays, file, text)),
                Content::Figure(svg) => figures.push(Figure { name: file.clone(), svg: svg.clone().into_owned() }),
                Content::State(_) | Content::StateRead(_) => {}
                Content::Other => others.push(file.clone()),
            }
        }
        let (facts, lists) = results(arrays, summary);
        tables.extend(lists);
        let moving = MODES.contains(&kind.as_str());
        let sheet = SheetData::new(arrays, &states(&name, files), own_table(&name, files), moving);
        let converged = summary.get("converged").and_then(Value::as_bool).unwrap_or_default();
        Self { converged, reason: word("reason"), name, kind, facts, tables, figures, others, sheet }
    }
}

/// Returns the states of a study, each with its row, which the file name `NAME/NAME_ROW.vtu` ends with. Modes of a
/// `bloch` study have other names and no row.
fn states<'a>(name: &str, files: &'a [(String, Content<'_>)]) -> Vec<Numbered<'a>> {
    let numbered =
        |file: &str, content: &'a Content<'_>| Some(Numbered { row: row_of(name, file), picture: content.picture()? });
    files.iter().filter_map(|(file, content)| numbered(file, content)).collect()
}

/// Returns the row of a state of a study in its table, by the name of its file.
pub(crate) fn row_of(study: &str, file: &str) -> Option<usize> {
    file.strip_prefix(&format!("{study}/{study}_"))?.strip_suffix(".vtu")?.parse().ok()
}

/// Puts files into the order of their names; numbers of five digits come after those of four.
pub(crate) fn put_in_order(files: &mut [(String, Content<'_>)]) {
    files.sort_by(|(a, _), (b, _)| (a.len(), a).cmp(&(b.len(), b)));
}

/// Returns the text of the table of a study that has a row for each state.
pub(crate) fn own_table<'a>(name: &str, files: &'a [(String, Content<'_>)]) -> Option<&'a str> {
    files.iter().find_map(|(file, content)| match content {
        Content::Table(text) if file.strip_suffix(".csv") == Some(name) => Some(text.as_ref()),
        _ => None,
    })
}
