//! The document: a scene of plants, each with the description for its maker.

use std::collections::BTreeSet;
use std::sync::Arc;

use base::Seed;
use glam::{DVec2, DVec3};
use ink::{Drawing, Layer, Stroke, StrokeClass};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shape::HandEdit;
use skin::{OrganMaterial, Pattern, StrokeWear, Wear};

use crate::fault::{MAX_EDITS, MAX_PICTURES};
use crate::ids::{PlantId, PlantNumbers, StrokeId};
use crate::names::{NAME_LENGTH, shortened, too_long};
use crate::picture::material_fault;
use crate::{Maker, Photo, SettingFault, SketchSettings, WornPictures};

/// One stroke of a sketch.
#[derive(Clone, Debug, PartialEq)]
pub struct DocumentStroke {
    /// Its name, unique in the whole document.
    pub id: StrokeId,
    /// The line as drawn; finite points, shared with the undo history.
    pub stroke: Arc<Stroke>,
    /// The class that the user set; `None` leaves it to the classifier.
    pub class: Option<StrokeClass>,
    /// The class that the user was clearly shown when the last stroke was drawn: the stroke is not reclassified without
    /// clear evidence. `None` for strokes from a file.
    pub shown: Option<StrokeClass>,
    /// The material of the leaves and petals of this stroke; `None` takes that of the plant.
    pub material: Option<Arc<OrganMaterial>>,
}

/// Place of a plant: scaled, turned about the vertical, then moved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Placement {
    /// Position of its origin, metres; each coordinate up to 100 km.
    #[schemars(with = "[f64; 3]")]
    pub position: DVec3,
    /// Turn about +Y, degrees, counter-clockwise seen from above. Default 0.
    pub yaw_deg: f64,
    /// Size, 0.001 to 1,000. Default 1.
    pub scale: f64,
}

impl Default for Placement {
    fn default() -> Self {
        Self { position: DVec3::ZERO, yaw_deg: 0.0, scale: 1.0 }
    }
}

impl Placement {
    fn fault(&self) -> Option<SettingFault> {
        let near = self.position.abs().max_element() <= 1e5 && self.position.is_finite();
        let sound = near && self.yaw_deg.abs() <= 1e6 && (1e-3..=1e3).contains(&self.scale);
        (!sound).then_some(SettingFault::Place)
    }
}

/// All data of a plant except its strokes.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Name of the plant, for files and reports. At most 200 characters.
    pub name: String,
    /// Seed of all random choices. Default 1.
    pub seed: Seed,
    /// Whether dice leave the seed alone. Default false.
    pub locked: bool,
    /// Whether the plant's place is locked. Default false.
    pub fixed: bool,
    /// Whether the plant is left out of the view and of exports of the scene. Default false.
    pub hidden: bool,
    /// The group it belongs to, by name; empty for none. At most 200 characters.
    pub group: String,
    /// Its place in the scene.
    pub placement: Placement,
    /// The materials of its organs by their kinds; `strokes` is empty, as strokes store their own.
    pub wear: Wear,
    /// The pictures that its materials name, at most 16.
    pub pictures: WornPictures,
    /// Its maker with its settings.
    pub maker: Maker,
    /// Hand edits, in the order in which they are applied; only for sketches and trees, at most 1,000.
    pub edits: Vec<PlantEdit>,
}

/// A hand edit that is stored with a plant.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantEdit {
    /// The edit; shared with the undo history.
    pub edit: Arc<HandEdit>,
    /// Whether the edit is switched off. Default false.
    pub off: bool,
}

impl From<HandEdit> for PlantEdit {
    fn from(edit: HandEdit) -> Self {
        Self { edit: Arc::new(edit), off: false }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            name: "plant".into(),
            seed: Seed::default(),
            locked: false,
            fixed: false,
            hidden: false,
            group: String::new(),
            placement: Placement::default(),
            wear: Wear::default(),
            pictures: WornPictures::new(),
            maker: Maker::default(),
            edits: Vec::new(),
        }
    }
}

impl Settings {
    fn edits_fault(&self) -> Option<SettingFault> {
        if !self.edits.is_empty() && !self.maker.branches() {
            return Some(SettingFault::NoBranches { maker: self.maker.word() });
        }
        if self.edits.len() > MAX_EDITS {
            return Some(SettingFault::Edits);
        }
        let fault = |(row, e): (usize, &PlantEdit)| Some((row, e.edit.check().err()?));
        let (row, why) = self.edits.iter().enumerate().find_map(fault)?;
        Some(SettingFault::Edit { row, why: why.to_string() })
    }

