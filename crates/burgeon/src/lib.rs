//! Burgeon: three-dimensional plants out of what people can draw, measure or point at.
//!
//! This is the facade: the one crate that programs use. It joins the makers with skinning, pictures and files.
//!
//! `Drawing -> make_from_sketch -> Made { plant, model, item } -> formats | render`
//!
//! ```
//! use burgeon::{Run, Seed, SketchOptions, make_from_sketch};
//! use burgeon::ink::Drawing;
//! use burgeon::glam::DVec2;
//!
//! let line: Vec<DVec2> = (0..40).map(|i| DVec2::new(0.02 * f64::from(i % 7), f64::from(i))).collect();
//! let drawing = Drawing::from_polylines("a stem", &[line]);
//! let made = make_from_sketch(&drawing, &SketchOptions::default(), Seed::new(1), &Run::plain())?;
//! assert_eq!(made.item.counts.branches, Some(1));
//! assert!(made.model.triangle_count() > 100);
//! # Ok::<(), burgeon::MakeError>(())
//! ```

mod assembly;
mod balls;
mod checks;
mod days;
mod engine;
mod engine_nodes;
mod evaluate;
mod flowers;
mod leaves;
mod levels;
mod light_source;
mod lit;
mod lit_scene;
mod made;
mod make;
mod motion;
mod opening;
mod pivot_painter;
mod refusal;
mod report;
mod robot;
mod scanned;
mod scene;
mod schemas;
mod shaping;
mod split;
mod stands;
mod structure;
mod trees;
mod venation;
mod weight;

pub use assembly::{AssemblyError, assemble};
pub use balls::{LeafBall, LeafBalls, leaf_balls};
pub use base::{
    Angle, Budget, CancelToken, Cancelled, Clock, Code, Coded, Counted, Digest, Draw, Executor, LiteMap,
    NoClock, OverBudget, Report, Run, Seed, Serial, Severity, Slip, Stopped, Stream, TimeUnit, Told, Unit,
    UpAxis, Warning, brief, byte_of_light, grouped, linear_of_srgb, map_indexed, map_of, meant, plainly,
    quoted, set_of, sort_by_key, srgb_of_linear,
};
pub use checks::{CHECKS, PLAUSIBLE, PlausibilityLimits, check_law, check_read};
pub use days::ScannedDays;
pub use engine::{
    Engine, EngineSetting, ExportChoice, PrintedPlant, WrongEngineFile, name_after, print_plant,
};
pub use engine_nodes::{engine_textures, write_engine_glb};
pub use evaluate::{Evaluator, FrontView, make_from_sketch, make_levels_from_sketch};
pub use flowers::{FlowerOptions, make_flower};
pub use leaves::{LeafOptions, make_leaf, make_leaf_of, make_shoot};
pub use levels::{Allowance, AllowanceError, Fitted, LevelSpec, Levels};
pub use light_source::{
    LightSourceError, LightSourceSpec, LightSources, PlaceOnDay, SkyShape, SourceFigures,
};
pub use lit::{
    EnergyFigures, LIGHT_SCALE, LightFigures, LightOptions, LightUnit, LitOrgan, LitStand, light_stand,
};
pub use lit_scene::{shown_plants, stood_plants, without_textures};
pub use made::{Made, MadePlant};
pub use make::{ClassOverrides, MakeError, SketchOptions, worn};
pub use motion::{cloud_model, colour_points, motion_model};
pub use opening::{OpenedPlant, OpeningError, OpeningPlant};
pub use refusal::Refusal;
pub use report::{
    CheckReport, Counts, EngineReport, FaceCounts, FidelityReport, GrowthReport, InputReport, ItemReport,
    LeafFit, LeafReport, REPORT_SCHEMA, ReadingReport, RobotReport, RunReport, ScanReport, SeverityWord,
    SideWord, StrokeReport, TimingsMs,
};
pub use robot::{Robot, RobotError, write_robot};
pub use scanned::{SeedlingOptions, make_leaf_from_scan, make_seedling};
pub use scene::{
    PlantLevel, SceneError, SceneEvaluator, ScenePlant, leaf_marks, standing, standing_at, tree_settings,
    tree_spec,
};
pub use schemas::{flower_schema, leaf_schema, material_schema, sketch_schema, skin_schema};
pub use shaping::{BranchRow, EditReport, branch_rows, edits_schema, edits_template};
pub use split::{SplitError, split};
pub use stands::{
    ForestPlan, ForestTilesError, ForestTilesSpec, LIMITS, Misfits, ModelsOf, Nursery, NurseryError,
    NurseryLook, NurserySpec, Placed, SPECIES_COLOURS, ScaleLimits, SiteError, SiteFiles, StandReport,
    StandTile, TILES_JOURNAL, TILES_MANIFEST, TILESET, TileDisk, TileFile, TileFolder, TileId, TileModels,
    TileWriter, Tiling, TilingError, TilingSpec, Variant, Watch, WholeForest, read_ground, read_masks,
    stand_map,
};
pub use structure::{write_structure, write_structure_with};

pub use trees::{
    GUIDED_METHODS, HeightError, MadeTree, NamedMesh, OAK_METHODS, PAPER_OAKS, PRESETS, PaperOak, Preset,
    ScanTreeOptions, ScannedTreeError, StructureModel, StructureModelError, StructureOptions, TreeError,
    TreeEvaluator, TreeGoal, TreeOfDbh, TreeOptions, TreeSize, age_of_height, aim_at, guided_methods,
    make_from_structure, make_tree, make_tree_from_scan, make_tree_of_plot, method_word, read_tree_spec,
    scale_to_height, show_obstacles, tree_blade, tree_of_dbh, tree_schema, tree_size,
};
pub use venation::make_ray_leaf;
pub use weight::FileForm;

pub use base::coded;
pub use growth::{Bark, BladeSpec, BlossomSpec, Look, TreeSpec};
pub use leaf::leaf_blade;
pub use makers::{
    DrawnKind, DrawnLine, LeafError, LeafTemplate, OrganFit, SeedlingError, ShootSpec, TemplateError,
    drawing_of, drawn, surface_places,
};
pub use mesh::{scene_copies, scene_model};
pub use scan::{Stood, SurveyError, SurveySpec, Surveyed, survey, survey_stand};
pub use skin::{
    NOTHING, PART_OF_SOIL, PART_OF_STONE, PARTS, PotSpec, SceneSite, SceneSiteSpec, coarser, make_site,
    part_of_axis, part_of_organ, triangle_labels,
};
pub use spec::{Colour, Spec, SpecFault};

pub use {
    bloom, document, forest, formats, geom, glam, growth, ink, leaf, light, makers, mechanics, mesh, plant,
    reading, render, scan, shape, sketch, skin, spec,
};

/// Version that is written into reports and files.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The example of the README is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
