//! A grown plant that stands for trees: its measures, and the thickness of its stems.

use base::ops;
use glam::DVec3;
use plant::{OrganKind, Plant};

/// Height up to which stems are measured, metres: 1.3 m at the smallest scale of a plant.
const STEM_M: f64 = 4.0;
/// Number of steps in which stems are measured.
const STEM_STEPS: usize = 80;
/// Breast height, metres.
pub(super) const BREAST_M: f64 = 1.3;
/// Least factor by which the stem of a variant may be thickened.
const THINNEST: f64 = 0.4;
/// Largest factor by which the stem of a variant may be thickened.
const THICKEST: f64 = 2.5;
/// Least thickness of a stem, as a multiple of the thinnest twig, at which it has a taper that could change.
const TAPERED: f64 = 1.5;

/// A plant that stands for trees of a species.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// Row of [`forest::Stand::species`].
    pub species: u16,
    /// Row of the ages at which the species is grown, 0 for the oldest.
    pub age: u8,
    /// Number among those of its species and age, from 0.
    pub number: u32,
    /// Height, metres.
    pub height_m: f64,
    /// Mean diameter of the crown, metres.
    pub crown_width_m: f64,
    /// Horizontal offset of the middle of the leaves from the foot, metres.
    pub lean_m: DVec3,
    /// Exponent by which radii are changed: `r' = r_min (r / r_min)^n`.
    pub thicker: f64,
    /// Radii of each stem as grown at even heights from 0 to [`STEM_M`], metres; 0 above its tip.
    stems: Vec<Vec<f64>>,
    /// Radius of the thinnest shoot, metres.
    thinnest_m: f64,
}

impl Variant {
    /// Returns the diameter of its stems at a height, metres: the quadratic sum of several. 0 above their tips.
    pub fn diameter_m(&self, height_m: f64) -> f64 {
        let at = (height_m / STEM_M).clamp(0.0, 1.0) * (STEM_STEPS - 1) as f64;
        let row = ops::whole(at) as usize;
        let share = at - row as f64;
        let radius = |stem: &Vec<f64>| {
            let (a, b) = (stem.get(row).copied(), stem.get(row + 1).copied());
            let (a, b) = (a.unwrap_or(0.0), b.or(a).unwrap_or(0.0));
            if a > 0.0 && b > 0.0 {
                thickened(ops::lerp(a, b, share), self.thinnest_m, self.thicker)
            } else {
                0.0
            }
        };
        let squares = self.stems.iter().map(|s| 4.0 * radius(s) * radius(s)).sum::<f64>();
        squares.sqrt()
    }

    pub(super) fn measure(plant: &Plant, (species, age, number): (u16, u8, u32)) -> Self {
        let measures = plant.measure();
        let (low, high) = plant.extent().unwrap_or_default();
        let across = 0.5 * (high.x - low.x + high.z - low.z);
        let hull = 2.0 * (measures.crown_projection_m2 / core::f64::consts::PI).sqrt();
        let shoot = plant.shoot();
        let standing = plant.axes.iter().zip(&shoot).filter(|(a, s)| **s && a.bearer.is_none());
        let stems = standing.map(|(axis, _)| {
            let rows = axis.nodes.start as usize..axis.nodes.end as usize;
            stem_radii(&plant.nodes.position[rows.clone()], &plant.nodes.radius_m[rows])
        });
        let leaves = plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf);
        let (sum, n) = leaves.fold((DVec3::ZERO, 0_u32), |(sum, n), o| (sum + o.frame.origin, n + 1));
        Self {
            species,
            age,
            number,
            height_m: measures.height_m.max(0.01),
            crown_width_m: if hull > 0.0 { hull } else { across.max(0.01) },
            lean_m: (sum / f64::from(n.max(1))).with_y(0.0),
            thicker: 1.0,
            stems: stems.collect(),
            thinnest_m: thinnest(plant, &shoot),
        }
    }

    /// Returns a radius after thickening, metres.
    pub(super) fn thickened(&self, radius: f64) -> f64 {
        thickened(radius, self.thinnest_m, self.thicker)
    }

    /// Thickens the stem at breast height by a factor.
    pub(super) fn thicken(&mut self, times: f64) {
        let breast = self.diameter_m(BREAST_M) / 2.0;
        if breast > TAPERED * self.thinnest_m && self.thinnest_m > 0.0 {
            let times = times.clamp(THINNEST, THICKEST);
            self.thicker = (1.0 + ops::ln(times) / ops::ln(breast / self.thinnest_m)).max(0.0);
        }
    }
}

fn thickened(radius: f64, thinnest: f64, exponent: f64) -> f64 {
    if radius > thinnest && thinnest > 0.0 {
        thinnest * ops::powf(radius / thinnest, exponent)
    } else {
        radius
    }
}

fn thinnest(plant: &Plant, shoot: &[bool]) -> f64 {
    let own = plant.nodes.radius_m.iter().zip(&plant.nodes.axis);
    let own = own.filter(|(r, a)| **r > 0.0 && shoot.get(a.index()).copied().unwrap_or(false));
    own.map(|(r, _)| *r).reduce(f64::min).unwrap_or(0.0)
}

/// Returns the radius where a stem first passes each height above its foot.
fn stem_radii(points: &[DVec3], radii: &[f64]) -> Vec<f64> {
    let foot = points.first().map_or(0.0, |p| p.y);
    let mut out = Vec::with_capacity(STEM_STEPS);
    for step in 0..STEM_STEPS {
        let level = foot + STEM_M * step as f64 / (STEM_STEPS - 1) as f64;
        let passing =
            points.windows(2).zip(radii.windows(2)).find(|(p, _)| p[0].y <= level && p[1].y >= level);
        out.push(passing.map_or(0.0, |(p, r)| {
            let rise = p[1].y - p[0].y;
            if rise > 0.0 { ops::lerp(r[0], r[1], (level - p[0].y) / rise) } else { r[0] }
        }));
    }
    out
}
