//! Requests as JSON; errors as JSON.

use std::fmt::Display;

use burgeon::skin::SkinSpec;
use burgeon::{Coded, Engine, EngineReport, ExportChoice, Refusal, Run, Slip, Spec, SpecFault};
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use wasm_bindgen::prelude::*;

use crate::host::with_budget;

/// A `Refusal` as JSON, which JavaScript catches.
#[derive(Debug)]
pub struct Refused(pub(crate) String);

impl From<Refused> for JsValue {
    fn from(refused: Refused) -> Self {
        Self::from_str(&refused.0)
    }
}

impl Refused {
    /// Returns an error with a message, but without fields.
    pub(crate) fn plain(code: &str, message: String) -> Self {
        Self::with(code, &[], message)
    }

    /// Returns the error for an unknown word.
    pub(crate) fn choice(path: &str, name: &str, choices: &str) -> Self {
        let hint = burgeon::meant(name, choices.split(", "));
        let message = format!("{path}: {name:?} is not known; there are {choices}{hint}");
        Self::with("spec-choice", &[("path", path), ("name", name), ("choices", choices)], message)
    }

    fn with(code: &str, fields: &[(&str, &str)], message: String) -> Self {
        Self(Refusal::plain(code, fields, message).into_json())
    }
}

/// Converts an error of the core.
pub(crate) fn refused(error: &(impl Coded + Display)) -> Refused {
    Refused(Refusal::from_error(error).into_json())
}

/// Parses JSON from JavaScript.
pub(crate) fn from_json<T: DeserializeOwned>(text: &str) -> Result<T, Refused> {
    burgeon::spec::through_json::from_text(text).map_err(|e| {
        let message = e.to_string();
        let refusal = Refusal {
            message: burgeon::plainly(&message),
            ..Refusal::from_error(&Slip::from_message(&message))
        };
        Refused(refusal.into_json())
    })
}

/// Checks that a number is within its range.
pub(crate) fn number(name: &str, value: f64, (min, max): (f64, f64)) -> Result<f64, Refused> {
    if (min..=max).contains(&value) {
        return Ok(value);
    }
    let (value, range) = (value.to_string(), format!("{min} to {max}"));
    let message = format!("{name} must be {range}, not {value}");
    Err(Refused::with("field-range", &[("field", name), ("value", &value), ("range", &range)], message))
}

/// Options of all makers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Asked {
    /// Fields that replace those of the maker's spec.
    pub fields: Map<String, Value>,
    /// Fields of the meshing.
    pub skin: SkinAsked,
    /// Coarser copies to make as well, 0 to 6; by default none, or as many as the program wants.
    pub lods: Option<u32>,
    /// The program that a file `glb` is for, such as `unity`: packed, blown and named as its importer takes it. The coarser
    /// copies are nodes of that file, or come beside it as `lod1.glb` and so on.
    pub engine: Option<String>,
    /// How many times the usual limits may be exceeded, 1 to 4.
    pub budget: Option<f64>,
    /// Files of the finest copy by their extensions: `glb`, `mtg`, `opf`.
    pub files: Vec<String>,
}

/// Options of the meshing; missing ones have the usual values.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SkinAsked {
    /// Whether there are columns for the effect of the wind on each vertex.
    pub wind: Option<bool>,
    /// Pixels along a side of the textures of bark, and along the length of those of leaves, 64 to 4096.
    pub texture_size: Option<u32>,
    /// Fields of its schema.
    #[serde(skip_serializing_if = "Map::is_empty")]
    pub fields: Map<String, Value>,
}

/// A tree.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TreeAsked {
    /// Options of all makers.
    pub common: Asked,
    /// A species.
    pub preset: Option<String>,
    /// The text of a TOML file.
    pub toml: Option<String>,
    /// Height in metres to which the wood is scaled.
    pub height_m: Option<f64>,
}

/// How files are written for a program.
pub(crate) struct Settled {
    pub(crate) engine: Engine,
    pub(crate) choice: ExportChoice,
    pub(crate) report: EngineReport,
}

impl Asked {
    /// Returns a spec with the requested fields.
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

    /// Returns the number of levels of detail in addition to the finest.
    pub(crate) fn levels(&self) -> Result<u32, Refused> {
        let lods = self.settled()?.and_then(|s| s.choice.lods).or(self.lods).unwrap_or(0);
        number("lods", f64::from(lods), (0.0, 6.0)).map(|_| lods)
    }

    /// Returns the settings that the named program wants for a `glb`, if one is named.
    pub(crate) fn settled(&self) -> Result<Option<Settled>, Refused> {
        let Some(word) = &self.engine else { return Ok(None) };
        let engine =
            Engine::from_word(word).ok_or_else(|| Refused::choice("engine", word, &Engine::words()))?;
        let still = !self.wind();
        let mut choice = ExportChoice { lods: self.lods, is_still: still, ..ExportChoice::default() };
        let set = engine.settle("glb", &mut choice);
        let set = set.map_err(|e| Refused::plain("write", format!("engine {word}: {e}")))?;
        let set = set.iter().map(ToString::to_string).collect();
        Ok(Some(Settled { engine, choice, report: EngineReport { name: word.clone(), set } }))
    }

    /// Computes within the requested budget.
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
