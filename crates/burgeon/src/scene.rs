//! A scene of plants -> one model for each, made again only where something changed.
//!
//! `Document -> SceneEvaluator (one evaluator for each plant) -> models, reports | scene_model -> one model`

mod error;

use std::ops::Range;
use std::sync::Arc;

use base::{Cancelled, Report, Run, Seed};
use document::{
    Document, DocumentPlant, FlowerMaker, LeafData, LeafMaker, Maker, PlantEdit, PlantId, Settings,
    SketchSettings, TreeSettings,
};
use formats::{MarksAxes, is_rays, read_marks, read_rays, read_vein_graph};
use glam::{DQuat, DVec3};
use growth::TreeSpec;
use ink::{Stroke, StrokeClass};
use leaf::{FullMarks, LeafSpec, Rays, ThicknessRule};
use mesh::{Copies, Model, Standing};
use plant::{AxisId, Plant};
use skin::{FoliageStyle, Layout, SkinSpec, Worn};

pub use self::error::SceneError;
use crate::evaluate::{Evaluator, FrontView};
use crate::flowers::{FlowerOptions, make_flower, untold_flower};
use crate::leaves::{LeafOptions, make_leaf_of};
use crate::levels::{LevelSpec, Levels};
use crate::made::{MadePlant, coarse, digest};
use crate::make::{SketchOptions, worn};
use crate::opening::OpeningPlant;
use crate::report::ItemReport;
use crate::trees::{TreeEvaluator, TreeOptions};
use crate::venation::make_ray_leaf;
use makers::{LeafError, LeafTemplate};

/// Results of one plant.
#[derive(Clone, Copy, Debug)]
pub struct ScenePlant<'a> {
    name: &'a str,
    item: &'a ItemReport,
    /// The meshes, in the plant's own coordinates.
    pub model: &'a Model,
    /// The plant; `None` after an update that was stopped.
    pub plant: Option<&'a Plant>,
    /// Places of the plant's parts in the model, for plants of which a branch can be moved alone.
    pub layout: Option<&'a Layout>,
    /// Places of the plant's parts in the model, for any plant.
    pub owners: Option<&'a Layout>,
    /// Placement of a drawing in the front view.
    pub front: Option<FrontView>,
    /// Number of the model within the evaluator: shared by copies that share a model, and otherwise unique.
    pub revision: u64,
    /// Stages that the last update recomputed.
    pub stages: &'a [&'static str],
}

/// A plant at a level of detail.
#[derive(Clone, Debug)]
pub struct PlantLevel {
    /// Its meshes.
    pub model: Model,
    /// The coarser plant, and the places of its parts in the meshes.
    laid_out: Option<(Plant, Layout)>,
}

impl PlantLevel {
    /// Returns the model without leaves of one form, and these ([`skin::copies`]). `None` where the places of the parts
    /// are unknown.
    pub fn copies(&self) -> Option<(Model, Vec<Copies>)> {
        let (plant, layout) = self.laid_out.as_ref()?;
        Some(skin::copies(plant, &self.model, layout))
    }

    /// Returns the triangles of a branch of `plant`, which this is a level of, and of all that it bears, in the form of
    /// [`Layout::branch`]. `None` where they are unknown, or the branch is too fine for the level.
    pub fn branch(&self, plant: &Plant, axis: AxisId) -> Option<Vec<Vec<Range<u32>>>> {
        let (coarse, layout) = self.laid_out.as_ref()?;
        let wanted = plant.axes.get(axis.index())?;
        let foot = plant.axis_points(axis).first()?;
        let same = |row: &usize| {
            let (id, own) = (AxisId::new(*row), &coarse.axes[*row]);
            (own.key, own.kind) == (wanted.key, wanted.kind) && coarse.axis_points(id).first() == Some(foot)
        };
        let row = (0..coarse.axes.len()).find(same)?;
        layout.branch(coarse, AxisId::new(row))
    }
}

impl ScenePlant<'_> {
    /// Returns the entry of the report.
    pub fn report(&self) -> ItemReport {
        ItemReport { name: self.name.to_owned(), ..self.item.clone() }
    }
}

