//! A drawn plant whose flowers open: its own petals, from the bud to full bloom and on to wilting.
//!
//! drawing -> plant -> (plant without flowers, a [`bloom::FlowerSpec`] for each flower) -> the plant of any day

use base::{Run, Seed, Stopped};
use bloom::{FlowerSpec, GrowthLaw, Insertion, PetalForm, PetalMesh, Seat, Stamens, Whorl};
use glam::DVec3;
use ink::Drawing;
use mesh::Model;
use plant::{Flower, FlowerId, Organ, OrganKind, Paint, Plant, Shape};
use skin::{KeptShapes, Layout, PetalColor, SkinSpec, SurfacePictures};

use crate::evaluate::make_from_sketch;
use crate::levels::{LaidOut, LevelSpec, Levels};
use crate::made::{coarse, coarser_copies};
use crate::make::{MakeError, SketchOptions};
use crate::report::ItemReport;

/// A plant of a drawing, its flowers at any day.
#[derive(Clone, Debug)]
pub struct OpeningPlant {
    /// The drawing's name.
    pub name: String,
    /// Days from bud to full bloom, and from there to wilted.
    pub days: [f64; 2],
    /// The entry of the report for the plant as it was drawn.
    pub item: ItemReport,
    /// The plant without the organs of its flowers.
    rest: Plant,
    skin: SkinSpec,
    size_m: f64,
    kept: KeptShapes,
    flowers: Vec<Placed>,
}

/// A flower and its place.
#[derive(Clone, Debug)]
struct Placed {
    spec: FlowerSpec,
    flower: FlowerId,
    seat: Seat,
    /// The stroke whose material its petals wear: that of most of the drawn ones.
    worn: Option<u32>,
}

/// Reason why no flower opens.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum OpeningError {
    /// The drawing makes no plant.
    #[error(transparent)]
    Make(#[from] MakeError),
    /// No petals were found.
    #[error("no flower was found in drawing \"{0}\": draw petals whose roots meet, or set classes")]
    NoFlowers(String),
}

impl From<Stopped> for OpeningError {
    fn from(stopped: Stopped) -> Self {
        Self::Make(stopped.into())
    }
}

impl OpeningPlant {
    /// Reads a drawing and prepares its flowers.
    ///
    /// A flower opens to the angle of the drawn one, with as many petals of the mean drawn form, in the drawn
    /// colour; stem, leaves and all else stay as drawn. The drawn petals' own irregularities are evened out, so
    /// that petals do not pass through one another on their way.
    ///
    /// # Errors
    /// [`OpeningError`].
    pub fn new(
        drawing: &Drawing,
        options: &SketchOptions,
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<Self, OpeningError> {
        let made = make_from_sketch(drawing, options, seed, run)?;
        Self::from_made(&drawing.name, (&made.plant, &made.item), &options.skin)
    }

    /// Prepares the flowers of a plant already made of a drawing, as [`OpeningPlant::new`] does: plant and entry of the
    /// report.
    ///
    /// # Errors
    /// [`OpeningError`].
    pub fn from_made(
        name: &str,
        (plant, item): (&Plant, &ItemReport),
        skin: &SkinSpec,
    ) -> Result<Self, OpeningError> {
        let natural = PetalColor::for_plant(plant, skin).linear();
        let mut rest = plant.clone();
        let flower_organs =
            |kind| matches!(kind, OrganKind::Petal | OrganKind::Disc | OrganKind::Stamen | OrganKind::Pistil);
        let mut flowers = Vec::new();
        for (k, flower) in plant.flowers.iter().enumerate() {
            let own = |o: &&Organ| o.flower.is_some_and(|f| f.index() == k);
            let organs: Vec<&Organ> = plant.organs.iter().filter(own).collect();
            let flower = placed(plant, (FlowerId::new(k), flower), &organs, natural);
            flowers.extend(flower.map(|f| Placed { worn: most_worn(&organs, skin), ..f }));
        }
        if flowers.is_empty() {
            return Err(OpeningError::NoFlowers(name.into()));
        }
        rest.organs.retain(|o| !(flower_organs(o.kind) && o.flower.is_some()));
        name.clone_into(&mut rest.name);
        let days = flowers[0].spec.days();
        let size_m = plant.extent().map_or(1.0, |(low, high)| low.distance(high));
        let (skin, kept, item) = (skin.clone(), KeptShapes::default(), item.clone());
        Ok(Self { name: name.into(), days, item, rest, skin, size_m, kept, flowers })
    }

    /// Returns the law of the first flower, for use without a fitted one.
    pub fn law(&self) -> GrowthLaw {
        let rate = self.flowers.first().map_or(0.95, |f| f.spec.rate_per_day);
        GrowthLaw::logistic(&self.name, self.days[0], rate)
    }

    /// Makes the plant at a day.
    ///
    /// Guaranteed: the same vertices and triangles at every day.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn make_on_day(
        &mut self,
        day: f64,
        law: &GrowthLaw,
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<OpenedPlant, Stopped> {
        let mut plant = self.rest.clone();
        let mut overlap = 0.0_f64;
        for (k, placed) in self.flowers.iter().enumerate() {
            let first = plant.organs.len();
            placed.spec.add_to(&mut plant, &placed.seat, day, law, seed.child(k as u64));
            // It replaces the drawn one.
            if let Some(open) = plant.flowers.pop() {
                plant.flowers[placed.flower.index()] = open;
            }
            for organ in &mut plant.organs[first..] {
                organ.flower = Some(placed.flower);
                organ.source = placed.worn.filter(|_| organ.kind == OrganKind::Petal);
            }
            overlap = overlap.max(bloom::part_overlap(&plant, Some(placed.flower)));
        }
        debug_assert_eq!(plant.validate().next(), None, "a sound plant");
        let (steady, kept) = (self.steady(), Some(&mut self.kept));
        let (model, layout) = skin::skin_laid_out(&plant, &steady, SurfacePictures::default(), kept, run)?;
        Ok(OpenedPlant { plant, model, layout, overlap })
    }

    /// Returns coarser copies of the meshes of one day and the other levels, with the same materials: at most half of
    /// the triangles with each level.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn levels(&self, open: &OpenedPlant, spec: &LevelSpec, run: &Run<'_>) -> Result<Levels, Stopped> {
        coarser_copies(spec, (&open.model, &open.plant, &open.layout), &self.steady(), run)
    }

