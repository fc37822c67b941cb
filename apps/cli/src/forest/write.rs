//! Tiles, the tileset, the table of trees, and one file of all.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{self, Write};

use burgeon::forest::{Figure, Tree};
use burgeon::formats::{
    Group, Instance, Linking, Prototype, Tileset, TreeRow, TreeTable, WriteError, decode_uri, earth_frame,
    stand_usda, tileset_json, write_tile,
};
use burgeon::glam::{DVec2, DVec3};
use burgeon::mesh::Bounds;
use burgeon::{Placed, StandTile};

use super::folder::{Entry, Folder, TILESET};
use super::models::{self, Models};
use super::{Plan, failed_to_write};
use crate::args::ForestArgs;
use crate::failure::{Failure, Outcome};
use crate::inputs;
use crate::machine::{Machine, Progress};
use crate::output::Outputs;

/// Tiles that are made side by side and then put in place.
const SIDE_BY_SIDE: usize = 32;
/// Rows of the table that are written at a time.
const ROWS: usize = 4_096;

pub(super) struct Writer<'a> {
    pub(super) plan: &'a Plan,
    pub(super) models: &'a Models,
    pub(super) machine: &'a Machine,
}

/// The trees of a tile or of all.
struct Shown {
    groups: BTreeMap<u32, Vec<Instance>>,
    rows: Vec<TreeRow>,
}

