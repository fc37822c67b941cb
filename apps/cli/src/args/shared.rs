//! Options that commands share, and their words.

use std::path::PathBuf;

use burgeon::formats::Packing;
use burgeon::render::{Background, PictureSpec, View};
use burgeon::skin::SkinSpec;
use burgeon::spec::Spec;
use burgeon::{Engine, Seed, Unit, UpAxis};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};

use super::lists;

/// Options of every command.
#[derive(Args, Debug)]
#[command(next_help_heading = "Running")]
pub(crate) struct CommonArgs {
    /// Number of threads, 1 to 256 [default: all of the machine]. The result does not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub(crate) threads: Option<u16>,
    /// Factor by which the limits of docs/limits.md may be exceeded, 1 to 1000: memory, points, joints, leaves,
    /// triangles and the like. Anything larger is refused.
    #[arg(long, value_name = "X", default_value_t = 1.0, allow_hyphen_values = true,
          value_parser = |s: &str| ranged(s, 1.0, 1000.0))]
    pub(crate) budget: f64,
    /// Follow paths in files wherever they lead: a model's textures, a spec's meshes, the scans of stages. Without it,
    /// a file may name only files in its folder or below it, also by links (docs/limits.md). Pipes and devices are
    /// never read.
    #[arg(long)]
    pub(crate) trust_paths: bool,
    /// Print nothing but errors; show no progress.
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// Write the report to a JSON file: inputs, interpretation, counts and times.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
    /// Print the report as JSON on stdout instead of the summary.
    #[arg(long)]
    pub(crate) json: bool,
}

impl CommonArgs {
    /// Whether anybody reads the report.
    pub(crate) fn reports(&self) -> bool {
        self.report.is_some() || self.json
    }
}

/// Treatment of implausible results.
#[derive(Args, Clone, Copy, Debug, Default)]
#[command(next_help_heading = "Running")]
pub(crate) struct CheckArgs {
    /// Fail, with exit status 2 and no file, if any check of the result fails (docs/limits.md lists them). Without it,
    /// fail only on results that nobody would accept; other failed checks are warnings.
    #[arg(long)]
    pub(crate) strict: bool,
}

/// Options for meshing plants.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Surface")]
pub(crate) struct SkinArgs {
    /// Fineness of the meshes, 0.1 to 8; triangle counts grow in proportion. At 1 a crown's leaf has 6 to 24
    /// [default: 1].
    #[arg(long, value_name = "X", allow_hyphen_values = true,
          value_parser = |s: &str| parse_field::<SkinSpec>(s, "detail"))]
    pub(crate) detail: Option<f64>,
    /// Sides of an ordinary branch, 3 to 24; thick branches get more [default: 8].
    #[arg(long, value_name = "N", value_parser = |s: &str| whole::<SkinSpec>(s, "sides"))]
    pub(crate) sides: Option<u32>,
    /// Pixels of a side of the textures of bark, and of the length of those of leaves: 64 to 4096, or off [default:
    /// 512] (docs/materials.md).
    #[arg(long, value_name = "SIZE|off", value_parser = texture_size, conflicts_with = "no_textures")]
    pub(crate) textures: Option<u32>,
    /// Plain colours instead of textures, as --textures off.
    #[arg(long)]
    pub(crate) no_textures: bool,
    /// Materials of leaves, petals, sepals and single strokes, a TOML or JSON file (docs/materials.md): colours,
    /// patterns, pictures.
    #[arg(long, value_name = "FILE")]
    pub(crate) materials: Option<PathBuf>,
    #[arg(long, help = lists::wind(""))]
    pub(crate) wind: bool,
}

impl SkinArgs {
    /// Replaces existing settings by those that were given.
    pub(crate) fn set(&self, skin: &mut SkinSpec) {
        skin.detail = self.detail.unwrap_or(skin.detail);
        skin.sides = self.sides.unwrap_or(skin.sides);
        skin.textures &= self.paints();
        skin.texture_size = self.textures.filter(|&size| size > 0).unwrap_or(skin.texture_size);
        skin.wind = self.wind;
    }

    /// Whether there are textures.
    pub(crate) fn paints(&self) -> bool {
        !self.no_textures && self.textures != Some(0)
    }

    /// Returns a plain surface with the given settings.
    pub(crate) fn spec(&self) -> SkinSpec {
        let mut skin = SkinSpec::default();
        self.set(&mut skin);
        skin
    }
}

