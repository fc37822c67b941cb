//! `burgeon grow`.

use std::path::PathBuf;

use burgeon::TreeSpec;
use burgeon::formats::Packing;
use burgeon::formats::Room;
use burgeon::glam::DVec3;
use burgeon::growth::FoliageSpec;
use burgeon::skin::{FoliageStyle, SkinSpec};
use clap::{Args, ValueEnum};

use super::given::Given;
use super::lists;
use super::plant_format::PlantFormat;
use super::shared::{AxesArgs, CheckArgs, CommonArgs, PackWord, PictureArgs, SkinArgs, of, ranged, seed};
use crate::failure::Outcome;

#[derive(Args, Debug)]
#[command(after_long_help = GROW_EXAMPLES)]
pub(crate) struct GrowArgs {
    /// First: clap takes the values of the others away as it reads them.
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
    /// Write each leaf shape once, and where its copies stand (`EXT_mesh_gpu_instancing`): a smaller .glb that is drawn
    /// faster, for programs that know it.
    #[arg(long, help_heading = "Surface", conflicts_with_all = ["wind", "sway"])]
    pub(crate) instances: bool,
    /// How leaves are drawn: by their outlines, as cards of which the leaf is cut out, or by their level of detail: outlines,
    /// then cards, then cards of whole shoots [default: outlines].
    #[arg(long, help_heading = "Surface", value_enum, value_name = "HOW")]
    pub(crate) foliage: Option<FoliageWord>,
    /// One more coarser copy, the last: views from all sides in an atlas of SIZE pixels a side, 128 to 4096
    /// (docs/exports.md).
    #[arg(long, help_heading = "Surface", value_name = "SIZE", conflicts_with_all = ["wind", "sway"],
        value_parser = clap::value_parser!(u32).range(128..=4096))]
    pub(crate) impostor: Option<u32>,
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

/// What grows, and for how long.
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
    #[arg(long, value_name = "F", allow_hyphen_values = true, value_parser = |s: &str| of::<FoliageSpec>(s, "leaf_keep"))]
    pub(crate) leaf_keep: Option<f64>,
    /// The tree as it was after N rounds, years (self-organizing) or rewriting steps (lsystem) [default: full-grown].
    #[arg(long, value_name = "N")]
    pub(crate) age: Option<u32>,
    /// The season of its leaves, -1 to 1: -1 bare, leaves unfold to 0, summer; 0.5 all in the colours of autumn, 1 bare; not
    /// for evergreens [default: the preset's, mostly 0].
    #[arg(long, value_name = "F", allow_hyphen_values = true, value_parser = |s: &str| of::<TreeSpec>(s, "look.season"))]
    pub(crate) season: Option<f64>,
}

/// Growth on given points.
#[derive(Args, Debug)]
#[command(next_help_heading = "Given points")]
pub(crate) struct PointsArgs {
    /// Attraction points (.xyz, .txt, .ply, .pcd, .las, .obj) instead of an envelope: space colonization of just these.
    #[arg(long, value_name = "FILE", conflicts_with = "method")]
    pub(crate) attractors: Option<PathBuf>,
    /// Where the tree stands, in the axes of --up and the --unit, as the points have it, also where these lie far from
    /// the origin (UTM); may be given several times [default: the preset's, mostly 0,0,0].
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

/// How the tree is meshed.
#[derive(Args, Debug)]
#[command(next_help_heading = "Surface")]
pub(crate) struct TreeSurfaceArgs {
    #[command(flatten)]
    pub(crate) skin: SkinArgs,
    /// Coarser copies to write beside the model (OUT-lod1, OUT-lod2, ...), 0 to 6.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=6))]
    pub(crate) lods: u32,
    /// Make the .glb light: numbers in few bits and textures as JPEG, and with meshopt also compressed
    /// (docs/exports.md).
    #[arg(long, value_enum, value_name = "HOW")]
    pub(crate) pack: Option<PackWord>,
    /// Where the coarser copies go: each into a file of its own, or all into the .glb (`MSFT_lod`) [default: each].
    #[arg(long, value_enum, value_name = "WHERE")]
    pub(crate) lod_file: Option<LodFileWord>,
    /// Let the .glb sway: an animation in a loop, with a joint for each limb (docs/exports.md).
    #[arg(long, conflicts_with_all = ["wind", "pack"])]
    pub(crate) sway: bool,
}

impl TreeSurfaceArgs {
    pub(crate) fn packing(&self) -> Option<Packing> {
        self.pack.map(PackWord::packing)
    }

    /// The coarser copies go into the model's own file.
    pub(crate) fn in_one_file(&self) -> bool {
        self.lod_file == Some(LodFileWord::One)
    }

    /// Coarser copies with files of their own.
    pub(crate) fn lod_files(&self) -> u32 {
        if self.in_one_file() { 0 } else { self.lods }
    }

    /// How the meshes are made; what sways needs the columns of the wind.
    pub(crate) fn spec(&self) -> SkinSpec {
        let skin = self.skin.spec();
        SkinSpec { wind: skin.wind || self.sway, ..skin }
    }

    /// Fails on options that nothing uses. `format`: of the plant that is written.
    pub(crate) fn check_used(&self, given: &Given, format: Option<PlantFormat>) -> Outcome {
        for (option, room) in [("pack", Room::Packing), ("lod_file", Room::Levels), ("sway", Room::Joints)] {
            given.only_if_holds(format.is_some_and(|f| f.holds(room)), &[option], room)?;
        }
        given.only_if(self.lods > 0, &["lod_file"], "coarser copies (--lods)", "none is made")?;
        let apart = !(self.in_one_file() && self.sway);
        given.only_if(apart, &["sway"], "levels in files of their own", "--lod-file one puts them into one")
    }
}

/// How leaves are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FoliageWord {
    /// By their outlines
    Outlines,
    /// As cards with holes
    Cards,
    /// Outlines in the model, cards in OUT-lod1, cards of shoots in OUT-lod2 and those after it
    ByLevel,
}

impl FoliageWord {
    pub(crate) const fn foliage(self) -> FoliageStyle {
        match self {
            Self::Outlines => FoliageStyle::Outlines,
            Self::Cards => FoliageStyle::Cards,
            Self::ByLevel => FoliageStyle::ByLevel,
        }
    }
}

/// Where coarser copies go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LodFileWord {
    /// Beside the model: OUT-lod1, OUT-lod2, ...
    Each,
    /// Into the model's own file, as levels of its node
    One,
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
