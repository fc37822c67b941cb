//! Contours filled with twigs and leaves (He and Cheng 2021, section 4.3).
//!
//! `Reading::regions + the plant's drawn axes -> grown twigs and leaves`
//!
//! | region | becomes | module |
//! |---|---|---|
//! | branch contour | twigs by Eq 2 | `twigs` |
//! | leaf contour | leaves on midribs by Eq 2 | `leaves` |
//! | crown | limbs, branches, twigs, leaves | `crown`, `foliage` |
//!
//! All of them grow in the body of the contour (`volume`) towards points scattered in it (`scatter`). Bounded: 4,000
//! twigs and 20,000 leaves a region, and about [`MOST_GROWN`] leaves a drawing.

mod crown;
mod foliage;
mod grow;
mod leaves;
mod scatter;
mod twigs;
mod volume;

use core::ops::Range;
use std::collections::BTreeMap;

use base::{Cancelled, Draw, Report, Run, Seed};
use glam::{DVec2, DVec3};
use plant::{AxisId, AxisKind, BladeForm, Paint, Phyllotaxis, Plant, Shape, ShapeId};

use crate::depth::drawn_light;
use crate::{FillSpec, PlantMap, PullSet, SketchSpec};
use crown::{Crown, Habit};
use foliage::Foliage;
use leaves::Leaves;
use reading::{Reading, RegionKind, RegionReading};
use twigs::Twigs;
use volume::{Inflation, Volume, above};

/// Most leaves that grow in all contours of a drawing together; a fair share of them in each.
pub(crate) const MOST_GROWN: usize = 200_000;

/// Length of a tree's leaves in a crown without drawn leaves, metres; smaller crowns have smaller ones.
const NATURAL_LEAF: f64 = 0.12;
/// Length of a conifer's sprays in such a crown, metres.
const NATURAL_SPRAY: f64 = 0.35;
/// Area that a leaf covers over the square of its length.
const LEAF_COVER: f64 = 0.5;
/// Area that a spray with sky between its needles covers over the square of its length.
const SPRAY_COVER: f64 = 0.2;
/// Area of a crown's leaves over that of its shadow, the mean of its three projections: a narrow crown has light from
/// the side. Broad-leaved trees have 3 to 6.
const LEAF_AREA_INDEX: f64 = 5.0;
/// Most leaves of a crown of density 1; leaves are larger if it would have more.
const MOST_CROWN: usize = 8_000;

/// Axes of a plant at which contours are left empty: a million nodes or more, a gigabyte of meshes.
const MOST_AXES: usize = 250_000;

/// Properties of the plant for filling its contours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FillContext<'a> {
    /// The requested settings.
    pub(crate) spec: &'a SketchSpec,
    /// The drawing's seed.
    pub(crate) seed: Seed,
    /// Ink to plant.
    pub(crate) map: PlantMap,
    /// The plant's axis of each row of `Reading::axes`; `None` if it degenerated.
    pub(crate) axis_of_reading: &'a [Option<AxisId>],
    /// Blade shapes of the drawn leaves, in their order, with their strokes.
    pub(crate) templates: &'a [(ShapeId, Option<u32>)],
    /// Height of the drawn plant, metres: the size of twigs and leaves that nobody drew is a share of it.
    pub(crate) height_m: f64,
    /// A tree rather than a herb.
    pub(crate) woody: bool,
    /// Drawn with coloured pens: leaves take the colour of their contour.
    pub(crate) coloured: bool,
}

/// The growth in one contour.
#[derive(Clone, Debug, PartialEq)]
pub struct GrownContour {
    /// The kind of growth.
    pub kind: RegionKind,
    /// The part of the contour that was filled, metres: for a tree drawn in one line, that above its trunk.
    pub outline: Vec<DVec2>,
    /// The plant's axes that grew in it.
    pub axes: Range<usize>,
    /// The plant's organs that grew in it.
    pub organs: Range<usize>,
}

/// Returns the plant of a stroke, if a drawing shows several.
fn plant_of(reading: &Reading, stroke: Option<u32>) -> Option<usize> {
    let stroke = stroke.filter(|_| reading.plants.len() > 1)?;
    reading.plants.iter().position(|p| p.strokes.binary_search(&stroke).is_ok())
}

