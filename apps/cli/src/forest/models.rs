//! The plants' own files, which tiles name.

use std::collections::{BTreeMap, BTreeSet};

use burgeon::StandTile;
use burgeon::formats::{
    ExportSpec, FileStems, ModelFormat, PngCache, SharedModel, decode_uri, gltf_files, share_pictures,
    usd_files, write_glb_packed,
};
use burgeon::mesh::{Bounds, Model};
use serde_json::Value;

use super::folder::Folder;
use super::{Plan, failed_to_write};
use crate::failure::{Failure, Outcome};
use crate::machine::{Machine, Progress};

/// From a tile to the folder of models.
const FROM_TILES: &str = "../../models/";
/// From the folder of the tileset to it.
const FROM_ROOT: &str = "models/";

/// The models of a run: of each variant and level that it needs, the document that tiles take in.
#[derive(Debug, Default)]
pub(super) struct Models {
    tiles: BTreeMap<(u32, u32), SharedModel>,
    /// The same, named from the folder of the tileset.
    root: BTreeMap<(u32, u32), SharedModel>,
    bounds: BTreeMap<u32, Bounds>,
}

impl Models {
    /// Makes those that a tile needs, or all; what an earlier run wrote stays. `usd`: the level that USD names, if it is wanted.
    pub(super) fn make(
        plan: &Plan,
        tile: Option<&StandTile>,
        usd: Option<u32>,
        folder: &mut Folder,
        machine: &Machine,
        progress: &Progress,
    ) -> Outcome<Self> {
        let levels = plan.look.levels();
        let (variants, levels): (Vec<u32>, Vec<u32>) = match tile {
            Some(tile) => {
                let rows = plan.tiling.shown(tile, &plan.stand, plan.seed);
                let placed = rows.filter_map(|row| plan.nursery.place(&plan.stand.trees[row as usize]));
                let used: BTreeSet<u32> = placed.map(|p| p.variant).collect();
                (used.into_iter().collect(), vec![plan.tiling.detail(tile)])
            }
            None => {
                let used = (0_u32..).zip(&plan.trees_of).filter(|(_, n)| **n > 0).map(|(v, _)| v);
                (used.collect(), (0..levels).collect())
            }
        };
        let mut models = Self::default();
        progress.expect(variants.len());
        for (done, &variant) in variants.iter().enumerate() {
            machine.cancel.check()?;
            progress.reached(done);
            let mut documents = levels.iter().map(|&l| kept(plan, (variant, l), usd == Some(l), folder));
            let documents: Option<Vec<Vec<u8>>> = documents.by_ref().collect();
            let documents = match documents {
                Some(documents) => documents,
                None => grown(plan, variant, &levels, usd, folder, machine)?,
            };
            for (&level, text) in levels.iter().zip(&documents) {
                let read = |from| SharedModel::read(text, from).map_err(|e| failed_to_write(&e));
                let (near, root) = (read(FROM_TILES)?, read(FROM_ROOT)?);
                let bounds = models.bounds.entry(variant).or_insert(Bounds::EMPTY);
                bounds.include(near.bounds().min);
                bounds.include(near.bounds().max);
                models.tiles.insert((variant, level), near);
                models.root.insert((variant, level), root);
            }
        }
        folder.flush()?;
        Ok(models)
    }

    pub(super) fn for_tile(&self, variant: u32, level: u32) -> Outcome<&SharedModel> {
        self.tiles.get(&(variant, level)).ok_or_else(|| Failure::Bug("a model is missing".into()))
    }

    pub(super) fn for_root(&self, variant: u32, level: u32) -> Outcome<&SharedModel> {
        self.root.get(&(variant, level)).ok_or_else(|| Failure::Bug("a model is missing".into()))
    }

    /// The box around a variant at all of its levels.
    pub(super) fn bounds(&self, variant: u32) -> Bounds {
        self.bounds.get(&variant).copied().unwrap_or(Bounds::EMPTY)
    }

    /// Triangles of all trees at each level, finest first.
    pub(super) fn triangles(&self, plan: &Plan) -> Vec<u64> {
        let of = |level: u32| {
            let all = (0_u32..).zip(&plan.trees_of);
            all.map(|(v, n)| n * self.tiles.get(&(v, level)).map_or(0, SharedModel::triangles)).sum()
        };
        (0..plan.look.levels()).map(of).collect()
    }
}

/// The name of a level's files, without folder and ending.
pub(super) fn stem(plan: &Plan, variant: u32, level: u32) -> String {
    let is_far = plan.look.impostor.is_some() && level + 1 == plan.look.levels();
    let level = if is_far { "far".to_owned() } else { format!("lod{}", plan.look.finest + level) };
    format!("{}-{level}", plan.nursery.name(variant))
}

/// The document of a model that an earlier run wrote with all that it names.
fn kept(plan: &Plan, (variant, level): (u32, u32), usd: bool, folder: &mut Folder) -> Option<Vec<u8>> {
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

/// Grows a variant and writes its levels; their documents.
fn grown(
    plan: &Plan,
    variant: u32,
    levels: &[u32],
    usd: Option<u32>,
    folder: &mut Folder,
    machine: &Machine,
) -> Outcome<Vec<Vec<u8>>> {
    let models = plan.nursery.models(variant, &plan.look, &machine.run());
    let models = models.map_err(|e| match e {
        burgeon::NurseryError::Stopped(stopped) => stopped.into(),
        other => Failure::Bad(other.to_string()),
    })?;
    let mut documents = Vec::with_capacity(levels.len());
    for &level in levels {
        let model = models.get(level as usize).ok_or_else(|| {
            let name = plan.nursery.name(variant);
            Failure::Bad(format!(
                "{name} is too small for pictures from all sides; leave them out with --impostor off"
            ))
        })?;
        documents.push(write_model(plan, (variant, level), model, folder)?);
        if usd == Some(level) {
            let name = stem(plan, variant, level);
            let files = usd_files(model, &name, &ExportSpec::default()).map_err(|e| failed_to_write(&e))?;
            for (name, bytes) in files.textures {
                folder.put(&format!("models/{name}"), bytes)?;
            }
            folder.put(&format!("models/{name}.usda"), files.usda)?;
        }
    }
    Ok(documents)
}

fn write_model(
    plan: &Plan,
    (variant, level): (u32, u32),
    model: &Model,
    folder: &mut Folder,
) -> Outcome<Vec<u8>> {
    let failed = |e| failed_to_write(&e);
    let name = stem(plan, variant, level);
    let mut glb = Vec::new();
    write_glb_packed(model, plan.packing, &mut PngCache::new(), &mut glb).map_err(failed)?;
    let stems = FileStems { model: &name, textures: &name };
    let files = gltf_files(glb, ModelFormat::Gltf, stems).map_err(failed)?;
    let species = plan.nursery.name(variant);
    let species = species.rsplitn(3, '-').last().unwrap_or("plant");
    let files = share_pictures(files, species).map_err(failed)?;
    for file in files.beside {
        folder.put(&format!("models/{}", file.name), file.bytes)?;
    }
    // Last: where it is, all that it names is.
    folder.put(&format!("models/{name}.gltf"), files.own.clone())?;
    Ok(files.own)
}
