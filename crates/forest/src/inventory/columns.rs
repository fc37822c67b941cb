//! Meaning of the columns of an inventory, by the words and units in their names.

use super::InventoryError;

/// Content of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Field {
    Easting,
    Northing,
    Longitude,
    Latitude,
    /// Height of the foot.
    Elevation,
    /// The scientific name, which is read first.
    Latin,
    /// The word of a preset, or any name.
    Species,
    /// A common name, which is read last.
    Common,
    Height,
    Dbh,
    Girth,
    CrownWidth,
    CrownRadius,
    Age,
    /// The year in which it was planted.
    Planted,
}

/// Names of columns, in lower case and reduced to letters and digits.
const WORDS: &[(Field, &[&str])] = &[
    (
        Field::Easting,
        &["x", "easting", "east", "xcoord", "xcoordinate", "coordx", "utmx", "rechtswert", "pointx"],
    ),
    (
        Field::Northing,
        &["y", "northing", "north", "ycoord", "ycoordinate", "coordy", "utmy", "hochwert", "pointy"],
    ),
    (Field::Longitude, &["lon", "lng", "long", "longitude", "lonwgs84", "decimallongitude"]),
    (Field::Latitude, &["lat", "latitude", "latwgs84", "decimallatitude"]),
    (Field::Elevation, &["z", "elevation", "elev", "altitude", "footheight", "groundheight"]),
    (
        Field::Latin,
        &["latin", "latinname", "scientificname", "scientific", "botanicalname", "botanical", "taxon"],
    ),
    (
        Field::Species,
        &[
            "species",
            "preset",
            "treespecies",
            "speciesname",
            "spp",
            "kind",
            "treetype",
            "baumart",
            "art",
            "essence",
            "especie",
        ],
    ),
    (Field::Common, &["name", "treename", "commonname", "common"]),
    (
        Field::Height,
        &[
            "height",
            "treeheight",
            "totalheight",
            "ht",
            "h",
            "heighttotal",
            "hoehe",
            "baumhoehe",
            "baumh\u{f6}he",
            "hauteur",
            "altura",
        ],
    ),
    (
        Field::Dbh,
        &[
            "dbh",
            "diameter",
            "trunkdiameter",
            "stemdiameter",
            "diameterbreastheight",
            "diameteratbreastheight",
            "bhd",
            "d130",
            "d",
            "diam",
            "diametre",
        ],
    ),
    (
        Field::Girth,
        &[
            "girth",
            "circumference",
            "trunkgirth",
            "trunkcircumference",
            "stemcircumference",
            "gbh",
            "cbh",
            "stammumfang",
            "circonference",
        ],
    ),
    (
        Field::CrownWidth,
        &[
            "crown",
            "crownwidth",
            "crowndiameter",
            "crownspread",
            "spread",
            "canopywidth",
            "canopydiameter",
            "canopy",
            "cw",
            "kronendurchmesser",
        ],
    ),
    (Field::CrownRadius, &["crownradius", "canopyradius"]),
    (Field::Age, &["age", "treeage", "ageyears", "alter"]),
    (
        Field::Planted,
        &[
            "planted",
            "plantingyear",
            "yearplanted",
            "plantedyear",
            "plantyear",
            "yearofplanting",
            "pflanzjahr",
        ],
    ),
];

/// Units of lengths, as suffixes of column names and values.
const UNITS: &[(&str, f64)] = &[
    ("m", 1.0),
    ("metres", 1.0),
    ("meters", 1.0),
    ("metre", 1.0),
    ("meter", 1.0),
    ("cm", 0.01),
    ("mm", 0.001),
    ("ft", 0.3048),
    ("feet", 0.3048),
    ("in", 0.0254),
    ("inch", 0.0254),
    ("inches", 0.0254),
];

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    pub(super) field: Field,
    /// Metres of its unit, if its name gives the unit.
    pub(super) metres: Option<f64>,
    /// Its name in the file.
    pub(super) name: String,
}

/// Returns the metres of a unit.
pub(super) fn unit_of(word: &str) -> Option<f64> {
    let word = word.trim().to_ascii_lowercase();
    UNITS.iter().find(|(unit, _)| *unit == word).map(|(_, metres)| *metres)
}

