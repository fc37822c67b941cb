//! A tree that changes: growth, look, hand edits and meshes, each kept until one of its inputs changes.
//!
//! `spec, seed -> grown | + look -> dressed | + edits -> shaped | + skin -> model`

use base::{Report, Run, Seed, Stopped, Telling, Warning};
use document::PlantEdit;
use growth::{BlossomSpec, Grown, Look, Method, TreeSpec};
use makers::LeafTemplate;
use mesh::Model;
use plant::{Blade, BladeForm, Plant};
use skin::{FoliageStyle, Layout, SkinSpec, SurfacePictures, coarser, coarser_with};

use super::look::{dressed, paint, tint};
use super::{Inside, OddMesh, TreeError, TreeOptions, scale_to_height, tree_blade};
use crate::checks::{check_plant, check_tree};
use crate::levels::LaidOut;
use crate::report::{Counts, GrowthReport, ItemReport, TimingsMs};
use crate::shaping::{EditReport, Shaper};

/// Makes trees of a description that changes: an update recomputes only what a change affects.
///
/// A hand edit, a colour or a finer mesh grows nothing. Guaranteed: the same result as from a fresh evaluator; after an
/// error the last model stays.
///
/// ```
/// use burgeon::shape::{AxisKey, HandEdit};
/// use burgeon::{Run, Seed, TreeEvaluator, TreeOptions, TreeSpec};
/// let (spec, mut options) = (TreeSpec::default(), TreeOptions::default());
/// let mut evaluator = TreeEvaluator::default();
/// evaluator.update(&spec, Seed::new(1), &options, &Run::plain())?;
/// let cut = HandEdit::Prune { axis: AxisKey::Path(vec![0, 0]), at: 0.0 };
/// options.edits.push(cut.into());
/// evaluator.update(&spec, Seed::new(1), &options, &Run::plain())?;
/// assert_eq!(evaluator.stages_done(), ["shape", "mesh"]);
/// # Ok::<(), burgeon::TreeError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct TreeEvaluator {
    grown: Option<Raw>,
    dressed: Option<Dressed>,
    shaper: Shaper,
    shaped: Option<Shaped>,
    model: Option<(Skinned, Model)>,
    /// Places of the plant's parts in the model.
    layout: Layout,
    /// Parts of the model inside obstacles.
    inside: Option<Inside>,
    /// Whether the model is of a previous plant: shown until there is another, in case an update is stopped.
    stale: bool,
    /// Times of the stages that a preview already computed, for the update that follows it.
    begun: Report,
    done: Vec<&'static str>,
    /// See [`crate::SceneEvaluator::set_previewing`].
    pub(crate) previewing: bool,
}

/// Result of growth.
#[derive(Clone, Debug)]
struct Raw {
    from: (TreeSpec, Blade, Seed),
    grown: Grown,
    odd: Vec<OddMesh>,
    warnings: Vec<Warning>,
}

/// A tree with colours and blossoms.
#[derive(Clone, Debug)]
struct Dressed {
    from: (Look, BlossomSpec, bool, Option<f64>),
    grown: Grown,
}

#[derive(Clone, Debug)]
struct Shaped {
    edits: Vec<PlantEdit>,
    plant: Plant,
    told: Vec<EditReport>,
}

/// Most nodes and organs of a tree without a coarse preview: the whole appears as quickly.
const SMALL: usize = 4_000;
/// Level of a preview: a quarter of the leaves, which cover the same area, and the longer half of the axes. With an
/// eighth, crowns of small leaves are bare.
const LOOK_LEVEL: u32 = 2;

/// Earliest season with flowers.
const EARLIEST_FLOWERS: f64 = -0.9;

/// Inputs of a model in addition to its plant.
pub(super) type Skinned = (SkinSpec, Look, Option<LeafTemplate>);

impl TreeEvaluator {
    /// Updates everything and reports. [`TreeOptions::levels`] are left to [`super::make_tree`].
    ///
    /// # Errors
    /// [`TreeError`]: a fault of the spec, or cancelled.
    pub fn update(
        &mut self,
        spec: &TreeSpec,
        seed: Seed,
        options: &TreeOptions,
        run: &Run<'_>,
    ) -> Result<ItemReport, TreeError> {
        let (report, obstacles) = self.shaped(spec, seed, options, run)?;
        self.meshed(spec, seed, options, (report, obstacles), run)
    }

