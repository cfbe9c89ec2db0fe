//! The types of a scene read from its text, which is kept for messages.

use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use miette::NamedSource;
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::SceneError;
use super::schema::{common_study_keys, is_key_of_scene, kinds, kinds_with_key};
use super::setting::{Setting, apply};
use super::spec::Scene;
use crate::sheet::SheetError;
use crate::sheet::serde_message::in_words;
use crate::sheet::similar::{did_you_mean, did_you_mean_of};
use crate::sheet::text::{line_and_column, shortened};

/// Arrays in the place of tables of edges, by the names that a scene has for them: one number for each edge of the
/// cell, or of the tiling; and `loads`, three for each vertex of a patch.
pub type Arrays = Arc<BTreeMap<PathBuf, Vec<f64>>>;

/// A scene with the text from which it was read.
#[derive(Clone, Debug)]
pub struct SceneFile {
    /// The scene.
    pub scene: Scene,
    path: PathBuf,
    text: Arc<NamedSource<String>>,
    settings: Vec<String>,
    arrays: Arrays,
}

impl SceneFile {
    /// Reads a scene from a text in which some keys are set, without checking it. `path` is used in messages, and paths
    /// in the scene are relative to it.
    pub(super) fn unchecked(text: &str, path: &Path, settings: &[Setting]) -> Result<Self, SceneError> {
        let mut name = path.display().to_string();
        let mut text = text.to_owned();
        if !settings.is_empty() {
            text = apply(&text, settings).map_err(|fault| SceneError::Setting { path: path.into(), fault })?;
            name.push_str(" (keys set)");
        }
        let source = Arc::new(NamedSource::new(name, text).with_language("TOML"));
        let settings = settings.iter().map(Setting::to_string).collect();
        let scene = deserialize(&source)?;
        Ok(Self { scene, path: path.to_path_buf(), text: source, settings, arrays: Arrays::default() })
    }

    /// Reads another text in the place of this one, in which some more keys are set, without checking it.
    pub(super) fn with(&self, text: &str, settings: &[Setting]) -> Result<Self, SceneError> {
        let mut file = Self::unchecked(text, &self.path, settings)?;
        file.settings.splice(0..0, self.settings.iter().cloned());
        Ok(file.with_arrays(self.arrays.clone()))
    }

    /// Returns the same scene, in which a table of edges that has the name of an array is this array and no file.
    #[must_use]
    pub fn with_arrays(self, arrays: Arrays) -> Self {
        Self { arrays, ..self }
    }

    /// Returns the arrays that it has in the place of tables.
    pub fn arrays(&self) -> &Arrays {
        &self.arrays
    }

    /// Returns the array of this name.
    pub(super) fn array(&self, name: &Path) -> Option<&[f64]> {
        self.arrays.get(name).map(Vec::as_slice)
    }

    /// Returns the keys that were set in the text, each as `key=value`.
    pub(crate) fn settings(&self) -> &[String] {
        &self.settings
    }