    /// Makes a level of a plant of one day that this made, and of its model.
    pub(crate) fn coarse(
        &self,
        (plant, model): (&Plant, &Model),
        level: u32,
        run: &Run<'_>,
    ) -> Result<LaidOut, Stopped> {
        coarse(plant, &self.steady(), model, level, run)
    }

    fn steady(&self) -> SkinSpec {
        SkinSpec { steady_m: Some(self.size_m), ..self.skin.clone() }
    }
}

/// A plant of a drawing at one day.
#[derive(Clone, Debug)]
pub struct OpenedPlant {
    /// The plant.
    pub plant: Plant,
    /// Its meshes.
    pub model: Model,
    /// Places of the plant's parts in the meshes.
    pub layout: Layout,
    /// The greatest share of petal triangles of a flower that cross another petal.
    pub overlap: f64,
}

/// Returns the mean paint of petals; `natural`: colour of those without one of their own.
fn dye<'a>(petals: impl Iterator<Item = &'a Paint>, natural: [f32; 3]) -> [f32; 3] {
    let (mut sum, mut count) = ([0.0_f32; 3], 0.0_f32);
    for paint in petals {
        let base = if let Paint::Natural(_) = paint { natural } else { [1.0; 3] };
        sum = [0, 1, 2].map(|k| sum[k] + base[k] * paint.rgb()[k]);
        count += 1.0;
    }
    sum.map(|s| (s / count.max(1.0)).clamp(0.0, 1.0))
}

/// Returns the first stroke whose material most petals of a flower wear; `None` if most wear none of a stroke.
fn most_worn(organs: &[&Organ], skin: &SkinSpec) -> Option<u32> {
    let petals = || organs.iter().filter(|o| o.kind == OrganKind::Petal);
    let row = |o: &Organ| o.source.and_then(|s| skin.worn.strokes.get(&s)).copied();
    let same = |of: &Organ| petals().filter(|o| row(o) == row(of)).count();
    let (of, _) = petals().map(|o| (o, same(o))).reduce(|best, o| if o.1 > best.1 { o } else { best })?;
    row(of).and(of.source)
}

/// Least petals round a middle that makes it a disc of florets.
const RAYS: u32 = 9;
/// Largest component of a flower's axis towards the viewer at which the flower is seen from the side.
const FACING: f64 = 0.35;

/// Adds the petals that a flower drawn from the side hides.
///
/// Up to four visible petals are a ring of at least three, with another ring within it (tulip, poppy, cross-bearer). Of
/// more, the two at the edges are single and each of the others hides another.
fn add_hidden(whorls: &mut Vec<Whorl>) {
    let [seen] = whorls.as_mut_slice() else { return };
    if seen.count >= 5 {
        seen.count = (2 * seen.count - 2).min(200);
        return;
    }
    if seen.count < 2 {
        return;
    }
    seen.count = seen.count.max(3);
    let half = 180.0 / f64::from(seen.count);
    let inner = Whorl {
        length_m: 0.97 * seen.length_m,
        width_m: 0.97 * seen.width_m,
        insertion: Insertion {
            radius_m: 0.8 * seen.insertion.radius_m,
            height_m: seen.insertion.height_m + 0.02 * seen.length_m,
        },
        open_deg: seen.open_deg.map(|a| 0.94 * a),
        wilted_deg: seen.wilted_deg.map(|a| 0.9 * a),
        phase_deg: seen.phase_deg + half,
        ..*seen
    };
    whorls.push(inner);
}

