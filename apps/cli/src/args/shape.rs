//! `burgeon shape`.

use std::path::PathBuf;

use clap::Args;

use super::export::TreeSurfaceArgs;
use super::given::Given;
use super::lists;
use super::settings;
use super::shared::{AxesArgs, CheckArgs, CommonArgs, PictureArgs, seed};
use super::structure::StructureArgs;
use crate::failure::Outcome;

#[derive(Args, Debug)]
#[command(after_long_help = SHAPE_EXAMPLES)]
pub(crate) struct ShapeArgs {
    /// Must be the first field: clap removes the values of the other fields as it reads them.
    #[command(flatten)]
    pub(crate) given: Given,
    /// A species of `burgeon presets`, a spec (.toml), a flower (rose, lily and others, or your own .toml) in full
    /// bloom, a drawing, a project (.burgeon), or the structure of a plant that was measured (.mtg, .opf, .swc, a table
    /// of cylinders as .csv or .txt), which needs no edits.
    #[arg(value_name = "PRESET|SPEC.toml|FLOWER|DRAWING|STRUCTURE", required_unless_present_any = ["template", "schema"])]
    pub(crate) what: Option<PathBuf>,
    /// The edits, a JSON file; --template prints one, docs/shaping.md explains it.
    #[arg(long, value_name = "EDITS.json")]
    pub(crate) edits: Option<PathBuf>,
    /// Leaves and bark of a species of `burgeon presets`, or of a spec (.toml), for a plant of a file of structure
    /// [default: the leaves of the file].
    #[arg(long, value_name = "PRESET|SPEC.toml")]
    pub(crate) leaves: Option<PathBuf>,
    #[arg(long, short, value_name = "OUT", help = lists::plant_output(), required_unless_present_any = ["png", "report", "json", "template", "schema", "list", "save"])]
    pub(crate) output: Option<PathBuf>,
    /// Name, or number from 1, of the plant in a project, or in a file of structure, that holds several.
    #[arg(long, value_name = "NAME|N")]
    pub(crate) plant: Option<String>,
    /// Also save a project: the drawing with the edits, or the project with the edits after those that it has.
    #[arg(long, value_name = "PROJECT.burgeon")]
    pub(crate) save: Option<PathBuf>,
    /// Also make a picture.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) png: Option<PathBuf>,
    /// Seed of all random choices of the plant; edits have their own. Default 1, or the project's.
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = seed)]
    pub(crate) seed: Option<u64>,
    /// Print the branches up to this order (0 is the trunk) with the paths that name them, after the edits if any.
    #[arg(long, value_name = "ORDER", num_args = 0..=1, default_missing_value = "1")]
    pub(crate) list: Option<u32>,
    /// Print an edits file with an edit of each kind.
    #[arg(long)]
    pub(crate) template: bool,
    /// Write the JSON Schema of edits files: every field with its meaning, unit, range and default.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) schema: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) surface: TreeSurfaceArgs,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) axes: AxesArgs,
    #[command(flatten)]
    pub(crate) structure: StructureArgs,
    #[command(flatten)]
    pub(crate) checks: CheckArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

const SHAPE_EXAMPLES: &str = "Examples:
  burgeon shape --template > edits.json
  burgeon shape oak --list                                       which branch has which path?
  burgeon shape oak --edits edits.json -o oak.glb --png oak.png
  burgeon shape tree.svg --edits edits.json -o tree.glb --report tree.json
  burgeon shape walnut.mtg --in-unit cm --thickness-unit mm --leaves walnut -o walnut.glb
  burgeon shape cylinders.csv --leaves oak --edits edits.json -o oak.glb
  burgeon shape garden.burgeon --plant bush --edits edits.json -o bush.glb --save garden2.burgeon

Edits are done one after another; one that cannot be done says why and changes nothing. If none can be done
that is an error, and so is a number out of its range, such as an \"at\" outside of 0 to 1.
A branch is named by  {\"path\": [0, 2]}  (stem 0, its branch number 2 from the base up),
by  {\"near\": [1.2, 3.4, 0]}  (metres), or by the mark that the Studio keeps.";

impl ShapeArgs {
    /// Sets the options that the engine of `--for` requires.
    pub(crate) fn settle(&mut self) -> Outcome {
        let surface = &mut self.surface;
        let set = (&mut surface.export, &mut surface.skin, &mut self.axes);
        settings::settle(&self.given, set, self.output.as_deref())
    }
}
