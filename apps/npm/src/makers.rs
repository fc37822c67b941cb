//! Drawings, leaves and flowers: a document of one plant -> the plant.

use std::sync::Arc;

use burgeon::bloom::FlowerSpec;
use burgeon::document::{
    CommandError, Document, DocumentPlant, Editor, FlowerMaker, LeafData, LeafMaker, Maker, NewPlant,
    PlantCommand, PlantId, SceneCommand, Settings, SketchCommand,
};
use burgeon::formats::{DrawingFormat, Foreign};
use burgeon::glam::DVec2;
use burgeon::ink::{Drawing, StrokeClass};
use burgeon::leaf::LeafSpec;
use burgeon::sketch::SketchSpec;
use burgeon::{SceneEvaluator, Seed};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wasm_bindgen::prelude::*;

use crate::asked::{Asked, Refused, from_json, refused};
use crate::host;
use crate::made::{Level, Made};

/// A drawing: a file's name with its extension, or points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SketchAsked {
    /// Options of all makers.
    pub common: Asked,
    /// Its name; the extension gives the format of a file.
    pub name: String,
    /// Classes of strokes, by the number of the stroke.
    pub classes: std::collections::BTreeMap<usize, String>,
    /// The day, if its flowers open.
    pub day: Option<f64>,
}

/// A leaf of numbers, or of the text of a file of marks or veins.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LeafAsked {
    /// Options of all makers.
    pub common: Asked,
    /// Its name.
    pub name: Option<String>,
    /// Marks (CSV) or a vein graph (JSON).
    pub text: String,
}

/// A flower on a day.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FlowerAsked {
    /// Options of all makers.
    pub common: Asked,
    /// A species.
    pub preset: Option<String>,
    /// The text of a TOML file.
    pub toml: Option<String>,
    /// The day: 0 is the bud; none for full bloom.
    pub day: Option<f64>,
}

/// Makes the plant of a drawing: `SketchAsked` as JSON; the bytes of a file, or points (x, y upwards) of strokes one
/// after another with the number of points of each.
///
/// # Errors
/// The fault of the request, as `Refusal` in JSON.
#[wasm_bindgen]
pub fn sketch(asked: &str, file: &[u8], points: &[f64], counts: &[u32], seed: u64) -> Result<Made, Refused> {
    host::tell_of_panics();
    let asked: SketchAsked = from_json(asked)?;
    let drawing = if file.is_empty() {
        lines(&asked.name, points, counts)
    } else {
        let (stem, extension) = asked.name.rsplit_once('.').unwrap_or((&asked.name, ""));
        let format = DrawingFormat::from_extension(extension).or_else(|| DrawingFormat::sniff(file));
        let unread = |why: String| Refused::plain("drawing", format!("{}: {why}", asked.name));
        let format = format.ok_or_else(|| match Foreign::sniff(file) {
            Some(foreign) => refused(&foreign),
            None => unread("is no drawing (.svg, .inkml, .ndjson, .json)".into()),
        })?;
        let mut read = burgeon::formats::read_drawings(file, format, stem);
        let first = read.next().ok_or_else(|| unread("holds no drawing".into()))?;
        let drawing = first.map_err(|e| refused(&e))?.drawing;
        if read.next().is_some() {
            return Err(unread("holds several drawings; give one".into()));
        }
        drawing
    };
    let document = Document::from_drawing(&drawing);
    let plant = document.plants().first().ok_or_else(lost)?;
    let (id, strokes) = (plant.id(), plant.strokes().iter().map(|s| s.id).collect::<Vec<_>>());
    let spec = asked.common.spec(&SketchSpec::default())?;
    let mut commands = vec![
        SketchCommand::SetSketch(Box::new(spec)).for_plant(id),
        SketchCommand::SetSkin(asked.common.skin()?).for_plant(id),
        PlantCommand::SetSeed(Seed::new(seed)).for_plant(id),
        SketchCommand::SetDay(asked.day).for_plant(id),
    ];
    for (row, word) in &asked.classes {
        let count = strokes.len().to_string();
        let stroke = strokes.get(*row);
        let stroke = stroke.ok_or_else(|| Refused::choice("classes", &row.to_string(), &count))?;
        let known = || StrokeClass::ALL.map(StrokeClass::word).join(", ");
        let class = StrokeClass::from_word(word);
        let class = class.ok_or_else(|| Refused::choice(&format!("classes[{row}]"), word, &known()))?;
        commands.push(SketchCommand::SetClass(vec![*stroke], Some(class)).for_plant(id));
    }
    let mut editor = Editor::new(document);
    for command in commands {
        done(editor.run(command))?;
    }
    made(&editor, id, "sketch", None, &asked.common)
}

