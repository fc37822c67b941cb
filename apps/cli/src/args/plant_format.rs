//! Formats that plants are written as, and their words.

use std::sync::LazyLock;

use burgeon::formats::{FormatRow, ModelFormat, RobotFormat, Room, StructureFormat, list_of_endings};
use clap::ValueEnum;
use clap::builder::PossibleValue;

/// A format of models as the word of an option.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FormatWord(pub(crate) ModelFormat);

impl FormatWord {
    pub(crate) const GLB: Self = Self(ModelFormat::Glb);
}

impl ValueEnum for FormatWord {
    fn value_variants<'a>() -> &'a [Self] {
        static ALL: LazyLock<Vec<FormatWord>> =
            LazyLock::new(|| PlantFormat::models().map(FormatWord).collect());
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(possible(self.0.row()))
    }
}

/// A format of plants as the word of an option: the ending of its files.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlantFormatWord(pub(crate) PlantFormat);

impl PlantFormatWord {
    pub(crate) const GLB: Self = Self(PlantFormat::Model(ModelFormat::Glb));
}

impl ValueEnum for PlantFormatWord {
    fn value_variants<'a>() -> &'a [Self] {
        static ALL: LazyLock<Vec<PlantFormatWord>> =
            LazyLock::new(|| PlantFormat::written().map(PlantFormatWord).collect());
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(possible(self.0.row()))
    }
}

fn possible(row: &'static FormatRow) -> PossibleValue {
    PossibleValue::new(row.endings[0]).help(row.about)
}

/// What a plant is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PlantFormat {
    /// Its meshes.
    Model(ModelFormat),
    /// Its structure.
    Structure(StructureFormat),
    /// Its bodies and joints.
    Robot(RobotFormat),
}

impl PlantFormat {
    pub(crate) const fn row(self) -> &'static FormatRow {
        match self {
            Self::Model(model) => model.row(),
            Self::Structure(structure) => structure.row(),
            Self::Robot(robot) => robot.row(),
        }
    }

    /// Whether its files have room for something.
    pub(crate) fn holds(self, room: Room) -> bool {
        self.row().holds.contains(&room)
    }

    /// How names of its files end, without the dot.
    pub(crate) const fn extension(self) -> &'static str {
        self.row().endings[0]
    }

    /// The format of models that it is.
    pub(crate) const fn model(self) -> Option<ModelFormat> {
        match self {
            Self::Model(model) => Some(model),
            Self::Structure(_) | Self::Robot(_) => None,
        }
    }

    pub(crate) fn from_extension(extension: &str) -> Option<Self> {
        StructureFormat::from_extension(extension)
            .map(Self::Structure)
            .or_else(|| ModelFormat::from_extension(extension).map(Self::Model))
            .or_else(|| RobotFormat::from_extension(extension).map(Self::Robot))
    }

    /// The formats of models that are written.
    fn models() -> impl Iterator<Item = ModelFormat> {
        ModelFormat::ALL.into_iter().filter(|f| f.row().is_written())
    }

    /// All that plants are written as, by the last ending of a file's name: that of tables may hold anything.
    fn written() -> impl Iterator<Item = Self> {
        Self::models().map(Self::Model).chain(Self::structures()).chain(RobotFormat::ALL.map(Self::Robot))
    }

    fn structures() -> impl Iterator<Item = Self> {
        let named = |f: &StructureFormat| !f.extension().contains('.');
        StructureFormat::ALL.into_iter().filter(named).map(Self::Structure)
    }

    /// How files of structure may end, for help texts.
    pub(crate) fn structure_endings() -> String {
        list_of_endings(Self::structures().map(|f| &f.row().endings[0]))
    }

    /// How files of plants may end, for messages.
    pub(crate) fn endings() -> String {
        format!("plants are written as {}", list_of_endings(Self::written().map(|f| &f.row().endings[0])))
    }
}
