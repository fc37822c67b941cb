//! A scene of plants -> a model each, made again only where something changed.
//!
//! `Document -> SceneEvaluator (an evaluator a plant) -> models, reports | scene_model -> one model`

use std::collections::BTreeMap;
use std::sync::Arc;

use base::{Cancelled, OverBudget, Report, Run, Seed, Stopped};
use bloom::FlowerSettings;
use document::{
    Document, DocumentPlant, Editor, FlowerMaker, LeafData, LeafMaker, Maker, Placement, PlantEdit, PlantId,
    SketchCommand, SketchSettings, TreeSettings,
};
use formats::{LeafFileError, MarksAxes, read_marks, read_vein_graph};
use glam::{DQuat, DVec3};
use growth::TreeSpec;
use ink::Drawing;
use leaf::{FullMarks, LeafSpec, ThicknessRule};
use mesh::{MaterialId, Model};
use plant::Plant;
use skin::SkinSpec;
use spec::Spec;

use crate::evaluate::{Evaluator, FrontView};
use crate::flowers::{FlowerOptions, make_flower};
use crate::leaves::{LeafError, LeafOptions, make_leaf_of};
use crate::made::{MadePlant, coarse};
use crate::make::{MakeError, SketchOptions};
use crate::opening::{OpeningError, OpeningPlant};
use crate::report::ItemReport;
use crate::template::LeafTemplate;
use crate::trees::{TreeError, TreeEvaluator, TreeOptions};

/// Why a plant of a scene could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The drawing makes no plant.
    #[error(transparent)]
    Sketch(#[from] MakeError),
    /// Its flowers do not open.
    #[error(transparent)]
    Opening(#[from] OpeningError),
    /// The tree does not grow.
    #[error(transparent)]
    Tree(TreeError),
    /// The leaf's file cannot be read.
    #[error(transparent)]
    File(#[from] LeafFileError),
    /// The leaf's veins make no marks.
    #[error(transparent)]
    Graph(#[from] leaf::GraphError),
    /// The marks make no leaf.
    #[error(transparent)]
    Leaf(LeafError),
    /// The leaf has no marks yet.
    #[error(
        "the leaf has no measurements yet: drop a table of marks (.csv) or a vein graph (.json) on the page"
    )]
    NoMarks,
    /// No such flower.
    #[error("the flower {0:?} is unknown")]
    Species(String),
    /// The plant whose leaf is borne has no leaf.
    #[error("the plant \"{0}\", whose leaf this one bears, has no leaf yet")]
    Lender(String),
    /// A coarser copy was asked for of what is not made.
    #[error("the plant \"{0}\" has not been made yet")]
    NotMade(String),
    /// The plants that are shown already take as many bytes as they may.
    #[error(
        "there is no room for it: the plants of this scene already take {} MB of memory; hide or delete some of them",
        .0 >> 20
    )]
    NoRoom(usize),
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// It would have been too much.
    #[error(transparent)]
    OverBudget(#[from] OverBudget),
}

impl SceneError {
    /// Whether it is no fault: the person asked to stop.
    pub fn is_cancelled(&self) -> bool {
        matches!(
            self,
            Self::Cancelled(_)
                | Self::Sketch(MakeError::Cancelled(_))
                | Self::Opening(OpeningError::Make(MakeError::Cancelled(_)))
                | Self::Tree(TreeError::Cancelled(_))
                | Self::Leaf(LeafError::Cancelled(_))
        )
    }

    /// Whether there is nothing to be made yet: an empty sheet, a leaf without marks.
    pub fn is_bare(&self) -> bool {
        matches!(self, Self::NoMarks | Self::Sketch(MakeError::NoStrokes { .. }))
    }
}

impl From<TreeError> for SceneError {
    fn from(e: TreeError) -> Self {
        if let TreeError::Cancelled(c) = e { Self::Cancelled(c) } else { Self::Tree(e) }
    }
}

impl From<Stopped> for SceneError {
    fn from(stopped: Stopped) -> Self {
        match stopped {
            Stopped::Cancelled(c) => Self::Cancelled(c),
            Stopped::OverBudget(o) => Self::OverBudget(o),
        }
    }
}

