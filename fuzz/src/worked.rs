//! A document in use: it is sound after any request, refused requests change nothing, and steps can be undone.

use burgeon::document::{Command, Document, read_project, write_project};
use burgeon::{Budget, Run, VERSION};
use workspace::{Action, FileKind, GestureRecord, NewMaker, Workspace, WorkspaceError};

use super::made::BUSH;
use super::{refused, split_first_line};

/// Most commands and steps that are run: a mutant never takes minutes.
const MOST_STEPS: usize = 60;

/// A fraction of the default limits: what fits is made in some tenths of a second.
const SMALL: Budget = Budget { times: 0.005, raise: None };

fn small() -> Run<'static> {
    Run { budget: SMALL, ..Run::plain() }
}

fn assert_sound(workspace: &Workspace) {
    assert_eq!(workspace.document().validate().next(), None, "a sound document");
}

/// Checks that a document that was saved and opened is saved as the same bytes: only the numbers of its plants are
/// lost.
fn assert_saved(workspace: &Workspace) {
    let file = workspace.save().expect("a sound document is saved");
    let again = write_project(&read_project(&file).expect("reads what it wrote"), VERSION);
    assert!(again.expect("a sound document is saved") == file, "saved, opened and saved: another file");
}

/// Opens any file, after a line with its name, as the Studio opens it: the result is a sound document that is made and
/// can be undone, or an error after which everything is unchanged.
pub fn opened(bytes: &[u8]) -> bool {
    let (name, file) = split_first_line(bytes);
    let mut workspace = Workspace::default();
    let before = workspace.document().clone();
    let opened = match workspace.open(&name, file, 0, false) {
        Ok(opened) => opened,
        Err(e) => {
            assert!(workspace.document() == &before, "a file that is refused changes nothing");
            return refused(&e);
        }
    };
    assert_sound(&workspace);
    assert_saved(&workspace);
    let after = workspace.document().clone();
    match workspace.evaluate(&small()) {
        Ok(view) => {
            assert_eq!(
                view.guest.is_some(),
                opened.kind == FileKind::Model,
                "a model is shown, and nothing else"
            );
        }
        Err(e) => drop(refused(&e)),
    }
    assert!(workspace.document() == &after, "making a plant changes no document");
    if opened.kind != FileKind::Model && opened.kind != FileKind::Law {
        assert!(workspace.undo().is_some(), "one step of undo");
        assert!(workspace.document() == &before, "taken back");
        assert!(workspace.redo().is_some(), "done again");
        assert!(workspace.document() == &after, "done again");
    }
    true
}

/// Makes a document with a plant of each maker, numbered as they were added: a drawing, a tree, a leaf, a flower.
fn planted() -> Workspace {
    let mut workspace = Workspace::default();
    let drawing = br#"{"burgeon":"drawing/1","strokes":[{"points":[[50,0],[50,40],[52,90]]},{"points":[[52,90],[70,110],[52,130],[34,110],[52,90]]},{"points":[[50,40],[80,60]]}]}"#;
    workspace.open("drawing.json", drawing, 0, true).expect("a drawing of our own");
    workspace.open("bush.toml", BUSH.as_bytes(), 0, false).expect("a spec of our own");
    for maker in [NewMaker::Leaf, NewMaker::Flower("lily".into())] {
        workspace.act(&Action::Add { name: "fuzz".into(), maker }).expect("comes with the program");
    }
    workspace
}

/// Runs commands, one in each line as JSON, and lines `undo` and `redo`. All of them can be undone and redone.
pub fn commands(bytes: &[u8]) -> bool {
    let (mut workspace, mut any) = (planted(), false);
    for line in bytes.split(|&b| b == b'\n').take(MOST_STEPS) {
        let before = workspace.document().clone();
        match line {
            b"undo" => drop(workspace.undo()),
            b"redo" => drop(workspace.redo()),
            _ => {
                if let Ok(command) = serde_json::from_slice::<Command>(line) {
                    let done = workspace.run(command);
                    any |= is_done(done, &workspace, &before);
                } else if let Ok(action) = serde_json::from_slice::<Action>(line) {
                    let done = workspace.act(&action);
                    any |= is_done(done, &workspace, &before);
                }
            }
        }
        assert_sound(&workspace);
    }
    assert_saved(&workspace);
    let end = workspace.document().clone();
    let mut taken_back = 0;
    while workspace.undo().is_some() {
        taken_back += 1;
    }
    for _ in 0..taken_back {
        assert!(workspace.redo().is_some(), "what was taken back is done again");
    }
    assert!(workspace.document() == &end, "taken back, and done again");
    any
}

/// Whether a request was done; checks that a refused one changed nothing.
fn is_done(done: Result<(), WorkspaceError>, workspace: &Workspace, before: &Document) -> bool {
    let Err(e) = done else { return true };
    assert!(workspace.document() == before, "what is refused changes nothing");
    refused(&e)
}

/// Replays a record of gestures, on a document with a plant of each maker: to its end or up to the step that is
/// refused.
pub fn records(bytes: &[u8]) -> bool {
    let mut record = match GestureRecord::read(bytes) {
        Ok(record) => record,
        Err(e) => return refused(&e),
    };
    record.steps.truncate(MOST_STEPS);
    let mut workspace = planted();
    let mut sound = true;
    let replayed = workspace.replay(&record, &small(), &mut |workspace, _| {
        sound &= workspace.document().validate().next().is_none();
    });
    assert!(sound, "a sound document after each step");
    let whole = replayed.map_or_else(|e| refused(&e), |_| true);
    workspace.abandon();
    assert_sound(&workspace);
    assert_saved(&workspace);
    whole
}
