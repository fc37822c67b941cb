//! The shapes of a show, into files.

use std::path::Path;

use burgeon::formats::{ExportSpec, ModelFormat, Morph, PngCache, Room, write_cloud_ply, write_glb_morph};
use burgeon::glam::DVec3;
use burgeon::mesh::PointCloud;
use burgeon::plant::{Measures, Plant};
use burgeon::{CheckReport, Counts, Digest, ItemReport, LevelSpec};

use super::{Show, Shown};
use crate::args::{AxesArgs, BloomRunArgs, PictureArgs};
use crate::failure::Outcome;
use crate::files::Goal;
use crate::levels::{Form, Whole};
use crate::machine::Machine;
use crate::output::Outputs;
use crate::{files, levels, names, picture};

/// Results of writing.
#[derive(Default)]
pub(super) struct Written {
    pub(super) frames: u32,
    /// Counts of the last shape.
    pub(super) counts: Counts,
    pub(super) measures: Option<Measures>,
    pub(super) digest: String,
    pub(super) overlap: Vec<f64>,
    /// Checks of the first shape with a failed one, or of the last shape.
    pub(super) checks: Vec<CheckReport>,
    pub(super) warnings: Vec<String>,
}

impl Written {
    fn take(&mut self, shown: &Shown) {
        self.frames += 1;
        self.counts = match &shown.plant {
            Some(plant) => Counts::from_plant(plant),
            None => Counts::default(),
        };
        self.counts.vertices = shown.model.vertex_count() as u64;
        self.counts.triangles = shown.model.triangle_count() as u64;
        self.measures = shown.plant.as_ref().map(Plant::measure);
        self.overlap.extend(shown.overlap);
        if self.checks.iter().all(|c| c.ok) {
            self.checks.clone_from(&shown.checks);
        }
    }
}

pub(super) fn write_show(
    args: &BloomRunArgs,
    show: &mut Show<'_>,
    axes: &ExportSpec,
    outputs: &mut Outputs,
    machine: &Machine,
) -> Outcome<Written> {
    let mut written = Written::default();
    let mut digest = Digest::new();
    let at = |k: u32| {
        let share = f64::from(k) / f64::from(args.frames - 1);
        show.days[0] + (show.days[1] - show.days[0]) * share
    };
    let mut one = |day: f64, path: &Path, written: &mut Written, digest: &mut Digest| -> Outcome {
        machine.cancel.check()?;
        let shown = (show.shape)(day)?;
        digest.add(&shown.model);
        written.take(&shown);
        let item = write_one(outputs, path, shown, axes, (args, machine))?;
        // A budget may have made it smaller.
        written.counts.vertices = item.counts.vertices;
        written.counts.triangles = item.counts.triangles;
        written.warnings.extend(item.warnings);
        Ok(())
    };
    match (files::extension(&args.output), args.film(), args.one_day()) {
        (None, ..) => {
            let name = names::safe(&show.name);
            for k in 0..args.frames {
                let name = format!("{name}-{k:03}.{}", args.format.0.extension());
                one(at(k), &args.output.join(name), &mut written, &mut digest)?;
            }
        }
        (Some(_), _, Some(day)) => one(day, &args.output, &mut written, &mut digest)?,
        (Some(_), Some(format), None) => {
            let mut models = Vec::new();
            for k in 0..args.frames {
                machine.cancel.check()?;
                let shown = (show.shape)(at(k))?;
                digest.add(&shown.model);
                written.take(&shown);
                models.push(shown.model);
            }
            // The model itself is the frame nearest to full bloom: a program that shows no animation, or no colours of
            // one, shows the open flower.
            let far = |k: u32| (at(k) - show.best).abs();
            let best = (0..args.frames).min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(0);
            #[expect(clippy::cast_possible_truncation, reason = "seconds of an animation")]
            let second = |k: u32| (args.seconds * f64::from(k) / f64::from(args.frames - 1)) as f32;
            if let Some(model) = models.get(best as usize) {
                let keys = (0..args.frames).zip(&models).filter(|(k, _)| *k != best);
                let keys = keys.map(|(k, m)| (second(k), m)).collect();
                let morph = Morph { name: "growth", at: second(best), keys };
                let goal = Goal::new("-o", &args.output);
                files::write_gltf(outputs, goal, format, |out| write_glb_morph(model, &morph, out))?;
            }
        }
        (Some(_), None, None) => one(show.best, &args.output, &mut written, &mut digest)?,
    }
    if let Some(png) = &args.png {
        let model = (show.shape)(args.day.unwrap_or(show.best))?.model;
        let look = PictureArgs {
            size: args.size,
            view: args.view,
            frames: 8,
            background: burgeon::render::Background::Sky,
            no_shadow: false,
            supersample: 4,
        };
        let spec = look.spec(args.seed);
        let model = picture::with_dots(model);
        let drawn =
            machine.with_progress("picture", |_| burgeon::render::render(&model, &spec, &machine.run()))?;
        picture::write(outputs, "--png", png, &drawn)?;
    }
    written.digest = digest.hex();
    Ok(written)
}