    /// Returns the path of the scene file, as it was passed to [`read`](super::read) or [`parse`](super::parse).
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns a path of the scene, which is relative to the scene file, as one relative to the current folder.
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(path)
    }

    /// Returns the title of the scene, or the name of its file without the ending.
    pub(crate) fn title(&self) -> String {
        let stem = || self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        self.scene.title.clone().unwrap_or_else(stem)
    }

    /// Returns the text of the scene, in which keys are set.
    pub fn text(&self) -> &str {
        self.text.inner()
    }

    /// Returns the line of a byte offset, counted from 1.
    pub(super) fn line_of(&self, offset: usize) -> usize {
        line_and_column(self.text(), offset)[0]
    }

    /// Returns an error that points at a place of the scene ([`super::Located::span`]); `message` describes the error,
    /// `help` proposes a correction.
    pub fn error_at(&self, span: Range<usize>, message: impl Into<String>, help: impl Into<String>) -> SceneError {
        error_at(&self.text, span, message.into(), Some(help.into()))
    }

    /// Fails with the error of [`Self::error_at`] where something is wrong.
    pub(crate) fn error_if(
        &self,
        wrong: bool,
        span: Range<usize>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Result<(), SceneError> {
        if wrong { Err(self.error_at(span, message, help)) } else { Ok(()) }
    }

    /// Returns the error of a file that is not there, with the name of a file beside it that may be meant, or that is a
    /// folder.
    fn no_file(&self, span: Range<usize>, path: &Path) -> SceneError {
        let here = Path::new(".").join(path);
        if here.is_dir() {
            let message = format!("{} is a folder", here.display());
            return self.error_at(span, message, "a file is expected; paths are relative to the folder of the scene");
        }
        let beside = fs::read_dir(here.parent().unwrap_or(&here)).into_iter().flatten().flatten();
        let beside: Vec<String> = beside.map(|file| file.file_name().to_string_lossy().into_owned()).collect();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let question = did_you_mean(&name, beside.iter().map(String::as_str));
        let help = format!("{question}paths are relative to the folder of the scene");
        self.error_at(span, format!("there is no file {}", path.display()), help)
    }

    /// Returns an error about a file that is not there with the place in the scene that names it.
    pub(super) fn placed(&self, error: SceneError) -> SceneError {
        let path = match &error {
            SceneError::Read { path, .. } | SceneError::Mesh(SheetError::Read { path, .. }) => path,
            _ => return error,
        };
        if path.exists() && !path.is_dir() {
            return error;
        }
        let names_it = |(at, quote): (usize, &str)| {
            let text = &self.text()[at + 1..];
            let length = text.find(quote)?;
            (self.resolve(Path::new(&text[..length])) == *path).then_some(at..at + length + 2)
        };
        match self.text().match_indices(['"', '\'']).find_map(names_it) {
            Some(span) => self.no_file(span, path),
            None => error,
        }
    }
}

fn error_at(text: &Arc<NamedSource<String>>, span: Range<usize>, message: String, help: Option<String>) -> SceneError {
    let [line, column] = line_and_column(text.inner(), span.start);
    let key = if span.is_empty() { "".into() } else { key_at(text.inner(), span.start).into() };
    let (text, span) = excerpt(text, span);
    let cut = |text: String| shortened(&text, LONGEST_PRINTED_LINE);
    let (message, help) = (cut(message), help.map(cut));
    SceneError::At { line, column, key, message, help, text, span: span.into() }
}

/// Returns the path of the key whose name or value is at a byte offset; empty if there is none.
fn key_at(text: &str, offset: usize) -> String {
    let found = DeTable::parse(text).ok().and_then(|root| key_in_table(root.get_ref(), offset));
    found.unwrap_or_default().join(".")
}

fn key_in_table(table: &DeTable<'_>, offset: usize) -> Option<Vec<String>> {
    table.iter().find_map(|(key, value)| {
        let below = if key.span().contains(&offset) { Some(Vec::new()) } else { key_in_value(value, offset) };
        below.map(|below| [vec![key.get_ref().to_string()], below].concat())
    })
}

/// Returns the path below a value; empty if the offset is at the value itself, `None` if it is elsewhere.
fn key_in_value(value: &Spanned<DeValue<'_>>, offset: usize) -> Option<Vec<String>> {
    let below = match value.get_ref() {
        DeValue::Table(table) => key_in_table(table, offset),
        DeValue::Array(items) => items
            .iter()
            .enumerate()
            .find_map(|(k, item)| key_in_value(item, offset).map(|below| [vec![k.to_string()], below].concat())),
        _ => None,
    };
    below.or_else(|| value.span().contains(&offset).then(Vec::new))
}

/// Largest number of characters of a line or message that are printed.
const LONGEST_PRINTED_LINE: usize = 400;