    /// Drops pictures that no material names; `strokes`: the materials of strokes.
    pub(crate) fn keep_pictures<'a>(&mut self, strokes: impl Iterator<Item = &'a OrganMaterial>) {
        let named = |m: &OrganMaterial| m.picture.clone();
        let worn = self.wear.materials().filter_map(named).chain(strokes.filter_map(named));
        let worn = base::set_of(worn);
        self.pictures.retain(|name, _| worn.contains_key(name));
    }

    fn wear_fault(&self) -> Option<SettingFault> {
        if self.pictures.len() > MAX_PICTURES {
            return Some(SettingFault::Pictures);
        }
        self.wear.materials().find_map(|m| material_fault(m, &self.pictures))
    }

    /// Returns the settings of a sketch; `None` for other makers.
    pub fn sketch(&self) -> Option<&SketchSettings> {
        if let Maker::Sketch(s) = &self.maker { Some(s) } else { None }
    }

    /// Returns the photograph under a sketch.
    pub fn photo(&self) -> Option<&Photo> {
        self.sketch()?.photo.as_ref()
    }
}

/// One plant of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct DocumentPlant {
    pub(crate) id: PlantId,
    pub(crate) settings: Settings,
    pub(crate) strokes: Vec<DocumentStroke>,
}

impl DocumentPlant {
    /// Returns its number within the document.
    pub fn id(&self) -> PlantId {
        self.id
    }

    /// Returns all its data except the strokes.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Returns the strokes of a sketch in the order in which they were drawn; empty for other makers.
    pub fn strokes(&self) -> &[DocumentStroke] {
        &self.strokes
    }

    /// Returns the strokes as the sketch maker takes them; row `i` is `strokes()[i]`. Cost: a copy of every point.
    pub fn drawing(&self) -> Drawing {
        let hidden = |s: &DocumentStroke| self.layer_of(s).is_some_and(|l| l.hidden);
        let stroke = |s| Stroke { hidden: hidden(s), ..Stroke::clone(&s.stroke) };
        let strokes = self.strokes.iter().map(stroke).collect();
        Drawing { name: self.settings.name.clone(), strokes, layers: self.layers().to_vec() }
    }

    /// Returns the layers of a sketch from below upwards; empty for other makers.
    pub fn layers(&self) -> &[Layer] {
        self.settings.sketch().map_or(&[], |s| &s.layers)
    }

    /// Returns the layer of a stroke; `None` for the sheet itself.
    pub fn layer_of(&self, stroke: &DocumentStroke) -> Option<&Layer> {
        let name = stroke.stroke.layer.as_ref()?;
        self.layers().iter().find(|l| l.name == *name)
    }

    /// Returns the materials of organs: by kinds, and of strokes by row of [`DocumentPlant::drawing`].
    pub fn wear(&self) -> Wear {
        let mut wear = Wear { strokes: Vec::new(), ..self.settings.wear.clone() };
        for (row, s) in (0..).zip(&self.strokes) {
            let Some(material) = &s.material else { continue };
            match wear.strokes.iter_mut().find(|w| w.material == **material) {
                Some(same) => same.strokes.push(row),
                None => {
                    let material = OrganMaterial::clone(material);
                    wear.strokes.push(StrokeWear { strokes: vec![row], material });
                }
            }
        }
        wear
    }

    /// Returns the classes that the user set, by row of [`DocumentPlant::drawing`].
    pub fn classes(&self) -> base::LiteMap<u32, StrokeClass> {
        base::map_of((0..).zip(&self.strokes).filter_map(|(row, s)| Some((row, s.class?))))
    }

    /// Returns the classes that were shown when the last stroke was drawn, by row of [`DocumentPlant::drawing`].
    pub fn shown(&self) -> base::LiteMap<u32, StrokeClass> {
        base::map_of((0..).zip(&self.strokes).filter_map(|(row, s)| Some((row, s.shown?))))
    }

    /// Returns the row of a stroke.
    pub fn row(&self, id: StrokeId) -> Option<usize> {
        self.strokes.iter().position(|s| s.id == id)
    }

    /// Removes the pictures from materials.
    fn leave_pictures(&mut self) {
        let plain = |m: &mut OrganMaterial| {
            if m.picture.take().is_some() {
                m.pattern = Pattern::Plain;
            }
        };
        let Settings { wear, pictures, .. } = &mut self.settings;
        pictures.clear();
        [&mut wear.leaf, &mut wear.petal, &mut wear.sepal].into_iter().flatten().for_each(plain);
        self.strokes.iter_mut().filter_map(|s| s.material.as_mut()).for_each(|m| plain(Arc::make_mut(m)));
    }

