//! `burgeon compare`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::given::Given;
use super::shared::{CommonArgs, PictureArgs, ranged, seed};

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon compare oak
  burgeon compare oak --png oaks.png --report oaks.json
  burgeon compare oak --height 15 --detail 2
  burgeon compare guided --png two.png")]
pub(crate) struct CompareArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// Comparison to make.
    #[arg(value_enum)]
    pub(crate) what: CompareWord,
    /// Picture of all of them in a row, seen from the front, to one scale; --size is that of each.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Height to which all are scaled, metres, 0.1 to 1000.
    #[arg(long, value_name = "METRES", default_value_t = 10.0, value_parser = |s: &str| ranged(s, 0.1, 1000.0))]
    pub(crate) height: f64,
    /// Fineness of the meshes, 0.1 to 8.
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = |s: &str| ranged(s, 0.1, 8.0))]
    pub(crate) detail: f64,
    /// Seed of all random choices.
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum CompareWord {
    /// L-system, space colonization and space competition, as the paper's Table 2
    Oak,
    /// Guided growth (buds with markers of their own) and its baseline, self-organisation by space (Palubicki 2009)
    Guided,
}
