//! What is asked for in JSON; errors as JSON.

use std::fmt::Display;

use burgeon::skin::SkinSpec;
use burgeon::{Coded, Refusal, Run, Slip, Spec, SpecFault};
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use wasm_bindgen::prelude::*;

use crate::host::with_budget;

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
        Self::with(code, &[], message)
    }

    /// A word that is none of those that are known.
    pub(crate) fn choice(path: &str, name: &str, choices: &str) -> Self {
        let hint = burgeon::meant(name, choices.split(", "));
        let message = format!("{path}: {name:?} is not known; there are {choices}{hint}");
        Self::with("spec-choice", &[("path", path), ("name", name), ("choices", choices)], message)
    }

    fn with(code: &str, fields: &[(&str, &str)], message: String) -> Self {
        Self(Refusal::plain(code, fields, message).into_json())
    }
}

/// An error of the core.
pub(crate) fn refused(error: &(impl Coded + Display)) -> Refused {
    Refused(Refusal::of(error).into_json())
}

/// Reads what JavaScript says.
pub(crate) fn from_json<T: DeserializeOwned>(text: &str) -> Result<T, Refused> {
    burgeon::spec::through_json::from_text(text).map_err(|e| {
        let message = e.to_string();
        let refusal = Refusal { message: burgeon::plainly(&message), ..Refusal::of(&Slip::of(&message)) };
        Refused(refusal.into_json())
    })
}

/// A number within its range.
pub(crate) fn number(name: &str, value: f64, (min, max): (f64, f64)) -> Result<f64, Refused> {
    if (min..=max).contains(&value) {
        return Ok(value);
    }
    let (value, range) = (value.to_string(), format!("{min} to {max}"));
    let message = format!("{name} must be {range}, not {value}");
    Err(Refused::with("field-range", &[("field", name), ("value", &value), ("range", &range)], message))
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Programs look for the code of the slip itself, and its place is around it.
    #[test]
    fn an_error_inside_another_arrives_with_its_own_code() {
        let Err(Refused(json)) = from_json::<TreeAsked>("{\n  \"preset\":") else {
            panic!("the text ends early")
        };
        let refusal: Value = serde_json::from_str(&json).unwrap_or_default();
        assert_eq!((&refusal["code"], &refusal["fields"]["line"]), (&"slip-at".into(), &"2".into()));
        assert_eq!(refusal["causes"]["what"]["code"], "json-ends");
    }
}