/// Returns the text to be shown around a place and the place in it: the whole text, or, if one of its lines is very
/// long, the text with long lines truncated, the line of the place to a part around it.
fn excerpt(text: &Arc<NamedSource<String>>, span: Range<usize>) -> (Arc<NamedSource<String>>, Range<usize>) {
    if text.inner().lines().all(|line| line.len() <= LONGEST_PRINTED_LINE) {
        return (text.clone(), span);
    }
    let (mut short, mut offset, mut moved) = (String::new(), 0, 0..0);
    for line in text.inner().split_inclusive('\n') {
        let here = offset..offset + line.len();
        let inside = here.contains(&span.start) || (span.start == here.end && here.end == text.inner().len());
        let place = if inside { span.start - here.start } else { 0 };
        let long = line.len() > LONGEST_PRINTED_LINE;
        let from = if long { line.floor_char_boundary(place.saturating_sub(LONGEST_PRINTED_LINE / 4)) } else { 0 };
        let to = if long { line.floor_char_boundary(from + LONGEST_PRINTED_LINE) } else { line.len() };
        if inside {
            let start = short.len() + place - from;
            let room = (short.len() + to - from).saturating_sub(start);
            moved = start..start + room.min(span.len());
        }
        short.push_str(&line[from..to]);
        if to < line.len() && line.ends_with('\n') {
            short.push('\n');
        }
        offset = here.end;
    }
    (Arc::new(NamedSource::new(text.name(), short).with_language("TOML")), moved)
}

fn deserialize(text: &Arc<NamedSource<String>>) -> Result<Scene, SceneError> {
    let mut root = DeTable::parse(text.inner()).map_err(|fault| from_toml(text, &fault))?;
    if let Some(DeValue::Array(studies)) = root.get_mut().get_mut("study").map(Spanned::get_mut) {
        for study in studies.iter_mut() {
            if let DeValue::Table(table) = study.get_mut() {
                nest_kind(table).map_err(|span| not_a_kind(text, span))?;
            }
        }
    }
    Scene::deserialize(toml::de::Deserializer::from(root)).map_err(|fault| from_toml(text, &fault))
}

/// Replaces `kind = "relax"` and the keys of that kind by `kind = { relax = { .. } }`, the form that serde can read
/// without losing places. A missing kind is left for serde to refuse; the error of one that is not a word is its place.
fn nest_kind(study: &mut DeTable<'_>) -> Result<(), Range<usize>> {
    let common = common_study_keys();
    let (mut kept, mut own) = (DeTable::new(), DeTable::new());
    for (key, value) in std::mem::take(study) {
        let target = if common.contains(&key.get_ref().as_ref()) { &mut kept } else { &mut own };
        target.insert(key, value);
    }
    if let Some(kind) = kept.get_mut("kind") {
        let span = kind.span();
        let DeValue::String(word) = kind.get_mut() else { return Err(span) };
        let word = Spanned::new(span.clone(), std::mem::take(word));
        *kind.get_mut() = DeValue::Table([(word, Spanned::new(span, DeValue::Table(own)))].into_iter().collect());
    }
    *study = kept;
    Ok(())
}

fn not_a_kind(text: &Arc<NamedSource<String>>, span: Range<usize>) -> SceneError {
    let help = format!("expected one of {}", kinds().map(|kind| format!("\"{kind}\"")).collect::<Vec<_>>().join(", "));
    error_at(text, span, "the kind of a study is a word".into(), Some(help))
}

