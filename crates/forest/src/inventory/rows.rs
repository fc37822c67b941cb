//! One row of an inventory: cells -> numbers and species; implausible values are refused.

use std::collections::BTreeMap;

use base::{Counted, Run, either};

use super::columns::{Columns, Field, in_metres, unit_of};
use super::{
    BadRows, InventoryError, InventoryReport, InventorySpec, MOST_TOUCHING, NAMES_TOLD, TOLD_SPAN_KM,
};
use crate::{Allometry, Measured};

/// Greatest height, metres: the highest tree is a coast redwood of 116 m.
const MOST_HEIGHT_M: f64 = 130.0;
/// Greatest diameter, metres: the thickest tree is a Montezuma cypress of 11.6 m across and 36 m around.
const MOST_DBH_M: f64 = 15.0;
/// Greatest width of a crown, metres: the widest crowns are banyans of 200 m.
const MOST_CROWN_M: f64 = 250.0;
/// Greatest age, years: the oldest bristlecone pines have 4,900 years.
const MOST_AGE: f64 = 6_000.0;
/// Greatest distance of a place from the origin of its projection, metres.
const MOST_PLACE_M: f64 = 1e8;
/// Plausible ratios of height to diameter, from stout old trunks to poles of a thicket.
const SLENDER: core::ops::Range<f64> = 4.0..250.0;
/// Median diameter from which values without a unit are centimetres; below, if none is as large, they are metres.
const CENTIMETRES_FROM: f64 = 3.0;
/// Words for a missing value.
const NOTHING: &[&str] = &["", "-", "--", "na", "n/a", "nan", "null", "none", "unknown", "nil", "?"];

/// A cell of the file.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cell<'a> {
    Text(&'a str),
    Number(f64),
}

/// One tree as in the file; NaN for missing figures.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) number: u32,
    pub(super) species: u16,
    /// The diameter, or girth, has no unit.
    is_bare: bool,
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) z: f64,
    height: f64,
    dbh: f64,
    crown: f64,
    age: f64,
}

impl Row {
    pub(super) fn measured(&self) -> Measured {
        let some = |v: f64| (!v.is_nan()).then_some(v);
        Measured {
            height_m: some(self.height),
            dbh_m: some(self.dbh),
            crown_width_m: some(self.crown),
            age_years: some(self.age),
        }
    }
}

/// All rows, and the counts for the report.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub(super) columns: Columns,
    pub(super) rows: Vec<Row>,
    pub(super) species: Vec<&'static Allometry>,
    /// Species by the names in the file.
    names: BTreeMap<String, Option<u16>>,
    /// Names that were replaced by another species of their genus, with it and the number of rows.
    by_genus: BTreeMap<String, (u16, u32)>,
    /// Number of rows without a known species, which get the requested one, and the first of their names.
    replaced: (u32, String),
    /// Number of rows so far.
    pub(super) seen: u32,
    pub(super) skipped: u32,
    pub(super) first_fault: Option<InventoryError>,
    /// Coordinates are degrees.
    pub(super) are_degrees: bool,
    /// Number of figures of 0, which inventories write for unknown values.
    zeros: u32,
    pub(super) sizeless: usize,
    pub(super) span_km: f64,
    pub(super) notes: Vec<String>,
    has_decimal_commas: bool,
}

/// Reason why a value is implausible, without its row and column.
type Why = String;

impl Rows {
    pub(super) fn new(columns: Columns, are_degrees: bool, has_decimal_commas: bool) -> Self {
        Self { columns, are_degrees, has_decimal_commas, ..Self::default() }
    }

