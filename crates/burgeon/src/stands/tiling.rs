//! The quadtree: the trees of a tile, and its level of detail.

use std::ops::Range;

use base::Seed;
use forest::{Stand, Tree};
use formats::TileNode;
use glam::DVec3;
use mesh::Bounds;

/// Most halvings of a cell.
const DEEPEST: u8 = 20;
/// Least side of the whole, metres.
const LEAST_M: f64 = 16.0;
/// Error of the first coarser level, as a share of the height of a tree. That level is made for trees of 192 pixels,
/// and readers of tiles accept an error of 16 pixels.
const LOST: f64 = 16.0 / 192.0;
/// Trees of the finest tiles where nothing else is asked for: so many tiles for the whole, but within these. As many as cells
/// that were halved five times, less what stands of equal density need so that hardly a cell has to be halved once more.
const TILES: usize = 700;
const FEWEST: u32 = 64;
/// Most trees of a finest tile by default.
const MOST: u32 = 1_024;

/// Settings for cutting a stand into tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TilingSpec {
    /// Most trees of a tile of the finest level, at least 1; each coarser level has four times as many.
    pub trees: u32,
    /// The finest level of detail, as [`NurseryLook::finest`](super::NurseryLook::finest).
    pub finest: u32,
    /// Number of levels of detail, at least 1; coarser tiles have the last level, and one of four trees.
    pub levels: u32,
}

impl TilingSpec {
    /// Returns the default number of trees of the finest tiles of a stand: 64 up to 64,000 trees, 1,024 from a million
    /// on.
    pub fn usual_trees(trees: usize) -> u32 {
        u32::try_from(trees / TILES).unwrap_or(MOST).clamp(FEWEST, MOST)
    }
}

/// The name of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TileId {
    /// Number of times that the whole was halved.
    pub depth: u8,
    /// Column, from the west.
    pub x: u32,
    /// Row, from the north.
    pub y: u32,
    /// Level of detail, 0 for the finest of the tileset.
    pub level: u8,
}

impl TileId {
    /// Returns its file below the folder of the tileset.
    pub fn file(self) -> String {
        let Self { depth, x, y, level } = self;
        format!("tiles/{depth}/{x}-{y}-{level}.glb")
    }
}

/// A tile and its trees.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StandTile {
    /// Its name.
    pub id: TileId,
    /// Range of its trees in [`Tiling::order`].
    trees: Range<usize>,
    /// Number of times that its trees were reduced to one in four, beyond the coarsest level of detail.
    pub thinned: u32,
    /// End of the range of the tiles below it.
    end: usize,
}

/// Reason why a stand is not cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TilingError {
    /// No trees.
    #[error("there are no trees")]
    Empty,
    /// More than 2^31 trees.
    #[error("there are more trees than tiles can name; split the inventory")]
    TooMany,
}

/// Tiles of a stand: a quadtree over the ground, in which each cell has its trees at a level of detail and is replaced
/// by cells of the next finer level, itself or its quarters.
///
/// Guaranteed: a tree is in one tile of each level of detail that is not thinned; its choice follows from the stand and
/// the spec alone.
#[derive(Clone, Debug)]
pub struct Tiling {
    /// Rows of trees, by their place along the curve through all cells.
    order: Vec<u32>,
    /// Tiles, coarser ones before those that replace them.
    tiles: Vec<StandTile>,
    spec: TilingSpec,
}

impl Tiling {
    /// Cuts a stand into tiles.
    ///
    /// Cost: n log n in trees; 12 bytes a tree and 40 a tile.
    ///
    /// # Errors
    /// [`TilingError`].
    pub fn new(stand: &Stand, spec: TilingSpec) -> Result<Self, TilingError> {
        let Ok(count) = u32::try_from(stand.trees.len()) else { return Err(TilingError::TooMany) };
        if count == 0 {
            return Err(TilingError::Empty);
        }
        let feet = || stand.trees.iter().map(|t| t.foot_m);
        let (low, high) =
            feet().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        let low = low.floor();
        // As close around the stand as it can be, so that its tiles are full.
        let side = (high.x - low.x).max(high.z - low.z).ceil().max(LEAST_M);
        let mut keyed: Vec<(u64, u32)> = (0..count)
            .zip(feet())
            .map(|(row, foot)| (curve([(foot.x - low.x) / side, (foot.z - low.z) / side]), row))
            .collect();
        keyed.sort_unstable();
        let spec = TilingSpec { trees: spec.trees.max(1), levels: spec.levels.max(1), ..spec };
        // The coarsest level includes all trees.
        let mut top = 0;
        while capacity(spec, top) < keyed.len() || top + 1 < spec.levels {
            top += 1;
        }
        let mut tiling = Self { order: Vec::new(), tiles: Vec::new(), spec };
        tiling.cut(&keyed, 0..keyed.len(), (0, 0, 0), top);
        tiling.order = keyed.into_iter().map(|(_, row)| row).collect();
        Ok(tiling)
    }

    /// Makes the tiles of a cell, which is to be shown at a level.
    fn cut(&mut self, keyed: &[(u64, u32)], trees: Range<usize>, (depth, x, y): (u8, u32, u32), level: u32) {
        if trees.is_empty() {
            return;
        }
        debug_assert!(trees.len() <= capacity(self.spec, level) || depth == DEEPEST, "it fits");
        let row = self.tiles.len();
        let id = TileId { depth, x, y, level: u8::try_from(level).unwrap_or(u8::MAX) };
        let thinned = (level + 1).saturating_sub(self.spec.levels);
        self.tiles.push(StandTile { id, trees: trees.clone(), thinned, end: row + 1 });
        if level > 0 {
            self.cut_until_it_fits(keyed, trees, (depth, x, y), level - 1);
        }
        self.tiles[row].end = self.tiles.len();
    }

