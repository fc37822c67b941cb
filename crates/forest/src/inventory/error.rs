//! Errors of reading an inventory.

use base::{Cancelled, OverBudget, Stopped};

use crate::UnknownSpecies;

/// Error of reading a stand from an inventory.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InventoryError {
    /// The file is not text.
    #[error("the inventory is not UTF-8 text (byte {0} of the file): save it as CSV in UTF-8, or as GeoJSON")]
    NotText(usize),
    /// The file has no rows.
    #[error("the inventory has no trees: no row after its header, or no feature")]
    Empty,
    /// A row cannot be split.
    #[error("row {row}: {why}")]
    Row {
        /// Number of the row, from 1, without the header.
        row: u32,
        /// The fault.
        why: String,
    },
    /// The file is not valid GeoJSON.
    #[error("the inventory is no sound GeoJSON: {0}")]
    Json(String),
    /// A geometry is not a point.
    #[error(
        "feature {feature} is a {kind}: trees are points; take the other shapes out, or make them points"
    )]
    Geometry {
        /// Number of the feature, from 1.
        feature: u32,
        /// Its type in the file.
        kind: String,
    },
    /// No column gives the places of the trees.
    #[error("no columns say where trees stand: name them x and y in metres, or lon and lat in degrees. Columns are: {columns}{}",
        if near.is_empty() { String::new() } else { format!("; is `{near}` meant by one?") })]
    NoPlaces {
        /// Names of all columns.
        columns: String,
        /// The known name that one of them resembles; empty for none.
        near: &'static str,
    },
    /// No column names species, and the request names none either.
    #[error(
        "no column names the species: name one species, latin or name, or say which species all trees are"
    )]
    NoSpecies,
    /// A value is implausible.
    #[error("row {row}, column `{column}`: {why}")]
    Value {
        /// Number of the row, from 1, without the header.
        row: u32,
        /// Name of the column in the file.
        column: String,
        /// The value, what it must be, and the way out.
        why: String,
    },
    /// A species is unknown.
    #[error("row {row}, column `{column}`: {unknown}")]
    Species {
        /// Number of the row, from 1, without the header.
        row: u32,
        /// Name of the column in the file.
        column: String,
        /// The unknown name, and the nearest known one.
        unknown: UnknownSpecies,
    },
    /// The unit of a column is unclear.
    #[error("column `{column}`: {why}; say the unit in its name, such as `{column}_cm` or `{column}_m`")]
    Unit {
        /// Name of the column in the file.
        column: String,
        /// Its values.
        why: String,
    },
    /// Places are in degrees, without a projection.
    #[error(
        "places are in degrees ({0}): say how they become metres, `local` (a plane that touches the earth amid the trees) or `utm`"
    )]
    Degrees(&'static str),
    /// Places in columns of metres look like degrees.
    #[error(
        "row {row}: {x}, {y} and the other places look like degrees of longitude and latitude, not metres: say `local` or `utm` for their projection, or `metres` if they are metres"
    )]
    DegreesAsMetres {
        /// Number of the row, from 1, without the header.
        row: u32,
        /// Its first coordinate.
        x: f64,
        /// Its second.
        y: f64,
    },
    /// The trees are too far apart for one plane.
    #[error(
        "the trees lie {0:.0} km apart: no plane has true distances over more than {1:.0} km. Split the inventory, or give coordinates of a projection"
    )]
    Span(f64, f64),
    /// Too many trees are at one place.
    #[error(
        "{rows} of {all} rows stand within one metre of {x}, {y}: at most {most} can. Are coordinates missing, rounded, or in another unit?"
    )]
    Crowded {
        /// Number of rows there.
        rows: usize,
        /// Number of all rows.
        all: usize,
        /// Most trees that may stand there.
        most: usize,
        /// First coordinate, metres, as read.
        x: f64,
        /// Second coordinate, metres, as read.
        y: f64,
    },
    /// There are too many rows.
    #[error(transparent)]
    OverBudget(#[from] OverBudget),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<Stopped> for InventoryError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Cancelled(e) => e.into(),
            Stopped::OverBudget(e) => e.into(),
        }
    }
}

base::coded!(InventoryError {
    Self::NotText(byte) => "inventory-not-text" { byte },
    Self::Empty => "inventory-empty" {},
    Self::Row { row, why } => "inventory-row" { row, why },
    Self::Json(why) => "inventory-json" { why },
    Self::Geometry { feature, kind } => "inventory-geometry" { feature, kind },
    Self::NoPlaces { columns, near } => "inventory-no-places" { columns, near },
    Self::NoSpecies => "inventory-no-species" {},
    Self::Value { row, column, why } => "inventory-value" { row, column, why },
    Self::Species { row, column, unknown } => "inventory-species" { row, column, unknown => UnknownSpecies },
    Self::Unit { column, why } => "inventory-unit" { column, why },
    Self::Degrees(columns) => "inventory-degrees" { columns },
    Self::DegreesAsMetres { row, x, y } => "inventory-degrees-as-metres" { row, x, y },
    Self::Span(km, most_km) => "inventory-span" { km, most_km },
    Self::Crowded { rows, all, most, x, y } => "inventory-crowded" { rows, all, most, x, y },
} wraps {
    Self::OverBudget(e) => e, OverBudget;
    Self::Cancelled(e) => e, Cancelled;
});
