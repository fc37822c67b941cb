//! Lists of measured trees: `CSV or GeoJSON -> rows -> Stand`.
//!
//! | module | owns |
//! |---|---|
//! | `columns` | what a column is, by its name and unit |
//! | `table`, `geojson` | the two formats: one row a tree |
//! | `rows` | one row: numbers, species, what cannot be meant |
//! | `error` | [`InventoryError`] |

mod columns;
mod error;
mod geojson;
mod rows;
mod table;
#[cfg(test)]
mod tests;

use base::{Draw, Report, Run, Seed, ops};
use glam::{DVec2, DVec3};

use crate::cells::SortedCells;
use crate::projection::Plane;
use crate::{Allometry, Figure, Given, Measured, Setting, Stand, Tree};
use columns::Field;
use rows::{Row, Rows};

pub use error::InventoryError;

/// Coordinate system of an inventory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crs {
    /// Metres in any plane, unchanged.
    Metres,
    /// Degrees (WGS 84), projected onto the plane that touches the earth along the meridian amid the trees.
    Local,
    /// Degrees (WGS 84), projected onto a zone of UTM; none: the zone amid the trees.
    Utm(Option<(u8, bool)>),
}

impl Crs {
    /// Parses `metres`, `local`, `utm`, or a zone such as `utm32n` or `utm19s`.
    ///
    /// ```
    /// use forest::Crs;
    /// assert_eq!(Crs::from_word("utm32N"), Some(Crs::Utm(Some((32, false)))));
    /// assert_eq!((Crs::from_word("utm61n"), Crs::from_word("degrees")), (None, None));
    /// ```
    pub fn from_word(word: &str) -> Option<Self> {
        let word = word.to_ascii_lowercase();
        match word.as_str() {
            "metres" => return Some(Self::Metres),
            "local" => return Some(Self::Local),
            "utm" => return Some(Self::Utm(None)),
            _ => {}
        }
        let zone = word.strip_prefix("utm")?.trim_start_matches([':', ' ', '-']);
        let is_south = zone.ends_with('s');
        let number = zone.strip_suffix(['n', 's'])?.parse().ok().filter(|z| (1..=60).contains(z))?;
        Some(Self::Utm(Some((number, is_south))))
    }
}

/// Treatment of rows with a value that is unreadable or implausible.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BadRows {
    /// The first such row is an error.
    #[default]
    Refuse,
    /// Such rows are left out, counted, and reported in one warning.
    Skip,
}

base::words!(BadRows { Refuse = "refuse", Skip = "skip" });

/// Settings for reading an inventory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InventorySpec {
    /// Coordinate system; none: metres, unless columns are named lon and lat, or the file is GeoJSON.
    pub crs: Option<Crs>,
    /// Surroundings of the trees; missing figures are filled accordingly.
    pub setting: Setting,
    /// The species of rows that name none or an unknown one; none: such rows are bad.
    pub species: Option<String>,
    /// Treatment of bad rows.
    pub bad_rows: BadRows,
    /// The year of the inventory, for columns with the year of planting; none: such columns are left out.
    pub year: Option<u32>,
    /// Seed for the rotations of the trees about their axes.
    pub seed: Seed,
}

/// Counts of one figure over all trees: how many were given and how many filled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FigureCount {
    /// Number of trees with a given value.
    pub given: u32,
    /// Number of trees with a filled value.
    pub filled: u32,
    /// For the filled ones, the mean of half the logarithm of high over low. 0.3: the interval is from 1/1.35 to 1.35
    /// times.
    pub mean_log_interval: f64,
}

/// Report on reading an inventory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InventoryReport {
    /// Warnings.
    pub report: Report,
    /// Number of rows that were read, including those left out.
    pub rows: u32,
    /// Number of rows that were left out.
    pub skipped: u32,
    /// Counts of the height.
    pub height: FigureCount,
    /// Counts of the diameter.
    pub dbh: FigureCount,
    /// Counts of the crown width.
    pub crown_width: FigureCount,
    /// Counts of the age.
    pub age: FigureCount,
    /// Number of trees at the place of an earlier one.
    pub duplicates: u32,
    /// Number of trees whose trunk touches that of a thicker one; at most 1,000 are counted.
    pub touching: u32,
}