    /// Adds one tree, from the cells of its columns.
    pub(super) fn take<'a>(
        &mut self,
        cells: &dyn Fn(usize) -> Option<Cell<'a>>,
        place: Option<[f64; 2]>,
        spec: &InventorySpec,
        run: &Run<'_>,
    ) -> Result<(), InventoryError> {
        self.seen += 1;
        if (self.seen as usize).is_multiple_of(super::CHECK_EVERY) {
            run.cancel.check()?;
        }
        run.budget.check(Counted::Trees, u64::from(self.seen), "split the inventory")?;
        match self.row(cells, place, spec) {
            Ok(row) => {
                self.rows.push(row);
                Ok(())
            }
            Err(fault) => self.bad(fault, spec),
        }
    }

    /// Handles a bad row: leaves it out if the settings say so, else fails.
    pub(super) fn bad(&mut self, fault: InventoryError, spec: &InventorySpec) -> Result<(), InventoryError> {
        if spec.bad_rows == BadRows::Refuse {
            return Err(fault);
        }
        self.skipped += 1;
        self.first_fault.get_or_insert(fault);
        Ok(())
    }

    fn row<'a>(
        &mut self,
        cells: &dyn Fn(usize) -> Option<Cell<'a>>,
        place: Option<[f64; 2]>,
        spec: &InventorySpec,
    ) -> Result<Row, InventoryError> {
        let nan = f64::NAN;
        let mut row = Row {
            number: self.seen,
            species: 0,
            is_bare: false,
            x: place.map_or(nan, |p| p[0]),
            y: place.map_or(nan, |p| p[1]),
            z: nan,
            height: nan,
            dbh: nan,
            crown: nan,
            age: nan,
        };
        let mut names: [Option<(usize, &str)>; 3] = [None; 3];
        for (k, column) in self.columns.all.iter().enumerate() {
            let (Some(column), Some(cell)) = (column, cells(k)) else { continue };
            let name_rank = match column.field {
                Field::Latin => Some(0),
                Field::Species => Some(1),
                Field::Common => Some(2),
                _ => None,
            };
            if let (Some(rank), Cell::Text(text)) = (name_rank, cell) {
                names[rank] = (!is_nothing(text)).then_some((k, text));
                continue;
            }
            let is_place =
                matches!(column.field, Field::Easting | Field::Northing | Field::Longitude | Field::Latitude);
            if name_rank.is_some() || (is_place && place.is_some()) {
                continue;
            }
            let fault = |why| InventoryError::Value { row: self.seen, column: column.name.clone(), why };
            let Some((value, unit)) = number(cell, self.has_decimal_commas).map_err(fault)? else { continue };
            let metres = unit.or(column.metres);
            if let Field::Dbh | Field::Girth = column.field {
                row.is_bare = metres.is_none();
            }
            self.zeros += put(&mut row, column.field, value, metres, spec).map_err(fault)?;
        }
        for (value, fields) in
            [(row.x, [Field::Easting, Field::Longitude]), (row.y, [Field::Northing, Field::Latitude])]
        {
            if value.is_nan() {
                let column = fields.map(|f| self.columns.name(f)).concat();
                let why = "there is no place; give coordinates, or leave the row out".into();
                return Err(InventoryError::Value { row: self.seen, column, why });
            }
        }
        row.species = self.species_of(names, spec)?;
        Ok(row)
    }

    /// Returns the species of a row, by the first of its names that is known.
    fn species_of(
        &mut self,
        names: [Option<(usize, &str)>; 3],
        spec: &InventorySpec,
    ) -> Result<u16, InventoryError> {
        let mut fault = None;
        for (column, name) in names.into_iter().flatten() {
            if let Some(Some(row)) = self.names.get(name) {
                if let Some((_, count)) = self.by_genus.get_mut(name) {
                    *count += 1;
                }
                return Ok(*row);
            }
            match Allometry::find(name) {
                Ok(found) => {
                    let row = self.species_row(found.allometry);
                    self.names.insert(name.to_owned(), Some(row));
                    if found.by_genus {
                        self.by_genus.insert(name.to_owned(), (row, 1));
                    }
                    return Ok(row);
                }
                Err(unknown) => {
                    let name = |c: &super::columns::Column| c.name.clone();
                    let column = self.columns.all.get(column).and_then(|c| c.as_ref().map(name));
                    let column = column.unwrap_or_default();
                    fault.get_or_insert(InventoryError::Species { row: self.seen, column, unknown });
                }
            }
        }
        let Some(instead) = &spec.species else { return Err(fault.unwrap_or_else(|| self.nameless())) };
        let found = Allometry::find(instead).map_err(|unknown| InventoryError::Species {
            row: self.seen,
            column: "species".into(),
            unknown,
        })?;
        if let Some((_, name)) = names.into_iter().flatten().next() {
            if self.replaced.0 == 0 {
                self.replaced.1 = base::quoted(name);
            }
            self.replaced.0 += 1;
        }
        Ok(self.species_row(found.allometry))
    }

    /// Returns the fault of a row without a species.
    fn nameless(&self) -> InventoryError {
        let fields = [Field::Latin, Field::Species, Field::Common];
        match fields.into_iter().find(|f| self.columns.has(*f)) {
            Some(field) => InventoryError::Value {
                row: self.seen,
                column: self.columns.name(field),
                why: "there is no species; name it, or say which species such rows are".into(),
            },
            None => InventoryError::NoSpecies,
        }
    }

    fn species_row(&mut self, allometry: &'static Allometry) -> u16 {
        let row = self.species.iter().position(|s| s.preset == allometry.preset).unwrap_or_else(|| {
            self.species.push(allometry);
            self.species.len() - 1
        });
        // There are fewer species than numbers.
        u16::try_from(row).unwrap_or(u16::MAX)
    }

    /// Finds the unit of diameters whose column does not give it, and checks them.
    pub(super) fn settle_units(&mut self) -> Result<(), InventoryError> {
        let mut bare: Vec<f64> =
            self.rows.iter().filter(|r| r.is_bare && !r.dbh.is_nan()).map(|r| r.dbh).collect();
        base::sort_numbers(&mut bare);
        let (Some(&middle), Some(&most)) = (bare.get(bare.len() / 2), bare.last()) else { return Ok(()) };
        let is_girth = !self.columns.has(Field::Dbh);
        let column = self.columns.name(if is_girth { Field::Girth } else { Field::Dbh });
        let per_diameter = if is_girth { base::ops::PI } else { 1.0 };
        let (metres, unit) = match () {
            () if most < CENTIMETRES_FROM * per_diameter => (1.0, "metres"),
            () if middle >= CENTIMETRES_FROM * per_diameter => (0.01, "centimetres"),
            () => {
                let why =
                    format!("values from {} to {most} are neither all metres nor all centimetres", bare[0]);
                return Err(InventoryError::Unit { column, why });
            }
        };
        self.notes.push(format!("column `{column}` says no unit: taken as {unit}"));
        let mut fault = None;
        for row in self.rows.iter_mut().filter(|r| r.is_bare && !r.dbh.is_nan()) {
            row.dbh = in_metres(row.dbh, metres) / per_diameter;
            if row.dbh > MOST_DBH_M && fault.is_none() {
                let why = format!("{:.1} m is no diameter of a trunk; mixed units?", row.dbh);
                fault = Some(InventoryError::Value { row: row.number, column: column.clone(), why });
            }
        }
        fault.map_or(Ok(()), Err)
    }

    /// Fails if a place is not a longitude and latitude.
    pub(super) fn check_degrees(&self) -> Result<(), InventoryError> {
        let bad = self.rows.iter().find(|r| r.x.abs() > 180.0 || r.y.abs() > 90.0);
        let Some(row) = bad else { return Ok(()) };
        let is_swapped = row.x.abs() <= 90.0;
        let way = if is_swapped {
            "are longitude and latitude swapped?"
        } else {
            "say `metres` if they are metres"
        };
        let fields = [Field::Longitude, Field::Latitude, Field::Easting, Field::Northing];
        let names: Vec<String> =
            fields.into_iter().map(|f| self.columns.name(f)).filter(|n| !n.is_empty()).collect();
        let why = format!("{}, {} is no longitude and latitude in degrees; {way}", row.x, row.y);
        Err(InventoryError::Value { row: row.number, column: names.join("`, `"), why })
    }

    /// Adds the counts and warnings to the report.
    pub(super) fn tell(&self, to: &mut InventoryReport, spec: &InventorySpec) {
        for note in &self.notes {
            to.report.warn("inventory-assumed", note.clone());
        }
        for (name, first) in &self.columns.repeated {
            base::warn!(to.report, "inventory-column", { name = name, first = first }, "column `{name}` says what `{first}` says, and was left out");
        }
        if let (Some(fault), rows) = (&self.first_fault, self.skipped) {
            base::warn!(to.report, "inventory-skipped", { rows = rows, fault = fault }, "{rows} rows were left out, the first because: {fault}");
        }
        for (name, (row, count)) in self.by_genus.iter().take(NAMES_TOLD) {
            let preset = self.species.get(usize::from(*row)).map_or("", |s| s.preset);
            base::warn!(to.report, "inventory-genus", { name = base::quoted(name), preset = preset, count = count }, "`{name}` ({count} trees) has no figures of its own: taken as `{preset}`, of the same genus");
        }
        if let Some(more) = self.by_genus.len().checked_sub(NAMES_TOLD).filter(|more| *more > 0) {
            base::warn!(
                to.report,
                "inventory-genera",
                { more = more },
                "{more} more names were taken by their genus"
            );
        }
        if let (rows @ 1.., name) = (self.replaced.0, &self.replaced.1) {
            let species = spec.species.clone().unwrap_or_default();
            base::warn!(to.report, "inventory-replaced", { rows = rows, name = name, species = species }, "{rows} trees of unknown species, the first `{name}`, were taken as `{species}`");
        }
        if self.zeros > 0 {
            base::warn!(
                to.report,
                "inventory-zeros",
                { zeros = self.zeros },
                "{zeros} figures are 0, which no tree has: taken as not measured"
            );
        }
        if self.sizeless > 0 {
            base::warn!(
                to.report,
                "inventory-sizeless",
                { trees = self.sizeless },
                "{trees} trees have neither height, diameter, crown nor age: they were given those of a third of a life, at most 40 years"
            );
        }
        if to.duplicates > 0 {
            base::warn!(
                to.report,
                "inventory-duplicates",
                { trees = to.duplicates },
                "{trees} trees stand exactly where an earlier one stands: they were kept; delete rows that were written twice"
            );
        }
        if to.touching > 0 {
            let more = if to.touching == MOST_TOUCHING { " or more" } else { "" };
            base::warn!(to.report, "inventory-touching", { trees = to.touching, more = more }, "{trees}{more} trunks touch a thicker one: they were kept; check coordinates and the unit of diameters");
        }
        if self.span_km > TOLD_SPAN_KM {
            let span = format!("{:.0}", self.span_km);
            base::warn!(
                to.report,
                "inventory-span",
                { span = span },
                "the trees lie {span} km apart: distances on one plane are then wrong by more than 1 in 20,000"
            );
        }
        self.tell_doubtful(to);
    }

    /// Warns of heights and diameters that do not fit together.
    fn tell_doubtful(&self, to: &mut InventoryReport) {
        let doubtful =
            |r: &&Row| !(r.height.is_nan() || r.dbh.is_nan() || SLENDER.contains(&(r.height / r.dbh)));
        let rows = self.rows.iter().filter(doubtful).count();
        if let Some(Row { number, height, dbh, .. }) = self.rows.iter().find(doubtful) {
            let (height, dbh) = (format!("{height:.2}"), format!("{dbh:.4}"));
            base::warn!(to.report, "inventory-doubtful", { rows = rows, number = number, height = height, dbh = dbh }, "{rows} trees are stouter or more slender than trees are, the first in row {number}: {height} m high, {dbh} m thick. They stay as given; check units");
        }
    }
}

