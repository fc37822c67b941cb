//! A plant's file with its coarser copies next to it, within a budget if there is one.

use std::path::Path;

use burgeon::formats::{
    Assembly, Level, ModelFormat, PngCache, Room, assembly_files, write_glb_levels, write_glb_rigged,
};
use burgeon::mesh::Model;
use burgeon::plant::Plant;
use burgeon::skin::{SolidError, SolidSpec};
use burgeon::{AssemblyError, FileForm, ItemReport, Levels, Report, Warning, name_after, print_plant};

use crate::args::{AxesArgs, ExportArgs, PlantFormat};
use crate::failure::{Failure, Outcome};
use crate::files::{self, Goal, PlantWritten};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{picture, say};

/// A plant as it was made.
pub(crate) struct Whole<'a> {
    pub(crate) plant: &'a Plant,
    pub(crate) model: Model,
    pub(crate) levels: Levels,
}

/// Target of a plant, and its form.
#[derive(Clone, Copy)]
pub(crate) struct Form<'a> {
    pub(crate) goal: Goal<'a>,
    pub(crate) format: PlantFormat,
    pub(crate) export: &'a ExportArgs,
    pub(crate) axes: &'a AxesArgs,
}

impl<'a> Form<'a> {
    /// Makes the form of a file that `-o` names.
    pub(crate) fn new(
        path: &'a Path,
        format: PlantFormat,
        export: &'a ExportArgs,
        axes: &'a AxesArgs,
    ) -> Self {
        Self { goal: Goal::new("-o", path), format, export, axes }
    }

    fn gltf(&self) -> ModelFormat {
        self.format.model().unwrap_or(ModelFormat::Glb)
    }

    fn file(&self) -> FileForm {
        let export = self.export;
        FileForm {
            format: self.gltf(),
            axes: files::axes(self.axes.up, self.axes.unit),
            packing: export.packing(),
            sways: export.sway,
            is_one_file: (export.in_one_file() || export.nodes) && self.format.holds(Room::Levels),
            nodes: export.engine.filter(|_| export.nodes),
        }
    }
}

/// Reduces a plant to the allowed size.
fn fit(form: &Form<'_>, whole: &mut Whole<'_>, item: &mut ItemReport, cache: &mut PngCache) -> Outcome {
    let export = form.export;
    let allowance = export.allowance();
    if !allowance.is_any() || form.format.model().is_none() {
        return Ok(());
    }
    let model = std::mem::take(&mut whole.model);
    let levels = std::mem::take(&mut whole.levels);
    let asked = (export.lods, export.impostor.is_some());
    let plant = whole.plant;
    let file = form.file();
    let weigh = |model: &Model, levels: &Levels| file.weigh(plant, &levels.split(model), cache);
    let fitted = levels.within(model, allowance, asked, weigh);
    let fitted = fitted.map_err(|e| crate::output::write_failed(form.goal.path, e))?;
    let fitted = fitted.map_err(|e| Failure::bad_file(form.goal.path, e))?;
    if let Some(line) = fitted.line() {
        item.warnings.push(line);
    }
    item.counts.vertices = fitted.model.vertex_count() as u64;
    item.counts.triangles = fitted.model.triangle_count() as u64;
    (whole.model, whole.levels) = (fitted.model, fitted.levels);
    Ok(())
}

/// Makes one closed body of a plant.
fn print(
    form: &Form<'_>,
    spec: &SolidSpec,
    whole: &mut Whole<'_>,
    item: &mut ItemReport,
    machine: &Machine,
) -> Outcome {
    let made =
        machine.with_progress("print", |_| print_plant(whole.plant, &whole.model, spec, &machine.run()));
    let made = made.map_err(|e| match e {
        SolidError::Cancelled(_) => Failure::Cancelled,
        e => Failure::bad_file(form.goal.path, e),
    })?;
    let wall = spec.wall_m * 1e3;
    item.warnings
        .push(format!("printed at 1 : {:.3}; what would be thinner than {wall} mm is thickened", made.scale));
    if made.loose > 0 {
        let one = "surface that hangs on nothing, or lies within the body, was";
        let many = "surfaces that hang on nothing, or lie within the body, were";
        item.warnings.push(format!("{} left out", say::counted(made.loose as u64, one, many)));
    }
    whole.model = made.model;
    whole.levels = Levels::default();
    item.counts.vertices = whole.model.vertex_count() as u64;
    item.counts.triangles = whole.model.triangle_count() as u64;
    Ok(())
}

