//! `burgeon species`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::shared::CommonArgs;
use super::structure::{LengthUnit, length_words};

/// Commands on species.
#[derive(Debug, Subcommand)]
pub(crate) enum SpeciesCommand {
    /// Make a species of measured trees: a spec whose trees branch like them
    ///
    /// Reads the structure of trees (tables of cylinders, as programs for laser scans write them, and those of `burgeon
    /// scan`; MTG, OPF, SWC), measures by branch order the lengths, thicknesses and taper of axes and the angles and
    /// distances at which they leave their bearers, and writes a spec that draws each of these from the measurements.
    /// Then it grows trees of the spec and reports, trait by trait, how well they agree with the trees that it was made
    /// of and with those that were kept out.
    Fit(Box<SpeciesFitArgs>),
}

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon species fit trees/*.csv -o my-oak.toml --png my-oak.png
  burgeon species fit orchard/*.mtg -o apple.toml --in-unit cm --thickness-unit mm
  burgeon grow my-oak.toml -o oak.glb --seed 7")]
pub(crate) struct SpeciesFitArgs {
    /// Files of trees: .csv, .txt (cylinders), .mtg, .opf, .swc. All plants of a file are used.
    #[arg(value_name = "TREES", required = true)]
    pub(crate) inputs: Vec<PathBuf>,
    /// The spec: .toml, for `burgeon grow`.
    #[arg(long, short, value_name = "SPECIES.toml")]
    pub(crate) output: PathBuf,
    /// Picture of the distributions, measured and grown: .png.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Trees that are grown for the comparison, 20 to 2000.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(20..=2000))]
    pub(crate) trees: u32,
    /// Fit all trees. Without it, every third of six or more is kept out of the fit and compared with the result of the
    /// others.
    #[arg(long)]
    pub(crate) keep_none_out: bool,
    /// Unit of length in the files [default: as a file says, or metres].
    #[arg(long, value_parser = length_words(), value_name = "UNIT")]
    pub(crate) in_unit: Option<LengthUnit>,
    /// Unit of radii and diameters in the files, where it differs from that of lengths.
    #[arg(long, value_parser = length_words(), value_name = "UNIT")]
    pub(crate) thickness_unit: Option<LengthUnit>,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}
