//! The result of a document's plant: kept as long as any Python object uses it.

use std::sync::Arc;

use burgeon::document::{Command, CommandError, Document, Editor, Maker, PlantId};
use burgeon::glam::DVec3;
use burgeon::mesh::Model;
use burgeon::plant::Plant;
use burgeon::skin::Layout;
use burgeon::{ItemReport, MadePlant, SceneEvaluator, ScenePlant, Seed};
use pyo3::prelude::*;

use crate::compute::compute;
use crate::fault::{beyond, refused, unusable};

/// A plant of a document and its results. It never changes: each edit makes another one.
pub(crate) struct Held {
    pub(crate) scene: SceneEvaluator,
    pub(crate) document: Document,
    pub(crate) id: PlantId,
    pub(crate) budget: f64,
    /// A plant without a document: a leaf of chief veins, or of a scan, or a scanned tree.
    pub(crate) lone: Option<MadePlant>,
    /// Report on a scanned tree.
    pub(crate) found: Option<Found>,
}

/// Report of a scan on its tree.
pub(crate) struct Found {
    /// Place of its foot in the scan, metres, +Y up.
    pub(crate) foot: DVec3,
    /// Counts of the points.
    pub(crate) tally: serde_json::Value,
    pub(crate) seed: Seed,
}

/// Applies a command; one that changes nothing is no error.
pub(crate) fn run(py: Python<'_>, editor: &mut Editor, command: Command) -> PyResult<()> {
    match editor.run(command) {
        Ok(()) | Err(CommandError::Nothing(_)) => Ok(()),
        Err(e) => Err(refused(py, &e)),
    }
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
            return Err(beyond("budget", budget, "1 to 1000"));
        }
        let mut held = Self { scene, document, id, budget, lone: None, found: None };
        let made = compute(py, budget, |run| held.scene.update(id, &held.document, run).map(|()| held))?;
        let held = made.map_err(|e| refused(py, &e))?;
        let there = held.scene.get(id).is_some_and(|p| p.plant.is_some() && p.owners.is_some());
        if !there {
            return Err(unusable(py, &"internal error, a bug in burgeon: no plant was made"));
        }
        if let Some(check) = held.report().as_ref().and_then(|r| r.refusal(false)) {
            return Err(unusable(py, &format_args!("{}: {}", check.message, check.advice)));
        }
        Ok(Arc::new(held))
    }

    /// Holds a plant that has no document.
    pub(crate) fn lone(made: MadePlant, found: Option<Found>, budget: f64) -> Arc<Self> {
        let (scene, document) = (SceneEvaluator::default(), Document::default());
        Arc::new(Self { scene, document, id: PlantId(u32::MAX), budget, lone: Some(made), found })
    }

    /// Returns the entry of the report.
    pub(crate) fn report(&self) -> Option<ItemReport> {
        self.lone.as_ref().map(|l| l.item.clone()).or_else(|| self.shown().map(|p| p.report()))
    }

    pub(crate) fn shown(&self) -> Option<ScenePlant<'_>> {
        self.scene.get(self.id)
    }

    pub(crate) fn model(&self) -> &Model {
        static NONE: std::sync::OnceLock<Model> = std::sync::OnceLock::new();
        let made = self.lone.as_ref().map(|l| &l.model).or_else(|| self.shown().map(|p| p.model));
        made.unwrap_or_else(|| NONE.get_or_init(Model::default))
    }

    pub(crate) fn plant(&self) -> &Plant {
        static NONE: std::sync::OnceLock<Plant> = std::sync::OnceLock::new();
        let made = self.lone.as_ref().map(|l| &l.plant).or_else(|| self.shown().and_then(|p| p.plant));
        made.unwrap_or_else(|| NONE.get_or_init(Plant::default))
    }

    pub(crate) fn layout(&self) -> &Layout {
        static NONE: std::sync::OnceLock<Layout> = std::sync::OnceLock::new();
        let made = self.lone.as_ref().map(|l| &l.layout).or_else(|| self.shown().and_then(|p| p.owners));
        made.unwrap_or_else(|| NONE.get_or_init(Layout::default))
    }

    pub(crate) fn name(&self) -> &str {
        let of_document = || self.document.plant(self.id).map_or("", |p| &*p.settings().name);
        self.lone.as_ref().map_or_else(of_document, |l| &l.plant.name)
    }

    pub(crate) fn seed(&self) -> Seed {
        if let Some(found) = &self.found {
            return found.seed;
        }
        self.document.plant(self.id).map_or_else(Seed::default, |p| p.settings().seed)
    }

    pub(crate) fn maker(&self) -> Option<&Maker> {
        Some(&self.document.plant(self.id)?.settings().maker)
    }

    /// Fails for plants without a document.
    pub(crate) fn must_have_document(&self, py: Python<'_>) -> PyResult<()> {
        if self.lone.is_none() {
            return Ok(());
        }
        let line = "a plant of a scan, and a leaf of chief veins, has no edits by hand, no other settings or days, and no \
                    project";
        Err(unusable(py, &line))
    }

    /// Returns the plant after more commands.
    pub(crate) fn after(
        &self,
        py: Python<'_>,
        commands: impl IntoIterator<Item = Command>,
    ) -> PyResult<Arc<Self>> {
        self.after_with(py, None, commands)
    }

    /// Returns the plant after more commands; with or without columns for wind, if `wind` says so.
    pub(crate) fn after_with(
        &self,
        py: Python<'_>,
        wind: Option<bool>,
        commands: impl IntoIterator<Item = Command>,
    ) -> PyResult<Arc<Self>> {
        self.must_have_document(py)?;
        let mut editor = Editor::new(self.document.clone());
        commands.into_iter().try_for_each(|command| run(py, &mut editor, command))?;
        let mut scene = self.scene.clone();
        if let Some(wind) = wind {
            scene.set_wind(wind);
        }
        Self::make(py, scene, editor.document().clone(), self.id, self.budget)
    }
}