    /// Updates as [`Self::update`] does, for programs without hand edits: a program that calls only this links no code
    /// of hand edits. [`TreeOptions::edits`] must be empty.
    ///
    /// # Errors
    /// [`TreeError`]: a fault of the spec, or cancelled.
    pub fn update_unedited(
        &mut self,
        spec: &TreeSpec,
        seed: Seed,
        options: &TreeOptions,
        run: &Run<'_>,
    ) -> Result<ItemReport, TreeError> {
        debug_assert!(options.edits.is_empty(), "there is nothing here that does edits by hand");
        let begun = self.grown_and_dressed(spec, seed, options, run)?;
        self.stale |= self.shaped.take().is_some();
        self.meshed(spec, seed, options, begun, run)
    }

    /// Makes meshes and report.
    fn meshed(
        &mut self,
        spec: &TreeSpec,
        seed: Seed,
        options: &TreeOptions,
        (mut report, obstacles): (Report, growth::Obstacles),
        run: &Run<'_>,
    ) -> Result<ItemReport, TreeError> {
        if self.mesh(spec, seed, options, &mut report, run)? {
            let model = self.model().filter(|_| !self.previewing);
            self.inside = model.and_then(|m| Inside::measure(m, &obstacles));
        }
        Ok(self.item(spec, options, &report))
    }

    /// Returns a much coarser model of the tree that [`Self::update`] will make, without textures, if that is a large
    /// tree that has not been grown yet: it is ready long before the whole. The update that follows grows nothing
    /// again.
    ///
    /// # Errors
    /// [`TreeError`]: a fault of the spec, or cancelled.
    pub fn preview(
        &mut self,
        spec: &TreeSpec,
        seed: Seed,
        options: &TreeOptions,
        run: &Run<'_>,
    ) -> Result<Option<Model>, TreeError> {
        let (report, obstacles) = self.shaped(spec, seed, options, run)?;
        self.begun = report;
        Ok(self.look((spec, seed, options), &obstacles, run)?.map(|(model, _)| model))
    }

    /// Returns what [`Self::preview`] does for a program without hand edits ([`Self::update_unedited`]), with the coarser
    /// plant and the places of its parts in the model.
    ///
    /// # Errors
    /// [`TreeError`]: a fault of the spec, or cancelled.
    pub fn preview_unedited(
        &mut self,
        spec: &TreeSpec,
        seed: Seed,
        options: &TreeOptions,
        run: &Run<'_>,
    ) -> Result<Option<LaidOut>, TreeError> {
        let (report, obstacles) = self.grown_and_dressed(spec, seed, options, run)?;
        self.begun = report;
        self.look((spec, seed, options), &obstacles, run)
    }

    /// Makes the coarse model of a large tree that has just been grown.
    fn look(
        &self,
        (spec, seed, options): (&TreeSpec, Seed, &TreeOptions),
        obstacles: &growth::Obstacles,
        run: &Run<'_>,
    ) -> Result<Option<LaidOut>, TreeError> {
        let plant = self.plant().filter(|p| p.organs.len() + p.nodes.position.len() > SMALL);
        let Some(plant) = plant.filter(|_| self.done.contains(&"structure")) else { return Ok(None) };
        let fine = skin_spec(spec, seed, options);
        let (mut copy, skin) = coarser(plant, &fine, LOOK_LEVEL);
        keep_clear(&mut copy, (&skin, &fine), plant, LOOK_LEVEL, obstacles);
        let from = (SkinSpec { textures: false, ..skin }, spec.look.clone(), None);
        let (model, layout) = skinned(&copy, &from, run)?;
        Ok(Some((model, (copy, layout))))
    }

    /// Computes everything but the meshes.
    fn shaped(
        &mut self,
        spec: &TreeSpec,
        seed: Seed,
        options: &TreeOptions,
        run: &Run<'_>,
    ) -> Result<(Report, growth::Obstacles), TreeError> {
        let (mut report, obstacles) = self.grown_and_dressed(spec, seed, options, run)?;
        let start = run.clock.now_ms();
        self.shape(&obstacles, options, run)?;
        report.book("depth", run.clock.now_ms() - start);
        Ok((report, obstacles))
    }