fn lines(name: &str, points: &[f64], counts: &[u32]) -> Drawing {
    let mut rest = points.chunks_exact(2).map(|p| DVec2::new(p[0], p[1]));
    let lines = counts.iter().map(|&n| rest.by_ref().take(n as usize).collect());
    let lines: Vec<Vec<DVec2>> = lines.collect();
    Drawing::from_polylines(name, &lines)
}

/// Makes a leaf: `LeafAsked` as JSON.
///
/// # Errors
/// The fault of the request, as `Refusal` in JSON.
#[wasm_bindgen]
pub fn leaf(asked: &str, seed: u64) -> Result<Made, Refused> {
    host::tell_of_panics();
    let asked: LeafAsked = from_json(asked)?;
    let settings = asked.common.spec(&LeafSpec::default())?;
    let name = asked.name.unwrap_or_else(|| "leaf".into());
    let data = LeafData { name: name.clone(), text: asked.text.into() };
    alone(&name, Maker::Leaf(Box::new(LeafMaker { data, settings })), ("leaf", None), &asked.common, seed)
}

/// Makes a flower: `FlowerAsked` as JSON.
///
/// # Errors
/// The fault of the request, as `Refusal` in JSON.
#[wasm_bindgen]
pub fn bloom(asked: &str, seed: u64) -> Result<Made, Refused> {
    host::tell_of_panics();
    let asked: FlowerAsked = from_json(asked)?;
    let base = match (&asked.preset, &asked.toml) {
        (Some(word), _) => {
            let known = || FlowerSpec::PRESETS.join(", ");
            burgeon::bloom::preset(word).ok_or_else(|| Refused::choice("preset", word, &known()))?
        }
        (None, Some(text)) => burgeon::spec::from_toml(text).map_err(|e| refused(&e))?,
        (None, None) => FlowerSpec::default(),
    };
    let spec = asked.common.spec(&base)?;
    let (name, day) = (spec.name.clone(), asked.day.unwrap_or(spec.opening_days));
    let flower = FlowerMaker { preset: asked.preset.clone(), spec: Arc::new(spec), day, law: None };
    let of = ("flower", asked.preset.as_deref());
    alone(&name, Maker::Flower(Box::new(flower)), of, &asked.common, seed)
}

/// Makes the only plant of a document.
fn alone(
    name: &str,
    maker: Maker,
    of: (&'static str, Option<&str>),
    asked: &Asked,
    seed: u64,
) -> Result<Made, Refused> {
    let settings = Settings { name: name.to_owned(), seed: Seed::new(seed), maker, ..Settings::default() };
    let mut editor = Editor::new(Document::default());
    let sheet: Vec<PlantId> = editor.document().plants().iter().map(DocumentPlant::id).collect();
    let plant = NewPlant { settings, strokes: Vec::new() };
    done(editor.run(SceneCommand::Add(Box::new(plant))))?;
    done(editor.run(SceneCommand::Rename(name.to_owned())))?;
    if !sheet.is_empty() {
        done(editor.run(SceneCommand::Remove(sheet)))?;
    }
    let id = editor.document().plants().last().map(DocumentPlant::id).ok_or_else(lost)?;
    made(&editor, id, of.0, of.1, asked)
}

fn made(
    editor: &Editor,
    id: PlantId,
    maker: &'static str,
    preset: Option<&str>,
    asked: &Asked,
) -> Result<Made, Refused> {
    let document = editor.document();
    let mut scene = SceneEvaluator::default();
    scene.set_wind(asked.wind());
    asked.run(|run| scene.update(id, document, run))?;
    let (shown, plant) = scene.get(id).zip(document.plant(id)).ok_or_else(lost)?;
    let structure = shown.plant.ok_or_else(lost)?;
    let owners = shown.owners.map(|layout| (structure.clone(), layout.clone()));
    let mut levels = vec![Level { model: shown.model.clone(), owners }];
    for level in 1..=asked.levels_made()? {
        let model = asked.run(|run| scene.at_level(plant, level, run))?;
        levels.push(Level { model, owners: None });
    }
    let days = scene.days(id, document);
    Made::new(maker, preset, shown.report(), (levels, structure.clone()), days, asked)
}

fn done(outcome: Result<(), CommandError>) -> Result<(), Refused> {
    match outcome {
        Ok(()) | Err(CommandError::Nothing(_)) => Ok(()),
        Err(e) => Err(refused(&e)),
    }
}

fn lost() -> Refused {
    Refused::plain("internal", "internal error, a bug in burgeon: no plant was made".into())
}
