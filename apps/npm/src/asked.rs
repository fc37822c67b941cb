//! Requests as JSON; errors as JSON.

use std::fmt::Display;

#[cfg(feature = "makers")]
use burgeon::formats::{ExportSpec, ModelFormat};
#[cfg(feature = "makers")]
use burgeon::mesh::Model;
use burgeon::skin::SkinSpec;
use burgeon::{
    Allowance, Coded, Engine, EngineReport, ExportChoice, Refusal, Run, Slip, Spec, SpecFault, TreeGoal,
};
#[cfg(feature = "makers")]
use burgeon::{FileForm, name_after};
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

    /// Returns the error for an option that nothing uses, or that another one excludes.
    pub(crate) fn unused(name: &str, message: String) -> Self {
        Self::with("field-range", &[("field", name), ("value", "given"), ("range", "left out")], message)
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
    /// Most triangles of the finest copy, 100 or more: it becomes the first level of detail within it.
    pub triangles: Option<u64>,
    /// Most megabytes of the file `glb`, 0.001 to 4000: textures become smaller first, then it becomes the first level of
    /// detail that fits.
    pub megabytes: Option<f64>,
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
    /// Height in metres to which it grows: it has the age at which it comes nearest, and is scaled by the rest.
    pub height: Option<f64>,
    /// Diameter at breast height in metres to which it grows, in the same way.
    pub dbh: Option<f64>,
}

impl TreeAsked {
    /// Returns the size that it grows to, if one is given.
    pub(crate) fn goal(&self) -> Result<Option<TreeGoal>, Refused> {
        let age = self.common.fields.get("age").filter(|age| !age.is_null());
        let given = [
            ("height", self.height.is_some()),
            ("dbh", self.dbh.is_some()),
            ("height_m", self.height_m.is_some()),
            ("age", age.is_some()),
        ];
        let given: Vec<&str> = given.into_iter().filter(|g| g.1).map(|g| g.0).collect();
        if (self.height.is_some() || self.dbh.is_some())
            && let [first, second, ..] = given[..]
        {
            return Err(Refused::unused(
                second,
                format!("{first} and {second} exclude each other: give one"),
            ));
        }
        if let Some(height) = self.height {
            return number("height", height, TreeGoal::HEIGHTS_M).map(TreeGoal::Height).map(Some);
        }
        self.dbh.map(|dbh| number("dbh", dbh, TreeGoal::DIAMETERS_M).map(TreeGoal::Dbh)).transpose()
    }
}

/// How files are written for a program.
pub(crate) struct Settled {
    pub(crate) engine: Engine,
    pub(crate) choice: ExportChoice,
    pub(crate) report: EngineReport,
}

#[cfg(feature = "makers")]
impl Settled {
    /// Returns the form of the file.
    pub(crate) fn file(&self) -> FileForm {
        let nodes = Some(self.engine).filter(|engine| engine.has_nodes(&self.choice));
        FileForm {
            format: ModelFormat::Glb,
            axes: ExportSpec::default(),
            packing: self.choice.packing,
            sways: self.choice.sways,
            is_one_file: nodes.is_some(),
            nodes,
        }
    }

    /// Returns a model with its names in files.
    pub(crate) fn named(&self, plant: &str, model: &Model) -> Model {
        let mut model = model.clone();
        if self.choice.has_names {
            name_after(plant, &mut model);
        }
        model
    }
}

#[cfg(not(feature = "makers"))]
impl Settled {
    /// Returns the error for a file for a program.
    pub(crate) fn unwritten(&self) -> Refused {
        let engine = self.engine.word();
        let told = format!(
            "files for a program (engine {engine}) are written by `burgeon`, not by `burgeon/growth`"
        );
        Refused::plain("write", told)
    }
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

    /// Returns the largest size that is wanted.
    ///
    /// Trees alone are half of the download: they have no budgets.
    pub(crate) fn allowance(&self) -> Result<Allowance, Refused> {
        if cfg!(not(feature = "makers")) {
            for (name, is_given) in
                [("triangles", self.triangles.is_some()), ("megabytes", self.megabytes.is_some())]
            {
                if is_given {
                    let line = format!("{name} is kept by `burgeon`, not by `burgeon/growth`");
                    return Err(Refused::unused(name, line));
                }
            }
        }
        if let Some(count) = self.triangles {
            let (least, most) = Allowance::TRIANGLES;
            number("triangles", count as f64, (least as f64, most as f64))?;
        }
        let megabytes = self.megabytes.map(|m| number("megabytes", m, Allowance::MEGABYTES)).transpose()?;
        if megabytes.is_some() && !self.files.iter().any(|f| f == "glb") {
            let line = "megabytes is of a file glb: ask for it with files: ['glb']";
            return Err(Refused::unused("megabytes", line.into()));
        }
        Ok(Allowance::new(self.triangles, megabytes))
    }

    /// Returns the number of levels of detail to make in addition to the finest: with an allowance, more than there will be.
    pub(crate) fn levels_made(&self) -> Result<u32, Refused> {
        Ok(self.allowance()?.levels(self.levels()?))
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
        self.computed(compute)?.map_err(|e| refused(&e))
    }

    /// Computes within the requested budget; errors are left to the caller.
    pub(crate) fn computed<T>(&self, compute: impl FnOnce(&Run<'_>) -> T) -> Result<T, Refused> {
        let times = number("budget", self.budget.unwrap_or(1.0), (1.0, 4.0))?;
        Ok(with_budget(times, compute))
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
