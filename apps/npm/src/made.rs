//! A made plant: its levels of detail as columns, its tables, its files.

use std::sync::Arc;

#[cfg(feature = "makers")]
use burgeon::Levels;
use burgeon::formats::{self, ExportSpec};
#[cfg(feature = "makers")]
use burgeon::formats::{PngCache, WriteError};
use burgeon::mesh::{AlphaMode, Model, Part, Texture};
use burgeon::plant::Plant;
use burgeon::skin::{Layout, Owner};
use burgeon::{Counts, ItemReport, TreeEvaluator, part_of_axis, part_of_organ};
use wasm_bindgen::prelude::*;

use crate::asked::{Asked, Refused, Settled};
use crate::view::{LevelView, MaterialView, PartView, PlantView, TextureView};

/// Meshes at one level of detail, with the parts of the plant that their triangles show.
#[derive(Debug)]
pub(crate) struct Level {
    pub(crate) model: Model,
    pub(crate) owners: Option<(Plant, Layout)>,
}

/// A plant, kept until its columns have been fetched.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Made {
    view: PlantView,
    levels: Vec<Level>,
    plant: Plant,
    textures: Vec<Arc<Texture>>,
    files: Vec<(String, Vec<u8>)>,
}

impl Made {
    pub(crate) fn from_tree(
        tree: TreeEvaluator,
        (item, preset): (ItemReport, Option<&str>),
        asked: &Asked,
    ) -> Result<Self, Refused> {
        let lost = || Refused::plain("internal", "internal error, a bug in burgeon: no tree was made".into());
        let (model, plant) = tree.model().zip(tree.plant()).ok_or_else(lost)?;
        let owners = tree.layout().map(|layout| (plant.clone(), layout.clone()));
        let mut levels = vec![Level { model: model.clone(), owners }];
        for level in 1..=asked.levels_made()? {
            let (model, owners) = asked.run(|run| tree.laid_out_at(level, run))?.ok_or_else(lost)?;
            levels.push(Level { model, owners: Some(owners) });
        }
        let plant = plant.clone();
        drop(tree);
        Self::new("tree", preset, item, (levels, plant), None, asked)
    }

    /// Makes the coarse copy of a tree.
    pub(crate) fn from_look(
        (model, owners): (Model, (Plant, Layout)),
        preset: Option<&str>,
    ) -> Result<Self, Refused> {
        let (name, plant) = (owners.0.name.clone(), owners.0.clone());
        let counts = Counts {
            vertices: model.vertex_count() as u64,
            triangles: model.triangle_count() as u64,
            ..Counts::from_plant(&plant)
        };
        let report = ItemReport { name, counts, ..ItemReport::default() };
        let level = Level { model, owners: Some(owners) };
        Self::new("tree", preset, report, (vec![level], plant), None, &Asked::default())
    }

    pub(crate) fn new(
        maker: &'static str,
        preset: Option<&str>,
        mut report: ItemReport,
        (levels, plant): (Vec<Level>, Plant),
        days: Option<[f64; 2]>,
        asked: &Asked,
    ) -> Result<Self, Refused> {
        let settled = asked.settled()?;
        let levels = within(levels, (&plant, &mut report), settled.as_ref(), asked)?;
        let bounds = levels.first().map(|l| l.model.bounds()).filter(|b| !b.is_empty());
        let (min, max) = bounds.map_or_else(Default::default, |b| (b.min.to_array(), b.max.to_array()));
        let mut textures: Vec<Arc<Texture>> = Vec::new();
        let views = levels.iter().map(|l| LevelView {
            parts: l.model.parts.iter().map(part_view).collect(),
            materials: l.model.materials.iter().map(|m| material_view(m, &mut textures)).collect(),
        });
        let levels_view = views.collect();
        let of_texture = |t: &Arc<Texture>| TextureView { width: t.width, height: t.height };
        let view = PlantView {
            name: report.name.clone(),
            maker,
            preset: preset.map(Into::into),
            report,
            engine: settled.as_ref().map(|s| s.report.clone()),
            days,
            min,
            max,
            levels: levels_view,
            textures: textures.iter().map(of_texture).collect(),
        };
        let mut made = Self { view, levels, plant, textures, files: Vec::new() };
        for extension in &asked.files {
            match &settled {
                Some(settled) if extension == "glb" => {
                    let files = made.files_for(settled)?;
                    made.files.extend(files);
                }
                _ => made.files.push((extension.clone(), made.file(extension)?)),
            }
        }
        Ok(made)
    }

