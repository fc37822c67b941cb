//! From a drawing to its plant in stages, each kept until what it depends on changes.
//!
//! `drawing -> ink, classes | + corrections -> reading | + spec, seed -> plant | + skin -> model`

use base::LiteMap;
use std::sync::Arc;

use base::{Cancelled, Counted, Report, Run, Seed, Stage, Stopped, Warning};
use document::{Photo, PlantEdit};
use glam::DVec2;
use ink::{Classified, Drawing, Ink, KeptMeasures, StrokeClass};
use makers::LeafTemplate;
use mesh::{Model, Texture};
use plant::{AxisKind, OrganKind, Plant};
use reading::{KeptStrokes, Kind, Reading, VeinReading};
use sketch::{Built, KeptBodies, SketchSpec};
use skin::{KeptShapes, Layout, SkinSpec, SurfacePictures, Traced, coarser};

use crate::checks::{Sketched, check_plant, check_sketch};
use crate::levels::{LaidOut, LevelSpec, Levels, levels_of};
use crate::made::Made;
use crate::make::{ClassOverrides, MakeError, SketchOptions};
use crate::report::{Counts, FidelityReport, ItemReport, ReadingReport, StrokeReport, TimingsMs};
use crate::shaping::{EditReport, Shaper};

/// Placement of a drawing in the front view of its model: `plant.xy = (drawing - origin) * metres_per_unit`, z towards
/// the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontView {
    /// Metres for each unit of the drawing, above 0.
    pub metres_per_unit: f64,
    /// The point of the drawing that is the model's origin: on the ground, at the root of the main axis.
    pub origin: DVec2,
}

/// Makes plants from a drawing that changes: an update recomputes only the stages that a change affects.
///
/// A seed or a setting of depth keeps the reading, a correction keeps the classes, a colour keeps the plant.
/// Guaranteed: the same result as from a fresh evaluator; after an error the last result stays.
///
/// ```
/// use burgeon::{Evaluator, Run, Seed, SketchOptions};
/// use burgeon::glam::DVec2;
/// use burgeon::ink::Drawing;
/// let line: Vec<DVec2> = (0..40).map(|i| DVec2::new(0.02 * f64::from(i % 7), f64::from(i))).collect();
/// let drawing = Drawing::from_polylines("a stem", &[line]);
/// let mut evaluator = Evaluator::default();
/// evaluator.update(&drawing, &SketchOptions::default(), Seed::new(1), &Run::plain())?;
/// evaluator.update(&drawing, &SketchOptions::default(), Seed::new(2), &Run::plain())?;
/// assert_eq!(evaluator.stages_done(), ["depth", "mesh"]);
/// # Ok::<(), burgeon::MakeError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Evaluator {
    /// Measurements of the strokes of the last drawing.
    measures: KeptMeasures,
    strokes: Option<Kept<Drawing, (Ink, Vec<Classified>)>>,
    /// Results of single strokes of the last drawing.
    understood: KeptStrokes,
    reading: Option<Kept<ReadFrom, Reading>>,
    /// Bodies of the contours of the last plant.
    bodies: KeptBodies,
    /// The plant with its fidelity to the drawing; `None` inside where that is still to be measured.
    plant: Option<Kept<PlantFrom, (Built, Option<FidelityReport>)>>,
    shaper: Shaper,
    /// The plant with its hand edits; `None` without any.
    shaped: Option<Shaped>,
    model: Option<Kept<ModelFrom, Model>>,
    /// Places of the plant's parts in the model.
    layout: Layout,
    /// Leaves and petals of the last model.
    shapes: KeptShapes,
    /// The photograph that was decoded last.
    picture: Option<Decoded>,
    done: Vec<&'static str>,
    /// See [`Evaluator::previewing`].
    preview: bool,
    /// For a preview: the interpretation of the drawing before this stroke, if there was one.
    taken: Option<Taken>,
    /// See [`crate::SceneEvaluator::set_previewing`].
    pub(crate) previewing: bool,
    /// See [`crate::SceneEvaluator::set_measuring_later`].
    pub(crate) later: bool,
}

/// Leaves for each stroke above which a plant has some that were not drawn.
const LEAVES_OF_A_STROKE: usize = 2;

/// Number of strokes above which the fidelity of a plant may be measured after the plant was seen.
const MANY: usize = 512;

/// Most organs of a preview: a larger crown is shown with fewer and larger leaves until the pen is lifted.
const SEEN_AT_ONCE: usize = 2_500;

