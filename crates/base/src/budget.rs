//! Limits on the amount that a computation may make: checked before the work starts, refused in one line.

use core::fmt;

/// Quantity that a budget limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Counted {
    /// Roots: trees that grow side by side.
    Roots,
    /// Attraction points and markers of one tree or stand.
    Points,
    /// Joints of skeletons: internodes, metamers, modules of a string.
    Joints,
    /// Points that buds query, counted once for each query: the measure of time for growth by markers.
    Course,
    /// Joints times the years that they live through: the measure of time for self-organising growth.
    MarkerQueries,
    /// Joints times the years that they live through: what self-organising growth takes time for.
    JointYears,
    /// Places for leaves.
    Leaves,
    /// Triangles of meshes.
    Triangles,
    /// Triangles of all obstacles and envelopes.
    Obstacles,
    /// Mean number of bounding boxes of triangles that overlap at a place on an obstacle's surface, which sets the time
    /// to find the nearest one. Two or three in a mesh of even triangles, many in a fan of slivers.
    Slivers,
    /// Strokes of a drawing.
    Strokes,
    /// Edits by hand of one plant.
    Edits,
    /// Nodes, leaves and flowers, counted once for each edit that visits them: the measure of time for edits.
    Pieces,
    /// Measured sizes, counted once for each comparison with a growth law: the measure of time for laws.
    EditedPieces,
    /// Measured sizes, each time that a growth law is compared with them: what laws take time for.
    Comparisons,
    /// Trees of a stand: rows of an inventory, trees that grow.
    Trees,
    /// Neighbours that the trees of a stand check in one step of growth: the measure of time for competition.
    Cells,
    /// Neighbours that trees of a stand look at in one step of growth: what competition takes time for.
    Looks,
}

impl Counted {
    /// All quantities, in the order of `docs/limits.md`.
    pub const ALL: [Self; 18] = [
        Self::Roots,
        Self::Points,
        Self::Joints,
        Self::Course,
        Self::MarkerQueries,
        Self::JointYears,
        Self::Leaves,
        Self::Triangles,
        Self::Obstacles,
        Self::Slivers,
        Self::Strokes,
        Self::Edits,
        Self::Pieces,
        Self::EditedPieces,
        Self::Comparisons,
        Self::Trees,
        Self::Cells,
        Self::Looks,
    ];

    /// Returns the name of the quantity in messages.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Roots => "roots",
            Self::Points => "attraction points",
            Self::Joints => "joints",
            Self::Course => "steps or leaves along one shoot",
            Self::MarkerQueries => "marker queries",
            Self::JointYears => "joints times years",
            Self::Leaves => "places for leaves",
            Self::Triangles => "triangles",
            Self::Obstacles => "triangles of obstacles and envelopes",
            Self::Slivers => "slivers side by side at a place of an obstacle, in the mean,",
            Self::Strokes => "strokes",
            Self::Edits => "edits",
            Self::Pieces => "nodes, leaves and flowers",
            Self::EditedPieces => "nodes, leaves and flowers that edits go through",
            Self::Comparisons => "comparisons of sizes with growth laws",
            Self::Trees => "trees of a stand",
            Self::Cells => "cells of a map",
            Self::Looks => "looks of trees at neighbours",
        }
    }

    /// Returns the usual limit. Each is well above what practical plants need; a computation that stays within all of
    /// them stays within [`Budget::bytes`].
    pub const fn limit(self) -> u64 {
        match self {
            Self::Roots | Self::Slivers => 1_000,
            Self::Points => 2_000_000,
            Self::Joints => 2_000_000,
            Self::Leaves | Self::Obstacles | Self::Pieces => 1_000_000,
            Self::Course => 100_000,
            Self::MarkerQueries => 100_000_000,
            Self::JointYears => 20_000_000,
            // Some 50,000 sizes.
            Self::Comparisons => 500_000_000,
            Self::Triangles => 16_000_000,
            // Some 220 bytes each while they grow.
            Self::Trees => 10_000_000,
            // Four bytes each: ten kilometres at one metre.
            Self::Cells => 100_000_000,
            // Some minutes for each step; a million trees of one size look 100 million times.
            Self::Looks => 50_000_000_000,
            Self::Strokes => 20_000,
            Self::Edits => 1_000,
            // The most edits of an oak.
            Self::EditedPieces => 60_000_000,
        }
    }
}

/// Limits of a computation, as a factor on the usual ones. Plain data; it never changes a result: exceeding a limit is
/// an error and does not yield another plant.
///
/// ```
/// use base::{Budget, Counted};
/// let budget = Budget { raise: Some("--budget"), ..Budget::default() };
/// assert!(budget.check(Counted::Points, 1_500, "lower points").is_ok());
/// let refused = budget.check(Counted::Points, 10_000_000, "lower points").unwrap_err();
/// assert_eq!(
///     refused.to_string(),
///     "10,000,000 attraction points are more than the limit of 2,000,000: lower points, or allow more with --budget 5"
/// );
/// assert!(Budget { times: 5.0, ..budget }.check(Counted::Points, 10_000_000, "lower points").is_ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Factor on the usual limits, above 0; 1 by default. Infinity switches the limits off; use it only deliberately.
    pub times: f64,
    /// The option that raises the factor, for messages; `None` if there is no such option.
    pub raise: Option<&'static str>,
}

