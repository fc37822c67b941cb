//! GeoJSON of points -> rows, one feature after the other: the file's tree is never in memory.

use core::fmt;
use std::collections::BTreeMap;

use base::Run;
use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::Value;

use super::columns::{Columns, Field};
use super::rows::{Cell, Rows};
use super::{Crs, InventoryError, InventorySpec};

/// Most names of properties that are read.
const MOST_COLUMNS: usize = 1000;

/// State that is kept from feature to feature.
struct State<'a> {
    rows: Rows,
    spec: &'a InventorySpec,
    run: &'a Run<'a>,
    columns_by_name: BTreeMap<String, usize>,
    features: u32,
    fault: Option<InventoryError>,
}

#[derive(serde::Deserialize)]
struct Feature {
    #[serde(default)]
    geometry: Option<Geometry>,
    #[serde(default)]
    properties: Option<BTreeMap<String, Value>>,
}

#[derive(serde::Deserialize)]
struct Geometry {
    #[serde(rename = "type", default)]
    kind: String,
    #[serde(default)]
    coordinates: Value,
}

pub(super) fn read(text: &str, spec: &InventorySpec, run: &Run<'_>) -> Result<Rows, InventoryError> {
    let mut state = State {
        rows: Rows::new(Columns::default(), true, false),
        spec,
        run,
        columns_by_name: BTreeMap::new(),
        features: 0,
        fault: None,
    };
    let mut reader = serde_json::Deserializer::from_str(text);
    let read = Collection(&mut state)
        .deserialize(&mut reader)
        .and_then(|has_features| reader.end().map(|()| has_features));
    if let Some(fault) = state.fault {
        return Err(fault);
    }
    let has_features = read.map_err(|e| InventoryError::Json(base::plainly(&e.to_string())))?;
    if !has_features {
        return Err(InventoryError::Json(
            "it has no `features`: save it as a FeatureCollection of points".into(),
        ));
    }
    let mut rows = state.rows;
    let is_degrees = |r: &super::rows::Row| r.x.abs() <= 180.0 && r.y.abs() <= 90.0;
    if spec.crs.is_none() && !rows.rows.is_empty() && !rows.rows.iter().all(is_degrees) {
        rows.are_degrees = false;
        rows.notes
            .push("places of GeoJSON are degrees; these are no degrees, and were taken as metres".into());
    }
    if spec.crs == Some(Crs::Metres) {
        rows.are_degrees = false;
    }
    if rows.columns.has(Field::Planted) && spec.year.is_none() {
        rows.notes.push(
            "years of planting were left out: say the year of the inventory to make ages of them".into(),
        );
    }
    Ok(rows)
}

/// Reads the whole file; returns whether it has features.
struct Collection<'s, 'a>(&'s mut State<'a>);

impl<'de> DeserializeSeed<'de> for Collection<'_, '_> {
    type Value = bool;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<bool, D::Error> {
        from.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Collection<'_, '_> {
    type Value = bool;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a FeatureCollection")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<bool, M::Error> {
        let mut has_features = false;
        while let Some(key) = map.next_key::<String>()? {
            if key == "features" {
                has_features = true;
                map.next_value_seed(Features(&mut *self.0))?;
            } else {
                map.next_value::<IgnoredAny>()?;
            }
        }
        Ok(has_features)
    }
}

/// Reads the list of features.
struct Features<'s, 'a>(&'s mut State<'a>);

impl<'de> DeserializeSeed<'de> for Features<'_, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<(), D::Error> {
        from.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for Features<'_, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of features")
    }

    fn visit_seq<S: SeqAccess<'de>>(self, mut list: S) -> Result<(), S::Error> {
        while let Some(feature) = list.next_element::<Feature>()? {
            if let Err(fault) = self.0.take(feature) {
                self.0.fault = Some(fault);
                return Err(serde::de::Error::custom("stopped"));
            }
        }
        Ok(())
    }
}

/// Returns the two numbers of a position.
fn position(value: &Value) -> Option<[f64; 2]> {
    let [x, y, ..] = value.as_array()?.as_slice() else { return None };
    Some([x.as_f64()?, y.as_f64()?])
}

impl State<'_> {
    fn take(&mut self, feature: Feature) -> Result<(), InventoryError> {
        self.features += 1;
        let Some(Geometry { kind, coordinates }) = feature.geometry else {
            return self.bad("the feature has no geometry".into());
        };
        let places: Option<Vec<[f64; 2]>> = match kind.as_str() {
            "Point" => position(&coordinates).map(|p| vec![p]),
            "MultiPoint" => coordinates.as_array().and_then(|all| all.iter().map(position).collect()),
            _ => {
                let fault = InventoryError::Geometry { feature: self.features, kind: base::quoted(&kind) };
                self.rows.seen += 1;
                return self.rows.bad(fault, self.spec);
            }
        };
        let Some(places) = places else {
            return self.bad(format!("feature {} has no coordinates", self.features));
        };
        let properties = feature.properties.unwrap_or_default();
        for name in properties.keys() {
            self.add_column(name);
        }
        let mut values: Vec<Option<Cell<'_>>> = vec![None; self.rows.columns.all.len()];
        for (name, value) in &properties {
            let cell = match value {
                Value::Number(n) => n.as_f64().map(Cell::Number),
                Value::String(text) => Some(Cell::Text(text)),
                _ => None,
            };
            if let Some(slot) = self.columns_by_name.get(name).and_then(|k| values.get_mut(*k)) {
                *slot = cell;
            }
        }
        for place in places {
            self.rows.take(&|k| values.get(k).copied().flatten(), Some(place), self.spec, self.run)?;
        }
        Ok(())
    }

    fn bad(&mut self, why: String) -> Result<(), InventoryError> {
        self.rows.seen += 1;
        let row = self.rows.seen;
        self.rows.bad(InventoryError::Row { row, why }, self.spec)
    }

    /// Adds a column for a property, because features differ in theirs.
    fn add_column(&mut self, name: &str) {
        if self.columns_by_name.len() < MOST_COLUMNS && !self.columns_by_name.contains_key(name) {
            self.columns_by_name.insert(name.to_owned(), self.rows.columns.all.len());
            self.rows.columns.push(name);
        }
    }
}