/// Most trees within a cell of one metre: seedlings of a nursery stand 10 cm apart.
const MOST_IN_A_METRE: usize = 100;
/// Largest count of trees whose trunks touch.
const MOST_TOUCHING: u32 = 1_000;
/// Most names of species, each known only by its genus, with a warning of their own.
const NAMES_TOLD: usize = 5;
/// Greatest distance between trees on one plane, kilometres: there distances are wrong by 1 in 160.
const MOST_SPAN_KM: f64 = 1_000.0;
/// Distance between trees from which the report gives the error of distances, kilometres.
const TOLD_SPAN_KM: f64 = 100.0;
/// Coordinates beyond this get a new origin, metres: single precision, as renderers use, keeps a millimetre up to
/// here.
const FAR_M: f64 = 10_000.0;

/// Reads an inventory of trees: CSV (comma, semicolon or tab; quoted fields; decimal commas if a semicolon or tab
/// separates), or GeoJSON of points. `docs/forests.md` lists the known columns.
///
/// Guaranteed: one tree for each row that is not left out, in order; given figures keep their bits (in metres);
/// missing figures are those of [`Allometry::fill`]. +X is east and +Z south, the origin is [`Stand::origin_m`]. Not
/// guaranteed: that given figures fit together; doubtful ones are reported.
///
/// Cost: n log n in the rows.
///
/// # Errors
/// [`InventoryError`]; it names row and column.
///
/// ```
/// use forest::{InventorySpec, read_inventory};
/// let (stand, report) = read_inventory(
///     b"x;y;species;DBH (cm)\n0;0;oak;41,5\n8;2;Fagus sylvatica;\n",
///     &InventorySpec::default(),
///     &base::Run::plain(),
/// )?;
/// assert_eq!((stand.species.len(), stand.trees[0].dbh_m), (2, 0.415));
/// assert_eq!((report.dbh.given, report.dbh.filled, report.height.filled), (1, 1, 2));
/// # Ok::<(), forest::InventoryError>(())
/// ```
pub fn read_inventory(
    bytes: &[u8],
    spec: &InventorySpec,
    run: &Run<'_>,
) -> Result<(Stand, InventoryReport), InventoryError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = core::str::from_utf8(bytes).map_err(|e| InventoryError::NotText(e.valid_up_to()))?;
    if text.contains('\0') {
        return Err(InventoryError::NotText(text.find('\0').unwrap_or(0)));
    }
    let is_json = text.trim_start().starts_with(['{', '[']);
    let mut rows = if is_json { geojson::read(text, spec, run)? } else { table::read(text, spec, run)? };
    if rows.rows.is_empty() {
        return Err(rows.first_fault.take().unwrap_or(InventoryError::Empty));
    }
    rows.settle_units()?;
    project(&mut rows, spec)?;
    let places = |rows: &Rows| rows.rows.iter().map(|r| DVec2::new(r.x, r.y)).collect::<Vec<_>>();
    check_crowds(&rows, &places(&rows))?;
    let mut report = InventoryReport::default();
    let stand = fill(&mut rows, spec, run, &mut report)?;
    find_neighbours(&stand, &mut report);
    rows.tell(&mut report, spec);
    Ok((stand, report))
}

