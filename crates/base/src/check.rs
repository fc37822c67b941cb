//! Whether a person would accept a result: measured values against bounds.

/// Which side of a number is plausible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// The number or more.
    AtLeast(f64),
    /// The number or less.
    AtMost(f64),
}

impl Bound {
    /// The number itself.
    pub const fn number(self) -> f64 {
        match self {
            Self::AtLeast(x) | Self::AtMost(x) => x,
        }
    }

    /// Whether a value is on the plausible side; never for what is no number.
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::AtLeast(x) => value >= x,
            Self::AtMost(x) => value <= x,
        }
    }
}

/// What a check that fails means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The result may be wrong: it is told with a way out.
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
    /// What was measured.
    pub value: f64,
    /// What is plausible.
    pub bound: Bound,
    /// Value and bound as people read them, with their units.
    pub shown: [String; 2],
    /// What it means if it fails.
    pub severity: Severity,
    /// A sentence without a full stop: what was measured.
    pub message: String,
    /// What to do if it fails.
    pub advice: &'static str,
}

impl Check {
    /// Whether the value is plausible.
    pub fn holds(&self) -> bool {
        self.bound.holds(self.value)
    }

    /// What was measured, and what is plausible.
    pub fn said(&self) -> String {
        let side = match self.bound {
            Bound::AtLeast(_) => "at least",
            Bound::AtMost(_) => "at most",
        };
        format!("{} ({side} {})", self.message, self.shown[1])
    }
}
