//! Options for reading files with the structure of plants: MTG, OPF, QSM and SWC.

use burgeon::formats::StructureSpec;
use burgeon::{Unit, UpAxis};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::given::Given;
use super::lists::structure_endings;
use super::shared::{AxesArgs, up_words};
use crate::failure::Outcome;

/// Properties that a file itself does not give.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Input")]
pub(crate) struct StructureArgs {
    /// Axis that points up in the input, where it differs from --up; MTG, OPF, QSM and SWC files may give it, and
    /// default to z.
    #[arg(long, value_parser = up_words(), value_name = "UP")]
    pub(crate) in_up: Option<UpAxis>,
    /// Unit of length in the input, where it differs from --unit; MTG, OPF, QSM and SWC files may give it, and default
    /// to metres. 0.1mm and um are for these.
    #[arg(long, value_parser = length_words(), value_name = "UNIT")]
    pub(crate) in_unit: Option<LengthUnit>,
    /// Unit of radii and diameters in an MTG, OPF, QSM or SWC file, where it differs from that of lengths: digitised
    /// trees often have places in cm and diameters in mm.
    #[arg(long, value_parser = length_words(), value_name = "UNIT")]
    pub(crate) thickness_unit: Option<LengthUnit>,
}

/// Options of [`StructureArgs`], by the names of their fields.
const OPTIONS: [&str; 3] = ["in_up", "in_unit", "thickness_unit"];

impl StructureArgs {
    pub(crate) fn spec(&self) -> StructureSpec {
        StructureSpec {
            up: self.in_up,
            metres: self.in_unit.map(|u| u.metres),
            thickness_metres: self.thickness_unit.map(|u| u.metres),
        }
    }

    /// Returns the spec where `--up` and `--unit` also apply to the input.
    pub(crate) fn spec_of_input(&self, axes: &AxesArgs, given: &Given) -> StructureSpec {
        let own = self.spec();
        let unit = given.has("unit").then(|| axes.unit.metres());
        StructureSpec { up: own.up.or(axes.up), metres: own.metres.or(unit), ..own }
    }

    /// Fails on these options where no such file is read.
    pub(crate) fn refuse(given: &Given, this: &str) -> Outcome {
        given.refuse(&OPTIONS, &format!("files of structure ({})", structure_endings()), this)
    }
}

/// A unit of length that a file may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LengthUnit {
    word: &'static str,
    pub(crate) metres: f64,
}

const LENGTHS: [(LengthUnit, &str); 6] = [
    (LengthUnit { word: "m", metres: 1.0 }, "Metres"),
    (LengthUnit { word: "cm", metres: 0.01 }, "Centimetres"),
    (LengthUnit { word: "mm", metres: 0.001 }, "Millimetres"),
    (LengthUnit { word: "ft", metres: 0.3048 }, "International feet"),
    (LengthUnit { word: "0.1mm", metres: 0.000_1 }, "Tenths of a millimetre"),
    (LengthUnit { word: "um", metres: 0.000_001 }, "Micrometres"),
];

impl LengthUnit {
    /// Returns the unit, if it is one that all files may have.
    pub(crate) fn unit(self) -> Option<Unit> {
        Unit::from_word(self.word)
    }
}

/// Returns the words of [`LengthUnit`].
pub(super) fn length_words() -> impl TypedValueParser<Value = LengthUnit> {
    let words = LENGTHS.map(|(unit, help)| PossibleValue::new(unit.word).help(help));
    let find = |word: String| LENGTHS.iter().map(|l| l.0).find(|u| u.word == word).ok_or("no unit");
    PossibleValuesParser::new(words).try_map(find)
}
