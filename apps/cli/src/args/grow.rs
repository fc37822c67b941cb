//! `burgeon grow`.

use std::path::PathBuf;

use burgeon::glam::DVec3;
use burgeon::growth::FoliageSpec;
use burgeon::{TreeGoal, TreeSpec};
use clap::{Args, ValueEnum};

use super::export::TreeSurfaceArgs;
use super::given::Given;
use super::lists;
use super::settings;
use super::shared::{AxesArgs, CheckArgs, CommonArgs, PictureArgs, parse_field, ranged, seed};
use crate::failure::Outcome;

#[derive(Args, Debug)]
#[command(after_long_help = GROW_EXAMPLES)]
pub(crate) struct GrowArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// A species of `burgeon presets`, or a spec (.toml) [default: a plain tree].
    #[arg(value_name = "PRESET|SPEC.toml", required_unless_present_any = ["method", "attractors"])]
    pub(crate) what: Option<PathBuf>,
    #[arg(long, short, value_name = "OUT", help = lists::plant_output(), required_unless_present_any = ["png", "qsm", "drawing", "report", "json"])]
    pub(crate) output: Option<PathBuf>,
    /// Also write the wood as cylinders: a quantitative structure model, one a row, with `TreeQSM`'s column names.
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) qsm: Option<PathBuf>,
    /// Also draw it as a person would, from the front: lines, which `burgeon sketch` reads.
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) drawing: Option<PathBuf>,
    /// Also make a picture.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Seed of all random choices.
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) growth: GrowthArgs,
    #[command(flatten)]
    pub(crate) points: PointsArgs,
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

const GROW_EXAMPLES: &str = "Examples:
  burgeon grow oak -o oak.glb --png oak.png
  burgeon grow pine -o pine.glb --leaf-keep 0.4 --lods 3         pine.glb, pine-lod1.glb, ...
  burgeon grow oak -o oak.glb --obstacle house.obj               around a house
  burgeon grow alder -o young.glb --age 12
  burgeon grow beech -o autumn.glb --season 0.5                  in the colours of autumn; -0.5: spring
  burgeon grow oak -o oak.glb --leaf-template leaf.csv           with a leaf of your own (burgeon leaf --help)
  burgeon grow oak -o oak.mtg --qsm oak.csv --report oak.json    structure and measures for programs of the field
  burgeon grow oak --drawing oak.svg                             trunk, bare limbs and the outline of the crown
  burgeon grow --attractors scan.xyz --root 0,0,0 --influence 1 --kill 0.4 -o tree.glb
  burgeon presets --show oak > mine.toml; burgeon grow mine.toml -o mine.glb";

/// Settings of growth and its duration.
#[derive(Args, Debug)]
#[command(next_help_heading = "Growth")]
pub(crate) struct GrowthArgs {
    /// Grow by this method; where PRESET or SPEC.toml uses another one, with this method's own defaults in the same
    /// envelope [default: the preset's].
    #[arg(long, value_enum)]
    pub(crate) method: Option<MethodWord>,
    #[arg(long, value_name = "MESH", help = lists::obstacle())]
    pub(crate) obstacle: Vec<PathBuf>,
    #[arg(long, value_name = "FILE", help = lists::leaf_template("the tree bears instead of its own"))]
    pub(crate) leaf_template: Option<PathBuf>,
    /// Share of the leaves kept, the best lit ones, 0 to 1 [default: the preset's, mostly 1].
    #[arg(long, value_name = "F", allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<FoliageSpec>(s, "leaf_keep"))]
    pub(crate) leaf_keep: Option<f64>,
    /// The tree as it was after N rounds, years (self-organizing) or rewriting steps (lsystem) [default: full-grown].
    #[arg(long, value_name = "N")]
    pub(crate) age: Option<u32>,
    /// Grow the tree until it has this height, in metres, within what its species reaches: at the age that comes
    /// nearest, and scaled by the rest.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, conflicts_with = "age",
        value_parser = |s: &str| ranged(s, TreeGoal::HEIGHTS_M.0, TreeGoal::HEIGHTS_M.1))]
    pub(crate) height: Option<f64>,
    /// Grow the tree until its stem has this diameter at breast height (1.3 m), in metres, within what its species reaches:
    /// at the age that comes nearest, and scaled by the rest.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, conflicts_with_all = ["age", "height"],
        value_parser = |s: &str| ranged(s, TreeGoal::DIAMETERS_M.0, TreeGoal::DIAMETERS_M.1))]
    pub(crate) dbh: Option<f64>,
    /// The season of its leaves, -1 to 1: -1 bare, leaves unfold until 0, summer; 0.5 all in the colours of autumn, 1
    /// bare; not for evergreens [default: the preset's, mostly 0].
    #[arg(long, value_name = "F", allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<TreeSpec>(s, "look.season"))]
    pub(crate) season: Option<f64>,
}

/// Growth on given points.
#[derive(Args, Debug)]
#[command(next_help_heading = "Given points")]
pub(crate) struct PointsArgs {
    /// Attraction points (.xyz, .txt, .ply, .pcd, .las, .obj) instead of an envelope: space colonization of just these.
    #[arg(long, value_name = "FILE", conflicts_with = "method")]
    pub(crate) attractors: Option<PathBuf>,
    /// Position of the tree, in the axes of --up and the --unit, in the coordinates of the points even where these lie
    /// far from the origin (UTM); may be given several times [default: the preset's, mostly 0,0,0].
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point)]
    pub(crate) root: Vec<DVec3>,
    /// Length D of a step, in --unit, above 0 [default: half of --kill].
    #[arg(long, value_name = "D", allow_hyphen_values = true, value_parser = length)]
    pub(crate) step: Option<f64>,
    /// Distance within which a point attracts, in --unit, above 0 [default: 1 m].
    #[arg(long, value_name = "D", allow_hyphen_values = true, value_parser = length)]
    pub(crate) influence: Option<f64>,
    /// Distance within which a point is consumed, in --unit, above 0 and at most --influence [default: 0.4 m].
    #[arg(long, value_name = "D", allow_hyphen_values = true, value_parser = length)]
    pub(crate) kill: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodWord {
    /// Life cycles of attraction points (the paper)
    Competition,
    /// Space colonization (Runions 2007)
    Colonization,
    /// Buds with markers of their own that keep away from one another
    Guided,
    /// Buds that compete for light (Palubicki 2009)
    SelfOrganizing,
    /// Rewriting rules: an oak, unless the spec has its own
    Lsystem,
}

impl MethodWord {
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Competition => "competition",
            Self::Colonization => "colonization",
            Self::Guided => "guided",
            Self::SelfOrganizing => "self-organizing",
            Self::Lsystem => "lsystem",
        }
    }
}

fn point(text: &str) -> Result<DVec3, String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|w| w.trim().parse().ok()).collect();
    match numbers.as_slice() {
        &[x, y, z] if text.split(',').count() == 3 && [x, y, z].iter().all(|c| c.abs() <= 1e8) => {
            Ok(DVec3::new(x, y, z))
        }
        _ => Err("give three numbers within 1e8 such as 0,0,1.5".into()),
    }
}

fn length(text: &str) -> Result<f64, String> {
    ranged(text, 1e-6, 1e6)
}

impl GrowArgs {
    /// Sets the options that the engine of `--for` requires.
    pub(crate) fn settle(&mut self) -> Outcome {
        let surface = &mut self.surface;
        let set = (&mut surface.export, &mut surface.skin, &mut self.axes);
        settings::settle(&self.given, set, self.output.as_deref())
    }
}
