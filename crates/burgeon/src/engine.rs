//! Plants for a program: what each wants of a file, in one table for all shells.

use base::{Run, Unit, UpAxis};
use formats::{ModelFormat, Packing, Room};
use mesh::{Material, MaterialId, MaterialKind, Model, Part};
use plant::Plant;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use skin::{SolidError, SolidSpec};

/// A program that plants go to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Engine {
    /// three.js and what stands on it.
    Three,
    /// Blender.
    Blender,
    /// Unity by glTFast.
    Unity,
    /// Unreal Engine.
    Unreal,
    /// Godot 4.
    Godot,
    /// Isaac Sim and other readers of USD.
    Isaac,
    /// A 3-D printer.
    Print,
}

base::words!(Engine {
    Three = "three",
    Blender = "blender",
    Unity = "unity",
    Unreal = "unreal",
    Godot = "godot",
    Isaac = "isaac",
    Print = "print",
});

/// Ending of USD files with rigid bodies and joints.
const PHYSICS: &str = "physics.usda";

/// How wind reaches a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Air {
    /// As attributes of vertices.
    Attributes,
    /// As texture coordinates, which importers keep.
    Sets,
    Still,
}

/// How a program knows shapes for collisions: by the names of their nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShapeNames {
    /// One mesh, whose name ends so.
    Whole(&'static str),
    /// Convex pieces, whose names begin so and end with a number.
    Pieces(&'static str),
}

/// How a program wants a plant.
struct Row {
    about: &'static str,
    /// Endings of files that it reads.
    endings: &'static [&'static str],
    /// Axis that points up and unit, where the format has room for them.
    axes: Option<(UpAxis, Unit)>,
    lods: u32,
    packing: Option<Packing>,
    wind: Air,
    /// Levels and shapes for collisions are nodes of one file; their names.
    nodes: Option<ShapeNames>,
    /// Pivots are textures beside a file with nodes.
    paints_pivots: bool,
    /// Materials and parts are named after the plant, because those of all files come into one folder.
    has_names: bool,
}

/// Choices of an export besides the program; `None` is open.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExportChoice {
    /// The axis that points up.
    pub up: Option<UpAxis>,
    /// The unit.
    pub unit: Option<Unit>,
    /// Coarser copies.
    pub lods: Option<u32>,
    /// How it is packed.
    pub packing: Option<Packing>,
    /// It has columns of the wind.
    pub has_wind: bool,
    /// It sways by joints.
    pub sways: bool,
    /// All levels are in one file.
    pub is_one_file: bool,
    /// It is drawn in a way that wind does not go with: leaves as instances, an impostor.
    pub is_still: bool,
    /// Parts and materials are named after the plant.
    pub has_names: bool,
}

/// A file that a program is not given.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("this program is given .{}, not .{given}", wanted.join(" or ."))]
pub struct WrongEngineFile {
    /// Endings of what it is given.
    pub wanted: &'static [&'static str],
    /// The ending of the file.
    pub given: String,
}

/// Something that an export is given because it is for a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EngineSetting {
    name: &'static str,
    value: String,
    is_option: bool,
}

impl EngineSetting {
    fn new(name: &'static str, value: impl Into<String>) -> Self {
        Self { name, value: value.into(), is_option: true }
    }

    fn note(name: &'static str, words: impl Into<String>) -> Self {
        Self { name, value: words.into(), is_option: false }
    }

    /// Whether it is an option of an export, with its value after a space.
    pub const fn is_option(&self) -> bool {
        self.is_option
    }

    /// Returns the name of the option; for what no option sets a name of its own, such as `names` for the names of
    /// materials and parts.
    pub const fn name(&self) -> &'static str {
        self.name
    }

    /// Returns the value of the option, empty for a switch; for what no option sets a few words.
    pub fn value(&self) -> &str {
        &self.value
    }
}

impl core::fmt::Display for EngineSetting {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match (self.is_option, self.value.as_str()) {
            (false, words) => f.write_str(words),
            (true, "") => f.write_str(self.name),
            (true, value) => write!(f, "{} {value}", self.name),
        }
    }
}

