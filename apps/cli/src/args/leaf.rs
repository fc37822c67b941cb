//! `burgeon leaf`.

use std::path::PathBuf;

use burgeon::leaf::{BallMove, LeafSpec, SurfaceKind};
use clap::{Args, ValueEnum};

use super::export::ExportArgs;
use super::given::Given;
use super::lists;
use super::settings::Settings;
use super::shared::{AxesArgs, CheckArgs, CommonArgs, PictureArgs, parse_field, ranged, whole};
use crate::failure::Outcome;

#[derive(Args, Debug)]
#[command(after_long_help = LEAF_EXAMPLES)]
pub(crate) struct LeafArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// Marks or chief veins of a leaf (.csv), its vein graph or its profile (.json), or the numbers of a leaf that was
    /// not measured (.toml); several for --days and --plant. `-` reads any but the last from standard input.
    #[arg(value_name = "DATA")]
    pub(crate) inputs: Vec<PathBuf>,
    #[arg(long, short, value_name = "OUT", help = lists::leaf_output())]
    pub(crate) output: Option<PathBuf>,
    /// Write a file of marks to fill in, with instructions, to -o or to standard output.
    #[arg(long)]
    pub(crate) template: bool,
    /// Rows of the template, 2 to 1000.
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(2..=1000))]
    pub(crate) rows: u32,
    /// DATA is the scan of one leaf (.ply, .xyz, .txt, .pcd, .las, .obj): find midrib, outline, stalk and surface.
    #[arg(long, conflicts_with_all = ["template", "plant", "days"])]
    pub(crate) scan: bool,
    /// Length of the midrib in metres, 0.002 to 10, for a vein graph in pixels [default: 0.1, with a warning] and for
    /// --venation [default: 0.1 palmate, 0.3 parallel].
    #[arg(long, value_name = "METRES", value_parser = |s: &str| parse_field::<LeafSpec>(s, "length_m"))]
    pub(crate) length: Option<f64>,
    /// Make a leaf with these veins from a few numbers, without DATA: --veins, --length, --depth.
    #[arg(long, value_enum, conflicts_with_all = ["inputs", "template", "scan", "plant", "days"])]
    pub(crate) venation: Option<VenationWord>,
    /// Chief veins of --venation, an odd number: 3 to 11 palmate, 3 to 31 parallel [default: 5, 9].
    #[arg(long, value_name = "N", requires = "venation", value_parser = clap::value_parser!(u32).range(3..=31))]
    pub(crate) veins: Option<u32>,
    /// Depth of the notches of a palmate leaf, 0 (none) to 0.9.
    #[arg(long, value_name = "X", default_value_t = 0.5, value_parser = |s: &str| ranged(s, 0.0, 0.9))]
    pub(crate) depth: f64,
    /// Side veins on either side of each chief vein in its lobe, made by rule and not measured, 0 to 12 [default: 4
    /// with --venation palmate, else 0].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=12))]
    pub(crate) side_veins: Option<u32>,
    /// Number, from 1, of the leaf in a file that holds several (profiles) [default: the first, with a warning].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) number: Option<u32>,
    /// Reading of a vein graph.
    #[arg(long, value_enum, value_name = "FORM", default_value_t = GraphWord::Auto)]
    pub(crate) graph: GraphWord,
    /// Also write the leaf as marks, such as those found in a scan or grown between stages.
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) marks: Option<PathBuf>,
    /// Materials of leaves, petals, sepals and single strokes, a TOML or JSON file (docs/materials.md): colours,
    /// patterns, pictures.
    #[arg(long, value_name = "FILE")]
    pub(crate) materials: Option<PathBuf>,
    #[arg(long, help = lists::wind(""))]
    pub(crate) wind: bool,
    #[command(flatten)]
    pub(crate) export: ExportArgs,
    /// Hand edits on a whole plant (--plant), a JSON file; `burgeon shape --template` prints one.
    #[arg(long, value_name = "EDITS.json")]
    pub(crate) edits: Option<PathBuf>,
    /// Also make a picture.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Seed of all random choices.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) shape: ShapeArgs,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    #[command(flatten)]
    pub(crate) plant: PlantArgs,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    #[command(flatten)]
    pub(crate) checks: CheckArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

