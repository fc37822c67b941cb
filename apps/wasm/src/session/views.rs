//! What the page is shown: evaluation, meshes, figures.

use std::collections::BTreeMap;
use std::sync::Arc;

use burgeon::document::{self, DocumentPlant, Editor, Maker, PlantId};
use burgeon::growth::Obstacle;
use burgeon::ink::Drawing;
use burgeon::mesh::{AlphaMode, Model, Texture};
use burgeon::plant::{OrganKind, Shape};
use burgeon::{CancelToken, Evaluator, ItemReport, MakeError, Run, SceneError, Seed, SketchOptions};

use super::shaping::coarser;
use super::{Column, GUEST, Outcome, PREVIEW_DETAIL, Session, Told, words};
use crate::host::{Attentive, BUDGET, Host};
use crate::wire::{Front, MaterialView, ObstacleView, PartView, PlantView, TextureView, View};

impl Session {
    pub(crate) fn evaluate(&mut self) -> Told<String> {
        let cancel = CancelToken::new();
        let executor = Attentive(&cancel);
        let run = Run { cancel: &cancel, executor: &executor, clock: &Host, budget: BUDGET };
        self.previewed = false;
        let current = self.current_id();
        let drawn = self.draft.is_some();
        let gesture = self.with_gesture();
        if self.guest.is_none() {
            let document = self.editor.document();
            self.scene.retain(document);
            for plant in document.plants().iter().filter(|p| !p.settings().hidden) {
                let id = plant.id();
                cancel.forget();
                let outcome = if drawn && Some(id) == current {
                    self.previewed = true;
                    let look = self.preview.get_or_insert_with(Evaluator::previewing);
                    let mut drawing = plant.drawing();
                    // With each stroke anew: what came before may be understood otherwise by now.
                    let now = Some((id, self.editor.revision()));
                    if self.followed != now
                        && self.scene.evaluator(id).is_some_and(|whole| look.follow(whole, &drawing))
                    {
                        self.followed = now;
                    }
                    drawing.strokes.extend(self.draft.clone());
                    let looked = preview(look, plant, &drawing, &run);
                    looked.map(|item| self.preview_item = Some(item)).map_err(SceneError::from)
                } else if drawn && self.outcomes.contains_key(&id) {
                    continue; // the pen goes first
                } else if let Some((_, shaped)) = gesture.as_ref().filter(|(held, _)| *held == id) {
                    self.scene.set_looking(self.held.as_ref().is_some_and(|h| h.large));
                    let looked = self.scene.update(id, shaped, &run);
                    self.scene.set_looking(false);
                    looked
                } else {
                    self.scene.update(id, document, &run)
                };
                let outcome = match outcome {
                    Ok(()) => Outcome::Made,
                    Err(e) if e.is_cancelled() => return Err("cancelled".into()),
                    Err(e) if e.is_bare() => Outcome::Bare,
                    Err(e) => Outcome::Failed(words(e)),
                };
                self.outcomes.insert(id, outcome);
            }
        }
        let view = self.view();
        serde_json::to_string(&view).map_err(words)
    }

    fn view(&mut self) -> View {
        let mut view = View { revision: self.editor.revision(), guest: None, plants: Vec::new() };
        let mut textures = std::mem::take(&mut self.textures);
        let mut given = BTreeMap::new();
        if let Some(model) = &self.guest {
            let mut seen = plant_view(GUEST, model, &mut textures);
            seen.fresh = true;
            view.guest = Some(seen);
        }
        for plant in self.editor.document().plants() {
            let id = plant.id();
            let previewed = self.previewed && self.current_id() == Some(id);
            let model = self.model(id);
            // None for what the page shows nothing of, or a look: whatever comes next is new to it.
            let shown = !previewed && model.is_some();
            let revision = self.scene.get(id).map(|p| p.revision).filter(|_| shown);
            let mut seen = model.map_or_else(|| PlantView::empty(id.0), |m| plant_view(id, m, &mut textures));
            seen.fresh = previewed || model.is_none() || self.meshes.get(&id) != Some(&revision);
            seen.item = self.item(id);
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
            seen.front = front.filter(|_| model.is_some()).map(|f| Front {
                metres_per_unit: f.metres_per_unit,
                x: f.origin.x,
                y: f.origin.y,
            });
            seen.days = self.scene.days(id, self.editor.document());
            if let Some(Outcome::Failed(why)) = self.outcomes.get(&id) {
                seen.error = Some(why.clone());
            }
            if let Maker::Tree(t) = &plant.settings().maker {
                seen.obstacles = t.obstacles.iter().map(|o| ObstacleView::of(&o.shape)).collect();
            }
            given.insert(id, revision);
            view.plants.push(seen);
        }
        self.meshes = given;
        self.textures = textures;
        view
    }

    fn item(&self, id: PlantId) -> Option<ItemReport> {
        if !matches!(self.outcomes.get(&id), Some(Outcome::Made)) {
            return None;
        }
        if self.previewed && self.current_id() == Some(id) {
            return self.preview_item.clone();
        }
        self.scene.get(id).map(|p| p.item.clone())
    }

    /// What is shown of a plant.
    pub(super) fn model(&self, id: PlantId) -> Option<&Model> {
        if id == GUEST {
            return self.variant.as_ref().or(self.guest.as_ref());
        }
        if matches!(self.outcomes.get(&id), None | Some(Outcome::Bare)) {
            return None;
        }
        if self.previewed && self.current_id() == Some(id) {
            return self.preview.as_ref()?.model();
        }
        self.scene.get(id).map(|p| p.model)
    }

