//! Specs of stands that grow.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Initial placement of the trees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum PlantingPattern {
    /// Random; species with a short seed spread form groups.
    #[default]
    Natural,
    /// In rows, as in orchards and plantations; the density of the stand is ignored.
    Rows {
        /// Distance in the row, metres, 0.1 to 1000.
        #[schemars(range(min = 0.1, max = 1000.0), extend("x-unit" = "m"))]
        spacing_m: f64,
        /// Distance between rows, metres, 0.1 to 1000.
        #[schemars(range(min = 0.1, max = 1000.0), extend("x-unit" = "m"))]
        row_m: f64,
        /// Direction of the rows from east towards south, degrees, -360 to 360, default 0.
        #[serde(default)]
        #[schemars(range(min = -360.0, max = 360.0), extend("x-unit" = "deg"))]
        angle_deg: f64,
        /// Greatest distance of trees from their place in the row, metres, 0 to 100, default 0.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 100.0), extend("x-unit" = "m"))]
        jitter_m: f64,
    },
}

/// One species of a stand. Missing values are those of the species.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SpeciesSpec {
    /// The word of a preset, a scientific or a common name.
    pub name: String,
    /// Share of the trees that are placed, relative to the other species, 0 to 1e6, default 1.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub share: f64,
    /// Least and greatest age of the trees that are placed, years, 0 to 5000, default 3 to 8.
    #[schemars(inner(range(min = 0.0, max = 5000.0)), extend("x-unit" = "a"))]
    pub age_years: [f64; 2],
    /// Least distance from a placed tree to another, metres, 0 to 100, default 0.3.
    #[schemars(range(min = 0.0, max = 100.0), extend("x-unit" = "m"))]
    pub spacing_m: f64,
    /// Light demand, 0 (grows in deep shade) to 1 (only in full light). Default that of the species.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub light: Option<f64>,
    /// Mean distance from a tree to its seedlings, metres, 0.1 to 10,000. Default that of the species.
    #[schemars(range(min = 0.1, max = 10_000.0), extend("x-unit" = "m"))]
    pub seed_spread_m: Option<f64>,
    /// Seedlings per year of a grown tree in full light that live to reach 1.3 m, 0 to 10, default 0.02.
    #[schemars(range(min = 0.0, max = 10.0), extend("x-unit" = "1/a"))]
    pub seedlings: f64,
    /// Least and greatest slope that it prefers, degrees; rare outside. Default any.
    #[schemars(inner(range(min = 0.0, max = 90.0)), extend("x-unit" = "deg"))]
    pub slope_deg: Option<[f64; 2]>,
    /// Least and greatest height of the ground that it prefers, metres; rare outside. Default any.
    #[schemars(inner(range(min = -1e4, max = 1e4)), extend("x-unit" = "m"))]
    pub height_m: Option<[f64; 2]>,
    /// Least and greatest distance from water that it prefers, metres; rare outside. Default any.
    #[schemars(inner(range(min = 0.0, max = 1e6)), extend("x-unit" = "m"))]
    pub water_m: Option<[f64; 2]>,
}

impl Default for SpeciesSpec {
    fn default() -> Self {
        Self {
            name: "oak".into(),
            share: 1.0,
            age_years: [3.0, 8.0],
            spacing_m: 0.3,
            light: None,
            seed_spread_m: None,
            seedlings: 0.02,
            slope_deg: None,
            height_m: None,
            water_m: None,
        }
    }
}

/// Water, in which no tree stands; species may prefer to be near it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Water {
    /// Corners, x and z in metres.
    #[schemars(extend("x-unit" = "m"))]
    pub points: Vec<[f64; 2]>,
    /// Width of a river or brook along the points, metres, 0 to 10,000; none: a lake with the points as its shore.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 10_000.0), extend("x-unit" = "m"))]
    pub width_m: Option<f64>,
}

