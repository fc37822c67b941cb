//! A stand with all that decides its tiles.

use std::collections::BTreeSet;

use base::{Digest, Run, Seed, Stopped};
use forest::Stand;
use formats::{Packing, WriteError};
use growth::TreeSpec;

use super::nursery::{Nursery, NurseryError, NurseryLook, NurserySpec};
use super::placed::Misfits;
use super::tiling::{StandTile, TileId, Tiling, TilingError, TilingSpec};

/// Pixels of a side of the textures of plants that stand for trees.
const TEXTURE_SIZE: u32 = 256;
/// The coarsest level of their meshes, and pixels of a side of the atlas for those far away.
const LODS: u32 = 3;
const IMPOSTOR: u32 = 512;
/// Trees between two looks at whether the user asked to stop.
const PATIENCE: usize = 4_096;

/// How a stand becomes tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct ForestTilesSpec {
    /// Plants of each species and age, 1 to 64. Default 4.
    pub variants: u32,
    /// Of the plants and of their choice.
    pub seed: Seed,
    /// How plants are meshed. Default: levels 0 to 3 with textures of 256 pixels, and pictures of 512 for those far away.
    pub look: NurseryLook,
    /// Most trees of a tile of the finest level. Default: [`TilingSpec::usual_trees`].
    pub tile_trees: Option<u32>,
    /// How models and tiles are packed. Default: compressed.
    pub packing: Packing,
}

impl Default for ForestTilesSpec {
    fn default() -> Self {
        let foliage = skin::FoliageStyle::ByLevel;
        let skin = skin::SkinSpec { texture_size: TEXTURE_SIZE, foliage, ..skin::SkinSpec::default() };
        Self {
            variants: NurserySpec::default().variants,
            seed: NurserySpec::default().seed,
            look: NurseryLook { skin, finest: 0, lods: LODS, impostor: Some(IMPOSTOR) },
            tile_trees: None,
            packing: Packing::Compressed,
        }
    }
}

