//! Named, unlimited undo over a document.

use crate::{Command, CommandError, Document, Event};

/// One step of the history: the unit of undo.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Name of the step: [`Command::name`] of its first command, or the gesture's name.
    pub name: String,
    /// Its events, in order.
    pub events: Vec<Event>,
}

/// A document with its history.
///
/// Guaranteed: a refused command changes nothing; undo of any step gives back the document before it, bit for bit;
/// `document().validate()` is empty after every call.
///
/// ```
/// use document::{Editor, SceneCommand};
/// let mut editor = Editor::default();
/// editor.run(SceneCommand::Rename("roses".into()))?;
/// assert_eq!(editor.undo(), Some("rename-scene"));
/// assert_eq!(editor.document().name(), "plant");
/// # Ok::<(), document::CommandError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Editor {
    document: Document,
    done: Vec<Step>,
    undone: Vec<Step>,
    gesture: Option<Step>,
    revision: u64,
}

impl Editor {
    /// Makes an editor of a document that was read; its history is empty.
    pub fn new(document: Document) -> Self {
        Self { document, ..Self::default() }
    }

    /// Returns the document as it is now, an open gesture included.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Returns a number that grows with every change, undo and redo included, and never returns to an earlier value.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Returns the steps that can be undone, oldest first.
    pub fn done(&self) -> &[Step] {
        &self.done
    }

    /// Returns the steps that can be redone; the next one is last.
    pub fn undone(&self) -> &[Step] {
        &self.undone
    }

    /// Executes a command, as one step or as part of the open gesture.
    ///
    /// # Errors
    /// [`CommandError`]; then nothing changed.
    pub fn run(&mut self, command: impl Into<Command>) -> Result<(), CommandError> {
        let command = command.into();
        let name = command.name();
        let events = command.decide(&self.document)?;
        events.iter().for_each(|e| e.apply(&mut self.document));
        self.revision += 1;
        self.undone.clear();
        match &mut self.gesture {
            Some(step) => step.events.extend(events),
            None => self.done.push(Step { name: name.into(), events }),
        }
        debug_assert!(self.document.validate().next().is_none(), "{:?}", self.document.validate().next());
        Ok(())
    }

    /// Opens a gesture: commands up to [`Editor::commit`] become one step of this name.
    ///
    /// # Errors
    /// [`CommandError::Gesture`] while another is open.
    pub fn begin_gesture(&mut self, name: &str) -> Result<(), CommandError> {
        if self.gesture.is_some() {
            return Err(CommandError::Gesture("a gesture is open already"));
        }
        self.gesture = Some(Step { name: name.into(), events: Vec::new() });
        Ok(())
    }

    /// Replaces all changes of the open gesture so far by one command: a drag shows its latest state only.
    ///
    /// # Errors
    /// [`CommandError`]; then the gesture is as it was before the call.
    pub fn stage(&mut self, command: impl Into<Command>) -> Result<(), CommandError> {
        let Some(mut step) = self.gesture.take() else {
            return Err(CommandError::Gesture("no gesture is open"));
        };
        let mut document = self.document.clone(); // cheap: strokes are shared
        step.events.iter().rev().for_each(|e| e.revert(&mut document));
        let outcome = match command.into().decide(&document) {
            Ok(events) => {
                events.iter().for_each(|e| e.apply(&mut document));
                self.undone.clear();
                step.events = events;
                Ok(())
            }
            // Dragged back to its start.
            Err(CommandError::Nothing(_)) => {
                step.events.clear();
                Ok(())
            }
            Err(error) => Err(error),
        };
        if outcome.is_ok() {
            self.document = document;
            self.revision += 1;
        }
        self.gesture = Some(step);
        outcome
    }

    /// Closes the gesture; if it changed anything, it becomes one step. Returns whether it did.
    pub fn commit(&mut self) -> bool {
        let Some(step) = self.gesture.take() else { return false };
        let changed = !step.events.is_empty();
        if changed {
            self.done.push(step);
        }
        changed
    }

    /// Closes the gesture and reverts it.
    pub fn cancel_gesture(&mut self) {
        if let Some(step) = self.gesture.take() {
            step.events.iter().rev().for_each(|e| e.revert(&mut self.document));
            self.revision += 1;
        }
    }

    /// Undoes the last step and returns its name; an open gesture is closed first.
    pub fn undo(&mut self) -> Option<&str> {
        self.commit();
        let step = self.done.pop()?;
        step.events.iter().rev().for_each(|e| e.revert(&mut self.document));
        self.revision += 1;
        self.undone.push(step);
        self.undone.last().map(|s| s.name.as_str())
    }

    /// Redoes the last step that was undone and returns its name.
    pub fn redo(&mut self) -> Option<&str> {
        self.commit();
        let step = self.undone.pop()?;
        step.events.iter().for_each(|e| e.apply(&mut self.document));
        self.revision += 1;
        self.done.push(step);
        self.done.last().map(|s| s.name.as_str())
    }
}