impl From<LeafError> for SceneError {
    fn from(e: LeafError) -> Self {
        if let LeafError::Cancelled(c) = e { Self::Cancelled(c) } else { Self::Leaf(e) }
    }
}

base::coded!(SceneError {
    Self::NoMarks => "leaf-no-marks" {},
    Self::Species(name) => "no-species" { name },
    Self::Lender(name) => "lender-without-leaf" { name },
    Self::NotMade(name) => "plant-not-made" { name },
    Self::NoRoom(bytes) => "scene-full" { mb = bytes >> 20 },
} wraps {
    Self::Sketch(e) => e, MakeError;
    Self::Opening(e) => e, OpeningError;
    Self::Tree(e) => e, TreeError;
    Self::File(e) => e, LeafFileError;
    Self::Graph(e) => e, leaf::GraphError;
    Self::Leaf(e) => e, LeafError;
    Self::Cancelled(e) => e, Cancelled;
    Self::OverBudget(e) => e, OverBudget;
});

/// What was made of one plant.
#[derive(Clone, Copy, Debug)]
pub struct ScenePlant<'a> {
    /// The entry of the report.
    pub item: &'a ItemReport,
    /// The meshes, in the plant's own coordinates.
    pub model: &'a Model,
    /// The plant; none after an update that was stopped on the way.
    pub plant: Option<&'a Plant>,
    /// How a drawing lies in the front view.
    pub front: Option<FrontView>,
    /// Grows whenever the model changes.
    pub revision: u64,
    /// What the last update did again.
    pub stages: &'a [&'static str],
}

/// Makes the plants of a document that changes; each keeps what its last change did not touch.
///
/// Guaranteed: the same result as from a fresh evaluator; after an error the last result of the plant stays. Where a
/// plant stands, its name's place in lists and whether it is hidden do not make it anew.
///
/// ```
/// use burgeon::document::{Editor, FlowerMaker, Maker, NewPlant, SceneCommand, Settings};
/// use burgeon::{Run, SceneEvaluator};
/// let mut editor = Editor::default();
/// let settings = Settings { maker: Maker::Flower(Box::default()), ..Settings::default() };
/// editor.run(SceneCommand::Add(Box::new(NewPlant { settings, strokes: vec![] })))?;
/// let flower = editor.document().plants()[1].id();
/// let mut scene = SceneEvaluator::default();
/// scene.update(flower, editor.document(), &Run::plain()).expect("a lily");
/// assert!(scene.get(flower).is_some_and(|p| p.model.triangle_count() > 100));
/// # Ok::<(), burgeon::document::CommandError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct SceneEvaluator {
    wind: bool,
    looking: bool,
    plants: BTreeMap<PlantId, Made>,
}

/// What a result was made from.
type MadeFrom = (Maker, Seed, String, Option<LeafTemplate>, Vec<PlantEdit>);

/// The last result of a plant.
#[derive(Clone, Debug, Default)]
struct Made {
    /// The word of who made it.
    maker: &'static str,
    /// What the result was made from.
    from: Option<MadeFrom>,
    sketch: Evaluator,
    tree: TreeEvaluator,
    opening: Option<OpeningPlant>,
    item: ItemReport,
    /// Of leaves and flowers, and of sketches whose flowers open.
    model: Option<Model>,
    /// Of leaves, flowers and sketches whose flowers open.
    plant: Option<Plant>,
    /// How leaves and flowers are meshed.
    skin: SkinSpec,
    lent: Option<LeafTemplate>,
    revision: u64,
    done: Vec<&'static str>,
}

impl SceneEvaluator {
    /// Whether models say how wind moves them, from the next update on. Default: no.
    pub fn set_wind(&mut self, wind: bool) {
        if self.wind != wind {
            self.wind = wind;
            // Only the surface is made again: what is below it keeps its own account of what it was made from.
            self.plants.values_mut().for_each(|made| made.from = None);
        }
    }

    /// Whether updates are looks while a hand is at work: reports of trees and drawings then have no digest, which is a
    /// third of what a large tree's meshes take. Default: no.
    pub fn set_looking(&mut self, looking: bool) {
        self.looking = looking;
    }