impl Default for Budget {
    fn default() -> Self {
        Self { times: 1.0, raise: None }
    }
}

/// Live memory at the usual limits, bytes: 4 GiB.
const BYTES: u64 = 4 << 30;
/// Largest factor that a message suggests.
const MOST: f64 = 1000.0;

impl Budget {
    /// Returns the limit of a quantity.
    pub fn limit(&self, what: Counted) -> u64 {
        self.scaled(what.limit())
    }

    /// Returns the memory that may be in use at one time, bytes. The allocator of the shell enforces it: the core
    /// cannot.
    pub fn bytes(&self) -> u64 {
        self.scaled(BYTES)
    }

    fn scaled(&self, usual: u64) -> u64 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "limits are small integers; a product that is too large saturates"
        )]
        let limit = (usual as f64 * self.times) as u64;
        limit
    }

    /// Fails if `number` is above the limit. `remedy` names the field or option to change, such as `lower points`.
    ///
    /// # Errors
    /// [`OverBudget`].
    pub fn check(&self, what: Counted, number: u64, remedy: &'static str) -> Result<(), OverBudget> {
        let limit = self.limit(what);
        if number <= limit {
            return Ok(());
        }
        #[expect(clippy::cast_precision_loss, reason = "a factor, rounded up")]
        let times = (number as f64 / what.limit() as f64).ceil();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1000")]
        let raise = self.raise.filter(|_| times <= MOST).map(|option| (option, times as u32));
        Err(OverBudget { what, number, limit, remedy, raise })
    }

    /// As [`check`](Self::check), for a number that was computed from lengths: a number that is not finite exceeds
    /// every limit.
    ///
    /// # Errors
    /// [`OverBudget`].
    pub fn check_estimate(&self, what: Counted, number: f64, remedy: &'static str) -> Result<(), OverBudget> {
        if self.times.is_infinite() {
            return Ok(());
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        let whole = if number.is_nan() { u64::MAX } else { number.ceil() as u64 };
        self.check(what, whole, remedy)
    }
}

/// A limit of the budget was exceeded; nothing was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OverBudget {
    /// The quantity.
    pub what: Counted,
    /// Lower bound of the number that would have been made.
    pub number: u64,
    /// The limit.
    pub limit: u64,
    /// The field or option to change.
    pub remedy: &'static str,
    /// The option that raises the limit, and the value that it needs.
    pub raise: Option<(&'static str, u32)>,
}

impl core::error::Error for OverBudget {}

impl fmt::Display for OverBudget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, number, limit, remedy, raise } = self;
        let (number, limit, what) = (grouped(*number), grouped(*limit), what.words());
        write!(f, "{number} {what} are more than the limit of {limit}: {remedy}")?;
        raise.map_or(Ok(()), |(option, times)| write!(f, ", or allow more with {option} {times}"))
    }
}

/// Writes a number with its digits in groups of three: `10,000,000`.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut out = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

crate::coded!(OverBudget {
    Self { what, number, limit, .. } => "over-budget" {
        what = what.words(), number = grouped(*number), limit = grouped(*limit)
    },
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_grouped() {
        let got = [0, 999, 1000, 1_234_567].map(grouped);
        assert_eq!(got, ["0", "999", "1,000", "1,234,567"]);
    }

    #[test]
    fn what_is_at_the_limit_passes_and_one_more_does_not() {
        for times in [0.25, 1.0, 1000.0] {
            let budget = Budget { times, ..Budget::default() };
            for what in Counted::ALL {
                let limit = budget.limit(what);
                assert_eq!(budget.check(what, limit, "lower it"), Ok(()));
                let refused = budget.check(what, limit + 1, "lower it").map_err(|e| (e.number, e.limit));
                assert_eq!(refused, Err((limit + 1, limit)));
            }
        }
    }

    #[test]
    fn estimates_that_are_no_numbers_are_too_many_but_for_those_who_asked_for_no_limits() {
        let budget = Budget::default();
        for bad in [f64::NAN, f64::INFINITY, 1e300] {
            assert!(budget.check_estimate(Counted::Leaves, bad, "lower it").is_err());
            let unlimited = Budget { times: f64::INFINITY, ..budget };
            assert_eq!(unlimited.check_estimate(Counted::Leaves, bad, "lower it"), Ok(()));
        }
        assert_eq!(budget.check_estimate(Counted::Leaves, -1.0, "lower it"), Ok(()));
    }

    #[test]
    fn only_what_can_be_raised_says_how() {
        let budget = Budget { raise: Some("--budget"), ..Budget::default() };
        let line = |n| budget.check(Counted::Roots, n, "give fewer roots").unwrap_err().to_string();
        assert_eq!(
            line(1001),
            "1,001 roots are more than the limit of 1,000: give fewer roots, or allow more with --budget 2"
        );
        assert!(line(1_000_001).ends_with("give fewer roots"), "{}", line(1_000_001));
        let plain = Budget::default().check(Counted::Roots, 1001, "give fewer roots").unwrap_err();
        assert!(plain.to_string().ends_with("give fewer roots"));
    }
}
