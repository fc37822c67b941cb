//! Errors of the core -> exceptions of Python with code and fields.

use std::fmt::Display;

use burgeon::formats::Foreign;
use burgeon::{Coded, Slip, Told};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// An exception of the module `burgeon.errors`.
fn exception<'a>(
    py: Python<'_>,
    class: &str,
    message: &str,
    code: &str,
    told: impl IntoIterator<Item = (&'a str, &'a str)>,
) -> PyErr {
    let made = || -> PyResult<Bound<'_, PyAny>> {
        let fields = PyDict::new(py);
        for (name, value) in told {
            fields.set_item(name, value)?;
        }
        py.import("burgeon.errors")?.getattr(class)?.call1((message, code, fields))
    };
    made().map_or_else(|e| e, PyErr::from_value)
}

/// Returns the exception for a faulty request, or for a computation that was stopped.
pub(crate) fn refused<E: Coded + Display>(py: Python<'_>, error: &E) -> PyErr {
    let Told { code, fields, .. } = error.details();
    let class = match code {
        "cancelled" => return PyKeyboardInterrupt::new_err("stopped"),
        "over-budget" => "BudgetError",
        _ => "SpecError",
    };
    let fields = fields.iter().map(|(name, value)| (*name, value.as_str()));
    exception(py, class, &error.to_string(), code, fields)
}

/// Returns the exception for a file that another one names and that must not be read.
pub(crate) fn not_readable(py: Python<'_>, error: &companions::NamedFileError) -> PyErr {
    let why = error.to_string();
    exception(py, "SpecError", &why, "file-refused", [("why", why.as_str())])
}

/// Returns the exception for an argument out of its range, with the message of the core.
pub(crate) fn beyond(field: &str, value: impl Display, range: &str) -> PyErr {
    let value = burgeon::quoted(&value.to_string());
    wrong(&format!("{field} must be {range}, not {value}"), field, &value, range)
}

/// Returns the exception for an argument out of its range, with a message of its own.
pub(crate) fn wrong(message: &str, field: &str, value: &str, range: &str) -> PyErr {
    let told = [("field", field), ("value", value), ("range", range)];
    Python::attach(|py| exception(py, "SpecError", message, "field-range", told))
}

/// Returns the exception for an unknown word; the message begins with `what`.
pub(crate) fn choice(field: &str, word: &str, known: &[&str], what: &str) -> PyErr {
    let (word, choices) = (burgeon::quoted(word), known.join(", "));
    let message =
        format!("{what} {word:?}; there are {choices}{}", burgeon::meant(&word, known.iter().copied()));
    let told = [("path", field), ("name", &word), ("choices", &choices)];
    Python::attach(|py| exception(py, "SpecError", &message, "spec-choice", told))
}

/// Returns the exception for an argument that a reader of JSON refused.
pub(crate) fn misread(py: Python<'_>, field: &str, error: &serde_json::Error) -> PyErr {
    let said = error.to_string();
    // Rows follow the name at once.
    let text = if said.starts_with('[') { format!("{field}{said}") } else { format!("{field}: {said}") };
    let slip = Slip::from_message(&text);
    let Told { code, fields, .. } = slip.details();
    let fields = fields.iter().map(|(name, value)| (*name, value.as_str()));
    exception(py, "SpecError", &(burgeon::plainly(&text) + &slip.hint()), code, fields)
}

/// Returns the end of a message with the known word that is probably meant; empty if none is near.
#[pyfunction]
pub(crate) fn meant(word: &str, known: Vec<String>) -> String {
    burgeon::meant(word, known.iter().map(String::as_str))
}

/// Recognises a file of another program by its first bytes, and says what to do with it; None for all readable files.
#[pyfunction]
pub(crate) fn foreign(start: &[u8]) -> Option<String> {
    Foreign::sniff_no_drawing(start).map(|foreign| foreign.to_string())
}

/// Returns the exception for a file that is none of the wanted ones: it names its program, or says `otherwise`.
pub(crate) fn unlike(py: Python<'_>, name: &str, bytes: &[u8], otherwise: &str) -> PyErr {
    match Foreign::sniff(bytes) {
        Some(foreign) => {
            let Told { code, fields, .. } = foreign.details();
            let fields = fields.iter().map(|(name, value)| (*name, value.as_str()));
            exception(py, "SpecError", &format!("{name}: {foreign}"), code, fields)
        }
        None => unusable(py, &format!("{name}: {otherwise}")),
    }
}

/// Returns an exception with only a message.
pub(crate) fn unusable(py: Python<'_>, error: &impl Display) -> PyErr {
    exception(py, "SpecError", &error.to_string(), "", [])
}
