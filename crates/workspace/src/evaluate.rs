//! Evaluation: makes changed plants again and offers their meshes as columns.

use burgeon::document::{self, DocumentPlant, Editor, Maker, PlantId};
use burgeon::growth::Obstacle;
use burgeon::ink::{Drawing, StrokeClass};
use burgeon::mesh::Model;
use burgeon::plant::{OrganKind, Shape};
use burgeon::{
    Evaluator, ItemReport, LiteMap, MakeError, Refusal, Run, SceneError, Seed, SketchOptions, set_of,
    sort_by_key,
};

use crate::view::{GUEST, Outcome, PREVIEW_DETAIL, coarser};
use crate::{Column, ObstacleView, PlantView, SceneView, WarningView, Workspace, WorkspaceError};

/// Most trees that are previewed before they are made: in a wood the first ones are enough to show that it is coming.
const MOST_PREVIEWED: usize = 8;

impl Workspace {
    /// Brings every visible plant up to date. While a stroke is drawn, only the current one, coarser.
    ///
    /// A plant that cannot be made gives the reason in its view; the others are made all the same. `run.cancel` reports
    /// the progress of the current plant.
    ///
    /// # Errors
    /// [`WorkspaceError::Cancelled`]; plants made before it stay.
    pub fn evaluate(&mut self, run: &Run<'_>) -> Result<SceneView, WorkspaceError> {
        self.previewed = false;
        self.coarse.clear();
        let current = self.current();
        let drawn = self.draft.is_some();
        let gesture = self.with_gesture();
        if self.guest.is_none() {
            let document = self.editor.document();
            for plant in document.plants().iter().filter(|p| !p.settings().hidden) {
                let id = plant.id();
                run.cancel.forget();
                let outcome = if drawn && Some(id) == current {
                    self.previewed = true;
                    let evaluator = self.preview.get_or_insert_with(Evaluator::previewing);
                    let mut drawing = plant.drawing();
                    // Compared again with each stroke: earlier strokes may be understood otherwise by now.
                    let now = Some((id, self.editor.revision()));
                    if self.followed != now
                        && self.scene.evaluator(id).is_some_and(|whole| evaluator.follow(whole, &drawing))
                    {
                        self.followed = now;
                    }
                    let draft = self.draft.clone();
                    let row = u32::try_from(drawing.strokes.len()).ok();
                    let said = row.zip(draft.as_ref().and_then(|d| d.class));
                    drawing.strokes.extend(draft.map(|d| d.stroke));
                    let item = preview(evaluator, plant, (&drawing, said), run);
                    item.map(|item| self.preview_item = Some(item)).map_err(SceneError::from)
                } else if drawn && self.outcomes.contains_key(&id) {
                    continue; // the pen goes first
                } else if let Some((_, shaped)) = gesture.as_ref().filter(|(held, _)| *held == id) {
                    self.scene.set_previewing(self.held.as_ref().is_some_and(|h| h.large));
                    let updated = self.scene.update(id, shaped, run);
                    self.scene.set_previewing(false);
                    updated
                } else if self.scene.get(id).is_none() && self.kept_bytes() > self.kept.most {
                    Err(SceneError::NoRoom(self.kept_bytes()))
                } else {
                    self.scene.update(id, document, run)
                };
                let outcome = match outcome {
                    Ok(()) => Outcome::Made,
                    Err(e) if e.is_cancelled() => return Err(WorkspaceError::Cancelled),
                    Err(e) if e.is_bare() => Outcome::Bare,
                    Err(e) => Outcome::Failed(e),
                };
                self.outcomes.insert(id, outcome);
            }
        }
        self.make_room();
        self.make_levels(run);
        Ok(self.view())
    }

    /// Sets whether [`Workspace::evaluate`] leaves the fidelity of plants to drawings of very many strokes to
    /// [`Workspace::measure`], which shows them in half of the time. Default: no.
    pub fn measure_later(&mut self, later: bool) {
        self.scene.set_measuring_later(later);
    }

