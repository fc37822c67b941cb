//! A stand with all that determines its tiles.

use std::collections::BTreeSet;

use base::{Digest, Run, Seed, Stopped};
use forest::Stand;
use formats::{Packing, WriteError};
use growth::TreeSpec;

use super::nursery::{Nursery, NurseryError, NurseryLook, NurserySpec};
use super::placed::Misfits;
use super::tiling::{StandTile, TileId, Tiling, TilingError, TilingSpec};

/// Side in pixels of the textures of plants that stand for trees.
const TEXTURE_SIZE: u32 = 256;
/// Coarsest level of their meshes.
const LODS: u32 = 3;
/// Side in pixels of the atlas for distant trees.
const IMPOSTOR: u32 = 512;
/// Number of trees between two checks of whether the user asked to stop.
const PATIENCE: usize = 4_096;

/// Settings for turning a stand into tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct ForestTilesSpec {
    /// Plants of each species and age, 1 to 64. Default 4.
    pub variants: u32,
    /// Seed of the plants and of their choice.
    pub seed: Seed,
    /// Settings for meshing plants. Default: levels 0 to 3 with textures of 256 pixels, and pictures of 512 for distant
    /// ones.
    pub look: NurseryLook,
    /// Most trees of a tile of the finest level. Default: [`TilingSpec::usual_trees`].
    pub tile_trees: Option<u32>,
    /// Packing of models and tiles. Default: compressed.
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

/// Reason why a stand did not become tiles.
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
    /// A plant is too small for views from all sides.
    #[error("{0} is too small for pictures from all sides; leave them out")]
    TooSmall(String),
    /// The tile does not exist.
    #[error("there is no tile {asked} in this forest; one of those that there are is {one}")]
    NoTile {
        /// The file that it would have.
        asked: String,
        /// The file of one that exists.
        one: String,
    },
    /// The file at the place of the manifest is not one.
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
    /// Its tiles.
    pub tiling: Tiling,
    /// Settings of the tiling.
    pub tiling_spec: TilingSpec,
    /// Differences between plants and the trees that they stand for.
    pub misfits: Misfits,
    /// Number of trees that each plant stands for.
    pub trees_of: Vec<u64>,
    spec: ForestTilesSpec,
}

impl ForestPlan {
    /// Grows the plants that a stand needs, and cuts it into tiles; `specs`: of its species, in their order. The same
    /// bits for any executor.
    ///
    /// Cost: that of [`Nursery::plan`], and linear in trees.
    ///
    /// # Errors
    /// [`ForestTilesError`] for species that cannot be grown and for stands that cannot be tiled.
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

    /// Returns the settings for meshing plants.
    pub const fn look(&self) -> &NurseryLook {
        &self.spec.look
    }

    pub(crate) const fn packing(&self) -> Packing {
        self.spec.packing
    }

    pub(crate) const fn seed(&self) -> Seed {
        self.spec.seed
    }

    /// Returns the rows of plants that stand for at least one tree.
    pub fn used_variants(&self) -> impl Iterator<Item = u32> + '_ {
        (0_u32..).zip(&self.trees_of).filter(|(_, trees)| **trees > 0).map(|(variant, _)| variant)
    }

    /// Returns the rows of plants that a tile shows.
    pub fn used_by(&self, tile: &StandTile) -> BTreeSet<u32> {
        let rows = self.tiling.shown(tile, &self.stand, self.spec.seed);
        rows.filter_map(|row| self.nursery.place(&self.stand.trees[row as usize]))
            .map(|p| p.variant)
            .collect()
    }

    /// Returns the tile of a name.
    ///
    /// # Errors
    /// [`ForestTilesError::NoTile`] with one that exists.
    pub fn tile(&self, id: TileId) -> Result<&StandTile, ForestTilesError> {
        self.tiling.find(id).ok_or_else(|| ForestTilesError::NoTile {
            asked: id.file(),
            one: self.tiling.tiles().last().map_or_else(String::new, |tile| tile.id.file()),
        })
    }

    /// Returns a digest of all that determines the tiles: trees, species, options, version. Equal keys, equal tiles.
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