/// Why a stand did not become tiles.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ForestTilesError {
    /// One of its plants cannot be grown, or the user asked to stop.
    #[error(transparent)]
    Nursery(#[from] NurseryError),
    /// It cannot be cut into tiles.
    #[error(transparent)]
    Tiling(#[from] TilingError),
    /// A file of it cannot be made.
    #[error("a file of the forest cannot be made: {0}")]
    Write(#[from] WriteError),
    /// A plant that is too small for views from all sides.
    #[error("{0} is too small for pictures from all sides; leave them out")]
    TooSmall(String),
    /// There is no such tile.
    #[error("there is no tile {asked} in this forest; one of those that there are is {one}")]
    NoTile {
        /// The file that it would have.
        asked: String,
        /// The file of one that there is.
        one: String,
    },
    /// What lies there as a manifest is none.
    #[error("is not the manifest of a forest; name another folder")]
    NoManifest,
    /// Our own fault.
    #[error("{0}")]
    Bug(String),
}

impl From<Stopped> for ForestTilesError {
    fn from(stopped: Stopped) -> Self {
        Self::Nursery(stopped.into())
    }
}

impl From<base::Cancelled> for ForestTilesError {
    fn from(cancelled: base::Cancelled) -> Self {
        Self::Nursery(cancelled.into())
    }
}

/// A forest, before its files.
#[derive(Debug)]
pub struct ForestPlan {
    /// Its trees.
    pub stand: Stand,
    /// The plants that stand for them.
    pub nursery: Nursery,
    /// How it is cut into tiles.
    pub tiling: Tiling,
    /// The same as it was asked for.
    pub tiling_spec: TilingSpec,
    /// How far plants are from the trees that they stand for.
    pub misfits: Misfits,
    /// How many trees each plant stands for.
    pub trees_of: Vec<u64>,
    spec: ForestTilesSpec,
}

impl ForestPlan {
    /// Grows what a stand needs, and cuts it into tiles; `specs`: of its species, in their order. The same bits for any executor.
    ///
    /// Cost: that of [`Nursery::plan`], and linear in trees.
    ///
    /// # Errors
    /// [`ForestTilesError`] of species that cannot be grown and of stands that cannot be tiled.
    pub fn new(
        stand: Stand,
        specs: &[TreeSpec],
        spec: ForestTilesSpec,
        run: &Run<'_>,
    ) -> Result<Self, ForestTilesError> {
        let tiling_spec = TilingSpec {
            trees: spec.tile_trees.unwrap_or_else(|| TilingSpec::usual_trees(stand.trees.len())),
            finest: spec.look.finest,
            levels: spec.look.levels(),
        };
        let tiling = Tiling::new(&stand, tiling_spec)?;
        let wanted = NurserySpec { variants: spec.variants, seed: spec.seed };
        let nursery = Nursery::plan(&stand, specs, &wanted, run)?;
        let (mut misfits, mut trees_of) = (Misfits::default(), vec![0; nursery.variants().len()]);
        for (n, tree) in stand.trees.iter().enumerate() {
            if n % PATIENCE == 0 {
                run.cancel.check()?;
            }
            let Some(placed) = nursery.place(tree) else { continue };
            misfits.add(tree, &placed);
            trees_of[placed.variant as usize] += 1;
        }
        Ok(Self { stand, nursery, tiling, tiling_spec, misfits, trees_of, spec })
    }

    /// How plants are meshed.
    pub const fn look(&self) -> &NurseryLook {
        &self.spec.look
    }

    pub(crate) const fn packing(&self) -> Packing {
        self.spec.packing
    }

    pub(crate) const fn seed(&self) -> Seed {
        self.spec.seed
    }

    /// Plants that stand for a tree at all, by their rows.
    pub fn used_variants(&self) -> impl Iterator<Item = u32> + '_ {
        (0_u32..).zip(&self.trees_of).filter(|(_, trees)| **trees > 0).map(|(variant, _)| variant)
    }

    /// Plants that a tile shows, by their rows.
    pub fn used_by(&self, tile: &StandTile) -> BTreeSet<u32> {
        let rows = self.tiling.shown(tile, &self.stand, self.spec.seed);
        rows.filter_map(|row| self.nursery.place(&self.stand.trees[row as usize]))
            .map(|p| p.variant)
            .collect()
    }

    /// The tile of a name.
    ///
    /// # Errors
    /// [`ForestTilesError::NoTile`] with one that there is.
    pub fn tile(&self, id: TileId) -> Result<&StandTile, ForestTilesError> {
        self.tiling.find(id).ok_or_else(|| ForestTilesError::NoTile {
            asked: id.file(),
            one: self.tiling.tiles().last().map_or_else(String::new, |tile| tile.id.file()),
        })
    }

    /// A fingerprint of what decides every tile: trees, species, options, version. Equal keys, equal tiles.
    pub fn key(&self) -> String {
        let mut digest = Digest::new();
        let head = format!(
            "{} {:?} {:?} {:?} {:?} {:?}",
            crate::VERSION,
            self.spec.look,
            self.tiling_spec,
            self.spec.packing,
            self.spec.seed.number(),
            self.stand.species
        );
        digest.bytes(head.as_bytes());
        // The plants themselves follow from their specs, whose measures these are.
        digest.bytes(format!("{:?}", self.nursery).as_bytes());
        for t in &self.stand.trees {
            let numbers = [t.age_years, t.height_m, t.dbh_m, t.crown_width_m, t.yaw];
            let vectors = [t.foot_m, t.up, t.crown_offset_m].map(|v| v.to_array());
            for x in numbers.iter().chain(vectors.as_flattened()) {
                digest.bytes(&x.to_le_bytes());
            }
            digest.bytes(&t.row.to_le_bytes()).bytes(&t.species.to_le_bytes());
        }
        digest.hex()
    }
}