/// Converts a value to metres. It divides, because 41.5 / 100 is exactly 0.415, and 41.5 times 0.01 is not.
pub(super) fn in_metres(value: f64, metres: f64) -> f64 {
    let per_metre = (1.0 / metres).round();
    if (per_metre * metres - 1.0).abs() < 1e-12 { value / per_metre } else { value * metres }
}

fn squeezed(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

fn field_of(word: &str) -> Option<Field> {
    WORDS.iter().find(|(_, words)| words.contains(&word)).map(|(field, _)| *field)
}

/// Returns the meaning of a column: by its whole name, or by its name before a unit: `height_cm`, `DBH (cm)`, `crown
/// [m]`.
pub(super) fn column_of(name: &str) -> Option<Column> {
    let name = name.trim();
    let column = |field, metres| Some(Column { field, metres, name: base::quoted(name) });
    if let Some(field) = field_of(&squeezed(name)) {
        return column(field, None);
    }
    let (word, unit) = name.trim_end_matches([')', ']']).rsplit_once(['(', '[', '_', ' ', '/', '.'])?;
    column(field_of(&squeezed(word))?, Some(unit_of(unit)?))
}

/// The columns of a file.
#[derive(Clone, Debug, Default)]
pub(super) struct Columns {
    /// In the order of the file; none for columns that are not used.
    pub(super) all: Vec<Option<Column>>,
    /// Columns that repeat another one, and that one.
    pub(super) repeated: Vec<(String, String)>,
}

impl Columns {
    /// Adds the next column; one that repeats another is left out.
    pub(super) fn push(&mut self, name: &str) {
        let column = column_of(name);
        let first = column.as_ref().and_then(|c| self.all.iter().flatten().find(|o| o.field == c.field));
        match (column, first) {
            (Some(column), Some(first)) => {
                self.repeated.push((column.name, first.name.clone()));
                self.all.push(None);
            }
            (column, _) => self.all.push(column),
        }
    }

    pub(super) fn has(&self, field: Field) -> bool {
        self.all.iter().flatten().any(|c| c.field == field)
    }

    /// Returns the name of the column of a field.
    pub(super) fn name(&self, field: Field) -> String {
        self.all.iter().flatten().find(|c| c.field == field).map(|c| c.name.clone()).unwrap_or_default()
    }

    /// Fails unless there are columns of places.
    pub(super) fn check_places(&self, names: &[String]) -> Result<(), InventoryError> {
        let metres = self.has(Field::Easting) && self.has(Field::Northing);
        let degrees = self.has(Field::Longitude) && self.has(Field::Latitude);
        if metres || degrees {
            return Ok(());
        }
        let squeezed_names: Vec<String> = names.iter().map(|n| squeezed(n)).collect();
        let words = ["x", "y", "easting", "northing", "lon", "lat", "longitude", "latitude"];
        let near =
            squeezed_names.iter().find_map(|n| words.iter().find(|w| base::nearest(n, [**w]).is_some()));
        Err(InventoryError::NoPlaces {
            columns: base::quoted(&names.join(", ")),
            near: near.copied().unwrap_or_default(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_known_by_words_and_units() {
        for (name, want) in [
            ("height", Some((Field::Height, None))),
            ("height_cm", Some((Field::Height, Some(0.01)))),
            ("DBH (cm)", Some((Field::Dbh, Some(0.01)))),
            ("dbh_mm", Some((Field::Dbh, Some(0.001)))),
            ("Crown Width [m]", Some((Field::CrownWidth, Some(1.0)))),
            ("Tree Height (ft)", Some((Field::Height, Some(0.3048)))),
            ("Scientific Name", Some((Field::Latin, None))),
            ("X", Some((Field::Easting, None))),
            ("y_m", Some((Field::Northing, Some(1.0)))),
            ("Trunk circumference, cm", Some((Field::Girth, Some(0.01)))),
            ("Planting year", Some((Field::Planted, None))),
            ("remarks", None),
            ("height_furlongs", None),
            ("", None),
        ] {
            assert_eq!(column_of(name).map(|c| (c.field, c.metres)), want, "{name}");
        }
        for (field, words) in WORDS {
            assert!(words.iter().all(|w| field_of(w) == Some(*field) && squeezed(w) == *w), "{field:?}");
        }
    }
}
