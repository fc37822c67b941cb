//! `burgeon sketch`.

use std::path::PathBuf;

use burgeon::reading::Kind;
use burgeon::sketch::{BranchDepth, LeafDepth, SketchSpec};
use burgeon::skin::{PetalColor, SkinSpec};
use clap::{Args, ValueEnum};

use super::export::ExportArgs;
use super::given::Given;
use super::lists;
use super::plant_format::PlantFormatWord;
use super::settings;
use super::shared::{AxesArgs, CheckArgs, CommonArgs, PictureArgs, SkinArgs, parse_field, seed};
use crate::failure::Outcome;

#[derive(Args, Debug)]
#[command(after_long_help = SKETCH_EXAMPLES)]
pub(crate) struct SketchArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// Drawings: .svg, .inkml, .ndjson (one drawing a line) or .json; projects: .burgeon, with their settings;
    /// - for standard input.
    #[arg(value_name = "IN", required = true)]
    pub(crate) inputs: Vec<PathBuf>,
    #[arg(long, short, value_name = "OUT", help = lists::sketch_output(), required_unless_present_any = ["png", "qsm", "split", "report", "json"])]
    pub(crate) output: Option<PathBuf>,
    /// Format of the files in a folder.
    #[arg(long, value_enum, default_value_t = PlantFormatWord::GLB)]
    pub(crate) format: PlantFormatWord,
    /// Also write the branches as cylinders, one in each row, in the form of `TreeQSM`. For several drawings a folder.
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) qsm: Option<PathBuf>,
    /// Also write a project in which every plant of the drawing is a plant of its own, where it was drawn.
    #[arg(long, value_name = "FILE.burgeon")]
    pub(crate) split: Option<PathBuf>,
    /// Also make a picture. For several drawings a folder, which is created and gets one picture each.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Seed of all random choices; another seed gives another plant of the same drawing
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
    pub(crate) checks: CheckArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

const SKETCH_EXAMPLES: &str = "Examples:
  burgeon sketch daisy.svg -o daisy.glb --png daisy.png
  burgeon sketch trees.ndjson -o trees/ --format obj --png trees/
  burgeon sketch oak.svg -o oak.mtg --qsm oak.csv               structure for programs of the field
  burgeon sketch bed.svg --split bed.burgeon                    a row of flowers: each a plant of its own
  burgeon sketch daisy.svg --report daisy.json                  what was each stroke taken for?
  burgeon sketch daisy.svg -o daisy.glb --classes daisy.json    ... corrected in that file

Class files (--classes) set strokes by their index from 0:
  CSV    lines of  stroke,class  or  drawing,stroke,class
  JSON   {\"3\": \"axis\"}  or  {\"drawing name\": {\"3\": \"axis\"}}
  JSON   a report of this command (--report) in which classes were corrected
Classes: blade, corolla, axis, trunk_outline, crown, vein, disc, pot, ground, fruit, scribble, other";

/// Settings for reading the drawing and giving it depth.
#[derive(Args, Debug)]
#[command(next_help_heading = "Plant")]
pub(crate) struct ReadingArgs {
    /// Height of the plant in metres, 0.001 to 1000 [default: 8 for a tree, 0.5 for a herb].
    #[arg(long, value_name = "METRES", allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<SketchSpec>(s, "height_m"))]
    pub(crate) height: Option<f64>,
    /// Departure of branches from the drawing's plane: riesz spreads siblings evenly, paper is the published entropy
    /// [default: riesz].
    #[arg(long, value_enum, value_name = "MODE", hide_default_value = true)]
    pub(crate) branch_depth: Option<BranchDepthWord>,
    /// Departure of leaves from the drawing's plane: drawn keeps the front view, paper turns all leaves to one side as
    /// published, signed keeps left and right [default: drawn].
    #[arg(long, value_enum, value_name = "MODE")]
    pub(crate) leaf_depth: Option<LeafDepthWord>,
    /// Read every plant of the drawing as one kind: flower, flowers, stem, tree, conifer, palm, bush, cactus, grass,
    /// leaf, fruit, `house_plant` or vegetable [default: the best explanation; the report lists up to three].
    #[arg(long = "as", value_name = "KIND", value_parser = kind)]
    pub(crate) read_as: Option<Kind>,
    /// Set the classes of strokes: a CSV or JSON file, see the end of this help.
    #[arg(long, value_name = "FILE")]
    pub(crate) classes: Option<PathBuf>,
    /// Flowers that face away from the viewer, by number from 0, separated by commas [default: none].
    #[arg(long, value_name = "N,N", value_delimiter = ',')]
    pub(crate) flip_flowers: Vec<u32>,
    /// Number of twigs and leaves that fill contours and crowns, relative to the usual, 0.1 to 10 [default: 1].
    #[arg(long, value_name = "X", allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<SketchSpec>(s, "fill.density"))]
    pub(crate) density: Option<f64>,
    /// Direction of grown twigs, -1 (weeping) to 1 (upright) [default: 0.1].
    #[arg(long, value_name = "X", allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<SketchSpec>(s, "fill.tropism"))]
    pub(crate) tropism: Option<f64>,
    /// Exponent of the pipe model, 1.8 to 3: a higher exponent makes branches below forks thinner
    /// [default: 2 for a tree, 2.5 for a herb].
    #[arg(long, value_name = "X", allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<SketchSpec>(s, "pipe_exponent"))]
    pub(crate) pipe_exponent: Option<f64>,
    /// Pull of light on drawn branches, -1 to 1, upwards [default: 0].
    #[arg(long, value_name = "X", allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<SketchSpec>(s, "phototropism"))]
    pub(crate) phototropism: Option<f64>,
    /// Sag of drawn branches, 0 to 1 [default: 0].
    #[arg(long, value_name = "X", allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<SketchSpec>(s, "gravity"))]
    pub(crate) gravity: Option<f64>,
    #[arg(long, value_name = "FILE",
          help = lists::leaf_template("the plant bears instead of the drawn or built-in ones"))]
    pub(crate) leaf_template: Option<PathBuf>,
    /// All settings of the sketch maker as TOML or JSON (missing ones keep their defaults); options above override it.
    #[arg(long, value_name = "FILE")]
    pub(crate) spec: Option<PathBuf>,
}

/// Parses a kind of plant by its word.
fn kind(word: &str) -> Result<Kind, String> {
    let known = || Kind::ALL.into_iter().filter(|k| *k != Kind::None);
    known().find(|k| k.word() == word).ok_or_else(|| {
        let words: Vec<&str> = known().map(Kind::word).collect();
        format!("must be one of {}", words.join(", "))
    })
}

/// Options for meshing and colouring the plant.
#[derive(Args, Debug)]
#[command(next_help_heading = "Surface")]
pub(crate) struct SurfaceArgs {
    #[command(flatten)]
    pub(crate) skin: SkinArgs,
    #[command(flatten)]
    pub(crate) export: ExportArgs,
    /// Colour of petals that were drawn without one [default: by seed and name].
    #[arg(long, value_enum, value_name = "COLOUR")]
    pub(crate) petals: Option<PetalWord>,
    /// Variation of colour from organ to organ, 0 (none) to 1 [default: 1].
    #[arg(long, value_name = "X", allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<SkinSpec>(s, "variation"))]
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

impl SketchArgs {
    /// Sets the options that the engine of `--for` requires.
    pub(crate) fn settle(&mut self) -> Outcome {
        let surface = &mut self.surface;
        let set = (&mut surface.export, &mut surface.skin, &mut self.axes);
        settings::settle(&self.given, set, self.output.as_deref())
    }
}
