//! Tiles, the tileset, the table of trees, and one file of all.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use base::{Run, map_indexed};
use forest::{Figure, Tree};
use formats::{
    Group, Instance, Linking, Prototype, SharedModel, Tileset, TreeRow, TreeTable, WriteError, decode_uri,
    earth_frame, stand_usda, tileset_json, write_tile,
};
use glam::{DVec2, DVec3};
use mesh::Bounds;

use super::placed::Placed;
use super::plan::{ForestPlan, ForestTilesError};
use super::tile_folder::{TILESET, TileDisk, TileFolder};
use super::tile_models::{TileModels, Watch, stem};
use super::tiling::StandTile;

/// Number of tiles that are made in parallel and then put in place.
const SIDE_BY_SIDE: usize = 32;
/// Rows of the table that are written at a time.
const ROWS: usize = 4_096;

/// Files of a forest in addition to its tiles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WholeForest {
    /// Whether to write all trees into one `forest.glb`.
    pub glb: bool,
    /// Whether to write all trees into one `forest.usda`.
    pub usd: bool,
    /// The level of both, 0 for the finest of the tileset.
    pub level: u32,
    /// Longitude and latitude of the origin in degrees, and its height in metres, if the tileset stands on the earth.
    pub place: Option<DVec3>,
}

/// Writes the tiles of a forest.
#[derive(Clone, Copy, Debug)]
pub struct TileWriter<'a> {
    /// The forest that is written.
    pub plan: &'a ForestPlan,
    /// The models that its tiles refer to.
    pub models: &'a TileModels,
}

/// The trees of a tile or of all.
struct Shown {
    groups: BTreeMap<u32, Vec<Instance>>,
    rows: Vec<TreeRow>,
}

