//! Python values -> JSON, for the readers of specs.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use serde_json::{Map, Number, Value};

use crate::fault::beyond;

/// Greatest nesting, deeper than any spec; a list that holds itself ends here.
const DEEPEST: usize = 32;

/// Largest whole number up to which a float distinguishes each from the next: 2^53.
const LARGEST_WHOLE: f64 = 9_007_199_254_740_992.0;

/// Converts a value to JSON; arrays and numbers of `NumPy` count as lists and numbers. `path`: its name in messages.
pub(crate) fn json_of(value: &Bound<'_, PyAny>, path: &str) -> PyResult<Value> {
    convert(value, path, 0)
}

fn convert(value: &Bound<'_, PyAny>, path: &str, depth: usize) -> PyResult<Value> {
    if depth > DEEPEST {
        return Err(beyond(path, "more", &format!("nested at most {DEEPEST} deep")));
    }
    let child = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    if value.is_none() {
        return Ok(Value::Null);
    }
    if let Ok(truth) = value.cast::<PyBool>() {
        return Ok(Value::Bool(truth.is_true()));
    }
    if value.is_instance_of::<PyInt>() {
        let whole = value.extract::<i64>().map(Number::from);
        let whole = whole.or_else(|_| value.extract::<u64>().map(Number::from));
        let much = |_| beyond(path, value, "a whole number below 2^64");
        return whole.map(Value::Number).map_err(much);
    }
    if value.is_instance_of::<PyFloat>() {
        let number: f64 = value.extract()?;
        // Numbers of NumPy are often floats that count things: a field of whole numbers accepts them.
        if number.fract() == 0.0 && number.abs() <= LARGEST_WHOLE {
            #[expect(clippy::cast_possible_truncation, reason = "whole, and within 2^53")]
            return Ok(Value::Number((number as i64).into()));
        }
        let none = || beyond(path, number, "a finite number");
        return Number::from_f64(number).map(Value::Number).ok_or_else(none);
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Value::String(text.extract::<String>()?));
    }
    if let Ok(table) = value.cast::<PyDict>() {
        let mut fields = Map::new();
        for (key, value) in table.iter() {
            let Ok(name) = key.extract::<String>() else {
                return Err(PyTypeError::new_err(format!("{path}: names of fields are text, not {key}")));
            };
            let value = convert(&value, &child(&name), depth + 1)?;
            fields.insert(name, value);
        }
        return Ok(Value::Object(fields));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let rows = value.try_iter()?.enumerate();
        let rows = rows.map(|(k, row)| convert(&row?, &format!("{path}[{k}]"), depth + 1));
        return Ok(Value::Array(rows.collect::<PyResult<_>>()?));
    }
    if value.hasattr("tolist")? {
        let plain = value.call_method0("tolist")?;
        return convert(&plain, path, depth + 1);
    }
    let kind = value.get_type();
    Err(PyTypeError::new_err(format!("{path}: a {} cannot be part of a spec", kind.name()?)))
}