    /// Computes everything but hand edits and meshes.
    fn grown_and_dressed(
        &mut self,
        spec: &TreeSpec,
        seed: Seed,
        options: &TreeOptions,
        run: &Run<'_>,
    ) -> Result<(Report, growth::Obstacles), TreeError> {
        let mut report = core::mem::take(&mut self.begun);
        if report.stages.is_empty() {
            self.done.clear();
        }
        let grown = self.grow(spec, seed, options, &mut report, run);
        let obstacles = grown.map_err(|e| e.naming(&options.obstacles))?;
        self.dress(spec, &obstacles, seed, options);
        Ok((report, obstacles))
    }

    fn grow(
        &mut self,
        spec: &TreeSpec,
        seed: Seed,
        options: &TreeOptions,
        report: &mut Report,
        run: &Run<'_>,
    ) -> Result<growth::Obstacles, TreeError> {
        let leaf = options.leaf.as_ref();
        if let (Some(file), None) = (&spec.blade.file, leaf) {
            return Err(TreeError::File { file: file.clone() });
        }
        spec.check(&run.budget)?;
        let obstacles = growth::Obstacles::new(&spec.obstacles, spec.clearance_m)?;
        let blade = leaf.map_or_else(|| tree_blade(&spec.blade), |l| l.scaled(1.0));
        let same = |k: &Raw| k.from.0.grows_like(spec) && (&k.from.1, k.from.2) == (&blade, seed);
        if self.grown.as_ref().is_some_and(same) {
            return Ok(obstacles);
        }
        let mut told = Report::default();
        let odd = spec.obstacles.iter().enumerate().filter_map(|(i, o)| OddMesh::check(i, o)).collect();
        let grown = growth::grow(spec, Some(blade.clone()), seed, run, &mut told)?;
        for stage in &told.stages {
            report.book(if stage.name == "grow" { "structure" } else { "depth" }, stage.ms);
        }
        (self.dressed, self.shaped, self.stale) = (None, None, true);
        self.done.extend(["structure", "depth"]);
        self.grown = Some(Raw { from: (spec.clone(), blade, seed), grown, odd, warnings: told.warnings });
        Ok(obstacles)
    }

    fn dress(&mut self, spec: &TreeSpec, obstacles: &growth::Obstacles, seed: Seed, options: &TreeOptions) {
        let Some(raw) = &self.grown else { return };
        let pictured = options.skin.textures && options.leaf.as_ref().is_some_and(LeafTemplate::has_picture);
        let height = options.height_m.filter(|_| spec.obstacles.is_empty());
        let from = (spec.look.clone(), spec.blossom.clone(), pictured, height);
        if self.dressed.as_ref().is_some_and(|d| d.from == from) {
            return;
        }
        let mut grown = raw.grown.clone();
        // Flowers replace some leaves. Nothing flowers in autumn, or before spring.
        if (EARLIEST_FLOWERS..=0.0).contains(&spec.look.leaf_season()) {
            let share = spec.blossom.share * flowering(spec);
            let blossom = BlossomSpec { share, ..spec.blossom.clone() };
            growth::add_blossom(&blossom, &mut grown.plant, &raw.grown.flowers, obstacles, seed);
        }
        let away = tint(&spec.look, &mut grown.plant, pictured, seed);
        (grown.leaves.kept, grown.leaves.fallen) = (grown.leaves.kept - away, grown.leaves.fallen + away);
        if let Some(height) = height {
            scale_to_height(&mut grown, height);
        }
        self.shaper.forget();
        (self.shaped, self.stale) = (None, true);
        self.dressed = Some(Dressed { from, grown });
    }

    fn shape(
        &mut self,
        obstacles: &growth::Obstacles,
        options: &TreeOptions,
        run: &Run<'_>,
    ) -> Result<(), TreeError> {
        let Some(dressed) = &self.dressed else { return Ok(()) };
        if self.shaped.as_ref().map_or(&[][..], |s| &s.edits) == options.edits {
            return Ok(());
        }
        let shaped = if options.edits.is_empty() {
            self.shaper.forget();
            None
        } else {
            let context = shape::Context { pipe_exponent: None, obstacles: obstacles.clone() };
            let (plant, told) = self.shaper.shape(&dressed.grown.plant, &options.edits, &context, run)?;
            Some(Shaped { edits: options.edits.clone(), plant, told })
        };
        (self.shaped, self.stale) = (shaped, true);
        self.done.push("shape");
        Ok(())
    }