/// Projects degrees to metres, and refuses degrees in columns of metres.
fn project(rows: &mut Rows, spec: &InventorySpec) -> Result<(), InventoryError> {
    let crs = match (spec.crs, rows.are_degrees) {
        (Some(Crs::Metres), true) if rows.columns.has(Field::Longitude) => {
            return Err(InventoryError::Degrees("columns lon and lat"));
        }
        (Some(crs), _) => crs,
        (None, true) => {
            let what = if rows.columns.has(Field::Longitude) { "columns lon and lat" } else { "GeoJSON" };
            return Err(InventoryError::Degrees(what));
        }
        (None, false) => {
            refuse_degrees(&rows.rows)?;
            Crs::Metres
        }
    };
    if crs == Crs::Metres {
        return Ok(());
    }
    rows.check_degrees()?;
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for row in &rows.rows {
        let p = DVec2::new(row.x, row.y);
        (low, high) = (low.min(p), high.max(p));
    }
    let centre = 0.5 * (low + high);
    let plane = match crs {
        Crs::Utm(zone) => {
            let (zone, is_south) = zone.unwrap_or((Plane::utm_zone(centre.x), centre.y < 0.0));
            rows.notes
                .push(format!("places are metres of UTM zone {zone}{}", if is_south { "S" } else { "N" }));
            Plane::utm(zone, is_south)
        }
        _ => Plane::local(centre.x, centre.y),
    };
    let span = plane.metres(low.x, low.y).distance(plane.metres(high.x, high.y)) / 1000.0;
    if span.is_nan() || span > MOST_SPAN_KM {
        return Err(InventoryError::Span(span, MOST_SPAN_KM));
    }
    rows.span_km = span;
    for row in &mut rows.rows {
        let p = plane.metres(row.x, row.y);
        (row.x, row.y) = (p.x, p.y);
    }
    Ok(())
}

/// Fails if places that should be metres lie in the range of degrees and either have more decimals than anybody
/// measures in metres, or are closer than trees stand.
fn refuse_degrees(rows: &[Row]) -> Result<(), InventoryError> {
    /// Metres with more than four decimals are finer than anybody measures.
    const FINE: f64 = 1e4;
    /// Least mean spacing of trees, metres.
    const CLOSE_M: f64 = 0.05;
    let is_in_range = rows.iter().all(|r| r.x.abs() <= 180.0 && r.y.abs() <= 90.0);
    if !is_in_range || rows.len() < 2 {
        return Ok(());
    }
    let is_fine = |v: f64| ((v * FINE).round() - v * FINE).abs() > 1e-6;
    let fine = rows.iter().filter(|r| is_fine(r.x) && is_fine(r.y)).count();
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for row in rows {
        let p = DVec2::new(row.x, row.y);
        (low, high) = (low.min(p), high.max(p));
    }
    let extent = (high - low).max_element();
    let spacing = extent / (rows.len() as f64).sqrt();
    // All trees at one place is another fault.
    if 2 * fine > rows.len() || (extent > 0.0 && spacing < CLOSE_M) {
        let Row { number, x, y, .. } = rows[0];
        return Err(InventoryError::DegreesAsMetres { row: number, x, y });
    }
    Ok(())
}

/// Fails if more trees stand within a metre than can.
fn check_crowds(rows: &Rows, places: &[DVec2]) -> Result<(), InventoryError> {
    let cells = SortedCells::new(places.iter().copied(), 1.0);
    let most = cells.cells().max_by_key(|c| c.len()).unwrap_or_default();
    let Some((_, first)) = most.first().filter(|_| most.len() > MOST_IN_A_METRE) else { return Ok(()) };
    let DVec2 { x, y } = places[*first as usize];
    Err(InventoryError::Crowded { rows: most.len(), all: rows.rows.len(), most: MOST_IN_A_METRE, x, y })
}