    /// Computes what the last evaluation left for later and returns the view again; `None` where it left nothing.
    ///
    /// # Errors
    /// [`WorkspaceError::Cancelled`]: the measurement is still left for later.
    pub fn measure(&mut self, run: &Run<'_>) -> Result<Option<SceneView>, WorkspaceError> {
        if self.guest.is_some() || self.draft.is_some() || self.held.is_some() {
            return Ok(None);
        }
        let plants = self.editor.document().plants().iter();
        let shown: Vec<PlantId> = plants.filter(|p| !p.settings().hidden).map(DocumentPlant::id).collect();
        let mut any = false;
        for id in shown {
            run.cancel.forget();
            any |= self.scene.measure(id, run).map_err(|_cancelled| WorkspaceError::Cancelled)?;
        }
        Ok(any.then(|| self.view()))
    }

    /// Makes much coarser previews of large trees that [`Workspace::evaluate`] is going to grow: they are seen long
    /// before the whole is ready. Their columns are available until the next evaluation, which grows nothing again.
    ///
    /// They are in no document, file or report. Empty while somebody draws or shapes, which has previews of its own.
    ///
    /// # Errors
    /// [`WorkspaceError::Cancelled`]. [`Workspace::evaluate`] reports all other faults of a plant.
    pub fn preview_trees(&mut self, run: &Run<'_>) -> Result<Vec<PlantView>, WorkspaceError> {
        self.coarse.clear();
        if self.guest.is_some() || self.draft.is_some() || self.held.is_some() {
            return Ok(Vec::new());
        }
        let mut views = Vec::new();
        let document = self.editor.document();
        for plant in document.plants().iter().filter(|p| !p.settings().hidden) {
            let id = plant.id();
            let full = self.scene.get(id).is_none() && self.kept_bytes() > self.kept.most;
            if full || views.len() == MOST_PREVIEWED {
                continue;
            }
            let model = match self.scene.preview(id, document, run) {
                Ok(Some(model)) => model,
                Err(e) if e.is_cancelled() => return Err(WorkspaceError::Cancelled),
                Ok(None) | Err(_) => continue,
            };
            views.push(PlantView::from_model(id, &model, &mut self.textures));
            self.coarse.insert(id, model);
            // The next meshes are new to the shell.
            self.meshes.insert(id, None);
        }
        Ok(views)
    }

    fn view(&mut self) -> SceneView {
        let mut view = SceneView { revision: self.editor.revision(), guest: None, plants: Vec::new() };
        let mut textures = std::mem::take(&mut self.textures);
        let mut given = LiteMap::new();
        if let Some(model) = &self.guest {
            let mut seen = PlantView::from_model(GUEST, model, &mut textures);
            seen.fresh = true;
            view.guest = Some(seen);
        }
        for plant in self.editor.document().plants() {
            let id = plant.id();
            let previewed = self.previewed && self.current() == Some(id);
            let model = self.model(id);
            // `None` for a preview and for a plant of which the page shows nothing: its next meshes are new to the
            // page.
            let shown = !previewed && model.is_some();
            let revision = self.scene.get(id).map(|p| self.levels.name(id, p.revision)).filter(|_| shown);
            let mut seen =
                model.map_or_else(|| PlantView::empty(id), |m| PlantView::from_model(id, m, &mut textures));
            seen.fresh = previewed || model.is_none() || self.meshes.get(&id) != Some(&revision);
            seen.mesh = revision;
            seen.item = self.item(id);
            let told = seen.item.iter().flat_map(|i| &i.told);
            seen.warnings = told.map(WarningView::from).collect();
            seen.stages = if previewed {
                self.preview.as_ref().map_or_else(Vec::new, |e| e.stages_done().to_vec())
            } else {
                self.scene.get(id).map_or_else(Vec::new, |p| p.stages.to_vec())
            };
            let front = if previewed {
                self.preview.as_ref().and_then(Evaluator::front)
            } else {
                self.scene.get(id).and_then(|p| p.front)
            };
            seen.front = front.filter(|_| model.is_some()).map(Into::into);
            seen.days = self.scene.days(id, self.editor.document());
            if let Some(Outcome::Failed(why)) = self.outcomes.get(&id) {
                seen.error = Some(Refusal::from_error(why));
            }
            if let Maker::Tree(t) = &plant.settings().maker {
                seen.obstacles = t.obstacles.iter().map(|o| ObstacleView::from_obstacle(&o.shape)).collect();
            }
            given.insert(id, revision);
            view.plants.push(seen);
        }
        self.meshes = given;
        textures.keep(view.guest.iter().chain(&view.plants));
        self.textures = textures;
        view
    }

