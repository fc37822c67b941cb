//! `burgeon forest`.

use std::path::PathBuf;

use burgeon::TileId;
use burgeon::forest::{BadRows, Crs, Setting};
use burgeon::glam::DVec3;
use burgeon::skin::SkinSpec;
use clap::Args;

use super::export::FoliageWord;
use super::given::Given;
use super::shared::{CommonArgs, PackWord, parse_field, ranged, seed, whole};

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon forest trees.csv -o city --map city.png --report city.json
  burgeon forest trees.csv -o city --place 16.37,48.21,170         where the origin stands on the earth
  burgeon forest trees.csv -o street --variants 8 --glb --usd
  burgeon forest trees.csv -o big --finest 1 --tile-trees 1024     many trees in few bytes
  burgeon forest trees.geojson --crs local -o park --ground hill.tif --lean 0.1
  burgeon forest stand.toml -o wood --map wood.png                  a stand that grows (docs/tiles.md)
  burgeon forest trees.csv -o one --tile 2,1,3,0                   a tile alone, the same bytes")]
pub(crate) struct ForestArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// The trees: an inventory (.csv, .geojson), or the spec of a stand that grows (.toml).
    #[arg(value_name = "INVENTORY")]
    pub(crate) input: PathBuf,
    /// The folder of the tileset: tileset.json, tiles, models, trees.csv, manifest.json. An interrupted run continues
    /// where it stopped.
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Also draw a plan: crowns from above, north up, coloured by species.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) map: Option<PathBuf>,
    /// Also write all trees as one file, DIR/forest.glb, with instances.
    #[arg(long)]
    pub(crate) glb: bool,
    /// Also write them as USD with a `PointInstancer`, DIR/forest.usda.
    #[arg(long)]
    pub(crate) usd: bool,
    /// Level of detail of --glb and --usd, from --finest to --lods [default: the second finest].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=6))]
    pub(crate) level: Option<u32>,
    /// Write only this tile, by depth, column, row and level as in its file's name tiles/D/X-Y-L.glb: the same bytes as
    /// in the whole. No tileset.json, no table.
    #[arg(long, value_name = "D,X,Y,L", value_parser = tile, conflicts_with_all = ["glb", "usd", "map"])]
    pub(crate) tile: Option<TileId>,
    /// Position of the origin on the earth: longitude and latitude in degrees, and metres above the ellipsoid [default:
    /// nowhere, a scene of its own].
    #[arg(long, value_name = "LON,LAT,H", allow_hyphen_values = true, value_parser = place)]
    pub(crate) place: Option<DVec3>,
    /// Most trees of a tile of the finest level; each coarser level has four times as many
    /// [default: a 700th of all, 64 to 1024].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65_536))]
    pub(crate) tile_trees: Option<u32>,
    /// Number of plants grown for each species and age of the trees, 1 to 64. More of them look less alike, and match
    /// diameters better.
    #[arg(long, value_name = "K", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) variants: u32,
    /// Seed of the plants and of their choice.
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) stand: InventoryArgs,
    #[command(flatten)]
    pub(crate) ground: GroundArgs,
    #[command(flatten)]
    pub(crate) surface: ForestSurfaceArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Settings for reading an inventory.
#[derive(Args, Debug)]
#[command(next_help_heading = "Inventory")]
pub(crate) struct InventoryArgs {
    /// Meaning of coordinates: metres, or degrees that become metres on a plane amid the trees (local) or of a zone
    /// (utm, utm32n) [default: metres, unless the file says degrees].
    #[arg(long, value_name = "metres|local|utm|utmNNn", value_parser = crs)]
    pub(crate) crs: Option<Crs>,
    /// Surroundings of the trees, by which missing measures are filled: free or stand.
    #[arg(long, value_name = "free|stand", default_value = "free", value_parser = setting)]
    pub(crate) setting: Setting,
    /// The species of rows that name none, or an unknown one [default: such rows are bad].
    #[arg(long, value_name = "NAME")]
    pub(crate) species: Option<String>,
    /// Treatment of bad rows: refuse or skip.
    #[arg(long, value_name = "refuse|skip", default_value = "refuse", value_parser = bad_rows)]
    pub(crate) bad_rows: BadRows,
    /// The year of the inventory, for columns that say when a tree was planted.
    #[arg(long, value_name = "YEAR", value_parser = clap::value_parser!(u32).range(1..=9999))]
    pub(crate) year: Option<u32>,
}