/// Returns the trees, with missing figures filled.
fn fill(
    rows: &mut Rows,
    spec: &InventorySpec,
    run: &Run<'_>,
    report: &mut InventoryReport,
) -> Result<Stand, InventoryError> {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for row in &rows.rows {
        let p = DVec2::new(row.x, row.y);
        (low, high) = (low.min(p), high.max(p));
    }
    let is_far = low.min_element().min(-high.max_element()) < -FAR_M;
    let origin = if is_far { (0.5 * (low + high)).round() } else { DVec2::ZERO };
    let mut stand = Stand {
        species: rows.species.iter().map(|s| s.preset.to_owned()).collect(),
        trees: Vec::with_capacity(rows.rows.len()),
        origin_m: DVec3::new(origin.x, 0.0, origin.y),
    };
    let sized: Vec<Measured> = rows.rows.iter().map(Row::measured).collect();
    for (k, (row, measured)) in rows.rows.iter().zip(&sized).enumerate() {
        if k.is_multiple_of(CHECK_EVERY) {
            run.cancel.check()?;
        }
        let allometry: &Allometry = rows.species[usize::from(row.species)];
        let figures = allometry.fill(measured, spec.setting);
        let mut given = Given::default();
        let mut count = |figure, is_given, to: &mut FigureCount, p: crate::Predicted| {
            if is_given {
                given = given.with(figure);
                to.given += 1;
            } else {
                to.filled += 1;
                let interval = if p.low > 0.0 { 0.5 * ops::ln(p.high / p.low) } else { 0.0 };
                to.mean_log_interval += interval;
            }
        };
        count(Figure::Height, measured.height_m.is_some(), &mut report.height, figures.height_m);
        count(Figure::Dbh, measured.dbh_m.is_some(), &mut report.dbh, figures.dbh_m);
        count(
            Figure::CrownWidth,
            measured.crown_width_m.is_some(),
            &mut report.crown_width,
            figures.crown_width_m,
        );
        count(Figure::Age, measured.age_years.is_some(), &mut report.age, figures.age_years);
        let foot = if row.z.is_nan() { 0.0 } else { row.z };
        stand.trees.push(Tree {
            foot_m: DVec3::new(row.x - origin.x, foot, -(row.y - origin.y)),
            species: row.species,
            row: row.number,
            age_years: figures.age_years.value,
            height_m: figures.height_m.value,
            dbh_m: figures.dbh_m.value,
            crown_width_m: figures.crown_width_m.value,
            yaw: spec.seed.child(u64::from(row.number)).stream(Draw::Stand).range(0.0, ops::TAU),
            up: DVec3::Y,
            crown_offset_m: DVec3::ZERO,
            given,
        });
    }
    rows.sizeless = sized.iter().filter(|m| **m == Measured::default()).count();
    for count in [&mut report.height, &mut report.dbh, &mut report.crown_width, &mut report.age] {
        count.mean_log_interval /= f64::from(count.filled.max(1));
    }
    (report.rows, report.skipped) = (rows.seen, rows.skipped);
    Ok(stand)
}

/// Number of rows between two checks for cancellation.
const CHECK_EVERY: usize = 4096;

/// Counts trees at the same place, and trunks that touch.
fn find_neighbours(stand: &Stand, report: &mut InventoryReport) {
    let place = |k: usize| DVec2::new(stand.trees[k].foot_m.x, stand.trees[k].foot_m.z);
    let cells = SortedCells::new((0..stand.trees.len()).map(place), 1.0);
    for (k, tree) in stand.trees.iter().enumerate() {
        let (p, mut is_duplicate) = (place(k), false);
        // In each pair the thicker one searches; of two equal ones, the later.
        let ring = ops::whole(tree.dbh_m.ceil()).max(1);
        for j in cells.near(p, i64::from(ring)).map(|j| j as usize).filter(|&j| j != k) {
            let (other, gap) = (&stand.trees[j], place(j).distance(p));
            is_duplicate |= gap <= 0.0 && j < k;
            let is_thinner = (other.dbh_m, j) < (tree.dbh_m, k);
            if gap > 0.0 && is_thinner && gap < 0.5 * (tree.dbh_m + other.dbh_m) {
                report.touching += 1;
            }
        }
        report.duplicates += u32::from(is_duplicate);
        if report.touching >= MOST_TOUCHING {
            report.touching = MOST_TOUCHING;
            return;
        }
    }
}