/// Fills every region of the reading with twigs and leaves, borne by the plant's axes. Returns the growth, in the
/// order of the regions.
///
/// Guaranteed: nodes and leaf roots inside a contour stay inside it as seen from the front; radii of the new
/// axes are 0 until they are set when the whole plant stands; the same input gives the same plant.
/// Not guaranteed: blades may overlap the contour a little. Contours without area are skipped with a warning.
///
/// Cost: 1 to 3 ms for a crown of 1,100 leaves; linear in leaves, twigs times branches for finding where to start.
///
/// # Errors
/// [`Cancelled`] when the caller asked to stop.
pub(crate) fn fill(
    plant: &mut Plant,
    reading: &Reading,
    ctx: &FillContext<'_>,
    kept: &mut KeptBodies,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Vec<GrownContour>, Cancelled> {
    let mut grown = Vec::with_capacity(reading.regions.len());
    let mut bodies = KeptBodies::default();
    let mut forms: Vec<(BladeForm, ShapeId)> = Vec::new();
    let templates = ctx
        .templates
        .iter()
        .filter_map(|&(shape, source)| Some((foliage::measured(plant, shape)?, plant_of(reading, source))));
    let templates: Vec<((ShapeId, f64), Option<usize>)> = templates.collect();
    let share = MOST_GROWN / reading.regions.len().max(1);
    let mut born: BTreeMap<u64, u64> = BTreeMap::new();
    for (row, region) in reading.regions.iter().enumerate() {
        run.cancel.check()?;
        if plant.axes.len() > MOST_AXES {
            let left = reading.regions.len() - row;
            base::warn!(
                report,
                "contours-beyond-limit",
                { axes = plant.axes.len(), count = left },
                "the plant has {axes} axes: {count} contours were left empty; draw several plants"
            );
            break;
        }
        let outline: Vec<DVec2> = region.outline.iter().map(|&p| ctx.map.plant_from_ink(p)).collect();
        let Some(mut volume) = kept.take(outline, region.kind, &mut bodies) else {
            base::warn!(
                report,
                "contour-flat",
                { contour = row + 1 },
                "contour {contour} encloses nothing and was left empty"
            );
            continue;
        };
        let bearers = bearers(plant, region, ctx, &volume);
        // The name is the bearer and the rank among that bearer's contours, so that editing one does not change
        // others.
        let bearer = bearers.first().map_or(0, |&a| plant.axis(a).key);
        let next = born.entry(bearer).or_default();
        let rank = *next;
        *next += 1;
        let seed = ctx.seed.child(bearer).child(rank);
        lay(plant, &mut volume, &bearers, region.kind);
        let spec = tame(ctx.spec.fill);
        let (first_axis, first) = (plant.axes.len(), plant.organs.len());
        let height_m = ctx.height_m;
        // Grass next to a tree does not belong to the tree.
        let own = plant_of(reading, region.source);
        let is_own = |of: Option<usize>| own.is_none() || of.is_none() || of == own;
        let drawn: Vec<(ShapeId, f64)> = templates.iter().filter(|t| is_own(t.1)).map(|t| t.0).collect();
        let natural = foliage::median_length(&drawn);
        let mut look = Look { forms: &mut forms, drawn: &drawn, natural, share, seed, spec, height_m };
        let (axes, leaves) = match region.kind {
            RegionKind::Twigs => {
                let kind = if ctx.woody { AxisKind::Twig } else { AxisKind::Stem };
                let wanted = twigs::twigs_for(volume.area, height_m, spec.density);
                let twigs =
                    Twigs { volume: &volume, spec, seed, bearers: &bearers, kind, wanted, salt: rank };
                (twigs.grow(plant, &mut Vec::new()), 0)
            }
            RegionKind::Leaves => {
                let (foliage, leaves) = look.fill_cluster(plant, &volume);
                Leaves { volume: &volume, spec, seed, bearers: &bearers, foliage, leaves, salt: rank }
                    .grow(plant)
            }
            RegionKind::Crown => {
                let habit = Habit::infer(&volume, plant.axis_points(bearers[0]));
                let (foliage, leaves) = look.fill_crown(plant, &volume, habit);
                let woody = ctx.woody;
                let bearers = &bearers;
                Crown { volume: &volume, spec, seed, bearers, foliage, leaves, habit, woody, salt: rank }
                    .grow(plant)
            }
        };
        if let Some(light) = region.color.filter(|_| ctx.coloured).and_then(drawn_light) {
            for organ in &mut plant.organs[first..] {
                #[expect(clippy::cast_possible_truncation, reason = "colours are f32")]
                let light = light.map(|x| x as f32);
                let varied = organ.paint.rgb();
                organ.paint = Paint::Drawn([0, 1, 2].map(|i| varied[i] * light[i]));
            }
        }
        grown.push(GrownContour {
            kind: region.kind,
            outline: volume.outline().to_vec(),
            axes: first_axis..plant.axes.len(),
            organs: first..plant.organs.len(),
        });
        if axes + leaves == 0 {
            base::warn!(
                report,
                "contour-empty",
                { contour = row + 1 },
                "nothing could grow in contour {contour}"
            );
        }
    }
    *kept = bodies;
    Ok(grown)
}

/// The bodies of a drawing's contours, for the next time that the same drawing is built: those of unchanged contours
/// are taken over. The result is the same with and without.
#[derive(Clone, Debug, Default)]
pub struct KeptBodies(Vec<(Vec<DVec2>, RegionKind, Option<Volume>)>);

impl KeptBodies {
    /// Most contours that are kept: each takes some hundred kilobytes.
    const MOST: usize = 64;

    /// Returns the body of a contour, and keeps it in `next`; `None` if it encloses nothing.
    fn take(&mut self, outline: Vec<DVec2>, kind: RegionKind, next: &mut Self) -> Option<Volume> {
        let known = self.0.iter().position(|(o, k, _)| *k == kind && *o == outline);
        let volume = match known {
            Some(row) => self.0.swap_remove(row).2,
            None => body(outline.clone(), kind).map(|(_, volume)| volume),
        };
        if next.0.len() < Self::MOST {
            next.0.push((outline, kind, volume.clone()));
        }
        volume
    }
}

/// Returns the part of a contour that is filled, and its body; `None` if it encloses nothing.
///
/// Many people draw a tree in one line: the part below the crown is its trunk, not foliage.
fn body(outline: Vec<DVec2>, kind: RegionKind) -> Option<(Vec<DVec2>, Volume)> {
    let inflation = if kind == RegionKind::Crown { Inflation::Rows } else { Inflation::Ball };
    let whole = Volume::new(&outline, inflation)?;
    if kind == RegionKind::Crown
        && let Some(neck) = whole.neck()
        && let crown = above(&outline, neck)
        && let Some(volume) = Volume::new(&crown, inflation)
    {
        return Some((crown, volume));
    }
    Some((outline, whole))
}

/// Returns the plant's axes that run into a region; if those of the reading have all degenerated, a new stem. Never
/// empty.
fn bearers(plant: &mut Plant, region: &RegionReading, ctx: &FillContext<'_>, volume: &Volume) -> Vec<AxisId> {
    let known = region.bearers.iter().filter_map(|&row| ctx.axis_of_reading.get(row).copied().flatten());
    let mut axes: Vec<AxisId> = known.collect();
    axes.dedup();
    // The trunk first: the lowest order, then the lowest foot.
    base::sort_by(&mut axes, |&a, &b| {
        let foot = |x| plant.axis_points(x).first().map_or(0.0, |p: &DVec3| p.y);
        plant.axis(a).order.cmp(&plant.axis(b).order).then(foot(a).total_cmp(&foot(b)))
    });
    if axes.is_empty() {
        let low = volume.low().y;
        let middle = |t: f64| {
            let y = low + t * volume.height();
            let x = volume.row(y).map_or(0.5 * (volume.low().x + volume.high().x), |(x, _)| x);
            DVec3::new(x, y, 0.0)
        };
        let points: Vec<DVec3> = (0..4).map(|i| middle(0.02 + 0.09 * f64::from(i))).collect();
        let kind = if ctx.woody { AxisKind::Branch } else { AxisKind::Stem };
        let key = ctx.seed.child(u64::from(region.source.unwrap_or(u32::MAX))).number();
        axes.push(plant.add_axis(kind, None, key, &points, region.source));
    }
    axes
}

/// Moves the body to the depth of its bearers.
fn lay(plant: &Plant, volume: &mut Volume, bearers: &[AxisId], kind: RegionKind) {
    let inside = |p: &&DVec3| volume.contains_xy(p.truncate());
    let points = || bearers.iter().flat_map(|&a| plant.axis_points(a));
    let mut lines: Vec<DVec3> = points().filter(inside).copied().collect();
    if lines.is_empty() {
        lines = bearers.iter().filter_map(|&a| plant.axis_points(a).last().copied()).collect();
    }
    if kind == RegionKind::Crown {
        // A crown is round about its trunk.
        let trunk = plant.axis_points(bearers[0]);
        let z = trunk.iter().rfind(inside).or(trunk.last()).map_or(0.0, |p| p.z);
        volume.centre_at(z);
    } else {
        let stride = lines.len().div_ceil(24).max(1);
        let few: Vec<DVec3> = lines.into_iter().step_by(stride).collect();
        volume.follow(&few);
    }
}

/// Clamps the numbers to their documented ranges; defaults for those that are not finite.
fn tame(spec: FillSpec) -> FillSpec {
    let d = FillSpec::default();
    let fix = |x: f64, lo: f64, hi: f64, or: f64| if x.is_finite() { x.clamp(lo, hi) } else { or };
    let named = spec.set.map(PullSet::coefficients);
    let [contour_pull, bearer_pull, memory] =
        named.unwrap_or([spec.contour_pull, spec.bearer_pull, spec.memory]);
    FillSpec {
        set: None,
        contour_pull: fix(contour_pull, 0.0, 1.0, d.contour_pull),
        bearer_pull: fix(bearer_pull, 0.0, 1.0, d.bearer_pull),
        memory: fix(memory, 0.0, 1.0, d.memory),
        density: fix(spec.density, 0.1, 10.0, d.density),
        tropism: fix(spec.tropism, -1.0, 1.0, d.tropism),
    }
}

/// Chooses leaves: the user's, if leaves were drawn, else botanical forms.
struct Look<'a> {
    forms: &'a mut Vec<(BladeForm, ShapeId)>,
    drawn: &'a [(ShapeId, f64)],
    /// Median length of the drawn leaves.
    natural: Option<f64>,
    /// Most leaves for this contour.
    share: usize,
    seed: Seed,
    spec: FillSpec,
    height_m: f64,
}

