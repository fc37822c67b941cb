//! Names, options and help of every command: a contract with other programs.

use std::path::PathBuf;

use burgeon::formats::ModelFormat;
use burgeon::render::{Background, PictureSpec, View};
use burgeon::sketch::{BranchDepth, LeafDepth};
use burgeon::skin::PetalColor;
use burgeon::{Seed, Unit, UpAxis};
use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::files::PlantFormat;
use crate::given::Given;

/// Three-dimensional plants out of what people can draw.
///
/// Exit status: 0 on success, 2 for bad usage or bad input (one line on stderr says what, where and what to do),
/// 1 for a bug of burgeon, 130 after Ctrl-C or another request to end (drawings of a batch that were finished by then
/// stay). The files of a command are written all or none, and never over a file that it reads; other files of
/// the same name are replaced, links are followed (docs/exports.md). An input named - is standard input.
#[derive(Debug, Parser)]
#[command(
    name = "burgeon",
    version,
    max_term_width = 100,
    subcommand_required = true,
    arg_required_else_help = true
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Turn drawn strokes into a plant
    ///
    /// Lines become stems and branches, closed outlines petals and leaves; a trunk and a crown become a tree.
    /// Seen from the front the plant is the drawing. Strokes on a layer, or with an id, named branch-contour or
    /// leaf-contour are filled with twigs or leaves.
    Sketch(Box<SketchArgs>),
    /// Turn marks measured on a leaf into a leaf or a whole plant
    ///
    /// Veins become solid balls along a spline, the blade a surface through the same points. Works from a CSV file
    /// of 7 marks along each pair of side veins.
    Leaf(Box<crate::leaf::LeafArgs>),
    /// Grow a tree: a species that comes with the program, or a spec of your own
    ///
    /// Branches compete for space and light, around obstacles; leaves stay where light reaches. `burgeon presets`
    /// lists the species.
    Grow(Box<crate::grow::GrowArgs>),
    /// Edit a plant by hand: prune, turn, move, regrow, sketch or brush branches, fill a silhouette, thin leaves
    ///
    /// Works on a species, a spec, a drawing or a project. The edits stand in a JSON file; the rest of the plant stays
    /// as it is.
    Shape(Box<crate::shape::ShapeArgs>),
    /// List the species that `burgeon grow` knows; show one as TOML; write the JSON Schema of specs
    Presets(crate::presets::PresetsArgs),
    /// Grow the same oak by three methods and compare them
    ///
    /// L-system, space colonization and space competition, at one height: vertices, triangles, leaves, seconds,
    /// bytes, and what the paper printed.
    Compare(Box<crate::compare::CompareArgs>),
    /// Make a picture of a model
    ///
    /// The model fills the picture but for a margin and stands on the ground in the light of a soft sun.
    Render(RenderArgs),
    /// Convert a model or a drawing to another format
    ///
    /// Models: .glb, .gltf, .obj, .ply and .stl to .glb, .obj, .ply, .stl or .usda. Drawings: .svg, .inkml,
    /// .ndjson and .json to .json. A drawing becomes a model with `burgeon sketch`.
    Convert(ConvertArgs),
    /// Say what is in a model or a drawing
    ///
    /// Counts, bounds, units, parts and materials, and what is wrong with it.
    Info(InfoArgs),
    /// Grow organs through scans of several days; flowers that open
    #[command(subcommand)]
    Bloom(crate::bloom::BloomCommand),
    /// Open the Studio: draw on the left, see the plant grow on the right
    ///
    /// Serves the built Studio on 127.0.0.1, to this machine's own browser only, and opens it. Nothing is sent
    /// anywhere: plants are made in the browser.
    Studio(StudioArgs),
}

/// Options of every command.
#[derive(Args, Debug)]
#[command(next_help_heading = "Running")]
pub(crate) struct CommonArgs {
    /// Number of threads, 1 to 256 [default: all of the machine]. The result does not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub(crate) threads: Option<u16>,
    /// How many times the usual limits of docs/limits.md may be exceeded, 1 to 1000: memory, points, joints, leaves,
    /// triangles and the like. What is more is refused.
    #[arg(long, value_name = "X", default_value_t = 1.0, allow_hyphen_values = true,
          value_parser = |s: &str| ranged(s, 1.0, 1000.0))]
    pub(crate) budget: f64,
    /// Print nothing but errors; show no progress.
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// Write the report to a JSON file: what was read, understood, counted and timed.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
    /// Print the report as JSON on stdout instead of the summary.
    #[arg(long)]
    pub(crate) json: bool,
}