    /// The files of all levels for a program: `glb`, `lod1.glb`, ..., or one `glb` with all levels as nodes.
    #[cfg(feature = "makers")]
    fn files_for(&self, settled: &Settled) -> Result<Vec<(String, Vec<u8>)>, Refused> {
        let (form, failed) = (settled.file(), |e: WriteError| Refused::plain("write", e.to_string()));
        let (mut cache, mut files) = (PngCache::new(), Vec::new());
        let models: Vec<Model> =
            self.levels.iter().map(|l| settled.named(&self.view.name, &l.model)).collect();
        let levels: Vec<formats::Level<'_>> = models.iter().map(formats::Level::plain).collect();
        let each: Vec<&[formats::Level<'_>]> =
            if form.is_one_file { vec![&levels[..]] } else { levels.chunks(1).collect() };
        for (k, levels) in each.into_iter().enumerate() {
            let mut bytes = Vec::new();
            form.write_glb(&self.plant, levels, &mut cache, &mut bytes).map_err(failed)?;
            files.push((if k == 0 { "glb".to_owned() } else { format!("lod{k}.glb") }, bytes));
        }
        if let Some(finest) = models.first() {
            let beside = form.textures_beside(&self.plant, finest, "").map_err(failed)?;
            let plain = |name: String| name.trim_start_matches('-').to_owned();
            files.extend(beside.into_iter().map(|file| (plain(file.name), file.bytes)));
        }
        Ok(files)
    }

    /// Trees alone are half of the download: they have no writers for programs.
    #[cfg(not(feature = "makers"))]
    fn files_for(&self, settled: &Settled) -> Result<Vec<(String, Vec<u8>)>, Refused> {
        Err(settled.unwritten())
    }

    fn file(&self, extension: &str) -> Result<Vec<u8>, Refused> {
        let mut bytes = Vec::new();
        let written = match (extension, self.levels.first()) {
            ("glb", Some(level)) => formats::write_glb(&level.model, &mut bytes),
            ("mtg", _) => formats::write_mtg(&self.plant, &ExportSpec::default(), &mut bytes),
            #[cfg(feature = "makers")]
            ("opf", _) => burgeon::write_structure(
                &self.plant,
                formats::StructureFormat::Opf,
                &ExportSpec::default(),
                &mut bytes,
            ),
            (other, _) => {
                let known = if cfg!(feature = "makers") { "glb, mtg, opf" } else { "glb, mtg" };
                return Err(Refused::choice("files", other, known));
            }
        };
        written.map_err(|e| Refused::plain("write", e.to_string()))?;
        Ok(bytes)
    }

    fn part(&self, level: usize, part: usize) -> Option<&Part> {
        self.levels.get(level)?.model.parts.get(part)
    }
}

/// Reduces a plant to the allowed size; the finest level that fits becomes the plant.
#[cfg(feature = "makers")]
fn within(
    levels: Vec<Level>,
    (plant, report): (&Plant, &mut ItemReport),
    settled: Option<&Settled>,
    asked: &Asked,
) -> Result<Vec<Level>, Refused> {
    let allowance = asked.allowance()?;
    if !allowance.is_any() {
        return Ok(levels);
    }
    let (models, mut owners): (Vec<Model>, Vec<_>) = levels.into_iter().map(|l| (l.model, l.owners)).unzip();
    let mut models = models.into_iter();
    let model = models.next().unwrap_or_default();
    let all = Levels { lods: models.collect(), ..Levels::default() };
    let name = report.name.clone();
    let mut cache = PngCache::new();
    let weigh = |model: &Model, levels: &Levels| {
        weight((plant, &name), std::iter::once(model).chain(&levels.lods), settled, &mut cache)
    };
    let fitted = all.within(model, allowance, (asked.levels()?, false), weigh)?;
    let fitted = fitted.map_err(|e| Refused::plain("budget", e.to_string()))?;
    report.warnings.extend(fitted.line());
    report.counts.vertices = fitted.model.vertex_count() as u64;
    report.counts.triangles = fitted.model.triangle_count() as u64;
    let kept = std::iter::once(fitted.model).chain(fitted.levels.lods);
    Ok(kept.zip(owners.drain(fitted.level..)).map(|(model, owners)| Level { model, owners }).collect())
}

/// Trees alone have no budgets, which [`Asked::allowance`] refuses.
#[cfg(not(feature = "makers"))]
fn within(
    levels: Vec<Level>,
    _: (&Plant, &mut ItemReport),
    _: Option<&Settled>,
    asked: &Asked,
) -> Result<Vec<Level>, Refused> {
    asked.allowance().map(|_| levels)
}

/// Returns the bytes of the file `glb` of a model, the first one.
#[cfg(feature = "makers")]
fn weight<'a>(
    (plant, name): (&Plant, &str),
    mut models: impl Iterator<Item = &'a Model>,
    settled: Option<&Settled>,
    cache: &mut PngCache,
) -> Result<u64, Refused> {
    let failed = |e: WriteError| Refused::plain("write", e.to_string());
    let Some(settled) = settled else {
        let mut bytes = Vec::new();
        if let Some(model) = models.next() {
            formats::write_glb_with(model, cache, &mut bytes).map_err(failed)?;
        }
        return Ok(bytes.len() as u64);
    };
    let models: Vec<Model> = models.map(|model| settled.named(name, model)).collect();
    let levels: Vec<formats::Level<'_>> = models.iter().map(formats::Level::plain).collect();
    settled.file().weigh(plant, &levels, cache).map_err(failed)
}