    fn item(&self, id: PlantId) -> Option<ItemReport> {
        if !matches!(self.outcomes.get(&id), Some(Outcome::Made)) {
            return None;
        }
        if self.previewed && self.current() == Some(id) {
            return self.preview_item.clone();
        }
        self.scene.get(id).map(|p| p.report())
    }

    /// Returns the model that is shown of a plant.
    pub(crate) fn model(&self, id: PlantId) -> Option<&Model> {
        if id == GUEST {
            return self.variant.as_ref().or(self.guest.as_ref());
        }
        if let Some(coarse) = self.coarse.get(&id) {
            return Some(coarse);
        }
        if matches!(self.outcomes.get(&id), None | Some(Outcome::Bare)) {
            return None;
        }
        if self.previewed && self.current() == Some(id) {
            return self.preview.as_ref()?.model();
        }
        self.levels.get(id).map(|l| &l.model).or_else(|| self.scene.get(id).map(|p| p.model))
    }

    /// Returns a column of a mesh of the last view; empty for a mesh that does not exist.
    pub fn column(&self, plant: PlantId, part: usize, column: Column) -> &[f32] {
        let part = self.model(plant).and_then(|m| m.parts.get(part));
        part.map_or(&[], |p| column.values(&p.mesh))
    }

    /// Returns the indices of a mesh of the last view, three for each triangle.
    pub fn indices(&self, plant: PlantId, part: usize) -> &[u32] {
        let part = self.model(plant).and_then(|m| m.parts.get(part));
        part.map_or(&[], |p| p.mesh.triangles.as_flattened())
    }

    /// Returns the corners of an obstacle that is a mesh, three for each triangle; empty for others.
    pub fn obstacle(&self, plant: PlantId, row: usize) -> Vec<f32> {
        let plant = self.editor.document().plant(plant);
        let Some(Maker::Tree(tree)) = plant.map(|p| &p.settings().maker) else { return Vec::new() };
        let Some(Obstacle::Mesh { vertices, triangles }) = tree.obstacles.get(row).map(|o| &*o.shape) else {
            return Vec::new();
        };
        let corners = triangles.iter().flatten().filter_map(|&i| vertices.get(i as usize));
        corners.flat_map(|p| p.as_vec3().to_array()).collect()
    }

    /// Returns the RGBA bytes of a texture by its number in the last view; empty for one that is not in it.
    pub fn texture(&self, number: u32) -> &[u8] {
        self.textures.get(number).map_or(&[], |t| &t.pixels)
    }

    /// Makes the current plant of another seed for a preview, with fewer triangles if it is a drawing;
    /// [`Workspace::end_variant`] returns to the plant itself.
    ///
    /// # Errors
    /// [`WorkspaceError::Cancelled`], or the reason why it cannot be made.
    pub fn variant(&mut self, seed: Seed, detail: f64, run: &Run<'_>) -> Result<PlantView, WorkspaceError> {
        let id = self.must()?;
        let mut document = Editor::new(self.editor.document().clone());
        let mut change = |c| match document.run(c) {
            Ok(()) | Err(document::CommandError::Nothing(_)) => Ok(()),
            Err(e) => Err(e),
        };
        change(document::PlantCommand::SetSeed(seed).for_plant(id))?;
        let coarse = coarser(self.editor.document(), id, detail);
        coarse.map_or(Ok(()), change)?;
        let mut aside = self.scene.aside(document.document().plant(id));
        aside.update(id, document.document(), run)?;
        let model = aside.get(id).map(|p| p.model.clone()).ok_or(WorkspaceError::NothingMade)?;
        let seen = PlantView::from_model(GUEST, &model, &mut self.textures);
        self.variant = Some(model);
        Ok(seen)
    }

    /// Returns to the plant itself.
    pub fn end_variant(&mut self) {
        self.variant = None;
    }

