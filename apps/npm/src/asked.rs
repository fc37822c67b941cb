//! What is asked for in JSON; errors as JSON.

use std::collections::BTreeMap;
use std::fmt::Display;

use burgeon::skin::SkinSpec;
use burgeon::{Coded, Run, Slip, Spec, SpecFault, Told};
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use wasm_bindgen::prelude::*;

use crate::host::with_budget;
use crate::view::Refusal;

/// A `Refusal` as JSON: what JavaScript catches.
#[derive(Debug)]
pub struct Refused(String);

impl From<Refused> for JsValue {
    fn from(refused: Refused) -> Self {
        Self::from_str(&refused.0)
    }
}

impl Refused {
    /// In words alone.
    pub(crate) fn plain(code: &str, message: String) -> Self {
        Self::of(Refusal { code: code.into(), fields: BTreeMap::new(), message })
    }

    /// A word that is none of those that are known.
    pub(crate) fn choice(path: &str, name: &str, choices: &str) -> Self {
        let fields = [("path", path), ("name", name), ("choices", choices)];
        let fields = fields.into_iter().map(|(k, v)| (k.into(), v.into())).collect();
        let hint = burgeon::meant(name, choices.split(", "));
        let message = format!("{path}: {name:?} is not known; there are {choices}{hint}");
        Self::of(Refusal { code: "spec-choice".into(), fields, message })
    }

    fn of(refusal: Refusal) -> Self {
        Self(serde_json::to_string(&refusal).unwrap_or(refusal.message))
    }
}

/// An error of the core.
pub(crate) fn refused(error: &(impl Coded + Display)) -> Refused {
    let Told { code, fields, .. } = error.told();
    let fields = fields.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
    Refused::of(Refusal { code: code.into(), fields, message: error.to_string() })
}

/// Reads what JavaScript says.
pub(crate) fn from_json<T: DeserializeOwned>(text: &str) -> Result<T, Refused> {
    burgeon::spec::through_json::from_text(text).map_err(|e| {
        let message = e.to_string();
        let told = Slip::of(&message).told();
        let fields = told.fields.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        Refused::of(Refusal { code: told.code.into(), fields, message })
    })
}

/// A number within its range.
pub(crate) fn number(name: &str, value: f64, (min, max): (f64, f64)) -> Result<f64, Refused> {
    if (min..=max).contains(&value) {
        return Ok(value);
    }
    let fields =
        [("field", name.to_owned()), ("value", value.to_string()), ("range", format!("{min} to {max}"))];
    let fields = fields.into_iter().map(|(k, v)| (k.to_owned(), v)).collect();
    let message = format!("{name} must be {min} to {max}, not {value}");
    Err(Refused::of(Refusal { code: "field-range".into(), fields, message }))
}

/// What all makers are asked for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Asked {
    /// Fields of the maker's spec in the place of its own.
    pub fields: Map<String, Value>,
    /// Fields of how it is meshed.
    pub skin: SkinAsked,
    /// Coarser copies to make as well, 0 to 6.
    pub lods: u32,
    /// How many times the usual limits may be exceeded, 1 to 4.
    pub budget: Option<f64>,
    /// Files of the finest copy by their extensions: `glb`, `mtg`, `opf`.
    pub files: Vec<String>,
}

/// How a plant is meshed; what is left out is as usual.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SkinAsked {
    /// Columns that say how wind moves each vertex.
    pub wind: Option<bool>,
    /// Pixels of a side of the textures of bark, and of the length of those of leaves, 64 to 4096.
    pub texture_size: Option<u32>,
    /// The fields of its schema.
    #[serde(skip_serializing_if = "Map::is_empty")]
    pub fields: Map<String, Value>,
}

/// A tree.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TreeAsked {
    /// What all makers are asked for.
    pub common: Asked,
    /// A species.
    pub preset: Option<String>,
    /// The text of a TOML file.
    pub toml: Option<String>,
    /// Scales the wood to this height, metres.
    pub height_m: Option<f64>,
}

impl Asked {
    /// A spec with the fields that are asked for in the place of its own.
    pub(crate) fn spec<T: Spec>(&self, base: &T) -> Result<T, Refused> {
        put(base, &self.fields)
    }

    pub(crate) fn skin(&self) -> Result<SkinSpec, Refused> {
        let skin = put(&SkinSpec::default(), &self.skin.fields)?;
        let texture_size = self.skin.texture_size.unwrap_or(skin.texture_size);
        number("texture_size", f64::from(texture_size), (64.0, 4096.0))?;
        Ok(SkinSpec { wind: self.wind(), texture_size, ..skin })
    }

    pub(crate) fn wind(&self) -> bool {
        self.skin.wind.unwrap_or(true)
    }

    /// Levels of detail beside the finest.
    pub(crate) fn levels(&self) -> Result<u32, Refused> {
        number("lods", f64::from(self.lods), (0.0, 6.0)).map(|_| self.lods)
    }

    /// Computes within the budget that is asked for.
    pub(crate) fn run<T, E: Coded + Display>(
        &self,
        compute: impl FnOnce(&Run<'_>) -> Result<T, E>,
    ) -> Result<T, Refused> {
        let times = number("budget", self.budget.unwrap_or(1.0), (1.0, 4.0))?;
        with_budget(times, compute).map_err(|e| refused(&e))
    }
}

fn put<T: Spec>(base: &T, fields: &Map<String, Value>) -> Result<T, Refused> {
    let put: Result<T, SpecFault> = burgeon::spec::with_fields(base, Value::Object(fields.clone()));
    put.map_err(|e| refused(&e))
}