/// Returns a coarser copy of a plant of very many organs, and its skin settings: for a preview.
fn coarse_preview(plant: &Plant, skin: &SkinSpec) -> Option<(Plant, SkinSpec)> {
    let level = plant.organs.len().div_ceil(SEEN_AT_ONCE).next_power_of_two().ilog2();
    (level > 0).then(|| coarser(plant, skin, level))
}

/// Basis on which a drawing of one plant was read.
#[derive(Clone, Copy, Debug)]
enum Taken {
    /// Its strokes.
    Strokes,
    /// A kind that explains the whole better.
    For(Kind),
    /// The arrangement of its faces and lines.
    Arranged,
}

/// Inputs of a plant in addition to its reading: the name goes into the plant.
type PlantFrom = (SketchSpec, Seed, String, Option<LeafTemplate>);

/// Inputs of a reading in addition to ink and classes.
type ReadFrom = (ClassOverrides, LiteMap<u32, StrokeClass>, Option<Kind>);

/// An edited plant and the edits.
#[derive(Clone, Debug)]
struct Shaped {
    edits: Vec<PlantEdit>,
    plant: Plant,
    told: Vec<EditReport>,
}

/// A photograph's file and its pixels, if they decode.
type Decoded = (Arc<[u8]>, Option<Arc<Texture>>);

/// Inputs of a model in addition to its plant. The opacity of a photograph does not affect it.
type ModelFrom = (SkinSpec, Option<Photo>);

/// A result, its inputs (besides the stage before it), and the messages reported with it.
#[derive(Clone, Debug)]
struct Kept<K, V> {
    from: K,
    value: V,
    warnings: Vec<Warning>,
}

/// Returns the basis of a reading, so that strokes keep their interpretation while another is drawn.
fn taken(reading: &Reading) -> Option<Taken> {
    let [plant] = &reading.plants[..] else { return None };
    let again = |s: &reading::StrokeReading| s.source == ink::Source::Rule(reading::READ_AS);
    let arranged = |s: &reading::StrokeReading| s.source == ink::Source::Rule(reading::ARRANGEMENT);
    Some(if reading.strokes.iter().any(again) {
        Taken::For(plant.kind)
    } else if reading.strokes.iter().any(arranged) {
        Taken::Arranged
    } else {
        Taken::Strokes
    })
}

impl Evaluator {
    /// Makes an evaluator for a stroke that is still being drawn: faster, and no more than a preview. Strokes keep
    /// their classes, and the report has neither fidelity nor digest. The guarantee above does not hold for it.
    pub fn previewing() -> Self {
        Self { preview: true, shapes: KeptShapes::loose(), ..Self::default() }
    }

    /// Takes over the results of another evaluator for this drawing, if it made that last: the preview keeps the
    /// classes of the strokes there. Returns whether it did.
    pub fn follow(&mut self, other: &Self, drawing: &Drawing) -> bool {
        let same = other.strokes.as_ref().is_some_and(|k| k.from.strokes == drawing.strokes);
        if same {
            (self.strokes, self.reading) = (other.strokes.clone(), None);
            self.taken = other.reading.as_ref().and_then(|r| taken(&r.value));
            (self.measures, self.bodies) = (other.measures.clone(), other.bodies.clone());
            self.understood = other.understood.clone();
        }
        same
    }

