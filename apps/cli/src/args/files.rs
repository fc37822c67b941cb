//! `burgeon render`, `convert`, `info` and `studio`.

use std::path::PathBuf;

use clap::Args;

use super::given::Given;
use super::lists;
use super::shared::{AxesArgs, CommonArgs, PackWord, PictureArgs, seed};
use super::structure::StructureArgs;

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon render daisy.glb -o daisy.png
  burgeon render tree.obj -o tree.png --view turntable --size 1600x900
  burgeon render tree.glb -o tree.png --background transparent --no-shadow
  burgeon render walnut.mtg -o walnut.png --in-unit cm --thickness-unit mm")]
pub(crate) struct RenderArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    #[arg(value_name = "MODEL", help = lists::render_input())]
    pub(crate) input: PathBuf,
    /// The picture: .png.
    #[arg(long, short, value_name = "PNG")]
    pub(crate) output: PathBuf,
    /// Seed of the pattern of the lights.
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    #[command(flatten)]
    pub(crate) structure: StructureArgs,
    /// Number, from 1, of the plant in a file with the structure of several.
    #[arg(long, value_name = "N")]
    pub(crate) plant: Option<String>,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon convert oak.glb -o oak.obj
  burgeon convert scan.ply -o scan.glb --up z --unit mm
  burgeon convert scan.ply -o scan.obj --in-unit mm --unit m
  burgeon convert cylinders.csv -o tree.mtg                      from a table of cylinders to an MTG
  burgeon convert tree.mtg -o tree.qsm.csv")]
pub(crate) struct ConvertArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// The file to read.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// The file to write; its extension gives the format.
    #[arg(long, short, value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    #[command(flatten)]
    pub(crate) structure: StructureArgs,
    /// Number, from 1, of the plant in a file with the structure of several.
    #[arg(long, value_name = "N")]
    pub(crate) plant: Option<String>,
    /// Make the .glb light: numbers in few bits and textures as JPEG, and with meshopt also compressed
    /// (docs/exports.md).
    #[arg(long, value_enum, value_name = "HOW")]
    pub(crate) pack: Option<PackWord>,
    /// Also make a picture of a model.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Seed of the pattern of the picture's lights.
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

#[derive(Args, Debug)]
pub(crate) struct InfoArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    #[arg(value_name = "FILE", help = lists::info_input())]
    pub(crate) input: PathBuf,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    #[command(flatten)]
    pub(crate) structure: StructureArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon studio
  burgeon studio daisy.svg
  burgeon studio --no-open --port 8080
  burgeon studio rose.burgeon --lan                for a headset in the same network")]
pub(crate) struct StudioArgs {
    /// A drawing, project or model to open.
    #[arg(value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    /// Port of 127.0.0.1, 1 to 65535, or 0 for any free one [default: 7734, or the next free one].
    #[arg(long, value_name = "N")]
    pub(crate) port: Option<u16>,
    /// Open no browser.
    #[arg(long)]
    pub(crate) no_open: bool,
    /// Serve the network instead of this machine: https, and only for browsers that have the link, the QR code or the
    /// code that are shown, each of which works once. A project that is opened is written back to its file. ADDR: the
    /// address of this machine in that network [default: that of its outgoing connection].
    #[arg(long, value_name = "ADDR", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    pub(crate) lan: Option<String>,
    /// The folder of a built Studio [default: the one in the program].
    #[arg(long, value_name = "DIR")]
    pub(crate) folder: Option<PathBuf>,
}