/// Makes the plants of a document that changes; each keeps the results that its last change did not affect.
///
/// Guaranteed: the same result as from a fresh evaluator; after an error the last result of the plant stays. The place
/// of a plant, its position in lists and whether it is hidden do not cause an update. Plants of the same maker, seed
/// and edits are made once and share the result until one of them changes; the name of a tree does not matter for this.
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
    surface: Surface,
    previewing: bool,
    later: bool,
    plants: base::LiteMap<PlantId, Kept>,
    /// The last number that a model was given.
    revision: u64,
}

/// Choices of an export for the surfaces of all plants.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Surface {
    wind: bool,
    foliage: Option<FoliageStyle>,
    texture_size: Option<u32>,
}

impl Surface {
    /// Returns settings of a surface with these choices.
    fn on(self, skin: SkinSpec) -> SkinSpec {
        SkinSpec {
            wind: self.wind,
            foliage: self.foliage.unwrap_or(skin.foliage),
            texture_size: self.texture_size.unwrap_or(skin.texture_size),
            ..skin
        }
    }
}

/// State kept for one plant.
#[derive(Clone, Debug, Default)]
struct Kept {
    name: String,
    /// Results, shared with copies.
    made: Arc<Made>,
    /// Stages that the last update recomputed.
    done: Vec<&'static str>,
}

/// Inputs of a result.
#[derive(Clone, Debug, PartialEq)]
struct MadeFrom {
    maker: Maker,
    seed: Seed,
    /// Name in plants and models of all makers but trees, which are named by their spec.
    name: String,
    leaf: Option<LeafTemplate>,
    edits: Vec<PlantEdit>,
    strokes: Vec<(Arc<Stroke>, [Option<StrokeClass>; 2])>,
    /// Names of hidden layers.
    hidden: Vec<Arc<str>>,
    worn: Worn,
    surface: Surface,
}

impl MadeFrom {
    fn from_plant(plant: &DocumentPlant, leaf: Option<LeafTemplate>, surface: Surface) -> Self {
        let settings = plant.settings();
        let grown = matches!(settings.maker, Maker::Tree(_));
        Self {
            maker: settings.maker.clone(),
            seed: settings.seed,
            name: if grown { String::new() } else { settings.name.clone() },
            leaf,
            edits: settings.edits.clone(),
            strokes: plant.strokes().iter().map(|s| (Arc::clone(&s.stroke), [s.class, s.shown])).collect(),
            hidden: plant.layers().iter().filter(|l| l.hidden).map(|l| Arc::clone(&l.name)).collect(),
            worn: worn(plant),
            surface,
        }
    }

    fn tree_options(&self, tree: &TreeSettings) -> TreeOptions {
        TreeOptions {
            skin: SkinSpec { worn: self.worn.clone(), ..self.surface.on(tree.skin.clone()) },
            height_m: tree.height_m,
            leaf: self.leaf.clone(),
            edits: self.edits.clone(),
            obstacles: tree.obstacles.iter().map(|o| o.name.clone()).collect(),
            ..TreeOptions::default()
        }
    }
}

/// The last result of a plant.
#[derive(Clone, Debug, Default)]
struct Made {
    /// The word of its maker.
    maker: &'static str,
    /// Inputs of the result; `None` after an update that was stopped half-way.
    from: Option<MadeFrom>,
    sketch: Evaluator,
    tree: TreeEvaluator,
    opening: Option<OpeningPlant>,
    /// The day to which a sketch's flowers were last opened.
    day: Option<f64>,
    item: ItemReport,
    /// Model of leaves and flowers, and of sketches whose flowers open.
    model: Option<Model>,
    /// Places of the plant's parts in the model.
    layout: Option<Layout>,
    /// Plant of leaves, flowers and sketches whose flowers open.
    plant: Option<Plant>,
    /// Skin settings of leaves and flowers.
    skin: SkinSpec,
    lent: Option<LeafTemplate>,
    revision: u64,
    /// See [`SceneEvaluator::set_measuring_later`].
    later: bool,
}

impl Kept {
    /// Returns the results to update, and whether the last update was left half-way.
    ///
    /// Until an update has succeeded, they are no result, not even the previous one.
    fn begin(&mut self, plant: &DocumentPlant, (previewing, later): (bool, bool)) -> (&mut Made, bool) {
        let word = plant.settings().maker.word();
        let made = Arc::make_mut(&mut self.made);
        if made.maker != word {
            // In the previous document this number belonged to another plant.
            *made = Made { maker: word, ..Made::default() };
        }
        (made.sketch.previewing, made.tree.previewing) = (previewing, previewing);
        (made.later, made.sketch.later) = (later, later);
        let before = made.from.take();
        (made, before.is_none())
    }
}