    /// Brings everything up to date and reports.
    ///
    /// # Errors
    /// [`MakeError`]: nothing usable in the drawing, a correction of a missing stroke, or a cancelled run.
    pub fn update(
        &mut self,
        drawing: &Drawing,
        options: &SketchOptions,
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<ItemReport, MakeError> {
        self.done.clear();
        let count = drawing.strokes.len();
        run.budget.check(Counted::Strokes, count as u64, "draw with fewer strokes or in several drawings")?;
        if let Some(&index) = options.classes.keys().find(|&&index| index as usize >= count) {
            return Err(MakeError::NoSuchStroke { name: drawing.name.clone(), index, strokes: count });
        }
        let mut stages = Vec::new();
        if self.strokes.as_ref().is_none_or(|k| k.from.strokes != drawing.strokes) {
            let mut report = Report::default();
            let before = self.strokes.as_ref().map(|k| &k.value.0);
            let ink = report.stage("preprocess", run.clock, |r| ink::clean_again(drawing, before, run, r));
            run.cancel.check()?;
            if ink.strokes.is_empty() {
                return Err(MakeError::NoStrokes { name: drawing.name.clone(), strokes: count });
            }
            let known = self.known(drawing, &ink);
            let classes = report
                .stage("classify", run.clock, |_| ink::classify_again(&ink, &known, &mut self.measures, run));
            run.cancel.check()?;
            self.reading = None;
            self.strokes =
                Some(Self::keep(&mut self.done, &mut stages, drawing.clone(), (ink, classes), report));
        }
        self.read(options, &mut stages, run)?;
        self.build(options, seed, &drawing.name, &mut stages, run)?;
        self.shape(options, &mut stages, run)?;
        let mut photo = options.photo.clone().filter(|p| p.place.paint);
        if let Some(photo) = &mut photo {
            photo.place.opacity = 1.0;
        }
        let skin = self.sparse(options);
        self.mesh(&skin, photo, &mut stages, run)?;
        Ok(self.item(&drawing.name, stages, run))
    }

    /// Returns, for a preview, the classes of unchanged strokes.
    fn known(&self, drawing: &Drawing, ink: &Ink) -> Vec<Option<Classified>> {
        let Some(Kept { from, value: (old, classes), .. }) = self.strokes.as_ref().filter(|_| self.preview)
        else {
            return Vec::new();
        };
        let before = base::map_of(old.strokes.iter().map(|s| s.index).zip(classes.iter().copied()));
        let same = |row: u32| {
            let row = row as usize;
            from.strokes.get(row).is_some_and(|s| Some(s) == drawing.strokes.get(row))
        };
        ink.strokes.iter().map(|s| before.get(&s.index).copied().filter(|_| same(s.index))).collect()
    }

    fn keep<K, V>(
        done: &mut Vec<&'static str>,
        stages: &mut Vec<Stage>,
        from: K,
        value: V,
        report: Report,
    ) -> Kept<K, V> {
        done.extend(report.stages.iter().map(|s| s.name));
        stages.extend(report.stages);
        Kept { from, value, warnings: report.warnings }
    }

    fn read(
        &mut self,
        options: &SketchOptions,
        stages: &mut Vec<Stage>,
        run: &Run<'_>,
    ) -> Result<(), MakeError> {
        let Some(strokes) = &self.strokes else { return Ok(()) };
        let SketchOptions { classes: wanted, shown, spec: SketchSpec { read_as, .. }, .. } = options;
        let from = (wanted.clone(), shown.clone(), *read_as);
        if self.reading.as_ref().is_some_and(|k| k.from == from) {
            return Ok(());
        }
        let read_as = *read_as;
        let (ink, classes) = &strokes.value;
        let mut classes = classes.clone();
        for (stroke, class) in ink.strokes.iter().zip(&mut classes) {
            class.shown = shown.get(&stroke.index).copied();
            if let Some(&wanted) = wanted.get(&stroke.index) {
                *class = Classified::by_user(wanted);
            }
        }
        let mut report = Report::default();
        let kept = &mut self.understood;
        let mut reading =
            report.stage("structure", run.clock, |r| match self.taken.filter(|_| read_as.is_none()) {
                Some(Taken::For(kind)) => reading::read_again(Some(kind), &[], (ink, &classes), kept, run, r),
                Some(Taken::Arranged) => reading::read_but_last((ink, &classes), kept, run, r),
                Some(Taken::Strokes) => {
                    reading::read_again(None, &[reading::READ_AS], (ink, &classes), kept, run, r)
                }
                None => reading::read_again(read_as, &[], (ink, &classes), kept, run, r),
            });
        run.cancel.check()?;
        if self.preview {
            // For a vein under the pen, the surface of leaves would be painted again at each of its points.
            let last = strokes.from.strokes.len().saturating_sub(1);
            let lies = |v: &VeinReading| v.source.is_none_or(|source| source as usize != last);
            reading.leaves.iter_mut().for_each(|leaf| leaf.veins.retain(lies));
        }
        self.plant = None;
        self.reading = Some(Self::keep(&mut self.done, stages, from, reading, report));
        Ok(())
    }

    fn build(
        &mut self,
        options: &SketchOptions,
        seed: Seed,
        name: &str,
        stages: &mut Vec<Stage>,
        run: &Run<'_>,
    ) -> Result<(), MakeError> {
        let (Some(strokes), Some(reading)) = (&self.strokes, &self.reading) else { return Ok(()) };
        let (spec, leaf) = (&options.spec, &options.leaf);
        let same =
            |k: &Kept<PlantFrom, _>| (&k.from.0, k.from.1, &*k.from.2, &k.from.3) == (spec, seed, name, leaf);
        if self.plant.as_ref().is_some_and(same) {
            return Ok(());
        }
        let mut report = Report::default();
        let kept = &mut self.bodies;
        let mut built = sketch::build_again(&reading.value, spec, seed, kept, run, &mut report)?; // books `depth`
        // The user's leaf replaces the drawn ones, so the fidelity has to be measured before it is applied.
        let later = self.later && leaf.is_none() && strokes.value.0.strokes.len() > MANY;
        let wanted = !self.preview && !later;
        let start = run.clock.now_ms();
        let fidelity = if wanted {
            Some(sketch::fidelity(&built, &reading.value, &strokes.value.0, run)?.into())
        } else {
            None
        };
        stages.push(Stage { name: "fidelity", ms: run.clock.now_ms() - start });
        // Applied after the fidelity is measured: the user's leaf is not the drawn one.
        if let Some(leaf) = leaf {
            let count = leaf.apply(&mut built.plant);
            if count == 0 {
                report.warn("no-leaves", "the plant has no leaf that could get the template's form");
            }
        }
        name.clone_into(&mut built.plant.name);
        (self.model, self.shaped) = (None, None);
        self.shaper.forget();
        let from = (spec.clone(), seed, name.to_owned(), leaf.clone());
        self.plant = Some(Self::keep(&mut self.done, stages, from, (built, fidelity), report));
        Ok(())
    }

    /// Measures the fidelity of the plant to its drawing, where an update put that off; `None` where nothing is left to
    /// measure.
    ///
    /// # Errors
    /// [`Cancelled`]; the fidelity is still to be measured then.
    pub(crate) fn measure(&mut self, run: &Run<'_>) -> Result<Option<FidelityReport>, Cancelled> {
        let (Some(strokes), Some(reading), Some(made)) = (&self.strokes, &self.reading, &mut self.plant)
        else {
            return Ok(None);
        };
        let (built, fidelity) = &mut made.value;
        if self.preview || fidelity.is_some() {
            return Ok(None);
        }
        let found = sketch::fidelity(built, &reading.value, &strokes.value.0, run)?.into();
        *fidelity = Some(found);
        Ok(Some(found))
    }

    /// Whether an update put off measuring the fidelity.
    pub(crate) fn is_unmeasured(&self) -> bool {
        !self.preview && self.plant.as_ref().is_some_and(|p| p.value.1.is_none())
    }

    /// Applies hand edits, after the fidelity is measured: an edited part is not what was drawn.
    fn shape(
        &mut self,
        options: &SketchOptions,
        stages: &mut Vec<Stage>,
        run: &Run<'_>,
    ) -> Result<(), MakeError> {
        let Some(plant) = &self.plant else { return Ok(()) };
        if self.shaped.as_ref().map_or(&[][..], |s| &s.edits) == options.edits {
            return Ok(());
        }
        let start = run.clock.now_ms();
        let context =
            shape::Context { pipe_exponent: options.spec.pipe_exponent, ..shape::Context::default() };
        let shaped = if options.edits.is_empty() {
            self.shaper.forget();
            None
        } else {
            let (plant, told) = self.shaper.shape(&plant.value.0.plant, &options.edits, &context, run)?;
            Some(Shaped { edits: options.edits.clone(), plant, told })
        };
        (self.model, self.shaped) = (None, shaped);
        self.done.push("shape");
        stages.push(Stage { name: "depth", ms: run.clock.now_ms() - start });
        Ok(())
    }

    /// Returns the skin settings of a drawing. The leaves of a sparsely filled one are no finer than those of one with
    /// the default density: otherwise fewer leaves would have more triangles.
    fn sparse(&self, options: &SketchOptions) -> SkinSpec {
        let density = options.spec.fill.density;
        let strokes = self.strokes.as_ref().map_or(0, |k| k.from.strokes.len());
        let filled = |plant: &&Plant| {
            let leaves = plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf).count();
            density > 0.0 && density < 1.0 && leaves > LEAVES_OF_A_STROKE * strokes
        };
        let crowd = self.plant().filter(filled).map(|plant| {
            let axes = plant.axes.iter().filter(|a| a.kind != AxisKind::Petiole).count();
            [axes, plant.organs.len()].map(|n| base::ops::whole((n as f64 / density).round()) as usize)
        });
        SkinSpec { crowd: crowd.or(options.skin.crowd), ..options.skin.clone() }
    }