    fn round(&mut self) {
        let points = || self.strokes.iter().flat_map(|s| s.stroke.samples.iter().map(|p| p.at));
        let (low, high) = points().fold((DVec2::MAX, DVec2::MIN), |(a, b), p| (a.min(p), b.max(p)));
        let size = (high - low).length();
        // A power of ten has few digits as text.
        let mut step = 1.0;
        while size > 0.0 && size.is_finite() && step * 10_000.0 > size && step > 1e-12 {
            step *= 0.1;
        }
        let per_step = (1.0 / step).round();
        let on_grid = |x: f64| (x * per_step).round() / per_step;
        for s in &mut self.strokes {
            let mut stroke = Stroke::clone(&s.stroke);
            for p in &mut stroke.samples {
                p.at = DVec2::new(on_grid(p.at.x), on_grid(p.at.y));
                p.time_ms = None;
                p.pressure = p.pressure.map(|x| (x * 100.0).round() / 100.0);
            }
            stroke.samples.dedup_by(|b, a| a.at == b.at);
            s.stroke = Arc::new(stroke);
        }
    }
}

/// The user's work: a scene of plants.
///
/// ```
/// use document::{Document, Editor, NewStroke, SketchCommand};
/// use glam::DVec2;
/// let mut editor = Editor::default();
/// let plant = editor.document().plants()[0].id();
/// editor.run(SketchCommand::AddStrokes(vec![NewStroke::line(&[DVec2::ZERO, DVec2::Y])]).for_plant(plant))?;
/// assert_eq!(editor.document().plants()[0].drawing().strokes.len(), 1);
/// # Ok::<(), document::CommandError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    pub(crate) name: String,
    pub(crate) plants: Vec<DocumentPlant>,
    /// Number of the next stroke: above every id ever given in this document.
    pub(crate) next_stroke: u32,
    /// Number of the next plant.
    pub(crate) next_plant: u32,
}

impl Default for Document {
    /// Returns a document with one empty sketch.
    fn default() -> Self {
        let plant = DocumentPlant { id: PlantId(0), settings: Settings::default(), strokes: Vec::new() };
        Self { name: "plant".into(), plants: vec![plant], next_stroke: 0, next_plant: 1 }
    }
}

/// A fault of a document.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DocumentFault {
    /// Two strokes share a number.
    #[error("two strokes have the number {}", .0.0)]
    SameId(StrokeId),
    /// A stroke has a number that this document has not assigned yet.
    #[error("stroke {} has a number that is not given yet", .0.0)]
    FutureId(StrokeId),
    /// Two plants share a number, or one has a number that was not assigned yet.
    #[error("plant {} has a number that is taken or not given yet", .0.0)]
    PlantNumber(PlantId),
    /// A point is NaN or infinite, or there is no point.
    #[error("stroke {} has no point or one that is not finite", .0.0)]
    NotFinite(StrokeId),
    /// A stroke lies on a layer that does not exist.
    #[error("stroke {} lies on a layer that is not there", .0.0)]
    Layer(StrokeId),
    /// A plant that is not a sketch has strokes.
    #[error("plant {} has strokes but is no sketch", .0.0)]
    Strokes(PlantId),
    /// A plant bears the leaf of one that does not exist, of itself, or of one that has none of its own.
    #[error("plant {} bears the leaf of a plant that has none", .0.0)]
    Leaf(PlantId),
    /// The name is too long.
    #[error("the name is longer than {NAME_LENGTH} characters")]
    Name,
    /// There are too many plants.
    #[error("there are more than {MAX_PLANTS} plants")]
    Plants,
    /// A setting is out of its range.
    #[error(transparent)]
    Setting(#[from] SettingFault),
}

/// Most plants of a scene.
pub(crate) const MAX_PLANTS: usize = 200;

impl Document {
    /// Makes a document of a drawing as it was read: points that are not finite are left out, and strokes without
    /// points too.
    pub fn from_drawing(drawing: &Drawing) -> Self {
        let mut document = Self { name: shortened(&drawing.name), ..Self::default() };
        let mut strokes = Vec::new();
        for stroke in &drawing.strokes {
            if let Some(stroke) = sound(stroke.clone()) {
                let id = document.give_stroke();
                let stroke = Arc::new(stroke);
                strokes.push(DocumentStroke { id, stroke, class: None, shown: None, material: None });
            }
        }
        if let Some(plant) = document.plants.first_mut() {
            plant.settings.name = shortened(&drawing.name);
            if let Maker::Sketch(sketch) = &mut plant.settings.maker {
                sketch.layers.clone_from(&drawing.layers);
            }
            plant.strokes = strokes;
        }
        document
    }