impl CommonArgs {
    /// Somebody reads the report.
    pub(crate) fn reports(&self) -> bool {
        self.report.is_some() || self.json
    }
}

/// How pictures are taken.
#[derive(Args, Debug)]
#[command(next_help_heading = "Picture")]
pub(crate) struct PictureArgs {
    /// Size of the picture in pixels, each 1 to 8192.
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size)]
    pub(crate) size: (u32, u32),
    /// From where: front is orthographic and shows what was drawn; turntable is a sheet of views all around.
    #[arg(long, value_enum, default_value_t = ViewWord::ThreeQuarter)]
    pub(crate) view: ViewWord,
    /// Views of a turntable, 1 to 64.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) frames: u32,
    /// What is behind: sky, transparent, white or a colour as #rrggbb.
    #[arg(long, value_name = "sky|transparent|white|#rrggbb", default_value = "sky", value_parser = background)]
    pub(crate) background: Background,
    /// Leave out the shadow on the ground.
    #[arg(long)]
    pub(crate) no_shadow: bool,
    /// Samples along a pixel's edge, 1 (rough) to 6 (finest).
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=6))]
    pub(crate) supersample: u32,
}

impl PictureArgs {
    pub(crate) fn spec(&self, seed: u64) -> PictureSpec {
        PictureSpec {
            width: self.size.0,
            height: self.size.1,
            view: match self.view {
                ViewWord::Front => View::Front,
                ViewWord::ThreeQuarter => View::ThreeQuarter,
                ViewWord::Side => View::Side,
                ViewWord::Top => View::Top,
                ViewWord::Turntable => View::Turntable { frames: self.frames },
            },
            background: self.background,
            ground_shadow: !self.no_shadow,
            supersample: self.supersample,
            seed: Seed::new(seed),
            ..PictureSpec::default()
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ViewWord {
    /// Orthographic, the drawing's own view
    Front,
    /// Perspective from the front right, a little above
    ThreeQuarter,
    /// Orthographic, from the plant's right
    Side,
    /// Orthographic, from above
    Top,
    /// A sheet of perspective views all around
    Turntable,
}

/// Axes and unit of files whose format does not fix them.
#[derive(Args, Debug)]
#[command(next_help_heading = "Geometry")]
pub(crate) struct AxesArgs {
    /// Axis that points up in OBJ, PLY, STL, USD, MTG and QSM files, clouds, and coordinates given as options; glTF is
    /// always +Y [default: y; z for MTG and QSM].
    #[arg(long, value_enum)]
    pub(crate) up: Option<UpWord>,
    /// Unit of length in OBJ, PLY, STL, USD, MTG and QSM files, clouds, and lengths said to be in --unit; glTF is always
    /// in metres.
    #[arg(long, value_enum, default_value_t = UnitWord::M)]
    pub(crate) unit: UnitWord,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum UpWord {
    /// +Y
    Y,
    /// +Z
    Z,
}

impl From<UpWord> for UpAxis {
    fn from(word: UpWord) -> Self {
        match word {
            UpWord::Y => Self::Y,
            UpWord::Z => Self::Z,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum UnitWord {
    /// Metres
    M,
    /// Centimetres
    Cm,
    /// Millimetres
    Mm,
}

impl From<UnitWord> for Unit {
    fn from(word: UnitWord) -> Self {
        match word {
            UnitWord::M => Self::Metre,
            UnitWord::Cm => Self::Centimetre,
            UnitWord::Mm => Self::Millimetre,
        }
    }
}

#[derive(Args, Debug)]
#[command(after_long_help = SKETCH_EXAMPLES)]
pub(crate) struct SketchArgs {
    /// First: clap takes the values of the others away as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// Drawings: .svg, .inkml, .ndjson (one drawing a line) or .json; projects: .burgeon, with their settings;
    /// - for standard input.
    #[arg(value_name = "IN", required = true)]
    pub(crate) inputs: Vec<PathBuf>,
    /// The model: .glb, .obj, .ply, .stl or .usda; or the plant's structure: .mtg (multiscale tree graph). For
    /// several drawings a folder, which is created and gets one file each.
    #[arg(long, short, value_name = "OUT", required_unless_present_any = ["png", "qsm", "report", "json"])]
    pub(crate) output: Option<PathBuf>,
    /// Format of the files in a folder.
    #[arg(long, value_enum, default_value_t = PlantFormatWord::Glb)]
    pub(crate) format: PlantFormatWord,
    /// Also write the branches as cylinders, one a row, as `TreeQSM` has them. For several drawings a folder.
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) qsm: Option<PathBuf>,
    /// Also make a picture. For several drawings a folder, which is created and gets one picture each.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Number that all chance follows from; another number gives another plant of the same drawing
    /// [default: 1, or the project's].
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: Option<u64>,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

const SKETCH_EXAMPLES: &str = "Examples:
  burgeon sketch daisy.svg -o daisy.glb --png daisy.png
  burgeon sketch trees.ndjson -o trees/ --format obj --png trees/
  burgeon sketch oak.svg -o oak.mtg --qsm oak.csv               structure for programs of the field
  burgeon sketch daisy.svg --report daisy.json                  what was each stroke taken for?
  burgeon sketch daisy.svg -o daisy.glb --classes daisy.json    ... corrected in that file

Class files (--classes) set strokes by their index from 0:
  CSV    lines of  stroke,class  or  drawing,stroke,class
  JSON   {\"3\": \"axis\"}  or  {\"drawing name\": {\"3\": \"axis\"}}
  JSON   a report of this command (--report) in which classes were corrected
Classes: blade, corolla, axis, trunk_outline, crown, vein, disc, pot, ground, fruit, scribble, other";

/// How the drawing is understood and given depth.
#[derive(Args, Debug)]
#[command(next_help_heading = "Plant")]
pub(crate) struct ReadingArgs {
    /// Height of the plant in metres, 0.001 to 1000 [default: 8 for a tree, 0.5 for a herb].
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 0.001, 1000.0))]
    pub(crate) height: Option<f64>,
    /// How branches leave the drawing's plane: riesz spreads siblings evenly, paper is the published entropy
    /// [default: riesz].
    #[arg(long, value_enum, value_name = "MODE", hide_default_value = true)]
    pub(crate) branch_depth: Option<BranchDepthWord>,
    /// How leaves leave the drawing's plane: drawn keeps the front view, paper turns all leaves to one side as
    /// published, signed keeps left and right [default: drawn].
    #[arg(long, value_enum, value_name = "MODE")]
    pub(crate) leaf_depth: Option<LeafDepthWord>,
    /// Set what strokes are: a CSV or JSON file, see the end of this help.
    #[arg(long, value_name = "FILE")]
    pub(crate) classes: Option<PathBuf>,
    /// Flowers that face away from the viewer, by number from 0, separated by commas [default: none].
    #[arg(long, value_name = "N,N", value_delimiter = ',')]
    pub(crate) flip_flowers: Vec<u32>,
    /// How many twigs and leaves fill contours and crowns, relative to the usual, 0.1 to 10 [default: 1].
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 0.1, 10.0))]
    pub(crate) density: Option<f64>,
    /// Direction of grown twigs, -1 (weeping) to 1 (upright) [default: 0.1].
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, -1.0, 1.0))]
    pub(crate) tropism: Option<f64>,
    /// Exponent of the pipe model, 1.8 to 3: higher makes branches below forks thinner
    /// [default: 2 for a tree, 2.5 for a herb].
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 1.8, 3.0))]
    pub(crate) pipe_exponent: Option<f64>,
    /// Pull of light on drawn branches, -1 to 1, upwards [default: 0].
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, -1.0, 1.0))]
    pub(crate) phototropism: Option<f64>,
    /// Sag of drawn branches, 0 to 1 [default: 0].
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 0.0, 1.0))]
    pub(crate) gravity: Option<f64>,
    /// A leaf that the plant bears instead of the drawn or built-in ones: marks (.csv), a vein graph (.json) or a
    /// model of one leaf (.glb, .obj, .ply, .stl) with its root at the origin.
    #[arg(long, value_name = "FILE")]
    pub(crate) leaf_template: Option<PathBuf>,
    /// All settings of the sketch maker as JSON (what is missing keeps its default); options above win over it.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) spec: Option<PathBuf>,
}

