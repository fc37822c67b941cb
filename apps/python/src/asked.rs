//! Options of all makers: a seed, fields of a spec, meshing.

use std::sync::Arc;

use burgeon::document::{
    Document, DocumentPlant, Editor, Maker, NewPlant, PlantId, SceneCommand, Settings, TreeCommand,
};
use burgeon::skin::{FoliageStyle, SkinSpec};
use burgeon::{SceneEvaluator, Seed, Spec};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;

use crate::fault::{beyond, refused, unusable};
use crate::held::{Held, run};
use crate::value::json_of;

/// Options of all makers.
#[derive(FromPyObject)]
pub(crate) struct Asked<'py> {
    #[pyo3(item)]
    pub(crate) seed: u64,
    #[pyo3(item)]
    pub(crate) budget: f64,
    /// Fields of the maker's spec.
    #[pyo3(item)]
    fields: Bound<'py, PyDict>,
    /// Fields of the meshing, and `wind`.
    #[pyo3(item)]
    skin: Bound<'py, PyDict>,
}

impl Asked<'_> {
    /// Returns a spec with the requested fields.
    pub(crate) fn spec<T: Spec>(&self, py: Python<'_>, base: &T) -> PyResult<T> {
        if self.fields.is_empty() {
            return burgeon::spec::from_json(&burgeon::spec::to_json(base)).map_err(|e| refused(py, &e));
        }
        put(py, base, json_of(self.fields.as_any(), "")?)
    }

    pub(crate) fn skin(&self, py: Python<'_>) -> PyResult<(SkinSpec, bool)> {
        let (skin, wind) = self.skin_on(py, &SkinSpec::default())?;
        Ok((skin, wind.unwrap_or(false)))
    }

    /// Calls [`skin_on`] with the requested fields.
    pub(crate) fn skin_on(&self, py: Python<'_>, base: &SkinSpec) -> PyResult<(SkinSpec, Option<bool>)> {
        skin_on(py, &self.skin, base)
    }

    pub(crate) fn seed(&self) -> Seed {
        Seed::new(self.seed)
    }

    pub(crate) fn budget(&self) -> PyResult<f64> {
        if (1.0..=1000.0).contains(&self.budget) {
            return Ok(self.budget);
        }
        Err(beyond("budget", self.budget, "1 to 1000"))
    }

    pub(crate) fn made(
        &self,
        py: Python<'_>,
        document: Document,
        id: PlantId,
        wind: bool,
    ) -> PyResult<Arc<Held>> {
        let mut scene = SceneEvaluator::default();
        scene.set_wind(wind);
        Held::make(py, scene, document, id, self.budget)
    }

    /// Makes the only plant of a document.
    pub(crate) fn alone(&self, py: Python<'_>, name: &str, maker: Maker, wind: bool) -> PyResult<Arc<Held>> {
        self.bearing(py, name, maker, None, wind)
    }

    /// Makes the only visible plant of a document; a hidden one may lend it its leaf.
    pub(crate) fn bearing(
        &self,
        py: Python<'_>,
        name: &str,
        maker: Maker,
        leaf: Option<Settings>,
        wind: bool,
    ) -> PyResult<Arc<Held>> {
        let mut editor = Editor::new(Document::default());
        let sheet: Vec<PlantId> = editor.document().plants().iter().map(DocumentPlant::id).collect();
        let mut add = |settings| -> PyResult<PlantId> {
            let plant = NewPlant { settings, strokes: Vec::new() };
            run(py, &mut editor, SceneCommand::Add(Box::new(plant)).into())?;
            let lost = || unusable(py, &"internal error, a bug in burgeon: the plant is not in its document");
            editor.document().plants().last().map(DocumentPlant::id).ok_or_else(lost)
        };
        let lender = leaf.map(|leaf| add(Settings { hidden: true, ..leaf })).transpose()?;
        let id = add(Settings { name: name.to_owned(), seed: self.seed(), maker, ..Settings::default() })?;
        if lender.is_some() {
            run(py, &mut editor, TreeCommand::SetLeaf(lender).for_plant(id))?;
        }
        run(py, &mut editor, SceneCommand::Rename(name.to_owned()).into())?;
        if !sheet.is_empty() {
            run(py, &mut editor, SceneCommand::Remove(sheet).into())?;
        }
        self.made(py, editor.document().clone(), id, wind)
    }
}

/// Returns the meshing of `base` with the requested fields, and the wish for wind columns, if there is one.
pub(crate) fn skin_on(
    py: Python<'_>,
    asked: &Bound<'_, PyDict>,
    base: &SkinSpec,
) -> PyResult<(SkinSpec, Option<bool>)> {
    let mut fields = json_of(asked.as_any(), "")?;
    // Fields that the schema of saved fields does not have.
    let mut unsaved = |name: &str| fields.as_object_mut().and_then(|f| f.remove(name));
    let wind = match unsaved("wind") {
        None => None,
        Some(Value::Bool(wind)) => Some(wind),
        Some(other) => return Err(beyond("wind", other, "True or False")),
    };
    let (size, foliage) = (unsaved("texture_size"), unsaved("foliage"));
    let mut skin = put(py, base, fields)?;
    if let Some(size) = size {
        let pixels = size.as_u64().and_then(|s| u32::try_from(s).ok()).filter(|s| (64..=4096).contains(s));
        skin.texture_size = pixels.ok_or_else(|| beyond("texture_size", size, "64 to 4096 pixels"))?;
    }
    if let Some(word) = foliage {
        skin.foliage = match word.as_str() {
            Some("outlines") => FoliageStyle::Outlines,
            Some("cards") => FoliageStyle::Cards,
            Some("by-level") => FoliageStyle::ByLevel,
            _ => return Err(beyond("foliage", word, "outlines, cards or by-level")),
        };
    }
    Ok((skin, wind))
}

/// Returns a spec with some fields replaced, all within their ranges.
fn put<T: Spec>(py: Python<'_>, base: &T, fields: Value) -> PyResult<T> {
    burgeon::spec::with_fields(base, fields).map_err(|e| refused(py, &e))
}
