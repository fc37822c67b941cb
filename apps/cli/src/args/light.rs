//! `burgeon light`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::given::Given;
use super::shared::{CheckArgs, CommonArgs, PictureArgs, ranged, seed};

#[derive(Args, Debug)]
#[command(after_long_help = LIGHT_EXAMPLES)]
pub(crate) struct LightArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// A species of `burgeon presets`, a spec (.toml), a flower (rose, lily and others, or your own .toml) in full
    /// bloom, a drawing, or a project (.burgeon), all visible plants of which stand in the light together.
    #[arg(value_name = "PRESET|SPEC.toml|FLOWER|DRAWING")]
    pub(crate) what: PathBuf,
    /// A table with a row for each axis and organ (.csv; docs/light.md has its columns), the structure of the plant
    /// with columns of light (.mtg, .opf), or the plant coloured by the light that it absorbs (.glb).
    #[arg(long, short, value_name = "OUT", required_unless_present_any = ["png", "report", "json"])]
    pub(crate) output: Option<PathBuf>,
    /// Also make a picture in these colours.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Seed of all random choices of the plant; plants of a project have their own [default: 1].
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: Option<u64>,
    #[command(flatten)]
    pub(crate) source: SourceArgs,
    #[command(flatten)]
    pub(crate) stand: LightStandArgs,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) checks: CheckArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Sources of light. All irradiances are of photosynthetically active radiation (PAR) on a horizontal surface.
#[derive(Args, Debug)]
#[command(next_help_heading = "Light")]
pub(crate) struct SourceArgs {
    /// Distribution of the light of the sky [default: overcast; clear with a sun].
    #[arg(long, value_enum, value_name = "SKY")]
    pub(crate) sky: Option<SkyWord>,
    /// PAR from the sky on a horizontal surface, W/m2, 0 to 2000 [default: 100; of a clear day with --place].
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 0.0, 2000.0))]
    pub(crate) diffuse: Option<f64>,
    /// PAR straight from the sun on a horizontal surface, W/m2, 0 to 2000 [default: of a clear day with --place].
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 0.0, 2000.0))]
    pub(crate) direct: Option<f64>,
    /// Position of the sun: azimuth from north (-Z) over east (+X), and elevation above the horizon, degrees.
    #[arg(long, value_name = "AZ,EL", allow_hyphen_values = true, value_parser = pair, conflicts_with = "place", requires = "direct")]
    pub(crate) sun: Option<[f64; 2]>,
    /// A place on earth, which gives the position of the sun on that day: latitude and longitude in degrees (north and
    /// east are positive), and metres above the sea [default of these: 0].
    #[arg(long, value_name = "LAT,LON[,M]", allow_hyphen_values = true, value_parser = place, requires = "date")]
    pub(crate) place: Option<[f64; 3]>,
    /// The day, 1950 to 2050.
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date, requires = "place")]
    pub(crate) date: Option<[u32; 3]>,
    /// The hour of the day by the clock, 0 to 24 [default: 12].
    #[arg(long, value_name = "H", value_parser = |s: &str| ranged(s, 0.0, 24.0), requires = "place")]
    pub(crate) hour: Option<f64>,
    /// Hours by which the clock is ahead of universal time, -12 to 14 [default: the longitude over 15, rounded].
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, -12.0, 14.0), requires = "place")]
    pub(crate) zone: Option<f64>,
    /// Linke's turbidity of the air, 1 to 10: 2 is very clear, 3 clear, 5 moist, 7 polluted [default: 3].
    #[arg(long, value_name = "T", value_parser = |s: &str| ranged(s, 1.0, 10.0), requires = "place", conflicts_with_all = ["direct", "diffuse"])]
    pub(crate) turbidity: Option<f64>,
    /// The sum of a clear day, every half hour from sunrise to sunset, in MJ.
    #[arg(long, requires = "place", conflicts_with_all = ["hour", "direct", "diffuse"])]
    pub(crate) daily: bool,
    /// A measured sky: a CSV file with rows of azimuth, elevation (degrees) and PAR on a horizontal surface (W/m2) from
    /// there, 1 to 2000 rows.
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["sky", "diffuse", "direct", "sun", "place"])]
    pub(crate) sky_table: Option<PathBuf>,
}