fn part_view(part: &Part) -> PartView {
    PartView { name: part.name.clone(), material: part.material.index() }
}

fn material_view(m: &burgeon::mesh::Material, textures: &mut Vec<Arc<Texture>>) -> MaterialView {
    let mut row = |texture: &Option<Arc<Texture>>| {
        let texture = texture.as_ref()?;
        let known = textures.iter().position(|t| Arc::ptr_eq(t, texture) || t == texture);
        Some(known.unwrap_or_else(|| {
            textures.push(Arc::clone(texture));
            textures.len() - 1
        }))
    };
    MaterialView {
        texture: row(&m.texture),
        normal: row(&m.maps.normal),
        orm: row(&m.maps.orm),
        name: m.name.clone(),
        kind: m.kind.word(),
        color: m.base_color,
        roughness: m.roughness,
        translucency: m.translucency,
        masked: m.alpha == AlphaMode::Mask,
        two_sided: m.double_sided,
    }
}

/// Converts a handle; -1 for none.
fn handle(raw: Option<u32>) -> i32 {
    raw.and_then(|r| i32::try_from(r).ok()).unwrap_or(burgeon::NOTHING)
}

#[wasm_bindgen]
impl Made {
    /// Returns `PlantView` as JSON.
    pub fn view(&self) -> String {
        serde_json::to_string(&self.view).unwrap_or_default()
    }

    /// Returns all measures, as JSON.
    pub fn measures(&self) -> String {
        serde_json::to_string(&self.plant.measure()).unwrap_or_default()
    }

