//! Keys of a scene that are set from outside: `energy.bars.stiffness=1e4` replaces or adds one value in its text.

use std::fmt;
use std::str::FromStr;

use crate::sheet::similar::there_are;
use thiserror::Error;
use toml_edit::{ArrayOfTables, DocumentMut, InlineTable, Item, Key, TableLike, Value};

/// A key of a scene, by its path, and the value that it gets.
///
/// The path has dots as in TOML. An element of a list of tables is named by its `name`, or by its number from 0:
/// `study.relaxed.tolerance`, `lock.0.angle`. The value is written as in TOML; a text needs no quotes.
///
/// ```
/// use foldwell::scene::{Setting, apply};
///
/// let scene = "sheet = { mesh = \"star.fold\" }\n[energy]\nbars = { stiffness = inf } # rigid\n";
/// let setting: Setting = "energy.bars.stiffness=1e4".parse()?;
/// assert!(apply(scene, &[setting])?.contains("bars = { stiffness = 1e4 } # rigid"));
/// # Ok::<(), foldwell::scene::SettingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Setting {
    text: String,
    keys: Vec<Key>,
    value: Value,
}

/// The reasons for which a key of a scene cannot be set.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum SettingError {
    #[error("`{0}` sets no key of the scene; write KEY=VALUE, as in energy.bars.stiffness=1e4")]
    Form(String),
    #[error("`{setting}`: `{part}` is a value, which has no keys")]
    NoTable { setting: String, part: String },
    #[error("`{setting}`: `{list}` has no element `{element}`; {}", elements(element, names))]
    NoElement { setting: String, list: String, element: String, names: Vec<String> },
}

fn elements(element: &str, names: &[String]) -> String {
    if names.is_empty() { "it is empty".into() } else { there_are(element, names.iter().map(String::as_str)) }
}

impl Setting {
    /// Returns the setting of the key with this path; the value is written as in TOML, a text needs no quotes.
    pub(super) fn new(path: &str, value: &str) -> Result<Self, SettingError> {
        let text = format!("{path}={value}");
        let Ok(keys) = Key::parse(path.trim()) else { return Err(SettingError::Form(text)) };
        let value = value.trim();
        let value = value.parse().unwrap_or_else(|_| Value::from(value));
        Ok(Self { text, keys, value })
    }

    /// Returns the first key of the path.
    pub(super) fn table(&self) -> &str {
        self.keys.first().map_or("", Key::get)
    }

    /// Whether another setting has the same path.
    pub(super) fn same_key(&self, other: &Self) -> bool {
        self.keys.iter().map(Key::get).eq(other.keys.iter().map(Key::get))
    }

    /// Returns the value as a field of a table: numbers with the fewest digits that are read back exactly, texts
    /// without quotes, lists and tables as in TOML.
    pub(super) fn field(&self) -> String {
        match &self.value {
            Value::String(text) => text.value().clone(),
            Value::Integer(number) => number.value().to_string(),
            Value::Float(number) => float(*number.value()),
            Value::Boolean(word) => word.value().to_string(),
            other => other.to_string().trim().to_owned(),
        }
    }

    /// Returns the setting of the frame of the mesh, `sheet.frame`.
    pub fn of_frame(frame: usize) -> Self {
        let value = i64::try_from(frame).unwrap_or(i64::MAX);
        Self {
            text: format!("sheet.frame={frame}"),
            keys: ["sheet", "frame"].map(Key::new).to_vec(),
            value: value.into(),
        }
    }
}

impl FromStr for Setting {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        let form = || SettingError::Form(text.to_owned());
        let (path, value) = text.split_once('=').ok_or_else(form)?;
        let setting = Self::new(path, value).map_err(|_| form())?;
        Ok(Self { text: text.to_owned(), ..setting })
    }
}