const LEAF_EXAMPLES: &str = "Examples:
  burgeon leaf --template -o marks.csv                           a file to fill in
  burgeon leaf marks.csv -o leaf.glb --png leaf.png
  burgeon leaf marks.csv -o leaf.glb --surface bezier            bezier, approximate, interpolate or nurbs
  burgeon leaf marks.csv -o leaf.glb --rings envelope --caps     the exact surface of the veins
  burgeon leaf marks.csv -o leaf.glb --curl 0.3 --wilt 0.6
  burgeon leaf marks.csv -o leaf.glb --surface approximate --ball 4,1,0,0,0.01,2   one control ball, by hand
  burgeon leaf d5.csv d9.csv d15.csv --days 5,9,15 --day 12 -o leaf.glb
  burgeon leaf low.csv middle.csv high.csv --plant -o tobacco.glb
  burgeon leaf --scan cloud.txt --unit mm -o leaf.glb --marks found.csv
  burgeon leaf --venation palmate --veins 5 -o maple.glb --marks maple.csv
  burgeon leaf --venation parallel --length 0.4 -o lily.glb
  burgeon leaf maple.csv -o maple.glb                            chief veins that start together, digitised
  burgeon leaf veins.json --length 0.06 -o leaf.glb --marks found.csv   a maple's graph too

Marks are a CSV file with the columns row,mark,x,y,z,thickness,midrib. Lines `# unit: mm`, `# up: z` and
`# thickness: diameter` in the file win over --unit, --up and --thickness.
Chief veins are a CSV file with the columns vein,mark,x,y,z,thickness: veins from the right margin to the left, marks
from the base outwards, as many on each; one without thickness is a margin or a notch between lobes.
A profile is {\"x\": [...], \"y\": [...], \"s\": [...], \"r\": [...]}: the midrib from base to tip seen from the side (y
upwards), and the whole width r at the length s from the base; several stand in a list (--number).
A vein graph is {\"unit\": \"pixel\", \"nodes_xyr\": [[x, y, radius], ...], \"edges\": [[0, 1], ...]}.";

/// Options for making blade and veins.
#[derive(Args, Debug)]
#[command(next_help_heading = "Leaf")]
pub(crate) struct ShapeArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// Surface of the blade.
    #[arg(long, value_enum, default_value_t = SurfaceWord::Interpolate)]
    pub(crate) surface: SurfaceWord,
    /// Rings of the veins: circles across the vein as published, or the exact envelope of its balls.
    #[arg(long, value_enum, default_value_t = RingsWord::Plain)]
    pub(crate) rings: RingsWord,
    /// Meaning of a measured thickness [default: as in the file, else diameter].
    #[arg(long, value_enum)]
    pub(crate) thickness: Option<ThicknessWord>,
    /// Parameters of side veins: those of the blade, on which they then lie, or their own chord lengths as
    /// published (they meet the blade at the marks only).
    #[arg(long, value_enum, default_value_t = ParametersWord::Shared)]
    pub(crate) parameters: ParametersWord,
    /// Pull of the thickest vein on a NURBS blade, 1 (none) to 100.
    #[arg(long, value_name = "X", default_value_t = 4.0,
          value_parser = |s: &str| parse_field::<LeafSpec>(s, "vein_weight"))]
    pub(crate) vein_weight: f64,
    /// Parts of each span between marks, 1 to 64.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = |s: &str| whole::<LeafSpec>(s, "subdivisions"))]
    pub(crate) subdivisions: u32,
    /// Points around a vein, 3 to 64.
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = |s: &str| whole::<LeafSpec>(s, "sides"))]
    pub(crate) sides: u32,
    /// Round ends on the veins.
    #[arg(long)]
    pub(crate) caps: bool,
    /// A vein along the margin too.
    #[arg(long)]
    pub(crate) margin_vein: bool,
}

/// Bend and colour of the leaf.
#[derive(Args, Debug)]
#[command(next_help_heading = "Look")]
pub(crate) struct LookArgs {
    /// Roll about the midrib, -1 (below) to 1 (margins meet above); 0 as measured.
    #[arg(long, value_name = "X", default_value_t = 0.0, allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<LeafSpec>(s, "curl"))]
    pub(crate) curl: f64,
    /// Loss of stiffness, 0 (as measured) to 1 (hanging limp).
    #[arg(long, value_name = "X", default_value_t = 0.0, value_parser = |s: &str| parse_field::<LeafSpec>(s, "wilt"))]
    pub(crate) wilt: f64,
    /// Move a control ball: that of mark MARK (1 to 7 from the right margin) in row ROW (1 from the tip, 0 the tip
    /// itself), or of mark MARK on chief vein ROW, by these metres to the right, towards the tip and off the upper
    /// side, and multiply the thickness of the veins there by TIMES; repeat the option for more balls.
    #[arg(long, value_name = "ROW,MARK,RIGHT,FORTH,UP[,TIMES]", allow_hyphen_values = true, value_parser = ball)]
    pub(crate) ball: Vec<BallMove>,
    /// Colour of the blade: veins (painted by the distance from them), plain, or a picture of the pressed leaf (.png or
    /// .jpg), cropped to its box with the tip at the top. With --scan: scan (that of the points, where they have any;
    /// the default) or plain.
    #[arg(long, value_name = "veins|plain|scan|FILE", default_value = "veins")]
    pub(crate) texture: PathBuf,
    /// Days on which the leaf was measured, one for each file, in order.
    #[arg(long, value_name = "D,D,...", value_delimiter = ',', requires = "day")]
    pub(crate) days: Vec<f64>,
    /// The day to show, between the first and the last of --days.
    #[arg(long, value_name = "D", requires = "days")]
    pub(crate) day: Option<f64>,
}