impl SceneEvaluator {
    /// Sets whether models have wind columns, from the next update on. Default: no.
    pub fn set_wind(&mut self, wind: bool) {
        self.surface.wind = wind;
    }

    /// Sets how the leaves of all plants are drawn, from the next update on. Default: as each plant has it.
    pub fn set_foliage(&mut self, foliage: Option<FoliageStyle>) {
        self.surface.foliage = foliage;
    }

    /// Sets the pixels of a side of the textures of all plants (64 to 4096, see [`SkinSpec::texture_size`]), from the next
    /// update on. Default: as each plant has it.
    pub fn set_texture_size(&mut self, size: Option<u32>) {
        self.surface.texture_size = size;
    }

    /// Sets whether updates are previews while somebody shapes: reports of trees and drawings then have no digest,
    /// which takes a third of the time of a large tree's meshes. Default: no.
    pub fn set_previewing(&mut self, previewing: bool) {
        self.previewing = previewing;
    }

    /// Sets whether reports omit what takes as long as the plant until [`Self::measure`] is called: the fidelity of a
    /// plant to a drawing of very many strokes, and the digest and the measures of a flower. Default: no.
    pub fn set_measuring_later(&mut self, later: bool) {
        self.later = later;
    }

    /// Adds to the report of a plant what an update left for later. Returns whether there was anything.
    ///
    /// # Errors
    /// [`Cancelled`]; it is still left for later then.
    pub fn measure(&mut self, id: PlantId, run: &Run<'_>) -> Result<bool, Cancelled> {
        let Some(kept) = self.plants.get(&id) else { return Ok(false) };
        if kept.made.is_untold() {
            let untold = Arc::clone(&kept.made);
            self.tell(untold);
            return Ok(true);
        }
        if !kept.made.sketch.is_unmeasured() {
            return Ok(false);
        }
        let Some(kept) = self.plants.get_mut(&id) else { return Ok(false) };
        let made = Arc::make_mut(&mut kept.made);
        let found = made.sketch.measure(run)?;
        if let Some(fidelity) = found {
            made.item.fidelity = fidelity;
        }
        Ok(found.is_some())
    }

    /// Completes the report of a flower, for all copies, which continue to share it.
    fn tell(&mut self, untold: Arc<Made>) {
        let copies: Vec<PlantId> =
            self.plants.iter().filter(|(_, k)| Arc::ptr_eq(&k.made, &untold)).map(|(id, _)| *id).collect();
        for id in &copies {
            self.plants.entry(*id).or_default().made = Arc::default();
        }
        let mut told = untold;
        let made = Arc::make_mut(&mut told);
        made.item.digest = made.model.as_ref().map_or_else(String::new, digest);
        made.item.plant = made.plant.as_ref().map(Plant::measure);
        for id in copies {
            self.plants.entry(id).or_default().made = Arc::clone(&told);
        }
    }

    /// Updates one plant, and the plant whose leaf it bears.
    ///
    /// # Errors
    /// [`SceneError`]; a plant that is not in the document is left unchanged.
    pub fn update(&mut self, id: PlantId, document: &Document, run: &Run<'_>) -> Result<(), SceneError> {
        let Some(plant) = document.plant(id) else { return Ok(()) };
        let Some(from) = self.wanted(plant, document, run)? else { return Ok(()) };
        let (next, kept) = (self.revision + 1, self.plants.entry(id).or_default());
        let (made, anew) = kept.begin(plant, (self.previewing, self.later));
        let done = made.update(plant, from, anew, run)?;
        // A drawing in which only the opacity of its photograph changed keeps its model.
        if !done.is_empty() {
            made.revision = next;
            self.revision = next;
        }
        kept.done = done;
        Ok(())
    }