/// Writes a number as TOML has it, with the fewest digits that are read back exactly.
pub(super) fn float(number: f64) -> String {
    if number.is_nan() { "nan".to_owned() } else { format!("{number:?}") }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// Returns the text of a scene with some keys set; the other lines, comments included, stay as they are. A text that is
/// not TOML is returned unchanged, for its reader to refuse it.
///
/// # Errors
/// [`SettingError`] if a path leads through a value, or to an element that a list does not have.
pub fn apply(text: &str, settings: &[Setting]) -> Result<String, SettingError> {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return Ok(text.to_owned()) };
    for setting in settings {
        set(document.as_table_mut(), &setting.keys, setting)?;
    }
    Ok(document.to_string())
}

/// Returns the text of a scene without one of its tables, and the comment before it; the other lines stay as they are.
pub(super) fn without(text: &str, table: &str) -> String {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return text.to_owned() };
    document.remove(table);
    document.to_string()
}

/// Sets the key with this path below `table`.
fn set(table: &mut dyn TableLike, path: &[Key], setting: &Setting) -> Result<(), SettingError> {
    let [key, rest @ ..] = path else { return Ok(()) };
    if rest.is_empty() {
        replace(table, key, &setting.value);
        return Ok(());
    }
    let missing = || Item::Value(Value::InlineTable(InlineTable::new()));
    match table.entry_format(key).or_insert_with(missing) {
        Item::ArrayOfTables(list) => set_in_tables(list, key, rest, setting),
        Item::Value(Value::Array(list)) => set_in_values(list, key, rest, setting),
        item => match item.as_table_like_mut() {
            Some(inner) => set(inner, rest, setting),
            None => Err(SettingError::NoTable { setting: setting.to_string(), part: key.get().into() }),
        },
    }
}

/// Replaces or adds a value; the space and the comment beside a replaced one stay.
fn replace(table: &mut dyn TableLike, key: &Key, value: &Value) {
    let mut value = value.clone();
    if let Some(before) = table.get(key.get()).and_then(Item::as_value) {
        *value.decor_mut() = before.decor().clone();
    }
    table.insert(key.get(), Item::Value(value));
}

/// Sets a key in one of the tables `[[key]]`.
fn set_in_tables(list: &mut ArrayOfTables, key: &Key, path: &[Key], setting: &Setting) -> Result<(), SettingError> {
    let names: Vec<String> = list.iter().enumerate().map(|(k, table)| name(table, k)).collect();
    let at = position(&names, key, &path[0], setting)?;
    list.get_mut(at).map_or(Ok(()), |table| set(table, &path[1..], setting))
}

/// Sets a key in one of the tables of a list in brackets, or replaces one of its values.
fn set_in_values(list: &mut toml_edit::Array, key: &Key, path: &[Key], setting: &Setting) -> Result<(), SettingError> {
    let number = |k: usize, value: &Value| value.as_inline_table().map_or(k.to_string(), |table| name(table, k));
    let names: Vec<String> = list.iter().enumerate().map(|(k, value)| number(k, value)).collect();
    let at = position(&names, key, &path[0], setting)?;
    match (list.get_mut(at), &path[1..]) {
        (Some(value), []) => {
            let mut new = setting.value.clone();
            *new.decor_mut() = value.decor().clone();
            *value = new;
            Ok(())
        }
        (Some(Value::InlineTable(table)), rest) => set(table, rest, setting),
        _ => Err(SettingError::NoTable { setting: setting.to_string(), part: path[0].get().into() }),
    }
}

/// Returns the name of element `k` of a list of tables; its number if it has none.
fn name(table: &dyn TableLike, k: usize) -> String {
    table.get("name").and_then(Item::as_str).map_or(k.to_string(), str::to_owned)
}