impl Engine {
    /// Returns the row of the table that docs/engines/ explains.
    const fn row(self) -> Row {
        let plain = Row {
            about: "",
            endings: &["glb", "gltf"],
            axes: None,
            lods: 0,
            packing: None,
            wind: Air::Still,
            nodes: None,
            paints_pivots: false,
            has_names: false,
        };
        match self {
            Self::Three => Row {
                about: "three.js and what stands on it: .glb, packed, with wind for a shader",
                packing: Some(Packing::Compressed),
                lods: 2,
                wind: Air::Attributes,
                ..plain
            },
            Self::Blender => Row {
                about: "Blender: .glb, plain, with wind as attributes",
                wind: Air::Attributes,
                has_names: true,
                ..plain
            },
            Self::Unity => Row {
                about: "Unity by glTFast: .glb, levels and a collider in one file, with wind for a shader",
                lods: 3,
                wind: Air::Sets,
                nodes: Some(ShapeNames::Whole("_collider")),
                has_names: true,
                ..plain
            },
            Self::Unreal => Row {
                about: "Unreal Engine: .usda, a skeleton with leaves on its joints (Nanite), or .glb, a static mesh with shapes for collisions",
                endings: &["usda", "glb", "gltf"],
                axes: Some((UpAxis::Z, Unit::Centimetre)),
                wind: Air::Sets,
                nodes: Some(ShapeNames::Pieces("UCX_")),
                paints_pivots: true,
                has_names: true,
                ..plain
            },
            Self::Godot => Row {
                about: "Godot 4: .glb with a shape for collisions, with wind for a shader; it makes levels itself",
                wind: Air::Sets,
                nodes: Some(ShapeNames::Whole("-colonly")),
                has_names: true,
                ..plain
            },
            Self::Isaac => Row {
                about: "Isaac Sim and other readers of USD: .usda or .usdz, metres, +Z up",
                endings: &["usda", "usdz", PHYSICS],
                axes: Some((UpAxis::Z, Unit::Metre)),
                has_names: true,
                ..plain
            },
            Self::Print => Row {
                about: "A 3-D printer: one closed body as .stl or .ply, millimetres, +Z up, on a flat foot",
                endings: &["stl", "ply"],
                axes: Some((UpAxis::Z, Unit::Millimetre)),
                ..plain
            },
        }
    }

    /// Describes the program and its files in a line, for lists.
    pub const fn about(self) -> &'static str {
        self.row().about
    }

    /// Endings of files that it is given, without the dot.
    pub const fn endings(self) -> &'static [&'static str] {
        self.row().endings
    }

    /// Returns whether a file of this ending for the program is an assembly ([`assemble`](crate::assemble)).
    pub fn has_assembly(self, ending: &str) -> bool {
        self == Self::Unreal && ending == "usda"
    }

    /// Returns whether a `.glb` for the program has levels and shapes for collisions as nodes of one file
    /// ([`write_engine_glb`](crate::write_engine_glb)); not with choices that need other files: joints, packing, instances, an
    /// impostor, levels by `MSFT_lod`.
    pub const fn has_nodes(self, choice: &ExportChoice) -> bool {
        self.nodes(choice).is_some()
    }

    const fn nodes(self, choice: &ExportChoice) -> Option<ShapeNames> {
        if choice.sways || choice.packing.is_some() || choice.is_still || choice.is_one_file {
            return None;
        }
        self.row().nodes
    }

    /// Returns whether textures of pivots lie beside a `.glb` with nodes ([`engine_textures`](crate::engine_textures)).
    pub(crate) const fn paints_pivots(self) -> bool {
        self.row().paints_pivots
    }

    pub(crate) const fn shape_names(self) -> Option<ShapeNames> {
        self.row().nodes
    }

    /// Sets what the program wants and `choice` leaves open, for a file of this ending; returns what was set.
    ///
    /// # Errors
    /// [`WrongEngineFile`] for a file that it is not given.
    pub fn settle(
        self,
        ending: &str,
        choice: &mut ExportChoice,
    ) -> Result<Vec<EngineSetting>, WrongEngineFile> {
        let row = self.row();
        if !row.endings.contains(&ending) {
            return Err(WrongEngineFile { wanted: row.endings, given: ending.to_owned() });
        }
        let mut set = Vec::new();
        if ending == PHYSICS {
            set.push(EngineSetting::note(
                "physics",
                "rigid bodies and springy joints in metres and kilograms, +Z up",
            ));
            return Ok(set);
        }
        let has_axes = ModelFormat::from_extension(ending).is_some_and(|format| format.holds(Room::Axes));
        if let Some((up, unit)) = row.axes.filter(|_| has_axes) {
            if choice.up.is_none() {
                choice.up = Some(up);
                set.push(EngineSetting::new("up", up.word()));
            }
            if choice.unit.is_none() {
                choice.unit = Some(unit);
                set.push(EngineSetting::new("unit", unit.word()));
            }
        }
        if row.lods > 0 && choice.lods.is_none() {
            choice.lods = Some(row.lods);
            set.push(EngineSetting::new("lods", row.lods.to_string()));
        }
        if let Some(packing) = row.packing.filter(|_| choice.packing.is_none() && !choice.sways) {
            choice.packing = Some(packing);
            set.push(EngineSetting::new("pack", packing.word()));
        }
        let open = !choice.has_wind && !choice.sways && !choice.is_still;
        if self.has_assembly(ending) {
            set.push(EngineSetting::note("skeleton", "a skeleton of at most 120 joints"));
            set.push(EngineSetting::note("leaves", "leaves as copies on its joints"));
            set.push(EngineSetting::note("wind-file", "wind as JSON"));
        } else if let Some(names) = self.nodes(choice) {
            if choice.lods.is_some_and(|lods| lods > 0) {
                set.push(EngineSetting::note("levels", "levels as nodes _LOD0, _LOD1, ... of one file"));
            }
            set.push(EngineSetting::note(
                "collider",
                match names {
                    ShapeNames::Whole(ending) => format!("the wood as a shape for collisions, node {ending}"),
                    ShapeNames::Pieces(start) => {
                        format!("the wood as convex shapes for collisions, nodes {start}")
                    }
                },
            ));
        }
        match row.wind {
            Air::Attributes if open => {
                choice.has_wind = true;
                set.push(EngineSetting::new("wind", ""));
            }
            Air::Sets if open && self.has_nodes(choice) && !self.has_assembly(ending) => {
                choice.has_wind = true;
                set.push(EngineSetting::new("wind", ""));
                set.push(EngineSetting::note("wind-sets", "wind as texture coordinates 2 to 5"));
                if row.paints_pivots {
                    set.push(EngineSetting::note("pivots", "textures for Pivot Painter 2, by coordinates 1"));
                }
            }
            _ => {}
        }
        if row.has_names {
            choice.has_names = true;
            set.push(EngineSetting::note("names", "names of materials and parts after the plant"));
        }
        Ok(set)
    }
}

