//! Context that every edit receives, and reasons why one stops.

use base::{Cancelled, OverBudget, Report, Run, Stopped};
use growth::{GrowthError, Obstacles};

use crate::draft::Draft;
use crate::habit::Habit;
use crate::outcome::Why;

/// Most axes of a plant after an edit that lets something grow.
pub(crate) const MOST_AXES: usize = 400_000;

/// Reason why an edit stopped.
pub(crate) enum Stop {
    Why(Why),
    Stopped(Stopped),
}

impl From<Why> for Stop {
    fn from(why: Why) -> Self {
        Self::Why(why)
    }
}

impl From<Cancelled> for Stop {
    fn from(c: Cancelled) -> Self {
        Self::Stopped(c.into())
    }
}

impl From<OverBudget> for Stop {
    fn from(much: OverBudget) -> Self {
        Self::Stopped(much.into())
    }
}

impl From<GrowthError> for Stop {
    fn from(error: GrowthError) -> Self {
        match error {
            GrowthError::Cancelled(c) => c.into(),
            // All other numbers are ours or checked, so the place is one where nothing can grow.
            _ => Self::Why(Why::NothingGrew),
        }
    }
}

/// Context of every edit.
pub(crate) struct Bench<'a> {
    pub(crate) obstacles: &'a Obstacles,
    pub(crate) exponent: Option<f64>,
    pub(crate) run: &'a Run<'a>,
}

impl Bench<'_> {
    pub(crate) fn habit(&self, draft: &Draft) -> Habit {
        Habit::learn(draft, self.exponent)
    }
}

/// Makes a report that nobody reads: warnings of growth are part of the outcome or of no interest during a gesture.
pub(crate) fn unread() -> Report {
    Report::default()
}