/// Parses a moved control ball of `--ball`.
fn ball(text: &str) -> Result<BallMove, String> {
    let form = || format!("`{text}` is not ROW,MARK,RIGHT,FORTH,UP or ROW,MARK,RIGHT,FORTH,UP,TIMES");
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let (&[row, mark, right, forth, up], times) = parts
        .split_at_checked(5)
        .and_then(|(five, rest)| {
            let five: &[&str; 5] = five.try_into().ok()?;
            (rest.len() < 2).then_some((five, rest.first()))
        })
        .ok_or_else(form)?;
    let count = |word: &str| word.parse::<u32>().map_err(|_e| form());
    let number = |word: &str| word.parse::<f64>().map_err(|_e| form());
    let by_m = [number(right)?, number(forth)?, number(up)?];
    let thickness = times.map_or(Ok(1.0), |word| number(word))?;
    let ball = BallMove { row: count(row)?, mark: count(mark)?, by_m, thickness };
    let asked = LeafSpec { balls: vec![ball], ..LeafSpec::default() };
    burgeon::spec::check(&asked).map_err(|e| e.to_string())?;
    Ok(ball)
}

/// A whole plant of these leaves.
#[derive(Args, Debug)]
#[command(next_help_heading = "Plant")]
pub(crate) struct PlantArgs {
    /// A plant with the leaves on one stem: the first file is the shape of the lowest leaves.
    #[arg(long, conflicts_with = "days")]
    pub(crate) plant: bool,
    /// Number of leaves of the plant, 1 to 200.
    #[arg(long, value_name = "N", default_value_t = 22, value_parser = clap::value_parser!(u32).range(1..=200))]
    pub(crate) leaves: u32,
    /// Height of the plant's stem in metres, 0.01 to 1000.
    #[arg(long, value_name = "METRES", default_value_t = 1.0, value_parser = |s: &str| ranged(s, 0.01, 1000.0))]
    pub(crate) height: f64,
    /// Angle between successive leaves in degrees, -360 to 360, with a standard deviation of 8 degrees.
    #[arg(long, value_name = "DEGREES", default_value_t = 137.0, allow_hyphen_values = true,
          value_parser = |s: &str| ranged(s, -360.0, 360.0))]
    pub(crate) azimuth: f64,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum SurfaceWord {
    /// Through all marks, with the folds of the blade
    Interpolate,
    /// A B-spline near the marks
    Approximate,
    /// One smooth polynomial
    Bezier,
    /// As approximate, drawn towards thick veins
    Nurbs,
}

impl From<SurfaceWord> for SurfaceKind {
    fn from(word: SurfaceWord) -> Self {
        match word {
            SurfaceWord::Interpolate => Self::Interpolate,
            SurfaceWord::Approximate => Self::Approximate,
            SurfaceWord::Bezier => Self::Bezier,
            SurfaceWord::Nurbs => Self::Nurbs,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum VenationWord {
    /// Chief veins spread from the base into lobes, as in a maple
    Palmate,
    /// Veins side by side from base to tip, as in a grass or lily
    Parallel,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum GraphWord {
    /// Palmate where three or more thick veins leave one place, else one midrib
    Auto,
    /// One midrib with side veins
    Midrib,
    /// Chief veins that start together
    Palmate,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum RingsWord {
    /// Circles across the vein
    Plain,
    /// Contact of each ball with the surface of all
    Envelope,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ThicknessWord {
    /// Diameter, as callipers measure it
    Diameter,
    /// Radius, as the formulas use it
    Radius,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ParametersWord {
    /// Parameters of the blade
    Shared,
    /// Chord lengths of the vein's own marks
    Own,
}

impl LeafArgs {
    /// Sets the options that the engine of `--for` requires.
    pub(crate) fn settle(&mut self) -> Outcome {
        let Self { export, axes, wind, output, .. } = self;
        Settings { export, axes, wind, output: output.as_deref() }.settle(&self.given)
    }
}
