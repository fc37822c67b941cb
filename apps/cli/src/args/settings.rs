//! Effects of `--for ENGINE` on the options of a command.

use std::path::Path;

use burgeon::ExportChoice;

use super::export::ExportArgs;
use super::given::Given;
use super::plant_format::PlantFormat;
use super::shared::{AxesArgs, PackWord, SkinArgs};
use crate::failure::{Failure, Outcome};

/// The options of a command that an engine sets.
pub(crate) struct Settings<'a> {
    pub(crate) export: &'a mut ExportArgs,
    pub(crate) axes: &'a mut AxesArgs,
    /// Whether there are wind columns.
    pub(crate) wind: &'a mut bool,
    /// The file that is written.
    pub(crate) output: Option<&'a Path>,
}

impl Settings<'_> {
    /// Sets the options that the engine requires and the command line leaves open.
    pub(crate) fn settle(self, given: &Given) -> Outcome {
        let Some(engine) = self.export.engine else { return Ok(()) };
        let ending = self.output.and_then(ending);
        let Some(ending) = ending else {
            return Err(Failure::Bad(format!(
                "--for {} is for a model: name its file with -o, ending with .{}",
                engine.word(),
                engine.endings().join(" or .")
            )));
        };
        let (export, axes) = (&mut *self.export, &mut *self.axes);
        let mut choice = ExportChoice {
            up: axes.up.filter(|_| given.has("up")),
            unit: Some(axes.unit).filter(|_| given.has("unit")),
            lods: Some(export.lods).filter(|_| given.has("lods")),
            packing: export.pack.map(PackWord::packing),
            has_wind: *self.wind,
            sways: export.sway,
            is_one_file: export.in_one_file(),
            is_still: export.instances || export.impostor.is_some(),
            has_names: export.names,
        };
        let set = engine.settle(&ending, &mut choice);
        let set = set.map_err(|e| {
            Failure::Bad(format!("--for {}: {e}; end the name with that, or leave --for out", engine.word()))
        })?;
        let written =
            |s: &burgeon::EngineSetting| if s.is_option() { format!("--{s}") } else { s.to_string() };
        export.set = set.iter().map(written).collect();
        export.assembly = engine.has_assembly(&ending);
        export.nodes = !export.assembly && engine.has_nodes(&choice);
        axes.up = choice.up.or(axes.up);
        axes.unit = choice.unit.unwrap_or(axes.unit);
        export.lods = choice.lods.unwrap_or(export.lods);
        export.pack = choice.packing.map(PackWord::from_packing);
        (*self.wind, export.sway, export.names) = (choice.has_wind, choice.sways, choice.has_names);
        Ok(())
    }
}

/// Returns the ending of a file's name, of two words where a format has them.
fn ending(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?;
    let two = PlantFormat::from_two_words(name).map(|format| format.extension().to_owned());
    two.or_else(|| Some(path.extension()?.to_str()?.to_ascii_lowercase()))
}

/// Settles the options of a command with a plain surface.
pub(crate) fn settle(
    given: &Given,
    (export, skin, axes): (&mut ExportArgs, &mut SkinArgs, &mut AxesArgs),
    output: Option<&Path>,
) -> Outcome {
    Settings { export, axes, wind: &mut skin.wind, output }.settle(given)
}