/// How the plant is meshed and coloured.
#[derive(Args, Debug)]
#[command(next_help_heading = "Surface")]
pub(crate) struct SurfaceArgs {
    /// Fineness of the meshes, 0.1 to 8; triangle counts grow in proportion [default: 1].
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 0.1, 8.0))]
    pub(crate) detail: Option<f64>,
    /// Sides of an ordinary branch, 3 to 24; thick branches get more [default: 8].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(3..=24))]
    pub(crate) sides: Option<u32>,
    /// Plain colours instead of textures.
    #[arg(long)]
    pub(crate) no_textures: bool,
    /// Colour of petals that were drawn without one [default: by seed and name].
    #[arg(long, value_enum, value_name = "COLOUR")]
    pub(crate) petals: Option<PetalWord>,
    /// Also write how wind moves each vertex, for shaders: attributes _WIND and _PIVOT of .glb, primvars of .usda
    /// (docs/exports.md).
    #[arg(long)]
    pub(crate) wind: bool,
    /// Variation of colour from organ to organ, 0 (none) to 1 [default: 1].
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 0.0, 1.0))]
    pub(crate) variation: Option<f64>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum BranchDepthWord {
    /// The sum of the angles between siblings, as published
    Paper,
    /// Siblings spread evenly
    Riesz,
}