/// Returns the flower as data; `None` without petals.
fn placed(
    plant: &Plant,
    (id, flower): (FlowerId, &Flower),
    organs: &[&Organ],
    natural: [f32; 3],
) -> Option<Placed> {
    let petals = organs.iter().filter(|o| o.kind == OrganKind::Petal);
    let dye = dye(petals.clone().map(|o| &o.paint), natural);
    let mut blades: Vec<(f64, PetalForm, f64)> = petals
        .filter_map(|o| match plant.shapes.get(o.shape.index())? {
            Shape::Blade(b) => {
                let (form, aspect) = PetalForm::from_outline(&b.outline)?;
                Some((b.length() * o.scale, form, aspect))
            }
            _ => None,
        })
        .collect();
    let count = u32::try_from(blades.len()).ok().filter(|&n| n > 0)?;
    // Long petals are the outer ones.
    base::sort_by(&mut blades, |a, b| b.0.total_cmp(&a.0));
    let rings = flower.whorls.clamp(1, count);
    let each = count.div_ceil(rings) as usize;
    // A disc of florets is a drawn one, or one with many rays around it; the middle of a lily is none.
    let rays = count >= RAYS;
    let discs = organs.iter().filter(|o| o.kind == OrganKind::Disc && (rays || o.source.is_some()));
    let disc = discs.into_iter().find_map(|o| match plant.shapes.get(o.shape.index())? {
        Shape::Dome { radius_m, .. } => Some(radius_m * o.scale),
        _ => None,
    });
    let stamens = organs.iter().filter(|o| o.kind == OrganKind::Stamen).count();
    let longest = blades[0].0;
    let disc = disc.unwrap_or(0.0).min(0.6 * longest);
    // The cone's half angle, in degrees: at least as open as a cup, so that a drawn bud opens too.
    let open = (flower.half_angle * 180.0 / base::ops::PI).clamp(35.0, 88.0);
    let mut whorls: Vec<Whorl> = blades
        .chunks(each)
        .enumerate()
        .filter_map(|(k, ring)| {
            let n = ring.len() as f64;
            let length = ring.iter().map(|b| b.0).sum::<f64>() / n;
            let aspect = ring.iter().map(|b| b.2).sum::<f64>() / n;
            let forms: Vec<PetalForm> = ring.iter().map(|b| b.1).collect();
            let inner = k as f64 / f64::from(rings);
            let shade = 1.0 - 0.12 * k as f32;
            let color = dye.map(|c| c * shade);
            Some(Whorl {
                count: u32::try_from(ring.len()).ok()?,
                length_m: length,
                width_m: length * aspect,
                insertion: Insertion {
                    radius_m: disc.max(0.05 * length) * (1.0 - 0.35 * inner),
                    height_m: 0.02 * length * k as f64,
                },
                bud_deg: [14.0 - 6.0 * inner, 2.0 - 2.0 * inner, -9.0],
                open_deg: [0.75, 1.0, 1.1].map(|x| x * open * (1.0 - 0.35 * inner)),
                wilted_deg: [0.9, 1.35, 1.75].map(|x| (x * open * (1.0 - 0.35 * inner)).min(165.0)),
                delay: 0.1 * inner,
                phase_deg: 180.0 / n * k as f64 + 90.0,
                lean_m: 0.008 * length,
                base_color: color.map(|c| (1.15 * c + 0.05).min(1.0)),
                tip_color: color,
                form: PetalForm::mean(&forms),
                ..Whorl::default()
            })
        })
        .collect();
    if flower.axis.normalize_or_zero().z.abs() <= FACING {
        add_hidden(&mut whorls);
    }
    let wide = whorls.iter().map(|w| w.insertion.radius_m).fold(disc, f64::max);
    let spec = FlowerSpec {
        name: plant.name.clone(),
        whorls,
        stamens: Stamens {
            count: u32::try_from(stamens).unwrap_or(0).min(40),
            length_m: 0.45 * longest,
            spread_deg: 18.0,
            ..Stamens::default()
        },
        pistil_m: if stamens > 0 { 0.5 * longest } else { 0.0 },
        disc_m: disc,
        stalk_m: 0.0,
        mesh: PetalMesh { rows: 16, columns: 10 },
        ..FlowerSpec::default()
    };
    let axis = flower.axis.try_normalize().unwrap_or(DVec3::Y);
    // The receptacle sits on the end of the stem, which would show through the disc.
    let centre = flower.centre + axis * FlowerSpec::receptacle_depth_m(wide);
    let seat = Seat { centre, turn: base::turn::between(DVec3::Y, axis), bearer: flower.bearer };
    Some(Placed { spec, flower: id, seat, worn: None })
}

base::coded!(OpeningError {
    Self::NoFlowers(name) => "no-flowers" { name },
} wraps {
    Self::Make(e) => e, MakeError;
});