    /// Gives the first sketch the materials, pictures and layers of a plant with the same strokes.
    pub fn dress(&mut self, like: &DocumentPlant) {
        let Some(plant) = self.plants.first_mut().filter(|p| p.strokes.len() == like.strokes.len()) else {
            return;
        };
        plant.settings.wear.clone_from(&like.settings.wear);
        plant.settings.pictures.clone_from(&like.settings.pictures);
        for (own, other) in plant.strokes.iter_mut().zip(&like.strokes) {
            own.material.clone_from(&other.material);
        }
    }

    /// Returns the name of the scene, for its file. At most 200 characters.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the plants in the order in which they were added.
    pub fn plants(&self) -> &[DocumentPlant] {
        &self.plants
    }

    /// Returns a plant by its number.
    pub fn plant(&self, id: PlantId) -> Option<&DocumentPlant> {
        self.plants.iter().find(|p| p.id == id)
    }

    /// Returns the numbers of its plants.
    pub fn numbers(&self) -> PlantNumbers {
        PlantNumbers { plants: self.plants.iter().map(DocumentPlant::id).collect(), next: self.next_plant }
    }

    /// Returns the same plants under other numbers, such as those of the session that saved it, so that references by
    /// number stay valid.
    ///
    /// # Errors
    /// [`DocumentFault::PlantNumber`] if the numbers are too few, too many, used twice, or not below the next one.
    ///
    /// ```
    /// use document::{Document, PlantId, PlantNumbers};
    /// let numbers = PlantNumbers { plants: vec![PlantId(7)], next: 9 };
    /// assert_eq!(Document::default().numbered(&numbers)?.plants()[0].id(), PlantId(7));
    /// # Ok::<(), document::DocumentFault>(())
    /// ```
    pub fn numbered(mut self, numbers: &PlantNumbers) -> Result<Self, DocumentFault> {
        if numbers.plants.len() != self.plants.len() {
            return Err(DocumentFault::PlantNumber(PlantId(numbers.next)));
        }
        let before = self.numbers().plants;
        let now = |id: PlantId| before.iter().position(|b| *b == id).map(|row| numbers.plants[row]);
        for (plant, id) in self.plants.iter_mut().zip(&numbers.plants) {
            plant.id = *id;
            let leaf = plant.settings.maker.leaf();
            plant.settings.maker.set_leaf(leaf.and_then(now));
        }
        self.next_plant = numbers.next;
        let fault = self.validate().find(|fault| matches!(fault, DocumentFault::PlantNumber(_)));
        fault.map_or(Ok(self), Err)
    }

    /// Returns a name that no group has: this one, or this one with the least free number from 2 on; an empty name
    /// stays empty.
    pub(crate) fn free_group(&self, name: &str) -> String {
        if name.is_empty() {
            return String::new();
        }
        let stem = match name.rsplit_once(' ') {
            Some((stem, number)) if !stem.is_empty() && number.parse::<u32>().is_ok() => stem,
            _ => name,
        };
        let taken = |name: &str| self.plants.iter().any(|p| p.settings.group == name);
        let names = (2..).map(|k: u32| {
            let behind = format!(" {k}");
            let room = NAME_LENGTH - behind.len();
            stem.chars().take(room).collect::<String>() + &behind
        });
        std::iter::once(name.to_owned()).chain(names).find(|n| !taken(n)).unwrap_or_default()
    }

    pub(crate) fn plant_mut(&mut self, id: PlantId) -> Option<&mut DocumentPlant> {
        self.plants.iter_mut().find(|p| p.id == id)
    }

    /// Returns the only plant, if it is a sketch that stands where it was drawn: such a document is a drawing.
    pub fn only_sketch(&self) -> Option<&DocumentPlant> {
        let [plant] = self.plants.as_slice() else { return None };
        let s = &plant.settings;
        let plain =
            s.sketch().is_some_and(|k| k.day.is_none()) && s.placement == Placement::default() && !s.hidden;
        plain.then_some(plant)
    }