    /// Returns a column of a mesh: `positions`, `normals`, `uvs`, `colors`, `wind`, `pivots`; empty if it has none.
    pub fn column(&self, level: usize, part: usize, name: &str) -> Vec<f32> {
        let Some(mesh) = self.part(level, part).map(|p| &p.mesh) else { return Vec::new() };
        match name {
            "positions" => mesh.positions.as_flattened().to_vec(),
            "normals" => mesh.normals.as_flattened().to_vec(),
            "uvs" => mesh.uvs.as_flattened().to_vec(),
            "colors" => mesh.colors.as_flattened().to_vec(),
            "wind" => mesh.wind.as_flattened().to_vec(),
            "pivots" => mesh.pivots.as_flattened().to_vec(),
            _ => Vec::new(),
        }
    }

    /// Returns three indices for each triangle.
    pub fn indices(&self, level: usize, part: usize) -> Vec<u32> {
        self.part(level, part).map_or_else(Vec::new, |p| p.mesh.triangles.as_flattened().to_vec())
    }

    /// Returns the pieces of a mesh, in the order of its triangles: for each the organ (-1: wood), its shape, and its
    /// number of triangles. Empty if they are not known.
    pub fn pieces(&self, level: usize, part: usize) -> Vec<i32> {
        let Some((plant, layout)) = self.levels.get(level).and_then(|l| l.owners.as_ref()) else {
            return Vec::new();
        };
        let Some(pieces) = layout.owners().nth(part) else { return Vec::new() };
        let row = |(owner, triangles): (Owner<'_>, u32)| match owner {
            Owner::Axes(_) => [-1, -1, handle(Some(triangles))],
            Owner::Organ(id) => {
                let shape = plant.organs.get(id.index()).map(|o| o.shape.raw());
                [handle(Some(id.raw())), handle(shape), handle(Some(triangles))]
            }
        };
        pieces.flat_map(row).collect()
    }

    /// Returns the places of the organs of a level: matrices of 16 numbers, column by column.
    pub fn organs(&self, level: usize) -> Vec<f32> {
        let owners = self.levels.get(level).and_then(|l| l.owners.as_ref());
        let matrix = |o: &burgeon::plant::Organ| {
            let [x, y, z] = [o.frame.right, o.frame.along, o.frame.normal].map(|v| (v * o.scale).as_vec3());
            let at = o.frame.origin.as_vec3();
            [x.extend(0.0), y.extend(0.0), z.extend(0.0), at.extend(1.0)].map(|v| v.to_array())
        };
        owners.map_or_else(Vec::new, |(plant, _)| plant.organs.iter().flat_map(matrix).flatten().collect())
    }

    /// Returns a table of the plant, in double precision: `position` (3 a node), `radius`.
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        match name {
            "position" => self.plant.nodes.position.iter().flat_map(|p| p.to_array()).collect(),
            "radius" => self.plant.nodes.radius_m.clone(),
            _ => Vec::new(),
        }
    }

    /// Returns a table of whole numbers: `node_axis`; `axis_part`, `axis_order`, `axis_bearer`, `axis_first`,
    /// `axis_end`; `organ_part`, `organ_bearer`, `organ_flower`. -1 for none.
    pub fn handles(&self, name: &str) -> Vec<i32> {
        let Plant { axes, organs, nodes, .. } = &self.plant;
        let whole = |n: u32| handle(Some(n));
        match name {
            "node_axis" => nodes.axis.iter().map(|a| whole(a.raw())).collect(),
            "axis_part" => axes.iter().map(|a| i32::from(part_of_axis(a.kind))).collect(),
            "axis_order" => axes.iter().map(|a| whole(a.order)).collect(),
            "axis_bearer" => axes.iter().map(|a| handle(a.bearer.map(|n| n.raw()))).collect(),
            "axis_first" => axes.iter().map(|a| whole(a.nodes.start)).collect(),
            "axis_end" => axes.iter().map(|a| whole(a.nodes.end)).collect(),
            "organ_part" => organs.iter().map(|o| i32::from(part_of_organ(o.kind))).collect(),
            "organ_bearer" => organs.iter().map(|o| handle(o.bearer.map(|n| n.raw()))).collect(),
            "organ_flower" => organs.iter().map(|o| handle(o.flower.map(|f| f.raw()))).collect(),
            _ => Vec::new(),
        }
    }

    /// Returns the RGBA bytes of a picture by its row.
    pub fn texture(&self, row: usize) -> Vec<u8> {
        self.textures.get(row).map_or_else(Vec::new, |t| t.pixels.clone())
    }

    /// Returns the names of the files: the extensions that were requested, and what a program wants beside them.
    pub fn file_names(&self) -> Vec<String> {
        self.files.iter().map(|(name, _)| name.clone()).collect()
    }

    /// Returns a file by its name.
    pub fn take_file(&mut self, wanted: &str) -> Vec<u8> {
        let found = self.files.iter_mut().find(|(name, _)| name == wanted);
        found.map_or_else(Vec::new, |(_, bytes)| std::mem::take(bytes))
    }
}

