//! Messages of a computation to its user, in addition to its result.

use core::fmt::{self, Display};

use crate::{Check, Clock};

/// An unexpected condition, and how the computation handled it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// A stable word for programs, such as `stroke-skipped`.
    pub code: &'static str,
    /// A sentence for people: the condition, its place and the action taken.
    pub message: String,
    /// Numbers and names in that sentence, for other languages; see [`crate::warn!`].
    pub fields: Vec<(&'static str, String)>,
}

impl Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// Most warnings that differ in numbers and names alone and are still listed one by one; more become one with a count.
const MOST_ALIKE: usize = 4;

/// Name of the field that holds how many others a warning stands for.
const MORE: &str = "more";

impl Warning {
    /// Returns how many warnings this one stands for.
    fn count(&self) -> usize {
        let more = self.fields.iter().find(|(name, _)| *name == MORE);
        1 + more.and_then(|(_, count)| count.parse().ok()).unwrap_or(0)
    }

    /// Whether both warnings differ in numbers and names alone.
    fn is_like(&self, other: &Self) -> bool {
        self.code == other.code && frame(self.own_message()) == frame(other.own_message())
    }

    /// Returns the message without the count of others.
    fn own_message(&self) -> &str {
        if self.count() == 1 {
            return &self.message;
        }
        self.message.rsplit_once(" (and ").map_or(&*self.message, |(own, _)| own)
    }

    /// Sets how many warnings this one stands for.
    fn stand_for(&mut self, count: usize) {
        let more = count - 1;
        self.message = format!("{} (and {more} more like it)", self.own_message());
        self.fields.retain(|(name, _)| *name != MORE);
        self.fields.push((MORE, more.to_string()));
    }
}

/// Returns a message without its numbers and its quoted words.
fn frame(message: &str) -> String {
    let unquoted = message.split(['`', '"']).step_by(2).collect::<Vec<_>>().join("\"");
    unquoted.chars().filter(|c| !c.is_ascii_digit() && *c != '.').collect()
}

/// Merges warnings that differ in numbers and names alone into one with a count if there are more than four of them.
///
/// ```
/// let strokes = (1..=20).map(|k| format!("stroke {k} has one point and was left out"));
/// let mut report = base::Report::default();
/// strokes.for_each(|message| report.warn("stroke-skipped", message));
/// let [one] = &report.warnings[..] else { panic!("{:?}", report.warnings) };
/// assert_eq!(one.message, "stroke 1 has one point and was left out (and 19 more like it)");
/// assert_eq!(base::gathered(report.warnings.clone()), report.warnings);
/// ```
pub fn gathered(warnings: impl IntoIterator<Item = Warning>) -> Vec<Warning> {
    let mut all = Vec::new();
    warnings.into_iter().for_each(|warning| gather(&mut all, warning));
    all
}

/// Adds a warning, or counts it at an equivalent one.
fn gather(all: &mut Vec<Warning>, new: Warning) {
    let alike: Vec<usize> = (0..all.len()).filter(|&i| all[i].is_like(&new)).collect();
    let count = alike.iter().map(|&i| all[i].count()).sum::<usize>() + new.count();
    match alike.split_first() {
        Some((&first, others)) if count > MOST_ALIKE => {
            all[first].stand_for(count);
            others.iter().rev().for_each(|&i| drop(all.remove(i)));
        }
        _ => all.push(new),
    }
}

/// Time that one stage took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// `read`, `preprocess`, `classify`, `structure`, `depth`, `mesh` or `write`.
    pub name: &'static str,
    /// Milliseconds; 0 where the shell gave no clock.
    pub ms: f64,
}

/// Warnings, checks and stage times, in the order in which they arose.
///
/// ```
/// let mut report = base::Report::default();
/// report.warn("stroke-skipped", "stroke 3 has one point and was left out");
/// let two = report.stage("structure", &base::NoClock, |_| 1 + 1);
/// assert_eq!((two, report.warnings.len(), report.stages[0].name), (2, 1, "structure"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// All warnings.
    pub warnings: Vec<Warning>,
    /// Stage times; a stage that ran twice is listed once with the sum.
    pub stages: Vec<Stage>,
    /// All checks of the result, failed or not.
    pub checks: Vec<Check>,
}

/// Warns in a sentence whose numbers and names are fields, so that every language has its own words around them.
///
/// Every field stands in the sentence by its name.
///
/// ```
/// let mut report = base::Report::default();
/// let rows = [1, 2];
/// base::warn!(report, "rock-open", { rock = 1, edges = rows.len() }, "rock {rock} has {edges} open edges");
/// let warning = &report.warnings[0];
/// assert_eq!(warning.message, "rock 1 has 2 open edges");
/// assert_eq!(warning.fields, [("rock", "1".to_owned()), ("edges", "2".to_owned())]);
/// ```
#[macro_export]
macro_rules! warn {
    ($report:expr, $code:expr, { $($field:ident = $value:expr),+ $(,)? }, $text:literal) => {{
        $(let $field = &$value;)+
        $report.warn_of($code, &[$((stringify!($field), $field)),+], format!($text));
    }};
}

impl Report {
    /// Adds a warning.
    pub fn warn(&mut self, code: &'static str, message: impl Into<String>) {
        self.warn_of(code, &[], message);
    }

    /// As [`Report::warn`], with numbers and names for other languages. For [`crate::warn!`], which takes them from the
    /// sentence itself.
    pub fn warn_of(
        &mut self,
        code: &'static str,
        fields: &[(&'static str, &dyn Display)],
        message: impl Into<String>,
    ) {
        let fields = fields.iter().map(|(name, value)| (*name, value.to_string())).collect();
        gather(&mut self.warnings, Warning { code, message: crate::brief(&message.into()), fields });
    }

    /// Adds a check; a failed one also adds a warning under its name, with its remedy.
    pub fn check(&mut self, check: Check) {
        if !check.holds() {
            let [value, bound] = &check.shown;
            let message = format!("{}: {}", check.said(), check.advice);
            self.warn_of(check.name, &[("value", value), ("bound", bound)], message);
        }
        self.checks.push(check);
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