/// Ground of the trees of an inventory.
#[derive(Args, Debug)]
#[command(next_help_heading = "Ground")]
pub(crate) struct GroundArgs {
    /// Heights: a GeoTIFF in the projection of the inventory, a PNG of 16 bits with its middle at the origin, or a mesh
    /// in metres with +Y up [default: heights of the inventory, or flat].
    #[arg(long, value_name = "FILE")]
    pub(crate) ground: Option<PathBuf>,
    /// Side of a pixel of a PNG, metres.
    #[arg(long, value_name = "M", requires = "ground", value_parser = |s: &str| ranged(s, 0.001, 10_000.0))]
    pub(crate) metres_per_cell: Option<f64>,
    /// Heights of black and white of a PNG, metres.
    #[arg(long, value_name = "LOW,HIGH", requires = "ground", allow_hyphen_values = true, value_parser = heights)]
    pub(crate) heights: Option<[f64; 2]>,
    /// Lean of trunks with the ground: 0 is upright, 1 perpendicular to the ground [default: 0].
    #[arg(long, value_name = "SHARE", requires = "ground", value_parser = |s: &str| ranged(s, 0.0, 1.0))]
    pub(crate) lean: Option<f64>,
}

fn crs(text: &str) -> Result<Crs, String> {
    Crs::from_word(text).ok_or_else(|| "give metres, local, utm or a zone such as utm32n".into())
}

fn setting(text: &str) -> Result<Setting, String> {
    Setting::from_word(text).ok_or_else(|| format!("give {}", Setting::words()))
}

fn bad_rows(text: &str) -> Result<BadRows, String> {
    BadRows::from_word(text).ok_or_else(|| format!("give {}", BadRows::words()))
}

fn heights(text: &str) -> Result<[f64; 2], String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|w| w.trim().parse().ok()).collect();
    match numbers.as_slice() {
        &[low, high]
            if text.split(',').count() == 2 && low.abs() <= 2e4 && high.abs() <= 2e4 && low < high =>
        {
            Ok([low, high])
        }
        _ => Err("give two heights in metres, the lower one first, such as 120,480".into()),
    }
}

/// Options for meshing the plants of a forest.
#[derive(Args, Debug)]
#[command(next_help_heading = "Surface")]
pub(crate) struct ForestSurfaceArgs {
    /// The coarsest level of meshes, 0 to 6: each has about half of the triangles of the one before.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=6))]
    pub(crate) lods: u32,
    /// The finest level, 0 to --lods: 0 shows whole plants nearby.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=6))]
    pub(crate) finest: u32,
    /// Pixels of the pictures of distant trees, 128 to 4096, or off: 8 by 8 views from all sides.
    #[arg(long, value_name = "SIZE|off", default_value = "512", value_parser = impostor)]
    pub(crate) impostor: u32,
    /// Drawing of leaves.
    #[arg(long, value_enum, value_name = "HOW", default_value_t = FoliageWord::ByLevel)]
    pub(crate) foliage: FoliageWord,
    /// Fineness of the meshes, 0.1 to 8 [default: 1].
    #[arg(long, value_name = "X", allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<SkinSpec>(s, "detail"))]
    pub(crate) detail: Option<f64>,
    /// Sides of an ordinary branch, 3 to 24 [default: 8].
    #[arg(long, value_name = "N", value_parser = |s: &str| whole::<SkinSpec>(s, "sides"))]
    pub(crate) sides: Option<u32>,
    /// Pixels of a side of the textures, 64 to 4096.
    #[arg(long, value_name = "SIZE", default_value_t = 256, value_parser = clap::value_parser!(u32).range(64..=4096))]
    pub(crate) textures: u32,
    /// Packing of models and tiles.
    #[arg(long, value_enum, value_name = "HOW", default_value_t = PackWord::Meshopt)]
    pub(crate) pack: PackWord,
}

fn tile(text: &str) -> Result<TileId, String> {
    let numbers: Vec<u32> = text.split(',').filter_map(|w| w.trim().parse().ok()).collect();
    let id = match numbers.as_slice() {
        &[depth, x, y, level] if text.split(',').count() == 4 => u8::try_from(depth)
            .ok()
            .zip(u8::try_from(level).ok())
            .map(|(depth, level)| TileId { depth, x, y, level }),
        _ => None,
    };
    id.ok_or_else(|| "give four whole numbers such as 2,1,3,0".into())
}

fn place(text: &str) -> Result<DVec3, String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|w| w.trim().parse().ok()).collect();
    match numbers.as_slice() {
        &[lon, lat, h]
            if text.split(',').count() == 3 && lon.abs() <= 180.0 && lat.abs() <= 90.0 && h.abs() <= 1e5 =>
        {
            Ok(DVec3::new(lon, lat, h))
        }
        _ => {
            Err("give longitude (-180 to 180), latitude (-90 to 90) and metres, such as 16.37,48.21,170"
                .into())
        }
    }
}

/// Parses a size of atlases; 0 for off.
fn impostor(text: &str) -> Result<u32, String> {
    match text.parse() {
        _ if text == "off" => Ok(0),
        Ok(size @ 128..=4096) => Ok(size),
        _ => Err("give 128 to 4096 pixels, or off".to_owned()),
    }
}