impl Writer<'_> {
    /// Writes tiles that are not there yet.
    pub(super) fn tiles(&self, tiles: &[StandTile], folder: &mut Folder, progress: &Progress) -> Outcome {
        progress.expect(tiles.len());
        for (batch, chunk) in tiles.chunks(SIDE_BY_SIDE).enumerate() {
            self.machine.cancel.check()?;
            progress.reached(batch * SIDE_BY_SIDE);
            let wanted: Vec<&StandTile> =
                chunk.iter().filter(|t| folder.keep(&t.id.file()).is_none()).collect();
            let made = burgeon::map_indexed(&self.machine.threads, wanted.len(), |k| self.tile(wanted[k]));
            for (tile, bytes) in wanted.iter().zip(made) {
                folder.put(&tile.id.file(), bytes?)?;
            }
        }
        folder.flush()
    }

    fn tile(&self, tile: &StandTile) -> Outcome<Vec<u8>> {
        let rows = self.plan.tiling.shown(tile, &self.plan.stand, self.plan.seed);
        let shown = self.shown(rows, tile.wider());
        let level = self.plan.tiling.detail(tile);
        let groups = shown.groups.iter().map(|(&variant, instances)| {
            Ok(Group { model: self.models.for_tile(variant, level)?, instances })
        });
        let groups: Vec<Group<'_>> = groups.collect::<Outcome<_>>()?;
        let mut bytes = Vec::new();
        let packing = Some(self.plan.packing);
        write_tile("trees", &groups, &self.table(&shown), packing, Linking::Named, &mut bytes)
            .map_err(|e| failed_to_write(&e))?;
        Ok(bytes)
    }

    fn table<'b>(&'b self, shown: &'b Shown) -> TreeTable<'b> {
        TreeTable { species: &self.plan.stand.species, rows: &shown.rows }
    }

    fn shown(&self, rows: impl Iterator<Item = u32>, wider: f64) -> Shown {
        let mut shown = Shown { groups: BTreeMap::new(), rows: Vec::new() };
        for row in rows {
            let tree = &self.plan.stand.trees[row as usize];
            let Some(placed) = self.plan.nursery.place(tree) else { continue };
            let placed = Placed { scale: placed.scale * DVec3::new(wider, 1.0, wider), ..placed };
            let at = u32::try_from(shown.rows.len()).unwrap_or(u32::MAX);
            shown.rows.push(table_row(tree));
            shown.groups.entry(placed.variant).or_default().push(placed.instance(tree, at));
        }
        shown
    }

    /// Writes what readers open, and the rest that needs all trees; their entries of the manifest.
    pub(super) fn whole(
        &self,
        args: &ForestArgs,
        folder: &Folder,
        outputs: &mut Outputs,
    ) -> Outcome<Vec<Entry>> {
        let mut last = vec![self.tileset(args, folder, outputs)?];
        last.push(self.csv(folder, outputs)?);
        if !args.glb && !args.usd {
            return Ok(last);
        }
        let level = super::one_level(args);
        let count = u32::try_from(self.plan.stand.trees.len()).unwrap_or(u32::MAX);
        let shown = self.shown(0..count, 1.0);
        if args.glb {
            last.push(self.glb(&shown, level, folder, outputs)?);
        }
        if args.usd {
            let files =
                shown.groups.keys().map(|&v| format!("models/{}.usda", models::stem(self.plan, v, level)));
            let files: Vec<String> = files.collect();
            let prototypes = files.iter().zip(shown.groups.values());
            let prototypes: Vec<Prototype<'_>> =
                prototypes.map(|(file, instances)| Prototype { file, instances }).collect();
            let text = stand_usda(&prototypes, &self.table(&shown)).map_err(|e| failed_to_write(&e))?;
            last.push(write(folder, outputs, "forest.usda", |out| Ok(out.write_all(&text)?))?);
        }
        Ok(last)
    }

    fn tileset(&self, args: &ForestArgs, folder: &Folder, outputs: &mut Outputs) -> Outcome<Entry> {
        let trees = &self.plan.stand.trees;
        let root =
            self.plan.tiling.nodes(&self.plan.stand, &|row, wider| self.reach(&trees[row as usize], wider));
        let tileset = Tileset {
            root: &root,
            // Nothing at all is twice as wrong as the coarsest tile, and no smaller than the forest.
            geometric_error_m: 2.0 * root.geometric_error_m.max(root.bounds.size().length() / 16.0),
            transform: args.place.map(|p| earth_frame(DVec2::new(p.x, p.y), p.z)),
            origin_m: self.plan.stand.origin_m,
        };
        let text = tileset_json(&tileset);
        write(folder, outputs, TILESET, |out| Ok(out.write_all(&text)?))
    }

    /// The box around what stands for a tree.
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

    fn glb(&self, shown: &Shown, level: u32, folder: &Folder, outputs: &mut Outputs) -> Outcome<Entry> {
        let groups = shown.groups.iter().map(|(&variant, instances)| {
            Ok(Group { model: self.models.for_root(variant, level)?, instances })
        });
        let groups: Vec<Group<'_>> = groups.collect::<Outcome<_>>()?;
        let open = |uri: &str| {
            let file = decode_uri(uri).unwrap_or_else(|| uri.to_owned());
            inputs::read_own(&folder.path(&file)).map_err(WriteError::Io)
        };
        write(folder, outputs, "forest.glb", |out| {
            let (table, packing) = (self.table(shown), Some(self.plan.packing));
            write_tile("forest", &groups, &table, packing, Linking::Embedded(&open), out)
        })
    }

    /// A row a tree: what it is, and what stands for it.
    fn csv(&self, folder: &Folder, outputs: &mut Outputs) -> Outcome<Entry> {
        let origin = self.plan.stand.origin_m;
        write(folder, outputs, "trees.csv", |out| {
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
                    let _ = writeln!(
                        text,
                        "{},{species},{east:.3},{north:.3},{up:.3},{:.2},{:.4},{:.2},{:.1},{},{},{:.4},{:.4},{:.3},{:.4},{:.3}",
                        t.row,
                        t.height_m,
                        t.dbh_m,
                        t.crown_width_m,
                        t.age_years,
                        given(t),
                        self.plan.nursery.name(p.variant),
                        p.scale.x,
                        p.scale.y,
                        p.height_error_m,
                        p.dbh_error_m,
                        p.crown_error_m,
                    );
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

/// Which measures the inventory gave, by their letters.
fn given(tree: &Tree) -> String {
    let all = [(Figure::Height, 'h'), (Figure::Dbh, 'd'), (Figure::CrownWidth, 'c'), (Figure::Age, 'a')];
    all.into_iter().filter(|(figure, _)| tree.given.has(*figure)).map(|(_, letter)| letter).collect()
}

/// A field of CSV.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// Writes a file of the last step; its entry of the manifest.
fn write(
    folder: &Folder,
    outputs: &mut Outputs,
    file: &str,
    write: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
) -> Outcome<Entry> {
    let (mut digest, mut bytes) = (burgeon::Digest::new(), 0);
    outputs.write("-o", &folder.path(file), |out| {
        let mut tally = Tally { out, digest: &mut digest, bytes: &mut bytes };
        write(&mut tally)
    })?;
    Ok(Entry { file: file.to_owned(), digest: digest.hex(), bytes })
}

/// Counts and digests what goes through.
struct Tally<'a> {
    out: &'a mut dyn Write,
    digest: &'a mut burgeon::Digest,
    bytes: &'a mut u64,
}

impl Write for Tally<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n = self.out.write(bytes)?;
        self.digest.bytes(&bytes[..n]);
        *self.bytes += n as u64;
        Ok(n)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl std::fmt::Debug for Tally<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Tally").field("bytes", self.bytes).finish_non_exhaustive()
    }
}

pub(super) fn failure(error: &WriteError) -> Failure {
    match error {
        WriteError::Io(e) => Failure::Bad(format!("a file of the forest cannot be made: {e}")),
        e => Failure::Bug(e.to_string()),
    }
}