    fn mesh(
        &mut self,
        skin: &SkinSpec,
        photo: Option<Photo>,
        stages: &mut Vec<Stage>,
        run: &Run<'_>,
    ) -> Result<(), MakeError> {
        if self.model.as_ref().is_some_and(|k| (&k.from.0, &k.from.1) == (skin, &photo)) {
            return Ok(());
        }
        let mut report = Report::default();
        let decoded = photo.as_ref().is_none_or(|p| self.decode(p, &mut report));
        let traced = photo.as_ref().filter(|_| decoded).and_then(|p| self.traced(p));
        let mut shapes = core::mem::take(&mut self.shapes);
        let coarse = self.plant().filter(|_| self.preview).and_then(|plant| coarse_preview(plant, skin));
        let plant = coarse.as_ref().map(|(copy, _)| copy).or_else(|| self.plant());
        let drawn = coarse.as_ref().map_or(skin, |(_, coarser)| coarser);
        let meshed = plant.map(|plant| {
            let pictures = SurfacePictures { traced: traced.as_ref(), ..SurfacePictures::default() };
            let model = report.stage("mesh", run.clock, |_| {
                skin::skin_laid_out(plant, drawn, pictures, Some(&mut shapes), run)
            });
            model.map(|(model, layout)| (Model { name: plant.name.clone(), ..model }, layout))
        });
        self.shapes = shapes;
        let (Some(model), Some(made)) = (meshed, &self.plant) else { return Ok(()) };
        let (mut model, layout) = model?;
        self.layout = layout;
        if let Some(leaf) = &made.from.3 {
            leaf.dress(&mut model, &skin.worn);
        }
        self.model = Some(Self::keep(&mut self.done, stages, (skin.clone(), photo), model, report));
        Ok(())
    }

