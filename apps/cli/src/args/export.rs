//! Export of a plant: the same options for every maker.

use burgeon::formats::{Packing, Room};
use burgeon::skin::{FoliageStyle, SolidSpec};
use burgeon::{Allowance, Engine, EngineReport, LevelSpec};
use clap::{Args, ValueEnum};

use super::given::Given;
use super::plant_format::PlantFormat;
use super::shared::{PackWord, SkinArgs, engine_words, ranged};
use crate::failure::Outcome;

/// Options for exporting a plant of any maker.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Export")]
pub(crate) struct ExportArgs {
    /// Write what a program wants: axes, unit, levels, packing, wind and names as its importer takes them (docs/engines/README.md).
    /// Options that stand here, too, win over it.
    #[arg(long = "for", value_name = "ENGINE", value_parser = engine_words())]
    pub(crate) engine: Option<Engine>,
    /// Number of coarser copies to write next to the model (OUT-lod1, OUT-lod2, ...), 0 to 6: each has at most half of
    /// the triangles of the one before, as far as there are leaves to lose.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=6))]
    pub(crate) lods: u32,
    /// Place of the coarser copies: each in a file of its own, or all in the .glb (`MSFT_lod`) [default: each].
    #[arg(long, value_enum, value_name = "WHERE")]
    pub(crate) lod_file: Option<LodFileWord>,
    /// Make the .glb light: numbers in few bits and textures as JPEG, and with meshopt also compressed
    /// (docs/exports.md).
    #[arg(long, value_enum, value_name = "HOW")]
    pub(crate) pack: Option<PackWord>,
    /// Let the .glb sway: an animation in a loop, with a joint for each limb (docs/exports.md).
    #[arg(long, conflicts_with_all = ["wind", "pack"])]
    pub(crate) sway: bool,
    /// Write each leaf shape once, and the places of its copies (`EXT_mesh_gpu_instancing`): a smaller .glb that is
    /// drawn faster, for programs that support it.
    #[arg(long, conflicts_with_all = ["wind", "sway"])]
    pub(crate) instances: bool,
    /// Drawing of leaves: by their outlines, as cards with the leaf cut out, or by their level of detail: outlines,
    /// then cards, then cards of whole shoots [default: outlines].
    #[arg(long, value_enum, value_name = "HOW")]
    pub(crate) foliage: Option<FoliageWord>,
    /// Add one more coarser copy, the last: views from all sides in an atlas of SIZE pixels a side, 128 to 4096
    /// (docs/exports.md).
    #[arg(long, value_name = "SIZE", conflicts_with_all = ["wind", "sway"],
        value_parser = clap::value_parser!(u32).range(128..=4096))]
    pub(crate) impostor: Option<u32>,
    /// Largest number of triangles of the model, 100 or more: the model is the first level of detail within it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(Allowance::TRIANGLES.0..))]
    pub(crate) triangles: Option<u64>,
    /// Largest size in megabytes (of a million bytes) of the model's file with the files next to it: textures become
    /// smaller first, and then the model becomes the first level of detail that fits.
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, Allowance::MEGABYTES.0, Allowance::MEGABYTES.1))]
    pub(crate) megabytes: Option<f64>,
    /// Height of the body for --for print, in millimetres, 10 to 2000 [default: 150].
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 10.0, 2000.0))]
    pub(crate) print_height: Option<f64>,
    /// Least thickness of all parts for --for print, in millimetres, 0.2 to 20: thinner twigs and leaves are thickened
    /// [default: 1.5].
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 0.2, 20.0))]
    pub(crate) print_wall: Option<f64>,
    /// Whether parts and materials are named after the plant: set for an engine.
    #[arg(skip)]
    pub(crate) names: bool,
    /// Whether levels and shapes for collisions are nodes of one file: set for an engine.
    #[arg(skip)]
    pub(crate) nodes: bool,
    /// Whether it is written as a skeleton with leaves on its joints: set for an engine.
    #[arg(skip)]
    pub(crate) assembly: bool,
    /// Options that were set for an engine.
    #[arg(skip)]
    pub(crate) set: Vec<String>,
}

/// Options of exports, by the names of their fields.
pub(crate) const EXPORT: [&str; 12] = [
    "engine",
    "lods",
    "lod_file",
    "pack",
    "sway",
    "instances",
    "foliage",
    "impostor",
    "triangles",
    "megabytes",
    "print_height",
    "print_wall",
];

impl ExportArgs {
    /// Returns the spec of the printed body, if there is one.
    pub(crate) fn print(&self) -> Option<SolidSpec> {
        let usual = SolidSpec::default();
        (self.engine == Some(Engine::Print)).then(|| SolidSpec {
            height_m: self.print_height.map_or(usual.height_m, |mm| mm / 1e3),
            wall_m: self.print_wall.map_or(usual.wall_m, |mm| mm / 1e3),
        })
    }

    /// Returns the part of the report about the engine.
    pub(crate) fn report(&self) -> Option<EngineReport> {
        Some(EngineReport { name: self.engine?.word().to_owned(), set: self.set.clone() })
    }

    pub(crate) fn packing(&self) -> Option<Packing> {
        self.pack.map(PackWord::packing)
    }

