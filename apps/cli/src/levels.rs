//! A plant's file with its coarser copies beside it.

use std::path::Path;

use burgeon::formats::{Level, ModelFormat, Packing, PngCache, Room, write_glb_levels, write_glb_rigged};
use burgeon::mesh::{Copies, Model};
use burgeon::plant::Plant;
use burgeon::{ItemReport, Report, Warning};

use crate::args::{AxesArgs, PlantFormat, TreeSurfaceArgs};
use crate::failure::Outcome;
use crate::files::{self, Goal};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::picture;

/// How a .glb is written.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Form<'a> {
    packing: Option<Packing>,
    in_one_file: bool,
    sway: bool,
    /// Of the model and each coarser copy, what is left without leaves that are one form, and these; empty to write all
    /// leaves as they are.
    copies: &'a [(Model, Vec<Copies>)],
}

impl Form<'_> {
    pub(crate) fn of(args: &TreeSurfaceArgs) -> Self {
        let (packing, in_one_file, sway) = (args.packing(), args.in_one_file(), args.sway);
        Self { packing, in_one_file, sway, copies: &[] }
    }

    /// With leaves that are one form as copies.
    pub(crate) fn with(self, copies: &[(Model, Vec<Copies>)]) -> Form<'_> {
        Form { packing: self.packing, in_one_file: self.in_one_file, sway: self.sway, copies }
    }
}

/// Writes a plant to `path` and its coarser copies beside it. What became of it comes into the plant's entry of the
/// report; each copy gets an entry of its own after it.
pub(crate) fn write(
    outputs: &mut Outputs,
    (path, format, form): (&Path, PlantFormat, Form<'_>),
    (plant, model): (&Plant, &Model),
    lods: &[Model],
    axes: &AxesArgs,
    items: &mut Vec<ItemReport>,
    machine: &Machine,
) -> Outcome {
    let mut cache = PngCache::new();
    let split = |level: usize, model| {
        let split = form.copies.get(level).map(|(rest, copies)| Level { model: rest, copies });
        split.unwrap_or(Level::plain(model))
    };
    let one = form.in_one_file && format.holds(Room::Levels);
    let gltf = format.model().unwrap_or(ModelFormat::Glb);
    let all = std::iter::once((model, "-o", path.to_path_buf()));
    let all = all.chain(lods.iter().zip(1..).map(|(m, level)| (m, "--lods", files::lod(path, level))));
    let whole: Vec<Level<'_>> =
        std::iter::once(model).chain(lods).enumerate().map(|(k, m)| split(k, m)).collect();
    let main = path;
    for (level, (model, by, path)) in all.enumerate() {
        machine.cancel.check()?;
        let (written, write_ms) = machine.timed(|| match level {
            0 if one => {
                let goal = Goal::new(by, &path);
                files::write_gltf(outputs, goal, gltf, |out| {
                    write_glb_levels(&whole, form.packing, &mut cache, out)
                })?;
                Ok(Vec::new())
            }
            // It is in the file of the whole.
            _ if one => Ok(Vec::new()),
            _ if form.sway => swaying(outputs, (Goal::new(by, &path), gltf), model, &mut cache),
            _ if !form.copies.is_empty() => {
                let level = [split(level, model)];
                let goal = Goal::new(by, &path);
                files::write_gltf(outputs, goal, gltf, |out| {
                    write_glb_levels(&level, form.packing, &mut cache, out)
                })?;
                Ok(Vec::new())
            }
            _ => {
                let goal = Goal { packing: form.packing, ..Goal::new(by, &path) };
                files::write_plant(outputs, goal, (plant, model), format, axes, &mut cache)
            }
        });
        let written = written?;
        if level > 0 {
            let name = format!("{} lod{level}", items[0].name);
            items.push(ItemReport { name, ..picture::model_item(model, Path::new(""), &[]) });
        }
        let item = &mut items[level];
        item.output = if one { main } else { path.as_path() }.display().to_string();
        item.warnings.extend(written.iter().map(ToString::to_string));
        item.timings_ms.add_io(0.0, write_ms);
    }
    Ok(())
}

/// Writes a model with joints that sway.
fn swaying(
    outputs: &mut Outputs,
    (goal, format): (Goal<'_>, ModelFormat),
    model: &Model,
    cache: &mut PngCache,
) -> Outcome<Vec<Warning>> {
    let mut report = Report::default();
    match burgeon::skin::sway(model, burgeon::skin::gust(model)) {
        Some(rig) => {
            files::write_gltf(outputs, goal, format, |out| write_glb_rigged(model, &rig, cache, out))?;
        }
        None => {
            report.warn("nothing-sways", "nothing of the plant sways: it was written as it stands");
            let still = [Level::plain(model)];
            files::write_gltf(outputs, goal, format, |out| write_glb_levels(&still, None, cache, out))?;
        }
    }
    Ok(report.warnings)
}