/// Writes a plant and its coarser copies next to it. The result is added to the plant's entry of the report, the first
/// of `items`; each copy gets an entry of its own after it.
pub(crate) fn write(
    outputs: &mut Outputs,
    form: &Form<'_>,
    mut whole: Whole<'_>,
    items: &mut Vec<ItemReport>,
    cache: &mut PngCache,
    machine: &Machine,
) -> Outcome {
    let (format, export) = (form.format, form.export);
    if export.instances && whole.levels.copies.iter().all(|(_, copies)| copies.is_empty()) {
        return Err(Failure::bad_file(
            form.goal.path,
            "--instances is for plants of which a leaf stands in several places; this one has none: leave it out",
        ));
    }
    if let Some(spec) = export.print() {
        print(form, &spec, &mut whole, &mut items[0], machine)?;
    }
    if export.names {
        let Whole { plant, model, levels } = &mut whole;
        let rest = levels.copies.iter_mut().map(|(rest, _)| rest);
        let all = levels.lods.iter_mut().chain(rest).chain([&mut *model]);
        all.for_each(|model| name_after(&plant.name, model));
    }
    fit(form, &mut whole, &mut items[0], cache)?;
    if let Some(report) = export.report().filter(|_| !machine.quiet) {
        say::line(&format!("for {}: {}", report.name, report.set.join(", ")));
    }
    if let Some(made) = whole.levels.assembly.take() {
        return write_assembly(outputs, form, made, &mut items[0], machine);
    }
    let Whole { plant, model, levels } = &whole;
    let file = form.file();
    let (one, gltf) = (file.is_one_file, file.format);
    let of_file = levels.split(model);
    let main = form.goal.path;
    let all = std::iter::once((model, "-o", main.to_path_buf()));
    let all = all.chain(levels.lods.iter().zip(1..).map(|(m, level)| (m, "--lods", files::lod(main, level))));
    for (level, (model, by, path)) in all.enumerate() {
        machine.cancel.check()?;
        let goal = Goal { by, path: &path, packing: export.packing(), ..form.goal };
        let in_levels = |outputs: &mut Outputs, levels: &[Level<'_>], cache: &mut PngCache| {
            files::write_beside(outputs, goal, file.textures_beside(plant, model, &goal.stems().0))?;
            files::write_gltf(outputs, goal, gltf, |out| file.write_levels(plant, levels, cache, out))
        };
        let (written, write_ms) = machine.timed(|| match level {
            0 if one => in_levels(outputs, &of_file, cache).map(|()| PlantWritten::default()),
            // It is in the file of the whole.
            _ if one => Ok(PlantWritten::default()),
            _ if export.sway => swaying(outputs, (goal, gltf), model, cache).map(Into::into),
            _ if !levels.copies.is_empty() => {
                in_levels(outputs, &of_file[level..=level], cache).map(|()| PlantWritten::default())
            }
            _ => files::write_plant(outputs, goal, (plant, model), format, form.axes, cache),
        });
        let written = written?;
        if level > 0 {
            let name = format!("{} lod{level}", items[0].name);
            items.push(ItemReport { name, ..picture::model_item(model, Path::new(""), &[]) });
        }
        let item = &mut items[level];
        item.output = if one { main } else { path.as_path() }.display().to_string();
        written.tell(item);
        item.timings_ms.add_io(0.0, write_ms);
    }
    Ok(())
}

/// Writes a plant as a skeleton with leaves on its joints.
fn write_assembly(
    outputs: &mut Outputs,
    form: &Form<'_>,
    made: Result<Assembly, AssemblyError>,
    item: &mut ItemReport,
    machine: &Machine,
) -> Outcome {
    let mut assembly = made.map_err(|e| Failure::bad_file(form.goal.path, e))?;
    let name = assembly.model.name.clone();
    name_after(&name, &mut assembly.model);
    let (_, stem) = form.goal.stems();
    let spec = files::axes(form.axes.up, form.axes.unit);
    let (written, write_ms) =
        machine.timed(|| files::write_files(outputs, form.goal, assembly_files(&assembly, &stem, &spec)));
    written?;
    item.output = form.goal.path.display().to_string();
    item.timings_ms.add_io(0.0, write_ms);
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