/// Returns the levels in addition to the finest meshes: none for an animation or a folder.
pub(super) fn levels_of(args: &BloomRunArgs) -> LevelSpec {
    let one = files::extension(&args.output).is_some() && args.film().is_none();
    let format = files::plant_writable(&args.output).ok().filter(|_| one);
    args.export.levels(format)
}

/// Writes clouds as PLY in double precision, everything else by the writers of models.
fn write_one(
    outputs: &mut Outputs,
    path: &Path,
    Shown { plant, model, levels, .. }: Shown,
    axes: &ExportSpec,
    (args, machine): (&BloomRunArgs, &Machine),
) -> Outcome<ItemReport> {
    let mut items = vec![ItemReport::default()];
    items[0].counts.vertices = model.vertex_count() as u64;
    items[0].counts.triangles = model.triangle_count() as u64;
    let mut cache = PngCache::new();
    if let Some(plant) = &plant {
        // --unit and --up applied to the scans: glTF in metres with +Y up is expected.
        let format = files::plant_writable(path)?;
        let plain = AxesArgs::default();
        let axes = if format.holds(Room::Axes) { &args.axes } else { &plain };
        let form = Form::new(path, format, &args.export, axes);
        let whole = Whole { plant, model, levels };
        levels::write(outputs, &form, whole, &mut items, &mut cache, machine)?;
        return Ok(items.swap_remove(0));
    }
    let bare = model.parts.iter().all(|p| p.mesh.triangles.is_empty());
    let format: ModelFormat = files::writable(path)?;
    if bare && format == ModelFormat::Ply {
        let mut cloud = PointCloud { offset_m: model.offset_m, ..PointCloud::default() };
        for part in &model.parts {
            let color = model.material(part).base_color;
            for p in &part.mesh.positions {
                cloud.points.push(DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2])));
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
            if part.mesh.colors.is_empty() {
                let color = color.map(|c| (c.clamp(0.0, 1.0).sqrt() * 255.0) as u8);
                cloud.colors.resize(cloud.points.len(), color);
            } else {
                let byte = |c: f32| burgeon::byte_of_light(f64::from(c));
                cloud.colors.extend(part.mesh.colors.iter().map(|c| c.map(byte)));
            }
        }
        outputs.write("-o", path, |out| write_cloud_ply(&cloud, axes, out))?;
        return Ok(items.swap_remove(0));
    }
    // --unit and --up applied to the scans: glTF in metres with +Y up is expected.
    let axes = if format.holds(Room::Axes) { axes } else { &ExportSpec::default() };
    files::write_model(outputs, Goal::new("-o", path), &model, format, axes, &mut cache)?;
    Ok(items.swap_remove(0))
}
