//! `burgeon scan`.

use std::path::PathBuf;

use clap::Args;

use super::export::TreeSurfaceArgs;
use super::given::Given;
use super::lists;
use super::settings;
use super::shared::{AxesArgs, CheckArgs, CommonArgs, PictureArgs, ranged, seed};
use crate::failure::Outcome;

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon scan tree.laz -o tree.glb --qsm tree.csv --mtg tree.mtg --report tree.json
  burgeon scan plot.las --at 12.5,3.0 -o tree.glb           the tree that stands there
  burgeon scan plot.las --all -o plot/                      each tree, with an inventory and a map
  burgeon scan tree.xyz --unit mm --leaves oak -o oak.glb --png oak.png
  burgeon scan tree.ply --up y -o tree.glb")]
pub(crate) struct ScanArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// The scan: .laz, .las, .e57, .ply, .xyz, .txt, .pcd or .obj, with +Z up unless --up says otherwise.
    #[arg(value_name = "SCAN")]
    pub(crate) input: PathBuf,
    #[arg(long, short, value_name = "OUT", help = lists::plant_output(), required_unless_present_any = ["png", "qsm", "mtg", "report", "json"])]
    pub(crate) output: Option<PathBuf>,
    /// Also write the wood as cylinders: a quantitative structure model, one a row, with `TreeQSM`'s column names.
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) qsm: Option<PathBuf>,
    /// Also write the structure.
    #[arg(long, value_name = "FILE.mtg")]
    pub(crate) mtg: Option<PathBuf>,
    /// Also make a picture.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Leaves and bark of a species of `burgeon presets`, or of a spec (.toml) [default: a bare tree].
    #[arg(long, value_name = "PRESET|SPEC.toml")]
    pub(crate) leaves: Option<PathBuf>,
    /// Position of the stem on the ground, in the coordinates and the unit of the scan: the two that are not up, in
    /// their order [default: the largest thing that stands on the ground].
    #[arg(long, value_name = "A,B", allow_hyphen_values = true, value_parser = place)]
    pub(crate) at: Option<[f64; 2]>,
    /// Make a tree of each stem: -o names a folder, which gets a model and a table of cylinders of each, an inventory
    /// (inventory.csv) and a map (map.png). Existing trees are kept, if their points and options are the same.
    #[arg(long, conflicts_with_all = ["at", "png", "qsm", "mtg"], requires = "output")]
    pub(crate) all: bool,
    /// Edge of the cubes into which the cloud is divided, metres, 0.001 to 1 [default: by the spacing of the points].
    #[arg(long, value_name = "M", value_parser = |s: &str| ranged(s, 0.001, 1.0))]
    pub(crate) cell: Option<f64>,
    /// Widest gap that is bridged, metres, 0 to 5 [default: 4 % of the height, at most 0.6].
    #[arg(long, value_name = "M", value_parser = |s: &str| ranged(s, 0.0, 5.0))]
    pub(crate) gap: Option<f64>,
    /// Seed of the leaves.
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) surface: TreeSurfaceArgs,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    #[command(flatten)]
    pub(crate) checks: CheckArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

fn place(text: &str) -> Result<[f64; 2], String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|w| w.trim().parse().ok()).collect();
    match numbers.as_slice() {
        &[a, b] if text.split(',').count() == 2 && a.abs() <= 1e8 && b.abs() <= 1e8 => Ok([a, b]),
        _ => Err("give two numbers within 1e8 such as 12.5,3".into()),
    }
}

impl ScanArgs {
    /// Sets the options that the engine of `--for` requires.
    pub(crate) fn settle(&mut self) -> Outcome {
        let surface = &mut self.surface;
        let set = (&mut surface.export, &mut surface.skin, &mut self.axes);
        settings::settle(&self.given, set, self.output.as_deref())
    }
}