    /// Returns pairs of points of the current plant's axes: x, y, z and order of each; then of its blades, from root to
    /// tip, with "order" 100 (leaves) or 101 (petals). Empty while a model file is shown.
    pub fn skeleton(&self) -> Vec<f32> {
        let id = self.current().filter(|&id| self.guest.is_none() && self.model(id).is_some());
        let previewed = self.preview.as_ref().filter(|_| self.previewed).and_then(Evaluator::plant);
        let plant = id.and_then(|id| previewed.or_else(|| self.scene.get(id)?.plant));
        let Some(plant) = plant else { return Vec::new() };
        let mut out = Vec::new();
        for axis in &plant.axes {
            let nodes = plant.nodes.position.get(axis.nodes.start as usize..axis.nodes.end as usize);
            for pair in nodes.unwrap_or_default().windows(2) {
                for p in pair {
                    let p = p.as_vec3();
                    #[expect(clippy::cast_precision_loss, reason = "orders are small")]
                    out.extend([p.x, p.y, p.z, axis.order as f32]);
                }
            }
        }
        for organ in &plant.organs {
            let Some(Shape::Blade(blade)) = plant.shapes.get(organ.shape.index()) else { continue };
            let tip = organ.frame.origin + organ.frame.along * (blade.length() * organ.scale);
            let kind = if organ.kind == OrganKind::Petal { 101.0 } else { 100.0 };
            for p in [organ.frame.origin, tip].map(|p| p.as_vec3()) {
                out.extend([p.x, p.y, p.z, kind]);
            }
        }
        out
    }

    /// Estimates how many bytes the results of all plants take.
    pub fn kept_bytes(&self) -> usize {
        self.scene.kept().map(|(_, bytes)| bytes).sum()
    }

    /// Sets how many bytes the results of all plants may take before no further plant is made: such a plant reports the
    /// limit, and is made when there is room again. Default [`crate::SHOWN_BYTES`].
    pub fn show_at_most(&mut self, bytes: usize) {
        self.kept.most = bytes;
    }

    /// Sets how many bytes the results of all plants may take before those of hidden or deleted plants are dropped.
    /// Visible results always stay. From the next evaluation on; default [`crate::KEPT_BYTES`].
    pub fn keep_at_most(&mut self, bytes: usize) {
        self.kept.limit = bytes;
    }

    /// Drops results that are not shown until the rest fits. A plant that returns is made again, with the same bits.
    pub(crate) fn make_room(&mut self) {
        let plants = self.editor.document().plants().iter();
        let shown = set_of(plants.filter(|p| !p.settings().hidden).map(DocumentPlant::id));
        self.kept.now += 1;
        for &id in shown.keys() {
            self.kept.shown.insert(id, self.kept.now);
        }
        let last = |id| self.kept.shown.get(&id).copied().unwrap_or(0);
        let aside = self.scene.kept().filter(|(id, _)| !shown.contains_key(id));
        let mut aside: Vec<(u64, PlantId)> = aside.map(|(id, _)| (last(id), id)).collect();
        sort_by_key(&mut aside, |row| *row);
        for (_, id) in aside {
            // Counted anew: results that a copy shares stay as long as the copy.
            if self.kept_bytes() <= self.kept.limit {
                break;
            }
            self.scene.forget(id);
        }
        let kept = set_of(self.scene.kept().map(|(id, _)| id));
        self.kept.shown.retain(|id, _| kept.contains_key(id));
        self.outcomes.retain(|id, _| kept.contains_key(id) || shown.contains_key(id));
    }
}

/// Makes the plant of a stroke that is still being drawn.
fn preview(
    evaluator: &mut Evaluator,
    plant: &DocumentPlant,
    (drawing, said): (&Drawing, Option<(u32, StrokeClass)>),
    run: &Run<'_>,
) -> Result<ItemReport, MakeError> {
    let mut options = SketchOptions::from_plant(plant);
    if let Some((row, class)) = said {
        options.classes.insert(row, class);
    }
    // Fast while the pen is down, fine when it is lifted.
    options.skin.detail = (options.skin.detail * PREVIEW_DETAIL).max(0.1);
    evaluator.update(drawing, &options, plant.settings().seed, run)
}