fn is_nothing(text: &str) -> bool {
    NOTHING.iter().any(|n| text.trim().eq_ignore_ascii_case(n))
}

/// Parses a number and, if a unit follows it, the metres of its unit; none for an empty cell.
fn number(cell: Cell<'_>, has_decimal_commas: bool) -> Result<Option<(f64, Option<f64>)>, Why> {
    let text = match cell {
        Cell::Number(value) => return finite(value).map(|v| Some((v, None))),
        Cell::Text(text) if is_nothing(text) => return Ok(None),
        Cell::Text(text) => text.trim(),
    };
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let (digits, unit) = match unit_of(&text[digits.len()..]) {
        Some(metres) => (digits.trim(), Some(metres)),
        None => (text, None),
    };
    let read = if has_decimal_commas && digits.matches(',').count() == 1 && !digits.contains('.') {
        digits.replace(',', ".").parse()
    } else {
        digits.parse::<f64>()
    };
    let value = read.map_err(|_not_a_number| {
        let hint = if digits.contains(',') {
            "; write a decimal point, or separate columns by semicolons"
        } else {
            ""
        };
        format!("`{}` is no number{hint}", base::quoted(text))
    });
    value.and_then(finite).map(|v| Some((v, unit)))
}

fn finite(value: f64) -> Result<f64, Why> {
    if value.is_finite() { Ok(value) } else { Err(format!("`{value}` is no number that can be measured")) }
}