    /// Decodes a photograph and keeps its pixels; returns whether it decodes.
    fn decode(&mut self, photo: &Photo, report: &mut Report) -> bool {
        let known = self.picture.as_ref().is_some_and(|(png, _)| Arc::ptr_eq(png, photo.png()));
        if !known {
            let texture = formats::read_picture(photo.png()).map(Arc::new);
            self.picture = Some((Arc::clone(photo.png()), texture));
        }
        let decoded = self.picture.as_ref().is_some_and(|(_, texture)| texture.is_some());
        if !decoded {
            report.warn(
                "photo",
                "the photograph under the drawing cannot be decoded; its colours are not used",
            );
        }
        decoded
    }

    /// Returns the photograph in the plant's plane; `None` if it was not decoded.
    fn traced(&self, photo: &Photo) -> Option<Traced> {
        let texture = self.picture.as_ref().and_then(|(_, t)| t.clone())?;
        let front = self.front()?;
        let drawing = &self.strokes.as_ref()?.from;
        let place = |x: f64, y: f64| (DVec2::new(x, y) - front.origin) * front.metres_per_unit;
        let corner = place(photo.place.x, photo.place.y + photo.height());
        // A stroke that leaves the picture was not traced over it.
        let inside = |s: &ink::Stroke| s.samples.iter().all(|p| photo.covers(p.at.x, p.at.y));
        let strokes = base::set_of((0..).zip(&drawing.strokes).filter(|(_, s)| inside(s)).map(|(i, _)| i));
        let size_m = (photo.place.width * front.metres_per_unit, photo.height() * front.metres_per_unit);
        Some(Traced { texture, strokes, corner_m: (corner.x, corner.y), size_m })
    }

    /// Returns a coarser copy of the model, with the same materials, its plant, and the places of that plant's parts in
    /// it; `None` before an update. See [`crate::MadePlant::at_level`].
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn laid_out_at(&self, level: u32, run: &Run<'_>) -> Result<Option<LaidOut>, Stopped> {
        Ok(self.laid_out_to(level.max(1), run)?.pop())
    }

    /// Returns coarser copies of the levels 1 to `count`; `None` before an update.
    fn laid_out_to(&self, count: u32, run: &Run<'_>) -> Result<Vec<LaidOut>, Stopped> {
        let (Some(plant), Some(model), Some(made)) = (self.plant(), &self.model, &self.plant) else {
            return Ok(Vec::new());
        };
        let (skin, photo) = &model.from;
        let traced = photo.as_ref().and_then(|photo| self.traced(photo));
        let leaf = made.from.3.as_ref();
        let mesh = |plant: &Plant, skin: &SkinSpec| {
            let pictures = SurfacePictures { traced: traced.as_ref(), ..SurfacePictures::default() };
            let (mut model, layout) = skin::skin_laid_out(plant, skin, pictures, None, run)?;
            model.name.clone_from(&plant.name);
            leaf.inspect(|leaf| leaf.dress(&mut model, &skin.worn));
            Ok((model, layout))
        };
        levels_of(plant, (skin, &model.value), count, mesh)
    }