    /// Returns a much coarser model, without textures, of the plant that [`Self::update`] will make: for large trees
    /// that have to be grown, which takes a while. It is not a result: nothing but the page ever sees it.
    ///
    /// # Errors
    /// [`SceneError`]; `None` for a plant that is not in the document.
    pub fn preview(
        &mut self,
        id: PlantId,
        document: &Document,
        run: &Run<'_>,
    ) -> Result<Option<Model>, SceneError> {
        let Some(plant) = document.plant(id) else { return Ok(None) };
        let Maker::Tree(tree) = &plant.settings().maker else { return Ok(None) };
        let Some(from) = self.wanted(plant, document, run)? else { return Ok(None) };
        let (made, _) = self.plants.entry(id).or_default().begin(plant, (self.previewing, self.later));
        Ok(made.tree.preview(&tree_spec(tree), from.seed, &from.tree_options(tree), run)?)
    }

    /// Returns the inputs of a plant; `None` where it is already made, itself or as one like it.
    fn wanted(
        &mut self,
        plant: &DocumentPlant,
        document: &Document,
        run: &Run<'_>,
    ) -> Result<Option<MadeFrom>, SceneError> {
        let (id, settings) = (plant.id(), plant.settings());
        let leaf = match settings.maker.leaf() {
            Some(lender) => self.template(lender, document, run)?,
            None => None,
        };
        let previewing = self.previewing;
        let from = MadeFrom::from_plant(plant, leaf, self.surface);
        let is_it = |k: &Kept| {
            let whole = previewing || !k.made.item.digest.is_empty() || k.made.is_untold();
            k.made.from.as_ref() == Some(&from) && whole
        };
        let own = self.plants.get(&id).is_some_and(is_it);
        let same = if own { None } else { self.plants.values().find(|k| is_it(k)) };
        let same = same.map(|k| Arc::clone(&k.made));
        let kept = self.plants.entry(id).or_default();
        kept.name.clone_from(&settings.name);
        kept.done.clear();
        let known = own || same.is_some();
        if let Some(same) = same {
            kept.made = same;
        }
        Ok((!known).then_some(from))
    }

    /// Returns the leaf that a plant lends.
    fn template(
        &mut self,
        lender: PlantId,
        document: &Document,
        run: &Run<'_>,
    ) -> Result<Option<LeafTemplate>, SceneError> {
        let Some(plant) = document.plant(lender) else { return Ok(None) };
        let none = || SceneError::Lender(plant.settings().name.clone());
        // A lender bears its own leaf, so this recurses only one level.
        self.update(lender, document, run).map_err(|e| if e.is_bare() { none() } else { e })?;
        let Some(kept) = self.plants.get_mut(&lender) else { return Ok(None) };
        let made = &mut kept.made;
        let lent = match &plant.settings().maker {
            Maker::Leaf(l) if made.lent.is_none() => {
                let (input, options) = leaf_input(l)?;
                let lent = match &input {
                    LeafInput::Marks(marks) => {
                        LeafTemplate::from_marks(marks, &options.look(), plant.settings().seed, run)?
                    }
                    LeafInput::Rays(rays) => match LeafTemplate::from_rays(rays, &options.look(), run)? {
                        Ok(lent) => lent,
                        Err(_) => return Err(none()),
                    },
                };
                Arc::make_mut(made).lent = Some(lent.clone());
                Some(lent)
            }
            Maker::Leaf(_) => made.lent.clone(),
            // The leaf as it was drawn: hand edits may have removed all leaves.
            _ => made.sketch.drawn().and_then(LeafTemplate::from_plant),
        };
        lent.map(Some).ok_or_else(none)
    }

