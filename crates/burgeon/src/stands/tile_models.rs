//! The plants' own files, which tiles refer to.

use std::collections::BTreeMap;

use base::Run;
use formats::{
    ExportSpec, FileStems, ModelFiles, ModelFormat, PngCache, SharedModel, decode_uri, gltf_files,
    share_pictures, usd_files, write_glb_joined,
};
use mesh::{Bounds, Model};
use serde_json::Value;

use super::plan::{ForestPlan, ForestTilesError};
use super::tile_folder::{TileDisk, TileFolder};
use super::tiling::StandTile;

/// Callback for the progress of a step: how many are done, of how many.
pub type Watch<'a> = &'a dyn Fn(usize, usize);

/// Selection of the models of a forest.
#[derive(Clone, Copy, Debug)]
pub enum ModelsOf<'a> {
    /// Models that a tile needs, at its level.
    Tile(&'a StandTile),
    /// Models of some plants of the nursery, at all levels.
    Variants(&'a [u32]),
    /// All models that stand for a tree, at all levels.
    All {
        /// The level that USD refers to, if it is wanted.
        usd: Option<u32>,
    },
}

/// Path from a tile to the folder of models.
const FROM_TILES: &str = "../../models/";
/// Path from the folder of the tileset to that of models.
const FROM_ROOT: &str = "models/";

/// The models of a run: for each variant and level that it needs, the document that tiles include.
#[derive(Debug, Default)]
pub struct TileModels {
    tiles: BTreeMap<(u32, u32), SharedModel>,
    /// The same documents, with names relative to the folder of the tileset.
    root: BTreeMap<(u32, u32), SharedModel>,
    bounds: BTreeMap<u32, Bounds>,
}

impl TileModels {
    /// Makes models; files that an earlier run wrote stay.
    ///
    /// # Errors
    /// [`ForestTilesError`], and those of the disk.
    pub fn make<D: TileDisk>(
        plan: &ForestPlan,
        of: ModelsOf<'_>,
        folder: &mut TileFolder<D>,
        run: &Run<'_>,
        watch: Watch<'_>,
    ) -> Result<Self, D::Error> {
        let all: Vec<u32> = (0..plan.look().levels()).collect();
        let (variants, levels, usd) = match of {
            ModelsOf::Tile(tile) => {
                (plan.used_by(tile).into_iter().collect(), vec![plan.tiling.detail(tile)], None)
            }
            ModelsOf::Variants(variants) => (variants.to_vec(), all, None),
            ModelsOf::All { usd } => (plan.used_variants().collect(), all, usd),
        };
        let mut models = Self::default();
        for (done, &variant) in variants.iter().enumerate() {
            run.cancel.check().map_err(ForestTilesError::from)?;
            watch(done, variants.len());
            let mut documents = levels.iter().map(|&l| kept(plan, (variant, l), usd == Some(l), folder));
            let documents: Option<Vec<Vec<u8>>> = documents.by_ref().collect();
            let documents = match documents {
                Some(documents) => documents,
                None => grown(plan, variant, &levels, usd, folder, run)?,
            };
            for (&level, text) in levels.iter().zip(&documents) {
                models.add((variant, level), text)?;
            }
        }
        folder.flush()?;
        Ok(models)
    }

    fn add(&mut self, key: (u32, u32), text: &[u8]) -> Result<(), ForestTilesError> {
        let (near, root) = (SharedModel::read(text, FROM_TILES)?, SharedModel::read(text, FROM_ROOT)?);
        let bounds = self.bounds.entry(key.0).or_insert(Bounds::EMPTY);
        bounds.include(near.bounds().min);
        bounds.include(near.bounds().max);
        self.tiles.insert(key, near);
        self.root.insert(key, root);
        Ok(())
    }

    pub(super) fn for_tile(&self, variant: u32, level: u32) -> Result<&SharedModel, ForestTilesError> {
        self.tiles.get(&(variant, level)).ok_or_else(|| ForestTilesError::Bug("a model is missing".into()))
    }

    pub(super) fn for_root(&self, variant: u32, level: u32) -> Result<&SharedModel, ForestTilesError> {
        self.root.get(&(variant, level)).ok_or_else(|| ForestTilesError::Bug("a model is missing".into()))
    }

    /// Returns the box around a variant at all of its levels.
    pub(super) fn bounds(&self, variant: u32) -> Bounds {
        self.bounds.get(&variant).copied().unwrap_or(Bounds::EMPTY)
    }

    /// Counts the triangles of all trees at each level, finest first; for a run that made all models.
    pub fn triangles(&self, plan: &ForestPlan) -> Vec<u64> {
        let of = |level: u32| {
            let all = (0_u32..).zip(&plan.trees_of);
            all.map(|(v, n)| n * self.tiles.get(&(v, level)).map_or(0, SharedModel::triangles)).sum()
        };
        (0..plan.look().levels()).map(of).collect()
    }
}

/// Returns the name of a level's files, without folder and ending.
pub(super) fn stem(plan: &ForestPlan, variant: u32, level: u32) -> String {
    let is_far = plan.look().impostor.is_some() && level + 1 == plan.look().levels();
    let level = if is_far { "far".to_owned() } else { format!("lod{}", plan.look().finest + level) };
    format!("{}-{level}", plan.nursery.name(variant))
}

/// Returns the document of a model that an earlier run wrote with all that it names.
fn kept<D: TileDisk>(
    plan: &ForestPlan,
    (variant, level): (u32, u32),
    usd: bool,
    folder: &mut TileFolder<D>,
) -> Option<Vec<u8>> {
    let stem = stem(plan, variant, level);
    let text = folder.keep(&format!("models/{stem}.gltf"))?;
    let root: Value = serde_json::from_slice(&text).ok()?;
    for list in ["buffers", "images"] {
        for row in root.get(list).and_then(Value::as_array).into_iter().flatten() {
            if let Some(uri) = row.get("uri").and_then(Value::as_str) {
                folder.keep(&format!("models/{}", decode_uri(uri).as_deref().unwrap_or(uri)))?;
            }
        }
    }
    if usd {
        let text = folder.keep(&format!("models/{stem}.usda"))?;
        // Names of files stand between two of these signs.
        for name in std::str::from_utf8(&text).ok()?.split('@').skip(1).step_by(2) {
            folder.keep(&format!("models/{}", name.trim_start_matches("./")))?;
        }
    }
    Some(text)
}

/// Grows a variant, writes its levels and returns their documents.
fn grown<D: TileDisk>(
    plan: &ForestPlan,
    variant: u32,
    levels: &[u32],
    usd: Option<u32>,
    folder: &mut TileFolder<D>,
    run: &Run<'_>,
) -> Result<Vec<Vec<u8>>, D::Error> {
    let models = plan.nursery.models(variant, plan.look(), run).map_err(ForestTilesError::from)?;
    let mut documents = Vec::with_capacity(levels.len());
    for &level in levels {
        let too_small = || ForestTilesError::TooSmall(plan.nursery.name(variant));
        let model = models.get(level as usize).ok_or_else(too_small)?;
        documents.push(write_model(plan, (variant, level), model, folder)?);
        if usd == Some(level) {
            let name = stem(plan, variant, level);
            let files = usd_files(model, &name, &ExportSpec::default()).map_err(ForestTilesError::from)?;
            for (name, bytes) in files.textures {
                folder.put(&format!("models/{name}"), bytes)?;
            }
            folder.put(&format!("models/{name}.usda"), files.usda)?;
        }
    }
    Ok(documents)
}

fn write_model<D: TileDisk>(
    plan: &ForestPlan,
    (variant, level): (u32, u32),
    model: &Model,
    folder: &mut TileFolder<D>,
) -> Result<Vec<u8>, D::Error> {
    let files = model_files(plan, (variant, level), model)?;
    for file in files.beside {
        folder.put(&format!("models/{}", file.name), file.bytes)?;
    }
    // Written last: where it exists, every file that it names does.
    folder.put(&format!("models/{}.gltf", stem(plan, variant, level)), files.own.clone())?;
    Ok(files.own)
}

fn model_files(
    plan: &ForestPlan,
    (variant, level): (u32, u32),
    model: &Model,
) -> Result<ModelFiles, ForestTilesError> {
    let name = stem(plan, variant, level);
    let mut glb = Vec::new();
    write_glb_joined(model, plan.packing(), &mut PngCache::new(), &mut glb)?;
    let stems = FileStems { model: &name, textures: &name };
    let files = gltf_files(glb, ModelFormat::Gltf, stems)?;
    let plant = plan.nursery.name(variant);
    let species = plant.rsplitn(3, '-').last().unwrap_or("plant");
    Ok(share_pictures(files, species)?)
}
