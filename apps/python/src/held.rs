//! What was made of a document's plant: kept as long as anything of Python looks at it.

use std::sync::Arc;

use burgeon::document::{Document, Editor, Maker, PlantId};
use burgeon::mesh::Model;
use burgeon::plant::Plant;
use burgeon::skin::Layout;
use burgeon::{SceneEvaluator, ScenePlant, Seed};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::compute::compute;
use crate::fault::{refused, unusable};

/// A plant of a document and what was made of it. Nothing changes it: what follows from it is another.
pub(crate) struct Held {
    pub(crate) scene: SceneEvaluator,
    pub(crate) document: Document,
    pub(crate) id: PlantId,
    pub(crate) budget: f64,
}

impl Held {
    /// Makes the plant of a document.
    pub(crate) fn make(
        py: Python<'_>,
        scene: SceneEvaluator,
        document: Document,
        id: PlantId,
        budget: f64,
    ) -> PyResult<Arc<Self>> {
        if !(1.0..=1000.0).contains(&budget) {
            return Err(PyValueError::new_err(format!("budget must be 1 to 1000, not {budget}")));
        }
        let mut held = Self { scene, document, id, budget };
        let made = compute(py, budget, |run| held.scene.update(id, &held.document, run).map(|()| held))?;
        let held = made.map_err(|e| refused(py, &e))?;
        let there = held.scene.get(id).is_some_and(|p| p.plant.is_some() && p.owners.is_some());
        if !there {
            return Err(unusable(py, &"internal error, a bug in burgeon: no plant was made"));
        }
        Ok(Arc::new(held))
    }

    pub(crate) fn shown(&self) -> Option<ScenePlant<'_>> {
        self.scene.get(self.id)
    }

    pub(crate) fn model(&self) -> &Model {
        static NONE: std::sync::OnceLock<Model> = std::sync::OnceLock::new();
        self.shown().map_or_else(|| NONE.get_or_init(Model::default), |p| p.model)
    }

    pub(crate) fn plant(&self) -> &Plant {
        static NONE: std::sync::OnceLock<Plant> = std::sync::OnceLock::new();
        self.shown().and_then(|p| p.plant).unwrap_or_else(|| NONE.get_or_init(Plant::default))
    }

    pub(crate) fn layout(&self) -> &Layout {
        static NONE: std::sync::OnceLock<Layout> = std::sync::OnceLock::new();
        self.shown().and_then(|p| p.owners).unwrap_or_else(|| NONE.get_or_init(Layout::default))
    }

    pub(crate) fn seed(&self) -> Seed {
        self.document.plant(self.id).map_or_else(Seed::default, |p| p.settings().seed)
    }

    pub(crate) fn maker(&self) -> Option<&Maker> {
        Some(&self.document.plant(self.id)?.settings().maker)
    }

    /// The plant after more commands.
    pub(crate) fn after(
        &self,
        py: Python<'_>,
        commands: impl IntoIterator<Item = burgeon::document::Command>,
    ) -> PyResult<Arc<Self>> {
        let mut editor = Editor::new(self.document.clone());
        for command in commands {
            match editor.run(command) {
                Ok(()) | Err(burgeon::document::CommandError::Nothing(_)) => {}
                Err(e) => return Err(refused(py, &e)),
            }
        }
        Self::make(py, self.scene.clone(), editor.document().clone(), self.id, self.budget)
    }
}
