//! `--for ENGINE`: what each program wants, in one table.

use burgeon::mesh::Model;
use burgeon::{Unit, UpAxis};
use clap::ValueEnum;

use crate::args::{AxesArgs, ExportArgs, Given, LodFileWord, PackWord, SkinArgs};
use crate::failure::{Failure, Outcome};
use crate::files;

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
struct Row {
    /// Endings of files that it reads.
    endings: &'static [&'static str],
    /// Axis that points up and unit, where the format has room for them.
    axes: Option<(UpAxis, Unit)>,
    lods: u32,
    lod_file: Option<LodFileWord>,
    pack: Option<PackWord>,
    /// How wind reaches it.
    wind: Air,
    /// Materials and parts are named after the plant, because those of all files come into one folder.
    names: bool,
}

/// How wind reaches an engine.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Air {
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
    const fn row(self) -> Row {
        let glb = &["glb", "gltf"];
        let plain = Row {
            endings: glb,
            axes: None,
            lods: 0,
            lod_file: None,
            pack: None,
            wind: Air::Still,
            names: false,
        };
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

/// The options of a command that an engine sets.
pub(crate) struct Settings<'a> {
    pub(crate) export: &'a mut ExportArgs,
    pub(crate) axes: &'a mut AxesArgs,
    /// Whether there are columns of the wind.
    pub(crate) wind: &'a mut bool,
    /// The file that is written.
    pub(crate) output: Option<&'a std::path::Path>,
}

impl Settings<'_> {
    /// Sets what the engine wants and the command line leaves open.
    pub(crate) fn settle(self, given: &Given) -> Outcome {
        let Some(engine) = self.export.engine else { return Ok(()) };
        let row = engine.row();
        let ending = self.output.and_then(files::extension).map(str::to_ascii_lowercase);
        let Some(ending) = ending else {
            return Err(Failure::Bad(format!(
                "--for {} is for a model: name its file with -o, ending with .{}",
                engine.word(),
                row.endings.join(" or .")
            )));
        };
        if !row.endings.contains(&ending.as_str()) {
            return Err(Failure::Bad(format!(
                "--for {}: this program is given .{}, not .{ending}; end the name with that, or leave --for out",
                engine.word(),
                row.endings.join(" or ."),
            )));
        }
        let mut set = Vec::new();
        if let Some((up, unit)) = row.axes {
            if !given.has("up") {
                self.axes.up = Some(up);
                set.push(format!("--up {}", up.word()));
            }
            if !given.has("unit") {
                self.axes.unit = unit;
                set.push(format!("--unit {}", unit.word()));
            }
        }
        if row.lods > 0 && !given.has("lods") {
            self.export.lods = row.lods;
            set.push(format!("--lods {}", row.lods));
        }
        if let Some(place) = row.lod_file.filter(|_| !given.has("lod_file")) {
            self.export.lod_file = Some(place);
            set.push("--lod-file".to_owned());
        }
        if let Some(pack) = row.pack.filter(|_| !given.has("pack") && !self.export.sway) {
            self.export.pack = Some(pack);
            let word = pack.to_possible_value();
            set.push(format!("--pack {}", word.as_ref().map_or("", |w| w.get_name())));
        }
        // Each of these is a way of its own to draw a plant, which wind does not go with.
        let open =
            !*self.wind && !self.export.sway && !self.export.instances && self.export.impostor.is_none();
        match row.wind {
            Air::Attributes if open => {
                *self.wind = true;
                set.push("--wind".to_owned());
            }
            Air::Joints if open && self.export.pack.is_none() && !self.export.in_one_file() => {
                self.export.sway = true;
                set.push("--sway".to_owned());
            }
            _ => {}
        }
        if row.names {
            self.export.names = true;
            set.push("names of materials and parts after the plant".to_owned());
        }
        self.export.set = set;
        Ok(())
    }
}

/// Settles the options of a command with a plain surface.
pub(crate) fn settle(
    given: &Given,
    (export, skin, axes): (&mut ExportArgs, &mut SkinArgs, &mut AxesArgs),
    output: Option<&std::path::Path>,
) -> Outcome {
    Settings { export, axes, wind: &mut skin.wind, output }.settle(given)
}

/// Names parts and materials after the plant: `oak_bark`, and not `bark` as those of all others.
pub(crate) fn name_after(plant: &str, model: &mut Model) {
    let stem = burgeon::formats::file_name(plant, "plant").to_lowercase();
    for material in &mut model.materials {
        material.name = format!("{stem}_{}", material.name);
    }
    for part in &mut model.parts {
        part.name = format!("{stem}_{}", part.name);
    }
}