    /// Halves a cell until its trees fit into tiles of a level.
    fn cut_until_it_fits(
        &mut self,
        keyed: &[(u64, u32)],
        trees: Range<usize>,
        (depth, x, y): (u8, u32, u32),
        level: u32,
    ) {
        if trees.len() <= capacity(self.spec, level) || depth == DEEPEST {
            return self.cut(keyed, trees, (depth, x, y), level);
        }
        let shift = 2 * (DEEPEST - depth - 1);
        let mut start = trees.start;
        for quarter in 0..4_u32 {
            let is_before = |(key, _): &(u64, u32)| (key >> shift) & 3 <= u64::from(quarter);
            let end = start + keyed[start..trees.end].partition_point(is_before);
            let cell = (depth + 1, 2 * x + (quarter & 1), 2 * y + (quarter >> 1));
            self.cut_until_it_fits(keyed, start..end, cell, level);
            start = end;
        }
    }

    /// Returns all tiles, coarser ones before those that replace them.
    pub fn tiles(&self) -> &[StandTile] {
        &self.tiles
    }

    /// Returns a tile by its name.
    pub fn find(&self, id: TileId) -> Option<&StandTile> {
        self.tiles.iter().find(|t| t.id == id)
    }

    /// Returns the level of detail of a tile: a row of the levels of [`Nursery::models`](super::Nursery::models).
    pub fn detail(&self, tile: &StandTile) -> u32 {
        u32::from(tile.id.level).min(self.spec.levels - 1)
    }

    /// Returns the rows of [`Stand::trees`] that a tile shows, in the order of the curve. A thinned one shows those
    /// whose keys, drawn from `seed`, end in enough zeros: each is also in the tiles that replace it.
    pub fn shown<'a>(
        &'a self,
        tile: &'a StandTile,
        stand: &'a Stand,
        seed: Seed,
    ) -> impl Iterator<Item = u32> + use<'a> {
        let mask = (1_u64 << (2 * tile.thinned).min(62)) - 1;
        let is_left = move |row: &u32| {
            let tree: Option<&Tree> = stand.trees.get(*row as usize);
            tree.is_some_and(|t| seed.child(u64::from(t.row)).number() & mask == 0)
        };
        let own = &self.order[tile.trees.clone()];
        // Of a few trees none may remain: then the first one is shown.
        let none = tile.thinned > 0 && !own.iter().any(is_left);
        own.iter()
            .copied()
            .enumerate()
            .filter(move |(k, row)| is_left(row) || (none && *k == 0))
            .map(|(_, row)| row)
    }

    /// Returns the tree of tiles with their boxes and errors. `reach`: returns the box around the plant of a tree,
    /// widened by the tile's own factor in thinned tiles.
    pub fn nodes(&self, stand: &Stand, reach: &dyn Fn(u32, f64) -> Bounds) -> TileNode {
        self.node(0, stand, reach).0
    }

    /// Returns a tile, and the height of the tallest tree in it.
    fn node(&self, row: usize, stand: &Stand, reach: &dyn Fn(u32, f64) -> Bounds) -> (TileNode, f64) {
        let tile = &self.tiles[row];
        let (mut bounds, mut tallest, mut children) = (Bounds::EMPTY, 0.0_f64, Vec::new());
        let mut child = row + 1;
        while child < tile.end {
            let (node, height) = self.node(child, stand, reach);
            bounds.include(node.bounds.min);
            bounds.include(node.bounds.max);
            tallest = tallest.max(height);
            children.push(node);
            child = self.tiles[child].end;
        }
        if children.is_empty() || tile.thinned > 0 {
            for &tree in &self.order[tile.trees.clone()] {
                let own = reach(tree, tile.wider());
                bounds.include(own.min);
                bounds.include(own.max);
                tallest = tallest.max(stand.trees[tree as usize].height_m);
            }
        }
        let geometric_error_m = self.lost(tile, tallest);
        (TileNode { bounds, geometric_error_m, content: tile.id.file(), children }, tallest)
    }

    /// Returns the error of a tile, metres: that of its level of detail for the tallest tree, 0 for the finest.
    fn lost(&self, tile: &StandTile, tallest_m: f64) -> f64 {
        if tile.id.level == 0 {
            return 0.0;
        }
        let level = self.spec.finest + u32::from(tile.id.level);
        LOST * tallest_m * f64::from(1_u32 << (level - 1).min(30))
    }
}

impl StandTile {
    /// Returns the number of trees in it; a thinned one shows fewer.
    pub fn len(&self) -> usize {
        self.trees.len()
    }

    /// Whether it has no trees.
    pub fn is_empty(&self) -> bool {
        self.trees.is_empty()
    }

    /// Returns the factor by which its plants are widened, to cover the ground of those that are left out.
    pub fn wider(&self) -> f64 {
        f64::from(1_u32 << self.thinned.min(30))
    }
}

/// Returns the most trees of a tile of a level.
fn capacity(spec: TilingSpec, level: u32) -> usize {
    (spec.trees as usize).saturating_mul(1_usize.checked_shl(2 * level).unwrap_or(usize::MAX).max(1))
}

/// Returns the place of a point (0 to 1) on the curve through all cells (Morton 1966): bits of both coordinates in
/// turn.
fn curve(at: [f64; 2]) -> u64 {
    let cells = f64::from(1_u32 << DEEPEST);
    let [x, y] = at.map(|x| u64::from(base::ops::whole((x * cells).clamp(0.0, cells - 1.0))));
    (0..u64::from(DEEPEST)).map(|bit| (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1)).sum()
}
