//! Errors of the core -> exceptions of Python with code and fields.

use std::fmt::Display;

use burgeon::{Coded, Told};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// An exception of the module `burgeon.errors`.
fn exception(py: Python<'_>, class: &str, message: &str, told: Option<&Told>) -> PyErr {
    let made = || -> PyResult<Bound<'_, PyAny>> {
        let fields = PyDict::new(py);
        for (name, value) in told.iter().flat_map(|t| &t.fields) {
            fields.set_item(name, value)?;
        }
        let code = told.map_or("", |t| t.code);
        py.import("burgeon.errors")?.getattr(class)?.call1((message, code, fields))
    };
    made().map_or_else(|e| e, PyErr::from_value)
}

/// What is wrong with what was asked for, or that it was stopped.
pub(crate) fn refused<E: Coded + Display>(py: Python<'_>, error: &E) -> PyErr {
    let told = error.told();
    let class = match told.code {
        "cancelled" => return PyKeyboardInterrupt::new_err("stopped"),
        "over-budget" => "BudgetError",
        _ => "SpecError",
    };
    exception(py, class, &error.to_string(), Some(&told))
}

/// The same, in words alone.
pub(crate) fn unusable(py: Python<'_>, error: &impl Display) -> PyErr {
    exception(py, "SpecError", &error.to_string(), None)
}