    /// Copies the state of plants and of those whose leaves they bear, for trials.
    pub fn aside<'a>(&self, plants: impl IntoIterator<Item = &'a DocumentPlant>) -> Self {
        let wanted = plants.into_iter().flat_map(|p| [Some(p.id()), p.settings().maker.leaf()]);
        let kept = wanted.flatten().filter_map(|id| Some((id, self.plants.get(&id)?.clone())));
        Self { plants: base::map_of(kept), ..*self }
    }

    /// Drops the state of a plant: it is made from the beginning when it is next requested.
    pub fn forget(&mut self, id: PlantId) {
        self.plants.remove(&id);
    }

    /// Returns the plants with kept results, and roughly how many bytes these take: meshes, textures, and the plant in
    /// the stages kept for the next change. Shared results count for the first of the copies.
    pub fn kept(&self) -> impl Iterator<Item = (PlantId, usize)> + '_ {
        let mut counted = base::Set::new();
        self.plants.iter().map(move |(&id, kept)| {
            let first = counted.insert(Arc::as_ptr(&kept.made), ()).is_none();
            (id, if first { kept.made.bytes() } else { 0 })
        })
    }

    /// Returns the evaluator of a sketch.
    pub fn evaluator(&self, id: PlantId) -> Option<&Evaluator> {
        self.plants.get(&id).map(|kept| &kept.made.sketch)
    }

    /// Returns the last result of a plant.
    pub fn get(&self, id: PlantId) -> Option<ScenePlant<'_>> {
        let Kept { name, made, done } = self.plants.get(&id)?;
        Some(ScenePlant {
            name,
            item: &made.item,
            model: made.model.as_ref().or_else(|| made.sketch.model()).or_else(|| made.tree.model())?,
            plant: made.plant.as_ref().or_else(|| made.sketch.plant()).or_else(|| made.tree.plant()),
            layout: if made.model.is_some() {
                None
            } else {
                made.sketch.layout().or_else(|| made.tree.layout())
            },
            owners: made.layout.as_ref().or_else(|| made.sketch.layout()).or_else(|| made.tree.layout()),
            front: made.sketch.front(),
            revision: made.revision,
            stages: done,
        })
    }

    /// Returns a coarser copy of a plant's last result for level `level` (1 to 6; 0 is the result itself), with the
    /// materials of the finest. Plants of hundreds of leaves or axes lose leaves and twigs, others only triangles: at
    /// least a half with each level.
    ///
    /// # Errors
    /// [`SceneError`]; [`SceneError::NotMade`] for a plant without a result.
    pub fn at_level(&self, plant: &DocumentPlant, level: u32, run: &Run<'_>) -> Result<Model, SceneError> {
        Ok(self.level(plant, level, run)?.model)
    }

    /// Returns coarser copies of a plant's last result and the other levels of `spec`.
    ///
    /// # Errors
    /// As [`Self::at_level`].
    pub fn levels(
        &self,
        plant: &DocumentPlant,
        spec: &LevelSpec,
        run: &Run<'_>,
    ) -> Result<Levels, SceneError> {
        let name = || SceneError::NotMade(plant.settings().name.clone());
        let shown = self.get(plant.id()).ok_or_else(name)?;
        let (whole, layout) = shown.plant.zip(shown.owners).ok_or_else(name)?;
        let at = |level| {
            let PlantLevel { model, laid_out } = self.level(plant, level, run)?;
            Ok(laid_out.map(|laid_out| (model, laid_out)))
        };
        Levels::new(spec, (shown.model, whole, layout), at, run)
    }

    /// Returns a level as [`Self::at_level`] does, and the places of the plant's parts in the model, where they are
    /// known.
    ///
    /// # Errors
    /// As [`Self::at_level`].
    pub fn level(&self, plant: &DocumentPlant, level: u32, run: &Run<'_>) -> Result<PlantLevel, SceneError> {
        let bare = |model| PlantLevel { model, laid_out: None };
        let name = || SceneError::NotMade(plant.settings().name.clone());
        let made = &self.plants.get(&plant.id()).ok_or_else(name)?.made;
        let shown = self.get(plant.id()).ok_or_else(name)?;
        match &plant.settings().maker {
            _ if level == 0 => Ok(bare(shown.model.clone())),
            Maker::Tree(_) => {
                let (model, laid_out) = made.tree.laid_out_at(level, run)?.ok_or_else(name)?;
                Ok(PlantLevel { model, laid_out: Some(laid_out) })
            }
            Maker::Sketch(_) => {
                let opened = made.opening.as_ref().filter(|_| made.model.is_some()).zip(shown.plant);
                let (model, laid_out) = match opened {
                    Some((opening, plant)) => opening.coarse((plant, shown.model), level, run)?,
                    None => made.sketch.laid_out_at(level, run)?.ok_or_else(name)?,
                };
                Ok(PlantLevel { model, laid_out: Some(laid_out) })
            }
            _ => {
                let plant = shown.plant.ok_or_else(name)?;
                let (model, laid_out) = coarse(plant, &made.skin, shown.model, level, run)?;
                Ok(PlantLevel { model, laid_out: Some(laid_out) })
            }
        }
    }

    /// Returns the days of a plant whose flowers open: from bud to full bloom, and from there to wilted.
    pub fn days(&self, id: PlantId, document: &Document) -> Option<[f64; 2]> {
        match &document.plant(id)?.settings().maker {
            Maker::Sketch(_) => self.plants.get(&id)?.made.opening.as_ref().map(|o| o.days),
            Maker::Flower(f) => Some(f.spec.days()),
            _ => None,
        }
    }
}