/// Stores a value in its row; returns 1 if it is a 0 that stands for an unknown value.
fn put(
    row: &mut Row,
    field: Field,
    value: f64,
    metres: Option<f64>,
    spec: &InventorySpec,
) -> Result<u32, Why> {
    let in_metres = in_metres(value, metres.unwrap_or(1.0));
    let is_size = !matches!(
        field,
        Field::Easting | Field::Northing | Field::Longitude | Field::Latitude | Field::Elevation
    );
    if is_size && value < 0.0 {
        return Err(format!("{value} is negative"));
    }
    // A tree of this year has the age of 0.
    if is_size && value <= 0.0 && field != Field::Age {
        return Ok(1);
    }
    let at_most = |most: f64, what: &str, units: &[&str]| {
        let way = if metres.is_some() {
            String::new()
        } else {
            format!("; is it in {}? Say so in the column's name", either(units))
        };
        if in_metres <= most {
            Ok(in_metres)
        } else {
            Err(format!("{in_metres} m is no {what}, which is at most {most} m{way}"))
        }
    };
    match field {
        Field::Easting | Field::Northing | Field::Elevation => {
            if in_metres.abs() > MOST_PLACE_M {
                return Err(format!("{value} is no place on the earth in metres"));
            }
            match field {
                Field::Easting => row.x = in_metres,
                Field::Northing => row.y = in_metres,
                _ => row.z = in_metres,
            }
        }
        Field::Longitude => row.x = value,
        Field::Latitude => row.y = value,
        Field::Height => row.height = at_most(MOST_HEIGHT_M, "height of a tree", &["cm", "ft"])?,
        Field::Dbh if metres.is_none() => row.dbh = value,
        Field::Dbh => row.dbh = at_most(MOST_DBH_M, "diameter of a trunk", &["cm", "mm"])?,
        // A measured diameter takes precedence over one from a girth.
        Field::Girth if !row.dbh.is_nan() => {}
        Field::Girth if metres.is_none() => row.dbh = value,
        Field::Girth => {
            row.dbh = at_most(MOST_DBH_M * base::ops::PI, "girth of a trunk", &["cm"])? / base::ops::PI
        }
        Field::CrownWidth => row.crown = at_most(MOST_CROWN_M, "width of a crown", &["cm", "ft"])?,
        Field::CrownRadius => {
            row.crown = 2.0 * at_most(0.5 * MOST_CROWN_M, "radius of a crown", &["cm", "ft"])?
        }
        Field::Age if value > MOST_AGE => return Err(format!("{value} years is no age of a tree")),
        Field::Age => row.age = value,
        Field::Planted => {
            let Some(year) = spec.year else { return Ok(0) };
            let age = f64::from(year) - value;
            if !(0.0..=MOST_AGE).contains(&age) {
                return Err(format!("{value} is no year in which a tree of {year} was planted"));
            }
            if row.age.is_nan() {
                row.age = age;
            }
        }
        Field::Latin | Field::Species | Field::Common => {}
    }
    Ok(0)
}