    /// Whether a plant has a leaf of its own that others may bear: a measured leaf, or a sketch with its own leaves.
    pub fn lends_leaf(&self, id: PlantId) -> bool {
        self.plant(id).is_some_and(|p| match &p.settings.maker {
            Maker::Leaf(_) => true,
            Maker::Sketch(s) => s.leaf.is_none(),
            _ => false,
        })
    }

    /// Returns a smaller document that looks the same: points on a grid of at most 1/10,000 of the drawing's diagonal,
    /// without their times; without photographs and pictures, whose materials become plain. For links, not for files.
    pub fn compact(&self) -> Self {
        let mut document = self.clone();
        for plant in &mut document.plants {
            plant.round();
            if let Maker::Sketch(s) = &mut plant.settings.maker {
                s.photo = None;
            }
            plant.leave_pictures();
        }
        document
    }

    pub(crate) fn give_stroke(&mut self) -> StrokeId {
        let id = StrokeId(self.next_stroke);
        self.next_stroke = self.next_stroke.saturating_add(1);
        id
    }

    /// Iterates over all faults; there are none after any sequence of commands. Cost: linear in points.
    pub fn validate(&self) -> impl Iterator<Item = DocumentFault> + '_ {
        let mut seen = BTreeSet::new();
        let strokes = self.plants.iter().flat_map(|p| &p.strokes).flat_map(move |s| {
            let same = (!seen.insert(s.id)).then_some(DocumentFault::SameId(s.id));
            let future = (s.id.0 >= self.next_stroke).then_some(DocumentFault::FutureId(s.id));
            let finite = !s.stroke.samples.is_empty() && s.stroke.samples.iter().all(|p| p.at.is_finite());
            let odd = (!finite).then_some(DocumentFault::NotFinite(s.id));
            [same, future, odd].into_iter().flatten()
        });
        let look = self.plants.iter().flat_map(|p| {
            let layer = |s: &&DocumentStroke| s.stroke.layer.is_some() && p.layer_of(s).is_none();
            let layer = p.strokes.iter().find(layer).map(|s| DocumentFault::Layer(s.id));
            let mut worn = p.strokes.iter().filter_map(|s| s.material.as_ref());
            let fault = worn.find_map(|m| material_fault(m, &p.settings.pictures));
            [layer, fault.map(DocumentFault::Setting)].into_iter().flatten()
        });
        let mut known = base::Set::new();
        let plants = self.plants.iter().flat_map(move |p| {
            let taken = known.insert(p.id, ()).is_some() || p.id.0 >= self.next_plant;
            let strokes = !p.strokes.is_empty() && p.settings.sketch().is_none();
            let leaf = p.settings.maker.leaf().is_some_and(|l| l == p.id || !self.lends_leaf(l));
            [
                taken.then_some(DocumentFault::PlantNumber(p.id)),
                strokes.then_some(DocumentFault::Strokes(p.id)),
                leaf.then_some(DocumentFault::Leaf(p.id)),
                (too_long(&p.settings.name) || too_long(&p.settings.group)).then_some(DocumentFault::Name),
                range_fault(&p.settings).map(DocumentFault::Setting),
            ]
            .into_iter()
            .flatten()
        });
        let name = too_long(&self.name).then_some(DocumentFault::Name);
        let many = (self.plants.len() > MAX_PLANTS).then_some(DocumentFault::Plants);
        strokes.chain(look).chain(plants).chain(name).chain(many)
    }
}

/// Returns the stroke with its finite points only; `None` if there are none. Unknown times and pressures stay unknown.
/// Its layer decides whether it is visible.
pub(crate) fn sound(mut stroke: Stroke) -> Option<Stroke> {
    stroke.samples.retain(|p| p.at.is_finite());
    for p in &mut stroke.samples {
        p.time_ms = p.time_ms.filter(|t| t.is_finite());
        p.pressure = p.pressure.filter(|t| t.is_finite());
    }
    stroke.width = stroke.width.filter(|&w| is_width(w));
    stroke.hidden = false;
    (!stroke.samples.is_empty()).then_some(stroke)
}

/// Whether a pen can have this width, in the drawing's unit.
pub(crate) fn is_width(width: f64) -> bool {
    (1e-9..=1e9).contains(&width)
}

/// Returns the first setting that is out of its range, `None` if all are sound.
pub fn range_fault(settings: &Settings) -> Option<SettingFault> {
    let wear = || settings.wear_fault();
    settings
        .maker
        .fault()
        .or_else(wear)
        .or_else(|| settings.placement.fault())
        .or_else(|| settings.edits_fault())
}