impl Made {
    /// Whether it is a flower whose report is incomplete.
    fn is_untold(&self) -> bool {
        let flower = matches!(self.from.as_ref().map(|f| &f.maker), Some(Maker::Flower(_)));
        self.later && flower && self.item.digest.is_empty()
    }

    fn bytes(&self) -> usize {
        // As grown, with its look, and twice in the course of the hand edits.
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

    /// Makes the plant and returns the stages that were recomputed. `anew`: the last update was stopped, or there was
    /// none.
    fn update(
        &mut self,
        plant: &DocumentPlant,
        from: MadeFrom,
        anew: bool,
        run: &Run<'_>,
    ) -> Result<Vec<&'static str>, SceneError> {
        let done = match &from.maker {
            Maker::Sketch(s) => self.sketched(plant, s, &from, anew, run)?,
            Maker::Tree(t) => self.grown(t, &from, run)?,
            Maker::Leaf(l) => self.measured(l, &from, run)?,
            Maker::Flower(f) => self.flowered(f, &from, run)?,
            _ => Vec::new(),
        };
        self.from = Some(from);
        Ok(done)
    }

    fn sketched(
        &mut self,
        plant: &DocumentPlant,
        settings: &SketchSettings,
        from: &MadeFrom,
        anew: bool,
        run: &Run<'_>,
    ) -> Result<Vec<&'static str>, SceneError> {
        let mut options = SketchOptions { leaf: from.leaf.clone(), ..SketchOptions::from_plant(plant) };
        options.skin = from.surface.on(options.skin);
        let drawing = plant.drawing();
        let item = self.sketch.update(&drawing, &options, from.seed, run)?;
        let mut done = self.sketch.stages_done().to_vec();
        let changed = !done.is_empty();
        if changed {
            self.opening = None;
        }
        // Times are those of the last change that affected the plant.
        if changed || anew || self.item.digest.is_empty() {
            self.item = item;
        }
        let opened = anew || self.day != settings.day;
        match (settings.day, self.sketch.plant()) {
            (Some(day), Some(plant)) => {
                if self.opening.is_none() {
                    let made = (plant, &self.item);
                    self.opening = Some(OpeningPlant::from_made(&drawing.name, made, &options.skin)?);
                }
                if let Some(opening) = self.opening.as_mut().filter(|_| changed || opened) {
                    let open = opening.make_on_day(day, &opening.law(), from.seed, run)?;
                    (self.plant, self.model) = (Some(open.plant), Some(open.model));
                    self.layout = Some(open.layout);
                }
            }
            _ => (self.plant, self.model, self.layout, self.opening) = (None, None, None, None),
        }
        self.day = settings.day;
        if opened && !changed {
            done.push("mesh");
        }
        Ok(done)
    }

    fn grown(
        &mut self,
        tree: &TreeSettings,
        from: &MadeFrom,
        run: &Run<'_>,
    ) -> Result<Vec<&'static str>, SceneError> {
        self.item = self.tree.update(&tree_spec(tree), from.seed, &from.tree_options(tree), run)?;
        Ok(self.tree.stages_done().to_vec())
    }

    fn measured(
        &mut self,
        leaf: &LeafMaker,
        from: &MadeFrom,
        run: &Run<'_>,
    ) -> Result<Vec<&'static str>, SceneError> {
        let (input, mut options) = leaf_input(leaf)?;
        options.skin = from.surface.on(options.skin);
        options.skin.worn.clone_from(&from.worn);
        let made = match &input {
            LeafInput::Marks(marks) => {
                make_leaf_of(&from.name, marks, &options, from.seed, run, Report::default())?
            }
            LeafInput::Rays(rays) => make_ray_leaf(&from.name, rays, &options, run)?,
        };
        self.lent = None;
        Ok(self.take(made))
    }

    fn flowered(
        &mut self,
        flower: &FlowerMaker,
        from: &MadeFrom,
        run: &Run<'_>,
    ) -> Result<Vec<&'static str>, SceneError> {
        let law = flower.law.as_ref().map_or_else(|| flower.spec.own_law(), |l| (**l).clone());
        let mut options = FlowerOptions { edits: from.edits.clone(), ..FlowerOptions::default() };
        options.skin = from.surface.on(options.skin);
        options.skin.worn.clone_from(&from.worn);
        let make = if self.later { untold_flower } else { make_flower };
        let made = make(&from.name, &flower.spec, (flower.day, &law), &options, from.seed, run)?;
        Ok(self.take(made))
    }

    fn take(&mut self, made: MadePlant) -> Vec<&'static str> {
        let MadePlant { plant, model, layout, skin, item } = made;
        (self.item, self.model, self.plant, self.skin) = (item, Some(model), Some(plant), skin);
        self.layout = Some(layout);
        vec!["mesh"]
    }
}