impl Look<'_> {
    fn form(&mut self, plant: &mut Plant, form: BladeForm) -> (ShapeId, f64) {
        if let Some((_, id)) = self.forms.iter().find(|(f, _)| *f == form) {
            return (*id, 1.0);
        }
        let id = plant.add_shape(Shape::Blade(form.blade()));
        self.forms.push((form, id));
        (id, 1.0)
    }

    fn fill_crown(&mut self, plant: &mut Plant, volume: &Volume, habit: Habit) -> (Foliage, usize) {
        // Diameter of the circle with the contour's area.
        let diameter = (volume.area * 4.0 / base::ops::PI).sqrt();
        let conifer = habit == Habit::Excurrent;
        let (natural, coarse, mut cover) =
            if conifer { (NATURAL_SPRAY, 8.5, SPRAY_COVER) } else { (NATURAL_LEAF, 11.0, LEAF_COVER) };
        let mut length = natural.min(diameter / coarse);
        let mut shapes = self.drawn.to_vec();
        if let Some(natural) = self.natural {
            (length, cover) = (natural.clamp(diameter / 40.0, diameter / 6.0), LEAF_COVER);
        } else if conifer {
            shapes.push(self.form(plant, BladeForm::Spray));
        } else {
            const FORMS: [BladeForm; 4] =
                [BladeForm::Ovate, BladeForm::Elliptic, BladeForm::Cordate, BladeForm::Lobed];
            let form = FORMS[self.seed.stream(Draw::Template).below(FORMS.len())];
            shapes.push(self.form(plant, form));
        }
        let shadow = (base::ops::PI * volume.half_width * volume.half_width + 2.0 * volume.area) / 3.0;
        let area = LEAF_AREA_INDEX * shadow;
        length = length.max((area / (cover * MOST_CROWN as f64)).sqrt());
        let leaves = leaves::leaves_for(area, length, 0.25 / cover * self.spec.density);
        let middle = 0.5 * (volume.low() + volume.high());
        let core = DVec2::new(middle.x, volume.low().y + 0.35 * volume.height());
        let foliage = Foliage {
            shapes,
            length,
            phyllotaxis: if conifer { Phyllotaxis::Opposite } else { Phyllotaxis::default() },
            insertion: if conifer { 0.7 } else { 0.95 },
            light: if conifer { 0.25 } else { 0.75 },
            core: core.extend(volume.mid(core)),
            most: leaves::MOST_LEAVES.min(self.share),
        };
        (foliage, leaves.min(self.share))
    }

    fn fill_cluster(&mut self, plant: &mut Plant, volume: &Volume) -> (Foliage, usize) {
        let mut shapes = self.drawn.to_vec();
        let room = 1.6 * volume.inradius;
        let length = self.natural.unwrap_or(leaves::DEFAULT_LENGTH * self.height_m).min(room);
        if shapes.is_empty() {
            shapes.push(self.form(plant, BladeForm::Ovate));
        }
        let leaves = leaves::leaves_for(volume.area, length, 0.64 * self.spec.density);
        let core = 0.5 * (volume.low() + volume.high());
        let foliage = Foliage {
            shapes,
            length,
            phyllotaxis: Phyllotaxis::default(),
            insertion: 0.9,
            light: 0.5,
            core: core.extend(volume.mid(core)),
            most: leaves::MOST_LEAVES.min(self.share),
        };
        (foliage, leaves.min(self.share))
    }
}

#[cfg(test)]
mod tests;