    /// Brings one plant up to date; those whose leaf it bears too.
    ///
    /// # Errors
    /// [`SceneError`]; a plant that is not in the document is left as it was.
    pub fn update(&mut self, id: PlantId, document: &Document, run: &Run<'_>) -> Result<(), SceneError> {
        let Some(plant) = document.plant(id) else { return Ok(()) };
        self.update_drawn(plant, plant.drawing(), document, run)
    }

    /// As [`SceneEvaluator::update`], of a sketch with this drawing in the place of its own.
    ///
    /// # Errors
    /// [`SceneError`].
    pub fn update_drawn(
        &mut self,
        plant: &DocumentPlant,
        drawing: Drawing,
        document: &Document,
        run: &Run<'_>,
    ) -> Result<(), SceneError> {
        let settings = plant.settings();
        let leaf = match settings.maker.leaf() {
            Some(lender) => self.template(lender, document, run)?,
            None => None,
        };
        let (wind, looking) = (self.wind, self.looking);
        let made = self.plants.entry(plant.id()).or_default();
        if made.maker != settings.maker.word() {
            // Of a document in which this number was another plant's.
            *made = Made { maker: settings.maker.word(), revision: made.revision, ..Made::default() };
        }
        (made.sketch.looking, made.tree.looking) = (looking, looking);
        if let Maker::Sketch(s) = &settings.maker {
            let mut options = SketchOptions { leaf, ..SketchOptions::of_plant(plant) };
            options.skin.wind = wind;
            return made.sketched(s, &drawing, &options, settings.seed, run);
        }
        let same = |k: &MadeFrom| {
            (&k.0, k.1, &k.2, &k.3, &k.4)
                == (&settings.maker, settings.seed, &settings.name, &leaf, &settings.edits)
        };
        made.done.clear();
        if made.from.as_ref().is_some_and(same) && (looking || !made.item.digest.is_empty()) {
            return Ok(());
        }
        // Until it has succeeded: an update that is stopped half-way is no result, not even of what was before.
        made.from = None;
        let (name, seed) = (settings.name.as_str(), settings.seed);
        match &settings.maker {
            Maker::Tree(t) => made.grown((name, wind), t, leaf.as_ref(), &settings.edits, seed, run)?,
            Maker::Leaf(l) => made.measured((name, wind), l, seed, run)?,
            Maker::Flower(f) => made.flowered((name, wind), f, &settings.edits, seed, run)?,
            _ => {}
        }
        made.revision += 1;
        made.from = Some((settings.maker.clone(), seed, settings.name.clone(), leaf, settings.edits.clone()));
        Ok(())
    }

    /// The leaf that a plant lends.
    fn template(
        &mut self,
        lender: PlantId,
        document: &Document,
        run: &Run<'_>,
    ) -> Result<Option<LeafTemplate>, SceneError> {
        let Some(plant) = document.plant(lender) else { return Ok(None) };
        let none = || SceneError::Lender(plant.settings().name.clone());
        // A lender bears its own leaf, so this goes one level down.
        self.update(lender, document, run).map_err(|e| if e.is_bare() { none() } else { e })?;
        let Some(made) = self.plants.get_mut(&lender) else { return Ok(None) };
        let lent = match &plant.settings().maker {
            Maker::Leaf(l) if made.lent.is_none() => {
                let (marks, options) = leaf_input(l)?;
                let lent = LeafTemplate::of_marks(&marks, &options, plant.settings().seed, run)?;
                made.lent = Some(lent);
                made.lent.clone()
            }
            Maker::Leaf(_) => made.lent.clone(),
            // As it was drawn: a hand may have taken all leaves away.
            _ => made.sketch.drawn().and_then(LeafTemplate::of_plant),
        };
        lent.map(Some).ok_or_else(none)
    }