/// Returns the spec of a tree of a document, with its obstacles.
pub fn tree_spec(tree: &TreeSettings) -> TreeSpec {
    let obstacles = tree.obstacles.iter().map(|o| (*o.shape).clone()).collect();
    TreeSpec { obstacles, ..(*tree.spec).clone() }
}

/// Returns the settings of a tree of a document from a spec: its obstacles get names.
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

/// Measurements of a leaf.
pub(crate) enum LeafInput {
    /// Marks along its midrib, veins and margins.
    Marks(FullMarks),
    /// Chief veins that start together.
    Rays(Rays),
}

/// Returns the measurements of a leaf of a document, and the options for making it.
pub(crate) fn leaf_input(leaf: &LeafMaker) -> Result<(LeafInput, LeafOptions), SceneError> {
    let LeafMaker { data, settings } = leaf;
    if is_rays(data.text.as_bytes()) {
        let read = read_rays(data.text.as_bytes(), &data.name, MarksAxes::default())?;
        let spec = LeafSpec { thickness: settings.thickness.or(read.thickness), ..settings.clone() };
        return Ok((LeafInput::Rays(read.rays), LeafOptions { spec, ..LeafOptions::default() }));
    }
    let (marks, in_file) = leaf_marks(data, settings)?;
    let full = marks.complete(&mut Report::default()).map_err(LeafError::from)?;
    let spec = LeafSpec { thickness: settings.thickness.or(in_file), ..settings.clone() };
    Ok((LeafInput::Marks(full), LeafOptions { spec, ..LeafOptions::default() }))
}

/// Returns the marks in a file of a leaf, and its thickness if the file gives it; without a text, those of the form
/// that is set.
///
/// # Errors
/// [`SceneError`]: the fault of the file.
pub fn leaf_marks(
    data: &LeafData,
    settings: &LeafSpec,
) -> Result<(leaf::Marks, Option<ThicknessRule>), SceneError> {
    let text = data.text.trim_start();
    if text.is_empty() {
        return Ok((settings.form.marks(), Some(ThicknessRule::Diameter)));
    }
    if text.starts_with('{') {
        let read = read_vein_graph(data.text.as_bytes())?;
        let marks = read.graph.marks(&mut Report::default())?;
        let length = marks.length();
        let in_pixels = read.unit.is_none() && length > 0.0;
        return Ok((if in_pixels { marks.scaled(settings.length_m / length) } else { marks }, None));
    }
    let read = read_marks(data.text.as_bytes(), &data.name, MarksAxes::default())?;
    Ok((read.marks, read.thickness))
}

/// Returns a plant of a scene in its place.
pub fn standing<'a>(plant: &'a DocumentPlant, model: &'a Model) -> Standing<'a> {
    let Settings { name, placement, .. } = plant.settings();
    standing_at(name, model, placement)
}

/// Returns a model at a place.
pub fn standing_at<'a>(name: &'a str, model: &'a Model, placement: &document::Placement) -> Standing<'a> {
    let (s, c) = base::ops::sin_cos(0.5 * placement.yaw_deg * (base::ops::PI / 180.0));
    let turn = DQuat::from_xyzw(0.0, s, 0.0, c);
    Standing { name, model, position: placement.position, turn, scale: placement.scale }
}