/// Returns the number of the element with this name or number.
fn position(names: &[String], list: &Key, element: &Key, setting: &Setting) -> Result<usize, SettingError> {
    let named = names.iter().position(|name| name == element.get());
    let numbered = || element.get().parse().ok().filter(|k| *k < names.len());
    named.or_else(numbered).ok_or_else(|| SettingError::NoElement {
        setting: setting.to_string(),
        list: list.get().into(),
        element: element.get().into(),
        names: names.to_vec(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "title = \"a\"\n[sheet]\nmesh = \"a.fold\"\ncells = [2, 3]\n[energy]\nbars = { stiffness = inf } # rigid\n\
                         [[lock]]\ncrease = [0, 1, 0, 0]\n[[study]]\nname = \"relaxed\"\nkind = \"relax\"\n";

    fn set_in(scene: &str, setting: &str) -> Result<String, SettingError> {
        apply(scene, &[setting.parse()?])
    }

    /// Claim: a setting changes its value and nothing else of the text, whatever kind of table holds it.
    #[test]
    fn one_value_changes() {
        for (setting, from, to) in [
            ("title=b", "title = \"a\"", "title = \"b\""),
            ("energy.bars.stiffness=1e4", "stiffness = inf }", "stiffness = 1e4 }"),
            ("sheet.mesh=../b.fold", "mesh = \"a.fold\"", "mesh = \"../b.fold\""),
            ("sheet.cells = [4, 4]", "cells = [2, 3]", "cells = [4, 4]"),
            ("sheet.cells.1=7", "cells = [2, 3]", "cells = [2, 7]"),
            ("lock.0.crease=[1,2,0,0]", "crease = [0, 1, 0, 0]", "crease = [1,2,0,0]"),
            ("study.relaxed.kind=modes", "kind = \"relax\"", "kind = \"modes\""),
            ("study.0.name='x y'", "name = \"relaxed\"", "name = 'x y'"),
        ] {
            assert_eq!(set_in(SCENE, setting).unwrap(), SCENE.replacen(from, to, 1), "{setting}");
        }
    }

    /// Claim: a key that is not there is added, with the tables that lead to it.
    #[test]
    fn keys_are_added() {
        for (setting, value) in [
            ("study.relaxed.start.random=0.1", "study[0].start.random"),
            ("energy.creases.stiffness=1.5", "energy.creases.stiffness"),
            ("extra.deep.key=true", "extra.deep.key"),
        ] {
            let table: toml::Table = set_in(SCENE, setting).unwrap().parse().unwrap();
            let steps = value.replace("[0]", ".0");
            let mut item = &toml::Value::Table(table);
            for step in steps.split('.') {
                item = step.parse::<usize>().map_or_else(|_| &item[step], |k| &item[k]);
            }
            assert_eq!(item.to_string(), setting.split_once('=').unwrap().1);
        }
    }

    /// Claim: elements of a list in brackets are found as those of `[[study]]`.
    #[test]
    fn inline_lists_are_lists_too() {
        let scene = "study = [{ name = \"a\", kind = \"relax\" }, { name = \"b\", kind = \"relax\" }]\n";
        let found = set_in(scene, "study.b.kind=modes").unwrap();
        assert_eq!(found, "study = [{ name = \"a\", kind = \"relax\" }, { name = \"b\", kind = \"modes\" }]\n");
    }

    /// Claim: what cannot be set is named, with what there is instead.
    #[test]
    fn wrong_settings_are_named() {
        let fault = |setting: &str| set_in(SCENE, setting).unwrap_err().to_string();
        assert!(fault("energy.bars").contains("KEY=VALUE"));
        assert!(fault("=3").contains("KEY=VALUE"));
        assert!(fault("energy..bars=3").contains("KEY=VALUE"));
        assert_eq!(fault("title.length=3"), "`title.length=3`: `title` is a value, which has no keys");
        assert_eq!(
            fault("study.pull.kind=3"),
            "`study.pull.kind=3`: `study` has no element `pull`; there are `relaxed`"
        );
        assert_eq!(fault("lock.1.angle=3"), "`lock.1.angle=3`: `lock` has no element `1`; there are `0`");
        assert_eq!(fault("sheet.cells.0.x=3"), "`sheet.cells.0.x=3`: `0` is a value, which has no keys");
    }

    /// Claim: a text that is not TOML is left to its reader.
    #[test]
    fn broken_scenes_stay() {
        assert_eq!(set_in("sheet = [", "title=b").unwrap(), "sheet = [");
    }
}
