//! Files of hand edits.

use std::path::Path;

use burgeon::document::PlantEdit;
use burgeon::shape::{Destination, EDITS_SCHEMA, EditsFile, HandEdit};
use burgeon::{ItemReport, plainly};

use crate::failure::{Failure, Outcome};
use crate::files;

/// Reads the edits of a file, all within their ranges.
pub(crate) fn read(path: &Path) -> Outcome<Vec<PlantEdit>> {
    let text = files::read_text(path)?;
    let file: EditsFile = serde_json::from_str(&text).map_err(|e| {
        Failure::bad_file(
            path,
            format_args!(
                "is not an edits file: {}; `burgeon shape --template` prints one",
                plainly(&e.to_string())
            ),
        )
    })?;
    if file.schema != EDITS_SCHEMA {
        let what = format_args!("is of schema \"{}\"; this version reads \"{EDITS_SCHEMA}\"", file.schema);
        return Err(Failure::bad_file(path, what));
    }
    for (k, edit) in file.edits.iter().enumerate() {
        edit.check().map_err(|why| {
            let word = edit.word();
            match along(edit).filter(|at| !(0.0..=1.0).contains(at)) {
                Some(at) => {
                    let line = "but it is a share of the branch's length; give a number from 0 to 1";
                    Failure::bad_file(path, format_args!("edit {k} ({word}): at is {at}, {line}"))
                }
                None => Failure::bad_file(path, format_args!("edit {k} ({word}): {why}")),
            }
        })?;
    }
    Ok(file.edits.into_iter().map(PlantEdit::from).collect())
}

/// Returns the place along a branch that an edit names.
fn along(edit: &HandEdit) -> Option<f64> {
    match edit {
        HandEdit::Prune { at, .. }
        | HandEdit::Move { to: Destination::Place { at, .. }, .. }
        | HandEdit::Copy { to: Destination::Place { at, .. }, .. } => Some(*at),
        HandEdit::SketchBranch { at, .. } => *at,
        _ => None,
    }
}

/// Fails if all new edits of a plant failed, as the result is not what was asked for. A project's own edits, which come
/// first, do not count.
pub(crate) fn some_done(path: &Path, item: &ItemReport, asked: usize) -> Outcome {
    let new = &item.edits[item.edits.len().saturating_sub(asked)..];
    let Some(first) = new.first() else { return Ok(()) };
    if new.iter().any(|e| e.done) {
        return Ok(());
    }
    let why = first.said.trim_start_matches("not done: ");
    let line = match new.len() {
        1 => format!("its edit could not be done: {why}"),
        n => format!("none of its {n} edits could be done; the first: {why}"),
    };
    let line = format_args!("{line}; `burgeon shape --list` names the branches");
    Err(Failure::bad_file(path, line))
}
