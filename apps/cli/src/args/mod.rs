//! Names, options and help of every command: a contract with other programs.

mod bloom;
mod compare;
mod export;
mod files;
mod forest;
mod given;
mod grow;
mod leaf;
mod light;
mod lists;
mod plant_format;
mod presets;
mod replay;
mod scan;
mod settings;
mod shape;
mod shared;
mod sketch;
mod species;
mod structure;

pub(crate) use bloom::{BloomAtArgs, BloomCommand, BloomRunArgs, FitArgs, FrameWord, ScanTextureWord};
pub(crate) use compare::{CompareArgs, CompareWord};
pub(crate) use export::{EXPORT, ExportArgs, FoliageWord, TreeSurfaceArgs};
pub(crate) use files::{ConvertArgs, InfoArgs, RenderArgs, StudioArgs};
pub(crate) use forest::{ForestArgs, GroundArgs};
pub(crate) use given::{Given, Seen};
pub(crate) use grow::{GrowArgs, MethodWord, PointsArgs};
pub(crate) use leaf::{
    GraphWord, LeafArgs, ParametersWord, RingsWord, SurfaceWord, ThicknessWord, VenationWord,
};
pub(crate) use light::{LightArgs, SkyWord, SourceArgs};
pub(crate) use lists::structure_endings;
pub(crate) use plant_format::{FormatWord, PlantFormat};
pub(crate) use presets::PresetsArgs;
pub(crate) use replay::ReplayArgs;
pub(crate) use scan::ScanArgs;
pub(crate) use shape::ShapeArgs;
pub(crate) use shared::{AxesArgs, CheckArgs, CommonArgs, PackWord, PictureArgs, SkinArgs};
pub(crate) use sketch::{ReadingArgs, SketchArgs, SurfaceArgs};
pub(crate) use species::{SpeciesCommand, SpeciesFitArgs};
pub(crate) use structure::StructureArgs;

use clap::{Args, Parser, Subcommand};

/// Turns drawings into three-dimensional plants.
///
/// Exit status: 0 on success, 2 for bad usage or bad input (one line on stderr gives the fault, its place and the
/// remedy), 1 for a bug of burgeon, 130 after Ctrl-C or another request to end (drawings of a batch that were finished
/// by then stay). The files of a command are written all or none, and never over a file that it reads; other files of
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
    Leaf(Box<LeafArgs>),
    /// Grow a tree: a species that comes with the program, or a spec of your own
    ///
    /// Branches compete for space and light, around obstacles; leaves stay where light reaches. `burgeon presets`
    /// lists the species.
    Grow(Box<GrowArgs>),
    /// Find a tree in a laser scan: wood as axes with radii, leaves by species
    ///
    /// Removes ground, noise and other things; paths from the foot give the skeleton, circles and the pipe model its
    /// radii. The result is a plant like all others: meshes, structure, cylinders, measures.
    Scan(Box<ScanArgs>),
    /// Turn an inventory of trees into a forest: 3D Tiles of grown plants, one file with instances, USD, a table
    ///
    /// Each tree stands in its place with its height, crown and diameter. A few plants of each species and age are
    /// grown and stand for many trees, turned and scaled as far as looks right; coarser levels and pictures stand for
    /// distant ones.
    Forest(Box<ForestArgs>),
    /// Compute the light on a plant: the light of sky and sun that each leaf and branch absorbs
    ///
    /// Photosynthetically active light (PAR) from a sky of 46 directions and the sun of a place and day, with the light
    /// that leaves and soil reflect and transmit; on one plant, on several, or on a canopy without end.
    Light(Box<LightArgs>),
    /// Edit a plant by hand: prune, turn, move, regrow, sketch or brush branches, fill a silhouette, thin leaves
    ///
    /// Works on a species, a spec, a drawing, a project or the structure of a plant that was measured (MTG, OPF, QSM,
    /// SWC), which may also get leaves. A JSON file holds the edits; the rest of the plant stays unchanged.
    Shape(Box<ShapeArgs>),
    /// Replay gestures recorded in a headset: a record that the Studio wrote
    ///
    /// The same tools, without a headset: the document in which the record ends, a picture of it, or an animated
    /// picture of every step.
    Replay(Box<ReplayArgs>),
    /// List the species that `burgeon grow` knows; show one as TOML; write the JSON Schema of specs
    Presets(PresetsArgs),
    /// Grow the same oak by three methods and compare them
    ///
    /// L-system, space colonization and space competition, at one height: vertices, triangles, leaves, seconds, bytes,
    /// and the figures of Yang et al. (2019).
    Compare(Box<CompareArgs>),
    /// Make a picture of a model or of a plant
    ///
    /// The model, or the plant of an MTG, OPF, QSM or SWC file, fills the picture except for a margin and stands on the
    /// ground in the light of a soft sun.
    Render(RenderArgs),
    /// Convert a model or a drawing to another format
    #[command(long_about = lists::convert())]
    Convert(ConvertArgs),
    /// Describe a model, a drawing, a project or the structure of a plant
    ///
    /// Counts, bounds, units, parts and materials, measures of plants, and faults.
    Info(InfoArgs),
    /// Grow organs through scans of several days; flowers that open
    #[command(subcommand)]
    Bloom(BloomCommand),
    /// Make a species of measured trees
    #[command(subcommand)]
    Species(SpeciesCommand),
    /// Open the Studio: draw on the left, see the plant grow on the right
    ///
    /// Serves the built Studio on 127.0.0.1, to this machine's own browser only, and opens it. Nothing is sent
    /// anywhere: plants are made in the browser.
    Studio(StudioArgs),
    /// Print the completions of a shell
    ///
    /// For one session: `source <(burgeon completions bash)`. For good, put them where the shell looks for them.
    #[command(after_long_help = "Examples:
  burgeon completions bash > ~/.local/share/bash-completion/completions/burgeon
  burgeon completions zsh > ~/.zfunc/_burgeon
  burgeon completions fish > ~/.config/fish/completions/burgeon.fish")]
    Completions(CompletionsArgs),
    /// Write the manual pages, one for each command
    ///
    /// `man -l FOLDER/burgeon-sketch.1` reads a page in place; if FOLDER is a share/man/man1, so does `man
    /// burgeon-sketch`.
    Man(ManArgs),
}

#[derive(Args, Debug)]
pub(crate) struct CompletionsArgs {
    /// The shell.
    #[arg(value_enum)]
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Args, Debug)]
pub(crate) struct ManArgs {
    /// A folder, which is created.
    #[arg(value_name = "FOLDER")]
    pub(crate) folder: std::path::PathBuf,
}