/// Ground of a stand. File names are relative to the spec.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum GroundSpec {
    /// The plane y = 0.
    #[default]
    Flat,
    /// A picture of 16 bits of grey, with its centre at the origin.
    Png {
        /// Name of the file.
        file: String,
        /// Side of a cell, metres, above 0, at most 10,000.
        #[schemars(range(max = 10_000.0), extend("exclusiveMinimum" = 0.0, "x-unit" = "m"))]
        metres_per_cell: f64,
        /// Height of black, metres, -20,000 to 20,000, default 0.
        #[serde(default)]
        #[schemars(range(min = -2e4, max = 2e4), extend("x-unit" = "m"))]
        low_m: f64,
        /// Height of white, metres, -20,000 to 20,000.
        #[schemars(range(min = -2e4, max = 2e4), extend("x-unit" = "m"))]
        high_m: f64,
        /// The level of cells without data, 0 to 65,535. Default none.
        #[serde(default)]
        no_data: Option<u16>,
    },
    /// A GeoTIFF of heights in metres, in a projection in metres, with its centre at the origin.
    Geotiff {
        /// Name of the file.
        file: String,
    },
    /// A model in metres, +Y up.
    Mesh {
        /// Name of the file.
        file: String,
    },
}

/// A picture over the area: white lets trees stand, black keeps them out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MaskSpec {
    /// Name of the file, relative to the spec.
    pub file: String,
    /// Whether black admits trees, and white keeps them out. Default false.
    pub inverted: bool,
    /// The species to which it applies, by its name in the stand. Default all.
    pub species: Option<String>,
}

/// A stand: species on a piece of ground, and the years that they grow in competition. Metres, degrees, years; +X
/// east, +Y up, +Z south. Saved as TOML.
///
/// ```
/// let spec: forest::ForestSpec = spec::from_toml(
///     "area_m = [60, 40]\nyears = 30\n[[species]]\nname = \"beech\"\n[[species]]\nname = \"Quercus robur\"\nshare = 0.5",
/// )?;
/// let stand = forest::grow_stand(&spec, &forest::Ground::Flat, base::Seed::new(1), &base::Run::plain())?;
/// assert!(stand.trees.len() > 50 && stand.validate().next().is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ForestSpec {
    /// Name for files and reports.
    pub name: String,
    /// Description in one line.
    pub about: String,
    /// Width from west to east and depth from north to south, metres, 1 to 200,000, default 100 by 100. The centre is
    /// the origin.
    #[schemars(inner(range(min = 1.0, max = 200_000.0)), extend("x-unit" = "m"))]
    pub area_m: [f64; 2],
    /// Corners of the stand within the area, x and z in metres. Default none: the whole area.
    #[schemars(extend("x-unit" = "m"))]
    pub outline: Vec<[f64; 2]>,
    /// Years of growth, 0 to 2000, default 50.
    #[schemars(range(max = 2000), extend("x-unit" = "a"))]
    pub years: u32,
    /// Years of one step of growth, 1 to 20, default 5: with shorter steps, the same forest takes longer.
    #[schemars(range(min = 1, max = 20), extend("x-unit" = "a"))]
    pub step_years: u32,
    /// Number of trees that are placed per hectare, 0.01 to 200,000, default 1500.
    #[schemars(range(min = 0.01, max = 200_000.0), extend("x-unit" = "1/ha"))]
    pub density_ha: f64,
    /// Initial placement. Default random.
    pub pattern: PlantingPattern,
    /// Growth relative to a good site, 0.1 to 3, default 1.
    #[schemars(range(min = 0.1, max = 3.0))]
    pub site: f64,
    /// Lean of trunks on slopes: 0 upright, 1 square to the ground. 0 to 1, default 0.1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub lean: f64,
    /// The species, at least one.
    pub species: Vec<SpeciesSpec>,
    /// Polygons without trees, x and z in metres: buildings, roads, clearings.
    #[schemars(extend("x-unit" = "m"))]
    pub keep_out: Vec<Vec<[f64; 2]>>,
    /// Rivers and lakes.
    pub water: Vec<Water>,
    /// The ground.
    pub ground: GroundSpec,
    /// Pictures over the area.
    pub masks: Vec<MaskSpec>,
}

spec::schemas!(ForestSpec);

impl Default for ForestSpec {
    fn default() -> Self {
        Self {
            name: "forest".into(),
            about: String::new(),
            area_m: [100.0, 100.0],
            outline: Vec::new(),
            years: 50,
            step_years: 5,
            density_ha: 1500.0,
            pattern: PlantingPattern::default(),
            site: 1.0,
            lean: 0.1,
            species: Vec::new(),
            keep_out: Vec::new(),
            water: Vec::new(),
            ground: GroundSpec::default(),
            masks: Vec::new(),
        }
    }
}