    /// Makes the meshes; returns whether the model changed.
    fn mesh(
        &mut self,
        spec: &TreeSpec,
        seed: Seed,
        options: &TreeOptions,
        report: &mut Report,
        run: &Run<'_>,
    ) -> Result<bool, TreeError> {
        let from = (skin_spec(spec, seed, options), spec.look.clone(), options.leaf.clone());
        if !self.stale && self.model.as_ref().is_some_and(|(f, _)| *f == from) {
            return Ok(false);
        }
        let Some(plant) = self.plant() else { return Ok(false) };
        // The progress that growth reported is complete.
        let telling = Telling::from(run.cancel.share().unwrap_or(0.0), run);
        let model = report.stage("mesh", run.clock, |_| skinned(plant, &from, &telling.run()));
        let (model, layout) = model?;
        (self.model, self.layout, self.stale) = (Some((from, model)), layout, false);
        self.done.push("mesh");
        Ok(true)
    }

    /// Returns a coarser copy of the model, with the same materials; `None` before an update. See [`coarser`].
    ///
    /// # Errors
    /// [`TreeError`].
    pub fn at_level(&self, level: u32, run: &Run<'_>) -> Result<Option<Model>, TreeError> {
        Ok(self.laid_out_at(level, run)?.map(|(model, _)| model))
    }

    /// Returns the same as [`Self::at_level`], and the coarser plant with the places of its parts in the model.
    ///
    /// # Errors
    /// [`TreeError`].
    pub fn laid_out_at(&self, level: u32, run: &Run<'_>) -> Result<Option<LaidOut>, TreeError> {
        let (Some(raw), Some(plant), Some((from, _))) = (&self.grown, self.plant(), &self.model) else {
            return Ok(None);
        };
        let (spec, (fine, look, leaf)) = (&raw.from.0, from);
        let obstacles = growth::Obstacles::new(&spec.obstacles, spec.clearance_m)?;
        let (mut copy, skin) = coarser(plant, fine, level);
        keep_clear(&mut copy, (&skin, fine), plant, level, &obstacles);
        let (model, layout) = skinned(&copy, &(skin, look.clone(), leaf.clone()), run)?;
        Ok(Some((model, (copy, layout))))
    }

    fn item(&self, spec: &TreeSpec, options: &TreeOptions, report: &Report) -> ItemReport {
        let (Some(raw), Some(dressed), Some(plant), Some((_, model))) =
            (&self.grown, &self.dressed, self.plant(), &self.model)
        else {
            return ItemReport::default(); // update fills all of them before it comes here
        };
        let growth = GrowthReport::new(spec, &dressed.grown, self.inside);
        let mut checks = Report::default();
        if !self.previewing {
            check_plant(plant, &mut checks);
            check_tree(spec, &raw.grown.plant, &growth, &mut checks);
        }
        // Some scattered points are always out of reach; this is worth a warning only when they were given, or most of
        // them.
        let given = matches!(spec.method, Method::Points { .. });
        let many = 2 * growth.unreachable > growth.attractors;
        let told = raw.warnings.iter().filter(|w| given || many || w.code != "attractors-unreached");
        let mut odd = Report::default();
        raw.odd.iter().for_each(|mesh| mesh.tell(&options.obstacles, &mut odd));
        let mut warnings: Vec<Warning> = odd.warnings;
        warnings.extend(told.cloned());
        let edits = self.shaped.as_ref();
        warnings.extend(edits.into_iter().flat_map(|s| s.told.iter().filter_map(|t| t.warning(&s.edits))));
        let mut item = ItemReport {
            name: spec.name.clone(),
            counts: Counts {
                vertices: model.vertex_count() as u64,
                triangles: model.triangle_count() as u64,
                ..Counts::from_plant(plant)
            },
            timings_ms: TimingsMs::from_report(report),
            digest: if self.previewing { String::new() } else { plant.digest_hex() },
            growth: Some(growth),
            edits: edits.map_or_else(Vec::new, |s| s.told.clone()),
            ..ItemReport::default()
        }
        .warning(warnings);
        item.add_checks(checks);
        item
    }

    /// Returns the stages that the last update recomputed: `structure`, `depth`, `shape`, `mesh`.
    pub fn stages_done(&self) -> &[&'static str] {
        &self.done
    }

    /// Returns the plant of the last successful update, with its hand edits.
    pub fn plant(&self) -> Option<&Plant> {
        let grown = || self.dressed.as_ref().map(|d| &d.grown.plant);
        self.shaped.as_ref().map(|s| &s.plant).or_else(grown)
    }

    /// Returns the model of the last successful update.
    pub fn model(&self) -> Option<&Model> {
        self.model.as_ref().map(|(_, m)| m)
    }

