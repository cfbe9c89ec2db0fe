//! Python values as values of a scene.

use crate::errors::refused;
use foldwell::scene::Arrays;
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyMapping, PyString};
use std::collections::BTreeMap;
use std::path::PathBuf;
use toml::{Table, Value};

/// Name of the array with the forces on all vertices of a patch.
const LOADS: &str = "loads";

/// Most levels of dicts, lists and arrays within each other: a value that contains itself has more, and values are read
/// by as many nested calls.
const MOST_LEVELS: usize = 100;
/// Most values of a scene: an iterator without end has more, and so have lists that contain each other many times.
const MOST_VALUES: usize = 2_000_000;

/// Returns a dict as a table of TOML. Keys with the value `None` are left out; tuples, arrays and other sequences
/// become lists, paths texts.
pub(crate) fn table(dict: &Bound<'_, PyDict>) -> PyResult<Table> {
    Reader::new(ToOwned::to_owned).table(dict, "", 0)
}

/// Returns the dict of a scene as a table of TOML, and the arrays in it that stand for a table in a file: stiffnesses,
/// rest values and rates with a number for each edge, and loads. The table names each as its file, by what `named`
/// makes of the path of its key.
pub(crate) fn scene_of(dict: &Bound<'_, PyDict>, named: fn(&str) -> String) -> PyResult<(Table, Arrays)> {
    let mut reader = Reader::new(named);
    let table = reader.table(dict, "", 0)?;
    Ok((table, reader.arrays.into()))
}

/// Does the same with keys that are set in a scene, given by their paths and kept in their order.
pub(crate) fn settings_of(dict: &Bound<'_, PyDict>) -> PyResult<(Vec<String>, Arrays)> {
    let (mut reader, mut settings) = (Reader::new(ToOwned::to_owned), Vec::new());
    for (path, given) in dict {
        let path: String = read(&path, "set")?;
        settings.push(format!("{path}={}", reader.value(&given, &path, 1)?));
    }
    Ok((settings, reader.arrays.into()))
}

/// Whether a value stands for a table of numbers of edges. Three numbers are a curvature tensor in the place of a mode,
/// and two its wavenumbers.
fn is_of_edges(given: &Bound<'_, PyAny>, path: &str) -> bool {
    let least = match path.splitn(5, '.').collect::<Vec<_>>()[..] {
        ["energy", _, "stiffness" | "rest"] | ["energy", _, "law", "each"] => 0,
        ["study", _, "modes", _] | ["energy", _, "rest", "mode"] => 4,
        _ => return false,
    };
    let is_word_or_table = given.is_instance_of::<PyString>() || given.cast::<PyMapping>().is_ok();
    !is_word_or_table && given.len().is_ok_and(|length| length >= least)
}

/// Returns a table as the text of a scene.
pub(crate) fn text(table: &Table) -> PyResult<String> {
    toml::to_string(table).map_err(|error| PyTypeError::new_err(error.to_string()))
}

/// Reads the values of a scene.
struct Reader {
    /// Number of values that may still come.
    left: usize,
    /// The name of an array at the path of a key.
    named: fn(&str) -> String,
    /// The arrays that stand for tables in files, by their names.
    arrays: BTreeMap<PathBuf, Vec<f64>>,
}

impl Reader {
    fn new(named: fn(&str) -> String) -> Self {
        Self { left: MOST_VALUES, named, arrays: BTreeMap::new() }
    }

    /// Keeps an array that the package's function `check` has looked at, and returns its name.
    fn keep(&mut self, check: &str, given: &Bound<'_, PyAny>, path: &str) -> PyResult<String> {
        let name = (self.named)(path);
        let checked = given.py().import("foldwell.arrays")?.getattr(check)?.call1((given, &name))?;
        let numbers: PyReadonlyArray1<'_, f64> = checked.extract()?;
        self.arrays.insert(PathBuf::from(&name), numbers.as_slice()?.to_vec());
        Ok(name)
    }

