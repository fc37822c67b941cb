//! What a computation wants to tell its user beside its result.

use core::fmt;

use crate::Clock;

/// One thing that was not as the user might expect, and what was done about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// A stable word for programs, such as `stroke-skipped`.
    pub code: &'static str,
    /// A sentence for people: what, where, what was done.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// The time one stage took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// `read`, `preprocess`, `classify`, `structure`, `depth`, `mesh` or `write`.
    pub name: &'static str,
    /// Milliseconds; 0 where the shell gave no clock.
    pub ms: f64,
}

/// Warnings and stage times, in the order in which they arose.
///
/// ```
/// let mut report = base::Report::default();
/// report.warn("stroke-skipped", "stroke 3 has one point and was left out");
/// let two = report.stage("structure", &base::NoClock, |_| 1 + 1);
/// assert_eq!((two, report.warnings.len(), report.stages[0].name), (2, 1, "structure"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Everything to be told.
    pub warnings: Vec<Warning>,
    /// Stage times; a stage that ran twice is listed once with the sum.
    pub stages: Vec<Stage>,
}

impl Report {
    /// Adds a warning.
    pub fn warn(&mut self, code: &'static str, message: impl Into<String>) {
        self.warnings.push(Warning { code, message: crate::brief(&message.into()) });
    }

    /// Runs `f` and books its time under `name`.
    pub fn stage<T>(&mut self, name: &'static str, clock: &dyn Clock, f: impl FnOnce(&mut Self) -> T) -> T {
        let start = clock.now_ms();
        let value = f(self);
        self.book(name, clock.now_ms() - start);
        value
    }

    /// Adds `ms` milliseconds to the stage `name`.
    pub fn book(&mut self, name: &'static str, ms: f64) {
        match self.stages.iter_mut().find(|s| s.name == name) {
            Some(stage) => stage.ms += ms,
            None => self.stages.push(Stage { name, ms }),
        }
    }
}
