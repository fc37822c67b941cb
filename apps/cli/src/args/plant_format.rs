//! Formats in which plants are written, and their words.

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

/// Written form of a plant.
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

    /// Whether its files have room for the given data.
    pub(crate) fn holds(self, room: Room) -> bool {
        self.row().holds.contains(&room)
    }

    /// Returns the ending of its files, without the dot.
    pub(crate) const fn extension(self) -> &'static str {
        self.row().endings[0]
    }

    /// Returns its format of models, if it is one.
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

    /// Returns the formats in which models are written.
    fn models() -> impl Iterator<Item = ModelFormat> {
        ModelFormat::ALL.into_iter().filter(|f| f.row().is_written())
    }

    /// Returns all formats in which plants are written, by the last ending of a file's name: a table may hold anything,
    /// and USD with physics is USD.
    fn written() -> impl Iterator<Item = Self> {
        let robots = RobotFormat::ALL.into_iter().filter(|f| !f.extension().contains('.')).map(Self::Robot);
        Self::models().map(Self::Model).chain(Self::structures()).chain(robots)
    }

    /// Returns the format that the last two words of a file's name say, if any.
    pub(crate) fn from_two_words(name: &str) -> Option<Self> {
        let formats = StructureFormat::ALL.into_iter().map(Self::Structure);
        let mut two = formats
            .chain(RobotFormat::ALL.into_iter().map(Self::Robot))
            .filter(|format| format.extension().contains('.'));
        two.find(|format| name.to_ascii_lowercase().ends_with(&format!(".{}", format.extension())))
    }

    fn structures() -> impl Iterator<Item = Self> {
        let named = |f: &StructureFormat| !f.extension().contains('.');
        StructureFormat::ALL.into_iter().filter(named).map(Self::Structure)
    }

    /// Returns the endings of files of structure, for help texts.
    pub(crate) fn structure_endings() -> String {
        list_of_endings(Self::structures().map(|f| &f.row().endings[0]))
    }

    /// Returns the endings of files of plants, for messages.
    pub(crate) fn endings() -> String {
        format!("plants are written as {}", list_of_endings(Self::written().map(|f| &f.row().endings[0])))
    }
}