    /// Whether the coarser copies go into the model's own file.
    pub(crate) fn in_one_file(&self) -> bool {
        self.lod_file == Some(LodFileWord::One)
    }

    /// Returns the number of coarser copies with files of their own.
    pub(crate) fn lod_files(&self) -> u32 {
        if self.in_one_file() || self.nodes { 0 } else { self.lods + u32::from(self.impostor.is_some()) }
    }

    /// Returns how leaves are drawn.
    pub(crate) fn foliage(&self) -> FoliageStyle {
        self.foliage.map_or_else(FoliageStyle::default, FoliageWord::foliage)
    }

    /// Returns the limits to the size of the output.
    pub(crate) fn allowance(&self) -> Allowance {
        Allowance::new(self.triangles, self.megabytes)
    }

    /// Returns the levels for a file of this format in addition to the finest meshes. For a budget, levels are made
    /// that nobody asked for, as the model may become one of them.
    pub(crate) fn levels(&self, format: Option<PlantFormat>) -> LevelSpec {
        if !matches!(format, Some(PlantFormat::Model(_))) {
            return LevelSpec::default();
        }
        let lods = self.allowance().levels(self.lods);
        LevelSpec { lods, copies: self.instances, impostor: self.impostor, assembly: self.assembly }
    }

    /// Fails on unused options. `format`: of the written plant. `picture`: whether one is made.
    pub(crate) fn check_used(
        &self,
        given: &Given,
        (format, picture): (Option<PlantFormat>, bool),
        paints: bool,
    ) -> Outcome {
        let print = self.engine == Some(Engine::Print);
        given.only_if(print, &["print_height", "print_wall"], "--for print", "nothing is printed")?;
        if print {
            let whole = "a print is one body";
            given.refuse(&["lods", "foliage", "triangles"], "models with levels of detail", whole)?;
        }
        if self.assembly {
            let nanite = "Nanite makes levels itself";
            let options = ["lods", "triangles", "megabytes", "impostor"];
            given.refuse(&options, "models with levels of detail", nanite)?;
        }
        let holds = |room| format.is_some_and(|format| format.holds(room));
        let rooms = [
            ("pack", Room::Packing),
            ("lod_file", Room::Levels),
            ("sway", Room::Joints),
            ("instances", Room::Instances),
        ];
        for (option, room) in rooms {
            given.only_if_holds(holds(room), &[option], room)?;
        }
        let model = matches!(format, Some(PlantFormat::Model(_)));
        given.only_if(model, &["lods", "triangles", "megabytes"], "models", "none is made")?;
        given.only_if(self.lods > 0, &["lod_file"], "coarser copies (--lods)", "none is made")?;
        let apart = !(self.in_one_file() && self.sway);
        given.only_if(
            apart,
            &["sway"],
            "levels in files of their own",
            "--lod-file one puts them into one",
        )?;
        let textured = holds(Room::Textures);
        given.only_if(textured, &["impostor"], "models with textures", "none is made")?;
        let sized = textured || picture || !paints;
        given.only_if(sized, &["textures"], "models and pictures with textures", "none is made")?;
        let painted = (textured || picture) && paints;
        given.only_if(painted, &["foliage"], "models and pictures with textures", "none is made")?;
        let by_level = self.foliage == Some(FoliageWord::ByLevel);
        given.only_if(
            !by_level || self.lods > 0 || self.allowance().is_any(),
            &["foliage"],
            "coarser copies (--lods)",
            "none is made",
        )
    }
}

/// Drawing of leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FoliageWord {
    /// By their outlines
    Outlines,
    /// As cards with holes
    Cards,
    /// Outlines in the model, cards in OUT-lod1, cards of shoots in OUT-lod2 and those after it
    ByLevel,
}

impl FoliageWord {
    pub(crate) const fn foliage(self) -> FoliageStyle {
        match self {
            Self::Outlines => FoliageStyle::Outlines,
            Self::Cards => FoliageStyle::Cards,
            Self::ByLevel => FoliageStyle::ByLevel,
        }
    }
}

/// Place of coarser copies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LodFileWord {
    /// Next to the model: OUT-lod1, OUT-lod2, ...
    Each,
    /// Into the model's own file, as levels of its node
    One,
}

/// Options for meshing and exporting a plant.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Surface")]
pub(crate) struct TreeSurfaceArgs {
    #[command(flatten)]
    pub(crate) skin: SkinArgs,
    #[command(flatten)]
    pub(crate) export: ExportArgs,
}

impl TreeSurfaceArgs {
    /// Returns the settings of the meshes; a swaying model needs wind columns.
    pub(crate) fn spec(&self) -> burgeon::skin::SkinSpec {
        let skin = self.skin.spec();
        burgeon::skin::SkinSpec {
            wind: skin.wind || self.export.sway,
            foliage: self.export.foliage(),
            ..skin
        }
    }

    /// Fails on unused options.
    pub(crate) fn check_used(&self, given: &Given, format: Option<PlantFormat>, picture: bool) -> Outcome {
        self.export.check_used(given, (format, picture), self.skin.paints())
    }
}