/// The lit stand.
#[derive(Args, Debug)]
#[command(next_help_heading = "Stand")]
pub(crate) struct LightStandArgs {
    /// Repeat the scene without end in cells of this width (along X) and depth (along Z), metres, each 0.001 to 10000:
    /// a closed canopy. Without it, the scene stands alone.
    #[arg(long, value_name = "WxD", value_parser = cell)]
    pub(crate) repeat: Option<[f64; 2]>,
    /// Reflectance and transmittance of leaves and petals, together at most 1 [default: 0.1,0.05].
    #[arg(long, value_name = "R,T", value_parser = optics)]
    pub(crate) leaf: Option<[f64; 2]>,
    /// Reflectance of wood and all other opaque parts, 0 to 1 [default: 0.16].
    #[arg(long, value_name = "R", value_parser = |s: &str| ranged(s, 0.0, 1.0))]
    pub(crate) wood: Option<f64>,
    /// Reflectance of the soil, 0 to 1 [default: 0.1].
    #[arg(long, value_name = "R", value_parser = |s: &str| ranged(s, 0.0, 1.0))]
    pub(crate) soil: Option<f64>,
    /// Number of times that light is followed from surface to surface, 0 to 50 [default: 3].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=50))]
    pub(crate) bounces: Option<u32>,
    /// Lines of light in each direction, 1000 to 4194304 [default: 262144].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1000..=4_194_304))]
    pub(crate) rays: Option<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SkyWord {
    /// Three times as bright at the zenith as at the horizon (Moon and Spencer 1942)
    Overcast,
    /// The same everywhere
    Uniform,
    /// Bright around the sun (CIE S 011, type 12)
    Clear,
}

const LIGHT_EXAMPLES: &str = "Examples:
  burgeon light oak -o oak.csv                                    under an overcast sky of 100 W/m2
  burgeon light oak --repeat 6x6 -o oak.csv --report oak.json     a stand of oaks: fAPAR, LAI, extinction
  burgeon light oak --place 48.1,11.6 --date 2026-06-21 --hour 9 -o oak.csv --png oak.png
  burgeon light oak --place 48.1,11.6 --date 2026-06-21 --daily -o oak.csv
  burgeon light rose --sun 180,45 --direct 200 --diffuse 60 -o rose.glb";

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|w| w.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

fn pair(text: &str) -> Result<[f64; 2], String> {
    let is_place = |p: &[f64; 2]| p[0].abs() <= 360.0 && p[1].abs() <= 90.0;
    numbers(text)
        .filter(is_place)
        .ok_or_else(|| "give azimuth and elevation in degrees, such as 180,45".into())
}

fn place(text: &str) -> Result<[f64; 3], String> {
    let two = || numbers(text).map(|[latitude, longitude]: [f64; 2]| [latitude, longitude, 0.0]);
    let is_place =
        |p: &[f64; 3]| p[0].abs() <= 90.0 && p[1].abs() <= 180.0 && (-500.0..=9000.0).contains(&p[2]);
    numbers(text).or_else(two).filter(is_place).ok_or_else(|| {
        "give latitude and longitude in degrees, such as 48.1,11.6, and metres up to 9000 if need be".into()
    })
}

fn date(text: &str) -> Result<[u32; 3], String> {
    let parts: Option<Vec<u32>> = text.split('-').map(|w| w.parse().ok()).collect();
    let parts: Option<[u32; 3]> = parts.and_then(|p| p.try_into().ok());
    parts.ok_or_else(|| "give year, month and day such as 2026-06-21".into())
}

fn cell(text: &str) -> Result<[f64; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, d)| Some([w.parse().ok()?, d.parse().ok()?]));
    sides
        .filter(|sides: &[f64; 2]| sides.iter().all(|s| (0.001..=1e4).contains(s)))
        .ok_or_else(|| "give width and depth in metres, each 0.001 to 10000, such as 6x6".into())
}

fn optics(text: &str) -> Result<[f64; 2], String> {
    let is_sound = |o: &[f64; 2]| o.iter().all(|x| (0.0..=1.0).contains(x)) && o[0] + o[1] <= 1.0;
    numbers(text)
        .filter(is_sound)
        .ok_or_else(|| "give reflectance and transmittance, together at most 1, such as 0.1,0.05".into())
}
