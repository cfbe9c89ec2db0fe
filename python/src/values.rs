//! Python values as values of a scene.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyString};
use toml::{Table, Value};

/// Returns a dict as a table of TOML. Keys with the value `None` are left out; tuples, arrays and other sequences become
/// lists, paths texts.
pub(crate) fn table(dict: &Bound<'_, PyDict>) -> PyResult<Table> {
    table_at(dict, "")
}

fn table_at(dict: &Bound<'_, PyDict>, path: &str) -> PyResult<Table> {
    let mut table = Table::new();
    for (key, given) in dict {
        let key: String =
            key.extract().map_err(|_| PyTypeError::new_err(format!("{path}: keys of a scene are str")))?;
        if !given.is_none() {
            let place = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            table.insert(key, value(&given, &place)?);
        }
    }
    Ok(table)
}

fn value(given: &Bound<'_, PyAny>, path: &str) -> PyResult<Value> {
    if let Ok(dict) = given.cast::<PyDict>() {
        return Ok(Value::Table(table_at(dict, path)?));
    }
    if given.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(given.extract()?));
    }
    if given.is_instance_of::<PyString>() {
        return Ok(Value::String(given.extract()?));
    }
    if given.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(given.extract()?));
    }
    if given.hasattr("__fspath__")? {
        return Ok(Value::String(given.call_method0("__fspath__")?.extract()?));
    }
    if given.hasattr("tolist")? {
        return value(&given.call_method0("tolist")?, path); // arrays and numbers of NumPy
    }
    if given.hasattr("__index__")? {
        return Ok(Value::Integer(given.extract()?));
    }
    if let Ok(items) = given.try_iter() {
        let list = items.enumerate().map(|(k, item)| value(&item?, &format!("{path}[{k}]")));
        return Ok(Value::Array(list.collect::<PyResult<_>>()?));
    }
    let kind = given.get_type().name()?;
    let message = format!("{path}: a {kind} is no value of a scene; give a bool, number, str, path, list or dict");
    Err(PyTypeError::new_err(message))
}

/// Returns a table as the text of a scene.
pub(crate) fn text(table: &Table) -> PyResult<String> {
    toml::to_string(table).map_err(|error| PyTypeError::new_err(error.to_string()))
}
