//! `burgeon bloom`.

use burgeon::formats::{DateOrder, ModelFormat, Room};
use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use super::export::ExportArgs;
use super::given::Given;
use super::lists;
use super::settings::Settings;
use super::shared::{AxesArgs, CheckArgs, CommonArgs, ViewWord, ranged, size};
use crate::failure::Outcome;

/// The two commands.
#[derive(Debug, Subcommand)]
pub(crate) enum BloomCommand {
    /// Fit growth laws to scans of several days, or to a growth table
    ///
    /// Reads the scans that a stages file names, cleans them, splits them into organs and regions, removes the motion
    /// of the plant between scans, and fits logistic, Gompertz and monomolecular laws to the means of x, y and z of
    /// each region. Organs of one kind share rate and time. A law that predicts left-out values no better than straight
    /// lines is reported as not determined.
    Fit(Box<FitArgs>),
    /// Make a plant's shape at any day, or the animation of all days
    ///
    /// Control points around each organ of the first shape move along the law to the last shape. START is a scan, a
    /// model, a stages file (all its stages are met), a whole flower (`burgeon presets` lists them), or a drawing of
    /// flowers (.svg, .inkml, .json, .burgeon), which then open.
    Run(Box<BloomRunArgs>),
    /// Evaluate a law on any day
    ///
    /// Prints for each law its value, and the interval in which 9 of 10 new measurements lie on that day.
    At(Box<BloomAtArgs>),
}

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon bloom at leaves.law.json --day 12
  burgeon bloom at leaves.law.json --day 12 --day 20 --json")]
pub(crate) struct BloomAtArgs {
    /// The law, of `burgeon bloom fit`.
    #[arg(value_name = "LAW.json")]
    pub(crate) input: PathBuf,
    /// The day, in the count of the stages or of the table; repeat the option for several days.
    #[arg(long, value_name = "D", required = true, allow_hyphen_values = true, value_parser = |s: &str| ranged(s, -1e6, 1e6))]
    pub(crate) day: Vec<f64>,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Settings for reading a growth table.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "Growth table")]
pub(crate) struct TableArgs {
    /// The heading of the column that identifies plants [default: plant, tree, id or subject].
    #[arg(long, value_name = "COLUMN")]
    pub(crate) plant: Option<String>,
    /// The heading of the column of sizes, for a table with several [default: size, length, height and the like].
    #[arg(long, value_name = "COLUMN")]
    pub(crate) size: Option<String>,
    /// Fit one curve to each group of plants, given by this column, and test whether one would do for all
    /// (docs/bloom.md).
    #[arg(long, value_name = "COLUMN")]
    pub(crate) by: Option<String>,
    /// The order of dates such as 3/4/2024 [default: found from a date after the twelfth].
    #[arg(long, value_name = "dmy|mdy", value_parser = dates)]
    pub(crate) dates: Option<DateOrder>,
    /// The sheet of a workbook [default: the first].
    #[arg(long, value_name = "NAME")]
    pub(crate) sheet: Option<String>,
}

fn dates(word: &str) -> Result<DateOrder, String> {
    DateOrder::from_word(word).ok_or_else(|| "give dmy or mdy".to_owned())
}

#[derive(Args, Debug)]
#[command(after_long_help = "Stages file (TOML):
  name = \"tomato\"
  unit = \"mm\"            # m, cm or mm [default: --unit]
  up = \"z\"               # y or z [default: --up]
  split = \"auto\"         # auto: stem and leaves are found; none: each file is one organ
  clean = true           # take stray points and the ground out
  [[stage]]
  file = \"march-05.xyz\"  # .ply .xyz .txt .pcd .las .obj, beside the stages file
  day = 5
  # unit, up             # of this file, if it has others
  # mirror = true        # the file is a mirror image
  # organ = \"petal-1\"    # the file is this organ; several files a day give several organs
  # region = 1           # ... or only this region of it, from 1 at the base
  # seed = [x, y, z]     # the organ at this place is cut out, in the file's unit
  # base = [x, y, z]     # where the organ is attached
  # crop = [[x, y, z], [x, y, z]]

Growth table (CSV, TSV or a workbook, .xlsx): day,size[,organ][,plant], one line a measurement; or a column for each organ or
plant, or for each day. Days are numbers, with the unit of a heading (age_years), or dates. Sizes are in --unit, in that of a line
`# unit: mm`, or in that of a heading (height_cm).

