//! A plant's file with its coarser copies beside it.

use std::path::Path;

use burgeon::ItemReport;
use burgeon::formats::{Packing, PngCache};
use burgeon::mesh::Model;
use burgeon::plant::Plant;

use crate::args::{AxesArgs, PlantFormat};
use crate::failure::Outcome;
use crate::files::{self, Goal};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::picture;

/// Writes a plant to `path` and its coarser copies beside it. What became of it comes into the plant's entry of the
/// report; each copy gets an entry of its own after it.
pub(crate) fn write(
    outputs: &mut Outputs,
    (path, format, packing): (&Path, PlantFormat, Option<Packing>),
    (plant, model): (&Plant, &Model),
    lods: &[Model],
    axes: &AxesArgs,
    items: &mut Vec<ItemReport>,
    machine: &Machine,
) -> Outcome {
    let mut cache = PngCache::new();
    let all = std::iter::once((model, "-o", path.to_path_buf()));
    let all = all.chain(lods.iter().zip(1..).map(|(m, level)| (m, "--lods", files::lod(path, level))));
    for (level, (model, by, path)) in all.enumerate() {
        machine.cancel.check()?;
        let goal = Goal { packing, ..Goal::new(by, &path) };
        let (written, write_ms) =
            machine.timed(|| files::write_plant(outputs, goal, (plant, model), format, axes, &mut cache));
        let written = written?;
        if level > 0 {
            let name = format!("{} lod{level}", items[0].name);
            items.push(ItemReport { name, ..picture::model_item(model, Path::new(""), &[]) });
        }
        let item = &mut items[level];
        item.output = path.display().to_string();
        item.warnings.extend(written.iter().map(ToString::to_string));
        item.timings_ms.add_io(0.0, write_ms);
    }
    Ok(())
}