/// Returns the words of parts of plants, by the numbers in tables.
#[wasm_bindgen]
pub fn parts() -> Vec<String> {
    burgeon::PARTS.iter().map(|p| (*p).to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use burgeon::mesh::{Material, MaterialId, MaterialKind, TriMesh};

    fn made(engine: &str, lods: Option<u32>, files: &[&str]) -> Result<Made, Refused> {
        let mesh = TriMesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            triangles: vec![[0, 1, 2]],
            ..TriMesh::default()
        };
        let part = Part { name: "leaf".into(), material: MaterialId::new(0), mesh };
        let materials = vec![Material::plain("leaf", MaterialKind::Leaf, [0.5; 3])];
        let model = Model { name: "oak".into(), parts: vec![part], materials, offset_m: None };
        let asked = Asked {
            engine: Some(engine.into()),
            lods,
            files: files.iter().map(|f| (*f).to_owned()).collect(),
            ..Asked::default()
        };
        let level = || Level { model: model.clone(), owners: None };
        let levels: Vec<Level> = (0..=asked.levels()?).map(|_| level()).collect();
        let report = ItemReport { name: "oak".into(), ..ItemReport::default() };
        Made::new("tree", None, report, (levels, Plant::default()), None, &asked)
    }

    #[cfg(feature = "makers")]
    #[test]
    fn files_for_a_program_are_as_the_table_says() {
        let unity = made("unity", None, &["glb"]).expect("files");
        let names: Vec<&str> = unity.files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["glb"], "levels are nodes of one file");
        let text = String::from_utf8_lossy(&unity.files[0].1).into_owned();
        assert!(text.contains("oak_leaf"), "names after the plant");
        assert!(text.contains("plant_LOD0") && text.contains("plant_LOD3"), "a node for each level");
        let told = unity.view.engine.expect("told");
        assert_eq!((told.name.as_str(), told.set[0].as_str()), ("unity", "lods 3"));
        let three = made("three", Some(0), &["glb"]).expect("files");
        assert_eq!(three.file_names(), ["glb"], "what is asked wins");
        let levels = made("three", None, &["glb"]).expect("files");
        assert_eq!(levels.file_names(), ["glb", "lod1.glb", "lod2.glb"]);
        assert!(String::from_utf8_lossy(&three.files[0].1).contains("EXT_meshopt_compression"));
    }

    #[test]
    fn programs_that_take_no_glb_and_unknown_ones_are_refused() {
        for (engine, part) in [("isaac", ".usda or .usdz or .physics.usda, not .glb"), ("maya", "unity")] {
            let Err(Refused(json)) = made(engine, None, &["glb"]) else { panic!("{engine} is refused") };
            assert!(json.contains(part), "{json}");
        }
    }
}
