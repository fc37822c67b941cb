//! How a plant is exported: the same options for every maker.

use burgeon::formats::{Packing, Room};
use burgeon::skin::{FoliageStyle, SolidSpec};
use burgeon::{EngineReport, LevelSpec};
use clap::{Args, ValueEnum};

use super::engine::Engine;
use super::given::Given;
use super::plant_format::PlantFormat;
use super::shared::{PackWord, SkinArgs, ranged};
use crate::failure::Outcome;

/// What is written of a plant, whatever made it.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Export")]
pub(crate) struct ExportArgs {
    /// Write what a program wants: axes, unit, levels, packing, wind and names as its importer takes them (docs/engines/README.md).
    /// Options that stand here, too, win over it.
    #[arg(long = "for", value_enum, value_name = "ENGINE")]
    pub(crate) engine: Option<Engine>,
    /// Coarser copies to write beside the model (OUT-lod1, OUT-lod2, ...), 0 to 6: each has at most half of the triangles
    /// of the one before, as far as there are leaves to lose.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=6))]
    pub(crate) lods: u32,
    /// Where the coarser copies go: each into a file of its own, or all into the .glb (`MSFT_lod`) [default: each].
    #[arg(long, value_enum, value_name = "WHERE")]
    pub(crate) lod_file: Option<LodFileWord>,
    /// Make the .glb light: numbers in few bits and textures as JPEG, and with meshopt also compressed
    /// (docs/exports.md).
    #[arg(long, value_enum, value_name = "HOW")]
    pub(crate) pack: Option<PackWord>,
    /// Let the .glb sway: an animation in a loop, with a joint for each limb (docs/exports.md).
    #[arg(long, conflicts_with_all = ["wind", "pack"])]
    pub(crate) sway: bool,
    /// Write each leaf shape once, and where its copies stand (`EXT_mesh_gpu_instancing`): a smaller .glb that is drawn
    /// faster, for programs that know it.
    #[arg(long, conflicts_with_all = ["wind", "sway"])]
    pub(crate) instances: bool,
    /// How leaves are drawn: by their outlines, as cards of which the leaf is cut out, or by their level of detail: outlines,
    /// then cards, then cards of whole shoots [default: outlines].
    #[arg(long, value_enum, value_name = "HOW")]
    pub(crate) foliage: Option<FoliageWord>,
    /// One more coarser copy, the last: views from all sides in an atlas of SIZE pixels a side, 128 to 4096
    /// (docs/exports.md).
    #[arg(long, value_name = "SIZE", conflicts_with_all = ["wind", "sway"],
        value_parser = clap::value_parser!(u32).range(128..=4096))]
    pub(crate) impostor: Option<u32>,
    /// The most triangles that the model may have, 100 or more: it is the first level of detail that has no more.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(100..))]
    pub(crate) triangles: Option<u64>,
    /// The most megabytes (of a million bytes) that the model's file may have, with what lies beside it: textures become
    /// smaller first, and then the model the first level of detail that fits.
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 0.001, 4000.0))]
    pub(crate) megabytes: Option<f64>,
    /// Height of what --for print makes, in millimetres, 10 to 2000 [default: 150].
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 10.0, 2000.0))]
    pub(crate) print_height: Option<f64>,
    /// No part of what --for print makes is thinner than this, in millimetres, 0.2 to 20: twigs and leaves that would be are
    /// thickened [default: 1.5].
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = |s: &str| ranged(s, 0.2, 20.0))]
    pub(crate) print_wall: Option<f64>,
    /// Parts and materials are named after the plant: set for an engine.
    #[arg(skip)]
    pub(crate) names: bool,
    /// What was set for an engine.
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
    /// The body that is printed, if one is.
    pub(crate) fn print(&self) -> Option<SolidSpec> {
        let usual = SolidSpec::default();
        (self.engine == Some(Engine::Print)).then(|| SolidSpec {
            height_m: self.print_height.map_or(usual.height_m, |mm| mm / 1e3),
            wall_m: self.print_wall.map_or(usual.wall_m, |mm| mm / 1e3),
        })
    }

    /// What the report says of the engine.
    pub(crate) fn report(&self) -> Option<EngineReport> {
        Some(EngineReport { name: self.engine?.word(), set: self.set.clone() })
    }

    pub(crate) fn packing(&self) -> Option<Packing> {
        self.pack.map(PackWord::packing)
    }

    /// The coarser copies go into the model's own file.
    pub(crate) fn in_one_file(&self) -> bool {
        self.lod_file == Some(LodFileWord::One)
    }

    /// Coarser copies with files of their own.
    pub(crate) fn lod_files(&self) -> u32 {
        if self.in_one_file() { 0 } else { self.lods + u32::from(self.impostor.is_some()) }
    }

    /// How leaves are drawn.
    pub(crate) fn foliage(&self) -> FoliageStyle {
        self.foliage.map_or_else(FoliageStyle::default, FoliageWord::foliage)
    }

    /// Whether the size of what is written has a bound.
    pub(crate) fn has_budget(&self) -> bool {
        self.triangles.is_some() || self.megabytes.is_some()
    }

    /// What is made for a file of this format besides the finest meshes. For a budget levels are made that are not asked
    /// for, as the model may become one of them.
    pub(crate) fn levels(&self, format: Option<PlantFormat>) -> LevelSpec {
        if !matches!(format, Some(PlantFormat::Model(_))) {
            return LevelSpec::default();
        }
        let lods = if self.has_budget() { MOST_LODS } else { self.lods };
        LevelSpec { lods, copies: self.instances, impostor: self.impostor }
    }

    /// Fails on options that nothing uses. `format`: of the plant that is written. `picture`: one is made.
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
        let painted = (textured || picture) && paints;
        given.only_if(painted, &["foliage"], "models and pictures with textures", "none is made")?;
        let by_level = self.foliage == Some(FoliageWord::ByLevel);
        given.only_if(
            !by_level || self.lods > 0 || self.has_budget(),
            &["foliage"],
            "coarser copies (--lods)",
            "none is made",
        )
    }
}

/// Levels of detail that there are.
const MOST_LODS: u32 = 6;

/// How leaves are drawn.
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

/// Where coarser copies go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LodFileWord {
    /// Beside the model: OUT-lod1, OUT-lod2, ...
    Each,
    /// Into the model's own file, as levels of its node
    One,
}

/// How a plant is meshed and exported.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Surface")]
pub(crate) struct TreeSurfaceArgs {
    #[command(flatten)]
    pub(crate) skin: SkinArgs,
    #[command(flatten)]
    pub(crate) export: ExportArgs,
}

impl TreeSurfaceArgs {
    /// How the meshes are made; what sways needs the columns of the wind.
    pub(crate) fn spec(&self) -> burgeon::skin::SkinSpec {
        let skin = self.skin.spec();
        burgeon::skin::SkinSpec {
            wind: skin.wind || self.export.sway,
            foliage: self.export.foliage(),
            ..skin
        }
    }

    /// Fails on options that nothing uses.
    pub(crate) fn check_used(&self, given: &Given, format: Option<PlantFormat>, picture: bool) -> Outcome {
        self.export.check_used(given, (format, picture), self.skin.paints())
    }
}