    /// Returns the places of the plant's parts in the model of the last update; `None` where that is of a previous
    /// plant.
    pub fn layout(&self) -> Option<&Layout> {
        self.model.as_ref().filter(|_| !self.stale).map(|_| &self.layout)
    }

    /// Returns the model of the last update with its plant and the places of its parts; `None` where it is of a
    /// previous plant.
    pub(super) fn laid_out(&self) -> Option<(&Model, &Plant, &Layout)> {
        Some((self.model()?, self.plant()?, self.layout()?))
    }

    /// Takes the grown tree with its hand edits, its model, and the places of its parts; the evaluator is then empty.
    pub(super) fn take(&mut self) -> Option<(Grown, Model, Layout)> {
        let Self { dressed, shaped, model, layout, .. } = std::mem::take(self);
        let mut grown = dressed?.grown;
        if let Some(shaped) = shaped {
            grown.plant = shaped.plant;
        }
        Some((grown, model?.1, layout))
    }
}

/// Returns a tree without meshes, as [`TreeEvaluator::update`] makes it.
pub(crate) fn grow_plant(spec: &TreeSpec, seed: Seed, run: &Run<'_>) -> Result<Plant, TreeError> {
    let mut evaluator = TreeEvaluator::default();
    evaluator.shaped(spec, seed, &TreeOptions::default(), run)?;
    Ok(evaluator.dressed.map(|d| d.grown.plant).unwrap_or_default())
}

/// Returns the meshes of a plant of a spec at a level, 0 for the plant itself, as [`TreeEvaluator::at_level`] makes
/// them; textures follow from the seed.
pub(crate) fn mesh_plant(
    plant: &Plant,
    (spec, seed): (&TreeSpec, Seed),
    options: &TreeOptions,
    (level, painted): (u32, Option<&skin::Shoots>),
    run: &Run<'_>,
) -> Result<Model, Stopped> {
    let fine = skin_spec(spec, seed, options);
    if level == 0 {
        return Ok(skinned(plant, &(fine, spec.look.clone(), options.leaf.clone()), run)?.0);
    }
    let (copy, skin) = coarser_with(plant, &fine, level, painted);
    Ok(skinned(&copy, &(skin, spec.look.clone(), options.leaf.clone()), run)?.0)
}

/// Gives leaves of a coarser copy of a plant that may enter an obstacle a smaller size, see [`skin::keep_out`].
fn keep_clear(
    copy: &mut Plant,
    skins: (&SkinSpec, &SkinSpec),
    plant: &Plant,
    level: u32,
    obstacles: &growth::Obstacles,
) {
    if !obstacles.is_empty() {
        let is_free = |frame: &plant::Frame, scale: f64, corners: &[glam::DVec3]| {
            obstacles.admit(frame, scale, corners)
        };
        skin::keep_out(copy, skins, plant, level, &is_free);
    }
}

fn skin_spec(spec: &TreeSpec, seed: Seed, options: &TreeOptions) -> SkinSpec {
    // A leaf of the user has veins of its own, or those of most leaves.
    let form = options.leaf.as_ref().map_or(spec.blade.form, |_| BladeForm::default());
    // It also has its own texture, which no atlas shows.
    let foliage = if options.leaf.is_some() { FoliageStyle::Outlines } else { options.skin.foliage };
    dressed(SkinSpec { seed, foliage, ..options.skin.clone() }, &spec.look, form)
}

pub(super) fn skinned(
    plant: &Plant,
    (skin, look, leaf): &Skinned,
    run: &Run<'_>,
) -> Result<(Model, Layout), Stopped> {
    let (mut model, layout) = skin::skin_laid_out(plant, skin, SurfacePictures::default(), None, run)?;
    paint(look, &mut model);
    if let Some(leaf) = leaf {
        leaf.dress(&mut model, &skin.worn);
    }
    Ok((model, layout))
}

/// Shares of a life between which a plant begins to flower: of trees of forty years, seedlings flower after five to
/// fifteen.
const JUVENILE: [f64; 2] = [0.1, 0.3];

/// Returns the share of its flowers that a plant has at its age.
fn flowering(spec: &TreeSpec) -> f64 {
    let life = spec.age.zip(spec.years).map_or(1.0, |(age, years)| f64::from(age) / f64::from(years.max(1)));
    base::ops::smoothstep(JUVENILE[0], JUVENILE[1], life)
}
