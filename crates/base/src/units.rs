//! Unit conversions at input and output: inside, everything is metres, radians, days, right-handed, +Y up.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ops::PI;

/// A value that must be finite was not.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{what} must be a finite number in {range}, not {value}")]
pub struct NotFinite {
    /// Name of the value.
    pub what: &'static str,
    /// The range that the value must lie in.
    pub range: &'static str,
    /// The value given.
    pub value: f64,
}

/// A checked angle, radians inside.
///
/// ```
/// let golden = base::Angle::from_deg(137.507_8)?;
/// assert!((golden.radians() - 2.399_96).abs() < 1e-4);
/// assert!(base::Angle::from_deg(f64::NAN).is_err());
/// # Ok::<(), base::NotFinite>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Angle(f64);

impl Angle {
    /// Makes an angle given in degrees.
    ///
    /// # Errors
    /// [`NotFinite`] for NaN and infinities.
    pub fn from_deg(degrees: f64) -> Result<Self, NotFinite> {
        if degrees.is_finite() {
            Ok(Self(degrees * (PI / 180.0)))
        } else {
            Err(NotFinite { what: "an angle", range: "degrees", value: degrees })
        }
    }

    /// Returns the angle in radians.
    pub const fn radians(self) -> f64 {
        self.0
    }

    /// Returns the angle in degrees, for files and people.
    pub fn degrees(self) -> f64 {
        self.0 * (180.0 / PI)
    }
}

/// A length below which two points are one, in metres.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Tolerance(f64);

impl Tolerance {
    /// Makes a tolerance given in metres.
    ///
    /// # Errors
    /// [`NotFinite`] unless `metres` is finite and above 0.
    pub fn metres(metres: f64) -> Result<Self, NotFinite> {
        if metres.is_finite() && metres > 0.0 {
            Ok(Self(metres))
        } else {
            Err(NotFinite { what: "a tolerance", range: "(0, infinity) m", value: metres })
        }
    }

    /// Returns the tolerance in metres.
    pub const fn get(self) -> f64 {
        self.0
    }
}

/// The unit of lengths in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Unit {
    /// Metres, the unit inside.
    #[default]
    #[serde(rename = "m")]
    Metre,
    /// Centimetres.
    #[serde(rename = "cm")]
    Centimetre,
    /// Millimetres.
    #[serde(rename = "mm")]
    Millimetre,
    /// International feet.
    #[serde(rename = "ft")]
    Foot,
}

crate::words!(Unit { Metre = "m", Centimetre = "cm", Millimetre = "mm", Foot = "ft" });

impl Unit {
    /// Returns the plural of its name.
    pub const fn plural(self) -> &'static str {
        match self {
            Self::Metre => "metres",
            Self::Centimetre => "centimetres",
            Self::Millimetre => "millimetres",
            Self::Foot => "feet",
        }
    }

    /// Returns the metres per unit.
    pub const fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 0.01,
            Self::Millimetre => 0.001,
            Self::Foot => 0.3048,
        }
    }
}

/// The unit in which a table counts time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TimeUnit {
    /// Days.
    #[default]
    Day,
    /// Weeks.
    Week,
    /// Months.
    Month,
    /// Years.
    Year,
}

crate::words!(TimeUnit { Day = "day", Week = "week", Month = "month", Year = "year" });

impl TimeUnit {
    /// Whether the unit is the default one, which files leave out.
    pub fn is_day(&self) -> bool {
        *self == Self::Day
    }
}

/// Which axis of a file points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum UpAxis {
    /// +Y, as inside and in glTF.
    #[default]
    Y,
    /// +Z, as in Blender and most survey data: file (x, y, z) is inside (x, z, -y).
    Z,
}

crate::words!(UpAxis { Y = "y", Z = "z" });
