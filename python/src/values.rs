//! Python values as values of a scene.

use crate::errors::refused;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyString};
use toml::{Table, Value};

/// Most levels of dicts, lists and arrays within each other: a value that contains itself has more, and values are read
/// by as many nested calls.
const MOST_LEVELS: usize = 100;
/// Most values of a scene: an iterator without end has more, and so have lists that contain each other many times.
const MOST_VALUES: usize = 10_000_000;

/// Returns a dict as a table of TOML. Keys with the value `None` are left out; tuples, arrays and other sequences
/// become lists, paths texts.
pub(crate) fn table(dict: &Bound<'_, PyDict>) -> PyResult<Table> {
    Reader { left: MOST_VALUES }.table(dict, "", 0)
}

/// Returns a table as the text of a scene.
pub(crate) fn text(table: &Table) -> PyResult<String> {
    toml::to_string(table).map_err(|error| PyTypeError::new_err(error.to_string()))
}

/// Reads the values of a scene.
struct Reader {
    /// Number of values that may still come.
    left: usize,
}

impl Reader {
    fn table(&mut self, dict: &Bound<'_, PyDict>, path: &str, level: usize) -> PyResult<Table> {
        let mut table = Table::new();
        for (key, given) in dict {
            let key = key.cast::<PyString>().map_err(|_| {
                let place = if path.is_empty() { String::new() } else { format!("{path}: ") };
                PyTypeError::new_err(format!("{place}keys of a scene are str"))
            })?;
            let key: String = read(key, path)?;
            if !given.is_none() {
                let place = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                table.insert(key, self.value(&given, &place, level + 1)?);
            }
        }
        Ok(table)
    }

    fn value(&mut self, given: &Bound<'_, PyAny>, path: &str, level: usize) -> PyResult<Value> {
        let py = given.py();
        if level > MOST_LEVELS {
            let top = path.split(['.', '[']).next().unwrap_or_default();
            let message = format!("{top}: more than {MOST_LEVELS} dicts and lists within each other");
            return Err(refused(py, message, "does it contain itself?"));
        }
        self.left = self.left.checked_sub(1).ok_or_else(|| {
            refused(py, format!("{path}: a scene has at most {MOST_VALUES} values"), "is it an iterator without end?")
        })?;
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
        if let Ok(items) = given.try_iter() {
            let list = items.enumerate().map(|(k, item)| self.value(&item?, &format!("{path}[{k}]"), level + 1));
            return Ok(Value::Array(list.collect::<PyResult<_>>()?));
        }
        let kind = given.get_type().name()?;
        let message = format!("{path}: a {kind} is no value of a scene; give a bool, number, str, path, list or dict");
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