Examples:
  burgeon bloom fit stages.toml -o tomato.law.json --plot tomato.svg
  burgeon bloom fit stages.toml -o tomato.law.json --leave-one-out     how far the model is from each day left out
  burgeon bloom fit lengths.csv -o leaves.law.json --unit mm
  burgeon bloom fit trial.xlsx -o trial.law.json --plant Seed --by treatment --plot trial.svg")]
pub(crate) struct FitArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// The stages file, or a growth table (.csv, .tsv, .xlsx).
    #[arg(value_name = "STAGES.toml|TABLE.csv")]
    pub(crate) input: PathBuf,
    /// The law: .json.
    #[arg(long, short, value_name = "LAW.json")]
    pub(crate) output: PathBuf,
    /// Plot of the fits with their points: .svg.
    #[arg(long, value_name = "FIT.svg")]
    pub(crate) plot: Option<PathBuf>,
    /// Parts of each organ from base to tip, 1 to 20.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=20))]
    pub(crate) regions: u32,
    /// Leave each stage out in turn, and print the errors of the model, no law, the nearest day and straight lines.
    #[arg(long)]
    pub(crate) leave_one_out: bool,
    /// Seed of the search for the ground, and of plants that change their groups.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) table: TableArgs,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    #[command(flatten)]
    pub(crate) checks: CheckArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

#[derive(Args, Debug)]
#[command(after_long_help = "Examples:
  burgeon bloom run stages.toml --law tomato.law.json --day 8 -o day8.ply
  burgeon bloom run stages.toml --plant --day 8 -o day8.glb      a plant on a day between the scans
  burgeon bloom run seedling.ply --plant --unit mm --up z -o seedling.glb
  burgeon bloom run first.ply --end last.ply --law lily.law.json --day 3 -o day3.ply --compare scan3.ply --unit mm
  burgeon bloom run first.glb --end last.glb --law lily.law.json --frames 20 -o opening.glb
  burgeon bloom run rose -o rose.glb --frames 16 --png rose.png
  burgeon bloom run rose --petal petal.csv -o own-rose.glb       petals from marks, a model or a drawing
  burgeon bloom run flower.svg -o flower.glb                     a drawn flower opens and wilts
  burgeon bloom run my-flower.toml -o flower.glb                 a flower of your own (docs/bloom.md)
  burgeon bloom run rose --law lily.law.json -o rose-as-lily/ --frames 16 --format obj")]