    fn item(&self, name: &str, stages: Vec<Stage>, run: &Run<'_>) -> ItemReport {
        let start = run.clock.now_ms();
        let mut report = Report::default();
        stages.iter().for_each(|s| report.book(s.name, s.ms));
        let (Some(strokes), Some(reading), Some(plant), Some(model), Some(shown)) =
            (&self.strokes, &self.reading, &self.plant, &self.model, self.plant())
        else {
            return ItemReport::default(); // update fills all four before it comes here
        };
        for warnings in [&strokes.warnings, &reading.warnings, &plant.warnings, &model.warnings] {
            report.warnings.extend_from_slice(warnings);
        }
        let (told, edits) = self.shaped.as_ref().map_or((&[][..], &[][..]), |s| (&s.told, &s.edits));
        let mut warnings = report.warnings.clone();
        warnings.extend(told.iter().filter_map(|t| t.warning(edits)));
        let mut checks = Report::default();
        if !self.preview {
            check_plant(shown, &mut checks);
            let (ink, reading) = (&strokes.value.0, &reading.value);
            let sketched = Sketched { ink, reading, extent: self.extent(), is_guessed: self.is_guessed() };
            check_sketch(&sketched, &mut checks);
        }
        let mut counts = Counts::from_plant(shown);
        counts.vertices = model.value.vertex_count() as u64;
        counts.triangles = model.value.triangle_count() as u64;
        let digest = if self.preview || self.previewing { String::new() } else { shown.digest_hex() };
        report.book("measure", run.clock.now_ms() - start);
        let mut item = ItemReport {
            name: name.to_owned(),
            output: String::new(),
            strokes: reading.value.strokes.iter().map(stroke_report).collect(),
            counts,
            timings_ms: TimingsMs::from_report(&report),
            fidelity: plant.value.1.unwrap_or_default(),
            readings: ReadingReport::from_reading(&reading.value),
            digest,
            edits: told.to_vec(),
            ..ItemReport::default()
        }
        .warning(warnings);
        item.add_checks(checks);
        item
    }

    /// Returns the diagonal of the front of the meshes over that of the drawing; `None` for a plant that was edited by
    /// hand.
    fn extent(&self) -> Option<f64> {
        let (plant, model) = (&self.plant.as_ref()?.value.0, &self.model.as_ref()?.value);
        if self.shaped.is_some() || plant.map.metres_per_ink <= 0.0 {
            return None;
        }
        let bounds = model.bounds();
        let size = bounds.max - bounds.min;
        // The drawing's diagonal is 1 in ink coordinates.
        Some(size.truncate().length() / plant.map.metres_per_ink).filter(|e| e.is_finite())
    }

    /// Whether nobody said what the drawing shows.
    fn is_guessed(&self) -> bool {
        self.reading.as_ref().is_some_and(|r| r.from.2.is_none())
    }

    /// Returns the stages that the last update recomputed, by their names in reports.
    pub fn stages_done(&self) -> &[&'static str] {
        &self.done
    }

    /// Returns the model of the last successful update.
    pub fn model(&self) -> Option<&Model> {
        Some(&self.model.as_ref()?.value)
    }

    /// Returns the places of the plant's parts in the model of the last update; `None` before one.
    pub(crate) fn layout(&self) -> Option<&Layout> {
        self.model.as_ref().map(|_| &self.layout)
    }

    /// Returns the plant of the last successful update, with its hand edits.
    pub fn plant(&self) -> Option<&Plant> {
        self.shaped.as_ref().map(|s| &s.plant).or_else(|| self.drawn())
    }

    /// Returns the plant as it was drawn, before any hand edit.
    pub(crate) fn drawn(&self) -> Option<&Plant> {
        Some(&self.plant.as_ref()?.value.0.plant)
    }

    /// Returns the placement of the drawing in the model's front view.
    pub fn front(&self) -> Option<FrontView> {
        let ink = self.strokes.as_ref()?.value.0.map;
        let map = self.plant.as_ref()?.value.0.map;
        Some(FrontView {
            metres_per_unit: map.metres_per_ink * ink.scale,
            origin: ink.to_drawing(map.origin_ink),
        })
    }

