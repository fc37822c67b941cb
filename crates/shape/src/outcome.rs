//! Outcomes of edits, in plain words.

use core::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Reason why an edit could not be done. Its text is for people, [`code`](Self::code) for programs and translations.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Why {
    /// No branch is like the marked one.
    #[error("the branch is gone: no branch of this plant is like the one that was edited")]
    BranchGone,
    /// A path names a branch by a number that does not exist.
    #[error("there is no branch number {number} there: it has {there} (numbered from 0)")]
    NoSuchNumber {
        /// The number.
        number: u32,
        /// Number of branches.
        there: usize,
    },
    /// A path of no numbers.
    #[error("the path names no branch: give at least the number of a stem, such as [0]")]
    EmptyPath,
    /// No axis near a point.
    #[error("no branch comes within {within_m:.3} m of the point")]
    NothingNear {
        /// Largest distance allowed.
        within_m: f64,
    },
    /// A number is not finite or out of range.
    #[error("{field} is not a number that can be used")]
    BadNumber {
        /// The field.
        field: &'static str,
    },
    /// A line without length, an outline without area.
    #[error("the {what} is too small")]
    TooSmall {
        /// The line or outline.
        what: &'static str,
    },
    /// A stroke or outline has too many points.
    #[error("it has more than {most} points: draw it in parts")]
    TooLong {
        /// Largest number of points.
        most: usize,
    },
    /// The branch stands on the ground and cannot slide along a bearer.
    #[error("the branch stands on the ground: it can be moved by a vector, not along a bearer")]
    NoBearer,
    /// A branch cannot be moved onto itself or onto a branch that it bears.
    #[error("a branch cannot be moved onto itself or onto one of its own branches")]
    OntoItself,
    /// Nothing grew.
    #[error("nothing grew: there is no room, or no branch within reach")]
    NothingGrew,
    /// The whole plant would be cut off.
    #[error("that would leave nothing of the plant")]
    NothingLeft,
    /// There are no leaves in the region.
    #[error("there are no leaves there")]
    NoLeaves,
    /// The plant has no branch at all.
    #[error("the plant has no branch")]
    NoBranches,
    /// The edit would make the plant too large.
    #[error("the plant would have more than {most} branches")]
    TooMany {
        /// Largest number of branches.
        most: usize,
    },
}

impl Why {
    /// Returns a stable word for programs.
    pub const fn code(&self) -> &'static str {
        match self {
            Self::BranchGone => "branch-gone",
            Self::NoSuchNumber { .. } => "no-such-number",
            Self::EmptyPath => "empty-path",
            Self::NothingNear { .. } => "nothing-near",
            Self::BadNumber { .. } => "bad-number",
            Self::TooSmall { .. } => "too-small",
            Self::TooLong { .. } => "too-long",
            Self::NoBearer => "no-bearer",
            Self::OntoItself => "onto-itself",
            Self::NothingGrew => "nothing-grew",
            Self::NothingLeft => "nothing-left",
            Self::NoLeaves => "no-leaves",
            Self::NoBranches => "no-branches",
            Self::TooMany { .. } => "too-many",
        }
    }
}

/// Changes made by an edit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Changed {
    /// Branches removed.
    pub removed: usize,
    /// Branches added.
    pub added: usize,
    /// Branches turned or moved, those borne included.
    pub moved: usize,
    /// Leaves removed.
    pub leaves_removed: usize,
    /// Leaves added.
    pub leaves_added: usize,
    /// Branches that a mirror plane has on one side only: no wood bears them on the other, or an obstacle stands there.
    #[serde(skip_serializing_if = "is_zero")]
    pub alone: usize,
    /// Whether the branch was found by its likeness because its own key had changed.
    pub by_likeness: bool,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
const fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// Outcome of one edit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// It was done.
    Done(Changed),
    /// It was not done, and the plant is unchanged.
    NotDone(Why),
}

impl Outcome {
    /// Whether it was done.
    pub const fn is_done(&self) -> bool {
        matches!(self, Self::Done(_))
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let c = match self {
            Self::NotDone(why) => return write!(f, "not done: {why}"),
            Self::Done(changed) => changed,
        };
        let said = [
            (c.moved, "moved", "branch", "branches"),
            (c.removed, "taken away", "branch", "branches"),
            (c.added, "grown", "branch", "branches"),
            (c.leaves_removed, "taken away", "leaf", "leaves"),
            (c.leaves_added, "added", "leaf", "leaves"),
            (c.alone, "on one side only", "branch", "branches"),
        ];
        let parts: Vec<String> = said
            .iter()
            .filter(|(n, ..)| *n > 0)
            .map(|(n, did, one, many)| format!("{n} {} {did}", if *n == 1 { one } else { many }))
            .collect();
        write!(f, "{}", if parts.is_empty() { "nothing to change".to_owned() } else { parts.join(", ") })?;
        if c.by_likeness {
            write!(f, " (the branch was found by its likeness)")?;
        }
        Ok(())
    }
}