/// Converts an error of the TOML reader or of serde to one in the terms of this program.
fn from_toml(text: &Arc<NamedSource<String>>, fault: &toml::de::Error) -> SceneError {
    let (span, question) = (fault.span().unwrap_or(0..0), did_you_mean_of(fault.message()));
    let (wrong, right) = in_words(fault.message());
    let named = text.inner().get(span.clone()).unwrap_or_default();
    if let Some(help) = slip(text.inner(), &span) {
        return error_at(text, span, "this is no TOML".into(), Some(help.into()));
    }
    if wrong == "duplicate key" {
        let help = "each key, and each table in brackets, is given once";
        return error_at(text, span.clone(), format!("`{named}` is given a second time"), Some(help.into()));
    }
    if let Some(key) = quoted_after(&wrong, "unknown field ") {
        let help = question + &unknown_key_help(&key, right);
        return error_at(text, span, format!("unknown key `{key}`"), Some(help));
    }
    if let Some(key) = quoted_after(&wrong, "missing field ") {
        return error_at(text, span, format!("missing key `{key}`"), Some(format!("`{key}` has to be given here")));
    }
    if wrong.starts_with("invalid float") || wrong.starts_with("invalid integer") {
        let help = "expected a number such as 0.5, -3 or 1e-3; there are no formulas here";
        return error_at(text, span, "this is no number".into(), Some(help.into()));
    }
    let is_header = right.as_deref() == Some("a list [..]") && named.starts_with('[');
    let right = if is_header { Some(format!("a list of tables, each under [{named}]")) } else { right };
    error_at(text, span, wrong, right.map(|right| format!("{question}expected {right}")))
}

/// Returns the advice about a slip that makes what stands at a place, or ends there, no TOML: a comma in a number, or
/// quotes that word processors make.
fn slip(text: &str, span: &Range<usize>) -> Option<&'static str> {
    let is_digit = |c: char| c.is_ascii_digit();
    let line = text.get(..span.start)?.lines().next_back()?;
    let before = line.trim_end().trim_end_matches(is_digit);
    let (number, after) = match before.strip_suffix(',') {
        Some(number) => (number, &line[before.len()..]),
        None => (line, text.get(span.start..)?.strip_prefix(',').unwrap_or_default()),
    };
    if text.get(span.clone())?.contains(['\u{201c}', '\u{201d}', '\u{201e}', '\u{2018}', '\u{2019}']) {
        Some("these are curly quotes; write straight ones, \"")
    } else if number.ends_with(is_digit) && after.starts_with(is_digit) && !line.contains('[') {
        Some("a number has a decimal point, 1.5; a comma ends it")
    } else {
        None
    }
}

fn quoted_after(text: &str, start: &str) -> Option<String> {
    Some(text.strip_prefix(start)?.strip_prefix('`')?.split_once('`')?.0.to_owned())
}

/// Returns a text with the allowed keys, and with the kinds of study that have the unknown one.
fn unknown_key_help(key: &str, right: Option<String>) -> String {
    let here = right.map_or("no keys are expected here".into(), |right| {
        format!("the keys here are {}", right.trim_start_matches("one of "))
    });
    match kinds_with_key(key).as_slice() {
        [] if is_key_of_scene(key) => format!("`{key}` belongs to the scene itself, above its first table; {here}"),
        [] => here,
        kinds => format!("`{key}` is a key of studies of kind {}; {here}", kinds.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: every place is at its key: in headers, lists of tables, inline tables and lists, whatever comes before
    /// it.
    #[test]
    fn places_have_their_keys() {
        let text =
            "title = \"a\"\n[energy]\nbars = { stiffness = 3 }\n[[study]]\nname = \"a\"\n[[study]]\nq1 = [1, 2]\n";
        for (place, key) in [
            ("= 3", "energy.bars"),
            ("= \"a\"\n[e", ""),
            ("3 }", "energy.bars.stiffness"),
            ("stiff", "energy.bars.stiffness"),
            ("energy", "energy"),
            ("2]", "study.1.q1.1"),
            ("\"a\"\n[e", "title"),
        ] {
            assert_eq!(key_at(text, text.find(place).unwrap()), key, "{place}");
        }
    }

    /// Claim: columns count characters, so that an accent before the place does not shift it. Source: counted by hand.
    #[test]
    fn line_and_column_of_an_offset() {
        let text = "a = 1\n# \u{e9}\u{e9} b = 2\n";
        assert_eq!(line_and_column(text, 0), [1, 1]);
        assert_eq!(line_and_column(text, 4), [1, 5]);
        assert_eq!(line_and_column(text, text.find('b').unwrap()), [2, 6]);
        assert_eq!(line_and_column(text, text.len() + 9), [3, 1]);
    }
}