    pub(crate) fn column(&self, plant: u32, part: usize, column: Column) -> Vec<f32> {
        let Some(part) = self.model(PlantId(plant)).and_then(|m| m.parts.get(part)) else {
            return Vec::new();
        };
        let mesh = &part.mesh;
        match column {
            Column::Positions => mesh.positions.as_flattened().to_vec(),
            Column::Normals => mesh.normals.as_flattened().to_vec(),
            Column::Uvs => mesh.uvs.as_flattened().to_vec(),
            Column::Colors => mesh.colors.as_flattened().to_vec(),
        }
    }

    pub(crate) fn indices(&self, plant: u32, part: usize) -> Vec<u32> {
        let part = self.model(PlantId(plant)).and_then(|m| m.parts.get(part));
        part.map_or_else(Vec::new, |p| p.mesh.triangles.as_flattened().to_vec())
    }

    /// Corners of an obstacle that is a mesh, three to a triangle; empty for others.
    pub(crate) fn obstacle(&self, plant: u32, row: usize) -> Vec<f32> {
        let plant = self.editor.document().plant(PlantId(plant));
        let Some(Maker::Tree(tree)) = plant.map(|p| &p.settings().maker) else { return Vec::new() };
        let Some(Obstacle::Mesh { vertices, triangles }) = tree.obstacles.get(row).map(|o| &*o.shape) else {
            return Vec::new();
        };
        let corners = triangles.iter().flatten().filter_map(|&i| vertices.get(i as usize));
        corners.flat_map(|p| p.as_vec3().to_array()).collect()
    }

    pub(crate) fn texture(&self, number: usize) -> Vec<u8> {
        self.textures.get(number).map_or_else(Vec::new, |t| t.pixels.clone())
    }

    /// Makes the current plant of another seed for a look, a drawing with fewer triangles;
    /// [`Session::end_variant`] goes back.
    pub(crate) fn variant(&mut self, seed: &str, detail: f64) -> Told<String> {
        let seed = Seed::new(seed.parse().ok().ok_or("the seed is a whole number")?);
        let id = self.must()?;
        let mut document = Editor::new(self.editor.document().clone());
        let mut change = |c| match document.run(c) {
            Ok(()) | Err(document::CommandError::Nothing(_)) => Ok(()),
            Err(e) => Err(words(e)),
        };
        change(document::PlantCommand::SetSeed(seed).of(id))?;
        let coarse = coarser(self.editor.document(), id, detail);
        coarse.map_or(Ok(()), change)?;
        let mut aside = self.scene.clone();
        let cancel = CancelToken::new();
        let run = Run { cancel: &cancel, executor: &Attentive(&cancel), clock: &Host, budget: BUDGET };
        aside.update(id, document.document(), &run).map_err(words)?;
        let model = aside.get(id).map(|p| p.model.clone()).ok_or("there is no plant yet")?;
        let seen = plant_view(GUEST, &model, &mut self.textures);
        self.variant = Some(model);
        serde_json::to_string(&seen).map_err(words)
    }

    pub(crate) fn end_variant(&mut self) {
        self.variant = None;
    }

    /// Pairs of points of the current plant's axes: x, y, z and order of each; then of its blades, from root to tip,
    /// with "order" 100 (leaves) or 101 (petals). Empty while a model file is looked at.
    pub(crate) fn skeleton(&self) -> Vec<f32> {
        let id = self.current_id().filter(|&id| self.guest.is_none() && self.model(id).is_some());
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
}

/// The plant of a stroke that is still being drawn.
fn preview(
    look: &mut Evaluator,
    plant: &DocumentPlant,
    drawing: &Drawing,
    run: &Run<'_>,
) -> Result<ItemReport, MakeError> {
    let mut options = SketchOptions::of_plant(plant);
    // Fast while the pen is down, fine when it is lifted.
    options.skin.detail = (options.skin.detail * PREVIEW_DETAIL).max(0.1);
    look.update(drawing, &options, plant.settings().seed, run)
}

fn plant_view(id: PlantId, model: &Model, textures: &mut Vec<Arc<Texture>>) -> PlantView {
    let mut view = PlantView::empty(id.0);
    let bounds = model.bounds();
    if !bounds.is_empty() {
        (view.min, view.max) = (bounds.min.to_array(), bounds.max.to_array());
    }
    let parts = model.parts.iter();
    view.parts = parts.map(|p| PartView { name: p.name.clone(), material: p.material.index() }).collect();
    let materials = model.materials.iter().map(|m| MaterialView {
        name: m.name.clone(),
        kind: m.kind.word(),
        color: m.base_color,
        roughness: m.roughness,
        translucency: m.translucency,
        masked: m.alpha == AlphaMode::Mask,
        two_sided: m.double_sided,
        texture: m.texture.as_ref().map(|t| TextureView {
            number: number_of(textures, t),
            width: t.width,
            height: t.height,
        }),
    });
    view.materials = materials.collect();
    view
}

fn number_of(textures: &mut Vec<Arc<Texture>>, texture: &Arc<Texture>) -> usize {
    let same = |t: &Arc<Texture>| Arc::ptr_eq(t, texture) || t == texture;
    textures.iter().position(same).unwrap_or_else(|| {
        textures.push(Arc::clone(texture));
        textures.len() - 1
    })
}