    /// A copy of what is kept of plants and of those whose leaves they bear, to try something with.
    pub fn aside<'a>(&self, plants: impl IntoIterator<Item = &'a DocumentPlant>) -> Self {
        let wanted = plants.into_iter().flat_map(|p| [Some(p.id()), p.settings().maker.leaf()]);
        let kept = wanted.flatten().filter_map(|id| Some((id, self.plants.get(&id)?.clone())));
        Self { wind: self.wind, looking: self.looking, plants: kept.collect() }
    }

    /// Forgets a plant: it is made from the beginning when it is asked for again.
    pub fn forget(&mut self, id: PlantId) {
        self.plants.remove(&id);
    }

    /// The plants of which something is kept, and about how many bytes: meshes, textures, and the plant in the stages in
    /// which it is kept for the next change.
    pub fn kept(&self) -> impl Iterator<Item = (PlantId, usize)> + '_ {
        self.plants.iter().map(|(&id, made)| (id, made.bytes()))
    }

    /// What makes the plant, of a sketch.
    pub fn evaluator(&self, id: PlantId) -> Option<&Evaluator> {
        self.plants.get(&id).map(|made| &made.sketch)
    }

    /// The last result of a plant.
    pub fn get(&self, id: PlantId) -> Option<ScenePlant<'_>> {
        let made = self.plants.get(&id)?;
        Some(ScenePlant {
            item: &made.item,
            model: made.model.as_ref().or_else(|| made.sketch.model()).or_else(|| made.tree.model())?,
            plant: made.plant.as_ref().or_else(|| made.sketch.plant()).or_else(|| made.tree.plant()),
            front: made.sketch.front(),
            revision: made.revision,
            stages: &made.done,
        })
    }

    /// A coarser copy of a plant's last result for level `level` (1 to 6; 0 is the result itself), with the materials of
    /// the finest. Trees lose leaves and twigs, others only triangles: about a half with each level, of drawings two
    /// thirds.
    ///
    /// # Errors
    /// [`SceneError`]; [`SceneError::NotMade`] for a plant without a result.
    pub fn at_level(
        &self,
        plant: &DocumentPlant,
        document: &Document,
        level: u32,
        run: &Run<'_>,
    ) -> Result<Model, SceneError> {
        let name = || SceneError::NotMade(plant.settings().name.clone());
        let made = self.plants.get(&plant.id()).ok_or_else(name)?;
        let shown = self.get(plant.id()).ok_or_else(name)?;
        match &plant.settings().maker {
            _ if level == 0 => Ok(shown.model.clone()),
            Maker::Tree(_) => made.tree.at_level(level, run)?.ok_or_else(name),
            Maker::Sketch(sketch) => {
                let mut skin = sketch.skin.clone();
                for _ in 0..level {
                    skin.detail = (skin.detail / 3.0).max(0.1);
                    skin.sides = (skin.sides / 2).max(3);
                }
                let mut editor = Editor::new(document.clone());
                // A mesh that is as coarse as it can be stays as it is.
                if editor.run(SketchCommand::SetSkin(skin).of(plant.id())).is_err() {
                    return Ok(shown.model.clone());
                }
                let mut aside = self.aside([plant]);
                aside.update(plant.id(), editor.document(), run)?;
                aside.get(plant.id()).map(|made| made.model.clone()).ok_or_else(name)
            }
            _ => Ok(coarse(shown.plant.ok_or_else(name)?, &made.skin, shown.model, level, run)?),
        }
    }

    /// The days of a plant whose flowers open: bud to full bloom, and from there to wilted.
    pub fn days(&self, id: PlantId, document: &Document) -> Option<[f64; 2]> {
        match &document.plant(id)?.settings().maker {
            Maker::Sketch(_) => self.plants.get(&id)?.opening.as_ref().map(|o| o.days),
            Maker::Flower(f) => Some(f.settings.spec()?.days()),
            _ => None,
        }
    }
}

impl Made {
    fn bytes(&self) -> usize {
        // As grown, dressed, and twice on the way through the edits by hand.
        const STAGES: usize = 4;
        let models = [self.model.as_ref(), self.sketch.model(), self.tree.model()];
        let plants = [self.sketch.plant(), self.tree.plant()];
        let plant = |p: &Plant| {
            let nodes = p.nodes.position.len() * (size_of::<DVec3>() + size_of::<f64>() + size_of::<u32>());
            nodes + size_of_val(&*p.axes) + size_of_val(&*p.organs)
        };
        models.into_iter().flatten().map(Model::bytes).sum::<usize>()
            + STAGES * plants.into_iter().flatten().map(plant).sum::<usize>()
    }