/// Names parts and materials after the plant: `oak_bark`, and not `bark` as those of all others.
pub fn name_after(plant: &str, model: &mut Model) {
    let stem = formats::file_name(plant, "plant").to_lowercase();
    for material in &mut model.materials {
        material.name = format!("{stem}_{}", material.name);
    }
    for part in &mut model.parts {
        part.name = format!("{stem}_{}", part.name);
    }
}

/// A plant as one closed body.
#[derive(Clone, Debug)]
pub struct PrintedPlant {
    /// The body.
    pub model: Model,
    /// How large it is beside the plant.
    pub scale: f64,
    /// Pieces of surface that were left out, as they hang on nothing or lie within the body.
    pub loose: usize,
}

/// Makes one closed body of a plant.
///
/// # Errors
/// [`SolidError`].
pub fn print_plant(
    plant: &Plant,
    model: &Model,
    spec: &SolidSpec,
    run: &Run<'_>,
) -> Result<PrintedPlant, SolidError> {
    let made = skin::solid(plant, model, spec, run)?;
    let material = Material::plain("print", MaterialKind::Other, [0.6; 3]);
    let part = Part { name: "print".to_owned(), material: MaterialId::new(0), mesh: made.mesh };
    let model =
        Model { name: model.name.clone(), parts: vec![part], materials: vec![material], offset_m: None };
    Ok(PrintedPlant { model, scale: made.scale, loose: made.loose })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(engine: Engine, ending: &str, asked: ExportChoice) -> (ExportChoice, String) {
        let mut choice = asked;
        let set = engine.settle(ending, &mut choice).expect("a file that it is given");
        (choice, set.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "))
    }

    #[test]
    fn what_is_asked_wins_over_what_a_program_wants() {
        let open = ExportChoice::default();
        let (choice, set) = settled(Engine::Unity, "glb", open);
        assert_eq!((choice.lods, choice.has_wind, choice.has_names), (Some(3), true, true));
        assert!(set.starts_with("lods 3, levels as nodes") && set.contains("_collider, wind"), "{set}");
        assert!(Engine::Unity.has_nodes(&choice));
        let (choice, set) = settled(Engine::Unreal, "usda", open);
        assert_eq!(
            (choice.up, choice.unit, choice.has_wind),
            (Some(UpAxis::Z), Some(Unit::Centimetre), false)
        );
        assert!(Engine::Unreal.has_assembly("usda") && set.contains("120 joints"), "{set}");
        let (choice, set) = settled(Engine::Unreal, "glb", open);
        assert_eq!((choice.up, choice.unit, choice.has_wind), (None, None, true));
        assert!(set.contains("nodes UCX_") && set.contains("Pivot Painter 2"), "{set}");
        let swaying = ExportChoice { sways: true, ..open };
        let (choice, set) = settled(Engine::Godot, "gltf", swaying);
        assert!(!choice.has_wind && !Engine::Godot.has_nodes(&choice) && !set.contains("-colonly"), "{set}");
        let asked = ExportChoice { lods: Some(0), packing: Some(Packing::Quantized), ..open };
        let (choice, set) = settled(Engine::Unity, "glb", asked);
        assert_eq!((choice.lods, choice.has_wind), (Some(0), false), "what is packed has no sets: {set}");
        let (choice, _) = settled(Engine::Three, "gltf", ExportChoice { is_still: true, ..open });
        assert_eq!((choice.packing, choice.has_wind), (Some(Packing::Compressed), false));
        let (choice, _) = settled(Engine::Print, "stl", ExportChoice { unit: Some(Unit::Metre), ..open });
        assert_eq!((choice.up, choice.unit), (Some(UpAxis::Z), Some(Unit::Metre)));
    }

    #[test]
    fn a_program_is_not_given_files_of_others() {
        let error = Engine::Isaac.settle("glb", &mut ExportChoice::default()).expect_err("no USD");
        assert_eq!(error.to_string(), "this program is given .usda or .usdz or .physics.usda, not .glb");
        for engine in Engine::ALL {
            assert!(!engine.about().is_empty() && !engine.endings().is_empty(), "{engine:?}");
        }
    }
}