    fn table(&mut self, dict: &Bound<'_, PyDict>, path: &str, level: usize) -> PyResult<Table> {
        let mut table = Table::new();
        for (key, given) in dict {
            let key = key.cast::<PyString>().map_err(|_| {
                let place = if path.is_empty() { String::new() } else { format!("{path}: ") };
                PyTypeError::new_err(format!("{place}keys of a scene are str"))
            })?;
            let key: String = read(key, path)?;
            let place = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            if place == "load" && given.hasattr("dtype")? {
                self.keep("forces", &given, LOADS)?;
            } else if !given.is_none() {
                table.insert(key, self.value(&given, &place, level + 1)?);
            }
        }
        Ok(table)
    }

    fn value(&mut self, given: &Bound<'_, PyAny>, path: &str, level: usize) -> PyResult<Value> {
        let py = given.py();
        if level > MOST_LEVELS {
            let top = path.split('.').next().unwrap_or_default();
            let message = format!("{top}: more than {MOST_LEVELS} dicts and lists within each other");
            return Err(refused(py, message, "does it contain itself?"));
        }
        self.left = self.left.checked_sub(1).ok_or_else(|| {
            refused(py, format!("{path}: a scene has at most {MOST_VALUES} values"), "is it an iterator without end?")
        })?;
        if is_of_edges(given, path) {
            let key = if path.contains(".mode") { "rates" } else { "file" };
            let name = self.keep("of_edges", given, path)?;
            return Ok(Value::Table(Table::from_iter([(key.to_owned(), name.into())])));
        }
        if let Ok(dict) = given.cast::<PyDict>() {
            return Ok(Value::Table(self.table(dict, path, level)?));
        }
        if given.is_instance_of::<PyBool>() {
            return Ok(Value::Boolean(given.extract()?));
        }
        if given.is_instance_of::<PyString>() {
            return Ok(Value::String(read(given, path)?));
        }
        if given.is_instance_of::<PyFloat>() {
            return Ok(Value::Float(given.extract()?));
        }
        if given.hasattr("__fspath__")? {
            return Ok(Value::String(read(&given.call_method0("__fspath__")?, path)?));
        }
        if given.hasattr("tolist")? {
            return self.value(&given.call_method0("tolist")?, path, level + 1); // arrays and numbers of NumPy
        }
        if given.hasattr("__index__")? {
            return Ok(Value::Integer(read(given, path)?));
        }
        if let Ok(mapping) = given.cast::<PyMapping>() {
            let dict = PyDict::new(py);
            dict.update(mapping)?;
            return self.value(&dict, path, level + 1);
        }
        if let Ok(items) = given.try_iter() {
            let list = items.enumerate().map(|(k, item)| self.value(&item?, &format!("{path}.{k}"), level + 1));
            return Ok(Value::Array(list.collect::<PyResult<_>>()?));
        }
        let kind = given.get_type().name()?;
        let law = match path.ends_with(".law") && given.is_callable() {
            true => {
                "a law is {\"kind\": \"formula\", ..} or {\"kind\": \"table\", ..}, other functions are terms: `with_term`"
            }
            false => "give a bool, number, str, path, list or dict",
        };
        let message = format!("{path}: a {kind} is no value of a scene; {law}");
        Err(PyTypeError::new_err(message))
    }
}

/// Returns a text or a whole number; a `SceneError` if a scene cannot have it: half of a surrogate pair, a number of
/// more than 64 bits.
fn read<'a, 'py, T: FromPyObject<'a, 'py>>(given: &'a Bound<'py, PyAny>, path: &str) -> PyResult<T> {
    given.extract().map_err(|error: T::Error| {
        let error: PyErr = error.into();
        refused(given.py(), format!("{path}: {error}"), "expected a text of Unicode, or a whole number of 64 bits")
    })
}