    fn sketched(
        &mut self,
        settings: &SketchSettings,
        drawing: &Drawing,
        options: &SketchOptions,
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<(), SceneError> {
        let item = self.sketch.update(drawing, options, seed, run)?;
        self.done = self.sketch.stages_done().to_vec();
        let changed = !self.done.is_empty();
        let before = self.from.take();
        if changed {
            self.opening = None;
        }
        // Times are those of the last change that touched the plant.
        if changed || before.is_none() || self.item.digest.is_empty() {
            self.item = item;
        }
        let day_before = before.and_then(|b| if let Maker::Sketch(s) = b.0 { Some(s.day) } else { None });
        let day_changed = day_before.is_none_or(|d| d != settings.day);
        match (settings.day, self.sketch.plant(), self.sketch.model()) {
            (Some(day), Some(plant), Some(model)) => {
                if self.opening.is_none() {
                    let made = (plant, model, &self.item);
                    self.opening = Some(OpeningPlant::of_made(&drawing.name, made, &options.skin)?);
                }
                if let Some(opening) = self.opening.as_mut().filter(|_| changed || day_changed) {
                    let open = opening.at(day, &opening.law(), seed, run)?;
                    (self.plant, self.model) = (Some(open.plant), Some(open.model));
                }
            }
            _ => (self.plant, self.model, self.opening) = (None, None, None),
        }
        if changed || day_changed {
            self.revision += 1;
        }
        let kept = SketchSettings { day: settings.day, ..SketchSettings::default() };
        self.from = Some((Maker::Sketch(Box::new(kept)), seed, String::new(), None, Vec::new()));
        Ok(())
    }

    fn grown(
        &mut self,
        (name, wind): (&str, bool),
        tree: &TreeSettings,
        leaf: Option<&LeafTemplate>,
        edits: &[PlantEdit],
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<(), SceneError> {
        let spec = TreeSpec { name: name.into(), ..tree_spec(tree) };
        let options = TreeOptions {
            skin: SkinSpec { wind, ..tree.skin.clone() },
            leaf: leaf.cloned(),
            edits: edits.to_vec(),
            ..TreeOptions::default()
        };
        self.item = self.tree.update(&spec, seed, &options, run)?;
        self.done = self.tree.stages_done().to_vec();
        Ok(())
    }

    fn measured(
        &mut self,
        (name, wind): (&str, bool),
        leaf: &LeafMaker,
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<(), SceneError> {
        let (marks, mut options) = leaf_input(leaf)?;
        options.skin.wind = wind;
        let made = make_leaf_of(name, &marks, &options, seed, run, Report::default())?;
        self.take(made);
        self.lent = None;
        Ok(())
    }

    fn flowered(
        &mut self,
        (name, wind): (&str, bool),
        flower: &FlowerMaker,
        edits: &[PlantEdit],
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<(), SceneError> {
        let spec =
            flower.settings.spec().ok_or_else(|| SceneError::Species(flower.settings.species.clone()))?;
        let law = flower.law.as_ref().map_or_else(|| spec.own_law(), |l| (**l).clone());
        let mut options = FlowerOptions { edits: edits.to_vec(), ..FlowerOptions::default() };
        options.skin.wind = wind;
        let made = make_flower(name, &spec, (flower.settings.day, &law), &options, seed, run)?;
        self.take(made);
        Ok(())
    }

    fn take(&mut self, made: MadePlant) {
        let MadePlant { plant, model, skin, item } = made;
        (self.item, self.model, self.plant, self.skin) = (item, Some(model), Some(plant), skin);
        self.done.push("mesh");
    }
}

/// The spec of a tree of a document, with its obstacles.
pub fn tree_spec(tree: &TreeSettings) -> TreeSpec {
    let obstacles = tree.obstacles.iter().map(|o| (*o.shape).clone()).collect();
    TreeSpec { obstacles, ..(*tree.spec).clone() }
}

/// What a tree of a document is, from a spec: its obstacles get names.
pub fn tree_settings(spec: &TreeSpec, preset: Option<&str>) -> TreeSettings {
    let obstacles = spec.obstacles.iter().enumerate().map(|(k, shape)| document::NamedObstacle {
        name: format!("obstacle {}", k + 1),
        shape: Arc::new(shape.clone()),
    });
    let obstacles = obstacles.collect();
    let plain = TreeSpec { obstacles: Vec::new(), ..spec.clone() };
    TreeSettings {
        preset: preset.map(Into::into),
        spec: Arc::new(plain),
        obstacles,
        ..TreeSettings::default()
    }
}

/// The JSON Schema of what can be set of a measured leaf.
pub fn leaf_schema() -> &'static serde_json::Value {
    LeafSpec::schema()
}

/// The JSON Schema of what can be set of a flower.
///
/// ```
/// assert_eq!(burgeon::flower_schema()["properties"]["day"]["x-unit"], "d");
/// ```
pub fn flower_schema() -> &'static serde_json::Value {
    FlowerSettings::schema()
}

/// The marks of a leaf of a document, and how it is made.
fn leaf_input(leaf: &LeafMaker) -> Result<(FullMarks, LeafOptions), SceneError> {
    let LeafMaker { data, settings } = leaf;
    let (marks, in_file) = leaf_marks(data, settings.length_m)?;
    let full = marks.complete(&mut Report::default()).map_err(LeafError::from)?;
    let spec = LeafSpec { thickness: settings.thickness.or(in_file), ..settings.clone() };
    Ok((full, LeafOptions { spec, ..LeafOptions::default() }))
}

/// The marks in a file of a leaf, and what its thickness is if it says so. `length_m`: of a vein graph in pixels.
///
/// # Errors
/// [`SceneError`]: what is wrong with it; [`SceneError::NoMarks`] for no text.
pub fn leaf_marks(
    data: &LeafData,
    length_m: f64,
) -> Result<(leaf::Marks, Option<ThicknessRule>), SceneError> {
    let text = data.text.trim_start();
    if text.is_empty() {
        return Err(SceneError::NoMarks);
    }
    if text.starts_with('{') {
        let read = read_vein_graph(data.text.as_bytes())?;
        let marks = read.graph.marks(&mut Report::default())?;
        let length = marks.length();
        let in_pixels = read.unit.is_none() && length > 0.0;
        return Ok((if in_pixels { marks.scaled(length_m / length) } else { marks }, None));
    }
    let read = read_marks(data.text.as_bytes(), &data.name, MarksAxes::default())?;
    Ok((read.marks, read.thickness))
}

/// The models of a scene as one, each where it stands. Parts carry the name of their plant where there are several.
///
/// Guaranteed: the model itself, bit for bit, of one plant that stands at the origin.
pub fn scene_model<'a>(name: &str, plants: impl IntoIterator<Item = (Placement, &'a Model)>) -> Model {
    let plants: Vec<(Placement, &Model)> = plants.into_iter().collect();
    if let [(placement, model)] = plants.as_slice()
        && *placement == Placement::default()
    {
        return Model { name: name.into(), ..(*model).clone() };
    }
    let mut whole = Model { name: name.into(), ..Model::default() };
    for (k, (placement, model)) in plants.iter().enumerate() {
        let first = whole.materials.len();
        let own = |what: &str| {
            if plants.len() > 1 { format!("{}-{}-{what}", k + 1, model.name) } else { what.to_owned() }
        };
        whole.materials.extend(model.materials.iter().map(|m| {
            let mut m = m.clone();
            m.name = own(&m.name);
            m
        }));
        let (s, c) = base::ops::sin_cos(0.5 * placement.yaw_deg * (base::ops::PI / 180.0));
        let turn = DQuat::from_xyzw(0.0, s, 0.0, c);
        for part in &model.parts {
            let mut part = part.clone();
            for p in part.mesh.positions.iter_mut().chain(&mut part.mesh.pivots) {
                let at = turn * (DVec3::from_array(p.map(f64::from)) * placement.scale) + placement.position;
                *p = at.as_vec3().to_array();
            }
            for n in &mut part.mesh.normals {
                *n = (turn * DVec3::from_array(n.map(f64::from))).as_vec3().to_array();
            }
            part.name = own(&part.name);
            part.material = MaterialId::new(first + part.material.index());
            whole.parts.push(part);
        }
    }
    whole
}