    /// Takes the reading, plant and model of the last update; the evaluator is then empty.
    pub(crate) fn take(&mut self) -> Option<(Reading, Plant, Model)> {
        let (reading, plant, model) = (self.reading.take()?, self.plant.take()?, self.model.take()?);
        self.strokes = None;
        let shaped = self.shaped.take().map(|s| s.plant);
        Some((reading.value, shaped.unwrap_or(plant.value.0.plant), model.value))
    }
}

fn stroke_report(s: &reading::StrokeReading) -> StrokeReport {
    StrokeReport {
        index: s.index,
        class: s.class.word().into(),
        organ: s.organ.word().into(),
        confidence: s.confidence,
        source: s.source.to_string(),
    }
}

/// Makes a plant and its meshes from a drawing (He and Cheng 2021).
///
/// The same drawing, options and seed give the same bits on every platform and for any executor.
/// Cost: linear in ink and organs, some milliseconds for a drawing of 30 strokes.
///
/// # Errors
/// [`MakeError`]: nothing usable in the drawing, an override of a missing stroke, or a cancelled run.
pub fn make_from_sketch(
    drawing: &Drawing,
    options: &SketchOptions,
    seed: Seed,
    run: &Run<'_>,
) -> Result<Made, MakeError> {
    let (made, _) = make_levels_from_sketch(drawing, options, (seed, &LevelSpec::default()), run)?;
    Ok(made)
}

/// Calls [`make_from_sketch`], and also makes coarser copies of the plant and other levels.
///
/// # Errors
/// As [`make_from_sketch`].
pub fn make_levels_from_sketch(
    drawing: &Drawing,
    options: &SketchOptions,
    (seed, levels): (Seed, &LevelSpec),
    run: &Run<'_>,
) -> Result<(Made, Levels), MakeError> {
    let mut evaluator = Evaluator::default();
    let mut item = evaluator.update(drawing, options, seed, run)?;
    let start = run.clock.now_ms();
    let finest = evaluator.model().zip(evaluator.plant()).zip(evaluator.layout());
    let levels = match finest {
        Some(((model, plant), layout)) => {
            let mut coarser = evaluator.laid_out_to(levels.lods, run)?.into_iter();
            Levels::new(levels, (model, plant, layout), |_| Ok::<_, MakeError>(coarser.next()), run)?
        }
        None => Levels::default(),
    };
    let ms = run.clock.now_ms() - start;
    item.timings_ms.mesh += ms;
    item.timings_ms.total += ms;
    let (reading, plant, model) = evaluator.take().ok_or(Cancelled)?; // update succeeded: all three are there
    Ok((Made { reading, plant, model, item }, levels))
}

#[cfg(test)]
mod tests {

    use super::*;
    use skin::PetalColor;

    fn drawing() -> Drawing {
        let stem: Vec<DVec2> = (0..40).map(|i| DVec2::new(0.02 * f64::from(i % 7), f64::from(i))).collect();
        let leaf: Vec<DVec2> = (0..=30)
            .map(|k| {
                let a = f64::from(k) / 30.0 * base::ops::TAU;
                DVec2::new(7.0 - 7.0 * base::ops::cos(a), 15.0 + 3.0 * base::ops::sin(a))
            })
            .collect();
        Drawing::from_polylines("herb", &[stem, leaf])
    }