/// Options of pictures.
#[derive(Args, Debug)]
#[command(next_help_heading = "Picture")]
pub(crate) struct PictureArgs {
    /// Size of the picture in pixels, each 1 to 8192.
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size)]
    pub(crate) size: (u32, u32),
    /// Viewpoint: front is orthographic and shows the drawing; turntable is a sheet of views all around.
    #[arg(long, value_enum, default_value_t = ViewWord::ThreeQuarter)]
    pub(crate) view: ViewWord,
    /// Views of a turntable, 1 to 64.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) frames: u32,
    /// Background: sky, transparent, white or a colour as #rrggbb.
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
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "Geometry")]
pub(crate) struct AxesArgs {
    /// Axis that points up in OBJ, PLY, STL, USD, MTG, OPF, QSM and SWC files, clouds, and coordinates given as
    /// options; glTF is always +Y [default: y; z for MTG, OPF, QSM and SWC].
    #[arg(long, value_parser = up_words())]
    pub(crate) up: Option<UpAxis>,
    /// Unit of length in OBJ, PLY, STL, USD, MTG, OPF, QSM and SWC files, clouds, and lengths said to be in --unit;
    /// glTF is always in metres.
    #[arg(long, value_parser = unit_words(), default_value = Unit::Metre.word())]
    pub(crate) unit: Unit,
}

/// Returns the words of axes that point up.
pub(crate) fn up_words() -> impl TypedValueParser<Value = UpAxis> {
    let words = [(UpAxis::Y, "+Y"), (UpAxis::Z, "+Z")];
    let words = words.map(|(up, help)| PossibleValue::new(up.word()).help(help));
    PossibleValuesParser::new(words).try_map(|word| UpAxis::from_word(&word).ok_or("no axis"))
}

/// Returns the words of units of length.
pub(crate) fn unit_words() -> impl TypedValueParser<Value = Unit> {
    let words = [
        (Unit::Metre, "Metres"),
        (Unit::Centimetre, "Centimetres"),
        (Unit::Millimetre, "Millimetres"),
        (Unit::Foot, "International feet"),
    ];
    let words = words.map(|(unit, help)| PossibleValue::new(unit.word()).help(help));
    PossibleValuesParser::new(words).try_map(|word| Unit::from_word(&word).ok_or("no unit"))
}

/// The words of programs that plants go to.
pub(crate) fn engine_words() -> impl TypedValueParser<Value = Engine> {
    let words = Engine::ALL.map(|engine| PossibleValue::new(engine.word()).help(engine.about()));
    PossibleValuesParser::new(words).try_map(|word| Engine::from_word(&word).ok_or("no program"))
}

/// How a GLB is packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PackWord {
    /// Numbers in few bits (`KHR_mesh_quantization`): most programs read it, Blender among them
    Quantized,
    /// The same, compressed (`EXT_meshopt_compression`, `EXT_texture_webp`): for three.js, Babylon, Godot and others
    /// that have the decoder
    Meshopt,
}

impl PackWord {
    pub(crate) const fn from_packing(packing: Packing) -> Self {
        match packing {
            Packing::Quantized => Self::Quantized,
            Packing::Compressed => Self::Meshopt,
        }
    }

    pub(crate) const fn packing(self) -> Packing {
        match self {
            Self::Quantized => Packing::Quantized,
            Self::Meshopt => Packing::Compressed,
        }
    }
}

/// Parses a size of textures; 0 for off.
fn texture_size(text: &str) -> Result<u32, String> {
    match text.parse() {
        _ if text == "off" => Ok(0),
        Ok(size @ 64..=4096) => Ok(size),
        _ => Err("give 64 to 4096 pixels, or off".to_owned()),
    }
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

/// Parses a number within the range that its spec gives a field.
pub(crate) fn parse_field<T: Spec>(text: &str, field: &str) -> Result<f64, String> {
    let [low, high] = range::<T>(field);
    ranged(text, low, high)
}

/// Parses a whole number as [`parse_field`] does.
pub(crate) fn whole<T: Spec>(text: &str, field: &str) -> Result<u32, String> {
    let [low, high] = range::<T>(field);
    text.parse()
        .ok()
        .filter(|&n| (low..=high).contains(&f64::from(n)))
        .ok_or_else(|| format!("give a whole number from {low} to {high}"))
}

fn range<T: Spec>(field: &str) -> [f64; 2] {
    let range = burgeon::spec::range::<T>(field);
    debug_assert!(range.is_some(), "{field} has a range");
    range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY])
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    #[test]
    fn commands_are_consistent() {
        crate::args::Cli::command().debug_assert();
    }
}
