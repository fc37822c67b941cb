//! What `--for ENGINE` sets of the options of a command.

use std::path::Path;

use clap::ValueEnum;

use super::engine::Air;
use super::export::ExportArgs;
use super::given::Given;
use super::shared::{AxesArgs, SkinArgs};
use crate::failure::{Failure, Outcome};

/// The options of a command that an engine sets.
pub(crate) struct Settings<'a> {
    pub(crate) export: &'a mut ExportArgs,
    pub(crate) axes: &'a mut AxesArgs,
    /// Whether there are columns of the wind.
    pub(crate) wind: &'a mut bool,
    /// The file that is written.
    pub(crate) output: Option<&'a Path>,
}

impl Settings<'_> {
    /// Sets what the engine wants and the command line leaves open.
    pub(crate) fn settle(self, given: &Given) -> Outcome {
        let Some(engine) = self.export.engine else { return Ok(()) };
        let row = engine.row();
        let ending =
            self.output.and_then(Path::extension).and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
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
    output: Option<&Path>,
) -> Outcome {
    Settings { export, axes, wind: &mut skin.wind, output }.settle(given)
}
