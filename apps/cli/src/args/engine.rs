//! `--for ENGINE`: what each program wants, in one table.

use burgeon::{Unit, UpAxis};
use clap::ValueEnum;

use super::shared::PackWord;

/// A program that plants go to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Engine {
    /// three.js and what stands on it: .glb, packed, with wind for a shader
    Three,
    /// Blender: .glb, plain, with wind as attributes
    Blender,
    /// Unity by glTFast: .glb, three levels in files of their own, swaying
    Unity,
    /// Unreal Engine: .glb, three levels in files of their own, swaying
    Unreal,
    /// Godot 4: .glb, swaying; it makes levels itself
    Godot,
    /// Isaac Sim and other readers of USD: .usda or .usdz, metres, +Z up
    Isaac,
    /// A 3-D printer: one closed body as .stl or .ply, millimetres, +Z up, on a flat foot
    Print,
}

/// How an engine wants a plant.
pub(super) struct Row {
    /// Endings of files that it reads.
    pub(super) endings: &'static [&'static str],
    /// Axis that points up and unit, where the format has room for them.
    pub(super) axes: Option<(UpAxis, Unit)>,
    pub(super) lods: u32,
    pub(super) pack: Option<PackWord>,
    /// How wind reaches it.
    pub(super) wind: Air,
    /// Materials and parts are named after the plant, because those of all files come into one folder.
    pub(super) names: bool,
}

/// How wind reaches an engine.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Air {
    /// As attributes of vertices.
    Attributes,
    /// As joints that an animation moves.
    Joints,
    Still,
}

impl Engine {
    /// Its word on the command line.
    pub(crate) fn word(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// What docs/engines/ explains, row by row.
    pub(super) const fn row(self) -> Row {
        let glb = &["glb", "gltf"];
        let plain = Row { endings: glb, axes: None, lods: 0, pack: None, wind: Air::Still, names: false };
        match self {
            Self::Three => Row { pack: Some(PackWord::Meshopt), lods: 2, wind: Air::Attributes, ..plain },
            Self::Blender => Row { wind: Air::Attributes, names: true, ..plain },
            Self::Unity | Self::Unreal => Row { lods: 3, wind: Air::Joints, names: true, ..plain },
            Self::Godot => Row { wind: Air::Joints, names: true, ..plain },
            Self::Print => {
                Row { endings: &["stl", "ply"], axes: Some((UpAxis::Z, Unit::Millimetre)), ..plain }
            }
            Self::Isaac => {
                Row { endings: &["usda", "usdz"], axes: Some((UpAxis::Z, Unit::Metre)), names: true, ..plain }
            }
        }
    }
}