pub(crate) struct BloomRunArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// First shape: a scan or a model; or a stages file (.toml); or a flower of `burgeon presets` such as rose, or one
    /// of your own (.toml); or a drawing.
    #[arg(value_name = "START")]
    pub(crate) start: String,
    #[arg(long, short, value_name = "OUT", help = lists::bloom_output())]
    pub(crate) output: PathBuf,
    /// Last shape: a scan or a model.
    #[arg(long, value_name = "END")]
    pub(crate) end: Option<PathBuf>,
    /// Shape of the petals of a whole flower: marks of a petal (.csv), a model of one, or a drawing whose first petal
    /// or leaf is used.
    #[arg(long, value_name = "FILE")]
    pub(crate) petal: Option<PathBuf>,
    /// Hand edits on a whole flower or a drawing, a JSON file; `burgeon shape --template` prints one.
    #[arg(long, value_name = "EDITS.json")]
    pub(crate) edits: Option<PathBuf>,
    /// The law that sets the pace [default: a straight line; for a flower its own].
    #[arg(long, value_name = "LAW.json")]
    pub(crate) law: Option<PathBuf>,
    /// Control points along the three axes of each organ, each 2 to 16.
    #[arg(long, value_name = "LxMxN", default_value = "4x4x4", value_parser = lattice)]
    pub(crate) lattice: [usize; 3],
    /// Shapes of an animation or of a folder, 2 to 1000.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(2..=1000))]
    pub(crate) frames: u32,
    /// One shape, at this day in the count of the stages (0 is the start where there are none).
    #[arg(long, value_name = "D", allow_hyphen_values = true)]
    pub(crate) day: Option<f64>,
    /// Day of START [default: the first of the law].
    #[arg(long, value_name = "D", allow_hyphen_values = true)]
    pub(crate) start_day: Option<f64>,
    /// Day of END [default: the last of the law].
    #[arg(long, value_name = "D", allow_hyphen_values = true)]
    pub(crate) end_day: Option<f64>,
    /// Measure the shape of --day against a scan of that day, in the unit and with the up axis of the stages: mean over
    /// x, y and z (the error of Huai, Yang and Cai 2019) and Euclidean distances both ways, in millimetres.
    #[arg(long, value_name = "SCAN", requires = "day")]
    pub(crate) compare: Option<PathBuf>,
    /// Coordinates of the result: of the scanner, in which the plant is moved and turned as it was between scans, or of
    /// the plant, as it stood in the first scan.
    #[arg(long, value_enum, default_value_t = FrameWord::Scanner)]
    pub(crate) frame: FrameWord,
    /// Make a plant of the scans instead of points: stem and stalks are axes with radii, leaves are blades. With --day,
    /// into a folder, or of one scan alone (without --end).
    #[arg(long, conflicts_with = "whole")]
    pub(crate) plant: bool,
    /// Colour of results made of scans: that of their points, where they have any, or plain.
    #[arg(long, value_enum, default_value_t = ScanTextureWord::Scan)]
    pub(crate) texture: ScanTextureWord,
    /// Do not split scans into organs: each is one organ. Models with faces are never split.
    #[arg(long)]
    pub(crate) whole: bool,
    /// Leave stray points and the ground in scans.
    #[arg(long)]
    pub(crate) no_clean: bool,
    /// Control points move on straight lines, as published, instead of turning with their organ.
    #[arg(long)]
    pub(crate) straight: bool,
    /// Seconds of an animation, above 0 to 600.
    #[arg(long, value_name = "S", default_value_t = 6.0, value_parser = |s: &str| ranged(s, 0.01, 600.0))]
    pub(crate) seconds: f64,
    /// Materials of leaves, petals, sepals and single strokes, a TOML or JSON file (docs/materials.md): colours,
    /// patterns, pictures.
    #[arg(long, value_name = "FILE")]
    pub(crate) materials: Option<PathBuf>,
    #[arg(long, help = lists::wind(" of a whole flower or a drawing"))]
    pub(crate) wind: bool,
    #[command(flatten)]
    pub(crate) export: ExportArgs,
    /// Format of the files in a folder.
    #[arg(long, value_enum, default_value_t = crate::args::FormatWord::GLB)]
    pub(crate) format: crate::args::FormatWord,
    /// Also make a picture of the shape at --day; without it of the last shape (for a flower, of full bloom).
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Seed of all random choices.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Size of the picture in pixels, each 1 to 8192.
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size)]
    pub(crate) size: (u32, u32),
    /// Viewpoint of the picture.
    #[arg(long, value_enum, default_value_t = ViewWord::ThreeQuarter)]
    pub(crate) view: ViewWord,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    #[command(flatten)]
    pub(crate) checks: CheckArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Colour of results made of scans.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ScanTextureWord {
    /// Colour of the points, where they have colours
    Scan,
    /// Green
    Plain,
}

/// Coordinates of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FrameWord {
    /// Coordinates of the scanner
    Scanner,
    /// Coordinates of the plant
    Plant,
}

impl BloomRunArgs {
    /// Whether an animation is written.
    pub(crate) fn is_film(&self) -> bool {
        self.film().is_some()
    }

    /// Returns the format of the animation that is written, if there is one.
    pub(crate) fn film(&self) -> Option<ModelFormat> {
        let format = self.output.extension().and_then(|e| ModelFormat::from_extension(e.to_str()?));
        format.filter(|f| f.row().is_written() && f.holds(Room::Morphs) && self.one_day().is_none())
    }

    /// Returns the only day that is made: that of `--day`, or of the only scan, if a plant is made of one.
    pub(crate) fn one_day(&self) -> Option<f64> {
        let extension = std::path::Path::new(&self.start).extension();
        let alone = self.end.is_none() && extension.is_some_and(|e| !e.eq_ignore_ascii_case("toml"));
        self.day.or_else(|| (self.plant && alone).then(|| self.start_day.unwrap_or(0.0)))
    }
}

fn lattice(text: &str) -> Result<[usize; 3], String> {
    let parts: Option<Vec<usize>> = text.split(['x', 'X']).map(|w| w.parse().ok()).collect();
    match parts.as_deref() {
        Some(&[a, b, c]) if [a, b, c].iter().all(|n| (2..=16).contains(n)) => Ok([a, b, c]),
        _ => Err("give the control points along three axes, each 2 to 16, such as 4x4x4".into()),
    }
}

impl BloomRunArgs {
    /// Sets the options that the engine of `--for` requires.
    pub(crate) fn settle(&mut self) -> Outcome {
        let Self { export, axes, wind, output, .. } = self;
        Settings { export, axes, wind, output: Some(output) }.settle(&self.given)
    }
}

impl BloomCommand {
    /// Sets the options that the engine of `--for` requires.
    pub(crate) fn settle(&mut self) -> Outcome {
        match self {
            Self::Fit(_) | Self::At(_) => Ok(()),
            Self::Run(args) => args.settle(),
        }
    }
}