impl TileWriter<'_> {
    /// Writes missing tiles. Memory: that of 32 tiles.
    ///
    /// # Errors
    /// [`ForestTilesError`], and those of the disk.
    pub fn tiles<D: TileDisk>(
        &self,
        tiles: &[StandTile],
        folder: &mut TileFolder<D>,
        run: &Run<'_>,
        watch: Watch<'_>,
    ) -> Result<(), D::Error> {
        for (batch, chunk) in tiles.chunks(SIDE_BY_SIDE).enumerate() {
            run.cancel.check().map_err(ForestTilesError::from)?;
            watch(batch * SIDE_BY_SIDE, tiles.len());
            let wanted: Vec<&StandTile> =
                chunk.iter().filter(|t| folder.keep(&t.id.file()).is_none()).collect();
            let made = map_indexed(run.executor, wanted.len(), |k| self.tile(wanted[k]));
            for (tile, bytes) in wanted.iter().zip(made) {
                folder.put(&tile.id.file(), bytes?)?;
            }
        }
        folder.flush()
    }

    fn tile(&self, tile: &StandTile) -> Result<Vec<u8>, ForestTilesError> {
        let rows = self.plan.tiling.shown(tile, &self.plan.stand, self.plan.seed());
        let shown = self.shown(rows, tile.wider());
        let groups =
            self.groups(&shown, |variant| self.models.for_tile(variant, self.plan.tiling.detail(tile)))?;
        let mut bytes = Vec::new();
        let packing = Some(self.plan.packing());
        write_tile("trees", &groups, &self.table(&shown), packing, Linking::Named, &mut bytes)?;
        Ok(bytes)
    }

    fn groups<'b>(
        &self,
        shown: &'b Shown,
        model: impl Fn(u32) -> Result<&'b SharedModel, ForestTilesError>,
    ) -> Result<Vec<Group<'b>>, ForestTilesError> {
        let group = |(&variant, instances): (&u32, &'b Vec<Instance>)| {
            Ok(Group { model: model(variant)?, instances })
        };
        shown.groups.iter().map(group).collect()
    }

    fn table<'b>(&'b self, shown: &'b Shown) -> TreeTable<'b> {
        TreeTable { species: &self.plan.stand.species, rows: &shown.rows }
    }

    fn shown(&self, rows: impl Iterator<Item = u32>, wider: f64) -> Shown {
        let mut placed: BTreeMap<u32, Vec<(Placed, &Tree)>> = BTreeMap::new();
        for row in rows {
            let tree = &self.plan.stand.trees[row as usize];
            let Some(own) = self.plan.nursery.place(tree) else { continue };
            let own = Placed { scale: own.scale * DVec3::new(wider, 1.0, wider), ..own };
            placed.entry(own.variant).or_default().push((own, tree));
        }
        // The table has the order of the copies, as tiles ask for few bytes.
        let mut shown = Shown { groups: BTreeMap::new(), rows: Vec::new() };
        for (variant, trees) in placed {
            let mut instances = Vec::with_capacity(trees.len());
            for (own, tree) in trees {
                let at = u32::try_from(shown.rows.len()).unwrap_or(u32::MAX);
                shown.rows.push(table_row(tree));
                instances.push(own.instance(tree, at));
            }
            shown.groups.insert(variant, instances);
        }
        shown
    }

    /// Writes the tileset, the table of trees, the manifest, and one file of all trees if it is wanted: the last step,
    /// after all tiles.
    ///
    /// # Errors
    /// [`ForestTilesError`], and those of the disk.
    pub fn whole<D: TileDisk>(
        &self,
        whole: &WholeForest,
        folder: &mut TileFolder<D>,
    ) -> Result<(), D::Error> {
        self.tileset(whole, folder)?;
        self.csv(folder)?;
        if whole.glb || whole.usd {
            let count = u32::try_from(self.plan.stand.trees.len()).unwrap_or(u32::MAX);
            let shown = self.shown(0..count, 1.0);
            if whole.glb {
                self.glb(&shown, whole.level, folder)?;
            }
            if whole.usd {
                self.usd(&shown, whole.level, folder)?;
            }
        }
        folder.manifest()
    }

    fn usd<D: TileDisk>(
        &self,
        shown: &Shown,
        level: u32,
        folder: &mut TileFolder<D>,
    ) -> Result<(), D::Error> {
        let files = shown.groups.keys().map(|&v| format!("models/{}.usda", stem(self.plan, v, level)));
        let files: Vec<String> = files.collect();
        let prototypes = files.iter().zip(shown.groups.values());
        let prototypes: Vec<Prototype<'_>> =
            prototypes.map(|(file, instances)| Prototype { file, instances }).collect();
        let text = stand_usda(&prototypes, &self.table(shown)).map_err(ForestTilesError::from)?;
        folder.write_last("forest.usda", |out| Ok(out.write_all(&text)?))
    }

    fn tileset<D: TileDisk>(&self, whole: &WholeForest, folder: &mut TileFolder<D>) -> Result<(), D::Error> {
        let trees = &self.plan.stand.trees;
        let root =
            self.plan.tiling.nodes(&self.plan.stand, &|row, wider| self.reach(&trees[row as usize], wider));
        let tileset = Tileset {
            root: &root,
            // An empty view is twice as wrong as the coarsest tile, and the error is never small against the forest.
            geometric_error_m: 2.0 * root.geometric_error_m.max(root.bounds.size().length() / 16.0),
            transform: whole.place.map(|p| earth_frame(DVec2::new(p.x, p.y), p.z)),
            origin_m: self.plan.stand.origin_m,
        };
        let text = tileset_json(&tileset);
        folder.write_last(TILESET, |out| Ok(out.write_all(&text)?))
    }

    /// Returns the box around the plant that stands for a tree.
    fn reach(&self, tree: &Tree, wider: f64) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        let Some(placed) = self.plan.nursery.place(tree) else { return bounds };
        let own = self.models.bounds(placed.variant);
        if own.is_empty() {
            bounds.include(tree.foot_m);
            return bounds;
        }
        let scale = placed.scale * DVec3::new(wider, 1.0, wider);
        for corner in 0..8_u32 {
            let pick = |bit: u32, low: f64, high: f64| if corner >> bit & 1 == 0 { low } else { high };
            let at = DVec3::new(
                pick(0, own.min.x, own.max.x),
                pick(1, own.min.y, own.max.y),
                pick(2, own.min.z, own.max.z),
            );
            bounds.include(tree.foot_m + placed.turn * (scale * at));
        }
        bounds
    }

    fn glb<D: TileDisk>(
        &self,
        shown: &Shown,
        level: u32,
        folder: &mut TileFolder<D>,
    ) -> Result<(), D::Error> {
        let groups = self.groups(shown, |variant| self.models.for_root(variant, level))?;
        let open = |uri: &str| {
            let file = decode_uri(uri).unwrap_or_else(|| uri.to_owned());
            let none = || WriteError::Io(std::io::ErrorKind::NotFound.into());
            folder.read(&file).ok().flatten().ok_or_else(none)
        };
        let (table, packing, mut bytes) = (self.table(shown), Some(self.plan.packing()), Vec::new());
        write_tile("forest", &groups, &table, packing, Linking::Embedded(&open), &mut bytes)
            .map_err(ForestTilesError::from)?;
        folder.write_last("forest.glb", |out| Ok(out.write_all(&bytes)?))
    }

    /// Writes one row for each tree: its measures, and the plant that stands for it.
    fn csv<D: TileDisk>(&self, folder: &mut TileFolder<D>) -> Result<(), D::Error> {
        let origin = self.plan.stand.origin_m;
        folder.write_last("trees.csv", |out| {
            out.write_all(
                b"row,species,easting_m,northing_m,ground_m,height_m,dbh_m,crown_width_m,age_years,given,plant,\
                scale_across,scale_up,height_error_m,dbh_error_m,crown_error_m\n",
            )?;
            let mut text = String::new();
            for trees in self.plan.stand.trees.chunks(ROWS) {
                text.clear();
                for t in trees {
                    let Some(p) = self.plan.nursery.place(t) else { continue };
                    // -Z is north.
                    let (east, north, up) =
                        (origin.x + t.foot_m.x, origin.z - t.foot_m.z, origin.y + t.foot_m.y);
                    let species = quoted(&self.plan.stand.species[usize::from(t.species)]);
                    let _ = write!(text, "{},{species}", t.row);
                    let measures = [(t.height_m, 2), (t.dbh_m, 4), (t.crown_width_m, 2), (t.age_years, 1)];
                    for (number, digits) in [(east, 3), (north, 3), (up, 3)].into_iter().chain(measures) {
                        write_number(&mut text, number, digits);
                    }
                    let _ = write!(text, ",{},{}", given(t), self.plan.nursery.name(p.variant));
                    let errors = [(p.height_error_m, 3), (p.dbh_error_m, 4), (p.crown_error_m, 3)];
                    for (number, digits) in [(p.scale.x, 4), (p.scale.y, 4)].into_iter().chain(errors) {
                        write_number(&mut text, number, digits);
                    }
                    text.push('\n');
                }
                out.write_all(text.as_bytes())?;
            }
            Ok(())
        })
    }
}

fn table_row(tree: &Tree) -> TreeRow {
    TreeRow {
        species: tree.species,
        row: tree.row,
        height_m: tree.height_m,
        dbh_m: tree.dbh_m,
        crown_width_m: tree.crown_width_m,
        age_years: tree.age_years,
    }
}

/// A comma and a number with at most so many digits, at least one, behind its point: none that says nothing.
fn write_number(text: &mut String, number: f64, digits: usize) {
    text.push(',');
    let start = text.len();
    let _ = write!(text, "{number:.digits$}");
    text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    if &text[start..] == "-0" {
        text.replace_range(start.., "0");
    }
}

/// Which measures the inventory gave, by their letters.
fn given(tree: &Tree) -> String {
    let all = [(Figure::Height, 'h'), (Figure::Dbh, 'd'), (Figure::CrownWidth, 'c'), (Figure::Age, 'a')];
    all.into_iter().filter(|(figure, _)| tree.given.has(*figure)).map(|(_, letter)| letter).collect()
}

/// Quotes a field of CSV.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