    /// Returns the stages that an update recomputed, after checking that a fresh evaluator gives the same.
    fn step(e: &mut Evaluator, d: &Drawing, o: &SketchOptions, seed: u64) -> Vec<&'static str> {
        let item = e.update(d, o, Seed::new(seed), &Run::plain()).unwrap();
        let mut fresh = Evaluator::default();
        let again = fresh.update(d, o, Seed::new(seed), &Run::plain()).unwrap();
        assert_eq!((&item, e.model(), e.front()), (&again, fresh.model(), fresh.front()));
        e.stages_done().to_vec()
    }

    #[test]
    fn only_what_a_change_touches_is_done_again() {
        let (mut e, mut d, mut o) = (Evaluator::default(), drawing(), SketchOptions::default());
        let all = ["preprocess", "classify", "structure", "depth", "mesh"];
        assert_eq!(step(&mut e, &d, &o, 1), all);
        assert_eq!(step(&mut e, &d, &o, 1), [""; 0]);
        o.skin.petals = Some(PetalColor::Blue);
        assert_eq!(step(&mut e, &d, &o, 1), all[4..]);
        assert_eq!(step(&mut e, &d, &o, 2), all[3..]);
        o.spec.fill.density = 2.0;
        assert_eq!(step(&mut e, &d, &o, 2), all[3..]);
        // A hand edit draws nothing anew.
        let turn = shape::Turn { about: glam::DVec3::Z, degrees: 25.0 };
        o.edits.push(shape::HandEdit::Rotate { axis: shape::AxisKey::Path(vec![0]), turn }.into());
        assert_eq!(step(&mut e, &d, &o, 2), ["shape", "mesh"]);
        assert!(e.plant() != e.drawn() && e.stages_done().len() == 2);
        o.edits[0].off = true;
        assert_eq!(step(&mut e, &d, &o, 2), ["shape", "mesh"]);
        o.edits.clear();
        assert_eq!(step(&mut e, &d, &o, 2), ["shape", "mesh"]);
        assert_eq!(e.plant(), e.drawn());
        o.classes.insert(1, StrokeClass::Axis);
        assert_eq!(step(&mut e, &d, &o, 2), all[2..]);
        d.strokes.pop();
        o.classes.clear();
        assert_eq!(step(&mut e, &d, &o, 2), all);
    }

    #[test]
    fn a_preview_keeps_classes_and_ends_in_the_same_plant() {
        let (mut d, o) = (drawing(), SketchOptions::default());
        let mut preview = Evaluator::previewing();
        let run = Run::plain();
        preview.update(&d, &o, Seed::new(1), &run).unwrap();
        d.strokes.push(d.strokes[1].clone());
        for p in &mut d.strokes[2].samples {
            p.at = DVec2::new(-p.at.x, p.at.y + 3.0);
        }
        let item = preview.update(&d, &o, Seed::new(1), &run).unwrap();
        assert_eq!((item.strokes.len(), item.digest.as_str()), (3, ""));
        let mut full = Evaluator::default();
        let whole = full.update(&d, &o, Seed::new(1), &run).unwrap();
        assert_eq!(item.counts.leaves, whole.counts.leaves);
        assert_eq!(preview.front(), full.front());
        // A changed first stroke is unknown again.
        d.strokes[0].samples.truncate(20);
        assert!(preview.update(&d, &o, Seed::new(1), &run).is_ok());
    }

    #[test]
    fn leaves_keep_their_surface_while_a_vein_is_drawn() {
        let mut d = drawing();
        let mut o = SketchOptions::default();
        let mut draw = |from: (f64, f64), to: (f64, f64)| {
            let at = |i: u32| DVec2::from(from).lerp(DVec2::from(to), f64::from(i) / 10.0);
            let line = Drawing::from_polylines("", &[(0..=10).map(at).collect::<Vec<_>>()]);
            d.strokes.extend(line.strokes);
            o.classes.insert(u32::try_from(d.strokes.len() - 1).unwrap(), StrokeClass::Vein);
            (d.clone(), o.clone())
        };
        draw((4.0, 15.2), (5.5, 16.8));
        let [two, three] = [((7.0, 15.2), (8.5, 17.2)), ((7.0, 14.8), (8.5, 12.8))].map(|(a, b)| draw(a, b));
        let of = |mut e: Evaluator, (d, o): &(Drawing, SketchOptions)| {
            e.update(d, o, Seed::new(1), &Run::plain()).unwrap();
            let leaf = e.model().unwrap().materials.iter().find(|m| m.kind == mesh::MaterialKind::Leaf);
            leaf.and_then(|m| m.texture.clone()).unwrap()
        };
        let (before, after) = (of(Evaluator::default(), &two), of(Evaluator::default(), &three));
        assert_ne!(before.pixels, after.pixels, "a vein is seen");
        assert_eq!(of(Evaluator::previewing(), &three).pixels, before.pixels, "when the pen is lifted");
    }

    #[test]
    fn an_error_keeps_the_last_result() {
        let (mut e, d, o) = (Evaluator::default(), drawing(), SketchOptions::default());
        step(&mut e, &d, &o, 1);
        let before = e.model().cloned();
        assert!(e.update(&Drawing::default(), &o, Seed::new(1), &Run::plain()).is_err());
        assert_eq!(e.model().cloned(), before);
        assert_eq!(step(&mut e, &d, &o, 1), [""; 0]);
    }

    #[test]
    fn the_front_view_is_where_the_drawing_is() {
        let (mut e, d, o) = (Evaluator::default(), drawing(), SketchOptions::default());
        step(&mut e, &d, &o, 1);
        let front = e.front().unwrap();
        let bounds = e.model().unwrap().bounds();
        let top = (DVec2::new(0.0, 39.0) - front.origin) * front.metres_per_unit;
        assert!((bounds.max.y - top.y).abs() < 0.02, "{} {}", bounds.max, top);
    }
}