impl From<BranchDepthWord> for BranchDepth {
    fn from(word: BranchDepthWord) -> Self {
        match word {
            BranchDepthWord::Paper => Self::Paper,
            BranchDepthWord::Riesz => Self::Riesz,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum LeafDepthWord {
    /// The front view is the drawing
    Drawn,
    /// Leaves turn to the light, all to one side, as published
    Paper,
    /// Leaves turn to the light, left and right kept
    Signed,
}

impl From<LeafDepthWord> for LeafDepth {
    fn from(word: LeafDepthWord) -> Self {
        match word {
            LeafDepthWord::Drawn => Self::Drawn,
            LeafDepthWord::Paper => Self::Paper,
            LeafDepthWord::Signed => Self::Signed,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PetalWord {
    /// Rose pink with a pale base
    Pink,
    /// White with a greenish base
    White,
    /// Warm yellow
    Yellow,
    /// Violet blue with a pale base
    Violet,
    /// Poppy red with a dark base
    Red,
    /// Orange with a yellow base
    Orange,
    /// Sky blue with a white base
    Blue,
}

impl From<PetalWord> for PetalColor {
    fn from(word: PetalWord) -> Self {
        match word {
            PetalWord::Pink => Self::Pink,
            PetalWord::White => Self::White,
            PetalWord::Yellow => Self::Yellow,
            PetalWord::Violet => Self::Violet,
            PetalWord::Red => Self::Red,
            PetalWord::Orange => Self::Orange,
            PetalWord::Blue => Self::Blue,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum FormatWord {
    /// Binary glTF: one file with textures and materials
    Glb,
    /// Wavefront OBJ with its material file and textures beside it
    Obj,
    /// PLY: one mesh with colours
    Ply,
    /// Universal Scene Description as text, with textures beside it
    Usda,
}

impl FormatWord {
    pub(crate) const fn format(self) -> ModelFormat {
        match self {
            Self::Glb => ModelFormat::Glb,
            Self::Obj => ModelFormat::Obj,
            Self::Ply => ModelFormat::Ply,
            Self::Usda => ModelFormat::Usda,
        }
    }

    pub(crate) const fn extension(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Usda => "usda",
        }
    }
}

/// What a plant is written as.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PlantFormatWord {
    /// Binary glTF: one file with textures and materials
    Glb,
    /// Wavefront OBJ with its material file and textures beside it
    Obj,
    /// PLY: one mesh with colours
    Ply,
    /// Universal Scene Description as text, with textures beside it
    Usda,
    /// Multiscale tree graph: axes, nodes and organs as text
    Mtg,
}

impl PlantFormatWord {
    pub(crate) const fn format(self) -> PlantFormat {
        match self {
            Self::Glb => PlantFormat::Model(ModelFormat::Glb),
            Self::Obj => PlantFormat::Model(ModelFormat::Obj),
            Self::Ply => PlantFormat::Model(ModelFormat::Ply),
            Self::Usda => PlantFormat::Model(ModelFormat::Usda),
            Self::Mtg => PlantFormat::Mtg,
        }
    }

    pub(crate) const fn extension(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Usda => "usda",
            Self::Mtg => "mtg",
        }
    }
}

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon render daisy.glb -o daisy.png
  burgeon render tree.obj -o tree.png --view turntable --size 1600x900
  burgeon render tree.glb -o tree.png --background transparent --no-shadow")]
pub(crate) struct RenderArgs {
    /// First: clap takes the values of the others away as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// The model: .glb, .gltf, .obj, .ply or .stl.
    #[arg(value_name = "MODEL")]
    pub(crate) input: PathBuf,
    /// The picture: .png.
    #[arg(long, short, value_name = "PNG")]
    pub(crate) output: PathBuf,
    /// Number that the pattern of the lights follows from.
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon convert oak.glb -o oak.obj
  burgeon convert scan.ply -o scan.glb --up z --unit mm
  burgeon convert scan.ply -o scan.obj --in-unit mm --unit m")]
pub(crate) struct ConvertArgs {
    /// First: clap takes the values of the others away as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// The file to read.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// The file to write; its extension says the format.
    #[arg(long, short, value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    /// Axis that points up in the input, where it differs from --up.
    #[arg(long, value_enum, value_name = "UP", help_heading = "Geometry")]
    pub(crate) in_up: Option<UpWord>,
    /// Unit of length in the input, where it differs from --unit.
    #[arg(long, value_enum, value_name = "UNIT", help_heading = "Geometry")]
    pub(crate) in_unit: Option<UnitWord>,
    /// Also make a picture of a model.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Number that the pattern of the picture's lights follows from.
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

#[derive(Args, Debug)]
pub(crate) struct InfoArgs {
    /// First: clap takes the values of the others away as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// The file: a model (.glb, .gltf, .obj, .ply, .stl), a drawing (.svg, .inkml, .ndjson, .json) or a project
    /// (.burgeon).
    #[arg(value_name = "FILE")]
    pub(crate) input: PathBuf,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon studio
  burgeon studio daisy.svg
  burgeon studio --no-open --port 8080")]
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
    /// The folder of the built Studio [default: found beside the program].
    #[arg(long, value_name = "DIR")]
    pub(crate) folder: Option<PathBuf>,
}

pub(crate) fn size(text: &str) -> Result<(u32, u32), String> {
    let parts = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match parts {
        Some((w, h)) if (1..=8192).contains(&w) && (1..=8192).contains(&h) => Ok((w, h)),
        _ => Err("give width and height in pixels, each 1 to 8192, such as 1024x768".into()),
    }
}

fn background(text: &str) -> Result<Background, String> {
    let hex = || {
        let hex = text.strip_prefix('#').filter(|h| h.len() == 6 && h.is_ascii())?;
        let byte = |i: usize| u8::from_str_radix(hex.get(i..i + 2)?, 16).ok();
        Some(Background::Plain([byte(0)?, byte(2)?, byte(4)?]))
    };
    match text {
        "sky" => Ok(Background::Sky),
        "transparent" => Ok(Background::Transparent),
        "white" => Ok(Background::Plain([255; 3])),
        _ => hex().ok_or_else(|| "give sky, transparent, white or a colour such as #f0f4e8".into()),
    }
}

pub(crate) fn seed(text: &str) -> Result<u64, String> {
    text.parse().ok().ok_or_else(|| format!("give a whole number from 0 to {}", u64::MAX))
}

pub(crate) fn ranged(text: &str, low: f64, high: f64) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x| (low..=high).contains(x))
        .ok_or_else(|| format!("give a number from {low} to {high}"))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    #[test]
    fn commands_are_consistent() {
        super::Cli::command().debug_assert();
    }
}
