//! CSV -> rows.

use base::Run;

use super::columns::{Columns, Field};
use super::rows::{Cell, Rows};
use super::{InventoryError, InventorySpec};

/// Characters that may separate columns.
const DELIMITERS: [u8; 4] = [b',', b';', b'\t', b'|'];
/// Most columns of a table.
const MOST_COLUMNS: usize = 1000;

/// Returns the most frequent delimiter of the header, outside of quotes.
fn delimiter(text: &str) -> u8 {
    let header = text.lines().find(|l| !l.trim().is_empty()).unwrap_or_default();
    let unquoted: Vec<&str> = header.split('"').step_by(2).collect();
    let count = |d: &u8| unquoted.iter().map(|part| part.bytes().filter(|b| b == d).count()).sum::<usize>();
    // The first of equally frequent ones.
    DELIMITERS.into_iter().rev().max_by_key(count).unwrap_or(b',')
}

pub(super) fn read(text: &str, spec: &InventorySpec, run: &Run<'_>) -> Result<Rows, InventoryError> {
    let delimiter = delimiter(text);
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| row_fault(0, &e))?.clone();
    if header.is_empty() {
        return Err(InventoryError::Empty);
    }
    let mut columns = Columns::default();
    let names: Vec<String> = header.iter().take(MOST_COLUMNS).map(str::to_owned).collect();
    names.iter().for_each(|name| columns.push(name));
    columns.check_places(&names)?;
    let named = [Field::Latin, Field::Species, Field::Common];
    if spec.species.is_none() && !named.iter().any(|f| columns.has(*f)) {
        return Err(InventoryError::NoSpecies);
    }
    let are_degrees = !(columns.has(Field::Easting) && columns.has(Field::Northing));
    drop_other_places(&mut columns, are_degrees);
    let mut rows = Rows::new(columns, are_degrees, delimiter != b',');
    if rows.columns.has(Field::Planted) && spec.year.is_none() {
        rows.notes.push(format!(
            "column `{}` was left out: say the year of the inventory to make ages of it",
            rows.columns.name(Field::Planted)
        ));
    }
    let mut record = csv::StringRecord::new();
    loop {
        match reader.read_record(&mut record) {
            Ok(false) => return Ok(rows),
            Ok(true) if record.iter().all(str::is_empty) => {}
            Ok(true) if record.len() != header.len() => {
                rows.seen += 1;
                let why = format!("it has {} fields, the header has {}", record.len(), header.len());
                rows.bad(InventoryError::Row { row: rows.seen, why }, spec)?;
            }
            Ok(true) => rows.take(&|k| record.get(k).map(Cell::Text), None, spec, run)?,
            Err(e) => return Err(row_fault(rows.seen + 1, &e)),
        }
    }
}

/// If a table has places in metres and in degrees, drops those in degrees.
fn drop_other_places(columns: &mut Columns, are_degrees: bool) {
    let other =
        if are_degrees { [Field::Easting, Field::Northing] } else { [Field::Longitude, Field::Latitude] };
    for column in &mut columns.all {
        if column.as_ref().is_some_and(|c| other.contains(&c.field)) {
            *column = None;
        }
    }
}

fn row_fault(row: u32, e: &csv::Error) -> InventoryError {
    InventoryError::Row { row, why: base::brief(&e.to_string()) }
}
