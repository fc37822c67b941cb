//! Plausibility checks of a result: measured values against bounds.

/// Which side of a number is plausible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// The number or more.
    AtLeast(f64),
    /// The number or less.
    AtMost(f64),
}

impl Bound {
    /// Returns the number itself.
    pub const fn number(self) -> f64 {
        match self {
            Self::AtLeast(x) | Self::AtMost(x) => x,
        }
    }

    /// Whether a value is on the plausible side; NaN never is.
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::AtLeast(x) => value >= x,
            Self::AtMost(x) => value <= x,
        }
    }
}

/// Consequence of a failed check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The result may be wrong: a warning says so and gives a remedy.
    Warning,
    /// Nobody would accept the result.
    Error,
}

/// One measured value of a result against the bound of what is plausible.
///
/// ```
/// use base::{Bound, Check, Report, Severity};
/// let mut report = Report::default();
/// report.check(Check {
///     name: "size-large",
///     value: 2_100.0,
///     bound: Bound::AtMost(130.0),
///     shown: ["2100 m".into(), "130 m".into()],
///     severity: Severity::Warning,
///     message: "the plant is 2100 m large".into(),
///     advice: "check the unit of the input",
/// });
/// assert!(!report.checks[0].holds());
/// assert_eq!(report.warnings[0].message, "the plant is 2100 m large (at most 130 m): check the unit of the input");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// A stable word for programs, which is the code of the warning.
    pub name: &'static str,
    /// The measured value.
    pub value: f64,
    /// The bound of plausible values.
    pub bound: Bound,
    /// Value and bound as people read them, with their units.
    pub shown: [String; 2],
    /// Consequence of a failure.
    pub severity: Severity,
    /// The finding, as a sentence without a full stop.
    pub message: String,
    /// The remedy if the check fails.
    pub advice: &'static str,
}

impl Check {
    /// Whether the value is plausible.
    pub fn holds(&self) -> bool {
        self.bound.holds(self.value)
    }

    /// Returns the measured value and the plausible range in words.
    pub fn said(&self) -> String {
        let side = match self.bound {
            Bound::AtLeast(_) => "at least",
            Bound::AtMost(_) => "at most",
        };
        format!("{} ({side} {})", self.message, self.shown[1])
    }
}
